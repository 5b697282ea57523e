"""Floating-point designs certified exactly: drawn systems, large rings; prints figures.

Run as ``python -m tests.assurance.campaigns.floating [COUNT] [SEED]`` for everything; the tests
call the parts with small counts.  The seeds are fixed and printed.
"""

from __future__ import annotations

import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

import mcexact.checker
from mcexact.analysis.stability import certify_stability, matrix_system
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.derived.drawn.networks import drawn_graph
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.derived.drawn.systems import jointly_controllable_system
from mcexact.errors import LimitReached
from mcexact.exact.linear_algebra import characteristic_polynomial, inverse
from mcexact.exact.matrix import Matrix, matrix_to_float
from mcexact.exact.roots import StabilityRegion
from mcexact.floating.margins import spectral_bound
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.certify import certify_controller
from mcexact.synthesis.design import Design
from mcexact.synthesis.distributed_observer import design_observer

CHECKER = Path(mcexact.checker.__file__).parent
RATE, RADIUS = Fraction(1), Fraction(4, 5)


def drawn_plant(seed: int, states: int = 10, channels: int = 8) -> MultiChannelSystem:
    """An unstable plant: odd seeds in discrete time, every other pair of seeds on a ring."""
    rng = random.Random(seed)
    n, m = rng.randint(1, states), rng.randint(1, channels)
    kind = "discrete" if seed % 2 else "continuous"
    for attempt in range(1000):
        choices = SeededChoices(f"floating {seed} {attempt}")
        system = jointly_controllable_system(choices, n, m, time=kind).system
        if StabilityRegion(kind).contains_roots_of(characteristic_polynomial(system.A)):
            continue
        if seed % 4 < 2:
            return system.with_neighbors(NeighborGraph.ring(system.names))
        return system.with_neighbors(drawn_graph(choices, system.names, strongly_connected=True))
    raise AssertionError(f"no unstable plant for seed {seed}")


def ring_plant(seed: int, n: int = 20, m: int = 15) -> MultiChannelSystem:
    """An unstable plant of small integers on a ring, one input and one output in every channel."""
    rng = random.Random(f"ring {seed}")
    while True:
        A = [
            [rng.choice([-2, -1, 1, 2]) * (rng.random() < 3 / n) for _ in range(n)]
            for _ in range(n)
        ]
        B = [[[rng.randint(-2, 2)] for _ in range(n)] for _ in range(m)]
        C = [[[rng.randint(-2, 2) for _ in range(n)]] for _ in range(m)]
        system = MultiChannelSystem(A, B, C)
        if spectral_bound(matrix_to_float(system.A), "continuous") > 0.5:
            return system.with_neighbors(NeighborGraph.ring(system.names))


@dataclass(frozen=True)
class Timed:
    """A design with the seconds that its parts took."""

    design: Design
    designing: float
    certifying: float
    eigenvalues: float

    @property
    def ratios(self) -> tuple[float, float]:
        """Certification over design, and over the numpy eigenvalue check."""
        return self.certifying / self.designing, self.certifying / self.eigenvalues


def timed_design(system: MultiChannelSystem) -> Timed:
    """Design for rate 1 or radius 4/5 and split the time at the certificate."""
    marks: list[float] = []

    def progress(what: str) -> None:
        if what == "certificate":
            marks.append(time.perf_counter())

    began = time.perf_counter()
    bound: dict[str, Any] = {"rate": RATE} if system.time == "continuous" else {"radius": RADIUS}
    design = design_observer(system, arithmetic="float", progress=progress, **bound)
    ended = time.perf_counter()
    loop = matrix_to_float(design.loop.matrix)
    before = time.perf_counter()
    spectral_bound(loop, system.time)
    return Timed(design, marks[0] - began, ended - marks[0], time.perf_counter() - before)


def valid_by_copied_checker(text: str) -> float:
    """Check a certificate with a copy of the checker in an isolated interpreter; the seconds."""
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(CHECKER, Path(folder) / "checker")
        Path(folder, "certificate.json").write_text(text, encoding="ascii")
        began = time.perf_counter()
        done = subprocess.run(
            [sys.executable, "-S", "-E", "-m", "checker", "certificate.json"],
            cwd=folder,
            capture_output=True,
            text=True,
            check=False,
        )
        took = time.perf_counter() - began
    if done.returncode or not re.match(r"VALID closed loop: every eigenvalue", done.stdout):
        raise AssertionError(done.stdout[:500] + done.stderr[:500])
    return took


