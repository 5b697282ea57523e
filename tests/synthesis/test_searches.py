"""What is asked of a search: rates that are chosen, rates out of reach, and the limits of gains."""

from __future__ import annotations

import itertools
import re
import time
from collections.abc import Iterator
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np
import pytest
from scipy.linalg import solve_continuous_are, solve_discrete_are

from mcexact.errors import Impossible, InputError, LimitReached, OutOfReach, UsageError
from mcexact.exact.matrix import matrix_to_float
from mcexact.exact.roots import StabilityRegion
from mcexact.model import gallery
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis import distributed_observer, rate, setpoint
from mcexact.synthesis.decentralized import design_decentralized, design_extended
from mcexact.synthesis.distributed_observer import design_observer
from mcexact.synthesis.gate import Proposal, Warned
from mcexact.synthesis.optimum import proposals
from mcexact.synthesis.optimum.diagnosis import diagnosed
from mcexact.synthesis.optimum.figures import MARGINS, THEOREM, Aims, least_cost
from mcexact.synthesis.optimum.problem import Weights
from mcexact.synthesis.rate import request_for
from mcexact.synthesis.setpoint import design_setpoint
from tests.synthesis.optimum.plants import coupled
from tests.synthesis.test_setpoint import two_tanks
from tests.wording import says

POSITION = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
NEARLY_FIXED = MultiChannelSystem([[1, 0], [0, -1]], [[[1], ["1e-7"]]], [[[1, 1]]])
"""A stable mode that the input hardly moves."""


@pytest.mark.parametrize("plant", [coupled(), gallery.load("compleib-dis5")], ids=str)
def test_without_a_rate_the_loop_is_as_fast_as_a_tenth_of_what_is_sensible_or_of_feedback(
    plant: MultiChannelSystem,
) -> None:
    request = request_for(plant)
    [note] = request.notes
    assert request.brisk is not None
    known = diagnosed(plant, request.brisk)
    assert known.is_sensible and known.sensible is not None
    pace = np.log if request.region.discrete else float
    sensible, slowest, brisk = (
        float(pace(float(each.edge))) for each in (known.sensible, request.region, request.brisk)
    )
    assert sensible / brisk == pytest.approx(2, rel=0.15)
    A, B = matrix_to_float(plant.A), matrix_to_float(plant.input_matrix())
    weights = np.eye(len(A)), np.eye(B.shape[1])
    if request.region.discrete:
        P = solve_discrete_are(A, B, *weights)
        F = np.linalg.solve(weights[1] + B.T @ P @ B, B.T @ P @ A)
        rate = np.log(np.max(np.abs(np.linalg.eigvals(A - B @ F))))
    else:
        P = solve_continuous_are(A, B, *weights)
        rate = -np.max(np.linalg.eigvals(A - B @ B.T @ P).real)
    smaller = min(sensible / 10, rate / 2, key=abs)
    assert slowest == pytest.approx(smaller, rel=0.15)
    assert f"{request.region.edge}, " in note and says(note, "search minimized")


def test_a_chosen_radius_is_not_nearly_zero() -> None:
    """All agents together can bring this plant to rest within few steps."""
    request = request_for(gallery.load("movable-by-periodic-gains"))
    assert request.brisk is not None
    assert request.region.edge > request.brisk.edge == Fraction(1, 10)


def test_without_a_rate_the_cost_is_less_than_with_the_rate_of_before_and_the_margins_are_kept():
    plant = gallery.load("compleib-dis5")
    request = request_for(plant)
    least = design_decentralized(plant, aims=Aims(effort=2)).parts["optimum"]
    fast = design_decentralized(plant, radius=request.brisk.edge, aims=Aims(effort=2))
    assert least.figures.cost < 0.8 * fast.parts["optimum"].figures.cost
    assert least.peaks.keep(MARGINS)
    bound = least_cost(plant, Weights.unit(plant))
    assert bound is not None and bound <= least.figures.cost <= 1.3 * bound


@pytest.mark.parametrize(("time", "mode"), [("continuous", "-1/50"), ("discrete", "0.99")])
def test_a_chosen_rate_is_slow_enough_for_stable_fixed_modes(time, mode) -> None:
    # One agent moves the slow mode and the other one sees it.
    plant = MultiChannelSystem(
        [[2, 0], [0, mode]], [[[1], [1]], [[0], [0]]], [[[1, 0]], [[0, 1]]], time=time
    )
    design = design_decentralized(plant, aims=Aims(effort=2))
    assert says(design.notes[0], "slow enough")
    proved: Any = design.certificates["fixed_spectrum"]
    assert not proved.outside(design.region)


