"""How long does it take to decide and to check a question for all values of a parameter?"""

from __future__ import annotations

import json
import random
from collections.abc import Iterator
from typing import Any

from benchmarks.fixed_spectrum import Row
from benchmarks.measure import processor_seconds
from mcexact import ParametricSystem, fixed_spectrum
from mcexact.answer.codec import document
from mcexact.checker import Limits, check_document

_WORK = 10**12
LIMITS = {("one entry", 20): (0.11, 1.05), ("one entry", 40): (2.05, 25.0)}
"""Seconds for deciding and for checking, where some were asked for."""
SIZES = {"one entry": (5, 10, 20, 40), "four entries": (5, 10, 20, 40), "all entries": (5, 10, 20)}


def plant(n: int, kind: str, seed: int = 1) -> ParametricSystem:
    """A plant of n states and n/5 channels, whose last state is reached through one entry alone."""
    rng = random.Random(seed * 1000 + n)
    m = max(2, n // 5)
    A: list[list[Any]] = [
        [rng.randint(-3, 3) if i == j or rng.random() < 3 / n else 0 for j in range(n)]
        for i in range(n)
    ]
    A[-1] = [0] * (n - 1) + [5]
    B: list[Any] = [
        [[rng.randint(-2, 2)] if i < n - 1 else [0] for i in range(n)] for _ in range(m)
    ]
    C = [[[rng.randint(-2, 2) for _ in range(n)]] for _ in range(m)]
    if kind == "one entry":
        A[-1][0] = "t - 3"
    elif kind == "four entries":
        A[-1][0], A[0][1], A[1][2] = "t^2 - 2", f"{A[0][1]} + t", f"{A[1][2]} + t"
        B[0][0][0] = "1 + t"
    else:
        A = [[f"{a} + (t - 3)*({rng.randint(-2, 2)})" for a in row] for row in A]
    return ParametricSystem(A, B, C, parameters=["t"])


def rows(kind: str, n: int) -> Iterator[Row]:
    """The least of some runs each of deciding which modes are fixed, and of checking it."""
    system = plant(n, kind)
    decided, checked, runs = [], [], 5 if n <= 20 and kind != "all entries" else 2
    for _ in range(runs):
        start = processor_seconds()
        text = json.dumps(document(fixed_spectrum(system))).encode()
        middle = processor_seconds()
        verdict = check_document(text, limits=Limits(work=_WORK))
        decided.append(middle - start)
        checked.append(processor_seconds() - middle)
    limits = LIMITS.get((kind, n))
    for what, times, k in (("decided", decided, 0), ("checked", checked, 1)):
        most = limits[k] if limits else None
        yield Row(
            f"fixed modes for all values, n={n}, t in {kind}, {what}",
            min(times),
            "reported" if most is None else f"<= {most} s",
            verdict.verdict == "VALID" and (most is None or min(times) <= most),
            f"{len(text) / 1000:.0f} kB, {verdict.spent / 1e6:.0f} million units",
            "s",
        )
