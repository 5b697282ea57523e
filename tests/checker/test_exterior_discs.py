"""Exterior discs, compared with their formulas in floating point, and the radii under gains."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

from mcexact.checker.core.arithmetic import Matrix
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import System
from mcexact.checker.discs import Box, exterior_discs, with_gains
from tests.checker.box_maker import decimal
from tests.checker.complex_numbers import drawn, numbers, real, sizes, times
from tests.checker.handmade import matrix


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
