"""The rule of ``deficiency``."""

from __future__ import annotations

from tests.checker.handmade import (
    INTEGRATOR,
    LOSS,
    NO_LOSS,
    certificate,
    changed,
    checked,
    layers,
    matrix,
    plant,
)
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

MOVED = {
    "modulus": 7,
    "gains": [matrix([0])],
    "channel": "1",
    "inputs": [1],
    "outputs": [1],
    "recurrence": [0, 1],
    "cofactors": [[1], []],
}
FREE = certificate(
    "deficiency",
    INTEGRATOR,
    {"deficiency": 0},
    {"blocks": [{"states": [0], "evidence": MOVED}], "modulus": None, "losses": []},
)


def loss(p: list[int], deficiency: int, *states: int) -> dict[str, object]:
    """States that no channel drives or sees, at a root of p."""
    U = layers([[int(a == state) for state in states] for a in range(4)])
    space = {"channels_T": [], "U": U, "V": layers([]), "pivots": list(states)}
    return {"polynomial": p, "deficiency": deficiency, "subspace": space}


STILL = certificate(
    "deficiency",
    plant(
        [[0, 0, 0, 0], [0, 2, 0, 0], [0, 0, 2, 0], [0, 0, 0, 3]],
        ([[1], [0], [0], [0]], [[1, 0, 0, 0]]),
    ),
    {"deficiency": 2},
    {
        "blocks": [
            {"states": [0], "evidence": MOVED},
            {"states": [1, 2, 3], "evidence": None},
        ],
        "modulus": 7,
        "losses": [loss([-2, 1], 2, 1, 2), loss([-3, 1], 1, 3)],
    },
)
"""An integrator beside two states with the mode 2 and one with the mode 3."""
P = "witness.losses"

ACCEPTED = [
    ("one block that leaves nothing", FREE),
    ("two modes, one of which loses more", STILL),
    ("the least modulus", changed(STILL, ("witness.modulus", 2))),
    ("the other mode first", changed(STILL, (P, STILL["witness"]["losses"][::-1]))),
    (
        "the whole state fixed",
        changed(
            STILL,
            ("system.channels.0.B", [[0]] * 4),
            ("system.channels.0.C", [[0, 0, 0, 0]]),
            ("witness.blocks", [{"states": [0, 1, 2, 3], "evidence": None}]),
            (P, [*STILL["witness"]["losses"], loss([0, 1], 1, 0)]),
        ),
    ),
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
    ("more than the blocks leave", FREE, ("claim.deficiency", 1), "INVALID"),
    ("a block that says nothing", FREE, ("witness.blocks.0.evidence", None), "INVALID"),
    ("a modulus of nothing", FREE, ("witness.modulus", 7), "INVALID"),
    ("no modulus for factors", STILL, ("witness.modulus", None), "MALFORMED"),
    ("gains besides", FREE, ("witness.gains", []), "MALFORMED"),
    ("no list of losses", FREE, (P, None), "MALFORMED"),
    ("the smaller loss", STILL, ("claim.deficiency", 1), "INVALID"),
    ("a larger loss", STILL, ("claim.deficiency", 3), "INVALID"),
    ("a factor left out", STILL, (P, [loss([-2, 1], 2, 1, 2)]), "INVALID"),
    ("a loss too low", STILL, (f"{P}.0.deficiency", 1), "INVALID"),
    ("a loss too high", STILL, (f"{P}.1.deficiency", 2), "INVALID"),
    ("a loss of nothing", STILL, (f"{P}.1.deficiency", 0), "MALFORMED"),
    ("a factor twice", STILL, (P, [loss([-2, 1], 1, 1), loss([-2, 1], 2, 1, 2)]), "INVALID"),
    ("a root twice", STILL, (P, [loss([4, -4, 1], 1, 1), loss([-3, 1], 1, 3)]), "INVALID"),
    ("factors that are one modulo ℓ", changed(STILL, ("system.A.3.3", 3)), ("witness.modulus", 1)),
    ("deg p = 0 in a loss", STILL, (f"{P}.0.polynomial", [1]), "MALFORMED"),
    ("another mode", STILL, (f"{P}.0.polynomial", [-4, 1]), "INVALID"),
    ("a channel that moves the state", STILL, ("system.channels.0.B.3.0", 1)),
]


test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)


def test_a_mode_is_a_root_of_a_polynomial_that_is_not_constant() -> None:
    verdict = checked(changed(LOSS, ("witness.polynomial", [1])))
    assert (verdict.verdict, verdict.place) == ("MALFORMED", "witness.polynomial")
    verdict = checked(changed(STILL, (f"{P}.0.polynomial", [1])))
    assert (verdict.verdict, verdict.place) == ("MALFORMED", f"{P}[0]")
