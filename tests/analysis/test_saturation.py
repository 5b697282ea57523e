"""Loops whose inputs are cut off: proofs beside simulated solutions, and the choice of gains."""

from __future__ import annotations

import random
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from mcexact import Controller, Matrix, MultiChannelSystem
from mcexact.analysis.saturation import Saturated, entering, gains_for, gains_none, saturation_of
from mcexact.answer.check import check
from mcexact.answer.saturation import RULES, SaturationStability
from mcexact.answer.sentence import Context
from mcexact.derived.sampling import sampled_system
from mcexact.designs import AgentProgram, LinearMap, local_controllers
from mcexact.errors import LimitReached, UsageError
from mcexact.exact.matrix import matrix_to_float
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.sizes import TypicalSizes
from mcexact.performance import saturation_stability, with_anti_windup
from tests.oracle.drawn.performance import drawn_loop
from tests.wording import refusal, says

ONE = (Fraction(-1), Fraction(1))
Floats = np.ndarray[Any, Any]


def cut_off(loop: ClosedLoop, proof: SaturationStability) -> tuple[Any, bool]:
    """A step of the loop with its inputs cut off, plainly, and whether time is discrete."""
    d, pairs = loop.disturbed, [pair for own in proof.limits for pair in own]
    M, E, U = (matrix_to_float(each) for each in (d.M, d.E, d.U))
    E = E + matrix_to_float(entering(loop, proof.back_calculation))
    low = np.array([-np.inf if pair is None else float(pair[0]) for pair in pairs])
    high = np.array([np.inf if pair is None else float(pair[1]) for pair in pairs])

    def change(z: Floats, more: Floats | float = 0.0) -> Floats:
        v = U @ z
        moved: Floats = M @ z + E @ (np.clip(v, low, high) - v) + more
        return moved

    return change, loop.plant.time == "discrete"


def later(change: Any, z: Floats, times: int, step: float | None) -> list[Floats]:
    """A solution: exact steps, or those of the classical Runge-Kutta method."""
    states = [z]
    for _ in range(times):
        if step is None:
            z = change(z)
        else:
            a = change(z)
            b = change(z + step / 2 * a)
            c = change(z + step / 2 * b)
            z = z + step / 6 * (a + 2 * b + 2 * c + change(z + step * c))
        states.append(z)
    return states


@pytest.mark.parametrize("seed", range(15))
def test_drawn_loops_do_what_is_proved_of_them(seed: int) -> None:
    rng = random.Random(seed)
    loop = next(drawn[2] for drawn in iter(lambda: drawn_loop(rng), 0) if drawn is not None)
    some: Any = (ONE, ONE, None, (Fraction(-1, 2), Fraction(2)))
    limits = tuple(
        tuple(rng.choice(some) for _ in range(loop.plant.p(i))) for i in range(loop.plant.m)
    )
    _, proof = gains_for(loop, limits)
    if proof is None or not loop.dimension:
        return
    change, discrete = cut_off(loop, proof)
    M = matrix_to_float(loop.matrix)
    step = None if discrete else 0.1 / max(1.0, float(np.linalg.norm(M, 2)))
    form = proof.proof.P if proof.region is None else proof.region.P
    assert form is not None
    P = matrix_to_float(form.matrix())
    draws = np.random.default_rng(seed)
    for _ in range(4):
        z, y = (draws.normal(size=len(M)) * 10 for _ in range(2))
        if proof.region is not None:
            # from the border of the ellipsoid, beside the solution that is at rest
            z, y = z / np.sqrt(z @ P @ z) * 0.999999, np.zeros(len(M))
        ours, theirs = (later(change, x, 60, step) for x in (z, y))
        sizes = [float((a - b) @ P @ (a - b)) for a, b in zip(ours, theirs, strict=True)]
        for before, after in pairwise(sizes):
            assert after <= before * (1 + 1e-9) + 1e-12 * sizes[0]


