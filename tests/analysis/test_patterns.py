"""Structural fixed modes against enumeration, and why modes of plants are fixed."""

from __future__ import annotations

import random
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from mcexact.analysis.analyze import analyze
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.patterns import least_matching, structural_fixed_modes, why_fixed
from mcexact.answer.check import check
from mcexact.checker.command import manifest_verdicts
from mcexact.checker.core.reading import Limits
from mcexact.checker.kinds import Expectation
from mcexact.derived.constructions import dual
from mcexact.errors import InputError, UsageError
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from tests.analysis.nearby.test_plants import grid
from tests.assurance.campaigns.patterns import compare_patterns, compare_plants
from tests.oracle.patterns import drawn_pattern
from tests.wording import says

X = Polynomial.from_roots([0])


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


def test_drawn_patterns_have_the_structural_fixed_modes_of_enumeration() -> None:
    seen = compare_patterns(7, seed=46)
    assert seen["patterns"] == 7 and seen["states without feedback"] > 0
    assert seen["with modes at 0 beside"] > 0


def test_every_fixed_mode_of_drawn_plants_is_fixed_by_zeros_or_by_equalities() -> None:
    seen = compare_plants(10, seed=1)
    assert min(seen["by zeros"], seen["by equalities"]) > 0


def test_adding_an_entry_never_adds_structural_fixed_modes() -> None:
    for seed in range(40):
        rng = random.Random(seed)
        pattern = drawn_pattern(rng)
        if not pattern.n:
            continue
        before = MultiChannelSystem(pattern.A, pattern.B, pattern.C)
        A = [row[:] for row in pattern.A]
        A[rng.randrange(pattern.n)][rng.randrange(pattern.n)] = 1
        after = MultiChannelSystem(A, pattern.B, pattern.C)
        degrees = [structural_fixed_modes(each).polynomial.degree for each in (before, after)]
        assert degrees[0] >= degrees[1]


def test_the_dual_pattern_has_the_same_structural_fixed_modes() -> None:
    for seed in range(40):
        pattern = drawn_pattern(random.Random(seed))
        plant = MultiChannelSystem(pattern.A, pattern.B, pattern.C)
        own, other = (structural_fixed_modes(each) for each in (plant, dual(plant)))
        assert (own.without_feedback, own.at_zero) == (other.without_feedback, other.at_zero)


def test_outputs_of_a_neighbor_give_feedback_to_what_no_agent_feeds_back_alone() -> None:
    names = ("1", "2")
    plant = MultiChannelSystem(
        [[1, 0], [1, 2]],
        [[[1], [0]], [[0], [1]]],
        [[[0, 0]], [[1, 1]]],
        neighbors=NeighborGraph(names, ((0, 1), (1,))),
    )
    own = structural_fixed_modes(plant)
    assert own.without_feedback == (0,) and str(own.polynomial) == "x - 1"
    assert structural_fixed_modes(plant, "outputs").empty


@pytest.mark.parametrize("n", [1, 2, 5])
def test_a_star_of_integrators_keeps_all_but_one_at_0(n: int) -> None:
    A = [[0] * (n + 1), *([1, *[0] * n] for _ in range(n))]
    plant = MultiChannelSystem(A, [[[1], *([0] for _ in range(n))]], [[[0, *[1] * n]]])
    found = structural_fixed_modes(plant)
    assert (found.without_feedback, found.at_zero) == ((), n - 1)
    assert fixed_spectrum(plant).empty is (n == 1)
    assert check(found).verdict == "VALID"


def test_plants_without_states_or_inputs_are_decided() -> None:
    none = MultiChannelSystem([], [[]], [[]])
    assert structural_fixed_modes(none).empty
    blind = MultiChannelSystem([[2]], [Matrix.zeros(1, 0)], [Matrix.zeros(0, 1)])
    assert str(structural_fixed_modes(blind).polynomial) == "x - 2"
    for plant in (none, blind):
        assert check(structural_fixed_modes(plant)).verdict == "VALID"


