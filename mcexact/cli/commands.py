"""The group of commands: loaded one by one, and a near miss is answered with the nearest name."""

from __future__ import annotations

import difflib
import importlib

import click

# In the order in which a user meets them; each is the module of that name in this package.
COMMANDS = ("analyze", "check", "design", "simulate", "demo", "sample")


class Commands(click.Group):
    """The commands of `mcexact`, each imported when it is named."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The commands in the order of the table above."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command of this name, or None."""
        if cmd_name not in COMMANDS:
            return None
        module = importlib.import_module(f"mcexact.cli.{cmd_name}")
        command = module.command
        if not isinstance(command, click.Command):
            raise TypeError(f"mcexact.cli.{cmd_name}.command is not a command")
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command that is meant; suggest the nearest one if there is none.

        Raises
        ------
        click.UsageError
            If no command has this name.
        """
        name = args[0]
        if name not in COMMANDS and not name.startswith("-"):
            nearest = difflib.get_close_matches(name, COMMANDS, n=1, cutoff=0.5)
            hint = f"did you mean '{nearest[0]}'?" if nearest else f"one of {', '.join(COMMANDS)}"
            raise click.UsageError(f"there is no command '{name}': {hint}", ctx)
        return super().resolve_command(ctx, args)
