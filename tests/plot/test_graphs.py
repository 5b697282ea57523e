"""Graphs stay readable: arrows for few channels, a matrix with names for many."""

from __future__ import annotations

import pytest

from mcexact.analysis.analyze import analyze
from mcexact.errors import UsageError
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.plot.graphs import LARGEST, MARKED, graph, names_and_edges


def chain(m: int) -> tuple[list[str], list[tuple[str, str]]]:
    names = [f"bus {k + 1}" for k in range(m)]
    return names, [(names[k], names[k + 1]) for k in range(m - 1)]


@pytest.mark.parametrize("m", [1, 2, 8, 10, LARGEST])
def test_few_channels_are_circles_with_their_names(m: int) -> None:
    [axis] = graph(chain(m)).axes
    assert not axis.images and [text.get_text() for text in axis.texts] == chain(m)[0]
    left, right = axis.get_xlim()
    assert all(left <= text.get_position()[0] <= right for text in axis.texts)


@pytest.mark.parametrize("m", [LARGEST + 1, 60])
def test_many_channels_are_a_matrix_whose_lines_are_named(m: int) -> None:
    [axis] = graph(chain(m)).axes
    assert len(axis.images) == 1
    assert [label.get_text() for label in axis.get_xticklabels()] == chain(m)[0]


def test_crowded_arrows_are_a_matrix() -> None:
    names, _ = chain(10)
    every = [(a, b) for a in names for b in names if a != b]
    assert graph((names, every)).axes[0].images and not graph((names, every[:20])).axes[0].images


def test_hundreds_of_channels_have_no_names() -> None:
    [axis] = graph(chain(200)).axes
    assert not axis.get_xticklabels() and "200 channels" in axis.get_xlabel()


def test_graphs_come_from_systems_answers_and_pairs() -> None:
    links = NeighborGraph(("1", "2"), [[1], []])
    plant = gallery.load("liu2020-3ch-augmented-outputs").with_neighbors({"1": ["2"]})
    transfer = analyze(plant).transfer_graph
    assert names_and_edges(links) == (["1", "2"], [("2", "1")])
    assert names_and_edges(plant)[1] == [("2", "1")]
    assert names_and_edges(transfer)[1] == [each for each in transfer.arcs if each[0] != each[1]]
    assert links.plot().axes[0].get_title() == "neighbor graph"
    assert transfer.plot().axes[0].get_title() == "transfer graph"
    with pytest.raises(UsageError, match=r"expected a graph.*found int"):
        graph(3)


def test_an_analysis_shows_both_graphs_with_the_obstruction() -> None:
    plant = gallery.load("liu2020-3ch-augmented-outputs").with_neighbors({"1": ["2"]})
    found = analyze(plant)
    axes = found.plot().axes
    assert [axis.get_title() for axis in axes] == ["neighbor graph", "transfer graph"]
    subset = found.fixed_spectrum.factors[0].channels
    from matplotlib.colors import to_hex

    shown = {
        text.get_text(): to_hex(circle.get_facecolor())
        for text, circle in zip(axes[1].texts, axes[1].patches, strict=False)
    }
    assert {name for name, color in shown.items() if color == MARKED} == set(subset)
