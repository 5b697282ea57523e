"""Worker processes, which may die: a job lost with one is repeated once in a new process."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import sys
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from typing import Any

from mcexact.errors import UsageError

_MOST = 256


class Workers:
    """A given executor, or one that is made when it is needed and replaced when it breaks.

    Parameters
    ----------
    executor : concurrent.futures.Executor, optional
        A given executor is not shut down after the sweep.
    count : int
        The number of processes; for a given executor, half the number of jobs it gets at once.

    Raises
    ------
    UsageError
        If the executor is not an executor, or the count is out of range.
    """

    def __init__(self, executor: Executor | None, count: int) -> None:
        if executor is not None and not isinstance(executor, Executor):
            raise UsageError(
                "expected a concurrent.futures.Executor, found "
                f"{type(executor).__module__.split('.')[0]} {type(executor).__name__}; "
                "a dask client gives one with client.get_executor()"
            )
        if type(count) is not int or not 1 <= count <= _MOST:
            raise UsageError(f"expected 1 to {_MOST} workers, found {count!r}")
        self.count = count
        self._given = executor
        self._own: ProcessPoolExecutor | None = None

    def submit(self, work: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Submit one call.

        Raises
        ------
        BrokenExecutor
            If a given executor has lost its processes.
        """
        if self._given is not None:
            return self._given.submit(work, *arguments)
        if self._own is None:
            self._own = _pool(self.count)
        try:
            return self._own.submit(work, *arguments)
        except BrokenExecutor:
            self.end()
            self._own = _pool(self.count)
            return self._own.submit(work, *arguments)

    def end(self) -> None:
        """End the processes that this team started, even while they work."""
        if self._own is None:
            return
        pool, self._own = self._own, None
        for process in list((getattr(pool, "_processes", None) or {}).values()):
            with contextlib.suppress(Exception):
                process.kill()
        pool.shutdown(wait=True, cancel_futures=True)


def alone(work: Callable[..., Any], *arguments: Any) -> Any:
    """Call a function in a new process.

    Raises
    ------
    BrokenExecutor
        If that process dies too.
    """
    workers = Workers(None, 1)
    try:
        return workers.submit(work, *arguments).result()
    finally:
        workers.end()


def process_context() -> Any:
    """How processes are started: by a fork on Linux, and anew elsewhere.

    A fork has loaded everything already.  Libraries of macOS do not survive it.
    """
    return multiprocessing.get_context("fork" if sys.platform == "linux" else "spawn")


def _pool(count: int) -> ProcessPoolExecutor:
    longest = sys.get_int_max_str_digits()
    return ProcessPoolExecutor(
        count, mp_context=process_context(), initializer=_prepare, initargs=(longest,)
    )


def _prepare(longest: int) -> None:
    """Set up a worker: only the parent handles interrupts, and each worker uses one thread."""
    sys.set_int_max_str_digits(longest)  # a process that is no fork has a limit of its own
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    end_with_parent()
    for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")


def end_with_parent() -> None:
    """Ask the kernel, if it supports this, to end this process when its parent ends."""
    if sys.platform == "linux":
        import ctypes

        parent_death_signal = 1
        with contextlib.suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(parent_death_signal, signal.SIGKILL)
