"""Trajectories as tables and as comma-separated values."""

from __future__ import annotations

import csv
import io
from fractions import Fraction
from typing import Any

from mcexact.exact.floats import to_float
from mcexact.exact.rational import rational_text
from mcexact.simulation.trajectory import Trajectory


def trajectory_csv(run: Trajectory) -> str:
    """Write one line for each time: t, x, then x_i and z_i of every agent.

    Rational numbers are written exactly, as "p/q", other numbers with all their digits.
    """
    first = run.snapshots[0]
    header = ["t", *(f"x[{k + 1}]" for k in range(len(first.plant)))]
    for name, x_i, z_i in zip(run.agents, first.shared, first.private, strict=True):
        header += [f"shared {name}[{k + 1}]" for k in range(len(x_i))]
        header += [f"private {name}[{k + 1}]" for k in range(len(z_i))]
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(header)
    for time, snapshot in zip(run.times, run.snapshots, strict=True):
        writer.writerow([_written(time, run), *(_written(v, run) for v in snapshot.flat())])
    return stream.getvalue()


def _written(value: Any, run: Trajectory) -> str:
    """Format a number."""
    if isinstance(value, Fraction) and run.arithmetic == "float":
        return repr(to_float(value))
    if isinstance(value, Fraction):
        return rational_text(value)
    return repr(value) if isinstance(value, float) else str(value)


def state_norms(run: Trajectory) -> list[float]:
    """Return the largest absolute value of an entry of x at every time."""
    return [_largest(snapshot.plant) for snapshot in run.snapshots]


def error_norms(run: Trajectory) -> dict[str, list[float]]:
    """Return the largest absolute entry of e_i = x_i − x for every agent with an estimate.

    The result is empty if the agents share no estimates of the plant's state.
    """
    if not run.has_estimates():
        return {}
    rows = [[_largest(e) for e in run.errors(k)] for k in range(len(run.times))]
    return {name: [row[i] for row in rows] for i, name in enumerate(run.agents)}


def _largest(values: list[Any]) -> float:
    """Return the largest absolute value as a float: infinity beyond floats, 0 without entries."""
    top = max((abs(value) for value in values), default=0)
    return to_float(top) if isinstance(top, (int, Fraction)) else float(top)


def trajectory_rows(run: Trajectory, lines: int = 12) -> tuple[tuple[str, ...], ...]:
    """Return a limited number of lines: t, the norm of x, and those of the estimation errors.

    Parameters
    ----------
    run : Trajectory
    lines : int
        The first and the last time are shown, the others at nearly equal distances between these.
    """
    states, errors = state_norms(run), error_norms(run)
    count = len(run.times)
    chosen = sorted({round(k * (count - 1) / max(lines - 1, 1)) for k in range(lines)})
    return tuple(
        (
            f"{to_float(run.times[k]):g}",
            f"{states[k]:.3e}",
            *(f"{errors[name][k]:.3e}" for name in errors),
        )
        for k in chosen
    )
