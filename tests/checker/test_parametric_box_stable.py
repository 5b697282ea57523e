"""The rule of ``parametric_box_stable``: all eigenvalues are in a region at all values."""

from __future__ import annotations

import json
from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.cells import cells_of, members_of_cell, subject_of
from mcexact.checker.constructions import closed_loop
from mcexact.checker.core.reading import Limits
from mcexact.checker.discs import loop_pencil
from mcexact.checker.kinds import Expectation, check_document
from mcexact.checker.parametric_system import plant_of
from tests.checker.box_maker import Rows, fractions
from tests.checker.box_plants import GAIN_RADII, LOOP, LOOP_STABLE
from tests.checker.handmade import Document, changed, checked, ranged, without
from tests.checker.parameter_plants import (
    ALL,
    DAMPED,
    LINKS,
    LOOP_DAMPED,
    LOOP_SAMPLED,
    SAMPLED,
    SHARING,
    STABLE,
    TURNED,
    TURNING,
    WAYS,
    stable,
)
from tests.checker.tables import accepts, rejects
from tests.checker.test_box_stable import loop_of
from tests.wording import says

OF_THIS_KIND = [(name, each) for name, each in ALL.items() if each["kind"] == STABLE]

test_what_is_made_is_proved = accepts(OF_THIS_KIND)

CUTS, PART = "witness.cuts", "witness.parts.0"
RANGE = "system.parameters.k.range"
PARTS = LOOP_DAMPED["witness"]["parts"]
RADII = "claim.gain_radii"
CONTROLLER = "subject.0.controller"
test_what_proves_less_is_refused = rejects(
    [
        ("the range is larger", LOOP_DAMPED, (RANGE, [0, 4]), "INVALID"),
        ("the range is elsewhere", LOOP_DAMPED, (RANGE, ["9/4", "11/4"]), "INVALID"),
        ("the range has one end", LOOP_DAMPED, (RANGE, ["1/4", None]), "MALFORMED"),
        ("there is no range", LOOP_DAMPED, ("system.parameters.k", {}), "MALFORMED"),
        ("an entry is steeper", LOOP_DAMPED, ("system.A.0.0", "-40*k + 16"), "INVALID"),
        (
            "an input is steeper",
            LOOP_DAMPED,
            ("system.channels.0.B.0.0", "33*k - 31/2"),
            "INVALID",
        ),
        (
            "an output is steeper",
            LOOP_DAMPED,
            ("system.channels.1.C.0.1", "33*k - 31/2"),
            "INVALID",
        ),
        ("the slope of an entry turns round", TURNED, ("system.A.1.0", "t"), "INVALID"),
        ("an entry is curved", TURNED, ("system.A.0.0", "9*t^2 - 1"), "INVALID"),
        (
            "a denominator reaches 0",
            LOOP_DAMPED,
            ("system.channels.1.C.0.1", "(1)/(k - 1/2)"),
            "INVALID",
        ),
        ("a cell is missing", LOOP_DAMPED, (CUTS, [0, None]), "INVALID"),
        ("a cell is too many", LOOP_DAMPED, (CUTS, [0, None, None, None]), "INVALID"),
        ("no cell is cut", LOOP_DAMPED, (CUTS, [None]), "MALFORMED"),
        ("a part is missing", LOOP_DAMPED, ("witness.parts", PARTS[:1]), "MALFORMED"),
        ("a part is too many", LOOP_DAMPED, ("witness.parts", [*PARTS, PARTS[0]]), "MALFORMED"),
        ("an unknown parameter is cut", LOOP_SAMPLED, (CUTS, [2, None, None]), "MALFORMED"),
        (
            "the parts are exchanged",
            TURNED,
            ("witness.parts", TURNED["witness"]["parts"][::-1]),
            "INVALID",
        ),
        ("the last cell is unstable", TURNED, (f"{PART}.nominal", {"method": "none"}), "MALFORMED"),
        ("a segment is too few", TURNED, (f"{PART}.segments", [0, 1]), "MALFORMED"),
        ("a segment has another frame", TURNED, (f"{PART}.segments.4", 0), "INVALID"),
        ("growth is too uneven", TURNED, (f"{PART}.growth", [1, 1000]), "INVALID"),
        ("growth in discrete time", LOOP_SAMPLED, (f"{PART}.growth", [1, 1, 1]), "INVALID"),
        ("a weight is 0", TURNED, (f"{PART}.frames.0.w.0", 0), "MALFORMED"),
        ("the rate is larger", LOOP_DAMPED, ("claim.bound", 2), "INVALID"),
        ("the rate is negative", LOOP_DAMPED, ("claim.bound", -1), "INVALID"),
        (
            "radii of the gains are larger",
            LOOP_DAMPED,
            (f"{RADII}.agents.0.input.outputs.1", [[2]]),
        ),
        ("radii of gains without a loop", TURNED, (RADII, GAIN_RADII), "INVALID"),
        (
            "the controller is another",
            LOOP_DAMPED,
            (f"{CONTROLLER}.agents.1.input.outputs.2", [[9]]),
            "INVALID",
        ),
        ("the controller is in another time", LOOP_DAMPED, (f"{CONTROLLER}.time", "discrete")),
        (
            "an agent uses what it does not get",
            LOOP_SAMPLED,
            ("subject.0.added", [["1", "2"]]),
            "INVALID",
        ),
        ("there are no links", LOOP_SAMPLED, ("subject", [SHARING]), "INVALID"),
        ("a construction behind the loop", LOOP_DAMPED, ("subject", [LOOP, LINKS]), "INCOMPLETE"),
        ("two loops", LOOP_DAMPED, ("subject", [LOOP, LOOP]), "INCOMPLETE"),
        ("what computes", LOOP_DAMPED, ("subject.0.construction", "feedback"), "INCOMPLETE"),
        (
            "a loop without a controller",
            LOOP_DAMPED,
            ("subject", [{"construction": "closed_loop"}]),
        ),
        ("a construction that is no object", LOOP_DAMPED, ("subject", [[]]), "MALFORMED"),
        ("constructions that are no list", LOOP_DAMPED, ("subject", LOOP), "MALFORMED"),
    ]
)


