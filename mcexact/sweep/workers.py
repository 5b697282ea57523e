"""Processes that may die: a job that was lost with one gets a fresh process, once."""

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
    """An executor of our own, made when it is needed and again when it is broken, or a given one.

    Parameters
    ----------
    executor : concurrent.futures.Executor, optional
        It stays open when the sweep is done.
    count : int
        How many processes; of a given executor, how many jobs it gets at once.

    Raises
    ------
    UsageError
        If the executor is none, or the count is not a number of processes.
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
        """Hand over one call.

        Raises
        ------
        BrokenExecutor
            If an executor that was given has lost its processes.
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
        """End our own processes, whatever they are doing."""
        if self._own is None:
            return
        pool, self._own = self._own, None
        for process in list((getattr(pool, "_processes", None) or {}).values()):
            with contextlib.suppress(Exception):
                process.kill()
        pool.shutdown(wait=True, cancel_futures=True)


def alone(work: Callable[..., Any], *arguments: Any) -> Any:
    """Call a function in a fresh process.

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


def _pool(count: int) -> ProcessPoolExecutor:
    methods = multiprocessing.get_all_start_methods()
    context = multiprocessing.get_context("fork" if "fork" in methods else "spawn")
    return ProcessPoolExecutor(count, mp_context=context, initializer=_prepare)


def _prepare() -> None:
    """In a worker: the parent hears an interrupt, and workers share the processors evenly."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    end_with_parent()
    for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")


def end_with_parent() -> None:
    """Ask the kernel, where it can, to end this process when its parent is gone."""
    if sys.platform == "linux":
        import ctypes

        parent_death_signal = 1
        with contextlib.suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(parent_death_signal, signal.SIGKILL)
