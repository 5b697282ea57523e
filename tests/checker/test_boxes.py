"""The subjects of claims about boxes: what constructions make of radii."""

from __future__ import annotations

from typing import Any

import pytest

from mcexact.checker.boxes import COPYING, absolute
from mcexact.checker.reading import Refused
from mcexact.checker.subject import CONSTRUCTIONS
from tests.checker.box_maker import fractions, subject_of
from tests.checker.box_plants import CALM, CERTAIN, DAMPED, LOOP, PAIR
from tests.checker.handmade import matrix

STEPS: dict[str, Any] = {
    "arcs": {"added": [["1", "2"]]},
    "augmented_outputs": {},
    "dual": {},
    "extended": {"share": "outputs+states", "dimensions": [1, 1]},
    "full_output": {"channel": "2"},
    "held": {"dimensions": [1, 1]},
    "integrators": {},
    "lifted": {"share": "outputs+states", "dimensions": [1, 1]},
    "merged": {"parts": [["1", "2"]]},
    "restricted": {"channels": ["2"]},
}


def nonzero(M: Any) -> list[tuple[int, int, Any]]:
    """The entries that are not 0."""
    return [(i, j, x) for i, row in enumerate(fractions(M)) for j, x in enumerate(row) if x]


@pytest.mark.parametrize("name", sorted(COPYING))
def test_a_copy_of_an_entry_has_its_radius_and_all_else_is_certain(name: str) -> None:
    plant = DAMPED if name in ("held", "lifted") else CALM
    box = subject_of(plant, "box_fixed", ({"construction": name, **STEPS[name]},))
    plain = subject_of(plant, "box_fixed", ())
    known = {x for M in (plain.radii.A, *plain.radii.B, *plain.radii.C) for *_, x in nonzero(M)}
    pairs = zip((box.A, *box.B, *box.C), (box.radii.A, *box.radii.B, *box.radii.C), strict=True)
    for M, D in pairs:
        assert (M.nrows, M.ncols) == (D.nrows, D.ncols)
        assert {x for *_, x in nonzero(D)} <= known
    assert [list(row) for row in fractions(box.radii.A)[:2]] == [
        [*row, *[0] * (box.n - 2)] for row in fractions(plain.radii.A)
    ]


def test_what_is_measured_as_a_whole_is_certain() -> None:
    box = subject_of(CALM, "box_fixed", ({"construction": "full_output", "channel": "2"},))
    assert not nonzero(box.radii.C[1])
    dual = subject_of(CALM, "box_fixed", ({"construction": "dual"},))
    assert nonzero(dual.radii.B[1]) == [(1, 0, fractions(box.radii.A)[1][1])]


@pytest.mark.parametrize("name", sorted(set(CONSTRUCTIONS) - COPYING))
def test_what_computes_with_entries_is_not_known(name: str) -> None:
    steps: dict[str, Any] = {
        "feedback": {"gains": [matrix([1]), matrix([1])]},
        "error": {"gains": [matrix([1, 0]), matrix([0, 1])]},
        "closed_loop": {"controller": LOOP["controller"]},
    }
    step = {"construction": name, **steps[name]}
    with pytest.raises(Refused) as refused:
        subject_of(CALM, "box_fixed", (step,))
    assert refused.value.args[:3] == ("INCOMPLETE", "construction", "subject[0]")


def test_a_loop_is_the_last_construction_of_a_claim_about_stability_alone() -> None:
    box = subject_of(CALM, "box_stable", (STEPS["dual"] | {"construction": "dual"},))
    assert box.plant is None
    loop = subject_of(CALM, "box_stable", (LOOP,))
    assert loop.plant is not None and loop.plant.radii.n == 2
    with pytest.raises(Refused):
        subject_of(CALM, "box_stable", (LOOP, {"construction": "dual"}))


def test_a_plant_without_uncertainty_is_the_one_member() -> None:
    box = subject_of(CERTAIN, "box_fixed", ())
    assert not nonzero(box.radii.A) and not nonzero(box.radii.B[0])
    assert subject_of(PAIR, "fixed_spectrum", ()).words.endswith(" at its nominal values")
    assert fractions(absolute(box.A.times(-2))) == [[2]]
