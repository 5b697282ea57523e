"""Controllability and observability indices."""

import random

from mcexact.analysis.controllability import controllability_indices, observability_indices
from mcexact.answer import protocol
from mcexact.checker.kinds import check_document
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem
from tests.oracle.draws import exact, sparse_system
from tests.oracle.enumeration import PlainSystem, product, rank


def oracle_ranks(system: PlainSystem) -> tuple[int, ...]:
    """The ranks of [B … A^{k−1}B] until they stop growing."""
    n = system.n
    block = [[value for t in range(system.m) for value in system.B[t][i]] for i in range(n)]
    rows, ranks = [list(row) for row in block], [0]
    while (found := rank(rows)) > ranks[-1]:
        ranks.append(found)
        block = product(system.A, block)
        rows = [a + b for a, b in zip(rows, block, strict=True)]
    return tuple(ranks[1:])


def test_drawn_systems_agree_with_plain_ranks_and_are_certified() -> None:
    rng = random.Random(8)
    for _ in range(150):
        small = sparse_system(rng)
        system = exact(small)
        for answer, wanted in (
            (controllability_indices(system), oracle_ranks(small)),
            (observability_indices(system), oracle_ranks(small.dual)),
        ):
            assert answer.ranks == wanted
            assert sum(answer.indices) == (wanted[-1] if wanted else 0)
            verdict = check_document(protocol.encode(answer).encode())
            assert verdict.verdict == "VALID", verdict


def test_a_chain_of_integrators_has_one_long_index() -> None:
    n = 8
    A = [[int(i == j + 1) for j in range(n)] for i in range(n)]
    system = MultiChannelSystem(A, [[[1]] + [[0]] * (n - 1)], [[[0] * n]])
    found = controllability_indices(system)
    assert (found.index, found.indices) == (n, (n,))
    assert observability_indices(system).ranks == ()


def test_without_states_the_index_is_0() -> None:
    system = MultiChannelSystem([], [Matrix.zeros(0, 1)], [Matrix.zeros(1, 0)])
    found = controllability_indices(system)
    assert (found.ranks, found.index, found.indices) == ((), 0, ())
    assert check_document(protocol.encode(found).encode()).verdict == "VALID"
