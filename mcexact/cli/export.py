"""`mcexact export`: write a controller as code, and say what is certified of the code.

The code is a controller of its own: its numbers are doubles, or integers over a power of two.  With
the plant, `mcexact.cli.loops.certified` decides about that controller in a child process, as it
does for `mcexact certify`; the code is written if its loop is stable.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import click

from mcexact.cli import options, parts
from mcexact.cli.certify import command as certify
from mcexact.cli.commands import DEFINITE_NO
from mcexact.cli.files import (
    emit_tables,
    require_apart,
    require_other,
    require_page,
    require_replaceable,
    require_writable,
    system_in,
    write_folder,
    write_result,
)
from mcexact.cli.output import emit
from mcexact.cli.results import Evidence, Exported, Loop
from mcexact.cli.running import Rechecked, Run
from mcexact.errors import InputError
from mcexact.exact.rational import Limits
from mcexact.export import MOST_BITS
from mcexact.export.equations import CONTROLLER, EQUATIONS, Language
from mcexact.model.controller import read_controller

if TYPE_CHECKING:
    from mcexact.export.fixed import FixedPoint

LEAST = -1
"""The value of --fixed-point without a number."""
_PROOF = "rounded_gains.json"
"""The file of the proof about all controllers that are rounded to so many bits."""


def bits_of_numbers(text: str) -> int:
    """Parse a number of fractional bits, or the word of an option without a number.

    Examples
    --------
    >>> bits_of_numbers("12"), bits_of_numbers("least")
    (12, -1)
    """
    if text == "least":
        return LEAST
    if not text.isascii() or not text.isdigit() or int(text) > MOST_BITS:
        raise click.BadParameter(f"expected 0 to {MOST_BITS} bits, found '{text}'")
    return int(text)


@click.command(name="export", short_help="Write a controller as C or Structured Text.")
@click.argument("file")
@click.option(
    "--to",
    "language",
    type=click.Choice(("c", "st", "json")),
    default="c",
    show_default=True,
    help="C99; Structured Text of IEC 61131-3; or the equations of all agents as JSON.",
)
@click.option(
    "--fixed-point",
    type=bits_of_numbers,
    is_flag=False,
    flag_value="least",
    metavar="[BITS]",
    help="Compute in integers of 32 bits, with every number of the controller rounded to this many "
    "fractional bits; without a number, and with --plant, to the fewest with which every rounding "
    "is proved to keep the loop stable.",
)
@options.ranges
@click.option(
    "--plant",
    metavar="PLANT",
    help="Certify the controller with the numbers of the code for this plant, and write the code "
    "only if its loop is stable. The rounding of signals in each step is not part of the verdict, "
    "nor are, in fixed point, signals beyond their ranges.",
)
@options.step
@options.late
@click.option(
    "-o",
    "--output",
    type=options.FOLDER,
    metavar="OUT",
    help="Write the code of each agent, equations.json, and controller.json, the controller that "
    "the code is, into this folder; JSON into this file, by default to standard output.",
)
@options.page("what is certified of that controller, and all certificates")
@options.answering
def command(file: str, language: Language, **values: Any) -> int:
    """Write the controller in FILE, in discrete time, as code for each agent.

    The code allocates nothing, uses no library, and computes in double precision, in the order of
    the equations, or in fixed point. Its comments say in which order an agent measures, sends,
    receives and computes, and how many numbers of the controller were rounded. Design a controller
    for the sampled plant, with --step of `mcexact design`.

    With --plant the first lines are those of `mcexact certify` about the controller with the
    numbers of the code, and --json prints that verdict; otherwise --json prints the equations.
    """
    run, html = Run(values), values.pop("html")
    output, plant_file, bits = values["output"], values["plant"], values["fixed_point"]
    sampling, ranges = options.sampling(values), options.ranges_of_signals(values)
    _require_whole(plant_file, bits, ranges, sampling, run.certificates or html)
    require_other(output, file, plant_file)
    if language != "json":
        if output is None:
            raise click.UsageError(f"--to {language} needs a folder: -o FOLDER")
        require_replaceable(output, EQUATIONS)
    else:
        require_writable(output)
    require_page(html, run.certificates, file, plant_file)
    require_apart(output, html, run.certificates)
    controller = run.read(file)
    plant = None if plant_file is None else run.read(plant_file)
    wanted = asked_by_default() | {"sampling": sampling}
    how = bits, ranges, wanted, html is not None, run.system_by_digest
    made = run.result(
        _exported, controller, plant, run.limits, language, *how, doing=f"exporting {file}"
    )

    def write(checked: Rechecked | None) -> None:
        if output is None:
            return
        if language == "json":
            write_result(output, made.files[EQUATIONS])
        else:
            write_folder(output, made.files)
        if html is not None and made.loop is not None and made.loop.page is not None:
            verdicts = {} if checked is None else checked.verdicts
            write_result(html, made.loop.page.rendered(made.loop.evidence.certificates, verdicts))

    if made.loop is None:
        write(None)
        if output is None or run.as_json:
            emit(made.files[EQUATIONS])
        return 0
    return _concluded(run, made.loop, file, write)


def _concluded(run: Run, loop: Loop, file: str, write: Any) -> int:
    """Show the verdict on the code, have its certificates checked, and write the code."""
    stable = bool(loop.document["certified"])
    for warning in loop.document["warnings"]:
        click.echo(f"mcexact: warning: {warning}", err=True)

    def show() -> bool:
        emit("\n".join(loop.verdict) + "\n\n")
        emit_tables(loop.tables)
        return True

    def write_if_stable(checked: Rechecked) -> None:
        if stable:
            write(checked)
        else:
            click.echo(
                "mcexact: the loop with this code is not stable: no code is written", err=True
            )

    about = f"the verdict on the code of {file}"
    run.conclude(loop, show, about=about, write=write_if_stable).require_complete()
    return 0 if stable else DEFINITE_NO


def _require_whole(
    plant: str | None, bits: int | None, ranges: Any, sampling: Any, evidence: Any
) -> None:
    """Refuse options that need others."""
    if plant is None:
        for given, name in ((sampling, "--step"), (evidence, "--certificates and --html")):
            if given:
                raise click.UsageError(f"{name} is about a plant: add --plant FILE")
        if bits == LEAST:
            raise click.UsageError(
                "the fewest bits depend on the plant: add --plant FILE, or give a number of bits"
            )
    if ranges and bits is None:
        raise click.UsageError("--range is for fixed point: add --fixed-point")


def asked_by_default() -> dict[str, Any]:
    """What `mcexact certify` asks of a plant and a controller without options."""
    context = certify.make_context("certify", ["PLANT", "CONTROLLER"])
    values = dict(context.params)
    run = Run(values)
    values["effort"] = options.effort_of_search(values)
    options.sampling(values)
    values["part"] = parts.taken(values, run)
    for name in ("file", "controller", "weights", "sizes", "html", "output"):
        del values[name]
    return values


def _about(fixed: FixedPoint | None) -> str:
    """What the verdict is about, and what is not part of it."""
    how = "double precision" if fixed is None else str(fixed)
    about = f"the verdict is about a controller with the numbers of the code ({how}); "
    if fixed is None:
        return about + "the rounding of sums in each step is not part of it"
    return about + (
        "the rounding of signals in each step, and signals beyond their ranges, are not part of it"
    )


def _exported(
    controller: tuple[str, bytes],
    plant: tuple[str, bytes] | None,
    limits: dict[str, int],
    language: Language,
    bits: int | None,
    ranges: dict[str, Fraction],
    wanted: dict[str, Any],
    with_page: bool,
    system_by_digest: bool,
) -> Exported:
    """Write a controller as code, and certify the controller that the code is, in the child."""
    # The child process alone loads what decides: the clock runs while it does, and Ctrl-C ends it.
    from mcexact.cli.loops import certified, sampled
    from mcexact.export.code import export_controller
    from mcexact.export.fixed import FixedPoint, least_fixed_point

    fixed, proof = None, None
    with InputError.inside(controller[0]):
        program = read_controller(controller[1], Limits(**limits))
        if bits == LEAST and plant is not None:
            system = sampled(system_in(*plant, limits), wanted["sampling"])
            safe = least_fixed_point(system, program, ranges=ranges)
            fixed, proof = safe.fixed, safe.proof
        elif bits is not None:
            fixed = FixedPoint(bits, ranges)
        files = export_controller(program, language, fixed)
    if plant is None:
        return Exported(files, None)
    what = CONTROLLER, files[CONTROLLER].encode()
    loop = certified(plant, what, None, None, limits, wanted, with_page, system_by_digest)
    verdict = [*loop.verdict, f"note: {_about(fixed)}"]
    evidence = loop.evidence
    if proof is not None:
        evidence = evidence.with_others(Evidence.about_own_plants({_PROOF: proof}))
    return Exported(files, replace(loop, verdict=verdict, evidence=evidence))
