"""Sampled plants have exact data, and say by how much these differ from the exponential."""

import json
from fractions import Fraction
from random import Random

import pytest

from mcexact.constructions import c2d
from mcexact.derived.sampling import sampled_system, tustin
from mcexact.errors import UsageError
from mcexact.exact.linear_algebra import inverse
from mcexact.exact.matrix import Matrix
from mcexact.model.controller import (
    Controller,
    load_controller,
    read_controller,
    save_controller,
)
from mcexact.model.files import load_system, save_system
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.decentralized import design_extended
from mcexact.synthesis.optimum.figures import THEOREM
from mcexact.synthesis.setpoint import design_setpoint
from tests.end_to_end.command_line import run


def plant(**more) -> MultiChannelSystem:
    return MultiChannelSystem(
        [[-1, 1], [0, -2]],
        [[[0], [1]], [[1], [0]]],
        [[[1, 0]], [[0, 1]]],
        names=["one", "two"],
        neighbors={"one": ["two"], "two": []},
        **more,
    )


def test_what_is_not_sampled_stays():
    found = c2d(plant(name="a plant", source="a book"), "1/2", decimals=30)
    assert found.time == "discrete" and found.sample_time == Fraction(1, 2)
    assert found.names == ("one", "two") and found.neighbors == plant().neighbors
    assert [found.C(i) for i in range(2)] == [plant().C(i) for i in range(2)]
    assert found.name == "a plant" and found.source.startswith("a book; sampled every 1/2")


def test_a_step_is_the_solution_of_the_differential_equation():
    """For a diagonal A, B_h is (e^{ah} − 1)/a."""
    single = MultiChannelSystem([[-2]], [[[3]]], [[[1]]])
    found = c2d(single, 1, decimals=20)
    a_h, b_h = found.A[0, 0], found.B(0)[0, 0]
    assert abs(b_h - 3 * (1 - a_h) / 2) < Fraction(1, 10**19)
    assert abs(a_h - Fraction("0.13533528323661269189")) < Fraction(1, 10**20)


@pytest.mark.parametrize("step", [0, "-1/2"])
def test_a_step_is_above_0(step):
    with pytest.raises(UsageError, match="expected a time above 0"):
        c2d(plant(), step)


def test_only_plants_in_continuous_time_are_sampled():
    with pytest.raises(UsageError, match="discrete time already"):
        c2d(c2d(plant(), 1), 1)
    with pytest.raises(UsageError, match="decimals"):
        c2d(plant(), 1, decimals=-1)


def test_the_command_writes_the_sampled_plant(tmp_path):
    file, out = tmp_path / "plant.json", tmp_path / "sampled.json"
    save_system(plant(), file)
    done = run("c2d", str(file), "--step", "1/10", "--decimals", "6", "-o", str(out))
    assert done.status == 0, done.stderr
    assert load_system(out) == c2d(plant(), "1/10", decimals=6)
    assert "0.51e-6" in json.loads(out.read_text("utf-8"))["source"]
    shown = run("c2d", str(file), "--step", "1/10", "--decimals", "6")
    assert shown.stdout == out.read_text("utf-8")


def dynamic(A: list, B: list, C: list, D: list, plant: MultiChannelSystem) -> Controller:
    """Controllers ż = Az + By, u = Cz + Dy of both agents, alike."""
    return local_controllers(plant, [(A, B, C, D)] * 2)


