"""Gains as a matrix: every entry of a controller is in its cell."""

from __future__ import annotations

from mcexact.exact.matrix import Matrix
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.plot.graphs import gains


def texts(figure: object) -> dict[tuple[int, int], str]:
    """What is written into the cells, keyed by row and column."""
    [axis] = figure.axes  # type: ignore[attr-defined]
    found = {}
    for text in axis.texts:
        column, row = text.get_position()
        found[row, column] = text.get_text()
    return found


def test_static_gains_are_on_the_diagonal() -> None:
    plant = MultiChannelSystem([[1]], [[[1]]] * 2, [[[1]]] * 2)
    controller = local_controllers(plant, [[[-3]], [["1/8"]]])
    figure = controller.plot()
    assert texts(figure) == {(0, 0): "-3", (1, 1): "0.125"}
    [axis] = figure.axes
    image = axis.images[0].get_array()
    assert image[0, 0] == -1 and image[0, 1] == 0 and 0 < image[1, 1] < 1
    assert [label.get_text() for label in axis.get_xticklabels()] == ["y 1", "y 2"]
    assert "largest 3" in axis.get_title()


def test_updates_and_all_signals_have_blocks() -> None:
    one, two = Matrix.from_rows([[1]]), Matrix.from_rows([[2], [3]])
    first = AgentProgram(
        "a",
        1,
        2,
        shared_update=LinearMap({0: one}, {1: one * 5}),
        private_update=LinearMap({0: two}, private=Matrix.identity(2) * 7, reference=two * -1),
        input=LinearMap(private=Matrix.from_rows([[8, 9]])),
    )
    second = AgentProgram("b", 1, 0, shared_update=LinearMap(shared={1: one * 6}))
    [axis] = gains(Controller("discrete", "", (first, second))).axes
    columns = [label.get_text() for label in axis.get_xticklabels()]
    rows = [label.get_text() for label in axis.get_yticklabels()]
    assert columns == ["y a", "x b", "z a", "r a"]
    assert rows == ["u a", "x a", "z a", "x b"]
    assert texts(axis.figure) == {
        (0, 2): "8", (0, 3): "9",
        (1, 0): "1", (1, 1): "5",
        (2, 0): "2", (2, 2): "7", (2, 4): "-2",
        (3, 0): "3", (3, 3): "7", (3, 4): "-3",
        (4, 1): "6",
    }  # fmt: skip


def test_a_controller_without_gains_is_drawn() -> None:
    empty = Controller("discrete", "", (AgentProgram("1", 0, 0),))
    assert "gains" in gains(empty).axes[0].get_title()
