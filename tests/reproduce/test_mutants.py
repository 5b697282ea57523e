"""The list of mutants covers every examination; `make paper-mutants` runs it."""

from __future__ import annotations

from collections import Counter

import pytest

from mcexact.reproduce.notebook import examinations
from mcexact.reproduce.reproduction import procedures
from tests.assurance.paper_mutants.__main__ import KINDS, Mutant, main, mutants, mutated, outcome


def test_every_examination_has_two_mutants_or_more() -> None:
    count = Counter(each.key for each in mutants())
    assert set(count) == {row.key for row in examinations()}
    assert min(count.values()) >= 2
    assert {each.kind for each in mutants()} == set(KINDS)


def test_every_mutant_changes_what_is_there() -> None:
    for each in mutants():
        assert each.old != each.new
        assert mutated(each, procedures()[each.key]) is not None, each


def test_a_mutant_is_caught_and_one_that_changes_nothing_survives(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["every-subset"]) == 0
    assert "2 of 2 mutants are caught" in capsys.readouterr().out
    idle = Mutant("every-subset", "sign", "not graph_of(plant)", "not  graph_of(plant)")
    assert outcome(idle) == ""
    with pytest.raises(ValueError, match="no longer there"):
        outcome(Mutant("every-subset", "sign", "nowhere", ""))
