"""The rule of ``box_stable``: no eigenvalue of a member crosses the border of the region."""

from __future__ import annotations

import itertools
from fractions import Fraction
from math import lcm
from operator import mul
from typing import Any

import pytest

from mcexact.checker.boxes import segments_of
from mcexact.checker.constructions import read_subject
from mcexact.checker.core.arithmetic import Matrix, characteristic_polynomial
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.roots import in_region
from mcexact.checker.core.system import read_plant
from mcexact.checker.discs import Pencil, loop_pencil
from tests.checker.box_maker import Rows, fractions, solved, stable, subject_of
from tests.checker.box_plants import (
    ALL,
    CALM,
    DAMPED,
    DELAYED,
    DELAYED_RADII,
    DELAYED_STABLE,
    GAIN_RADII,
    LOOP,
    LOOP_STABLE,
    SAMPLED_STABLE,
    STABLE,
    uncertain,
)
from tests.checker.handmade import Document, changed, checked, plant, without
from tests.checker.tables import accepts, rejects
from tests.wording import says

KIND = "box_stable"
OF_THIS_KIND = [(name, each) for name, each in ALL.items() if each["kind"] == KIND]

test_what_is_made_is_proved = accepts(OF_THIS_KIND)

FRAME = "witness.frames.0"
RADII = "claim.gain_radii"
RADIUS = f"{RADII}.agents.0.input.outputs.1"
PLANT_A = "system.uncertainty.absolute.A.entries"
POINTS = LOOP_STABLE["witness"]["points"]
SEGMENTS = LOOP_STABLE["witness"]["segments"]
test_what_proves_less_is_refused = rejects(
    [
        ("the radii of A are larger", STABLE, (PLANT_A, [[0, 0, 2], [1, 1, 2]]), "INVALID"),
        (
            "the radii of A are larger, in a loop",
            LOOP_STABLE,
            (PLANT_A, [[0, 0, 4], [1, 1, 4]]),
            "INVALID",
        ),
        ("the radii of the gains are larger", LOOP_STABLE, (RADIUS, [[2]]), "INVALID"),
        ("a radius of the gains is negative", LOOP_STABLE, (RADIUS, [["-1/100"]]), "MALFORMED"),
        ("the radii are of another shape", LOOP_STABLE, (RADIUS, [[0, 0]]), "MALFORMED"),
        ("radii of other agents", LOOP_STABLE, (f"{RADII}.agents.1.name", "3"), "INVALID"),
        ("radii of more states", LOOP_STABLE, (f"{RADII}.agents.1.private", 1), "INVALID"),
        ("radii in another time", LOOP_STABLE, (f"{RADII}.time", "discrete"), "INVALID"),
        (
            "radii in another time, sampled",
            DELAYED_STABLE,
            (f"{RADII}.time", "continuous"),
            "INVALID",
        ),
        (
            "radii of what holds its messages",
            DELAYED_STABLE,
            (f"{RADII}.agents.0.hold", {"2": 1}),
            "INVALID",
        ),
        ("radii of gains that are no loop's", STABLE, (RADII, GAIN_RADII), "INVALID"),
        (
            "a radius of an output that is not received",
            LOOP_STABLE,
            (f"{RADII}.agents.1.input.outputs", {"1": [["1/100"]]}),
            "INVALID",
        ),
        (
            "a radius of an output of before that nothing else reads",
            DELAYED_STABLE,
            ("subject.0.controller.agents.0.private_update", {"private": [["1/4"]]}),
            "INVALID",
        ),
        ("no radii are claimed", LOOP_STABLE, (RADII, 0), "MALFORMED"),
        ("the rate is larger", LOOP_STABLE, ("claim.bound", 2), "INVALID"),
        ("the rate is negative", LOOP_STABLE, ("claim.bound", -1), "INVALID"),
        ("the radius of the region is another", SAMPLED_STABLE, ("claim.bound", "2/3"), "INVALID"),
        (
            "the nominal loop is another",
            LOOP_STABLE,
            ("subject.0.controller.agents.1.input.outputs.2", [[9]]),
            "INVALID",
        ),
        (
            "the nominal loop is not stable",
            STABLE,
            ("claim.bound", 1),
            "INVALID",
        ),
        (
            "the nominal proof is for what is unstable",
            STABLE,
            ("witness.nominal", {"method": "instability", "P": 0, "R2": 0, "v": 0}),
            "INVALID",
        ),
        ("a point is 0", STABLE, ("witness.points.0", 0), "INVALID"),
        ("points go back", STABLE, ("witness.points", [2, 1, 4]), "INVALID"),
        ("points stay", STABLE, ("witness.points", [1, 1, 4]), "INVALID"),
        ("a point is a decimal text", STABLE, ("witness.points.0", "0.5"), "MALFORMED"),
        (
            "the first segment reaches further",
            LOOP_STABLE,
            ("witness.points", [4, 5, 6, 7, *range(8, 13)]),
            "INVALID",
        ),
        (
            "the last segments are missing",
            LOOP_STABLE,
            (("witness.points", POINTS[:4]), ("witness.segments", SEGMENTS[:4])),
            "INVALID",
        ),
        (
            "there is no segment",
            STABLE,
            (("witness.points", []), ("witness.segments", [])),
            "INVALID",
        ),
        ("a segment is too few", STABLE, ("witness.segments", [0, 1]), "MALFORMED"),
        (
            "the last arc is missing",
            SAMPLED_STABLE,
            ("witness.segments", [0, 1, 2, 3, 4]),
            "MALFORMED",
        ),
        ("a segment has no frame", STABLE, ("witness.segments.0", 3), "MALFORMED"),
        ("a segment is far beyond the frames", STABLE, ("witness.segments.0", 99), "MALFORMED"),
        ("a segment is true", STABLE, ("witness.segments.1", True), "MALFORMED"),
        ("a segment has another frame", LOOP_STABLE, ("witness.segments.8", 0), "INVALID"),
        ("an arc has another frame", SAMPLED_STABLE, ("witness.segments.5", 0), "INVALID"),
        ("a weight of growth is 0", STABLE, ("witness.growth", [1, 0]), "MALFORMED"),
        ("growth is too uneven", STABLE, ("witness.growth", [1, 1000]), "INVALID"),
        ("growth is missing", STABLE, ("witness.growth", None), "MALFORMED"),
        ("growth of the signals as well", LOOP_STABLE, ("witness.growth", [2] * 7), "MALFORMED"),
        ("growth in discrete time", SAMPLED_STABLE, ("witness.growth", [1, 1]), "INVALID"),
        ("V is 0", STABLE, (f"{FRAME}.V.re", [[0, 0]] * 2), "INVALID"),
        ("V is of the states alone", LOOP_STABLE, (f"{FRAME}.V.re", [[0] * 3] * 3), "MALFORMED"),
        ("a weight is 0", STABLE, (f"{FRAME}.w", [0, 1]), "MALFORMED"),
        (
            "a construction behind the loop",
            LOOP_STABLE,
            ("subject", [LOOP, {"construction": "dual"}]),
            "INCOMPLETE",
        ),
    ]
)


