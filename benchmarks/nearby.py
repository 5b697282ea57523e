"""Plants nearby, measured: what is found of plants that rounding errors, units or typing disturbed.

    python -m benchmarks.nearby [PART …]

Parts: ``noise`` (published plants whose fixed modes relative errors destroy, 20 draws each),
``floats`` (plants computed in floating point), ``units`` (states, inputs and outputs in other
units), ``typed`` (plants of two or three digits), ``posed`` (published plants), ``seconds`` (CPU
of `analyze` with and without the search) and ``reading`` (CPU of `from_float` with and without its
warning).  Every plant that is found is examined: it is near, keeps
its zeros, and its certificate is VALID.  Figures depend on the processor and its kernels.
"""

from __future__ import annotations

import os
import random
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

# A second thread of OpenBLAS that waits for work takes time of the processor, too.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

from mcexact.analysis.analyze import analyze
from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.nearby.plants import Nearby, NearPlant
from mcexact.analysis.nearby.search import nearby_plants
from mcexact.answer.check import check
from mcexact.answer.nearby import Lost
from mcexact.errors import RoundingWarning
from mcexact.exact.matrix import Matrix, matrix_to_float
from mcexact.model import gallery
from mcexact.model.system import MultiChannelSystem

FILE = Path(__file__).with_name("NEARBY.md")
NOISES = (1e-16, 1e-15, 1e-12, 1e-10, 1e-8, 1e-6)
DRAWS = 20
UNITS = (2, 4, 6, 9)
_IN_FLOATS = "swing-grid-four-buses-in-floats"
"""The one plant of the gallery whose answer is that of its rounding errors."""


def mapped(system: MultiChannelSystem, move: Callable[[Fraction], Fraction]) -> MultiChannelSystem:
    """The plant with each entry that is not 0 replaced."""

    def table(M: Matrix) -> Matrix:
        return Matrix.from_entries(M.shape, ((i, j, move(M[i, j])) for i, j, _ in M.nonzero()))

    return MultiChannelSystem(
        table(system.A),
        [table(M) for M in system.B],
        [table(M) for M in system.C],
        time=system.time,
        names=system.names,
    )


def noisy(system: MultiChannelSystem, part: float, seed: int) -> MultiChannelSystem:
    """The plant with relative errors of its entries, as floats print them."""
    rng = random.Random(seed)
    return mapped(system, lambda x: Fraction(repr(float(x) * (1 + part * rng.uniform(-1, 1)))))


def typed(system: MultiChannelSystem, number: int) -> MultiChannelSystem:
    """The plant with a number of significant digits."""
    return mapped(system, lambda x: Fraction(f"{float(x):.{number - 1}e}"))


def fragile() -> Iterator[tuple[str, MultiChannelSystem]]:
    """The published plants with fixed modes that errors of their entries destroy."""
    for name in gallery.names():
        plant = gallery.load(name)
        fixed = plant.n <= 12 and not fixed_spectrum(plant).empty
        if fixed and fixed_spectrum(noisy(plant, 1e-3, 1)).empty:
            yield name, plant


def examined(system: MultiChannelSystem, near: NearPlant) -> bool:
    """Whether a plant is near, keeps its zeros, and has a VALID certificate about itself."""
    pairs = [
        (x, y)
        for M, N in zip(
            (system.A, *system.B, *system.C),
            (near.plant.A, *near.plant.B, *near.plant.C),
            strict=True,
        )
        for row, other in zip(M.rows(), N.rows(), strict=True)
        for x, y in zip(row, other, strict=True)
    ]
    own = near.proof.about.plant.digest() == near.plant.digest()
    close = all(abs(y - x) <= near.part * abs(x) for x, y in pairs)
    return own and close and near.proof.rank < system.n and check(near.proof).verdict == "VALID"


def found(system: MultiChannelSystem, lost: Lost = "fixed") -> NearPlant | None:
    """The nearest plant found, examined."""
    near = nearby_plants(system, [lost]).get(lost)
    if near is not None and not examined(system, near):
        raise ArithmeticError(f"no member: {system}")
    return near


# Plants that are computed in floating point.


def swing(machines: int, rng: Any) -> MultiChannelSystem:
    """Machines on a ring with further lines, whose frequencies alone are measured: 0 is hidden."""
    n = 2 * machines
    M, D, K = rng.uniform(5, 15, machines), rng.uniform(0.5, 2, machines), np.zeros((machines,) * 2)
    pairs = [(i, (i + 1) % machines) for i in range(machines)]
    pairs += [tuple(rng.integers(0, machines, 2)) for _ in range(machines)]
    for i, j in pairs:
        if i != j:
            K[i, j] = K[j, i] = round(rng.uniform(1, 4), 1)
    A = np.zeros((n, n))
    for i in range(machines):
        A[2 * i, 2 * i + 1] = 1.0
        A[2 * i + 1, ::2] = K[i] / M[i]
        A[2 * i + 1, 2 * i] = -K[i].sum() / M[i]
        A[2 * i + 1, 2 * i + 1] = -D[i] / M[i]
    B = [np.eye(n)[:, [2 * i + 1]] / M[i] for i in range(machines)]
    return in_floats(A, B, [np.eye(n)[[2 * i + 1]] for i in range(machines)])


