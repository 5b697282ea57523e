"""One run: limits of time and memory, child processes, rechecking.

Compiled arithmetic does not respond to signals.  Therefore a child process computes (`supervised`),
and the parent waits, shows progress and writes the results; it can end the child at any moment, and
a child that is ended leaves no files behind.  What the child decided before a limit ended it is
kept, and a `Run` starts another child, for other questions or to show what was decided.

`MemoryLimit` limits the memory of the child, and recognizes the errors, signals and exit statuses
by which compiled libraries fail without memory, so that they are reported as a limit and not as a
bug.

`rechecked` has the independent checker verify every certificate and every sentence of an answer
before files are written; `Run.conclude` is the common end of the commands that answer.
"""

from __future__ import annotations

import contextlib
import errno
import faulthandler
import importlib
import os
import pickle
import re
import shutil
import signal
import sys
import time
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from typing import TYPE_CHECKING, Any, TypeVar

import click

from mcexact.answer.sentence import MANIFEST, PLANT
from mcexact.answer.templates import count
from mcexact.cli import options
from mcexact.cli.commands import INTERRUPTED
from mcexact.cli.files import Deadline, directory, emit_tables, place_of, read, say_written
from mcexact.cli.output import emit, emit_json
from mcexact.cli.results import Evidence, Result, Shown
from mcexact.errors import InternalError, LimitReached, McexactError, UsageError
from mcexact.model.text import write_text
from mcexact.processes import Child

if TYPE_CHECKING:
    from mcexact.analysis.analyze import Analysis
    from mcexact.checker.kinds import Verdict

T = TypeVar("T")


@dataclass(frozen=True)
class Rechecked:
    """The checker's verdicts on the certificates of one run.

    Attributes
    ----------
    verdicts : mapping from names of certificates to Verdict
        The verdicts of the certificates that are VALID.
    open : tuple of str
        The names of the other certificates.
    missing : LimitReached or None
        The reason if not all are VALID: a limit on time or memory, or a limit of the checker.
    """

    verdicts: Mapping[str, Verdict]
    open: tuple[str, ...]
    missing: LimitReached | None

    def view(self) -> dict[str, Any]:
        """Return the number of VALID certificates and the names of the others, as plain data."""
        return {"valid": len(self.verdicts), "open": list(self.open)}

    def line(self) -> str:
        """Return a line of text that gives the number of VALID certificates."""
        if not self.verdicts:
            return "no certificate, as nothing was decided exactly\n"
        number = count(len(self.verdicts), "certificate")
        rest = f"not re-checked: {', '.join(self.open)}\n" if self.open else ""
        return f"{number} re-checked by the independent checker: VALID\n{rest}"

    def require_complete(self) -> None:
        """Raise an error if a certificate was not re-checked.

        Raises
        ------
        LimitReached
        """
        if self.missing is not None:
            raise self.missing


def rechecked(
    evidence: Evidence,
    *,
    doing: str,
    deadline: Deadline,
    max_memory: int | None,
) -> Rechecked:
    """Let the independent checker verify certificates and sentences, within limits.

    Parameters
    ----------
    evidence : Evidence
    doing : str
        A description of the work, for progress.
    deadline : Deadline
    max_memory : int or None
        The limit on memory in MiB.

    Raises
    ------
    InternalError
        If the checker rejects a certificate, or a sentence that the certificates do not imply.
    """
    names = [name for name in evidence.files if name != MANIFEST and not name.endswith(PLANT)]
    kept, missing = Kept(), None
    try:
        verdicts = supervised(
            _recheck,
            dict(evidence.files),
            evidence.plants,
            len(names),
            doing=doing,
            timeout=deadline,
            max_memory=max_memory,
            kept=kept,
        )
    except LimitReached as reached:
        valid = _valid(kept.parts)
        valid.pop(MANIFEST, None)
        what = f"{len(valid)} of {len(names)} certificates" if valid else "the answers"
        what += " are re-checked, and the sentences are not" if valid else " are not re-checked"
        missing = LimitReached(reached.message.replace("nothing has been decided", what))
        return Rechecked(valid, tuple(name for name in names if name not in valid), missing)
    valid = _valid(verdicts)
    reasons = [f"{name} ({verdicts[name].message})" for name in verdicts if name not in valid]
    if reasons:
        missing = LimitReached(f"not re-checked, a limit of the checker: {', '.join(reasons)}")
    return Rechecked(valid, tuple(name for name in verdicts if name not in valid), missing)


def _valid(verdicts: Mapping[str, Verdict]) -> dict[str, Verdict]:
    """Return the verdicts that are VALID."""
    return {name: verdict for name, verdict in verdicts.items() if verdict.verdict == "VALID"}


