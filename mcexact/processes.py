"""Child processes, which send messages and can be ended at any moment, also in compiled code.

A child is a fork only where this process has a single thread: a fork of a process with threads may
inherit locks that nobody releases, and every notebook, every thread pool and OpenBLAS has threads.
Otherwise a new interpreter starts and imports what the work needs.  Unlike that of
`multiprocessing`, it does not run the main script of this process again, so that a script needs
no main guard, and a notebook or a console no file.
"""

from __future__ import annotations

import contextlib
import io
import multiprocessing
import os
import pickle
import signal
import socket
import subprocess
import sys
import threading
import weakref
from collections.abc import Callable
from multiprocessing.connection import Connection
from multiprocessing.spawn import get_executable
from typing import Any

from mcexact.errors import UsageError

_THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
_TASKS = "/proc/self/task"


class Child:
    """A process that calls a function with a connection to this one, and ends with it.

    Parameters
    ----------
    work : callable
        A function of a module, which takes the connection of the child and then the arguments.
    arguments : tuple
        Objects that can be pickled.
    one_thread : bool
        Whether the child multiplies matrices in one thread: one of several that work at once.

    Attributes
    ----------
    connection : multiprocessing.connection.Connection
        What the child sends is received here; it has ended where this raises EOFError.
    """

    connection: Any

    def __init__(
        self,
        work: Callable[..., None],
        arguments: tuple[Any, ...] = (),
        *,
        one_thread: bool = False,
    ) -> None:
        for stream in (sys.stdout, sys.stderr):
            if stream is not None:
                stream.flush()
        self._process: Any
        if os.name != "posix":  # a new interpreter cannot inherit a connection
            self.connection, theirs = multiprocessing.get_context("spawn").Pipe()
            context: Any = multiprocessing.get_context("spawn")
            self._process = context.Process(target=_begun, args=(theirs, work, arguments))
            self._process.start()
            theirs.close()
        elif may_fork() and not one_thread:
            self.connection, theirs = multiprocessing.Pipe()
            forking: Any = multiprocessing.get_context("fork")
            self._process = forking.Process(
                target=_forked, args=(self.connection, theirs, work, arguments)
            )
            self._process.start()
            theirs.close()
        else:
            self._process, self.connection = _started(one_thread)
            with contextlib.suppress(BrokenPipeError):  # receiving says that it has ended
                self.connection.send((work, arguments))
        weakref.finalize(self, _ended, self._process, self.connection)

    @property
    def pid(self) -> int:
        """The number of the process."""
        return int(self._process.pid)

    def exit_status(self) -> int:
        """Wait for the end: the status, or the negative number of the signal that ended it."""
        return _waited(self._process)

    def kill(self) -> None:
        """End the process, whatever it does; receiving from it then raises EOFError."""
        with contextlib.suppress(OSError):
            self._process.kill()

    def end(self) -> None:
        """End the process, whatever it does, and close the connection."""
        _ended(self._process, self.connection)


def _waited(process: Any) -> int:
    if isinstance(process, subprocess.Popen):
        return process.wait()
    process.join()
    return int(process.exitcode)


def _ended(process: Any, connection: Any) -> None:
    """End a process whose `Child` is not used any more."""
    with contextlib.suppress(OSError):
        process.kill()
    _waited(process)
    connection.close()


def may_fork() -> bool:
    """Whether a fork is safe: on Linux, if the process has one thread, also in compiled code.

    Libraries of macOS do not survive a fork.
    """
    try:
        return threading.active_count() == 1 and len(os.listdir(_TASKS)) == 1
    except OSError:
        return False


def serve(connection: Connection) -> None:
    """Do pieces of work in a child, one after the other, until the connection is closed.

    Each piece is a function with its arguments; what is sent back is ``(True, result)``, or
    ``(False, error)``.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interrupt is the parent's
    with contextlib.suppress(EOFError, OSError):
        while True:
            piece = connection.recv_bytes()
            try:
                work, arguments = _unpickled(piece)
                reply = pickle.dumps((True, work(*arguments)))
            except Exception as error:
                reply = _error_reply(error)
            connection.send_bytes(reply)


def end_with_parent() -> None:
    """Ask the kernel, if it supports this, to end this process when its parent ends."""
    if sys.platform == "linux":
        import ctypes

        parent_death_signal = 1
        with contextlib.suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(parent_death_signal, signal.SIGKILL)


def _error_reply(error: Exception) -> bytes:
    """Pickle an error, or its text if the error itself cannot be pickled."""
    try:
        reply = pickle.dumps((False, error))
        pickle.loads(reply)
    except Exception:
        return pickle.dumps((False, RuntimeError(f"{type(error).__name__}: {error}")))
    return reply


def _started(one_thread: bool) -> tuple[subprocess.Popen[bytes], Connection]:
    """Start an interpreter that waits for its work, which is all that it inherits."""
    ours, theirs = socket.socketpair()
    with ours, theirs:
        longest = sys.get_int_max_str_digits()
        # The modules that this process finds are found there; nothing else is imported before.
        begin = (
            "import signal, sys; signal.signal(signal.SIGINT, signal.SIG_IGN); "
            f"sys.path[:] = {sys.path!r}; sys.set_int_max_str_digits({longest}); "
            f"from mcexact.processes import _main; _main({theirs.fileno()})"
        )
        flags = subprocess._args_from_interpreter_flags()  # type: ignore[attr-defined]
        threads = {name: os.environ.get(name, "1") for name in _THREADS} if one_thread else {}
        process = subprocess.Popen(
            [os.fsdecode(get_executable()), *flags, "-c", begin],
            pass_fds=[theirs.fileno()],
            stdin=subprocess.DEVNULL,
            env=os.environ | threads,
        )
        return process, Connection(ours.detach())


def _main(descriptor: int) -> None:
    """Take the work from the parent, and do it."""
    connection = Connection(descriptor)
    end_with_parent()
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    try:
        work, arguments = _unpickled(connection.recv_bytes())
    except EOFError:
        return
    work(connection, *arguments)


def _begun(connection: Connection, work: Callable[..., None], arguments: tuple[Any, ...]) -> None:
    """Do the work in a process that `multiprocessing` started."""
    end_with_parent()
    work(connection, *arguments)


def _forked(
    parents: Connection, connection: Connection, work: Callable[..., None], arguments: Any
) -> None:
    """Do the work in a fork, which does not keep the parent's end of the connection open."""
    parents.close()
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    _begun(connection, work, arguments)


class _Unpickler(pickle.Unpickler):
    """Reads work, whose functions are those of modules: the main script is not run again."""

    def find_class(self, module: str, name: str) -> Any:
        if module == "__main__":
            raise UsageError(
                f"{name} is defined in the main script or notebook, which worker processes do not "
                "run: put it into a module, or give an executor"
            )
        return super().find_class(module, name)


def _unpickled(data: bytes) -> Any:
    return _Unpickler(io.BytesIO(data)).load()