def compartments(n: int, rng: Any) -> MultiChannelSystem:
    """Compartments whose inputs move content between two of them: the mode 0 is not controlled."""
    A = np.zeros((n, n))
    for i in range(n):
        for j in range(n):
            if i != j and (abs(i - j) == 1 or rng.random() < 0.2):
                A[i, j] = rng.uniform(0.1, 2)
    A -= np.diag(A.sum(axis=0))
    B, C = [], []
    for i in range(n // 2):
        B.append((np.eye(n)[:, [2 * i]] - np.eye(n)[:, [2 * i + 1]]) * 0.7)
        C.append(np.eye(n)[[2 * i]] * rng.uniform(0.5, 2))
    return in_floats(A, B, C)


def similar(n: int, rng: Any) -> MultiChannelSystem:
    """A plant with a mode that no input moves, in dense coordinates."""
    A, T = rng.uniform(-1, 1, (n, n)), rng.uniform(-1, 1, (n, n))
    A[0], A[0, 0] = 0, 0.3
    B = [rng.uniform(-1, 1, (n, 1)) for _ in range(4)]
    for b in B:
        b[0] = 0
    back = np.linalg.inv(T)
    C = [rng.uniform(-1, 1, (1, n)) @ back for _ in range(4)]
    return in_floats(T @ A @ back, [T @ b for b in B], C)


def sampled(n: int, rng: Any) -> MultiChannelSystem:
    """The same before the change of coordinates of a plant with coupled states, sampled."""
    from scipy.linalg import expm

    half = n // 2
    A = rng.uniform(-1, 1, (n, n))
    A[:half, half:] = 0
    A[0, 1:] = 0
    B = rng.uniform(-1, 1, (n, 3))
    B[0] = 0
    T = np.eye(n) + np.diag(rng.uniform(0.2, 1, n - 1), 1)
    A, B = T @ A @ np.linalg.inv(T), T @ B
    E = expm(0.1 * np.block([[A, B], [np.zeros((3, n + 3))]]))
    C = [rng.uniform(-1, 1, (1, n)) for _ in range(3)]
    return in_floats(E[:n, :n], [E[:n, [n + i]] for i in range(3)], C, "discrete")


def in_floats(A: Any, B: list[Any], C: list[Any], domain: str = "continuous") -> MultiChannelSystem:
    return MultiChannelSystem.from_float(A, B, C, rounding="decimal", time=domain)


KINDS = {"swing": lambda n, rng: swing(n // 2, rng), "compartments": compartments,
         "dense similarity": similar, "sampled": sampled}  # fmt: skip


def scaled(system: MultiChannelSystem, power: int, rng: Any) -> MultiChannelSystem:
    """The plant with states, inputs and outputs in other units, computed in floating point."""
    T = 10.0 ** rng.uniform(-power, power, system.n)
    unit = lambda size: 10.0 ** rng.uniform(-power, power, size)  # noqa: E731
    A = matrix_to_float(system.A) * T[:, None] / T[None, :]
    B = [matrix_to_float(M) * T[:, None] * unit(M.ncols)[None, :] for M in system.B]
    C = [matrix_to_float(M) / T[None, :] * unit(M.nrows)[:, None] for M in system.C]
    return in_floats(A, B, C, system.time)


# The parts.


def noise() -> Iterator[str]:
    plants = [*fragile()]
    yield f"published plants whose fixed modes errors destroy: {len(plants)}"
    for part in NOISES:
        total = near = within = 0
        for _, plant in plants:
            for seed in range(DRAWS):
                moved = noisy(plant, part, seed)
                if not fixed_spectrum(moved).empty:
                    continue
                total += 1
                one = found(moved)
                near += one is not None
                within += one is not None and one.part <= 20 * Fraction(max(part, 2.0**-53))
        yield f"errors of {part:g}: {near} of {total} found, {within} within 20 times the errors"


def floats() -> Iterator[str]:
    for name, make in KINDS.items():
        rng, total, near, farthest = np.random.default_rng(1), 0, 0, Fraction(0)
        for n in (4, 6, 8, 12, 20, 40):
            plant = make(n, rng)
            if fixed_spectrum(plant).empty:
                total += 1
                one = found(plant)
                near += one is not None and one.within == "rounding"
                farthest = max(farthest, Fraction(0) if one is None else one.part)
        yield f"{name}: {near} of {total} within rounding errors, at most {float(farthest):.1e}"


def units() -> Iterator[str]:
    rng = np.random.default_rng(1)
    plants = [plant for _, plant in fragile()]
    plants += [make(n, rng) for make in KINDS.values() for n in (6, 8, 12)]
    for power in UNITS:
        scales = [scaled(plant, power, rng) for plant in plants]
        lost = [plant for plant in scales if fixed_spectrum(plant).empty]
        near = [found(plant) for plant in lost]
        within = sum(one is not None and one.within == "rounding" for one in near)
        certified = sum(one is not None for one in near)
        yield (
            f"units of 10^±{power}: {certified} of {len(lost)} certified, {within} within rounding "
            f"errors; {len(plants) - len(lost)} more keep the mode exactly"
        )


def digits() -> Iterator[str]:
    rng, alarms, total = random.Random(5), dict[str, int](), 0
    for _ in range(200):
        n, m, number = rng.choice([3, 4, 6, 8, 10]), rng.choice([2, 3]), rng.choice([2, 3])
        dense = rng.choice([0.5, 0.8, 1.0])

        def table(r: int, c: int, d: int = number, often: float = dense) -> list[list[Any]]:
            entry = lambda: f"{rng.uniform(-3, 3):.{d}g}" if rng.random() < often else 0  # noqa: E731
            return [[entry() for _ in range(c)] for _ in range(r)]

        plant = MultiChannelSystem(
            table(n, n), [table(n, 1) for _ in range(m)], [table(1, n) for _ in range(m)]
        )
        total += 1
        for one in looked_for(plant).plants:
            alarms[one.within or "part"] = alarms.get(one.within or "part", 0) + 1
    yield f"{total} drawn plants of 2 or 3 digits: alarms {alarms or 'none'}"
    for number in (3, 4, 5):
        rng_floats, lost, told = np.random.default_rng(2), 0, 0
        for k in range(40):
            make = [*KINDS.values()][k % 3]
            plant = typed(make(6, rng_floats), number)
            if fixed_spectrum(plant).empty:
                lost += 1
                one = found(plant)
                told += one is not None and one.within is not None
        yield f"typed with {number} digits: {told} of {lost} lost modes told of"


def looked_for(plant: MultiChannelSystem) -> Nearby:
    """What `analyze` looks for."""
    spectrum = fixed_spectrum(plant)
    lost: list[Lost] = ["unstable"] * spectrum.stabilizable + ["fixed"] * spectrum.empty
    lost += ["uncontrollable"] * joint_controllability(plant).controllable
    lost += ["unobservable"] * joint_observability(plant).controllable
    return nearby_plants(plant, lost)


def posed() -> Iterator[str]:
    names = [name for name in gallery.names() if name != _IN_FLOATS]
    alarms = {
        name: [one.explain() for one in near.plants]
        for name in names
        if (near := looked_for(gallery.load(name))).plants
    }
    yield f"{len(names)} published plants as they are: alarms {alarms or 'none'}"
    alarms = {each.lost: each.within for each in looked_for(gallery.load(_IN_FLOATS)).plants}
    yield f"{_IN_FLOATS}: alarms {alarms or 'none'}"


def seconds() -> Iterator[str]:
    rng = np.random.default_rng(3)
    for n in (4, 30, 100, 200):
        plants = {"well-posed": noisy(similar(n, rng), 1e-2, 1), "swing": swing(n // 2, rng)}
        for name, plant in plants.items():
            taken = []
            for nearby in (False, True):
                began = time.process_time()
                _ = analyze(plant, ["fixed_spectrum"], nearby=nearby).account
                taken.append(time.process_time() - began)
            yield f"n = {n}, {name}: {taken[0]:.3f} s without, {taken[1]:.3f} s with"


def reading() -> Iterator[str]:
    rng = np.random.default_rng(4)
    for n in (4, 30, 100):
        A, B, C = rng.normal(size=(n, n)), rng.normal(size=(n, 4)), rng.normal(size=(4, n))
        parts = A, np.hsplit(B, 4), np.vsplit(C, 4)
        taken = []
        for action in ("ignore", "always"):
            with warnings.catch_warnings():
                warnings.simplefilter(action, RoundingWarning)
                MultiChannelSystem.from_float(*parts)
                began = time.process_time()
                MultiChannelSystem.from_float(*parts)
                taken.append(time.process_time() - began)
        yield f"n = {n}, well-posed: {taken[0]:.3f} s without the warning, {taken[1]:.3f} s with"


PARTS: dict[str, Callable[[], Iterator[str]]] = {
    "noise": noise, "floats": floats, "units": units, "typed": digits, "posed": posed,
    "seconds": seconds, "reading": reading,
}  # fmt: skip


_HEAD = """\
# Plants nearby

What `analyze` finds of plants nearby of which an answer is another one; `make nearby` writes this
file. Every plant that is counted as found was examined: it keeps the zeros, is as near as it says,
and its certificate is VALID. Figures depend on the processor and its kernels.

"""


def main(names: list[str]) -> int:
    """Print the figures of some parts; without names those of all, which are written."""
    lines = []
    warnings.simplefilter("ignore", RoundingWarning)
    for name in names or PARTS:
        for line in PARTS[name]():
            lines.append(f"- {name}: {line}")
            print(lines[-1], flush=True)
    if not names:
        FILE.write_text(_HEAD + "\n".join(lines) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
