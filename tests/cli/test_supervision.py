"""Long work can be limited and interrupted at any moment, also inside compiled code."""

import contextlib
import multiprocessing
import os
import signal
import subprocess
import sys

import pytest

from mcexact.cli import supervision
from mcexact.cli.supervision import supervised
from mcexact.errors import Impossible, InputError, InternalError, LimitReached
from mcexact.sweeps.workers import alone, process_context
from tests.end_to_end.command_line import interruptible


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
    with pytest.raises(LimitReached, match=r"time limit of 0\.2 s was reached while dividing"):
        supervised(deaf, 10**9, doing="dividing", timeout=0.2)
    assert multiprocessing.active_children() == []


def test_what_takes_long_is_said_once(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(supervision, "_SHOW_AFTER", 0)
    with pytest.raises(LimitReached):
        supervised(deaf, 10**9, doing="dividing", timeout=0.5)
    assert capsys.readouterr().err == "mcexact: dividing …\n"


@pytest.mark.skipif(sys.platform != "linux", reason="there the limit is defined")
def test_a_memory_limit_is_reached_and_one_that_suffices_is_not() -> None:
    with pytest.raises(LimitReached, match="memory limit of 50 MiB was exhausted while filling"):
        supervised(allocate, 200, doing="filling", max_memory=50)
    assert supervised(allocate, 20, doing="filling", max_memory=50) == 20 << 20


def test_an_interrupt_ends_compiled_code_and_leaves_no_process() -> None:
    listener, begun = os.pipe()
    script = (
        "from mcexact.cli.supervision import supervised\n"
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


def test_where_a_fork_is_unsafe_processes_start_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    assert process_context().get_start_method() == "fork"
    monkeypatch.setattr(sys, "platform", "darwin")
    assert process_context().get_start_method() == "spawn"
    assert supervised(os.getppid, doing="asking") == os.getpid()
    assert supervised(str, 10**5000, doing="writing") == "1" + "0" * 5000


def test_a_pool_of_processes_starts_anew_there_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "darwin")
    assert alone(os.getppid) == os.getpid()
