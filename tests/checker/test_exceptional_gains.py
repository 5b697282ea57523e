"""The rule of ``exceptional_gains``: every root loses rank, and nothing else does."""

from __future__ import annotations

from tests.checker.handmade import certificate, changed, layers, matrix, plant
from tests.checker.tables import accepts, rejects

PLANT = plant([[0, 1], [0, 0]], ([[0], [1]], [[0, 0]]))
UNIT = matrix([1, 0], [0, 1])
DISC = {"re": "-2", "im": "0", "radius": "0"}
ROOT = certificate(
    "exceptional_gains",
    PLANT,
    {"M": matrix([0, 2], [1, 0]), "blocks": 2, "polynomial": [2, 1], "roots": [DISC]},
    {
        "modulus": 7,
        "factors": [{"polynomial": [2, 1], "row": layers([[1, 0]]), "pivot": 0}],
        "compressions": [UNIT, UNIT],
    },
)
"""[B, (M+gA)B] = [0, g+2; 1, 0]."""

NEVER = certificate(
    "exceptional_gains",
    plant([[0, 1], [0, 0]], ([[1, 0], [0, 1]], [[0, 0]])),
    {"M": matrix([0, 2], [1, 0]), "blocks": 1, "polynomial": [1], "roots": []},
    {"modulus": 7, "factors": [], "compressions": [UNIT, UNIT]},
)
HIDDEN = changed(
    ROOT,
    ("system.A", [[0, 7], [0, 0]]),
    ("claim.M", matrix([0, -1], [0, 0])),
    ("claim.polynomial", ["-1/7", 1]),
    ("claim.roots", [{"re": "0.14", "im": "0", "radius": "0.1"}]),
    ("witness.factors.0.polynomial", ["-1/7", 1]),
)
"""[B, (M+gA)B] = [0, 7g−1; 1, 0], which is [0, −1; 1, 0] modulo 7."""

SQUARE = certificate(
    "exceptional_gains",
    plant([[0, 1, 0], [0, 0, 1], [0, 0, 0]], ([[0], [0], [1]], [[0, 0, 0]])),
    {
        "M": matrix([0, 0, 0], [0, 0, 0], [0, 0, 0]),
        "blocks": 3,
        "polynomial": [0, 1],
        "roots": [{"re": "0", "im": "0", "radius": "0"}],
    },
    {
        "modulus": 7,
        "factors": [{"polynomial": [0, 1], "row": layers([[1, 0, 0]]), "pivot": 0}],
        "compressions": [matrix([1, 0, 0], [0, 1, 0], [0, 0, 1])] * 2,
    },
)
"""A chain of three: the determinant is g³ up to its sign."""

BOTH_SIGNS = certificate(
    "exceptional_gains",
    plant([[1, 0, 1], [0, 0, 0], [0, 0, 0]], ([[0], [0], [1]], [[0, 0, 0]])),
    {
        "M": matrix([0, -1, 0], [0, 0, 1], [0, 0, 0]),
        "blocks": 3,
        "polynomial": [-1, 0, 1],
        "roots": [{"re": "-1", "im": "0", "radius": "0"}, {"re": "1", "im": "0", "radius": "0"}],
    },
    {
        "modulus": 7,
        "factors": [
            {
                "polynomial": [-1, 0, 1],
                "row": layers([[1, 0, 0]], [[0, -1, 0]]),
                "pivot": 0,
            }
        ],
        "compressions": [matrix([1, 0, 0], [0, 1, 0], [0, 0, 1])] * 2,
    },
)
"""The blocks are e3, e2 + g e1 and (g²−1) e1."""

THREE, ZERO = [[1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 0, 0]] * 3
FIRST, SECOND, THIRD = (
    matrix(*(row for k in range(3) for row in (THREE if k == block else ZERO)))
    for block in range(3)
)
SHIFTED = certificate(
    "exceptional_gains",
    plant(THREE, (THREE, [[0, 0, 0]])),
    {"M": matrix(*THREE), "blocks": 3, "polynomial": [1], "roots": []},
    {"modulus": 7, "factors": [], "compressions": [THIRD, FIRST]},
)
"""The blocks are I, (g+1) I and (g+1)² I: the first determinant is (g+1)⁶, the second 1."""

LONGER = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]]

