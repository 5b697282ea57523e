"""Plots over parameters: which values are marked, and which curves are drawn."""

from __future__ import annotations

from typing import Any

import pytest

from mcexact import ParametricSystem, fixed_spectrum
from mcexact.errors import UsageError
from mcexact.parameters import exceptional_hypersurfaces, load_parametric_system
from tests.wording import worded


def test_exceptional_values_are_marked_with_their_modes() -> None:
    plant = ParametricSystem(
        [["t", 1], [0, "1/(t - 3)"]], [[[1], ["t^2 - 2"]]], [[[1, 0]]], parameters=["t"]
    )
    found = fixed_spectrum(plant)
    [axis] = found.plot(span=(-2, 2)).axes
    dots = [line for line in axis.get_lines() if line.get_marker() == "o"]
    marked = sorted(float(line.get_xdata()[0]) for line in dots)
    real = [float(disc.re) for each in found.exceptional for disc in each.real]
    assert marked == pytest.approx(sorted(x for x in real if -2 <= x <= 2))
    for line in dots:
        t = float(line.get_xdata()[0])
        modes = (t, 1 / (t - 3))
        assert min(abs(line.get_ydata()[0] - mode) for mode in modes) < 1e-9
    assert axis.get_xlabel() == "t" and axis.get_xlim() == (-2.0, 2.0)


def test_modes_fixed_for_every_value_are_drawn_and_the_range_is_kept() -> None:
    plant = ParametricSystem(
        [["t"]], [[[0]]], [[[1]]], parameters=["t"], assume={"t": (0, 5)}, name="one"
    )
    [axis] = fixed_spectrum(plant).plot().axes
    _, labels = axis.get_legend_handles_labels()
    assert worded(labels)
    assert axis.get_xlim() == (0.0, 5.0)


@pytest.mark.parametrize("ends", [(None, None), (0, None), (None, 9)])
def test_without_a_range_all_exceptional_values_are_drawn(ends: tuple[Any, Any]) -> None:
    plant = ParametricSystem([[1]], [[["t - 7"]]], [[[1]]], parameters=["t"], assume={"t": ends})
    low, high = fixed_spectrum(plant).plot().axes[0].get_xlim()
    assert low < 7 < high and ends in ((None, None), (low, None), (None, high))


def test_hypersurfaces_of_two_parameters_are_curves() -> None:
    found = exceptional_hypersurfaces(load_parametric_system("gallery:quadruple-tank-parametric"))
    figure = found.plot()
    [axis] = figure.axes
    _, labels = axis.get_legend_handles_labels()
    assert labels == ["gamma1 = 1", "gamma2 = 1"]
    paths = [path for drawn in axis.collections for path in drawn.get_paths() if len(path.vertices)]
    assert all(1 in path.vertices[0].round(9) for path in paths) and len(paths) == 2


def test_more_parameters_are_refused_with_the_way_out() -> None:
    plant = ParametricSystem([["a*b*c"]], [[["a"]]], [[[1]]], parameters=["a", "b", "c"])
    with pytest.raises(UsageError, match="along"):
        exceptional_hypersurfaces(plant).plot()