def test_tustins_rule_puts_the_trapezoid_in_place_of_the_derivative():
    """z(t+1) − z(t) is h times the mean of the derivatives, with the mean of z as the new state."""
    controller = dynamic([[-1, 2], [0, -3]], [[1], ["1/2"]], [[1, -1]], [[2]], plant())
    held, h, rng = tustin(controller, sampled_system(plant(), "1/5")), Fraction(1, 5), Random(3)
    for before, after in zip(controller.agents, held.agents, strict=True):
        (own,) = before.private_update.outputs
        A, B = before.private_update.private, before.private_update.outputs[own]
        C, D = before.input.private, before.input.outputs[own]
        # w is the state of the trapezoid, with the mean of two outputs as its input
        w, z = Matrix.zeros(2, 1), Matrix.zeros(2, 1)
        X = inverse(Matrix.identity(2) - A * (h / 2))
        last = Matrix.zeros(1, 1)
        w = Matrix.zeros(2, 1)
        for _ in range(5):
            y = Matrix.from_rows([[rng.randint(-3, 3)]])
            # (w' − w)/h = A (w' + w)/2 + B (y + last)/2
            w = X @ (w + A @ w * (h / 2) + B @ (y + last) * (h / 2))
            u = after.input.private @ z + after.input.outputs[own] @ y
            assert u == C @ w + D @ y
            update = after.private_update
            z, last = update.private @ z + update.outputs[own] @ y, y


def test_integrators_remain_integrators_with_the_step_as_their_gain():
    made = design_setpoint(MultiChannelSystem([[-1]], [[[1]]], [[[1]]]), rate="1/4")
    sampled = sampled_system(MultiChannelSystem([[-1]], [[[1]]], [[[1]]]), "1/10")
    (agent,), (before,) = tustin(made.controller, sampled).agents, made.controller.agents
    k = next(
        i for i, row in enumerate(before.private_update.outputs[0].rows()) if row == (Fraction(1),)
    )
    identity = Matrix.identity(before.private).rows()[k]
    assert agent.private_update.private.rows()[k] == identity
    assert agent.private_update.outputs[0].rows()[k] == (Fraction(1, 10),)
    assert agent.private_update.reference.rows()[k] == (Fraction(-1, 10),)


def test_what_is_static_stays_and_the_controller_names_the_samples():
    gains = local_controllers(plant(), [[[-1]], [[-2]]])
    held = tustin(gains, sampled_system(plant(), "1/10", 1))
    assert held.agents == gains.agents and held.time == "discrete"
    assert held.system == c2d(plant(), "1/10", 1).digest()


def test_tustins_rule_refuses_what_it_does_not_apply_to():
    sampled = sampled_system(plant(), 2)
    with pytest.raises(UsageError, match="mode 2/h"):
        tustin(dynamic([[1]], [[1]], [[1]], [[0]], plant()), sampled)
    with pytest.raises(UsageError, match="made by sampled_system"):
        tustin(local_controllers(plant(), [[[-1]], [[-2]]]), plant())
    with pytest.raises(UsageError, match="discrete time already"):
        tustin(local_controllers(sampled, [[[-1]], [[-2]]]), sampled)
    shared = design_extended(plant(), dimensions=[0, 1], aims=THEOREM)
    with pytest.raises(UsageError, match="shared states"):
        tustin(shared.controller, sampled)


def test_a_controller_in_continuous_time_is_certified_at_the_samples(tmp_path):
    integrator = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    save_system(integrator, tmp_path / "plant.json")
    lag = local_controllers(integrator, [([["-2"]], [[1]], [["-1/3"]], [["-1"]])])
    save_controller(lag, tmp_path / "c.json")
    file, gains, out = (str(tmp_path / name) for name in ("plant.json", "c.json", "held.json"))
    done = run("certify", file, gains, "--step", "1/10", "--late", "1", "--no-box", "-o", out)
    assert done.status == 0, done.stderr
    assert "Tustin's rule, rounded to 12 digits" in " ".join(done.stdout.split())
    held = load_controller(out)
    assert held.time == "discrete" and held.system == c2d(integrator, "1/10", 1).digest()
    again = run("c2d", file, "--step", "1/10", "--late", "1", "--controller", gains)
    assert read_controller(again.stdout) == held
    slow = run("certify", file, gains, "--step", "3", "--late", "1", "--no-box")
    assert slow.status == 1
