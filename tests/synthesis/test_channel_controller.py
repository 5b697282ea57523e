"""Brasch–Pearson: the loop has the prescribed polynomial, at the order that the index allows."""

import random
from fractions import Fraction

import pytest

from mcexact.errors import InputError, LimitReached
from mcexact.exact.linear_algebra import characteristic_polynomial, rank
from mcexact.exact.matrix import Matrix, hstack
from mcexact.exact.polynomial import Polynomial
from mcexact.model.loop import closed_loop
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.channel_controller import channel_controller, observing_rows, transposed
from tests.wording import refusal


def drawn(rng, nrows, ncols, bound=2):
    return Matrix.from_integers(
        [[rng.randint(-bound, bound) for _ in range(ncols)] for _ in range(nrows)], ncols=ncols
    )


def index_of(A, B):
    """The controllability index over Q, or None."""
    blocks = [B]
    for nu in range(1, A.nrows + 1):
        if rank(hstack(blocks)) == A.nrows:
            return nu
        blocks.append(A @ blocks[-1])
    return None


def triples(count, seed):
    """Drawn (A, B, C), controllable, observable and cyclic, with both indices."""
    rng = random.Random(seed)
    while count:
        n, p, q = rng.randint(1, 6), rng.randint(1, 3), rng.randint(1, 3)
        A, B, C = drawn(rng, n, n), drawn(rng, n, p), drawn(rng, q, n)
        if rng.random() < 0.3:
            A = A * Fraction(1, rng.randint(2, 5))
        reach, see = index_of(A, B), index_of(A.T, C.T)
        cyclic = index_of(A, drawn(rng, n, 1, 50)) is not None
        if reach is not None and see is not None and cyclic:
            count -= 1
            yield rng, A, B, C, reach, see


def spectrum(made, A, B, C):
    """The characteristic polynomial of the loop."""
    plant = MultiChannelSystem(A, [B], [C])
    return characteristic_polynomial(
        closed_loop(plant, local_controllers(plant, [made.matrices])).matrix
    )


@pytest.mark.parametrize("seed", range(4))
def test_the_controllability_index_sets_the_order(seed):
    for rng, A, B, C, reach, _ in triples(15, seed):
        wanted = Polynomial.of(*(rng.randint(-9, 9) for _ in range(A.nrows + reach - 1)), 1)
        made = channel_controller(A, B, C, wanted, index=reach)
        assert made.order == reach - 1
        assert spectrum(made, A, B, C) == wanted


@pytest.mark.parametrize("seed", range(4))
def test_the_observability_index_sets_the_order_of_the_dual_design(seed):
    for rng, A, B, C, _, see in triples(15, seed):
        wanted = Polynomial.of(*(rng.randint(-9, 9) for _ in range(A.nrows + see - 1)), 1)
        made = transposed(channel_controller(A.T, C.T, B.T, wanted, index=see))
        assert made.order == see - 1
        assert spectrum(made, A, B, C) == wanted


def test_a_larger_order_than_needed_is_rectangular_and_possible():
    for rng, A, B, C, reach, _ in triples(10, 9):
        wanted = Polynomial.of(*(rng.randint(-9, 9) for _ in range(A.nrows + reach)), 1)
        made = channel_controller(A, B, C, wanted, index=reach + 1)
        assert spectrum(made, A, B, C) == wanted


def test_a_derogatory_matrix_has_no_observing_row():
    I = Matrix.identity(2)
    assert list(observing_rows(I, I, random.Random(0))) == []
    with pytest.raises(LimitReached, match="not cyclic"):
        channel_controller(I, I, I, Polynomial.of(1, 2, 1), index=1)


def test_an_index_below_the_controllability_index_is_refused():
    A, B = Matrix.from_rows([[0, 1], [0, 0]]), Matrix.from_rows([[0], [1]])
    C = Matrix.from_rows([[1, 0]])
    with refusal(InputError):
        channel_controller(A, B, C, Polynomial.of(1, 2, 1), index=1)


def test_the_degree_must_fit_the_index():
    A = Matrix.from_rows([[1]])
    with pytest.raises(InputError, match="degree 1, found degree 2"):
        channel_controller(A, A, A, Polynomial.of(1, 2, 1), index=1)
