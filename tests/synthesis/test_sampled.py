"""Controllers for sampled plants: what is proved of them is about the plant in continuous time."""

from __future__ import annotations

import json
import random
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mcexact import (
    MultiChannelSystem,
    certify_controller,
    check,
    design_decentralized,
    design_setpoint,
    save_system,
)
from mcexact.answer.protocol import encode
from mcexact.boxes import Box, box_stability
from mcexact.checker.command import manifest_verdicts
from mcexact.checker.core.reading import Limits
from mcexact.checker.kinds import Expectation, check_document
from mcexact.constructions import c2d, sampled_system
from mcexact.designs import local_controllers
from mcexact.errors import LimitReached
from mcexact.exact.matrix import matrix_to_float
from mcexact.model.controller import Controller, controller_text
from mcexact.model.loop import closed_loop
from mcexact.synthesis.certify import account_of_verdict
from mcexact.synthesis.design import Design
from mcexact.synthesis.robustness import every_loop
from tests.cli.calling import call
from tests.wording import says

CART = MultiChannelSystem(
    [[0, 1, 0], [0, 0, 1], [0, 0, -2]],
    [[[0], [0], [1]], [[0], [1], [0]]],
    [[[1, 0, 0]], [[0, 1, 0]]],
    names=["motor", "brake"],
    name="cart",
)


@pytest.fixture(scope="module")
def design() -> Design:
    """A controller of the cart at 10 Hz, one step late."""
    return design_decentralized(sampled_system(CART, "1/10", 1))


def test_every_claim_of_a_design_is_about_the_plant_in_continuous_time(
    design: Design, tmp_path: Path
) -> None:
    around = design.every_loop()
    account = design.account_with(around)
    assert around.proof is not None and around.part is not None and around.part > 0
    assert around.failing is not None
    for name, each in account.answers.items():
        plant = around.failing.plant if name == "failing_loop" else CART
        assert each.about.plant == plant.with_uncertainty(each.about.plant.uncertainty)
        assert each.subject[0]["construction"] == "sampled"
    account.save(tmp_path)
    known = {sentence.template.key for sentence in account.sentences}
    rules = {"sampled-loop", "members-sampled-region-part", "certify-failing-plant"}
    assert rules <= known
    for about, verdict in manifest_verdicts(str(tmp_path), Expectation(), Limits()):
        good = {"IMPLIED", "REMARK"} if "text" in about else {"VALID"}
        assert verdict.verdict in good, (about, verdict.line())


def test_a_box_holds_the_loops_of_exact_samples_of_plants_at_its_ends(design: Design) -> None:
    around, rng = design.every_loop(), random.Random(4)
    assert around.part is not None
    for _ in range(20):
        member = Box.relative(CART, around.part).member(rng, vertex=True)
        loop = closed_loop(sampled_system(member, "1/10", 1, decimals=30), design.controller)
        radius = np.abs(np.linalg.eigvals(matrix_to_float(loop.matrix))).max()
        assert radius < 1


def test_the_controller_names_the_plant_at_its_samples(design: Design) -> None:
    assert design.controller.system == c2d(CART, "1/10", 1).digest()
    assert design.controller.warnings_for(sampled_system(CART, "1/10", 1)) == ()
    other = sampled_system(CART, "1/10")
    assert design.controller.warnings_for(other) and design.controller.warnings_for(CART)


def test_a_controller_file_says_which_samples_a_certificate_must_be_about(design: Design) -> None:
    certificate = encode(design.certificates["stability"]).encode()

    def verdict(controller: Controller, system: str = "") -> Any:
        text = controller_text(controller).encode()
        wanted = Expectation(system=system).controlled(text, Limits())
        return check_document(certificate, wanted)

    assert verdict(design.controller, CART.digest()).verdict == "VALID"
    for name in (CART.digest(), c2d(CART, "1/10").digest(), c2d(CART, "1/11", 1).digest()):
        assert verdict(replace(design.controller, system=name)).code == "controller"
    # without a digest nothing says at which step the controller runs
    unnamed = verdict(replace(design.controller, system=""))
    assert (unnamed.verdict, unnamed.code) == ("NOT ABOUT", "expected")


