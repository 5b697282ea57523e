"""The rule of ``parametric_fixed_spectrum``: zero blocks, and gains that move all the rest."""

from __future__ import annotations

import json
from typing import Any

import pytest

from mcexact.checker.core.budget import MORE, PER_BYTE, Budget, limited
from tests.checker.handmade import FREE, changed, checked, plant, without
from tests.checker.parametric_plants import (
    ALL,
    DIAGONAL,
    EMPTY,
    GROWN,
    IRRATIONAL,
    MOVING,
    PAIR,
    PAPER,
    POLES,
    RANGED,
    SCALAR,
    SETTLED,
    TANGENT,
    TWO,
    exactly,
)
from tests.wording import says


@pytest.mark.parametrize("name", ALL)
def test_what_is_found_is_proved(name: str) -> None:
    found = checked(ALL[name])
    assert found.verdict == "VALID", found.line()
    again = checked(exactly(ALL[name]))
    assert (again.verdict, again.statement) == ("VALID", found.statement), again.line()


def test_the_statements_say_what_is_fixed_and_where() -> None:
    said = checked(PAPER).statement
    start = "for every complex value of the parameter t at which all entries of the plant are "
    never = "no mode is fixed under linear time-invariant decentralized control"
    assert f"{start}defined, {never}; but at" in said
    assert says(said, "roots discs")
    fixed = "the modes that are fixed under linear time-invariant decentralized control are the"
    assert (
        f"and only there, {fixed} roots x of x + (-1), where [xI - A, B; C, 0] with the matrix A"
        in said
    )
    assert says(said, "others loses")
    assert "multiplied by t + 1, are the roots x of x; " in checked(POLES).statement
    assert "multiplied by t - 2, are the roots x of x^4" in checked(MOVING).statement
    ranged = checked(RANGED).statement
    assert says(ranged, "defined except")
    assert says(ranged, "none between")
    assert "x^4 + (4*t^3 " not in checked(MOVING).statement
    nothing = "no mode is fixed under linear time-invariant decentralized control"
    assert checked(EMPTY).statement.endswith(nothing)


VALUE = "claim.exceptional.0"
PROOF = "witness.exceptional.0"
ROOT = [{"re": "0", "im": "0", "radius": "0"}]
NOTHING = {"modes": [], "divisors": []}
ZERO = {"denominator": 1, "entries": [[0]]}


def shorter(block: Any) -> Any:
    """A zero block with a column of U less."""
    return {
        **block,
        "row_pivots": block["row_pivots"][:-1],
        "U": [
            {
                "denominator": part["denominator"],
                "coefficients": [[row[:-1] for row in layer] for layer in part["coefficients"]],
            }
            for part in block["U"]
        ],
    }


def grown(document: Any) -> Any:
    """W(t) multiplied by 1 + t, for a W that does not depend on t."""
    [layer] = document["witness"]["exceptional"][1]["modes"][0]["W"]["coefficients"]
    return [layer, layer]


def congruent(document: Any, common: Any) -> Any:
    """The value 0 is said to be out of range, as one that is congruent modulo ℓ."""
    ell, outside = document["witness"]["modulus"], document["claim"]["outside"]
    value = {"value": [ell, 1], "roots": [{**ROOT[0], "re": str(-ell)}]}
    return changed(
        document,
        ("claim.exceptional", []),
        ("witness.exceptional", []),
        ("witness.common", common),
        ("claim.outside", [*outside, value]),
    )


def pair(*divisor: list[int]) -> Any:
    """The pair of modes with the gains 3 and 4 of the second channel, and a divisor at t = 0."""
    return changed(
        PAIR,
        ("witness.gains.0.1.entries", [[3]]),
        ("witness.gains.1.1.entries", [[4]]),
        ("witness.common.0.divisor", [*divisor]),
    )


def scalar(*gains: int) -> list[tuple[str, Any]]:
    """Changes of the first gains of a plant with one input and one output."""
    return [(f"witness.gains.{k}.0.entries", [[f]]) for k, f in enumerate(gains)]


