"""Systems made from plants are designed for like plants, and the proofs are about the plant."""

from __future__ import annotations

from typing import Any

import pytest

from mcexact.answer.codec import encode
from mcexact.checker import check_document
from mcexact.derived.extended import extended_system
from mcexact.derived.feedback import feedback
from mcexact.errors import Impossible
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import digest
from mcexact.synthesis.network.decentralized import design_decentralized
from mcexact.synthesis.network.extended import design_extended
from mcexact.synthesis.observer.observer import design_observer
from mcexact.synthesis.setpoint import design_setpoint
from tests.synthesis.test_setpoint import two_tanks
from tests.synthesis.three_channels import three_channels


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
    design: Any, options: dict[str, str], arithmetic: str
) -> None:
    plant = two_tanks()
    made = design(feedback(plant, [[[1]], [["1/2"]]]), rate=1, arithmetic=arithmetic, **options)
    for certificate in made.certificates.values():
        assert certificate.subject[0]["construction"] == "feedback"
        verdict = check_document(encode(certificate).encode(), digest(plant))
        assert verdict.verdict == "VALID", verdict.line()


def test_decentralized_control_of_the_extended_system_is_distributed_control_of_the_plant() -> None:
    plant = three_channels()
    shared = design_extended(plant, rate=1, dimensions=[0, 0, 1])
    alone = design_decentralized(extended_system(plant, [0, 0, 1]), rate=1)
    assert alone.order + 1 == shared.order
    assert alone.loop.polynomial == shared.loop.polynomial


def test_a_refusal_is_about_the_plant_too() -> None:
    plant = MultiChannelSystem([[1]], [[[1]], [[0]]], [[[0]], [[1]]], neighbors={"1": [], "2": []})
    for design in (design_decentralized, design_observer, design_extended):
        with pytest.raises(Impossible) as refusal:
            design(feedback(plant, [[[0]], [[0]]]), rate=1)
        certificate = refusal.value.certificate
        assert certificate.subject[0]["construction"] == "feedback"
        verdict = check_document(encode(certificate).encode(), digest(plant))
        assert verdict.verdict == "VALID", verdict.line()
