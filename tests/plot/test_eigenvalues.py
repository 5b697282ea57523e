"""Eigenvalues in the picture: where they lie, how often, and what is proved of them."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from mcexact.analysis.stability import closed_loop_spectrum, open_loop_spectrum
from mcexact.errors import UsageError
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model.system import MultiChannelSystem
from mcexact.plot.eigenvalues import Point, eigenvalues, points_of


def crosses(figure: Figure) -> list[complex]:
    """The places of the crosses."""
    [axis] = figure.axes
    lines = [line for line in axis.get_lines() if line.get_marker() == "x"]
    x, y = np.array(lines[0].get_xdata()), np.array(lines[0].get_ydata())
    return [complex(each) for each in x + 1j * y]


def test_multiplicities_are_exact_and_discs_contain_the_roots() -> None:
    p = Polynomial.from_roots([-1, -1]) * Polynomial.of(2, 0, 1) ** 3
    found = points_of(p)
    assert [each.multiplicity for each in found] == [2, 3, 3]
    for each in found[1:]:
        assert abs(abs(each.place) - 2**0.5) <= each.radius + 1e-15 and each.radius
    texts = [text.get_text() for text in eigenvalues(p).axes[0].texts]
    assert texts == ["×2", "×3", "×3"]


def test_a_spectrum_an_answer_and_numbers_are_drawn_alike() -> None:
    M = Matrix.from_rows([[-1, 1], [0, -2]])
    plant = MultiChannelSystem(M, [[[0], [1]]], [[[1, 0]]])
    spectrum = closed_loop_spectrum(M, "continuous")
    for found in (spectrum, open_loop_spectrum(plant), [-2, -1], Polynomial.from_roots([-1, -2])):
        assert crosses(eigenvalues(found)) == [-2, -1]
    assert crosses(spectrum.plot()) == [-2, -1]


def test_a_spectrum_draws_the_stability_region_of_its_time() -> None:
    for time, shown in (("continuous", 0), ("discrete", 1)):
        [axis] = closed_loop_spectrum(Matrix.identity(1), time).plot().axes
        assert sum(isinstance(each, Circle) for each in axis.patches) == shown


def test_the_axes_that_are_given_are_drawn_on() -> None:
    figure = Figure()
    first, second = figure.subplots(1, 2)
    assert eigenvalues([-1], second, title="mine") is figure
    assert second.get_title() == "mine" and not first.get_lines()


def test_all_eigenvalues_and_the_edge_are_inside_the_picture() -> None:
    for roots, rate in (
        ([-1, -1000], 1),
        ([-1], 3),
        ([2], None),
        ([0], None),
        ([-1e-9, -2e-9], None),
    ):
        axis = eigenvalues(roots, region=StabilityRegion.of("continuous", rate=rate)).axes[0]
        left, right = axis.get_xlim()
        low, high = axis.get_ylim()
        assert all(left < each < right for each in roots) and low < 0 < high
        assert left < 0 <= right and (rate is None or left < -rate)


def test_eigenvalues_of_different_sizes_are_kept_apart() -> None:
    axis = eigenvalues([-1, -1000]).axes[0]
    assert axis.get_xscale() == "symlog"
    labels = [label.get_text() for label in axis.get_xticklabels()]
    assert labels == ["-100", "-1", "0", "1", "100"]


def test_small_imaginary_parts_have_a_scale() -> None:
    axis = eigenvalues([-0.016, complex(-0.09, 0.003), complex(-0.09, -0.003), -11]).axes[0]
    low, high = axis.get_ylim()
    assert len([tick for tick in axis.get_yticks() if low < tick < high]) == 3


def test_discrete_time_has_circles() -> None:
    axis = eigenvalues([0.5j], region=StabilityRegion.of("discrete", radius="3/4")).axes[0]
    assert [circle.get_radius() for circle in axis.patches] == [1, 0.75]


def test_nothing_is_said_to_be_proved_about_numbers() -> None:
    assert points_of([1j]) == (Point(1j),)
    assert eigenvalues([1j]).axes[0].get_legend() is None
    legend = eigenvalues(Polynomial.of(2, 0, 1)).axes[0].get_legend()
    assert "with proof" in legend.get_texts()[0].get_text()
    exact = eigenvalues(Polynomial.of(1, 1)).axes[0].get_legend()
    assert exact.get_texts()[0].get_text() == "exact"


def test_infinities_are_left_out() -> None:
    assert crosses(eigenvalues([complex("inf"), 1])) == [1]


def test_what_has_no_eigenvalues_is_refused() -> None:
    with pytest.raises(UsageError, match=r"expected a polynomial.*found int"):
        eigenvalues(3)


@pytest.mark.parametrize(("radius", "power"), [("0.001", -3), ("0.00100000000000000000001", -2)])
def test_the_power_of_ten_of_the_discs_is_at_least_every_radius(radius: str, power: int) -> None:
    disc = SimpleNamespace(re="0", im="0", radius=radius)
    found = SimpleNamespace(polynomial=Polynomial.of("1/10000", 1), discs=(disc,))
    legend = eigenvalues(found).axes[0].get_legend()
    assert f"10^{{{power}}}" in legend.get_texts()[0].get_text()
