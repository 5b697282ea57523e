"""Drawn systems with parameters: what is decided for all values is what is decided at each."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import HealthCheck, example, find, given, settings
from hypothesis import strategies as st

import mcexact
from mcexact import (
    MultiChannelSystem,
    ParametricSystem,
    check,
    fixed_spectrum,
    joint_controllability,
    joint_observability,
    setpoint_solvability,
    transfer_graph,
)
from mcexact.errors import InputError
from mcexact.parameters import exceptional_hypersurfaces
from mcexact.testing import parametric_systems

VALUES = st.sampled_from([Fraction(v) for v in (0, 1, -1, "1/2", 3, 5)])
FEW = settings(max_examples=10, deadline=None)
PLANTED = ParametricSystem(
    [["t", 1], [0, "1/(t - 3)"]], [[[0], ["t - 1/2"]]], [[[1, 0]]], parameters=["t"]
)


DRAWN = parametric_systems(2, denominators=True, ranges=True)


def systems_at(
    plant: ParametricSystem, value: Fraction, *answers: Any
) -> Iterator[tuple[Fraction, MultiChannelSystem]]:
    """The plant at a value, and at all rational ones that answers name, where it is defined."""
    named = {each.exact for found in answers for each in found.exceptional}
    for each in {value, *named} - {None}:
        try:
            yield each, plant.at({"t": each})
        except InputError:
            continue


def says_nothing(found: Any, value: Fraction) -> bool:
    """Whether a value is out of the range."""
    return any(each.value(value) == 0 for each in found.outside)


@FEW
@given(DRAWN, VALUES)
@example(PLANTED, Fraction(1, 2))
@example(PLANTED, Fraction(3))
def test_substituting_a_value_and_asking_again_gives_the_same_answer(
    plant: ParametricSystem, value: Fraction
) -> None:
    found = fixed_spectrum(plant)
    known = dict(systems_at(plant, value, found))
    if value not in known:
        with pytest.raises(InputError, match="undefined"):
            found.at(value)
    for each, at in known.items():
        if not says_nothing(found, each):
            assert set(found.at(each)) == {f.polynomial for f in fixed_spectrum(at).factors}
    assert check(found, plant).valid


@settings(FEW, max_examples=5)
@given(DRAWN, VALUES)
@example(PLANTED, Fraction(1, 2))
def test_substituting_a_value_gives_the_same_controllability_and_observability(
    plant: ParametricSystem, value: Fraction
) -> None:
    for ask in (joint_controllability, joint_observability):
        found = ask(plant)
        for each, at in systems_at(plant, value, found):
            if not says_nothing(found, each):
                lost = any(q.value(each) == 0 for q in found.exceptional)
                assert (ask(at).dimension < plant.n) is (lost or bool(found.generic))
        assert check(found, plant).valid


@settings(FEW, max_examples=5)
@given(DRAWN, VALUES)
@example(PLANTED, Fraction(1, 2))
def test_substituting_a_value_gives_the_same_set_points_and_edges(
    plant: ParametricSystem, value: Fraction
) -> None:
    rank, graph = setpoint_solvability(plant), transfer_graph(plant)
    for each, at in systems_at(plant, value, rank, *graph.columns.values()):
        if not says_nothing(rank, each):
            assert rank_at(rank, each) == setpoint_solvability(at).rank
        there = transfer_graph(at).arcs
        for pair, found in graph.columns.items():
            if not says_nothing(found, each):
                assert bool(rank_at(found, each)) is (pair in there)


def rank_at(found: Any, value: Fraction) -> int:
    """The rank that an answer states at a value."""
    lost = (each.rank for each in found.exceptional if each.value(value) == 0)
    return int(next(lost, found.rank))


@settings(FEW, max_examples=4)
@given(parametric_systems(2, 1, parameters=("a", "b")), VALUES, VALUES)
def test_off_all_hypersurfaces_and_for_no_generic_mode_nothing_is_fixed(
    plant: ParametricSystem, a: Fraction, b: Fraction
) -> None:
    found = exceptional_hypersurfaces(plant)
    at = {"a": 100 + a, "b": b - 1000}
    if not found.generic and all(h.polynomial.values({k: float(v) for k, v in at.items()})
                                 for h in found.hypersurfaces):  # fmt: skip
        assert fixed_spectrum(plant.at(at)).empty


def test_drawn_systems_shrink_and_are_printed_as_calls() -> None:
    quick = settings(max_examples=40, database=None, suppress_health_check=list(HealthCheck))
    found = find(parametric_systems(), lambda plant: True, settings=quick)
    assert (found.n, found.m) == (1, 1) and found.A.is_zero()
    assert hasattr(mcexact, "ParametricSystem")


def test_values_that_are_undefined_or_out_of_range_are_refused() -> None:
    with pytest.raises(InputError, match="undefined at 3"):
        fixed_spectrum(PLANTED).at(3)
    ranged = ParametricSystem(
        [[1]], [[["t^2 - 4"]]], [[[1]]], parameters=["t"], assume={"t": (0, None)}
    )
    found = fixed_spectrum(ranged)
    assert [str(p) for p in found.at(2)] == ["x - 1"] and found.at(-1) == ()
    with pytest.raises(InputError, match="only t in"):
        found.at(-2)
