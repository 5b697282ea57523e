"""A time limit for everything that one command does."""

from __future__ import annotations

import contextlib
import signal
import threading
import time
from collections.abc import Iterator
from types import FrameType

from mcexact.errors import LimitReached

_LEAST_GRACE = 5.0
"""Seconds that it may take at least to show and to re-check what was decided in time."""


class Deadline:
    """A time limit of some seconds from now, or no limit.

    Parameters
    ----------
    seconds : float or None
        None means that there is no limit.
    """

    def __init__(self, seconds: float | None) -> None:
        self.seconds = seconds
        self._start = time.monotonic()
        self._said = seconds

    def left(self) -> float | None:
        """Return the seconds that are left, at least 0; None without a limit."""
        if self.seconds is None:
            return None
        return max(0.0, self.seconds - (time.monotonic() - self._start))

    def with_grace(self) -> Deadline:
        """Return the limit on what follows the decisions: a quarter of the time again, or 5 s."""
        left = self.left()
        if left is None or self.seconds is None:
            return self
        allowed = Deadline(max(left, self.seconds / 4, _LEAST_GRACE))
        allowed._said = self._said
        return allowed

    def missed(self, doing: str) -> LimitReached:
        """Return the error to raise when the time is over."""
        return LimitReached(
            f"the time limit of {self._said:g} s was reached while {doing}; "
            "nothing has been decided (--timeout allows more)"
        )

    @contextlib.contextmanager
    def interrupting(self, doing: str) -> Iterator[None]:
        """Interrupt an operation that waits, such as reading an idle pipe, when the time is over.

        Raises
        ------
        LimitReached
            When the time is over, if the platform has alarms and this is the main thread.
        """
        left = self.left()
        here = threading.current_thread() is threading.main_thread()
        if left is None or not here or not hasattr(signal, "setitimer"):
            yield
            return
        if left == 0:
            raise self.missed(doing)

        def end(number: int, frame: FrameType | None) -> None:
            raise self.missed(doing)

        before = signal.signal(signal.SIGALRM, end)
        signal.setitimer(signal.ITIMER_REAL, left)
        try:
            yield
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)
