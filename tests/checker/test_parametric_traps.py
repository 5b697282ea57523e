"""Ways to prove what is false for some value of a parameter, and true claims that look like it."""

from __future__ import annotations

from typing import Any

import pytest

from tests.assurance.attack.forgeries.parametric_traps import (
    FIXED_AT_ONE,
    FIXED_AT_ZERO,
    FREE,
    ONE_BY_ONE,
    ONE_ROW,
    RANKS,
    SPECTRA,
    THROUGH_A_ZERO,
    TWO_BY_TWO,
    UNMOVED,
    X,
    block,
    layers,
    plant,
    rank,
    scalar,
    spectrum,
    with_gains,
)
from tests.checker.handmade import Document, changed, checked

CODES = {
    "a value is divided out modulo ℓ, with one that is congruent to it": "common_factor",
    "ℓ divides the denominator of a value": "unit",
    "powers of a generic polynomial are divided out modulo ℓ": "common_factor",
    "a value is divided out modulo ℓ alone, with one that is congruent to it": "common_factor",
    "ℓ alone divides the denominator of a value": "degree",
    "a value is divided out once for each time that it is named": "common_factor",
    "a value is divided out as often as the degree of what divides nothing": "divisor",
    "a value is divided out that is not named": "claim",
    "scalars are restricted to a companion matrix": "common_factor",
    "the leading coefficient of a resultant is no unit": "unit",
    "a value where nothing is fixed": "claim",
    "a real value in a disc beside the axis": "disc",
    "the resultant is known modulo too small a number": "modulus",
    "the first resultant vanishes, and the second one modulo ℓ nowhere": "product",
    "channels at whose pencil no rank is lost": "claim",
    "an entry that is not written canonically": "form",
    "a divisor of no polynomial of fixed modes": "divisor",
    "a polynomial that is not monic": "form",
    "a real value beyond no range": "range",
    "a pole of no entry": "pole",
    "a value at which an entry is undefined": "pole",
    "a zero block of another mode": "identity",
    "a zero block beside inputs that act": "identity",
    "a zero block beside outputs that see": "identity",
    "a zero block without rows": "rank",
    "a zero block that vanishes at a root of p": "pivots",
    "one row of W twice": "pivots",
    "a zero block that is zero": "pivots",
    "a zero at the end of a coefficient": "form",
    "a parameter that is called x": "form",
    "a value is divided out of a minor modulo ℓ": "common_factor",
    "ℓ divides the denominator of a root of a minor": "unit",
    "a minor of no rows and no columns": "rank",
    "a minor that is zero beside one that is 1 modulo ℓ": "product",
    "a part of the kernel at a value": "common_factor",
    "a value at which the rank is not less": "claim",
    "a kernel without columns": "rank",
    "a kernel that is not annihilated": "identity",
    "more blocks than states": "claim",
    "outputs of another number of states": "form",
    "a range upside down": "form",
    "inputs of another number of states": "form",
    "an entry of too high a degree": "form",
    "an entry that is too long": "form",
}


def test_every_trap_has_its_reason() -> None:
    assert CODES.keys() == {**SPECTRA, **RANKS}.keys()


@pytest.mark.parametrize("trap", CODES)
def test_what_looks_proved_and_is_false_is_refused(trap: str) -> None:
    found = checked({**SPECTRA, **RANKS}[trap])
    assert found.code == CODES[trap], found.line()
    assert found.verdict == ("MALFORMED" if CODES[trap] == "form" else "INVALID")


