"""What became of the tries, by kind, by construction and by mutator."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

OUTCOMES = ("tries", "true", "false", "undecided", "errors", "time-outs", "rejected")
LEAST_TRIES, LEAST_TRUE, MOST_UNDECIDED = 5000, 200, 0.01


@dataclass
class Report:
    """Counts under (table, row, outcome), and what is to be looked at."""

    counts: Counter[tuple[str, str, str]] = field(default_factory=Counter)
    findings: list[dict[str, Any]] = field(default_factory=list)
    statements: dict[str, str] = field(default_factory=dict)
    meanings: dict[str, str] = field(default_factory=dict)
    seconds: float = 0.0

    def count(self, rows: list[tuple[str, str]], outcome: str) -> None:
        """One try with its outcome, under every row that it belongs to."""
        for table, row in rows:
            self.counts[table, row, "tries"] += 1
            self.counts[table, row, outcome] += 1

    def add(self, other: Report) -> None:
        """The tries of another process."""
        self.counts.update(other.counts)
        self.findings += other.findings
        for digest, said in other.statements.items():
            if self.statements.setdefault(digest, said) != said:
                self.findings.append({"what": "one statement for two meanings", "digest": digest})
        for said, digest in other.meanings.items():
            if self.meanings.setdefault(said, digest) != digest:
                self.findings.append({"what": "two statements for one meaning", "digest": digest})
        self.seconds += other.seconds

    def total(self, outcome: str) -> int:
        """So many tries of all kinds had an outcome."""
        return self.counts["all", "all", outcome]

    def shortfalls(self) -> list[str]:
        """Kinds and constructions that were not tried enough."""
        found = []
        for table, row in sorted(
            {key[:2] for key in self.counts if key[0] in ("kind", "construction")}
        ):
            tries, true, open_ = (
                self.counts[table, row, k] for k in ("tries", "true", "undecided")
            )
            if tries < LEAST_TRIES or true < LEAST_TRUE or open_ > MOST_UNDECIDED * tries:
                found.append(f"{table} {row}: {tries} tries, {true} true, {open_} undecided")
        return found

    def lines(self) -> list[str]:
        """The tables as text."""
        made = []
        for table in ("all", "kind", "construction", "mutator", "verdict"):
            rows = sorted({key[1] for key in self.counts if key[0] == table})
            made += ["", f"{table:28}" + "".join(f"{outcome:>11}" for outcome in OUTCOMES)]
            for row in rows:
                made.append(
                    f"{row:28}" + "".join(f"{self.counts[table, row, k]:>11}" for k in OUTCOMES)
                )
        made += ["", f"{len(self.statements)} different statements, {self.seconds:.0f} s of work"]
        return made
