"""The spectrum of a loop: enclosures that hold, and a verdict from the polynomial alone."""

from fractions import Fraction

import pytest

from mcexact.analysis.stability import closed_loop_spectrum
from mcexact.exact.matrix import Matrix


@pytest.mark.parametrize(
    ("rows", "time", "stable", "rate"),
    [
        ([], "continuous", True, None),
        ([[-2]], "continuous", True, 2),
        ([[0]], "continuous", False, 0),
        ([[-1, 7], [0, -1]], "continuous", True, 1),
        ([[0, 1], [-5, -2]], "continuous", True, 1),
        ([["1/2"]], "discrete", True, Fraction(1, 2)),
        ([[0, 1], [0, 0]], "discrete", True, 0),
        ([[0, -1], [1, 0]], "discrete", False, 1),
    ],
)
def test_the_rate_is_enclosed(rows, time, stable, rate):
    found = closed_loop_spectrum(Matrix.from_rows(rows, ncols=len(rows)), time)
    assert found.stable is stable
    if rate is None:
        assert found.rate is None
    else:
        assert Fraction(found.rate.lower) <= rate <= Fraction(found.rate.upper)
        assert Fraction(found.rate.upper) - Fraction(found.rate.lower) < Fraction(1, 10**6)


def test_equal_eigenvalues_share_a_disc():
    found = closed_loop_spectrum(
        Matrix.from_rows([[-1, 1, 0], [0, -1, 0], [0, 0, -2]]), "continuous"
    )
    assert len(found.discs) == 2 and found.polynomial.degree == 3
