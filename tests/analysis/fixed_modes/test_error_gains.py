"""Proposition 1: lists K_i, H_ij for the error system, or its obstruction."""

from __future__ import annotations

import pytest

from mcexact import MultiChannelSystem
from mcexact.answer.protocol import encode
from mcexact.answer.structure import StuckWitness
from mcexact.checker.kinds import check_document
from mcexact.errors import UsageError
from mcexact.exact.linear_algebra import minimal_polynomial
from mcexact.exact.matrix import Matrix, block
from mcexact.questions import error_gains
from tests.wording import says

PLANT = MultiChannelSystem(
    [[1, 0, 0], [0, 1, 0], [0, 1, 1]],
    [[[1], [0], [0]], [[0], [1], [0]], [[1], [0], [0]]],
    [[[1, 0, 0], [0, 0, 1]], [[0, 1, 0]], [[0, 1, 0]]],
    neighbors={"1": ["2"], "2": ["3"], "3": ["1"]},
)
F = [[[-1, 0, 0]], [[0, -2, -1]], [[0, 1, 0]]]


def test_the_lists_make_the_error_matrix_of_the_paper_cyclic() -> None:
    found = error_gains(PLANT, F)
    assert found.exists
    assert found.gains is not None
    assert [len(each) for each in found.gains] == [2, 2, 2]
    # E_ii = A + ΣBF + K_iC_i + ΣH_ij − B_iF_i, E_ij = −H_ij − B_jF_j for neighbors j.
    gains = [Matrix.from_rows(rows) for rows in F]
    driven = [PLANT.B(j) @ gains[j] for j in range(3)]
    whole = sum(driven, PLANT.A)
    rows = []
    for i in range(3):
        K, H = found.gains[i]
        j = PLANT.indices([PLANT.names[(i + 1) % 3]])[0]
        row = [-driven[k] for k in range(3)]
        row[i] = whole - driven[i] + K @ PLANT.C(i) + H
        row[j] = row[j] - H
        rows.append(row)
    assert minimal_polynomial(block(rows)).degree == 9
    assert found.indices is not None
    assert {control for control, _ in found.indices} == {3}
    verdict = check_document(encode(found.answer).encode())
    assert verdict.verdict == "VALID"
    assert "A_F cyclic" in verdict.statement


def test_without_arcs_the_plant_itself_may_connect_the_agents() -> None:
    plant = MultiChannelSystem([[0]], [[[1]]] * 2, [[[1]]] * 2, neighbors={"1": [], "2": []})
    assert error_gains(plant, [[[-1]], [[-1]]]).exists
    refused = error_gains(plant, [[[0]], [[0]]])
    assert not refused.exists
    verdict = check_document(encode(refused.answer).encode())
    assert verdict.verdict == "VALID"
    assert says(verdict.statement, "same make")


def test_a_plant_that_is_not_jointly_observable_is_refused_with_a_mode() -> None:
    plant = MultiChannelSystem(
        [[1, 0], [0, 2]],
        [[[1], [0]], [[0], [1]]],
        [[[1, 0]], [[1, 0]]],
        neighbors={"1": ["2"], "2": ["1"]},
    )
    found = error_gains(plant, [[[0, 0]], [[0, 0]]])
    assert not found.exists
    assert found.gains is None
    assert isinstance(found.answer.evidence, StuckWitness)
    assert str(found.answer.evidence.polynomial) == "x - 2"


def test_a_graph_is_needed() -> None:
    with pytest.raises(UsageError):
        error_gains(MultiChannelSystem([[0]], [[[1]]], [[[1]]]), [[[0]]])
