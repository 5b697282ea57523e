"""The rule of ``controllability``."""

from __future__ import annotations

import pytest

from tests.checker.handmade import (
    CONTROLLABLE,
    UNCONTROLLABLE,
    Document,
    certificate,
    changed,
    checked,
    matrix,
    plant,
)
from tests.checker.tables import accepts

NOTHING = certificate(
    "controllability",
    plant([[0, 1], [0, 0]], ([[0], [0]], [[1, 0]])),
    {
        "channels": ["1"],
        "dimension": 0,
        "controllable": False,
        "uncontrollable_polynomial": [0, 0, 1],
    },
    {"modulus": 2, "annihilator": matrix([1, 0], [0, 1]), "pivots": [0, 1]},
)
NOBODY = changed(NOTHING, ("claim.channels", []))
NO_STATES = certificate(
    "controllability",
    plant([], ([], [])),
    {"channels": ["1"], "dimension": 0, "controllable": True, "uncontrollable_polynomial": [1]},
    {"modulus": 2, "annihilator": matrix(), "pivots": []},
)
ROW = certificate(
    "controllability",
    plant([[1, 0], [1, 2]], ([[1], [-1]], [[0, 0]])),
    {
        "channels": ["1"],
        "dimension": 1,
        "controllable": False,
        "uncontrollable_polynomial": [-2, 1],
    },
    {"modulus": 5, "annihilator": matrix([1, 1]), "pivots": [1]},
)

ACCEPTED = [
    ("a mode that the input does not reach", UNCONTROLLABLE),
    ("the other pivot of the same row", changed(ROW, ("witness.pivots", [0]))),
    ("a row that is no unit vector", ROW),
    ("a controllable chain", CONTROLLABLE),
    ("an input of zeros", NOTHING),
    ("no channels", NOBODY),
    ("no states", NO_STATES),
    ("another modulus", changed(UNCONTROLLABLE, ("witness.modulus", 2))),
    ("channels that add nothing", changed(CONTROLLABLE, ("claim.channels", ["1", "2"]))),
    (
        "observability, by the dual",
        changed(UNCONTROLLABLE, ("subject", [{"construction": "dual"}])),
    ),
]

REJECTED = [
    ("called controllable", UNCONTROLLABLE, ("claim.controllable", True), "INVALID"),
    ("called uncontrollable", CONTROLLABLE, ("claim.controllable", False), "INVALID"),
    ("an empty W", UNCONTROLLABLE, ("witness.annihilator", matrix()), "MALFORMED"),
    ("a W without columns", UNCONTROLLABLE, ("witness.annihilator", matrix([])), "MALFORMED"),
    ("W = 0", UNCONTROLLABLE, ("witness.annihilator", matrix([0, 0])), "INVALID"),
    ("W B is not 0", UNCONTROLLABLE, ("witness.annihilator", matrix([1, 1])), "INVALID"),
    ("W A is not Z W", NOTHING, ("witness.annihilator", matrix([1, 0], [0, 2])), "INVALID"),
    ("a dimension too high", UNCONTROLLABLE, ("claim.dimension", 2), "INVALID"),
    ("a dimension too low", CONTROLLABLE, ("claim.dimension", 1), "INVALID"),
    ("a dimension above n", UNCONTROLLABLE, ("claim.dimension", 3), "INVALID"),
    ("a channel that does not control", CONTROLLABLE, ("claim.channels", ["2"]), "INVALID"),
    ("an unknown channel", CONTROLLABLE, ("claim.channels", ["0"]), "MALFORMED"),
    ("another polynomial", UNCONTROLLABLE, ("claim.uncontrollable_polynomial", [-1, 1]), "INVALID"),
    ("a power of it", UNCONTROLLABLE, ("claim.uncontrollable_polynomial", [4, -4, 1]), "INVALID"),
    ("modulus 1", UNCONTROLLABLE, ("witness.modulus", 1), "INVALID"),
    ("modulus 0", UNCONTROLLABLE, ("witness.modulus", 0), "INVALID"),
    (
        "a modulus that divides a denominator",
        changed(UNCONTROLLABLE, ("system.channels.0.B", [["1/7"], [0]])),
        ("witness.modulus", 7),
        "INVALID",
    ),
    (
        "a rank that is lost modulo ℓ proves nothing",
        changed(CONTROLLABLE, ("system.A.1.0", 7)),
        ("witness.modulus", 7),
        "INVALID",
    ),
    (
        "a pivot that is no unit",
        changed(CONTROLLABLE, ("system.A.1.0", 2)),
        ("witness.modulus", 6),
        "INVALID",
    ),
]


test_sound_evidence_is_accepted = accepts(ACCEPTED)


@pytest.mark.parametrize(("reason", "document", "edit", "expected"), REJECTED)
def test_a_change_of_one_place_is_rejected(
    reason: str, document: Document, edit: tuple[str, object], expected: str
) -> None:
    verdict = checked(changed(document, edit))
    assert verdict.verdict == expected, verdict.line()


def test_the_words_say_which_system_and_which_channels() -> None:
    observability = changed(UNCONTROLLABLE, ("subject", [{"construction": "dual"}]))
    assert checked(observability).theorem == (
        "the channels {1} of the dual of the plant (continuous time, 2 states, 1 channel) control "
        "a subspace of dimension exactly 1: not controllable through them together; "
        "uncontrollable polynomial x - 2"
    )
