"""Long work can be limited and interrupted at any moment, also inside compiled code."""

import contextlib
import multiprocessing
import os
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest

from mcexact import processes
from mcexact.cli import running
from mcexact.cli.running import Known, Reporting, Run, supervised, undecided_error
from mcexact.errors import Impossible, InputError, InternalError, LimitReached
from mcexact.processes import may_fork
from tests.end_to_end.command_line import interruptible
from tests.wording import refusal, says, worded


def deaf(digits: int, begun: int | None = None) -> int:
    """One call of compiled code that listens to no signal, for hours; said to have begun."""
    if begun is not None:
        os.write(begun, b"begun\n")
    return (10**digits) // (3**digits)


def double(number: int) -> int:
    return 2 * number


def refuse(certificate: str) -> None:
    raise Impossible("there is none", certificate, where="plant.json")


def stumble() -> None:
    raise KeyError("surprise")


def read_badly() -> None:
    raise InputError("expected 4 rows, found 3", where="channels[2].B")


def allocate(mebibytes: int) -> int:
    return len(bytearray(mebibytes << 20))


def abort() -> None:
    os.abort()


def test_the_result_comes_back() -> None:
    assert supervised(double, 21, doing="doubling") == 42


def test_an_error_comes_back_with_what_it_carries() -> None:
    with pytest.raises(Impossible, match=r"plant\.json: there is none") as caught:
        supervised(refuse, "why", doing="refusing")
    assert caught.value.certificate == "why"
    with pytest.raises(InputError, match=r"channels\[2\]\.B: expected 4 rows, found 3"):
        supervised(read_badly, doing="reading")


def test_an_error_that_was_not_intended_is_an_internal_error() -> None:
    with pytest.raises(InternalError, match=r"KeyError.*surprise.*test_supervision"):
        supervised(stumble, doing="stumbling")


def test_compiled_code_that_aborts_is_an_internal_error() -> None:
    with pytest.raises(InternalError, match="while aborting"):
        supervised(abort, doing="aborting")


def test_a_time_limit_ends_compiled_code() -> None:
    with refusal(LimitReached, quantity="0.2 s"):
        supervised(deaf, 10**9, doing="dividing", timeout=0.2)
    assert multiprocessing.active_children() == []


