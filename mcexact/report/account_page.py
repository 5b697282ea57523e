"""The page that `mcexact analyze --html` writes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from mcexact.answer.account import Account
from mcexact.report.account import answer, tables
from mcexact.report.graph_figures import LEAST, dimensions_picture, graph_pictures
from mcexact.report.page import page
from mcexact.report.picture import EmbeddedPicture, Picture
from mcexact.report.plant import shown_plant
from mcexact.report.text import Table


@dataclass(frozen=True)
class AccountPage:
    """The contents of a report, except for the verdicts on certificates.

    Attributes
    ----------
    title, heading : str
    good : bool
        Whether control with the given information can stabilize the plant.
    answer : tuple of str
    pictures : tuple of EmbeddedPicture
    tables : tuple of Table
    plant : mapping
        The matrices and the source of the system, as `shown_plant` returns them.
    """

    title: str
    heading: str
    good: bool
    answer: tuple[str, ...]
    pictures: tuple[EmbeddedPicture, ...]
    tables: tuple[Table, ...]
    plant: Mapping[str, Any]

    def rendered(
        self, certificates: Mapping[str, str], verdicts: Mapping[str, Any], latex: str | None = None
    ) -> str:
        """Return the whole page.

        Parameters
        ----------
        certificates : mapping from names of files to texts
        verdicts : mapping from names of files to Verdict
            The checker's verdicts; a certificate without verdict is marked as not re-checked.
        latex : str, optional
            The results as LaTeX.
        """
        evidence = []
        for name, text in certificates.items():
            said = verdicts.get(name)
            evidence.append(
                {
                    "title": name,
                    "verdict": said.verdict if said is not None else "not re-checked",
                    "theorem": said.line() if said is not None else "",
                    "text": text,
                }
            )
        if latex is not None:
            evidence.append({"title": "LaTeX", "verdict": "", "theorem": "", "text": latex})
        return page("account", **vars(self), evidence=evidence)


def account_page(account: Account) -> AccountPage:
    """Return the contents of the report on a system."""
    system, said = account.given.system, account.sentences
    first, *rest = tables(said)
    spectrum = account.answers.get("fixed_spectrum")
    return AccountPage(
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
