"""From a controller that was found to more damping, a larger box, and the fastest rate."""

from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from mcexact import design_decentralized
from mcexact.exact.matrix import matrix_to_float
from mcexact.exact.roots import StabilityRegion
from mcexact.model.box import Box
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.assessment import assess
from mcexact.synthesis.gate import Request
from mcexact.synthesis.networks import decentralized_network
from mcexact.synthesis.optimum import continuation
from mcexact.synthesis.optimum.continuation import (
    box_part,
    eased,
    fastest,
    more_damped,
    sounder,
    with_larger_box,
    with_margins,
)
from mcexact.synthesis.optimum.descent import Target
from mcexact.synthesis.optimum.figures import (
    MARGINS,
    Aims,
    Limits,
    Margins,
    figures_of,
    least_cost,
)
from mcexact.synthesis.optimum.problem import Effort, FeedbackProblem, Weights
from mcexact.synthesis.optimum.proposals import Family, optimum
from mcexact.synthesis.optimum.search import Candidate, Ladder, candidate_of
from mcexact.synthesis.robustness import every_loop
from tests.wording import says, worded

SPRING = MultiChannelSystem(
    [[0, 1], [-1, "-1/100"]], [[[0], ["1/2"]]], [[[1, 0], [0, 1]]], time="continuous"
)
"""A mass on a spring, hardly damped, with its position and its speed measured."""
DOUBLE = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
LEAD = [[-21.0, 20.0], [10.0, -10.0]]
"""−(1 + 20 s/(s + 10)), which damps it."""


def found(plant: MultiChannelSystem, K: Any, orders: tuple[int, ...] = (0,), rate: Any = "1/1000"):
    """A ladder for a slow rate, and the candidate of some gains."""
    weights = Weights.unit(plant)
    problem = FeedbackProblem.of(decentralized_network(plant), orders, weights)
    region = StabilityRegion.of(plant.time, bound=rate)
    target = Target(region, 100.0, MARGINS, least_cost(plant, weights) or 1.0)
    none: Any = None
    ladder = Ladder(none, none, weights, target, 1.0, Effort(2e4), brisk=region)
    candidate = candidate_of(ladder, "gains", problem, np.array(K, dtype=float))
    assert candidate is not None
    return ladder, candidate


def test_damping_that_costs_little_is_taken_and_what_costs_much_is_told() -> None:
    ladder, slow = found(SPRING, [[0.0, -0.02]])
    assert slow.figures.damping < 0.07
    taken = more_damped(ladder, slow)
    assert taken.candidate.figures.damping >= 0.07 and not taken.notes
    assert taken.candidate.figures.cost <= 1.15 * slow.figures.cost
    cheap = replace(slow, figures=replace(slow.figures, cost=slow.figures.cost / 100))
    kept = more_damped(ladder, cheap)
    assert kept.candidate is cheap
    [note] = kept.notes
    assert says(note, "damping ratio") and "0.07" in note and "computed" in note


@pytest.mark.parametrize(("reached", "taken"), [(0.058, True), (0.045, False)])
def test_a_smaller_damping_ratio_is_better_than_none(
    monkeypatch: pytest.MonkeyPatch, reached: float, taken: bool
) -> None:
    ladder, slow = found(SPRING, [[0.0, -0.02]])
    other = replace(slow, figures=replace(slow.figures, damping=reached))
    monkeypatch.setattr(continuation, "followed", lambda *_: other)
    improved = more_damped(ladder, slow)
    assert improved.candidate is (other if taken else slow)
    assert worded(improved.notes)
    dear = replace(other, figures=replace(other.figures, cost=2 * slow.figures.cost))
    monkeypatch.setattr(continuation, "followed", lambda *_: dear)
    assert more_damped(ladder, slow).candidate is slow


def test_a_damped_loop_is_left_alone() -> None:
    ladder, calm = found(DOUBLE, LEAD, (1,))
    before = ladder.effort.spent
    assert calm.figures.damping >= 0.07
    assert more_damped(ladder, calm).candidate is calm and ladder.effort.spent == before


TWICE = MultiChannelSystem([[1]], [[[1]]], [[[1], [1]]])
"""Two sensors of the same state, whose gains can nearly cancel."""
STABLE = MultiChannelSystem([[-1]], [[[1]]], [[[1]]])


