"""What a run may take: time, also while it waits for a file, and memory."""

from __future__ import annotations

import contextlib
import re
import signal
from collections.abc import Callable, Iterator
from types import FrameType
from typing import TypeVar

from .kinds import Verdict

T = TypeVar("T")

AGAIN = 0.05
"""Seconds between two alarms: the first is lost if Python runs a callback that ignores errors."""

Found = tuple[dict[str, str], Verdict]


class OutOfTime(BaseException):
    """The time is over; no handler of errors takes this for one of its own."""


class Clock:
    """A limit on the time of a run.

    Parameters
    ----------
    seconds : float or None
        None means that there is no limit.
    """

    def __init__(self, seconds: float | None = None) -> None:
        self.seconds, self.over, self.armed = seconds, False, False

    @contextlib.contextmanager
    def running(self) -> Iterator[None]:
        """Let the time run."""
        if self.seconds is None:
            yield
            return
        before = signal.signal(signal.SIGALRM, self._ring)
        signal.setitimer(signal.ITIMER_REAL, min(self.seconds, 1e9), AGAIN)
        try:
            yield
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)

    def _ring(self, number: int, frame: FrameType | None) -> None:
        self.over = True
        if self.armed:
            raise OutOfTime

    def within(self, work: Callable[[], T]) -> T:
        """Do some work, which OutOfTime interrupts; it is raised here and nowhere else."""
        try:
            self.armed = True
            if self.over:
                raise OutOfTime
            return work()
        finally:
            self.armed = False

    def verdict(self) -> Verdict:
        """The verdict on what there was no time for."""
        self.armed = False
        message = f"not decided after {self.seconds:g} s (--timeout allows more)"
        return Verdict("INCOMPLETE", code="time", place="checker", message=message)

    def limited(self, found: Iterator[Found], about: dict[str, str]) -> Iterator[Found]:
        """Yield the same verdicts as long as there is time, then an INCOMPLETE one."""
        while True:
            try:
                item = self.within(lambda: next(found, None))
            except OutOfTime:
                yield about, self.verdict()
                return
            if item is None:
                return
            yield item


@contextlib.contextmanager
def memory(mebibytes: int | None) -> Iterator[None]:
    """Limit the memory that may be added to what the process occupies now."""
    if mebibytes is None:
        yield
        return
    import resource

    before = resource.getrlimit(resource.RLIMIT_AS)
    most = _occupied() + mebibytes * 2**20
    if before[1] != resource.RLIM_INFINITY:
        most = min(most, before[1])
    resource.setrlimit(resource.RLIMIT_AS, (min(most, 2**62), before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)


def _occupied() -> int:
    """The bytes of address space that this process occupies; 0 where the system does not say."""
    with contextlib.suppress(OSError), open("/proc/self/status", encoding="ascii") as status:
        found = re.search(r"^VmSize:\s*(\d+) kB$", status.read(), re.MULTILINE)
        return int(found[1]) * 1024 if found else 0
    return 0


def unsupported(seconds: float | None, mebibytes: int | None) -> str:
    """Why this platform cannot keep these limits; empty if it can."""
    if seconds is not None and not hasattr(signal, "setitimer"):
        return "this platform has no alarms: leave out --timeout"
    if mebibytes is not None:
        try:
            import resource  # noqa: F401
        except ImportError:
            return "this platform has no limit on memory: leave out --max-memory"
    return ""
