"""`mcexact design`: the group of designs, each in a module of its own."""

from __future__ import annotations

import importlib

import click

# Each is the module design_<name> in this package.
DESIGNS = ("observer",)


class Designs(click.Group):
    """The designs, each imported when it is named."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The designs in the order of the table above."""
        return list(DESIGNS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The design of this name, or None."""
        if cmd_name not in DESIGNS:
            return None
        command = importlib.import_module(f"mcexact.cli.design_{cmd_name}").command
        if not isinstance(command, click.Command):
            raise TypeError(f"mcexact.cli.design_{cmd_name}.command is not a command")
        return command


@click.group(name="design", cls=Designs, short_help="Design a controller, with its proof.")
def command() -> None:
    """Design a controller and certify the closed loop that results."""
