"""What a failure looks like to the user: one message and one exit status."""

from __future__ import annotations

import re

import click

from mcexact.cli.commands import NoCommand
from mcexact.errors import InternalError, McexactError

DEFINITE_NO = 1
WRONG_USAGE = 2
BAD_INPUT = 3
INTERNAL_ERROR = 70
INTERRUPTED = 130


def exit_status(error: BaseException) -> int:
    """The exit status that belongs to an error."""
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
    """What to tell the user about an error, in one line without control characters.

    A group of commands that is called without one is no error to explain: its help is the answer.
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
        # Messages name a limit as Python does; here it is an option.
        text = re.sub(r"\bLimits\.(\w+)", r"--max-\1", f"mcexact: {error}")
    elif isinstance(error, OSError):
        place = f"{error.filename}: " if error.filename is not None else ""
        text = f"mcexact: {place}{error.strerror or error}"
    else:
        text = (
            f"mcexact: internal error, {_described(error)}. This is a bug in mcexact, "
            "not in your input: please report it with the command and the file"
        )
    return printable(text)


def _described(error: BaseException) -> str:
    """The error with its kind, unless it comes with it."""
    return str(error) if isinstance(error, InternalError) else f"{type(error).__name__}: {error}"


def printable(text: str, limit: int = 2000) -> str:
    """The text in one line: control and direction-changing characters escaped, the middle cut out.

    Examples
    --------
    >>> printable("a\\nb")
    'a\\\\nb'
    """
    escaped = "".join(
        letter if letter.isprintable() else letter.encode("unicode_escape").decode("ascii")
        for letter in text
    )
    if len(escaped) <= limit:
        return escaped
    return f"{escaped[: limit // 2]} … {escaped[-limit // 2 :]}"