ONCE = {"value": [0, 1], "divisor": [[-1], [1]]}
FALSE: dict[str, tuple[Any, str]] = {
    "a value is left out": (
        changed(
            PAPER, ("claim.exceptional", []), ("witness.exceptional", []), ("witness.common", [])
        ),
        "common_factor",
    ),
    "a value is left out of the claim alone": (
        changed(PAPER, ("claim.exceptional", []), ("witness.exceptional", [])),
        "claim",
    ),
    "a value is left out of the divisors": (
        changed(PAPER, ("witness.common", [])),
        "common_factor",
    ),
    "a value is left out of an exact resultant": (
        changed(exactly(PAPER), ("claim.exceptional", []), ("witness.exceptional", [])),
        "common_factor",
    ),
    "a value is said to be settled": (
        changed(
            PAPER,
            ("claim.exceptional", []),
            ("witness.exceptional", []),
            ("witness.settled", [{"value": [0, 1], "divisors": []}]),
        ),
        "common_factor",
    ),
    "a value is settled, its mode a divisor of nothing": (
        changed(
            PAPER,
            ("claim.exceptional", []),
            ("witness.exceptional", []),
            ("witness.settled", [{"value": [0, 1], "divisors": [[[-1], [1]]]}]),
        ),
        "divisor",
    ),
    "a value is called a pole": (
        changed(
            PAPER,
            ("claim.exceptional", []),
            ("witness.exceptional", []),
            ("witness.undefined", [[0, 1]]),
        ),
        "pole",
    ),
    "a value in the range is left out": (
        changed(
            RANGED,
            ("claim.exceptional", []),
            ("witness.exceptional", []),
            ("claim.outside", [*RANGED["claim"]["outside"], {"value": [0, 1], "roots": ROOT}]),
        ),
        "range",
    ),
    "a value congruent to one in the range is said to be beyond it": (
        congruent(RANGED, RANGED["witness"]["common"][1:]),
        "common_factor",
    ),
    "a value congruent to one in the range, with its divisor": (
        congruent(
            RANGED,
            [
                {**RANGED["witness"]["common"][0], "value": [RANGED["witness"]["modulus"], 1]},
                *RANGED["witness"]["common"][1:],
            ],
        ),
        "divisor",
    ),
    "a value congruent to one in the range, and an exact resultant": (
        congruent(exactly(RANGED), []),
        "common_factor",
    ),
    "a generic polynomial that is right at two values": (
        changed(DIAGONAL, ("claim.generic.0", [[6, -9, 2], [1]])),
        "identity",
    ),
    "a real value is out of no range": (
        changed(
            PAPER,
            ("claim.exceptional", []),
            ("witness.exceptional", []),
            ("claim.outside", [{"value": [0, 1], "roots": ROOT}]),
        ),
        "range",
    ),
    "a value is moved by the modulus": (
        changed(
            PAPER,
            (f"{VALUE}.value", [PAPER["witness"]["modulus"], 1]),
            (f"{VALUE}.roots.0.re", str(-PAPER["witness"]["modulus"])),
        ),
        "identity",
    ),
    "a value is moved": (
        changed(PAPER, (f"{VALUE}.value", [-1, 1]), (f"{VALUE}.roots.0.re", "1")),
        "identity",
    ),
    "another root": (changed(PAPER, (f"{VALUE}.roots.0.re", "1")), "disc"),
    "a disc that meets the axis beside its center": (
        changed(PAPER, (f"{VALUE}.roots.0", {"re": "0", "im": "0.1", "radius": "1"})),
        "disc",
    ),
    "another mode": (changed(PAPER, (f"{VALUE}.modes.0.polynomial", [[-2], [1]])), "identity"),
    "no mode": (changed(PAPER, (f"{VALUE}.modes", []), (f"{PROOF}.modes", [])), "claim"),
    "other channels": (changed(PAPER, (f"{VALUE}.modes.0.channels", ["2"])), "claim"),
    "channels that come later": (changed(PAPER, (f"{VALUE}.modes.0.channels", ["3"])), "claim"),
    "another T": (changed(PAPER, (f"{PROOF}.modes.0.channels_T", [])), "identity"),
    "all channels in T": (
        changed(PAPER, (f"{PROOF}.modes.0.channels_T", ["1", "2", "3"])),
        "identity",
    ),
    "a generic mode is left out": (
        changed(MOVING, ("claim.generic", []), ("witness.generic", [])),
        "degree",
    ),
    "a generic mode is left out, and the resultant exact": (
        changed(exactly(MOVING), ("claim.generic", []), ("witness.generic", [])),
        "product",
    ),
    "another generic mode": (changed(POLES, ("claim.generic.0", [[1], [1]])), "identity"),
    "a generic mode that moves": (changed(POLES, ("claim.generic.0", [[0, 1], [1]])), "identity"),
    "a mode at a value is said to be generic": (
        changed(
            PAPER,
            ("claim.generic", [[[-1], [1]]]),
            ("witness.generic", PAPER["witness"]["exceptional"][0]["modes"]),
        ),
        "identity",
    ),
    "a generic mode is said to be exceptional as well": (
        changed(
            SETTLED,
            (f"{VALUE}.modes", [{"polynomial": [[], [1]], "channels": ["2"]}]),
            (f"{PROOF}.modes", SETTLED["witness"]["generic"]),
        ),
        "common_factor",
    ),
    "a generic mode is said to be exceptional beside another": (
        changed(
            SETTLED,
            (
                f"{VALUE}.modes",
                [
                    *SETTLED["claim"]["exceptional"][0]["modes"],
                    {"polynomial": [[], [1]], "channels": ["2"]},
                ],
            ),
            (
                f"{PROOF}.modes",
                [*SETTLED["witness"]["exceptional"][0]["modes"], *SETTLED["witness"]["generic"]],
            ),
        ),
        "common_factor",
    ),
    "a block that is too small": (
        changed(
            PAPER, (f"{PROOF}.modes.0", shorter(PAPER["witness"]["exceptional"][0]["modes"][0]))
        ),
        "rank",
    ),
    "a block that is much too small": (
        changed(
            MOVING,
            ("witness.generic.0.W.coefficients", [[[1, 0, 0, 0], [0, 1, 0, 0]]]),
            ("witness.generic.0.column_pivots", [0, 1]),
        ),
        "rank",
    ),
    "outputs that see what grows with x alone": (
        changed(MOVING, ("witness.generic.0.channels_T", [])),
        "identity",
    ),
    "an identity up to the second power of x": (
        changed(MOVING, ("witness.generic.0.U.2.coefficients.0.0.0", -3)),
        "identity",
    ),
    "an identity up to the third power of x": (
        changed(MOVING, ("claim.generic.0.3", [5, -2])),
        "identity",
    ),
    "pivots that depend on x alone": (
        changed(MOVING, ("witness.generic.0.U.1.coefficients.0.3.0", 1)),
        "pivots",
    ),
    "pivots that are no identity": (
        changed(POLES, ("witness.generic.0.row_pivots", [1, 3])),
        "pivots",
    ),
    "pivots of another column": (
        changed(POLES, ("witness.generic.0.column_pivots", [0, 1, 2])),
        "pivots",
    ),
    "pivots that depend on x": (changed(MOVING, ("witness.generic.0.row_pivots", [0])), "pivots"),
    "pivots that are 0": (
        changed(
            POLES,
            ("witness.generic.0.U.0.coefficients", [[[0, 0]] * 4]),
        ),
        "pivots",
    ),
    "pivots at a value that are 2": (
        changed(
            PAPER,
            (
                f"{PROOF}.modes.0.W.coefficients",
                [
                    [
                        [2 * e for e in row]
                        for row in PAPER["witness"]["exceptional"][0]["modes"][0]["W"][
                            "coefficients"
                        ][0]
                    ]
                ],
            ),
        ),
        "pivots",
    ),
    "pivots at a value that are -1": (
        changed(
            TWO,
            (
                f"{PROOF}.modes.0.W.coefficients",
                [
                    [
                        [-e for e in row]
                        for row in TWO["witness"]["exceptional"][0]["modes"][0]["W"][
                            "coefficients"
                        ][0]
                    ]
                ],
            ),
        ),
        "pivots",
    ),
    "pivots at a value that are 1 + t": (
        changed(SETTLED, ("witness.exceptional.1.modes.0.W.coefficients", grown(SETTLED))),
        "pivots",
    ),
    "no moduli": (changed(TANGENT, ("witness.moduli", [])), "common_factor"),
    "no moduli, and divisors that are not enough": (
        changed(TANGENT, ("witness.moduli", []), ("witness.common", [ONCE])),
        "common_factor",
    ),
    "no moduli, and a divisor twice": (
        changed(TANGENT, ("witness.moduli", []), ("witness.common", [ONCE, ONCE])),
        "common_factor",
    ),
    "a small modulus": (changed(TANGENT, ("witness.moduli", [101])), "modulus"),
    "a modulus of 1": (changed(TANGENT, ("witness.moduli", [1])), "modulus"),
    "one modulus twice": (
        changed(TANGENT, ("witness.moduli", TANGENT["witness"]["moduli"] * 2)),
        "unit",
    ),
    "the same gains twice": (
        changed(PAPER, ("witness.gains.0", PAPER["witness"]["gains"][1])),
        "degree",
    ),
    "the same gains twice, and an exact resultant": (
        changed(exactly(PAPER), ("witness.gains.0", PAPER["witness"]["gains"][1])),
        "product",
    ),
    "a modulus that divides the difference of gains": (
        changed(SCALAR, *scalar(0, 5), ("witness.modulus", 5)),
        "degree",
    ),
    "a modulus that has a factor in common with the difference of gains": (
        changed(SCALAR, *scalar(0, 5), ("witness.modulus", 10)),
        "unit",
    ),
    "a divisor that divides nothing": (
        changed(PAPER, ("witness.common.0.divisor", [[5], [1]])),
        "divisor",
    ),
    "a divisor of the first polynomial alone": (pair([5], [-6], [1]), "divisor"),
    "a divisor of the second polynomial alone": (pair([6], [-7], [1]), "divisor"),
    "a divisor at a value that is not named": (
        changed(PAPER, ("witness.common.0.value", [-1, 1])),
        "claim",
    ),
    "gains that move nothing": (
        changed(SETTLED, ("witness.gains.2", SETTLED["witness"]["gains"][0])),
        "common_factor",
    ),
    "a divisor of nothing": (changed(PAPER, (f"{PROOF}.divisors", [[[5], [1]]])), "divisor"),
    "the generic mode is no divisor": (
        changed(GROWN, ("witness.settled.0.divisors", [])),
        "common_factor",
    ),
    "a settled value is left out": (
        changed(GROWN, ("witness.settled", []), ("witness.common", [])),
        "common_factor",
    ),
    "an irrational value is left out": (
        changed(
            IRRATIONAL,
            ("claim.exceptional", IRRATIONAL["claim"]["exceptional"][:1]),
            ("witness.exceptional", IRRATIONAL["witness"]["exceptional"][:1]),
            ("witness.common", IRRATIONAL["witness"]["common"][:1]),
        ),
        "common_factor",
    ),
    "modes at a value exchanged": (
        changed(TWO, (f"{PROOF}.modes", TWO["witness"]["exceptional"][0]["modes"][::-1])),
        "identity",
    ),
    "one of two modes at a value": (
        changed(
            TWO,
            (f"{VALUE}.modes", TWO["claim"]["exceptional"][0]["modes"][:1]),
            (f"{PROOF}.modes", TWO["witness"]["exceptional"][0]["modes"][:1]),
        ),
        "common_factor",
    ),
    "values exchanged": (
        changed(
            IRRATIONAL,
            ("witness.exceptional", IRRATIONAL["witness"]["exceptional"][::-1]),
        ),
        "identity",
    ),
    "another modulus that divides a denominator": (changed(POLES, ("witness.modulus", 2)), "unit"),
}


