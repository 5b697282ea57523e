"""The rule of ``controllability_indices``."""

from __future__ import annotations

from tests.checker.handmade import (
    INDICES,
    NO_INDEX,
    certificate,
    changed,
    checked,
    matrix,
    plant,
)
from tests.checker.tables import accepts, rejects

TWO_INPUTS = certificate(
    "controllability_indices",
    plant([[0, 0, 0], [1, 0, 0], [0, 1, 0]], ([[1, 0], [0, 1], [0, 0]], [[0, 0, 1]])),
    {"channels": ["1"], "ranks": [2, 3], "index": 2, "indices": [2, 1]},
    {"modulus": 7, "annihilator": matrix([0, 0, 1])},
)
NO_INPUT = certificate(
    "controllability_indices",
    plant([[0, 1], [0, 0]], ([[0], [0]], [[1, 0]])),
    {"channels": ["1"], "ranks": [], "index": None, "indices": []},
    {"modulus": 7, "annihilator": matrix([1, 0], [0, 1])},
)
NO_STATES = certificate(
    "controllability_indices",
    plant([], ([], [])),
    {"channels": ["1"], "ranks": [], "index": 0, "indices": []},
    {"modulus": 7, "annihilator": matrix()},
)
THREE = certificate(
    "controllability_indices",
    plant([[0, 0, 0], [5, 0, 0], [0, 1, 0]], ([[1], [0], [0]], [[0, 0, 1]])),
    {"channels": ["1"], "ranks": [1, 2, 3], "index": 3, "indices": [3]},
    {"modulus": 7, "annihilator": matrix([0, 0, 1], [0, 1, 0])},
)

ACCEPTED = [
    ("a chain of three", THREE),
    ("a chain of two", INDICES),
    ("a mode that stays out of reach", NO_INDEX),
    ("two inputs, indices 2 and 1", TWO_INPUTS),
    ("an input of zeros has no ranks", NO_INPUT),
    ("no states have index 0", NO_STATES),
    ("another annihilator", changed(INDICES, ("witness.annihilator", matrix([0, -3])))),
    ("another modulus", changed(INDICES, ("witness.modulus", 6))),
]

REJECTED = [
    ("ranks that nobody reaches", INDICES, ("claim.channels", [])),
    ("a rank that is claimed once more", NO_INDEX, ("claim.ranks", [1, 1])),
    ("ranks that fall", INDICES, ("claim.ranks", [2, 1])),
    ("a plant whose ranks stop early modulo ℓ", THREE, ("witness.modulus", 5)),
    ("an index too low", INDICES, ("claim.index", 1)),
    ("an index where there is none", NO_INDEX, ("claim.index", 1)),
    ("no index where there is one", INDICES, ("claim.index", None)),
    ("a rank too low", INDICES, ("claim.ranks", [1])),
    ("a rank too high", NO_INDEX, ("claim.ranks", [2])),
    ("a rank that repeats", INDICES, ("claim.ranks", [1, 1, 2])),
    ("a rank of 0", INDICES, ("claim.ranks", [0, 1, 2])),
    ("ranks beyond n", NO_INDEX, ("claim.ranks", [1, 2, 3])),
    ("the ranks themselves for indices", TWO_INPUTS, ("claim.indices", [2, 3])),
    ("the steps for indices", INDICES, ("claim.indices", [1, 1])),
    ("W with dependent rows", NO_INPUT, ("witness.annihilator", matrix([1, 0], [2, 0]))),
    ("W that does not annihilate B", INDICES, ("witness.annihilator", matrix([1, 0]))),
    ("an empty W", INDICES, ("witness.annihilator", matrix())),
    ("W = 0", NO_INDEX, ("witness.annihilator", matrix([0, 0]))),
    ("W that vanishes modulo ℓ", NO_INDEX, ("witness.annihilator", matrix([0, 7]))),
    ("modulus 1", INDICES, ("witness.modulus", 1)),
    ("a plant whose last rank is lost modulo ℓ", INDICES, ("system.A.1.0", 14)),
    ("a plant that goes on growing", NO_INDEX, ("system.A.1.0", 1)),
]


test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)


def test_the_words_name_the_index() -> None:
    assert checked(TWO_INPUTS).statement.endswith(
        "are [2,3] and do not grow further; the controllability indices are [2,1] and the "
        "controllability index is 2"
    )
    assert checked(NO_INDEX).statement.endswith("the controllability index is none")