@pytest.mark.parametrize("part", ["cuts", "parts"])
def test_every_part_of_the_witness_is_needed(part: str) -> None:
    assert checked(without(TURNED, f"witness.{part}")).verdict == "MALFORMED"


def test_the_statement_names_the_loop_the_ranges_and_the_radii() -> None:
    said = checked(LOOP_DAMPED).statement
    assert says(said, "closed sha")
    assert says(said, "states continuous")
    assert says(said, "controllers differ")
    assert says(said, "being sha")
    assert says(said, "eigenvalue below")
    said = checked(LOOP_SAMPLED).statement
    assert says(said, "added controlled")
    assert says(said, "parameter")
    assert said.endswith(" to 17/16, every eigenvalue of A has modulus below 1")
    said = checked(TURNED).statement
    assert says(said, "eigenvalue below 2")


def test_other_kinds_are_not_about_loops_of_plants_with_parameters() -> None:
    for kind in ("parametric_box_fixed", "parametric_rank", "parametric_fixed_spectrum"):
        assert checked({**LOOP_DAMPED, "kind": kind}).verdict == "INCOMPLETE"
    assert checked({**LOOP_DAMPED, "kind": "box_stable"}).verdict == "MALFORMED"
    plain = {k: part for k, part in TURNING.items() if k != "parameters"}
    plain["A"] = [[-1, 0], [0, -1]]
    assert checked({**TURNED, "system": plain}).verdict == "MALFORMED"


def controller_file(step: Document, system: str = "") -> bytes:
    """The file of a controller."""
    given = {"format": "mcexact-controller/1", "system": system, **step["controller"]}
    return json.dumps(given).encode()


def test_the_loop_is_that_of_the_controller_that_is_asked_for() -> None:
    wanted = Expectation().controlled(controller_file(LOOP), Limits())
    assert check_document(LOOP_DAMPED, wanted).verdict == "VALID"
    assert check_document(LOOP_DAMPED, wanted).controller_digest == wanted.controller
    other = changed(LOOP, ("controller.agents.1.input.outputs.2", [[-2]]))
    wanted = Expectation().controlled(controller_file(other), Limits())
    assert check_document(LOOP_DAMPED, wanted).code == "controller"
    assert check_document(TURNED, wanted).code == "controller"


def test_a_controller_is_made_at_values_of_the_parameters() -> None:
    """So the digest of a plant in its file is not that of the plant with parameters."""
    wanted = Expectation().controlled(controller_file(LOOP, "0" * 64), Limits())
    assert check_document(LOOP_DAMPED, wanted).verdict == "VALID"
    verdict = check_document(LOOP_STABLE, wanted)
    assert (verdict.verdict, verdict.code) == ("NOT ABOUT", "controller")


