"""The largest certified box, and a plant near it that fails: both ends are exact."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
import scipy.linalg
import scipy.optimize  # noqa: F401
from hypothesis import given, settings

from mcexact import (
    MultiChannelSystem,
    check,
    fixed_spectrum,
    gallery,
    joint_controllability,
    testing,
)
from mcexact.analysis.boxes.failure import failing_plant, rational_point, severed_plants, tried_sets
from mcexact.analysis.boxes.largest import Proofs, failing_member, largest_factor
from mcexact.analysis.boxes.pencils import one_thread
from mcexact.answer.boxes import BoxFixedModes
from mcexact.boxes import Box, largest_uncertainty
from mcexact.constructions import dual
from mcexact.errors import UsageError
from tests.wording import says

EFFORT = 0.5
TWO_MODES = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [1]]], [[[1, 1]]])


def test_both_ends_are_proved() -> None:
    """Modes 1 and 2 meet where each moves by a third."""
    found = largest_uncertainty(TWO_MODES, effort=EFFORT)
    assert found.proof is not None and found.upper is not None and found.failing is not None
    assert Fraction(1, 10) < found.lower < Fraction(1, 3) <= found.upper < Fraction(2, 5)
    assert check(found.proof, Box.relative(TWO_MODES, found.lower).system).verdict == "VALID"
    assert not fixed_spectrum(found.failing).empty
    assert Box.relative(TWO_MODES, found.upper).contains(found.failing)
    assert found.refutation is not None and check(found.refutation, found.failing).valid
    assert found.relative and "no fixed mode" in found.explain()
    assert found.to_dict()["upper"] is not None and "fails within" in found._repr_html_()


def test_radii_of_the_plant_are_the_units() -> None:
    plant = Box.absolute(TWO_MODES, A=[[1, 0], [0, 1]]).system
    found = largest_uncertainty(plant, effort=EFFORT)
    assert not found.relative and found.upper is not None
    assert Fraction(1, 5) < found.lower < Fraction(1, 2) <= found.upper < Fraction(3, 5)
    assert "times the radii" in found.explain()


@pytest.mark.parametrize("wanted", ["controllable", "observable", "stabilizable"])
def test_other_properties_have_ends_of_their_own(wanted: Any) -> None:
    plant = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [1]]], [[[1, 3]]])
    found = largest_uncertainty(plant, wanted, effort=EFFORT)
    assert found.wanted == wanted and found.proof is not None and found.lower > Fraction(1, 20)
    assert check(found.proof, Box.relative(plant, found.lower).system).valid
    assert found.failing is not None and found.upper is not None
    if wanted == "stabilizable":
        assert not fixed_spectrum(found.failing).stabilizable
    else:
        seen = found.failing if wanted == "controllable" else dual(found.failing)
        assert not joint_controllability(seen).controllable
    assert Box.relative(plant, found.upper).contains(found.failing)


def test_a_plant_that_fails_itself_has_no_box() -> None:
    found = largest_uncertainty(gallery("davison-aghdam-miller-2020-p27"), effort=EFFORT)
    assert found.lower == 0 and found.proof is None
    assert says(found.explain(), "proved box") and found.to_dict()["lower"] == 0


def test_a_plant_whose_channels_do_nothing_is_within_the_whole_entries() -> None:
    """Two integrators that see each other: nothing nearer is found to fail."""
    plant = MultiChannelSystem([[0, 1], [1, 0]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]])
    for wanted in ("no fixed mode", "observable"):
        found = largest_uncertainty(plant, wanted, effort=0.1)
        assert found.upper is not None and found.failing is not None and found.upper <= 1, wanted
        assert found.refutation is not None and check(found.refutation).valid


def test_channels_lose_what_is_nearer_and_certain_entries_stay() -> None:
    plant = MultiChannelSystem([[-3]], [[[2]], [[1]]], [[[1]], [[4]]], names=["a", "b"])
    radii = Box.absolute(plant, A=[[1]], B=[[[1]], [[0]]], C=[[["1/4"]], [[2]]]).radii
    severed, stopped = severed_plants(plant, radii)
    assert (severed.distance, severed.channels, severed.plant.A) == (2, ("b",), plant.A)
    assert severed.plant.B[0].is_zero() and severed.plant.C[1].is_zero()
    assert (severed.plant.C[0], severed.plant.B[1]) == (plant.C[0], plant.B[1])
    assert stopped.distance == 3 and stopped.plant.A.is_zero()
    assert not [*severed_plants(plant, radii, inputs=True)]
    certain = Box.absolute(plant, B=[[[1]], [[1]]]).radii
    assert len([*severed_plants(plant, certain)]) == 1


@pytest.mark.parametrize("time", ["continuous", pytest.param("discrete", marks=pytest.mark.slow)])
def test_a_fixed_mode_of_a_plant_that_is_not_stabilizable_is_not_stable(time: str) -> None:
    """A mode at -2 or 1/2 that one channel hardly controls, and one at 1 or 3/2."""
    values = ("-2", "1") if time == "continuous" else ("1/2", "3/2")
    plant = MultiChannelSystem(
        [[values[0], 0], [0, values[1]]], [[["1/100"], [1]]], [[[1, 1]]], time=time
    )
    near = Box.absolute(plant, A=[[1, 0], [0, 1]], B=[[[1], [1]]]).system
    fixed = largest_uncertainty(near, "no fixed mode", effort=0.2)
    unstable = largest_uncertainty(near, "stabilizable", effort=0.2)
    assert fixed.upper is not None and unstable.upper is not None
    assert fixed.upper <= Fraction(1, 100) < Fraction(1, 5) < unstable.upper <= 1
    assert unstable.failing is not None and not fixed_spectrum(unstable.failing).stabilizable


def test_requests_that_make_no_sense_are_refused() -> None:
    with pytest.raises(UsageError, match=r"wanted: expected one of 'no fixed mode', .*, found 'x'"):
        largest_uncertainty(TWO_MODES, "x")  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="of a plant, and not of a derived system"):
        largest_uncertainty(dual(TWO_MODES))


@given(testing.systems(min_states=1, max_states=3, max_channels=2))
@settings(max_examples=4)
def test_a_plant_that_fails_is_exactly_at_its_distance(drawn: testing.Drawn) -> None:
    plant = drawn.system
    unit = Box.relative(plant, 1)
    with one_thread():
        found = failing_plant(plant, unit.radii, tried_sets(plant.m), 4)
    if found is None:
        return
    assert not fixed_spectrum(found.plant).empty
    assert unit.scaled(found.distance).contains(found.plant)
    assert not found.distance or not unit.scaled(found.distance * Fraction(99, 100)).contains(
        found.plant
    )


def test_the_search_ends_with_a_plant_that_is_near_enough() -> None:
    """The nearest is at a third; a change of at most 1/2 is enough, and of 1/10 there is none."""
    plant, unit = TWO_MODES, Box.relative(TWO_MODES, 1)
    tries = tried_sets(plant.m)
    nearest = failing_plant(plant, unit.radii, tries, 8)
    for enough in (Fraction(1, 2), Fraction(1, 10)):
        near = failing_plant(plant, unit.radii, tries, 8, enough=enough)
        assert nearest is not None and near is not None
        assert nearest.distance <= near.distance <= max(enough, nearest.distance)
        assert not fixed_spectrum(near.plant).empty


def test_a_plant_that_is_known_to_fail_is_not_searched(monkeypatch: pytest.MonkeyPatch) -> None:
    box = Box.relative(TWO_MODES, 1).system
    uncontrollable = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [0]]], [[[1, 1]]])
    calls: list[str] = []
    monkeypatch.setattr(
        "mcexact.analysis.boxes.largest.failing_plant", lambda *_, **__: calls.append("searched")
    )
    failing = failing_member(box, "no fixed mode", known=[TWO_MODES, uncontrollable])
    assert failing is not None and failing.about.plant == uncontrollable and not calls
    failing_member(Box.relative(TWO_MODES, "1/10").system, "no fixed mode", known=[TWO_MODES])
    assert calls


def test_few_channels_have_all_sets_and_many_the_simplest() -> None:
    assert [len(tried_sets(m)) for m in range(1, 6)] == [2, 4, 8, 16, 32]
    assert len(tried_sets(7)) == 16


@pytest.mark.parametrize("point", [0.6 + 0.8j, -0.3 + 0.4j, 0.5 + 0j])
def test_a_rational_point_keeps_to_its_circle(point: complex) -> None:
    re, im = rational_point(point, "circle")
    size = Fraction(abs(point)).limit_denominator(10**6)
    assert re**2 + im**2 == size**2 and abs(complex(re, im) - point) < 1e-5
    assert rational_point(point, "plane") == rational_point(point, "line")


def test_what_is_said_of_both_ends_is_rounded_to_where_it_is_proved() -> None:
    """A plant that fails within 12.34 % does not fail within 12.3 %."""
    found = largest_uncertainty(TWO_MODES, effort=EFFORT)
    known = replace(found, lower=Fraction(1239, 10**4), upper=Fraction(1241, 10**4))
    assert "within 12.3 % of each entry; not for a plant within 12.5 %" in known.explain()
    assert dict(known.rows())["a plant fails within"] == "12.5 %"
    multiple = replace(known, relative=False, upper=Fraction(12341, 1000))
    assert dict(multiple.rows())["a plant fails within"] == "12.4 times the radii"


@pytest.mark.parametrize("effort", [-1, float("nan"), "a", True, None])
def test_effort_is_a_number_of_seconds(effort: Any) -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    with pytest.raises(UsageError, match="effort: expected a number of seconds, found"):
        largest_uncertainty(plant, effort=effort)


def test_a_stable_plant_with_a_box_without_fixed_modes_has_one_that_is_stabilizable() -> None:
    found = largest_uncertainty(gallery("compleib-dis3"), "stabilizable", effort=0.05)
    assert found.lower and isinstance(found.proof, BoxFixedModes)
    assert found.proof.bound == 0 and check(found.proof).valid


def test_factors_that_failed_are_tried_again_by_a_search_that_learned() -> None:
    asked: list[float] = []
    learned = 10**6

    def proof(growth: Fraction) -> Any:
        asked.append(float(growth))
        return growth if growth < (0.5 if len(asked) <= learned else 0.8) else None

    search = Proofs(lambda: 1.0, proof, lambda: float(len(asked)))
    assert 0.45 < largest_factor(search, 100, 1e6)[0] < 0.5
    learned = len(asked)
    asked.clear()
    assert 0.75 < largest_factor(replace(search, rounds=2), 100, 1e6)[0] < 0.8
    asked.clear()
    largest_factor(replace(search, likely=lambda: 0.2), 100, 1e6)
    assert asked[:2] == [0.194, 0.97]


def test_a_factor_that_is_as_small_as_rounding_is_reported_as_0() -> None:
    """All that is proved near a plant that fails by a hair would be the plant itself."""
    asked: list[Fraction] = []

    def proof(growth: Fraction) -> Any:
        asked.append(growth)
        return growth

    search = Proofs(lambda: 1e-13, proof, lambda: 0.0)
    assert largest_factor(search, 100, 1e6) == (0, None) and not asked
    nothing = replace(search, capacity=lambda: 1.0, proof=lambda growth: asked.append(growth))
    assert largest_factor(nothing, 100, 1e6) == (0, None) and min(asked) > Fraction(1, 10**13)
