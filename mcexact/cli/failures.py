"""The message and the exit status that a failure gives the user."""

from __future__ import annotations

import re

import click

from mcexact.analysis.questions import QUESTIONS
from mcexact.cli.commands import NoCommand
from mcexact.errors import InternalError, McexactError

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