@pytest.mark.parametrize("lie", FALSE)
def test_what_is_false_is_invalid(lie: str) -> None:
    document, code = FALSE[lie]
    found = checked(document)
    assert (found.verdict, found.code) == ("INVALID", code), found.line()


MALFORMED: dict[str, Any] = {
    "a kind about plants without parameters": changed(
        PAPER, ("kind", "neighbor_graph"), ("claim", {}), ("witness", {})
    ),
    "a plant without parameters": changed(PAPER, ("system", plant([[0]], ([[1]], [[1]])))),
    "zeros at the end": changed(PAPER, (f"{VALUE}.modes.0.polynomial", [[-1, 0], [1]])),
    "a coefficient that is not reduced": changed(
        PAPER, (f"{VALUE}.modes.0.polynomial", [[-1, 1], [1]])
    ),
    "not monic in x": changed(PAPER, (f"{VALUE}.modes.0.polynomial", [[-1], [2]])),
    "no x": changed(PAPER, (f"{VALUE}.modes.0.polynomial", [[1]])),
    "a value that is not monic": changed(PAPER, (f"{VALUE}.value", [0, 2])),
    "a value without t": changed(PAPER, (f"{VALUE}.value", [1])),
    "a zero block less": changed(PAPER, ("witness.exceptional", [])),
    "a mode's block less": changed(PAPER, (f"{PROOF}.modes", [])),
    "a generic block less": changed(POLES, ("witness.generic", [])),
    "a layer in x more": changed(
        PAPER, (f"{PROOF}.modes.0.U", PAPER["witness"]["exceptional"][0]["modes"][0]["U"] * 2)
    ),
    "a layer in t more": changed(
        PAPER,
        (
            f"{PROOF}.modes.0.W.coefficients",
            PAPER["witness"]["exceptional"][0]["modes"][0]["W"]["coefficients"] * 2,
        ),
    ),
    "two of three gains": changed(PAPER, ("witness.gains", PAPER["witness"]["gains"][:2])),
    "moduli and divisors": changed(PAPER, ("witness.moduli", TANGENT["witness"]["moduli"])),
    "a divisor without x": changed(PAPER, ("witness.common.0.divisor", [[1]])),
    "a divisor that is not reduced": changed(
        PAPER, ("witness.common.0.divisor", [[-1, 1], [], [1]])
    ),
    "a divisor at a value without t": changed(PAPER, ("witness.common.0.value", [1])),
    "gains of another shape": changed(PAPER, ("witness.gains.0.0", ZERO)),
    "a key less": without(PAPER, "witness.settled"),
    "a claim less": without(PAPER, "claim.outside"),
    "an unknown key": changed(PAPER, (f"{VALUE}.real", True)),
    "a zero at the end of a generic coefficient": changed(POLES, ("claim.generic.0", [[0], [1]])),
    "a zero behind others": changed(POLES, ("claim.generic.0", [[1, 2, 0], [1]])),
    "a settled value without t": changed(
        PAPER, ("witness.settled", [{"value": [1], "divisors": []}])
    ),
    "a value beyond the range without t": changed(
        RANGED, ("claim.outside", [{"value": [1], "roots": []}])
    ),
    "a pole that is no polynomial": changed(PAPER, ("witness.undefined", [[1]])),
}


