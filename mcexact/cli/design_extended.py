"""`mcexact design extended`: design a controller with shared sub-states of least dimension."""

from __future__ import annotations

from typing import Any

import click

from mcexact.cli import designing, options
from mcexact.cli.commands import GroupedCommand
from mcexact.cli.spectra import spectrum_examples


@click.command(
    name="extended",
    cls=GroupedCommand,
    short_help="Design a controller with shared sub-states.",
    epilog=spectrum_examples("closed_loop"),
)
@click.argument("file")
@designing.design_options(
    "Roots such as '-1+2i, -3', as text; or JSON {\"closed_loop\": P}, as text or a file, P a list "
    "of coefficients or of roots and pairs, without constraint."
)
@click.option(
    "--dimensions",
    default="minimal",
    show_default=True,
    metavar="WHICH",
    help="`minimal`, `bound` (Theorem 2's), or n_1,n_2,… in the order of the channels.",
)
@click.option(
    "--share",
    type=click.Choice(["outputs+states", "states"]),
    help="Signals that agents send; by default both, but with holding sub-states alone.",
)
@click.option(
    "--network",
    type=click.Choice(["extended", "lifted", "held"]),
    help="With delays: `lifted` (the mode 0 is fixed) or `held` (no mode is fixed). By default a "
    "search tries both and keeps the cheaper one; else it is `lifted`.",
)
@click.option(
    "--free",
    "free_assignability",
    is_flag=True,
    help="Share enough that the whole spectrum can be assigned without partition.",
)
def command(
    file: str,
    dimensions: str,
    share: str | None,
    network: str | None,
    free_assignability: bool,
    **given: Any,
) -> None:
    """Design a distributed controller through the extended system of FILE (- for standard input).

    FILE needs a neighbor graph, and may have delays in discrete time. Agents share sub-states; the
    controller file says for how many steps agents hold them. If no shared dimensions suffice for
    linear time-invariant control, the status is 1.
    """
    sizes: str | list[int] = dimensions
    if dimensions not in ("minimal", "bound"):
        try:
            sizes = [options.count(part) for part in dimensions.split(",")]
        except ValueError:
            raise click.BadParameter(
                f"expected minimal, bound or integers >= 0 such as 0,0,1, found '{dimensions}'",
                param_hint="--dimensions",
            ) from None
    wanted = {
        "dimensions": sizes,
        "share": share,
        "network": network,
        "free_assignability": free_assignability,
    }
    designing.answer("extended", file, given, wanted)
