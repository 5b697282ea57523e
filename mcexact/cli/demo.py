"""`mcexact demo`: two questions that floating point answers wrongly."""

from __future__ import annotations

import click

from mcexact.cli.options import as_json


@click.command(
    name="demo", short_help="Show two wrong answers of floating point with the exact ones."
)
@as_json
def command(as_json: bool) -> None:
    """Show two wrong answers of floating point, recorded and recomputed, with the exact ones."""
    from mcexact.cli.output import emit, emit_json
    from mcexact.crosschecks.demonstration import (
        demonstration,
        demonstration_text,
        demonstration_view,
    )

    shown = demonstration()
    if as_json:
        emit_json({"format": "mcexact-demo/1", **demonstration_view(shown)})
    else:
        emit(demonstration_text(shown))
