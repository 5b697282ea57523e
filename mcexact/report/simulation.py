"""A simulation with everything that is shown of it: facts, warnings, table, figure, page."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.analysis.closed_loop_spectrum import LoopSpectrum, closed_loop_spectrum
from mcexact.errors import InputError
from mcexact.exact.floats import to_float
from mcexact.exact.location import is_discrete
from mcexact.model.closed_loop import closed_loop_matrix
from mcexact.model.controller import Controller
from mcexact.model.system import MultiChannelSystem
from mcexact.report.figures import simulation_png
from mcexact.report.simulation_page import simulation_page
from mcexact.report.text import Table
from mcexact.report.trajectory import error_norms, trajectory_csv, trajectory_rows
from mcexact.simulation.trajectory import InitialState, Trajectory, default_initial, simulate

# Beyond this the numbers in the characteristic polynomial take longer than anybody waits.
_LARGEST_SPECTRUM = 60


@dataclass(frozen=True)
class SimulationReport:
    """A run, and the spectrum of the loop where it was computed.

    Attributes
    ----------
    title : str
    run : Trajectory
    spectrum : LoopSpectrum or None
    warnings : tuple of str
    """

    title: str
    run: Trajectory
    spectrum: LoopSpectrum | None
    warnings: tuple[str, ...]

    @property
    def columns(self) -> tuple[str, ...]:
        """The heads of the table."""
        return ("t", "state", *(f"error of {name}" for name in error_norms(self.run)))

    def facts(self) -> list[str]:
        """What is known exactly."""
        lines = [f"{self.run.time} time, {self.run.arithmetic} arithmetic"]
        if self.spectrum is not None and self.spectrum.rate is not None:
            rate, stable = self.spectrum.rate, "" if self.spectrum.stable else "not "
            what = "spectral radius" if is_discrete(self.run.time) else "decay rate"
            lines.append(
                f"the closed loop is {stable}stable; its {what} is between {rate.lower} and "
                f"{rate.upper}"
            )
        return lines

    def tables(self) -> tuple[Table, ...]:
        """The norms at some times."""
        note = "largest absolute entries; the error of an agent is its estimate less the state"
        rows = trajectory_rows(self.run)
        title = f"{self.title}: {'; '.join(self.facts())}"
        return (Table(title, self.columns, rows, note=note),)

    def as_json(self) -> dict[str, Any]:
        """The same as plain data, with the whole trajectory of the norms."""
        rows = trajectory_rows(self.run, lines=len(self.run.times))
        found = self.spectrum
        return {
            "time": self.run.time,
            "arithmetic": self.run.arithmetic,
            "stable": None if found is None else found.stable,
            "rate": None if found is None or found.rate is None else found.rate.document(),
            "columns": list(self.columns),
            "rows": [list(row) for row in rows],
            "warnings": list(self.warnings),
        }

    def file(self, suffix: str) -> bytes:
        """The content of a file that ends so: .csv, .png, .html; nothing for no suffix."""
        if suffix == ".csv":
            return trajectory_csv(self.run).encode("utf-8")
        if suffix == ".png":
            return simulation_png(self.run, self.spectrum, self.title)
        if suffix == ".html":
            png = simulation_png(self.run, self.spectrum, self.title)
            page = simulation_page(
                self.title,
                self.facts(),
                list(self.warnings),
                self.columns,
                trajectory_rows(self.run),
                png,
            )
            return page.encode("utf-8")
        return b""


def run_report(
    system: MultiChannelSystem,
    controller: Controller,
    *,
    initial: Sequence[Fraction] | None = None,
    horizon: Fraction | None = None,
    reference: Sequence[Fraction] | None = None,
    arithmetic: str | None = None,
) -> SimulationReport:
    """Run a controller, with the spectrum of its loop and the warnings that belong to the run.

    Parameters
    ----------
    system : MultiChannelSystem
    controller : Controller
    initial : sequence of Fraction, optional
        The plant's initial state.
    horizon : Fraction, optional
        By default long enough to see the decay, from the spectrum.
    reference : sequence of Fraction, optional
        Set-points of all outputs, in the order of the channels.
    arithmetic : str, optional
        As in `simulate`.
    """
    M = closed_loop_matrix(system, controller)
    spectrum = None
    if M.nrows <= _LARGEST_SPECTRUM:
        spectrum = closed_loop_spectrum(M, system.time)
    start = default_initial(system, controller)
    if initial is not None:
        if len(initial) != system.n:
            raise InputError(f"expected {system.n} numbers, found {len(initial)}", where="initial")
        start = InitialState(tuple(initial), start.shared, start.private)
    run = simulate(
        system,
        controller,
        initial=start,
        horizon=_horizon(system.time, spectrum, M.nrows) if horizon is None else horizon,
        reference=_by_channel(system, reference),
        arithmetic=arithmetic,
    )
    warnings = controller.warnings_for(system) + (() if run.warning is None else (run.warning,))
    return SimulationReport(system.name or "simulation", run, spectrum, warnings)


def _horizon(time: str, spectrum: LoopSpectrum | None, states: int) -> Fraction:
    """Some time constants, within reason."""
    rate = None if spectrum is None else spectrum.rate
    if is_discrete(time):
        radius = 0.9 if rate is None else min(0.95, to_float(rate.upper))
        steps = states if radius <= 0 else max(states, math.ceil(-10 / math.log(radius)))
        return Fraction(min(steps + 3, 200))
    lower = Fraction(1) if rate is None else Fraction(rate.lower)
    if lower <= 0:
        return Fraction(5)
    return min(Fraction(100), max(Fraction(1, 100), Fraction(math.ceil(2000 / lower), 100)))


def _by_channel(
    system: MultiChannelSystem, reference: Sequence[Fraction] | None
) -> list[list[Fraction]] | None:
    """The set-points of each channel."""
    if reference is None:
        return None
    total = sum(system.q(i) for i in range(system.m))
    if len(reference) != total:
        raise InputError(f"expected {total} numbers, found {len(reference)}", where="reference")
    rest, result = list(reference), []
    for i in range(system.m):
        result.append(rest[: system.q(i)])
        rest = rest[system.q(i) :]
    return result
