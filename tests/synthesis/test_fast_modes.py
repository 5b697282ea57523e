"""Modes that are fast enough stay where they are; slow ones that nothing moves are refused."""

from fractions import Fraction
from typing import Any

import pytest

from mcexact.answer.protocol import encode
from mcexact.checker.kinds import Expectation, check_document
from mcexact.errors import Impossible
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.distributed_observer import design_observer
from mcexact.synthesis.state_feedback import feedback_for_region, observable_part

FAST: dict[str, Any] = {"continuous": -5, "discrete": Fraction(1, 10)}
BOUND: dict[str, Any] = {"continuous": {"rate": 2}, "discrete": {"radius": Fraction(1, 2)}}
PAIR = {"1": ["2"], "2": ["1"]}


def plant(time, B, C, last=None):
    """A mode at 1, driven and seen, and a fast one at the end, coupled to it."""
    slow = FAST[time] if last is None else last
    return MultiChannelSystem([[1, 0], [0, slow]], [B, B], [C, C], time=time, neighbors=PAIR)


UNSEEN = ([[1], [1]], [[1, 0]])
UNMOVED = ([[1], [0]], [[1, 1]])
NEITHER = ([[1], [0]], [[1, 0]])


@pytest.mark.parametrize("time", ["continuous", "discrete"])
@pytest.mark.parametrize("ports", [UNSEEN, UNMOVED, NEITHER])
def test_a_fast_mode_that_is_not_seen_or_not_moved_is_left_alone(time, ports):
    system = plant(time, *ports)
    design = design_observer(system, **BOUND[time])
    chi = characteristic_polynomial(design.loop.matrix)
    assert Polynomial.of(-FAST[time], 1).divides(chi)
    (bound,) = BOUND[time].values()
    assert StabilityRegion(time, Fraction(bound)).contains_roots_of(chi)
    verdict = check_document(encode(design.loop.proof).encode())
    assert verdict.verdict == "VALID", verdict.line()
    assert design.parts["estimated"].ncols == 2
    assert {agent.shared for agent in design.controller.agents} == {design.parts["estimated"].nrows}


@pytest.mark.parametrize("time", ["continuous", "discrete"])
@pytest.mark.parametrize("ports", [UNSEEN, UNMOVED])
def test_a_mode_that_is_too_slow_is_refused_with_its_certificate(time, ports):
    B, C = ports
    system = plant(time, B, C, last=-2 if time == "continuous" else Fraction(1, 2))
    with pytest.raises(Impossible) as caught:
        design_observer(system, **BOUND[time])
    verdict = check_document(encode(caught.value.certificate).encode())
    assert verdict.verdict == "VALID" and "not controllable" in verdict.statement


@pytest.mark.parametrize(
    ("B", "C", "kind"),
    [
        ([[[0], [1]], [[0], [1]]], [[[1, 0]], [[1, 0]]], "controllability"),
        ([[[1], [1]], [[0], [1]]], [[[0, 0]], [[1, 0]]], "fixed_spectrum"),
    ],
)
def test_a_refusal_beside_an_unseen_mode_is_about_the_plant(B, C, kind):
    system = MultiChannelSystem([[1, 0], [0, -9]], B, C, neighbors={"1": [], "2": []})
    with pytest.raises(Impossible) as caught:
        design_observer(system, rate=1)
    assert caught.value.certificate.kind == kind
    verdict = check_document(
        encode(caught.value.certificate).encode(), Expectation(system=system.digest())
    )
    assert verdict.verdict == "VALID", verdict.line()


@pytest.mark.parametrize("ports", [UNSEEN, UNMOVED])
def test_a_prescribed_spectrum_needs_every_mode(ports):
    system = plant("continuous", *ports)
    with pytest.raises(Impossible):
        design_observer(system, spectrum={"feedback": [-3, -5], "error": [-5] * 5})


def test_the_observable_part_moves_like_what_is_seen_of_the_plant():
    system = MultiChannelSystem(
        [[1, 0, 0], [2, 3, 0], [1, 1, 4]], [[[1], [0], [2]]], [[[1, 1, 0], [0, 2, 0]]]
    )
    part, L = observable_part(system)
    assert part.n == 2
    assert L @ system.A == part.A @ L
    assert part.C(0) @ L == system.C(0)
    assert part.B(0) == L @ system.B(0)


def test_the_feedback_for_a_region_assigns_what_can_be_moved():
    found = feedback_for_region(
        plant("continuous", *UNMOVED), StabilityRegion("continuous", Fraction(2))
    )
    assert found.polynomial == Polynomial.from_roots([-3, -5])
