"""Blocks of states: the strong components, their order, and the evidence of each."""

from __future__ import annotations

import random
from typing import Any

import networkx
import pytest

from mcexact.analysis.blocks import (
    bounded_blocks,
    completed_blocks,
    free_blocks,
    modes_left,
    state_blocks,
)
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.sharing import deficiency
from mcexact.answer.evidence import CoprimePolynomials, KrylovSequence
from mcexact.answer.modes import ByBlocks, TwoPolynomials
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem
from tests.assurance.campaigns.absence import tried
from tests.oracle.agreement import drawn_pair

CHAIN = MultiChannelSystem([[0, 0], [1, 0]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]])
"""Channel 1 drives the first of two integrators, channel 2 the second."""


def beside(*systems: MultiChannelSystem) -> MultiChannelSystem:
    """Systems that know nothing of each other."""
    n = sum(system.n for system in systems)
    A, B, C, start = [[0] * n for _ in range(n)], [], [], 0
    for system in systems:
        rows: list[list[Any]] = [list(row) for row in system.A.rows()]
        for a, row in enumerate(rows):
            A[start + a][start : start + system.n] = row
        for channel in system.channels:
            b: list[list[Any]] = [[0] * channel.B.ncols for _ in range(n)]
            b[start : start + system.n] = [list(row) for row in channel.B.rows()]
            after = n - start - system.n
            B.append(b)
            C.append([[0] * start + list(row) + [0] * after for row in channel.C.rows()])
        start += system.n
    return MultiChannelSystem(A, B, C)


def drawn(rng: random.Random, n: int, bound: int) -> MultiChannelSystem:
    """A system of few entries, with channels of several widths."""

    def table(rows: int, cols: int) -> Matrix:
        entries = [
            [rng.randint(-bound, bound) if rng.random() < 1 / n else 0 for _ in range(cols)]
            for _ in range(rows)
        ]
        return Matrix.from_integers(entries, ncols=cols)

    widths = [(rng.randint(0, 2), rng.randint(0, 2)) for _ in range(rng.randint(1, 4))]
    B, C = [table(n, p) for p, _ in widths], [table(q, n) for _, q in widths]
    return MultiChannelSystem(table(n, n), B, C, time="discrete")


@pytest.mark.parametrize(("n", "bound"), [(3, 1), (6, 10**20), (9, 2), (140, 5)])
def test_the_blocks_are_the_strong_components_in_order(n: int, bound: int) -> None:
    for seed in range(40 if n < 100 else 2):
        system = drawn(random.Random(seed), n, bound)
        graph, A = networkx.DiGraph(), system.A.numerators
        graph.add_nodes_from(range(n))
        graph.add_edges_from((b, a) for a in range(n) for b in range(n) if A[a][b])
        reached = []
        for channel in system.channels:
            moved = [a for a, row in enumerate(channel.B.numerators) if any(row)]
            seen = {b for row in channel.C.numerators for b, entry in enumerate(row) if entry}
            graph.add_edges_from((b, a) for a in moved for b in seen)
            reached.append((set(moved), seen))
        blocks = state_blocks(system)
        components = {tuple(sorted(c)) for c in networkx.strongly_connected_components(graph)}
        assert {block.states for block in blocks} == components
        at = {a: k for k, block in enumerate(blocks) for a in block.states}
        assert all(at[a] <= at[b] for b, a in graph.edges)
        for block in blocks:
            inside = set(block.states)
            acting = [i for i, (x, y) in enumerate(reached) if x & inside and y & inside]
            if block.system is None:
                assert not acting
                continue
            assert block.system.names == system.named(acting)
            assert block.system.time == "discrete"
            assert block.system.A == system.A.take(block.states, block.states)
            for k, i in enumerate(acting):
                assert block.system.B(k) == system.B(i).take(rows=block.states)
                assert block.system.C(k) == system.C(i).take(cols=block.states)


def test_a_chain_is_proved_block_by_block() -> None:
    found = fixed_spectrum(CHAIN)
    assert isinstance(found.evidence, ByBlocks)
    assert [block.states for block in found.evidence.blocks] == [(1,), (0,)]
    assert all(isinstance(block.evidence, KrylovSequence) for block in found.evidence.blocks)


# x, y → x + y, x + 2y: the digraph is strongly connected, and channel 2 still does not reach 1
HIDDEN = MultiChannelSystem(
    [[-1, 1], [-2, 2]], [[[1], [1]], [[1], [2]]], [[[2, -1]], [[-1, 1]]]
)  # fmt: skip


def test_a_plant_that_is_one_block_is_not_copied() -> None:
    for system in (HIDDEN, beside(HIDDEN)):
        [block] = state_blocks(system)
        assert block.system is system


def test_two_polynomials_serve_a_block_in_which_no_channel_sees_everything() -> None:
    assert len(state_blocks(HIDDEN)) == 1
    assert isinstance(fixed_spectrum(HIDDEN).evidence, TwoPolynomials)
    assert free_blocks(HIDDEN) is None
    both = beside(HIDDEN, CHAIN)
    found = fixed_spectrum(both)
    assert found.empty and isinstance(found.evidence, ByBlocks)
    kinds = {block.states: type(block.evidence) for block in found.evidence.blocks}
    assert kinds == {(0, 1): CoprimePolynomials, (2,): KrylovSequence, (3,): KrylovSequence}
    assert free_blocks(both) == found.evidence.blocks
    assert check_document(encode(found).encode()).verdict == "VALID"


def test_what_is_fixed_in_a_block_is_left_there() -> None:
    stuck = MultiChannelSystem([[3]], [[[0]]], [[[1]]])
    system = beside(HIDDEN, stuck)
    blocks = bounded_blocks(system)
    assert modes_left(blocks) == 2
    assert modes_left(completed_blocks(system, blocks)) == 1
    assert free_blocks(system) is None
    found = fixed_spectrum(system)
    assert isinstance(found.evidence, ByBlocks)
    assert [str(factor.polynomial) for factor in found.factors] == ["x - 3"]
    assert check_document(encode(found).encode()).verdict == "VALID"


def test_ranks_are_those_of_the_plant() -> None:
    # one mode in each of two blocks, and one column of the plant that is lost
    shift = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [0]]], [[[0, 0]]])
    assert len(state_blocks(shift)) == 2
    found = fixed_spectrum(shift)
    assert isinstance(found.evidence, TwoPolynomials)
    [factor] = found.factors
    assert (factor.rank, factor.multiplicity_at_most) == (1, 2)
    assert deficiency(shift).deficiency == 1


def test_drawn_systems_agree_with_enumeration_by_either_proof() -> None:
    for seed in range(40):
        proof, problems = tried(*drawn_pair(seed))
        assert proof and not problems
