"""`mcexact reproduce`: what is known of every statement of the paper, examined exactly."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from mcexact.cli import options
from mcexact.cli.failures import DEFINITE_NO


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
def command(
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

    from mcexact.cli.folders import require_replaceable, write_folder
    from mcexact.cli.output import emit, emit_json, emit_tables
    from mcexact.cli.supervision import supervised
    from mcexact.errors import MissingExtra
    from mcexact.reproduce import pages, reproduction, terminal

    MissingExtra.require("plot", "matplotlib")
    keys = reproduction.chosen(wanted)
    if output is not None:
        require_replaceable(output, "report.html")
    findings: list[Any] = []
    for k, (name, procedures) in enumerate(reproduction.SECTIONS):
        if not any(key in procedures for key in keys):
            continue
        found = supervised(
            reproduction.examine,
            k,
            keys,
            doing=f"examining section {name}",
            timeout=timeout,
            max_memory=max_memory,
        )
        findings += found
        _tell(name, found)
    result = reproduction.assembled(findings)
    if output is not None:
        files = {f"certificates/{name}": text for name, text in result.certificates().items()}
        files["report.html"] = pages.reproduction_page(result)
        if latex:
            files["table.tex"] = pages.reproduction_latex(result)
        write_folder(output, files)
    if as_json:
        emit_json({"format": "mcexact-reproduction/1", **pages.reproduction_view(result)})
    elif latex:
        emit(pages.reproduction_latex(result))
    else:
        emit_tables(terminal.reproduction_tables(result))
    for row in result.failures:
        click.echo(f"mcexact: {row.examination.title}: {row.finding.failure}", err=True)
    return 0 if result.holds else DEFINITE_NO


def _tell(name: str, findings: tuple[Any, ...]) -> None:
    """Print one line of progress for a finished section."""
    held = sum(finding.holds for finding in findings)
    made = sum(len(finding.certificates) for finding in findings)
    click.echo(
        f"mcexact: section {name}: {held} of {len(findings)} examinations hold, "
        f"{made} certificates",
        err=True,
    )
