"""The display of a simulation."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from decimal import MAX_EMAX, MIN_EMIN, Decimal, localcontext
from fractions import Fraction
from itertools import chain
from typing import Any

from mcexact.exact.matrix import finite, float_above, to_float
from mcexact.exact.rational import digits_outward, rational_text
from mcexact.exact.roots import is_discrete
from mcexact.report.figures import real_pictures, real_png, simulation_pictures, simulation_png
from mcexact.report.html import AnswerPage, shown_plant
from mcexact.report.text import Table
from mcexact.simulation.envelope import LARGEST, SimulatedLoop
from mcexact.simulation.real import RealRun
from mcexact.simulation.trajectory import SIGNALS, Trajectory, as_float

# Trajectories as tables and as comma-separated values.

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
        decimal = (Decimal(x.numerator) / Decimal(x.denominator)).normalize()
    short = -_DIGITS <= decimal.adjusted() <= _DIGITS
    return f"{decimal:f}" if short else str(decimal)


def shown_times(run: Trajectory, lines: int) -> list[int]:
    """Positions of the first and the last time, and of others at nearly equal distances."""
    count = len(run.times)
    return sorted({round(k * (count - 1) / max(lines - 1, 1)) for k in range(lines)})


# The display of a simulation: facts, warnings, tables, figures and page.

_COLUMNS = 8
"""The largest number of signals with a column of their own."""
_TITLES = ("At some times", "Proved bounds: |y(t) − rest| is at most size d(t) + rounding")
"""The titles of the tables on the page."""
_REAL_TITLES = (
    "The real loop beside the ideal one",
    "The real loop at some times",
    "Proved bounds of the ideal loop: |y(t) − rest| is at most size d(t) + rounding",
)


@dataclass(frozen=True)
class SimulationReport:
    """The displayed data of a simulation.

    Attributes
    ----------
    done : SimulatedLoop
    fractions : bool
        Whether exact numbers are written as fractions.
    """

    done: SimulatedLoop
    fractions: bool = False

    def facts(self) -> list[str]:
        """Return exact statements about the loop and the simulation."""
        run, spectrum = self.done.run, self.done.spectrum
        unit = "steps" if is_discrete(run.time) else "units of time"
        lines = [
            f"{run.time} time, {run.arithmetic} arithmetic, {to_float(run.times[-1]):g} {unit}"
        ]
        if spectrum is not None and spectrum.rate is not None:
            stable = "" if spectrum.stable else "not "
            what = "spectral radius" if is_discrete(run.time) else "decay rate"
            between = f"between {spectrum.rate.lower} and {spectrum.rate.upper}"
            size = spectrum.rate.lower if spectrum.rate.lower == spectrum.rate.upper else between
            lines.append(f"the closed loop is {stable}stable; its {what} is {size}")
        if run.loop.dimension > LARGEST:
            lines.append(
                f"the loop has {run.loop.dimension} states: beyond {LARGEST} nothing is proved "
                "here, and `mcexact certify` decides stability"
            )
        if run.note is not None:
            lines.append(run.note)
        return lines

    def tables(self, lines: int = 12) -> tuple[Table, ...]:
        """Return the signals and the norms at some times, and the proved bounds."""
        title = f"{self.done.title}: {'; '.join(self.facts())}"
        columns, note = self._shown()
        chosen = shown_times(self.done.run, lines)
        rows = tuple(
            (
                f"{to_float(self.done.run.times[k]):g}",
                *(f"{values[k]:.4g}" for values in columns.values()),
            )
            for k in chosen
        )
        signals = Table(title, ("t", *columns), rows, note=note)
        return (signals, *self._bounds())

    def _shown(self) -> tuple[dict[str, list[float]], str]:
        """Every output and input if there are few, otherwise the largest ones; then the norms."""
        run = self.done.run
        signals = {kind: run.values(kind) for kind in SIGNALS}
        if not any(map(any, signals["reference"].values())):
            del signals["reference"]
        few = sum(map(len, signals.values())) <= _COLUMNS
        columns: dict[str, list[float]] = {}
        for kind, values in signals.items():
            if few:
                columns |= values
            elif values:
                each_time = zip(*values.values(), strict=True)
                columns[f"|{SIGNALS[kind]}|"] = [max(map(abs, row)) for row in each_time]
        columns["|x|"] = run.state_norms()
        errors = run.error_norms()
        if len(errors) <= _COLUMNS:
            columns |= {f"|e {name}|": values for name, values in errors.items()}
        elif errors:
            columns["|e|"] = [max(row) for row in zip(*errors.values(), strict=True)]
        note = "y: outputs, u: inputs, |…|: the largest absolute entry"
        note += "; e: an agent's estimate minus the state" if errors else ""
        return columns, note

    def _bounds(self) -> tuple[Table, ...]:
        """The proved envelope of every output."""
        envelope = self.done.envelope
        if envelope is None or not envelope.outputs:
            return ()
        names = self.done.run.values("outputs")
        decay = f"d(t) = {radius_text(envelope.bound)}^t"
        if not is_discrete(envelope.time):
            decay = f"d(t) = exp(-{digits_outward(envelope.bound, up=False)} t)"
        rows = [
            (name, *_bounds_in_digits(rest, size))
            for name, (rest, size) in zip(names, envelope.outputs, strict=True)
        ]
        more = len(rows) - 2 * _COLUMNS
        note = f"{decay}; of the exact trajectory, by a certificate of stability"
        if more > 0:
            rows, note = rows[: 2 * _COLUMNS], f"{note}; {more} more in the JSON document"
        title = "Proved bounds: |y(t) - rest| is at most size d(t) + rounding"
        columns = ("output", "rest", "size", "rounding")
        return (Table(title, columns, tuple(rows), note=note),)

    def as_json(self) -> dict[str, Any]:
        """Return the whole trajectory as plain data; numbers are floats unless fractions are asked.

        A number that exceeds floats is None.
        """
        run, spectrum, envelope = self.done.run, self.done.spectrum, self.done.envelope
        snapshots = run.snapshots
        return {
            "time": run.time,
            "arithmetic": run.arithmetic,
            "stable": None if spectrum is None else spectrum.stable,
            "rate": None if spectrum is None or spectrum.rate is None else spectrum.rate.document(),
            "warnings": list(self.done.warnings),
            "times": [self._number(t) for t in run.times],
            "state": [self._numbers(each.plant) for each in snapshots],
            "agents": [
                {
                    "name": name,
                    **{
                        kind: [self._numbers(getattr(each, kind)[i]) for each in snapshots]
                        for kind in (*SIGNALS, "shared", "private")
                    },
                }
                for i, name in enumerate(run.agents)
            ],
            "state_norm": [finite(value) for value in run.state_norms()],
            "error_norms": {
                name: [finite(value) for value in values]
                for name, values in run.error_norms().items()
            },
            "proved_bounds": None
            if envelope is None
            else {
                "bound": str(envelope.bound),
                "outputs": [
                    {"name": name, **_bounds_in_floats(rest, size)}
                    for name, (rest, size) in zip(
                        run.values("outputs"), envelope.outputs, strict=True
                    )
                ],
            },
        }

    def _numbers(self, values: list[Any]) -> list[Any]:
        return [self._number(value) for value in values]

    def _number(self, value: Any) -> float | str | None:
        """A number for JSON; a fraction as a text where fractions are asked for."""
        if self.fractions and self.done.run.arithmetic == "exact":
            return rational_text(value)
        return finite(as_float(value))

    def file(self, suffix: str) -> bytes:
        """Return the content of a file with suffix .csv or .png; empty with another suffix."""
        if suffix == ".csv":
            return trajectory_csv(self.done.run, fractions=self.fractions).encode("utf-8")
        if suffix == ".png":
            return simulation_png(self.done)
        return b""

    def page(self) -> AnswerPage:
        """Return the page of the simulation."""
        done = self.done
        return AnswerPage(
            title=done.title,
            heading="A controller, run as a network of agents that receive messages from neighbors "
            "only. Trajectories are computed; what is proved is said to be proved.",
            good=None if done.spectrum is None else done.spectrum.stable,
            answer=(
                *(f"{each[0].upper()}{each[1:]}." for each in self.facts()),
                *(f"warning: {each}" for each in done.warnings),
            ),
            pictures=tuple(each.embedded() for each in simulation_pictures(done)),
            tables=tuple(
                replace(each, title=title)
                for each, title in zip(self.tables(), _TITLES, strict=False)
            ),
            plant=shown_plant(done.run.loop.plant),
        )


@dataclass(frozen=True)
class RealReport:
    """The displayed data of a real loop beside the ideal one.

    Attributes
    ----------
    run : RealRun
    done : SimulatedLoop
        The ideal loop, with what is proved about it.
    """

    run: RealRun
    done: SimulatedLoop

    @property
    def _ideal(self) -> SimulationReport:
        return SimulationReport(self.done)

    def tables(self, lines: int = 12) -> tuple[Table, ...]:
        """Return the comparison, signals at some times, and bounds of the ideal loop."""
        facts = "; ".join(self.run.realization.facts())
        note = (
            "settled: within 2 % of the largest distance from rest in the ideal loop; "
            "effort: sum of u² times the time between samples; computed, not certified"
        )
        compared = Table(
            f"{self.done.title}, the real loop beside the ideal one: {facts}",
            ("", "ideal", "real"),
            tuple(self.run.compared()),
            note=note,
        )
        ideal = "; ".join(self._ideal.facts())
        counted = "t counts steps; " if is_discrete(self.run.ideal.time) else ""
        bounds = (
            replace(each, title=f"Ideal: {ideal}", note=f"{counted}{each.note}")
            for each in self._ideal.tables(lines)[1:]
        )
        return compared, self._shown(lines), *bounds

    def _shown(self, lines: int) -> Table:
        """Outputs and inputs of the real loop, and their distances from those of the ideal one."""
        run, columns = self.run, dict[str, list[float]]()
        signals = {kind: run.real.values(kind) for kind in ("outputs", "inputs")}
        few = sum(map(len, signals.values())) <= _COLUMNS
        for kind, values in signals.items():
            beside = run.ideal.values(kind)
            columns |= values if few else {f"|{SIGNALS[kind]}|": _largest_of(values.values())}
            apart = [
                [abs(a - b) for a, b in zip(values[name], beside[name], strict=True)]
                for name in values
            ]
            columns[f"|{SIGNALS[kind]} - ideal|"] = _largest_of(apart)
        rows = tuple(
            (f"{to_float(run.times[k]):g}", *(f"{values[k]:.4g}" for values in columns.values()))
            for k in shown_times(run.real, lines)
        )
        return Table("The real loop at some times", ("t", *columns), rows)

    def as_json(self) -> dict[str, Any]:
        """Return the ideal loop as a simulation has it, and the real one beside it."""
        run = self.run
        outputs, inputs = run.measured, run.computed
        sizes = [
            [len(each) for each in getattr(run.real.snapshots[0], kind)]
            for kind in ("outputs", "inputs")
        ]
        agents = []
        for i, name in enumerate(run.real.agents):
            starts = [sum(size[:i]) for size in sizes]
            parts = [
                [row[start : start + size[i]] for row in rows]
                for rows, start, size in zip((outputs, inputs), starts, sizes, strict=True)
            ]
            at = run.real.snapshots
            agents.append(
                {
                    "name": name,
                    "outputs": [each.outputs[i] for each in at],
                    "measured": parts[0],
                    "computed": parts[1],
                    "inputs": [each.inputs[i] for each in at],
                    "reference": [each.reference[i] for each in at],
                }
            )
        real = {
            **run.realization.to_dict(),
            "times": [to_float(t) for t in run.times],
            "state": [each.plant for each in run.real.snapshots],
            "agents": agents,
            "outputs": [
                {
                    "name": each.name,
                    "rest": finite(each.rest),
                    "settled": _both(*(None if t is None else to_float(t) for t in each.settled)),
                    "largest_distance": _both(*each.peak),
                    "apart": finite(each.apart),
                }
                for each in run.outputs
            ],
            "inputs": [
                {
                    "name": each.name,
                    "largest_modulus": _both(*each.peak),
                    "effort": _both(*each.effort),
                    "steps_at_a_limit": each.at_limit,
                }
                for each in run.inputs
            ],
        }
        return {**self._ideal.as_json(), "real": real}

    def file(self, suffix: str) -> bytes:
        """Return the content of a file with suffix .csv or .png; empty with another suffix."""
        if suffix == ".csv":
            return self._csv().encode("utf-8")
        if suffix == ".png":
            return real_png(self.run, self.done.title)
        return b""

    def _csv(self) -> str:
        """All signals, as floats with all their digits."""
        signals = self.run.signals()
        stream = io.StringIO()
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(signals)
        writer.writerows(zip(*(map(repr, values) for values in signals.values()), strict=True))
        return stream.getvalue()

    def page(self) -> AnswerPage:
        """Return the page of the real loop."""
        done = self.done
        facts = [*self.run.realization.facts(), *(f"ideal: {each}" for each in self._ideal.facts())]
        return AnswerPage(
            title=done.title,
            heading="A controller as it is installed, beside the ideal loop. Trajectories are "
            "computed; what is proved is proved of the ideal loop.",
            good=None if done.spectrum is None else done.spectrum.stable,
            answer=(
                *(f"{each[0].upper()}{each[1:]}." for each in facts),
                *(f"warning: {each}" for each in done.warnings),
            ),
            pictures=tuple(each.embedded() for each in real_pictures(self.run, done)),
            tables=tuple(
                replace(each, title=title)
                for each, title in zip(self.tables(), _REAL_TITLES, strict=False)
            ),
            plant=shown_plant(done.run.loop.plant.plant),
        )


def _largest_of(curves: Iterable[Sequence[float]]) -> list[float]:
    """The largest modulus of several curves at every time."""
    return [max(map(abs, row)) for row in zip(*curves, strict=True)]


def _both(ideal: float | None, real: float | None) -> dict[str, float | None]:
    return {
        key: None if value is None else finite(value)
        for key, value in (("ideal", ideal), ("real", real))
    }


def radius_text(bound: Fraction) -> str:
    """A radius, rounded up to at least four digits; if it is below 1, to a number below 1."""
    digits, text = 4, digits_outward(bound, up=True)
    while bound < 1 <= Fraction(text):
        digits += 2
        text = digits_outward(bound, up=True, digits=digits)
    return text


def _bounds_in_digits(rest: Fraction, size: Fraction) -> tuple[str, str, str]:
    """The value at rest, rounded, the size, rounded up, and at least the error of the former."""
    value = digits_outward(rest, up=rest < 0, digits=6)
    off = abs(rest - Fraction(value))
    return value, digits_outward(size, up=True), digits_outward(off, up=True, digits=2)


def _bounds_in_floats(rest: Fraction, size: Fraction) -> dict[str, float | None]:
    """The value at rest and the size as floats for JSON; None for a number that exceeds floats."""
    near = finite(to_float(rest))
    off = None
    if near is not None:
        # A reader may take the float, or the decimal that the document has for it.
        off = finite(float_above(max(abs(rest - Fraction(each)) for each in (near, repr(near)))))
    return {"rest": near, "size": finite(float_above(size)), "rounding": off}
