"""Graphs too large for circles and arrows are matrices with a cell for every arc."""

from matplotlib.colors import to_hex

from mcexact.analysis.analyze import analyze
from mcexact.derived.drawn.systems import Draw, drawn_system
from mcexact.plot.graphs import LARGEST, MARKED, SENDERS
from mcexact.report.figures import graph_pictures


def test_a_large_graph_is_a_matrix_with_the_obstruction_first() -> None:
    m = LARGEST + 2
    system = drawn_system(Draw(3, states=8, channels=m, fixed_degree=1, neighbors=True))
    found = analyze(system, ["fixed_spectrum", "transfer_graph"])
    subset = found.fixed_spectrum.factors[0].channels
    [neighbors], [transfer] = (each.figure.axes for each in graph_pictures(found.account))
    [image] = neighbors.images
    colors = [[to_hex(cell) for cell in row] for row in image.get_array()]
    assert len(colors) == m and system.neighbors is not None
    arcs = len(system.neighbors.edges())
    empty = {"#fbe3cf", "#f4f4f4", "#d8d8d8"}
    assert sum(cell not in empty for row in colors for cell in row) == arcs
    k = len(subset)
    assert {cell for row in colors[k:] for cell in row} <= {"#f4f4f4", "#d8d8d8", "#555555"}
    assert {cell for row in colors[:k] for cell in row[:k]} <= {"#fbe3cf", "#d8d8d8", MARKED}
    heard = {cell for row in colors[:k] for cell in row[k:]}
    assert SENDERS in heard and MARKED not in heard
    assert transfer.get_title() == "transfer graph" and len(transfer.images) == 1


def test_a_small_graph_has_a_circle_for_every_channel() -> None:
    system = drawn_system(Draw(3, states=4, channels=3))
    [picture] = graph_pictures(analyze(system).account)
    [axis] = picture.figure.axes
    assert not axis.images and len(axis.texts) == 3
