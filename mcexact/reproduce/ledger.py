"""The ledger lists the examinations of the paper, with their code and machine-checked proofs."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from typing import Any

KINDS = ("definition", "claim", "example", "numbered")
COVERS = {
    "printed": "as printed",
    "corrected": "as corrected",
    "added": "under added hypotheses",
    "part": "in part",
}
"""How far theorems cover an examination: the word in ``ledger.toml``, and what the report says."""


@dataclass(frozen=True)
class Examination:
    """One examination, of one or several statements of the paper.

    Attributes
    ----------
    key : str
        Its printed name or number in small letters, or a chosen word if it has none.
    title, section : str
    kind : {"definition", "claim", "example", "numbered"}
        An equation that defines something, a claim in the text, the example of IV-B, or a numbered
        theorem, proposition, lemma, corollary or remark.
    says : str
        A short version of what is examined.
    code : tuple of str
        The functions of this package that construct or decide it.
    equations : tuple of int
        The numbers of the paper's equations that it is about, as printed.
    labels : tuple of str
        Labels of the paper's LaTeX source, by which it can be named as well.
    certificates : tuple of str
        The kinds of certificates that are written for it.
    proofs : tuple of str
        Machine-checked theorems, as file.theorem in ``proofs/``.
    covers : {"printed", "corrected", "added", "part", ""}
        Whether these theorems prove it as printed, as corrected, under added hypotheses, a part of
        it, or nothing.
    part : str
        The part that is proved, or the added hypotheses.
    erratum : str
        The correction, or an empty text.
    nearest_false : mapping of str to str
        The nearest false statements by short names; an instance of the examination refutes each.
    """

    key: str
    title: str
    section: str
    kind: str
    says: str
    code: tuple[str, ...]
    equations: tuple[int, ...] = ()
    labels: tuple[str, ...] = ()
    certificates: tuple[str, ...] = ()
    proofs: tuple[str, ...] = ()
    covers: str = ""
    part: str = ""
    erratum: str = ""
    nearest_false: Mapping[str, str] = field(default_factory=dict)

    @property
    def names(self) -> tuple[str, ...]:
        """All names by which it can be asked for."""
        numbers = [f"({number})" for number in self.equations]
        return (self.key, self.title, *self.labels, *numbers)

    def status(self, instances: int) -> str:
        """Return in words what is proved in general and what was checked on instances.

        Examples
        --------
        >>> examination("theorem-2").status(7)
        'proved in general as printed, checked on 7 instances'
        >>> from dataclasses import replace
        >>> replace(examination("theorem-2"), proofs=(), covers="").status(1)
        'checked on 1 instance'
        >>> examination("lemma-1").status(2)
        'proved in general under added hypotheses (if the neighbor graph is strongly connected), \
checked on 2 instances'
        """
        checked = f"checked on {instances} instance" + ("" if instances == 1 else "s")
        if self.kind == "example":
            return "computed exactly on the paper's data"
        if self.covers == "part":
            return f"{checked}; proved in general: {self.part}"
        if self.covers:
            under = f" ({self.part})" if self.part else ""
            return f"proved in general {COVERS[self.covers]}{under}, {checked}"
        return checked


@cache
def examinations() -> tuple[Examination, ...]:
    """The ledger, in the order of the paper.

    Examples
    --------
    >>> [each.title for each in examinations() if each.kind == "numbered"][:3]
    ['Proposition 1', 'Theorem 1', 'Remark 1']
    """
    text = resources.files("mcexact.reproduce").joinpath("ledger.toml").read_text("utf-8")
    return tuple(_read(row) for row in tomllib.loads(text)["examination"])


def _read(row: dict[str, Any]) -> Examination:
    """Read one entry of the file."""
    fields: dict[str, Any] = {
        name: tuple(value) if isinstance(value, list) else value for name, value in row.items()
    }
    return Examination(**fields)


def examination(key: str) -> Examination:
    """Return the examination with a key.

    Raises
    ------
    KeyError
        If there is none.
    """
    return {each.key: each for each in examinations()}[key]


def table() -> str:
    """The ledger as the table of ``proofs/README.md``."""
    lines = [
        "| examined | section | in the code | certificates | formal proof, or instances |",
        "|---|---|---|---|---|",
    ]
    for each in examinations():
        code = ", ".join(f"`{name.removeprefix('mcexact.')}`" for name in each.code)
        kinds = ", ".join(f"`{kind}`" for kind in each.certificates) or "named checks"
        proof = "instances"
        if each.proofs:
            extent = COVERS[each.covers] + (f": {each.part}" if each.part else "")
            proof = ", ".join(f"`{name}`" for name in each.proofs) + f" ({extent})"
        title = f"{each.title} (corrected)" if each.erratum else each.title
        lines.append(f"| {title} | {each.section} | {code} | {kinds} | {proof} |")
    return "\n".join(lines) + "\n"
