"""Discs of regular pencils and exterior discs, compared with their formulas in floating point."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.arithmetic import Matrix
from mcexact.checker.boxes import Box
from mcexact.checker.exterior_discs import exterior_discs, with_gains
from mcexact.checker.reading import Refused
from mcexact.checker.regular_discs import Pencil, left_inverse, right_inverse
from mcexact.checker.system import System
from tests.checker.box_maker import decimal
from tests.checker.handmade import matrix

Complex = list[list[complex]]
CLEAR = 1e-4
"""Where both sides of an inequality are so close to each other, rounding decides."""


def drawn(rng: random.Random, nrows: int, ncols: int, near: complex = 0) -> tuple[Any, Complex]:
    """A complex matrix, near a multiple of the identity, in a certificate and as numbers."""
    d = 2**20
    re, im = (
        [
            [round(d * part * (i == j)) + rng.randint(-d // 16, d // 16) for j in range(ncols)]
            for i in range(nrows)
        ]
        for part in (near.real, near.imag)
    )
    pairs = zip(re, im, strict=True)
    numbers = [[complex(x / d, y / d) for x, y in zip(*rows, strict=True)] for rows in pairs]
    return {"denominator": d, "re": re, "im": im}, numbers


def real(rng: random.Random, nrows: int, ncols: int, d: int, least: int = -3) -> Matrix:
    """A matrix of the checker with small entries."""
    return Matrix([[rng.randint(least, 3) for _ in range(ncols)] for _ in range(nrows)], ncols, d)


def numbers(M: Matrix) -> Complex:
    """Its entries."""
    return [[complex(entry / M.denominator) for entry in row] for row in M.rows]


def times(A: Complex, B: Complex) -> Complex:
    """The product."""
    columns = list(zip(*B, strict=True))
    return [[sum(a * b for a, b in zip(row, col, strict=True)) for col in columns] for row in A]


def sizes(A: Complex) -> Complex:
    """The absolute values."""
    return [[complex(abs(entry)) for entry in row] for row in A]


@pytest.mark.parametrize("left", [True, False])
def test_a_disc_is_regular_exactly_where_the_rows_are_small(left: bool) -> None:
    seen = set()
    for seed in range(150):
        rng = random.Random(seed)
        n, more = rng.choice(((1, 0), (2, 0), (2, 1), (1, 2)))
        N = n + more
        d = rng.choice((4, 5))
        Z = real(rng, N if left else n, N, d)
        if left and more:
            Z = Matrix(
                [
                    [-d * (i == j) if i >= n else e for j, e in enumerate(row)]
                    for i, row in enumerate(Z.rows)
                ],
                N,
                d,
            )
        D = real(rng, Z.nrows, N, 40, 0)
        c = complex(rng.randint(-3, 3) / 2, rng.randint(-3, 3) / 2)
        rho = Fraction(rng.randint(0, 6), 16)
        w = [rng.randint(1, 3) for _ in range(N if left else n)]
        near = 1 / (c + 0.3) if rng.random() < 0.8 else 1
        given, V = drawn(rng, N, N if left else n, near)
        rule = left_inverse if left else right_inverse
        found = rule(given, w, "", Pencil(Z, D, n))(Fraction(c.real), Fraction(c.imag), rho)
        E = [[complex(i == j < n) for j in range(N)] for i in range(Z.nrows)]
        cEZ = [
            [c * e - z for e, z in zip(*rows, strict=True)]
            for rows in zip(E, numbers(Z), strict=True)
        ]
        order = [V, cEZ] if left else [cEZ, V]
        M = times(*order)
        bound = times(*([sizes(V), numbers(D)] if left else [numbers(D), sizes(V)]))
        moved = sizes(times(*([V, E] if left else [E, V])))
        rows = [
            sum(
                (abs((i == j) - M[i][j]) + bound[i][j].real + float(rho) * moved[i][j].real) * w[j]
                for j in range(len(w))
            )
            - w[i]
            for i in range(len(w))
        ]
        if min(map(abs, rows)) > CLEAR:
            assert found == (max(rows) < 0), seed
            seen.add(found)
    assert seen == {True, False}


def test_exterior_discs_are_as_large_as_their_rows_ask_for() -> None:
    seen = set()
    for seed in range(60):
        rng = random.Random(seed)
        n = rng.choice((1, 2, 3))
        A, D = real(rng, n, n, 5), real(rng, n, n, 50, 0)
        (Y, y), (T, t) = drawn(rng, n, n, rng.choice((1, 1j))), drawn(rng, n, n, 1)
        G, H = times(y, t), times(times(y, numbers(A)), t)
        e = [sum(row).real for row in times(times(sizes(y), numbers(D)), sizes(t))]
        slack = [2 * abs(G[i][i]) - sum(map(abs, G[i])) for i in range(n)]
        centers = [complex(round(H[i][i].real), round(2 * H[i][i].imag) / 2) for i in range(n)]
        needed = [
            (sum(abs(centers[i] * g - h) for g, h in zip(G[i], H[i], strict=True)) + e[i])
            / slack[i]
            if slack[i]
            else 1.0
            for i in range(n)
        ]
        for factor in (0.9, 1.1):
            discs = [
                {
                    "re": decimal(Fraction(a.real)),
                    "im": decimal(Fraction(a.imag)),
                    "radius": f"{factor * r:.9f}",
                }
                for a, r in zip(centers, needed, strict=True)
            ]
            try:
                good = bool(exterior_discs(Y, T, discs, "", A, D))
            except Refused as refused:
                good = False
                assert refused.verdict == "INVALID" or "-" in discs[0]["radius"], refused.args
            seen.add((good, factor))
            if min(map(abs, slack)) > 0.1 and min(map(abs, needed)) > 0.01:
                assert good == (factor > 1 and min(slack) > 0), (seed, factor)
    assert (True, 1.1) in seen and (True, 0.9) not in seen


def test_the_radii_under_gains_are_reached_where_nothing_cancels() -> None:
    """In every entry, by the member that is farthest from the center in every entry."""
    rng, n, sizes = random.Random(5), 3, [(2, 1), (1, 3)]

    def system(d: int) -> System:
        B, C = [real(rng, n, p, d, 0) for p, _ in sizes], [real(rng, q, n, d, 0) for _, q in sizes]
        return System("continuous", ["1", "2"], real(rng, n, n, d, 0), B, C)

    for _ in range(20):
        given, radii = system(2), system(7)
        moved, none = (
            {
                "A": given.A + radii.A.times(factor),
                "B": [M + D.times(factor) for M, D in zip(given.B, radii.B, strict=True)],
                "C": [M + D.times(factor) for M, D in zip(given.C, radii.C, strict=True)],
            }
            for factor in (1, 0)
        )
        F = [matrix(*real(rng, p, q, 1, 0).rows, denominator=3) for p, q in sizes]
        M, D = with_gains(F, "", Box(**vars(given), radii=radii))
        far, center = (
            with_gains(F, "", Box(**{**vars(given), **parts}, radii=system(5)))[0]
            for parts in (moved, none)
        )
        assert center.equals(M) and (far - M).equals(D)
        negative = [{**F_i, "entries": [[-x for x in r] for r in F_i["entries"]]} for F_i in F]
        assert with_gains(negative, "", Box(**vars(given), radii=radii))[1].equals(D)


@pytest.mark.parametrize(
    ("Y", "discs", "code"),
    [
        ([[(3, 4)]], [("3", "-4", "5.1")], ""),
        ([[(3, 4)]], [("3", "-4", "4")], "disc"),
        ([[(0, 0), (1, 0)], [(1, 0), (0, 0)]], [("0", "0", "-10")] * 2, "dominance"),
        ([[(1, 0), (1, 0)], [(0, 0), (1, 0)]], [("0", "0", "10")] * 2, "dominance"),
    ],
)
def test_discs_are_checked_in_complex_numbers_and_rows_that_are_dominant(
    Y: list[list[tuple[int, int]]], discs: list[tuple[str, str, str]], code: str
) -> None:
    """About the matrix 0: discs around other points have to reach it, and no radius is negative."""
    n = len(Y)
    given, unit = (
        {
            "denominator": 1,
            "re": [[x for x, _ in row] for row in M],
            "im": [[y for _, y in row] for row in M],
        }
        for M in (Y, [[(int(i == j), 0) for j in range(n)] for i in range(n)])
    )
    listed = [dict(zip(("re", "im", "radius"), disc, strict=True)) for disc in discs]
    zeros, found = Matrix.zeros(n, n), ""
    try:
        exterior_discs(given, unit, listed, "", zeros, zeros)
    except Refused as refused:
        found = refused.code
    assert found == code


@pytest.mark.parametrize(("radius", "good"), [("1.1", True), ("1", False), ("0.5", False)])
def test_discs_reach_what_is_tied(radius: str, good: bool) -> None:
    """A = s with s from −1 to 1."""
    one = {"denominator": 1, "re": [[1]], "im": [[0]]}
    zero, listed = Matrix.zeros(1, 1), [{"re": "0", "im": "0", "radius": radius}]
    found = True
    try:
        exterior_discs(one, one, listed, "", zero, zero, [Matrix([[1]], 1)])
    except Refused:
        found = False
    assert found == good


@pytest.mark.parametrize("rule", [left_inverse, right_inverse])
def test_a_disc_stays_clear_of_what_is_tied(rule: Any) -> None:
    """λ − s is regular for all s from −1 to 1 where |λ − 2| is below 1."""
    zero, half = Matrix.zeros(1, 1), {"denominator": 2, "re": [[1]], "im": [[0]]}
    regular = rule(half, [1], "", Pencil(zero, zero, 1, [Matrix([[1]], 1)]))
    assert regular(Fraction(2), Fraction(0), Fraction(9, 10))
    assert not regular(Fraction(2), Fraction(0), Fraction(1))


def test_a_disc_is_regular_beside_signals_without_dynamics() -> None:
    """diag(λ, 1) is regular where |λ − 1| is below 1."""
    unit = {"denominator": 1, "re": [[1, 0], [0, 1]], "im": [[0, 0], [0, 0]]}
    pencil = Pencil(Matrix([[0, 0], [0, -1]], 2), Matrix.zeros(2, 2), 1)
    regular = left_inverse(unit, [1, 1], "", pencil)
    assert regular(Fraction(1), Fraction(0), Fraction(9, 10))
    assert not regular(Fraction(1), Fraction(0), Fraction(1))


def test_without_dynamics_every_disc_is_regular() -> None:
    one = {"denominator": 1, "re": [[1]], "im": [[0]]}
    regular = left_inverse(one, [1], "", Pencil(Matrix([[-1]], 1), Matrix.zeros(1, 1), 0))
    assert regular(Fraction(5), Fraction(-3), Fraction(100))
