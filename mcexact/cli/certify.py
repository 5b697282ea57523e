"""`mcexact certify`: decide whether a controller makes the closed loop stable, or fast enough."""

from __future__ import annotations

from typing import Any

import click

from mcexact.cli import options
from mcexact.cli.failures import DEFINITE_NO


@click.command(name="certify", short_help="Decide whether a controller stabilizes, with proof.")
@click.argument("file")
@click.argument("controller")
@options.rate
@options.radius
@click.option(
    "--largest", is_flag=True, help="Search for the largest rate (least radius) and certify it."
)
@click.option(
    "--method",
    type=click.Choice(["polynomial", "lyapunov"]),
    help="Decide by the characteristic polynomial or by Lyapunov matrices; by default by size.",
)
@options.answering
def command(file: str, controller: str, **given: Any) -> int:
    """Decide whether CONTROLLER stabilizes the system in FILE, or makes it fast enough.

    The controller is linear and time-invariant, as in every controller file. The decision is exact,
    also for a controller designed in floating point. If the answer is no, the exit status is 1, and
    --certificates writes a proof of that as well. A warning is given if the controller was designed
    for another plant.
    """
    from mcexact.cli.files import place_of, require_writable
    from mcexact.cli.running import Run, show_tables

    run = Run(given)
    require_writable(None, run.certificates)
    about = place_of(controller)
    programs = run.read(file), run.read(controller)
    answer = run.result(_certified, *programs, run.limits, given, doing=f"certifying {about}")
    for warning in answer["json"]["warnings"]:
        click.echo(f"mcexact: warning: {warning}", err=True)
    about = f"the verdict on {about}"
    run.conclude(answer, show_tables(answer), about=about).require_complete()
    return 0 if answer["json"]["certified"] else DEFINITE_NO


def _certified(
    plant: tuple[str, bytes],
    program: tuple[str, bytes],
    limits: dict[str, int],
    wanted: dict[str, Any],
) -> dict[str, Any]:
    """Decide and format the answer, in the child process."""
    from mcexact.cli.files import system_in
    from mcexact.cli.running import told
    from mcexact.errors import InputError
    from mcexact.exact.rational import Limits
    from mcexact.model.controller_file import read_controller
    from mcexact.report.account import tables
    from mcexact.synthesis.certify import account_of_verdict, certify_controller

    system = system_in(*plant, limits)
    with InputError.inside(program[0]):
        controller = read_controller(program[1], Limits(**limits))
        found = certify_controller(system, controller, **wanted)
    account = account_of_verdict(found, largest=wanted["largest"])
    bound = None if found.bound is None else str(found.bound)
    return told(account) | {
        "json": account.as_json(
            certified=found.stable,
            region=str(found.region),
            bound=bound,
            method=found.method,
            states=found.about.n,
            blocks=list(found.blocks),
            largest=bound if wanted["largest"] else None,
            warnings=list(controller.warnings_for(system)),
        ),
        "tables": tables(account.sentences),
    }
