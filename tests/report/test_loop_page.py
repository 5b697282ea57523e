"""The figure of a loop and its description."""

from fractions import Fraction

from mcexact.exact.roots import StabilityRegion
from mcexact.model.loop import closed_loop
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.report.pages import loop_pictures, margin_pictures
from mcexact.synthesis.optimum.diagnosis import curves_of
from mcexact.synthesis.performance import performance_of
from mcexact.synthesis.setpoint import design_setpoint
from tests.wording import says, worded


def lines(axis):
    return [(each.get_xdata(), each.get_ydata()) for each in axis.get_lines()]


def pictured(plant, gain, region):
    curves = curves_of(closed_loop(plant, local_controllers(plant, [[[gain]]])), region)
    return curves, loop_pictures(curves)


def test_continuous_time_has_a_line_and_discrete_time_a_circle():
    moving = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    curves, [picture, *_] = pictured(moving, -3, StabilityRegion("continuous", Fraction(1)))
    assert curves.eigenvalues == [-2] and curves.region.edge == 1
    [poles] = picture.figure.axes
    shown = [list(x) for x, _ in lines(poles)]
    assert [-2] in shown and [0, 0] in shown and [-1, -1] in shown
    assert says(picture.alternative, "inside dashed")
    sampled = MultiChannelSystem([["1/2"]], [[[1]]], [[[1]]], time="discrete")
    curves, [picture, *_] = pictured(sampled, "-1/4", StabilityRegion.of("discrete", radius="1/2"))
    assert says(picture.alternative, "dashed circle") and "0.5" in picture.alternative
    assert curves.growth[:3] == [1, 0.25, 0.0625] and curves.effort[:2] == [0.25, 0.0625]


def test_eigenvalues_beyond_the_line_are_not_said_to_be_inside():
    plant = MultiChannelSystem([[1, 0], [0, -5]], [[[1], [0]]], [[[1, 0]]])
    _, [picture, *_] = pictured(plant, -3, StabilityRegion("continuous", Fraction(4)))
    assert says(picture.alternative, "them dashed")
    sampled = MultiChannelSystem([["1/2"]], [[[1]]], [[[1]]], time="discrete")
    _, [picture, *_] = pictured(sampled, "1/4", StabilityRegion.of("discrete", radius="1/2"))
    assert says(picture.alternative, "them inside")


def test_a_damping_ratio_and_a_largest_modulus_are_drawn_and_told():
    """Eigenvalues −1 ± i, of damping ratio 1/√2, on the inner sides of both edges."""
    plant = MultiChannelSystem([[0, 1], [-2, -2]], [[[0], [1]]], [[[1, 0]]])
    region = StabilityRegion("continuous").limited(damping="1/2", largest_modulus=2)
    curves, [picture, *_] = pictured(plant, 0, region)
    assert says(picture.alternative, "damping circle") and "0.5" in picture.alternative
    [axis] = picture.figure.axes
    edges = [each for each in axis.get_lines() if each.get_linestyle() == "--"]
    _, upper, lower, circle = ([complex(*each) for each in one.get_xydata()] for one in edges)
    assert all(abs(-each.real - abs(each) / 2) < 1e-6 for each in upper + lower)
    assert min(each.imag for each in upper) == 0 == max(each.imag for each in lower)
    assert all(abs(abs(each) - 2) < 1e-9 and each.real <= 0 for each in circle)
    assert axis.get_xlim()[0] < -2 and axis.get_ylim()[1] > 2
    assert [each for each in (-1 + 1j, -0.2 + 1j, -3 + 0j) if curves.keeps(each)] == [-1 + 1j]
    wide = StabilityRegion("continuous").limited(largest_modulus=1000)
    _, [picture, *_] = pictured(plant, 0, wide)
    assert says(picture.alternative, "circle picture")
    assert picture.figure.axes[0].get_ylim()[1] < 10


def test_eigenvalues_of_different_sizes_are_all_seen():
    plant = MultiChannelSystem([[1, 0], [0, -1000]], [[[1], [1]]], [[[1, 0]]])
    _, [picture, *_] = pictured(plant, -3, StabilityRegion("continuous"))
    assert picture.figure.axes[0].get_xscale() == "symlog"


def test_a_loop_with_integrators_shows_its_step_responses():
    plant = MultiChannelSystem([[1, 0], [1, -1]], [[[1], [0]]], [[[1, 0]]], names=["pump"])
    made = design_setpoint(plant, rate="1/2")
    curves = curves_of(made.loop.closed, made.region)
    [(name, values)] = curves.steps
    assert name == "pump" and values[0] == 0 and abs(values[-1] - 1) < 0.1
    *_, picture = loop_pictures(curves)
    assert picture.alternative.startswith("Each output after a unit step")
    assert picture.figure.axes[0].get_legend().get_texts()[0].get_text() == "pump"


def test_a_page_draws_the_steps_of_set_points_once_with_the_peaks_that_are_proved():
    plant = MultiChannelSystem([[1, 0], [1, -1]], [[[1], [0]]], [[[1, 0]]], names=["pump"])
    made = design_setpoint(plant, rate="1/2")
    curves = curves_of(made.loop.closed, made.region)
    with_peaks = [each.title for each in loop_pictures(curves, peaks=True)]
    assert with_peaks[:3] == [each.title for each in loop_pictures(curves)][:3]
    assert with_peaks[3] == "Effort"
    of_steps = margin_pictures(performance_of(made.loop.closed))[2:]
    assert worded(each.title for each in of_steps)
    assert all(says(each.alternative, "peaks") for each in of_steps)
    assert says(of_steps[1].alternative, "agent pump")


def test_an_output_of_several_is_numbered():
    plant = MultiChannelSystem(
        [[0, 0], [0, 0]],
        [[[1, 0], [0, 1]]],
        [[[1, 0], [0, 1]]],
        time="continuous",
        neighbors={"1": []},
    )
    made = design_setpoint(plant, rate="1/2")
    curves = curves_of(made.loop.closed, made.region)
    assert [name for name, _ in curves.steps] == ["1, 1", "1, 2"]