def member_of(pencil: Pencil, number: int) -> Rows:
    """A vertex of the box of a pencil, by the binary digits of a number, over and over."""
    signs = itertools.cycle([1 if number >> k & 1 else -1 for k in range(7)])
    values, radii = fractions(pencil.Z), fractions(pencil.D)
    return [
        [value + next(signs) * r if r else value for value, r in zip(*rows, strict=True)]
        for rows in zip(values, radii, strict=True)
    ]


def loop_of(Z: Rows, n: int) -> Rows:
    """The matrix of a loop from its pencil: the signals behind the state are taken out."""
    signals = solved([[-entry for entry in row[n:]] for row in Z[n:]], [row[:n] for row in Z[n:]])
    columns = list(zip(*signals, strict=True))
    return [
        [row[j] + sum(map(mul, row[n:], columns[j]), Fraction(0)) for j in range(n)]
        for row in Z[:n]
    ]


@pytest.mark.parametrize(
    ("plant", "step", "gain_radii", "bound"),
    [(CALM, LOOP, GAIN_RADII, Fraction(1, 8)), (DAMPED, DELAYED, DELAYED_RADII, Fraction(1))],
    ids=["continuous", "discrete"],
)
def test_the_pencil_is_that_of_the_loop_and_of_stable_members(
    plant: Document, step: Document, gain_radii: Document, bound: Fraction
) -> None:
    box = subject_of(plant, KIND, (step,))
    pencil = loop_pencil(box, gain_radii)
    n, whole = pencil.dynamic, pencil.Z.nrows
    assert loop_of(fractions(pencil.Z), n) == fractions(read_subject([step], read_plant(plant)).A)
    for i in range(n, whole):
        below = [entry for row in (pencil.Z, pencil.D) for entry in row.rows[i][i:]]
        assert below == [-pencil.Z.denominator, *[0] * (2 * (whole - i) - 1)]
    for number in range(0, 128, 5):
        loop = loop_of(member_of(pencil, number), n)
        d = lcm(*(entry.denominator for row in loop for entry in row))
        M = Matrix([[int(entry * d) for entry in row] for row in loop], n, d)
        assert in_region(characteristic_polynomial(M), box.time, bound)


