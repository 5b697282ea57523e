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
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from typing import Any, TypeVar

from mcexact.cli.deadline import Deadline
from mcexact.cli.memory import MemoryLimit, died_of_memory, out_of_memory, ran_out
from mcexact.errors import InternalError, McexactError
from mcexact.processes import Child

T = TypeVar("T")


class _Note(str):
    """A line that the child wants to be shown at once."""

    __slots__ = ()


class _Step(str):
    """What the child does now, for progress."""

    __slots__ = ()


@dataclass
class Kept:
    """What a child sent before it ended: parts of its result, which a limit does not discard.

    Attributes
    ----------
    parts : dict
        By name.
    running : str
        The part that the child works on.
    """

    parts: dict[str, Any] = field(default_factory=dict)
    running: str = ""


@dataclass(frozen=True)
class _Part:
    """A part of the result, or the beginning of the work on it."""

    name: str
    value: Any = None
    begins: bool = False


class Reporting:
    """What a child says before it has the result; the work takes it as the keyword ``report``."""

    def __init__(self, send: Callable[[Any], None]) -> None:
        self._send = send

    def step(self, text: str) -> None:
        """Say what is to be shown as progress."""
        self._send(_Step(text))

    def begin(self, name: str, step: str) -> None:
        """Say that the work on a part begins, and what is to be shown as progress."""
        self._send(_Part(name, begins=True))
        self.step(step)

    def keep(self, name: str, value: Any) -> None:
        """Hand over a part, which can be pickled."""
        self._send(_Part(name, value))


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
    kept: Kept | None = None,
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
    kept : Kept, optional
        What the parts of the result are added to.  The function then takes a keyword ``report``, a
        `Reporting` that hands them over.

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
    deadline = timeout if isinstance(timeout, Deadline) else Deadline(timeout)
    limits = (max_memory, tuple(libraries))
    child = Child(_child, (limits, work, arguments, telling, kept is not None))
    try:
        outcome = _await(child.connection, doing, deadline, quiet, kept or Kept())
    except (EOFError, ConnectionResetError):
        status = child.exit_status()
        if died_of_memory(status, max_memory):
            raise out_of_memory(doing, max_memory) from None
        raise InternalError(f"the computation ended with status {status} while {doing}") from None
    finally:
        child.end()
    if isinstance(outcome, BaseException):
        if isinstance(outcome, MemoryError):
            raise out_of_memory(doing, max_memory)
        raise outcome
    result: T = outcome[0]
    return result


def _await(receiver: Connection, doing: str, deadline: Deadline, quiet: bool, kept: Kept) -> Any:
    """Wait for the child's result, and show progress if that takes long."""
    start, step = time.monotonic(), ""
    progress = _Progress(doing)
    with _terminable(), contextlib.ExitStack() as stack:
        stack.callback(progress.clear)
        while True:
            while not receiver.poll(0.1 if (left := deadline.left()) is None else min(0.1, left)):
                if not quiet:
                    progress.show(time.monotonic() - start, step)
                if deadline.left() == 0:
                    raise deadline.missed(doing)
            outcome = pickle.loads(receiver.recv_bytes())
            if isinstance(outcome, _Step):
                step = str(outcome)
            elif isinstance(outcome, _Part):
                kept.running = outcome.name if outcome.begins else ""
                if not outcome.begins:
                    kept.parts[outcome.name] = outcome.value
            elif isinstance(outcome, _Note):
                progress.clear()
                print(f"mcexact: {outcome}", file=sys.stderr, flush=True)
            else:
                return outcome


def _child(
    sender: Connection,
    limits: tuple[int | None, tuple[str, ...]],
    work: Callable[..., Any],
    arguments: Any,
    telling: bool,
    keeping: bool,
) -> None:
    """Do the work and send its result, or the error that ended it."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
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
        told: dict[str, Any] = {}
        if telling:
            told["tell"] = lambda line: sender.send_bytes(pickle.dumps(_Note(line)))
        if keeping:
            told["report"] = Reporting(lambda said: sender.send_bytes(pickle.dumps(said)))
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


class _Progress:
    """What is being done, on standard error, once it has taken a second.

    On a terminal one line says what the child works on and for how long, and is cleared again;
    elsewhere a line is printed once.
    """

    def __init__(self, doing: str) -> None:
        self._doing, self._shown = doing, ""
        self._terminal = sys.stderr is not None and sys.stderr.isatty()

    def show(self, elapsed: float, step: str) -> None:
        """Show what is being done, after so many seconds."""
        if elapsed < _SHOW_AFTER:
            return
        if not self._terminal:
            if not self._shown:
                self._shown = self._doing
                print(f"mcexact: {self._doing} …", file=sys.stderr, flush=True)
            return
        line = ", ".join(filter(None, (self._doing, step, f"{elapsed:.0f} s")))
        if line != self._shown:
            self._shown = line
            columns = shutil.get_terminal_size().columns
            print(f"{_CLEAR}{_within(line, columns - 1)}", end="", file=sys.stderr, flush=True)

    def clear(self) -> None:
        """Clear the line on a terminal, so that another can be printed."""
        if self._terminal and self._shown:
            self._shown = ""
            print(_CLEAR, end="", file=sys.stderr, flush=True)


def _within(line: str, columns: int) -> str:
    """A line of so many columns at most; its middle is left out, as its end changes."""
    if len(line) <= columns:
        return line
    kept = max(columns - 2, 2)
    return f"{line[: kept // 3]}… {line[-(kept - kept // 3) :]}"[:columns]