def _recheck(
    files: Mapping[str, str],
    plants: str | Mapping[str, str],
    number: int,
    *,
    report: Reporting,
) -> dict[str, Verdict]:
    """Verify files, and hand over each verdict, in the child process."""
    # Only there: it has every kind of answer, and every command imports this module.
    from mcexact.answer.check import recheck

    done: list[str] = []

    def keep(name: str, verdict: Verdict) -> None:
        done.append(name)
        report.keep(name, verdict)
        report.step(f"{len(done)} of {number} certificates")

    report.step(f"0 of {number} certificates")
    return recheck(files, plants, keep)


LIMITS = ("bytes", "depth", "digits", "exponent")


@dataclass
class Known:
    """The parts of an answer that are already decided when work on it starts or resumes.

    Attributes
    ----------
    parts : dict
        What was decided, pickled, by name.
    lost : dict
        Why other parts were not decided: the memory that each needs.
    ended : str
        Why no further part is to be decided; empty if the work goes on.
    """

    parts: dict[str, bytes] = field(default_factory=dict)
    lost: dict[str, str] = field(default_factory=dict)
    ended: str = ""

    def resume(self, analysis: Analysis, report: Reporting) -> None:
        """Enter the decided parts into an analysis, and have it report what else it decides."""
        for name, data in self.parts.items():
            if name in analysis.questions:
                analysis.know(name, *pickle.loads(data))
        for name, reason in self.lost.items():
            analysis.leave_open(reason, [name])
        if self.ended:
            analysis.leave_open(self.ended)
        analysis.watch(
            report.begin, lambda name, *outcome: report.keep(name, pickle.dumps(outcome))
        )


class Run:
    """The common options of commands, removed from the options given to a command.

    Parameters
    ----------
    values : dict
        The values of all options of the command, from which those of `options.work_limits` are
        removed and, if the command has them, those of `options.file_limits`,
        `options.certificates` and `options.as_json`.

    Notes
    -----
    The time of ``--timeout`` began when the command line did, so that it holds for the import of
    the command, too.
    """

    def __init__(self, values: dict[str, Any]) -> None:
        context = click.get_current_context(silent=True)
        self.deadline = Deadline(values.pop("timeout"), context.obj if context else None)
        self.max_memory: int | None = values.pop("max_memory")
        self.limits = options.set_limits({name: values.pop(name, None) for name in LIMITS})
        self.certificates = values.pop("certificates", None)
        self.system_by_digest = values.pop("system_by_digest", False)
        if self.system_by_digest and self.certificates is None:
            raise click.UsageError("--system-by-digest is about files: give --certificates, too")
        self.as_json = values.pop("as_json", False)

    def read(self, file: str) -> tuple[str, bytes]:
        """Return the name by which messages refer to a file, and its bytes."""
        return place_of(file), read(file, self.limits, self.deadline)

    def result(
        self, work: Callable[..., T], *arguments: Any, doing: str, telling: bool = False
    ) -> T:
        """Call a function in a child process, within the limits; see `supervised`."""
        return supervised(
            work,
            *arguments,
            doing=doing,
            timeout=self.deadline,
            max_memory=self.max_memory,
            telling=telling,
        )

    def result_in_parts(
        self, work: Callable[..., T], *arguments: Any, doing: str
    ) -> tuple[T, BaseException | None]:
        """Call a function in a child process, and again with what was decided before a limit.

        Parameters
        ----------
        work : callable
            A function that takes these arguments, the keyword ``known`` and the keyword ``report``,
            by which it hands over pickled parts as they are decided.
        *arguments
        doing : str
            A description of the work.

        Returns
        -------
        result
        LimitReached or KeyboardInterrupt or None
            What ended the work before everything was decided.

        Raises
        ------
        LimitReached, KeyboardInterrupt
            If nothing was decided by then.
        """
        known, kept = Known(), Kept()
        ended: BaseException | None = None
        deadline = self.deadline
        while True:
            kept.running = ""
            try:
                result = supervised(
                    work,
                    *arguments,
                    known,
                    doing="showing what was decided" if known.ended else doing,
                    timeout=deadline,
                    max_memory=self.max_memory,
                    kept=kept,
                )
            except (LimitReached, KeyboardInterrupt) as error:
                known.parts = kept.parts
                if known.ended or not known.parts:
                    raise ended or error from None
                ended, deadline = error, self.deadline.with_grace()
                interrupted = isinstance(error, KeyboardInterrupt)
                if interrupted or self.deadline.left() == 0 or not kept.running:
                    known.ended = _reason(error)
                else:  # other questions may need less memory
                    known.lost[kept.running] = _reason(error)
                    deadline = self.deadline
                continue
            self.deadline = deadline if ended else self.deadline
            return result, ended

    def conclude(
        self,
        result: Result,
        show: Callable[[], bool],
        *,
        about: str,
        write: Callable[[Rechecked], None] = lambda _: None,
    ) -> Rechecked:
        """Show an answer, have its certificates and sentences verified, and write the files.

        Parameters
        ----------
        result : Result
        show : callable
            A function that prints the answer and returns whether a line about the checker may
            follow.
        about : str
            A description of the answer, for progress.
        write : callable, optional
            A function that writes the other files.

        Raises
        ------
        InternalError
            If the checker rejects a certificate or a sentence; no file is written then.
        """
        line_follows = not self.as_json and show()
        checked = rechecked(
            result.evidence,
            doing=f"re-checking {about}",
            deadline=self.deadline.with_grace(),
            max_memory=self.max_memory,
        )
        if self.certificates is not None:
            folder = directory(self.certificates)
            for name, text in result.evidence.files.items():
                write_text(folder / name, text)
            say_written(folder, len(result.evidence.files))
        write(checked)
        if self.as_json:
            emit_json({**result.document, "re_checked": checked.view()})
        elif line_follows and (checked.missing is None or checked.verdicts):
            emit("\n" + checked.line())
        return checked


