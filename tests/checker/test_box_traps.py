"""Ways to prove a false claim about a box that the rules have to close, each by a plant of its own.

Every document would be accepted by a checker that left out one requirement, and the claim is false
unless the test says otherwise.
"""

from __future__ import annotations

import json
from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.core.reading import Limits
from mcexact.checker.core.system import canonical_json, digest_of
from mcexact.checker.kinds import Verdict
from mcexact.checker.parametric_system import plant_of_file
from tests.checker.box_maker import DENOMINATOR, stable
from tests.checker.box_plants import (
    CALM,
    CONTROLLABLE,
    DELAYED_STABLE,
    FIXED,
    LOOP_STABLE,
    SAMPLED_STABLE,
    STABLE,
    gains,
    uncertain,
)
from tests.checker.handmade import Document, certificate, changed, checked, matrix, plant
from tests.checker.tables import rejects

BOUNDARY = {"points", "segments", "frames"}
UNIT = {"denominator": 1, "re": [[1]], "im": [[0]]}


def refused(document: Document, code: str) -> Verdict:
    """The verdict on a document, which is refused for this reason."""
    verdict = checked(document)
    assert (verdict.verdict, verdict.code) == ("INVALID", code), verdict.line()
    return verdict


def inverse(re: Fraction, im: Fraction) -> Document:
    """1/(re + i·im), as a matrix."""
    size = re**2 + im**2
    parts = (round(x / size * DENOMINATOR) for x in (re, -im))
    x, y = parts
    return {"denominator": DENOMINATOR, "re": [[x]], "im": [[y]]}


def uncontrolled(mode: Any, cover: Any, frames: list[Any], radius: str = "1.1") -> Document:
    """That x' = mode·x without inputs has no fixed mode; frames are for λ − mode, about centers."""
    system = plant([[mode]], ([[0]], [[1]]))
    exterior = {
        "F": None,
        "Y": UNIT,
        "T": UNIT,
        "discs": [{"re": "0", "im": "0", "radius": radius}],
    }
    shift = Fraction(mode)
    listed = [{"gains": None, "V": inverse(re - shift, im), "w": [1]} for re, im in frames]
    witness = {"exterior": [exterior], "gains": [], "frames": listed, "cover": [cover]}
    return certificate("box_fixed", system, {"bound": None}, witness)


def test_the_disc_around_a_square_reaches_its_corners() -> None:
    """1/5 is on the side of the first square, nearer to its corners than to the disc inside it."""
    h = Fraction(11, 20)
    centers = [(-h, -h), (-h, h), (h, -h), (h, h)]
    document = uncontrolled("1/5", [None, 0, 1, 2, 3], centers)
    assert all(h**2 < (re - Fraction(1, 5)) ** 2 + im**2 for re, im in centers)
    assert refused(document, "cell").place == "witness.cover[0][3]"


def test_what_dominates_a_row_is_rounded_down() -> None:
    """|1 − i| is above 1, and with 2 in its place a disc around 1 + i of radius 1 would do.

    The mode 0 is fixed, and farther from 1 + i.
    """
    turned = {"denominator": 1, "re": [[1]], "im": [[-1]]}
    document = changed(
        uncontrolled(0, [0], [(Fraction(1), Fraction(1))], "1.1"),
        ("witness.exterior.0.Y", turned),
        ("witness.exterior.0.discs.0", {"re": "1", "im": "1", "radius": "1.1"}),
    )
    assert refused(document, "disc").place == "witness.exterior[0].discs[0]"
    enough = changed(document, ("witness.exterior.0.discs.0.radius", "2.1"))
    assert refused(enough, "cell").place == "witness.cover[0][0]"


@pytest.mark.parametrize("turn", [(-1, 0), (0, 1)], ids=str)
def test_coordinates_do_not_make_an_entry_more_certain(turn: tuple[int, int]) -> None:
    """A is between −3 and 1, whichever way its coordinate is turned; 1 is not stable, and fixed."""
    x, y = turn
    system = plant([[-1]], ([[0]], [[1]]), uncertainty=uncertain([[2]]))
    Y, T = ({"denominator": 1, "re": [[x]], "im": [[im]]} for im in (-y, y))

    def about(radius: str) -> Document:
        discs = [{"re": "-1", "im": "0", "radius": radius}]
        exterior = [{"F": None, "Y": Y, "T": T, "discs": discs}]
        witness = {"exterior": exterior, "gains": [], "frames": [], "cover": [[]]}
        return certificate("box_fixed", system, {"bound": 0}, witness)

    assert refused(about("0.5"), "disc").place == "witness.exterior[0].discs[0]"
    assert refused(about("2.1"), "cover").place == "witness.cover[0]"


