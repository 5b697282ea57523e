"""`mcexact analyze`: decide all questions about one system."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from mcexact.analysis.questions import QUESTIONS, asked_by
from mcexact.cli import options
from mcexact.cli.commands import DEFINITE_NO, one_message
from mcexact.cli.uncertainty import at_values
from mcexact.model.properties import PROPERTIES, Property, question_about

if TYPE_CHECKING:
    from mcexact.analysis.boxes.largest import LargestUncertainty
    from mcexact.cli.running import Known, Reporting
    from mcexact.model.system import MultiChannelSystem

_LINES_OF_WORDS, _WITH_LINKS = 5, 8
"""The most lines of sentences before the tables, also where links of the plant are told about."""
_MODES = 6
_FIXED = ("factors", "generic", "exceptional", "hypersurfaces")
"""What the fixed spectrum says of modes, without and with parameters."""
_ASKED = {question.option: question.help for question in reversed([*QUESTIONS.values()])}
_ALSO = {option: told for option, told in reversed(_ASKED.items()) if option}
"""The options that add questions, from the table of questions, with their help texts."""


def _also(function: Callable[..., int]) -> Callable[..., int]:
    """Add the options that add questions."""
    for option, told in reversed(_ALSO.items()):
        function = click.option(f"--{option}", is_flag=True, help=f"Also decide {told}.")(function)
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
@at_values(
    "give a parameter a value",
    "May be repeated; without values for all of them, the others stay, and the answers are about "
    "all their values.",
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
    asserted: str | None,
    html: Path | None,
    latex: bool,
    **given: Any,
) -> int:
    """Decide the questions about the system in FILE (- for standard input).

    These are: which modes are fixed under every linear time-invariant decentralized control, which
    channels cause that, whether the system can be stabilized, joint controllability with its
    indices, the transfer graph, completeness, and the parts into which the spectrum splits.

    Of a system with parameters most of these are decided for all values, and it is said at which
    values the answer is another one.  With --at all questions are asked about one value.
    """

    from mcexact.cli import files
    from mcexact.cli.files import require_apart, require_page, write_result
    from mcexact.cli.running import Rechecked, Run, undecided_error

    effort = options.effort_of_search(given, "property")
    if effort is not None and information != "own":
        raise click.UsageError(
            "--largest-uncertainty is about agents that feed back their own outputs: leave out "
            "--information"
        )
    wanted = given.pop("property").replace("-", " ")
    run = Run(given)
    require_page(html, run.certificates, file)
    require_apart(html, run.certificates)
    also = [option for option in _ALSO if given[option.replace("-", "_")]]
    plant = run.read(file)
    doing = f"analyzing {plant[0]}"
    answer, ended = run.result_in_parts(
        _answer,
        plant,
        run.limits,
        also,
        {"information": information, "subset": _named(subset), "channel": channel},
        named,
        (given.pop("uncertainty"), effort, wanted),
        dict(at),
        html is not None,
        latex,
        run.system_by_digest,
        doing=doing,
    )
    only_latex = latex and html is None

    def show() -> bool:
        if only_latex:
            files.emit(answer["latex"])
        else:
            files.emit(answer["words"] + "\n")
            files.emit_tables(answer["tables"])
        return not only_latex

    def write(checked: Rechecked) -> None:
        if html is not None:
            results = answer["latex"] if latex else None
            page = answer["page"].rendered(answer["certificates"], checked.verdicts, results)
            write_result(html, page)

    about = f"the answers about {plant[0]}"
    checked = run.conclude(answer, show, about=about, write=write)
    undecided = undecided_error(ended, answer["ended"], doing)
    if checked.missing is not None and undecided is not None:
        click.echo(one_message(undecided), err=True)
    checked.require_complete()
    if asserted == "no-fixed-modes":
        spectrum = answer["json"]["fixed_spectrum"]
        if any(spectrum.get(key) for key in _FIXED):
            return DEFINITE_NO
    if undecided is not None:
        raise undecided
    return 0


def _named(subset: str | None) -> list[str] | None:
    """Parse names separated by commas; an empty text is the empty set."""
    if subset is None:
        return None
    return [name.strip() for name in subset.split(",")] if subset.strip() else []


def _answer(
    plant: tuple[str, bytes],
    limits: dict[str, int],
    also: list[str],
    question: dict[str, Any],
    named: tuple[str, ...],
    uncertain: tuple[Fraction | None, float | None, Property],
    at: dict[str, Fraction],
    with_page: bool,
    with_latex: bool,
    system_by_digest: bool,
    known: Known,
    report: Reporting,
) -> dict[str, Any]:
    """Decide and format the answer, in the child process."""
    from dataclasses import replace

    from mcexact.analysis.analyze import analyze
    from mcexact.cli import uncertainty
    from mcexact.cli.files import plant_in
    from mcexact.cli.running import told
    from mcexact.cli.uncertainty import effort_tables, for_all_values
    from mcexact.model.parametric import ParametricSystem
    from mcexact.report.text import in_lines, latex, tables

    given = plant_in(*plant, limits, at)
    if isinstance(given, ParametricSystem):
        refused = question["information"] != "own" or question["subset"] or any(uncertain[:2])
        asked, channel = [*asked_by(*also), *named], question["channel"]
        return for_all_values(
            *(given, asked, channel, bool(refused), with_page, with_latex, system_by_digest),
            known=known,
            report=report,
        )
    system, largest = _searched(given, uncertain, known, report)
    found = analyze(system, also=[*asked_by(*also), *named], **question)
    if largest is not None and largest.proof is not None:
        found.know(question_about(uncertain[2]), largest.proof)
    known.resume(found, report)
    account = found.account
    lines = _WITH_LINKS if "linked_fixed_spectrum" in account.answers else _LINES_OF_WORDS
    page = None
    if with_page:
        from mcexact.report.pages import account_page

        page = account_page(account)
        more = (*uncertainty.tables(largest), *effort_tables(found.effort()))
        page = replace(
            page,
            answer=(*uncertainty.leading(account, largest), *page.answer),
            pictures=(*uncertainty.pictures(largest), *page.pictures),
            tables=(
                *page.tables,
                *(replace(each, title=each.title.capitalize()) for each in more),
            ),
        )
    return told(account, system_by_digest and system is given) | {
        "json": found.to_dict() | uncertainty.view(largest),
        "words": uncertainty.lead(account, largest) + in_lines(account.sentences, lines),
        "tables": (
            *uncertainty.tables(largest),
            *tables(account.sentences, most_modes=_MODES),
            *effort_tables(found.effort()),
        ),
        "latex": latex(account) if with_latex else "",
        "page": page,
        "ended": _not_searched(uncertain, known) | found.ended(),
    }


_LARGEST = "largest uncertainty"


def _searched(
    given: MultiChannelSystem,
    uncertain: tuple[Fraction | None, float | None, Property],
    known: Known,
    report: Reporting,
) -> tuple[MultiChannelSystem, LargestUncertainty | None]:
    """The system with the radii that are asked for, and the search for the largest ones."""
    from mcexact.cli import uncertainty

    part, effort, wanted = uncertain
    if effort is None or _not_searched(uncertain, known):
        return uncertainty.of(given, part)
    if _LARGEST in known.parts:
        found: tuple[MultiChannelSystem, LargestUncertainty] = pickle.loads(known.parts[_LARGEST])
        return found
    report.begin(_LARGEST, f"searching the {_LARGEST}")
    made = uncertainty.of(given, part, effort, wanted)
    report.keep(_LARGEST, pickle.dumps(made))
    return made


def _not_searched(
    uncertain: tuple[Fraction | None, float | None, Property], known: Known
) -> dict[str, list[str]]:
    """The search for the largest radii, by the reason why it was ended, if it was."""
    reason = known.lost.get(_LARGEST) or known.ended
    if uncertain[1] is None or not reason or _LARGEST in known.parts:
        return {}
    return {reason: [_LARGEST]}
