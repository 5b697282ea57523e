"""`mcexact crosscheck`: compare floating-point verdicts on a system with the exact ones."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from mcexact.cli import options

FORMAT = "mcexact-crosscheck/1"


@click.command(name="crosscheck", short_help="Compare floating-point verdicts with the exact ones.")
@click.argument("file", required=False)
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
def command(file: str | None, exhibits: bool, html: Path | None, **given: Any) -> None:
    """Answer structural questions about the system in FILE in floating point and exactly.

    Each floating-point verdict comes from a library's own function with its default tolerance; the
    table quotes the call. The last table has a plant near a small system that has a fixed
    mode, which is decided exactly.
    """
    from mcexact.cli.files import require_writable, write_result
    from mcexact.cli.output import emit, emit_json
    from mcexact.cli.running import Run
    from mcexact.report.text import WIDE, plain

    if exhibits == (file is not None):
        raise click.UsageError("give either FILE or --exhibits")
    if html is not None and not exhibits:
        raise click.UsageError("--html goes with --exhibits")
    require_writable(html)
    run = Run(given)
    if file is None:
        answer = run.result(_exhibited, doing="asking the exhibits' questions")
    else:
        plant = run.read(file)
        doing = f"cross-checking {plant[0]}"
        answer = run.result(_crosschecked, *plant, run.limits, doing=doing)
    if html is not None:
        write_result(html, answer["html"])
    if run.as_json:
        emit_json(answer["json"])
    else:
        emit(plain(answer["tables"], width=WIDE))


def _crosschecked(place: str, data: bytes, limits: dict[str, int]) -> dict[str, Any]:
    """Answer and format the answers, in the child process."""
    from mcexact.cli.files import system_in
    from mcexact.crosschecks.gallery import crosscheck_tables, crosscheck_view
    from mcexact.crosschecks.table import crosscheck

    system = system_in(place, data, limits)
    found = crosscheck(system)
    view = {"format": FORMAT, **crosscheck_view(found)}
    return {"json": view, "tables": crosscheck_tables(found)}


def _exhibited() -> dict[str, Any]:
    """Answer every exhibit's question on this machine, in the child process."""
    from mcexact.crosschecks.gallery import (
        exhibit_tables,
        exhibits,
        exhibits_page,
        exhibits_view,
        shown,
    )

    found = [shown(each) for each in exhibits()]
    return {
        "json": {"format": FORMAT, "exhibits": exhibits_view(found)},
        "tables": exhibit_tables(found),
        "html": exhibits_page(found),
    }
