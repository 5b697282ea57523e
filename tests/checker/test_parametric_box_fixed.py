"""The rule of ``parametric_box_fixed``: no mode is fixed at any values within ranges."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

from tests.checker.box_plants import gains
from tests.checker.handmade import changed, checked, ranged, without
from tests.checker.parameter_plants import (
    ALL,
    CURVED,
    FIXED,
    HALVES,
    ONE_VALUE,
    QUARTERS,
    SPRING,
    STABILIZABLE,
    TIED,
    fixed,
)
from tests.checker.tables import accepts, rejects
from tests.wording import says

OF_THIS_KIND = [(name, each) for name, each in ALL.items() if each["kind"] == FIXED]

test_what_is_made_is_proved = accepts(OF_THIS_KIND)

CUTS, PART = "witness.cuts", "witness.parts.0"
RANGE = "system.parameters.k.range"
PARTS = HALVES["witness"]["parts"]
test_what_proves_less_is_refused = rejects(
    [
        ("the range is larger", TIED, (RANGE, [0, 4]), "INVALID"),
        ("the range is elsewhere", TIED, (RANGE, ["5/4", "7/4"]), "INVALID"),
        ("the range has one end", TIED, (RANGE, ["1/4", None]), "MALFORMED"),
        ("the range has no first end", TIED, (RANGE, [None, "3/4"]), "MALFORMED"),
        ("there is no range", TIED, ("system.parameters.k", {}), "MALFORMED"),
        ("an entry depends on more", TIED, ("system.channels.0.B.0.0", "4*k - 2"), "INVALID"),
        ("the slope of an entry turns round", TIED, ("system.A.0.1", "-k + 1"), "INVALID"),
        ("a square is steeper", CURVED, ("system.A.0.0", "8*t^2"), "INVALID"),
        (
            "a denominator reaches 0",
            CURVED,
            ("system.channels.0.C.0.0", "(1)/(t - 1/2)"),
            "INVALID",
        ),
        ("a denominator is 0 at one end", CURVED, ("system.channels.0.C.0.0", "(1)/(t)")),
        ("a parameter reaches 0 in a denominator", QUARTERS, ("system.parameters.b.range.0", 0)),
        ("a cell is missing", HALVES, (CUTS, [0, None]), "INVALID"),
        ("both halves are missing", HALVES, (CUTS, [0]), "INVALID"),
        ("a cell is too many", HALVES, (CUTS, [0, None, None, None]), "INVALID"),
        ("no cell is cut", HALVES, (CUTS, [None]), "MALFORMED"),
        ("there are no cells", HALVES, (CUTS, []), "INVALID"),
        ("there are no cells at all", HALVES, (CUTS, None), "MALFORMED"),
        ("a cell is cut twice", HALVES, (CUTS, [0, 0, None, None, None]), "MALFORMED"),
        ("another parameter is cut", QUARTERS, (CUTS, [0, 1, None, None, None]), "INVALID"),
        ("an unknown parameter is cut", HALVES, (CUTS, [1, None, None]), "MALFORMED"),
        ("a parameter far beyond is cut", HALVES, (CUTS, [7, None, None]), "MALFORMED"),
        ("a negative parameter is cut", HALVES, (CUTS, [-1, None, None]), "MALFORMED"),
        ("a boolean is cut", HALVES, (CUTS, [False, None, None]), "MALFORMED"),
        ("a part is missing", HALVES, ("witness.parts", PARTS[:1]), "MALFORMED"),
        ("a part is too many", HALVES, ("witness.parts", [*PARTS, PARTS[0]]), "MALFORMED"),
        (
            "the parts are exchanged",
            QUARTERS,
            ("witness.parts", QUARTERS["witness"]["parts"][::-1]),
        ),
        ("the parts are no list", HALVES, ("witness.parts", None), "MALFORMED"),
        ("a tree is empty", TIED, (f"{PART}.cover.0", []), "INVALID"),
        ("a disc shrinks", TIED, (f"{PART}.exterior.0.discs.0.radius", "0.5"), "INVALID"),
        ("a weight is 0", TIED, (f"{PART}.frames.0.w.0", 0), "MALFORMED"),
        ("gains are others", TIED, (f"{PART}.gains.0", gains((9, 1), (-9, 1))), "INVALID"),
        ("the bound is larger", STABILIZABLE, ("claim.bound", 2), "INVALID"),
        ("there is no bound", STABILIZABLE, ("claim.bound", None), "INVALID"),
        ("the bound is a rate below 0", STABILIZABLE, ("claim.bound", -1), "INVALID"),
        ("the claim has another key", TIED, ("claim.channels", ["1"]), "MALFORMED"),
    ]
)


@pytest.mark.parametrize("part", ["cuts", "parts"])
def test_every_part_of_the_witness_is_needed(part: str) -> None:
    assert checked(without(TIED, f"witness.{part}")).verdict == "MALFORMED"


def test_the_statement_names_the_ranges() -> None:
    both = "a from 19/20 to 21/20 and of the parameter b from 39/40 to 41/40, there is no mode"
    for document, said in (
        (TIED, "k from 1/4 to 3/4, there is no mode that is fixed under"),
        (STABILIZABLE, "k from 1/4 to 3/4, there is no mode of real part at least 0"),
        (QUARTERS, both),
        (ONE_VALUE, "t from 1/2 to 1/2, there is no mode that is fixed under"),
    ):
        statement = checked(document).statement
        assert says(statement, "ranges") and f" of the parameter {said}" in statement


def halved(times: int) -> list[int | None]:
    """The cuts of the ranges of one parameter, over and over."""
    return [0, *halved(times - 1), *halved(times - 1)] if times else [None]


def test_what_depends_on_one_parameter_is_moved_together() -> None:
    """The modes k and k + 1 are never the same, which one input would not move apart.

    With independent entries of the same ranges both can be 3/2.
    """
    system = ranged([["t", 0], [0, "t + 1"]], ([[1], [1]], [[1, 1]]), t=(0, 2))
    assert checked(fixed(system, halved(4), [gains((1, 1)), gains((-1, 1))])).verdict == "VALID"
    apart = changed(system, ("A", [["t", 0], [0, "-t + 3"]]))
    true = fixed(changed(apart, ("parameters.t.range", [0, 1])), halved(3), [gains((1, 1))])
    assert checked(true).verdict == "VALID"
    assert checked({**true, "system": apart}).verdict == "INVALID"


@pytest.mark.parametrize("number", range(6))
def test_a_plant_with_a_fixed_mode_in_the_range_is_never_proved(number: int) -> None:
    """At t = s the input vanishes; the witness is the one about another range or entry."""
    rng = random.Random(number)
    s = Fraction(rng.randint(1, 7), 8)
    system = ranged([[1]], ([[f"t - {s}"]], [[1]]), t=(2, 3))
    true = fixed(system, [None], [gains((4, 1))])
    assert checked(true).verdict == "VALID"
    for ends in ([0, 1], [str(s), str(s)], [str(s), 3], [0, str(s)], [-1, 3]):
        assert checked(changed(true, ("system.parameters.t.range", ends))).verdict == "INVALID"


def test_other_kinds_are_not_about_ranges_of_several_parameters() -> None:
    document = {**QUARTERS, "kind": "parametric_fixed_spectrum"}
    assert checked(document).verdict == "INCOMPLETE"
    assert checked({**QUARTERS, "kind": "box_fixed"}).verdict == "MALFORMED"
    plain = {k: part for k, part in SPRING.items() if k != "parameters"}
    plain["A"] = [[0, 0], [0, 0]]
    assert checked({**TIED, "system": plain}).verdict == "MALFORMED"
