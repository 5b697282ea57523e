"""All statements of the paper are there, and none claims more than stands behind it."""

from __future__ import annotations

import re
from collections import Counter

import pytest

from mcexact.reproduce.notebook import (
    EXPLAINED,
    OPEN,
    PROVED,
    STATUSES,
    Statement,
    counted,
    examination,
    examinations,
    open_table,
    statements,
)
from tests.reproduce.test_ledger import NUMBERED, script

# How many statements each section of the paper makes, counted on paper.
SECTIONS = {
    "I": 3, "I-A": 2, "I-B": 4, "II-A": 7, "II-B": 10, "II-C": 12, "II-D": 14, "III": 13,
    "IV": 1, "IV-A": 11, "IV-B": 6, "IV-C": 5, "IV-D": 13, "IV-E": 8, "V": 1, "V-A": 12,
    "V-B": 9, "VI": 3,
}  # fmt: skip
EVERY = pytest.mark.parametrize("said", statements(), ids=lambda said: str(said.number))


def test_no_statement_of_the_paper_is_missing() -> None:
    assert Counter(said.section for said in statements()) == SECTIONS
    assert len(statements()) == sum(SECTIONS.values()) == 134
    assert sum(counted(statements()).values()) == 134
    told = " ".join(said.equation for said in statements())
    for name in (*NUMBERED, *(f"({number})" for number in range(1, 39))):
        assert name in told or name in ("(5)", "(6)"), name


def test_every_examination_is_of_a_statement() -> None:
    of = {key for said in statements() for key in said.examined}
    assert of == {row.key for row in examinations()}


@EVERY
def test_a_status_is_backed(said: Statement) -> None:
    assert said.status in STATUSES and said.says.endswith((".", "?"))
    assert bool(said.examined) == (said.status not in ("informal", "absent"))
    assert bool(said.closes) == (said.status in OPEN)
    assert not (said.status in EXPLAINED and not said.note), "it needs a note"
    if said.status in PROVED:
        assert said.proofs
    if said.status in ("corrected", "refuted", "answered"):
        assert said.erratum
    if said.status in ("shown", "instances", "informal", "absent"):
        assert not said.proofs
    rows = [examination(key) for key in said.examined]
    if said.status == "refuted":
        assert any(row.nearest_false for row in rows), "no instance refutes it by name"
    if said.status == "shown":
        assert any(row.certificates for row in rows), "no certificate shows it"


def with_added_hypotheses() -> set[str]:
    """The theorems of paper.v with a hypothesis that is not printed: it is named added."""
    return {
        f"paper.{name}"
        for name, (_, text) in script("ledger_table").texts("paper").items()
        if re.search(r"\(added\b", text)
    }


@EVERY
def test_a_theorem_with_an_added_hypothesis_proves_nothing_as_printed(said: Statement) -> None:
    """A row that rests on an added hypothesis says so, and names it."""
    added = with_added_hypotheses() & set(said.proofs)
    if said.status in ("printed", "answered"):
        assert not added
    if added:
        assert said.status in ("added", "corrected") and said.note


def test_theorems_with_added_hypotheses_are_known_by_their_name() -> None:
    found = with_added_hypotheses()
    assert {"paper.lemma_1", "paper.equation_31", "paper.corollary_1"} <= found
    assert not {"paper.theorem_2", "paper.corollary_1_printed", "paper.proposition_3"} & found


def test_every_theorem_that_a_statement_cites_exists() -> None:
    printed = set(script("assumptions").theorems())
    named = {name for said in statements() for name in said.proofs}
    assert named <= printed, named - printed


def test_what_is_open_is_listed_with_what_would_close_it() -> None:
    rows = open_table().splitlines()[2:]
    assert rows
    assert len(rows) == sum(counted(statements())[status] for status in OPEN)
    for row in rows:
        assert row.count("|") == 7 and all(cell.strip() for cell in row.split("|")[1:-1]), row
