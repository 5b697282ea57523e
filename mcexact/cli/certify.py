"""`mcexact certify`: decide whether a controller makes the closed loop stable, or fast enough."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import click

from mcexact.cli import options
from mcexact.cli.commands import DEFINITE_NO, GroupedCommand
from mcexact.cli.uncertainty import at_values

rounded_output = click.option(
    "-o",
    "--output",
    type=options.FOLDER,
    metavar="FILE",
    help="Write the rounded controller to this file.",
)


@click.command(
    name="certify",
    cls=GroupedCommand,
    short_help="Decide whether a controller stabilizes, with proof.",
)
@click.argument("file")
@click.argument("controller")
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
@at_values(
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
@rounded_output
@options.page("figures of the loop and all certificates")
@options.answering
def command(file: str, controller: str, **given: Any) -> int:
    """Decide whether CONTROLLER stabilizes the system in FILE, or makes it fast enough.

    The controller is linear and time-invariant, as in every controller file. The decision is exact,
    also for a controller designed in floating point. If the answer is no, the exit status is 1,
    --certificates writes a proof of that as well, and a disc is told that holds an eigenvalue and
    lies outside, if the loop is small. A warning is given if the controller was designed for
    another plant. The first line says whether to install the controller.

    For a system with parameters it is proved that the loop is stable, or fast enough, at all values
    within their ranges. Where no proof is found, the largest part of the ranges that is proved is
    told, and values at which the loop fails, which are decided exactly: the exit status is then 1,
    and 4 if none are found.
    """
    from mcexact.cli.files import (
        emit,
        emit_tables,
        place_of,
        require_apart,
        require_other,
        require_page,
        require_writable,
        write_result,
    )
    from mcexact.cli.running import Rechecked, Run
    from mcexact.errors import LimitReached

    run, weights, html = Run(given), given.pop("weights"), given.pop("html")
    output, given["effort"] = given.pop("output"), options.effort_of_search(given)
    if given["effort"] is not None and given["gains"] is not None:
        raise click.UsageError(
            "--largest-uncertainty takes the gains as they are: leave out --gains"
        )
    if output is not None and given["round_gains"] is None:
        raise click.UsageError("-o writes the rounded controller: give --round-gains, too")
    require_other(output, file, controller, weights)
    require_writable(output, run.certificates)
    require_page(html, run.certificates, file, controller, weights)
    require_apart(output, html, run.certificates)
    about = place_of(controller)
    programs = run.read(file), run.read(controller), None if weights is None else run.read(weights)
    answer = run.result(
        _certified,
        *programs,
        run.limits,
        given,
        html is not None,
        run.system_by_digest,
        doing=f"certifying {about}",
    )
    for warning in answer["json"]["warnings"]:
        click.echo(f"mcexact: warning: {warning}", err=True)

    def show() -> bool:
        emit("\n".join(answer["said"]) + "\n\n")
        emit_tables(answer["tables"])
        return True

    def write(checked: Rechecked) -> None:
        if output is not None:
            write_result(output, answer["controller"])
        if html is not None:
            write_result(html, answer["page"].rendered(answer["certificates"], checked.verdicts))

    about = f"the verdict on {about}"
    run.conclude(answer, show, about=about, write=write).require_complete()
    if answer["json"]["certified"]:
        return 0
    return DEFINITE_NO if answer["json"].get("refuted", True) else LimitReached.exit_status


def _certified(
    plant: tuple[str, bytes],
    program: tuple[str, bytes],
    weights: tuple[str, bytes] | None,
    limits: dict[str, int],
    wanted: dict[str, Any],
    with_page: bool,
    system_by_digest: bool,
) -> dict[str, Any]:
    """Decide and format the answer, in the child process."""
    from mcexact.answer.templates import count
    from mcexact.cli import uncertainty
    from mcexact.cli.design import assessed
    from mcexact.cli.files import plant_in
    from mcexact.cli.running import told
    from mcexact.errors import InputError
    from mcexact.exact.rational import Limits
    from mcexact.exact.roots import StabilityRegion
    from mcexact.model.controller import controller_text, read_controller
    from mcexact.model.loop import closed_loop
    from mcexact.model.parametric import ParametricSystem
    from mcexact.report.text import Table, tables
    from mcexact.synthesis.assessment import BASIS, assessed_loop
    from mcexact.synthesis.certify import account_of_verdict, certify_controller, enclosed_outside
    from mcexact.synthesis.optimum.diagnosis import rounded_controller

    gains, effort, at = wanted.pop("gains"), wanted.pop("effort"), dict(wanted.pop("at"))
    typed_plant = plant_in(*plant, limits, at)
    with InputError.inside(program[0]):
        controller = read_controller(program[1], Limits(**limits))
    if isinstance(typed_plant, ParametricSystem):
        given = wanted | {"weights": weights, "effort": effort}
        return uncertainty.certified(
            typed_plant, controller, gains, given, with_page, system_by_digest
        )
    system, largest = uncertainty.of(typed_plant, wanted.pop("uncertainty"))
    with InputError.inside(program[0]):
        digits, notes, typed = wanted.pop("round_gains"), tuple[str, ...](), controller
        if digits is not None:
            controller = rounded_controller(controller, digits)
            notes = (f"the verdict is about the controller rounded to {count(digits, 'digit')}",)
        if effort is not None:
            asked = StabilityRegion.of(system.time, wanted["rate"], wanted["radius"])
            system, largest = uncertainty.of_loop(system, controller, asked, effort)
        found = certify_controller(system, controller, **wanted)
    outside = enclosed_outside(found)
    if outside is not None:
        center = f"{outside.re} + {outside.im} i".replace("+ -", "- ")
        near = f"an eigenvalue is at most {outside.radius} from {center}"
        notes = (*notes, f"{near}, outside {found.region}")
    loop, weighed = closed_loop(system, controller), options.read_weights(weights, limits)
    with InputError.inside(plant[0] if weights is None else weights[0]):
        assessment = assessed_loop(
            loop, found.region, certified=found.stable, weights=weighed, notes=notes
        )
    loops = uncertainty.loops(system, controller, found, gains, largest)
    assessment = replace(assessment, within_radii=loops.within_radii)
    account = account_of_verdict(
        found, largest=wanted["largest"], every_loop=loops.proof, gains=gains, failing=loops.failing
    )
    if digits is not None:
        loops = loops.with_digits(uncertainty.digits_of(system, typed, found, digits))
    figures = Table(BASIS, (), tuple(assessment.rows()))
    shown = (*uncertainty.tables(largest), *loops.tables(), *tables(account.sentences), figures)
    drawn = uncertainty.pictures(largest) if with_page else ()
    bound = None if found.bound is None else str(found.bound)
    return (
        told(account, system_by_digest and system is typed_plant)
        | assessed(account, assessment, loop, shown, with_page, drawn)
        | {
            "json": account.as_json(
                certified=found.stable,
                region=str(found.region),
                bound=bound,
                method=found.method,
                states=found.about.n,
                blocks=list(found.blocks),
                largest=bound if wanted["largest"] else None,
                warnings=list(controller.warnings_for(typed_plant)),
                rounded_to_digits=digits,
                eigenvalue_outside=None if outside is None else outside.to_dict(),
                **loops.view,
                **uncertainty.view(largest),
                assessment=assessment.to_dict(),
            ),
            "controller": controller_text(controller),
        }
    )
