"""Groups of commands, which load a command when it is named and suggest the nearest name."""

from __future__ import annotations

import difflib
import importlib
from typing import Any

import click

# The order is that of the help text; each command is the module of that name in this package.
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
    "gallery",
    "sample",
    "convert",
    "c2d",
    "schema",
    "sweep",
)


class NoCommand(click.UsageError):
    """A group was called without a command; the message is its help."""


LAST = "Limits and help"
GROUPS = {
    "Asked of the loop": (
        "rate", "radius", "damping", "largest_modulus", "spectrum", "largest", "round_gains",
        "uncertainty", "largest_uncertainty", "gains", "method", "dimensions", "share", "network",
        "free_assignability", "order", "agent", "arithmetic",
    ),
    "Weights and limits of the search": (
        "weights", "margin", "largest_gain", "largest_order", "most_digits", "effort", "seeds",
    ),
    "Output": ("output", "html", "certificates", "system_by_digest", "as_json"),
    LAST: ("timeout", "max_memory", "help_all"),
    "Reading": ("bytes", "depth", "digits", "exponent"),
}  # fmt: skip
"""The headings under which `GroupedCommand` lists options, with their parameters; others are under
`LAST`."""


class GroupedCommand(click.Command):
    """A command whose help lists its options under the headings of `GROUPS`."""

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options, heading by heading."""
        options = [each for each in self.get_params(ctx) if isinstance(each, click.Option)]
        known = {name: heading for heading, names in GROUPS.items() for name in names}
        sections: dict[str, list[tuple[str, str]]] = {heading: [] for heading in GROUPS}
        for option in options:
            record = option.get_help_record(ctx)
            if record is not None:
                sections[known.get(str(option.name), LAST)].append(record)
        for heading, records in sections.items():
            if records:
                with formatter.section(heading):
                    formatter.write_dl(records)


class Commands(click.Group):
    """A group whose commands are modules of this package, each imported when it is named.

    Parameters
    ----------
    names : tuple of str
        The commands, in the order in which help lists them.
    prefix : str
        The prefix of a command's name in the name of its module.
    **attributes
        Arguments of `click.Group`.
    """

    def __init__(
        self, *, names: tuple[str, ...] = COMMANDS, prefix: str = "", **attributes: Any
    ) -> None:
        super().__init__(**attributes)
        self.names = names
        self.prefix = prefix

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of the commands in the order of help."""
        return list(self.names)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return the command with a name, or None."""
        if cmd_name not in self.names:
            return None
        module = importlib.import_module(f"mcexact.cli.{self.prefix}{cmd_name}")
        command = module.command
        if not isinstance(command, click.Command):
            raise TypeError(f"{module.__name__}.command is not a command")
        return command

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse the options of the group.

        Raises
        ------
        NoCommand
            If no command follows the group, for which versions of click end with different
            statuses.
        """
        if not args and not ctx.resilient_parsing:
            raise NoCommand(ctx.get_help(), ctx)
        return super().parse_args(ctx, args)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command with the given name.

        Raises
        ------
        click.UsageError
            If no command has this name; the message suggests the nearest one.
        """
        name = args[0]
        if name not in self.names and not name.startswith("-"):
            nearest = difflib.get_close_matches(name, self.names, n=1, cutoff=0.5)
            hint = f"did you mean '{nearest[0]}'?" if nearest else f"one of {', '.join(self.names)}"
            raise click.UsageError(f"there is no command '{name}': {hint}", ctx)
        return super().resolve_command(ctx, args)
