"""`mcexact design observer`: the distributed observer with a prescribed spectrum."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Any

import click

from mcexact.cli import options


@click.command(name="observer", short_help="A distributed observer with a prescribed spectrum.")
@click.argument("file")
@options.rate
@options.radius
@click.option(
    "--spectrum",
    metavar="FILE",
    help='JSON {"feedback": P, "error": P}, P a list of coefficients or of roots and pairs.',
)
@click.option("--agent", metavar="NAME", help="Who carries the channel controller; else the first.")
@click.option(
    "--order",
    type=click.Choice(["least"]),
    help="The least order that one of the indices allows, instead of m - 1; in floating point "
    "an observer of reduced order.",
)
@options.arithmetic
@options.controller_output
@options.certificates
@options.as_json
@options.work_limits
@options.file_limits
def command(
    file: str,
    rate: Fraction | None,
    radius: Fraction | None,
    spectrum: str | None,
    agent: str | None,
    order: str | None,
    arithmetic: str,
    output: Path | None,
    certificates: Path | None,
    as_json: bool,
    timeout: float | None,
    max_memory: int | None,
    **limits: int | None,
) -> None:
    """Design a distributed observer-based controller for the system in FILE (- for standard input).

    FILE needs a neighbor graph. Give a rate or radius, or all the numbers: n for the feedback and
    nm + m - 1 for the estimation errors. If no linear time-invariant controller of this form
    exists, the status is 1 and the certificate says why.
    """
    from mcexact.cli.deadline import Deadline
    from mcexact.cli.files import directory, place_of, read, require_other, require_writable
    from mcexact.cli.output import emit, emit_json, emit_tables
    from mcexact.cli.supervision import supervised
    from mcexact.errors import Impossible
    from mcexact.model.atomic import write_text

    deadline = Deadline(timeout)
    place = place_of(file)
    moved = options.given(limits)
    require_other(output, file, spectrum)
    require_writable(output, certificates)
    prescribed = None if spectrum is None else (place_of(spectrum), read(spectrum, moved, deadline))
    wanted = {
        "q": agent,
        "rate": rate,
        "radius": radius,
        "order": order,
        "arithmetic": arithmetic,
    }
    answer = supervised(
        _designed,
        place,
        read(file, moved, deadline),
        prescribed,
        moved,
        wanted,
        doing=f"designing for {place}",
        timeout=deadline,
        max_memory=max_memory,
    )
    if certificates is not None and answer["certificate"] is not None:
        name, text = answer["certificate"]
        write_text(directory(certificates) / name, text)
    if "impossible" in answer:
        if as_json:
            emit_json({"design": "observer", "possible": False, "reason": answer["impossible"]})
        raise Impossible(answer["impossible"])
    if output is not None:
        write_text(output, answer["controller"])
    if as_json:
        if certificates is not None:
            answer["json"]["certificate"] = answer["certificate"][0]
        emit_json(answer["json"])
    elif output is not None:
        emit_tables(answer["tables"])
    else:
        emit(answer["controller"])


def _designed(
    place: str,
    data: bytes,
    prescribed: tuple[str, bytes] | None,
    limits: dict[str, int],
    wanted: dict[str, Any],
) -> dict[str, Any]:
    """Design, and put the answer into text: what the child process does."""
    from mcexact.certificate import codec
    from mcexact.cli.files import system_in
    from mcexact.errors import Impossible, InputError
    from mcexact.exact.rational import Limits
    from mcexact.model.controller_file import controller_text
    from mcexact.model.json_text import parse
    from mcexact.synthesis.observer import design_observer
    from mcexact.synthesis.spectrum import require_numbers

    spectrum = None
    system = system_in(place, data, limits)
    try:
        if prescribed is not None:
            spectrum = parse(prescribed[1], Limits(**limits))
            require_numbers(spectrum)
        design = design_observer(system, spectrum=spectrum, **wanted)
    except InputError as error:
        raise error.within(prescribed[0] if prescribed is not None else place) from None
    except Impossible as refused:
        found = refused.certificate
        written = None if found is None else (f"{found.kind}.json", codec.encode(found))
        return {"impossible": str(refused), "certificate": written}
    view, tables = _described(design)
    return {
        "controller": controller_text(design.controller),
        "certificate": (f"{design.certificate.kind}.json", codec.encode(design.certificate)),
        "json": view,
        "tables": tables,
    }


def _described(design: Any) -> tuple[dict[str, Any], Any]:
    """The design as plain data and as tables."""
    from mcexact.synthesis.observer import ObserverDesign

    if isinstance(design, ObserverDesign):
        from mcexact.report.design_view import observer_tables, observer_view

        return observer_view(design), observer_tables(design)
    from mcexact.report.observer_float_view import (
        design_margins,
        observer_float_tables,
        observer_float_view,
    )

    margins = design_margins(design)
    return observer_float_view(design, margins), observer_float_tables(design, margins)
