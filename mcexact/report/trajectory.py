"""Trajectories as tables and as comma-separated values."""

from __future__ import annotations

import csv
import io
from decimal import MAX_EMAX, MIN_EMIN, Decimal, localcontext
from fractions import Fraction
from itertools import chain
from typing import Any

from mcexact.exact.matrix import to_float
from mcexact.exact.rational import rational_text
from mcexact.simulation.trajectory import SIGNALS, Trajectory

_DIGITS = 17


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
    header += [name for kind in SIGNALS for name in run.names(kind)]
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


def shown_times(run: Trajectory, lines: int) -> list[int]:
    """Positions of the first and the last time, and of others at nearly equal distances."""
    count = len(run.times)
    return sorted({round(k * (count - 1) / max(lines - 1, 1)) for k in range(lines)})
