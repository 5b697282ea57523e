"""`mcexact design`: the group of the design commands, each in its own module."""

from __future__ import annotations

import click

from mcexact.cli.commands import Commands


@click.group(
    name="design",
    cls=Commands,
    names=("decentralized", "observer", "extended", "setpoint"),
    prefix="design_",
    short_help="Design a controller and prove its closed loop.",
)
def command() -> None:
    """Design a linear time-invariant controller and certify its closed loop."""
