"""The display of a simulation: facts, warnings, table, figure and page."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from mcexact.exact.location import is_discrete
from mcexact.report.figures import simulation_png
from mcexact.report.simulation_page import simulation_page
from mcexact.report.text import Table
from mcexact.report.trajectory import error_norms, trajectory_csv, trajectory_rows
from mcexact.simulation.run import SimulatedLoop


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

    @property
    def columns(self) -> tuple[str, ...]:
        """The heads of the table."""
        return ("t", "state", *(f"error of {name}" for name in error_norms(self.done.run)))

    def facts(self) -> list[str]:
        """Return exact statements about the loop."""
        lines = [f"{self.done.run.time} time, {self.done.run.arithmetic} arithmetic"]
        if self.done.spectrum is not None and self.done.spectrum.rate is not None:
            rate, stable = self.done.spectrum.rate, "" if self.done.spectrum.stable else "not "
            what = "spectral radius" if is_discrete(self.done.run.time) else "decay rate"
            between = f"between {rate.lower} and {rate.upper}"
            size = rate.lower if rate.lower == rate.upper else between
            lines.append(f"the closed loop is {stable}stable; its {what} is {size}")
        return lines

    def tables(self) -> tuple[Table, ...]:
        """Return the table of norms at some times."""
        note = "largest absolute entries; the error of an agent is its estimate minus the state"
        rows = trajectory_rows(self.done.run)
        title = f"{self.done.title}: {'; '.join(self.facts())}"
        return (Table(title, self.columns, rows, note=note),)

    def as_json(self) -> dict[str, Any]:
        """Return the data with the whole trajectory of the norms, as plain data."""
        rows = trajectory_rows(self.done.run, lines=len(self.done.run.times))
        found = self.done.spectrum
        return {
            "time": self.done.run.time,
            "arithmetic": self.done.run.arithmetic,
            "stable": None if found is None else found.stable,
            "rate": None if found is None or found.rate is None else found.rate.document(),
            "columns": list(self.columns),
            "rows": [list(row) for row in rows],
            "warnings": list(self.done.warnings),
        }

    def file(self, suffix: str) -> bytes:
        """Return the content of a file with suffix .csv, .png or .html; empty without a suffix."""
        if suffix == ".csv":
            return trajectory_csv(self.done.run, fractions=self.fractions).encode("utf-8")
        if suffix == ".png":
            return simulation_png(self.done.run, self.done.spectrum, self.done.title)
        if suffix == ".html":
            png = simulation_png(self.done.run, self.done.spectrum, self.done.title)
            page = simulation_page(
                self.done.title,
                self.facts(),
                list(self.done.warnings),
                self.columns,
                trajectory_rows(self.done.run),
                png,
            )
            return page.encode("utf-8")
        return b""
