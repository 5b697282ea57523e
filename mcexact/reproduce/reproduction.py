"""`reproduce` examines every statement of the paper, section by section."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass

from mcexact.errors import UsageError
from mcexact.reproduce import decentralized, delays, extended, observer, problem, setpoint
from mcexact.reproduce.ledger import Statement, statements
from mcexact.reproduce.notebook import Notebook, Procedure, examined

SECTIONS: tuple[tuple[str, dict[str, Procedure]], ...] = (
    ("I, the problem", problem.PROCEDURES),
    ("II, the distributed observer", observer.PROCEDURES),
    ("III, set-points", setpoint.PROCEDURES),
    ("IV-A and IV-B, decentralized control", decentralized.PROCEDURES),
    ("IV-C to IV-E, extended systems", extended.PROCEDURES),
    ("V, delays", delays.PROCEDURES),
)


@dataclass(frozen=True)
class Row:
    """A statement with its finding."""

    statement: Statement
    finding: Notebook

    @property
    def status(self) -> str:
        """What is known, in words."""
        if not self.finding.holds:
            return "does not hold"
        return self.statement.status(len(self.finding.instances))


@dataclass(frozen=True)
class Reproduction:
    """The findings on statements of the paper, in the order of the ledger.

    Attributes
    ----------
    rows : tuple of Row
    """

    rows: tuple[Row, ...]

    @property
    def holds(self) -> bool:
        """Whether every statement holds."""
        return all(row.finding.holds for row in self.rows)

    @property
    def failures(self) -> tuple[Row, ...]:
        """The rows of statements that do not hold."""
        return tuple(row for row in self.rows if not row.finding.holds)

    def certificates(self) -> dict[str, str]:
        """The texts of all certificates, keyed by file names."""
        return {made.name: made.text for row in self.rows for made in row.finding.certificates}


def procedures() -> dict[str, Procedure]:
    """The procedures that examine statements, keyed by statement."""
    return {key: made for _, section in SECTIONS for key, made in section.items()}


def chosen(wanted: Iterable[str]) -> tuple[str, ...]:
    """Return the keys for some keys or titles of the ledger; all keys if none is given.

    Raises
    ------
    UsageError
        If the ledger has no such statement.

    Examples
    --------
    >>> chosen(["Theorem 2"])
    ('thm:strg-graph',)
    """
    by_name = {each.title.lower(): each.key for each in statements()}
    by_name |= {each.key.lower(): each.key for each in statements()}
    keys = []
    for name in wanted:
        if name.lower() not in by_name:
            near = difflib.get_close_matches(name.lower(), by_name, n=1)
            hint = f"; did you mean {near[0]!r}?" if near else ""
            raise UsageError(f"the ledger has no statement {name!r}{hint}")
        keys.append(by_name[name.lower()])
    return tuple(keys) or tuple(each.key for each in statements())


def examine(section: int, keys: tuple[str, ...]) -> tuple[Notebook, ...]:
    """Examine the statements of one section whose keys are given."""
    return tuple(examined(key, made) for key, made in SECTIONS[section][1].items() if key in keys)


def assembled(findings: Iterable[Notebook]) -> Reproduction:
    """Join findings with their statements, in the order of the ledger."""
    by_key = {finding.key: finding for finding in findings}
    return Reproduction(
        tuple(Row(each, by_key[each.key]) for each in statements() if each.key in by_key)
    )


def reproduce(keys: Iterable[str] = ()) -> Reproduction:
    """Examine statements of the paper in this process.

    Parameters
    ----------
    keys : iterable of str
        Keys or titles of the ledger; all statements if none is named.

    Examples
    --------
    >>> reproduce(["every-subset"]).holds
    True
    """
    wanted = chosen(keys)
    return assembled(finding for k in range(len(SECTIONS)) for finding in examine(k, wanted))
