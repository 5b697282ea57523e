"""The rule of ``single_channel_gains``: indices for yes, a stuck mode or a cut for no."""

from __future__ import annotations

from tests.checker.handmade import (
    PAIR,
    certificate,
    changed,
    checked,
    layers,
    matrix,
    plant,
)
from tests.checker.tables import accepts, rejects
from tests.wording import says

RING = plant([[1, 0], [0, 1]], ([[1], [0]], [[0, 1]]), ([[0], [1]], [[1, 0]]))
E1, E2 = matrix([1, 0]), matrix([0, 1])
BOTH = certificate(
    "single_channel_gains",
    RING,
    {
        "channels": ["1", "2"],
        "property": "both",
        "exists": True,
        "cyclic": True,
        "indices": [[2, 2], [2, 2]],
    },
    {
        "gains": [matrix([1]), matrix([1])],
        "modulus": 7,
        "annihilators": [[E2, E1], [E1, E2]],
        "generator": matrix([1], [0]),
    },
)
ONE = certificate(
    "single_channel_gains",
    RING,
    {
        "channels": ["2"],
        "property": "observable",
        "exists": True,
        "cyclic": False,
        "indices": [[2]],
    },
    {
        "gains": [matrix([3]), matrix([0])],
        "modulus": 10,
        "annihilators": [[E2]],
        "generator": None,
    },
)
NO_STATES = certificate(
    "single_channel_gains",
    plant([], ([], [])),
    {
        "channels": ["1"],
        "property": "controllable",
        "exists": True,
        "cyclic": False,
        "indices": [[0]],
    },
    {"gains": [matrix()], "modulus": 7, "annihilators": [[matrix([])]], "generator": None},
)
REFUSED = {"property": "controllable", "exists": False, "cyclic": False, "indices": None}
STUCK = certificate(
    "single_channel_gains",
    PAIR,
    {"channels": ["1"], **REFUSED},
    {
        "channel": "1",
        "side": "controllable",
        "polynomial": [-2, 1],
        "subspace": {
            "channels_T": ["1"],
            "U": layers([[1, 0], [0, 1]]),
            "V": layers([[1, 0]]),
            "pivots": [0, 1],
        },
    },
)
APART = plant([[0, 0], [0, 1]], ([[1], [0]], [[1, 0]]), ([[0], [1]], [[0, 1]]))
CUT = certificate(
    "single_channel_gains",
    APART,
    {"channels": ["1"], **REFUSED},
    {
        "channel": "1",
        "side": "controllable",
        "zero": {"from": ["1"], "X": matrix([1], [0]), "pivots": [0]},
    },
)
BLIND = changed(
    CUT, ("claim.property", "both"), ("witness.side", "observable"), ("claim.channels", ["1", "2"])
)
DEAD = changed(CUT, ("system.channels.1.C", [[0, 0]]))

ACCEPTED = [
    ("both properties through both channels", BOTH),
    ("observed by the second channel alone", ONE),
    ("no states have index 0", NO_STATES),
    ("a mode out of reach", STUCK),
    ("a channel that nothing else hears", CUT),
    ("the same on the dual", BLIND),
    ("other gains", changed(BOTH, ("witness.gains.0", matrix([5])))),
    (
        "cyclic, but not said so",
        changed(BOTH, ("claim.cyclic", False), ("witness.generator", None)),
    ),
    ("another generator", changed(BOTH, ("witness.generator", matrix([2], [1])))),
    (
        "one channel of two",
        changed(
            STUCK,
            ("system.channels.0.name", "a"),
            ("claim.channels", ["a"]),
            ("witness.channel", "a"),
            ("witness.subspace.channels_T", ["a"]),
        ),
    ),
]

REJECTED = [
    ("an index too low", BOTH, (("claim.indices.0.0", 1),)),
    ("an index too high", BOTH, (("claim.indices.0.0", 3),)),
    ("an index of 0 with states", BOTH, (("claim.indices.0.0", 0),)),
    ("an index that was not asked", ONE, (("claim.indices", [[2, 2]]),)),
    ("no gains at all", BOTH, (("witness.gains", [matrix([0]), matrix([0])]),)),
    ("gains that vanish modulo ℓ", BOTH, (("witness.gains.1", matrix([7])),)),
    ("gains of one channel alone", BOTH, (("witness.gains.1", matrix([0])),)),
    ("a row that is not annihilated", BOTH, (("witness.annihilators.0.0", E1),)),
    ("a row of zeros", BOTH, (("witness.annihilators.0.0", matrix([0, 0])),)),
    (
        "a row that is zero in B only modulo ℓ",
        BOTH,
        (("witness.annihilators.0.0", matrix([7, 1])),),
    ),
    ("a generator of an eigenvector", BOTH, (("witness.generator", matrix([1], [1])),)),
    ("a generator of zeros", BOTH, (("witness.generator", matrix([0], [0])),)),
    ("a generator that nobody asked for", ONE, (("witness.generator", matrix([1], [0])),)),
    ("cyclic without a generator", ONE, (("claim.cyclic", True),)),
    ("modulus 1", BOTH, (("witness.modulus", 1),)),
    ("index 1 without states", NO_STATES, (("claim.indices", [[1]]),)),
    ("no turned into yes", STUCK, (("claim.exists", True),)),
    ("yes turned into no", BOTH, (("claim.exists", False),)),
    ("a refusal with indices", STUCK, (("claim.indices", [[1]]),)),
    ("a refusal that is cyclic", STUCK, (("claim.cyclic", True),)),
    ("deg p = 0", STUCK, (("witness.polynomial", [1]),)),
    ("another mode", STUCK, (("witness.polynomial", [-1, 1]),)),
    ("a side that was not asked", STUCK, (("witness.side", "observable"),)),
    ("a channel outside T", CUT, (("claim.channels", ["2"]), ("witness.channel", "2"))),
    ("a channel that was not asked", BLIND, (("claim.channels", ["2"]),)),
    ("a cut behind which nothing is measured", CUT, (("system.channels.1.C", [[0, 0]]),)),
    ("a cut that leaks", CUT, (("system.channels.1.C", [[1, 1]]),)),
    ("a cut that is not invariant", CUT, (("system.A.1.0", 1),)),
    (
        "a cut from everybody",
        CUT,
        (("witness.zero", {"from": ["1", "2"], "X": matrix([1, 0], [0, 1]), "pivots": [0, 1]}),),
    ),
    ("a mode that is reached after all", STUCK, (("system.A.1.0", 1),)),
]


test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)


def test_a_dead_channel_hinders_nobody_but_itself() -> None:
    assert checked(DEAD).code == "cut"


def test_the_words_name_the_indices() -> None:
    assert (
        'for every q in {"1", "2"}, with the indices {"1":[2,2],"2":[2,2]}, and A_F cyclic'
        in checked(BOTH).statement
    )
    assert says(checked(STUCK).statement, "same make")
    assert " (C_q, A_F) observable for every q in {" in checked(BLIND).statement


def test_a_mode_is_a_root_of_a_polynomial_that_is_not_constant() -> None:
    verdict = checked(changed(STUCK, ("witness.polynomial", [1])))
    assert (verdict.verdict, verdict.place) == ("MALFORMED", "witness.polynomial")