def test_what_is_uncertain_is_what_has_a_radius() -> None:
    """CALM has radii in A, B_1 and C_2; the controller in two of its gains; messages in none."""
    for system, step, radii, gains in ((CALM, LOOP, GAIN_RADII, 2), (DAMPED, DELAYED, None, 0)):
        box = subject_of(system, KIND, (step,))
        D = fractions(loop_pencil(box, radii).D)
        assert sum(map(bool, itertools.chain(*D))) == 4 + gains


def test_points_that_go_back_are_refused_though_each_segment_is_regular() -> None:
    """The way to the last point is longer then, and so is nothing that is left out."""
    further = stable(CALM, [1, 2, 3, 4], growth=[1, 1])["witness"]["frames"][3]
    witness = {
        **STABLE["witness"],
        "points": [1, 2, 4, 3],
        "segments": [0, 1, 2, 3],
        "frames": [*STABLE["witness"]["frames"], further],
    }
    verdict = checked({**STABLE, "witness": witness})
    assert (verdict.verdict, verdict.code) == ("INVALID", "points")


SWIFT = plant([[-2]], ([[1]], [[1]]), uncertainty=uncertain([[1]]))
"""x' = ax with a from −3 to −1."""
SLOW = plant([["-1/2"]], ([[1]], [[1]]))
FED = plant([[-1]], ([[1]], [["1/2"]]))
MAPS: Document = {"shared_update": {}, "private_update": {}, "input": {"outputs": {"1": [[-6]]}}}
AGENT = {"name": "1", "shared": 0, "private": 0, **MAPS}
FEEDING = {
    "construction": "closed_loop",
    "controller": {"time": "continuous", "agents": [AGENT]},
}
"""u = −6y, y = x/2: the sizes 1 of x, 1/2 of y and 3 of u make x' as large as 4."""


@pytest.mark.parametrize("radii", [[-1, 1], [1, -1], [-1, -1]])
def test_no_radius_of_a_gain_is_negative(radii: list[int]) -> None:
    wide = plant([[-1]], ([[1]], [[1], [1]]))
    step, given = (
        changed(FEEDING, ("controller.agents.0.input.outputs.1", [row]))
        for row in ([-1, -1], radii)
    )
    with pytest.raises(Refused) as refused:
        loop_pencil(subject_of(wide, KIND, (step,)), given["controller"])
    assert refused.value.verdict == "MALFORMED"


