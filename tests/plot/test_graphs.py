"""Graphs stay readable: arrows for few channels, a matrix with names for many."""

from __future__ import annotations

from typing import Any

import pytest

from mcexact.analysis.analyze import analyze
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.errors import UsageError
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.plot.graphs import ADDED, LARGEST, MARKED, fixed_mode, graph, names_and_edges
from mcexact.report.pages import account_page


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
    assert names_and_edges(transfer)[1] == list(transfer.arcs)
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


def test_a_channel_that_hears_itself_has_a_loop() -> None:
    from matplotlib.patches import FancyArrowPatch

    def arrows(edges: list[tuple[str, str]]) -> int:
        [axis] = graph((["1", "2"], edges)).axes
        return sum(isinstance(each, FancyArrowPatch) for each in axis.patches)

    assert arrows([("1", "2"), ("1", "1"), ("2", "2")]) == 3 and arrows([("1", "2")]) == 1
    names, _ = chain(LARGEST + 1)
    [axis] = graph((names, [(names[0], names[0])])).axes
    image = axis.images[0].get_array()
    assert image[0][0].sum() < image[1][1].sum() and "0 edges" in axis.get_ylabel()


def drawn_mode(plant: MultiChannelSystem, **options: Any) -> tuple[list[str], list[str]]:
    """The texts of the picture, and the colors of its arrows."""
    from matplotlib.colors import to_hex
    from matplotlib.patches import FancyArrowPatch

    [axis] = fixed_mode(fixed_spectrum(plant), **options).axes
    arrows = [each for each in axis.patches if isinstance(each, FancyArrowPatch)]
    return [each.get_text() for each in axis.texts], [to_hex(a.get_edgecolor()) for a in arrows]


def beside(m: int, acting: int, measuring: range) -> MultiChannelSystem:
    """A plant of m channels with a state each, and a mode 1 that some move and others measure."""
    A = [[(k - m if k < m else 1) * (k == r) for k in range(m + 1)] for r in range(m + 1)]
    B = [[[int(r == k or (r == m and k < acting))] for r in range(m + 1)] for k in range(m)]
    C = [[[int(r == k or (r == m and k in measuring)) for r in range(m + 1)]] for k in range(m)]
    return MultiChannelSystem(A, B, C)


def test_a_fixed_mode_stands_between_its_channels() -> None:
    texts, arrows = drawn_mode(beside(4, 2, range(2, 3)))
    assert texts == ["1", "2", "4", "do not observe it", "3", "do not control it", "1"]
    # channels 1 and 2 move it, channel 3 measures it, and channel 4 does neither
    assert len(arrows) == 3 and ADDED not in arrows
    assert drawn_mode(beside(4, 2, range(2, 3)), links=[("3", "1")])[1].count(ADDED) == 1
    many, arrows = drawn_mode(beside(LARGEST + 1, 5, range(5, 9)), links=[("7", "1"), ("8", "1")])
    assert many[0] == "13 channels" and many[2] == "4 channels" and arrows.count(ADDED) == 1


def test_a_mode_that_nobody_moves_has_one_side_and_conjugates_share_a_line() -> None:
    plant = MultiChannelSystem(
        [[0, 1, 0], [-1, 0, 0], [0, 0, -3]],
        [[[0], [0], [1]]],
        [[[1, 0, 1]]],
        names=["the tank"],
    )
    texts, arrows = drawn_mode(plant)
    assert texts == ["the tank", "do not control it", "± 1i"] and len(arrows) == 1
    with pytest.raises(UsageError) as refused:
        fixed_mode(fixed_spectrum(gallery.load("compleib-ac1")))
    assert refused.value.where == "found"


def test_the_page_of_an_analysis_draws_the_mode_and_the_link_that_helps() -> None:
    plant = gallery.load("hidden-triple-mode")
    picture, *others = account_page(analyze(plant).account).pictures
    assert picture.title == "Fixed mode" and "u2 → u1" in picture.alternative and others
    free = account_page(analyze(gallery.load("compleib-ac1")).account).pictures
    assert free and all(each.title != "Fixed mode" for each in free)
