"""Distributed observers for drawn systems: design, certificate, network; prints what occurred.

Run as ``python -m tests.assurance.campaigns.observer [COUNT] [SEED]``; the tests call it with small
counts.
"""

from __future__ import annotations

import json
import random
import sys
import time
from collections import Counter
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from typing import Any

from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.derived.drawn.networks import drawn_graph
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.derived.drawn.systems import jointly_controllable_system
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix, largest_entry
from mcexact.exact.polynomial import Polynomial
from mcexact.model.controller import Controller, controller_text
from mcexact.model.system import MultiChannelSystem
from mcexact.simulation.network import InitialState
from mcexact.simulation.trajectory import simulate
from mcexact.synthesis.design import Design
from mcexact.synthesis.distributed_observer import design_observer
from tests.oracle.controller_loop import applied, loop_rows

TOO_LARGE_FOR_DOUBLES = 10**5


def drawn_plant(seed: int) -> MultiChannelSystem:
    """A plant with n, m ≤ 4 over a strongly connected graph; odd seeds in discrete time."""
    choices, rng = SeededChoices(f"observer {seed}"), random.Random(seed)
    system = jointly_controllable_system(
        choices,
        rng.randint(1, 4),
        rng.randint(1, 4),
        time="discrete" if seed % 2 else "continuous",
    ).system
    return system.with_neighbors(drawn_graph(choices, system.names, strongly_connected=True))


def drawn_spectrum(rng: random.Random, degree: int, discrete: bool) -> list[Any]:
    """Roots and pairs inside the stability region, some repeated."""
    roots: list[Any] = []
    left = degree
    while left:
        if left >= 2 and rng.random() < 0.3:
            re, im = Fraction(-rng.randint(1, 3)), Fraction(rng.randint(1, 2))
            if discrete:
                re, im = re / 6, im / 4
            roots.append({"re": re, "im": im})
            left -= 2
        else:
            value = Fraction(-rng.randint(1, 4))
            roots.append(rng.choice([value / 5, Fraction(0), -value / 7]) if discrete else value)
            left -= 1
    return roots


def expanded(roots: list[Any]) -> Polynomial:
    """The product of the factors, by the definition."""
    result = Polynomial.of(1)
    for root in roots:
        if isinstance(root, dict):
            re, im = root["re"], root["im"]
            result = result * Polynomial.of(re * re + im * im, -2 * re, 1)
        else:
            result = result * Polynomial.of(-root, 1)
    return result


def one_design(seed: int) -> tuple[MultiChannelSystem, Design]:
    """Design for one drawn plant and compare every polynomial and the certificate.

    Raises
    ------
    AssertionError
        On the first disagreement.
    """
    system, rng = drawn_plant(seed), random.Random(seed)
    n, m, discrete = system.n, system.m, system.time == "discrete"
    feedback = drawn_spectrum(rng, n, discrete)
    error = drawn_spectrum(rng, n * m + m - 1, discrete)
    q = rng.choice(system.names)
    design = design_observer(system, agent=q, spectrum={"feedback": feedback, "error": error})
    verdict = check_document(encode(design.loop.proof).encode())
    assert verdict.verdict == "VALID", verdict
    loop = Matrix.from_rows(loop_of(system, design))
    assert loop == design.loop.matrix
    assert characteristic_polynomial(loop) == expanded(feedback) * expanded(error)
    return system, design


def loop_of(system: MultiChannelSystem, design: Design | Renamed) -> list[list[Fraction]]:
    """The matrix of the loop from the files alone."""
    plant = json.loads(json.dumps(system.canonical_document()))
    return loop_rows(plant, controller_text(design.controller))


def drawn_initial(system: MultiChannelSystem, design: Design | Renamed, seed: int) -> InitialState:
    """Small rational numbers everywhere."""
    rng = random.Random(seed)

    def numbers(count: int) -> tuple[Fraction, ...]:
        return tuple(Fraction(rng.randint(-9, 9), rng.randint(1, 4)) for _ in range(count))

    agents = design.controller.agents
    return InitialState(
        numbers(system.n),
        tuple(numbers(agent.shared) for agent in agents),
        tuple(numbers(agent.private) for agent in agents),
    )


def compare_discrete(system: MultiChannelSystem, design: Design | Renamed, seed: int) -> None:
    """The network's steps are powers of the loop matrix, exactly."""
    matrix = loop_of(system, design)
    run = simulate(
        system, design.controller, initial=drawn_initial(system, design, seed), horizon=6
    )
    state = run.snapshots[0].flat()
    for snapshot in run.snapshots[1:]:
        state = applied(matrix, state)
        assert snapshot.flat() == state


