"""Directed graphs, and the gains of a controller as a matrix.

`graph` draws up to 16 channels as circles with arrows; more channels, or crowded arrows, become a
matrix with a cell for each edge.  `structure` draws the neighbor graph and the transfer graph
beside each other, and `fixed_mode` a mode between the channels that control it and those that
observe it.  `gains` draws every entry of a controller's programs as a colored cell.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from typing import Any

from mcexact.errors import UsageError
from mcexact.exact.linear_algebra import nullspace
from mcexact.exact.matrix import Matrix, to_float
from mcexact.plot.canvas import (
    GRAY,
    ON_DARK,
    ON_LIGHT,
    RED,
    cut,
    empty_figure,
    one_axis,
    plain_label,
    several_axes,
)

# Directed graphs of channels.

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
    between = [edge for edge in edges if edge[0] != edge[1]]
    crowded = len(names) > _INSIDE and len(between) > _CROWDED * len(names)
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
    for axis, (title, directed) in zip(axes, panels, strict=True):
        graph(directed, axis, marked=marked, senders=senders, title=title)
    return axes[0].figure


def graph_size(channels: int) -> tuple[float, float]:
    """The size of the picture of one graph in inches; a matrix of many channels is larger."""
    if channels <= LARGEST:
        return 4.4, 4.0
    side = max(4.4, min(0.16 * channels, 9.0))
    return side, side


def names_and_edges(source: Any) -> tuple[list[str], list[Edge]]:
    """Return the names of a graph, and its edges, loops among them.

    Raises
    ------
    UsageError
        If the object has no graph.
    """
    if hasattr(source, "arcs") and hasattr(source, "about"):
        names, edges = source.about.names, source.arcs
    elif hasattr(source, "edges") and hasattr(source, "names"):
        names = source.names
        edges = [(names[j], names[i]) for j, i in source.edges()]
    elif getattr(source, "neighbors", None) is not None:
        return names_and_edges(source.neighbors)
    elif isinstance(source, tuple) and len(source) == 2:
        names, edges = source
    else:
        raise UsageError(
            "expected a graph, a system with neighbors, or names and edges; found "
            f"{type(source).__name__}"
        )
    return list(names), [(start, end) for start, end in edges]


def _draw_circle(
    axis: Any,
    names: Sequence[str],
    edges: Sequence[Edge],
    marked: set[str],
    senders: set[str],
    added: set[Edge],
) -> None:
    """Draw channels on a circle, with bent edges so that both directions are visible."""
    from matplotlib.patches import Circle

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
            ink = ON_DARK if color != PLAIN else "black"
            axis.text(*at, name, ha="center", va="center", color=ink, zorder=4, parse_math=False)
        else:
            x, y = (c + (size + 0.06) * f(a) for c, f in zip(at, (math.cos, math.sin), strict=True))
            side = "left" if math.cos(a) > 0.2 else "right" if math.cos(a) < -0.2 else "center"
            above = "bottom" if math.sin(a) > 0.9 else "top" if math.sin(a) < -0.9 else "center"
            axis.text(x, y, cut(name, 12), ha=side, va=above, fontsize="small", parse_math=False)
    for start, end in edges:
        color = SENDERS if start in senders and end in marked else _EDGE
        if start == end:
            _draw_loop(axis, place[start], size, turn[names.index(start)])
            continue
        if (start, end) in added:
            color = ADDED
        _draw_arrow(axis, circle[start], circle[end], color, bend=0.14, large=m <= _INSIDE)


def _draw_arrow(
    axis: Any, start: Any, end: Any, color: str, *, bend: float = 0.0, large: bool = True
) -> None:
    """Draw an arrow from one circle to another; the blue ones are thicker."""
    from matplotlib.patches import FancyArrowPatch

    axis.add_patch(
        FancyArrowPatch(
            start.center,
            end.center,
            patchA=start,
            patchB=end,
            shrinkA=1,
            shrinkB=1,
            connectionstyle=f"arc3,rad={bend}",
            arrowstyle="-|>",
            mutation_scale=14 if large else 9,
            color=color,
            linewidth=(1.2 if large else 0.8) + (color == ADDED),
        )
    )


def _draw_loop(axis: Any, at: tuple[float, float], size: float, outward: float) -> None:
    """Draw an arrow from a circle to itself, on the side away from the others."""
    from matplotlib.patches import FancyArrowPatch

    ends = [
        (at[0] + size * math.cos(outward + side), at[1] + size * math.sin(outward + side))
        for side in (0.6, -0.6)
    ]
    large = size > 0.1
    axis.add_patch(
        FancyArrowPatch(
            *ends,
            shrinkA=0,
            shrinkB=0,
            connectionstyle="arc3,rad=-1.5",
            arrowstyle="-|>",
            mutation_scale=10 if large else 6,
            color=_EDGE,
            linewidth=1.2 if large else 0.8,
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

    The marked channels come first, then the senders; the diagonal is gray, darker for a loop.
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
        if start == end:
            cells[place[end]][place[start]] = to_rgb("#a8a8a8")
            continue
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
    between = sum(start != end for start, end in edges)
    axis.set_ylabel(f"to each: {between} edges", fontsize="small")


# A fixed mode between the channels that act on it and those that see it.

_MOST_STATES = 100
"""The largest number of states for which single channels are told apart beside a fixed mode."""
_WORDS = 1.15
"""How high the words above both columns stand."""


def fixed_mode(
    found: Any, ax: Any = None, *, links: Collection[Edge] = (), title: str | None = None
) -> Any:
    """Draw a fixed mode between channels that do not observe it and others that do not control it.

    Parameters
    ----------
    found : FixedSpectrum
        With a fixed mode, of which the first is drawn.
    ax : matplotlib.axes.Axes, optional
        By default those of a new figure.
    links : collection of (str, str)
        Links that would help, in blue, such as `minimal_communication` finds.
    title : str, optional

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    UsageError
        If no mode is fixed.

    Notes
    -----
    On the left stands the set s, whose channels do not observe the mode, on the right are the
    others, which do not control it.  An arrow leads from each channel of s whose inputs act on the
    mode, and one to each other channel whose outputs show it; both are computed from the null
    spaces of p(A) and its transpose over the rationals, p the polynomial of the mode.  Of more than
    16 channels or 100 states each side is drawn as one circle.

    Examples
    --------
    >>> import mcexact
    >>> found = mcexact.fixed_spectrum(mcexact.gallery("hidden-triple-mode"))
    >>> figure = fixed_mode(found, links=[("u2", "u1")])
    >>> [text.get_text() for text in figure.axes[0].texts]
    ['u1', 'do not observe it', 'u2', 'do not control it', '1']
    """
    from matplotlib.patches import Circle

    if not found.factors:
        raise UsageError("no mode is fixed, so there is none to draw", where="found")
    factor, system = found.factors[0], found.about
    axis = one_axis(ax, 4.4, 3.4)
    axis.set_aspect("equal")
    axis.set_axis_off()
    axis.set_xlim(-1.8, 1.8)
    axis.set_ylim(-1.2, 1.4)
    if title:
        axis.set_title(title, fontsize="medium")
    left = [name for name in system.names if name in factor.channels]
    right = [name for name in system.names if name not in factor.channels]
    if system.m > LARGEST or system.n > _MOST_STATES:
        left, right = _as_one(left), _as_one(right)
        acting, showing = set(left), set(right)
        links = [(right[0], left[0])] if links else []
    else:
        acting, showing = _acting_and_showing(system, factor.polynomial)
    circle = _draw_column(axis, left, -1.0, "do not observe it", MARKED)
    circle |= _draw_column(axis, right, 1.0, "do not control it", PLAIN)
    mode = Circle((0, 0), 0.32, facecolor=RED, edgecolor="#333333", zorder=3)
    axis.add_patch(mode)
    axis.text(0, 0, _roots(factor), ha="center", va="center", color=ON_DARK, zorder=4)
    for name in left:
        if name in acting:
            _draw_arrow(axis, circle[name], mode, _EDGE)
    for name in right:
        if name in showing:
            _draw_arrow(axis, mode, circle[name], _EDGE)
    for start, end in links:
        below = circle[start].center[1] + circle[end].center[1] <= 0
        rightward = circle[start].center[0] < circle[end].center[0]
        bend = 0.5 if rightward == below else -0.5
        _draw_arrow(axis, circle[start], circle[end], ADDED, bend=bend)
    return axis.figure


def _as_one(names: Sequence[str]) -> list[str]:
    """One name for all channels of a side, which is empty if the side is."""
    return [f"{len(names)} channels"] if len(names) > 1 else list(names)


def _draw_column(
    axis: Any, names: Sequence[str], across: float, words: str, color: str
) -> dict[str, Any]:
    """Draw channels below each other under a few words; return their circles."""
    from matplotlib.patches import Circle

    size = 0.2 if len(names) <= 4 else 0.09
    spread = min(0.9, len(names) / 3) * 2 / max(len(names) - 1, 1)
    circle = {}
    for k, name in enumerate(names):
        up = ((len(names) - 1) / 2 - k) * spread
        circle[name] = Circle((across, up), size, facecolor=color, edgecolor="#333333", zorder=3)
        axis.add_patch(circle[name])
        if size > 0.1 and len(name) <= 6:
            ink = "black" if color == PLAIN else ON_DARK
            axis.text(
                across, up, name, ha="center", va="center", color=ink, zorder=4, parse_math=False
            )
        else:
            outside = across * (1.06 + size)
            side = "left" if across > 0 else "right"
            text = cut(name, 12)
            axis.text(outside, up, text, ha=side, va="center", fontsize="small", parse_math=False)
    if names:
        axis.text(across, _WORDS, words, ha="center", fontsize="small")
    return circle


def _acting_and_showing(system: Any, p: Any) -> tuple[set[str], set[str]]:
    """The channels whose inputs act on the modes p, and those whose outputs show them."""
    at_A = Matrix.zeros(system.n, system.n)
    for coefficient in reversed(p.coefficients):
        at_A = at_A @ system.A + coefficient * Matrix.identity(system.n)
    seen, moved = nullspace(at_A), nullspace(at_A.T).T
    channels = list(zip(system.names, system.B, system.C, strict=True))
    acting = {name for name, B, _ in channels if not (moved @ B).is_zero()}
    return acting, {name for name, _, C in channels if not (C @ seen).is_zero()}


def _roots(factor: Any) -> str:
    """The roots of a factor in three digits, of a conjugate pair one line, at most three lines."""
    lines = []
    for disc in factor.roots:
        re, im = to_float(disc.re), to_float(disc.im)
        if im == 0:
            lines.append(f"{re:.3g}")
        elif im > 0:
            lines.append(f"{re:.3g} ± {im:.3g}i" if re else f"± {im:.3g}i")
    return "\n".join(lines[:3] + ["…"] * (len(lines) > 3))


# The gains of a controller as a colored matrix.

_WRITTEN = 12
"""The largest number of rows and columns whose gains are written into the cells."""
_DECADES = 4.0
_LABELED_GAINS = 40

Labels = list[tuple[str, int]]


def gains(controller: Any, ax: Any = None) -> Any:
    """Draw every entry of a controller's programs: who computes what from which signals.

    Parameters
    ----------
    controller : Controller
        Or a design, whose controller is meant.
    ax : matplotlib.axes.Axes, optional
        By default those of a new figure.

    Returns
    -------
    matplotlib.figure.Figure

    Notes
    -----
    A row for each entry of u_i and of the updates of x_i and z_i, a column for each entry of y_j,
    x_j, z_j and r_j.  Positive gains are red and negative ones blue, darker the larger they are, on
    a logarithmic scale of four decades.  White cells are zeros; lines separate the agents.
    """
    programs = getattr(controller, "controller", controller).agents
    rows, columns = _labels(programs)
    cells = _cells(programs, rows, columns)
    height, width = sum(size for _, size in rows), sum(size for _, size in columns)
    size = max(4.4, min(2.2 + 0.42 * width, 9.0)), max(2.4, min(1.6 + 0.34 * height, 9.0))
    axis = one_axis(ax, *size)
    largest = max((abs(each) for row in cells for each in row), default=0.0) or 1.0
    axis.imshow(
        [[_shade(each, largest) for each in row] for row in cells] or [[0.0]],
        cmap="RdBu_r",
        vmin=-1.35,
        vmax=1.35,
        aspect="auto",
        interpolation="nearest",
    )
    _label(axis.set_yticks, rows, axis.axhline)
    _label(axis.set_xticks, columns, axis.axvline, rotation=90)
    axis.tick_params(length=0)
    if max(height, width) <= _WRITTEN:
        for i, row in enumerate(cells):
            for j, each in enumerate(row):
                if each:
                    ink = ON_DARK if abs(_shade(each, largest)) > 0.8 else ON_LIGHT
                    text = f"{each:.3g}"
                    axis.text(j, i, text, ha="center", va="center", color=ink, fontsize="x-small")
    axis.set_title(f"gains, the largest {largest:.3g}", fontsize="medium")
    axis.set_xlabel("computed from", fontsize="small")
    axis.set_ylabel("computed", fontsize="small")
    return axis.figure


def _labels(programs: Any) -> tuple[Labels, Labels]:
    """The names of the blocks of rows and of columns, with their sizes."""
    rows: Labels = []
    columns: dict[str, int] = {}
    for agent in programs:
        name = agent.name
        sizes = [M.nrows for M in agent.input.matrices()]
        rows += [(f"u {name}", sizes[0] if sizes else 0)]
        rows += [(f"x {name}", agent.shared), (f"z {name}", agent.private)]
    for kind in "yxzr":
        for j, agent in enumerate(programs):
            columns[f"{kind} {agent.name}"] = _width(programs, kind, j)
    return [each for each in rows if each[1]], [each for each in columns.items() if each[1]]


def _width(programs: Any, kind: str, j: int) -> int:
    """The number of entries of a signal of the j-th agent that any program uses."""
    used = (_blocks(each, i) for i, agent in enumerate(programs) for each in agent.maps())
    return max((blocks[kind, j].ncols for blocks in used if (kind, j) in blocks), default=0)


def _blocks(each: Any, i: int) -> Mapping[tuple[str, int], Any]:
    """The matrices of a map of the i-th agent, keyed by the signal and its agent."""
    matrices = {("y", j): M for j, M in each.outputs.items()}
    matrices |= {("x", j): M for j, M in each.shared.items()}
    if each.private is not None:
        matrices["z", i] = each.private
    if each.reference is not None:
        matrices["r", i] = each.reference
    return matrices


def _cells(programs: Any, rows: Labels, columns: Labels) -> list[list[float]]:
    """All entries as floats, with zeros where a program does not use a signal."""
    start, offset = {}, 0
    for name, size in columns:
        start[name] = offset
        offset += size
    sizes, cells = dict(rows), []
    for i, agent in enumerate(programs):
        maps = ((f"u {agent.name}", agent.input), (f"x {agent.name}", agent.shared_update))
        for name, each in (*maps, (f"z {agent.name}", agent.private_update)):
            block = [[0.0] * offset for _ in range(sizes.get(name, 0))]
            for (kind, j), M in _blocks(each, i).items():
                first = start.get(f"{kind} {programs[j].name}", 0)
                for k, row in enumerate(M.rows()):
                    for column, entry in enumerate(row):
                        block[k][first + column] = to_float(entry)
            cells += block
    return cells


def _shade(value: float, largest: float) -> float:
    """A number between −1 and 1 on a logarithmic scale, with the sign of the value."""
    if not value:
        return 0.0
    decades = math.log10(largest / abs(value))
    return math.copysign(max(1 - decades / _DECADES, 0.12), value)


def _label(ticks: Any, labels: Labels, line: Any, **style: Any) -> None:
    """Names in the middle of their blocks, and lines between these."""
    places, start = [], 0
    for _, size in labels:
        places.append(start + (size - 1) / 2)
        start += size
        if start < sum(each for _, each in labels):
            line(start - 0.5, color=GRAY, linewidth=0.6)
    shown = len(labels) <= _LABELED_GAINS
    names = [plain_label(name, 12) if shown else "" for name, _ in labels]
    ticks(places, names, fontsize=8 if len(labels) <= 20 else 6, **style)
