"""The transfer graph of sparse systems, beside the one that dense matrices give."""

from __future__ import annotations

import random
from collections import Counter

import pytest

from mcexact.analysis import fixed_modes as completeness_module
from mcexact.analysis import sparse
from mcexact.analysis import structure as graph_module
from mcexact.analysis.fixed_modes import completeness
from mcexact.analysis.sparse import edge_modulus, reachable_pairs
from mcexact.analysis.structure import transfer_graph
from mcexact.answer.modes import BlocksWitness, PathCutWitness
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.errors import LimitReached
from mcexact.model.system import MultiChannelSystem
from tests.oracle.draws import exact, sparse_system
from tests.oracle.planted import planted
from tests.wording import refusal


@pytest.fixture
def by_structure(monkeypatch: pytest.MonkeyPatch) -> pytest.MonkeyPatch:
    """Small systems get the evidence of large ones."""
    for module in (graph_module, completeness_module):
        monkeypatch.setattr(module, "is_large_and_sparse", lambda system: True)
    return monkeypatch


def valid(answer: object) -> bool:
    return check_document(encode(answer).encode()).verdict == "VALID"  # type: ignore[arg-type]


def test_the_structure_gives_the_same_graph(monkeypatch: pytest.MonkeyPatch) -> None:
    counted: Counter[str] = Counter()
    for number in range(150):
        system = exact(sparse_system(random.Random(number)))
        expected, complete = transfer_graph(system), completeness(system)
        with monkeypatch.context() as patched:
            for module in (graph_module, completeness_module):
                patched.setattr(module, "is_large_and_sparse", lambda system: True)
            found, answer = transfer_graph(system), completeness(system)
        assert found.claim() == expected.claim()
        assert answer.claim() == complete.claim()
        assert valid(found)
        assert valid(answer)
        if len(expected.arcs) < system.m**2:
            counted["zeros" if found.zeros else "paths"] += 1
        counted["cuts"] += isinstance(answer.evidence, PathCutWitness)
        if answer.complete and isinstance(answer.evidence, BlocksWitness):
            counted["small moduli"] += answer.evidence.modulus < 100
    assert counted["paths"] > 50 > counted["zeros"] > 1, counted
    assert counted["small moduli"] > 5, counted
    assert counted["cuts"] > 5, counted


def test_terms_that_cancel_need_a_zero_transfer(by_structure: pytest.MonkeyPatch) -> None:
    system = MultiChannelSystem([[0, 0], [0, 0]], [[[1], [-1]]], [[[1, 1]]])
    assert reachable_pairs(system).all()
    found = transfer_graph(system)
    assert found.arcs == ()
    assert len(found.zeros) == 1
    assert valid(found)


def test_a_modulus_divides_no_denominator_and_keeps_sums_exact() -> None:
    assert edge_modulus(MultiChannelSystem([["1/31"]], [[[1]]], [[[1]]])) == 61
    assert edge_modulus(MultiChannelSystem([["1/31"]], [[["1/61"]]], [[["1/53"]]])) is None
    found = transfer_graph(MultiChannelSystem([["1/31"]], [[["1/61"]]], [[["1/53"]]]))
    assert found.arcs == (("1", "1"),)


@pytest.mark.parametrize("ports", [([[[]]], [[[1]]]), ([[[1]]], [[]])])
def test_channels_without_inputs_or_outputs(
    ports: tuple[object, object], by_structure: pytest.MonkeyPatch
) -> None:
    B, C = ports
    found = transfer_graph(MultiChannelSystem([[0]], B, C))  # type: ignore[arg-type]
    assert found.arcs == ()
    assert valid(found)


def test_no_states(by_structure: pytest.MonkeyPatch) -> None:
    found = transfer_graph(MultiChannelSystem([], [[], []], [[[]], [[]]]))
    assert found.arcs == ()
    assert valid(found)


def test_a_sparse_system_of_400_states() -> None:
    system = planted(400, 40, 1)
    found = transfer_graph(system)
    assert found.strongly_connected
    assert (found.modulus, found.zeros) == (7, ())
    assert valid(found)


def test_too_many_channels_are_said(by_structure: pytest.MonkeyPatch) -> None:
    by_structure.setattr(sparse, "_MOST_NUMBERS", 100)
    with refusal(LimitReached):
        transfer_graph(planted(60, 6, 1))


def test_a_search_that_ends_early_leaves_the_decision_to_dense_matrices(
    by_structure: pytest.MonkeyPatch,
) -> None:
    by_structure.setattr(sparse, "_MOST_PRODUCTS", 0)
    n = 4
    A = [[int(i == j + 1) for j in range(n)] for i in range(n)]
    found = transfer_graph(
        MultiChannelSystem(A, [[[1]] + [[0]] * (n - 1)], [[[0] * (n - 1) + [1]]])
    )
    assert found.arcs == (("1", "1"),)
    assert valid(found)
