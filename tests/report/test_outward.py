"""Proved figures that are rounded for display are rounded to the side on which they still hold."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

from mcexact.analysis.stability import closed_loop_spectrum
from mcexact.cli.loops import loops_within
from mcexact.exact.matrix import Matrix, float_above, float_below
from mcexact.exact.rational import digits_outward
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.plot.responses import rate_text
from mcexact.report.figures import spectrum_picture
from mcexact.report.simulation import radius_text
from mcexact.report.sweep import tolerance_tables
from mcexact.synthesis.certify import certify_controller

EXTREMES = [
    Fraction(text)
    for text in ("0", "1e-500", "1e-320", "2/3", "0.1", "99999999/100000000", "7", "1e23", "1e500")
] + [Fraction(1, 3**700), Fraction(2**1024 - 1), Fraction(1, 2**1075)]


@pytest.mark.parametrize("x", [sign * x for x in EXTREMES for sign in (1, -1)])
def test_floats_and_digits_are_on_the_side_that_was_asked_for(x: Fraction) -> None:
    for digits in (1, 2, 4, 9):
        low, high = (Fraction(digits_outward(x, up=up, digits=digits)) for up in (False, True))
        assert low <= x <= high <= low + abs(x) * Fraction(10, 10**digits)
    for found, side in ((float_above(x), 1), (float_below(x), -1)):
        if abs(found) != float("inf"):
            assert side * Fraction(found) >= side * x <= side * Fraction(repr(found))
        else:
            assert (found > 0) == (side > 0) and abs(x) >= Fraction(2**1023)


@pytest.mark.parametrize("x", ["1/2", "99999/100000", f"{10**30 - 1}/{10**30}", "1", "10/9"])
def test_a_radius_below_one_is_written_below_one(x: str) -> None:
    written = Fraction(radius_text(Fraction(x)))
    assert Fraction(x) <= written and (written < 1) == (Fraction(x) < 1)


@pytest.mark.parametrize("entry", ["-2/3", "-20001/30000", "-99995/100000", "1/3"])
def test_the_rate_in_pictures_is_not_better_than_the_certified_one(entry: str) -> None:
    for time in ("continuous", "discrete"):
        spectrum = closed_loop_spectrum(Matrix.from_rows([[0, 1], [entry, -1]]), time)
        if spectrum.rate is None:
            continue
        shown = Fraction(rate_text(time, spectrum).split()[1])
        if time == "discrete":
            assert shown >= Fraction(spectrum.rate.upper)
        else:
            assert shown <= Fraction(spectrum.rate.lower)


def test_the_radius_of_discs_in_words_is_at_least_that_of_each() -> None:
    spectrum = closed_loop_spectrum(Matrix.from_rows([[0, 1], [-2, -1]]), "continuous")
    wide = replace(spectrum, discs=tuple(replace(d, radius="0.00104999") for d in spectrum.discs))
    words = spectrum_picture(wide, "continuous", "").alternative
    shown = words.partition("radius at most ")[2].removesuffix(".")
    assert Fraction("0.00104999") <= Fraction(shown) < Fraction("0.0012")


def test_a_part_within_which_plants_fail_is_written_exactly() -> None:
    documents = [
        {"name": "p: within 1/3", "answers": {"box_fixed_modes": {"member": "x"}}},
    ]
    [table] = tolerance_tables(documents, ["box_fixed_modes"])
    assert table.rows[0][1] == "100/3 %"


def test_the_part_of_gains_is_not_rounded_up() -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    controller = local_controllers(plant, [[[0]]])
    verdict = certify_controller(plant, controller)
    loops = loops_within(plant, controller, verdict, Fraction(2, 3))
    assert dict(loops.rows)["gains"] == "within 66.6 %"
