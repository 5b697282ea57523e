"""`mcexact c2d`: sample a plant in continuous time."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Any

import click

from mcexact.cli import options


@click.command(name="c2d", short_help="Sample a plant in continuous time.")
@click.argument("file")
@click.option(
    "--step", type=options.rational, required=True, help="The time between samples, such as 1/10."
)
@click.option(
    "--decimals",
    type=click.IntRange(min=0, max=1000),
    default=12,
    show_default=True,
    help="Decimals to which the matrix exponential is rounded.",
)
@click.option(
    "-o",
    "--output",
    type=options.FOLDER,
    metavar="FILE",
    help="Write the system to this file; by default to standard output.",
)
@options.as_json
@options.work_limits
@options.file_limits
def command(file: str, step: Fraction, decimals: int, output: Path | None, **given: Any) -> None:
    """Sample the system in FILE, whose inputs are held between samples (- for standard input).

    The system file that is written has exact data, and its "source" states by how much they differ
    from the matrix exponential at most. Later answers are about the rounded plant. The output is
    JSON with and without --json, since a system file is JSON.

    Of a file with "uncertainty" the values are sampled, and not the radii: every entry of the
    sampled A and B depends on many of the entries that are uncertain. Decide about the plant in
    continuous time, or give the sampled file an "uncertainty" of its own.
    """
    from mcexact.cli.files import require_other, require_writable, write_result
    from mcexact.cli.output import emit
    from mcexact.cli.running import Run

    run = Run(given)
    require_other(output, file)
    require_writable(output)
    plant = run.read(file)
    text, certain = run.result(
        _sampled, plant, run.limits, step, decimals, doing=f"sampling {plant[0]}"
    )
    if not certain:
        click.echo(
            "mcexact: warning: the values are sampled, and the radii of the file are not carried "
            "over: answers about the sampled plant hold for the values alone",
            err=True,
        )
    if output is None:
        emit(text)
    else:
        write_result(output, text)


def _sampled(
    plant: tuple[str, bytes], limits: dict[str, int], step: Fraction, decimals: int
) -> tuple[str, bool]:
    """Sample a system: its file's text, and whether the plant is certain, in the child process."""
    from mcexact.cli.files import system_in
    from mcexact.model.statespace import c2d
    from mcexact.model.system_file import system_text

    system = system_in(*plant, limits)
    return system_text(c2d(system, step, decimals=decimals)), system.uncertainty is None
