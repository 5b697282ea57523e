"""Pictures of neighbor and transfer graphs with a colored obstruction, and of dimensions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from mcexact.answer.account import Account
from mcexact.report.picture import Picture, empty_figure

MARKED, SENDERS, PLAIN = "#d95f02", "#7570b3", "#e8e8e8"
LARGEST = 24
"""The largest number of channels that are drawn as a circle; more are drawn as a matrix."""

LEAST = {
    "outputs+states": "minimal_shared_dimensions_outputs_states",
    "states": "minimal_shared_dimensions_states",
}
"""The question about each way of sharing."""
_BOUNDS = {
    "outputs+states": "shared_dimension_bound_outputs_states",
    "states": "shared_dimension_bound_states",
}
_SHARING = ("sufficient to share", "least to share")

Edge = tuple[str, str]


def graph_picture(account: Account) -> Picture:
    """Draw the neighbor graph, if there is one, and the transfer graph.

    Parameters
    ----------
    account : Account
        An account with the transfer graph and the fixed spectrum; the set s of its first factor is
        colored, and so is N_s∖s, from which s receives.
    """
    system, said = account.given.system, account.sentences
    fixed, transfer = account.answers["fixed_spectrum"], account.answers["transfer_graph"]
    names, graph = system.names, system.neighbors
    subset = set(fixed.factors[0].channels) if fixed.factors else set()
    boundary: set[str] = set()
    panels: list[tuple[str, list[Edge]]] = []
    if graph is not None:
        inside = [names.index(name) for name in subset]
        boundary = set(system.named(graph.union(inside))) - subset if subset else set()
        edges = [(names[j], names[i]) for j, i in graph.edges()]
        panels.append(("neighbor graph", edges))
    panels.append(("transfer graph", [edge for edge in transfer.arcs if edge[0] != edge[1]]))
    figure = empty_figure(4.2 * len(panels), 3.9)
    for axis, (title, edges) in zip(
        figure.subplots(1, len(panels), squeeze=False)[0], panels, strict=True
    ):
        _draw(axis, title, names, edges, subset, boundary)
    caption = "; ".join(said.at("graphs")) + "."
    return Picture(figure, "".join(said.at("graphs.title")), caption)


def _draw(
    axis: Any,
    title: str,
    names: Sequence[str],
    edges: Sequence[Edge],
    subset: set[str],
    boundary: set[str],
) -> None:
    """Draw channels on a circle, with bent edges so that both directions are visible."""
    from matplotlib.patches import Circle, FancyArrowPatch

    axis.set_title(title, fontsize="medium")
    axis.set_aspect("equal")
    m = len(names)
    if m > LARGEST:
        _draw_matrix(axis, names, edges, subset, boundary)
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
    for start, end in edges:
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
    axis: Any, names: Sequence[str], edges: Sequence[Edge], subset: set[str], boundary: set[str]
) -> None:
    """Draw a matrix with a column for the start and a row for the end of each edge.

    The obstruction comes first, then the agents from which it receives; the other agents form an
    empty block.
    """
    from matplotlib.colors import to_rgb

    ordered = sorted(names, key=lambda name: (name not in subset, name not in boundary))
    place = {name: k for k, name in enumerate(ordered)}
    empty = {name: to_rgb("#fbe3cf" if name in subset else "#f4f4f4") for name in names}
    cells = [[empty[row]] * len(names) for row in ordered]
    for start, end in edges:
        color = "#555555"
        if end in subset:
            color = MARKED if start in subset else SENDERS if start in boundary else color
        cells[place[end]][place[start]] = to_rgb(color)
    axis.imshow(cells, interpolation="nearest")
    axis.set_xticks([])
    axis.set_yticks([])
    axis.set_xlabel(f"from each of {len(names)} channels", fontsize="small")
    axis.set_ylabel(f"to each: {len(edges)} edges", fontsize="small")


def dimensions_picture(account: Account) -> Picture:
    """Draw bars for every agent: the least dimensions for each way of sharing, and the bound.

    Parameters
    ----------
    account : Account
        An account with the least dimensions for some way of sharing.
    """
    names, said, answers = account.given.names, account.sentences, account.answers
    least = {share: answers[name] for share, name in LEAST.items() if name in answers}
    told = [each for each in said.at("table") if each.template.label in _SHARING]
    read = {file for each in told for file, *_ in each.because}
    holds = any(file.startswith("shared_dimension_bound") for file in read)
    figure = empty_figure(4.4 * len(least), 3.2)
    for axis, (share, found) in zip(
        figure.subplots(1, len(least), squeeze=False)[0], least.items(), strict=True
    ):
        sizes = (0,) * len(names) if found.dimensions is None else found.dimensions
        places = range(len(names))
        bound = answers[_BOUNDS[share]].deficiency if holds else None
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
    caption = "; ".join(each.line for each in told) + "."
    return Picture(figure, "".join(said.at("dimensions.title")), caption)