def test_without_a_rate_what_is_impossible_is_refused_with_a_proof() -> None:
    with pytest.raises(Impossible) as refused:
        design_decentralized(MultiChannelSystem([[1]], [[[0]]], [[[1]]]))
    assert refused.value.certificate.kind == "fixed_spectrum"


def test_a_spectrum_is_placed_exactly_without_a_search() -> None:
    design = design_decentralized(POSITION, spectrum=[-1, -2, -3], aims=Aims(margin=0.5))
    assert "optimum" not in design.parts and design.loop.polynomial is not None
    assert not design.notes


def test_a_rate_in_exact_arithmetic_takes_the_search_too() -> None:
    design = design_decentralized(POSITION, rate="1/2")
    assert design.parts["optimum"].digits <= 4
    assert design.controller.bit_length() <= 47


def test_a_named_agent_gets_the_controller_of_the_theorem() -> None:
    [block] = design_decentralized(POSITION, agent="1", rate="1/2").parts["blocks"]
    assert block.agent == "1"


def test_what_is_out_of_reach_for_all_agents_together_is_said_before_any_search() -> None:
    told: list[str] = []
    with pytest.raises(OutOfReach, match=r"mode -1: a relative change of .* fixes it; sensible"):
        design_decentralized(NEARLY_FIXED, rate=2, progress=told.append)
    assert told == ["fixed modes", "diagnosis"]
    # With an effort it is searched all the same, and warned of.
    design_decentralized(NEARLY_FIXED, rate=2, aims=Aims(effort=1), progress=told.append)
    assert [type(each) for each in told if "hard" in each] == [Warned]


def test_out_of_reach_is_not_said_of_plants_that_are_fragile_at_every_rate() -> None:
    # Hardly observable: every controller is fragile, and a slower one as well.
    plant = MultiChannelSystem([[2, 1], [0, 1]], [[[1], [0]], [[0], [1]]], [[[1, 1]], [[1, 2]]])
    known = diagnosed(plant, StabilityRegion.of("continuous", rate="1/10"))
    assert not known.is_out_of_reach


def test_a_search_that_finds_nothing_ends_with_the_controller_of_the_theorem() -> None:
    effort = Aims(effort=1e-6)
    design = design_decentralized(coupled(), rate="1/2", arithmetic="float", aims=effort)
    assert "blocks" in design.parts and "diagnosis" in design.parts
    shared = design_extended(coupled(), rate="1/2", aims=effort)
    assert "blocks" in shared.parts
    with pytest.raises(LimitReached, match="sensible rate"):
        design_decentralized(coupled(), rate="1/2", aims=Aims(effort=1e-6, digits=3))


def nothing(*_: object, **__: object) -> Iterator[Proposal]:
    """Proposals of a method that finds none."""
    raise LimitReached("nothing was drawn")
    yield


@pytest.mark.parametrize(
    ("module", "name", "design"),
    [
        (proposals, "network_proposals", partial(design_decentralized, POSITION, aims=THEOREM)),
        (setpoint, "observers", partial(design_setpoint, two_tanks(), method="observer")),
        (distributed_observer, "observers", partial(design_observer, two_tanks())),
    ],
    ids=["decentralized", "setpoint", "observer"],
)
def test_a_limit_of_a_theorem_tells_the_diagnosis_too(module, name, design, monkeypatch) -> None:
    monkeypatch.setattr(module, name, nothing)
    told = r"nothing was drawn; (mode .*: a relative change of .*; )?sensible rate .*\(computed\)"
    with pytest.raises(LimitReached, match=told):
        design(rate="1/2")


@pytest.mark.parametrize("digits", [1, 2])
def test_no_gain_has_more_digits_than_asked_for(digits) -> None:
    design = design_decentralized(coupled(), rate="1/2", aims=Aims(effort=2, digits=digits))
    for M in design.controller.matrices():
        for x in (abs(x) for row in M.rows() for x in row if x):
            assert float(f"{float(x):.{digits - 1}e}") == float(x)


def test_no_agent_has_more_states_than_asked_for() -> None:
    design = design_decentralized(coupled(), rate="1/2", aims=Aims(effort=2, largest_order=0))
    assert design.order == 0
    with pytest.raises(LimitReached):  # only the position is measured
        design_decentralized(POSITION, rate="1/2", aims=Aims(effort=2, largest_order=0))


def test_smaller_gains_are_found_where_they_are_asked_for() -> None:
    free, low = (
        design_decentralized(coupled(), rate="1/2", aims=Aims(effort=2, largest_gain=largest))
        for largest in (None, 1.0)
    )
    assert low.controller.largest_entry() < free.controller.largest_entry()
    assert low.controller.largest_entry() < 1.5


