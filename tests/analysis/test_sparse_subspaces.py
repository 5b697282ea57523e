"""Fixed factors by products with sparse matrices, beside those that dense ones give."""

from __future__ import annotations

import random
from collections import Counter
from fractions import Fraction

import pytest

from mcexact.analysis import sparse as sparse_subspaces
from mcexact.analysis.sparse import fixed_subspaces
from mcexact.analysis.subspaces import decide
from mcexact.derived.modular import generator
from mcexact.errors import LimitReached
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.system import MultiChannelSystem
from tests.oracle.draws import exact, sparse_system
from tests.oracle.planted import planted
from tests.wording import refusal


def dense(system: MultiChannelSystem) -> set[tuple[Polynomial, tuple[int, ...], int]]:
    found = decide(system, generator(system, "fixed_spectrum")).obstructions
    return {(o.polynomial, o.subspace.channels_T, o.subspace.deficiency) for o in found}


def sparse(system: MultiChannelSystem) -> set[tuple[Polynomial, tuple[int, ...], int]]:
    return {(p, at.channels_T, at.deficiency) for p, at in fixed_subspaces(system)}


def test_the_same_factors_and_sets_are_found_as_with_dense_matrices() -> None:
    counted: Counter[str] = Counter()
    for number in range(120):
        system = exact(sparse_system(random.Random(number)))
        try:
            assert sparse(system) == dense(system)
        except LimitReached as limit:
            assert "Jordan" in str(limit)
            counted["Jordan"] += 1
        else:
            counted["T" if any(T for _, T, _ in dense(system)) else "no T"] += 1
    assert counted["T"] > 10, counted
    assert counted["Jordan"] < 15, counted


def test_a_planted_mode_that_one_channel_sees_is_found() -> None:
    system = planted(300, 20, 1)
    [(p, at)] = fixed_subspaces(system)
    assert (str(p), at.channels_T, at.deficiency) == ("x + 3", (0,), 1)
    assert sum(1 for M in at.U.matrices for _ in M.nonzero()) == 4


@pytest.mark.parametrize("scale", [7, 10**5 + 3, 10**12 + 39])
def test_long_entries_take_several_primes(scale: int) -> None:
    [(_, at)] = fixed_subspaces(planted(40, 4, 2, scale=scale))
    entries = {abs(Fraction(x, M.denominator)) for M in at.U.matrices for _, _, x in M.nonzero()}
    assert {scale, Fraction(1, scale)} & entries


@pytest.mark.parametrize("mode", [10**6 + 3, -(10**9)])
def test_long_modes_take_several_primes(mode: int) -> None:
    [(p, at)] = fixed_subspaces(planted(40, 4, 2, mode=mode))
    assert p == Polynomial.from_roots([mode])
    assert at.channels_T == (0,)


def fixed_part(rows: list[list[int]]) -> MultiChannelSystem:
    """States that no channel drives or sees, beside one that a channel moves."""
    n = len(rows)
    A = [[*row, 0] for row in rows] + [[0] * n + [5]]
    return MultiChannelSystem(A, [[[0]] * n + [[1]]], [[[0] * n + [1]]])


@pytest.mark.parametrize(
    "rows",
    [
        [[0, -1], [1, 0]],
        [[0, 0, 2], [1, 0, 0], [0, 1, 0]],
        [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 0, -1], [0, 0, 1, 0]],
        [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
        [[1, 0], [0, 2]],
    ],
)
def test_factors_of_higher_degree_and_deficiency(rows: list[list[int]]) -> None:
    system = fixed_part(rows)
    assert sparse(system) == dense(system)


def test_nothing_is_fixed() -> None:
    assert fixed_subspaces(MultiChannelSystem([[1]], [[[1]]], [[[1]]])) == ()
    assert fixed_subspaces(MultiChannelSystem([], [Matrix.zeros(0, 1)], [Matrix.zeros(1, 0)])) == ()


@pytest.mark.parametrize(
    ("rows", "says"),
    [
        ([[0, 1], [0, 0]], "Jordan"),
        ([[int(i == j + 1) for j in range(7)] for i in range(7)], "Jordan"),
        (
            [[int(i == j + 1) + 2 * int((i, j) == (0, 6)) for j in range(7)] for i in range(7)],
            "degree 7",
        ),
    ],
)
def test_what_is_not_found_is_said(rows: list[list[int]], says: str) -> None:
    with pytest.raises(LimitReached, match=says):
        fixed_subspaces(fixed_part(rows))


def test_limits_are_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sparse_subspaces, "MOST_COLUMNS", 1)
    with pytest.raises(LimitReached, match="more than 1 dimensions"):
        fixed_subspaces(planted(40, 4, 2))
    monkeypatch.undo()
    monkeypatch.setattr(sparse_subspaces, "MOST_WORK", 0)
    with refusal(LimitReached):
        fixed_subspaces(planted(40, 4, 2, mode=10**9))
    with refusal(LimitReached):
        fixed_subspaces(planted(40, 4, 2, scale=10**9))
