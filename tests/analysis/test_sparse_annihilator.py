"""What channels do not control, by products with sparse matrices, beside elimination."""

from __future__ import annotations

import random

import pytest

from mcexact.analysis import sparse
from mcexact.analysis.blocks import measured_system
from mcexact.analysis.sparse import annihilator
from mcexact.exact.krylov import controllable_subspace
from mcexact.exact.linear_algebra import rank
from mcexact.exact.matrix import Matrix, vstack
from mcexact.model.system import MultiChannelSystem
from tests.oracle.draws import exact, sparse_system


def test_the_same_annihilator_is_found_as_by_elimination() -> None:
    found = 0
    for number in range(120):
        rng = random.Random(number)
        system = exact(sparse_system(rng))
        T = [i for i in range(system.m) if rng.random() < 0.6] or [0]
        expected = controllable_subspace(system.A, system.input_matrix(T), rng).annihilator()
        if not expected.nrows:
            continue
        answer = annihilator(measured_system(system, T)[0], expected.nrows)
        assert answer is not None
        W, pivots = answer
        assert W.take(cols=pivots) == Matrix.identity(expected.nrows)
        assert rank(vstack([W, expected])) == expected.nrows
        found += 1
    assert found > 40


def beside(factor: int) -> MultiChannelSystem:
    """The sum of x_1 and a multiple of x_2 decays whatever the input is."""
    A = [[-factor - 1, -(factor**2)], [1, factor - 1]]
    return MultiChannelSystem(A, [[[-factor], [1]]], [[[1, 0]]])


@pytest.mark.parametrize("factor", [3, 10**9 + 7, 10**15 + 37])
def test_long_entries_take_several_primes(factor: int) -> None:
    answer = annihilator(measured_system(beside(factor), [0])[0], 1)
    assert answer is not None
    W, pivots = answer
    assert W.rows() == ((1, factor),)
    assert pivots == (0,)


def test_what_is_not_found_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    part, _ = measured_system(beside(10**9 + 7), [0])
    assert annihilator(part, 2) is None
    assert annihilator(part, 10**4) is None
    monkeypatch.setattr(sparse, "MOST_WORK", 0)
    assert annihilator(part, 1) is None
