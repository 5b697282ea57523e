"""`mcexact sample`: systems drawn with known structure."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from mcexact.cli import options
from mcexact.cli.options import FOLDER, as_json


@click.command(name="sample", short_help="Draw systems with known structure.")
@click.option(
    "--seed", type=int, default=0, show_default=True, help="The same seed, the same system."
)
@options.draws
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
    count: int,
    output: Path | None,
    as_json: bool,
    **drawn: Any,
) -> None:
    """Draw a system that is jointly controllable and observable, and print its system file.

    A system file is JSON, so --json changes nothing here.
    """
    from mcexact.cli.files import directory
    from mcexact.cli.output import emit
    from mcexact.derived.draw import Draw, drawn_system
    from mcexact.model.atomic import write_text
    from mcexact.model.system_file import system_text

    if count > 1 and output is None:
        raise click.UsageError("--count needs --output, a directory for the files")
    for number in range(seed, seed + count):
        text = system_text(drawn_system(Draw(number, **drawn)))
        if output is None:
            emit(text)
        else:
            write_text(directory(output) / f"sample-{number}.json", text)