def drawn_designs(count: int, seed: int) -> Counter[str]:
    """Design for drawn plants; every certificate VALID.

    A drawn plant may leave floating point so little room that only some processors find a design.
    """
    seen, certifying, ratios = Counter[str](), 0.0, []
    for number in range(seed, seed + count):
        system = drawn_plant(number)
        try:
            timed = timed_design(system)
        except LimitReached:
            seen["nothing found"] += 1
            continue
        verdict = check_document(encode(timed.design.loop.proof).encode("ascii"))
        if verdict.verdict != "VALID":
            raise AssertionError(f"seed {number}: {verdict.line()}")
        seen["VALID"] += 1
        seen[f"{system.time} time"] += 1
        seen["ring" if number % 4 < 2 else "drawn graph"] += 1
        seen["100 or more states in the loop"] += timed.design.loop.closed.dimension >= 100
        certifying += timed.certifying
        ratios.append(timed.ratios)
    if not ratios:
        return seen
    middle = sorted(ratios)[len(ratios) // 2]
    print(f"certifying {certifying:.1f} s for {count} systems, seeds {seed} to {seed + count - 1}")
    print(f"median certification: {middle[0]:.2f} of the design", end=", ")
    print(f"{sorted(r[1] for r in ratios)[len(ratios) // 2]:.0f} of numpy's eigenvalues")
    return seen


def ring_designs(seeds: range, n: int = 20, m: int = 15) -> None:
    """Design, certify by blocks and check for rings; times and gains on stdout."""
    for seed in seeds:
        timed = timed_design(ring_plant(seed, n, m))
        text = encode(timed.design.loop.proof)
        checking = valid_by_copied_checker(text)
        figures = ", ".join(
            f"{k} {v:.3g}" for k, v in timed.design.measures().items() if v is not None
        )
        print(
            f"n={n} m={m} seed {seed}: {timed.design.loop.closed.dimension} states, "
            f"design {timed.designing:.1f} s, certification {timed.certifying:.1f} s, "
            f"check {checking:.1f} s, certificate {len(text) / 1e6:.1f} MB; {figures}; "
            f"certification {timed.ratios[0]:.2f} of the design, "
            f"{timed.ratios[1]:.1f} of numpy's eigenvalues",
            flush=True,
        )


def both_methods(n: int, seed: int = 1, *, check: bool = True) -> None:
    """A loop of 5n states (m = 2) by both methods, for a bound that holds and one that fails."""
    system = ring_plant(seed, n, 2)
    design = timed_design(system).design
    M = design.loop.matrix
    abscissa = spectral_bound(matrix_to_float(M), "continuous")
    for bound, stable in ((RATE, True), (Fraction(round(-abscissa * 1.5) + 1), False)):
        for method in ("polynomial", "lyapunov"):
            began = time.perf_counter()
            verdict = certify_controller(system, design.controller, rate=bound, method=method)
            took = time.perf_counter() - began
            if verdict.stable != stable:
                raise AssertionError(f"{M.nrows} states, {bound}, {method}: {verdict.stable}")
            began = time.perf_counter()
            if check:
                checked = check_document(encode(verdict).encode("ascii"))
                if checked.verdict != "VALID":
                    raise AssertionError(checked.line())
            print(
                f"{M.nrows} states, bound {bound}, {verdict.method}: {verdict.stable}, "
                f"{took:.2f} s, check {time.perf_counter() - began:.1f} s",
                flush=True,
            )


def near_the_boundary(states: int = 40, *, check: bool = True) -> None:
    """Loops with abscissa 1e-9, −1e-9 and exactly 0, in coordinates that hide it."""
    near = Fraction(1, 10**9)
    for slowest, stable in ((near, False), (-near, True), (Fraction(0), False)):
        loop = matrix_system(hidden_spectrum(slowest, states))
        began = time.perf_counter()
        verdict = certify_stability(loop)
        if verdict.stable != stable:
            raise AssertionError(f"abscissa {slowest}: {verdict.stable}")
        if check:
            checked = check_document(encode(verdict).encode("ascii"))
            if checked.verdict != "VALID":
                raise AssertionError(checked.line())
        print(
            f"{states} states, abscissa {float(slowest):g}: stable {verdict.stable}, "
            f"{verdict.method}, {time.perf_counter() - began:.1f} s; numpy's abscissa "
            f"{spectral_bound(matrix_to_float(loop.A), 'continuous'):.2e}",
            flush=True,
        )


def hidden_spectrum(slowest: Fraction, states: int, seed: int = 1) -> Matrix:
    """A pair on the line Re λ = slowest, the others left of −1, after a drawn change of basis."""
    rng = random.Random(seed)
    D = [[Fraction(0)] * states for _ in range(states)]
    for k in range(states):
        D[k][k] = slowest if k < 2 else Fraction(-1 - k % 5)
    D[0][1], D[1][0] = Fraction(1), Fraction(-1)
    S = Matrix.identity(states)
    for _ in range(2 * states):
        i, j = rng.sample(range(states), 2)
        step = [[int(a == b) for b in range(states)] for a in range(states)]
        step[i][j] = rng.choice([1, -1])
        S = Matrix.from_integers(step) @ S
    back = inverse(S)
    if back is None:
        raise AssertionError("elementary matrices have a singular product")
    return S @ Matrix.from_rows(D) @ back


def main(arguments: list[str]) -> None:
    """Run everything and print the figures."""
    count = int(arguments[0]) if arguments else 50
    seed = int(arguments[1]) if len(arguments) > 1 else 0
    print(f"numpy {np.__version__}, drawn systems: {count}, first seed {seed}")
    for what, number in sorted(drawn_designs(count, seed).items()):
        print(f"  {number:4d}  {what}")
    ring_designs(range(3))
    for n in (4, 8, 12):
        both_methods(n)
    near_the_boundary()


if __name__ == "__main__":
    main(sys.argv[1:])
