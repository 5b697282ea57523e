"""The campaign on structure in small counts; its module runs the large ones."""

from __future__ import annotations

import random

from tests.assurance.campaigns import structure

CASES = (
    "hidden-triple-mode",
    "liu2020-3ch-no-communication",
    "liu2020-unimodular",
    "quadruple-tank-pplus",
    "compleib-psm",
)


def test_pencil_ranks_of_published_cases_are_those_of_every_subset_by_sympy() -> None:
    seen = structure.compare_pencils(CASES)
    assert seen["cases"] == len(CASES)
    assert seen["ranks below n"] > 0


def test_structural_answers_about_drawn_systems_are_those_of_brute_force() -> None:
    seen = structure.compare_systems(60, seed=1)
    assert seen["remnant polynomials above 1"] > 0
    assert seen["complete"] > 0


def test_exceptional_gains_are_the_real_roots_of_the_common_divisor_of_all_minors() -> None:
    seen = structure.compare_exceptional(30, seed=1)
    assert seen["with an irrational real root"] > 0


def test_proposition_1_holds_over_connected_graphs_and_is_decided_over_others() -> None:
    rng, seen = random.Random(1), structure.Seen()
    for m in (2, 3):
        for heard in structure.graphs(m, connected=True):
            structure._observed(rng, heard, 2, seen)
    assert seen == {"strongly connected on 2 vertices": 1, "strongly connected on 3 vertices": 18}


def test_there_are_46_graphs_on_3_vertices_that_are_not_strongly_connected() -> None:
    assert len(list(structure.graphs(3, connected=False))) == 46