def test_the_exact_samples_are_proved_where_no_box_is(design: Design) -> None:
    loop = design.loop.closed
    alone = box_stability(sampled_system(CART, "1/10", 1), design.controller)
    assert check(alone).verdict == "VALID"
    assert says(check(alone).statement, "plant alone")
    assert "sampled without rounding" in check(alone).statement
    around = every_loop(loop, design.region)
    wide = Box.relative(CART, 10 * (around.part or Fraction(1))).system
    with pytest.raises(LimitReached, match="no proof"):
        box_stability(sampled_system(wide, "1/10", 1), design.controller)


def test_a_loop_that_is_stable_without_delay_may_not_be_late() -> None:
    integrator = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    fast = replace(local_controllers(sampled_system(integrator, 1), [[["-3/2"]]]), system="")
    assert certify_controller(sampled_system(integrator, 1), fast).stable
    late = certify_controller(sampled_system(integrator, 1, 1), fast)
    assert not late.stable and check(late).verdict == "VALID"


def test_radii_of_the_plant_are_the_box_of_its_samples(design: Design) -> None:
    around = design.every_loop()
    assert around.part is not None
    size = float(around.part) / 4
    radii = [[Fraction(0), Fraction(str(size)), Fraction(0)], [Fraction(0)] * 3, [Fraction(0)] * 3]
    small = Box.absolute(CART, A=radii).system
    own = design_decentralized(sampled_system(small, "1/10", 1))
    proved = own.every_loop()
    assert proved.within_radii == "proved"
    keys = {each.template.key for each in own.account_with(proved).sentences}
    assert "members-sampled-region" in keys


def test_set_points_are_held_at_the_samples(tmp_path: Path) -> None:
    made = design_setpoint(sampled_system(CART, "1/10", 1), regulate={"motor": [1]})
    made.account.save(tmp_path)
    for about, verdict in manifest_verdicts(str(tmp_path), Expectation(), Limits()):
        good = {"IMPLIED", "REMARK"} if "text" in about else {"VALID"}
        assert verdict.verdict in good, (about, verdict.line())


def test_a_verdict_is_told_in_discrete_time(design: Design) -> None:
    verdict = certify_controller(sampled_system(CART, "1/10", 1), design.controller)
    account = account_of_verdict(verdict)
    texts = [sentence.line for sentence in account.sentences]
    assert any("|λ| < 1" in text for text in texts) and not any("Re λ" in text for text in texts)


def test_the_commands_design_certify_and_check(tmp_path: Path) -> None:
    plant, gains, proofs = (str(tmp_path / name) for name in ("cart.json", "c.json", "proofs"))
    save_system(CART, plant)
    sampling = ("--step", "0.1", "--late", "1")
    status, out, said = call(
        "design", "decentralized", plant, *sampling, "-o", gains, "--certificates", proofs
    )
    assert status == 0, said
    first = out.splitlines()[0]
    assert "sampled every 0.1, 1 step late" in first and "of each entry" in first
    assert call("certify", plant, gains, *sampling, "--no-box")[0] == 0
    status, out, said = call("certify", plant, gains, "--step", "0.1", "--no-box")
    assert says(said, "made another")
    for name in ("stability", "box_stability"):
        file = f"{proofs}/{name}.json"
        assert call("check", "--statements", file, "--system", plant, "--controller", gains)[0] == 0
    status, out, _ = call(
        "check", "--statements", "--manifest", proofs, "--system", plant, "--controller", gains
    )
    assert status == 0 and "0 not" in out
    assert json.loads(Path(gains).read_text("utf-8"))["time"] == "discrete"


@pytest.mark.parametrize(
    ("options", "status", "message"),
    [
        (("--late", "1"), 2, "--late is for plants that are sampled: add --step"),
        (("--step", "0"), 2, "expected a time above 0"),
        (("--step", "1e9"), 4, "long for the fastest rates"),
    ],
)
def test_steps_that_are_none_are_refused(
    options: tuple[str, ...], status: int, message: str, tmp_path: Path
) -> None:
    save_system(CART, tmp_path / "cart.json")
    found, _, said = call("design", "decentralized", str(tmp_path / "cart.json"), *options)
    assert (found, message in said) == (status, True), said
