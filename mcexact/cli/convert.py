"""Commands that make files: convert, c2d, sample, gallery, schema.

What reads a file of a user runs in a child process, within the limits on time and memory, as it is
in the commands that decide.  `convert_command` refuses what the output cannot hold, and gives the
floats of an output the rounding that makes the same numbers of them again.  `c2d_command` says in
the file by how much a sampled plant differs from the exact one.
"""

from __future__ import annotations

from dataclasses import asdict
from fractions import Fraction
from pathlib import Path
from typing import Any, get_args

import click

from mcexact.cli import options, parts
from mcexact.cli.files import (
    Deadline,
    directory,
    emit_tables,
    require_other,
    require_replaceable,
    require_writable,
    say_written,
    system_in,
    write_folder,
    write_result,
)
from mcexact.cli.options import FOLDER, as_json
from mcexact.cli.output import emit, emit_json
from mcexact.cli.results import Converted
from mcexact.cli.running import Run, supervised
from mcexact.derived.drawn.systems import Draw, drawn_system
from mcexact.errors import InputError, UsageError
from mcexact.exact.matrix import Rounding
from mcexact.exact.rational import Limits
from mcexact.model.arrays import MARK, Reading
from mcexact.model.controller import (
    controller_bytes,
    controller_text,
    doubts_about_floats,
    is_controller,
    read_controller,
)
from mcexact.model.files import is_folder, read_plant, require_suffix, system_files
from mcexact.model.gallery import published
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import system_text
from mcexact.model.system_file import template as starting_file
from mcexact.model.text import write_text
from mcexact.report.schema import DOCUMENTS, schema_text
from mcexact.report.schema import FOLDER as SCHEMAS
from mcexact.report.text import WIDE, Table, shorten

_ASKED = ("fixed_spectrum", "joint_controllability", "joint_observability")
"""What plants nearby may lack."""


def sizes(text: str) -> tuple[int, ...]:
    """Parse sizes of channels, integers between commas."""
    try:
        return tuple(options.count(part.strip()) for part in text.split(","))
    except ValueError:
        raise click.BadParameter(f"expected integers such as 1,2, found '{text}'") from None


@click.command(name="convert", short_help="Convert system and controller files of other kinds.")
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
    type=click.Choice(get_args(Rounding)),
    help="How floats in .mat and .npz files become exact, by default simplest: a short fraction or "
    "decimal within 4 units in the last place (1/3 comes back), or else decimal: the shortest "
    "decimal that prints the float (0.1 is 1/10); dyadic: the binary value that is stored. In an "
    "output file, numbers become floats from which this rounding makes them again.",
)
@click.option(
    "--nearest",
    is_flag=True,
    help="Write numbers that no float is as the nearest floats, which are another system.",
)
@click.option("--inputs", type=sizes, metavar="SIZES", help="Columns of a stacked B per channel.")
@click.option("--outputs", type=sizes, metavar="SIZES", help="Rows of a stacked C per channel.")
@parts.option("Write")
@options.at_values("write the system at this value of a parameter", "Repeat it for each parameter.")
@options.as_json
@options.work_limits
@options.file_limits
def convert_command(file: str, output: Path | None, **values: Any) -> None:
    """Convert the system in FILE, a .json, .yaml, .mat or .npz file or a folder of .csv files.

    A controller in FILE is converted as well, between .json, .mat and .npz: u_1_y_2 is the matrix
    of y_2 in u_1, x_1_z that of z_1 in the next x_1, and so on.

    Arrays are named A, B_1, C_1, B_2, C_2 and so on; or A, and the stacked B and C, with the sizes
    of the channels in inputs and outputs; in MATLAB B and C may be cells. Optional are time,
    sample_time, names, neighbors (row i marks whose messages agent i receives), delays, name and
    source. Nothing is lost: numbers that the output cannot hold are an error. Of a plant in floats
    it warns where an answer is another one but for rounding errors. A system with
    parameters is written as JSON, which YAML is too, or with --at in every kind. With --modulo both
    the system is a minimal realization: the fewest states with the same transfer matrix.
    """
    run = Run(values)
    if output is not None:
        require_suffix(output)
    require_other(output, file, parts.file_of(values))
    if output is not None and is_folder(output):
        require_replaceable(output, MARK)
    else:
        require_writable(output)
    plant, part = run.read(file), parts.taken(values, run)
    target = "plant.json" if output is None else str(output)
    made = run.result(
        _converted,
        plant,
        run.limits,
        target,
        values["rounding"],
        values["inputs"],
        values["outputs"],
        values["nearest"],
        dict(values["at"]),
        part,
        doing=f"converting {plant[0]}",
    )
    for warning in made.warnings:
        click.echo(f"mcexact: warning: {warning}", err=True)
    if not isinstance(made.content, bytes):
        write_folder(Path(target), made.content)
    elif output is None:
        emit(made.content.decode("ascii"))
    else:
        write_result(output, made.content)


