"""The ledger lists every statement of the paper with its code and its machine-checked proofs."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

KINDS = ("definition", "claim", "example", "numbered")


@dataclass(frozen=True)
class Statement:
    """One statement of the paper.

    Attributes
    ----------
    key : str
        Its label in the paper's LaTeX source, or a chosen word if it has none.
    title, section : str
    kind : {"definition", "claim", "example", "numbered"}
        An equation that defines something, a claim in the text, the example of IV-B, or a numbered
        theorem, proposition, lemma, corollary or remark.
    says : str
        A short version of the statement.
    code : tuple of str
        The functions of this package that construct or decide it.
    certificates : tuple of str
        The kinds of certificates that are written for it.
    proofs : tuple of str
        Machine-checked theorems, as file.theorem in ``proofs/``.
    covers : {"all", "part", ""}
        Whether these theorems prove the statement, a part of it, or nothing.
    part : str
        The part that is proved.
    erratum : str
        The correction of the statement, or an empty text.
    """

    key: str
    title: str
    section: str
    kind: str
    says: str
    code: tuple[str, ...]
    certificates: tuple[str, ...] = ()
    proofs: tuple[str, ...] = ()
    covers: str = ""
    part: str = ""
    erratum: str = ""

    @property
    def proved(self) -> bool:
        """Whether a machine-checked theorem covers the whole statement."""
        return self.covers == "all" and bool(self.proofs)

    def status(self, instances: int) -> str:
        """Return in words what is proved in general and what was checked on instances.

        Examples
        --------
        >>> statement("thm:strg-graph").status(7)
        'proved in general, checked on 7 instances'
        >>> from dataclasses import replace
        >>> replace(statement("thm:strg-graph"), proofs=()).status(1)
        'checked on 1 instance'
        """
        checked = f"checked on {instances} instance" + ("" if instances == 1 else "s")
        if self.kind == "example":
            return "computed exactly on the paper's data"
        if self.proved:
            return f"proved in general, {checked}"
        if self.proofs:
            return f"{checked}; proved in general: {self.part}"
        return checked


@cache
def statements() -> tuple[Statement, ...]:
    """The ledger, in the order of the paper.

    Examples
    --------
    >>> [each.title for each in statements() if each.kind == "numbered"][:3]
    ['Proposition 1', 'Theorem 1', 'Remark 1']
    """
    text = resources.files("mcexact.reproduce").joinpath("ledger.toml").read_text("utf-8")
    return tuple(_read(row) for row in tomllib.loads(text)["statement"])


def _read(row: dict[str, Any]) -> Statement:
    """Read one entry of the file."""
    fields: dict[str, Any] = {
        name: tuple(value) if isinstance(value, list) else value for name, value in row.items()
    }
    return Statement(**fields)


def statement(key: str) -> Statement:
    """Return the statement with a key.

    Raises
    ------
    KeyError
        If there is none.
    """
    return {each.key: each for each in statements()}[key]


def table() -> str:
    """The ledger as the table of ``proofs/README.md``."""
    lines = [
        "| statement | section | in the code | certificates | formal proof, or instances |",
        "|---|---|---|---|---|",
    ]
    for each in statements():
        code = ", ".join(f"`{name.removeprefix('mcexact.')}`" for name in each.code)
        kinds = ", ".join(f"`{kind}`" for kind in each.certificates) or "named checks"
        if each.proofs:
            proofs = ", ".join(f"`{name}`" for name in each.proofs)
            proof = proofs if each.proved else f"{proofs} ({each.part}); instances"
        else:
            proof = "instances"
        title = f"{each.title} (corrected)" if each.erratum else each.title
        lines.append(f"| {title} | {each.section} | {code} | {kinds} | {proof} |")
    return "\n".join(lines) + "\n"
