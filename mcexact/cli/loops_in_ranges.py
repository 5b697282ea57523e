"""What `mcexact certify` says about a loop at all values of parameters within their ranges."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mcexact.analysis.boxes.largest import LargestRanges
    from mcexact.answer.account import Account
    from mcexact.model.controller import Controller
    from mcexact.model.parametric import ParametricSystem

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
