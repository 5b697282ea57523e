"""The paper is reproduced; a formula that is broken on purpose is noticed and named."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from mcexact.cli import main
from mcexact.derived import constructions
from mcexact.report.text import plain
from mcexact.reproduce.notebook import (
    STATUSES,
    Notebook,
    examination,
    examinations,
    examined,
)
from mcexact.reproduce.reproduction import (
    COMMON_BOUND,
    Reproduction,
    answer,
    counts,
    reproduce,
    reproduction_latex,
    reproduction_page,
    reproduction_tables,
    reproduction_view,
)
from tests.report.strict_html import external_addresses
from tests.wording import says, worded


@pytest.fixture(scope="module")
def whole() -> Reproduction:
    """The whole paper, once: some twenty seconds."""
    return reproduce()


def test_no_examination_fails(whole: Reproduction) -> None:
    assert [row.finding.failure for row in whole.failures] == []
    assert len(whole.rows) == len(examinations()) and whole.is_whole


def test_every_nearest_false_statement_is_refuted_by_name(whole: Reproduction) -> None:
    for row in whole.rows:
        named = {each.name: each.statement for each in row.finding.refutations if each.refuted}
        assert named == row.examination.nearest_false, row.examination.key
        assert all(each.refuted and each.instance for each in row.finding.refutations)


def test_an_instance_that_does_not_refute_fails_the_examination() -> None:
    def lame(note: Notebook) -> None:
        note.on("an instance")
        note.check("something holds", True)
        note.refute("tight", False)

    def silent(note: Notebook) -> None:
        note.on("an instance")
        note.check("something holds", True)

    assert says(examined("tight", lame).failure, "instance refuted")
    assert "no instance refutes: The bound" in examined("tight", silent).failure


def test_an_examination_whose_instances_say_nothing_fails() -> None:
    def empty(note: Notebook) -> None:
        note.on("an instance")
        note.check("something holds", True)
        note.counts(False)
        for name in examination("tight").nearest_false:
            note.refute(name)

    assert worded(examined("tight", empty).failure)


def test_every_row_says_on_how_many_instances_it_has_content(whole: Reproduction) -> None:
    for row in whole.rows:
        instances, content = len(row.finding.instances), row.finding.with_content
        assert 0 < content <= instances, row.examination.key
        assert set(row.finding.content) <= set(row.finding.instances)
        assert row.examination.content
        if row.examination.kind != "example":
            told = "all" if content == instances else str(content)
            assert row.status.endswith(
                ", with content" if instances == 1 else f", {told} with content"
            )
    sizes = {row.examination.key: row.finding.with_content for row in whole.rows}
    for few in ("footnote", "equation-19", "lemma-1", "corfmat-morse", "extended-joint"):
        assert sizes[few] > 3, "drawn plants alone have hardly any"


def test_nothing_holds_without_a_check_or_a_certificate(whole: Reproduction) -> None:
    for row in whole.rows:
        assert row.finding.checks or row.finding.certificates
        assert row.finding.instances


def test_the_certificates_are_of_the_kinds_that_the_ledger_names(whole: Reproduction) -> None:
    for row in whole.rows:
        kinds = {made.kind for made in row.finding.certificates}
        assert set(row.examination.certificates) <= kinds, row.examination.key


def test_the_report_parses_strictly_and_links_its_certificates_alone(whole: Reproduction) -> None:
    text = reproduction_page(whole)
    beside = {f"a href=certificates/{name}" for name in whole.certificates()}
    assert set(external_addresses(text)) == beside
    assert "<math>" in text and says(text, "example drawn")
    for drawn in (
        "Graphs",
        "The effect of delays",
        "Set-point responses",
        "Shared states by agent",
    ):
        assert drawn in text
    outside = re.sub(r"<details.*?</details>", "", text, flags=re.DOTALL)
    assert "<figure" in text and "<figure" not in outside
    assert text.count("<summary>") == len(whole.rows)
    assert '<div class="inside" id="theorem-2">' in text and "<b>Theorem 2</b> (26):" in text


def test_the_report_says_first_what_the_paper_asks_and_counts_every_status(
    whole: Reproduction,
) -> None:
    said = answer(whole)
    assert said[0] == COMMON_BOUND
    assert says(said[1], "all") and f"All {len(whole.rows)} " in said[1]
    assert sum(counts(whole).values()) == 134
    view = reproduction_view(whole)
    assert view["counts"] == counts(whole) and len(view["statements"]) == 134
    assert {each["status"] for each in view["statements"]} <= set(STATUSES.values())
    one = Reproduction(whole.rows[:1])
    assert worded(answer(one)[0])
    assert [each.number for each in one.statements] == [1]


def test_what_fails_on_an_instance_has_a_row_of_its_own(whole: Reproduction) -> None:
    row = next(row for row in whole.rows if row.examination.key == "every-subset")
    checks = [
        *row.finding.checks,
        replace(row.finding.checks[0], holds=False, instance="an agent"),
    ]
    broken = replace(row, finding=replace(row.finding, checks=checks))
    text = reproduction_page(Reproduction((broken,)))
    assert re.search(r"<td [^>]*>NO</td><td [^>]*>an agent</td>", text)
    assert "; three agents, links: <span" in text and "an agent;" not in text


def test_a_terminal_shows_the_whole_paper_or_a_few_statements_in_full(whole: Reproduction) -> None:
    text = plain(reproduction_tables(whole), width=100)
    assert "Corollary 2" in text and "what was checked" not in text
    row = next(row for row in whole.rows if row.examination.key == "equation-31")
    text = " ".join(plain(reproduction_tables(Reproduction((row,))), width=200).split())
    assert "0 absent" not in text and "absent 0" not in text
    for told in (
        "106 IV-E (31) Under the hypotheses of Theorem 2 some F̄_i make",
        "proved as corrected. The extended transfer graph has to be strongly connected besides",
        "Examined on the matrices of the example of IV-B; 5 drawn",
        "Machine-checked: paper.equation_31, paper.one_channel.",
        "Correction: Statement 106: The extended transfer graph has to be strongly connected",
        "The same with n_i = 0. yes A = 0 on a cycle, nothing shared",
    ):
        assert told in text, told


def test_the_statements_are_set_in_latex(whole: Reproduction) -> None:
    text = reproduction_latex(whole)
    assert sum(line.endswith("\\\\") for line in text.splitlines()) == 134
    assert text.isascii(), {character for character in text if not character.isascii()}


def doubled(module: Any, name: str) -> Any:
    """A function of a module that gives twice its value."""
    right = getattr(module, name)
    return lambda *arguments, **options: right(*arguments, **options) * 2


def transposed(module: Any, name: str) -> Any:
    """A function of a module that gives the transpose of its value."""
    right = getattr(module, name)
    return lambda *arguments, **options: right(*arguments, **options).T


BROKEN = [
    (constructions, "selector", doubled, "equations-24-25", "Equations (24) and (25)"),
    (constructions, "shift", transposed, "equations-34-35", "Equations (34) and (35)"),
    (constructions, "shift", transposed, "equations-37-38", "Equations (37) and (38)"),
    (constructions, "block", doubled, "equations-12-16", "Equations (12) to (16)"),
    (constructions, "selector", doubled, "equations-17-18", "Equations (17) and (18)"),
    (constructions, "closed_by", doubled, "equation-1", "Equation (1)"),
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
    assert "1 of 1 examination fails" in captured.out


def test_a_wrong_construction_is_refused_by_the_checker_too(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The checker builds the extended system itself, so evidence about another one is not valid."""
    monkeypatch.setattr(constructions, "selector", doubled(constructions, "selector"))
    (row,) = reproduce(["equations-24-25"]).rows
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
    assert view["statements"][0]["equation"] == "Theorem 2, (26)"
    written = sorted(path.name for path in (folder / "certificates").iterdir())
    assert written == sorted(view["examinations"][0]["certificates"])
    assert [path.name for path in tmp_path.iterdir()] == ["paper"]
    with pytest.raises(SystemExit) as ended:
        main(["check", "--statements", *(str(folder / "certificates" / name) for name in written)])
    assert ended.value.code == 0
    other = tmp_path / "mine"
    other.mkdir()
    (other / "notes.txt").write_text("keep", encoding="utf-8")
    with pytest.raises(SystemExit) as ended:
        main(["reproduce", "--statement", "Theorem 2", "-o", str(other)])
    assert ended.value.code == 3
    assert (other / "notes.txt").read_text(encoding="utf-8") == "keep"


def test_another_run_elsewhere_and_with_another_hash_seed_writes_the_same_bytes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The examination of the example has matrices, a figure, checks and certificates."""
    asked = ("reproduce", "--statement", "example", "--latex", "-o")
    with pytest.raises(SystemExit):
        main([*asked, str(tmp_path / "here")])
    seed = "1" if os.environ.get("PYTHONHASHSEED") == "2" else "2"
    there = subprocess.run(
        [sys.executable, "-m", "mcexact", *asked, "there"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONHASHSEED": seed, "TZ": "Asia/Tokyo"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert there.stdout == capsys.readouterr().out
    files = {
        folder: {
            path.relative_to(tmp_path / folder): path.read_bytes()
            for path in (tmp_path / folder).rglob("*.*")
        }
        for folder in ("here", "there")
    }
    assert files["here"] == files["there"] and len(files["here"]) > 5


def test_an_unknown_statement_is_wrong_usage(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["reproduce", "--statement", "Theorem 22"])
    assert ended.value.code == 2
    assert "did you mean 'theorem 2'" in capsys.readouterr().err
