"""Options that several commands share, and the types of their values."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any, TypeVar

import click

F = TypeVar("F", bound=Callable[..., Any])


class Rational(click.ParamType):
    """An exact number on the command line: the number grammar of the files, such as -1/2."""

    name = "rational"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> Fraction:
        """The fraction that the text stands for."""
        if isinstance(value, Fraction):
            return value
        from mcexact.errors import InputError
        from mcexact.exact.rational import parse_rational

        try:
            return parse_rational(str(value))
        except InputError as error:
            self.fail(error.message, param, ctx)


class FileLimit(click.ParamType):
    """One limit on what a file may ask for, such as ``digits=10000``."""

    name = "limit"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, int]:
        """The name of the limit and its value."""
        import dataclasses

        from mcexact.model.json_text import FileLimits

        names = [field.name for field in dataclasses.fields(FileLimits)]
        name, _, number = str(value).partition("=")
        if name not in names:
            self.fail(f"expected one of {', '.join(names)}, found '{name}'", param, ctx)
        if not (number.isascii() and number.isdigit() and len(number) < 16 and int(number) > 0):
            self.fail(f"expected a whole number above 0 for {name}, found '{number}'", param, ctx)
        return name, int(number)


class Seconds(click.ParamType):
    """A time limit: a finite number of seconds above 0."""

    name = "seconds"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """The number of seconds."""
        try:
            seconds = float(value)
        except ValueError:
            seconds = 0.0
        if not 0 < seconds < float("inf"):
            self.fail(f"expected a number of seconds above 0, found '{value}'", param, ctx)
        return seconds


RATIONAL = Rational()
SECONDS = Seconds()
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
    type=FileLimit(),
    multiple=True,
    metavar="NAME=VALUE",
    help="Move a limit that a message named: size, depth, digits, exponent or cells.",
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
            type=SECONDS,
            metavar="SECONDS",
            help="Time that the computation may take; beyond it, status 4.",
        ),
    ):
        function = option(function)
    return function