def test_all_outputs_together_get_a_margin_and_what_costs_much_is_told() -> None:
    ladder, weak = found(TWICE, [[-5.0, 3.0]])
    limits = replace(MARGINS, together=0.2)
    assert Margins(weak.problem, weak.K).peaks(limits).together < 0.2
    taken, then = sounder(ladder, weak)
    assert taken.candidate.peaks.together >= 0.2 and not taken.notes
    assert then.target.limits == limits
    cheap = replace(weak, figures=replace(weak.figures, cost=weak.figures.cost / 100))
    kept, then = sounder(ladder, cheap)
    assert kept.candidate is cheap and then is ladder
    [note] = kept.notes
    told = "a disk margin of 0.2 of all inputs, and of all outputs, together would cost "
    assert note.startswith(told) and note.endswith(" % more (computed)")


def test_a_loop_is_made_no_slower_than_the_plant() -> None:
    ladder, slow = found(STABLE, [[0.5]])
    assert slow.figures.bound > -0.99
    taken, then = sounder(ladder, slow)
    assert taken.candidate.figures.bound <= -0.99 and str(then.target.region) == "Re λ < -1"
    assert taken.candidate.figures.cost <= 1.15 * slow.figures.cost
    cheap = replace(slow, figures=replace(slow.figures, cost=slow.figures.cost / 100))
    [note] = sounder(ladder, cheap)[0].notes
    assert says(note, "slower would")


def test_a_sound_loop_is_left_alone() -> None:
    for plant, K in ((STABLE, [[-0.4]]), (TWICE, [[-2.0, -2.0]])):
        ladder, sound = found(plant, K)
        kept, then = sounder(ladder, sound)
        assert np.array_equal(kept.candidate.K, sound.K) and not kept.notes
        assert then.target.limits.together == 0.2 and ladder.effort.spent == 0


def test_the_seeming_box_is_one_that_can_be_proved() -> None:
    _, candidate = found(SPRING, [[0.0, -1.0]])
    part = box_part(candidate)
    assert part is not None and 0.05 < part < 1
    design = design_decentralized(SPRING, rate="1/5", aims=Aims(effort=1))
    known = every_loop(design.loop.closed, design.region)
    assert known.part is not None and known.failing is not None
    seen = box_part(_candidate_of(design))
    assert seen is not None and seen <= known.failing.distance
    assert known.part <= 1.2 * seen


def _candidate_of(design: Any) -> Candidate:
    optimum = design.parts["optimum"]
    return Candidate("", optimum.problem, optimum.K, optimum.figures, optimum.peaks)


def test_the_box_of_a_plant_with_radii_is_a_part_of_these() -> None:
    _, candidate = found(SPRING, [[0.0, -1.0]])
    whole = box_part(candidate)
    boxed = decentralized_network(Box.relative(SPRING, Fraction(1, 100)).system)
    own = box_part(replace(candidate, problem=replace(candidate.problem, network=boxed)))
    assert whole is not None and own == pytest.approx(100 * whole, rel=1e-6)


def test_radii_are_aimed_at_whatever_it_costs() -> None:
    boxed = Box.relative(SPRING, Fraction(1, 20)).system
    ladder, slow = found(boxed, [[0.0, -0.02]])
    small = box_part(slow)
    assert small is not None and small < 1
    wide = with_larger_box(ladder, slow, None, np.inf)
    reached = box_part(wide.candidate)
    assert reached is not None and reached >= 1 and not wide.notes


def test_faster_loops_have_a_larger_box_and_the_box_is_reached_if_it_may_cost() -> None:
    ladder, slow = found(SPRING, [[0.0, -0.02]])
    small = box_part(slow)
    assert small is not None and small < 0.05
    wide = with_larger_box(ladder, slow, Fraction(1, 20), np.inf)
    reached = box_part(wide.candidate)
    assert reached is not None and reached >= 0.05 and not wide.notes
    cheap = replace(slow, figures=replace(slow.figures, cost=slow.figures.cost / 100))
    dear = with_larger_box(ladder, cheap, Fraction(1, 20))
    assert dear.candidate is cheap and len(dear.notes) == 1
    assert "computed" in dear.notes[0]


def test_of_a_box_that_is_not_reached_as_much_is_taken_as_was_found() -> None:
    ladder, slow = found(SPRING, [[0.0, -0.02]])
    small = box_part(slow)
    asked = with_larger_box(ladder, slow, Fraction(9, 10), np.inf)
    reached = box_part(asked.candidate)
    assert small is not None and reached is not None and 3 * small < reached < 0.9
    (note,) = asked.notes
    assert f"within about {100 * reached:.2g} % of each entry: no loop for 90 %" in note
    assert asked.candidate.peaks.keep(MARGINS) or not slow.peaks.keep(MARGINS)
    # Where nobody asked, the cheapest loop stays.
    unasked = with_larger_box(ladder, slow, Fraction(9, 10))
    assert unasked.candidate is slow or not unasked.notes