@pytest.mark.parametrize("name", MALFORMED)
def test_what_is_not_as_the_format_says_is_malformed(name: str) -> None:
    found = checked(MALFORMED[name])
    assert found.verdict == "MALFORMED", found.line()


def test_more_work_is_granted_where_there_is_a_parameter() -> None:
    spent, size = checked(PAPER).spent, PER_BYTE * len(json.dumps(PAPER))
    with limited(Budget(usual=spent // 2 - size)):
        assert checked(PAPER).verdict == "VALID"
    with limited(budget := Budget()):
        assert (checked(FREE).verdict, budget.times) == ("VALID", 1)
        assert (checked(PAPER).verdict, budget.times) == ("VALID", MORE)
        assert (checked(FREE).verdict, budget.times) == ("VALID", MORE)


KEPT: dict[str, Any] = {
    "divisors of a mode": changed(PAPER, (f"{PROOF}.divisors", [[[-1], [1]]])),
    "settled values where nothing happens": changed(
        PAPER, ("witness.settled", [{"value": [7, 1], "divisors": []}])
    ),
    "poles where nothing happens": changed(POLES, ("witness.undefined", [[1, 1], [1, 1]])),
    "other gains, and what divides both polynomials": pair([-1], [1]),
    "values beyond a range": changed(
        RANGED,
        (
            "claim.outside",
            [
                *RANGED["claim"]["outside"],
                {"value": [3, 1], "roots": [{"re": "-3", "im": "0", "radius": "0"}]},
            ],
        ),
    ),
}


@pytest.mark.parametrize(
    ("root", "radius", "beyond"),
    [("-3", "2.9", True), ("-3", "3", False), ("3", "1.9", True), ("3", "2", False)],
)
def test_a_disc_that_meets_the_range_is_not_beyond_it(root: str, radius: str, beyond: bool) -> None:
    disc = {"re": root, "im": "0", "radius": radius}
    more = {"value": [-int(root), 1], "roots": [disc]}
    found = checked(changed(RANGED, ("claim.outside", [*RANGED["claim"]["outside"], more])))
    assert (found.verdict, found.code) == (("VALID", "") if beyond else ("INVALID", "range"))


@pytest.mark.parametrize("name", KEPT)
def test_what_is_superfluous_and_true_is_accepted(name: str) -> None:
    found = checked(KEPT[name])
    assert found.verdict == "VALID", found.line()
