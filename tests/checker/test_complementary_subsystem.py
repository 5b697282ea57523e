"""The rule of ``complementary_subsystem``: constant matrices that show a Smith form."""

from __future__ import annotations

from typing import Any

import pytest

from tests.checker.handmade import (
    CHAIN,
    INTEGRATOR,
    Document,
    certificate,
    changed,
    checked,
    matrix,
    plant,
)
from tests.checker.tables import accepts, rejects

CLAIM: dict[str, Any] = {
    "subset": ["1"],
    "normal_rank": 2,
    "invariant_polynomials": [],
    "remnant": [1],
    "transfer_zero": False,
    "complete": True,
}
FREE = certificate(
    "complementary_subsystem",
    plant([[0]], ([[1]], [[1]]), ([[1]], [[1]])),
    CLAIM,
    {
        "modulus": 7,
        "reachable": 0,
        "X": matrix([]),
        "F": matrix([]),
        "A1": matrix(),
        "S": matrix([]),
        "B1": matrix(),
        "L": matrix([1]),
        "G": matrix([1]),
        "N": matrix([0]),
    },
)
"""[x, 1; 1, 0]."""

NOTHING = certificate(
    "complementary_subsystem",
    CHAIN,
    {**CLAIM, "transfer_zero": True, "complete": False},
    {
        "modulus": 7,
        "reachable": 1,
        "X": matrix([0], [1]),
        "F": matrix([0]),
        "A1": matrix([0]),
        "S": matrix([1]),
        "B1": matrix([1]),
        "L": matrix([1, 0]),
        "G": matrix([1]),
        "N": matrix([0]),
    },
)
"""Channel 2 drives a state that channel 1 does not see."""

DELAY = certificate(
    "complementary_subsystem",
    plant([[0, 0], [1, 0]], ([[0], [0]], [[0, 1]]), ([[1], [0]], [[0, 0]])),
    {**CLAIM, "normal_rank": 3},
    {
        "modulus": 7,
        "reachable": 0,
        "X": matrix([], []),
        "F": matrix([]),
        "A1": matrix(),
        "S": matrix([]),
        "B1": matrix(),
        "L": matrix([0, 1], [1, 0]),
        "G": matrix([1], [0]),
        "N": matrix([0, 0], [1, 0]),
    },
)
"""A double integrator seen at its end: the second row of L is the first times A."""

SIDE = ([[1], [0], [0]], [[1, 0, 0]])
TWICE = certificate(
    "complementary_subsystem",
    plant([[1, 0, 0], [0, 2, 0], [0, 0, 2]], SIDE, SIDE),
    {
        **CLAIM,
        "normal_rank": 4,
        "invariant_polynomials": [[-2, 1], [-2, 1]],
        "remnant": [-2, 1],
        "complete": False,
    },
    {
        "modulus": 7,
        "reachable": 0,
        "X": matrix([0, 0], [1, 0], [0, 1]),
        "F": matrix([0, 0]),
        "A1": matrix(),
        "S": matrix([]),
        "B1": matrix(),
        "L": matrix([1, 0, 0]),
        "G": matrix([1]),
        "N": matrix([0]),
    },
)
"""Two states apart, both at 2: the rank drops by two there, to 2 < 3."""

APART = changed(
    TWICE,
    ("system.A.2.2", 3),
    ("claim.invariant_polynomials", [[6, -5, 1]]),
    ("claim.remnant", [1]),
    ("claim.complete", True),
    ("witness.X", matrix([0, 0], [1, 2], [1, 3])),
)
"""Apart at 2 and at 3: one invariant polynomial, no remnant polynomial, and complete."""

LONE = ([[1], [0], [0], [0]], [[1, 0, 0, 0]])
THREE_APART = certificate(
    "complementary_subsystem",
    plant([[1, 0, 0, 0], [0, 2, 0, 0], [0, 0, 3, 0], [0, 0, 0, 4]], LONE, LONE),
    {**CLAIM, "normal_rank": 5, "invariant_polynomials": [[-24, 26, -9, 1]]},
    {
        **TWICE["witness"],
        "X": matrix([0, 0, 0], [1, 2, 4], [1, 3, 9], [1, 4, 16]),
        "F": matrix([0, 0, 0]),
        "L": matrix([1, 0, 0, 0]),
    },
)
"""Apart at 2, 3 and 4: the columns of X are v, A v and A² v."""

NOBODY = ([[0], [0]], [[0, 0]])
UNSEEN = certificate(
    "complementary_subsystem",
    plant([[0, 1], [1, 0]], NOBODY, NOBODY),
    {
        **CLAIM,
        "invariant_polynomials": [[-1, 0, 1]],
        "remnant": [-1, 0, 1],
        "transfer_zero": True,
        "complete": False,
    },
    {
        "modulus": 7,
        "reachable": 0,
        "X": matrix([1, 0], [0, 1]),
        "F": matrix([0, 0]),
        "A1": matrix(),
        "S": matrix([1]),
        "B1": matrix(),
        "L": matrix(),
        "G": matrix(),
        "N": matrix(),
    },
)
"""Nothing enters and nothing is seen: x² − 1 is an invariant polynomial."""
A_CYCLE = (
    ("claim.invariant_polynomials", []),
    ("claim.remnant", [1]),
    ("witness.X", matrix([], [])),
    ("witness.F", matrix([])),
    ("witness.L", matrix([1, 0], [0, 1])),
    ("witness.G", matrix([0], [0])),
    ("witness.N", matrix([0, 1], [1, 0])),
)
"""L = N L A with N = A: all would be seen, if N were strictly lower triangular."""