def _converted(
    plant: tuple[str, bytes],
    limits: dict[str, int],
    target: str,
    rounding: Rounding | None,
    inputs: tuple[int, ...] | None,
    outputs: tuple[int, ...] | None,
    nearest: bool,
    at: dict[str, Fraction],
    part: parts.Part,
) -> Converted:
    """Read a system and return the contents of the output, in the child process."""
    place, data = plant
    if is_controller(data, Limits(**limits)):
        if inputs or outputs or at or part is not None:
            raise UsageError("found a controller: leave out --inputs, --outputs, --at and --modulo")
        return _controller(place, data, Limits(**limits), target, rounding, nearest)
    with InputError.inside(place):
        system = read_plant(data, place, Reading(Limits(**limits), rounding, inputs, outputs))
        if at:
            if not isinstance(system, ParametricSystem):
                raise InputError("found a system without parameters: leave out --at")
            system = system.at(at)
    system = parts.without(system, part, limits)
    with InputError.inside(target):
        content = system_files(system, target, rounding=_used(rounding, target), nearest=nearest)
    return Converted(content, _warnings(system))


def _controller(
    place: str,
    data: bytes,
    limits: Limits,
    target: str,
    rounding: Rounding | None,
    nearest: bool,
) -> Converted:
    """Read a controller and return the contents of the output."""
    if Path(target).suffix.lower() not in _CONTROLLERS:
        kinds = ", ".join(_CONTROLLERS)
        raise UsageError(f"no controller is written to such a file: choose {kinds}", where=target)
    with InputError.inside(place):
        controller = read_controller(data, limits, rounding)
        doubts = [] if rounding else doubts_about_floats(data, limits)
    used = _used(rounding, target)
    with InputError.inside(target):
        content = controller_bytes(controller, target, rounding=used, nearest=nearest)
    return Converted(content, doubts)


_CONTROLLERS = (".json", ".mat", ".npz")
"""The ends of the names of files that controllers are written to."""


def _warnings(system: MultiChannelSystem | ParametricSystem) -> list[str]:
    """Say of a plant in floats which plants that its rounding errors hide have other answers.

    It is looked for the same as `mcexact analyze` looks for by default.
    """
    if isinstance(system, ParametricSystem) or system.rounding is None:
        return []
    # Only there: floating point needs numpy, whose threads forbid that this process is forked.
    from mcexact.analysis.analyze import analyze

    analysis = analyze(system, _ASKED)
    if analysis.nearby_left_out:
        return []
    return list(analysis.nearby.doubts)


def _used(rounding: Rounding | None, target: str) -> Rounding | None:
    """The rounding for the output; other kinds of files need none, and the input may."""
    return rounding if target.lower().endswith((".mat", ".npz")) else None


