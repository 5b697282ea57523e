"""Sampled plants near one whose loop fails, and the largest box of plants that are sampled."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from mcexact import MultiChannelSystem, certify_controller, check, save_system
from mcexact.analysis.boxes.samples import failing_samples
from mcexact.boxes import Box, largest_loop_uncertainty
from mcexact.constructions import sampled_system
from mcexact.derived.sampling import resampled
from mcexact.designs import local_controllers
from mcexact.exact.matrix import matrix_to_float
from mcexact.exact.roots import StabilityRegion
from mcexact.model.controller import controller_text
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.synthesis.robustness import every_loop
from tests.cli.calling import call
from tests.wording import says

LAG = MultiChannelSystem([[1]], [[[1]]], [[[1]]], name="lag")
PAIR = MultiChannelSystem(
    [[0, 1, 0], [-1, "-1/5", "1/2"], [0, 0, -2]],
    [[[0], [1], [0]], [[0], [0], [1]]],
    [[[1, 0, 0], [0, 1, 0]], [[0, 0, 1]]],
)
CIRCLE = StabilityRegion("discrete")


def loop_of(plant: MultiChannelSystem, gains: object, step: object, late: int) -> ClosedLoop:
    sampled = sampled_system(Box.relative(plant, 1).system, step, late)  # type: ignore[arg-type]
    return closed_loop(sampled, local_controllers(sampled, gains))  # type: ignore[arg-type]


def largest_modulus(loop: ClosedLoop, plant: MultiChannelSystem) -> float:
    sampled = resampled(loop.plant, plant)
    M = closed_loop(sampled, loop.controller).system.A
    return float(max(abs(np.linalg.eigvals(matrix_to_float(M)))))


@pytest.mark.parametrize("late", [0, 1, 2])
def test_a_plant_that_fails_is_a_corner_of_its_box_on_the_border(late: int) -> None:
    loop = loop_of(PAIR, [[["-2", "-1"]], [["-3"]]], "1/10", late)
    near = next(failing_samples(loop, CIRCLE, 3))
    box = Box.relative(PAIR, near.distance)
    assert box.contains(near.plant)
    assert not Box.relative(PAIR, near.distance * Fraction(99, 100)).contains(near.plant)
    assert 0.999 < largest_modulus(loop, near.plant) < 1.05
    assert largest_modulus(loop, PAIR) < 1


@pytest.mark.parametrize("late", [0, 1])
def test_no_drawn_corner_of_a_box_fails_much_nearer(late: int) -> None:
    """Of 60 drawn corners none at 90 % of the distance fails."""
    loop = loop_of(PAIR, [[["-2", "-1"]], [["-3"]]], "1/10", late)
    near = next(failing_samples(loop, CIRCLE, 3))
    rng = np.random.default_rng(late)
    t = Fraction(9, 10) * near.distance
    for _ in range(60):
        A, *ports = (
            [[x * (1 + t * int(rng.choice([-1, 1]))) for x in row] for row in M.rows()]
            for M in (PAIR.A, PAIR.B(0), PAIR.B(1), PAIR.C(0), PAIR.C(1))
        )
        assert largest_modulus(loop, MultiChannelSystem(A, ports[:2], ports[2:])) < 1


def test_both_ends_of_the_largest_box_are_near_the_known_one() -> None:
    """With short steps those of the plant in continuous time: 1 + τ = 3 (1 − τ)² at τ = 1/3."""
    sampled = sampled_system(LAG, "1/100")
    gain = local_controllers(sampled, [[[-3]]])
    found = largest_loop_uncertainty(sampled, gain, effort=1)
    assert found.proof is not None and found.upper is not None and found.failing is not None
    assert found.relative and Fraction(3, 10) < found.lower < Fraction(1, 3)
    assert Fraction(33, 100) < found.upper < Fraction(34, 100)
    assert check(found.proof, Box.relative(LAG, found.lower).system).valid
    assert not certify_controller(sampled_system(found.failing, "1/100"), gain).stable
    assert found.refutation is not None and check(found.refutation, found.failing).valid


def test_radii_of_the_plant_are_multiplied() -> None:
    plant = Box.absolute(LAG, A=[[1]]).system
    sampled = sampled_system(plant, "1/10", 1)
    found = largest_loop_uncertainty(sampled, local_controllers(sampled, [[[-3]]]), effort=1)
    assert not found.relative and found.upper is not None
    assert 1 < found.lower < found.upper < Fraction(5, 2)


def test_a_loop_that_fails_at_once_has_no_box() -> None:
    sampled = sampled_system(LAG, 1)
    found = largest_loop_uncertainty(sampled, local_controllers(sampled, [[[-3]]]), effort=1)
    assert found.lower == 0 and found.upper == 0 and found.refutation is not None


def test_what_nothing_moves_has_no_plant_that_fails() -> None:
    still = MultiChannelSystem([[0]], [[[0]]], [[[1]]])
    loop = loop_of(still, [[["1/2"]]], 1, 1)
    assert not list(failing_samples(loop, CIRCLE, 2))


def test_every_loop_of_samples_has_a_plant_that_fails() -> None:
    sampled = sampled_system(PAIR, "1/10", 1)
    gains = local_controllers(sampled, [[["-2", "-1"]], [["-3"]]])
    around = every_loop(closed_loop(sampled, gains), CIRCLE)
    assert around.part is not None and around.failing is not None
    assert around.part < around.failing.distance
    assert around.failing.refutation is not None
    assert check(around.failing.refutation, around.failing.plant).valid


def test_certify_searches_the_largest_uncertainty_of_samples(tmp_path: Path) -> None:
    plant, gains, folder = (str(tmp_path / name) for name in ("p.json", "c.json", "proofs"))
    save_system(LAG, plant)
    program = local_controllers(sampled_system(LAG, "1/10", 1), [[["-3/2"]]])
    (tmp_path / "c.json").write_text(controller_text(program), encoding="utf-8")
    search = ("certify", plant, gains, "--step", "1/10", "--late", "1", "--largest-uncertainty")
    status, out, _ = call(*search, "--effort", "1", "--json", "--certificates", folder)
    largest = json.loads(out)["largest_uncertainty"]
    assert status == 0 and 0 < Fraction(largest["lower"]) < Fraction(largest["upper"])
    status, out, _ = call("check", "--statements", "--manifest", folder)
    assert status == 0 and says(out, "entry differs")
    assert "INVALID" not in out


def test_certify_names_a_plant_within_the_radii_whose_samples_fail(tmp_path: Path) -> None:
    plant, gains = str(tmp_path / "p.json"), str(tmp_path / "c.json")
    save_system(Box.relative(LAG, "1/2").system, plant)
    program = local_controllers(sampled_system(LAG, "1/10", 1), [[["-3/2"]]])
    (tmp_path / "c.json").write_text(controller_text(program), encoding="utf-8")
    _, out, _ = call("certify", plant, gains, "--step", "1/10", "--late", "1", "--json")
    every = json.loads(out)["every_loop"]
    assert not every["certified"] and Fraction(every["fails_within"]) < 1
