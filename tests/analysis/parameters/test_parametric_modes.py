"""The fixed modes for all values of a parameter, against known answers, laws and enumeration."""

from __future__ import annotations

import random
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from sympy import symbols

from mcexact import ParametricSystem, check, fixed_spectrum, load_certificate, save_certificate
from mcexact.answer.protocol import encode
from mcexact.errors import InputError, UsageError
from mcexact.parameters import ParametricFixedSpectrum
from tests.answer.test_golden import PORTS, tanks, with_a_parameter
from tests.assurance.campaigns.parametric import examined
from tests.oracle.parametric_draws import drawn_parametric
from tests.wording import refusal, worded

t = symbols("t")


@pytest.mark.parametrize("i", range(3))
@pytest.mark.parametrize("j", range(3))
def test_three_entries_of_the_paper_s_example_are_exceptional_at_0_alone(i: int, j: int) -> None:
    A: list[list[Any]] = [[1, 0, 0], [0, 1, 0], [0, 1, 1]]
    A[i][j] = t
    found = fixed_spectrum(with_a_parameter(A, PORTS))
    expected = [0] if (i, j) in {(1, 0), (1, 2), (2, 0)} else []
    assert [each.exact for each in found.exceptional] == expected
    assert bool(found.generic) is not bool(expected)


def test_four_tanks_lose_a_mode_where_a_valve_is_open() -> None:
    for plant in (tanks("t", "7/10"), tanks("7/10", "t")):
        found = fixed_spectrum(plant)
        assert [each.exact for each in found.exceptional] == [1]
        assert not found.generic
    (value,) = fixed_spectrum(tanks("t", "7/10")).exceptional
    assert value.modes and value.inside((Fraction(0), Fraction(1)))
    assert not value.inside((None, Fraction(1, 2)))


def test_generic_modes_depend_on_the_parameter_and_are_divided_by_the_denominator() -> None:
    plant = ParametricSystem([[1 / t, 0], [0, 1]], [[[0], [1]]], [[[1, 1]]], parameters=[t])
    found = fixed_spectrum(plant)
    assert [str(c) for c in found.generic[0]] == ["-1", "1"]  # x = 1, divided by t
    assert str(found.scale) == "x"
    assert [str(q) for q in found.undefined_at] == ["x"]
    assert found.settled == ()
    assert fixed_spectrum(plant.at({t: 2})).factors[0].polynomial(Fraction(1, 2)) == 0


def test_the_words_name_the_parameter() -> None:
    A = [["1/k", 0, 0], [0, 1, "k"], [0, 0, 2]]
    plant = ParametricSystem(A, [[[0], [1], [2]]], [[[1, 1, 0]]], parameters=["k"])
    assert worded(fixed_spectrum(plant).words)


def test_a_range_leaves_out_the_values_beyond_it() -> None:
    plant = ParametricSystem(
        [[0, 0], [t**2 - 2, 1]], [[[1], [0]]], [[[0, 1]]], parameters=[t], assume={t: (0, 1)}
    )
    found = fixed_spectrum(plant)
    assert [str(each.value) for each in found.outside] == ["x^2 - 2"]
    assert not found.exceptional and not found.in_range()
    wide = ParametricSystem(
        plant.A, [plant.channels[0].B], [plant.channels[0].C], parameters=[t], assume={t: (1, 2)}
    )
    (value,) = fixed_spectrum(wide).in_range()
    assert len(value.real) == 2 and value.exact is None


def test_several_parameters_need_a_line() -> None:
    plant = ParametricSystem([["a", "b"], [0, 1]], [[[1], [0]]], [[[1, 0]]], parameters=["a", "b"])
    with refusal(UsageError):
        fixed_spectrum(plant)
    assert fixed_spectrum(plant.along({"a": "s", "b": 2})).generic


def test_a_line_through_exceptional_points_has_generic_modes_of_its_own() -> None:
    plant = ParametricSystem(
        [[0, 0], ["a - b", 1]], [[[1], [0]]], [[[0, 1]]], parameters=["a", "b"]
    )
    across = fixed_spectrum(plant.along({"a": "s", "b": "2*s - 1"}))
    assert [each.exact for each in across.exceptional] == [1] and not across.generic
    inside = fixed_spectrum(plant.along({"a": "s", "b": "s"}))
    assert not inside.exceptional and inside.generic


def test_a_certificate_is_read_back(tmp_path: Path) -> None:
    plant = tanks("t", "t^2", (0, "1/2"))
    found, path = fixed_spectrum(plant), tmp_path / "found.json"
    save_certificate(found, path)
    read = load_certificate(path, plant)
    assert isinstance(read, ParametricFixedSpectrum)
    assert (read, encode(read), read.about) == (found, encode(found), plant)
    save_certificate(found, path, system_by_digest=True)
    assert load_certificate(path, plant) == found
    with pytest.raises(InputError, match="does not accept"):
        load_certificate(path, tanks("t", "t"))
    assert check(found, tanks("t", "t")).verdict == "NOT ABOUT"


@pytest.mark.parametrize("number", (1, 2, 3, 4))
def test_enumeration_at_points_and_modulo_primes_finds_the_same(number: int) -> None:
    assert examined(number, 12)[0] == []


@pytest.mark.parametrize("number", range(20))
def test_at_a_point_the_answer_is_that_of_the_system_there(number: int) -> None:
    rng = random.Random(number)
    plant = drawn_parametric(rng)
    found = fixed_spectrum(plant)
    for value in {Fraction(0), Fraction(1), Fraction(rng.randint(-9, 9), 4)}:
        try:
            there = fixed_spectrum(plant.at({"t": value}))
        except InputError:
            assert any(q(value) == 0 for q in found.undefined_at)
            continue
        if any(each.value(value) == 0 for each in found.outside):
            continue
        modes = [*found.generic] + [
            mode.polynomial
            for each in found.exceptional
            if each.value(value) == 0
            for mode in each.modes
        ]
        at = [[c(value) * found.scale(value) ** k for k, c in enumerate(p)] for p in modes]
        degrees = sum(f.polynomial.degree for f in there.factors)
        for p in (factor.polynomial for factor in there.factors):
            assert any(divides(p, q) for q in at)
        assert degrees <= sum(len(q) - 1 for q in at)
        assert bool(at) == bool(there.factors)


def divides(p: Any, coefficients: list[Fraction]) -> bool:
    """Whether a polynomial divides one of these coefficients."""
    return bool(p.divides(type(p).from_coefficients(coefficients)))
