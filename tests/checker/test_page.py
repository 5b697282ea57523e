"""The page of an audit, made by the checker alone and by the command of the package."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from html import unescape
from pathlib import Path

import pytest

from mcexact.checker.command import main
from mcexact.checker.core.budget import Verdict
from mcexact.checker.kinds import Found
from mcexact.checker.page import Audit, Marked, Table, rendered, written
from mcexact.cli.check import checker_archive
from tests.checker.manifests import EVIDENCE, manifest, sentence, write


def cells(page: str) -> list[list[str]]:
    """The cells of all rows of tables, without marks."""
    rows = re.findall(r"<tr>(.*?)</tr>", page)
    return [re.findall(r"<t[dh]>(.*?)</t[dh]>", row) for row in rows]


def marked(page: str) -> list[str]:
    return [unescape(each) for each in re.findall("<mark>(.*?)</mark>", page)]


def test_the_checker_alone_writes_the_page_that_is_to_be_signed(tmp_path: Path) -> None:
    write(tmp_path)
    archive, page = tmp_path / "checker.pyz", tmp_path / "page.html"
    archive.write_bytes(checker_archive())
    asked = [str(tmp_path / "manifest.json"), "--html", str(page)]
    run = [sys.executable, "-I", "-S", str(archive), *asked]
    done = subprocess.run(run, capture_output=True, text=True, check=True)
    text = page.read_text("utf-8")
    last = done.stdout.splitlines()[-1]
    assert last in unescape(text) and "status 0" in text
    assert text.count("<td>VALID</td>") == len(EVIDENCE)
    rows = [row for row in cells(text) if row and row[0] == "IMPLIED"]
    assert len(rows) == done.stdout.count("\nIMPLIED")
    assert [row for row in cells(text) if row[0].startswith("SHA-256 of mcexact-checker.pyz")]
    assert "warning: no plant" in text and "<script" not in text
    (tmp_path / "folder.html").mkdir()
    nowhere = [*run[:-1], str(tmp_path / "folder.html")]
    assert subprocess.run(nowhere, capture_output=True, check=False).returncode == 74


def test_words_that_are_not_compared_are_marked_and_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    said = [
        sentence("controllable", "joint_controllability") | {"text": text}
        for text in ("jointly controllable: every mode", "jointly controllable: any mode")
    ]
    fixed = sentence("fixed", "fixed_spectrum") | {"text": "fixed modes: the mode 0"}
    write(tmp_path, listed=manifest(sentences=[*said, fixed]))
    page = tmp_path / "page.html"
    assert main([str(tmp_path), "--html", str(page)]) == 1
    text, told = page.read_text("utf-8"), capsys.readouterr().out
    assert marked(text) == ["the mode 0"]
    assert "warning: 1 certificates" in text
    assert "INVALID 'jointly controllable: any mode'" in told
    assert "in the report: 'fixed modes: the mode 0'; compare 'the mode 0'" in told


def test_what_was_asked_and_what_was_found_are_told_apart() -> None:
    plant, controller, other = "1" * 64, "2" * 64, "3" * 64
    loop = "For the closed loop"

    def valid(k: int, statement: str, summary: str, plant: str, controller: str) -> Found:
        about = {"file": f"{k}.json", "number": str(k), "manifest": "nowhere.json"}
        return about, Verdict("VALID", statement, "4" * 64, summary, (), plant, controller)

    found = [
        valid(1, loop, "", plant, controller),
        valid(2, loop, "of a plant nearby: x", other, controller),
        valid(3, loop, "for all plants within the radii", "5" * 64, "6" * 64),
        valid(4, "For the plant sampled every 1", "", plant, "7" * 64),
        (
            {"text": "x <\u202e 1: 2", "rule": "r", "premises": "1"},
            Verdict("IMPLIED", left_open=((8, 9),)),
        ),
        (
            {"text": "gone", "rule": "r", "premises": ""},
            Verdict("INVALID", code="text", message="m"),
        ),
    ]
    asked = {"plant": "a/plant.json", "controller": "c.json"}
    audit = Audit(found, ["a folder", "--system", "p"], asked, 1, "last", second={0: "CONFIRMED"})
    text = unescape(audit.page())
    for words in (
        "fails: certificates 2",
        "around it: certificates 3",
        "another one: certificates 3",
        "at samples: certificates 4",
        "plant.json and c.json",
        "python -I mcexact-checker.pyz 'a folder' --system p --html FILE",
        "confirmed",
        "text: m",
        "x <\\u202e 1: <mark>2</mark>",
    ):
        assert words in text, words
    assert marked(audit.page()) == ["2"] and "\u202e" not in audit.page()
    again = Audit(found, [], {}, 1, "last", worded={("r", "x <\u202e 1: 2")}).page()
    assert "computed all of" in again and "<td>yes</td>" in again
    partly = Audit(found, [], {}, 1, "last", worded=()).page()
    assert "computed 0 of 1 of" in partly


def test_a_page_has_a_name_that_no_certificate_has(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "fixed.json"
    file.write_text(json.dumps(EVIDENCE["fixed_spectrum"]))
    assert main([str(file), "--html", str(file)]) == 2
    assert "ends with .html" in capsys.readouterr().err


def test_texts_are_written_so_that_none_is_taken_for_the_page() -> None:
    assert written("<b> & \n\x1b é") == "&lt;b&gt; &amp; \\n\\x1b é"
    assert Marked("a<b>c", [(1, 2)]).__html__() == "a<mark>&lt;</mark>b&gt;c"
    table = rendered(Table("t", ("<h>",), [("<c>",)], "n", "s"))
    assert "&lt;h&gt;" in table and "&lt;c&gt;" in table and 'class="s"' in table
