"""Options for what a search aims at, and the aims that they give."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import isfinite
from typing import TYPE_CHECKING, Any, TypeVar

import click

from mcexact.cli import options

if TYPE_CHECKING:
    from mcexact.synthesis.optimum.figures import Aims

F = TypeVar("F", bound=Callable[..., Any])

AIMS = (
    "margin", "damping", "largest_modulus", "largest_gain", "largest_order", "most_digits",
    "effort", "seeds",
)  # fmt: skip


def number(text: str) -> float:
    """Parse a finite number of at least 0."""
    try:
        found = float(text)
    except ValueError:
        found = -1.0
    if not (found >= 0 and isfinite(found)):
        raise click.BadParameter(f"expected a number of at least 0, found '{text}'")
    return found


weights = click.option(
    "--weights",
    metavar="FILE",
    help='JSON {"Q": rows, "R": rows, "W": rows, "V": rows}, or some of them: weights of states '
    "and inputs, and covariances of the noises of states and outputs; by default identities, and "
    "I/100 for V.",
)


damping = click.option(
    "--damping",
    type=options.rational,
    metavar="RATIO",
    help="Every eigenvalue has a damping ratio above RATIO; in discrete time a design aims at it, "
    "which is not certified.",
)

fastest = click.option(
    "--fastest",
    "largest_modulus",
    type=options.rational,
    metavar="MODULUS",
    help="In continuous time: every modulus is below MODULUS.",
)


def aims(function: F) -> F:
    """Add the options of a search; see `aims_of`."""
    for option in (
        click.option(
            "--seeds",
            type=click.IntRange(min=1, max=1000),
            default=4,
            show_default=True,
            metavar="N",
            help="Drawn starts of each order.",
        ),
        click.option(
            "--effort",
            type=number,
            metavar="SECONDS",
            help="About how long a processor of 2024 may search for each rate that is tried, by "
            "counted work; 0 gives the controller of the theorem without a search.",
        ),
        click.option(
            "--digits",
            "most_digits",
            type=click.IntRange(min=1, max=17),
            metavar="N",
            help="Largest number of significant digits of a gain.",
        ),
        click.option(
            "--max-order",
            "largest_order",
            type=click.IntRange(min=0, max=1000),
            metavar="N",
            help="Largest number of states of each agent.",
        ),
        click.option(
            "--max-gain",
            "largest_gain",
            type=number,
            metavar="GAIN",
            help="Largest gain to aim at; by default ten times that of one controller for all.",
        ),
        fastest,
        damping,
        click.option(
            "--margin",
            type=number,
            default=0.3,
            show_default=True,
            help="Margin at the plant's inputs to aim at.",
        ),
        weights,
    ):
        function = option(function)
    return function


def aims_of(given: Mapping[str, Any], weighed: Mapping[str, Any] | None) -> Aims:
    """Return the aims that the options of `aims` and the content of a file of weights give."""
    from mcexact.synthesis.optimum.figures import Aims

    chosen = {name: given[name] for name in AIMS}
    return Aims(weights=weighed, digits=chosen.pop("most_digits"), **chosen)


def read_weights(
    file: tuple[str, bytes] | None, limits: Mapping[str, int]
) -> dict[str, Any] | None:
    """Read a file of weights, an object of lists of rows.

    Raises
    ------
    InputError
        If it is malformed; sizes and entries are checked when the plant is known.
    """
    from mcexact.errors import InputError
    from mcexact.exact.rational import Limits
    from mcexact.model.text import parse

    if file is None:
        return None
    with InputError.inside(file[0]):
        found = parse(file[1], Limits(**limits))
        if not isinstance(found, dict):
            raise InputError('expected an object such as {"Q": rows, "R": rows}')
    return found
