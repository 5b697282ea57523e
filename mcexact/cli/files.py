"""What commands read, and the folders that results go to."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from mcexact.errors import InputError

if TYPE_CHECKING:
    from mcexact.cli.deadline import Deadline
    from mcexact.model.system import MultiChannelSystem


def place_of(file: str) -> str:
    """What messages call a file."""
    return "standard input" if file == "-" else file


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

    try:
        with deadline.interrupting(f"reading {place_of(file)}"):
            return read_bytes(file, Limits(**limits))
    except InputError as error:
        raise error.within(place_of(file)) from None


def system_in(place: str, data: bytes, limits: Mapping[str, int]) -> MultiChannelSystem:
    """The system in the bytes of a file, the place named in whatever is wrong with it.

    Raises
    ------
    InputError
        If it is malformed.
    """
    from mcexact.exact.rational import Limits
    from mcexact.model.system_file import read_system

    try:
        return read_system(data, limits=Limits(**limits))
    except InputError as error:
        raise error.within(place) from None


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