def test_from_a_ball_every_state_of_the_plant_is_in_the_region() -> None:
    plant = MultiChannelSystem([[1, 1], [0, "1/2"]], [[[0], [1]]], [[[1, 0], [0, 1]]])
    controller = local_controllers(plant, [[[-6, -6]]])
    found = saturation_stability(plant, controller, limits={0: [[-2, 3]]})
    assert found.region is not None and found.region.radius > Fraction(1, 20)
    P, radius = matrix_to_float(found.region.P.matrix()), float(found.region.radius)
    assert np.linalg.eigvalsh(P)[-1] * radius**2 <= 1
    assert check(found).verdict == "VALID"


def test_limits_twice_as_wide_give_a_region_twice_as_large() -> None:
    plant = MultiChannelSystem([["3/2"]], [[[1]]], [[[1]]], time="discrete")
    controller = local_controllers(plant, [[["-3/2"]]])
    one, two = (
        saturation_stability(plant, controller, limits={"1": [[-c, c]]}).region for c in (1, 2)
    )
    assert one is not None and two is not None
    assert abs(two.radius / one.radius - 2) < Fraction(1, 50)


def test_no_state_beyond_what_the_input_can_hold_is_in_a_region() -> None:
    # x(t+1) = 3/2 x + u with |u| ≤ 1 holds |x| < 2 and nothing beyond
    plant = MultiChannelSystem([["3/2"]], [[[1]]], [[[1]]], time="discrete")
    for gain in ("-3/2", "-5/4", "-7/4", "-1"):
        controller = local_controllers(plant, [[[gain]]])
        region = saturation_stability(plant, controller, limits={"1": [[-1, 1]]}).region
        assert region is not None and region.radius < 2


def integral(q: int = 1) -> Controller:
    """u = −(2y + the integral of 2y)."""
    two = Matrix.from_rows([[-2]])
    agent = AgentProgram(
        "1",
        0,
        1,
        private_update=LinearMap({0: two}),
        input=LinearMap({0: two}, private=Matrix.from_rows([[1]])),
    )
    return Controller("continuous", "", (agent,))


def test_an_integral_is_stable_at_its_limits_with_anti_windup_alone() -> None:
    plant = MultiChannelSystem([[-1]], [[[1]]], [[[1]]])
    loop = closed_loop(plant, integral())
    limits = ((ONE,),)
    assert Saturated.of(loop, limits, gains_none(loop)).norm() >= 1
    without = saturation_of(loop, limits, gains_none(loop))
    assert without is None or without.region is not None
    gains, proof = gains_for(loop, limits)
    assert gains[0][0, 0] > 0 and proof is not None and proof.region is None
    assert check(proof).verdict == "VALID"


def test_a_controller_with_anti_windup_is_certified_with_its_own_limits_and_gains() -> None:
    plant = MultiChannelSystem([[-1]], [[[1]]], [[[1]]])
    controller = with_anti_windup(plant, integral(), limits={"1": [[-1, "1/2"]]})
    proof = saturation_stability(plant, controller)
    assert proof.limits == (((Fraction(-1), Fraction(1, 2)),),)
    assert proof.back_calculation == (controller.agents[0].back_calculation,)
    assert check(proof, controller=controller).verdict == "VALID"
    other = controller.with_saturation(proof.limits, [Matrix.from_rows([[50]])])
    assert check(proof, controller=other).verdict == "NOT ABOUT"


def test_gains_of_one_agent_do_not_depend_on_units_of_another() -> None:
    # each agent uses its own input alone: its gains have its own rows and columns
    plant = MultiChannelSystem(
        [[-1, 0], [0, -2]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]], names=["1", "2"]
    )
    two = Matrix.from_rows([[-2]])
    agents = tuple(
        AgentProgram(
            name,
            0,
            1,
            private_update=LinearMap({i: two}),
            input=LinearMap({i: two}, private=Matrix.from_rows([[1]])),
        )
        for i, name in enumerate(plant.names)
    )
    loop = closed_loop(plant, Controller("continuous", "", agents))
    gains, _ = gains_for(loop, ((ONE,), (None,)))
    assert gains[0][0, 0] > 0 and gains[1].is_zero()
    rows = matrix_to_float(entering(loop, gains))
    assert np.count_nonzero(rows) == 1 and rows[2, 0] > 0


