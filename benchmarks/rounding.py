"""How many numbers each rounding of floats recovers, and what that does to plants.

Run as ``python -m benchmarks.rounding``, which writes ``benchmarks/ROUNDING.md`` in less than a
minute.

Numbers with few digits are drawn, and something is computed of them twice: in floating point, and
in exact arithmetic.  A rounding recovers an entry if it reads the float as the exact result.  A
number that is irrational has no such result: there it is counted whether "simplest" reads the float
as the decimal that it prints, or as something else.

Plants are drawn whose mode 0 is fixed by an equality between entries, and computed in floating
point; it is counted of how many the mode is fixed as each rounding reads them.  Last, matrices of
200 × 200 entries are read, with the seconds of the processor and the length of their common
denominator.
"""

from __future__ import annotations

import os
import random
import textwrap
import time
import warnings
from collections.abc import Callable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any, get_args

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
import scipy.linalg

from mcexact import MultiChannelSystem, fixed_spectrum
from mcexact.errors import RoundingWarning
from mcexact.exact.linear_algebra import inverse
from mcexact.exact.matrix import Matrix, Rounding, from_float, matrix_from_float

PAGE = Path(__file__).with_name("ROUNDING.md")
ROUNDINGS: tuple[Rounding, ...] = ("simplest", "decimal", "dyadic")
DRAWS, PLANTS, SIDE = 10_000, 50, 200
Pair = tuple[float, Fraction]
"""A float, and the exact result that it stands for."""


def typed(dice: random.Random, digits: int, spread: int = 3) -> Fraction:
    """A number with so many significant digits, of moderate size."""
    mantissa = dice.randint(10 ** (digits - 1), 10**digits - 1)
    return Fraction(mantissa) / Fraction(10) ** (digits - 1 + dice.randint(0, spread - 1))


# Results of arithmetic with numbers of few digits.


def as_typed(dice: random.Random, digits: int) -> Pair:
    x = typed(dice, digits)
    return float(x), x


def quotient(dice: random.Random, digits: int) -> Pair:
    a, b = typed(dice, digits), typed(dice, digits)
    return float(a) / float(b), a / b


def product(dice: random.Random, digits: int) -> Pair:
    a, b = typed(dice, digits), typed(dice, digits)
    return float(a) * float(b), a * b


def total(dice: random.Random, digits: int) -> Pair:
    numbers = [typed(dice, digits) for _ in range(5)]
    return sum(map(float, numbers)), sum(numbers, Fraction(0))


def over_inertia(dice: random.Random, digits: int) -> Pair:
    a, b, H = (typed(dice, digits, 1) for _ in range(3))
    return -(float(a) + float(b)) / float(H), -(a + b) / H


def of_inverse(dice: random.Random, digits: int) -> Pair:
    bound, i, j = 10**digits, dice.randrange(3), dice.randrange(3)
    M = Matrix.from_rows(
        [[Fraction(dice.randint(-bound, bound), 10) for _ in range(3)] for _ in range(3)]
    )
    exact = inverse(M)
    if exact is None:
        return of_inverse(dice, digits)
    return float(np.linalg.inv(M.to_numpy())[i, j]), exact[i, j]


def of_integrators(dice: random.Random, digits: int) -> Pair:
    """An entry of the sampled chain of three integrators, h**k / k!."""
    h, k = typed(dice, digits), dice.randint(1, 2)
    exponential = scipy.linalg.expm(np.diag([1.0, 1.0], 1) * float(h))
    return float(exponential[0, k]), h**k / (1 if k == 1 else 2)


RESULTS: list[tuple[str, Callable[[random.Random, int], Pair], tuple[int, ...]]] = [
    ("typed", as_typed, (3, 10, 15)),
    ("sum of five", total, (3, 10)),
    ("product", product, (3, 5)),
    ("quotient", quotient, (2, 3, 4, 5)),
    ("−(a + b)/H", over_inertia, (3, 4)),
    ("inverse 3 × 3, entry", of_inverse, (1, 2, 3)),
    ("chain of integrators, sampled", of_integrators, (2, 3)),
]

# Numbers that are irrational.


def normal(dice: random.Random) -> float:
    return dice.gauss(0, 1)


def root(dice: random.Random) -> float:
    return float(np.sqrt(dice.randint(2, 10**6) + 0.5))


def sampled(dice: random.Random) -> float:
    A = np.array([[float(typed(dice, 2)) for _ in range(4)] for _ in range(4)])
    return float(scipy.linalg.expm(A / 10)[dice.randrange(4), dice.randrange(4)])


IRRATIONAL: dict[str, Callable[[random.Random], float]] = {
    "normal": normal,
    "square root": root,
    "matrix exponential 4 × 4, entry": sampled,
}

# Plants with a fixed mode that an equality between entries makes.


def swing_grid(dice: random.Random) -> tuple[Any, list[Any], list[Any]]:
    """Four machines that measure their frequencies, none of which shows the common angle."""
    H, d = ([float(typed(dice, 2, 1)) for _ in range(4)] for _ in range(2))
    k = np.zeros((4, 4))
    for i in range(4):
        for j in range(i):
            k[i, j] = k[j, i] = float(typed(dice, 2))
    stiffness = (k - np.diag(k.sum(axis=1))) / np.array(H)[:, None]
    A = np.block([[np.zeros((4, 4)), np.eye(4)], [stiffness, -np.diag(np.array(d) / H)]])
    return (
        A,
        [np.eye(8)[:, [4 + i]] / H[i] for i in range(4)],
        [np.eye(8)[[4 + i]] for i in range(4)],
    )


