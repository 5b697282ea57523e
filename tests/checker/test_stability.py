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
FOUR = matrix([1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1])


def diagonal(*entries: int) -> Document:
    return matrix(*([e if i == j else 0 for j in range(4)] for i, e in enumerate(entries)))


def side(P: Document) -> Document:
    return {"P": P, "R": P, "R2": P}


def limited(stable: bool, **limits: Any) -> Document:
    return {**claim(stable), **limits}


# [-3 4; -4 -3] has the eigenvalues -3 + 4i and -3 - 4i: the modulus 5, the damping ratio 3/5.
ROUND = loop([[-3, 4], [-4, -3]])
DAMPED = certificate("stability", ROUND, limited(True, damping="1/2"), POLYNOMIAL)
WITHIN = certificate("stability", ROUND, limited(True, largest_modulus=6), POLYNOMIAL)
BOTH_LIMITS = {"damping": "1/2", "largest_modulus": 6}
IN_A_REGION = certificate(
    "stability",
    ROUND,
    {"bound": 2, "stable": True, **BOTH_LIMITS},
    {
        "method": "lyapunov",
        "transformation": None,
        # For ζ = 1/2 the lifted matrix is [M, -M/3; M, M].
        "blocks": [
            {
                **form(UNIT),
                "damping": {
                    "P": matrix([3, 0, 0, 0], [0, 3, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]),
                    "R": FOUR,
                    "R2": matrix([1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 2, 0], [0, 0, 0, 2]),
                },
                "largest_modulus": side(UNIT),
            }
        ],
    },
)
UNSTABLE_IN_DISCRETE_TIME = certificate(
    "stability", loop([[2]], time="discrete"), claim(False), POLYNOMIAL
)
NOT_DAMPED = certificate(
    "stability",
    loop([[0, 1], [-1, 0]]),
    limited(False, damping="3/5"),
    POLYNOMIAL,
)
TOO_FAST = certificate(
    "stability",
    loop([[-2, 0], [0, "-1/2"]]),
    limited(False, largest_modulus=1),
    {
        "method": "instability",
        "side": "largest_modulus",
        "P": matrix([-1, 0], [0, 1]),
        "R2": UNIT,
        "v": matrix([1], [0]),
    },
)

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
    ("a damping ratio", DAMPED),
    ("a damping ratio near its own", changed(DAMPED, ("claim.damping", "599/1000"))),
    ("a damping ratio of one state by a form", certificate(
        "stability", loop([[-1]]), limited(True, damping="1/2"), {
            "method": "lyapunov",
            "transformation": None,
            "blocks": [{**ALONE, "damping": {"P": matrix([3, 0], [0, 1]), "R": UNIT, "R2": UNIT}}],
        }
    )),
    ("exactly its damping ratio is not met", changed(
        DAMPED, ("claim.damping", "3/5"), ("claim.stable", False)
    )),
    ("a larger damping ratio is not met", changed(
        DAMPED, ("claim.damping", "601/1000"), ("claim.stable", False)
    )),
    ("every damping ratio of real eigenvalues", changed(
        BY_POLYNOMIAL, ("claim.damping", "999/1000")
    )),
    ("no damping ratio of the eigenvalue 0", certificate(
        "stability", loop([[0]]), limited(False, damping="1/1000"), POLYNOMIAL
    )),
    ("a largest modulus", WITHIN),
    ("exactly its largest modulus is not met", changed(
        WITHIN, ("claim.largest_modulus", 5), ("claim.stable", False)
    )),
    ("a largest modulus above 1, which is no radius", changed(
        WITHIN, ("claim.largest_modulus", "501/100")
    )),
    ("a rate, a damping ratio and a largest modulus", IN_A_REGION),
    ("the same by the polynomial", changed(IN_A_REGION, ("witness", POLYNOMIAL))),
    ("a rate that is not met, and limits that are", changed(
        IN_A_REGION, ("witness", POLYNOMIAL), ("claim.bound", 3), ("claim.stable", False)
    )),
    ("limits of no states", certificate(
        "stability", loop([]), limited(True, **BOTH_LIMITS), POLYNOMIAL
    )),
    ("no damping at all", NOT_DAMPED),
    ("an eigenvalue that is too fast", TOO_FAST),
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
    ("exactly its damping ratio", DAMPED, ("claim.damping", "3/5")),
    ("a larger damping ratio", DAMPED, ("claim.damping", "601/1000")),
    ("a damping ratio of 0", DAMPED, ("claim.damping", 0), "INVALID"),
    ("a damping ratio of 1", DAMPED, ("claim.damping", 1), "INVALID"),
    ("a negative damping ratio", DAMPED, ("claim.damping", "-1/2"), "INVALID"),
    ("a damping ratio that is null", DAMPED, ("claim.damping", None), "MALFORMED"),
    (
        "a damping ratio in discrete time",
        IN_DISCRETE_TIME,
        [("witness", POLYNOMIAL), ("claim.damping", "1/2")],
        "INVALID",
    ),
    (
        "a largest modulus in discrete time",
        IN_DISCRETE_TIME,
        [("witness", POLYNOMIAL), ("claim.largest_modulus", "1/2")],
        "INVALID",
    ),
    ("exactly its largest modulus", WITHIN, ("claim.largest_modulus", 5)),
    ("a largest modulus of 0", WITHIN, ("claim.largest_modulus", 0), "INVALID"),
    (
        "a largest modulus of 0 that is not met",
        TOO_FAST,
        [("witness", POLYNOMIAL), ("claim.largest_modulus", 0)],
        "INVALID",
    ),
    (
        "a negative largest modulus that is not met",
        TOO_FAST,
        [("witness", POLYNOMIAL), ("claim.largest_modulus", -1)],
        "INVALID",
    ),
    ("a damping ratio of 1 that is not met", NOT_DAMPED, ("claim.damping", 1), "INVALID"),
    ("a damping ratio above 1 that is not met", NOT_DAMPED, ("claim.damping", "3/2"), "INVALID"),
    ("a damping ratio of 0 that is not met", NOT_DAMPED, ("claim.damping", 0), "INVALID"),
    (
        "a limit in discrete time that is not met",
        UNSTABLE_IN_DISCRETE_TIME,
        ("claim.largest_modulus", 1),
        "INVALID",
    ),
    (
        "a damping ratio in discrete time that is not met",
        UNSTABLE_IN_DISCRETE_TIME,
        ("claim.damping", "1/2"),
        "INVALID",
    ),
    (
        "a fast rotation, and a form that falls for [M, M/3; M, M]",
        IN_A_REGION,
        [("system.A", [[-1, 10], [-10, -1]]), ("claim.bound", 0), ("claim.largest_modulus", 100)],
        "INVALID",
    ),
    (
        "the border of a damping ratio, and a form that falls less fast than at -1",
        IN_A_REGION,
        [
            ("claim.damping", "3/5"),
            ("witness.blocks.0.damping.P", diagonal(16, 16, 9, 9)),
            ("witness.blocks.0.damping.R2", diagonal(2, 2, 3, 3)),
        ],
        "INVALID",
    ),
    (
        "the border of a damping ratio, and a form that falls for a smaller one",
        IN_A_REGION,
        [
            ("claim.damping", "3/5"),
            ("witness.blocks.0.damping.P", diagonal(41, 41, 9, 9)),
            ("witness.blocks.0.damping.R2", diagonal(1, 1, 2, 2)),
        ],
        "INVALID",
    ),
    (
        "the border of a damping ratio, and a form that falls for nearly it",
        IN_A_REGION,
        [
            ("claim.damping", "3/5"),
            ("witness.blocks.0.damping.P", diagonal(1000, 1000, 459, 459)),
            ("witness.blocks.0.damping.R2", diagonal(2, 2, 3, 3)),
        ],
        "INVALID",
    ),
    (
        "limits in vain, for a rate that is not met",
        IN_A_REGION,
        [("witness", POLYNOMIAL), ("claim.bound", 3)],
    ),
    (
        "a limit without its form",
        DAMPED,
        [
            ("witness", BY_LYAPUNOV["witness"]),
        ],
        "MALFORMED",
    ),
    ("a form without its limit", IN_A_REGION, ("claim", claim(True)), "MALFORMED"),
    (
        "a form of the rate for the damping ratio",
        IN_A_REGION,
        ("witness.blocks.0.damping", side(UNIT)),
    ),
    (
        "a form that does not decrease with the damping ratio",
        IN_A_REGION,
        [("claim.damping", "3/5")],
        "INVALID",
    ),
    (
        "a negative form for the damping ratio",
        IN_A_REGION,
        (
            "witness.blocks.0.damping.P",
            matrix(*([-3 * (i == j) for j in range(4)] for i in range(4))),
        ),
        "INVALID",
    ),
    (
        "R of zeros for the damping ratio",
        IN_A_REGION,
        ("witness.blocks.0.damping.R", matrix(*([0] * 4 for _ in range(4)))),
        "INVALID",
    ),
    (
        "a form that does not decrease with the largest modulus",
        IN_A_REGION,
        ("claim.largest_modulus", 5),
        "INVALID",
    ),
    (
        "a key too many beside a form",
        IN_A_REGION,
        ("witness.blocks.0.damping.size", 4),
        "MALFORMED",
    ),
    ("evidence against another side", TOO_FAST, ("witness.side", "bound"), "INVALID"),
    ("evidence against a side that is not claimed", TOO_FAST, ("witness.side", "damping")),
    ("evidence against a side, without limits", UNSTABLE, ("witness.side", "bound"), "MALFORMED"),
    (
        "evidence against no side",
        certificate("stability", TOO_FAST["system"], TOO_FAST["claim"], TOO_FAST["witness"]),
        ("witness", UNSTABLE["witness"]),
        "MALFORMED",
    ),
]


test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)
