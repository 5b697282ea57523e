"""A few plants of the campaign over every question."""

from __future__ import annotations

from collections import Counter

from tests.assurance.campaigns.every_question import DRAWN, examined


def test_drawn_plants_of_every_kind_are_decided_as_by_elimination_over_q() -> None:
    seen = Counter[str]()
    for number in range(6 * len(DRAWN)):
        wrong, counted = examined(number)
        assert not wrong, (number, wrong)
        seen.update(counted)
    assert all(seen[f"{kind} plants"] == 6 for kind in DRAWN)
    assert seen["indices with relations"] > 10
