"""The rule of ``controllability``."""

from __future__ import annotations

import pytest

from mcexact.checker.core.reach import krylov_ranks
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import digest, read_plant
from mcexact.checker.structure import require_reached
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
from tests.wording import worded

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
STILL = certificate(
    "controllability",
    plant([[0, 0], [0, 0]], ([[0], [0]], [[0, 0]])),
    NOTHING["claim"],
    NOTHING["witness"],
)
"""Two states that nothing moves."""
CHAINED = certificate(
    "controllability",
    plant([[0, 1], [0, 0]], ([[0], [1]], [[0, 0]]), ([[0], [0]], [[0, 0]])),
    {**NOTHING["claim"], "channels": ["2"]},
    NOTHING["witness"],
)
HALF = {
    "channels": ["1"],
    "dimension": 1,
    "controllable": False,
    "uncontrollable_polynomial": [0, 1],
}
FIRST = changed(
    CHAINED,
    ("claim", HALF),
    ("witness", {"modulus": 7, "annihilator": matrix([1, 0]), "pivots": [0]}),
)
"""W B = 0, but W A = (0, 1) is no multiple of W = (1, 0): channel 1 controls both states."""
ZEROS = changed(
    STILL, ("system.channels.0.B", [[1], [0]]), ("witness.annihilator", matrix([0, 0], [0, 0]))
)
"""W = 0 annihilates everything, also x_1, which the channel controls."""
DRIVEN = changed(
    ROW,
    ("system.A", [[1, 0], [0, 2]]),
    ("system.channels.0.B", [[1], [0]]),
    ("witness.annihilator", matrix([0, 1])),
)

DOUBLE = certificate(
    "controllability",
    plant([[0, 1], [0, 0]], ([[0], [1]], [[1, 0]])),
    {"channels": ["1"], "dimension": 2, "controllable": True, "uncontrollable_polynomial": [1]},
    {
        "blocks": [
            {
                "states": [0, 1],
                "evidence": {
                    "modulus": 7,
                    "gains": [matrix([0])],
                    "channel": "1",
                    "inputs": [1],
                    "outputs": [1],
                    "recurrence": [0, 0, 1],
                    "cofactors": [[1], []],
                },
            }
        ],
        "measured": None,
        "annihilator": matrix(),
        "pivots": [],
    },
)
"""x'' = u, y = x: one sequence of the channel is 0, 1, 0, …."""
S = "witness.blocks.0.evidence"
STATES = changed(
    DOUBLE,
    ("system.channels.0.C", {"shape": [0, 2], "entries": []}),
    ("witness.measured", [[0, 1]]),
    (f"{S}.gains", [matrix([0, 0])]),
    (f"{S}.outputs", [1, 0]),
)
"""The same without outputs; the proof measures both states."""
FIRST_STATE = changed(
    STATES, ("witness.measured", [[0]]), (f"{S}.gains", [matrix([0])]), (f"{S}.outputs", [1])
)
BESIDE = certificate(
    "controllability",
    plant([[1, 0], [0, 2]], ([[1], [0]], [[1, 0]]), ([[0], [1]], [[0, 1]])),
    {
        "channels": ["1"],
        "dimension": 1,
        "controllable": False,
        "uncontrollable_polynomial": [-2, 1],
    },
    {
        "blocks": [
            {
                "states": [0],
                "evidence": {
                    **DOUBLE["witness"]["blocks"][0]["evidence"],
                    "recurrence": [6, 1],
                },
            },
            {"states": [1], "evidence": None},
        ],
        "measured": None,
        "annihilator": matrix([0, 1]),
        "pivots": [1],
    },
)
"""Channel 2 moves what channel 1 does not, and is none of those asked about."""
BOTH = changed(
    BESIDE,
    (
        "claim",
        {
            "channels": ["1", "2"],
            "dimension": 2,
            "controllable": True,
            "uncontrollable_polynomial": [1],
        },
    ),
    (
        "witness.blocks.1.evidence",
        {
            **BESIDE["witness"]["blocks"][0]["evidence"],
            "channel": "2",
            "recurrence": [5, 1],
        },
    ),
    ("witness.annihilator", matrix()),
    ("witness.pivots", []),
)
SECOND = changed(
    BESIDE,
    ("claim.channels", ["2"]),
    ("claim.uncontrollable_polynomial", [-1, 1]),
    ("witness.blocks", [{"states": [0], "evidence": None}, BOTH["witness"]["blocks"][1]]),
    ("witness.annihilator", matrix([1, 0])),
    ("witness.pivots", [0]),
)
NO_CHANNEL = changed(
    BESIDE,
    ("claim.channels", []),
    ("claim.dimension", 0),
    ("claim.uncontrollable_polynomial", [2, -3, 1]),
    ("witness.blocks", [{"states": [0, 1], "evidence": None}]),
    ("witness.annihilator", matrix([1, 0], [0, 1])),
    ("witness.pivots", [0, 1]),
)
OTHERS_STATE = changed(
    BOTH,
    ("witness.measured", [[0], [1]]),
)

