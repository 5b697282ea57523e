"""Neighbor and transfer graphs with the channels of an obstruction colored; shared dimensions."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from mcexact.analysis.fixed_spectrum import fixed_spectrum
from mcexact.analysis.transfer_graph import TransferGraph, transfer_graph
from mcexact.answer.fixed_spectrum import FixedSpectrum
from mcexact.answer.wording import details as say
from mcexact.report.picture import Picture, empty_figure

if TYPE_CHECKING:
    from mcexact.analysis.allocation import SharedDimensionBound, SharedDimensions
    from mcexact.derived.extended import Share
    from mcexact.model.system import MultiChannelSystem

MARKED, SENDERS, PLAIN = "#d95f02", "#7570b3", "#e8e8e8"
LARGEST = 24
"""Channels beyond which circles and arrows say nothing any more: a matrix is drawn instead."""

Arc = tuple[str, str]


def graph_picture(
    system: MultiChannelSystem,
    *,
    fixed: FixedSpectrum | None = None,
    transfer: TransferGraph | None = None,
    information: str = "own",
) -> Picture:
    """Draw the neighbor graph, where there is one, beside the transfer graph.

    Parameters
    ----------
    system : MultiChannelSystem
    fixed : FixedSpectrum, optional
        Its first factor's channels s are colored, and so is N_s∖s, whom s hears; decided here if it
        is not given.
    transfer : TransferGraph, optional
    information : {"own", "outputs"}
        What the fixed spectrum is about; for the caption.
    """
    fixed = fixed_spectrum(system) if fixed is None else fixed
    transfer = transfer_graph(system) if transfer is None else transfer
    names, graph = system.names, system.neighbors
    subset = set() if fixed.empty else set(fixed.factors[0].channels)
    boundary: set[str] = set()
    panels: list[tuple[str, list[Arc]]] = []
    if graph is not None:
        inside = [names.index(name) for name in subset]
        boundary = set(system.named(graph.union(inside))) - subset if subset else set()
        arcs = [(names[j], names[i]) for j, i in graph.edges()]
        panels.append(("neighbor graph", arcs))
    panels.append(("transfer graph", [arc for arc in transfer.arcs if arc[0] != arc[1]]))
    figure = empty_figure(4.2 * len(panels), 3.9)
    for axis, (title, arcs) in zip(
        figure.subplots(1, len(panels), squeeze=False)[0], panels, strict=True
    ):
        _draw(axis, title, names, arcs, subset, boundary)
    words = [say.PICTURE_TRANSFER(arcs=panels[-1][1])]
    if graph is not None:
        words.insert(0, say.PICTURE_NEIGHBORS(arcs=panels[0][1]))
    if subset:
        s = sorted(subset, key=names.index)
        words.append(say.PICTURE_OBSTRUCTION(s=s, p=fixed.factors[0].polynomial))
        if boundary:
            heard = sorted(boundary, key=names.index)
            words.append(say.PICTURE_HEARD(s=s, heard=heard))
    title = say.PICTURE_OUTPUTS() if information == "outputs" else say.PICTURE()
    return Picture(figure, title, "; ".join(words) + ".")


def _draw(
    axis: Any,
    title: str,
    names: Sequence[str],
    arcs: Sequence[Arc],
    subset: set[str],
    boundary: set[str],
) -> None:
    """Channels on a circle, arcs bent so that both directions are seen."""
    from matplotlib.patches import Circle, FancyArrowPatch

    axis.set_title(title, fontsize="medium")
    axis.set_aspect("equal")
    m = len(names)
    if m > LARGEST:
        _draw_matrix(axis, names, arcs, subset, boundary)
        return
    axis.set_axis_off()
    size = 0.2 if m <= 8 else 0.1
    turn = [math.pi / 2 - 2 * math.pi * k / m for k in range(m)]
    radius = 1.0 if m > 1 else 0.0
    place = {
        name: (radius * math.cos(a), radius * math.sin(a))
        for name, a in zip(names, turn, strict=True)
    }
    axis.set_xlim(min(x for x, _ in place.values()) - 0.4, max(x for x, _ in place.values()) + 0.4)
    axis.set_ylim(min(y for _, y in place.values()) - 0.4, max(y for _, y in place.values()) + 0.4)
    circle = {}
    for name, at in place.items():
        color = MARKED if name in subset else SENDERS if name in boundary else PLAIN
        circle[name] = Circle(at, size, facecolor=color, edgecolor="#333333", zorder=3)
        axis.add_patch(circle[name])
        text = name if len(name) <= 6 else name[:5] + "…"
        ink = "white" if color != PLAIN else "black"
        axis.text(*at, text, ha="center", va="center", color=ink, zorder=4, parse_math=False)
    for start, end in arcs:
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
                mutation_scale=14,
                color=SENDERS if start in boundary and end in subset else "#555555",
                linewidth=1.2,
            )
        )


def _draw_matrix(
    axis: Any, names: Sequence[str], arcs: Sequence[Arc], subset: set[str], boundary: set[str]
) -> None:
    """A column for the channel where an arc starts, a row for the one where it ends.

    The obstruction comes first, then whom it hears: what it does not hear is an empty block.
    """
    from matplotlib.colors import to_rgb

    ordered = sorted(names, key=lambda name: (name not in subset, name not in boundary))
    place = {name: k for k, name in enumerate(ordered)}
    empty = {name: to_rgb("#fbe3cf" if name in subset else "#f4f4f4") for name in names}
    cells = [[empty[row]] * len(names) for row in ordered]
    for start, end in arcs:
        color = "#555555"
        if end in subset:
            color = MARKED if start in subset else SENDERS if start in boundary else color
        cells[place[end]][place[start]] = to_rgb(color)
    axis.imshow(cells, interpolation="nearest")
    axis.set_xticks([])
    axis.set_yticks([])
    axis.set_xlabel(f"from each of {len(names)} channels", fontsize="small")
    axis.set_ylabel(f"to each: {len(arcs)} arcs", fontsize="small")


def dimensions_picture(
    system: MultiChannelSystem,
    least: Mapping[Share, SharedDimensions],
    bounds: Mapping[Share, SharedDimensionBound] | None = None,
) -> Picture:
    """Bars for every agent: the least for each way of sharing, beside the bound where it holds.

    Parameters
    ----------
    system : MultiChannelSystem
    least : mapping from the way of sharing to the answer
    bounds : mapping from the way of sharing to the answer, optional
        For a plant that meets the hypotheses of Theorem 2.
    """
    names = system.names
    figure = empty_figure(4.4 * len(least), 3.2)
    words = []
    for axis, (share, found) in zip(
        figure.subplots(1, len(least), squeeze=False)[0], least.items(), strict=True
    ):
        sizes = (0,) * len(names) if found.dimensions is None else found.dimensions
        places = range(len(names))
        bound = None if bounds is None else bounds[share].per_agent
        if bound is not None:
            axis.bar(
                [k - 0.2 for k in places],
                [bound] * len(names),
                0.4,
                color="#bbbbbb",
                label="bound of the paper",
            )
        axis.bar([k + 0.2 for k in places], sizes, 0.4, color=MARKED, label="least")
        axis.set_xticks(list(places), names, parse_math=False)
        axis.set_yticks(range(max(bound or 0, *sizes, 1) + 1))
        axis.set_xlabel("agent")
        axis.set_ylabel("shared dimension")
        axis.set_title(share, fontsize="medium")
        axis.legend(fontsize="small", loc="upper center")
        axis.margins(y=0.35)
        alone, beside, nothing = say.PICTURE_LEAST[share]
        if found.dimensions is None:
            words.append(nothing())
        else:
            told = alone if bound is None else beside
            words.append(told(sizes=found.dimensions, bound=bound))
    return Picture(figure, say.PICTURE_DIMENSIONS(), "; ".join(words) + ".")
