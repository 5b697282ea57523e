"""The rule of ``controllability_indices``."""

from __future__ import annotations

import random
from typing import Any

import pytest

from mcexact.checker import structure
from mcexact.checker.core.arithmetic import Matrix, SparseMatrix
from mcexact.checker.core.evidence import inputs
from mcexact.checker.core.reach import krylov_ranks
from mcexact.checker.core.system import System
from mcexact.checker.structure import banded_krylov_ranks
from tests.checker.handmade import (
    GENERIC,
    INDICES,
    NO_INDEX,
    PAIR,
    certificate,
    changed,
    checked,
    layers,
    listed,
    matrix,
    plant,
)
from tests.checker.tables import accepts, rejects
from tests.wording import says

TWO_PLANT = plant([[0, 0, 0], [1, 0, 0], [0, 1, 0]], ([[1, 0], [0, 1], [0, 0]], [[0, 0, 1]]))
TWO_CLAIM = {"channels": ["1"], "ranks": [2, 3], "index": 2, "indices": [2, 1]}
THREE_PLANT = plant([[0, 0, 0], [5, 0, 0], [0, 1, 0]], ([[1], [0], [0]], [[0, 0, 1]]))
THREE_CLAIM = {"channels": ["1"], "ranks": [1, 2, 3], "index": 3, "indices": [3]}
UNMOVED_PLANT = plant([[0, 1], [0, 0]], ([[0], [0]], [[1, 0]]))
UNMOVED_CLAIM = {"channels": ["1"], "ranks": [], "index": None, "indices": []}
NO_PLANT = plant([], ([], []))
NO_CLAIM = {"channels": ["1"], "ranks": [], "index": 0, "indices": []}
KIND = "controllability_indices"
NONE = {"denominator": 1, "coefficients": [[[], []]]}

# by relations, as they are written
TWO_INPUTS = certificate(KIND, TWO_PLANT, TWO_CLAIM, {**GENERIC, "relations": NONE})
THREE = certificate(KIND, THREE_PLANT, THREE_CLAIM, GENERIC)
NO_STATES = certificate(
    KIND, NO_PLANT, NO_CLAIM, {**GENERIC, "relations": {"denominator": 1, "coefficients": [[]]}}
)
NO_INPUT = certificate(
    KIND, UNMOVED_PLANT, UNMOVED_CLAIM, {**GENERIC, "relations": layers([[1]]), "inputs": [0]}
)
ALL_ANNIHILATED = certificate(
    KIND,
    UNMOVED_PLANT,
    UNMOVED_CLAIM,
    {**GENERIC, "annihilator": matrix([1, 0], [0, 1]), "pivots": [0, 1]},
)
RELATED = certificate(
    KIND,
    PAIR,
    NO_INDEX["claim"],
    {**GENERIC, "relations": layers([[-1]], [[1]]), "inputs": [0]},
)
# three chains of lengths 3, 1 and 1, and the second input is also that of the first
LONG_PLANT = plant(
    [[0, 0, 0, 0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 0]],
    ([[1, 1, 0], [0, 0, 0], [0, 0, 0], [0, 0, 1]], [[0, 0, 1, 0]]),
)
LONG = certificate(
    KIND,
    LONG_PLANT,
    {"channels": ["1"], "ranks": [2, 3, 4], "index": 3, "indices": [3, 1]},
    {
        **GENERIC,
        # B(e_1 − e_2) = 0 and A B e_3 = 0
        "relations": layers([[1, 0], [-1, 0], [0, 0]], [[0, 0], [0, 0], [0, 1]]),
        "inputs": [1, 2],
    },
)
HALVES = certificate(
    KIND,
    plant([["1/2", 0], [0, 0]], ([["1/3"], [0]], [[1, 0]])),
    NO_INDEX["claim"],
    {**GENERIC, "relations": layers([[-1]], [[2]]), "inputs": [0]},
)

ACCEPTED = [
    ("a chain of three needs a modulus alone", THREE),
    ("a chain of two", INDICES),
    ("a mode that stays out of reach, by a row", NO_INDEX),
    ("a mode that stays out of reach, by a relation", RELATED),
    ("two inputs, indices 2 and 1", TWO_INPUTS),
    ("an input of zeros, by a relation of degree 0", NO_INPUT),
    ("an input of zeros, by rows that annihilate it", ALL_ANNIHILATED),
    ("no states have index 0", NO_STATES),
    ("relations of degrees 0 and 1", LONG),
    ("a plant with denominators", HALVES),
    ("another modulus", changed(INDICES, ("witness.modulus", 6))),
    ("a modulus above a byte", changed(LONG, ("witness.modulus", 101))),
    ("a relation over a denominator", changed(RELATED, ("witness.relations.denominator", 3))),
    (
        "a relation that is a multiple",
        changed(RELATED, ("witness.relations", layers([[2]], [[-2]]))),
    ),
    (
        "a relation that is not needed",
        changed(RELATED, ("witness.annihilator", matrix([0, 1])), ("witness.pivots", [1])),
    ),
]

