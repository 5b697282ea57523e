"""What `mcexact analyze` and `mcexact allocate` decide, in their child processes.

`analyzed` reads the plant and asks the questions about it, by `mcexact.analysis.analyze.Analysis`:
with parameters for all values of these, and without parameters after the search for the largest
radii if that is asked for.  It resumes what an earlier child decided before a limit (`Known`), and
hands over each answer at once (`Reporting`).  `allocated` finds the least dimensions of shared
sub-states, or the cheapest links to add.

Pages have pictures, whose libraries are loaded for a page alone.
"""

from __future__ import annotations

import pickle
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from mcexact.analysis.analyze import (
    Analysis,
    Effort,
    account_of_dimensions,
    account_of_links,
    analyze,
)
from mcexact.analysis.questions import QUESTIONS, questions_about
from mcexact.answer.account import Account
from mcexact.answer.sharing import ROW_BOUND
from mcexact.cli import options, parts, uncertainty
from mcexact.cli.files import plant_in, system_in
from mcexact.cli.results import PART_OF_SEARCH, Allocated, Analyzed, Asked, Evidence
from mcexact.cli.running import Known, Reporting
from mcexact.errors import UsageError
from mcexact.exact.rational import parse_rational
from mcexact.exact.roots import StabilityRegion
from mcexact.model.parametric import ParametricSystem
from mcexact.model.properties import question_about
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import system_text
from mcexact.report.text import (
    WIDTH,
    Table,
    in_lines,
    latex,
    parameter_latex,
    parameter_tables,
    tables,
    wrapped,
)

if TYPE_CHECKING:
    from mcexact.analysis.boxes.largest import LargestUncertainty
    from mcexact.analysis.nearby.plants import Nearby

_LINES_OF_WORDS, _WITH_LINKS = 5, 8
"""The most lines of sentences before the tables, and where sentences are about links as well."""
_ABOUT_LINKS = {"linked_fixed_spectrum", "minimal_communication"}
_LINES_NEARBY = 4
"""How many more lines there are where a sentence about a plant nearby leads."""
_LINES_FAILURES, _LINES_SHARED = 3, 3
"""How many more lines there are where single failures were asked about."""
_MODES = 6
_LONG = 10.0
"""The seconds from which on a question is listed with its time."""
_LARGEST = "largest uncertainty"


def analyzed(
    plant: tuple[str, bytes],
    limits: Mapping[str, int],
    asked: Asked,
    with_page: bool,
    with_latex: bool,
    system_by_digest: bool,
    known: Known,
    report: Reporting,
) -> Analyzed:
    """Decide the questions about a plant and format the answers.

    Parameters
    ----------
    plant : tuple of str and bytes
        The name of the file and its content.
    limits : mapping
        The limits on input files.
    asked : Asked
    with_page, with_latex : bool
        Whether a page and LaTeX are asked for.
    system_by_digest : bool
        Whether certificates name the plant by its digest.
    known : Known
        What an earlier process decided.
    report : Reporting

    Raises
    ------
    InputError
        If the file is malformed.
    UsageError
        If something is asked that does not apply to the plant.
    """
    began = time.monotonic()
    typed = plant_in(*plant, limits, asked.at)
    if asked.part is not None and (asked.radii or asked.effort):
        raise UsageError(
            "--modulo is about the values of a plant: leave out --uncertainty and "
            "--largest-uncertainty"
        )
    of_numbers = asked.radii or asked.effort or asked.part
    if asked.pattern and (of_numbers or asked.questions or asked.subset or asked.channel):
        raise UsageError("--pattern is about all numbers: leave out what is about those of a plant")
    if isinstance(typed, ParametricSystem):
        if asked.pattern:
            raise UsageError("--pattern is about a plant without parameters: give them values")
        parts.without(typed, asked.part, limits)
        return _for_all_values(
            typed, asked, with_page, with_latex, system_by_digest, known=known, report=report
        )
    given, search = _searched(typed, asked, known, report)
    system = parts.without(given, asked.part, limits)
    analysis = analyze(
        system,
        ["structural_fixed_modes"] if asked.pattern else None,
        also=asked.questions,
        information=asked.information,
        subset=asked.subset,
        channel=asked.channel,
        nearby=asked.nearby,
    )
    if search is not None and search.proof is not None:
        analysis.know(question_about(asked.wanted), search.proof)
    known.resume(analysis, report)
    if asked.seconds is not None:
        # The questions come first, and showing what they are has its time as well.
        decided, left = analysis.answers, asked.seconds - (time.monotonic() - began)
        analysis.nearby_seconds = max(0.0, left) / PART_OF_SEARCH if decided else 0.0
    account, taken = analysis.account, effort_tables(analysis.effort())
    near = None if analysis.nearby_left_out else analysis.nearby
    suspected = () if near is None else suspicions(near)
    lines = _WITH_LINKS if _ABOUT_LINKS & account.answers.keys() else _LINES_OF_WORDS
    lines += _LINES_FAILURES * ("failures_1" in account.answers)
    lines += _LINES_SHARED * ("shared_fixed_spectrum" in account.answers)
    lines += _LINES_NEARBY * (near is not None and bool(near.leading))
    page = None
    if with_page:
        # Pictures need numpy and matplotlib.
        from mcexact.report.pages import account_page

        page = account_page(account)
        more = (*uncertainty.tables(search), *suspected, *taken)
        page = replace(
            page,
            answer=(*uncertainty.leading(account, search), *page.answer),
            pictures=(*uncertainty.pictures(search), *page.pictures),
            tables=(
                *page.tables,
                *(replace(each, title=each.title.capitalize()) for each in more),
            ),
        )
    return Analyzed(
        evidence=Evidence.of(account, system_by_digest and given is typed),
        document=analysis.to_dict() | uncertainty.view(search),
        words=uncertainty.lead(account, search) + in_lines(account.sentences, lines),
        tables=(
            *uncertainty.tables(search),
            *tables(account.sentences, most_modes=_MODES, note=account.reading),
            *suspected,
            *taken,
        ),
        latex=latex(account) if with_latex else "",
        page=page,
        undecided=_not_searched(asked, known) | analysis.ended(),
        nearby=system_text(near.plants[0].plant) if near is not None and near.plants else "",
    )


