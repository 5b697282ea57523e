"""Commands about the paper and floating point: reproduce, crosscheck, demo.

`reproduce_command` examines the statements of the paper section by section, each in a child process
with the limits to itself, so that a line of progress follows every section.  `crosscheck_command`
compares libraries with the exact answers about one system, or shows the systems with a recorded
wrong answer; `demo_command` shows two of those.  Each of the three loads another large part of the
package, with numpy, which the other two do not need.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from mcexact.cli import options
from mcexact.cli.commands import DEFINITE_NO
from mcexact.cli.files import (
    emit_tables,
    require_replaceable,
    require_writable,
    system_in,
    write_folder,
    write_result,
)
from mcexact.cli.options import as_json
from mcexact.cli.output import emit, emit_json
from mcexact.cli.results import Compared
from mcexact.cli.running import Run, supervised
from mcexact.errors import InputError, MissingExtra
from mcexact.exact.rational import Limits
from mcexact.report.text import WIDE, plain

if TYPE_CHECKING:
    from mcexact.reproduce.notebook import Notebook

FORMAT = "mcexact-crosscheck/1"


@click.command(name="reproduce", short_help="Say of every statement of the paper what is known.")
@click.option(
    "-o",
    "--output",
    type=options.FOLDER,
    metavar="DIR",
    help="Write report.html and the certificates into this folder.",
)
@click.option(
    "--statement",
    "wanted",
    multiple=True,
    metavar="NAME",
    help="Examine only 'Theorem 2', 31 for equation (31), 'statement 89' or 'section II-D'. "
    "May be repeated.",
)
@click.option("--latex", is_flag=True, help="Print the table in LaTeX, for amsmath.")
@options.as_json
@options.work_limits
def reproduce_command(
    output: Path | None,
    wanted: tuple[str, ...],
    latex: bool,
    as_json: bool,
    timeout: float | None,
    max_memory: int | None,
) -> int:
    """Examine the statements of the paper, on its own example and on drawn systems.

    Says what is known of each, with certificates. If an examination fails, the status is 1, and the
    examination is named.
    """
    # Only this of the three commands needs the examinations.
    from mcexact.reproduce import reproduction

    MissingExtra.require("plot", "matplotlib")
    keys = reproduction.chosen(wanted)
    if output is not None:
        require_replaceable(output, "report.html")
    findings: list[Notebook] = []
    for k, (name, procedures) in enumerate(reproduction.SECTIONS):
        if not any(key in procedures for key in keys):
            continue
        section = supervised(
            reproduction.examine,
            k,
            keys,
            doing=f"examining section {name}",
            timeout=timeout,
            max_memory=max_memory,
        )
        findings += section
        _tell(name, section)
    result = reproduction.assembled(findings)
    if output is not None:
        files = {f"certificates/{name}": text for name, text in result.certificates().items()}
        files["report.html"] = reproduction.reproduction_page(result)
        if latex:
            files["table.tex"] = reproduction.reproduction_latex(result)
        write_folder(output, files)
    if as_json:
        emit_json({"format": "mcexact-reproduction/1", **reproduction.reproduction_view(result)})
    elif latex:
        emit(reproduction.reproduction_latex(result))
    else:
        emit_tables(reproduction.reproduction_tables(result))
    for row in result.failures:
        click.echo(f"mcexact: {row.examination.title}: {row.finding.failure}", err=True)
    return 0 if result.holds else DEFINITE_NO


def _tell(name: str, findings: tuple[Notebook, ...]) -> None:
    """Print one line of progress for a finished section."""
    held = sum(finding.holds for finding in findings)
    certificates = sum(len(finding.certificates) for finding in findings)
    click.echo(
        f"mcexact: section {name}: {held} of {len(findings)} examinations hold, "
        f"{certificates} certificates",
        err=True,
    )


@click.command(name="crosscheck", short_help="Compare floating-point verdicts with the exact ones.")
@click.argument("file", required=False)
@click.argument("controller", required=False)
@click.option(
    "--exhibits",
    is_flag=True,
    help="Instead of FILE, show systems for which a wrong floating-point answer was recorded, with "
    "the recorded answer and the answer on this machine.",
)
@click.option(
    "--html",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE",
    help="With --exhibits: write the exhibits as an HTML page.",
)
@options.as_json
@options.work_limits
@options.file_limits
def crosscheck_command(
    file: str | None, controller: str | None, exhibits: bool, html: Path | None, **values: Any
) -> None:
    """Answer structural questions about the system in FILE in floating point and exactly.

    Each floating-point verdict comes from a library's own function with its default tolerance; the
    table quotes the call. With a CONTROLLER the disk margin of each loop is asked for as well, by
    python-control on a grid of frequencies and with a proof. The last table has a plant near a
    small system that has a fixed mode, which is decided exactly.
    """
    if exhibits == (file is not None):
        raise click.UsageError("give either FILE or --exhibits")
    if html is not None and not exhibits:
        raise click.UsageError("--html goes with --exhibits")
    require_writable(html)
    run = Run(values)
    if file is None:
        answer = run.result(_exhibited, doing="asking the exhibits' questions")
    else:
        plant = run.read(file)
        doing = f"cross-checking {plant[0]}"
        program = None if controller is None else run.read(controller)
        answer = run.result(_crosschecked, *plant, program, run.limits, doing=doing)
    if html is not None:
        write_result(html, answer.page)
    if run.as_json:
        emit_json(answer.document)
    else:
        emit(plain(answer.tables, width=WIDE))


def _crosschecked(
    place: str, data: bytes, program: tuple[str, bytes] | None, limits: dict[str, int]
) -> Compared:
    """Answer and format the answers, in the child process."""
    # Only there: numpy has threads, with which this process could not be forked.
    from mcexact.crosschecks.gallery import crosscheck_tables, crosscheck_view
    from mcexact.crosschecks.table import crosscheck
    from mcexact.model.controller import read_controller
    from mcexact.model.system import with_links

    system, controller = system_in(place, data, limits), None
    if program is not None:
        with InputError.inside(program[0]):
            controller = read_controller(program[1], Limits(**limits))
            controller.require_fits(system, with_links(system)[1])
    comparison = crosscheck(system, controller)
    document = {"format": FORMAT, **crosscheck_view(comparison)}
    return Compared(document, crosscheck_tables(comparison))


def _exhibited() -> Compared:
    """Answer every exhibit's question on this machine, in the child process."""
    # Only there: numpy has threads, with which this process could not be forked.
    from mcexact.crosschecks import gallery

    exhibits = [gallery.shown(each) for each in gallery.exhibits()]
    document = {"format": FORMAT, "exhibits": gallery.exhibits_view(exhibits)}
    return Compared(document, gallery.exhibit_tables(exhibits), gallery.exhibits_page(exhibits))


@click.command(
    name="demo", short_help="Show two wrong answers of floating point with the exact ones."
)
@as_json
def demo_command(as_json: bool) -> None:
    """Show two wrong answers of floating point, recorded and recomputed, with the exact ones."""
    # Only this of the three commands needs them.
    from mcexact.crosschecks import demonstration

    shown = demonstration.demonstration()
    if as_json:
        emit_json({"format": "mcexact-demo/1", **demonstration.demonstration_view(shown)})
    else:
        emit(demonstration.demonstration_text(shown))
