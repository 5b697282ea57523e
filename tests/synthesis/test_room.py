"""Every theorem's controller is found in floating point, on plants that leave it room.

Whether floating point finds a controller near its limits depends on the processor.  Here every loop
is also certified, exactly, for a rate 1.1 times the one that was asked for, or a radius as many
times smaller: no kernel errs by that much.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.model import gallery
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.certify import certify_controller
from mcexact.synthesis.decentralized import design_decentralized, design_extended
from mcexact.synthesis.distributed_observer import design_observer
from mcexact.synthesis.optimum.figures import THEOREM
from mcexact.synthesis.setpoint import design_setpoint
from tests.synthesis.test_extended import late
from tests.synthesis.test_setpoint import two_tanks
from tests.synthesis.three_channels import three_channels

RATE, RADIUS = {"rate": Fraction(1)}, {"radius": Fraction(1, 2)}
ALONE: dict[str, Any] = {"aims": THEOREM}


def faster(bound: dict[str, Fraction]) -> dict[str, Fraction]:
    """The bound with room."""
    times = {"rate": Fraction(11, 10), "radius": Fraction(10, 11)}
    return {name: value * times[name] for name, value in bound.items()}


@pytest.mark.parametrize(
    ("design", "plant", "bound", "options"),
    [
        (design_observer, three_channels(), RATE, {}),
        (design_observer, three_channels("discrete"), RADIUS, {}),
        (design_observer, three_channels(), RATE, {"order": "least"}),
        (
            design_decentralized,
            gallery.load("farina-three-rooms"),
            {"rate": Fraction(1, 100)},
            ALONE,
        ),
        (design_extended, three_channels(), RATE, ALONE),
        (design_extended, three_channels("discrete"), RADIUS, ALONE),
        (design_extended, late(), RADIUS, {"network": "lifted", **ALONE}),
        (design_extended, late(), RADIUS, {"network": "held", **ALONE}),
        (design_setpoint, two_tanks(), RATE, {"method": "observer"}),
        (design_setpoint, two_tanks(), RATE, {"method": "extended", **ALONE}),
    ],
    ids=[
        "observer",
        "observer in discrete time",
        "observer of least order",
        "decentralized",
        "extended",
        "extended in discrete time",
        "lifted",
        "held",
        "set-points by an observer",
        "set-points by shared states",
    ],
)
def test_a_design_in_floating_point_is_certified_with_room(
    design: Any,
    plant: MultiChannelSystem,
    bound: dict[str, Fraction],
    options: dict[str, Any],
) -> None:
    made = design(plant, arithmetic="float", **bound, **options)
    found = certify_controller(plant, made.controller, **faster(bound))  # type: ignore[arg-type]
    assert found.stable
    for certificate in (made.loop.proof, found):
        assert check_document(encode(certificate).encode()).verdict == "VALID"
