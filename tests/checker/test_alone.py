"""The checker by itself, as folder and archive: hostile files around it, streams and limits."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
import zipfile
from collections.abc import Sequence
from pathlib import Path

import pytest

from mcexact import checker
from mcexact.cli.check import checker_archive
from tests.checker.handmade import FIXED, FREE, changed
from tests.effort import PATIENCE
from tests.wording import says, worded

FOLDER = Path(checker.__path__[0])
# fmt: off
SHADOWS = (
    "_decimal", "_json", "argparse", "bisect", "dataclasses", "datetime", "decimal", "errno",
    "fractions", "gettext", "hashlib", "heapq", "inspect", "json", "locale", "math", "numbers",
    "pickle", "random", "re", "resource", "secrets", "shutil", "signal", "string", "struct",
    "system", "tempfile", "textwrap", "typing", "unicodedata",
)
"""Names of standard modules that a file in the working directory could have."""
EARLY = (
    "collections", "contextlib", "copy", "functools", "importlib", "io", "keyword", "operator",
    "os", "reprlib", "stat", "threading", "token", "traceback", "types", "warnings", "weakref",
    "zipfile", "zlib",
)
"""Such that Python itself may import for ``-m``, before the checker runs."""
# fmt: on
POSIX = pytest.mark.skipif(os.name != "posix", reason="needs FIFOs, alarms and /dev/full")


@pytest.fixture(scope="module")
def hostile(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the checker, certificates, and files named like standard modules."""
    target = tmp_path_factory.mktemp("hostile")
    shutil.copytree(FOLDER, target / "checker", ignore=shutil.ignore_patterns("__pycache__"))
    (target / "checker.pyz").write_bytes(checker_archive())
    for name in (*SHADOWS, *EARLY):
        text = f"open('executed', 'a').write('{name} ')\nraise RuntimeError('{name}')\n"
        (target / f"{name}.py").write_text(text)
    documents = {
        "valid": FREE,
        "fixed": FIXED,
        "invalid": changed(FREE, ("witness.gains.0.entries", [[0]])),
        "malformed": changed(FREE, ("verified", True)),
        "incomplete": changed(FREE, ("kind", "is_nice")),
    }
    for name, document in documents.items():
        (target / f"{name}.json").write_text(json.dumps(document), encoding="utf-8")
    return target


def run(
    folder: Path, *command: str, stdin: int | None = subprocess.DEVNULL, **environment: str
) -> subprocess.CompletedProcess[str]:
    """Run Python in a folder, with these options and arguments."""
    return subprocess.run(
        [sys.executable, *command],
        cwd=folder,
        env={"PATH": os.environ.get("PATH", ""), **environment},
        stdin=stdin,
        capture_output=True,
        text=True,
        check=False,
        timeout=PATIENCE,
    )


STARTS = [
    ("checker",),
    ("-S", "-E", "checker"),
    ("-I", "checker"),
    ("-O", "checker"),
    ("-P", "checker"),
    ("checker.pyz",),
    ("-I", "checker.pyz"),
    ("-S", "-E", "checker.pyz"),
]


@pytest.mark.parametrize("start", STARTS, ids=" ".join)
def test_no_file_around_passes_for_a_standard_module(hostile: Path, start: Sequence[str]) -> None:
    done = run(hostile, *start, "fixed.json", "valid.json", "--json", "--max-memory", "500")
    assert (done.returncode, done.stderr) == (0, "")
    assert not (hostile / "executed").exists()
    assert run(hostile / "checker", "-I", "../checker.pyz", "../fixed.json").returncode == 0


@pytest.mark.parametrize(
    "start", [("-E", "-m", "checker"), ("checker",), ("checker.pyz",)], ids=" ".join
)
def test_a_path_that_leads_to_files_around_is_cleared_before_anything_is_imported(
    tmp_path: Path, start: Sequence[str]
) -> None:
    shutil.copytree(FOLDER, tmp_path / "checker", ignore=shutil.ignore_patterns("__pycache__"))
    (tmp_path / "checker.pyz").write_bytes(checker_archive())
    for name in SHADOWS:
        (tmp_path / f"{name}.py").write_text(f"raise RuntimeError('{name}')\n")
    (tmp_path / "valid.json").write_text(json.dumps(FREE))
    done = run(tmp_path, "-S", *start, "valid.json", PYTHONPATH=".")
    assert (done.returncode, done.stderr) == (0, "")


