"""Lemma 3: exceptional gains, by known answers and laws."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

from mcexact import MultiChannelSystem, controllability_indices
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.errors import FloatRefused, Impossible, InputError
from mcexact.exact.matrix import Matrix
from mcexact.questions import exceptional_gains


def index_of(A: Matrix, B: Matrix) -> int | None:
    """The controllability index of a pair."""
    found = controllability_indices(MultiChannelSystem(A, [B], [Matrix.zeros(0, A.nrows)]))
    return found.index


def test_membership_is_decided_as_by_the_index_at_that_gain() -> None:
    rng, exceptional = random.Random(3), 0
    for _ in range(25):
        n = rng.randint(2, 4)

        def drawn(ncols: int, n: int = n) -> Matrix:
            rows = [[rng.choice([0, 0, 1, -1]) for _ in range(ncols)] for _ in range(n)]
            return Matrix.from_rows(rows)

        M, A, B = drawn(n), drawn(n), drawn(rng.randint(1, 2))
        try:
            found = exceptional_gains(M, A, B)
        except Impossible:
            continue
        for g in (Fraction(k, 2) for k in range(-6, 7)):
            index = index_of(M + A * g, B)
            assert (g in found.controllability_set) == (index is None)
            assert (g in found.index_set) == (index is None or index > found.index)
            exceptional += g in found.index_set
    assert exceptional > 5


def test_the_second_set_is_part_of_the_first() -> None:
    # With two inputs the index can grow where controllability stays.
    M = [[0, 0, 0], [0, 0, 0], [1, 0, 0]]
    A = [[0, 0, 0], [0, 0, 0], [0, 1, 0]]
    B = [[1, 0], [0, 1], [0, 0]]
    found = exceptional_gains(M, A, B)
    assert found.index == 2
    assert str(found.index_set.polynomial) == "1"
    chain = exceptional_gains(
        [[0, 0, 0, 0], [1, 0, 0, 0], [0, 0, 0, 0], [0, 1, 0, 0]],
        [[0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 1, 0]],
        [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]],
    )
    assert chain.controllability_set.polynomial.divides(chain.index_set.polynomial)


def test_an_irrational_gain_is_enclosed_and_no_rational_one_is_in_the_set() -> None:
    # det [b, (M+gA)b, (M+gA)²b] has the factor g² − 2.
    M, A, B = [[0, 2], [1, 0]], [[1, 0], [0, -1]], [[1, 0], [0, 1]]
    found = exceptional_gains(M, A, B)
    assert found.index == 1
    assert found.index_set.polynomial.degree == 0
    single = exceptional_gains([[0, 1], [2, 0]], [[0, 1], [-1, 0]], [[1], [0]])
    assert [int(low) for low, _ in single.index_set.real_roots] == [2]
    for answer in (found.index_set, single.index_set, found.indices):
        assert check_document(encode(answer).encode()).verdict == "VALID"


def test_similarity_changes_nothing() -> None:
    M, A, B = (
        Matrix.from_rows(rows)
        for rows in ([[0, 1, 0], [2, 0, 1], [0, 0, 1]], [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
                     [[1], [0], [0]])
    )  # fmt: skip
    T = Matrix.from_rows([[1, 1, 0], [0, 1, 2], [0, 0, 1]])
    back = Matrix.from_rows([[1, -1, 2], [0, 1, -2], [0, 0, 1]])
    assert T @ back == Matrix.identity(3)
    first = exceptional_gains(M, A, B)
    second = exceptional_gains(T @ M @ back, T @ A @ back, T @ B)
    assert first.index_set.polynomial == second.index_set.polynomial


def test_a_pair_that_is_not_controllable_is_refused_with_the_certificate() -> None:
    with pytest.raises(Impossible, match="not controllable") as caught:
        exceptional_gains([[0, 1], [0, 0]], [[1, 0], [0, 1]], [[1], [0]])
    verdict = check_document(encode(caught.value.certificate).encode())
    assert verdict.verdict == "VALID"
    assert "not controllable" in verdict.statement


def test_shapes_and_floats_are_refused() -> None:
    with pytest.raises(InputError):
        exceptional_gains([[0, 1]], [[0, 1], [0, 0]], [[0], [1]])
    with pytest.raises(FloatRefused):
        exceptional_gains([[0.5]], [[0]], [[1]])


def test_one_state_and_none() -> None:
    assert str(exceptional_gains([[1]], [[2]], [[3]]).index_set.polynomial) == "1"
    nothing = exceptional_gains([], [], Matrix.zeros(0, 1))
    assert nothing.index == 0
    assert check_document(encode(nothing.index_set).encode()).verdict == "VALID"
