"""The pages that `mcexact analyze --html` and `mcexact allocate --html` write."""

from __future__ import annotations

from dataclasses import replace

from mcexact.answer.account import Account
from mcexact.report.account import answer, tables
from mcexact.report.answer_page import AnswerPage
from mcexact.report.dimension_figures import (
    LEAST,
    allocation_picture,
    dimensions_picture,
)
from mcexact.report.graph_figures import graph_pictures, links_picture
from mcexact.report.picture import Picture
from mcexact.report.plant import shown_plant

_SHARED = (
    "The least that the agents must share, with a proof that less does not suffice.",
    "The least dimensions",
)
_LINKS = (
    "The cheapest links to add, with a proof that cheaper ones do not suffice.",
    "The links to add",
)


def account_page(account: Account) -> AnswerPage:
    """Return the page of an analysis."""
    system, said = account.given.system, account.sentences
    first, *rest = tables(said)
    spectrum = account.answers.get("fixed_spectrum")
    return AnswerPage(
        title=system.name or "A multi-channel system",
        heading="".join(said.at("page")),
        good=spectrum is None or spectrum.stabilizable,
        answer=tuple(answer(said)),
        pictures=tuple(drawn.embedded() for drawn in _pictures(account)),
        tables=(replace(first, title="All answers"), *rest),
        plant=shown_plant(system),
    )


def _pictures(account: Account) -> list[Picture]:
    """Return pictures of the graphs, and of shared dimensions if these were asked about."""
    drawn = []
    if {"fixed_spectrum", "transfer_graph"} <= account.answers.keys():
        drawn += graph_pictures(account)
    if set(LEAST.values()) & account.answers.keys():
        drawn.append(dimensions_picture(account))
    return drawn


def allocation_page(account: Account) -> AnswerPage:
    """Return the page of the least dimensions, or of the links to add.

    Parameters
    ----------
    account : Account
        As `account_of_dimensions` or `account_of_links` returns it.
    """
    system, said = account.given.system, account.sentences
    linked = account.answers.get("minimal_communication")
    least = account.answers["minimal_shared_dimensions"] if linked is None else linked
    heading, title = _SHARED if linked is None else _LINKS
    drawn = []
    if least.feasible:
        drawn.append((allocation_picture if linked is None else links_picture)(account))
    first, *rest = tables(said)
    found = [replace(first, title=title)] if first.rows else []
    words = said.at("title", *([] if first.rows else ["table.note"]))
    return AnswerPage(
        title=system.name or "A multi-channel system",
        heading=heading,
        good=least.feasible,
        answer=tuple(words),
        pictures=tuple(each.embedded() for each in drawn),
        tables=(*found, *rest),
        plant=shown_plant(system),
    )