REJECTED = [
    ("ranks that nobody reaches", INDICES, ("claim.channels", [])),
    ("a rank that is claimed once more", NO_INDEX, ("claim.ranks", [1, 1])),
    ("ranks that fall", INDICES, ("claim.ranks", [2, 1])),
    ("a plant whose ranks stop early modulo ℓ", THREE, ("witness.modulus", 5)),
    (
        "a plant whose ranks stop early modulo a long ℓ",
        THREE,
        (
            ("witness.modulus", 101),
            ("system.A.1.0", 101),
        ),
    ),
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
    ("modulus 1", INDICES, ("witness.modulus", 1)),
    ("a plant whose last rank is lost modulo ℓ", INDICES, ("system.A.1.0", 14)),
    ("a plant that goes on growing", NO_INDEX, ("system.A.1.0", 1)),
    (
        "the last of the ranks cut off",
        LONG,
        (
            ("claim.ranks", [2, 3]),
            ("claim.index", None),
            ("claim.indices", [2, 1]),
        ),
    ),
    ("W that moves", NO_INDEX, ("system.A.1.0", 1)),
    ("W that is moved by the input", NO_INDEX, ("system.channels.0.B.1.0", 1)),
    ("W without an identity matrix", NO_INDEX, ("witness.annihilator", matrix([0, 2]))),
    ("W = 0", NO_INDEX, ("witness.annihilator", matrix([0, 0]))),
    (
        "no W and no relation",
        NO_INDEX,
        (
            ("witness.annihilator", matrix()),
            ("witness.pivots", []),
        ),
    ),
    ("pivots that are missing", NO_INDEX, ("witness.pivots", [])),
    ("a relation that does not hold", RELATED, ("witness.relations", layers([[1]], [[1]]))),
    (
        "a relation of too high a degree",
        RELATED,
        (
            "witness.relations",
            layers([[0]], [[-1]], [[1]]),
        ),
    ),
    ("a relation of zeros", RELATED, ("witness.relations", layers([[0]], [[0]]))),
    ("a relation with another input", LONG, ("witness.inputs", [2, 1])),
    (
        "a relation twice",
        LONG,
        (
            ("witness.relations", layers([[1, 1], [-1, -1], [0, 0]])),
            ("witness.inputs", [0, 1]),
            ("claim.ranks", [1]),
            ("claim.indices", [1]),
            ("claim.index", None),
        ),
    ),
    ("one input for two relations", LONG, ("witness.inputs", [2, 2])),
    ("an input beyond all", RELATED, ("witness.inputs", [1]), "MALFORMED"),
    ("an input below all", RELATED, ("witness.inputs", [-1]), "MALFORMED"),
    ("a relation without an input", RELATED, ("witness.inputs", []), "MALFORMED"),
    ("an input without a relation", RELATED, ("witness.inputs", [0, 0]), "MALFORMED"),
    ("no layer of relations", RELATED, ("witness.relations.coefficients", []), "MALFORMED"),
    (
        "layers of another shape",
        LONG,
        (
            "witness.relations",
            layers([[1, 0], [-1, 0]], [[0, 0], [0, 1]]),
        ),
        "MALFORMED",
    ),
    ("relations left out", RELATED, ("witness.relations", None), "MALFORMED"),
    ("rows alone", NO_INDEX, ("witness", {"modulus": 7, "annihilator": matrix([0, 1])})),
]


test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)


def test_the_words_name_the_index() -> None:
    assert says(checked(TWO_INPUTS).statement, "grow further")
    assert says(checked(NO_INDEX).statement, "controllability index")


@pytest.mark.parametrize("ell", [7, 61])
def test_ranks_in_a_band_are_those_of_all_entries(ell: int) -> None:
    rng, stopped = random.Random(ell), 0
    for _ in range(25):
        n, p, blocks = rng.randint(46, 60), rng.randint(1, 6), rng.randint(1, 14)
        cells = {(i, min(i + rng.randint(0, 2), n - 1)): rng.randint(1, 9) for i in range(n)}
        cells |= {(i + 1, i): rng.randint(1, 9) for i in range(n - 1) if rng.random() < 0.9}
        A = SparseMatrix(n, n, sorted((i, j, x) for (i, j), x in cells.items()), 5)
        columns = [(rng.randrange(n), u, rng.randint(1, 6)) for u in range(p - 1)]
        both = Matrix([[0] * 2 for _ in range(n)], 2)
        both.rows[0][0] = both.rows[n // 2][1] = 1
        B = [both, SparseMatrix(n, p - 1, sorted(columns))]
        system = System("continuous", ["1", "2"], A, B, [Matrix.zeros(1, n)] * 2)
        for T in ([0], [1], [0, 1]):
            ranks = krylov_ranks(system, T, ell, blocks)
            ranks += ranks[-1:] * (blocks + 1 - len(ranks))
            assert banded_krylov_ranks(system, T, ell, blocks) == ranks
            stopped += ranks[-1] < min(n, blocks * inputs(system, T).ncols)
        assert banded_krylov_ranks(system, [], ell, blocks) == [0] * (blocks + 1)
    assert stopped > 5


def test_sparse_plants_are_in_a_band_modulo_small_numbers_only(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    n = 46
    chain = listed([[int(i == j + 1) for j in range(n)] for i in range(n)], n)
    claim = {"channels": ["1"], "ranks": [*range(1, n + 1)], "index": n, "indices": [n]}
    found = certificate(KIND, plant(chain, ([[1], *[[0]] * (n - 1)], [[0] * n])), claim, GENERIC)
    asked = list[int]()

    def counting(*arguments: Any) -> list[int]:
        asked.append(arguments[2])
        return banded_krylov_ranks(*arguments)

    monkeypatch.setattr(structure, "banded_krylov_ranks", counting)
    for ell, many in ((7, 1), (61, 2), (67, 2)):
        assert checked(changed(found, ("witness.modulus", ell))).verdict == "VALID"
        assert len(asked) == many
