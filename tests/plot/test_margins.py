"""Disk margins and Nyquist curves, which stay out of the certified disk."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.figure import Figure

from mcexact.errors import UsageError
from mcexact.exact.matrix import to_float
from mcexact.model import gallery
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.plot.margins import disk, margins, nyquist
from mcexact.synthesis.decentralized import design_decentralized
from mcexact.synthesis.optimum.figures import Aims
from mcexact.synthesis.performance import (
    Performance,
    SingleLoop,
    loop_performance,
    performance_of,
)


def of(gain: int, time: str = "continuous") -> Performance:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time=time)
    return loop_performance(plant, local_controllers(plant, [[[gain]]]))


def test_the_bars_are_the_margins_that_are_proved() -> None:
    performance = of(-3)
    left, right = performance.plot().axes
    assert [bar.get_width() for bar in left.patches] == [v for v, _ in performance.bars.values()]
    assert all(proved for _, proved in performance.bars.values())
    assert "certified" in right.get_legend().get_texts()[-1].get_text()


@pytest.mark.parametrize("name", ["compleib-dis5", "farina-string-of-vehicles-4"])
def test_no_curve_enters_the_certified_disk_and_one_nearly_touches_it(name: str) -> None:
    loop = design_decentralized(gallery.load(name), aims=Aims(effort=1)).loop.closed
    performance = performance_of(loop)
    assert performance.margin is not None
    center, radius = disk(to_float(performance.margin))
    distances = [abs(z - center) for each in performance.loops for z in each.curve]
    assert radius < min(distances) < 1.05 * radius
    for each in performance.loops:
        # nor does a chord between neighbors
        middles = [(a + b) / 2 for a, b in pairwise(each.curve)]
        assert all(abs(z - center) > 0.98 * radius for z in middles)


def test_a_known_loop_has_its_curve() -> None:
    """L = 3/(s − 1) at s = 0 is −3, and at infinity 0."""
    (first, *_) = of(-3).loops
    assert first.name in ("input of agent 1", "output of agent 1")
    assert first.curve[0] == pytest.approx(-3) and abs(first.curve[-1]) < 0.1


def test_axes_can_be_given_and_an_unstable_loop_has_nothing_to_draw() -> None:
    figure = Figure()
    assert margins(of(-3), figure.subplots(1, 2)) is figure
    assert nyquist(of(-3), figure.add_subplot()) is figure
    with pytest.raises(UsageError, match="not stable"):
        of(3).plot()


def test_no_line_crosses_the_certified_disk_where_a_curve_comes_from_infinity() -> None:
    """1/s has the points −j/ω; at ω = 0 a program finds any number that is large enough."""
    frequencies = np.logspace(-3, 3, 300)
    curve = (complex(-1, -1e16), *(complex(0, -1 / w) for w in frequencies))
    loop = replace(of(-3), loops=(SingleLoop("output of agent 1", curve),))
    assert loop.margin is not None
    center, radius = disk(to_float(loop.margin))
    axis = Figure().add_subplot()
    nyquist(loop, axis)
    xs, ys = (np.asarray(values) for values in axis.lines[0].get_data())
    # the point of each line that is nearest to the center
    points = xs + 1j * ys
    start, along = points[:-1], np.diff(points)
    share = np.clip(((center - start) * along.conj()).real / np.abs(along) ** 2, 0, 1)
    assert np.nanmin(np.abs(start + share * along - center)) > radius
    assert np.sum(np.hypot(xs, ys) < axis.get_xlim()[1]) > 100
