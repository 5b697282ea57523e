"""Why modes are fixed: decided block by block, and never against what zeros alone fix."""

from __future__ import annotations

import random
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from mcexact.analysis.analyze import analyze
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.nearby.equalities import why_fixed
from mcexact.answer.check import check
from mcexact.checker.command import manifest_verdicts
from mcexact.checker.core.reading import Limits
from mcexact.checker.kinds import Expectation
from mcexact.derived.constructions import dual
from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.system import MultiChannelSystem
from tests.analysis.nearby.test_plants import entries, grid
from tests.oracle.draws import exact, sparse_system
from tests.oracle.enumeration import fixed_factors, plain
from tests.wording import says


def fractions(x: Fraction, y: int) -> Fraction:
    return x / y


def side_by_side(*plants: MultiChannelSystem) -> MultiChannelSystem:
    """Plants that nothing connects, each with channels of its own."""
    n, start = sum(plant.n for plant in plants), 0
    A: list[list[Any]] = []
    B, C = list[Any](), list[Any]()
    for plant in plants:
        after = n - start - plant.n
        A += [[0] * start + [*row] + [0] * after for row in plant.A.rows()]
        for channel in plant.channels:
            wide = [[0] * channel.B.ncols]
            B.append(wide * start + [*map(list, channel.B.rows())] + wide * after)
            C.append([[0] * start + [*row] + [0] * after for row in channel.C.rows()])
        start += plant.n
    return MultiChannelSystem(A, B, C)


EQUAL = MultiChannelSystem([[1, 2], [4, -1]], [[[1], [0]]], [[[1, -1]]])
"""The rows of A sum to 3, and the output is a difference."""
ALONE = MultiChannelSystem([[5]], [[[0]]], [[[1]]])
"""No input drives the only state."""
STUCK = MultiChannelSystem([[0, 0], [1, 0]], [[[0], [1]]], [[[0, 1]]])
"""One integrator that no input drives, before another one."""


def test_the_modes_of_a_grid_rest_on_equalities_that_a_vector_names() -> None:
    why = why_fixed(grid(fractions))
    assert why.freed == (Polynomial.from_roots([0]),) and not why.computed
    (law,) = why.laws
    assert law.kernel.matrices[0].rows() == tuple((Fraction(k % 2 == 0),) for k in range(8))
    assert not law.subject and law.deficiency == 1


def test_the_zeros_alone_fix_what_no_input_drives_whatever_the_number_is() -> None:
    for number in (5, "1/7", -3):
        plant = MultiChannelSystem([[number]], [[[0]]], [[[1]]])
        why = why_fixed(plant)
        assert not why.freed and why.proof is None
        assert [cause for _, cause in why.computed] == ["zeros"]


def test_of_two_modes_one_of_which_the_zeros_fix_the_other_one_is_not_accused() -> None:
    why = why_fixed(side_by_side(EQUAL, ALONE))
    assert [str(p) for p in why.freed] == ["x - 3"]
    assert [(str(p), cause) for p, cause in why.computed] == [("x - 5", "zeros")]
    assert why.proof is not None
    assert [str(f.polynomial) for f in why.proof.factors] == ["x - 5"]


def test_a_mode_of_two_blocks_is_freed_only_if_both_are() -> None:
    three = MultiChannelSystem([[3]], [[[0]]], [[[1]]])
    why = why_fixed(side_by_side(EQUAL, three))
    assert not why.freed
    assert [(str(p), cause) for p, cause in why.computed] == [("x - 3", "zeros")]
    both = why_fixed(side_by_side(EQUAL, EQUAL))
    assert [str(p) for p in both.freed] == ["x - 3"]


def test_a_mode_at_0_that_the_zeros_fix_is_not_freed_by_other_numbers() -> None:
    why = why_fixed(STUCK)
    assert not why.freed and [cause for _, cause in why.computed] == ["zeros"]


