"""Drawn systems with parameters: what is decided for all values is what is decided at each."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import HealthCheck, example, find, given, settings
from hypothesis import strategies as st

import mcexact
from mcexact import ParametricSystem, check, exceptional_hypersurfaces, fixed_spectrum
from mcexact.errors import InputError
from mcexact.testing import parametric_systems

VALUES = st.sampled_from([Fraction(0), Fraction(1), Fraction(-1), Fraction(1, 2), Fraction(5)])
FEW = settings(max_examples=10, deadline=None)
PLANTED = ParametricSystem(
    [["t", 1], [0, "1/(t - 3)"]], [[[0], ["t - 1/2"]]], [[[1, 0]]], parameters=["t"]
)


@FEW
@given(parametric_systems(2, denominators=True), VALUES)
@example(PLANTED, Fraction(1, 2))
def test_substituting_a_value_and_asking_again_gives_the_same_answer(
    plant: ParametricSystem, value: Fraction
) -> None:
    found = fixed_spectrum(plant)
    try:
        at = plant.at({"t": value})
    except InputError:
        with pytest.raises(InputError, match="undefined"):
            found.at(value)
        return
    assert set(found.at(value)) == {each.polynomial for each in fixed_spectrum(at).factors}
    assert check(found, plant).valid


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
