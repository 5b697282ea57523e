"""The checker's own command line, run as a stranger would: copied away, standard library only."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from mcexact import checker
from mcexact.checker.core.system import digest, read_plant
from tests.checker.handmade import FIXED, FREE, PAPER, changed, checked
from tests.checker.manifests import EVIDENCE, SENTENCES, digest_of, write
from tests.effort import PATIENCE

ENVIRONMENTS = [
    {},
    {"LANG": "C", "LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"},
    {"PYTHONINTMAXSTRDIGITS": "0"},
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder that holds a copy of the checker and some certificates."""
    target = tmp_path_factory.mktemp("elsewhere")
    shutil.copytree(
        Path(checker.__file__).parent,
        target / "checker",
        ignore=shutil.ignore_patterns("__pycache__"),
    )
    documents = {
        "valid": FREE,
        "fixed": FIXED,
        "invalid": changed(FREE, ("witness.gains.0.entries", [[0]])),
        "malformed": changed(FREE, ("verified", True)),
        "incomplete": changed(FREE, ("kind", "is_nice")),
        "accented": changed(
            FREE, ("system.channels.0.name", "\u00e9\u2192"), ("kind", "controllability")
        ),
        "system": {"format": "mcexact-system/1", "name": "paper", **PAPER},
        "other": {"format": "mcexact-system/1", **PAPER, "A": [[0.1, 0, 0]] * 3},
    }
    for name, document in documents.items():
        (target / f"{name}.json").write_text(json.dumps(document), encoding="utf-8")
    return target


def run(
    folder: Path, *arguments: str, start: Sequence[str] = ("-m", "checker"), **environment: str
) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-S", "-E", *start, *arguments],
        cwd=folder,
        env={"PATH": os.environ.get("PATH", ""), **environment},
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
        timeout=PATIENCE,
    )


@pytest.mark.parametrize("start", [("-m", "checker"), ("checker",), ("-O", "checker")])
def test_the_folder_runs_by_itself(folder: Path, start: Sequence[str]) -> None:
    done = run(folder, "fixed.json", "--statements", start=start)
    statement = checked(FIXED).statement
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == (f"VALID {hashlib.sha256(statement.encode()).hexdigest()} {statement}\n")


@pytest.mark.parametrize("environment", ENVIRONMENTS, ids=str)
def test_neither_locale_nor_settings_matter(folder: Path, environment: dict[str, str]) -> None:
    files = ["valid.json", "accented.json", "fixed.json"]
    done = run(folder, *files, start=("-O", "-m", "checker"), **environment)
    assert done.stderr == ""
    assert [line.split()[0] for line in done.stdout.splitlines()] == ["VALID", "MALFORMED", "VALID"]


@pytest.mark.parametrize(
    ("files", "status"),
    [
        (["valid", "fixed"], 0),
        (["invalid"], 1),
        (["malformed"], 3),
        (["incomplete"], 5),
        (["missing"], 3),
        (["valid", "invalid", "fixed"], 1),
        (["incomplete", "invalid"], 1),
        (["invalid", "malformed", "incomplete"], 3),
        (["incomplete", "valid"], 5),
    ],
)
def test_the_exit_status_is_the_worst_of_all_files(
    folder: Path, files: list[str], status: int
) -> None:
    done = run(folder, *(f"{name}.json" for name in files))
    assert done.returncode == status
    assert len(done.stdout.splitlines()) == len(files)
    assert "Traceback" not in done.stdout + done.stderr


def test_a_folder_or_a_missing_file_is_unreadable(folder: Path) -> None:
    (folder / "empty").mkdir(exist_ok=True)
    done = run(folder, "empty", "missing.json", "a\x01b")
    assert done.returncode == 3
    assert [line.split()[:4] for line in done.stdout.splitlines()] == [
        ["MALFORMED", name, "unreadable", "file:"]
        for name in ("'empty'", "'missing.json'", r"'a\x01b'")
    ]


def test_arguments_and_names_are_shown_without_characters_that_do_not_print(folder: Path) -> None:
    for option in ("--\x1b[31mx", "--m\u00e4rk", "--max-bytes=\x07"):
        done = run(folder, "valid.json", option)
        assert done.returncode == 2
        assert done.stderr.replace("\n", "").isprintable() and done.stderr.isascii()
    name = "\x1b[31m\u00e4'.json"
    (folder / name).write_text(json.dumps(FREE), encoding="ascii")
    done = run(folder, "--", name, "valid.json", name)
    (folder / name).unlink()
    assert [line.split()[1] for line in done.stdout.splitlines()] == [
        r""""\x1b[31m\xe4'.json":""",
        "'valid.json':",
        r""""\x1b[31m\xe4'.json":""",
    ]
    assert done.stdout.replace("\n", "").isprintable() and done.stdout.isascii()


