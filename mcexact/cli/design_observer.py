"""`mcexact design observer`: design a distributed observer-based controller."""

from __future__ import annotations

from typing import Any

import click

from mcexact.cli import designing
from mcexact.cli.commands import GroupedCommand
from mcexact.cli.spectra import spectrum_examples


@click.command(
    cls=GroupedCommand,
    name="observer",
    short_help="Design a distributed observer-based controller.",
    epilog=spectrum_examples("feedback", "error"),
)
@click.argument("file")
@designing.design_options(
    'JSON {"feedback": P, "error": P}, as text or a file, P a list of coefficients or of roots and '
    "pairs.",
    agent_help="The agent with the channel controller; by default the first, in floating point "
    "none where none is needed.",
    searches=False,
)
@click.option(
    "--order",
    type=click.Choice(["least", "low"]),
    help="`least`: the least order that one of the indices allows, instead of m - 1; in floating "
    "point an observer of reduced order. `low`: compare it with a controller of low order over the "
    "same links, whose agents do not estimate the whole state, and keep the better one.",
)
def command(file: str, order: str | None, **given: Any) -> None:
    """Design a distributed observer-based controller for the system in FILE (- for standard input).

    FILE needs a neighbor graph. Without a rate, a radius or a spectrum, half the sensible rate is
    taken. A spectrum has n numbers for the feedback and nm + m - 1 for the estimation errors. If no
    linear time-invariant controller of this form exists, the status is 1 and a certificate proves
    this.
    """
    designing.answer("observer", file, given, {"order": order})
