"""Options that several commands share, and the types of their values."""

from __future__ import annotations

from collections.abc import Callable, Mapping
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


def count(text: str) -> int:
    """An integer of at least 0, in digits and nothing else; what is not one is a ValueError."""
    if not (text.isascii() and text.isdigit()):
        raise ValueError(text)
    return int(text)


def seconds(text: str) -> float:
    """A time limit: a finite number of seconds above 0."""
    try:
        number = float(text)
    except ValueError:
        number = 0.0
    if not 0 < number < float("inf"):
        raise click.BadParameter(f"expected a number of seconds above 0, found '{text}'")
    return number


FOLDER = click.Path(path_type=Path)

rate = click.option("--rate", type=rational, help="Continuous time: every real part below -RATE.")

radius = click.option("--radius", type=rational, help="Discrete time: every modulus below RADIUS.")

arithmetic = click.option(
    "--arithmetic",
    type=click.Choice(["exact", "float"]),
    default="exact",
    show_default=True,
    help="Exact assigns every number, for small systems; float meets a rate or radius. "
    "The proof is exact either way; the gains of float differ a little between processors.",
)

controller_output = click.option(
    "-o",
    "--output",
    type=FOLDER,
    metavar="FILE",
    help="Write the controller here; else it goes to standard output.",
)

as_json = click.option("--json", "as_json", is_flag=True, help="Print one JSON document.")

certificates = click.option(
    "--certificates",
    "certificates",
    type=FOLDER,
    metavar="DIR",
    help="Write a certificate for every answer into this directory.",
)


def file_limits(function: F) -> F:
    """Add the options that move the limits on what a file may ask for.

    The command gets them as keywords, ``bytes`` and so on; see `given`.
    """
    for name, what in (
        ("exponent", "exponent of a decimal"),
        ("digits", "number of digits"),
        ("depth", "nesting"),
        ("bytes", "size of a file"),
    ):
        function = click.option(
            f"--max-{name}",
            name,
            type=click.IntRange(min=1, max=10**15),
            metavar="N",
            help=f"Largest {what} that is read.",
        )(function)
    return function


def given(limits: Mapping[str, int | None]) -> dict[str, int]:
    """The limits that were moved."""
    return {name: limit for name, limit in limits.items() if limit is not None}


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


def draws(function: F) -> F:
    """Add the options that say what systems are drawn: the fields of a `Draw` but its seed."""
    for option in (
        click.option(
            "--neighbors", is_flag=True, help="Draw a strongly connected neighbor graph as well."
        ),
        click.option(
            "--time",
            type=click.Choice(["continuous", "discrete"]),
            default="continuous",
            show_default=True,
        ),
        click.option(
            "--plant-fixed-mode",
            "fixed_degree",
            type=click.IntRange(min=1),
            is_flag=False,
            flag_value=1,
            metavar="[DEGREE]",
            help="Hide a fixed mode in it: the roots of an irreducible factor of this degree, "
            "or of 1.",
        ),
        click.option("--channels", type=click.IntRange(min=1), default=2, show_default=True),
        click.option("--states", type=click.IntRange(min=0), default=4, show_default=True),
    ):
        function = option(function)
    return function
