"""Worker processes, which may die: a job lost with one is repeated once in a new process."""

from __future__ import annotations

import contextlib
import pickle
import queue
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from typing import Any

from mcexact.errors import UsageError
from mcexact.processes import Child, serve

_MOST = 256


class Workers:
    """The caller's executor, or processes that are started when needed, and again if one dies.

    Parameters
    ----------
    executor : concurrent.futures.Executor, optional
        The caller's executor, which is not shut down after the sweep.
    count : int
        The number of processes; for the caller's executor, half the number of jobs it gets at once.

    Raises
    ------
    UsageError
        If the executor is not an executor, or the count is out of range.

    Notes
    -----
    A thread waits for each process.  The processes are new interpreters and no forks: a fork would
    copy the locks that threads of this process hold, and nothing would release them.
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
        self._threads: ThreadPoolExecutor | None = None
        self._idle: queue.SimpleQueue[Child] = queue.SimpleQueue()
        self._all: list[Child] = []
        self._ended = False

    def submit(self, work: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Submit one call, whose future raises BrokenExecutor if its process dies.

        Raises
        ------
        BrokenExecutor
            If the caller's executor has lost its processes.
        """
        if self._given is not None:
            return self._given.submit(work, *arguments)
        if self._threads is None:
            self._threads = ThreadPoolExecutor(self.count, thread_name_prefix="mcexact-sweep")
        return self._threads.submit(self._done, work, arguments)

    def _done(self, work: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
        """Have a process do a call, and wait for it, in one of the threads."""
        piece = pickle.dumps((work, arguments))
        try:
            child = self._idle.get_nowait()
        except queue.Empty:
            child = Child(serve, one_thread=True)
            self._all.append(child)
            if self._ended:
                child.kill()
        try:
            child.connection.send_bytes(piece)
            fine, result = pickle.loads(child.connection.recv_bytes())
        except (EOFError, OSError) as error:
            raise BrokenExecutor("the process died") from error
        self._idle.put(child)
        if not fine:
            raise result
        return result

    def end(self) -> None:
        """End the processes that this team started, even while they work."""
        if self._threads is None:
            return
        self._ended = True
        for child in list(self._all):
            child.kill()
        self._threads.shutdown(wait=True, cancel_futures=True)
        for child in self._all:
            with contextlib.suppress(OSError):
                child.end()


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
