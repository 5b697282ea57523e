"""`mcexact sample`: systems drawn with known structure."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from mcexact.cli import options
from mcexact.cli.options import FOLDER, as_json

if TYPE_CHECKING:
    from mcexact.derived.drawn.systems import Draw


@click.command(name="sample", short_help="Draw systems with known structure.")
@click.option(
    "--seed",
    type=int,
    default=0,
    show_default=True,
    help="Seed of the draw; the same seed draws the same system.",
)
@options.draws
@click.option(
    "--count",
    type=click.IntRange(min=1),
    default=1,
    show_default=True,
    help="Number of systems, drawn from consecutive seeds; more than 1 needs --output.",
)
@click.option(
    "-o", "--output", type=FOLDER, metavar="DIR", help="Write system files into this directory."
)
@click.option(
    "--template",
    type=click.Choice(["json", "yaml"]),
    is_flag=False,
    flag_value="json",
    help="Print a small system file to start from, in which every key is explained, instead of a "
    "drawn one: as JSON, or with `--template yaml` with comments.",
)
@as_json
@options.work_limits
def command(
    seed: int,
    count: int,
    output: Path | None,
    template: str | None,
    as_json: bool,
    timeout: float | None,
    max_memory: int | None,
    **drawn: Any,
) -> None:
    """Draw a system that is jointly controllable and observable, or a network, as a system file.

    The output is JSON with and without --json, since a system file is JSON.
    """
    from mcexact.cli.deadline import Deadline
    from mcexact.cli.files import directory, require_writable, say_written
    from mcexact.cli.output import emit
    from mcexact.cli.supervision import supervised
    from mcexact.derived.drawn.systems import Draw
    from mcexact.model.text import write_text

    if template is not None:
        from mcexact.model.system_file import template as starting_file

        if output is not None or count > 1:
            raise click.UsageError("--template prints one file: leave out --output and --count")
        emit(starting_file(template))
        return
    if count > 1 and output is None:
        raise click.UsageError("--count needs --output, the directory for the files")
    require_writable(None, output)
    deadline = Deadline(timeout)
    for number in range(seed, seed + count):
        text = supervised(
            _drawn,
            Draw(number, **drawn),
            doing="drawing a system",
            timeout=deadline,
            max_memory=max_memory,
            libraries=("flint",),
        )
        if output is None:
            emit(text)
        else:
            write_text(directory(output) / f"sample-{number}.json", text)
    if output is not None:
        say_written(output, count)


def _drawn(draw: Draw) -> str:
    """Draw a system and return its file's text, in the child process."""
    from mcexact.derived.drawn.systems import drawn_system
    from mcexact.model.system_file import system_text

    return system_text(drawn_system(draw))