def undecided_error(
    ended: BaseException | None, undecided: Mapping[str, Sequence[str]], doing: str
) -> LimitReached | None:
    """Return the error to raise if something ended the work, which names what is not decided.

    Parameters
    ----------
    ended : LimitReached or KeyboardInterrupt or None
    undecided : mapping
        The parts that were not decided, by the reason of that.
    doing : str
        A description of the work.
    """
    if ended is None:
        return None
    sentence = f"{_reason(ended)} while {doing}, after everything was decided"
    if undecided:
        lists = {reason: ", ".join(names).replace("_", " ") for reason, names in undecided.items()}
        sentence = "; ".join(
            f"{reason} while {doing}, not decided: {names}" for reason, names in lists.items()
        )
    if isinstance(ended, KeyboardInterrupt):
        error = LimitReached(sentence)
        error.exit_status = INTERRUPTED
        return error
    option = "--timeout" if "time limit" in sentence else "--max-memory"
    return LimitReached(f"{sentence} ({option} allows more)")


def _reason(error: BaseException) -> str:
    """Why a question was not decided, as a clause."""
    if isinstance(error, KeyboardInterrupt):
        return "the work was interrupted"
    return str(error).partition(" while ")[0]


def show_tables(result: Shown) -> Callable[[], bool]:
    """Return a function that prints the tables of an answer; a line about the checker follows."""

    def show() -> bool:
        emit_tables(result.tables)
        return True

    return show


# A limit on the memory of a process, and recognition of errors that it causes.

_MEBIBYTE = 1 << 20
# An unexpected error this close to the limit is attributed to the limit.
_NEAR = 16 * _MEBIBYTE
# Compiled libraries end by these signals without memory; OpenBLAS interrupts its own process.
_DEATHS = frozenset({signal.SIGABRT, signal.SIGSEGV, signal.SIGINT}) | {
    getattr(signal, name) for name in ("SIGBUS", "SIGILL", "SIGTRAP") if hasattr(signal, name)
}


class MemoryLimit:
    """A limit on the memory of this process, in force until it is lifted.

    Parameters
    ----------
    mebibytes : int
        The amount that may be added to the address space that the process occupies now.
    libraries : sequence of str
        Compiled libraries to load before the limit: if memory runs out while they load, they fail
        in ways that look like bugs, or wait forever.

    Raises
    ------
    UsageError
        If the platform does not limit memory.
    """

    def __init__(self, mebibytes: int, libraries: Sequence[str]) -> None:
        occupied = _kibibytes("VmSize") * 1024
        try:
            import resource

            resource.RLIMIT_AS  # noqa: B018 - not every platform has it
        except (ImportError, AttributeError):
            occupied = 0
        if not occupied:  # macOS has the limit and does not enforce it
            raise UsageError("this platform does not limit memory: leave out --max-memory")
        for name in libraries:
            importlib.import_module(name)
        if "numpy" in libraries:
            _claim_working_memory(libraries)
        self._resource = resource
        self._before = resource.getrlimit(resource.RLIMIT_AS)
        hard = self._before[1]
        limit = _kibibytes("VmSize") * 1024 + mebibytes * _MEBIBYTE  # with the libraries
        self._bytes = limit if hard == resource.RLIM_INFINITY else min(limit, hard)
        resource.setrlimit(resource.RLIMIT_AS, (self._bytes, hard))

    def lift(self) -> None:
        """Remove the limit, so that an error can be reported."""
        self._resource.setrlimit(self._resource.RLIMIT_AS, self._before)

    def explains(self, error: BaseException) -> bool:
        """Whether this limit caused an error, or one that led to it."""
        for cause in _causes(error):
            # These are the messages of a library that could not be mapped or initialized.
            missing = isinstance(cause, ModuleNotFoundError)
            if isinstance(cause, ImportError | SystemError) and not missing:
                return True
        intended = isinstance(error, McexactError) and not isinstance(error, InternalError)
        return not intended and _kibibytes("VmPeak") * 1024 > self._bytes - _NEAR


