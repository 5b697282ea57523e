"""Limits on the time and the memory of a run, in the process that runs the tests."""

from __future__ import annotations

import builtins
import resource
import signal
from collections.abc import Iterator
from typing import Any

import pytest

from mcexact.checker.kinds import AGAIN, Clock, OutOfTime, Verdict, memory

ABOUT = {"file": "a.json"}


def rung(seconds: float = 1.0) -> Clock:
    """A clock whose time is over."""
    clock = Clock(seconds)
    clock._ring(signal.SIGALRM, None)
    return clock


def verdicts(*words: str) -> Iterator[tuple[dict[str, str], Verdict]]:
    yield from ((ABOUT, Verdict(word)) for word in words)


def told(clock: Clock, *words: str) -> list[str]:
    return [verdict.verdict for _, verdict in clock.limited(verdicts(*words), ABOUT)]


def test_without_a_limit_nothing_is_set() -> None:
    before = signal.getsignal(signal.SIGALRM)
    clock = Clock()
    with clock.running():
        assert signal.getsignal(signal.SIGALRM) is before
        assert signal.getitimer(signal.ITIMER_REAL) == (0, 0)
        assert told(clock, "VALID", "INVALID") == ["VALID", "INVALID"]


@pytest.mark.parametrize("seconds", [900.0, 1e300])
def test_an_alarm_is_set_and_taken_back(seconds: float) -> None:
    before = signal.getsignal(signal.SIGALRM)
    clock = Clock(seconds)
    with clock.running():
        assert signal.getsignal(signal.SIGALRM) == clock._ring
        left, again = signal.getitimer(signal.ITIMER_REAL)
        assert 0 < left <= min(seconds, 1e9)
        assert again > 0  # an alarm that a callback swallows must not be the last
    assert signal.getsignal(signal.SIGALRM) is before
    assert signal.getitimer(signal.ITIMER_REAL) == (0, 0)


def test_it_is_taken_back_after_an_error() -> None:
    before = signal.getsignal(signal.SIGALRM)
    with pytest.raises(ZeroDivisionError), Clock(900.0).running():
        raise ZeroDivisionError
    assert signal.getsignal(signal.SIGALRM) is before
    assert signal.getitimer(signal.ITIMER_REAL) == (0, 0)


def test_work_is_interrupted_and_what_is_done_between_is_not() -> None:
    clock = Clock(1.0)
    assert clock.within(lambda: 7) == 7
    clock._ring(signal.SIGALRM, None)  # no work is under way: only noted
    with pytest.raises(OutOfTime):
        clock.within(lambda: 7)
    clock = Clock(1.0)
    with pytest.raises(OutOfTime):
        clock.within(lambda: clock._ring(signal.SIGALRM, None))
    clock._ring(signal.SIGALRM, None)


def test_no_handler_of_errors_takes_the_end_of_time_for_one() -> None:
    assert not issubclass(OutOfTime, Exception)


def test_what_was_decided_is_told_and_then_that_time_is_over() -> None:
    assert told(Clock(1.0), "VALID", "INVALID") == ["VALID", "INVALID"]
    assert told(Clock(1.0)) == []
    assert told(rung(), "VALID") == ["INCOMPLETE"]
    clock = Clock(2.5)
    found = []
    for about, verdict in clock.limited(verdicts("VALID", "INVALID"), ABOUT):
        assert about == ABOUT
        found.append(verdict)
        clock._ring(signal.SIGALRM, None)
    assert [verdict.verdict for verdict in found] == ["VALID", "INCOMPLETE"]
    assert (found[1].code, found[1].status) == ("time", 5)
    assert "2.5 s" in found[1].message


def test_a_limit_on_memory_is_above_what_is_occupied_and_taken_back() -> None:
    before = resource.getrlimit(resource.RLIMIT_AS)
    with memory(None):
        assert resource.getrlimit(resource.RLIMIT_AS) == before
    with memory(10**6):
        most, hard = resource.getrlimit(resource.RLIMIT_AS)
        assert hard == before[1]
        assert most >= 10**6 * 2**20 or most == hard
    assert resource.getrlimit(resource.RLIMIT_AS) == before
    with pytest.raises(ZeroDivisionError), memory(10**6):
        raise ZeroDivisionError
    assert resource.getrlimit(resource.RLIMIT_AS) == before


def status(monkeypatch: pytest.MonkeyPatch, pages: Any) -> None:
    """Let the system say how many pages the process occupies from a file."""
    opened = builtins.open

    def open_other(path: Any, *arguments: Any, **options: Any) -> Any:
        return opened(pages if path == "/proc/self/statm" else path, *arguments, **options)

    monkeypatch.setattr(builtins, "open", open_other)


@pytest.mark.parametrize("infinity", [-1, 2**63 - 1])
def test_memory_is_added_to_what_the_system_says_is_occupied(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Any, infinity: int
) -> None:
    """No limit is a number below all others on some platforms, and above them on others."""
    monkeypatch.setattr(resource, "RLIM_INFINITY", infinity)
    calls: list[tuple[int, int]] = []
    monkeypatch.setattr(resource, "setrlimit", lambda which, limits: calls.append(limits))
    monkeypatch.setattr(resource, "getpagesize", lambda: 7)
    status(monkeypatch, tmp_path / "statm")
    (tmp_path / "statm").write_text("5 4 3 0 0 2 0\n")
    for hard, mebibytes, most in (
        (infinity, 3, 35 + 3 * 2**20),
        (infinity, 10**30, 2**62),
        (2**20, 3, 2**20),
        (2**40, 3, 35 + 3 * 2**20),
    ):
        monkeypatch.setattr(resource, "getrlimit", lambda which, hard=hard: (9, hard))
        with memory(mebibytes):
            assert calls.pop() == (most, hard)
        assert calls.pop() == (9, hard)
    (tmp_path / "statm").unlink()
    with memory(1):
        assert calls.pop() == (2**20, 2**40)


def test_an_alarm_that_is_lost_comes_again_soon() -> None:
    assert 0 < AGAIN <= 0.1
