"""The one page in which commands show answers: words, pictures, tables, the system, evidence."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from mcexact.report.page import page
from mcexact.report.picture import EmbeddedPicture
from mcexact.report.text import Table


@dataclass(frozen=True)
class AnswerPage:
    """The contents of a page, except for the verdicts on certificates.

    Attributes
    ----------
    title, heading : str
    good : bool or None
        Whether the answer is what a user hopes for; None if it is neither good nor bad.
    answer : tuple of str
        Sentences; those that start with ``"warning: "`` are shown as warnings.
    pictures : tuple of EmbeddedPicture
    tables : tuple of Table
    plant : mapping, optional
        The matrices and the source of the system, as `shown_plant` returns them.
    """

    title: str
    heading: str
    good: bool | None
    answer: tuple[str, ...]
    pictures: tuple[EmbeddedPicture, ...]
    tables: tuple[Table, ...]
    plant: Mapping[str, Any] | None = None

    def rendered(
        self,
        certificates: Mapping[str, str] | None = None,
        verdicts: Mapping[str, Any] | None = None,
        latex: str | None = None,
    ) -> str:
        """Return the whole page.

        Parameters
        ----------
        certificates : mapping from names of files to texts, optional
        verdicts : mapping from names of files to Verdict, optional
            The checker's verdicts; a certificate without verdict is marked as not re-checked.
        latex : str, optional
            The results as LaTeX.
        """
        evidence = []
        for name, text in (certificates or {}).items():
            said = (verdicts or {}).get(name)
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
        return page("answer", **vars(self), evidence=evidence)