def test_a_mode_at_0_that_the_zeros_and_an_equality_fix_is_ascribed_to_neither() -> None:
    # Of twice 0, other nonzero entries leave one: the rows (1, 1) and (2, 2) are proportional.
    A = [[0, 2, 3, 1, 5], [1, 0, 0, 0, 0], [4, 0, 0, 0, 0], [1, 0, 0, 1, 1], [2, 0, 0, 2, 2]]
    first = [1, 0, 0, 0, 0]
    plant = MultiChannelSystem(A, [[[x] for x in first]], [[first]])
    [factor] = fixed_spectrum(plant).factors
    assert factor.multiplicity_at_most == 2
    found = why_fixed(plant)
    assert (found.freed, found.computed) == ((), ())


@pytest.mark.parametrize("seed", range(60))
def test_drawn_plants_are_freed_by_a_plant_with_the_same_zeros(seed: int) -> None:
    plant = exact(sparse_system(random.Random(seed)), "continuous")
    why = why_fixed(plant)
    own = {tuple(p) for p in fixed_factors(plain(plant))}
    assert {tuple(p.coefficients) for p in why.freed} <= own
    named = [*why.freed, *(p for p, _ in why.computed)]
    assert len(named) == len({*named})
    if why.proof is None:
        assert not why.freed
        return
    other = why.proof.about
    assert [x == 0 for x in entries(plant)] == [x == 0 for x in entries(other)]
    there = {tuple(p) for p in fixed_factors(plain(other))}
    assert there <= own and not there & {tuple(p.coefficients) for p in why.freed}
    assert check(why.proof).verdict == "VALID"
    for p, cause in why.computed:
        assert cause == "equalities" or tuple(p.coefficients) in there


def test_the_analysis_says_why_with_certificates_that_are_checked(tmp_path: Path) -> None:
    found = analyze(side_by_side(EQUAL, ALONE))
    lines = [each.line for each in found.sentences]
    assert says(lines, "why equalities")
    assert "law: A v = 3 v and C v = 0 for v = (1, 1, 0)" in lines
    view = found.to_dict()["why_fixed"]
    assert view["by_equalities"] == [[-3, 1]] and view["certificate"] == "redrawn.json"
    assert view["computed_not_certified"] == [{"mode": [-5, 1], "fixed_by": "zeros"}]
    assert "redrawn" in found.to_dict() and "law_1" in found.to_dict()
    found.save(tmp_path)
    told = {each.verdict for _, each in manifest_verdicts(str(tmp_path), Expectation(), Limits())}
    assert told == {"VALID", "IMPLIED", "REMARK"}


def test_without_fixed_modes_or_on_request_nothing_is_said() -> None:
    free = MultiChannelSystem([[1]], [[[1]], [[0]]], [[[1]], [[0]]])
    assert not analyze(free).why_fixed.known and "why_fixed" not in analyze(free).to_dict()
    silent = analyze(EQUAL, nearby=False)
    assert "why_fixed" not in silent.to_dict()
    assert not any(each.template.label == "why fixed" for each in silent.sentences)
    assert silent.why_fixed.freed


def test_of_a_derived_system_it_is_not_asked() -> None:
    with pytest.raises(InputError):
        why_fixed(dual(EQUAL))
    with pytest.raises(InputError):
        why_fixed(EQUAL.A)  # type: ignore[arg-type]


def test_answers_to_other_questions_have_no_reasons() -> None:
    assert not analyze(EQUAL, ["joint_controllability"]).why_fixed.known


@pytest.mark.parametrize("scale", [1, Fraction(1, 3)])
def test_no_vector_is_named_where_none_is_short(scale: Any) -> None:
    """A mode that is a root of a quadratic polynomial has no rational vector."""
    A = Matrix.from_rows([[0, 2 * scale, 0], [1 * scale, 0, 0], [1, 1, 1]])
    plant = MultiChannelSystem(A, [[[0], [0], [1]]], [[[0, 0, 1]]])
    assert not why_fixed(plant).laws
