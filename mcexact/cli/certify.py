"""`mcexact certify`: decide whether a controller makes the closed loop stable, or fast enough."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
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
@options.certificates
@options.as_json
@options.work_limits
@options.file_limits
def command(
    file: str,
    controller: str,
    rate: Fraction | None,
    radius: Fraction | None,
    largest: bool,
    method: str | None,
    certificates: Path | None,
    as_json: bool,
    timeout: float | None,
    max_memory: int | None,
    **limits: int | None,
) -> int:
    """Decide whether CONTROLLER stabilizes the system in FILE, or makes it fast enough.

    The controller is linear and time-invariant, as in every controller file. The decision is exact,
    also for a controller designed in floating point. If the answer is no, the exit status is 1, and
    --certificates writes a proof of that as well. A warning is given if the controller was designed
    for another plant.
    """
    from mcexact.cli.concluding import concluded
    from mcexact.cli.deadline import Deadline
    from mcexact.cli.files import place_of, read, require_writable
    from mcexact.cli.output import emit_tables
    from mcexact.cli.supervision import supervised

    deadline = Deadline(timeout)
    require_writable(None, certificates)
    moved = options.given(limits)
    answer = supervised(
        _certified,
        (place_of(file), read(file, moved, deadline)),
        (place_of(controller), read(controller, moved, deadline)),
        moved,
        {"rate": rate, "radius": radius, "largest": largest, "method": method},
        doing=f"certifying {place_of(controller)}",
        timeout=deadline,
        max_memory=max_memory,
    )
    for warning in answer["json"]["warnings"]:
        click.echo(f"mcexact: warning: {warning}", err=True)

    def show() -> bool:
        emit_tables(answer["tables"])
        return True

    concluded(
        answer,
        show,
        doing=f"re-checking the verdict on {place_of(controller)}",
        certificates=certificates,
        as_json=as_json,
        deadline=deadline,
        max_memory=max_memory,
    ).require_complete()
    return 0 if answer["json"]["certified"] else DEFINITE_NO


def _certified(
    plant: tuple[str, bytes],
    program: tuple[str, bytes],
    limits: dict[str, int],
    wanted: dict[str, Any],
) -> dict[str, Any]:
    """Decide and format the answer, in the child process."""
    from mcexact.cli.concluding import told
    from mcexact.cli.files import system_in
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
