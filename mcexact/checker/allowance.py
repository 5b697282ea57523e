"""What a run may take: time, also while it waits for a file, and memory."""

import contextlib
import signal
from collections.abc import Callable, Iterator
from types import FrameType
from typing import TypeVar

from .kinds import Found, Verdict

T = TypeVar("T")

SUPPORTED = hasattr(signal, "setitimer")
"""Whether the platform has alarms, and limits on memory."""
AGAIN = 0.05
"""Seconds between two alarms: the first is lost if Python runs a callback that ignores errors."""


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
        try:
            while (item := self.within(lambda: next(found, None))) is not None:
                yield item
        except OutOfTime:
            yield about, self.verdict()


@contextlib.contextmanager
def memory(mebibytes: int | None) -> Iterator[None]:
    """Limit the memory that may be added to what the process occupies now."""
    if mebibytes is None:
        yield
        return
    import resource

    occupied = 0
    with contextlib.suppress(OSError), open("/proc/self/statm", encoding="ascii") as pages:
        occupied = int(pages.read().split()[0]) * resource.getpagesize()
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    most = min(occupied + mebibytes * 2**20, 2**62 if hard == resource.RLIM_INFINITY else hard)
    resource.setrlimit(resource.RLIMIT_AS, (most, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