FORGED = [
    ("a state that the input drives on", FIRST),
    ("a W of zeros", ZEROS),
    (
        "a dimension that W does not bound",
        changed(CONTROLLABLE, ("claim.dimension", 1), ("claim.controllable", False)),
    ),
]

ACCEPTED = [
    ("two states that nothing moves", STILL),
    ("the channel that does not control", CHAINED),
    ("a mode beside the input", DRIVEN),
    ("a mode that the input does not reach", UNCONTROLLABLE),
    ("the other pivot of the same row", changed(ROW, ("witness.pivots", [0]))),
    ("a row that is no unit vector", ROW),
    ("a controllable chain", CONTROLLABLE),
    ("an input of zeros", NOTHING),
    ("no channels", NOBODY),
    ("no states", NO_STATES),
    ("another modulus", changed(UNCONTROLLABLE, ("witness.modulus", 2))),
    ("channels that add nothing", changed(CONTROLLABLE, ("claim.channels", ["1", "2"]))),
    ("two states, by a sequence of the channel", DOUBLE),
    ("two states that the proof measures", STATES),
    ("the first of them", FIRST_STATE),
    ("a mode that the other channel alone moves", BESIDE),
    ("two blocks with a channel each", BOTH),
    ("the second channel alone", SECOND),
    ("nobody, by blocks", NO_CHANNEL),
    ("nobody who measures", changed(NO_CHANNEL, ("witness.measured", []))),
    ("each measures what it moves", OTHERS_STATE),
    (
        "observability, by the dual",
        changed(UNCONTROLLABLE, ("subject", [{"construction": "dual"}])),
    ),
]

REJECTED = [
    ("W that says nothing", STILL, ("witness.annihilator", matrix([0, 0], [0, 0])), "INVALID"),
    ("W that the states leave", CHAINED, ("claim.channels", ["1"]), "INVALID"),
    ("W that the input drives", DRIVEN, ("system.channels.0.B", [[1], [1]]), "INVALID"),
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
    ("one mode more than the blocks leave", BESIDE, ("witness.blocks.0.evidence", None), "INVALID"),
    ("nothing of the blocks", DOUBLE, (S, None), "INVALID"),
    ("nothing measured", STATES, ("witness.measured", [[]]), "MALFORMED"),
    ("states measured twice", STATES, ("witness.measured", [[1, 1]]), "MALFORMED"),
    ("a state that is not there", STATES, ("witness.measured", [[0, 2]]), "MALFORMED"),
    ("states for too many channels", STATES, ("witness.measured", [[0, 1], []]), "MALFORMED"),
    ("no list of states", STATES, ("witness.measured", 0), "MALFORMED"),
    ("no word of what is measured", DOUBLE, ("witness", {"blocks": []}), "MALFORMED"),
    ("outputs that there are none", STATES, ("witness.measured", None), "MALFORMED"),
    (
        "measures what does not see the first state",
        FIRST_STATE,
        ("witness.measured", [[1]]),
        "INVALID",
    ),
    ("a modulus besides", DOUBLE, ("witness.modulus", 7), "MALFORMED"),
    ("W that the input drives, by blocks", BESIDE, ("claim.channels", ["2"]), "INVALID"),
    (
        "the blocks of all channels for one",
        BOTH,
        (
            "claim",
            {
                "channels": ["1"],
                "dimension": 2,
                "controllable": True,
                "uncontrollable_polynomial": [1],
            },
        ),
        "MALFORMED",
    ),
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
    assert (
        worded(checked(observability).statement)
        and digest(read_plant(UNCONTROLLABLE["system"])) in checked(observability).statement
    )


@pytest.mark.parametrize(("reason", "document"), FORGED)
def test_a_forgery_is_rejected(reason: str, document: Document) -> None:
    assert checked(document).verdict == "INVALID"


@pytest.mark.parametrize(
    ("channel", "blocks", "good"), [(0, 2, True), (0, 3, True), (0, 1, False), (1, 2, False)]
)
def test_a_channel_reaches_every_state_in_some_blocks(
    channel: int, blocks: int, good: bool
) -> None:
    system = read_plant(CHAINED["system"])
    if good:
        require_reached(system, channel, 7, blocks)
    else:
        with pytest.raises(Refused) as found:
            require_reached(system, channel, 7, blocks)
        assert found.value.verdict == "INVALID"


@pytest.mark.parametrize(
    ("channels", "blocks", "ranks"),
    [
        ([0], 9, [0, 1, 2, 2]),
        ([0], 2, [0, 1, 2]),
        ([0], 1, [0, 1]),
        ([0], 0, [0]),
        ([1], 9, [0, 0]),
        ([0, 1], 9, [0, 1, 2, 2]),
        ([], 9, [0]),
    ],
)
def test_ranks_grow_until_they_stop(channels: list[int], blocks: int, ranks: list[int]) -> None:
    assert krylov_ranks(read_plant(CHAINED["system"]), channels, 7, blocks) == ranks
