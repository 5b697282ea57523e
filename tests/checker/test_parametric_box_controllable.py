"""The rule of ``parametric_box_controllable``: channels control at all values within ranges."""

from __future__ import annotations

from typing import Any

import pytest

from tests.checker.handmade import Document, certificate, changed, checked, matrix, ranged, without
from tests.checker.parameter_plants import ALL, CONTROLLABLE, CONTROLLED, OBSERVED
from tests.checker.tables import accepts, rejects
from tests.wording import says

OF_THIS_KIND = [(name, each) for name, each in ALL.items() if each["kind"] == CONTROLLABLE]

test_what_is_made_is_proved = accepts(OF_THIS_KIND)

test_what_proves_less_is_refused = rejects(
    [
        ("a channel fewer", CONTROLLED, ("claim.channels", ["1"]), "MALFORMED"),
        ("an unknown channel", CONTROLLED, ("claim.channels", ["3"]), "MALFORMED"),
        ("an input reaches 0", CONTROLLED, ("system.channels.0.B.0.0", "2*k - 1"), "INVALID"),
        ("an input moves with k", CONTROLLED, ("system.channels.0.B.0.0", "4*k - 1"), "INVALID"),
        ("the range is larger", CONTROLLED, ("system.parameters.k.range", [0, 4]), "INVALID"),
        (
            "an output reaches 0, about the dual",
            OBSERVED,
            ("system.channels.0.C.0.0", "20*a - 20"),
            "INVALID",
        ),
        ("a cell is missing", OBSERVED, ("witness.cuts", [0, None]), "INVALID"),
        ("a part is missing", OBSERVED, ("witness.parts", []), "MALFORMED"),
        ("a frame is missing", CONTROLLED, ("witness.parts.0.frames", []), "MALFORMED"),
        ("R is 0", CONTROLLED, ("witness.parts.0.frames.0.R.re", [[0, 0]] * 4), "INVALID"),
    ]
)


@pytest.mark.parametrize("part", ["cuts", "parts"])
def test_every_part_of_the_witness_is_needed(part: str) -> None:
    assert checked(without(CONTROLLED, f"witness.{part}")).verdict == "MALFORMED"


def test_the_statement_names_the_ranges() -> None:
    assert says(checked(CONTROLLED).statement, "real parameter")
    assert says(checked(OBSERVED).statement, "dual plant")


def test_gains_from_the_state_to_several_channels_have_discs_as_well() -> None:
    """The modes 1 and −1 are moved to −3 and 4: the first by −4 (k + 1/2), within 4/16 + 1/16."""
    first, second = ([["k + 1/2"], [0]], [[1, 0]]), ([[0], [1]], [[0, 1]])
    system = ranged([["k + 1/2", 0], [0, -1]], first, second, k=("7/16", "9/16"))
    one = {"denominator": 1, "re": [[1, 0], [0, 1]], "im": [[0, 0], [0, 0]]}

    def discs(F: Any, *given: tuple[str, str]) -> Document:
        around = [{"re": re, "im": "0", "radius": radius} for re, radius in given]
        return {"F": F, "Y": one, "T": one, "discs": around}

    moved = discs([matrix([-4, 0], [0, 5])], ("-3", "0.32"), ("4", "0.01"))
    exterior = [discs(None, ("1", "0.07"), ("-1", "0.01")), moved]
    part = {"exterior": exterior, "frames": [], "cover": [[], []]}
    claim = {"channels": ["1", "2"], "bound": None}
    document = certificate(CONTROLLABLE, system, claim, {"cuts": [None], "parts": [part]})
    assert checked(document).verdict == "VALID"
    place = "witness.parts.0.exterior.1.discs.0.radius"
    assert checked(changed(document, (place, "0.31"))).code == "disc"
