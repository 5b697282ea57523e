"""`mcexact gallery`: the published plants that every command takes by name."""

from __future__ import annotations

import click

from mcexact.cli import options


@click.command(name="gallery", short_help="List published plants, which every command takes.")
@options.as_json
def command(as_json: bool) -> None:
    """List the published plants with their sources and what each shows.

    Every command takes one as gallery:NAME in place of a file, such as `mcexact analyze
    gallery:quadruple-tank-pminus`; `mcexact convert gallery:NAME -o FILE` writes its file.
    """
    from dataclasses import asdict

    from mcexact.cli.output import emit_json, emit_tables
    from mcexact.model.gallery import published
    from mcexact.report.text import WIDE, Table, shorten

    plants = published()
    if as_json:
        emit_json({"format": "mcexact-gallery/1", "plants": [asdict(each) for each in plants]})
        return
    rows = tuple(
        (
            each.name,
            str(each.n),
            str(each.m),
            ", ".join(each.parameters),
            each.time,
            shorten(each.source, 60),
            each.shows,
        )
        for each in plants
    )
    note = "mcexact analyze gallery:NAME"
    columns = ("name", "n", "m", "parameters", "time", "source", "shows")
    emit_tables((Table("", columns, rows, note),), width=WIDE)
