"""Typical sizes of signals in system files, and units near them."""

from __future__ import annotations

import json
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mcexact.analysis.performance import default_weights, weights_in
from mcexact.checker.core.reading import Limits, Refused
from mcexact.checker.core.system import digest, read_system_file
from mcexact.derived.sampling import c2d
from mcexact.errors import FloatRefused, InputError, UsageError
from mcexact.model.loop import closed_loop
from mcexact.model.sizes import TypicalSizes
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import read_system, system_text
from mcexact.model.units import Units, controller_in, loop_in, power_of_ten, system_in
from tests.wording import refusal

TANKS = MultiChannelSystem(
    [["-1/50", "1/50"], ["1/50", "-1/30"]],
    [[["1/2"], [0]], [[0], ["2/5"]]],
    [[[1, 0]], [[0, 1]]],
    names=["pump", "valve"],
)
DOCUMENT: dict[str, Any] = {
    "states": ["1/20", 2],
    "inputs": {"pump": [10], "valve": [300]},
    "errors": {"pump": ["1/1000"], "valve": [3]},
    "disturbances": "1/4",
}


def file_with(sizes: Any) -> str:
    return json.dumps({**TANKS.to_dict(), "sizes": sizes})


def test_the_weights_follow_from_the_sizes_by_brysons_rule() -> None:
    weights = default_weights(read_system(file_with(DOCUMENT)))
    assert weights.states == (400, Fraction(1, 4))
    assert weights.inputs == (Fraction(1, 100), Fraction(1, 90_000))
    assert weights.disturbances == (Fraction(1, 1600), 1)
    assert weights.noise == (Fraction(1, 10**6), 9)


def test_without_sizes_the_weights_are_one_in_the_units_of_the_file() -> None:
    plain, empty = default_weights(TANKS), default_weights(read_system(file_with({})))
    assert plain == empty and set(plain.states + plain.inputs + plain.disturbances) == {1}
    assert set(plain.noise) == {Fraction(1, 100)}


def test_a_file_keeps_its_sizes_and_no_digest_depends_on_them() -> None:
    plant = read_system(file_with(DOCUMENT))
    assert plant.typical_sizes is not None
    assert plant.typical_sizes.document(plant.names) == DOCUMENT
    assert read_system(system_text(plant)) == plant == read_system(json.dumps(plant.to_dict()))
    assert plant.digest() == TANKS.digest() and plant != TANKS
    assert c2d(plant, "1/10").typical_sizes == plant.typical_sizes


@pytest.mark.parametrize(
    ("sizes", "message"),
    [
        ([], "sizes: expected a JSON object"),
        ({"state": [1, 1]}, r"unknown key 'state' \(did you mean 'states'\?\)"),
        ({"states": [1]}, "sizes: states: expected 2 sizes, found 1"),
        ({"states": [1, 0]}, r"sizes: states\[1\]: expected a size above 0, found 0"),
        ({"states": [1, "x"]}, r"sizes.states\[1\]"),
        ({"inputs": {"pump": [1]}}, "sizes.inputs: the channel 'valve' is missing"),
        ({"inputs": {"pump": [1], "valve": [1, 2]}}, r"sizes: inputs\[1\]: expected 1 sizes"),
        ({"inputs": {"pump": [1], "vale": [1]}}, r"did you mean 'valve'\?"),
        ({"errors": {"pump": [-1], "valve": [1]}}, "expected a size above 0, found -1"),
        ({"disturbances": 0}, "sizes: disturbances: expected a size above 0, found 0"),
    ],
)
def test_a_malformed_size_is_an_error_that_names_its_place(sizes: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        read_system(file_with(sizes))


def test_sizes_of_python_are_checked_like_those_of_files() -> None:
    with pytest.raises(FloatRefused):
        TypicalSizes(states=[0.1, 1])
    with pytest.raises(InputError, match="states: expected a list of numbers"):
        TypicalSizes(states="12")
    with pytest.raises(InputError, match="sizes: inputs: expected 2 lists, found 1"):
        TANKS.with_typical_sizes(TypicalSizes(inputs=[[1]]))
    with pytest.raises(InputError, match="sizes: expected a TypicalSizes"):
        TANKS.with_typical_sizes("large")  # type: ignore[arg-type]
    derived = closed_loop(TANKS, local_controllers(TANKS, [[[-1]], [[-1]]])).system
    with refusal(UsageError):
        derived.with_typical_sizes(None)


def test_the_checker_reads_a_file_with_sizes_and_refuses_a_malformed_one() -> None:
    def read(sizes: Any) -> str:
        return digest(read_system_file(file_with(sizes).encode(), Limits()))

    assert read(DOCUMENT) == read({}) == TANKS.digest()
    for sizes in (
        {"states": [1]},
        {"errors": {"pump": [0], "valve": [1]}},
        {"errors": {"pump": [1]}},
        {"inputs": {"x": [1]}},
        {"disturbances": -1},
        [],
        {"a": 1},
    ):
        with pytest.raises(Refused):
            read(sizes)


positive = st.fractions(min_value=Fraction(1, 10**9), max_value=10**9).filter(lambda x: x > 0)


@given(positive, st.integers(-12, 12))
def test_the_nearest_power_of_ten_moves_with_its_number(x: Fraction, k: int) -> None:
    power = power_of_ten(x)
    assert Fraction(1, 10) * power**2 <= x**2 < 10 * power**2
    assert power_of_ten(x * Fraction(10) ** k) == power * Fraction(10) ** k


powers = st.integers(-6, 6).map(lambda k: Fraction(10) ** k)


@given(st.tuples(powers, powers), st.tuples(powers, powers), st.tuples(powers, powers))
def test_a_plant_in_units_near_its_sizes_is_the_same_in_all_units(
    x: tuple[Fraction, ...], u: tuple[Fraction, ...], y: tuple[Fraction, ...]
) -> None:
    plant = read_system(file_with(DOCUMENT))
    other = system_in(Units(x, ((u[0],), (u[1],)), ((y[0],), (y[1],))), plant)
    own, others = Units.of(plant), Units.of(other)
    assert own is not None
    measured = system_in(own, plant)
    assert (other if others is None else system_in(others, other)) == measured
    assert Units.of(measured) is None
    assert weights_in(own, default_weights(plant)) == default_weights(measured)
    assert system_in(own.inverse(), measured) == plant


@given(st.tuples(powers, powers), st.tuples(powers, powers), st.tuples(powers, powers))
def test_units_change_neither_the_eigenvalues_of_a_loop_nor_its_integrators(
    x: tuple[Fraction, ...], u: tuple[Fraction, ...], y: tuple[Fraction, ...]
) -> None:
    units = Units(x, ((u[0],), (u[1],)), ((y[0],), (y[1],)))
    loop = closed_loop(TANKS, local_controllers(TANKS, [[[-1]], [["-1/3"]]]))
    other = loop_in(units, loop)
    assert (
        other.matrix
        == MultiChannelSystem(
            [[loop.matrix[i, j] * x[j] / x[i] for j in range(2)] for i in range(2)],
            [[[], []]],
            [[]],
        ).A
    )
    back = controller_in(units.inverse(), other.controller, TANKS.digest())
    assert back == loop.controller
