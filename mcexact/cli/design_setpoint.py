"""`mcexact design setpoint`: every output at the set-point of its agent."""

from __future__ import annotations

from typing import Any

import click

from mcexact.cli import designing


@click.command(name="setpoint", short_help="Every output at the set-point of its agent.")
@click.argument("file")
@designing.design_options(
    'JSON for the plant with its integrators: {"feedback": P, "error": P}, or {"closed_loop": P} '
    "with --method extended."
)
@click.option(
    "--method",
    type=click.Choice(["observer", "extended"]),
    default="observer",
    show_default=True,
    help="A distributed observer, or shared sub-states of the least dimension.",
)
def command(file: str, method: str, **given: Any) -> None:
    """Design a distributed controller that holds every output of FILE at its agent's set-point.

    FILE needs a neighbor graph. Run it with simulate --reference. If no equilibrium holds some
    set-points, the status is 1 and the certificate gives the combination.
    """
    designing.answer("setpoint", file, given, {"method": method})
