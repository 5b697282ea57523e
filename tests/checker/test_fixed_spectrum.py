"""The rule of ``fixed_spectrum``: what proves a fixed spectrum, and what only seems to."""

from __future__ import annotations

import pytest

from tests.checker.handmade import (
    FIXED,
    FREE,
    OSCILLATION,
    PAPER_SUBSPACE,
    Document,
    certificate,
    changed,
    checked,
    layers,
    matrix,
    plant,
)
from tests.checker.tables import accepts
from tests.wording import says

FACTOR = "claim.factors.0"
SPACE = "witness.subspaces.0"

# 1 and 1 + 7 are both fixed; modulo 7 they look like one root of multiplicity two.
MODULAR_TRAP = certificate(
    "fixed_spectrum",
    plant([[1, 0, 0], [0, 8, 0], [0, 0, 0]], ([[0], [0], [1]], [[1, 1, 1]])),
    {
        "polynomial": [-1, 1],
        "factors": [
            {
                "polynomial": [-1, 1],
                "multiplicity_in_A": 2,
                "multiplicity_at_most": 2,
                "channels": [],
                "rank": 2,
                "stable": False,
                "roots": [{"re": "1", "im": "0", "radius": "0"}],
            }
        ],
        "stabilizable": False,
        "best_rate": {"lower": "-1", "upper": "-1"},
    },
    {
        "gains": [matrix([2])],
        "modulus": 7,
        "subspaces": [
            {
                "channels_T": ["1"],
                "U": layers([[1, 0], [0, 0], [0, 1]]),
                "V": layers([[0, 1]]),
                "pivots": [0, 2],
            }
        ],
        "completion": {"B0": matrix([1], [1], [0]), "C0": matrix([1, 1, 0])},
    },
)
HIDDEN_MODES = certificate(
    "fixed_spectrum",
    plant([[1, 0], [0, 1]], ([[1], [0]], [[1, 0]])),
    {"polynomial": [1], "factors": [], "stabilizable": True, "best_rate": None},
    {"gains": [matrix([1])], "modulus": 7, "subspaces": [], "completion": None},
)
DISCRETE = changed(
    OSCILLATION,
    ("system.time", "discrete"),
    ("claim.best_rate", {"lower": "0.75", "upper": "1.25"}),
)
NO_STATES = changed(
    FREE,
    ("system", plant([], ({"shape": [0, 1], "entries": []}, [[]]))),
)
TWO_FACTORS = certificate(
    "fixed_spectrum",
    plant([[1, 0], [0, -2]], ([[0], [0]], [[1, 1]])),
    {
        "polynomial": [-2, 1, 1],
        "factors": [
            {
                "polynomial": [root, 1],
                "multiplicity_in_A": 1,
                "multiplicity_at_most": 1,
                "channels": [],
                "rank": 1,
                "stable": root > 0,
                "roots": [{"re": str(-root), "im": "0", "radius": "0.5"}],
            }
            for root in (-1, 2)
        ],
        "stabilizable": False,
        "best_rate": {"lower": "-1.5", "upper": "-0.5"},
    },
    {
        "gains": [matrix([0])],
        "modulus": 101,
        "subspaces": [
            {"channels_T": ["1"], "U": layers(U), "V": layers([[0]]), "pivots": [k]}
            for k, U in enumerate(([[1], [0]], [[0], [1]]))
        ],
        "completion": {"B0": matrix([1], [1]), "C0": matrix([1, 1])},
    },
)
# x(x − 1) as one factor: a rule for any monic polynomial, irreducible or not.
REDUCIBLE = certificate(
    "fixed_spectrum",
    plant([[0, 1], [0, 1]], ([[0], [0]], [[1, 1]])),
    {
        "polynomial": [0, -1, 1],
        "factors": [
            {
                "polynomial": [0, -1, 1],
                "multiplicity_in_A": 1,
                "multiplicity_at_most": 1,
                "channels": [],
                "rank": 1,
                "stable": False,
                "roots": [
                    {"re": "0", "im": "0", "radius": "0"},
                    {"re": "1", "im": "0", "radius": "0"},
                ],
            }
        ],
        "stabilizable": False,
        "best_rate": {"lower": "-1", "upper": "-1"},
    },
    {
        "gains": [matrix([0])],
        "modulus": 101,
        # (1, 0)' at x = 0 and (1, 1)' at x = 1: the column (1, x)' serves both
        "subspaces": [
            {
                "channels_T": ["1"],
                "U": layers([[1], [0]], [[0], [1]]),
                "V": layers([[0]]),
                "pivots": [0],
            }
        ],
        "completion": {"B0": matrix([1], [2]), "C0": matrix([1, 0])},
    },
)
# x(x − 1) again, with x² and one factor x − 1 in every loop, and x²(x − 1)² without feedback: the
# exponent of x(x − 1) in the loop, 1, is that of x − 1 and not of x.
UNEVEN = certificate(
    "fixed_spectrum",
    plant(
        [[0, 1, 1, 0], [0, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
        ([[0], [0], [0], [1]], [[0, 0, 0, 1]]),
    ),
    changed(
        REDUCIBLE["claim"],
        ("factors.0.multiplicity_in_A", 2),
        ("factors.0.channels", ["1"]),
        ("factors.0.rank", 3),
    ),
    {
        "gains": [matrix([2])],
        "modulus": 101,
        "subspaces": [
            {
                "channels_T": [],
                "U": layers([[1], [0], [0], [0]], [[0], [0], [1], [0]]),
                "V": layers([]),
                "pivots": [0],
            }
        ],
        "completion": {"B0": matrix([0], [1], [1], [0]), "C0": matrix([1, 0, 1, 0])},
    },
)

UNSAID = [(f"claim.factors.{k}.multiplicity_in_A", None) for k in (0, 1)]
# (x − 1)² in every loop, while a pencil loses rank 1: h = x − 1.  A^8 has rows of sum 9, and 2^8 is
# the least power of order 8 above: 1·1 + 1·2 = 3 is the bound.
TWICE = certificate(
    "fixed_spectrum",
    plant([[1, 1], [0, 1]], ([[0], [0]], [[1, 0]])),
    {
        "polynomial": [-1, 1],
        "factors": [
            {
                "polynomial": [-1, 1],
                "multiplicity_in_A": None,
                "multiplicity_at_most": 2,
                "channels": [],
                "rank": 1,
                "stable": False,
                "roots": [{"re": "1", "im": "0", "radius": "0"}],
            }
        ],
        "stabilizable": False,
        "best_rate": {"lower": "-1", "upper": "-1"},
    },
    {
        "gains": [matrix([1])],
        "modulus": 4,
        "subspaces": [
            {
                "channels_T": ["1"],
                "U": layers([[1], [0]]),
                "V": layers([[0]]),
                "pivots": [0],
            }
        ],
        "completion": {"B0": matrix([0], [1]), "C0": matrix([1, 0])},
    },
)
# The same with 1/2 in place of 1: D = 2, and (D·A)^8 has rows of sum 17.
HALF_TWICE = changed(
    TWICE,
    ("system.A", [["1/2", 1], [0, "1/2"]]),
    ("claim.polynomial", ["-1/2", 1]),
    (f"{FACTOR}.polynomial", ["-1/2", 1]),
    (f"{FACTOR}.roots.0.re", "0.5"),
    ("claim.best_rate", {"lower": "-0.5", "upper": "-0.5"}),
    ("witness.modulus", 5),
)

TEN = changed(
    FIXED,
    ("witness.modulus", 10),
    ("witness.completion", {"B0": matrix([1], [1], [1]), "C0": matrix([0, -1, 3])}),
)
"""With -B_0 for B_0 a pivot would be even, although the determinant only changes its sign."""

ACCEPTED = [
    ("the paper's mode, as it stands", FIXED),
    ("other gains are another valid proof", changed(FIXED, ("witness.gains.1", matrix([3])))),
    ("so is another modulus", changed(FIXED, ("witness.modulus", 10**18 + 9))),
    ("the modulus need not be prime", changed(FIXED, ("witness.modulus", 25))),
    ("an interval may be wider", changed(FIXED, ("claim.best_rate.lower", "-1.5"))),
    ("a disc may be wider, and the rate with it", OSCILLATION),
    ("a modulus may be small where nothing is fixed", changed(FREE, ("witness.modulus", 2))),
    ("a completion whose pivots are units modulo 10", TEN),
    ("no states at all", NO_STATES),
    ("discrete time asks for moduli", DISCRETE),
    ("two factors, one of them stable", TWO_FACTORS),
    ("nothing said of A", changed(FIXED, (f"{FACTOR}.multiplicity_in_A", None))),
    ("nothing said of A, with two factors", changed(TWO_FACTORS, *UNSAID)),
    ("a modulus above the bound", TWICE),
    ("a modulus above the bound of an integer multiple of A", HALF_TWICE),
    ("two roots as one factor, of which one stays twice", UNEVEN),
    (
        "columns beyond those that are needed",
        changed(
            FIXED,
            (f"{SPACE}.channels_T", ["1", "3"]),
            (f"{SPACE}.V", layers([[0, 0], [0, 0]])),
            (f"{FACTOR}.channels", ["2"]),
        ),
    ),
    (
        "an order of V and denominators that cancel",
        changed(FIXED, (f"{SPACE}.U", layers([[2, 0], [0, 0], [0, 2]], denominator=2))),
    ),
]

UNREDUCED = layers([[1, 0], [0, 0], [0, 1]], [[0, 0]] * 3)
OVER_101 = matrix([2], denominator=101)
RANK_2 = matrix([0, 0, 1], [1, 0, 0])

REJECTED = [
    # the polynomial
    ("deg p = 0: the polynomial 1 has no root", (f"{FACTOR}.polynomial", [1]), "MALFORMED"),
    ("the empty polynomial", (f"{FACTOR}.polynomial", []), "MALFORMED"),
    ("a polynomial that is not monic", (f"{FACTOR}.polynomial", [-2, 2]), "MALFORMED"),
    ("another root", (f"{FACTOR}.polynomial", [-2, 1]), "INVALID"),
    ("a product that is not the product", ("claim.polynomial", [-1, 2, 1]), "INVALID"),
    ("the product 1", ("claim.polynomial", [1]), "INVALID"),
    ("a repeated root", (f"{FACTOR}.polynomial", [1, -2, 1]), "INVALID"),
    # multiplicities
    ("a multiplicity in A too low", (f"{FACTOR}.multiplicity_in_A", 2), "INVALID"),
    ("a multiplicity in A too high", (f"{FACTOR}.multiplicity_in_A", 4), "INVALID"),
    ("a multiplicity of 0", (f"{FACTOR}.multiplicity_at_most", 0), "MALFORMED"),
    ("a loose bound on the multiplicity", (f"{FACTOR}.multiplicity_at_most", 2), "INVALID"),
    ("true for 1", (f"{FACTOR}.multiplicity_at_most", True), "MALFORMED"),
    # the subset and its rank
    ("another subset", (f"{FACTOR}.channels", ["3"]), "INVALID"),
    ("an unknown channel", (f"{FACTOR}.channels", ["2", "4"]), "MALFORMED"),
    ("a channel named twice", (f"{FACTOR}.channels", ["2", "2", "3"]), "MALFORMED"),
    ("channels out of order", (f"{FACTOR}.channels", ["3", "2"]), "MALFORMED"),
    ("a rank bounded from the wrong side: 3 is no drop", (f"{FACTOR}.rank", 3), "INVALID"),
    ("a rank too low", (f"{FACTOR}.rank", 1), "INVALID"),
    ("a rank above n", (f"{FACTOR}.rank", 4), "INVALID"),
    # the subspace
    ("U without columns", (f"{SPACE}.pivots", []), "MALFORMED"),
    ("a U that is not the identity there", (f"{SPACE}.pivots", [0, 1]), "INVALID"),
    ("a row taken twice", (f"{SPACE}.pivots", [0, 0]), "MALFORMED"),
    ("a row from the end, -1", (f"{SPACE}.pivots", [0, -1]), "MALFORMED"),
    ("rows out of order", (f"{SPACE}.pivots", [2, 0]), "MALFORMED"),
    ("a V that does not fit", (f"{SPACE}.V", layers([[0, 1]])), "INVALID"),
    ("an output that sees U", (f"{SPACE}.U", layers([[1, 0], [0, 1], [0, 1]])), "INVALID"),
    ("a U that is not reduced modulo p", (f"{SPACE}.U", UNREDUCED), "MALFORMED"),
    ("no subspace", ("witness.subspaces", []), "MALFORMED"),
    ("a subspace too many", ("witness.subspaces", [PAPER_SUBSPACE] * 2), "MALFORMED"),
    # gains and modulus
    ("gains that leave the mode twice", ("witness.gains.0", matrix([0, 0])), "INVALID"),
    ("gains of another shape", ("witness.gains.0", matrix([1])), "MALFORMED"),
    ("modulus 0", ("witness.modulus", 0), "INVALID"),
    ("modulus 1: everything is congruent", ("witness.modulus", 1), "INVALID"),
    ("a negative modulus", ("witness.modulus", -101), "INVALID"),
    ("a modulus that divides a denominator", ("witness.gains.1", OVER_101), "INVALID"),
    ("a composite modulus with a pivot that is no unit", ("witness.modulus", 2 * 101), "INVALID"),
    ("a denominator of 0", ("witness.gains.1", matrix([2], denominator=0)), "MALFORMED"),
    ("a negative denominator", ("witness.gains.1", matrix([2], denominator=-1)), "MALFORMED"),
    # the completion
    ("no completion", ("witness.completion", None), "MALFORMED"),
    ("a completion that leaves the mode", ("witness.completion.C0", matrix([0, 0, 0])), "INVALID"),
    ("a completion of rank 2", ("witness.completion.C0", RANK_2), "MALFORMED"),
    # where the roots lie
    ("called stable", (f"{FACTOR}.stable", True), "INVALID"),
    ("called stabilizable", ("claim.stabilizable", True), "INVALID"),
    ("a disc elsewhere", (f"{FACTOR}.roots.0.re", "1.5"), "INVALID"),
    ("a disc with a negative radius", (f"{FACTOR}.roots.0.radius", "-1"), "INVALID"),
    ("no discs", (f"{FACTOR}.roots", []), "MALFORMED"),
    ("a disc with an exponent", (f"{FACTOR}.roots.0.re", "1e0"), "MALFORMED"),
    ("a disc with a float", (f"{FACTOR}.roots.0.re", 1.0), "MALFORMED"),
    ("a rate too good", ("claim.best_rate", {"lower": "-0.5", "upper": "1"}), "INVALID"),
    ("a rate too bad", ("claim.best_rate", {"lower": "-3", "upper": "-2"}), "INVALID"),
    ("no rate", ("claim.best_rate", None), "MALFORMED"),
    # the system
    ("a plant in which 1 is not fixed", ("system.A.2.2", 2), "INVALID"),
    ("a plant with another output", ("system.channels.1.C", [[1, 0, 0]]), "INVALID"),
]  # fmt: skip

ROOTS = OSCILLATION["claim"]["factors"][0]["roots"]
ONE_FACTOR = TWO_FACTORS["claim"]["factors"][:1]
ONE_SPACE = TWO_FACTORS["witness"]["subspaces"][:1]

FORGED = [
    ("two modes that agree modulo 7 passed off as one", changed(MODULAR_TRAP)),
    (
        "the same with the exponent told right",
        changed(
            MODULAR_TRAP,
            (f"{FACTOR}.multiplicity_in_A", 1),
            (f"{FACTOR}.multiplicity_at_most", 1),
        ),
    ),
    ("fixed modes denied", HIDDEN_MODES),
    (
        "a factor left out",
        changed(
            TWO_FACTORS,
            ("claim.factors", ONE_FACTOR),
            ("witness.subspaces", ONE_SPACE),
            ("claim.polynomial", [-1, 1]),
        ),
    ),
    (
        "a factor given twice",
        changed(
            TWO_FACTORS,
            ("claim.factors", ONE_FACTOR * 2),
            ("witness.subspaces", ONE_SPACE * 2),
            ("claim.polynomial", [1, -2, 1]),
        ),
    ),
    (
        "discs that meet",
        changed(OSCILLATION, *((f"{FACTOR}.roots.{k}.radius", "1") for k in (0, 1))),
    ),
    ("fewer discs than the degree", changed(OSCILLATION, (f"{FACTOR}.roots", ROOTS[:1]))),
    ("one root twice", changed(OSCILLATION, (f"{FACTOR}.roots", ROOTS[:1] * 2))),
    ("the time domain changed, the rest kept", changed(OSCILLATION, ("system.time", "discrete"))),
    ("a rate of nothing", changed(FREE, ("claim.best_rate", {"lower": "0", "upper": "0"}))),
    (
        "a completion of nothing",
        changed(FREE, ("witness.completion", {"B0": matrix([]), "C0": matrix()})),
    ),
    ("nothing fixed, yet not stabilizable", changed(FREE, ("claim.stabilizable", False))),
    (
        "u not above rank B_T: any channel would do",
        changed(
            FIXED,
            ("system.channels.0.B", [[1, 0], [0, 0], [0, 1]]),
            ("witness.gains.0", matrix([1, 0], [0, 1])),
            (f"{SPACE}.V", layers([[0, 0], [0, 0]])),
        ),
    ),
    ("an identity that holds only modulo 101", changed(FIXED, ("system.A.0.0", 102))),
]


test_sound_evidence_is_accepted = accepts(ACCEPTED)


@pytest.mark.parametrize(("reason", "edit", "expected"), REJECTED)
def test_a_change_of_one_place_is_rejected(
    reason: str, edit: tuple[str, object], expected: str
) -> None:
    verdict = checked(changed(FIXED, edit))
    assert verdict.verdict == expected, verdict.line()


@pytest.mark.parametrize(("reason", "document"), FORGED)
def test_a_forgery_is_rejected(reason: str, document: Document) -> None:
    verdict = checked(document)
    assert verdict.verdict in ("INVALID", "MALFORMED"), verdict.line()


UNPROVED = [
    ("two modes that agree modulo 7, below the bound", changed(MODULAR_TRAP, UNSAID[0]), "modulus"),
    ("a modulus at the bound", changed(TWICE, ("witness.modulus", 3)), "modulus"),
    ("one at the bound, beside fractions", changed(HALF_TWICE, ("witness.modulus", 3)), "modulus"),
    ("exponents of one factor alone", changed(TWO_FACTORS, UNSAID[0]), "claim"),
    (
        "a factor left out, and nothing said of A",
        changed(
            TWO_FACTORS,
            ("claim.factors", ONE_FACTOR),
            UNSAID[0],
            ("witness.subspaces", ONE_SPACE),
            ("claim.polynomial", [-1, 1]),
        ),
        "common_factor",
    ),
    ("an exponent below", changed(TWICE, (f"{FACTOR}.multiplicity_at_most", 1)), "claim"),
]


@pytest.mark.parametrize(("reason", "document", "code"), UNPROVED)
def test_without_exponents_in_A_the_modulus_is_beyond_a_bound(
    reason: str, document: Document, code: str
) -> None:
    verdict = checked(document)
    assert (verdict.verdict, verdict.code) == ("INVALID", code), verdict.line()


def test_a_reducible_polynomial_may_be_one_factor() -> None:
    verdict = checked(REDUCIBLE)
    assert verdict.verdict == "VALID", verdict.line()
    assert says(verdict.statement, "roots")


def test_the_claim_is_about_the_subject_not_the_plant() -> None:
    shared = changed(FIXED, ("subject", [{"construction": "augmented_outputs"}]))
    gains = [matrix([1, 0, 0]), matrix([2, 0]), matrix([0, 0, 0])]
    fitting = changed(
        shared,
        ("witness.gains", gains),
        (f"{SPACE}.channels_T", ["1", "3"]),
        (f"{SPACE}.V", layers([[0, 0], [0, 0]])),
        (f"{FACTOR}.channels", ["2"]),
    )
    verdict = checked(fitting)
    assert verdict.verdict == "VALID", verdict.line()
    assert says(verdict.statement, "neighbors measured")
    assert checked(changed(fitting, (f"{FACTOR}.channels", ["2", "3"]))).verdict == "INVALID"
    assert checked(shared).verdict == "MALFORMED"


def test_a_mode_is_counted_in_one_factor() -> None:
    factors, spaces = FIXED["claim"]["factors"] * 2, FIXED["witness"]["subspaces"] * 2
    verdict = checked(changed(FIXED, ("claim.factors", factors), ("witness.subspaces", spaces)))
    assert (verdict.verdict, verdict.code) == ("INVALID", "common_factor"), verdict.line()


def test_a_factor_without_roots_is_refused_where_it_stands() -> None:
    verdict = checked(changed(FIXED, (f"{FACTOR}.polynomial", [1])))
    assert (verdict.verdict, verdict.place) == ("MALFORMED", "claim.factors[0].polynomial")
