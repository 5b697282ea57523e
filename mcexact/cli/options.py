"""Options that several commands share, and the types of their values."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any, TypeVar

import click

F = TypeVar("F", bound=Callable[..., Any])


def rational(text: str) -> Fraction:
    """An exact number on the command line, in the number grammar of the files.

    Examples
    --------
    >>> rational("-1/2")
    Fraction(-1, 2)
    """
    from mcexact.errors import InputError
    from mcexact.exact.rational import parse_rational

    try:
        return parse_rational(text)
    except InputError as error:
        raise click.BadParameter(error.message) from None


def seconds(text: str) -> float:
    """A time limit: a finite number of seconds above 0."""
    try:
        number = float(text)
    except ValueError:
        number = 0.0
    if not 0 < number < float("inf"):
        raise click.BadParameter(f"expected a number of seconds above 0, found '{text}'")
    return number


def file_limit(text: str) -> tuple[str, int]:
    """One limit on what a file may ask for, such as ``digits=10000``."""
    import dataclasses

    from mcexact.exact.rational import Limits

    names = [field.name for field in dataclasses.fields(Limits)]
    name, _, number = text.partition("=")
    if name not in names:
        raise click.BadParameter(f"expected one of {', '.join(names)}, found '{name}'")
    if not (number.isascii() and number.isdigit() and len(number) < 16 and int(number) > 0):
        raise click.BadParameter(f"expected a whole number above 0 for {name}, found '{number}'")
    return name, int(number)


FOLDER = click.Path(path_type=Path)

as_json = click.option("--json", "as_json", is_flag=True, help="Print one JSON document.")

certificates = click.option(
    "--certificates",
    "certificates",
    type=FOLDER,
    metavar="DIR",
    help="Write a certificate for every answer into this directory.",
)


file_limits = click.option(
    "--limit",
    "limits",
    type=file_limit,
    multiple=True,
    metavar="NAME=VALUE",
    help="Move a limit that a message named: bytes, depth, digits or exponent.",
)


def work_limits(function: F) -> F:
    """Add the options that limit time and memory."""
    for option in (
        click.option(
            "--max-memory",
            type=click.IntRange(min=1),
            metavar="MIB",
            help="Memory that the computation may use, in MiB; beyond it, status 4.",
        ),
        click.option(
            "--timeout",
            type=seconds,
            metavar="SECONDS",
            help="Time that the computation may take; beyond it, status 4.",
        ),
    ):
        function = option(function)
    return function
