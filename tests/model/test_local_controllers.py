"""Local controllers from matrices and from python-control."""

import control
import pytest

from mcexact.analysis.stability import certify_stability
from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix
from mcexact.model.controller import controller_text, read_controller
from mcexact.model.loop import closed_loop
from mcexact.model.statespace import local_controllers, loop_from_statespace
from mcexact.model.system import MultiChannelSystem

PLANT = MultiChannelSystem([[0, 1], [2, 0]], [[[0], [1]], [[1], [0]]], [[[1, 0]], [[0, 1]]])
LEAD = ([[-5]], [[1]], [[7]], [[-9]])


def test_the_loop_is_made_of_the_matrices():
    controller = local_controllers(PLANT, [LEAD, [[-1]]])
    expected = Matrix.from_rows([[0, 0, 0], [-7, 0, 7], [1, 0, -5]])
    assert closed_loop(PLANT, controller).matrix == expected
    assert read_controller(controller_text(controller)).document() == controller.document()


def test_a_statespace_is_a_controller_and_a_loop():
    lead = control.ss(*LEAD)
    controller = local_controllers(PLANT, [lead, [[-1]]], rounding="decimal")
    assert controller.document() == local_controllers(PLANT, [LEAD, [[-1]]]).document()
    plant = control.ss([[0, 1], [2, 0]], [[0], [1]], [[1, 0]], [[0]])
    # python-control subtracts: what is added here is fed back with sign 1.
    loop = loop_from_statespace(control.feedback(plant, lead, sign=1), rounding="decimal")
    assert loop.A == Matrix.from_rows([[0, 1, 0], [-7, 0, 7], [1, 0, -5]])
    assert certify_stability(loop, rate="1/10").stable
    sampled = control.ss([[0.5]], [[1.0]], [[1.0]], [[0.0]], 0.1)
    assert certify_stability(loop_from_statespace(sampled, rounding="decimal"), radius=1).stable


def test_a_number_is_no_matrix_whatever_floats_mean():
    for rounding in (None, "decimal"):
        with pytest.raises(
            InputError, match=r"parts\[0\]\.D: expected .*a list of rows, found int"
        ):
            local_controllers(PLANT, [-3, [[1]]], rounding=rounding)


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ([[[1]]], "expected 2 controllers, found 1"),
        ([[[0.5]], [[1]]], "float"),
        ([([[1]], [[1]]), [[1]]], "found 2 matrices"),
        ([([[1]], [[1, 2]], [[1]], [[1]]), [[1]]], r"parts\[0\]\.B: expected"),
        ([control.ss([[0.5]], [[1.0]], [[1.0]], [[0.0]], True), [[1]]], "in discrete time"),
    ],
)
def test_what_does_not_fit_is_named(parts, message):
    with pytest.raises(InputError, match=message):
        local_controllers(PLANT, parts)


def test_a_loop_comes_from_a_statespace_only():
    with pytest.raises(InputError, match=r"expected a control\.StateSpace, found list"):
        loop_from_statespace([[1.0]], rounding="decimal")