OF_NONE = certificate(
    "complementary_subsystem",
    INTEGRATOR,
    {**CLAIM, "subset": [], "normal_rank": 1, "transfer_zero": True, "complete": False},
    {
        "modulus": 7,
        "reachable": 1,
        "X": matrix([1]),
        "F": matrix([0]),
        "A1": matrix([0]),
        "S": matrix([1]),
        "B1": matrix([1]),
        "L": matrix(),
        "G": matrix(),
        "N": matrix(),
    },
)
"""[x, 1]: the outputs of no channel, and the inputs of all."""

OF_ALL = certificate(
    "complementary_subsystem",
    INTEGRATOR,
    {**CLAIM, "normal_rank": 1, "transfer_zero": True, "complete": False},
    {
        "modulus": 7,
        "reachable": 0,
        "X": matrix([]),
        "F": matrix(),
        "A1": matrix(),
        "S": matrix(),
        "B1": matrix(),
        "L": matrix([1]),
        "G": matrix([1]),
        "N": matrix([0]),
    },
)
"""[x; 1]: the outputs of all channels, and the inputs of none."""

ACCEPTED = [
    ("one integrator between two channels", FREE),
    ("a transfer matrix of zeros", NOTHING),
    ("a row of L that needs N", DELAY),
    ("two zeros at one place", TWICE),
    ("two zeros at two places", APART),
    ("three zeros at three places", THREE_APART),
    ("channels that neither move nor see", UNSEEN),
    ("another modulus", changed(TWICE, ("witness.modulus", 9))),
    ("another basis", changed(TWICE, ("witness.X", matrix([0, 0], [1, 1], [0, 1])))),
    (
        "fractions",
        changed(
            FREE,
            ("witness.L", matrix([1], denominator=2)),
            ("witness.G", matrix([1], denominator=2)),
        ),
    ),
]

REJECTED = [
    ("a normal rank too low", FREE, (("claim.normal_rank", 1),)),
    ("a normal rank too high", NOTHING, (("claim.normal_rank", 3),)),
    ("complete where it is not", TWICE, (("claim.complete", True),)),
    ("not complete where it is", FREE, (("claim.complete", False),)),
    ("a zero transfer where there is one", FREE, (("claim.transfer_zero", True),)),
    ("a transfer where there is none", NOTHING, (("claim.transfer_zero", False),)),
    ("no remnant polynomial", TWICE, (("claim.remnant", [1]),)),
    ("the zero polynomial for the remnant", TWICE, (("claim.remnant", [4, -4, 1]),)),
    (
        "invariant polynomials that do not divide",
        APART,
        (
            ("claim.invariant_polynomials", [[-2, 1], [-3, 1]]),
            ("witness.X", matrix([0, 0], [1, 0], [0, 1])),
            ("claim.remnant", [-2, 1]),
            ("claim.complete", False),
        ),
    ),
    (
        "one invariant polynomial for two",
        TWICE,
        (
            ("claim.invariant_polynomials", [[4, -4, 1]]),
            ("claim.remnant", [1]),
            ("claim.complete", True),
        ),
    ),
    ("a constant among them", TWICE, (("claim.invariant_polynomials", [[1], [-2, 1], [-2, 1]]),)),
    ("the empty subset", FREE, (("claim.subset", []),)),
    ("all channels", FREE, (("claim.subset", ["1", "2"]),)),
    ("the other subset", NOTHING, (("claim.subset", ["2"]),)),
    (
        "zeros hidden in what is controlled",
        TWICE,
        (
            ("witness.reachable", 2),
            ("claim.invariant_polynomials", []),
            ("witness.A1", matrix([2, 0], [0, 2])),
            ("witness.B1", matrix([], [])),
            ("claim.remnant", [1]),
            ("claim.complete", True),
        ),
    ),
    ("X with dependent columns", TWICE, (("witness.X", matrix([0, 0], [1, 1], [1, 1])),)),
    ("X dependent modulo ℓ", TWICE, (("witness.X", matrix([0, 0], [1, 0], [0, 7])),)),
    ("L of zeros", FREE, (("witness.L", matrix([0])), ("witness.G", matrix([0])))),
    ("N = I proves anything", NOTHING, (("witness.N", matrix([1])),)),
    ("L = N L with N = I", FREE, (("witness.G", matrix([0])), ("witness.N", matrix([1])))),
    ("N turns in a cycle", UNSEEN, A_CYCLE, "INVALID"),
    ("an invariant polynomial that is constant", FREE, (("claim.invariant_polynomials", [[1]]),)),
    ("N not strictly lower triangular", DELAY, (("witness.N", matrix([0, 1], [1, 0])),)),
    ("L seen through an input", DELAY, (("system.channels.1.B", [[0], [1]]),)),
    ("an S of zeros", NOTHING, (("witness.S", matrix([0])), ("witness.B1", matrix([0])))),
    ("modulus 0", FREE, (("witness.modulus", 0),)),
    ("more controlled states than there are", FREE, (("witness.reachable", 2),)),
    ("a plant that moves", TWICE, (("system.A.0.1", 1),)),
]


test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)


@pytest.mark.parametrize("document", [OF_NONE, OF_ALL])
def test_a_subset_is_proper_and_not_empty(document: Document) -> None:
    verdict = checked(document)
    assert (verdict.verdict, verdict.place) == ("INVALID", "claim.subset"), verdict.line()


@pytest.mark.parametrize("edit", [("witness.reachable", 2), ("claim.normal_rank", 3)])
def test_dimensions_that_do_not_fit_are_named(edit: tuple[str, object]) -> None:
    verdict = checked(changed(FREE, edit))
    assert (verdict.verdict, verdict.place) == ("INVALID", "claim.normal_rank"), verdict.line()
