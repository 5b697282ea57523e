"""What does a rational matrix cost beside the bare flint matrix that it holds?"""

from __future__ import annotations

import random
from collections.abc import Iterator
from typing import Any

import flint

from benchmarks.fixed_spectrum import Row
from benchmarks.measure import interleaved
from mcexact.exact.matrix import Matrix

_SIZE, _STEPS = 30, 6


def rows() -> Iterator[Row]:
    """Six steps of X @ B + A, with integers and over the denominator 7."""
    rng = random.Random(1)
    A, B = ([[rng.randint(-9, 9) for _ in range(_SIZE)] for _ in range(_SIZE)] for _ in range(2))
    for name, d, bare in (
        ("integers", 1, [flint.fmpz_mat(M) for M in (A, B)]),
        ("sevenths", 7, [flint.fmpq_mat(flint.fmpz_mat(M)) / 7 for M in (A, B)]),
    ):
        ours = [Matrix.from_integers(M, d) for M in (A, B)]
        times = interleaved(
            {
                "mcexact": lambda ours=ours: _steps(*ours),  # type: ignore[misc]
                "flint": lambda bare=bare: _bare_steps(*bare),  # type: ignore[misc]
            },
            runs=51,
            warmup=5,
        )
        ratio = times["mcexact"].median / times["flint"].median
        yield Row(
            f"{_STEPS} steps of X @ B + A at n = {_SIZE} in {name}, against flint",
            ratio,
            "<= 3",
            ratio <= 3,
            f"{times['mcexact'].median * 1e3:.2f} ms / {times['flint'].median * 1e3:.2f} ms",
        )


def _steps(A: Matrix, B: Matrix) -> Matrix:
    X = A
    for _ in range(_STEPS):
        X = X @ B + A
    return X


def _bare_steps(A: Any, B: Any) -> Any:
    X = A
    for _ in range(_STEPS):
        X = X * B + A
    return X
