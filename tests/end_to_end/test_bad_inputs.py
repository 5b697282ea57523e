"""Every bad input ends with its status and one message that says where, what and how to mend it."""

import json
import shlex
import sys
from pathlib import Path
from typing import Any

import pytest

from mcexact.model import gallery
from tests.end_to_end.bad_input_files import arguments
from tests.end_to_end.command_line import Run, run

TABLE = json.loads((Path(__file__).parent / "bad_inputs.json").read_text(encoding="utf-8"))
FRUGAL = ("tests.effort", "200000")
"""The program as a module and its first argument, the steps that it is allowed: it answers a bad
input before any computation."""


@pytest.fixture(scope="module")
def documents(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """The base system and the certificate of its fixed spectrum."""
    folder = tmp_path_factory.mktemp("base")
    file = folder / "system.json"
    file.write_text(json.dumps(TABLE["base_system"]), encoding="utf-8")
    done = run("analyze", str(file), "--certificates", str(folder / "certificates"))
    assert done.status == 0, done.stderr
    made = folder / "certificates" / "fixed_spectrum.json"
    certificate = json.loads(made.read_text(encoding="utf-8"))
    return {"system": TABLE["base_system"], "certificate": certificate, **shared_loop(folder)}


def shared_loop(folder: Path) -> dict[str, Any]:
    """The paper's plant on a ring, with certificates for the least sharing and for a loop."""
    document = json.loads(gallery.text("liu2020-3ch-no-communication"))
    document["neighbors"] = {"1": ["2"], "2": ["3"], "3": ["1"]}
    plant, controller, made = folder / "plant.json", folder / "controller.json", folder / "made"
    plant.write_text(json.dumps(document), encoding="utf-8")
    for argv in (
        ("design", "extended", plant, "--rate", "1", "--effort", "0", "-o", controller),
        ("certify", plant, controller, "--certificates", made),
        ("allocate", plant, "--certificates", made),
    ):
        done = run(*map(str, argv))
        assert done.status == 0, done.stderr
    files = {"loop": "stability", "sharing": "minimal_shared_dimensions"}
    read = {
        name: json.loads((made / f"{stem}.json").read_text(encoding="utf-8"))
        for name, stem in files.items()
    }
    return {"plant": document, **read}


def run_entry(entry: dict[str, Any], found: list[str]) -> Run:
    environment = entry.get("environment", {})
    module, steps = FRUGAL
    command = shlex.join([sys.executable, "-m", module, steps, *found])
    if "shell" in entry:
        command = entry["shell"].format(command=command)
        return run("-c", command, program=["sh"], environment=environment)
    if entry.get("closed_stdin"):
        return run("-c", f"{command} <&-", program=["sh"])
    return run(steps, *found, module=module, environment=environment)


@pytest.mark.parametrize("entry", TABLE["entries"], ids=lambda entry: entry["id"])
def test_bad_input_gets_its_status_and_one_message(
    entry: dict[str, Any], documents: dict[str, Any], tmp_path: Path
) -> None:
    done = run_entry(entry, arguments(entry, tmp_path, documents))
    expected = entry["exit"] if isinstance(entry["exit"], list) else [entry["exit"]]
    assert done.status in expected, done
    assert "Traceback" not in done.stdout + done.stderr
    messages = done.messages
    if entry["argv"][0] == "check":  # whose messages are its verdicts, a line for each file
        messages = [line for line in messages if not line.startswith("mcexact-verified")]
        messages += done.stdout.splitlines()
        assert len(messages) == (2 if entry["id"] == "B211" else 1)
    else:
        assert len(messages) == (1 if done.status in {2, 3, 74} else 0)
    for text in entry["says"]:
        assert text in "\n".join(messages)
    for text in entry.get("prints", ()):
        assert text in done.stdout


def test_no_bad_input_leaves_a_file_behind(documents: dict[str, Any], tmp_path: Path) -> None:
    file = tmp_path / "bad.json"
    file.write_text("{", encoding="utf-8")
    done = run("analyze", str(file), "--certificates", str(tmp_path / "certificates"))
    assert done.status == 3
    assert [path.name for path in tmp_path.iterdir()] == ["bad.json"]


@pytest.mark.skipif(not Path("/dev/stdout").exists(), reason="a file name of Unix")
def test_a_report_can_go_to_a_stream(documents: dict[str, Any], tmp_path: Path) -> None:
    file = tmp_path / "plant.json"
    file.write_text(json.dumps(documents["plant"]), encoding="utf-8")
    done = run("design", "extended", str(file), "--rate", "1", "-o", "/dev/stdout")
    assert done.status == 0, done.stderr
    assert '"format": "mcexact-controller/1"' in done.stdout


def test_figures_need_no_display(tmp_path: Path) -> None:
    """B221."""
    file, page = tmp_path / "plant.json", tmp_path / "page.html"
    file.write_text(gallery.text("hidden-triple-mode"), encoding="utf-8")
    environment = {"DISPLAY": "", "MPLBACKEND": "TkAgg"}
    done = run("analyze", str(file), "--html", str(page), environment=environment)
    assert done.status == 0, done.stderr
    assert "<svg" in page.read_text(encoding="utf-8") or "<img" in page.read_text(encoding="utf-8")


@pytest.mark.skipif(sys.platform != "linux", reason="limits on memory are tested where they are")
def test_a_limit_is_status_4_and_never_a_verdict(tmp_path: Path) -> None:
    drawn = run("sample", "--states", "60", "--channels", "30", "--output", str(tmp_path))
    assert drawn.status == 0, drawn.stderr
    file = str(tmp_path / "sample-0.json")
    for option, value, said in (
        ("--timeout", "0.01", "time limit of 0.01 s"),
        ("--max-memory", "1", "memory limit of 1 MiB"),
    ):
        done = run("analyze", file, option, value, "--certificates", str(tmp_path / "made"))
        assert done.status == 4, done
        assert done.stdout == ""
        (message,) = done.messages
        assert said in message
        assert option in message
        assert not (tmp_path / "made").exists()
