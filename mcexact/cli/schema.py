"""`mcexact schema`: JSON Schemas of files and of the JSON of commands."""

from __future__ import annotations

import click

from mcexact.cli.options import as_json


@click.command(name="schema", short_help="Print a JSON Schema of files or of --json.")
@click.argument("name", required=False)
@as_json
def command(name: str | None, as_json: bool) -> None:
    """Print the JSON Schema (2020-12) NAME, or list all of them with their folder.

    Editors complete and check system files by it, and programs what the commands print. The output
    for a NAME is JSON with and without --json.
    """
    from mcexact.cli.output import emit, emit_json, emit_tables
    from mcexact.report.schema import DOCUMENTS, FOLDER, schema_text
    from mcexact.report.text import Table

    if name is not None:
        emit(schema_text(name))
    elif as_json:
        emit_json(
            {"folder": str(FOLDER), "schemas": {key: told for key, (_, told) in DOCUMENTS.items()}}
        )
    else:
        listed = tuple((key, told) for key, (_, told) in DOCUMENTS.items())
        emit_tables((Table(f"schemas in {FOLDER}", (), listed, "mcexact schema NAME"),))
