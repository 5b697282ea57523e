"""Input files within a deadline, results written completely or not at all, tables.

The parent process reads all inputs, with one `Deadline` for the whole command.  Before any work,
the ``require_…`` functions check that results can be written where they are wanted, without
creating or changing anything: that the place is writable, is not also an input, and is not named
twice.  `write_result` and `write_folder` write completely or not at all.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from types import FrameType

import click

from mcexact.cli.output import emit
from mcexact.errors import InputError, LimitReached, MissingExtra, NotWritten
from mcexact.errors import place_of as place_of
from mcexact.exact.rational import Limits
from mcexact.model.arrays import Reading
from mcexact.model.files import read_any, read_input, read_plant
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import write_bytes
from mcexact.report.text import WIDTH, Table, plain, show


def read(file: str, limits: Mapping[str, int], deadline: Deadline) -> bytes:
    """Read the bytes of a file, of standard input for ``-``, or what `read_input` takes besides.

    The parent process reads, since the child process has no standard input.  An idle pipe is waited
    for until the deadline.

    Raises
    ------
    InputError
        If the file is missing, unreadable or too large.
    LimitReached
        If the deadline passes.
    """
    place = place_of(file)
    with InputError.inside(place), deadline.interrupting(f"reading {place}"):
        return read_input(file, Limits(**limits))


def system_in(place: str, data: bytes, limits: Mapping[str, int]) -> MultiChannelSystem:
    """Read the system from the bytes of a file; error messages name the file.

    Raises
    ------
    InputError
        If it is malformed.
    """
    with InputError.inside(place):
        return read_any(data, place, Reading(Limits(**limits)))


def plant_in(
    place: str, data: bytes, limits: Mapping[str, int], at: Mapping[str, Fraction]
) -> MultiChannelSystem | ParametricSystem:
    """Read a system; parameters without values remain parameters.

    Raises
    ------
    InputError
        If it is malformed, or a value is that of no parameter.
    """
    with InputError.inside(place):
        return valued(read_plant(data, place, Reading(Limits(**limits))), at)


def valued(
    system: MultiChannelSystem | ParametricSystem, at: Mapping[str, Fraction]
) -> MultiChannelSystem | ParametricSystem:
    """Give values to some parameters of a system.

    Raises
    ------
    InputError
        If it has no parameters, or a value is that of no parameter.
    """
    if not at:
        return system
    if not isinstance(system, ParametricSystem):
        raise InputError("found a system without parameters: leave out --at")
    return system.with_values(at)


def require_other(output: Path | None, *inputs: str | None) -> None:
    """Refuse an output file that is also an input file, possibly through a symbolic link.

    Raises
    ------
    InputError
        If the output is one of the inputs.
    """
    for file in inputs:
        if output is not None and file is not None and _is_same(output, file):
            raise InputError(
                "the output file is also an input: choose another name", where=str(output)
            )


def require_apart(*outputs: Path | None) -> None:
    """Refuse one name for two results, the second of which would overwrite the first.

    Raises
    ------
    InputError
        If two names are those of one place, whether or not there is anything yet.
    """
    wanted = [each for each in outputs if each is not None]
    for k, output in enumerate(wanted):
        if any(_is_place(output, other) for other in wanted[:k]):
            raise InputError(
                "two results would be written there: choose another name for one of them",
                where=str(output),
            )


def _is_same(output: Path, file: str) -> bool:
    try:
        return output.is_file() and output.samefile(file)
    except OSError:
        return False


def _is_place(output: Path, other: Path) -> bool:
    """Whether two names are those of one file, one folder, or one that can be made."""
    try:
        if output.exists() and not (output.is_file() or output.is_dir()):
            return False  # a stream, such as /dev/null
        return os.path.realpath(output) == os.path.realpath(other)
    except (OSError, ValueError):
        return False


def require_writable(file: Path | None, folder: Path | None = None) -> None:
    """Check before the work that its results can be written, without creating or changing anything.

    Parameters
    ----------
    file : Path or None
        The file for a result; its folder exists, or will be made for the other results.
    folder : Path or None
        The folder for other results; a missing one will be created, with the folders above it.

    Raises
    ------
    NotWritten
        If a new file cannot be made there, or something else has that name.
    """
    if folder is not None:
        with _refusing(folder):
            resolved = Path(os.path.realpath(folder))
            if _exists(resolved) and not resolved.is_dir():
                raise NotWritten("cannot be made a directory: File exists", where=str(folder))
            _try(_nearest(resolved))
    if file is not None:
        with _refusing(file):
            if _exists(file) and not file.is_file():
                if file.is_dir() or not os.access(file, os.W_OK):
                    raise NotWritten("cannot write: it is no file", where=str(file))
                return
            target = Path(os.path.realpath(file))
            _exists(target)
            new_folders = () if folder is None else (resolved, *resolved.parents)
            parent = target.parent
            _try(_nearest(parent) if parent in new_folders else parent)


def require_drawable(file: Path | None) -> None:
    """Refuse to start work for a file with pictures that cannot be drawn.

    Raises
    ------
    MissingExtra
        If the library that draws is not installed.
    """
    if file is not None:
        MissingExtra.require("plot", "matplotlib")


def require_page(page: Path | None, folder: Path | None, *inputs: str | None) -> None:
    """Check before the work that a page can be written: its pictures, and where it is to stand.

    Parameters
    ----------
    page : Path or None
    folder : Path or None
        The folder for certificates.
    *inputs : str or None
        Files that are read by the same command.

    Raises
    ------
    InputError
        If the page is one of these files.
    NotWritten
        If it cannot be written.
    MissingExtra
        If the library that draws is not installed.
    """
    require_other(page, *inputs)
    require_writable(page, folder)
    require_drawable(page)


@contextlib.contextmanager
def _refusing(path: Path) -> Iterator[None]:
    """Turn an operating-system error about writing into NotWritten."""
    try:
        yield
    except OSError as error:
        raise NotWritten(f"cannot write: {error.strerror or error}", where=str(path)) from None
    except ValueError as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"is not a file name: {error}", where=repr(str(path))) from None


def _exists(path: Path) -> bool:
    """Whether a path exists; an OSError is raised if no file can have this name."""
    try:
        path.stat()
    except FileNotFoundError:
        return False
    return True


def _nearest(folder: Path) -> Path:
    """Return the folder, or the nearest existing one above it."""
    while not _exists(folder):
        folder = folder.parent
    return folder


def _try(folder: Path) -> None:
    """Make a temporary file in a folder; an OSError is raised if that is impossible."""
    handle, name = tempfile.mkstemp(prefix=".mcexact-", dir=folder)
    os.close(handle)
    os.unlink(name)


def write_result(path: Path, content: str | bytes) -> None:
    """Write a result to a file, completely or not at all, and say so on standard error.

    Raises
    ------
    NotWritten
        If it cannot be written.
    """
    write_bytes(path, content if isinstance(content, bytes) else content.encode("utf-8"))
    say_written(path)


def say_written(path: Path, files: int | None = None) -> None:
    """Say on standard error that a file was written, or a number of files into a folder.

    Nothing is said of a stream such as ``/dev/stdout``.

    Parameters
    ----------
    path : Path
        The file or the folder.
    files : int, optional
        The number of files in a folder.
    """
    if files is not None:
        number = "1 file" if files == 1 else f"{files} files"
        click.echo(f"mcexact: wrote {number} into {path}{os.sep}", err=True)
    elif path.is_file():
        click.echo(f"mcexact: wrote {path}", err=True)


def directory(path: Path) -> Path:
    """Make the directory at a path if it is missing, and return the path.

    Raises
    ------
    NotWritten
        If it cannot be made, or something else has that name.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise NotWritten(f"cannot be made a directory: {error.strerror}", where=str(path)) from None
    return path