FIXED_AT_EIGHT = (
    {
        "value": [-8, 1],
        "roots": [{"re": "8", "im": "0", "radius": "0"}],
        "modes": [{"polynomial": X, "channels": []}],
    },
    {"modes": [ONE_ROW], "divisors": []},
)
ROOTS_OF_TWO = [
    {"re": sign + "1.414213562373095", "im": "0", "radius": "0.000000000000001"}
    for sign in ("-", "")
]
OUTER_ROWS = [[1, 0, 0], [0, 0, 1]]
OUTER_COLUMNS = [[1, 0], [0, 0], [0, 1]]
TRUE: dict[str, Document] = {
    "both of two values that are congruent modulo 7": spectrum(
        scalar("t^2 - 9*t + 8"), exceptional=(FIXED_AT_ONE, FIXED_AT_EIGHT)
    ),
    "both, each divided out once": spectrum(
        scalar("t^2 - 9*t + 8"),
        moduli=(),
        exceptional=(FIXED_AT_ONE, FIXED_AT_EIGHT),
        common=(([-1, 1], X), ([-8, 1], X)),
    ),
    "a value whose denominator is a unit": spectrum(
        scalar("7*t - 1"),
        exceptional=(
            (
                {
                    "value": ["-1/7", 1],
                    "roots": [{"re": "0.142857", "im": "0", "radius": "0.000001"}],
                    "modes": [{"polynomial": X, "channels": []}],
                },
                {"modes": [ONE_ROW], "divisors": []},
            ),
        ),
    ),
    "a generic mode and one that is congruent to it": spectrum(
        plant([[0, 0], [0, 7]], ([[0], ["t"]], [[1, 1]])),
        generic=((X, block(["1"], [layers([[1, 0], [0, 1]])], layers([[1, 0]]), [0, 1], [0])),),
        exceptional=(
            (
                {
                    "value": [0, 1],
                    "roots": FIXED_AT_ZERO[0]["roots"],
                    "modes": [{"polynomial": [[-7], [1]], "channels": []}],
                },
                {
                    "modes": [
                        block(["1"], [layers([[1, 0], [0, 1]])], layers([[0, 1]]), [0, 1], [1])
                    ],
                    "divisors": [],
                },
            ),
        ),
    ),
    "modes that depend on an irrational value": spectrum(
        THROUGH_A_ZERO,
        exceptional=(
            (
                {
                    "value": [-2, 0, 1],
                    "roots": ROOTS_OF_TWO,
                    "modes": [{"polynomial": [[0, -1], [1]], "channels": ["2"]}],
                },
                {
                    "modes": [
                        block(["1"], [layers(OUTER_COLUMNS)], layers(OUTER_ROWS), [0, 2], [0, 2])
                    ],
                    "divisors": [],
                },
            ),
        ),
    ),
}
TRUE |= {
    "a resultant that is known exactly": spectrum(
        scalar("5*t + 1"),
        exceptional=(
            (
                {
                    "value": ["1/5", 1],
                    "roots": [{"re": "-0.2", "im": "0", "radius": "0"}],
                    "modes": [{"polynomial": X, "channels": []}],
                },
                {"modes": [ONE_ROW], "divisors": []},
            ),
        ),
        moduli=(17,),
    ),
    "a zero block as small as one may be": spectrum(
        plant([[0]], ([[0]], [["t"]])), generic=(UNMOVED,)
    ),
    "a plant without fixed modes": spectrum(FREE),
    "a parameter that is called y": spectrum(
        scalar("y", parameter="y"), exceptional=(FIXED_AT_ZERO,)
    ),
    "a minor of all rows and columns": rank(
        plant([[0, 0], [0, 0]], ([["t", 0], [0, "t"]], [[1, 0]])),
        2,
        ([0, 1], [0, 1]),
        TWO_BY_TWO,
        exceptional=(
            (
                {"value": [0, 1], "roots": FIXED_AT_ZERO[0]["roots"], "rank": 0},
                {"columns": layers([[1, 0], [0, 1]]), "pivots": [0, 1]},
            ),
        ),
    ),
    "an entry of the largest degree": rank(
        plant([[0]], ([[1]], [["t^1000"]])), 1, ([0], [0]), ONE_BY_ONE
    ),
}


@pytest.mark.parametrize("name", TRUE)
def test_what_is_true_and_proved_is_accepted(name: str) -> None:
    found = checked(TRUE[name])
    assert found.verdict == "VALID", found.line()


TOGETHER = plant([[0]], ([["t - 1", 1]], [[1]]))
"""0 is moved by t − 1 and by 1, which cancel where gains are unlucky."""


@pytest.mark.parametrize(
    ("first", "second", "code"),
    [
        ([1, 0], [2, 0], "common_factor"),
        ([1, 1], [2, 2], "common_factor"),
        ([0, 0], [1, 1], "product"),
        ([1, 0], [0, 1], ""),
        ([1, 0], [1, 1], ""),
    ],
)
def test_small_gains_that_meet_by_accident_prove_nothing(
    first: list[int], second: list[int], code: str
) -> None:
    """The claim is true: other gains have to be drawn."""
    document = with_gains(spectrum(TOGETHER), [0, 0], first, second)
    assert checked(document).code == code


def test_gains_are_constant() -> None:
    """With gains over Q[t]/(q) as those of a companion matrix, more would be moved."""
    polynomial = layers([[1]], [[1]])
    document = changed(SPECTRA["scalars are restricted to a companion matrix"])
    document["witness"]["gains"][0][0] = polynomial
    assert checked(document).verdict == "MALFORMED"


def test_a_line_in_the_space_of_several_parameters_is_a_plant_of_its_own() -> None:
    """On the line u = 0 the mode 0 is fixed for every t, and for no t off it but t = 0."""
    wide = scalar("t*u")
    wide["parameters"] = {"t": {}, "u": {}}
    both = spectrum(wide, exceptional=(FIXED_AT_ZERO,))
    assert checked(both).verdict == "INCOMPLETE"
    on_the_line = spectrum(plant([[0]], ([[0]], [["t"]])), generic=(UNMOVED,))
    assert checked(on_the_line).verdict == "VALID"
    assert checked(spectrum(scalar("t"), exceptional=(FIXED_AT_ZERO,))).verdict == "VALID"


def test_a_value_is_undefined_where_a_denominator_vanishes_and_nowhere_else() -> None:
    inverse = scalar("(t - 1)/(t + 1)")
    settled: dict[str, Any] = {"value": [-1, 1], "divisors": []}
    assert checked(spectrum(inverse, exceptional=(FIXED_AT_ONE,))).verdict == "VALID"
    for key, value in (("undefined", [-1, 1]), ("settled", settled)):
        document = changed(spectrum(inverse), (f"witness.{key}", [value]))
        assert checked(document).code == ("pole" if key == "undefined" else "common_factor")
    pole = plant([[0]], ([["t - 1"]], [["(1)/(t - 1)"]]))
    document = changed(spectrum(pole), ("witness.undefined", [[-1, 1]]))
    assert checked(document).verdict == "VALID"
    assert checked(spectrum(pole)).code == "common_factor"
    assert checked(spectrum(pole, exceptional=(FIXED_AT_ONE,))).code == "pole"
