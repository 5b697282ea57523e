"""`mcexact analyze`: the options, and how the answers are shown.

Which questions there are is not decided here: `QUESTIONS` has them with their options and help
texts.  `mcexact.cli.decisions.analyzed` decides in a child process.  Where a limit or an interrupt
ends it, what was decided is shown, re-checked and written all the same, and then the status is that
of the limit.  ``--assert`` is answered from the fixed spectrum, even if other questions are open.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import click

from mcexact.analysis.questions import QUESTIONS
from mcexact.cli import options, parts
from mcexact.cli.commands import DEFINITE_NO, one_message
from mcexact.cli.files import (
    emit_tables,
    require_apart,
    require_other,
    require_page,
    require_writable,
    write_result,
)
from mcexact.cli.output import emit
from mcexact.cli.results import Analyzed, Asked
from mcexact.cli.running import Rechecked, Run, undecided_error
from mcexact.model.properties import PROPERTIES

_FIXED = ("factors", "generic", "exceptional", "hypersurfaces")
"""What the fixed spectrum says of modes, without and with parameters."""
_BY_OPTION = {question.option: question.help for question in reversed([*QUESTIONS.values()])}
_ALSO = {option: text for option, text in reversed(_BY_OPTION.items()) if option}
"""The options that add questions, from the table of questions, with their help texts."""


def _also(function: Callable[..., int]) -> Callable[..., int]:
    """Add the options that add questions."""
    for option, text in reversed(_ALSO.items()):
        function = click.option(f"--{option}", is_flag=True, help=f"Also decide {text}.")(function)
    return function


@click.command(
    name="analyze",
    short_help="Decide which modes are fixed, and all other questions about a system.",
)
@click.argument("file")
@click.option(
    "--information",
    type=click.Choice(["own", "outputs"]),
    default="own",
    show_default=True,
    help="The outputs that agent i feeds back: its own, or those of all its neighbors.",
)
@parts.option("Ask about")
@_also
@click.option(
    "--subset",
    metavar="NAMES",
    help="Also decide the rank of the pencil of these channels, such as 1,3, at every mode of A, "
    "and their complementary subsystem.",
)
@click.option(
    "--channel",
    metavar="NAME",
    help="Also decide what this channel controls and observes, alone and with gains.",
)
@click.option(
    "--also",
    "named",
    multiple=True,
    type=click.Choice(sorted(QUESTIONS)),
    metavar="QUESTION",
    help="Also decide this question, by its name in --json, such as one that is left out of large "
    "systems. May be repeated.",
)
@options.uncertainty
@options.largest_uncertainty(
    "Search the largest part by which entries may differ such that every plant has a property, by "
    "default no fixed mode, and a plant near it that lacks it."
)
@click.option(
    "--property",
    type=click.Choice([each.replace(" ", "-") for each in PROPERTIES.values()]),
    default="no-fixed-mode",
    show_default=True,
    help="With --largest-uncertainty: what every plant is to have, or to be.",
)
@options.at_values(
    "give a parameter a value",
    "May be repeated; without values for all of them, the others stay, and the answers are about "
    "all their values.",
)
@click.option(
    "--nearby",
    type=options.FOLDER,
    metavar="FILE",
    help="Write the plant nearby of which an answer is another one, if one is found, exactly into "
    "this system file.",
)
@click.option(
    "--no-nearby",
    is_flag=True,
    help="Do not look for plants nearby of which an answer is another one.",
)
@click.option(
    "--pattern",
    is_flag=True,
    help="Take the entries that are not 0 for places of any numbers: decide only which modes are "
    "fixed for all of them, and for almost all of them.",
)
@click.option(
    "--assert",
    "asserted",
    type=click.Choice(["no-fixed-modes"]),
    help="End with status 1 if this property does not hold.",
)
@options.page("sentences, graphs and all certificates")
@click.option(
    "--latex", is_flag=True, help="Print the results in LaTeX (with --html: add them to the page)."
)
@options.answering
def command(
    file: str,
    information: str,
    subset: str | None,
    channel: str | None,
    named: tuple[str, ...],
    at: tuple[tuple[str, Fraction], ...],
    nearby: Path | None,
    no_nearby: bool,
    pattern: bool,
    asserted: str | None,
    html: Path | None,
    latex: bool,
    **values: Any,
) -> int:
    """Decide the questions about the system in FILE (- for standard input).

    These are: which modes are fixed under every linear time-invariant decentralized control, which
    channels cause that, whether the system can be stabilized, joint controllability with its
    indices, the transfer graph, completeness, and the parts into which the spectrum splits.

    Of a system with parameters most of these are decided for all values, and it is said at which
    values the answer is another one.  With --at all questions are asked about one value.
    """
    effort = options.effort_of_search(values, "property")
    if effort is not None and information != "own":
        raise click.UsageError(
            "--largest-uncertainty is about agents that feed back their own outputs: leave out "
            "--information"
        )
    wanted = values.pop("property").replace("-", " ")
    run = Run(values)
    require_page(html, run.certificates, file)
    require_apart(html, run.certificates, nearby)
    require_other(nearby, file)
    require_writable(nearby)
    if nearby is not None and no_nearby:
        raise click.UsageError("--nearby and --no-nearby contradict each other: give one of them")
    if pattern and asserted:
        raise click.UsageError("--pattern has no answer to --assert: leave out one of them")
    also = [option for option in _ALSO if values[option.replace("-", "_")]]
    require_other(html, parts.file_of(values))
    plant, part = run.read(file), parts.taken(values, run)
    doing = f"analyzing {plant[0]}"
    answer, ended = run.result_in_parts(
        _analyzed,
        plant,
        run.limits,
        Asked(
            options=also,
            named=named,
            information=information,
            subset=_subset(subset),
            channel=channel,
            radii=values["uncertainty"],
            effort=effort,
            wanted=wanted,
            at=dict(at),
            nearby=not (no_nearby or pattern),
            pattern=pattern,
            seconds=run.deadline.left(),
            part=part,
        ),
        html is not None,
        latex,
        run.system_by_digest,
        doing=doing,
    )
    only_latex = latex and html is None

    def show() -> bool:
        if only_latex:
            emit(answer.latex)
        else:
            emit(answer.words + "\n" if answer.words.strip() else "")
            emit_tables(answer.tables)
        return not only_latex

    def write(checked: Rechecked) -> None:
        if html is not None and answer.page is not None:
            results = answer.latex if latex else None
            certificates = answer.evidence.certificates
            write_result(html, answer.page.rendered(certificates, checked.verdicts, results))
        if nearby is not None and answer.nearby:
            write_result(nearby, answer.nearby)
        elif nearby is not None:
            click.echo(f"no plant nearby was found: {nearby} is not written", err=True)

    about = f"the answers about {plant[0]}"
    checked = run.conclude(answer, show, about=about, write=write)
    undecided = undecided_error(ended, answer.undecided, doing)
    if checked.missing is not None and undecided is not None:
        click.echo(one_message(undecided), err=True)
    checked.require_complete()
    if asserted == "no-fixed-modes":
        spectrum = answer.document["fixed_spectrum"]
        if any(spectrum.get(key) for key in _FIXED):
            return DEFINITE_NO
    if undecided is not None:
        raise undecided
    return 0


def _subset(text: str | None) -> list[str] | None:
    """Parse names separated by commas; an empty text is the empty set."""
    if text is None:
        return None
    return [name.strip() for name in text.split(",")] if text.strip() else []


def _analyzed(*arguments: Any, **messages: Any) -> Analyzed:
    """Decide and format the answers, in the child process."""
    # The child process alone loads what decides: the clock runs while it does, and Ctrl-C ends it.
    from mcexact.cli.decisions import analyzed

    return analyzed(*arguments, **messages)
