"""`mcexact design`: the group of designs, each in a module of its own."""

from __future__ import annotations

import click

from mcexact.cli.commands import Commands


@click.group(
    name="design",
    cls=Commands,
    names=("decentralized", "observer", "extended", "setpoint"),
    prefix="design_",
    short_help="Design a controller, with its proof.",
)
def command() -> None:
    """Design a linear time-invariant controller and certify the closed loop that results."""
