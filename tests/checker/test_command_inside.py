"""The checker's command line in the process of the tests; ``test_command.py`` runs it outside."""

from __future__ import annotations

import errno
import importlib
import io
import json
import os
import runpy
import sys
from pathlib import Path
from typing import Any

import pytest

from mcexact import checker
from mcexact.checker import command, kinds
from mcexact.checker.command import main
from mcexact.checker.core import reading
from mcexact.checker.kinds import Verdict
from tests.checker.handmade import FIXED, FREE, PAPER, changed
from tests.checker.manifests import EVIDENCE, SENTENCES, digest_of, write
from tests.wording import worded


@pytest.fixture
def _imported_as_usual(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without pytest's hook, which loads a package with fixtures, and gives ``runpy`` no code."""
    usual = [finder for finder in sys.meta_path if not hasattr(finder, "mark_rewrite")]
    monkeypatch.setattr(sys, "meta_path", usual)


class Stream(io.TextIOWrapper):
    """A stream that fails with an error as soon as it is written to, or only at the end."""

    def __init__(self, path: Path, error: OSError, late: bool = False) -> None:
        super().__init__(path.open("wb"), encoding="ascii")
        self.error, self.late = error, late

    def write(self, text: str) -> int:
        if not self.late:
            raise self.error
        return len(text)

    def flush(self) -> None:
        if self.late:
            raise self.error


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working directory, with some files in it."""
    documents = {
        "valid": FREE,
        "fixed": FIXED,
        "invalid": changed(FREE, ("witness.gains.0.entries", [[0]])),
        "malformed": changed(FREE, ("verified", True)),
        "incomplete": changed(FREE, ("kind", "is_nice")),
        "system": {"format": "mcexact-system/1", "name": "paper", **PAPER},
        "other": {"format": "mcexact-system/1", **PAPER, "A": [[0.1, 0, 0]] * 3},
    }
    for name, document in documents.items():
        (tmp_path / f"{name}.json").write_text(json.dumps(document), encoding="utf-8")
    (tmp_path / "evidence").mkdir()
    write(tmp_path / "evidence")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    ("files", "status", "words"),
    [
        ("valid", 0, "VALID"),
        ("invalid", 1, "INVALID"),
        ("malformed", 3, "MALFORMED"),
        ("incomplete", 5, "INCOMPLETE"),
        ("missing", 3, "MALFORMED"),
        ("valid invalid fixed", 1, "VALID INVALID VALID"),
        ("incomplete invalid malformed", 3, "INCOMPLETE INVALID MALFORMED"),
        ("incomplete valid", 5, "INCOMPLETE VALID"),
        ("incomplete invalid", 1, "INCOMPLETE INVALID"),
    ],
)
def test_files_are_judged_in_order_and_the_status_is_the_worst(
    folder: Path, capsys: pytest.CaptureFixture[str], files: str, status: int, words: str
) -> None:
    assert main([f"{name}.json" for name in files.split()]) == status
    told = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in told] == words.split()


def test_a_bug_comes_before_everything_else(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def check(*arguments: Any) -> Verdict:
        raise ZeroDivisionError

    monkeypatch.setattr(command, "check_document", check)
    assert main(["valid.json", "missing.json"]) == 70
    assert capsys.readouterr().out.startswith("ERROR 'valid.json' internal checker: ")


def test_one_document_says_the_same(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--json", "fixed.json", "invalid.json"]) == 1
    document = json.loads(capsys.readouterr().out)
    assert document.keys() == {"format", "verdicts"} and document["format"] == "mcexact-verdicts/1"
    found = document["verdicts"]
    assert [(row["file"], row["verdict"]) for row in found] == [
        ("fixed.json", "VALID"),
        ("invalid.json", "INVALID"),
    ]


@pytest.mark.parametrize(
    ("text", "said"),
    [("A = 1", "not JSON: expected value"), ("[1 2]", "not JSON: expected ',' delimiter")],
)
def test_a_text_that_is_no_json_is_told_in_a_sentence(
    text: str, said: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "other.json").write_text(text, encoding="utf-8")
    assert main(["other.json"]) == 3
    assert capsys.readouterr().out.rstrip().endswith(said)


def test_a_document_is_indented_by_one(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--json", "fixed.json"]) == 0
    told = capsys.readouterr().out
    assert told == json.dumps(json.loads(told), indent=1) + "\n"


def test_nothing_to_judge_is_well() -> None:
    assert command.status_of([]) == 0


@pytest.mark.parametrize("seconds", ["0.5", "1", "1e300"])
def test_any_time_above_0_is_a_limit(seconds: str) -> None:
    assert command.seconds(seconds) == float(seconds)


def test_manifests_are_options_or_files_of_that_name(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for arguments in (["--manifest", "evidence"], ["evidence/manifest.json"]):
        assert main([*arguments, "--json"]) == 0
        found = json.loads(capsys.readouterr().out)["verdicts"]
        assert [row["text"] for row in found if "text" in row] == [
            sentence["text"] for sentence in SENTENCES
        ]
    assert main(["--manifest", "nowhere"]) == 3
    assert main(["--manifest", "evidence", "--system", "other.json"]) == 1


@pytest.mark.parametrize(
    ("system", "status"),
    [("system.json", 0), ("other.json", 1), ("fixed.json", 3), ("missing.json", 3)],
)
def test_a_system_can_be_insisted_on(
    folder: Path, capsys: pytest.CaptureFixture[str], system: str, status: int
) -> None:
    assert main(["fixed.json", "--system", system]) == status
    told = capsys.readouterr()
    assert bool(told.err) == (status == 3)
    assert bool(told.out) == (status != 3)


def test_a_line_names_its_file_where_there_are_several(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main(["fixed.json"])
    alone = capsys.readouterr().out
    files = ["fixed.json", "invalid.json", "--manifest", "evidence"]
    assert main(files) == 1
    valid, invalid, *implied, counted = capsys.readouterr().out.splitlines()
    implied = implied[len(EVIDENCE) :]
    assert valid.replace(" 'fixed.json': ", " ", 1) + "\n" == alone
    assert invalid.startswith("INVALID 'invalid.json' common_factor ")
    texts = [ascii(each["text"]) for each in SENTENCES]
    assert all(
        line.startswith("IMPLIED ") and line.endswith(f": {text}")
        for line, text in zip(implied, texts, strict=True)
    )
    told = f"{len(SENTENCES)} sentences implied, 0 not, 0 remarks; "
    told += f"{len(EVIDENCE)} certificates valid, 0 not"
    ungiven, counts = counted.removeprefix("COUNTED 'evidence' ").split("; ", 1)
    counts, digest = counts.rsplit("; ", 1)
    assert counts == told and ungiven.split()[:2] == ["no", "plant"]
    assert digest.split()[-1] == digest_of(folder / "evidence" / "manifest.json")
    assert main([*files, "--statements"]) == 1
    valid, *_ = capsys.readouterr().out.splitlines()
    (folder / "said.txt").write_text(valid + "\n", encoding="ascii")
    assert main(["fixed.json", "--expect", "said.txt"]) == 0


@pytest.mark.parametrize("option", ["--system", "--controller", "--expect"])
def test_what_cannot_be_asked_is_told_once_and_in_one_document(
    folder: Path, capsys: pytest.CaptureFixture[str], option: str
) -> None:
    (folder / "empty.json").write_text("{}", encoding="ascii")
    for file, code, status in (("nope", "unreadable", 3), ("empty.json", "form", 3)):
        assert main(["fixed.json", option, file]) == status
        told = capsys.readouterr()
        assert (told.out, told.err.count(file)) == ("", 1)
        assert main(["fixed.json", option, file, "--json"]) == status
        ((row),) = json.loads(capsys.readouterr().out)["verdicts"]
        assert (row["file"], row["verdict"], row["code"]) == (file, "MALFORMED", code)
    assert main(["fixed.json", option, "fixed.json", "--max-bytes", "100"]) == 5
    assert "(--max-bytes)" in capsys.readouterr().err


def test_memory_that_is_missing_for_what_is_asked_is_incomplete(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*arguments: Any) -> bytes:
        raise MemoryError

    monkeypatch.setattr(reading, "read_bytes", full)
    assert main(["fixed.json", "--system", "system.json"]) == 5
    assert worded(capsys.readouterr().err)


def test_a_manifest_is_not_asked_for_one_statement(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for arguments in (["--manifest", "evidence"], ["fixed.json", "evidence/manifest.json"]):
        assert main([*arguments, "--expect", "said.txt"]) == 2
        assert "leave out --expect" in capsys.readouterr().err


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["-", "-"],
        ["-", "--system", "-"],
        ["valid.json", "--sytem", "system.json"],
        *(["valid.json", "--max-bytes", number] for number in ("0", "-1", "many", "1.5", "\u0663")),
        *(["valid.json", "--timeout", number] for number in ("0", "-1", "nan", "inf", "soon")),
        ["valid.json", "--max-wor", "40000000"],
    ],
)
def test_wrong_usage_ends_with_2(
    folder: Path, capsys: pytest.CaptureFixture[str], arguments: list[str]
) -> None:
    assert main(arguments) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err


def test_a_complaint_is_in_ascii(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["a", "--sytem", "\u00f6"]) == 2
    assert capsys.readouterr().err.endswith("error: unrecognized arguments: --sytem \\xf6\n")


def test_help_is_no_wrong_usage(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--help"]) == 0
    told = " ".join(capsys.readouterr().out.split())
    for option in (
        "--manifest FILE verify",
        "(default: 67,108,864)",
        "(default: 4,300)",
        "5 INCOMPLE",
    ):
        assert option in told


def test_limits_that_the_platform_lacks_are_wrong_usage(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command, "SUPPORTED", False)
    assert main(["valid.json"]) == 0
    assert main(["valid.json", "--timeout", "900"]) == 2
    assert main(["valid.json", "--max-memory", "100000"]) == 2


def test_every_limit_reaches_the_reader(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for option, few, enough in (
        ("--max-bytes", "100", "100000"),
        ("--max-digits", "2", "3"),
        ("--max-work", "100", "40000000"),
    ):
        assert main(["fixed.json", option, few]) == 5
        assert f"({option})" in capsys.readouterr().out
        assert main(["fixed.json", option, enough]) == 0
    assert main(["fixed.json", "--max-depth", "3"]) == 3
    assert main(["fixed.json", "--timeout", "900", "--max-memory", "100000"]) == 0


def test_standard_input_is_read_once(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(json.dumps(FREE).encode())))
    assert main(["-"]) == 0
    monkeypatch.setattr(sys, "stdin", None)
    assert main(["-"]) == 3


def test_an_interruption_ends_with_130(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def check(*arguments: Any) -> Verdict:
        raise KeyboardInterrupt

    monkeypatch.setattr(command, "check_document", check)
    assert main(["valid.json"]) == 130


def test_when_the_time_is_over_the_rest_is_incomplete(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def late(self: kinds.Clock, work: Any) -> Any:
        raise kinds.OutOfTime

    monkeypatch.setattr(kinds.Clock, "within", late)
    for asked in ([], ["--system", "system.json"]):
        assert main(["valid.json", "--timeout", "900", *asked]) == 5
        told = capsys.readouterr()
        assert "(--timeout allows more)" in told.out + told.err


@pytest.mark.parametrize("late", [False, True])
def test_verdicts_that_cannot_be_written_end_with_74(
    folder: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    late: bool,
) -> None:
    for error, told in ((OSError(errno.ENOSPC, "full"), True), (BrokenPipeError(), False)):
        stream = Stream(folder / "out", error, late)
        with monkeypatch.context() as changes:
            changes.setattr(sys, "stdout", stream)
            assert main(["valid.json"]) == 74
        assert os.path.samestat(os.fstat(stream.fileno()), os.stat(os.devnull))
        stream.late, stream.error = True, OSError()
        assert bool(capsys.readouterr().err) == told
        with pytest.raises(OSError):
            stream.close()
    monkeypatch.setattr(sys, "stdout", None)
    assert main(["valid.json"]) == 74


def test_complaints_that_cannot_be_written_change_no_status(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for late in (False, True):
        stream = Stream(folder / "err", BrokenPipeError(), late)
        with monkeypatch.context() as changes:
            changes.setattr(sys, "stderr", stream)
            assert main(["valid.json", "--system", "missing.json"]) == 3
        stream.late = True
        with pytest.raises(OSError):
            stream.close()
    monkeypatch.setattr(sys, "stderr", None)
    assert main(["valid.json", "--system", "missing.json"]) == 3
    assert not capsys.readouterr().out, "what is printed to None goes to standard output"


def test_a_stream_of_another_kind_is_written_to_as_it_is(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stream = io.StringIO()
    monkeypatch.setattr(sys, "stdout", stream)
    assert main(["valid.json"]) == 0
    assert stream.getvalue().startswith("VALID ")


def test_a_character_that_the_encoding_lacks_is_written_in_another_way(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with io.TextIOWrapper((folder / "out").open("wb"), encoding="ascii") as stream:
        monkeypatch.setattr(sys, "stdout", stream)
        assert main(["valid.json"]) == 0
        assert stream.errors == "backslashreplace"


def test_standard_error_that_fails_at_the_end_leads_nowhere(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The interpreter flushes it once more, which must not change the exit status."""
    stream = Stream(folder / "err", OSError(), late=True)
    monkeypatch.setattr(sys, "stderr", stream)
    assert main(["valid.json"]) == 0
    assert os.path.samestat(os.fstat(stream.fileno()), os.stat(os.devnull))
    stream.late = False
    stream.close()


@pytest.mark.usefixtures("_imported_as_usual")
@pytest.mark.parametrize("as_module", [True, False])
def test_the_folder_starts_by_itself(
    folder: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    as_module: bool,
) -> None:
    start = Path(checker.__file__).parent
    monkeypatch.setattr(sys, "argv", ["checker", "valid.json"])
    monkeypatch.setattr(sys, "path", ["", str(folder), *sys.path])
    monkeypatch.delitem(sys.modules, "mcexact.checker.__main__", raising=False)
    before = dict(sys.modules)
    try:
        with pytest.raises(SystemExit) as end:
            if as_module:
                runpy.run_module("mcexact.checker", run_name="__main__", alter_sys=False)
            else:
                runpy.run_path(str(start / "__main__.py"), run_name="__main__")
    finally:
        for name in sys.modules.keys() - before.keys():
            if name.split(".")[0] == "checker":
                del sys.modules[name]
    assert end.value.code == 0
    assert capsys.readouterr().out.startswith("VALID ")
    assert not {"", str(folder)} & set(sys.path)
    assert os.path.dirname(os.__file__) in sys.path


@pytest.mark.usefixtures("_imported_as_usual")
def test_an_interruption_before_the_checker_is_loaded_ends_with_130_too(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def interrupted() -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr(command, "main", interrupted)
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.delitem(sys.modules, "mcexact.checker.__main__", raising=False)
    with pytest.raises(SystemExit) as end:
        runpy.run_module("mcexact.checker", run_name="__main__", alter_sys=False)
    assert end.value.code == 130


def test_every_place_of_the_standard_library_stays_on_the_path(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    start = importlib.import_module("mcexact.checker.__main__")
    major, minor = sys.version_info[:2]
    named = f"python{major}.{minor}"
    monkeypatch.setattr(os, "__file__", os.path.join("lib", named, "os.py"))
    monkeypatch.setattr(sys, "base_prefix", "base")
    monkeypatch.setattr(sys, "base_exec_prefix", "built")
    monkeypatch.setattr(sys, "platlibdir", "lib64")
    library = [
        os.path.join("lib", f"python{major}{minor}.zip"),
        os.path.join("lib", named),
        os.path.join("base", "DLLs"),
        os.path.join("built", "DLLs"),
        os.path.join("base", "lib64", named, "lib-dynload"),
        os.path.join("built", "lib64", named, "lib-dynload"),
    ]
    others = ["lib", "base", "built", os.path.join("lib", "python.zip")]
    monkeypatch.setattr(sys, "path", [*library, *others])
    start.clear_path()
    assert sys.path == library


def test_only_the_standard_library_stays_on_the_path(monkeypatch: pytest.MonkeyPatch) -> None:
    start = importlib.import_module("mcexact.checker.__main__")
    home = os.path.dirname(os.__file__)
    library = [home, os.path.join(home, "lib-dynload")]
    others = ["", ".", "elsewhere", os.path.join(home, "site-packages"), os.path.dirname(home)]
    monkeypatch.setattr(sys, "path", [*others, *library, *others])
    start.clear_path()
    assert sys.path == library
    packed = os.path.join("lib", "python.zip")
    monkeypatch.setattr(os, "__file__", os.path.join(packed, "os.py"))
    monkeypatch.setattr(sys, "path", ["", packed, "lib", "elsewhere"])
    start.clear_path()
    assert sys.path == [packed, "lib"]
