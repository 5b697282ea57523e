"""What commands say about parameters, ranges and radii.

A plant can be uncertain in two ways, and the commands ask about both:

- its entries have radii: `of` and `of_loop` search the largest ones for which the answers are
  proved, and `loops` proves all loops within the radii of plant and gains, or finds a plant nearby
  whose loop fails;
- its entries are functions of parameters: these are given values (`at_values`), or the answers are
  decided for all values (`for_all_values`), and a loop for all values in their ranges
  (`certified`).

`effort_tables` lists the questions that took long or were not decided.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any, TypeVar

import click

from mcexact.cli import options
from mcexact.model.properties import PROPERTIES, Property

if TYPE_CHECKING:
    from mcexact.analysis.analyze import Effort
    from mcexact.analysis.boxes.failure import FailingPlant
    from mcexact.analysis.boxes.largest import LargestRanges, LargestUncertainty
    from mcexact.answer.account import Account
    from mcexact.answer.boxes import BoxStability
    from mcexact.answer.loops import StabilityVerdict
    from mcexact.answer.protocol import Answer
    from mcexact.cli.running import Known, Reporting
    from mcexact.exact.roots import StabilityRegion
    from mcexact.model.controller import Controller
    from mcexact.model.parametric import ParametricSystem
    from mcexact.model.system import MultiChannelSystem
    from mcexact.report.html import EmbeddedPicture
    from mcexact.report.text import Table
    from mcexact.synthesis.robustness import WithinRadii


# Radii: every plant whose entries are within them.


def of(
    system: MultiChannelSystem,
    part: Fraction | None,
    effort: float | None = None,
    wanted: Property = "no fixed mode",
) -> tuple[MultiChannelSystem, LargestUncertainty | None]:
    """The system with the radii that are asked for, and the search for the largest ones.

    Parameters
    ----------
    system : MultiChannelSystem
    part : Fraction or None
        The radii, as a part of the moduli of the entries.
    effort : float or None
        The seconds for the search; None if it is not asked for.
    wanted : str
        The property that every plant is to have, in words.
    """
    from mcexact.model.box import Box

    if effort is not None:
        from mcexact.analysis.boxes.largest import largest_uncertainty

        found = largest_uncertainty(system, wanted, effort=effort)
        return _within(system, found), found
    return (system if part is None else Box.relative(system, part).system), None


def of_loop(
    system: MultiChannelSystem, controller: Controller, region: StabilityRegion, effort: float
) -> tuple[MultiChannelSystem, LargestUncertainty]:
    """The system with the largest radii within which every loop is in a region, and the search."""
    from mcexact.analysis.boxes.largest import largest_loop_uncertainty

    given: dict[str, Any] = {region.word: region.bound}
    found = largest_loop_uncertainty(system, controller, effort=effort, **given)
    return _within(system, found), found


def _within(system: MultiChannelSystem, found: LargestUncertainty) -> MultiChannelSystem:
    """The system with the radii that were found with a proof, if any were."""
    return system if found.proof is None else found.proof.about.plant


def leading(account: Account, found: LargestUncertainty | None) -> tuple[str, ...]:
    """The first lines of an answer, with the radii that were found or how to search them."""
    own = account.given.asked.get("information", "own") == "own"
    if found is None and own and {*account.open} & PROPERTIES.keys():
        *said, last = account.leading
        return (
            *said,
            "--largest-uncertainty searches radii with a proof, and a plant that fails",
            last,
        )
    if found is None or found.proof is None:
        return account.leading
    unit = "" if found.relative else " of the file"
    first = f"largest radii that were found with a proof: {found.proved_part}{unit}"
    return (first, *account.leading)


def lead(account: Account, found: LargestUncertainty | None) -> str:
    """The same as lines of text."""
    from mcexact.report.text import WIDTH, wrapped

    *said, last = leading(account, found) or ("",)
    lines = [line for each in said for line in wrapped(each, WIDTH)]
    return "\n".join([*lines, "", last, ""]) if last else ""


def view(found: LargestUncertainty | None) -> dict[str, Any]:
    """The search as a part of the JSON of an answer."""
    return {} if found is None else {"largest_uncertainty": found.to_dict()}


def pictures(found: LargestUncertainty | None) -> tuple[EmbeddedPicture, ...]:
    """The search as a picture for a page."""
    from mcexact.report.html import Picture

    if found is None:
        return ()
    return (Picture(found.plot(), "Largest uncertainty", f"{found.explain()}.").embedded(),)


def tables(found: LargestUncertainty | None) -> tuple[Table, ...]:
    """The search as a table."""
    from mcexact.report.text import Table

    if found is None:
        return ()
    rows = [(label, str(value)) for label, value in found.rows()]
    return (Table("largest uncertainty", (), tuple(rows)),)


@dataclass(frozen=True)
class Loops:
    """What is proved about all loops of a box.

    Attributes
    ----------
    rows : tuple of (str, str)
        Labels and texts.
    proof : BoxStability or None
    view : mapping
        Plain data.
    within_radii : str or None
        Whether all loops within the given radii are stable; None if none are given.
    failing : FailingPlant or None
        A plant nearby whose loop is not stable.
    """

    rows: tuple[tuple[str, str], ...] = ()
    proof: BoxStability | None = None
    view: Mapping[str, Any] = field(default_factory=dict)
    within_radii: WithinRadii | None = None
    failing: FailingPlant | None = None

    def tables(self) -> tuple[Table, ...]:
        """The table, if there is something to say."""
        from mcexact.report.text import Table

        title = "every loop in the box" if "every_loop" in self.view else "rounded gains"
        return (Table(title, (), self.rows),) if self.rows else ()

    def with_digits(self, other: Loops) -> Loops:
        """The same with rows and data about digits."""
        return replace(self, rows=self.rows + other.rows, view={**self.view, **other.view})


def loops(
    system: MultiChannelSystem,
    controller: Controller,
    found: StabilityVerdict,
    gains: Fraction | None,
    largest: LargestUncertainty | None = None,
) -> Loops:
    """Whether every loop within the radii of plant and gains is in the region of a verdict.

    Where it is not proved, mere stability is tried, and then a plant whose loop fails is searched.

    Parameters
    ----------
    system : MultiChannelSystem
    controller : Controller
    found : StabilityVerdict
        About the nominal loop.
    gains : Fraction or None
        The radii of the gains, as a part of their moduli.
    largest : LargestUncertainty or None
        The search that found the radii of the system.
    """
    from mcexact.exact.rational import percent, written
    from mcexact.model.box import radii_in_words
    from mcexact.model.loop import closed_loop
    from mcexact.synthesis.robustness import failing_plant, known_within

    near = None if largest is None or not found.stable else largest.nearby
    if system.uncertainty is None and gains is None:
        return Loops(failing=near)
    said = [] if system.uncertainty is None else [("plant", radii_in_words(system))]
    said += [] if gains is None else [("gains", f"within {percent(gains)}")]
    proof, failing, region = None, None, _of_boxes(found)
    unproved = [region]
    if found.stable:
        known = None if largest is None else largest.proof
        proof, region, unproved = _proof(system, controller, region, gains, known)
    if unproved:
        neither = "".join(f", and neither is {each}" for each in unproved[1:])
        said.append(("eigenvalues of every loop", f"{unproved[0]} is not proved{neither}"))
    view: dict[str, Any] = {"certified": proof is not None, "region": str(region)}
    if proof is None and found.stable and system.uncertainty is not None:
        failing = failing_plant(closed_loop(system, controller))
    if failing is not None:
        view |= {"fails_within": written(failing.distance), "failing": failing.plant.to_dict()}
    within: WithinRadii | None = known_within(proof, failing)
    if largest is not None and largest.proof is not None:
        within = _within_given(largest)
    return Loops(tuple(said), proof, {"every_loop": view}, within, failing or near)


def _within_given(largest: LargestUncertainty) -> WithinRadii | None:
    """Whether all loops are stable within the radii from which a search began with some proof."""
    from mcexact.answer.boxes import BoxStability

    if largest.relative:
        return None
    if largest.lower >= 1:
        return "proved"
    # A plant that misses a rate or radius may be stable.
    fails = isinstance(largest.proof, BoxStability) and largest.proof.bound is None
    return "refuted" if fails and largest.upper is not None and largest.upper <= 1 else "open"


def _proof(
    system: MultiChannelSystem,
    controller: Controller,
    asked: StabilityRegion,
    gains: Fraction | None,
    known: Answer | None,
) -> tuple[BoxStability | None, StabilityRegion, list[StabilityRegion]]:
    """A proof for the region that is asked for, or else for stability, and what is not proved.

    A proof in ``known`` is used and not made again.
    """
    from mcexact.analysis.boxes.loops import box_stability
    from mcexact.answer.boxes import BoxStability
    from mcexact.errors import LimitReached
    from mcexact.exact.roots import StabilityRegion

    unproved = list[StabilityRegion]()
    for region in dict.fromkeys((asked, StabilityRegion(asked.time))):
        if isinstance(known, BoxStability) and known.region == region:
            return known, region, unproved
        given: dict[str, Any] = {region.word: region.bound}
        with suppress(LimitReached):
            proof = box_stability(system, controller, gains=gains, **given)
            return proof, region, unproved
        unproved.append(region)
    return None, asked, unproved


def _of_boxes(found: StabilityVerdict) -> StabilityRegion:
    """The region of a verdict without its limits on damping and modulus: boxes have none."""
    return replace(found.region, damping=None, largest_modulus=None)


def digits_of(
    system: MultiChannelSystem, controller: Controller, found: StabilityVerdict, most: int
) -> Loops:
    """Rows about the digits of the gains: how many are safe, and how many are too few."""
    from mcexact.answer.templates import count
    from mcexact.synthesis.certify import safe_digits

    region = _of_boxes(found)
    given: dict[str, Any] = {region.word: region.bound}
    known = safe_digits(system, controller, most=most, **given)
    safe = "none proved" if known.safe is None else f"{count(known.safe, 'digit')}, however rounded"
    safe += "" if region == found.region else f", for {region} alone"
    few = (
        "none found"
        if known.unsafe is None
        else f"{count(known.unsafe, 'digit')}, rounded up or down so that the loop fails"
    )
    view = {"safe_digits": {"safe": known.safe, "too_few": known.unsafe}}
    rows = ("digits of the gains that are safe", safe), ("digits that are too few", few)
    return Loops(rows, None, view)


# Systems with parameters on the command line: values, and the answers for all values.

F = TypeVar("F", bound=Callable[..., Any])


def parameter_value(text: str) -> tuple[str, Fraction]:
    """Parse ``NAME=VALUE`` with an exact number.

    Examples
    --------
    >>> parameter_value("t=1/3")
    ('t', Fraction(1, 3))
    """
    name, equals, value = text.partition("=")
    if not (name.strip() and equals and value.strip()):
        raise click.BadParameter(f"expected NAME=VALUE, such as t=1/3, found '{text}'")
    return name.strip(), options.rational(value.strip())


def at_values(use: str, more: str) -> Callable[[F], F]:
    """Return the option for values of parameters, whose help says their use, and more."""
    return click.option(
        "--at",
        type=parameter_value,
        multiple=True,
        metavar="NAME=VALUE",
        help=f"Of a system with parameters: {use}, such as t=1/3.  {more}",
    )


def for_all_values(
    system: ParametricSystem,
    also: Sequence[str],
    channel: str | None,
    refused: bool,
    with_page: bool,
    with_latex: bool,
    system_by_digest: bool,
    *,
    known: Known,
    report: Reporting,
) -> dict[str, Any]:
    """Decide and format the answers for all values, in the child process.

    Parameters
    ----------
    system : ParametricSystem
    also : sequence of str
        Questions that are asked as well.
    channel : str or None
    refused : bool
        Whether something is asked that is only decided for systems without parameters.
    with_page, with_latex, system_by_digest : bool
    known : Known
    report : Reporting

    Raises
    ------
    UsageError
        If something else is asked.
    """
    from dataclasses import replace

    from mcexact.analysis.analyze import ParametricAnalysis
    from mcexact.errors import UsageError
    from mcexact.report.pages import parameter_latex, parameter_page, parameter_tables
    from mcexact.report.text import WIDTH, wrapped

    if refused or not ParametricAnalysis.questions.keys() >= {*also}:
        raise UsageError(
            "these questions are about systems without parameters: give values to "
            f"{', '.join(system.parameters)} by --at NAME=VALUE"
        )
    found = ParametricAnalysis(system, channel=channel)
    found.also(also)
    known.resume(found, report)
    account, taken = found.account, effort_tables(found.effort())
    page = parameter_page(account) if with_page else None
    if page is not None:
        page = replace(page, tables=(*page.tables, *taken))
    words = [line for said in account.at("answer") for line in wrapped(said, WIDTH)]
    return {
        "certificates": account.certificates,
        "files": account.files(system_by_digest=system_by_digest),
        "plant": account.about,
        "json": found.to_dict(),
        "words": "\n".join(words) + "\n",
        "tables": (*parameter_tables(account), *taken),
        "latex": parameter_latex(account) if with_latex else "",
        "page": page,
        "ended": found.ended(),
    }


# `mcexact certify` for a loop at all values of parameters within their ranges.

_EFFORT = 5.0
_ASKED = ("rate", "radius")
"""The options that say what is proved, besides --gains."""


def certified(
    system: ParametricSystem,
    controller: Controller,
    gains: Fraction | None,
    wanted: Mapping[str, Any],
    with_page: bool,
    system_by_digest: bool,
) -> dict[str, Any]:
    """Prove a loop for all values, or search the largest part of the ranges and values that fail.

    Parameters
    ----------
    system : ParametricSystem
    controller : Controller
    gains : Fraction or None
        The radii of the gains, as a part of their moduli.
    wanted : mapping
        The other options by name.
    with_page, system_by_digest : bool

    Raises
    ------
    UsageError
        If something is asked that is only decided for systems without parameters.
    """
    from mcexact.analysis.boxes.largest import largest_loop_ranges
    from mcexact.errors import UsageError
    from mcexact.exact.roots import StabilityRegion

    if any(value for name, value in wanted.items() if name not in _ASKED):
        raise UsageError(
            "with parameters only --rate, --radius and --gains are decided: give values to "
            f"{', '.join(system.parameters)} by --at NAME=VALUE"
        )
    asked = {name: wanted[name] for name in _ASKED}
    region = StabilityRegion.of(system.time, **asked)
    found = largest_loop_ranges(system, controller, gains=gains, effort=_EFFORT, **asked)
    account = _account(system, found, gains)
    ranges = ", ".join(system.parameters_in_words)
    proved = found.lower == 1
    if proved:
        said = f"{region} for every {ranges}: proved."
    elif found.failing is not None:
        said = f"{region} does not hold for every {ranges}."
    else:
        said = f"{region} for every {ranges}: open, as no proof and no value that fails was found."
    return _evidence(account, found, proved, system_by_digest) | {
        "said": [said],
        "tables": _tables(account, found, proved),
        "page": _page(account, said, found, proved) if with_page else None,
        "json": account.as_json(
            certified=proved,
            refuted=found.failing is not None,
            region=str(region),
            bound=None if region.bound is None else str(region.bound),
            parameters=system.document()["parameters"],
            largest_ranges=found.to_dict(),
            warnings=[],
        ),
    }


def _account(system: ParametricSystem, found: LargestRanges, gains: Fraction | None) -> Account:
    """The proof for the whole ranges with its sentence, if there is one."""
    from mcexact.answer.account import Account
    from mcexact.answer.loops import EVERY_LOOP_RULES
    from mcexact.answer.sentence import Given

    ranges = ", ".join(system.parameters_in_words)
    given = Given(system, {"parameters": ranges, "part_of_gains": gains})
    whole = found.proof is not None and found.lower == 1
    answers: dict[str, Any] = {"box_stability": found.proof} if whole else {}
    return Account(answers, given, EVERY_LOOP_RULES.sentences(answers, given))


def _evidence(
    account: Account, found: LargestRanges, proved: bool, system_by_digest: bool
) -> dict[str, Any]:
    """The certificates: of the whole ranges, or of a part of them and of values that fail."""
    from mcexact.answer import protocol
    from mcexact.cli.running import told

    if proved:
        return told(account, system_by_digest)
    parts = {
        "box_stability_in_part.json": found.proof,
        "stability_at_values.json": found.refutation,
    }
    known = {name: answer for name, answer in parts.items() if answer is not None}
    texts = {name: protocol.encode(answer) for name, answer in known.items()}
    plants = {name: answer.about.plant.canonical_text() for name, answer in known.items()}
    return {"certificates": texts, "files": texts, "plant": plants}


def _tables(account: Account, found: LargestRanges, proved: bool) -> tuple[Any, ...]:
    """The sentence, or how far the ranges can be."""
    from mcexact.report.text import Table

    rows = [each.cells for each in account.sentences] if proved else list(found.rows())
    return (Table("closed loop" if proved else "largest part of the ranges", (), tuple(rows)),)


def _page(account: Account, said: str, found: LargestRanges, proved: bool) -> Any:
    """The page of the answer."""
    from mcexact.report.html import AnswerPage, shown_plant

    system = account.given.system
    return AnswerPage(
        title=system.name or "A closed loop",
        heading="A controller and its closed loops, for all values of the plant's parameters.",
        good=proved,
        answer=(said,),
        pictures=(),
        tables=_tables(account, found, proved),
        plant=shown_plant(system),
    )


_LONG = 10.0
"""The seconds from which on a question is listed with its time."""


def effort_tables(taken: Sequence[Effort]) -> tuple[Table, ...]:
    """A table of the questions that took long, or were not decided, if there are any."""
    from mcexact.report.text import Table

    rows = [
        (
            each.question.replace("_", " "),
            "–" if each.outcome == "left out" else f"{each.seconds:.1f}",
            f"{each.outcome}: {each.reason}" if each.reason else each.outcome,
        )
        for each in taken
        if each.seconds >= _LONG or each.outcome != "decided"
    ]
    left_out = any(each.outcome == "left out" for each in taken)
    note = "Decide a question that is left out by --also and its name." if left_out else ""
    columns = ("question", "seconds", "outcome")
    title = "questions that are open or took long"
    return (Table(title, columns, tuple(rows), note),) if rows else ()