def _searched(
    plant: MultiChannelSystem, asked: Asked, known: Known, report: Reporting
) -> tuple[MultiChannelSystem, LargestUncertainty | None]:
    """Return the plant with the radii that are asked for, and the search for the largest ones.

    The search is a part of the work like a question: it is taken from ``known`` if it was finished,
    and not begun again if a limit ended it.
    """
    if asked.effort is None or _not_searched(asked, known):
        return uncertainty.with_radii(plant, asked.radii)
    if _LARGEST in known.parts:
        finished: tuple[MultiChannelSystem, LargestUncertainty] = pickle.loads(
            known.parts[_LARGEST]
        )
        return finished
    report.begin(_LARGEST, f"searching the {_LARGEST}")
    searched = uncertainty.with_radii(plant, asked.radii, asked.effort, asked.wanted)
    report.keep(_LARGEST, pickle.dumps(searched))
    return searched


def _not_searched(asked: Asked, known: Known) -> dict[str, list[str]]:
    """Return the search for the largest radii by the reason why it was ended, if it was."""
    reason = known.lost.get(_LARGEST) or known.ended
    if asked.effort is None or not reason or _LARGEST in known.parts:
        return {}
    return {reason: [_LARGEST]}


def _for_all_values(
    system: ParametricSystem,
    asked: Asked,
    with_page: bool,
    with_latex: bool,
    system_by_digest: bool,
    *,
    known: Known,
    report: Reporting,
) -> Analyzed:
    """Decide and format the answers for all values of the parameters.

    Raises
    ------
    UsageError
        If something is asked that is only decided for systems without parameters.
    """
    only_without = asked.information != "own" or asked.subset or asked.radii or asked.effort
    if only_without or not questions_about(system.parameters).keys() >= {*asked.questions}:
        raise UsageError(
            "these questions are about systems without parameters: give values to "
            f"{', '.join(system.parameters)} by --at NAME=VALUE"
        )
    analysis = Analysis(system, channel=asked.channel)
    analysis.also(asked.questions)
    known.resume(analysis, report)
    account, taken = analysis.account, effort_tables(analysis.effort())
    page = None
    if with_page:
        # Pictures need numpy and matplotlib.
        from mcexact.report.pages import parameter_page

        page = parameter_page(account)
        page = replace(page, tables=(*page.tables, *taken))
    words = [line for sentence in account.at("answer") for line in wrapped(sentence, WIDTH)]
    return Analyzed(
        evidence=Evidence.of(account, system_by_digest),
        document=analysis.to_dict(),
        words="\n".join(words) + "\n",
        tables=(*parameter_tables(account), *taken),
        latex=parameter_latex(account) if with_latex else "",
        page=page,
        undecided=analysis.ended(),
    )


def suspicions(near: Nearby) -> tuple[Table, ...]:
    """Return a table of the plants nearby that floating point suspects, if there are any."""
    rows = [("", each.explain()) for each in near.suspected]
    return (Table("plants nearby, computed and not certified", (), tuple(rows)),) if rows else ()


def effort_tables(efforts: Sequence[Effort]) -> tuple[Table, ...]:
    """Return a table of the questions that took long or were not decided, if there are any."""
    rows = [
        (
            each.question.replace("_", " "),
            "–" if each.outcome == "left out" else f"{each.seconds:.1f}",
            f"{each.outcome}: {each.reason}" if each.reason else each.outcome,
        )
        for each in efforts
        if each.seconds >= _LONG or each.outcome != "decided"
    ]
    left_out = any(each.outcome == "left out" and each.question in QUESTIONS for each in efforts)
    note = "Decide a question that is left out by --also and its name." if left_out else ""
    columns = ("question", "seconds", "outcome")
    title = "questions that are open or took long"
    return (Table(title, columns, tuple(rows), note),) if rows else ()