def test_costs_at_corners_of_a_box_make_it_larger_where_faster_loops_may_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ladder, slow = found(TWICE, [[-5.0, 3.0]])
    aimed = Fraction(1, 4)
    loops = [*continuation._loops_of_members(ladder, slow, aimed)]
    reached = [box_part(each) or 0.0 for each in loops]
    assert (box_part(slow) or 0.0) < 0.5 * float(aimed) <= float(aimed) <= max(reached)
    assert sorted(reached) == reached
    monkeypatch.setattr(continuation, "_faster_loops", lambda *_: iter(()))
    wide = with_larger_box(ladder, slow, aimed, np.inf)
    assert (box_part(wide.candidate) or 0.0) >= aimed and not wide.notes
    assert wide.candidate.peaks.keep(MARGINS)


@pytest.mark.parametrize("rate", ["1/5", 50])
def test_the_fastest_loop_keeps_its_margins_and_faster_ones_fail(rate: Any) -> None:
    ladder, start = found(DOUBLE, LEAD, (1,))
    asked = StabilityRegion.of("continuous", rate=rate)
    assert start.peaks.keep(MARGINS)
    reached = fastest(ladder, start, asked)
    assert reached is not None
    best, region = reached
    assert best.peaks.keep(MARGINS) and best.figures.bound < -float(region.edge)
    assert region == asked if rate == "1/5" else region.edge < asked.edge


def test_a_loop_without_margins_has_no_fastest_rate_with_them() -> None:
    ladder, start = found(DOUBLE, LEAD, (1,))
    hard = replace(ladder, target=replace(ladder.target, limits=Limits(1.9, 5.0)))
    assert fastest(hard, start, StabilityRegion.of("continuous", rate=1)) is None


def test_a_rate_that_no_loop_with_margins_has_is_answered_with_the_fastest_that_one_has() -> None:
    asked, told = 8, list[str]()
    design = design_decentralized(
        DOUBLE, rate=asked, aims=Aims(effort=4, disk=0.9), progress=told.append
    )
    optimum = design.parts["optimum"]
    assert design.stable and optimum.peaks.keep(Limits(0.9, 0.3))
    [note] = design.notes
    assert "a search, not a proof" in note and f"Re λ < -{asked}" in note
    assert design.region.edge < asked
    said = assess(design)
    assert said.install == "with care" and says(said.verdict, "place")
    assert any(each.startswith("a slower rate, for the margins") for each in told)
    values = np.linalg.eigvals(matrix_to_float(design.loop.matrix))
    assert np.max(values.real) < -float(design.region.edge)
    assert figures_of(optimum.problem, optimum.K, peak=False).bound == optimum.figures.bound


def test_margins_that_a_search_missed_are_insisted_on() -> None:
    ladder, fragile = found(DOUBLE, [[-3.0, 20.0], [1.0, -10.0]], (1,))
    assert fragile.peaks.margin < 0.3
    insisted = with_margins(ladder, [fragile])
    assert any(each.peaks.keep(MARGINS) for each in insisted)
    assert min(each.figures.cost for each in insisted) > 0


def test_a_rate_that_nobody_asked_for_gives_way_to_the_margins() -> None:
    turning = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, "-1/2"]]])
    quick = [[-800.0, 343.0], [1000.0, -430.0]]  # three eigenvalues of -10, and a zero of 2
    ladder, fragile = found(turning, quick, (1,), rate=8)
    assert not fragile.peaks.keep(MARGINS)
    reached = eased(ladder, [fragile])
    assert reached is not None
    region, [best, *_] = reached
    assert region.edge < 8 and best.peaks.keep(MARGINS)
    assert best.figures.bound < -float(region.edge)
    assert eased(replace(ladder, effort=Effort(0)), [fragile]) is None


def test_a_search_says_which_rate_gave_way_to_the_margins() -> None:
    request = Request.of(DOUBLE, rate=8, arithmetic="float")
    asked = replace(request, brisk=request.region)
    result = optimum(Family(decentralized_network(DOUBLE)), asked, Aims(effort=2, disk=0.9))
    assert result.peaks.keep(Limits(0.9, 0.3)) and result.asked is None
    assert result.region is not None and result.region.edge < 8
    note = result.notes[0]
    assert says(note, "disk margin") and "0.9" in note
    assert f"{result.region} was taken" in note
    assert result.figures.bound < -float(result.region.edge)
