"""`mcexact simulate`: run a controller as a network of agents.

The signals that act on the loop are parsed here: numbers with commas, from a time on.  Their
lengths are checked where the plant is known, in `mcexact.cli.loops.simulated`, which runs in a
child process.  A run without a proof has no certificate, and then nothing is said of the checker.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import click

from mcexact.cli import options, parts
from mcexact.cli.files import (
    emit_tables,
    require_apart,
    require_drawable,
    require_other,
    require_writable,
    write_result,
)
from mcexact.cli.results import Simulated
from mcexact.cli.running import Rechecked, Run

_FILES = (".csv", ".png", ".html")


def change_option(name: str, what: str) -> Callable[[options.F], options.F]:
    """Return an option for numbers that are added to a signal from a time on."""
    return click.option(
        f"--{name}",
        name,
        multiple=True,
        metavar="NUMBERS[@TIME]",
        help=f"{what} from TIME on, by default from the start. Repeatable.",
    )


def converter(text: str) -> tuple[Fraction, ...]:
    """Parse a step, or BITS:LOW,HIGH.

    Examples
    --------
    >>> converter("1/100"), converter("12:-10,10")
    ((Fraction(1, 100),), (Fraction(12, 1), Fraction(-10, 1), Fraction(10, 1)))
    """
    bits, colon, ends = text.partition(":")
    if not colon:
        return (options.rational(text),)
    low, comma, high = ends.partition(",")
    if not comma:
        raise click.BadParameter(f"expected BITS:LOW,HIGH such as 12:-10,10, found '{text}'")
    return tuple(options.rational(each.strip()) for each in (bits, low, high))


@click.command(name="simulate", short_help="Run a controller as a network of agents.")
@click.argument("file")
@click.argument("controller")
@click.option(
    "--initial",
    metavar="NUMBERS",
    help="Initial state of the plant, such as 1,0,-1/2, or one number for all states, such as 0; "
    "all ones by default. Agents start at 0.",
)
@click.option(
    "--horizon",
    type=options.rational,
    help="Number of steps, or final time in continuous time; by default chosen from the slowest "
    "mode of the loop.",
)
@click.option(
    "--points",
    type=click.IntRange(min=1, max=10**6),
    metavar="N",
    help="In continuous time, the number of intervals; by default chosen from the fastest mode.",
)
@click.option(
    "--reference",
    metavar="NUMBERS",
    help="Set-points, one number for each output in the order of the channels; 0 by default.",
)
@change_option("steps", "Add these numbers, such as 0,2@5, to the set-points")
@change_option("ramps", "Let the set-points grow by these numbers in each unit of time,")
@click.option(
    "--cosines",
    multiple=True,
    metavar="NUMBERS:OMEGA",
    help="Add these numbers, such as 0,2:1/2, times cos(OMEGA t) to the set-points; in discrete "
    "time OMEGA stands for the cosine of the angle per step. Repeatable.",
)
@change_option("disturbances", "Add these numbers to the inputs at the plant")
@click.option(
    "--arithmetic",
    type=click.Choice(["exact", "multiprecision", "float"]),
    help="By default exact in discrete time and float in continuous time.",
)
@parts.option("Run the loop of")
@options.step
@options.late
@options.limits(
    "They are those of the actuators in the real loop; a controller with limits cuts off at its "
    "own ones first."
)
@click.option(
    "--quantize-outputs",
    multiple=True,
    type=converter,
    metavar="STEP|BITS:LOW,HIGH",
    help="The real loop: outputs are measured in steps, such as 1/100, or by a converter, such as "
    "12:-10,10; once for all outputs or once for each.",
)
@click.option(
    "--quantize-inputs",
    multiple=True,
    type=converter,
    metavar="STEP|BITS:LOW,HIGH",
    help="The same for inputs.",
)
@click.option(
    "--code",
    type=click.Choice(["interpreted", "compiled"]),
    help="The real loop: whether the sums of the exported code are computed here in its order, or "
    "the exported C is compiled and run; both give the same bits.",
)
@options.fixed_point
@options.ranges
@click.option(
    "--fractions",
    is_flag=True,
    help="Write the numbers of an exact run as fractions, which can be very long, to a .csv file "
    "and with --json; by default as decimals and as numbers.",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Write the trajectory to this file, which ends in .csv, .png or .html.",
)
@options.answering
def command(file: str, controller: str, **values: Any) -> None:
    """Run CONTROLLER on the system in FILE, as agents that receive messages from neighbors only.

    Shown are the outputs y, the inputs u, and the set-points r if there are any. If the loop is
    stable and nothing changes after the start, bounds on the outputs are proved, too; their
    certificate is checked, and --certificates writes it.

    With --step, --limits, --quantize-outputs, --quantize-inputs, --fixed-point or --code the real
    loop is run: the plant at the samples, inputs that are held, late and limited, converters, and
    the arithmetic of the exported code, from agents at 0. The ideal loop, about which something is
    proved, is shown beside it, with settling times and control effort of both. A controller in
    continuous time is taken at the samples by Tustin's rule; the ideal loop is then the one in
    continuous time.
    """
    run = Run(values)
    real = _real(values)
    output, fractions = values.pop("output"), values.pop("fractions")
    suffix = "" if output is None else output.suffix
    if output is not None and suffix not in _FILES:
        raise click.UsageError(f"expected a file that ends in .csv, .png or .html, found {output}")
    require_other(output, file, controller, parts.file_of(values))
    require_writable(output, run.certificates)
    require_apart(output, run.certificates)
    require_drawable(output if suffix in (".png", ".html") else None)
    wanted = values | {
        "initial": _numbers(values["initial"], "--initial"),
        "reference": _numbers(values["reference"], "--reference"),
        **{name: _changes(values[name], name) for name in ("steps", "ramps", "disturbances")},
        "cosines": _cosines(values["cosines"]),
    }
    wanted["part"] = parts.taken(wanted, run)
    if real and wanted["part"] is not None:
        raise click.UsageError(parts.NOT_REAL)
    plant, program = run.read(file), run.read(controller)
    doing = f"simulating {plant[0]}"
    how = suffix, fractions, run.system_by_digest, real
    answer = run.result(_simulated, plant, program, run.limits, wanted, *how, doing=doing)
    for warning in answer.warnings:
        click.echo(f"mcexact: warning: {warning}", err=True)

    def show() -> bool:
        emit_tables(answer.tables)
        return bool(answer.evidence.files)

    def write(checked: Rechecked) -> None:
        if output is not None and answer.page is not None:
            page = answer.page.rendered(answer.evidence.certificates, checked.verdicts)
            write_result(output, page)
        elif output is not None:
            write_result(output, answer.file)

    about = f"the simulation of {plant[0]}"
    run.conclude(answer, show, about=about, write=write).require_complete()


_REAL = ("limited", "quantize_outputs", "quantize_inputs", "code", "fixed_point")
_IDEAL = {name: f"--{name}" for name in ("arithmetic", "points", "fractions", "cosines")}


def _real(values: dict[str, Any]) -> dict[str, Any]:
    """Take what makes the loop real from the values of the command; nothing if it is not."""
    sampling, ranges = options.sampling(values), options.ranges_of_signals(values)
    real = {name: values.pop(name) for name in _REAL}
    if ranges and real["fixed_point"] is None:
        raise click.UsageError("--range is for fixed point: add --fixed-point")
    if not sampling and not any(value not in (None, ()) for value in real.values()):
        return {}
    for name, option in _IDEAL.items():
        if values[name]:
            raise click.UsageError(f"{option} is not for the real loop")
    given = {name: None if value == () else value for name, value in real.items()}
    return sampling | given | {"ranges": ranges}


def _numbers(text: str | None, name: str) -> list[Fraction] | None:
    """Parse numbers separated by commas."""
    if text is None:
        return None
    try:
        return [options.rational(part.strip()) for part in text.split(",")] if text else []
    except click.BadParameter as error:
        raise click.BadParameter(error.message, param_hint=name) from None


def _changes(texts: tuple[str, ...], name: str) -> list[tuple[Fraction, list[Fraction]]]:
    """Parse numbers with the time from which they are added."""
    changes = []
    for text in texts:
        numbers, _, time = text.partition("@")
        [start] = _numbers(time or "0", f"--{name}") or [Fraction(0)]
        changes.append((start, _numbers(numbers, f"--{name}") or []))
    return changes


def _cosines(texts: tuple[str, ...]) -> list[tuple[Fraction, list[Fraction]]]:
    """Parse amplitudes with their frequency."""
    found = []
    for text in texts:
        numbers, colon, omega = text.rpartition(":")
        if not colon:
            raise click.BadParameter(
                f"expected NUMBERS:OMEGA such as 0,2:1/2, found '{text}'", param_hint="--cosines"
            )
        [number] = _numbers(omega, "--cosines") or [Fraction(0)]
        found.append((number, _numbers(numbers, "--cosines") or []))
    return found


def _simulated(*arguments: Any) -> Simulated:
    """Simulate and format the results, in the child process."""
    # The child process alone loads what decides: the clock runs while it does, and Ctrl-C ends it.
    from mcexact.cli.loops import simulated

    return simulated(*arguments)
