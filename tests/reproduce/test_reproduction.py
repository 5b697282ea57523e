"""The paper is reproduced; a formula that is broken on purpose is noticed and named."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from mcexact.cli import main
from mcexact.derived import error_system, extended, feedback, integrators
from mcexact.reproduce.ledger import statements
from mcexact.reproduce.pages import answer, reproduction_latex, reproduction_page
from mcexact.reproduce.reproduction import Reproduction, reproduce
from tests.report.strict_html import external_addresses


@pytest.fixture(scope="module")
def whole() -> Reproduction:
    """The whole paper, once: some fifteen seconds."""
    return reproduce()


def test_every_statement_of_the_paper_holds(whole: Reproduction) -> None:
    assert [row.finding.failure for row in whole.failures] == []
    assert len(whole.rows) == len(statements())


def test_nothing_holds_without_a_check_or_a_certificate(whole: Reproduction) -> None:
    for row in whole.rows:
        assert row.finding.checks or row.finding.certificates
        assert row.finding.instances


def test_the_certificates_are_of_the_kinds_that_the_ledger_names(whole: Reproduction) -> None:
    for row in whole.rows:
        kinds = {made.kind for made in row.finding.certificates}
        assert set(row.statement.certificates) <= kinds, row.statement.key


def test_the_report_parses_strictly_and_asks_nobody(whole: Reproduction) -> None:
    text = reproduction_page(whole)
    assert external_addresses(text) == []
    for drawn in (
        "Graphs",
        "The effect of delays",
        "Set-point responses",
        "Shared states by agent",
    ):
        assert drawn in text


def test_the_report_speaks_of_proofs_only_where_there_are_some(whole: Reproduction) -> None:
    said = " ".join(answer(whole))
    proved = sum(row.statement.proved for row in whole.rows)
    assert f"All {len(whole.rows)} statements examined hold" in said
    assert answer(Reproduction(whole.rows[:1]))[0] == "The statement examined holds."
    assert "1 of them" not in " ".join(answer(Reproduction(whole.rows[:1])))
    assert f"{proved} are proved in general" in said


def test_the_rows_are_set_in_latex(whole: Reproduction) -> None:
    text = reproduction_latex(whole)
    assert text.count("\\\\") == len(whole.rows) + 1
    assert text.isascii() or "·" in text


def doubled(module: Any, name: str) -> Any:
    """A function of a module that gives twice its value."""
    right = getattr(module, name)
    return lambda *arguments, **options: right(*arguments, **options) * 2


def transposed(module: Any, name: str) -> Any:
    """A function of a module that gives the transpose of its value."""
    right = getattr(module, name)
    return lambda *arguments, **options: right(*arguments, **options).T


BROKEN = [
    (extended, "selector", doubled, "emcs", "Equations bun, emcs"),
    (extended, "shift", transposed, "emcsdd", "Equations emcsdd, emcsdd-mtrx"),
    (extended, "shift", transposed, "emcsdd-hold", "Equations emcsdd-hold, emcsdd-hold-mtrx"),
    (error_system, "block", doubled, "eme1", "Equations eme1, eme2, auditt, com.o, anal"),
    (integrators, "selector", doubled, "b1", "Equations int, b1, b2"),
    (feedback, "closed_by", doubled, "mcs", "Equation (1)"),
]


@pytest.mark.parametrize(("module", "name", "breaking", "key", "title"), BROKEN)
def test_a_formula_broken_on_purpose_fails_the_run_and_names_the_statement(
    module: Any,
    name: str,
    breaking: Any,
    key: str,
    title: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(module, name, breaking(module, name))
    with pytest.raises(SystemExit) as ended:
        main(["reproduce", "--statement", key])
    captured = capsys.readouterr()
    assert ended.value.code == 1
    assert f"mcexact: {title}: " in captured.err
    assert "1 of 1 statements do not hold" in captured.out


def test_a_wrong_construction_is_refused_by_the_checker_too(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The checker builds the extended system itself, so evidence about another one is not valid."""
    monkeypatch.setattr(extended, "selector", doubled(extended, "selector"))
    (row,) = reproduce(["emcs"]).rows
    assert {made.verdict for made in row.finding.certificates} != {"VALID"}


def test_the_folder_is_written_whole_and_replaces_only_its_own(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "paper"
    for _ in range(2):
        with pytest.raises(SystemExit) as ended:
            main(["reproduce", "--statement", "Theorem 2", "-o", str(folder), "--json"])
        assert ended.value.code == 0
    view = json.loads(capsys.readouterr().out.partition("\n}\n")[2] or "{}")
    assert view["statements"][0]["title"] == "Theorem 2"
    written = sorted(path.name for path in (folder / "certificates").iterdir())
    assert written == sorted(view["statements"][0]["certificates"])
    assert [path.name for path in tmp_path.iterdir()] == ["paper"]
    with pytest.raises(SystemExit) as ended:
        main(["check", *(str(folder / "certificates" / name) for name in written)])
    assert ended.value.code == 0
    other = tmp_path / "mine"
    other.mkdir()
    (other / "notes.txt").write_text("keep", encoding="utf-8")
    with pytest.raises(SystemExit) as ended:
        main(["reproduce", "--statement", "Theorem 2", "-o", str(other)])
    assert ended.value.code == 3
    assert (other / "notes.txt").read_text(encoding="utf-8") == "keep"


def test_an_unknown_statement_is_wrong_usage(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["reproduce", "--statement", "Theorem 22"])
    assert ended.value.code == 2
    assert "did you mean 'theorem 2'" in capsys.readouterr().err
