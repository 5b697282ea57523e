"""Groups of commands: loaded one by one, and a near miss is answered with the nearest name."""

from __future__ import annotations

import difflib
import importlib
from typing import Any

import click

# In the order in which a user meets them; each is the module of that name in this package.
COMMANDS = (
    "analyze",
    "check",
    "allocate",
    "design",
    "certify",
    "crosscheck",
    "simulate",
    "reproduce",
    "demo",
    "sample",
    "sweep",
)


class NoCommand(click.UsageError):
    """A group is called without a command; the message is its help, which lists them."""


class Commands(click.Group):
    """A group whose commands are modules of this package, each imported when it is named.

    Parameters
    ----------
    names : tuple of str
        The commands, in the order in which help lists them.
    prefix : str
        What stands before a command's name in the name of its module.
    **attributes
        Of `click.Group`.
    """

    def __init__(
        self, *, names: tuple[str, ...] = COMMANDS, prefix: str = "", **attributes: Any
    ) -> None:
        super().__init__(**attributes)
        self.names = names
        self.prefix = prefix

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The commands in the order of the table."""
        return list(self.names)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command of this name, or None."""
        if cmd_name not in self.names:
            return None
        module = importlib.import_module(f"mcexact.cli.{self.prefix}{cmd_name}")
        command = module.command
        if not isinstance(command, click.Command):
            raise TypeError(f"{module.__name__}.command is not a command")
        return command

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Read the options of the group.

        Raises
        ------
        NoCommand
            If nothing follows the group; of this, versions of click make different statuses.
        """
        if not args and not ctx.resilient_parsing:
            raise NoCommand(ctx.get_help(), ctx)
        return super().parse_args(ctx, args)

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
        if name not in self.names and not name.startswith("-"):
            nearest = difflib.get_close_matches(name, self.names, n=1, cutoff=0.5)
            hint = f"did you mean '{nearest[0]}'?" if nearest else f"one of {', '.join(self.names)}"
            raise click.UsageError(f"there is no command '{name}': {hint}", ctx)
        return super().resolve_command(ctx, args)
