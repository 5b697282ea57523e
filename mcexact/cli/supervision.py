"""Work in a child process, which can be limited and interrupted at any moment.

Compiled arithmetic does not respond to signals.  Therefore the child computes, and the parent
waits, shows progress and writes the results.  A child that is ended leaves no files behind.
"""

from __future__ import annotations

import contextlib
import faulthandler
import os
import pickle
import shutil
import signal
import sys
import time
import traceback
from collections.abc import Callable, Iterator, Sequence
from multiprocessing.connection import Connection
from typing import Any, TypeVar

from mcexact.cli.deadline import Deadline
from mcexact.cli.memory import MemoryLimit, died_of_memory, out_of_memory, ran_out
from mcexact.errors import InternalError, McexactError
from mcexact.sweeps.workers import end_with_parent, process_context

T = TypeVar("T")
Tell = Callable[[str], None]


class _Note(str):
    """A line that the child wants to be shown at once."""

    __slots__ = ()


_LIBRARIES = ("flint", "numpy", "scipy.linalg")
_SHOW_AFTER = 1.0  # seconds
_CLEAR = "\r\x1b[K"
"""Move to the start of the terminal's line, and clear it."""


def supervised(
    work: Callable[..., T],
    *arguments: Any,
    doing: str,
    timeout: float | Deadline | None = None,
    max_memory: int | None = None,
    libraries: Sequence[str] = _LIBRARIES,
    quiet: bool = False,
    telling: bool = False,
) -> T:
    """Call a function in a child process and return what it returns.

    Parameters
    ----------
    work : callable
        A function of a module whose arguments and result can be pickled.
    *arguments
        The arguments of the function.
    doing : str
        A description of the work, for progress and for the message at a limit.
    timeout : float or Deadline, optional
        Seconds for the work, or the deadline of the whole command.
    max_memory : int, optional
        MiB that the child may add to what the program and the libraries occupy.
    libraries : sequence of str
        Compiled libraries to load before memory is limited.
    quiet : bool
        Whether to show no progress.
    telling : bool
        Whether the function takes a keyword ``tell``, a function that shows a line on standard
        error at once.

    Returns
    -------
    T

    Raises
    ------
    LimitReached
        If a limit on time or memory ended the work.
    McexactError
        The error that the work raised.
    InternalError
        If the work failed unexpectedly.
    """
    context = process_context()
    receiver, sender = context.Pipe(duplex=False)
    deadline = timeout if isinstance(timeout, Deadline) else Deadline(timeout)
    limits = (max_memory, tuple(libraries))
    child = context.Process(target=_child, args=(sender, limits, work, arguments, telling))
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            stream.flush()
    child.start()
    sender.close()
    try:
        outcome = _await(receiver, doing, deadline, quiet)
    except EOFError:
        child.join()
        if died_of_memory(child.exitcode, max_memory):
            raise out_of_memory(doing, max_memory) from None
        raise InternalError(
            f"the computation ended with status {child.exitcode} while {doing}"
        ) from None
    finally:
        child.kill()
        child.join()
        receiver.close()
    if isinstance(outcome, BaseException):
        if isinstance(outcome, MemoryError):
            raise out_of_memory(doing, max_memory)
        raise outcome
    result: T = outcome[0]
    return result


def _await(receiver: Connection, doing: str, deadline: Deadline, quiet: bool) -> Any:
    """Wait for the child's result, and show progress if that takes long."""
    start = time.monotonic()
    with _terminable(), _progress(doing) as show:
        while True:
            while not receiver.poll(0.1 if (left := deadline.left()) is None else min(0.1, left)):
                if not quiet:
                    show(time.monotonic() - start)
                if deadline.left() == 0:
                    raise deadline.missed(doing)
            outcome = pickle.loads(receiver.recv_bytes())
            if not isinstance(outcome, _Note):
                return outcome
            print(f"mcexact: {outcome}", file=sys.stderr, flush=True)


def _child(
    sender: Connection,
    limits: tuple[int | None, tuple[str, ...]],
    work: Callable[..., Any],
    arguments: Any,
    telling: bool,
) -> None:
    """Do the work and send its result, or the error that ended it."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    end_with_parent()
    sys.set_int_max_str_digits(0)  # as `main` does, for a process that is no fork
    # The user gets one message, without what compiled code prints before it aborts.
    faulthandler.disable()
    silence = os.open(os.devnull, os.O_WRONLY)
    os.dup2(silence, 1)
    os.dup2(silence, 2)
    max_memory, libraries = limits
    limit = None
    try:
        if max_memory is not None:
            limit = MemoryLimit(max_memory, libraries)
        told: dict[str, Tell] = {}
        if telling:
            told["tell"] = lambda line: sender.send_bytes(pickle.dumps(_Note(line)))
        message = pickle.dumps((work(*arguments, **told),))
    except Exception as error:
        if limit is not None:
            limit.lift()
        message = pickle.dumps(_told(error, limit))
    sender.send_bytes(message)
    sender.close()


def _told(error: Exception, limit: MemoryLimit | None) -> Exception:
    """The form in which an error is sent to the parent: an unexpected one as text."""
    if ran_out(error) or (limit is not None and limit.explains(error)):
        return MemoryError()
    if isinstance(error, McexactError):
        return error
    frame = traceback.extract_tb(error.__traceback__)[-1]
    place = f"{os.path.basename(frame.filename)}:{frame.lineno}"
    return InternalError(f"{type(error).__name__}: {error} ({place})")


@contextlib.contextmanager
def _terminable() -> Iterator[None]:
    """Turn a signal that ends this process into an exception, so that the child is ended too."""

    def end(number: int, frame: object) -> None:
        sys.exit(128 + number)

    try:
        before = signal.signal(signal.SIGTERM, end)
    except ValueError:  # signals only reach the main thread
        yield
        return
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


@contextlib.contextmanager
def _progress(doing: str) -> Iterator[Callable[[float], None]]:
    """Show on standard error what is being done, once it has taken a second."""
    if sys.stderr is not None and sys.stderr.isatty():
        shown = ""

        def show(elapsed: float) -> None:
            nonlocal shown
            line = f"{doing}, {elapsed:.0f} s"
            if elapsed >= _SHOW_AFTER and line != shown:
                shown = line
                columns = shutil.get_terminal_size().columns
                print(f"{_CLEAR}{line[: columns - 1]}", end="", file=sys.stderr, flush=True)

        try:
            yield show
        finally:
            if shown:
                print(_CLEAR, end="", file=sys.stderr, flush=True)
        return
    said = False

    def say(elapsed: float) -> None:
        nonlocal said
        if elapsed >= _SHOW_AFTER and not said:
            print(f"mcexact: {doing} …", file=sys.stderr, flush=True)
            said = True

    yield say
