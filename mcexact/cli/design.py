"""`mcexact design`: the group of the design commands, each in its own module."""

from __future__ import annotations

import click

from mcexact.cli.commands import Commands


@click.group(
    name="design",
    cls=Commands,
    names={
        "decentralized": "mcexact.cli.design_decentralized:command",
        "observer": "mcexact.cli.design_observer:command",
        "extended": "mcexact.cli.design_extended:command",
        "setpoint": "mcexact.cli.design_setpoint:command",
    },
    short_help="Design a controller and prove its closed loop.",
)
def command() -> None:
    """Design a linear time-invariant controller and certify its closed loop."""
