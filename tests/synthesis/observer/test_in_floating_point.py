"""The observer in floating point: what comes out is certified, or nothing does."""

from fractions import Fraction
from typing import Any

import pytest

from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.errors import Impossible, InputError, LimitReached, UsageError
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis import gate
from mcexact.synthesis.distributed_observer import design_observer
from tests.assurance.campaigns.floating import drawn_designs
from tests.synthesis.three_channels import three_channels
from tests.wording import refusal

BOTH = {"1": ["2"], "2": ["1"]}


def assert_meets(design, system, bound):
    """The bound is certified, and met with room: no kernel errs by a tenth."""
    verdict = check_document(encode(design.loop.proof).encode())
    assert verdict.verdict == "VALID", verdict.line()
    loop = closed_loop(system, design.controller).matrix
    assert loop == design.loop.matrix
    faster = Fraction(11, 10) if system.time == "continuous" else Fraction(10, 11)
    region = StabilityRegion(system.time, Fraction(bound) * faster)
    assert region.contains_roots_of(characteristic_polynomial(loop))


@pytest.mark.parametrize("q", ["1", "2", "3"])
def test_the_example_is_designed_through_every_agent(q):
    plant = three_channels()
    design = design_observer(plant, agent=q, rate=1, arithmetic="float")
    assert_meets(design, plant, 1)
    assert design.parts["agent"] == q and design.controller.order == 18
    assert set(design.measures()) == {
        *("largest_gain", "spectral", "numerical", "distance_to_instability")
    }


def test_discrete_time_takes_a_radius():
    plant = three_channels("discrete")
    assert_meets(design_observer(plant, radius="1/2", arithmetic="float"), plant, "1/2")


def test_only_the_gains_are_rounded_and_all_of_them_are_dyadic():
    design = design_observer(three_channels(), agent="1", rate=1, arithmetic="float")
    for M in (
        *design.parts["feedback"],
        *design.parts["observer_gains"],
        design.parts["G"],
        design.parts["L"],
    ):
        assert M.denominator & (M.denominator - 1) == 0


def test_gains_from_outside_are_kept():
    plant = MultiChannelSystem([[1]], [[[1]], [[0]]], [[[0]], [[1]]], neighbors=BOTH)
    design = design_observer(plant, gains=[[[-4]], [[0]]], rate=2, arithmetic="float")
    assert_meets(design, plant, 2)
    assert design.parts["feedback"][0].numerators == ((-4,),)


def test_a_fast_mode_may_be_out_of_reach():
    plant = MultiChannelSystem(
        [[1, 0], [0, -5]], [[[1], [0]], [[0], [0]]], [[[0, 0]], [[1, 0]]], neighbors=BOTH
    )
    assert_meets(design_observer(plant, rate=1, arithmetic="float"), plant, 1)


@pytest.mark.parametrize(
    ("B", "C", "word"),
    [([[1], [0]], [[1, 1]], "control"), ([[1], [1]], [[1, 0]], "observe")],
)
def test_a_slow_mode_out_of_reach_is_a_refusal_with_a_certificate(B, C, word):
    plant = MultiChannelSystem([[2, 0], [0, 3]], [B], [C], neighbors={"1": []})
    with refusal(Impossible) as refused:
        design_observer(plant, rate=1, arithmetic="float")
    assert check_document(encode(refused.value.certificate).encode()).verdict == "VALID"


def test_agents_that_cannot_hear_of_each_other_are_a_refusal_for_these_gains():
    plant = MultiChannelSystem([[1]], [[[1]], [[0]]], [[[0]], [[1]]], neighbors={"1": [], "2": []})
    with refusal(Impossible) as refused:
        design_observer(plant, gains=[[[-4]], [[0]]], rate=1, arithmetic="float")
    assert check_document(encode(refused.value.certificate).encode()).verdict == "VALID"
    with pytest.raises(LimitReached, match="try another agent"):
        design_observer(plant, rate=1, arithmetic="float")


def test_a_spectrum_is_for_exact_arithmetic():
    with pytest.raises(UsageError, match="takes a rate or a radius"):
        design_observer(
            three_channels(),
            arithmetic="float",
            spectrum={"feedback": [-1] * 3, "error": [-1] * 11},
        )


@pytest.mark.parametrize("time", ["continuous", "discrete"])
@pytest.mark.parametrize(("q", "seen"), [("1", 5), ("2", 4), ("3", 4)])
def test_the_reduced_order_leaves_out_what_the_agent_sees(q, seen, time):
    plant = three_channels(time)
    bound = {"rate": 1} if time == "continuous" else {"radius": "1/2"}
    design = design_observer(plant, agent=q, order="least", arithmetic="float", **bound)
    assert design.parts["channel_order"] == 9 - seen and design.controller.order == 18 - seen
    assert_meets(design, plant, *bound.values())


def test_an_agent_that_sees_every_error_needs_no_channel_controller():
    plant = MultiChannelSystem([[2]], [[[1]]], [[[3]]], neighbors={"1": []})
    design = design_observer(plant, rate=1, order="least", arithmetic="float")
    assert design.parts["channel_order"] == 0
    assert_meets(design, plant, 1)


def test_the_arithmetic_has_two_names_and_every_agent_has_a_gain():
    with pytest.raises(UsageError, match='expected "exact" or "float"'):
        design_observer(three_channels(), rate=1, arithmetic="decimal")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="expected 3 gains"):
        design_observer(three_channels(), rate=1, gains=[], arithmetic="float")


def test_what_cannot_be_certified_is_not_returned(monkeypatch):
    def refuse(*_, **__):
        raise UsageError("Lyapunov matrices do not decide")

    monkeypatch.setattr(gate, "certify_stability", refuse)
    with pytest.raises(LimitReached, match="could be certified"):
        design_observer(three_channels(), rate=1, arithmetic="float")


@pytest.mark.parametrize("time", ["continuous", "discrete"])
@pytest.mark.parametrize(
    ("A", "B", "C", "neighbors"),
    [
        ([], [[]], [[]], {"1": []}),
        ([["1/3"]], [[["2/7"]]], [[["1/9"]]], {"1": []}),
        ([[3]], [[["1/100000000"]]], [[[1000000]]], {"1": []}),
        (
            [[0, 1], [0, 0]],
            [[[0], [1]], [[], []], [[0], [0]]],
            [[], [[1, 0]], [[0, 0]]],
            {"1": ["2"], "2": ["3"], "3": ["1"]},
        ),
    ],
    ids=["no states", "fractions", "scales apart", "channels without inputs or outputs"],
)
def test_plants_at_the_edge_are_designed_for(A, B, C, neighbors, time):
    plant = MultiChannelSystem(A, B, C, time=time, neighbors=neighbors)
    bound: dict[str, Any] = {"rate": "3/2"} if time == "continuous" else {"radius": "1/8"}
    design = design_observer(plant, arithmetic="float", **bound)
    assert_meets(design, plant, *bound.values())


def test_numbers_beyond_doubles_are_for_exact_arithmetic():
    plant = MultiChannelSystem([[10**400]], [[[1]]], [[[1]]], neighbors={"1": []})
    with refusal(LimitReached):
        design_observer(plant, rate=1, arithmetic="float")


def test_what_is_designed_for_drawn_plants_is_certified():
    seen = drawn_designs(8, 0)
    assert seen["VALID"] + seen["nothing found"] == 8
    assert seen["VALID"] > seen["nothing found"]
    assert seen["ring"] and seen["drawn graph"] and seen["discrete time"]
