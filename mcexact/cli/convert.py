"""Commands that make files: convert, c2d, sample, gallery, schema."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from mcexact.cli import options
from mcexact.cli.options import FOLDER, as_json
from mcexact.cli.uncertainty import at_values

if TYPE_CHECKING:
    from mcexact.derived.drawn.systems import Draw
    from mcexact.exact.matrix import Rounding


# `mcexact convert`: a system file of one kind as one of another kind.


def sizes(text: str) -> tuple[int, ...]:
    """Parse sizes of channels, integers between commas."""
    try:
        return tuple(options.count(part.strip()) for part in text.split(","))
    except ValueError:
        raise click.BadParameter(f"expected integers such as 1,2, found '{text}'") from None


@click.command(name="convert", short_help="Convert system files of MATLAB, numpy and others.")
@click.argument("file")
@click.option(
    "-o",
    "--output",
    type=options.FOLDER,
    metavar="FILE",
    help="Write the system to this file, of the kind that its end says: .json, .yaml, .mat, .npz, "
    "or a folder for .csv files if there is none; by default as JSON to standard output.",
)
@click.option(
    "--rounding",
    type=click.Choice(["decimal", "dyadic"]),
    help="How floats in .mat and .npz files become exact: by the shortest decimal that prints them "
    "(0.1 is 1/10), or by the binary value that is stored. In an output file, numbers become "
    "floats from which this rounding makes them again.",
)
@click.option(
    "--nearest",
    is_flag=True,
    help="Write numbers that no float is as the nearest floats, which are another system.",
)
@click.option("--inputs", type=sizes, metavar="SIZES", help="Columns of a stacked B per channel.")
@click.option("--outputs", type=sizes, metavar="SIZES", help="Rows of a stacked C per channel.")
@at_values("write the system at this value of a parameter", "Repeat it for each parameter.")
@options.as_json
@options.work_limits
@options.file_limits
def convert_command(file: str, output: Path | None, **given: Any) -> None:
    """Convert the system in FILE, a .json, .yaml, .mat or .npz file or a folder of .csv files.

    Arrays are named A, B_1, C_1, B_2, C_2 and so on; or A, and the stacked B and C, with the sizes
    of the channels in inputs and outputs; in MATLAB B and C may be cells. Optional are time,
    sample_time, names, neighbors (row i marks whose messages agent i receives), delays, name and
    source. Nothing is lost: numbers that the output cannot hold are an error. A system with
    parameters is written as JSON, which YAML is too, or with --at in every kind.
    """
    from mcexact.cli.files import (
        emit,
        require_other,
        require_replaceable,
        require_writable,
        write_folder,
        write_result,
    )
    from mcexact.cli.running import Run
    from mcexact.model.arrays import MARK
    from mcexact.model.files import is_folder, require_suffix

    run = Run(given)
    if output is not None:
        require_suffix(output)
    require_other(output, file)
    if output is not None and is_folder(output):
        require_replaceable(output, MARK)
    else:
        require_writable(output)
    plant = run.read(file)
    target = "plant.json" if output is None else str(output)
    made = run.result(_converted, plant, run.limits, target, given, doing=f"converting {plant[0]}")
    if output is None:
        emit(made.decode("ascii"))
    elif isinstance(made, bytes):
        write_result(output, made)
    else:
        write_folder(output, made)


def _converted(
    plant: tuple[str, bytes],
    limits: dict[str, int],
    target: str,
    given: dict[str, Any],
) -> bytes | dict[str, str]:
    """Read a system and return the contents of the output, in the child process."""
    from mcexact.errors import InputError
    from mcexact.exact.rational import Limits
    from mcexact.model.arrays import Reading
    from mcexact.model.files import read_plant, system_files
    from mcexact.model.parametric import ParametricSystem

    place, data = plant
    rounding: Rounding | None = given["rounding"]
    with InputError.inside(place):
        how = Reading(Limits(**limits), rounding, given["inputs"], given["outputs"])
        system = read_plant(data, place, how)
        if given["at"]:
            if not isinstance(system, ParametricSystem):
                raise InputError("found a system without parameters: leave out --at")
            system = system.at(dict(given["at"]))
    with InputError.inside(target):
        return system_files(
            system, target, rounding=_used(rounding, target), nearest=given["nearest"]
        )


def _used(rounding: Rounding | None, target: str) -> Rounding | None:
    """The rounding for the output; other kinds of files need none, and the input may."""
    return rounding if target.lower().endswith((".mat", ".npz")) else None


# `mcexact c2d`: sample a plant in continuous time.


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
def c2d_command(
    file: str, step: Fraction, decimals: int, output: Path | None, **given: Any
) -> None:
    """Sample the system in FILE, whose inputs are held between samples (- for standard input).

    The system file that is written has exact data, and its "source" states by how much they differ
    from the matrix exponential at most. Later answers are about the rounded plant. The output is
    JSON with and without --json, since a system file is JSON.

    Of a file with "uncertainty" the values are sampled, and not the radii: every entry of the
    sampled A and B depends on many of the entries that are uncertain. Decide about the plant in
    continuous time, or give the sampled file an "uncertainty" of its own.
    """
    from mcexact.cli.files import emit, require_other, require_writable, write_result
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


# `mcexact sample`: systems drawn with known structure.


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
def sample_command(
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
    from mcexact.cli.files import Deadline, directory, emit, require_writable, say_written
    from mcexact.cli.running import supervised
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


# `mcexact gallery`: the published plants that every command takes by name.


@click.command(name="gallery", short_help="List published plants, which every command takes.")
@options.as_json
def gallery_command(as_json: bool) -> None:
    """List the published plants with their sources and what each shows.

    Every command takes one as gallery:NAME in place of a file, such as `mcexact analyze
    gallery:quadruple-tank-pminus`; `mcexact convert gallery:NAME -o FILE` writes its file.
    """
    from dataclasses import asdict

    from mcexact.cli.files import emit_json, emit_tables
    from mcexact.model.gallery import published
    from mcexact.report.text import WIDE, Table, shorten

    plants = published()
    if as_json:
        emit_json({"format": "mcexact-gallery/1", "plants": [asdict(each) for each in plants]})
        return
    rows = tuple(
        (
            each.name,
            str(each.n),
            str(each.m),
            ", ".join(each.parameters),
            each.time,
            shorten(each.source, 60),
            each.shows,
        )
        for each in plants
    )
    note = "mcexact analyze gallery:NAME"
    columns = ("name", "n", "m", "parameters", "time", "source", "shows")
    emit_tables((Table("", columns, rows, note),), width=WIDE)


# `mcexact schema`: JSON Schemas of files and of the JSON of commands.


@click.command(name="schema", short_help="Print a JSON Schema of files or of --json.")
@click.argument("name", required=False)
@as_json
def schema_command(name: str | None, as_json: bool) -> None:
    """Print the JSON Schema (2020-12) NAME, or list all of them with their folder.

    Editors complete and check system files by it, and programs what the commands print. The output
    for a NAME is JSON with and without --json.
    """
    from mcexact.cli.files import emit, emit_json, emit_tables
    from mcexact.report.schema import DOCUMENTS, FOLDER, schema_text
    from mcexact.report.text import Table

    if name is not None:
        emit(schema_text(name))
    elif as_json:
        emit_json(
            {"folder": str(FOLDER), "schemas": {key: told for key, (_, told) in DOCUMENTS.items()}}
        )
    else:
        listed = tuple((key, told) for key, (_, told) in DOCUMENTS.items())
        emit_tables((Table(f"schemas in {FOLDER}", (), listed, "mcexact schema NAME"),))