def test_what_is_not_below_the_real_axis_is_not_skipped() -> None:
    """±i are fixed, and one disc is around each of them: the lower one alone needs no cover."""
    system = plant([[0, -1], [1, 0]], ([[0], [0]], [[1, 0]]))
    exterior = {
        "F": None,
        "Y": {"denominator": 2, "re": [[1, 0], [1, 0]], "im": [[0, 1], [0, -1]]},
        "T": {"denominator": 1, "re": [[1, 1], [0, 0]], "im": [[0, 0], [-1, 1]]},
        "discs": [{"re": "0", "im": im, "radius": "0.1"} for im in ("1", "-1")],
    }
    witness = {"exterior": [exterior], "gains": [], "frames": [], "cover": [[], []]}
    document = certificate("box_fixed", system, {"bound": None}, witness)
    assert refused(document, "cover").place == "witness.cover[0]"


def test_a_cell_in_the_region_is_skipped_only_if_all_of_it_is() -> None:
    """The mode 0 is on the border; the disc reaches to 1/2 on its right."""
    document = changed(uncontrolled(0, [], [], "0.5"), ("claim.bound", 0))
    assert refused(document, "cover").place == "witness.cover[0]"
    inside = changed(document, ("system.A", [[-1]]), ("witness.exterior.0.discs.0.re", "-1"))
    assert checked(inside).verdict == "VALID"


@pytest.mark.parametrize("radius", [None, "1/10000000000000000000000000000000000000000"])
def test_a_tiny_radius_is_no_rounding(radius: str | None) -> None:
    """The input is 10⁻⁴⁰, and with a radius as large a member has none."""
    tiny = Fraction(1, 10**40)
    system = plant([[1]], ([[str(tiny)]], [[1]]))
    if radius is not None:
        system["uncertainty"] = uncertain(None, {"1": [[radius]]})
    # [λ − 1, −b; x, 1] at λ = 1 with b x = 1: its inverse is [1, b; −x, 0]
    x = 10**40
    V = {"denominator": x, "re": [[x, 1], [-x * x, 0]], "im": [[0, 0], [0, 0]]}
    exterior = {"F": None, "Y": UNIT, "T": UNIT, "discs": [{"re": "1", "im": "0", "radius": "0.1"}]}
    witness = {
        "exterior": [exterior],
        "gains": [{"X": [matrix([x])], "W": [matrix([1])]}],
        "frames": [{"gains": 0, "V": V, "w": [1, 2 * x]}],
        "cover": [[0]],
    }
    verdict = checked(certificate("box_fixed", system, {"bound": None}, witness))
    assert verdict.verdict == ("VALID" if radius is None else "INVALID"), verdict.line()


def test_eigenvalues_that_cross_far_out_are_not_overlooked() -> None:
    """-1/10 ± 4i cross the axis in the box, and the segments end at i."""
    turning = plant(
        [["-1/10", 4], [-4, "-1/10"]],
        ([[0], [0]], [[0, 0]]),
        uncertainty=uncertain([["1/5", 0], [0, "1/5"]]),
    )
    for growth in ([1, 1], [1, 3], [10**9, 1]):
        refused(stable(turning, [1], growth=growth), "growth")
    assert refused(stable(turning, [5], growth=[1, 1]), "segment").place == "witness.segments[0]"


def test_no_gain_reaches_infinity_through_the_signals() -> None:
    """Inputs are computed from outputs, these from states: radii of other ways are unknown."""
    direct = "claim.gain_radii.agents.0.input.inputs"
    assert checked(changed(LOOP_STABLE, (direct, {"1": [[2]]}))).verdict == "MALFORMED"
    feedthrough = changed(LOOP_STABLE, ("system.channels.0.D", [[1]]))
    assert checked(feedthrough).verdict == "MALFORMED"


CROSSING = plant(
    [["1/8", "7/8"], ["-7/8", "1/8"]],
    ([[0], [0]], [[0, 0]]),
    time="discrete",
    uncertainty=uncertain([["1/8", "1/8"], ["1/8", "1/8"]]),
)
"""Eigenvalues near ±7i/8, which cross the circle near ±i."""


@pytest.mark.parametrize(
    "points",
    [[], ["1/100"], [100], ["1/2", 2], ["1/8", "1/4", "1/2", "3/4", 1, "4/3", 2, 4, 8]],
    ids=str,
)
def test_no_way_around_the_circle_avoids_what_crosses_it(points: list[Any]) -> None:
    assert refused(stable(CROSSING, points), "segment").place.startswith("witness.segments")


