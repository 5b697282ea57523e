"""`mcexact certify`: decide whether a controller makes the closed loop stable, or fast enough.

`mcexact.cli.loops.certified` decides in a child process.  The status is 0 only if what was asked is
proved; it is 1 if the loop, or the loop at some values of parameters, is proved to fail, and 4 if
neither was found.
"""

from __future__ import annotations

from typing import Any

import click

from mcexact.cli import options, parts
from mcexact.cli.commands import DEFINITE_NO, GroupedCommand
from mcexact.cli.files import (
    emit_tables,
    place_of,
    require_apart,
    require_other,
    require_page,
    require_writable,
    write_result,
)
from mcexact.cli.output import emit
from mcexact.cli.results import Loop
from mcexact.cli.running import Rechecked, Run
from mcexact.errors import LimitReached


@click.command(
    name="certify",
    cls=GroupedCommand,
    short_help="Decide whether a controller stabilizes, with proof.",
)
@click.argument("file")
@click.argument("controller")
@parts.option("Certify the loop of")
@options.step
@options.late
@options.rate
@options.radius
@options.damping
@options.fastest
@click.option(
    "--largest", is_flag=True, help="Search for the largest rate (least radius) and certify it."
)
@click.option(
    "--method",
    type=click.Choice(["polynomial", "lyapunov"]),
    help="Decide by the characteristic polynomial or by Lyapunov matrices; by default by size.",
)
@click.option(
    "--round-gains",
    type=click.IntRange(min=1, max=1000),
    metavar="DIGITS",
    help="Certify the controller with every entry rounded to this many significant digits, and say "
    "how many digits are safe, whichever way they are rounded.",
)
@options.uncertainty
@options.largest_uncertainty(
    "Search the largest part by which entries of the plant may differ such that every loop meets "
    "the rate or radius, or is stable if none is given, and a plant near it whose loop fails to."
)
@options.at_values(
    "give a parameter a value",
    "May be repeated; where parameters are left, the answer is about all values in their ranges.",
)
@click.option(
    "--gains",
    type=options.part,
    metavar="PART",
    help="Also decide about every controller whose entries differ by at most this part of their "
    "moduli, such as 1%.",
)
@options.weights
@options.sizes
@options.limited
@options.no_box
@options.prove_all
@click.option(
    "-o",
    "--output",
    type=options.FOLDER,
    metavar="FILE",
    help="Write the controller that is rounded, taken at the samples, or limited to this file.",
)
@options.page("figures of the loop and all certificates")
@options.answering
def command(file: str, controller: str, **values: Any) -> int:
    """Decide whether CONTROLLER stabilizes the system in FILE, or makes it fast enough.

    The controller is linear and time-invariant, as in every controller file. The decision is exact,
    also for a controller designed in floating point. If the answer is no, the exit status is 1,
    --certificates writes a proof of that as well, and a disc is told that holds an eigenvalue and
    lies outside, if the loop is small. A warning is given if the controller was designed for
    another plant. The first line says whether to install the controller.

    With --step a controller in continuous time is taken at the samples by Tustin's rule, exactly,
    and rounded to 12 digits, or to those of --round-gains.

    For a system with parameters it is proved that the loop is stable, or fast enough, at all values
    within their ranges. Where no proof is found, the largest part of the ranges that is proved is
    told, and values at which the loop fails, which are decided exactly: the exit status is then 1,
    and 4 if none are found.
    """
    run, weights, html = Run(values), values.pop("weights"), values.pop("html")
    sizes = values.pop("sizes")
    output, values["effort"] = values.pop("output"), options.effort_of_search(values)
    values["sampling"] = options.sampling(values)
    if values["effort"] is not None and values["gains"] is not None:
        raise click.UsageError(
            "--largest-uncertainty takes the gains as they are: leave out --gains"
        )
    changes = values["round_gains"] is not None or values["sampling"] or values["limited"]
    if output is not None and not changes:
        raise click.UsageError(
            "-o writes the controller that is rounded, taken at the samples or limited: give "
            "--round-gains, --step or --limits, too"
        )
    if values["modulo"] is not None and values["sampling"]:
        raise click.UsageError(parts.NOT_SAMPLED)
    inputs = file, controller, weights, sizes, parts.file_of(values)
    require_other(output, *inputs)
    require_writable(output, run.certificates)
    require_page(html, run.certificates, *inputs)
    require_apart(output, html, run.certificates)
    about = place_of(controller)
    read = (None if each is None else run.read(each) for each in (weights, sizes))
    programs = run.read(file), run.read(controller), *read
    values["part"] = parts.taken(values, run)
    answer = run.result(
        _certified,
        *programs,
        run.limits,
        values,
        html is not None,
        run.system_by_digest,
        doing=f"certifying {about}",
    )
    for warning in answer.document["warnings"]:
        click.echo(f"mcexact: warning: {warning}", err=True)

    def show() -> bool:
        emit("\n".join(answer.verdict) + "\n\n")
        emit_tables(answer.tables)
        return True

    def write(checked: Rechecked) -> None:
        if output is not None:
            write_result(output, answer.controller)
        if html is not None and answer.page is not None:
            page = answer.page.rendered(answer.evidence.certificates, checked.verdicts)
            write_result(html, page)

    run.conclude(answer, show, about=f"the verdict on {about}", write=write).require_complete()
    if answer.document["certified"]:
        return 0
    return DEFINITE_NO if answer.document.get("refuted", True) else LimitReached.exit_status


def _certified(*arguments: Any) -> Loop:
    """Decide and format the answer, in the child process."""
    # The child process alone loads what decides: the clock runs while it does, and Ctrl-C ends it.
    from mcexact.cli.loops import certified

    return certified(*arguments)
