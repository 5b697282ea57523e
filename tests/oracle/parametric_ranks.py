"""Ranks of matrices with a parameter, by elimination at points and modulo primes."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import flint

from tests.oracle.parametric import PRIMES, values

Rows = list[list[Any]]


def rank_of(matrix: dict[str, Any], plain: Any, names: Sequence[str], ell: int, time: str) -> int:
    """The rank of a named matrix, made from rows of numbers."""
    A, B, C = plain
    n = len(A)
    if matrix["name"] == "setpoint":
        shift = int(time == "discrete")
        width = sum(len(M[0]) if M else 0 for M in B)
        rows = [
            [v - shift * (i == j) for j, v in enumerate(row)] + [v for M in B for v in M[i]]
            for i, row in enumerate(A)
        ]
        return _rank(rows + [[*row, *[0] * width] for M in C for row in M], ell)
    if matrix["name"] == "controllability":
        chosen = [names.index(name) for name in matrix["channels"]]
        power = [[v for i in chosen for v in B[i][k]] for k in range(n)]
        rows = [[] for _ in range(n)]
        for _ in range(matrix["blocks"]):
            rows = [row + more for row, more in zip(rows, power, strict=True)]
            power = _product(A, power)
        return _rank(rows, ell)
    power, found = B[names.index(matrix["from"])], []
    for _ in range(n):
        product = _product(C[names.index(matrix["to"])], power)
        found += [[v] for row in product for v in row]
        power = _product(A, power)
    return _rank(found, ell)


def _product(left: Rows, right: Rows) -> Rows:
    columns = list(zip(*right, strict=True))
    return [[sum(a * b for a, b in zip(row, c, strict=True)) for c in columns] for row in left]


def _rank(rows: Rows, ell: int) -> int:
    ncols = len(rows[0]) if rows else 0
    entries = [v for row in rows for v in row]
    if ell:
        return int(flint.nmod_mat(len(rows), ncols, [int(v) % ell for v in entries], ell).rank())
    fractions = [Fraction(v) for v in entries]
    numbers = [flint.fmpq(v.numerator, v.denominator) for v in fractions]
    return int(flint.fmpq_mat(len(rows), ncols, numbers).rank())


def rank_disagreements(
    found: Any, points: Sequence[Fraction], primes: Sequence[int] = PRIMES
) -> list[str]:
    """Where an answer and elimination differ, at rational points and at all points of fields.

    Its roots modulo a prime can be more than those over the complex numbers, and the rank there
    less, so a disagreement modulo one prime alone does not count.
    """
    about, matrix = found.about, found.matrix.document()
    wrong = []
    for t in points:
        plain = values(about, t)
        said = _claimed(found, t, 0)
        if plain is not None and said is not None:
            want = rank_of(matrix, plain, about.names, 0, about.time)
            if want != said:
                wrong.append(f"{matrix} at t = {t}: {want}, claimed {said}")
    bad = []
    for ell in primes:
        try:
            if any(_differs(about, matrix, found, t, ell) for t in range(ell)):
                bad.append(ell)
        except ValueError:  # the prime divides a denominator
            continue
    if len(bad) > 1:
        wrong.append(f"{matrix} modulo {bad}")
    return wrong


def _differs(about: Any, matrix: dict[str, Any], found: Any, t: int, ell: int) -> bool:
    plain, said = values(about, t, ell), _claimed(found, t, ell)
    if plain is None or said is None:
        return False
    return rank_of(matrix, plain, about.names, ell, about.time) != said


def _claimed(found: Any, t: Any, ell: int) -> int | None:
    def vanishes(q: Any) -> bool:
        if not ell:
            return bool(q(t) == 0)
        total = 0
        for k, c in enumerate(q.coefficients):
            total += c.numerator * pow(c.denominator, -1, ell) * t**k
        return total % ell == 0

    if any(vanishes(each.value) for each in found.outside):
        return None
    return next((each.rank for each in found.exceptional if vanishes(each.value)), int(found.rank))
