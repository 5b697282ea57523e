"""Directed graphs of channels: circles and arrows if there are few, otherwise a matrix."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from typing import Any

from mcexact.errors import UsageError
from mcexact.plot.canvas import GRAY, cut, empty_figure, one_axis, plain_label, several_axes

MARKED, SENDERS, PLAIN, ADDED = "#d95f02", "#7570b3", "#e8e8e8", "#1f78b4"
_EDGE, _FREE = "#555555", "#f4f4f4"
LARGEST = 16
"""The largest number of channels that are drawn as a circle; more are drawn as a matrix."""
_INSIDE = 8
"""The largest number of channels whose names stand inside their circles."""
_CROWDED = 3
"""More edges for each channel than this make arrows unreadable, beyond `_INSIDE` channels."""
_LABELED = 64

Edge = tuple[str, str]


def graph(
    found: Any,
    ax: Any = None,
    *,
    marked: Collection[str] = (),
    senders: Collection[str] = (),
    added: Collection[Edge] = (),
    title: str | None = None,
) -> Any:
    """Draw a directed graph of channels or agents.

    Parameters
    ----------
    found : NeighborGraph, TransferGraph, system, or (names, edges)
        A neighbor graph, an answer about the transfer graph, a system whose neighbor graph is
        meant, or names with pairs (from, to) of names.
    ax : matplotlib.axes.Axes, optional
        By default those of a new figure.
    marked, senders : collections of str
        Names in orange and in purple, and edges from purple to orange in purple.
    added : collection of (str, str)
        Edges in blue.
    title : str, optional

    Returns
    -------
    matplotlib.figure.Figure

    Notes
    -----
    Up to 16 channels are circles with arrows.  More channels, or crowded arrows, are drawn as a
    matrix with a column for the start and a row for the end of each edge, marked names first.

    Examples
    --------
    >>> figure = graph((["1", "2"], [("1", "2")]), title="one link")
    >>> [text.get_text() for text in figure.axes[0].texts]
    ['1', '2']
    """
    names, edges = names_and_edges(found)
    axis = one_axis(ax, *graph_size(len(names)))
    if title:
        axis.set_title(title, fontsize="medium")
    crowded = len(names) > _INSIDE and len(edges) > _CROWDED * len(names)
    draw = _draw_matrix if len(names) > LARGEST or crowded else _draw_circle
    draw(axis, names, edges, set(marked), set(senders), set(added))
    return axis.figure


def structure(system: Any, fixed: Any, transfer: Any, ax: Any = None) -> Any:
    """Draw the neighbor graph, if there is one, and the transfer graph.

    Parameters
    ----------
    system : MultiChannelSystem
    fixed : FixedSpectrum
        The set s of its first factor is orange, and N_s∖s, from which s receives, is purple.
    transfer : TransferGraph
    ax : axes of matplotlib, optional
        One for each graph; by default those of a new figure.

    Returns
    -------
    matplotlib.figure.Figure
    """
    marked = set(fixed.factors[0].channels) if fixed.factors else set()
    senders: set[str] = set()
    panels = [("transfer graph", transfer)]
    if system.neighbors is not None:
        panels.insert(0, ("neighbor graph", system.neighbors))
        if marked:
            inside = [system.names.index(name) for name in marked]
            senders = set(system.named(system.neighbors.union(inside))) - marked
    if ax is None:
        width, height = graph_size(system.m)
        ax = empty_figure(width * len(panels), height).subplots(1, len(panels), squeeze=False)
    axes = several_axes(ax, len(panels))
    for axis, (title, found) in zip(axes, panels, strict=True):
        graph(found, axis, marked=marked, senders=senders, title=title)
    return axes[0].figure


def graph_size(channels: int) -> tuple[float, float]:
    """The size of the picture of one graph in inches; a matrix of many channels is larger."""
    if channels <= LARGEST:
        return 4.4, 4.0
    side = max(4.4, min(0.16 * channels, 9.0))
    return side, side


def names_and_edges(found: Any) -> tuple[list[str], list[Edge]]:
    """Return the names of a graph, and its edges between different names.

    Raises
    ------
    UsageError
        If the object has no graph.
    """
    if hasattr(found, "arcs") and hasattr(found, "about"):
        names, edges = found.about.names, found.arcs
    elif hasattr(found, "edges") and hasattr(found, "names"):
        names = found.names
        edges = [(names[j], names[i]) for j, i in found.edges()]
    elif getattr(found, "neighbors", None) is not None:
        return names_and_edges(found.neighbors)
    elif isinstance(found, tuple) and len(found) == 2:
        names, edges = found
    else:
        raise UsageError(
            "expected a graph, a system with neighbors, or names and edges; found "
            f"{type(found).__name__}"
        )
    return list(names), [(start, end) for start, end in edges if start != end]


def _draw_circle(
    axis: Any,
    names: Sequence[str],
    edges: Sequence[Edge],
    marked: set[str],
    senders: set[str],
    added: set[Edge],
) -> None:
    """Draw channels on a circle, with bent edges so that both directions are visible."""
    from matplotlib.patches import Circle, FancyArrowPatch

    axis.set_aspect("equal")
    axis.set_axis_off()
    m = len(names)
    inside = m <= _INSIDE and max(map(len, names), default=0) <= 6
    size = 0.2 if m <= _INSIDE else 0.09
    turn = [math.pi / 2 - 2 * math.pi * k / m for k in range(m)]
    radius = 1.0 if m > 1 else 0.0
    place = {
        name: (radius * math.cos(a), radius * math.sin(a))
        for name, a in zip(names, turn, strict=True)
    }
    room = 0.4 if inside else 0.75
    for limits, k in ((axis.set_xlim, 0), (axis.set_ylim, 1)):
        ends = [at[k] for at in place.values()] or [0.0]
        limits(min(ends) - room, max(ends) + room)
    circle = {}
    for (name, at), a in zip(place.items(), turn, strict=True):
        color = MARKED if name in marked else SENDERS if name in senders else PLAIN
        circle[name] = Circle(at, size, facecolor=color, edgecolor="#333333", zorder=3)
        axis.add_patch(circle[name])
        if inside:
            ink = "white" if color != PLAIN else "black"
            axis.text(*at, name, ha="center", va="center", color=ink, zorder=4, parse_math=False)
        else:
            x, y = (c + (size + 0.06) * f(a) for c, f in zip(at, (math.cos, math.sin), strict=True))
            side = "left" if math.cos(a) > 0.2 else "right" if math.cos(a) < -0.2 else "center"
            above = "bottom" if math.sin(a) > 0.9 else "top" if math.sin(a) < -0.9 else "center"
            axis.text(x, y, cut(name, 12), ha=side, va=above, fontsize="small", parse_math=False)
    for start, end in edges:
        color = SENDERS if start in senders and end in marked else _EDGE
        axis.add_patch(
            FancyArrowPatch(
                place[start],
                place[end],
                patchA=circle[start],
                patchB=circle[end],
                shrinkA=1,
                shrinkB=1,
                connectionstyle="arc3,rad=0.14",
                arrowstyle="-|>",
                mutation_scale=14 if m <= _INSIDE else 9,
                color=ADDED if (start, end) in added else color,
                linewidth=(1.2 if m <= _INSIDE else 0.8) + ((start, end) in added),
            )
        )


def _draw_matrix(
    axis: Any,
    names: Sequence[str],
    edges: Sequence[Edge],
    marked: set[str],
    senders: set[str],
    added: set[Edge],
) -> None:
    """Draw a matrix with a column for the start and a row for the end of each edge.

    The marked channels come first, then the senders; the diagonal is gray.
    """
    from matplotlib.colors import to_rgb

    axis.set_aspect("equal")
    ordered = sorted(names, key=lambda name: (name not in marked, name not in senders))
    place = {name: k for k, name in enumerate(ordered)}
    empty = {name: to_rgb("#fbe3cf" if name in marked else _FREE) for name in names}
    cells = [[empty[row]] * len(names) for row in ordered]
    for k in range(len(names)):
        cells[k][k] = to_rgb("#d8d8d8")
    for start, end in edges:
        color = _EDGE
        if end in marked:
            color = MARKED if start in marked else SENDERS if start in senders else color
        color = ADDED if (start, end) in added else color
        cells[place[end]][place[start]] = to_rgb(color)
    axis.imshow(cells, interpolation="nearest")
    axis.set_xticks([])
    axis.set_yticks([])
    if len(names) <= _LABELED:
        small = 7.0 if len(names) <= 30 else 5.0
        labels = [plain_label(name, 10) for name in ordered]
        positions = range(len(ordered))
        axis.set_xticks(positions, labels, rotation=90, fontsize=small)
        axis.set_yticks(positions, labels, fontsize=small)
        axis.tick_params(length=0)
        edges_of_cells = [k - 0.5 for k in range(1, len(names))]
        for line in (axis.axvline, axis.axhline):
            for at in edges_of_cells:
                line(at, color="white", linewidth=0.5)
    for spine in axis.spines.values():
        spine.set_color(GRAY)
    axis.set_xlabel(f"from each of {len(names)} channels", fontsize="small")
    axis.set_ylabel(f"to each: {len(edges)} edges", fontsize="small")
