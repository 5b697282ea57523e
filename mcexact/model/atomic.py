"""Write a file completely or not at all."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from mcexact.errors import InputError, NotWritten, place_of


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Write a text to a file under a temporary name that is then renamed.

    Parameters
    ----------
    path : path
        If this is a symbolic link, the file that it points to is replaced.  A path that is not a
        regular file, such as ``/dev/stdout``, is opened and written to.
    text : str

    Raises
    ------
    NotWritten
        If the folder is missing or cannot be written.
    InputError
        If the path is no name of a file.
    """
    write_bytes(path, text.encode("utf-8"))


def write_bytes(path: str | os.PathLike[str], data: bytes) -> None:
    """Write bytes to a file as `write_text` writes a text.

    Raises
    ------
    NotWritten
        If the folder is missing or cannot be written.
    InputError
        If the path is no name of a file.
    """
    place = place_of(path)
    try:
        target = Path(os.path.realpath(path))
        # For a stream, the target of the link is not a name that can be opened.
        if os.path.exists(path) and not os.path.isfile(path):
            with open(path, "wb") as stream:
                stream.write(data)
            return
        _replace(target, data)
    except OSError as error:
        raise NotWritten(f"cannot write: {error.strerror or error}", where=place) from error
    except ValueError as error:
        raise InputError(f"is not a file name: {error}", where=repr(path)) from error


def _replace(target: Path, data: bytes) -> None:
    """Write a temporary file beside the target, then rename it."""
    handle, temporary = tempfile.mkstemp(prefix=".mcexact-", dir=target.parent)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(data)
        if target.exists():
            mode = target.stat().st_mode & 0o777
        else:
            # mkstemp makes files private; this file should be as readable as other new files.
            mask = os.umask(0)
            os.umask(mask)
            mode = 0o666 & ~mask
        os.chmod(temporary, mode)
        os.replace(temporary, target)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise
