"""`mcexact sample`: systems drawn with known structure."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from mcexact.cli.options import FOLDER, as_json

if TYPE_CHECKING:
    from mcexact.model.system import MultiChannelSystem


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
    is_flag=False,
    flag_value=1,
    metavar="[DEGREE]",
    help="Hide a fixed mode in it: the roots of an irreducible factor of this degree, or of 1.",
)
@click.option(
    "--time",
    "domain",
    type=click.Choice(["continuous", "discrete"]),
    default="continuous",
    show_default=True,
)
@click.option("--neighbors", is_flag=True, help="Draw a strongly connected neighbor graph as well.")
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
    domain: str,
    neighbors: bool,
    count: int,
    output: Path | None,
    as_json: bool,
) -> None:
    """Draw a system that is jointly controllable and observable, and print its system file.

    A system file is JSON, so --json changes nothing here.
    """
    from mcexact.cli.files import directory
    from mcexact.cli.output import emit
    from mcexact.model.atomic import write_text
    from mcexact.model.system_file import system_text

    if count > 1 and output is None:
        raise click.UsageError("--count needs --output, a directory for the files")
    for number in range(seed, seed + count):
        text = system_text(_drawn(number, states, channels, degree, domain, neighbors))
        if output is None:
            emit(text)
        else:
            write_text(directory(output) / f"sample-{number}.json", text)


def _drawn(
    seed: int, states: int, channels: int, degree: int | None, time: str, neighbors: bool
) -> MultiChannelSystem:
    """Draw one system."""
    from mcexact.derived.choices import SeededChoices
    from mcexact.derived.drawn import jointly_controllable_system, system_with_fixed_mode
    from mcexact.derived.drawn_graph import drawn_graph

    choices = SeededChoices(seed)
    if degree is None:
        system = jointly_controllable_system(choices, states, channels, time=time).system
    else:
        system = system_with_fixed_mode(choices, states, channels, degree, time=time).system
    if neighbors:
        graph = drawn_graph(choices, system.names, strongly_connected=True)
        system = system.with_neighbors(graph)
    return system