ENDS = SAMPLED_STABLE["witness"]["points"]
ARCS = SAMPLED_STABLE["witness"]["segments"]

test_the_border_is_walked_from_end_to_end_without_a_gap = rejects(
    [
        ("an arc is longer than half the circle", SAMPLED_STABLE, ("witness.points.0", -1)),
        ("the arcs go back", SAMPLED_STABLE, ("witness.points", ENDS[::-1]), "INVALID"),
        ("arcs start beyond 0", SAMPLED_STABLE, ("witness.points.0", 0), "INVALID"),
        (
            "two arcs have become one",
            DELAYED_STABLE,
            (
                ("witness.points", DELAYED_STABLE["witness"]["points"][3:]),
                ("witness.segments", DELAYED_STABLE["witness"]["segments"][3:]),
            ),
            "INVALID",
        ),
        ("an arc is left out", SAMPLED_STABLE, ("witness.segments", ARCS[1:]), "MALFORMED"),
        ("an arc is listed that is not there", SAMPLED_STABLE, ("witness.segments", [*ARCS, 0])),
        (
            "a segment is left out",
            STABLE,
            ("witness.segments", STABLE["witness"]["segments"][1:]),
            "MALFORMED",
        ),
        ("there is no tree for a disc", FIXED, ("witness.cover", [[0]]), "MALFORMED"),
        ("there are no trees", FIXED, ("witness.cover", None), "MALFORMED"),
    ]
)

LEFT, RIGHT = FIXED["witness"]["frames"][0], CONTROLLABLE["witness"]["frames"][0]
BORDER = STABLE["witness"]["frames"][0]
test_a_frame_proves_the_kind_for_which_it_is_made = rejects(
    [
        ("of controllability, for fixed modes", FIXED, ("witness.frames.0", RIGHT), "MALFORMED"),
        ("of fixed modes, for control", CONTROLLABLE, ("witness.frames.0", LEFT), "MALFORMED"),
        ("of fixed modes, for stability", STABLE, ("witness.frames.0", LEFT), "MALFORMED"),
        ("of stability, for fixed modes", FIXED, ("witness.frames.0", BORDER), "MALFORMED"),
        (
            "of λI − A, for the pencil with gains",
            FIXED,
            ("witness.frames.0", {"gains": 0, **BORDER}),
            "MALFORMED",
        ),
        ("a boolean for gains", FIXED, ("witness.frames.0.gains", False), "MALFORMED"),
        ("a boolean for a node", FIXED, ("witness.cover.0.0", False), "MALFORMED"),
        ("a boolean for a segment", STABLE, ("witness.segments.0", False), "MALFORMED"),
        ("a boolean for a weight of growth", STABLE, ("witness.growth.0", True), "MALFORMED"),
        ("a boolean for a radius", FIXED, ("witness.exterior.0.discs.0.radius", True), "MALFORMED"),
    ]
)


def test_the_loop_that_is_stable_at_its_values_is_the_one_of_the_claim() -> None:
    """x' = x is unstable throughout, and nothing ever crosses the axis."""
    still = plant([[1]], ([[0]], [[0]]))
    document = stable(still, ["1/2", 2], growth=[1])
    assert BOUNDARY <= set(document["witness"])
    assert checked(document).verdict == "INVALID"
    faster = changed(stable(CALM, [1, 2, 4], growth=[1, 1]), ("claim.bound", 3))
    assert checked(faster).verdict == "INVALID"


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_the_values_themselves_are_in_the_region_of_the_claim(time: str) -> None:
    """Nothing ever crosses its border: −1/4, or 3/4, is stable, and stays outside."""
    points, growth = (["1/2", 1, 2], [1]) if time == "continuous" else (["1/4", "1/2", 1, 2], None)
    mode, bound = ("-1/4", 1) if time == "continuous" else ("3/4", "1/2")
    still = plant([[mode]], ([[0]], [[0]]), time=time)
    document = stable(still, points, growth=growth, bound=bound)
    assert refused(document, "claim").place == "claim.stable"


def test_digits_as_typed_tell_what_is_typed() -> None:
    """0.10 is known better than 0.1; a part of 0.10 is one of 0.1."""
    text = (
        '{"format": "mcexact-system/1", "time": "continuous", "A": [[%s]], '
        '"channels": [{"B": [[1]], "C": [[1]]}], "uncertainty": %s}'
    )

    def known(entry: str, doubt: Any) -> str:
        data = (text % (entry, json.dumps(doubt))).encode()
        return digest_of(canonical_json(plant_of_file(data, Limits())))

    typed, part = {"digits": "as typed"}, {"relative": "1/10"}
    assert known("0.10", typed) != known("0.1", typed)
    assert known("0.10", part) == known("0.1", part) == known("1e-1", part)
    assert known("0.1", typed) == known('"1e-1"', typed) != known('"1/10"', typed)