def test_a_closed_standard_error_leaves_standard_output_to_verdicts(folder: Path) -> None:
    command = "exec 2>&-; " + '"$0" -S -E -m checker valid.json --system missing.json'
    done = subprocess.run(
        ["sh", "-c", command, sys.executable],
        cwd=folder,
        capture_output=True,
        check=False,
        timeout=PATIENCE,
    )
    assert (done.returncode, done.stdout, done.stderr) == (3, b"", b"")


def test_wrong_usage_ends_with_2(folder: Path) -> None:
    assert run(folder).returncode == 2
    assert run(folder, "valid.json", "--sytem", "system.json").returncode == 2
    assert run(folder, "valid.json", "--max-bytes", "many").returncode == 2


def test_the_system_can_be_insisted_on(folder: Path) -> None:
    assert run(folder, "fixed.json", "--system", "system.json").returncode == 0
    other = run(folder, "fixed.json", "--system", "other.json")
    assert other.returncode == 1
    assert other.stdout.startswith("NOT ABOUT system system: about another system, of digest ")
    for wrong in ("fixed.json", "missing.json"):
        refused = run(folder, "fixed.json", "--system", wrong)
        assert (refused.returncode, refused.stdout) == (3, "")
        assert len(refused.stderr.splitlines()) == 1


def test_json_says_the_same(folder: Path) -> None:
    done = run(folder, "--json", "fixed.json", "invalid.json")
    assert done.returncode == 1
    first, second = json.loads(done.stdout)["verdicts"]
    assert (first["file"], first["verdict"]) == ("fixed.json", "VALID")
    assert first["system_digest"] == digest(read_plant(PAPER))
    assert first["statement"] == checked(FIXED).statement
    digested = hashlib.sha256(first["statement"].encode()).hexdigest()
    assert (first["statement_digest"], first["controller_digest"]) == (digested, "")
    assert (second["verdict"], second["code"]) == ("INVALID", "common_factor")
    assert second["statement"] == second["statement_digest"] == ""


def test_a_manifest_is_checked_beside_files_or_alone(folder: Path) -> None:
    (folder / "evidence").mkdir(exist_ok=True)
    write(folder / "evidence")
    done = run(folder, "--manifest", "evidence", "--system", "system.json")
    assert (done.returncode, done.stderr) == (0, "")
    *lines, counted = done.stdout.splitlines()
    assert len(lines) == len(EVIDENCE) + len(SENTENCES)
    counts, digest = counted.rsplit("; ", 1)
    assert counts == (
        f"COUNTED 'evidence' {len(SENTENCES)} sentences implied, 0 not, 0 remarks; "
        f"{len(EVIDENCE)} certificates valid, 0 not"
    )
    assert digest.split()[-1] == digest_of(folder / "evidence" / "manifest.json")
    words = [line.split()[0] for line in lines]
    assert words == ["VALID"] * len(EVIDENCE) + ["IMPLIED"] * len(SENTENCES)
    both = run(folder, "fixed.json", "--manifest", "evidence/manifest.json", "--json")
    found = json.loads(both.stdout)["verdicts"]
    assert [row["verdict"] for row in found] == [
        *["VALID"] * (1 + len(EVIDENCE)),
        *["IMPLIED"] * len(SENTENCES),
        "COUNTED",
    ]
    texts = [row["text"] for row in found if "text" in row]
    assert texts == [each["text"] for each in SENTENCES]
    other = run(folder, "--manifest", "evidence", "--system", "other.json")
    assert other.returncode == 1
    absent = run(folder, "--manifest", "nowhere")
    assert absent.returncode == 3
    named = run(folder, "--manifest", "nowhere", "fixed.json").stdout.splitlines()[1]
    assert named.startswith("MALFORMED 'nowhere' unreadable file: ")
    nothing = "COUNTED 'nowhere' 0 sentences implied, 0 not, 0 remarks; 0 certificates valid, 0 not"
    assert absent.stdout.splitlines()[1].startswith(nothing)  # a manifest is no certificate
    files = [f"evidence/{path.name}" for path in (folder / "evidence").iterdir()]
    words = [line.split()[0] for line in run(folder, *files).stdout.splitlines()]
    assert (words.count("VALID"), words.count("IMPLIED")) == (len(EVIDENCE), len(SENTENCES))


def test_standard_input_is_a_file_as_well(folder: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-S", "-E", "-m", "checker", "-"],
        cwd=folder,
        input=json.dumps(FREE).encode(),
        capture_output=True,
        check=False,
        timeout=PATIENCE,
    )
    assert done.returncode == 0
    assert done.stdout.decode() == f"VALID {checked(FREE).summary}\n"


def test_limits_can_be_adjusted(folder: Path) -> None:
    small = run(folder, "fixed.json", "--max-bytes", "100")
    assert small.returncode == 5 and "(--max-bytes)" in small.stdout
    assert run(folder, "fixed.json", "--max-depth", "3").returncode == 3
    assert run(folder, "fixed.json", "--max-digits", "2").returncode == 5
    assert run(folder, "fixed.json", "--max-digits", "3").returncode == 0