def test_a_long_chain_is_matched_along_long_paths() -> None:
    n = 300
    A = Matrix.from_entries((n, n), [(k + 1, k, 1) for k in range(n - 1)])
    B = Matrix.from_entries((n, 1), [(0, 0, 1)])
    C = Matrix.from_entries((1, n), [(0, n - 1, 1)])
    assert structural_fixed_modes(MultiChannelSystem(A, [B], [C])).empty


def test_potentials_prove_that_a_matching_is_least() -> None:
    for seed in range(60):
        rng = random.Random(seed)
        size = rng.randint(1, 7)
        places = [(i, j) for i in range(size) for j in range(size) if i == j or rng.random() < 0.3]
        costs = {at: int(at[0] == at[1] and rng.random() < 0.6) for at in places}
        rows, columns, matching = least_matching(size, costs)
        assert sorted(matching) == [*range(size)]
        assert all(rows[i] + columns[j] <= cost for (i, j), cost in costs.items())
        assert sum(rows) + sum(columns) == sum(costs[at] for at in enumerate(matching))


def test_what_it_is_not_about_is_refused() -> None:
    through = MultiChannelSystem([[1]], [[[1]]], [[[1]]], D=[[1]])
    with pytest.raises(InputError):
        structural_fixed_modes(through)
    with pytest.raises(UsageError):
        structural_fixed_modes(EQUAL, "outputs")
    with pytest.raises(UsageError):
        structural_fixed_modes(EQUAL, "all")  # type: ignore[arg-type]


def test_the_modes_of_a_grid_rest_on_equalities_that_a_vector_names() -> None:
    why = why_fixed(grid(fractions))
    assert why.by_equalities == (X,) and not why.by_zeros
    (law,) = why.laws
    assert law.kernel.matrices[0].rows() == tuple((Fraction(k % 2 == 0),) for k in range(8))
    assert not law.subject and law.deficiency == 1


def test_the_zeros_alone_fix_what_no_input_drives_whatever_the_number_is() -> None:
    for number in (5, "1/7", -3):
        why = why_fixed(MultiChannelSystem([[number]], [[[0]]], [[[1]]]))
        assert why.by_zeros == (Polynomial.from_roots([number]),) and not why.by_equalities


def test_of_two_modes_one_of_which_the_zeros_fix_the_other_one_is_not_accused() -> None:
    why = why_fixed(side_by_side(EQUAL, ALONE))
    assert [str(p) for p in why.by_equalities] == ["x - 3"]
    assert [str(p) for p in why.by_zeros] == ["x - 5"]


def test_a_mode_of_two_blocks_is_freed_only_if_both_are() -> None:
    three = MultiChannelSystem([[3]], [[[0]]], [[[1]]])
    assert [str(p) for p in why_fixed(side_by_side(EQUAL, three)).by_zeros] == ["x - 3"]
    both = why_fixed(side_by_side(EQUAL, EQUAL))
    assert [str(p) for p in both.by_equalities] == ["x - 3"]


def test_a_mode_at_0_that_the_zeros_fix_is_not_freed_by_other_numbers() -> None:
    assert why_fixed(STUCK).by_zeros == (X,)


def test_a_mode_at_0_that_an_equality_fixes_once_more_is_fixed_by_the_zeros_once() -> None:
    # Of twice 0, other nonzero entries leave one: the rows (1, 1) and (2, 2) are proportional.
    A = [[0, 2, 3, 1, 5], [1, 0, 0, 0, 0], [4, 0, 0, 0, 0], [1, 0, 0, 1, 1], [2, 0, 0, 2, 2]]
    first = [1, 0, 0, 0, 0]
    plant = MultiChannelSystem(A, [[[x] for x in first]], [[first]])
    [factor] = fixed_spectrum(plant).factors
    assert factor.multiplicity_at_most == 2
    assert structural_fixed_modes(plant).polynomial == X
    assert why_fixed(plant).by_zeros == (X,)


