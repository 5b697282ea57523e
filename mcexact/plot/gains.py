"""The gains of a controller as a colored matrix."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from mcexact.exact.matrix import to_float
from mcexact.plot.canvas import GRAY, one_axis, plain_label

_WRITTEN = 12
"""The largest number of rows and columns whose gains are written into the cells."""
_DECADES = 4.0
_LABELED = 40

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
                    ink = "white" if abs(_shade(each, largest)) > 0.8 else "black"
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
    found = {("y", j): M for j, M in each.outputs.items()}
    found |= {("x", j): M for j, M in each.shared.items()}
    if each.private is not None:
        found["z", i] = each.private
    if each.reference is not None:
        found["r", i] = each.reference
    return found


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
    shown = len(labels) <= _LABELED
    names = [plain_label(name, 12) if shown else "" for name, _ in labels]
    ticks(places, names, fontsize=8 if len(labels) <= 20 else 6, **style)