def value_of(M: Rows, parts: list[tuple[Rows, Fraction]]) -> Rows:
    """A matrix and so many times others."""
    return [
        [entry + sum(share * N[i][j] for N, share in parts) for j, entry in enumerate(row)]
        for i, row in enumerate(M)
    ]


@pytest.mark.parametrize(
    ("system", "steps", "cuts"),
    [
        (TURNING, (), [None]),
        (DAMPED, (LOOP,), [0, None, None]),
        (SAMPLED, (LINKS, SHARING), [0, 1, None, None, None]),
    ],
    ids=["the plant", "a loop", "a loop with links"],
)
def test_the_loop_at_values_is_within_the_pencil_of_its_cell(
    system: Document, steps: tuple[Document, ...], cuts: Any
) -> None:
    """The loop at a value is that of a pencil which differs from the center along the ties."""
    given = plant_of(system)
    subject: Any = subject_of(list(steps), given, STABLE)
    for cell in cells_of(cuts, "", subject):
        pencil = loop_pencil(members_of_cell(subject, cell), None)
        Z, D = fractions(pencil.Z), fractions(pencil.D)
        for share in (Fraction(-1), Fraction(1, 3), Fraction(1)):
            point = [((b + a) + share * (b - a)) / 2 for a, b in cell]
            inside: Any = subject_of(list(steps[:-1]), given, STABLE)
            here = members_of_cell(inside, [(x, x) for x in point])
            loop = closed_loop(here, {"controller": steps[-1]["controller"]}, "") if steps else here
            moved = value_of(Z, [(fractions(M), share) for M in pencil.tied])
            exact = loop_pencil(members_of_cell(subject, [(x, x) for x in point]), None)
            at_values = loop_of(fractions(exact.Z), exact.dynamic) if steps else fractions(exact.Z)
            assert at_values == fractions(loop.A)
            for row, near, radii in zip(fractions(exact.Z), moved, D, strict=True):
                pairs = zip(row, near, radii, strict=True)
                assert all(abs(x - y) <= radius for x, y, radius in pairs)


def test_what_depends_on_one_parameter_is_moved_together() -> None:
    """The eigenvalues −1 ± it have the real part −1; with t twice they are −1 ± t."""
    apart = changed(TURNED, ("system.A.1.0", "t"), ("system.parameters.t.range", [-1, "15/16"]))
    verdict = checked(apart)
    assert (verdict.verdict, verdict.code) == ("INVALID", "segment")


@pytest.mark.parametrize("last", [2, "5/2", 3, "7/2"])
@pytest.mark.parametrize(("entry", "ends"), [("t", (-3, -1)), ("-t", (1, 3))])
def test_growth_is_what_members_reach_along_the_ties(
    entry: str, ends: tuple[int, int], last: Any
) -> None:
    """x' = ax, a from −3 to −1: what grows as fast as 3 has to be excluded by the points."""
    system = ranged([[entry]], ([[1]], [[1]]), t=ends)
    near = [Fraction(k, 4) for k in range(1, 15) if Fraction(k, 4) <= Fraction(last)]
    points = [int(x) if x.denominator == 1 else str(x) for x in near]
    verdict = checked(stable(system, [None], points, growth=[1]))
    grows = Fraction(last) <= 3
    assert (verdict.verdict, verdict.code) == (("INVALID", "growth") if grows else ("VALID", ""))


@pytest.mark.parametrize("end", [2, "31/16", "5/4"])
def test_a_loop_that_is_unstable_in_the_range_is_never_proved(end: Any) -> None:
    """x' = (k − 2)x + ku, u = −y/2 is stable for k below 4; the witness is about another range."""
    system = ranged([["k - 2"]], ([["k"]], [[1]]), k=(0, 1))
    agent = {"name": "1", "shared": 0, "private": 0, "shared_update": {}, "private_update": {}}
    agent["input"] = {"outputs": {"1": [["-1/2"]]}}
    step = {
        "construction": "closed_loop",
        "controller": {"time": "continuous", "agents": [agent]},
    }
    true = stable(system, [0, None, None], WAYS, step, growth=[1])
    assert checked(true).verdict == "VALID"
    for ends in ([0, 8], [end, 5], [4, 4], [5, 6]):
        assert checked(changed(true, ("system.parameters.k.range", ends))).verdict == "INVALID"
