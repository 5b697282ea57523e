"""`mcexact design decentralized`: design a controller without communication."""

from __future__ import annotations

from typing import Any

import click

from mcexact.cli import designing
from mcexact.cli.commands import GroupedCommand
from mcexact.cli.spectra import spectrum_examples


@click.command(
    cls=GroupedCommand,
    name="decentralized",
    short_help="Design a controller without communication.",
    epilog=spectrum_examples("closed_loop", parts=True),
)
@click.argument("file")
@designing.design_options(
    "Roots such as '-1+2i, -3', as text; or JSON {\"closed_loop\": P}, as text or a file, P a list "
    "of coefficients or of roots and pairs, or a mapping from one agent of each strong component "
    "of the transfer graph to such a list."
)
def command(file: str, **given: Any) -> None:
    """Design a decentralized controller for the system in FILE (- for standard input).

    Agent i computes u_i from y_i alone. Without --rate or --radius, half the sensible rate is
    taken. The first line of the answer says whether to install the controller. No linear
    time-invariant controller of this form moves the fixed modes, which remain if they are fast
    enough; if one is too slow, the status is 1 and a certificate proves that no such controller
    exists.
    """
    designing.answer("decentralized", file, given, {})