def compartments(dice: random.Random) -> tuple[Any, list[Any], list[Any]]:
    """Four tanks between which an amount flows that no pump changes: columns add up to 0."""
    rates = np.array([[float(typed(dice, 2)) for _ in range(4)] for _ in range(4)])
    np.fill_diagonal(rates, 0)
    A = rates - np.diag(rates.sum(axis=0))
    B = [np.eye(4)[:, [i]] - np.eye(4)[:, [i + 1]] for i in range(3)]
    return A, B, [np.eye(4)[[i]] for i in range(3)]


def sampled_compartments(dice: random.Random) -> tuple[Any, list[Any], list[Any]]:
    """The same, sampled in floating point with inputs held."""
    A, B, C = compartments(dice)
    both = scipy.linalg.expm(np.block([[A, np.hstack(B)], [np.zeros((3, 7))]]) * 0.05)
    return both[:4, :4] - np.eye(4), [both[:4, [4 + i]] for i in range(3)], C


FAMILIES = {
    "swing grid of 4 machines": swing_grid,
    "4 compartments": compartments,
    "4 compartments, sampled by a matrix exponential": sampled_compartments,
}

# Tables.


def share(count: int, of: int) -> str:
    return f"{100 * count / of:.1f} %"


def recovered() -> Iterator[str]:
    yield "| entries | digits | " + " | ".join(ROUNDINGS) + " |"
    yield "| --- | --- |" + " --- |" * len(ROUNDINGS)
    for name, compute, lengths in RESULTS:
        for digits in lengths:
            dice = random.Random(digits)
            pairs = [compute(dice, digits) for _ in range(DRAWS)]
            counts = [sum(from_float(x, each) == exact for x, exact in pairs) for each in ROUNDINGS]
            cells = " | ".join(share(count, DRAWS) for count in counts)
            yield f"| {name} | {digits} | {cells} |"


def left_alone() -> Iterator[str]:
    yield "| entries | read as printed |"
    yield "| --- | --- |"
    for name, draw in IRRATIONAL.items():
        dice = random.Random(1)
        numbers = [draw(dice) for _ in range(DRAWS)]
        same = sum(from_float(x, "simplest") == from_float(x, "decimal") for x in numbers)
        yield f"| {name} | {share(same, DRAWS)} |"


def plants() -> Iterator[str]:
    yield "| plants | " + " | ".join(ROUNDINGS) + " |"
    yield "| --- |" + " --- |" * len(ROUNDINGS)
    for name, draw in FAMILIES.items():
        dice = random.Random(1)
        drawn = [draw(dice) for _ in range(PLANTS)]
        cells = [
            sum(
                not fixed_spectrum(MultiChannelSystem.from_float(*each, rounding=rounding)).empty
                for each in drawn
            )
            for rounding in ROUNDINGS
        ]
        yield f"| {name} | " + " | ".join(f"{cell} of {PLANTS}" for cell in cells) + " |"


def large() -> Iterator[str]:
    cells = " | ".join(f"{each}: s, bits" for each in ROUNDINGS)
    yield f"| {SIDE} × {SIDE} entries | {cells} |"
    yield "| --- |" + " --- |" * len(ROUNDINGS)
    dice = random.Random(1)
    kinds: dict[str, Callable[[], float]] = {
        "typed with 3 digits": lambda: as_typed(dice, 3)[0],
        "quotients of 2 digits": lambda: quotient(dice, 2)[0],
        "quotients of 3 digits": lambda: quotient(dice, 3)[0],
        "quotients of 4 digits": lambda: quotient(dice, 4)[0],
        "quotients of 5 digits": lambda: quotient(dice, 5)[0],
        "irrational": lambda: normal(dice),
    }
    for name, draw in kinds.items():
        M = np.array([[draw() for _ in range(SIDE)] for _ in range(SIDE)])
        cells = ""
        for each in ROUNDINGS:
            began = time.process_time()
            bits = matrix_from_float(M, each).denominator.bit_length()
            cells += f" {time.process_time() - began:.2f}, {bits} |"
        yield f"| {name} |{cells}"


def main() -> None:
    """Write the page."""
    assert set(ROUNDINGS) == set(get_args(Rounding))
    warnings.simplefilter("ignore", RoundingWarning)
    tables = {
        f"Of {DRAWS:,} results of arithmetic with numbers of few digits, those that a rounding "
        "reads as the exact result. Digits are those of the numbers that were typed.": recovered,
        f"Of {DRAWS:,} irrational numbers, those that `simplest` reads as the decimals that they "
        "print. The others become a fraction of 44 bits that is near by chance.": left_alone,
        "Plants computed in floating point whose mode 0 is fixed by an equality between entries: "
        "those whose mode is fixed as each rounding reads them.": plants,
        "Seconds of the processor for reading a matrix, and the bits of its common denominator. "
        "Many different denominators make it long, and everything that follows slow.": large,
    }
    parts = ["# What roundings of floats recover", "", "Made by `make rounding`.", ""]
    for text, rows in tables.items():
        parts += [textwrap.fill(text, 100), "", *rows(), ""]
    PAGE.write_text("\n".join(parts), encoding="utf-8")


if __name__ == "__main__":
    main()