def test_what_is_not_limited_or_not_stable_is_refused() -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    with refusal(UsageError, where="limits"):
        saturation_stability(plant, local_controllers(plant, [[[-3]]]))
    with refusal(LimitReached):
        saturation_stability(plant, local_controllers(plant, [[[0]]]), limits={0: [[-1, 1]]})
    # an input that is never negative holds no unstable plant
    with pytest.raises(LimitReached):
        saturation_stability(plant, local_controllers(plant, [[[-3]]]), limits={0: [[0, 1]]})


def test_a_region_is_far_larger_than_the_ball_in_which_nothing_is_cut_off() -> None:
    plant = MultiChannelSystem(
        [[1, 1], [0, 1]], [[["1/2"], [1]]], [[[1, 0], [0, 1]]], time="discrete"
    )
    gains = local_controllers(plant, [[["-1/5", "-3/5"]]])
    found = saturation_stability(plant, gains, limits={"1": [[-1, 1]]})
    K, M = np.array([[-0.2, -0.6]]), np.array([[0.9, 0.7], [-0.2, 0.4]])
    peak, power = 0.0, np.eye(2)
    for _ in range(100):
        peak, power = max(peak, float(np.linalg.norm(K @ power))), M @ power
    assert found.region is not None and found.region.radius * Fraction(peak) > 3


def swing(unit: Fraction) -> MultiChannelSystem:
    """A rod that falls; angle and velocity are in another unit, and so are their sizes."""
    return MultiChannelSystem(
        [[0, 1], [2, 0]],
        [[[0], [unit]]],
        [[[1 / unit, 0], [0, 1 / unit]]],
        typical_sizes=TypicalSizes(states=[unit / 10, unit / 2]),
    )


@pytest.mark.parametrize("sampling", [None, (Fraction(1, 20), 1)])
def test_a_region_in_sizes_does_not_change_with_the_unit(
    sampling: tuple[Fraction, int] | None,
) -> None:
    regions = list[Fraction]()
    # samples are rounded to decimals in the units of the file
    finest = Fraction(1, 10**9) if sampling is None else Fraction(1)
    for unit in (Fraction(1), Fraction(1000), Fraction("3.6"), finest):
        plant = swing(unit)
        loop = plant if sampling is None else sampled_system(plant, *sampling)
        found = saturation_stability(
            loop, local_controllers(loop, [[[-5, -3]]]), limits={"1": [[-1, 1]]}
        )
        assert found.region is not None and found.region.sizes is not None
        assert found.region.sizes[:2] == (unit / 10, unit / 2)
        assert check(found).verdict == "VALID"
        regions.append(found.region.radius)
    assert len({*regions}) == 1


def test_without_sizes_a_region_names_none() -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    found = saturation_stability(plant, local_controllers(plant, [[[-3]]]), limits={"1": [[-1, 1]]})
    assert found.region is not None and found.region.sizes is None and found.exact is None


def test_what_is_proved_of_samples_is_proved_of_exact_ones_unless_decimals_are_missing() -> None:
    plant, gain = MultiChannelSystem([[1]], [[[1]]], [[[1]]]), [[[-2]]]
    fine, rough = (sampled_system(plant, "1/2", decimals=k) for k in (12, 1))
    limits = {"1": [[-1, 1]]}
    found = saturation_stability(fine, local_controllers(fine, gain), limits=limits)
    assert found.exact and check(found).verdict == "VALID"
    assert "sampled without rounding" in check(found).statement
    assert says(said_of(found, fine), "also samples")
    least = saturation_stability(rough, local_controllers(rough, gain), limits=limits)
    assert least.exact is None and check(least).verdict == "VALID"
    assert says(said_of(least, rough), "exact ones")
    # the exact plant, which starts in the region, with 100 digits of e^(1/2)
    assert found.region is not None
    A = float(np.exp(0.5))
    x = float(found.region.radius) * 0.999
    for _ in range(200):
        x = A * x + (A - 1) * float(np.clip(-2 * x, -1, 1))
    assert abs(x) < 1e-6


def said_of(found: SaturationStability, plant: MultiChannelSystem) -> str:
    """The sentences about an answer."""
    return "\n".join(map(str, RULES.sentences({"saturation": found}, Context(plant))))