def test_expensive_inputs_are_used_less() -> None:
    dear, cheap = (
        design_decentralized(coupled(), rate="1/10", aims=Aims({"R": r}, effort=2))
        for r in (100 * np.eye(3), np.eye(3) / 100)
    )
    assert dear.controller.largest_entry() < cheap.controller.largest_entry()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"margin": 0}, "margin: expected a number above 0"),
        ({"digits": 0}, "digits: expected an integer of at least 1"),
        ({"largest_order": -1}, "largest_order: expected an integer of at least 0"),
        ({"largest_gain": 0}, "largest_gain: expected a number above 0"),
        ({"effort": -1}, "effort: expected a number of seconds"),
        ({"seeds": 0}, "seeds: expected an integer"),
    ],
)
def test_aims_out_of_range_are_refused(given, message) -> None:
    with pytest.raises(UsageError, match=message):
        Aims(**given)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"S": [[1]]}, "weights.S: expected one of Q, R, W, V"),
        ({"Q": [[1, 0]]}, r"weights.Q: expected a 2 × 2 matrix"),
        ({"Q": [[1, 2], [0, 1]]}, "weights.Q: expected a symmetric matrix"),
        ({"W": [[1, 0], [0, -1]]}, "weights.W: expected a positive semidefinite"),
        ({"V": [[0]]}, "weights.V: expected a positive definite"),
        ({"R": "1"}, "weights.R: expected a list of rows"),
    ],
)
def test_weights_that_are_none_are_refused(given, message) -> None:
    with pytest.raises(InputError, match=message):
        Weights.of(POSITION, given)


def test_weights_may_be_exact_floats_or_arrays() -> None:
    for V in ([["1/4"]], [[0.25]], np.array([[0.25]])):
        assert Weights.of(POSITION, {"V": V}).V.tolist() == [[0.25]]


def test_set_points_are_held_without_messages_where_that_suffices() -> None:
    design = design_setpoint(two_tanks(), rate="1/2", aims=Aims(effort=2))
    assert design.method == "decentralized" and not design.controller.edges()
    observer = design_setpoint(two_tanks(), rate="1/2", aims=THEOREM)
    assert observer.method == "observer" and observer.order > design.order


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_stability_alone_has_the_sensible_rate_of_a_rate(time: str) -> None:
    plant = MultiChannelSystem([[0, 1], ["1/2", 0]], [[[0], [1]]], [[[1, 0]]], time=time)
    stable = diagnosed(plant, StabilityRegion(time))
    asked = diagnosed(plant, stable.sensible or StabilityRegion(time))
    assert stable.sensible is not None and stable.sensible.edge != stable.region.edge
    assert asked.is_sensible


def test_set_points_are_held_without_a_graph_as_with_an_empty_one() -> None:
    tanks = two_tanks().with_neighbors(None)
    design = design_setpoint(tanks, rate="1/100")
    assert design.method == "decentralized" and not design.controller.edges()
    assert design.loop.closed.plant.neighbors is None


def test_a_search_whose_time_is_over_ends_with_the_best_controller_so_far(monkeypatch) -> None:
    plant, whole, short = gallery.load("compleib-dis2"), list[str](), list[str]()
    design_decentralized(plant, aims=Aims(effort=4), progress=whole.append)
    ticks = itertools.count()
    monkeypatch.setattr(time, "monotonic", lambda: float(next(ticks)))
    design = design_decentralized(plant, aims=Aims(effort=4, seconds=150), progress=short.append)
    assert design.stable and "optimum" in design.parts
    searched = [each for each in short if each in whole and each.startswith(("static", "order"))]
    assert 0 < len(searched) < len([each for each in whole if each.startswith(("static", "order"))])


def test_the_choice_of_a_rate_takes_from_the_time_of_a_search(monkeypatch) -> None:
    ticks = itertools.count()

    def slowly(*_: Any) -> None:
        next(itertools.islice(ticks, 100, None))

    monkeypatch.setattr(time, "monotonic", lambda: float(next(ticks)))
    monkeypatch.setattr(rate, "chosen_regions", slowly)
    asked = request_for(gallery.load("compleib-dis2"), aims=Aims(seconds=150))
    assert asked.deadline is not None and asked.deadline <= 151 < next(ticks) + 150


def test_progress_says_what_the_best_controller_costs_and_its_margins() -> None:
    told = list[str]()
    design_decentralized(gallery.load("compleib-dis2"), aims=Aims(effort=4), progress=told.append)
    costs = [re.search("so far (.+) times the bound, disk margin (.+) and (.+) together", each)
             for each in told if each.startswith("order")]  # fmt: skip
    assert costs and all(each is not None and float(each[1]) >= 1 for each in costs)
