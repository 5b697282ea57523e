"""`reproduce` carries out the examinations of the paper, section by section."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from dataclasses import dataclass

from mcexact.errors import UsageError
from mcexact.reproduce import (
    almost_any,
    bounds,
    cancellation,
    decentralized,
    delays,
    example,
    extended,
    freedom,
    holding,
    lemmas,
    observer,
    problem,
    restated,
    setpoint,
    tracking,
)
from mcexact.reproduce.ledger import Examination, examinations
from mcexact.reproduce.notebook import Notebook, Procedure, examined
from mcexact.reproduce.statements import Statement, statements

SECTIONS: tuple[tuple[str, dict[str, Procedure]], ...] = (
    ("I, the problem", problem.PROCEDURES),
    ("II-A, certainty equivalence", cancellation.PROCEDURES),
    ("II-B and II-C, the distributed observer", observer.PROCEDURES),
    ("II-D, its analysis", lemmas.PROCEDURES),
    ("II-B, II-D and IV-E, almost all gains", almost_any.PROCEDURES),
    ("III, set-points", {**setpoint.PROCEDURES, **tracking.PROCEDURES}),
    ("IV-A, decentralized control", decentralized.PROCEDURES),
    ("IV-B, sharing outputs", example.PROCEDURES),
    ("IV-C, extended systems", {**extended.PROCEDURES, **restated.PROCEDURES}),
    ("IV-D, shared dimensions", bounds.PROCEDURES),
    ("IV-E and VI, free assignment", freedom.PROCEDURES),
    ("V-A, delays", delays.PROCEDURES),
    ("V-B, holding", holding.PROCEDURES),
)


@dataclass(frozen=True)
class Row:
    """An examination with its finding."""

    examination: Examination
    finding: Notebook

    @property
    def status(self) -> str:
        """What is known, in words."""
        if not self.finding.holds:
            return "fails"
        return self.examination.status(len(self.finding.instances))


@dataclass(frozen=True)
class Reproduction:
    """The findings of examinations, in the order of the ledger.

    Attributes
    ----------
    rows : tuple of Row
    """

    rows: tuple[Row, ...]

    @property
    def holds(self) -> bool:
        """Whether no examination fails."""
        return all(row.finding.holds for row in self.rows)

    @property
    def failures(self) -> tuple[Row, ...]:
        """The rows of examinations that fail."""
        return tuple(row for row in self.rows if not row.finding.holds)

    @property
    def is_whole(self) -> bool:
        """Whether these are all examinations of the ledger."""
        return len(self.rows) == len(examinations())

    @property
    def statements(self) -> tuple[Statement, ...]:
        """The statements of the paper that these examinations are about: all, if these are all."""
        keys = {row.examination.key for row in self.rows}
        return tuple(
            each for each in statements() if self.is_whole or keys.intersection(each.examined)
        )

    def fails(self, statement: Statement) -> bool:
        """Whether an examination of the statement fails."""
        return any(row.examination.key in statement.examined for row in self.failures)

    def certificates(self) -> dict[str, str]:
        """The texts of all certificates, keyed by file names."""
        return {made.name: made.text for row in self.rows for made in row.finding.certificates}


def procedures() -> dict[str, Procedure]:
    """The procedures of all examinations, by their keys."""
    return {key: made for _, section in SECTIONS for key, made in section.items()}


def chosen(wanted: Iterable[str]) -> tuple[str, ...]:
    """Return the keys of the examinations with some names; all keys if none is given.

    A name is a key or title of the ledger, a printed number of an equation, a label of the paper's
    LaTeX source, ``statement 89`` for a number of the list of statements, or ``section II-D``.

    Raises
    ------
    UsageError
        If there is nothing of this name, or if nothing examines it.

    Examples
    --------
    >>> chosen(["Theorem 2", "(26)", "26", "eqn:n_i", "statement 89", "Equation (21)"])
    ('theorem-2', 'equation-21')
    """
    by_name: dict[str, tuple[str, ...]] = {
        name.lower(): (each.key,) for each in examinations() for name in each.names
    }
    for each in statements():
        by_name[f"statement {each.number}"] = each.examined
        for section in {each.section, each.section.partition("-")[0]}:
            name = f"section {section}".lower()
            by_name[name] = (*by_name.get(name, ()), *each.examined)
    keys: list[str] = []
    for name in wanted:
        number = re.fullmatch(r"(?:(?:equation|eq\.) )?\(?(\d+)\)?", name.lower())
        asked = f"({number[1]})" if number else name.lower()
        if asked not in by_name:
            near = difflib.get_close_matches(asked, by_name, n=1)
            hint = f"; did you mean {near[0]!r}?" if near else ""
            raise UsageError(f"the paper has no statement {name!r}{hint}")
        if not by_name[asked]:
            why = statements()[int(asked.removeprefix("statement ")) - 1].note
            raise UsageError(f"nothing examines {asked}: {why}")
        keys += by_name[asked]
    return tuple(dict.fromkeys(keys)) or tuple(each.key for each in examinations())


def examine(section: int, keys: tuple[str, ...]) -> tuple[Notebook, ...]:
    """Carry out the examinations of one section whose keys are given."""
    return tuple(examined(key, made) for key, made in SECTIONS[section][1].items() if key in keys)


def assembled(findings: Iterable[Notebook]) -> Reproduction:
    """Join findings with their examinations, in the order of the ledger."""
    by_key = {finding.key: finding for finding in findings}
    return Reproduction(
        tuple(Row(each, by_key[each.key]) for each in examinations() if each.key in by_key)
    )


def reproduce(keys: Iterable[str] = ()) -> Reproduction:
    """Examine statements of the paper in this process.

    Parameters
    ----------
    keys : iterable of str
        Names as for `chosen`; all examinations if none is named.

    Examples
    --------
    >>> reproduce(["every-subset"]).holds
    True
    """
    wanted = chosen(keys)
    return assembled(finding for k in range(len(SECTIONS)) for finding in examine(k, wanted))