@click.command(name="c2d", short_help="Sample a plant in continuous time.")
@click.argument("file")
@click.option(
    "--step", type=options.rational, required=True, help="The time between samples, such as 1/10."
)
@click.option(
    "--late",
    type=click.IntRange(min=0),
    default=0,
    show_default=True,
    metavar="STEPS",
    help="Apply every input so many steps late: inputs under way become states.",
)
@click.option(
    "--decimals",
    type=click.IntRange(min=0, max=1000),
    default=12,
    show_default=True,
    help="Decimals to which the matrix exponential is rounded.",
)
@click.option(
    "--enclose",
    is_flag=True,
    help="Give the file radii that contain the exact samples, also where FILE has none.",
)
@click.option(
    "--controller",
    metavar="FILE",
    help="Write this controller in continuous time, in place of the plant, for its samples: by "
    "Tustin's rule, rounded to as many significant digits.",
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
    file: str,
    step: Fraction,
    late: int,
    decimals: int,
    enclose: bool,
    controller: str | None,
    output: Path | None,
    **values: Any,
) -> None:
    """Sample the system in FILE, whose inputs are held between samples (- for standard input).

    The system file that is written has exact data, and its "source" states by how much they differ
    from the matrix exponential at most. The output is JSON with and without --json, since a system
    file is JSON.

    If FILE has an "uncertainty", so has the sampled file: it contains the exact samples of every
    plant within the radii of FILE. What is proved for every plant within these radii is proved for
    the exact samples; all other answers are about the rounded values. The radii grow with the step.
    """
    run = Run(values)
    require_other(output, file, controller)
    require_writable(output)
    plant = run.read(file)
    program = None if controller is None else run.read(controller)
    how = {"step": step, "late": late, "decimals": decimals, "enclosed": enclose}
    sampled = run.result(_sampled, plant, program, run.limits, how, doing=f"sampling {plant[0]}")
    if output is None:
        emit(sampled)
    else:
        write_result(output, sampled)


def _sampled(
    plant: tuple[str, bytes],
    program: tuple[str, bytes] | None,
    limits: dict[str, int],
    how: dict[str, Any],
) -> str:
    """Sample a system, or a controller for it, in the child process."""
    # Only there: the command line starts without what samples.
    from mcexact.derived.sampling import c2d, sampled_system, tustin

    system = system_in(*plant, limits)
    if program is None:
        return system_text(c2d(system, **how))
    from mcexact.synthesis.optimum.diagnosis import rounded_controller

    with InputError.inside(program[0]):
        controller = read_controller(program[1], Limits(**limits))
        held = sampled_system(system, how["step"], how["late"], decimals=how["decimals"])
        return controller_text(rounded_controller(tustin(controller, held), how["decimals"]))


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
    if template is not None:
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
    return system_text(drawn_system(draw))


@click.command(name="gallery", short_help="List published plants, which every command takes.")
@options.as_json
def gallery_command(as_json: bool) -> None:
    """List the published plants with their sources and what each shows.

    Every command takes one as gallery:NAME in place of a file, such as `mcexact analyze
    gallery:quadruple-tank-pminus`; `mcexact convert gallery:NAME -o FILE` writes its file.
    """
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


@click.command(name="schema", short_help="Print a JSON Schema of files or of --json.")
@click.argument("name", required=False)
@as_json
def schema_command(name: str | None, as_json: bool) -> None:
    """Print the JSON Schema (2020-12) NAME, or list all of them with their folder.

    Editors complete and check system files by it, and programs what the commands print. The output
    for a NAME is JSON with and without --json.
    """
    if name is not None:
        emit(schema_text(name))
    elif as_json:
        emit_json(
            {
                "folder": str(SCHEMAS),
                "schemas": {key: purpose for key, (_, purpose) in DOCUMENTS.items()},
            }
        )
    else:
        listed = tuple((key, purpose) for key, (_, purpose) in DOCUMENTS.items())
        emit_tables((Table(f"schemas in {SCHEMAS}", (), listed, "mcexact schema NAME"),))
