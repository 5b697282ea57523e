"""Trajectories as tables and as comma-separated values."""

from __future__ import annotations

import csv
import io
from decimal import MAX_EMAX, MIN_EMIN, Decimal, localcontext
from fractions import Fraction
from typing import Any

from mcexact.exact.floats import to_float
from mcexact.exact.rational import rational_text
from mcexact.simulation.trajectory import Trajectory

_DIGITS = 17


def trajectory_csv(run: Trajectory, *, fractions: bool = False) -> str:
    """Write one line for each time: t, x, then x_i and z_i of every agent.

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
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(header)
    for time, snapshot in zip(run.times, run.snapshots, strict=True):
        numbers = (time, *snapshot.flat())
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
