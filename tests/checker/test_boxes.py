"""The subjects of claims about boxes: what constructions make of radii."""

from __future__ import annotations

import random
from dataclasses import replace
from fractions import Fraction
from math import lcm
from typing import Any

import pytest

from mcexact.checker.constructions import CONSTRUCTIONS, read_subject
from mcexact.checker.core.arithmetic import Matrix, absolute
from mcexact.checker.core.reading import Refused
from mcexact.checker.discs import LOOP as CLOSED
from tests.checker.box_maker import fractions, subject_of
from tests.checker.box_plants import CALM, CERTAIN, DAMPED, LOOP, PAIR, uncertain
from tests.checker.handmade import matrix, plant
from tests.wording import says

STEPS: dict[str, Any] = {
    "arcs": {"added": [["1", "2"]]},
    "augmented_outputs": {},
    "dual": {},
    "error": {"gains": [matrix([-2, 1], denominator=3), matrix([0, -1])]},
    "extended": {"share": "outputs+states", "dimensions": [1, 1]},
    "feedback": {"gains": [matrix([-3], denominator=2), matrix([5])]},
    "full_output": {"channel": "2"},
    "held": {"dimensions": [1, 1]},
    "failed": {"agents": [], "actuators": [["1", 1]], "sensors": [["2", 1]], "links": []},
    "input_filters": {},
    "integrators": {},
    "internal_model": {
        "polynomial": ["1/4", 0, 1],
        "gains": [matrix([-3], denominator=2), {"denominator": 1, "entries": []}],
    },
    "lifted": {"share": "outputs+states", "dimensions": [1, 1]},
    "merged": {"parts": [["1", "2"]]},
    "regulated": {"gains": [matrix([-2], [1], denominator=3), matrix([1])]},
    "restricted": {"channels": ["2"]},
    "sampled": {"step": "1/10", "late": 1, "decimals": 12},
    "servo": {"gains": [matrix([-3], denominator=2), {"denominator": 1, "entries": []}]},
    "slow": {"window": 4},
}
DISCRETE = {"held", "lifted", "slow"}
"""The constructions of plants in discrete time."""


def nonzero(M: Any) -> list[tuple[int, int, Any]]:
    """The entries that are not 0."""
    return [(i, j, x) for i, row in enumerate(fractions(M)) for j, x in enumerate(row) if x]


@pytest.mark.parametrize(
    "name",
    sorted(
        {*STEPS} - {"error", "feedback", "internal_model", "regulated", "sampled", "servo", "slow"}
    ),
)
def test_a_copy_of_an_entry_has_its_radius_and_all_else_is_certain(name: str) -> None:
    start = DAMPED if name in DISCRETE else CALM
    box = subject_of(start, "box_fixed", (step_of(name),))
    plain = subject_of(start, "box_fixed", ())
    known = {x for M in (plain.radii.A, *plain.radii.B, *plain.radii.C) for *_, x in nonzero(M)}
    pairs = zip((box.A, *box.B, *box.C), (box.radii.A, *box.radii.B, *box.radii.C), strict=True)
    for M, D in pairs:
        assert (M.nrows, M.ncols) == (D.nrows, D.ncols)
        assert {x for *_, x in nonzero(D)} <= known
    beside = fractions(box.radii.A)
    if name == "input_filters":  # there the inputs of the plant stand beside its states
        beside = [row[:2] for row in beside]
    assert [list(row) for row in beside[:2]] == [
        [*row, *[0] * (len(beside[0]) - 2)] for row in fractions(plain.radii.A)
    ]


def test_what_is_measured_as_a_whole_is_certain() -> None:
    box = subject_of(CALM, "box_fixed", ({"construction": "full_output", "channel": "2"},))
    assert not nonzero(box.radii.C[1])
    dual = subject_of(CALM, "box_fixed", ({"construction": "dual"},))
    assert nonzero(dual.radii.B[1]) == [(1, 0, fractions(box.radii.A)[1][1])]


def corner(M: Any, D: Any, rng: random.Random) -> Matrix:
    """A matrix all of whose entries are at an end of their interval."""
    both = zip(fractions(M), fractions(D), strict=True)
    rows = [[x + rng.choice((-1, 1)) * r for x, r in zip(*each, strict=True)] for each in both]
    d = lcm(*(x.denominator for row in rows for x in row))
    return Matrix([[int(x * d) for x in row] for row in rows], M.ncols, d)


def step_of(name: str) -> dict[str, Any]:
    """A construction with its parameters."""
    return {"construction": name, **STEPS[name]}