def test_the_analysis_says_why_with_certificates_that_are_checked(tmp_path: Path) -> None:
    found = analyze(side_by_side(EQUAL, ALONE))
    lines = [each.line for each in found.sentences]
    assert says([line for line in lines if line.startswith("why fixed")], "why")
    assert "law: A v = 3 v and C v = 0 for v = (1, 1, 0)" in lines
    view = found.to_dict()["why_fixed"]
    assert (view["by_equalities"], view["by_zeros"]) == ([[-3, 1]], [[-5, 1]])
    assert {"structural_fixed_modes", "law_1"} <= {*found.to_dict()}
    found.save(tmp_path)
    told = {each.verdict for _, each in manifest_verdicts(str(tmp_path), Expectation(), Limits())}
    assert told == {"VALID", "IMPLIED", "REMARK"}


def test_without_fixed_modes_or_laws_on_request_nothing_is_said() -> None:
    free = MultiChannelSystem([[1]], [[[1]], [[0]]], [[[1]], [[0]]])
    assert (
        says(analyze(free).why_fixed.explain(), "none")
        and "why_fixed" not in analyze(free).to_dict()
    )
    assert "structural_fixed_modes" not in analyze(free).to_dict()
    silent = analyze(EQUAL, nearby=False)
    assert "why_fixed" not in silent.to_dict() and "law_1" not in silent.to_dict()
    assert silent.why_fixed.by_equalities


def test_asked_by_name_it_says_what_is_fixed_for_all_numbers() -> None:
    linked = ALONE.with_neighbors({"1": []})
    rows = [
        each.line
        for found in (
            analyze(EQUAL, ["structural_fixed_modes"]),
            analyze(ALONE, ["structural_fixed_modes"]),
            analyze(linked, ["structural_fixed_modes"], information="outputs"),
        )
        for each in found.sentences.at("table")
        if each.template.key.startswith("structural-")
    ]
    assert len(rows) == 3 and says(rows, "asked")
    keys = {each.template.key for each in analyze(ALONE).sentences}
    assert not keys & {"structural-none", "structural-modes"}  # there it is a reason
    free = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    keys = {each.template.key for each in analyze(free, also=["structural_fixed_modes"]).sentences}
    assert "structural-none" in keys


def test_of_a_derived_system_it_is_not_asked() -> None:
    with pytest.raises(InputError):
        why_fixed(dual(EQUAL))
    with pytest.raises(InputError):
        why_fixed(EQUAL.A)  # type: ignore[arg-type]


def test_the_fixed_spectrum_alone_has_reasons_which_are_told_on_request() -> None:
    found = analyze(EQUAL, ["fixed_spectrum"])
    assert [str(p) for p in found.why_fixed.by_equalities] == ["x - 3"]
    assert found.why_fixed.known and {*found.account.answers} == {"fixed_spectrum"}
    assert "why_fixed" not in found.to_dict()


def test_without_the_fixed_spectrum_of_the_plant_itself_nothing_is_known() -> None:
    linked = EQUAL.with_neighbors({"1": []})
    through = MultiChannelSystem(EQUAL.A, EQUAL.B, EQUAL.C, D=[[1]])
    for found in (
        analyze(EQUAL, ["joint_controllability"]),
        analyze(linked, information="outputs"),
        analyze(through),
    ):
        why = found.why_fixed
        assert not why.known and says(why.explain(), "unknown") and says(repr(why), "unknown")
        assert "why_fixed" not in found.to_dict()


def test_reasons_rest_on_answers_about_the_same_plant_and_own_outputs() -> None:
    linked = EQUAL.with_neighbors({"1": []})
    with pytest.raises(UsageError):
        why_fixed(linked, structural=structural_fixed_modes(linked, "outputs"))
    with pytest.raises(UsageError):
        why_fixed(EQUAL, structural=structural_fixed_modes(ALONE))
    with pytest.raises(UsageError):
        why_fixed(EQUAL, fixed_spectrum(ALONE))


@pytest.mark.parametrize("scale", [1, Fraction(1, 3)])
def test_no_vector_is_named_where_none_is_short(scale: Any) -> None:
    """A mode that is a root of a quadratic polynomial has no rational vector."""
    A = Matrix.from_rows([[0, 2 * scale, 0], [1 * scale, 0, 0], [1, 1, 1]])
    plant = MultiChannelSystem(A, [[[0], [0], [1]]], [[[0, 0, 1]]])
    assert not why_fixed(plant).laws
