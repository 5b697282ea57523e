"""Groups of commands, and the message and status of a failure.

A group knows of each command where it stands and what help says of it in one line (`Listed`), so
that the list of commands, their completion in a shell, and the hint after a misspelled name load no
command.  A command is imported when it is named, with all that it needs.
"""

from __future__ import annotations

import difflib
import importlib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import click
from click.shell_completion import CompletionItem

from mcexact.analysis.questions import QUESTIONS
from mcexact.errors import InternalError, McexactError


@dataclass(frozen=True)
class Listed:
    """What a group knows of a command that is not loaded.

    Attributes
    ----------
    place : str
        Its module below `mcexact.cli`, and its name there, such as ``"sweep:command"``.
    help : str
        The line of help about it, which is its ``short_help``.
    """

    place: str
    help: str

    def load(self) -> click.Command:
        """Import the command."""
        home, _, name = self.place.partition(":")
        command = getattr(importlib.import_module(f"mcexact.cli.{home}"), name)
        if not isinstance(command, click.Command):
            raise TypeError(f"{self.place} is not a command")
        return command


COMMANDS = {
    "analyze": Listed(
        "analyze:command", "Decide which modes are fixed, and all other questions about a system."
    ),
    "check": Listed("check:command", "Verify certificates with the independent checker."),
    "allocate": Listed("allocate:command", "Find the least that agents must share, and prove it."),
    "design": Listed("design:design_command", "Design a controller and prove its closed loop."),
    "certify": Listed("certify:command", "Decide whether a controller stabilizes, with proof."),
    "crosscheck": Listed(
        "reproduce:crosscheck_command", "Compare floating-point verdicts with the exact ones."
    ),
    "simulate": Listed("simulate:command", "Run a controller as a network of agents."),
    "reproduce": Listed(
        "reproduce:reproduce_command", "Say of every statement of the paper what is known."
    ),
    "demo": Listed(
        "reproduce:demo_command", "Show two wrong answers of floating point with the exact ones."
    ),
    "gallery": Listed(
        "convert:gallery_command", "List published plants, which every command takes."
    ),
    "sample": Listed("convert:sample_command", "Draw systems with known structure."),
    "convert": Listed(
        "convert:convert_command", "Convert system and controller files of other kinds."
    ),
    "c2d": Listed("convert:c2d_command", "Sample a plant in continuous time."),
    "export": Listed("export:command", "Write a controller as C or Structured Text."),
    "schema": Listed("convert:schema_command", "Print a JSON Schema of files or of --json."),
    "sweep": Listed("sweep:command", "Answer the same questions about many systems."),
}
"""The commands in the order of the help text."""


class NoCommand(click.UsageError):
    """A group was called without a command; the message is its help."""


LAST = "Limits and help"
GROUPS = {
    "Asked of the loop": (
        "step", "late", "rate", "radius", "damping", "largest_modulus", "spectrum", "largest",
        "round_gains", "uncertainty", "largest_uncertainty", "gains", "method", "dimensions",
        "share", "network", "free_assignability", "order", "agent", "arithmetic",
    ),
    "Weights and limits of the search": (
        "weights", "sizes", "margin", "disk", "box", "largest_gain", "largest_order", "most_digits",
        "effort", "seeds",
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
    """A group whose commands are each imported when they are named.

    Parameters
    ----------
    listed : mapping from names to Listed
        The commands, in the order of help.
    **attributes
        Arguments of `click.Group`.
    """

    def __init__(
        self, *, listed: Mapping[str, Listed] = MappingProxyType(COMMANDS), **attributes: Any
    ) -> None:
        super().__init__(**attributes)
        self.listed = listed

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of the commands in the order of help."""
        return list(self.listed)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import and return the command with a name; None if there is none."""
        return self.listed[cmd_name].load() if cmd_name in self.listed else None

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list of commands, without loading them."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, each.help) for name, each in self.listed.items()])

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """Complete the name of a command, without loading one, or an option of the group."""
        names = [
            CompletionItem(name, help=each.help)
            for name, each in self.listed.items()
            if name.startswith(incomplete)
        ]
        return names + click.Command.shell_complete(self, ctx, incomplete)

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
        if name not in self.listed and not name.startswith("-"):
            nearest = difflib.get_close_matches(name, self.listed, n=1, cutoff=0.5)
            hint = (
                f"did you mean '{nearest[0]}'?" if nearest else f"one of {', '.join(self.listed)}"
            )
            raise click.UsageError(f"there is no command '{name}': {hint}", ctx)
        return super().resolve_command(ctx, args)


# The message and the exit status that a failure gives the user.

DEFINITE_NO = 1
WRONG_USAGE = 2
BAD_INPUT = 3
INTERNAL_ERROR = 70
INTERRUPTED = 130


def exit_status(error: BaseException) -> int:
    """Return the exit status of an error."""
    if isinstance(error, McexactError):
        return error.exit_status
    if isinstance(error, click.UsageError):
        return WRONG_USAGE
    if isinstance(error, click.Abort | KeyboardInterrupt):
        return INTERRUPTED
    if isinstance(error, OSError | click.ClickException):
        return BAD_INPUT
    return INTERNAL_ERROR


def one_message(error: BaseException) -> str:
    """Return the message of an error in one line without control characters.

    For a group called without a command the message is the group's help.
    """
    if isinstance(error, NoCommand):
        return error.format_message()
    if isinstance(error, click.Abort | KeyboardInterrupt):
        text = "interrupted"
    elif isinstance(error, click.UsageError):
        command = error.ctx.command_path if error.ctx is not None else "mcexact"
        problem = error.format_message().strip().rstrip(".")
        text = f"{command}: {problem} (see {command} --help)"
    elif isinstance(error, click.ClickException):
        text = f"mcexact: {error.format_message()}"
    elif isinstance(error, McexactError) and error.exit_status != INTERNAL_ERROR:
        # A library message names a limit as an attribute of Limits, and a question as the table
        # has it; on the command line they are options.
        text = re.sub(r"\bLimits\.(\w+)", r"--max-\1", f"mcexact: {error}")
        text = re.sub(r"\bthe question '(\w+)'", _option, text)
    elif isinstance(error, OSError):
        place = f"{error.filename}: " if error.filename is not None else ""
        text = f"mcexact: {place}{error.strerror or error}"
    else:
        text = (
            f"mcexact: internal error, {_described(error)}. This is a bug in mcexact, "
            "not in your input: please report it with the command and the file"
        )
    return _printable(text)


def _option(question: re.Match[str]) -> str:
    """The option that asks a question."""
    option = QUESTIONS[question[1]].option
    return f"--{option}" if option else f"--also {question[1]}"


def _described(error: BaseException) -> str:
    """The text of an error, with its type unless it is an InternalError."""
    return str(error) if isinstance(error, InternalError) else f"{type(error).__name__}: {error}"


def _printable(text: str, limit: int = 2000) -> str:
    """Return a text in one line, with control and bidirectional characters escaped and shortened.

    Examples
    --------
    >>> _printable("a\\nb")
    'a\\\\nb'
    """
    escaped = "".join(
        letter if letter.isprintable() else letter.encode("unicode_escape").decode("ascii")
        for letter in text
    )
    if len(escaped) <= limit:
        return escaped
    return f"{escaped[: limit // 2]} … {escaped[-limit // 2 :]}"