def test_importing_the_package_changes_no_path_and_imports_nothing(tmp_path: Path) -> None:
    shutil.copytree(FOLDER, tmp_path / "checker", ignore=shutil.ignore_patterns("__pycache__"))
    program = (
        "import sys; sys.path.append('.'); path, before = sys.path[:], {*sys.modules}; "
        "import checker; print(sorted({*sys.modules} - before), sys.path == path); "
        "from checker import check_document; print(check_document(b'').verdict, sys.path == path)"
    )
    done = run(tmp_path, "-I", "-c", program)
    assert done.stdout.splitlines() == ["['checker'] True", "MALFORMED True"], done.stderr
    path = sys.path[:]
    assert checker.check_document(b"{}").status == 3
    assert sys.path == path
    with pytest.raises(AttributeError, match="has no attribute 'chek'"):
        _ = checker.chek


def test_the_archive_has_the_files_of_the_folder_and_always_the_same_bytes(tmp_path: Path) -> None:
    data = checker_archive()
    assert data == checker_archive()
    (tmp_path / "checker.pyz").write_bytes(data)
    with zipfile.ZipFile(tmp_path / "checker.pyz") as archive:
        paths = [*FOLDER.rglob("*.py"), FOLDER / "wordings.json"]
        files = {str(path.relative_to(FOLDER)): path.read_bytes() for path in paths}
        assert {name: archive.read(name) for name in archive.namelist()} == files
        assert archive.namelist() == sorted(files)
        assert {member.date_time for member in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}


def test_the_exported_archive_prints_the_lines_of_the_command(hostile: Path) -> None:
    export = run(hostile, "-P", "-m", "mcexact", "check", "--export", "exported.pyz")
    assert (export.returncode, export.stdout) == (0, "")
    assert export.stderr == "mcexact: wrote exported.pyz\n"
    files = [f"{name}.json" for name in ("valid", "fixed", "invalid", "malformed", "incomplete")]
    alone = run(hostile, "-I", "exported.pyz", *files, "missing.json")
    inside = run(hostile, "-P", "-m", "mcexact", "check", *files, "missing.json")
    assert (alone.stdout, alone.returncode) == (inside.stdout, inside.returncode)
    assert [line.split()[0] for line in alone.stdout.splitlines()] == [
        *("VALID", "VALID", "INVALID", "MALFORMED", "INCOMPLETE", "MALFORMED")
    ]
    both = run(hostile, "-P", "-m", "mcexact", "check", "--export", "x.pyz", "valid.json")
    assert both.returncode == 2 and not (hostile / "x.pyz").exists()


BOTH = [("-I", "checker"), ("-P", "-m", "mcexact", "check", "--no-verified")]
"""The checker alone, as a folder that Python compiles once, and as a command of the package."""


@pytest.fixture(params=BOTH, ids=("alone", "command"))
def start(request: pytest.FixtureRequest) -> tuple[str, ...]:
    """How the checker is started."""
    return tuple(request.param)


@POSIX
@pytest.mark.parametrize("end", [">/dev/full", ">&-", ">/dev/full 2>/dev/full"])
@pytest.mark.parametrize("arguments", ["fixed.json valid.json", "--json invalid.json"])
def test_verdicts_that_cannot_be_written_end_with_74(
    hostile: Path, start: Sequence[str], end: str, arguments: str
) -> None:
    shell = f"{sys.executable} {' '.join(start)} {arguments} {end}; echo $? >status"
    done = subprocess.run(
        ["sh", "-c", shell], cwd=hostile, capture_output=True, text=True, timeout=PATIENCE
    )
    assert (hostile / "status").read_text() == "74\n"
    assert "Traceback" not in done.stderr and "Exception ignored" not in done.stderr
    assert len(done.stderr.splitlines()) == ("2>" not in end)


@POSIX
@pytest.mark.parametrize("arguments", [("fixed.json", "valid.json"), ("--json", "invalid.json")])
def test_a_pipe_that_nobody_reads_ends_with_74(
    hostile: Path, start: Sequence[str], arguments: Sequence[str]
) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    command = [sys.executable, *start, *arguments]
    done = subprocess.run(
        command, cwd=hostile, stdout=writer, stderr=subprocess.PIPE, timeout=PATIENCE
    )
    os.close(writer)
    assert (done.returncode, done.stderr) == (74, b"")


@POSIX
def test_help_that_cannot_be_written_ends_with_74(hostile: Path) -> None:
    shell = f"{sys.executable} -I checker.pyz --help >/dev/full; echo $?"
    done = subprocess.run(["sh", "-c", shell], cwd=hostile, capture_output=True, text=True)
    assert done.stdout == "74\n" and len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize("name", ["bytes", "digits", "depth", "memory"])
def test_limits_are_integers_from_1_on(hostile: Path, start: Sequence[str], name: str) -> None:
    for wrong in ("0", "-1", "1.5", "x", ""):
        done = run(hostile, *start, "valid.json", f"--max-{name}", wrong)
        assert (done.returncode, done.stdout) == (2, ""), wrong
    done = run(hostile, *start, "valid.json", f"--max-{name}", str(10**15))
    assert (done.returncode, done.stdout[:5]) == (0, "VALID"), done.stderr


