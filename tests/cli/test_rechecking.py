"""No answer is left without the verdict of the independent checker on its certificates."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from mcexact.checker.kinds import Check, Verdict
from mcexact.checker.sentences import RULES
from mcexact.cli import files, main
from mcexact.cli.files import Deadline
from mcexact.cli.running import Rechecked
from mcexact.model import gallery
from tests.wording import says, worded

FOLDER = Path(gallery.__file__).parent
PLANT = str(FOLDER / "lexalutyi-similarity-3x3.json")
Call = Callable[..., tuple[int, str, str]]


@pytest.fixture
def call(capsys: pytest.CaptureFixture[str]) -> Call:
    """The program in this process: status, output, messages."""

    def called(*arguments: str) -> tuple[int, str, str]:
        with pytest.raises(SystemExit) as ended:
            main(list(arguments))
        captured = capsys.readouterr()
        assert isinstance(ended.value.code, int)
        return ended.value.code, captured.out, captured.err

    return called


def test_every_certificate_is_re_checked_also_when_none_is_saved(call: Call) -> None:
    status, out, _ = call("analyze", PLANT)
    assert status == 0
    assert says(out, "certificates independent")
    document = json.loads(call("analyze", PLANT, "--json")[1])
    assert document["re_checked"] == {"valid": 9, "open": []}


@pytest.mark.parametrize(
    "command",
    [
        ("analyze", PLANT, "--json"),
        ("allocate", PLANT, "--links", "--json"),
        ("design", "decentralized", PLANT, "--rate", "1", "--json"),
    ],
    ids=lambda command: command[0],
)
def test_a_certificate_that_is_not_accepted_is_an_internal_error(
    command: tuple[str, ...], call: Call, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    refused = Verdict("INVALID", code="claim", place="claim", message="not so")
    monkeypatch.setattr(Check, "of", lambda *_: refused)
    status, out, err = call(*command, "--certificates", str(tmp_path / "evidence"))
    assert status == 70 and json.loads(out).keys() == {"format", "status", "message"}
    assert "cannot be trusted" in err
    assert not (tmp_path / "evidence").exists()


@pytest.mark.parametrize(
    ("command", "key"),
    [
        (("analyze", PLANT), "nothing-fixed"),
        (("allocate", PLANT, "--links"), "allocate-no-links-needed"),
    ],
)
def test_a_sentence_that_the_checker_does_not_know_is_an_internal_error(
    command: tuple[str, ...], key: str, call: Call, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delitem(RULES, key)
    status, _, err = call(*command, "--certificates", str(tmp_path / "evidence"))
    assert (status, "cannot be trusted" in err) == (70, True)
    assert not (tmp_path / "evidence").exists()


@pytest.mark.parametrize("form", [(), ("--json",)])
def test_what_a_limit_of_the_checker_leaves_open_is_status_4_and_keeps_the_answer(
    form: tuple[str, ...], call: Call, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    large = Verdict("INCOMPLETE", code="size", place="subject", message="too large to build")
    monkeypatch.setattr(Check, "of", lambda *_: large)
    page = tmp_path / "page.html"
    status, out, err = call("analyze", PLANT, *form, "--html", str(page))
    assert status == 4
    assert "fixed" in out and "not re-checked" in err
    if form:
        assert len(json.loads(out)["re_checked"]["open"]) == 9
    assert "not re-checked" in page.read_text(encoding="utf-8")


def test_what_the_time_limit_leaves_open_is_status_4_and_keeps_the_answer(
    call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown = files.emit_tables

    def show_and_run_out(*arguments: Any) -> None:
        shown(*arguments)
        monkeypatch.setattr(Deadline, "left", lambda _: 0.0)

    monkeypatch.setattr(Deadline, "left", lambda _: 10.0**6)
    monkeypatch.setattr("mcexact.cli.analyze.emit_tables", show_and_run_out)
    status, out, err = call("analyze", PLANT, "--timeout", "60")
    assert status == 4
    assert says(out, "mode fixed") and "re-checked by" not in out
    assert says(err, "answers checked")


def test_nothing_is_called_valid_where_there_is_no_certificate() -> None:
    assert worded(Rechecked({}, (), None).line())
