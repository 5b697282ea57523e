"""Starts of searches: what agents take for the whole, and starts that count as they are."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from mcexact.exact.roots import StabilityRegion
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.decentralized import design_decentralized
from mcexact.synthesis.networks import decentralized_network
from mcexact.synthesis.optimum import search
from mcexact.synthesis.optimum.descent import Target
from mcexact.synthesis.optimum.figures import MARGINS, Aims, figures_of, least_cost, shift_of
from mcexact.synthesis.optimum.problem import Effort, FeedbackProblem, Weights
from mcexact.synthesis.optimum.starts import local_regulators, localities
from tests.synthesis.optimum.plants import coupled


def sampled_string() -> MultiChannelSystem:
    """Two vehicles with gap, speed and actuator; each input moves also the gap behind, a little."""
    A = [
        [1, "-0.2", "-0.0176", 0, 0, 0],
        [0, 1, "0.1648", 0, 0, 0],
        [0, 0, "0.6703", 0, 0, 0],
        [0, "0.2", "0.0176", 1, "-0.2", "-0.0176"],
        [0, 0, 0, 0, 1, "0.1648"],
        [0, 0, 0, 0, 0, "0.6703"],
    ]
    B = [
        [["-0.0024"], ["0.0352"], ["0.3297"], ["0.0024"], [0], [0]],
        [[0], [0], [0], ["-0.0024"], ["0.0352"], ["0.3297"]],
    ]
    C = [[[int(j == i) for j in range(6)] for i in (first, first + 1)] for first in (0, 3)]
    return MultiChannelSystem(A, B, C, time="discrete")


def test_states_that_an_agent_hardly_drives_can_be_left_out() -> None:
    plant = sampled_string()
    weights = Weights.unit(plant)
    problem = FeedbackProblem.of(decentralized_network(plant), (0, 0), weights)
    assert [each.states for each in localities(problem, weights)] == [(0, 1, 2, 3), (3, 4, 5)]
    narrow = localities(problem, weights, much=True)
    assert [each.states for each in narrow] == [(0, 1, 2), (3, 4, 5)]
    shift = shift_of(StabilityRegion.of("discrete", radius="0.98"))
    K = local_regulators(problem, narrow, shift)
    assert figures_of(problem, K, peak=False).bound < 0.98


def test_a_start_inside_the_region_counts_as_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(search, "_finish", lambda *_: False)
    made = design_decentralized(sampled_string(), radius="0.98", aims=Aims(seeds=1, effort=0.2))
    assert made.parts["optimum"].step == "static gains"
    monkeypatch.setattr(search, "_as_it_is", lambda *_: [])
    made = design_decentralized(sampled_string(), radius="0.98", aims=Aims(seeds=1, effort=0.2))
    assert "optimum" not in made.parts


def test_drafts_that_seem_to_lead_to_the_same_optimum_are_followed_once():
    plant = coupled()
    weights = Weights.unit(plant)
    static, dynamic = (
        FeedbackProblem.of(decentralized_network(plant), orders, weights)
        for orders in ((0, 0, 0), (1, 1, 1))
    )
    drafts = [
        (value, search.Start("start", problem, np.zeros(problem.mask.shape)))
        for value, problem in [(2.0, static), (1.0, static), (1.0005, static), (1.0005, dynamic)]
    ]
    kept = search._different(drafts)
    assert [(value, draft.problem.order) for value, draft in kept] == [
        (1.0, 0),
        (1.0005, 3),
        (2.0, 0),
    ]


@pytest.mark.parametrize("size", [1, 100])
def test_the_cost_of_a_draft_is_compared_with_what_is_enough_in_the_same_unit(size: int) -> None:
    # Disturbances of this size make all costs larger by its square, and nothing else.
    plant = coupled()
    unit = Weights.unit(plant)
    weights = replace(unit, W=size**2 * unit.W, V=size**2 * unit.V)
    problem = FeedbackProblem.of(decentralized_network(plant), (0, 0, 0), weights)
    region = StabilityRegion.of("continuous", rate="1/2")
    least = least_cost(plant, weights)
    assert least is not None
    none: Any = None
    target = Target(region, least=least)
    ladder = search.Ladder(none, none, weights, target, 1.05 * least, Effort(1e5))
    start = search.Start("gains", problem, np.array(problem.gain(np.full(problem.size, -9.0))))
    value, draft = search._draft(ladder, start, 0.3)
    cost = figures_of(draft.problem, draft.K, peak=False).cost
    assert least <= value <= cost * (1 + 1e-9) and value > 0.5 * cost


def test_further_starts_are_drawn_only_where_the_cost_is_high() -> None:
    plant = MultiChannelSystem([[0, 1], [4, 0]], [[[0], [1]]], [[[1, 0]]])
    weights = Weights.unit(plant)
    network = decentralized_network(plant)
    problem = FeedbackProblem.of(network, (1,), weights)
    region = StabilityRegion.of("continuous", rate="1/10")
    least = least_cost(plant, weights)
    assert least is not None
    none: Any = None
    target = Target(region, 1e3, MARGINS, least)
    told = list[str]()
    ladder = search.Ladder(
        lambda orders: (network, (orders,) if isinstance(orders, int) else tuple(orders)),
        none, weights, target, 1.05 * least, Effort(4e3), tell=told.append,
    )  # fmt: skip
    K = np.array([[-60.0, 50.0], [10.0, -10.0]])
    dear = search.candidate_of(ladder, "gains", problem, K)
    assert dear is not None and dear.figures.cost > 2.1 * least
    more = search.drawn_further(ladder, [dear])
    assert more and min(each.figures.cost for each in more) < dear.figures.cost
    assert {each.problem.order for each in more} <= {1, 2}
    assert told and told[0].startswith("order 1 per agent, seed 1; so far")
    cheap = replace(dear, figures=replace(dear.figures, cost=least))
    assert search.drawn_further(ladder, [cheap]) == []