def test_what_takes_long_is_said_once(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(running, "_SHOW_AFTER", 0)
    with pytest.raises(LimitReached):
        supervised(deaf, 10**9, doing="dividing", timeout=0.5)
    assert capsys.readouterr().err == "mcexact: dividing …\n"


@pytest.mark.skipif(sys.platform != "linux", reason="there the limit is defined")
def test_a_memory_limit_is_reached_and_one_that_suffices_is_not() -> None:
    with refusal(LimitReached, quantity="50 MiB"):
        supervised(allocate, 200, doing="filling", max_memory=50)
    assert supervised(allocate, 20, doing="filling", max_memory=50) == 20 << 20


def test_an_interrupt_ends_compiled_code_and_leaves_no_process() -> None:
    listener, begun = os.pipe()
    script = (
        "from mcexact.cli.running import supervised\n"
        "from tests.cli.test_supervision import deaf\n"
        f"supervised(deaf, 10**9, {begun}, doing='dividing')\n"
    )
    with (
        open(listener, "rb") as told,
        subprocess.Popen(
            [sys.executable, "-c", script],
            stderr=subprocess.DEVNULL,
            preexec_fn=interruptible,
            pass_fds=[begun],
        ) as process,
    ):
        os.close(begun)
        assert told.readline() == b"begun\n"
        while process.poll() is None:
            # One that comes while a callback runs is ignored by Python, as on a busy machine.
            process.send_signal(signal.SIGINT)
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(timeout=1)
        assert process.returncode == -signal.SIGINT
        assert told.read() == b"", "it ends when no process holds the other end"


def test_a_process_with_threads_is_not_forked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(processes, "may_fork", may_fork)
    assert supervised(os.getppid, doing="asking") == os.getpid()
    with ThreadPoolExecutor(1) as threads:
        threads.submit(int).result()
        assert not may_fork()
        assert supervised(os.getppid, doing="asking") == os.getpid()
        assert supervised(str, 10**5000, doing="writing") == "1" + "0" * 5000
        with refusal(LimitReached, quantity="9 s"):
            supervised(deaf, 10**9, doing="dividing", timeout=9)


def test_a_new_interpreter_does_not_run_the_main_script_again() -> None:
    """A script without a main guard, whose functions a new interpreter does not know."""
    script = (
        "import os, sys, threading\n"
        "print('begun', flush=True)\n"
        "threading.Thread(target=threading.Event().wait, daemon=True).start()\n"
        "from mcexact.sweeps.workers import alone\n"
        "assert alone(os.getppid) == os.getpid()\n"
        "def own():\n"
        "    return 1\n"
        "try:\n"
        "    alone(own)\n"
        "except ValueError as error:\n"
        "    print(error)\n"
    )
    for how in (["-c", script], ["-W", "error", "-"]):
        done = subprocess.run(
            [sys.executable, *how],
            input=script,
            capture_output=True,
            text=True,
            check=True,
        )
        first, second = done.stdout.splitlines()
        assert (first, done.stderr) == ("begun", "") and says(second, "own defined")


def half_done(known: Known, *, report: Reporting) -> dict[str, Any]:
    """Decide one thing at once, and then one that never ends."""
    if not known.ended:
        report.keep("first", b"1")
        report.begin("second", "1 of 2 decided")
        deaf(10**9)
    return {"parts": known.parts, "ended": known.ended}


def hungry(known: Known, *, report: Reporting) -> dict[str, Any]:
    """Decide three things, of which the second needs too much memory."""
    for name in ("first", "second", "third"):
        if name not in known.parts and name not in known.lost:
            report.begin(name, name)
            allocate(200 if name == "second" else 1)
            report.keep(name, b"1")
    return {"parts": set(known.parts), "lost": known.lost}


def run_with(**limits: Any) -> Run:
    return Run({"timeout": None, "max_memory": None} | limits)


def test_what_was_decided_before_a_time_limit_is_not_lost() -> None:
    result, ended = run_with(timeout=3.0).result_in_parts(half_done, doing="working")
    assert result["parts"] == {"first": b"1"}
    assert worded(result["ended"]) and "3 s" in result["ended"]
    error = undecided_error(ended, {result["ended"]: ["second"]}, "working")
    assert error is not None and error.exit_status == 4 and "not decided: second" in str(error)
    error = undecided_error(KeyboardInterrupt(), {}, "working")
    assert error is not None and error.exit_status == 130
    assert undecided_error(None, {}, "working") is None


@pytest.mark.skipif(sys.platform != "linux", reason="there the limit is defined")
def test_what_needs_too_much_memory_costs_only_itself() -> None:
    result, ended = run_with(max_memory=100).result_in_parts(hungry, doing="working")
    assert result["parts"] == {"first"}
    assert [*result["lost"]] == ["second"]
    assert worded(result["lost"]["second"]) and "100 MiB" in result["lost"]["second"]
    assert isinstance(ended, LimitReached)


def test_an_error_ends_the_work_even_if_something_was_decided() -> None:
    with pytest.raises(InternalError):
        run_with().result_in_parts(fails_late, doing="working")


def fails_late(known: Known, *, report: Reporting) -> None:
    report.keep("first", b"1")
    stumble()


def test_the_line_of_a_narrow_terminal_keeps_the_step_and_the_seconds(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", "60")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    shown = running._Progress("analyzing /a/very/long/path/to/some/plant.json")
    shown.show(12, "1/9 " * 7)
    line = capsys.readouterr().err.removeprefix(running._CLEAR)
    assert len(line) == 59 and line.startswith("analy")
    assert line.endswith(f"plant.json, {'1/9 ' * 7}, 12 s")
    shown.show(13, "1/9 " * 20)
    line = capsys.readouterr().err.removeprefix(running._CLEAR)
    assert len(line) == 59 and line.endswith("1/9 , 13 s")
