"""State feedback: the prescribed characteristic polynomial, or a certified refusal."""

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mcexact import testing
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.errors import Impossible
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.state_feedback import loop_matrix, state_feedback


def drawn_polynomial(seed, degree):
    rng = random.Random(seed)
    return Polynomial.of(*(rng.randint(-5, 5) for _ in range(degree)), 1)


@given(testing.jointly_controllable_systems(max_states=5, max_channels=4), st.integers(0, 999))
def test_the_closed_loop_has_the_prescribed_polynomial(drawn, seed):
    system = drawn.system
    wanted = drawn_polynomial(seed, system.n)
    found = state_feedback(system, wanted)
    assert [F.shape for F in found.gains] == [(system.p(i), system.n) for i in range(system.m)]
    assert characteristic_polynomial(loop_matrix(system, found.gains)) == wanted
    assert found.polynomial == wanted


def test_no_states_need_no_gains():
    system = MultiChannelSystem(Matrix.zeros(0, 0), [Matrix.zeros(0, 1)], [Matrix.zeros(1, 0)])
    assert state_feedback(system, Polynomial.of(1)).gains[0].shape == (1, 0)


def test_equal_eigenvalues_that_one_input_cannot_move_are_moved_by_two():
    system = MultiChannelSystem([[1, 0], [0, 1]], [[[1], [0]], [[0], [1]]], [[[1, 0]]] * 2)
    wanted = Polynomial.of(1, 0, 1)
    assert state_feedback(system, wanted).polynomial == wanted


def test_integers_are_found_where_the_inputs_allow_them():
    A = [[0, 1, 2], [1, 0, -1], [2, 1, 1]]
    system = MultiChannelSystem(A, [[[1], [0], [0]], [[0], [1], [0]]], [[[1, 0, 0]]] * 2)
    found = state_feedback(system, Polynomial.from_roots([-1, -2, -3]))
    assert all(F.denominator == 1 for F in found.gains)


def test_an_uncontrollable_mode_is_named_and_certified():
    system = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [0]]], [[[1, 1]]])
    with pytest.raises(Impossible, match="moves the mode 2") as caught:
        state_feedback(system, Polynomial.of(2, 3, 1))
    verdict = check_document(encode(caught.value.certificate).encode())
    assert verdict.verdict == "VALID" and "not controllable" in verdict.statement