@pytest.mark.parametrize(
    ("system", "steps", "last", "grows"),
    [
        (SWIFT, (), "5/2", True),
        (SWIFT, (), 3, True),
        (SWIFT, (), "7/2", False),
        (FED, (FEEDING,), 3, True),
        (FED, (FEEDING,), 4, True),
        (FED, (FEEDING,), "9/2", False),
        (SLOW, (), None, True),
        (SLOW, (), "1/2", True),
        (SLOW, (), 1, False),
    ],
)
def test_growth_is_what_members_and_signals_reach(
    system: Document, steps: tuple[Document, ...], last: Any, grows: bool
) -> None:
    """The last point has to be beyond it; without points no size of a state is small enough."""
    end = Fraction(last or 0)
    ends = [
        *(Fraction(k, 4) for k in range(1, 18) if Fraction(k, 4) < end),
        *([end] if end else ()),
    ]
    points = [int(point) if point.denominator == 1 else str(point) for point in ends]
    verdict = checked(stable(system, points, *steps, growth=[1]))
    assert (verdict.verdict, verdict.code) == (("INVALID", "growth") if grows else ("VALID", ""))


def test_segments_are_on_the_border_and_leave_no_gap() -> None:
    ends = [Fraction(1, 2), Fraction(1), Fraction(3)]
    rate, radius = Fraction(1, 3), Fraction(4, 5)
    line = segments_of("continuous", rate, ends)
    reached = Fraction(0)
    for re, im, rho in line:
        assert re == -rate and im - rho == reached
        reached = im + rho
    assert reached == 3
    arcs = segments_of("discrete", radius, ends)
    edge = [
        (radius * (1 - t * t) / (1 + t * t), 2 * radius * t / (1 + t * t))
        for t in [Fraction(0), *ends]
    ]
    edge.append((-radius, Fraction(0)))
    for (re, im, rho), p, q in zip(arcs, edge, edge[1:], strict=False):
        for x, y in (p, q):
            away = (x - re) ** 2 + (y - im) ** 2
            assert away <= rho**2 < away * (1 + Fraction(1, 10**6))
    assert (
        len(arcs) == len(edge) - 1
        and edge[0] == (radius, 0)
        and all(x**2 + y**2 == radius**2 for x, y in edge)
    )
    assert len(segments_of("discrete", radius, [])) == 1
    assert segments_of("discrete", radius, []) == [(0, 0, radius)]


def test_without_a_loop_there_are_no_signals_but_the_state() -> None:
    said = checked(STABLE).statement
    assert says(said, "eigenvalue below")
    assert says(said, "plants differ")
    assert checked(SAMPLED_STABLE).statement.endswith("every eigenvalue of A has modulus below 7/8")


def test_the_statement_names_the_radii_of_the_gains_by_their_size_and_digest() -> None:
    said = checked(LOOP_STABLE).statement
    assert says(said, "closed sha")
    between = (
        ", and for all controllers whose entries differ from those of the controller by at most "
    )
    assert f"{between}their radii (2 entries have one, none above 1/50 and none " in said
    assert says(said, "being sha")
    assert says(said, "eigenvalue below")
    written = changed(LOOP_STABLE, (RADIUS, [["1/100"]]), (f"{RADII}.agents.0.hold", {"2": 0}))
    assert checked(written).statement == said
    none = changed(LOOP_STABLE, (RADII, None))
    assert "for all controllers" not in checked(none).statement
    assert checked(none).verdict == "VALID"


@pytest.mark.parametrize("part", ["nominal", "points", "growth", "segments", "frames"])
def test_every_part_of_the_witness_is_needed(part: str) -> None:
    assert checked(without(STABLE, f"witness.{part}")).verdict == "MALFORMED"
