"""All statements of the paper, each with what is known of it."""

from __future__ import annotations

import tomllib
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from importlib import resources

STATUSES = {
    "printed": "proved as printed",
    "corrected": "proved as corrected",
    "added": "proved under added hypotheses",
    "defined": "defined",
    "shown": "shown by an instance",
    "instances": "seen on instances",
    "weaker": "weaker than printed",
    "refuted": "refuted by an instance",
    "informal": "informal",
    "absent": "absent",
}
"""What can be known of a statement: the word in ``statements.toml``, and what the report says."""

PROVED = ("printed", "corrected", "added")
EXPLAINED = ("corrected", "added", "weaker", "refuted", "informal", "absent")
"""The statuses that need a note: what was wrong, added or missing, or why."""
OPEN = ("instances", "weaker", "absent")
"""The statuses of what is not proved, and not settled otherwise."""


@dataclass(frozen=True)
class Statement:
    """One statement of the paper.

    Attributes
    ----------
    number : int
        Its place in the paper, from 1.
    section : str
    says : str
        The statement in our words.
    status : str
        A key of `STATUSES`.
    equation : str
        The number printed beside it, or an empty text.
    examined : tuple of str
        The keys of the examinations with its instances.
    proofs : tuple of str
        Machine-checked theorems, as file.theorem in ``proofs/``.
    note : str
        What was corrected, added or is missing, or why it is absent.
    closes : str
        What would prove it in general, if it is open.
    """

    number: int
    section: str
    says: str
    status: str
    equation: str = ""
    examined: tuple[str, ...] = ()
    proofs: tuple[str, ...] = ()
    note: str = ""
    closes: str = ""


@cache
def statements() -> tuple[Statement, ...]:
    """All statements, in the order of the paper.

    Examples
    --------
    >>> len(statements())
    134
    >>> statements()[88].equation
    'Theorem 2, (26)'
    """
    text = resources.files("mcexact.reproduce").joinpath("statements.toml").read_text("utf-8")
    return tuple(
        Statement(
            number,
            row["section"],
            row["says"],
            row["status"],
            row.get("equation", ""),
            tuple(row.get("examined", ())),
            tuple(row.get("proofs", ())),
            row.get("note", ""),
            row.get("closes", ""),
        )
        for number, row in enumerate(tomllib.loads(text)["statement"], 1)
    )


def counted(chosen: Iterable[Statement]) -> dict[str, int]:
    """How many statements have each status; every status is named.

    Examples
    --------
    >>> sum(counted(statements()).values())
    134
    """
    found = Counter(each.status for each in chosen)
    return {status: found[status] for status in STATUSES}


def statement_table() -> str:
    """The statements as ``proofs/STATEMENTS.md`` lists them."""
    lines = ["| status | statements |", "|---|---|"]
    lines += [f"| {STATUSES[key]} | {size} |" for key, size in counted(statements()).items()]
    lines += [
        f"| all | {len(statements())} |",
        "",
        "| | section | equation | statement | status | examined by | theorems | note |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for each in statements():
        keys = ", ".join(f"`{key}`" for key in each.examined)
        proofs = ", ".join(f"`{name}`" for name in each.proofs)
        cells = (str(each.number), each.section, each.equation, each.says, STATUSES[each.status])
        lines.append(f"| {' | '.join((*cells, keys, proofs, each.note))} |")
    return "\n".join(lines) + "\n"


def open_table() -> str:
    """The statements that are not proved as ``proofs/OPEN.md`` lists them."""
    lines = [
        "| | section | statement | what is known | machine-checked so far | what would close it |",
        "|---|---|---|---|---|---|",
    ]
    for each in statements():
        if each.status in OPEN:
            where = f"{each.section} {each.equation}".strip()
            known = f"{STATUSES[each.status]}. {each.note}".strip().removesuffix(".")
            proofs = ", ".join(f"`{name}`" for name in each.proofs) or "nothing"
            cells = (str(each.number), where, each.says, f"{known}.", proofs, each.closes)
            lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"
