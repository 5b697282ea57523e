"""The comparison of drawn controllers with the certified bound, which does not use the package."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest

from benchmarks import costs
from mcexact.performance import CostBound, cost_bound


def test_no_drawn_controller_is_below_the_bound_which_is_near_the_best() -> None:
    for each in costs.examined(6, seed=1):
        assert each.plants == 2 and each.kinds.total() == 12
        assert not each.below and not each.unproved and each.least >= 1
        assert each.proposed < 1e-6 and each.certified < 0.03


def raised(bound: CostBound) -> CostBound:
    """A claim of a tenth more."""
    return replace(bound, cost=bound.cost * 11 / 10)


@pytest.mark.parametrize("family", range(3))
def test_a_bound_that_is_too_high_is_noticed(family: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(costs, "cost_bound", lambda *about: raised(cost_bound(*about)))
    refused = costs.Found()
    costs.examine(random.Random(3), family, refused)
    assert refused.unproved == 1
    monkeypatch.setattr(costs, "check", lambda *_: type("Verdict", (), {"verdict": "VALID"}))
    found = costs.Found()
    costs.examine(random.Random(3), family, found)
    assert found.below >= 1 and found.least < 1
