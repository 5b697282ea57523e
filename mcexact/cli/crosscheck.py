"""`mcexact crosscheck`: what floating point says about a system, beside what is true."""

from __future__ import annotations

from typing import Any

import click

from mcexact.cli import options


@click.command(name="crosscheck", short_help="Floating-point verdicts beside the exact ones.")
@click.argument("file")
@options.as_json
@options.work_limits
@options.file_limits
def command(
    file: str,
    as_json: bool,
    timeout: float | None,
    max_memory: int | None,
    **limits: int | None,
) -> None:
    """Answer structural questions about the system in FILE twice: in floating point, and exactly.

    Each floating-point verdict is the library's own call with its default tolerance, and is quoted.
    At the end stands an upper bound on the distance to having a fixed mode, in floating point.
    """
    from mcexact.cli.files import place_of, read
    from mcexact.cli.output import emit, emit_json
    from mcexact.cli.supervision import supervised
    from mcexact.report.text import plain

    place = place_of(file)
    moved = options.given(limits)
    answer = supervised(
        _crosschecked,
        place,
        read(file, moved),
        moved,
        doing=f"cross-checking {place}",
        timeout=timeout,
        max_memory=max_memory,
    )
    if as_json:
        emit_json(answer["json"])
    else:
        emit(plain(answer["tables"]))


def _crosschecked(place: str, data: bytes, limits: dict[str, int]) -> dict[str, Any]:
    """Answer, and put the answers into text: what the child process does."""
    from mcexact.cli.files import system_in
    from mcexact.crosscheck.table import crosscheck
    from mcexact.report.crosscheck_view import crosscheck_tables, crosscheck_view

    system = system_in(place, data, limits)
    found = crosscheck(system)
    return {"json": crosscheck_view(found), "tables": crosscheck_tables(found)}
