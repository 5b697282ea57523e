"""`mcexact analyze`: everything that is decided about one system."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from mcexact.cli import options
from mcexact.cli.failures import DEFINITE_NO

_LINES_OF_WORDS = 5
_FACTORS = 6


@click.command(
    name="analyze", short_help="Decide which modes no linear time-invariant control can move."
)
@click.argument("file")
@click.option(
    "--information",
    type=click.Choice(["own", "outputs"]),
    default="own",
    show_default=True,
    help="What agent i feeds back: its own output, or those of all its neighbors.",
)
@click.option(
    "--minimal", is_flag=True, help="Find the least that the agents must share, both ways."
)
@click.option(
    "--links",
    is_flag=True,
    help="Find the fewest links over which sending outputs leaves no mode fixed.",
)
@click.option(
    "--subset",
    metavar="NAMES",
    help="Also the rank of the pencil for this set of channels, such as 1,3, at every mode of A, "
    "and its complementary subsystem.",
)
@click.option(
    "--channel",
    metavar="NAME",
    help="Also what this channel controls and observes, alone and with gains.",
)
@click.option(
    "--every-channel",
    is_flag=True,
    help="Also gains with which every channel controls and observes the whole plant.",
)
@click.option(
    "--delayed", is_flag=True, help="Also what is fixed with the delays in FILE, lifted and held."
)
@click.option(
    "--assert",
    "asserted",
    type=click.Choice(["no-fixed-modes"]),
    help="End with status 1 if this is false.",
)
@click.option(
    "--html",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Write a report for a browser: the answer in plain words, graphs, and all evidence.",
)
@click.option("--latex", is_flag=True, help="Print the results in LaTeX (with --html: add them).")
@options.certificates
@options.as_json
@options.work_limits
@options.file_limits
def command(
    file: str,
    information: str,
    minimal: bool,
    links: bool,
    delayed: bool,
    subset: str | None,
    channel: str | None,
    every_channel: bool,
    asserted: str | None,
    html: Path | None,
    latex: bool,
    certificates: Path | None,
    as_json: bool,
    timeout: float | None,
    max_memory: int | None,
    **limits: int | None,
) -> int:
    """Decide everything about the system in FILE (- for standard input).

    Which modes are fixed under every linear time-invariant decentralized control, which channels
    are to blame, whether the rest can be stabilized, joint controllability with its indices, the
    transfer graph, completeness, and the parts into which the spectrum splits.
    """

    from mcexact.cli.deadline import Deadline
    from mcexact.cli.files import directory, place_of, read, require_other, require_writable
    from mcexact.cli.output import emit, emit_json, emit_tables
    from mcexact.cli.rechecking import rechecked
    from mcexact.cli.supervision import supervised
    from mcexact.model.atomic import write_text

    deadline = Deadline(timeout)
    place = place_of(file)
    require_other(html, file)
    require_writable(html, certificates)
    moved = options.given(limits)
    answer = supervised(
        _answer,
        place,
        read(file, moved, deadline),
        moved,
        {
            "information": information,
            "minimal": minimal,
            "links": links,
            "delayed": delayed,
            "subset": _named(subset),
            "channel": channel,
            "every_channel": every_channel,
        },
        certificates is not None,
        html is not None,
        doing=f"analyzing {place}",
        timeout=deadline,
        max_memory=max_memory,
    )
    shown = not as_json
    if latex and html is None and shown:
        emit(answer["latex"])
    elif shown:
        emit(answer["words"] + "\n")
        emit_tables(answer["tables"])
    checked = rechecked(
        answer["certificates"],
        answer["digest"],
        doing=f"re-checking the answers about {place}",
        deadline=deadline,
        max_memory=max_memory,
    )
    if certificates is not None:
        folder = directory(certificates)
        for name, text in answer["certificates"].items():
            write_text(folder / name, text)
    if html is not None:
        results = answer["latex"] if latex else None
        write_text(html, answer["page"].rendered(answer["certificates"], checked.verdicts, results))
    if as_json:
        emit_json(answer["json"] | {"re_checked": checked.view()})
    elif checked.missing is None and not (latex and html is None):
        emit("\n" + checked.line())
    checked.require_complete()
    if asserted == "no-fixed-modes" and not answer["json"]["fixed_spectrum"]["empty"]:
        return DEFINITE_NO
    return 0


def _named(subset: str | None) -> list[str] | None:
    """The names in a list separated by commas; an empty text is the empty set."""
    if subset is None:
        return None
    return [name.strip() for name in subset.split(",")] if subset.strip() else []


def _answer(
    place: str,
    data: bytes,
    limits: dict[str, int],
    question: dict[str, Any],
    names_certificates: bool,
    with_page: bool,
) -> dict[str, Any]:
    """Decide, and put the answer into text: what the child process does."""
    from mcexact.answer import codec
    from mcexact.cli.files import system_in
    from mcexact.model.system_file import digest
    from mcexact.report.assessment import assess
    from mcexact.report.assessment_tables import assessment_tables
    from mcexact.report.json_view import assessment_view
    from mcexact.report.latex import assessment_latex
    from mcexact.report.words import in_lines

    system = system_in(place, data, limits)
    assessment = assess(system, **question)
    page = None
    if with_page:
        from mcexact.report.assessment_page import assessment_page

        page = assessment_page(assessment)
    return {
        "json": assessment_view(assessment, with_certificates=names_certificates),
        "words": in_lines(assessment, _LINES_OF_WORDS),
        "tables": assessment_tables(assessment, most_factors=_FACTORS),
        "latex": assessment_latex(assessment),
        "page": page,
        "certificates": {
            name: codec.encode(made) for name, made in assessment.certificates().items()
        },
        "digest": digest(system.plant),
    }
