"""Systems made from plants are designed for like plants, and the proofs are about the plant."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from mcexact.answer.account import Account
from mcexact.answer.protocol import encode
from mcexact.checker.command import manifest_verdicts
from mcexact.checker.core.reading import Limits
from mcexact.checker.kinds import Expectation, check_document
from mcexact.derived.constructions import (
    augmented_outputs,
    extended_system,
    feedback,
    full_output,
    merged,
)
from mcexact.errors import Impossible
from mcexact.model.loop import closed_loop
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.certify import account_of_verdict, certify_controller
from mcexact.synthesis.decentralized import design_decentralized, design_extended
from mcexact.synthesis.distributed_observer import design_observer
from mcexact.synthesis.optimum.figures import THEOREM
from mcexact.synthesis.performance import performance_of
from mcexact.synthesis.setpoint import design_setpoint
from tests.synthesis.test_setpoint import two_tanks
from tests.synthesis.three_channels import three_channels
from tests.wording import worded


@pytest.mark.parametrize("arithmetic", ["exact", "float"])
@pytest.mark.parametrize(
    ("design", "options"),
    [
        (design_decentralized, {}),
        (design_observer, {}),
        (design_extended, {}),
        (design_extended, {"dimensions": "bound"}),
        (design_setpoint, {"method": "extended"}),
    ],
)
def test_every_method_takes_a_plant_with_feedback(
    design: Any, options: dict[str, str], arithmetic: str, tmp_path: Path
) -> None:
    plant = two_tanks()
    made = design(feedback(plant, [[[1]], [["1/2"]]]), rate=1, arithmetic=arithmetic, **options)
    for certificate in made.certificates.values():
        assert certificate.subject[0]["construction"] == "feedback"
        verdict = check_document(encode(certificate).encode(), Expectation(system=plant.digest()))
        assert verdict.verdict == "VALID", verdict.line()
    require_implied(made.account, tmp_path)


def test_what_is_said_of_a_loop_of_a_derived_system_is_implied(tmp_path: Path) -> None:
    plant = MultiChannelSystem([[1]], [[[1]], [[1]]], [[[1]], [[2]]])
    heard = augmented_outputs(plant, plant.with_neighbors({"1": ["2"], "2": []}).neighbors)
    tall = MultiChannelSystem([[1]], [[[1]]], [[[1], [2]]], neighbors={"1": []})
    made = design_setpoint(full_output(tall, 0), rate=1)
    require_implied(made.account, tmp_path)
    local = local_controllers(heard, [[[-3, 0]], [[0]]])
    require_implied(account_of_verdict(certify_controller(heard, local, rate=1)), tmp_path)


def test_the_order_of_the_observer_is_that_for_the_system_in_the_loop(tmp_path: Path) -> None:
    made = design_decentralized(extended_system(three_channels(), [0, 0, 1]), rate=1)
    account = made.account
    told = [each for each in account.manifest()["sentences"] if "observer-order" in each["rule"]]
    assert worded([each["text"] for each in told])
    account.save(tmp_path)
    found = manifest_verdicts(str(tmp_path), Expectation(), Limits())
    said = [verdict.statement for _, verdict in found]
    assert [each for each in said if "Liu" in each and "14 states" in each]


def require_implied(account: Account, folder: Path) -> None:
    """The checker finds that the certificates imply every sentence."""
    account.save(folder)
    for about, verdict in manifest_verdicts(str(folder), Expectation(), Limits()):
        good = {"IMPLIED", "REMARK"} if "text" in about else {"VALID"}
        assert verdict.verdict in good, (about, verdict.line())


def test_decentralized_control_of_the_extended_system_is_distributed_control_of_the_plant() -> None:
    plant = three_channels()
    shared = design_extended(plant, rate=1, dimensions=[0, 0, 1], aims=THEOREM)
    alone = design_decentralized(extended_system(plant, [0, 0, 1]), rate=1, aims=THEOREM)
    assert alone.order + 1 == shared.order
    assert alone.loop.polynomial == shared.loop.polynomial


def test_a_refusal_is_about_the_plant_too() -> None:
    plant = MultiChannelSystem([[1]], [[[1]], [[0]]], [[[0]], [[1]]], neighbors={"1": [], "2": []})
    for design in (design_decentralized, design_observer, design_extended):
        with pytest.raises(Impossible) as refusal:
            design(feedback(plant, [[[0]], [[0]]]), rate=1)
        certificate = refusal.value.certificate
        assert certificate.subject[0]["construction"] == "feedback"
        verdict = check_document(encode(certificate).encode(), Expectation(system=plant.digest()))
        assert verdict.verdict == "VALID", verdict.line()


def test_a_derived_loop_has_figures_with_its_own_graph() -> None:
    """A system with merged channels takes no graph."""
    plant = MultiChannelSystem([[1, 0], [1, -1]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]])
    one = merged(plant, [["1", "2"]])
    found = performance_of(closed_loop(one, local_controllers(one, [[[-3, 0], [0, -1]]])))
    assert found.ratio is not None and found.margin is not None
