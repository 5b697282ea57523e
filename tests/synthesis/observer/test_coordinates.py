"""The coordinates in which an observer's loop is block upper triangular."""

from fractions import Fraction

import pytest

from mcexact.exact.matrix import Matrix
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.distributed_observer import design_observer
from mcexact.synthesis.observer import observer_coordinates
from tests.synthesis.three_channels import three_channels


def separation(M, n, controller):
    """The first that there is."""
    found = (each.separation(M) for each in observer_coordinates(n, controller))
    return next(filter(None, found), None)


@pytest.mark.parametrize(
    ("options", "sizes"),
    [
        ({"rate": 1, "arithmetic": "float"}, (3, 9)),
        ({"rate": 1, "arithmetic": "float", "agent": "3"}, (3, 9, 9)),
        ({"rate": 1}, (3, 11)),
    ],
)
def test_the_blocks_are_feedback_errors_and_their_observer(options, sizes):
    plant = three_channels()
    design = design_observer(plant, **options)
    M = design.loop.matrix
    found = separation(M, plant.n, design.controller)
    assert found is not None and found.sizes == sizes
    assert M @ found.T == found.T @ found.Delta
    closed = plant.A
    for i, F in enumerate(design.parts["feedback"]):
        closed = closed + plant.B(i) @ F
    assert found.blocks()[0] == closed


def test_any_other_loop_does_not_separate():
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    alone = AgentProgram("1", 0, 1, input=LinearMap({0: Matrix.from_rows([[-3]])}))
    static = Controller("continuous", "", (alone,))
    assert separation(closed_loop(plant, static).matrix, 1, static) is None
    # An estimate that is driven by something else than the error is no observer.
    estimate = AgentProgram(
        "1",
        1,
        0,
        LinearMap({0: Matrix.from_rows([[1]])}, {0: Matrix.from_rows([[-5]])}),
        input=LinearMap(shared={0: Matrix.from_rows([[Fraction(-2)]])}),
    )
    other = Controller("continuous", "", (estimate,))
    assert separation(closed_loop(plant, other).matrix, 1, other) is None
