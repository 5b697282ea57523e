"""Trajectories as tables and as comma-separated values."""

from __future__ import annotations

import csv
import io
from decimal import MAX_EMAX, MIN_EMIN, Decimal, localcontext
from fractions import Fraction
from itertools import chain
from typing import Any

from mcexact.exact.floats import to_float
from mcexact.exact.rational import rational_text
from mcexact.simulation.trajectory import Trajectory

_DIGITS = 17
SIGNALS = {"outputs": "y", "inputs": "u", "reference": "r"}
"""The letters of the signals of all agents, keyed by their names in a `Snapshot`."""


def trajectory_csv(run: Trajectory, *, fractions: bool = False) -> str:
    """Write one line for each time: t, x, x_i and z_i of every agent, then all y_i, u_i and r_i.

    Parameters
    ----------
    run : Trajectory
    fractions : bool
        Whether rational numbers are written exactly, as "p/q"; else as decimals, rounded to 17
        significant digits.  Other numbers are written with all their digits.
    """
    first = run.snapshots[0]
    header = ["t", *(f"x[{k + 1}]" for k in range(len(first.plant)))]
    for name, x_i, z_i in zip(run.agents, first.shared, first.private, strict=True):
        header += [f"shared {name}[{k + 1}]" for k in range(len(x_i))]
        header += [f"private {name}[{k + 1}]" for k in range(len(z_i))]
    header += [name for kind in SIGNALS for name in signal_names(run, kind)]
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(header)
    for time, snapshot in zip(run.times, run.snapshots, strict=True):
        signals = [each for kind in SIGNALS for each in chain(*getattr(snapshot, kind))]
        numbers = (time, *snapshot.flat(), *signals)
        writer.writerow([_written(value, run, fractions=fractions) for value in numbers])
    return stream.getvalue()


def _written(value: Any, run: Trajectory, *, fractions: bool) -> str:
    """Format a number."""
    if isinstance(value, Fraction) and run.arithmetic == "float":
        return repr(to_float(value))
    if isinstance(value, int | Fraction) and not isinstance(value, bool):
        exact = Fraction(value)
        return rational_text(exact) if fractions else decimal_text(exact)
    return repr(value) if isinstance(value, float) else str(value)


def decimal_text(x: Fraction, digits: int = _DIGITS) -> str:
    """Write a rational number as a decimal with a number of significant digits.

    Examples
    --------
    >>> decimal_text(Fraction(1, 4)), decimal_text(Fraction(-200)), decimal_text(Fraction(1, 3), 4)
    ('0.25', '-200', '0.3333')
    >>> decimal_text(Fraction(1, 10**400))
    '1E-400'
    """
    with localcontext(prec=digits, Emax=MAX_EMAX, Emin=MIN_EMIN):
        found = (Decimal(x.numerator) / Decimal(x.denominator)).normalize()
    short = -_DIGITS <= found.adjusted() <= _DIGITS
    return f"{found:f}" if short else str(found)


def signal_names(run: Trajectory, kind: str) -> list[str]:
    """Return the names of all entries of a signal, such as "y pump" or "u 2[1]"."""
    letter, first = SIGNALS[kind], getattr(run.snapshots[0], kind)
    return [
        f"{letter} {name}" if len(values) == 1 else f"{letter} {name}[{k + 1}]"
        for name, values in zip(run.agents, first, strict=True)
        for k in range(len(values))
    ]


def signal_values(run: Trajectory, kind: str) -> dict[str, list[float]]:
    """Return the values of all entries of a signal at all times as floats, keyed by their names."""
    rows = [list(map(as_float, chain(*getattr(each, kind)))) for each in run.snapshots]
    columns = zip(*rows, strict=True)
    return dict(zip(signal_names(run, kind), map(list, columns), strict=True))


def as_float(value: Any) -> float:
    """A native number as the nearest float; infinity beyond floats."""
    return to_float(value) if isinstance(value, (int, Fraction)) else float(value)


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
    return as_float(max((abs(value) for value in values), default=0))


def shown_times(run: Trajectory, lines: int) -> list[int]:
    """Positions of the first and the last time, and of others at nearly equal distances."""
    count = len(run.times)
    return sorted({round(k * (count - 1) / max(lines - 1, 1)) for k in range(lines)})