def compare_multiprecision(
    system: MultiChannelSystem, design: Design | Renamed, seed: int
) -> float:
    """The agents at 60 digits against mpmath's exponential; the relative difference."""
    from mpmath import mp

    with mp.workdps(80):
        rows = [
            [mp.mpf(x.numerator) / x.denominator for x in row] for row in loop_of(system, design)
        ]
        end = Fraction(1)
        run = simulate(
            system,
            design.controller,
            initial=drawn_initial(system, design, seed),
            horizon=end,
            points=2,
            arithmetic="multiprecision",
        )
        start = mp.matrix([mp.mpf(x) for x in run.snapshots[0].flat()])
        expected = mp.expm(mp.matrix(rows) * mp.mpf(1), method="taylor") * start
        found = run.snapshots[-1].flat()
        scale = max(abs(x) for x in expected)
        return float(max(abs(a - b) for a, b in zip(found, expected, strict=True)) / scale)


def compare_double(system: MultiChannelSystem, design: Design | Renamed, seed: int) -> float:
    """The agents in double precision against scipy's exponential, interval by interval.

    The relative difference, the worst of 128 intervals.  The intervals are short because it is
    scipy's exponential that errs over long ones: for one of these loops, of entries up to 8e4, it
    is off by a factor of 13 at t = 2, the agents by less than 1e-6, measured at 60 digits.
    """
    import numpy as np
    from scipy.linalg import expm

    M = np.array([[float(x) for x in row] for row in loop_of(system, design)])
    initial = drawn_initial(system, design, seed)
    run = simulate(
        system, design.controller, initial=initial, horizon=2, points=128, arithmetic="float"
    )
    states = [np.array(snapshot.flat()) for snapshot in run.snapshots]
    over_one = expm(M * float(run.times[1]))
    worst = 0.0
    for before, after in pairwise(states):
        scale = max(np.abs(before).max(), np.abs(after).max())
        worst = max(worst, float(np.abs(over_one @ before - after).max() / scale))
    return worst


def campaign(count: int, seed: int, multiprecision: int = 10) -> Counter[str]:
    """Design and run for ``count`` drawn plants; what occurred, and the worst figures on stdout."""
    seen: Counter[str] = Counter()
    heights, worst, slowest, exponential = [], 0.0, 0.0, 0.0
    for number in range(seed, seed + count):
        began = time.perf_counter()
        system, design = one_design(number)
        slowest = max(slowest, time.perf_counter() - began)
        heights.append(design.controller.bit_length())
        seen[f"{system.time} time"] += 1
        small = largest_entry([design.loop.matrix]) < TOO_LARGE_FOR_DOUBLES
        # What a network computes does not depend on what its time is called.
        compare_discrete(*renamed(system, design, "discrete"), number)
        flowing = renamed(system, design, "continuous")
        if small:
            seen["entries below 1e5, compared in double precision"] += 1
            worst = max(worst, compare_double(*flowing, number))
        few = max(system.n, system.m) <= 3 and system.time == "continuous"
        if few and seen["compared at 60 digits"] < multiprecision:
            seen["compared at 60 digits"] += 1
            exponential = max(exponential, compare_multiprecision(*flowing, number))
    print(f"longest number in bits: median {sorted(heights)[count // 2]}, worst {max(heights)}")
    print(f"slowest design with check and comparison {slowest:.1f} s")
    print(f"worst relative difference: double precision {worst:.1e}, 60 digits {exponential:.1e}")
    return seen


@dataclass(frozen=True)
class Renamed:
    """As much of a design as the comparisons need."""

    controller: Controller


def renamed(
    system: MultiChannelSystem, design: Design, time: str
) -> tuple[MultiChannelSystem, Renamed]:
    """The same matrices read in another time domain."""
    channels = system.channels
    turned = MultiChannelSystem(
        system.A,
        [channel.B for channel in channels],
        [channel.C for channel in channels],
        time=time,
        names=system.names,
        neighbors=system.neighbors,
    )
    return turned, Renamed(replace(design.controller, time=time))


if __name__ == "__main__":
    numbers = [int(text) for text in sys.argv[1:]]
    print(dict(campaign(numbers[0] if numbers else 100, numbers[1] if numbers[1:] else 0)))