_LEAST_GRACE = 5.0
"""Seconds that it may take at least to show and to re-check what was decided in time."""


class Deadline:
    """A time limit of some seconds, or no limit.

    Parameters
    ----------
    seconds : float or None
        None means that there is no limit.
    start : float, optional
        When the time began, by the clock of `time.monotonic`; by default now.
    """

    def __init__(self, seconds: float | None, start: float | None = None) -> None:
        self.seconds = seconds
        self._start = time.monotonic() if start is None else start
        self._stated = seconds

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
        allowed._stated = self._stated
        return allowed

    def missed(self, doing: str) -> LimitReached:
        """Return the error to raise when the time is over."""
        return LimitReached(
            f"the time limit of {self._stated:g} s was reached while {doing}; "
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


def require_replaceable(folder: Path, mark: str) -> None:
    """Refuse an output folder that does not contain an earlier result, or cannot be replaced.

    Parameters
    ----------
    folder : Path
        It must be missing, be empty, or contain the mark.
    mark : str
        The name of a file that every earlier result contains.

    Raises
    ------
    InputError
        If the folder contains something else, or nothing can be written beside it.
    """
    require_writable(None, Path(os.path.realpath(folder)).parent)
    if not folder.exists():
        return
    if not folder.is_dir():
        raise InputError("expected a folder, found a file", where=str(folder))
    if any(folder.iterdir()) and not (folder / mark).is_file():
        raise InputError(
            f"holds other files and no {mark}; name a new or empty folder", where=str(folder)
        )


def write_folder(folder: Path, files: Mapping[str, str]) -> None:
    """Write files into a new folder, rename it to the folder's name, and say so.

    Parameters
    ----------
    folder : Path
        An earlier result there is replaced.
    files : mapping from relative paths to texts

    Raises
    ------
    NotWritten
        If it cannot be written.
    """
    target = Path(os.path.realpath(folder))
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        scratch = Path(tempfile.mkdtemp(prefix=".mcexact-", dir=target.parent))
        try:
            scratch.chmod(0o755)
            for name, text in files.items():
                path = scratch / "new" / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(text.encode("utf-8"))
            if target.exists():
                target.rename(scratch / "old")
            try:
                (scratch / "new").rename(target)
            except BaseException:
                if (scratch / "old").exists():
                    (scratch / "old").rename(target)
                raise
        finally:
            shutil.rmtree(scratch, ignore_errors=True)
    except OSError as error:
        raise NotWritten(f"cannot write: {error.strerror or error}", where=str(folder)) from error
    say_written(folder, len(files))


def emit_tables(tables: Sequence[Table], width: int | None = None) -> None:
    """Draw tables if standard output is a terminal, otherwise write plain lines.

    Parameters
    ----------
    tables : sequence of Table
    width : int, optional
        The width of plain lines in characters.
    """
    if sys.stdout is not None and sys.stdout.isatty():
        show(tables, sys.stdout)
    else:
        emit(plain(tables, width or WIDTH))
