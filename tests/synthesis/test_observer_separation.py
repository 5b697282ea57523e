"""The coordinates in which an observer's loop is block upper triangular."""

from fractions import Fraction

import pytest

from mcexact.exact.matrix import Matrix
from mcexact.model.closed_loop import closed_loop_matrix
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.observer import design_observer
from mcexact.synthesis.observer_separation import observer_separation
from tests.synthesis.three_channels import three_channels


@pytest.mark.parametrize(
    ("options", "sizes"),
    [
        ({"rate": 1, "arithmetic": "float"}, (3, 9, 9)),
        ({"rate": 1, "arithmetic": "float", "q": "3"}, (3, 9, 9)),
        ({"rate": 1}, (3, 11)),
    ],
)
def test_the_blocks_are_feedback_errors_and_their_observer(options, sizes):
    plant = three_channels()
    design = design_observer(plant, **options)
    M = design.loop.matrix
    found = observer_separation(M, plant.n, design.controller)
    assert found.sizes == sizes
    assert M @ found.T == found.T @ found.Delta
    inputs = [design.feedback[i] for i in range(3)] if len(sizes) == 3 else design.feedback.gains
    closed = plant.A
    for i, F in enumerate(inputs):
        closed = closed + plant.B(i) @ F
    assert found.blocks()[0] == closed


def test_any_other_loop_does_not_separate():
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    alone = AgentProgram("1", 0, 1, input=LinearMap({0: Matrix.from_rows([[-3]])}))
    static = Controller("continuous", "", (alone,))
    assert observer_separation(closed_loop_matrix(plant, static), 1, static) is None
    # An estimate that is driven by something else than the error is no observer.
    estimate = AgentProgram(
        "1",
        1,
        0,
        LinearMap({0: Matrix.from_rows([[1]])}, {0: Matrix.from_rows([[-5]])}),
        input=LinearMap(shared={0: Matrix.from_rows([[Fraction(-2)]])}),
    )
    other = Controller("continuous", "", (estimate,))
    assert observer_separation(closed_loop_matrix(plant, other), 1, other) is None
