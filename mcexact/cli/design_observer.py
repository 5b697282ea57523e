"""`mcexact design observer`: the distributed observer with a prescribed spectrum."""

from __future__ import annotations

from typing import Any

import click

from mcexact.cli import designing


@click.command(name="observer", short_help="A distributed observer with a prescribed spectrum.")
@click.argument("file")
@designing.design_options(
    'JSON {"feedback": P, "error": P}, P a list of coefficients or of roots and pairs.',
    agent_help="Who carries the channel controller; else the first.",
)
@click.option(
    "--order",
    type=click.Choice(["least"]),
    help="The least order that one of the indices allows, instead of m - 1; in floating point "
    "an observer of reduced order.",
)
def command(file: str, order: str | None, **given: Any) -> None:
    """Design a distributed observer-based controller for the system in FILE (- for standard input).

    FILE needs a neighbor graph. Give a rate or radius, or all the numbers: n for the feedback and
    nm + m - 1 for the estimation errors. If no linear time-invariant controller of this form
    exists, the status is 1 and the certificate says why.
    """
    designing.answer("observer", file, given, {"order": order})
