"""`mcexact simulate`: run a controller as a network of agents."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Any

import click

from mcexact.cli import options


@click.command(name="simulate", short_help="Run a controller as a network of agents.")
@click.argument("file")
@click.argument("controller")
@click.option(
    "--initial",
    metavar="NUMBERS",
    help="Initial state of the plant, such as 1,0,-1/2; all ones by default. Agents start at 0.",
)
@click.option(
    "--horizon",
    type=options.rational,
    help="Number of steps, or final time in continuous time; by default chosen from the spectrum.",
)
@click.option(
    "--reference",
    metavar="NUMBERS",
    help="Set-points, one number for each output in the order of the channels; 0 by default.",
)
@click.option(
    "--arithmetic",
    type=click.Choice(["exact", "multiprecision", "float"]),
    help="By default exact in discrete time and float in continuous time.",
)
@click.option(
    "--fractions",
    is_flag=True,
    help="Write the numbers of an exact run to a .csv file as fractions, which can be very long; "
    "by default as decimals of 17 digits.",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Write the trajectory to this file, which ends in .csv, .png or .html.",
)
@options.as_json
@options.work_limits
@options.file_limits
def command(
    file: str,
    controller: str,
    initial: str | None,
    horizon: Fraction | None,
    reference: str | None,
    arithmetic: str | None,
    fractions: bool,
    output: Path | None,
    **given: Any,
) -> None:
    """Run CONTROLLER on the system in FILE, as agents that receive messages from neighbors only."""
    from mcexact.cli.files import require_drawable, require_other, require_writable
    from mcexact.cli.output import emit_json, emit_tables
    from mcexact.cli.running import Run
    from mcexact.model.atomic import write_bytes

    run = Run(given)
    suffix = "" if output is None else output.suffix
    if suffix not in ("", ".csv", ".png", ".html") or (output is not None and not suffix):
        raise click.UsageError(f"expected a file that ends in .csv, .png or .html, found {output}")
    require_other(output, file, controller)
    require_writable(output)
    require_drawable(output if suffix in (".png", ".html") else None)
    wanted = {
        "initial": _numbers(initial, "--initial"),
        "reference": _numbers(reference, "--reference"),
        "horizon": horizon,
        "arithmetic": arithmetic,
    }
    plant, program = run.read(file), run.read(controller)
    doing = f"simulating {plant[0]}"
    how = suffix, fractions
    answer = run.result(_simulated, plant, program, run.limits, wanted, *how, doing=doing)
    for warning in answer["warnings"]:
        click.echo(f"mcexact: warning: {warning}", err=True)
    if output is not None:
        write_bytes(output, answer["file"])
    if run.as_json:
        emit_json(answer["json"])
    else:
        emit_tables(answer["tables"])


def _numbers(text: str | None, name: str) -> list[Fraction] | None:
    """Parse numbers separated by commas."""
    if text is None:
        return None
    try:
        return [options.rational(part.strip()) for part in text.split(",")] if text else []
    except click.BadParameter as error:
        raise click.BadParameter(error.message, param_hint=name) from None


def _simulated(
    plant: tuple[str, bytes],
    program: tuple[str, bytes],
    limits: dict[str, int],
    wanted: dict[str, Any],
    suffix: str,
    fractions: bool,
) -> dict[str, Any]:
    """Simulate and format the results, in the child process."""
    from mcexact.cli.files import system_in
    from mcexact.errors import InputError
    from mcexact.exact.rational import Limits
    from mcexact.model.controller_file import read_controller
    from mcexact.report.simulation import SimulationReport
    from mcexact.simulation.run import simulated_loop

    system = system_in(*plant, limits)
    with InputError.inside(program[0]):
        controller = read_controller(program[1], Limits(**limits))
    done = simulated_loop(system, controller, **wanted)
    report = SimulationReport(done, fractions)
    return {
        "warnings": done.warnings,
        "json": report.as_json(),
        "tables": report.tables(),
        "file": report.file(suffix),
    }
