"""Set-points, edges, indices and completeness for all values of a parameter."""

from __future__ import annotations

import random
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from mcexact import (
    ParametricSystem,
    check,
    completeness,
    controllability_indices,
    fixed_spectrum,
    joint_controllability,
    joint_observability,
    load_certificate,
    observability_indices,
    save_certificate,
    setpoint_solvability,
    transfer_graph,
)
from mcexact.errors import InputError, UsageError
from mcexact.parameters import ParametricRank
from tests.answer.test_golden import PORTS, tanks, with_a_parameter
from tests.oracle.parametric_draws import drawn_parametric
from tests.oracle.parametric_ranks import rank_disagreements
from tests.wording import worded

EXAMPLE = with_a_parameter([[1, 0, 0], ["t", 1, 0], [0, 1, 1]], PORTS)


def rank_at(found: ParametricRank, value: Fraction) -> int | None:
    """The rank that an answer states at a value; None if it says nothing."""
    if any(each.value(value) == 0 for each in found.outside):
        return None
    for each in found.exceptional:
        if each.value(value) == 0:
            return each.rank
    return found.rank


def test_set_points_of_four_tanks_fail_where_both_ratios_add_up_to_1() -> None:
    for second in (Fraction(7, 10), Fraction(1, 3)):
        found = setpoint_solvability(tanks("t", str(second)))
        assert (found.rank, [each.exact for each in found.exceptional]) == (6, [1 - second])
        assert [each.rank for each in found.exceptional] == [5]
    (value,) = setpoint_solvability(tanks("t", "2*t")).exceptional
    assert value.exact == Fraction(1, 3)
    assert found.words == ("rank 6 for almost every t", "rank 5 where t = 2/3")
    ranged = setpoint_solvability(tanks("t", "t^2", (0, 1)))
    assert len(ranged.in_range()) == 1 and ranged.exceptional[0].exact is None
    assert not setpoint_solvability(tanks("t", "t^2", (0, "1/2"))).exceptional


def test_an_edge_of_the_example_vanishes_at_0() -> None:
    graph = transfer_graph(EXAMPLE)
    lost = {pair: [each.exact for each in values] for pair, values in graph.lost.items()}
    assert set(graph.arcs) >= {("1", "2"), ("1", "1"), ("2", "2")}
    assert lost[("1", "2")] == [0] and ("2", "2") not in lost
    assert all(check(each, EXAMPLE).verdict == "VALID" for each in graph.certificates)


def test_completeness_is_lost_where_a_mode_is_fixed_or_the_graph_falls_apart() -> None:
    found = completeness(EXAMPLE)
    assert found.generic and [str(q) for q in found.exceptional] == ["x"]
    assert len(found.certificates) == 10
    plant = ParametricSystem(
        [[1, "t - 2"], ["t", 2]],
        [[[1], [0]], [[0], [1]]],
        [[[1, 0]], [[0, 1]]],
        parameters=["t"],
    )
    coupled = completeness(plant)
    assert coupled.generic and [str(q) for q in coupled.exceptional] == ["x - 2", "x"]
    assert not coupled.spectrum.exceptional
    apart = completeness(plant.along({"t": 0}))
    assert not apart.generic and apart.exceptional == ()


def test_indices_grow_until_they_agree_at_every_value() -> None:
    plant = ParametricSystem(
        [[0, "t", 0], [0, 0, "t - 1"], [0, 0, 0]],
        [[[0], [0], [1]]],
        [[[1, 0, 0]]],
        parameters=["t"],
    )
    found = controllability_indices(plant)
    assert [each.rank for each in found] == [1, 2, 3]
    values = [[(e.exact, e.rank) for e in each.exceptional] for each in found]
    assert values == [[], [(1, 1)], [(1, 1), (0, 2)]]
    assert [each.rank for each in controllability_indices(EXAMPLE)] == [2, 3, 3]
    assert [each.rank for each in controllability_indices(EXAMPLE, ["2"])] == [1, 2, 2]
    seen = observability_indices(EXAMPLE, ["2"])
    assert [each.rank for each in seen] == [1, 2, 2]
    assert seen[1].exceptional[0].exact == 0
    assert check(seen[1], EXAMPLE).verdict == "VALID"
    with pytest.raises(UsageError, match="no channel '4'"):
        controllability_indices(EXAMPLE, ["4"])


@pytest.mark.parametrize("number", range(3))
def test_elimination_at_points_finds_the_same_ranks(number: int) -> None:
    rng = random.Random(number)
    plant = drawn_parametric(rng)
    graph = transfer_graph(plant)
    answers: list[Any] = [setpoint_solvability(plant), *controllability_indices(plant)]
    answers += graph.certificates[:3]
    for found in answers:
        points = [Fraction(rng.randint(-9, 9), rng.choice((1, 2, 3))) for _ in range(6)]
        exact = [each.exact for each in found.exceptional if each.exact is not None]
        assert rank_disagreements(found, [*points, *exact], ()) == []
        assert check(found, plant).verdict == "VALID"


def test_elimination_at_all_points_of_fields_finds_the_same_rank() -> None:
    found = setpoint_solvability(tanks("t", "t^2"))
    assert rank_disagreements(found, [], (211, 307)) == []
    lie = replace(found, exceptional=())
    assert len(rank_disagreements(lie, [], (211, 241, 251))) == 1
    assert len(rank_disagreements(replace(found, rank=5), [Fraction(2)], ())) == 1


def test_at_a_point_the_answers_are_those_of_the_system_there() -> None:
    rng = random.Random(7)
    for _ in range(6):
        plant = drawn_parametric(rng)
        value = Fraction(rng.randint(-3, 3))
        try:
            there = plant.at({"t": value})
        except InputError:
            continue
        rank = rank_at(setpoint_solvability(plant), value)
        assert rank in (None, setpoint_solvability(there).rank)
        edges = [
            pair for pair, found in transfer_graph(plant).columns.items() if rank_at(found, value)
        ]
        if not plant.ranges[0][1]:
            assert set(edges) == set(transfer_graph(there).arcs)


def test_a_certificate_is_read_back(tmp_path: Path) -> None:
    for found in (
        setpoint_solvability(EXAMPLE),
        controllability_indices(EXAMPLE, ["1"])[1],
        *transfer_graph(EXAMPLE).certificates[:2],
    ):
        save_certificate(found, tmp_path / "found.json")
        assert load_certificate(tmp_path / "found.json", EXAMPLE) == found


def test_words_name_the_question_and_the_values_that_are_decided() -> None:
    plain = ParametricSystem([["t"]], [[[1]]], [[[1]]], parameters=["t"])
    assert worded(joint_controllability(plain).words)
    assert worded(joint_observability(plain).words)
    assert setpoint_solvability(plain).words == ("rank 2 for every t",)
    later = ParametricSystem([["t"]], [[["t"]]], [[[1]]], parameters=["t"], assume={"t": (2, None)})
    assert worded(fixed_spectrum(later).words)
    assert setpoint_solvability(later).words == ("rank 2 for every t in [2, ∞)",)


def test_the_value_1_is_not_taken_for_the_generic_modes_in_sympy() -> None:
    plant = ParametricSystem(
        [["t", 0, 0], [0, 1, 0], [0, 0, 5]],
        [[["1"], ["t - 1"], [0]]],
        [[[1, 1, 1]]],
        parameters=["t"],
    )
    found = fixed_spectrum(plant).to_sympy()
    assert [str(p.as_expr()) for p in found[True]] == ["x - 5"]
    assert [str(p.as_expr()) for p in found[1]] == ["x - 1"]
