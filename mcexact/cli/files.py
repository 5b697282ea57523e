"""Reading input files, checking where results can be written, and writing them."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import click

from mcexact.errors import InputError, MissingExtra, NotWritten
from mcexact.errors import place_of as place_of

if TYPE_CHECKING:
    from fractions import Fraction

    from mcexact.cli.deadline import Deadline
    from mcexact.model.parametric import ParametricSystem
    from mcexact.model.system import MultiChannelSystem


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
    from mcexact.exact.rational import Limits
    from mcexact.model.files import read_input

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
    from mcexact.exact.rational import Limits
    from mcexact.model.arrays import Reading
    from mcexact.model.files import read_any

    with InputError.inside(place):
        return read_any(data, place, Reading(Limits(**limits)))


def plant_in(
    place: str, data: bytes, limits: Mapping[str, int], at: Mapping[str, Fraction]
) -> MultiChannelSystem | ParametricSystem:
    """Read a system, with parameters as far as these are given no values.

    Raises
    ------
    InputError
        If it is malformed, or a value is that of no parameter.
    """
    from mcexact.exact.rational import Limits
    from mcexact.model.arrays import Reading
    from mcexact.model.files import read_plant

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
    from mcexact.model.parametric import ParametricSystem

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
    """Refuse one file for two results, of which only one would be left.

    Raises
    ------
    InputError
        If two names are those of one place, whether or not there is anything yet.
    """
    given = [each for each in outputs if each is not None]
    for k, output in enumerate(given):
        if any(_is_place(output, other) for other in given[:k]):
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
        The folder for other results; it will be made, with the folders above it, if it is missing.

    Raises
    ------
    NotWritten
        If a new file cannot be made there, or something else has that name.
    """
    if folder is not None:
        with _refusing(folder):
            made = Path(os.path.realpath(folder))
            if _exists(made) and not made.is_dir():
                raise NotWritten("cannot be made a directory: File exists", where=str(folder))
            _try(_nearest(made))
    if file is not None:
        with _refusing(file):
            if _exists(file) and not file.is_file():
                if file.is_dir() or not os.access(file, os.W_OK):
                    raise NotWritten("cannot write: it is no file", where=str(file))
                return
            target = Path(os.path.realpath(file))
            _exists(target)
            to_be_made = () if folder is None else (made, *made.parents)
            parent = target.parent
            _try(_nearest(parent) if parent in to_be_made else parent)


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
    from mcexact.model.text import write_bytes

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
