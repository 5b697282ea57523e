"""`mcexact demo`: two questions that floating point answers wrongly."""

from __future__ import annotations

import click

from mcexact.cli.options import as_json


@click.command(name="demo", short_help="Show two failures of floating point beside exact answers.")
@as_json
def command(as_json: bool) -> None:
    """Show two failures of floating point, computed now, beside the exact answers."""
    from mcexact.cli.output import emit, emit_json
    from mcexact.report.demonstration import demonstration

    shown = demonstration()
    if as_json:
        emit_json(shown.as_json())
    else:
        emit(shown.as_text())
