"""What commands read, and the folders that results go to."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from mcexact.errors import InputError
from mcexact.errors import place_of as place_of

if TYPE_CHECKING:
    from mcexact.cli.deadline import Deadline
    from mcexact.model.system import MultiChannelSystem


def read(file: str, limits: Mapping[str, int], deadline: Deadline) -> bytes:
    """The bytes of a file, or of the standard input for ``-``.

    This is done before a child process is started, which has no standard input.  A pipe into which
    nobody writes is waited for, until the deadline.

    Raises
    ------
    InputError
        If it is missing, unreadable or too large.
    LimitReached
        If the deadline is missed.
    """
    from mcexact.exact.rational import Limits
    from mcexact.model.json_text import read_bytes

    place = place_of(file)
    with InputError.inside(place), deadline.interrupting(f"reading {place}"):
        return read_bytes(file, Limits(**limits))


def system_in(place: str, data: bytes, limits: Mapping[str, int]) -> MultiChannelSystem:
    """The system in the bytes of a file, the place named in whatever is wrong with it.

    Raises
    ------
    InputError
        If it is malformed.
    """
    from mcexact.exact.rational import Limits
    from mcexact.model.system_file import read_system

    with InputError.inside(place):
        return read_system(data, limits=Limits(**limits))


def require_other(output: Path | None, *inputs: str | None) -> None:
    """Refuse to write a result over what it is made of, also by way of a link.

    Raises
    ------
    InputError
        If the output is one of the inputs.
    """
    for file in inputs:
        if output is not None and file is not None and _is_same(output, file):
            raise InputError("is read as well: write to another file", where=str(output))


def _is_same(output: Path, file: str) -> bool:
    try:
        return output.is_file() and output.samefile(file)
    except OSError:
        return False


def require_writable(file: Path | None, folder: Path | None = None) -> None:
    """Refuse, before the work, what could not be written after it; nothing is made or changed.

    Parameters
    ----------
    file : Path or None
        Where a result goes; its folder exists, or is made for the other results.
    folder : Path or None
        Where other results go; it is made, with the folders above it, where it is missing.

    Raises
    ------
    InputError
        If a new file cannot be made there, or something else stands there.
    """
    if folder is not None:
        with _refusing(folder):
            made = Path(os.path.realpath(folder))
            if _exists(made) and not made.is_dir():
                raise InputError("cannot be made a directory: File exists", where=str(folder))
            _try(_nearest(made))
    if file is not None:
        with _refusing(file):
            if _exists(file) and not file.is_file():
                if file.is_dir() or not os.access(file, os.W_OK):
                    raise InputError("cannot write: it is no file", where=str(file))
                return
            target = Path(os.path.realpath(file))
            _exists(target)
            to_be_made = () if folder is None else (made, *made.parents)
            parent = target.parent
            _try(_nearest(parent) if parent in to_be_made else parent)


@contextlib.contextmanager
def _refusing(path: Path) -> Iterator[None]:
    """What the system says against writing, as an error of the input."""
    try:
        yield
    except OSError as error:
        raise InputError(f"cannot write: {error.strerror or error}", where=str(path)) from None
    except ValueError as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"is no file name: {error}", where=repr(str(path))) from None


def _exists(path: Path) -> bool:
    """Whether something stands there; an OSError if nothing ever could."""
    try:
        path.stat()
    except FileNotFoundError:
        return False
    return True


def _nearest(folder: Path) -> Path:
    """The folder, or the nearest one above it that exists."""
    while not _exists(folder):
        folder = folder.parent
    return folder


def _try(folder: Path) -> None:
    """Make a file without a lasting name in a folder; an OSError if that is impossible."""
    handle, name = tempfile.mkstemp(prefix=".mcexact-", dir=folder)
    os.close(handle)
    os.unlink(name)


def directory(path: Path) -> Path:
    """The directory at this path, made if it is missing.

    Raises
    ------
    InputError
        If it cannot be made, or if something else stands there.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot be made a directory: {error.strerror}", where=str(path)) from None
    return path