def allocated(
    plant: tuple[str, bytes],
    limits: Mapping[str, int],
    question: dict[str, Any],
    with_page: bool,
    system_by_digest: bool,
) -> Allocated:
    """Find the least that agents must share, or the cheapest links to add, and format the answer.

    Parameters
    ----------
    plant : tuple of str and bytes
        The name of the file and its content.
    limits : mapping
        The limits on input files.
    question : dict
        The options of `mcexact allocate` that say what is asked.
    with_page, system_by_digest : bool

    Raises
    ------
    UsageError
        If options contradict each other, or do not apply to the plant.
    """
    system = system_in(*plant, limits)
    region = _region(system.time, question.pop("rate"), question.pop("radius"))
    if question.pop("links"):
        account = account_of_links(system, **_links(question, region))
        least = account.answers["minimal_communication"]
    else:
        account = account_of_dimensions(system, **_dimensions(system.names, question, region))
        least = account.answers["minimal_shared_dimensions"]
    page = None
    if with_page:
        # Pictures need numpy and matplotlib.
        from mcexact.report.pages import allocation_page

        page = allocation_page(account)
    return Allocated(
        evidence=Evidence.of(account, system_by_digest),
        document=account.as_json(**_shares(account)),
        tables=tables(account.sentences, note=account.reading),
        page=page,
        feasible=least.feasible,
        within=getattr(least, "at_least", None) is not None,
    )


def _shares(account: Account) -> dict[str, Any]:
    """The dimensions by agent and in all: the least, and those of a bound that holds."""
    least = account.answers.get("minimal_shared_dimensions")
    if least is None or least.dimensions is None or least.at_least is not None:
        return {}
    holds = any(each.template.key == ROW_BOUND.key for each in account.sentences)
    k = account.answers["shared_dimension_bound"].deficiency if holds else None
    named = zip(account.given.names, least.dimensions, strict=True)
    total = {"least": least.total, "bound": None if k is None else k * account.given.m}
    by_agent = {agent: {"least": size, "bound": k} for agent, size in named}
    return {"shares": {"by_agent": by_agent, "total": total}}


def _region(time: str, rate: Fraction | None, radius: Fraction | None) -> StabilityRegion | None:
    """Return the region of the rate or the radius; a rate of 0 means stability."""
    own = StabilityRegion(time).word
    bounds = {"rate": rate, "radius": radius}
    bound = bounds.pop(own)
    if any(other is not None for other in bounds.values()):
        raise UsageError(f"the system is in {time} time: give --{own}")
    return None if bound is None else StabilityRegion.of(time, bound=bound)


def _dimensions(
    names: Sequence[str], question: dict[str, Any], region: StabilityRegion | None
) -> dict[str, Any]:
    """Return the arguments of `minimal_shared_dimensions`."""
    if question["dimensions"] or question["link_costs"] or question["forbid"]:
        raise UsageError("--dimensions, --link-cost and --forbid go with --links")
    prices = _by_agent(names, question["costs"], "--cost", parse_rational)
    most = _by_agent(names, question["upper"], "--upper", options.count)
    return {
        "share": question["share"],
        "costs": [prices.get(name, 1) for name in names],
        "upper": [most.get(name) for name in names],
        "region": region,
        "free_assignability": question["free"],
        "node_limit": question["node_limit"],
    }


def _by_agent(
    names: Sequence[str], pairs: Sequence[tuple[str, str]], option: str, read: Callable[[str], Any]
) -> dict[str, Any]:
    """Return the value that an option has for each agent."""
    values = {}
    for name, text in pairs:
        if name not in names:
            raise UsageError(f"{option}: there is no agent {name!r}")
        try:
            values[name] = read(text)
        except ValueError:  # an InputError is one
            raise UsageError(f"{option} {name}: expected a number, found {text!r}") from None
    return values


def _links(question: dict[str, Any], region: StabilityRegion | None) -> dict[str, Any]:
    """Return the arguments of `minimal_communication`."""
    if question["costs"] or question["upper"] or question["free"]:
        raise UsageError("--cost, --upper and --free do not go with --links")
    sizes = None
    costs: dict[tuple[str, str], Any] = {}
    for j, i, price in question["link_costs"]:
        costs[j, i] = _by_agent([i], [(i, price)], f"--link-cost {j}", parse_rational)[i]
    if question["dimensions"] is not None:
        try:
            sizes = [options.count(size) for size in question["dimensions"].split(",")]
        except ValueError:
            raise UsageError("--dimensions: expected integers >= 0 such as 0,0,1") from None
    return {
        "dimensions": sizes,
        "share": "outputs" if sizes is None else question["share"],
        "costs": costs,
        "forbidden": question["forbid"],
        "region": region,
        "node_limit": question["node_limit"],
    }