ACCEPTED = [
    ("one root", ROOT),
    ("blocks that never lose rank", NEVER),
    ("a root that is infinite modulo ℓ", changed(HIDDEN, ("witness.modulus", 11))),
    ("a triple root", SQUARE),
    ("two roots of one factor", BOTH_SIGNS),
    ("blocks of full rank, one of which never loses it", SHIFTED),
    ("another row", changed(SQUARE, ("witness.factors.0.row", layers([[1, 5, 0]])))),
    ("another compression", changed(ROOT, ("witness.compressions.0", matrix([1, 1], [0, 3])))),
    (
        "other compressions of few blocks",
        changed(NEVER, ("witness.compressions.1", matrix([0, 0], [0, 0]))),
    ),
]

REJECTED = [
    (
        "a block more than there are states",
        SQUARE,
        (
            ("claim.blocks", 4),
            ("witness.compressions", [matrix(*LONGER)] * 2),
        ),
        "INVALID",
    ),
    (
        "no root where there is one",
        ROOT,
        (("claim.polynomial", [1]), ("claim.roots", []), ("witness.factors", [])),
    ),
    (
        "a root that is infinite modulo ℓ, denied",
        HIDDEN,
        (
            ("claim.polynomial", [1]),
            ("claim.roots", []),
            ("witness.factors", []),
            ("witness.modulus", 7),
        ),
    ),
    ("another root", ROOT, (("claim.polynomial", [3, 1]),)),
    (
        "another root throughout",
        ROOT,
        (
            ("claim.polynomial", [3, 1]),
            ("witness.factors.0.polynomial", [3, 1]),
            ("claim.roots.0.re", "-3"),
        ),
    ),
    (
        "a root that loses nothing",
        NEVER,
        (
            ("claim.polynomial", [2, 1]),
            ("claim.roots", [DISC]),
            ("witness.factors", ROOT["witness"]["factors"]),
        ),
    ),
    ("a factor twice", ROOT, (("witness.factors", ROOT["witness"]["factors"] * 2),)),
    ("a row of zeros", ROOT, (("witness.factors.0.row", layers([[0, 0]])),)),
    ("a row without the 1", ROOT, (("witness.factors.0.pivot", 1),)),
    ("a row that is not reduced", ROOT, (("witness.factors.0.row", layers([[1, 0]], [[0, 0]])),)),
    ("a row that does not annihilate", ROOT, (("witness.factors.0.row", layers([[1, 1]])),)),
    ("deg f = 0", ROOT, (("witness.factors.0.polynomial", [1]),)),
    ("a disc somewhere else", ROOT, (("claim.roots.0.re", "-1"),)),
    (
        "a disc beside the real axis that meets it",
        ROOT,
        (("claim.roots.0", {"re": "-2", "im": "0.1", "radius": "0.5"}),),
    ),
    (
        "a disc beneath the real axis that meets it",
        ROOT,
        (("claim.roots.0", {"re": "-2", "im": "-0.1", "radius": "0.5"}),),
    ),
    (
        "a disc beside the real axis that touches it",
        ROOT,
        (("claim.roots.0", {"re": "-2", "im": "0.5", "radius": "0.5"}),),
    ),
    (
        "a row of which one layer annihilates",
        BOTH_SIGNS,
        (("witness.factors.0.row", layers([[1, 0, 0]], [[0, -1, 1]])),),
    ),
    (
        "(g+1)⁶ and (g+1)³, which only a seventh value tells from coprime ones",
        SHIFTED,
        (("witness.compressions.1", SECOND),),
    ),
    ("no disc", ROOT, (("claim.roots", []),)),
    ("no blocks", NEVER, (("claim.blocks", 0),)),
    ("fewer blocks", ROOT, (("claim.blocks", 1),)),
    ("compressions of zeros", ROOT, (("witness.compressions", [matrix([0, 0], [0, 0])] * 2),)),
    (
        "a second determinant of zeros",
        SQUARE,
        (
            ("claim.polynomial", [1]),
            ("claim.roots", []),
            ("witness.factors", []),
            ("witness.compressions.1", matrix([0, 0, 0], [0, 0, 0], [0, 0, 0])),
        ),
    ),
    ("modulus 1", ROOT, (("witness.modulus", 1),)),
    ("another M", ROOT, (("claim.M", matrix([0, 3], [1, 0])),)),
    ("another plant", ROOT, (("system.A.0.1", 2),)),
]


test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)
