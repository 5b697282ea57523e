"""The rule of ``stability``."""

from __future__ import annotations

from typing import Any

from tests.checker.handmade import Document, certificate, changed, matrix, plant
from tests.checker.tables import accepts, rejects

POLYNOMIAL: Document = {"method": "polynomial"}
UNIT = matrix([1, 0], [0, 1])


def loop(A: Any, time: str = "continuous") -> Document:
    """A matrix alone: a plant whose one channel has neither input nor output."""
    none = {"shape": [0, len(A)], "entries": []} if A else []
    return plant(A, ([[] for _ in A], none), time=time)


def claim(stable: bool, bound: Any = None) -> Document:
    return {"bound": bound, "stable": stable}


def form(P: Document, R: Document = UNIT, R2: Document = UNIT) -> Document:
    return {"size": len(P["entries"]), "P": P, "R": R, "R2": R2}


SLOW = loop([[-1, 0], [0, -2]])
BY_POLYNOMIAL = certificate("stability", SLOW, claim(True), POLYNOMIAL)
BY_LYAPUNOV = certificate(
    "stability",
    SLOW,
    claim(True),
    {"method": "lyapunov", "transformation": None, "blocks": [form(UNIT)]},
)
# M = [0 1; -2 -3] has eigenvalues -1 and -2; T holds the eigenvectors.
BY_BLOCKS = certificate(
    "stability",
    loop([[0, 1], [-2, -3]]),
    claim(True),
    {
        "method": "lyapunov",
        "transformation": {
            "T": matrix([1, 1], [-1, -2]),
            "Delta": matrix([-1, 0], [0, -2]),
            "modulus": 7,
        },
        "blocks": [form(matrix([1]), matrix([1]), matrix([1]))] * 2,
    },
)
IN_DISCRETE_TIME = certificate(
    "stability",
    loop([["1/2", 0], [0, "-1/3"]], time="discrete"),
    claim(True, "3/4"),
    {"method": "lyapunov", "transformation": None, "blocks": [form(UNIT)]},
)
UNSTABLE = certificate(
    "stability",
    loop([[1, 0], [0, -1]]),
    claim(False),
    {"method": "instability", "P": matrix([-1, 0], [0, 1]), "R2": UNIT, "v": matrix([1], [0])},
)
ROTATION = certificate("stability", loop([[0, 1], [-1, 0]]), claim(False), POLYNOMIAL)
ALONE = form(matrix([1]), matrix([1]), matrix([1]))
APART = certificate(
    "stability",
    loop([[-1, 2], [0, -1]]),
    claim(True),
    {"method": "lyapunov", "transformation": None, "blocks": [ALONE, ALONE]},
)
"""The second state drives the first; if the first drives the second, too, 1 is an eigenvalue."""
THREE = matrix([1, 0, 0], [0, 1, 0], [0, 0, 1])

ACCEPTED = [
    ("a block that drives another", APART),
    ("two real eigenvalues, by the polynomial", BY_POLYNOMIAL),
    ("the same by a quadratic form", BY_LYAPUNOV),
    ("a rate just below the slowest", changed(BY_LYAPUNOV, ("claim.bound", "99/100"))),
    ("block by block", BY_BLOCKS),
    ("a radius", IN_DISCRETE_TIME),
    ("a radius by the polynomial", changed(IN_DISCRETE_TIME, ("witness", POLYNOMIAL))),
    ("one unstable eigenvalue", UNSTABLE),
    ("a direction in which the form is zero", changed(UNSTABLE, ("witness.v", matrix([1], [1])))),
    ("the same by the polynomial", changed(UNSTABLE, ("witness", POLYNOMIAL))),
    ("eigenvalues exactly on the boundary", ROTATION),
    ("a rate met with equality is not met", changed(
        BY_POLYNOMIAL, ("claim.bound", 1), ("claim.stable", False)
    )),
    ("no states", certificate("stability", loop([]), claim(True), POLYNOMIAL)),
]  # fmt: skip

REJECTED = [
    ("a block beyond the states", BY_LYAPUNOV, ("witness.blocks", [form(THREE, THREE, THREE)])),
    ("a block too many", BY_LYAPUNOV, ("witness.blocks", [form(UNIT), form(matrix([1]))])),
    ("blocks that act on each other", APART, ("system.A.1.0", 2)),
    ("a stable loop called unstable, by the same form", BY_LYAPUNOV, ("claim.stable", False)),
    ("a form besides the polynomial", BY_POLYNOMIAL, ("witness.P", UNIT)),
    ("the opposite claim", BY_POLYNOMIAL, ("claim.stable", False)),
    ("a rate met only with equality", BY_LYAPUNOV, ("claim.bound", 1)),
    ("a rate met only with equality, by the polynomial", BY_POLYNOMIAL, ("claim.bound", 1)),
    ("the boundary called stable", ROTATION, ("claim.stable", True)),
    ("a negative rate", BY_LYAPUNOV, ("claim.bound", -1)),
    ("a radius above 1", IN_DISCRETE_TIME, ("claim.bound", 2)),
    ("a radius of 0", IN_DISCRETE_TIME, ("claim.bound", 0)),
    ("the other time domain", IN_DISCRETE_TIME, ("system.time", "continuous")),
    ("P not of integers", BY_LYAPUNOV, ("witness.blocks.0.P.entries", [["1", 0], [0, 1]])),
    ("P not symmetric", BY_LYAPUNOV, ("witness.blocks.0.P", matrix([9, 1], [0, 9]))),
    ("P negative definite", BY_LYAPUNOV, ("witness.blocks.0.P", matrix([-1, 0], [0, -1]))),
    ("R of zeros", BY_LYAPUNOV, ("witness.blocks.0.R", matrix([0, 0], [0, 0]))),
    ("R not square", BY_LYAPUNOV, ("witness.blocks.0.R", matrix([1], [0]))),
    ("R2 of rank 1", BY_LYAPUNOV, ("witness.blocks.0.R2", matrix([1, 0], [0, 0]))),
    ("a block missing", BY_LYAPUNOV, ("witness.blocks", [])),
    ("a block of a wrong size", BY_LYAPUNOV, ("witness.blocks.0.size", 1)),
    ("T singular", BY_BLOCKS, ("witness.transformation.T", matrix([0, 0], [0, 0]))),
    ("another Δ", BY_BLOCKS, ("witness.transformation.Delta", matrix([-2, 0], [0, -1]))),
    ("Δ not triangular", BY_BLOCKS, ("witness.transformation", None)),
    ("modulus 1", BY_BLOCKS, ("witness.transformation.modulus", 1)),
    ("another loop", BY_BLOCKS, ("system.A.1.1", -4)),
    ("v = 0", UNSTABLE, ("witness.v", matrix([0], [0]))),
    ("a v where P is positive", UNSTABLE, ("witness.v", matrix([0], [1]))),
    ("instability of a stable loop", UNSTABLE, ("system.A.0.0", -1)),
    ("instability called stability", UNSTABLE, ("claim.stable", True)),
    ("an unknown method", BY_POLYNOMIAL, ("witness.method", "eigenvalues")),
]


test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)