def test_channels_do_not_share_what_they_measure() -> None:
    """An X of both channels would move the mode 0, which no channel both controls and observes."""
    apart = plant([[0]], ([[1]], [[0]]), ([[0]], [[1]]))
    wide = {"X": [matrix([0, 1]), matrix([0, 0])], "W": [matrix([1]), matrix([1])]}
    V = {"denominator": 1, "re": [[0] * 3] * 3, "im": [[0] * 3] * 3}
    exterior = {"F": None, "Y": UNIT, "T": UNIT, "discs": [{"re": "0", "im": "0", "radius": "0.1"}]}
    witness = {
        "exterior": [exterior],
        "gains": [wide],
        "frames": [{"gains": 0, "V": V, "w": [1] * 3}],
        "cover": [[0]],
    }
    document = certificate("box_fixed", apart, {"bound": None}, witness)
    assert checked(document).verdict == "MALFORMED"
    narrow = changed(document, ("witness.gains.0", gains((1, 1), (1, 1))))
    assert checked(narrow).verdict == "INVALID"


@pytest.mark.parametrize("x", [2, -2])
def test_gains_of_either_sign_make_an_output_as_uncertain(x: int) -> None:
    """The mode 1 is fixed for the member without an output, and moved by X where there is one."""

    def about(radius: Any) -> Document:
        system = plant([[1]], ([[1]], [[1]]), uncertainty=uncertain(None, C={"1": [[radius]]}))
        # [λ − 1, −1; x, 1] at λ = 1: its inverse is [1/x, 1/x; −1, 0]
        sign = 1 if x > 0 else -1
        V = {"denominator": 2, "re": [[sign, sign], [-2, 0]], "im": [[0, 0], [0, 0]]}
        exterior = {
            "F": None,
            "Y": UNIT,
            "T": UNIT,
            "discs": [{"re": "1", "im": "0", "radius": "0.1"}],
        }
        witness = {
            "exterior": [exterior],
            "gains": [gains((x, 1))],
            "frames": [{"gains": 0, "V": V, "w": [1, 3]}],
            "cover": [[0]],
        }
        return certificate("box_fixed", system, {"bound": None}, witness)

    assert refused(about(1), "cell").place == "witness.cover[0][0]"
    assert checked(about("1/2")).verdict == "VALID"


@pytest.mark.parametrize("doubtful", ["B", "C"])
@pytest.mark.parametrize(("b", "c"), [(1, 1), (-1, 1), (1, -1)])
def test_gains_move_nothing_where_an_input_or_an_output_may_be_absent(
    doubtful: str, b: int, c: int
) -> None:
    """0 is moved to −2 by u = ±2y; it is fixed for the member whose input or output is 0."""

    def about(part: Any, radius: str) -> Document:
        doubts: Document = {"B": None, "C": None, doubtful: {"1": [[part]]}}
        system = plant([[0]], ([[b]], [[c]]), uncertainty=uncertain(None, **doubts))
        around = {"Y": UNIT, "T": UNIT}
        exterior = [
            {"F": None, **around, "discs": [{"re": "0", "im": "0", "radius": "0.001"}]},
            {
                "F": [matrix([-2 * b * c])],
                **around,
                "discs": [{"re": "-2", "im": "0", "radius": radius}],
            },
        ]
        witness = {"exterior": exterior, "gains": [], "frames": [], "cover": [[]]}
        return certificate("box_fixed", system, {"bound": None}, witness)

    assert refused(about(1, "1.998"), "disc").place == "witness.exterior[1].discs[0]"
    assert refused(about(1, "2.001"), "cover").place == "witness.cover[0]"
    assert checked(about("99/100", "1.981")).verdict == "VALID"


def test_a_mode_that_no_gains_move_is_in_discs_of_all_matrices() -> None:
    """Discs of the same mode are far from each other around their centers, and meet in it."""
    system = plant([[0]], ([[0]], [[1]]))
    exterior = [
        {
            "F": F,
            "Y": {"denominator": 1000, "re": [[1000]], "im": [[0]]},
            "T": UNIT,
            "discs": [{"re": re, "im": re, "radius": "0.708"}],
        }
        for F, re in ((None, "0.5"), ([matrix([7])], "-0.5"), ([matrix([-9])], "0.5"))
    ]
    for cover in ([], [None], [None, None]):
        witness = {"exterior": exterior, "gains": [], "frames": [], "cover": [cover]}
        refused(certificate("box_fixed", system, {"bound": None}, witness), "cover")