def test_a_time_limit_is_a_number_above_0(hostile: Path, start: Sequence[str]) -> None:
    for wrong in ("0", "-1", "nan", "inf", "x"):
        assert run(hostile, *start, "valid.json", "--timeout", wrong).returncode == 2
    for good in ("1e9", "1e300"):
        assert run(hostile, *start, "valid.json", "--timeout", good).returncode == 0


def test_standard_input_is_read_once(hostile: Path, start: Sequence[str]) -> None:
    for twice in (["-", "-"], ["-", "--system", "-"]):
        done = run(hostile, *start, *twice)
        assert (done.returncode, done.stdout) == (2, "")
        assert says(done.stderr, "standard once")


@POSIX
def test_a_closed_standard_input_is_unreadable(hostile: Path, start: Sequence[str]) -> None:
    shell = f"{sys.executable} {' '.join(start)} - <&-; echo $?"
    done = subprocess.run(["sh", "-c", shell], cwd=hostile, capture_output=True, text=True)
    assert worded(done.stdout)


@POSIX
def test_a_fifo_that_nobody_writes_to_obeys_the_time_limit(
    hostile: Path, start: Sequence[str]
) -> None:
    fifo = hostile / "fifo"
    if not fifo.exists():
        os.mkfifo(fifo)
    done = run(hostile, *start, "valid.json", "fifo", "fixed.json", "--timeout", "2")
    lines = done.stdout.splitlines()
    files = ("valid.json", "fifo", "fixed.json")
    why = "time checker: not decided after 2 s (--timeout allows more)"
    late = [f"INCOMPLETE '{name}' {why}" for name in files]
    # On a busy machine there may be no time for the first file, either.
    assert lines[1:] == late[1:] and (lines[0] == late[0] or lines[0].startswith("VALID"))
    assert (done.returncode, done.stderr) == (5, "")
    asked = run(hostile, *start, "valid.json", "--system", "fifo", "--timeout", "0.3")
    assert (asked.returncode, asked.stdout) == (5, "")
    assert "not decided after 0.3 s" in asked.stderr and len(asked.stderr.splitlines()) == 1


@pytest.mark.skipif(sys.platform != "linux", reason="needs the size of the process")
def test_memory_that_runs_out_is_incomplete(hostile: Path, start: Sequence[str]) -> None:
    large = changed(FREE, ("comment", "x" * (50 << 20)))
    (hostile / "large.json").write_text(json.dumps(large))
    done = run(hostile, *start, "large.json", "valid.json", "--max-memory", "30")
    first, second = done.stdout.splitlines()
    assert first.startswith("INCOMPLETE 'large.json' memory ") and second.startswith("VALID ")
    assert (done.returncode, done.stderr) == (5, "")


def test_a_rule_that_exhausts_the_memory_is_incomplete(monkeypatch: pytest.MonkeyPatch) -> None:
    from mcexact.checker import kinds

    def greedy() -> kinds.Verdict:
        raise MemoryError

    verdict = kinds.attempt(greedy)
    assert (verdict.verdict, verdict.code, verdict.status) == ("INCOMPLETE", "memory", 5)


@POSIX
def test_an_interruption_ends_with_130(hostile: Path, start: Sequence[str]) -> None:
    fifo = hostile / "other"
    if not fifo.exists():
        os.mkfifo(fifo)
    # In a background job the signal is ignored, and a process would inherit that.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        process = subprocess.Popen(
            [sys.executable, *start, "valid.json", "other"],
            cwd=hostile,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
    finally:
        signal.signal(signal.SIGINT, before)
    assert process.stdout is not None
    assert process.stdout.readline().startswith("VALID ")
    while process.poll() is None:
        process.send_signal(signal.SIGINT)
        time.sleep(0.5)
    _, errors = process.communicate(timeout=PATIENCE)
    assert process.returncode == 130
    assert "Traceback" not in errors


def test_what_is_no_readable_file_is_named_in_one_line(hostile: Path, start: Sequence[str]) -> None:
    (hostile / "empty").mkdir(exist_ok=True)
    done = run(hostile, *start, "empty", "missing.json", "a\nb\x1b[31m")
    assert done.returncode == 3
    lines = done.stdout.splitlines()
    names = ("'empty'", "'missing.json'", r"'a\nb\x1b[31m'")
    assert [line.split()[:3] for line in lines] == [
        ["MALFORMED", name, "unreadable"] for name in names
    ]
    assert done.stdout.replace("\n", "").isprintable() and done.stdout.isascii()
    asked = run(hostile, *start, "valid.json", "--system", "a\nb\x1b[31m")
    assert (asked.returncode, len(asked.stderr.splitlines())) == (3, 1)
    assert asked.stderr.strip().isprintable()
