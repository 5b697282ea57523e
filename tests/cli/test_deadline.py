"""A time limit holds over everything that a command does, also while it waits for its input."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import pytest

from mcexact.cli.files import Deadline
from mcexact.errors import LimitReached
from mcexact.model.files import save_system
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import system_text
from tests.cli.calling import call
from tests.end_to_end.command_line import MCEXACT, interruptible, run
from tests.wording import says

PLANT = MultiChannelSystem([[1]], [[[1]]], [[[1]]])

pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")


@pytest.fixture
def pipe(tmp_path: Path) -> str:
    """A named pipe that nobody writes to."""
    path = tmp_path / "pipe.json"
    os.mkfifo(path)
    return str(path)


@pytest.fixture
def plant(tmp_path: Path) -> str:
    path = tmp_path / "plant.json"
    save_system(PLANT, path)
    return str(path)


@pytest.mark.parametrize(
    "arguments",
    [
        ("analyze", "PIPE"),
        ("allocate", "PIPE"),
        ("crosscheck", "PIPE"),
        ("certify", "PLANT", "PIPE"),
        ("simulate", "PLANT", "PIPE"),
        ("design", "decentralized", "PLANT", "--rate=1", "--spectrum", "PIPE"),
        ("design", "observer", "PIPE", "--rate=1"),
        ("sweep", "PIPE"),
    ],
)
def test_a_pipe_without_a_writer_is_waited_for_until_the_time_limit(
    pipe: str, plant: str, arguments: tuple[str, ...]
) -> None:
    named = [{"PIPE": pipe, "PLANT": plant}.get(each, each) for each in arguments]
    done = run(*named, "--timeout", "0.5", "--json")
    assert done.status == 4
    said = done.stdout if "sweep" in arguments else done.stderr
    # A busy machine can still be at the file before the pipe when the time is over.
    read = [path for path in named if path in (pipe, plant)]
    assert says(said, "limit") and "0.5 s" in said
    assert any(f" while reading {path}" in said for path in read)


def test_a_pipe_with_a_writer_is_read(pipe: str) -> None:
    def write() -> None:
        Path(pipe).write_text(system_text(PLANT), encoding="utf-8")

    writer = threading.Thread(target=write)
    writer.start()
    done = run("analyze", pipe, "--timeout", "60", "--json")
    writer.join()
    assert done.status == 0, done.stderr


def test_standard_input_that_never_ends_is_read_until_the_time_limit() -> None:
    ours, theirs = os.pipe()
    try:
        done = subprocess.run(
            [*MCEXACT, "analyze", "-", "--timeout", "0.5"],
            stdin=ours,
            capture_output=True,
            check=False,
        )
    finally:
        os.close(ours)
        os.close(theirs)
    assert done.returncode == 4
    assert b"while reading standard input" in done.stderr


def test_an_interrupt_ends_the_waiting_for_a_pipe(pipe: str) -> None:
    script = (
        f"from mcexact.cli import main\nprint('ready', flush=True)\nmain(['analyze', {pipe!r}])\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", script],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        preexec_fn=interruptible,
    ) as process:
        assert process.stdout is not None
        process.stdout.readline()
        while process.poll() is None:
            process.send_signal(signal.SIGINT)
            try:
                process.wait(timeout=1)
            except subprocess.TimeoutExpired:
                continue
        # The second where the interrupt comes before the program listens for one.
        assert process.returncode in (130, -signal.SIGINT)


def test_a_deadline_that_is_over_is_missed_at_once() -> None:
    deadline = Deadline(1e-9)
    while deadline.left():
        pass
    with pytest.raises(LimitReached, match="while reading"), deadline.interrupting("reading"):
        pytest.fail("nothing should be begun")


def test_without_a_limit_nothing_is_interrupted() -> None:
    before = signal.getsignal(signal.SIGALRM)
    with Deadline(None).interrupting("reading"):
        assert signal.getsignal(signal.SIGALRM) is before
    assert Deadline(None).left() is None


def test_what_is_done_in_time_leaves_no_alarm_behind() -> None:
    before = signal.getsignal(signal.SIGALRM)
    with Deadline(3600).interrupting("reading"):
        assert signal.getitimer(signal.ITIMER_REAL)[0] > 0
    assert signal.getitimer(signal.ITIMER_REAL)[0] == 0
    assert signal.getsignal(signal.SIGALRM) is before


INDICES = "mcexact.analysis.controllability.controllability_indices"
LIMITED = ("analyze", "gallery:hidden-triple-mode", "--timeout", "6")


def endless(*_: Any, **__: Any) -> None:
    time.sleep(10**6)


def test_a_limit_shows_writes_and_checks_what_was_decided(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(INDICES, endless)
    folder, page = tmp_path / "evidence", tmp_path / "page.html"
    status, out, err = call(*LIMITED, "--json", "--certificates", str(folder), "--html", str(page))
    told = json.loads(out)
    left = {each["question"] for each in told["questions"] if each["outcome"] == "open"}
    assert (status, left) == (4, {"controllability_indices", "observability_indices"})
    assert told["fixed_spectrum"]["polynomial"] == [-1, 1]
    assert not any(told[name]["decided"] for name in left)
    assert told["re_checked"] == {"valid": 10, "open": []}
    assert len([*folder.iterdir()]) == 11 and page.exists()
    assert "not decided: controllability indices, observability indices" in err
    assert call("check", "--manifest", str(folder))[0] == 0


def test_an_answer_that_was_decided_counts_more_than_a_limit(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(INDICES, endless)
    assert call(*LIMITED, "--assert", "no-fixed-modes")[0] == 1


def test_a_limit_keeps_answers_about_parameters_and_names_a_search_that_it_ended(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    plant = "gallery:liu2020-3ch-parametric-a11"
    with monkeypatch.context() as patched:
        patched.setattr("mcexact.analysis.structure.setpoint_solvability", endless)
        status, out, err = call("analyze", plant, "--timeout", "6", "--json")
    told = json.loads(out)
    left = {each["question"] for each in told["questions"] if each["outcome"] == "open"}
    # The indices are asked last, since a limit shall not discard others for them.
    assert (status, left) == (4, {"setpoint", "controllability_indices", "observability_indices"})
    assert "generic" in told["fixed_spectrum"] and "not decided: " in err
    monkeypatch.setattr("mcexact.analysis.boxes.largest.largest_uncertainty", endless)
    status, _, err = call(*LIMITED, "--largest-uncertainty")
    assert status == 4 and says(err, "undecided")
