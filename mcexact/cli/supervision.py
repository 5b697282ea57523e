"""Long work in a process of its own, so that it can be limited and interrupted at any moment.

Compiled arithmetic does not listen to signals.  The parent waits, shows progress, and is the only
one that writes results; the child computes and sends them.  A child that is ended leaves nothing
behind.
"""

from __future__ import annotations

import contextlib
import faulthandler
import multiprocessing
import os
import pickle
import signal
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from multiprocessing.connection import Connection
from typing import Any, TypeVar

from mcexact.errors import InternalError, LimitReached, McexactError
from mcexact.sweep.workers import end_with_parent

T = TypeVar("T")

_MEBIBYTE = 1 << 20
_SHOW_AFTER = 1.0  # seconds


def supervised(
    work: Callable[..., T],
    *arguments: Any,
    doing: str,
    timeout: float | None = None,
    max_memory: int | None = None,
    quiet: bool = False,
) -> T:
    """Call a function in a child process and return what it returns.

    Parameters
    ----------
    work : callable
        A function of a module; its arguments and its result can be pickled.
    *arguments
        What it is called with.
    doing : str
        What is being done, for progress and for the message at a limit.
    timeout : float, optional
        Seconds.
    max_memory : int, optional
        MiB that the child may add to what the program occupies when it starts.
    quiet : bool
        Show no progress.

    Returns
    -------
    T

    Raises
    ------
    LimitReached
        If the work was ended at a limit.
    McexactError
        Whatever the work raised on purpose.
    InternalError
        If the work failed in a way that it did not intend.
    """
    methods = multiprocessing.get_all_start_methods()
    context: Any = multiprocessing.get_context("fork" if "fork" in methods else "spawn")
    receiver, sender = context.Pipe(duplex=False)
    child = context.Process(target=_child, args=(sender, max_memory, work, arguments))
    sys.stdout.flush()
    sys.stderr.flush()
    child.start()
    sender.close()
    try:
        outcome = _await(receiver, doing, timeout, quiet)
    except EOFError:
        child.join()
        raise _lost(child.exitcode, doing, max_memory) from None
    finally:
        child.kill()
        child.join()
        receiver.close()
    if isinstance(outcome, BaseException):
        if isinstance(outcome, MemoryError):
            raise _out_of_memory(doing, max_memory)
        raise outcome
    result: T = outcome[0]
    return result


def _await(receiver: Connection, doing: str, timeout: float | None, quiet: bool) -> Any:
    """Wait for the child's message, and show what it is doing if that takes long."""
    start = time.monotonic()
    with _terminable(), _progress(doing) as show:
        while not receiver.poll(0.1 if timeout is None else min(0.1, timeout)):
            elapsed = time.monotonic() - start
            if timeout is not None and elapsed >= timeout:
                raise LimitReached(
                    f"the time limit of {timeout:g} s was reached while {doing}; "
                    "nothing has been decided (--timeout allows more)"
                )
            if not quiet:
                show(elapsed)
        return pickle.loads(receiver.recv_bytes())


def _child(
    sender: Connection, max_memory: int | None, work: Callable[..., Any], arguments: Any
) -> None:
    """Do the work and send its result, or the error that it ended with."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    end_with_parent()
    # What compiled code says before it aborts is not for the user, who gets one message.
    faulthandler.disable()
    silence = os.open(os.devnull, os.O_WRONLY)
    os.dup2(silence, 1)
    os.dup2(silence, 2)
    try:
        if max_memory is not None:
            _limit_memory(max_memory)
        outcome: Any = (work(*arguments),)
    except (McexactError, MemoryError) as error:
        outcome = error
    except Exception as error:
        frame = traceback.extract_tb(error.__traceback__)[-1]
        place = f"{os.path.basename(frame.filename)}:{frame.lineno}"
        outcome = InternalError(f"{type(error).__name__}: {error} ({place})")
    sender.send_bytes(pickle.dumps(outcome))
    sender.close()


def _limit_memory(mebibytes: int) -> None:
    """Let this process grow by so much and no more."""
    try:
        import resource
    except ImportError:
        raise McexactError("this platform has no limit on memory") from None
    occupied = 0
    with contextlib.suppress(OSError, ValueError), open("/proc/self/statm") as statm:
        occupied = int(statm.read().split()[0]) * resource.getpagesize()
    limit = occupied + mebibytes * _MEBIBYTE
    hard = resource.getrlimit(resource.RLIMIT_AS)[1]
    resource.setrlimit(
        resource.RLIMIT_AS, (limit if hard == resource.RLIM_INFINITY else min(limit, hard), hard)
    )


def _lost(exit_code: int | None, doing: str, max_memory: int | None) -> McexactError:
    """What to say about a child that ended without a word."""
    if max_memory is not None and exit_code in (-signal.SIGABRT, -signal.SIGSEGV, -signal.SIGBUS):
        return _out_of_memory(doing, max_memory)
    if exit_code == -getattr(signal, "SIGKILL", 9):
        return _out_of_memory(doing, max_memory)
    return InternalError(f"the computation ended with status {exit_code} while {doing}")


def _out_of_memory(doing: str, max_memory: int | None) -> LimitReached:
    """What to say when memory was not enough."""
    if max_memory is None:
        return LimitReached(f"the memory was exhausted while {doing}; nothing has been decided")
    return LimitReached(
        f"the memory limit of {max_memory} MiB was exhausted while {doing}; "
        "nothing has been decided (--max-memory allows more)"
    )


@contextlib.contextmanager
def _terminable() -> Iterator[None]:
    """Turn a request to end into an exception, so that the child is ended too."""

    def end(number: int, frame: object) -> None:
        sys.exit(128 + number)

    try:
        before = signal.signal(signal.SIGTERM, end)
    except ValueError:  # not the main thread: nobody sends us signals
        yield
        return
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


@contextlib.contextmanager
def _progress(doing: str) -> Iterator[Callable[[float], None]]:
    """Say on standard error what takes longer than a second."""
    if sys.stderr.isatty():
        from rich.console import Console

        with contextlib.ExitStack() as stack:
            console = Console(stderr=True)
            status = console.status("")
            shown = False

            def show(elapsed: float) -> None:
                nonlocal shown
                if elapsed >= _SHOW_AFTER:
                    status.update(f"{doing}, {elapsed:.0f} s")
                    if not shown:
                        stack.enter_context(status)
                        shown = True

            yield show
        return
    said = False

    def say(elapsed: float) -> None:
        nonlocal said
        if elapsed >= _SHOW_AFTER and not said:
            print(f"mcexact: {doing} …", file=sys.stderr, flush=True)
            said = True

    yield say
