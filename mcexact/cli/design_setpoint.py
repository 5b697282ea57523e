"""`mcexact design setpoint`: design a controller that holds every output at its set-point."""

from __future__ import annotations

from typing import Any

import click

from mcexact.cli import designing
from mcexact.cli.commands import GroupedCommand
from mcexact.cli.spectra import spectrum_examples


@click.command(
    cls=GroupedCommand,
    name="setpoint",
    short_help="Design a controller that holds outputs at set-points.",
    epilog=spectrum_examples("feedback", "error"),
)
@click.argument("file")
@designing.design_options(
    'JSON for the plant with its integrators, as text or a file: {"feedback": P, "error": P}, or '
    '{"closed_loop": P} with --method extended.'
)
@click.option(
    "--method",
    type=click.Choice(["observer", "extended"]),
    help="Use a distributed observer, or shared sub-states; by default a controller of low order "
    "without communication if one exists, else with shared sub-states.",
)
def command(file: str, method: str | None, **given: Any) -> None:
    """Design a distributed controller that holds every output of FILE at its agent's set-point.

    Without a neighbor graph in FILE agents receive nothing. Without a rate, a radius or a spectrum,
    half the sensible rate is taken. `mcexact simulate --reference` runs the controller with given
    set-points. If some set-points have no equilibrium, the status is 1 and a certificate gives
    their linear combinations.
    """
    designing.answer("setpoint", file, given, {"method": method})
