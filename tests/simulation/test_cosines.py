"""Set-points that are cosines: exact in discrete time, and followed by models of them."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import pytest

from mcexact import Controller, MultiChannelSystem, design_setpoint, simulate
from mcexact.designs import AgentProgram, Aims
from mcexact.errors import InputError
from mcexact.simulation.network import Cosine

LAG = MultiChannelSystem([[-1]], [[[1]]], [[[1]]])
STEPPED = MultiChannelSystem([["1/2"]], [[[1]]], [[[1]]], time="discrete")


def idle(plant: MultiChannelSystem) -> Controller:
    """Agents that do nothing."""
    return Controller(plant.time, "", tuple(AgentProgram(name, 0, 0) for name in plant.names))


@pytest.mark.parametrize("cosine", [Fraction(3, 5), Fraction(-1, 3), Fraction(1), Fraction(-1)])
def test_cosines_of_multiples_of_an_angle_solve_its_recurrence(cosine: Fraction) -> None:
    run = simulate(STEPPED, idle(STEPPED), horizon=12, cosines=[(cosine, [2])])
    r = [snapshot.reference[0][0] for snapshot in run.snapshots]
    assert r[:2] == [2, 2 * cosine]
    assert all(c == 2 * cosine * b - a for a, b, c in zip(r, r[1:], r[2:], strict=False))


@pytest.mark.parametrize("order", range(6))
def test_derivatives_of_a_cosine_are_cosines(order: int) -> None:
    found = Cosine(Fraction(3, 2), False, 128).derivative(Fraction(7, 5), order)
    assert abs(float(found) - 1.5**order * math.cos(2.1 + order * math.pi / 2)) < 1e-12


@pytest.mark.parametrize(
    ("plant", "signals", "omega", "limit", "horizon"),
    [
        (LAG, "sine:2", 2, {"rate": 1}, 10),
        (STEPPED, "cosine:3/5", "3/5", {"radius": "3/5"}, 60),
    ],
)
def test_errors_on_a_cosine_tend_to_zero_with_its_model_alone(
    plant: MultiChannelSystem, signals: str, omega: Any, limit: Any, horizon: int
) -> None:
    errors = []
    for asked in (signals, "step"):
        design = design_setpoint(plant, signals=asked, aims=Aims(effort=0), **limit)
        run = simulate(plant, design.controller, horizon=horizon, cosines=[(omega, [1])])
        pairs = [(each.outputs[0][0], each.reference[0][0]) for each in run.snapshots[-10:]]
        errors.append(max(abs(float(y - r)) for y, r in pairs))
    assert 100 * errors[0] < 1e-2 < errors[1]


def test_multiprecision_follows_the_same_cosine() -> None:
    design = design_setpoint(LAG, signals="sine:2", aims=Aims(effort=0), rate="1/2")
    options: Any = {"horizon": 2, "points": 2, "cosines": [(2, [1])]}
    found = [
        [float(each.outputs[0][0]) for each in simulate(LAG, design.controller, **how).snapshots]
        for how in (options, {**options, "arithmetic": "multiprecision", "digits": 30})
    ]
    assert found[0] == pytest.approx(found[1], abs=1e-9)


@pytest.mark.parametrize("cosines", [[(2, [1])], [(Fraction(1, 2), [1, 2])], [3], [(1,)]])
def test_what_is_no_cosine_is_refused(cosines: Any) -> None:
    with pytest.raises(InputError):
        simulate(STEPPED, idle(STEPPED), horizon=2, cosines=cosines)
