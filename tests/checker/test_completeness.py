"""The rule of ``completeness``: yes by gains or by blocks, no by a fixed mode or by a cut."""

from __future__ import annotations

from tests.checker.handmade import (
    COMPLETE,
    CUT,
    INTEGRATOR,
    MODE,
    certificate,
    changed,
    checked,
    matrix,
    plant,
)
from tests.checker.tables import accepts, rejects
from tests.checker.test_blocks import block, one_state
from tests.wording import worded

EXCHANGE = certificate(
    "completeness",
    plant([[0, 1], [1, 0]], ([[1], [0]], [[1, 0]]), ([[0], [1]], [[0, 1]])),
    {"complete": True},
    {
        "modulus": 101,
        "gains": [matrix([2]), matrix([3])],
        "arcs": [["1", "2", 1], ["2", "1", 1]],
    },
)

BY_BLOCKS = changed(
    COMPLETE, ("witness", {"modulus": 7, "blocks": [block([0], one_state("1"))], "arcs": []})
)

EVERYBODY = {"from": ["1", "2"], "X": matrix([1, 0], [0, 1]), "pivots": [0, 1]}

ALONG = certificate(
    "completeness",
    plant(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
        ([[1], [0], [0]], [[1, 0, 0]]),
        ([[0], [1], [0]], [[0, 0, 1]]),
        ([[0], [0], [1]], [[0, 1, 0]]),
    ),
    {"complete": False},
    {"from": ["2", "3"]},
)
"""Channel 1 drives the others along a chain of states, and nothing leads back to it."""
FAR = changed(ALONG, ("system.channels.2.C", [[0, 0, 1]]))
"""The others see the end of the chain alone."""

ACCEPTED = [
    ("one integrator", COMPLETE),
    ("one integrator, by a block", BY_BLOCKS),
    ("two channels that reach each other", EXCHANGE),
    ("one channel needs no arcs", changed(COMPLETE, ("witness.arcs", []))),
    ("a cut between integrators", CUT),
    ("a cut that no path crosses", ALONG),
    (
        "the same for one of them, where the other is not measured",
        changed(ALONG, ("witness.from", ["3"]), ("system.channels.1.C", [[1, 0, 0]])),
    ),
    ("the paper's fixed mode", MODE),
    ("other gains", changed(EXCHANGE, ("witness.gains.0", matrix([5])))),
]

REJECTED = [
    ("yes turned into no", COMPLETE, ("claim.complete", False)),
    ("no turned into yes", MODE, ("claim.complete", True)),
    ("no turned into yes, by a cut", CUT, ("claim.complete", True)),
    ("1 for true", COMPLETE, ("claim.complete", 1)),
    ("gains that move nothing", COMPLETE, ("witness.gains.0", matrix([0]))),
    ("gains that move nothing modulo ℓ", COMPLETE, ("witness.gains.0", matrix([7]))),
    ("a block that may have a fixed mode", BY_BLOCKS, ("witness.blocks.0.evidence", None)),
    ("blocks of a state too few", EXCHANGE, ("witness", BY_BLOCKS["witness"])),
    ("arcs that do not connect", EXCHANGE, ("witness.arcs", [["1", "2", 1]])),
    ("an arc that is not there", EXCHANGE, ("witness.arcs.0", ["1", "2", 0])),
    ("an arc twice", EXCHANGE, ("witness.arcs", [["1", "2", 1], ["1", "2", 1]])),
    ("modulus 1", EXCHANGE, ("witness.modulus", 1)),
    ("gains of zeros", EXCHANGE, ("witness.gains", [matrix([0]), matrix([0])])),
    ("a cut from nobody", CUT, ("witness.zero.from", [])),
    ("a cut from everybody", CUT, ("witness.zero", EVERYBODY)),
    ("a cut that leaks", CUT, ("system.channels.0.C", [[1, 1]])),
    ("a cut that is not invariant", CUT, ("system.A.0.1", 1)),
    ("a cut that a path crosses, one way", ALONG, ("witness.from", ["1"])),
    ("a path over a state between", ALONG, ("witness.from", ["1", "3"])),
    ("a path of several entries", FAR, ("witness.from", ["1"])),
    ("an entry that leads back", ALONG, ("system.A.0.2", 1)),
    ("an output that sees the last state", ALONG, ("system.channels.0.C", [[1, 0, 1]])),
    ("an input on the first state", ALONG, ("system.channels.2.B", [[1], [0], [1]])),
    ("no channels", ALONG, ("witness.from", [])),
    ("all channels", ALONG, ("witness.from", ["1", "2", "3"])),
    ("channels out of order", ALONG, ("witness.from", ["3", "2"])),
    ("a channel that is not there", ALONG, ("witness.from", ["2", "4"])),
    ("a channel by its position", ALONG, ("witness.from", [1, 2])),
    ("yes by a cut along paths", ALONG, ("claim.complete", True)),
    ("a cut by paths and by a subspace", ALONG, ("witness.zero", EVERYBODY)),
    ("no evidence", MODE, ("witness", {})),
    ("both kinds of evidence", MODE, ("witness", {**MODE["witness"], **CUT["witness"]})),
    ("deg p = 0", MODE, ("witness.polynomial", [1])),
    ("another polynomial", MODE, ("witness.polynomial", [-2, 1])),
    ("u = rank B_T, no drop", MODE, ("witness.subspace.channels_T", ["1", "2"])),
    ("a plant without that mode", MODE, ("system.channels.2.C", [[1, 0, 0]])),
]  # fmt: skip


test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)


def test_uncontrollable_modes_count_although_no_subsystem_sees_them() -> None:
    # A = diag(0, 1), B_i = (1, 0)', C_i = (1, 1): every complementary subsystem looks complete.
    port = ([[1], [0]], [[1, 1]])
    denied = certificate(
        "completeness",
        plant([[0, 0], [0, 1]], port, port),
        {"complete": True},
        {
            "modulus": 101,
            "gains": [matrix([1]), matrix([1])],
            "arcs": [["1", "2", 0], ["2", "1", 0]],
        },
    )
    assert checked(denied).code == "common_factor"
    assert checked(changed(denied, ("system", INTEGRATOR))).verdict == "MALFORMED"


def test_the_message_names_the_channel_by_its_number_from_1() -> None:
    assert checked(CUT).verdict == "VALID"
    verdict = checked(changed(CUT, ("system.channels.0.C", [[0, 1]])))
    assert verdict.code == "identity" and worded(verdict.message)