@pytest.mark.parametrize(
    "names", [[name] for name in STEPS] + [["feedback", "error"], ["error", "dual"]], ids="-".join
)
def test_what_is_made_of_a_member_is_within_the_radii_of_what_is_made(names: list[str]) -> None:
    start = DAMPED if DISCRETE & set(names) else CALM
    plain, steps = subject_of(start, "box_fixed", ()), [step_of(name) for name in names]
    box = subject_of(start, "box_fixed", tuple(steps))
    reached = False
    for seed in range(12):
        rng = random.Random(seed)
        A, *ports = (
            corner(M, D, rng)
            for M, D in zip(
                (plain.A, *plain.B, *plain.C),
                (plain.radii.A, *plain.radii.B, *plain.radii.C),
                strict=True,
            )
        )
        member = replace(plain, A=A, B=ports[: plain.m], C=ports[plain.m :])
        made = read_subject(steps, member)
        whole = zip(
            (made.A, *made.B, *made.C),
            (box.A, *box.B, *box.C),
            (box.radii.A, *box.radii.B, *box.radii.C),
            strict=True,
        )
        for M, M0, D in whole:
            for row, center, radii in zip(*map(fractions, (M, M0, D)), strict=True):
                away = [abs(x - y) for x, y in zip(row, center, strict=True)]
                assert all(x <= r for x, r in zip(away, radii, strict=True))
                reached |= any(x == r > 0 for x, r in zip(away, radii, strict=True))
    assert reached


def test_the_radius_of_a_product_is_that_of_both_factors_at_their_ends() -> None:
    one = plant([[5]], ([[2]], [[3]]), uncertainty=uncertain([[1]], {"1": [["1/2"]]}))
    one["uncertainty"]["absolute"]["C"] = uncertain(None, None, {"1": [["1/3"]]})["absolute"]["C"]
    step = {"construction": "feedback", "gains": [matrix([-7])]}
    box = subject_of(one, "box_fixed", (step,))
    assert fractions(box.A) == [[5 - 42]]
    assert fractions(box.radii.A) == [[1 + 7 * (Fraction(5, 2) * Fraction(10, 3) - 6)]]
    assert fractions(box.radii.B[0]) == [[Fraction(1, 2)]]


def test_a_loop_is_known_as_the_last_construction_alone() -> None:
    with pytest.raises(Refused) as refused:
        subject_of(CALM, "box_fixed", (step_of("dual"), LOOP))
    assert refused.value.args[:3] == ("INCOMPLETE", "construction", "subject[1]")
    assert {*STEPS, CLOSED, "modulo", "periodic_loop"} == {*CONSTRUCTIONS}


def test_a_part_of_the_nominal_plant_is_none_of_every_plant_in_a_box() -> None:
    still = plant([[0, 0], [0, 0]], ([[1], [0]], [[1, 0]]))
    part = {"annihilator": matrix([0, 1]), "pivots": [1], "polynomial": [0, 1]}
    for side in ("unobservable", "uncontrollable"):
        step = {"construction": "modulo", "part": side, **part}
        assert subject_of(still, "fixed_spectrum", (step,)).n == 1
        with pytest.raises(Refused) as refused:
            subject_of(still, "box_fixed", (step,))
        assert refused.value.args[:3] == ("INCOMPLETE", "construction", "subject[0]")


def test_a_loop_is_the_last_construction_of_a_claim_about_stability_alone() -> None:
    box = subject_of(CALM, "box_stable", (STEPS["dual"] | {"construction": "dual"},))
    assert box.plant is None
    loop = subject_of(CALM, "box_stable", (LOOP,))
    assert loop.plant is not None and loop.plant.radii.n == 2
    turned = subject_of(CALM, "box_stable", ({"construction": "dual"}, LOOP))
    assert turned.plant is not None and turned.programs == loop.programs
    assert nonzero(turned.plant.radii.B[1]) and not nonzero(loop.plant.radii.B[1])
    with pytest.raises(Refused):
        subject_of(CALM, "box_stable", (LOOP, {"construction": "dual"}))


def test_a_plant_without_uncertainty_is_the_one_member() -> None:
    box = subject_of(CERTAIN, "box_fixed", ())
    assert not nonzero(box.radii.A) and not nonzero(box.radii.B[0])
    assert says(subject_of(PAIR, "fixed_spectrum", ()).words, "nominal values")
    assert fractions(absolute(box.A.times(-2))) == [[2]]
