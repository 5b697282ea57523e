"""`mcexact sample`: systems drawn with known structure."""

from __future__ import annotations

from pathlib import Path

import click

from mcexact.cli.options import FOLDER, as_json


@click.command(name="sample", short_help="Draw systems with known structure.")
@click.option(
    "--seed", type=int, default=0, show_default=True, help="The same seed, the same system."
)
@click.option("--states", type=click.IntRange(min=0), default=4, show_default=True)
@click.option("--channels", type=click.IntRange(min=1), default=2, show_default=True)
@click.option(
    "--plant-fixed-mode",
    "degree",
    type=click.IntRange(min=1),
    metavar="DEGREE",
    help="Hide a fixed mode in it: an irreducible factor of this degree.",
)
@click.option(
    "--count",
    type=click.IntRange(min=1),
    default=1,
    show_default=True,
    help="How many systems, with seeds that follow one another; needs --output.",
)
@click.option(
    "-o", "--output", type=FOLDER, metavar="DIR", help="Write system files into this directory."
)
@as_json
def command(
    seed: int,
    states: int,
    channels: int,
    degree: int | None,
    count: int,
    output: Path | None,
    as_json: bool,
) -> None:
    """Draw a system that is jointly controllable and observable, and print its system file.

    A system file is JSON, so --json changes nothing here.
    """
    from mcexact.cli.output import directory, emit
    from mcexact.derived.drawn import sample_system
    from mcexact.model.atomic import write_text
    from mcexact.model.system_file import system_text

    if count > 1 and output is None:
        raise click.UsageError("--count needs --output, a directory for the files")
    if degree is not None and degree > states:
        raise click.UsageError(f"a fixed mode of degree {degree} needs at least {degree} states")
    for number in range(seed, seed + count):
        text = system_text(sample_system(number, states, channels, degree))
        if output is None:
            emit(text)
        else:
            write_text(directory(output) / f"sample-{number}.json", text)