def ran_out(error: BaseException) -> bool:
    """Whether an error, or one that led to it, reports that memory ran out."""
    return any(
        isinstance(cause, MemoryError) or getattr(cause, "errno", None) == errno.ENOMEM
        for cause in _causes(error)
    )


def died_of_memory(exit_code: int | None, max_memory: int | None) -> bool:
    """Whether a process that ended without a message had too little memory.

    The operating system sends SIGKILL to a process that takes too much.  Under a limit, a library
    that gets no memory aborts or ends the process with a status of its own.
    """
    if exit_code is None:
        return False
    if exit_code == -getattr(signal, "SIGKILL", 9):
        return True
    return max_memory is not None and (exit_code > 0 or -exit_code in _DEATHS)


def out_of_memory(doing: str, max_memory: int | None) -> LimitReached:
    """Return the error to raise when memory ran out."""
    if max_memory is None:
        return LimitReached(f"the memory was exhausted while {doing}; nothing has been decided")
    return LimitReached(
        f"the memory limit of {max_memory} MiB was exhausted while {doing}; "
        "nothing has been decided (--max-memory allows more)"
    )


def _claim_working_memory(libraries: Sequence[str]) -> None:
    """Multiply matrices once, so that OpenBLAS allocates buffers without which it waits forever."""
    import numpy as np

    M = np.ones((128, 128))
    _ = M @ M
    if "scipy.linalg" in libraries:
        from scipy.linalg import blas

        blas.dgemm(1.0, M, M)


def _causes(error: BaseException) -> Iterator[BaseException]:
    """Yield an error and those that led to it."""
    cause: BaseException | None = error
    while cause is not None:
        yield cause
        cause = cause.__cause__ or cause.__context__


def _kibibytes(name: str) -> int:
    """A size from the kernel's status of this process; 0 where the platform has none."""
    with contextlib.suppress(OSError), open("/proc/self/status", encoding="ascii") as status:
        line = re.search(rf"^{name}:\s*(\d+) kB$", status.read(), re.MULTILINE)
        return int(line[1]) if line else 0
    return 0


class _Note(str):
    """A line that the child wants to be shown at once."""

    __slots__ = ()


class _Step(str):
    """What the child does now, for progress."""

    __slots__ = ()


@dataclass
class Kept:
    """Parts of a result that a child sent before it ended, which a limit does not discard.

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
    """Messages of a child before its result; the work takes it as the keyword ``report``."""

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
_DOING = 16
"""The columns that are kept of what is done, so that the step and the seconds are whole."""
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
        Collects the parts of the result.  The function then takes a keyword ``report``, a
        `Reporting` by which it sends them.

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
    # OpenBLAS, whose threads otherwise spin for 0.1 s of a processor once numpy is loaded.
    os.environ.setdefault("OPENBLAS_THREAD_TIMEOUT", "4")
    max_memory, libraries = limits
    limit = None
    try:
        if max_memory is not None:
            limit = MemoryLimit(max_memory, libraries)
        channels: dict[str, Any] = {}
        if telling:
            channels["tell"] = lambda line: sender.send_bytes(pickle.dumps(_Note(line)))
        if keeping:
            channels["report"] = Reporting(lambda part: sender.send_bytes(pickle.dumps(part)))
        message = pickle.dumps((work(*arguments, **channels),))
    except Exception as error:
        if limit is not None:
            limit.lift()
        message = pickle.dumps(_as_sent(error, limit))
    sender.send_bytes(message)
    sender.close()


def _as_sent(error: Exception, limit: MemoryLimit | None) -> Exception:
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
    """Show on standard error what is being done, once it has taken a second.

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
            columns = shutil.get_terminal_size().columns - 1
            doing = _within(self._doing, max(columns - len(line) + len(self._doing), _DOING))
            line = _within(doing + line.removeprefix(self._doing), columns)
            print(f"{_CLEAR}{line}", end="", file=sys.stderr, flush=True)

    def clear(self) -> None:
        """Clear the line on a terminal, so that another can be printed."""
        if self._terminal and self._shown:
            self._shown = ""
            print(_CLEAR, end="", file=sys.stderr, flush=True)


def _within(line: str, columns: int) -> str:
    """Shorten a line to some columns; the middle is left out, because the end changes."""
    if len(line) <= columns:
        return line
    kept = max(columns - 2, 2)
    return f"{line[: kept // 3]}… {line[-(kept - kept // 3) :]}"[:columns]
