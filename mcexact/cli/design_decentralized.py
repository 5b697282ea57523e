"""`mcexact design decentralized`: a controller without any message."""

from __future__ import annotations

from typing import Any

import click

from mcexact.cli import designing


@click.command(name="decentralized", short_help="A controller without any message.")
@click.argument("file")
@designing.design_options(
    'JSON {"closed_loop": P}, P a list of coefficients or of roots and pairs, or a mapping from '
    "one agent of each strong component of the transfer graph to such a list."
)
def command(file: str, **given: Any) -> None:
    """Design a decentralized controller for the system in FILE (- for standard input).

    Agent i makes u_i of y_i alone. Fixed modes, which no linear time-invariant controller of this
    kind moves, stay if they are fast enough; if one is not, the status is 1 and the certificate
    says why.
    """
    designing.answer("decentralized", file, given, {})
