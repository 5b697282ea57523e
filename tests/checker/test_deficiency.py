"""The rule of ``deficiency``."""

from __future__ import annotations

from tests.checker.handmade import LOSS, NO_LOSS, changed, checked, matrix
from tests.checker.tables import accepts, rejects

SHARED = changed(
    LOSS,
    ("subject", [{"construction": "augmented_outputs"}]),
    ("witness.gains", [matrix([1, 0, 0]), matrix([2, 0]), matrix([0, 0, 0])]),
    ("witness.subspace.channels_T", ["1", "3"]),
    (
        "witness.subspace.V",
        {"denominator": 1, "coefficients": [[[0, 0], [0, 0]]]},
    ),
)

ACCEPTED = [
    ("the paper's plant loses 1", LOSS),
    ("it still does when outputs are shared", SHARED),
    ("an integrator loses nothing", NO_LOSS),
    ("another completion", changed(LOSS, ("witness.C0", matrix([0, 0, 5])))),
    ("another modulus", changed(LOSS, ("witness.modulus", 7))),
]

REJECTED = [
    ("a loss too high", LOSS, ("claim.deficiency", 2)),
    ("a loss denied", LOSS, ("claim.deficiency", 0)),
    ("a negative loss", NO_LOSS, ("claim.deficiency", -1)),
    ("no subspace", LOSS, ("witness.subspace", None)),
    ("no polynomial", LOSS, ("witness.polynomial", None)),
    ("a polynomial for no loss", NO_LOSS, ("witness.polynomial", [0, 1])),
    ("deg p = 0", LOSS, ("witness.polynomial", [1])),
    ("a completion of zeros", LOSS, ("witness.B0", matrix([0], [0], [0]))),
    ("gains of zeros", LOSS, ("witness.gains.1", matrix([0]))),
    ("modulus 1", LOSS, ("witness.modulus", 1)),
    ("modulus 0", NO_LOSS, ("witness.modulus", 0)),
    ("T that drives too much", LOSS, ("witness.subspace.channels_T", ["1", "2"])),
    ("another plant", LOSS, ("system.A.2.2", 2)),
]


test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)


def test_a_mode_is_a_root_of_a_polynomial_that_is_not_constant() -> None:
    verdict = checked(changed(LOSS, ("witness.polynomial", [1])))
    assert (verdict.verdict, verdict.place) == ("MALFORMED", "witness.polynomial")
