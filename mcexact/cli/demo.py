"""`mcexact demo`: two questions that floating point answers wrongly."""

from __future__ import annotations

import click

from mcexact.cli.options import as_json


@click.command(name="demo", short_help="Show two failures of floating point beside exact answers.")
@as_json
def command(as_json: bool) -> None:
    """Show two failures of floating point, as recorded and as computed now, beside the truth."""
    from mcexact.cli.output import emit, emit_json
    from mcexact.crosscheck.demonstration import demonstration
    from mcexact.report.demonstration_view import demonstration_text, demonstration_view

    shown = demonstration()
    if as_json:
        emit_json(demonstration_view(shown))
    else:
        emit(demonstration_text(shown))
