"""Periodic controllers run as agents: every step is the one that is computed by hand."""

from __future__ import annotations

import json
import random
from fractions import Fraction
from typing import Any

import pytest

from mcexact.designs import PeriodicController, local_controllers
from mcexact.errors import InputError, UsageError
from mcexact.model import gallery
from mcexact.model.periodic import periodic_text
from mcexact.model.system import MultiChannelSystem
from mcexact.simulation import simulate_periodic
from tests.checker.test_subject import drawn_plant, periodic
from tests.oracle.periodic import period_by_hand

PLANT = gallery.load("movable-by-periodic-gains")
GAINS = PeriodicController(
    tuple(local_controllers(PLANT, each) for each in ([[[0]], [["121/500"]]], [[[1]], [[0]]]))
)


def test_agents_do_in_each_step_what_is_computed_by_hand() -> None:
    rng = random.Random(2)
    for _ in range(10):
        system = drawn_plant(rng, "discrete")
        controller = periodic(rng, system)
        start = [Fraction(rng.randint(-3, 3)) for _ in range(system.n)]
        steps = 2 * controller.period
        run = simulate_periodic(system, controller, initial=start, horizon=steps)
        phases = json.loads(periodic_text(controller))["phases"]
        state = [*start, *[Fraction(0)] * controller.order]
        expected = [state]
        for _ in range(2):
            expected += period_by_hand(system, phases, expected[-1])[1:]
        assert [snapshot.flat() for snapshot in run.snapshots] == expected


def test_the_default_horizon_is_whole_periods_until_the_state_is_small() -> None:
    run = simulate_periodic(PLANT, GAINS)
    assert (len(run.snapshots) - 1) % 2 == 0
    assert run.state_norms()[-1] < 0.05
    idle = local_controllers(PLANT, [[[0]], [[0]]])
    assert len(simulate_periodic(PLANT, PeriodicController((idle,) * 3)).snapshots) % 3 == 1
    assert "repeat after 2 steps" in str(run.note)


def test_disturbances_and_other_arithmetics() -> None:
    options: dict[str, Any] = {"horizon": 4, "disturbances": [(2, [1, 0])]}
    exact = simulate_periodic(PLANT, GAINS, **options)
    rough = simulate_periodic(PLANT, GAINS, arithmetic="float", **options)
    assert exact.times == rough.times
    assert exact.snapshots[3].plant != simulate_periodic(PLANT, GAINS, horizon=4).snapshots[3].plant
    pairs = zip(exact.snapshots[-1].plant, rough.snapshots[-1].plant, strict=True)
    assert all(abs(float(a) - b) < 1e-12 for a, b in pairs)


def test_arguments_are_refused() -> None:
    with pytest.raises(UsageError, match="a number of steps"):
        simulate_periodic(PLANT, GAINS, horizon="1/2")
    with pytest.raises(InputError, match="expected 3 numbers"):
        simulate_periodic(PLANT, GAINS, initial=[1])
    with pytest.raises(InputError, match="PeriodicController"):
        simulate_periodic(PLANT, GAINS.phases[0])  # type: ignore[arg-type]
    other = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
    with pytest.raises(UsageError, match="agents"):
        simulate_periodic(other, GAINS)
