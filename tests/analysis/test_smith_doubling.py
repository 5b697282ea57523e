"""Lyapunov equations to any precision: the residual says what came out."""

from fractions import Fraction

import pytest

from mcexact.analysis.lyapunov import decrease, doubled_lyapunov, is_dominant, quadratic_form
from mcexact.exact.matrix import Matrix
from mcexact.exact.roots import StabilityRegion


def far_from_normal(time: str, states: int = 8) -> Matrix:
    """Eigenvalues 1/2 and −2 (or −2 and −3) under a superdiagonal of 10⁶."""
    first, second = (-2, -3) if time == "continuous" else (Fraction(1, 2), Fraction(-1, 3))
    return Matrix.from_rows(
        [
            [(first if i % 2 else second) * (i == j) + 10**6 * (j == i + 1) for j in range(states)]
            for i in range(states)
        ]
    )


@pytest.mark.parametrize(
    ("time", "bound"), [("continuous", Fraction(1)), ("discrete", Fraction(3, 4))]
)
def test_the_residual_is_the_identity(time, bound):
    D = far_from_normal(time, 3)
    P = doubled_lyapunov(D, StabilityRegion(time, bound))
    S = decrease(D, P, StabilityRegion(time, bound))
    off = S - Matrix.identity(3)
    assert max(abs(x) for row in off.rows() for x in row) < Fraction(1, 10**30)


@pytest.mark.parametrize(
    ("time", "bound"), [("continuous", Fraction(3)), ("discrete", Fraction(1, 4))]
)
def test_an_eigenvalue_outside_leaves_no_solution(time, bound):
    assert doubled_lyapunov(far_from_normal(time, 3), StabilityRegion(time, bound)) is None


@pytest.mark.parametrize(
    ("time", "bound"), [("continuous", Fraction(1)), ("discrete", Fraction(3, 4))]
)
def test_what_defeats_double_precision_is_decided(time, bound):
    D = far_from_normal(time)
    form = quadratic_form(D, StabilityRegion(time, bound))
    assert form is not None and form.R is not None
    assert is_dominant(form.R.T @ form.P @ form.R)
    assert is_dominant(form.R2.T @ decrease(D, form.P, StabilityRegion(time, bound)) @ form.R2)


def test_numbers_beyond_doubles_leave_the_question_open():
    far = Matrix.from_rows([[-(10**400)]])
    assert quadratic_form(far, StabilityRegion("continuous", Fraction(1))) is None
