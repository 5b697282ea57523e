"""`mcexact convert`: a system file of one kind as one of another kind."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from mcexact.cli import options
from mcexact.cli.parameters import at_values

if TYPE_CHECKING:
    from mcexact.exact.matrix import Rounding


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
def command(file: str, output: Path | None, **given: Any) -> None:
    """Convert the system in FILE, a .json, .yaml, .mat or .npz file or a folder of .csv files.

    Arrays are named A, B_1, C_1, B_2, C_2 and so on; or A, and the stacked B and C, with the sizes
    of the channels in inputs and outputs; in MATLAB B and C may be cells. Optional are time,
    sample_time, names, neighbors (row i marks whose messages agent i receives), delays, name and
    source. Nothing is lost: numbers that the output cannot hold are an error. A system with
    parameters is written as JSON, which YAML is too, or with --at in every kind.
    """
    from mcexact.cli.files import require_other, require_writable, write_result
    from mcexact.cli.folders import require_replaceable, write_folder
    from mcexact.cli.output import emit
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
