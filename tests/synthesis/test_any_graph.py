"""What an observer over any directed graph leaves: a sample of the campaign."""

from __future__ import annotations

import pytest

from tests.assurance.campaigns.any_graph import closed_sets, examined


@pytest.mark.parametrize("number", range(4))
def test_modes_over_any_graph_are_those_of_closed_sets(number: int) -> None:
    wrong, seen = examined(number)
    assert wrong == [] and seen["certificates"] == 2


def test_a_closed_set_receives_nothing_from_outside() -> None:
    assert closed_sets([[0], [0, 1], [1, 2]]) == [(), (0,), (0, 1), (0, 1, 2)]
