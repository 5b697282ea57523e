"""The rule of ``pencil_rank``: a kernel from above, unit pivots from below."""

from __future__ import annotations

import pytest

from tests.checker.handmade import (
    OSCILLATOR_RANK,
    RANK,
    Document,
    certificate,
    changed,
    checked,
    layers,
    plant,
)
from tests.checker.tables import accepts

OSCILLATOR_DROP = certificate(
    "pencil_rank",
    OSCILLATOR_RANK["system"],
    {"subset": [], "polynomial": [1, 0, 1], "rank": 1},
    {
        "modulus": 101,
        "kernel": layers([[1, 0], [0, 0], [0, 1]], [[0, 0], [1, 0], [0, 0]]),
        "pivots": [0, 2],
    },
)
ELSEWHERE = changed(
    RANK,
    ("claim", {"subset": ["2"], "polynomial": [-2, 1], "rank": 3}),
    ("witness.kernel", layers([[-1, -1], [0, 0], [0, 0], [1, 0], [0, 1]])),
    ("witness.pivots", [3, 4]),
)
# At 0 the rank of xI − diag(0, 1) is 1, and so it is at 1: but not by the same column.
TWO_ROOTS = certificate(
    "pencil_rank",
    plant([[0, 0], [0, 1]], ([[0], [0]], [[0, 0]])),
    {"subset": ["1"], "polynomial": [0, -1, 1], "rank": 2},
    {"modulus": 101, "kernel": layers([[], []]), "pivots": []},
)
# The same at 1 and 2, where p and every entry have a constant term that is a unit.
NOT_ZERO = certificate(
    "pencil_rank",
    plant([[1, 0], [0, 2]], ([[0], [0]], [[0, 0]])),
    {"subset": ["1"], "polynomial": [2, -3, 1], "rank": 2},
    {"modulus": 101, "kernel": layers([[], []]), "pivots": []},
)
# At 0 the first column of xI − A is (2, 1): modulo 6 only its second entry has an inverse.
UNITS = certificate(
    "pencil_rank",
    plant([[-2, -1], [-1, -1]], ([[0], [0]], [[0, 0]])),
    {"subset": ["1"], "polynomial": [0, 1], "rank": 2},
    {"modulus": 6, "kernel": layers([[], []]), "pivots": []},
)
# At 1 the kernel of xI − A is (1, 0), which the channel measures.
SEEN = certificate(
    "pencil_rank",
    plant([[1, 0], [0, 2]], ([[], []], [[1, 0]]), ([[], []], [[0, 1]])),
    {"subset": ["2"], "polynomial": [-1, 1], "rank": 1},
    {"modulus": 101, "kernel": layers([[1], [0]]), "pivots": [0]},
)
# [x 0 0; 0 0 0; 0 0 0] with two inputs and two outputs: nothing stands in the lower right corner.
CORNER = certificate(
    "pencil_rank",
    plant([[0]], ([[]], [[0], [0]]), ([[0, 0]], [[0]])),
    {"subset": ["1"], "polynomial": [-1, 1], "rank": 1},
    {"modulus": 101, "kernel": layers([[0, 0], [1, 0], [0, 1]]), "pivots": [1, 2]},
)

ACCEPTED = [
    ("two inputs and two outputs that do nothing", CORNER),
    ("a kernel that the other channel sees", SEEN),
    ("a number without inverse above one with", UNITS),
    ("the paper's pencil drops at 1", RANK),
    ("and at 2 it does not", ELSEWHERE),
    ("full rank at a pair of roots", OSCILLATOR_RANK),
    ("a drop at a pair of roots", OSCILLATOR_DROP),
    ("another modulus", changed(RANK, ("witness.modulus", 2))),
    ("a modulus in which p splits", changed(OSCILLATOR_DROP, ("witness.modulus", 5))),
    ("full rank by one unit, where p splits", changed(OSCILLATOR_RANK, ("witness.modulus", 5))),
]

REJECTED = [
    ("a kernel that the outputs see, and that claims a lower rank", SEEN, ("claim.subset", ["1"])),
    (
        "x in the lower right corner",
        changed(CORNER, ("claim.rank", 2), ("witness.pivots", [1])),
        ("witness.kernel", layers([[0], [1], [0]])),
    ),
    ("a pivot too few", RANK, ("witness.pivots", [0, 2])),
    ("a pivot too many", RANK, ("witness.pivots", [0, 1, 2, 3])),
    ("a column without a number that has an inverse", UNITS, ("system.A", [[-2, -1], [0, -1]])),
    ("a rank too high", RANK, ("claim.rank", 3)),
    ("a rank too low", RANK, ("claim.rank", 1)),
    ("a rank beyond the columns", RANK, ("claim.rank", 6)),
    ("another subset", RANK, ("claim.subset", ["3"])),
    ("another polynomial", RANK, ("claim.polynomial", [-2, 1])),
    ("deg p = 0", RANK, ("claim.polynomial", [1])),
    ("an empty kernel", RANK, ("witness.kernel", layers([[]] * 5))),
    ("a kernel of zeros", RANK, ("witness.kernel", layers([[0, 0, 0]] * 5))),
    ("a kernel with dependent columns", RANK, ("witness.pivots", [0, 2, 4])),
    ("a kernel that is none", RANK, ("witness.kernel.coefficients.0.4", [0, 0, 1])),
    ("a kernel that the outputs see", RANK, ("witness.kernel.coefficients.0.1", [1, 0, 0])),
    ("no layers", RANK, ("witness.kernel.coefficients", [])),
    ("a denominator of 0", RANK, ("witness.kernel.denominator", 0)),
    ("modulus 1", RANK, ("witness.modulus", 1)),
    ("modulus 0", RANK, ("witness.modulus", 0)),
    (
        "a modulus that takes the pivots",
        changed(RANK, ("system.A.2.1", 101)),
        ("system.channels.1.C.0.1", 101),
    ),
    ("a drop at one root of two", TWO_ROOTS, ("claim.rank", 1)),
    ("full rank where it drops at both roots", TWO_ROOTS, ("claim.rank", 2)),
    ("full rank where it drops at both roots, none of them 0", NOT_ZERO, ("claim.rank", 2)),
    (
        "a kernel of which the outputs see one layer",
        changed(OSCILLATOR_RANK, ("claim.rank", 1), ("witness.pivots", [0])),
        ("witness.kernel", layers([[1], [0]], [[0], [1]])),
    ),
]


test_sound_evidence_is_accepted = accepts(ACCEPTED)


@pytest.mark.parametrize(("reason", "document", "edit"), REJECTED)
def test_a_change_of_one_place_is_rejected(
    reason: str, document: Document, edit: tuple[str, object]
) -> None:
    verdict = checked(changed(document, edit))
    assert verdict.verdict in ("INVALID", "MALFORMED"), verdict.line()
