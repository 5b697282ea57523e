"""Write a folder of files completely or not at all."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path

from mcexact.cli.files import require_writable, say_written
from mcexact.errors import InputError, NotWritten


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
        made = Path(tempfile.mkdtemp(prefix=".mcexact-", dir=target.parent))
        try:
            made.chmod(0o755)
            for name, text in files.items():
                path = made / "new" / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
            if target.exists():
                target.rename(made / "old")
            try:
                (made / "new").rename(target)
            except BaseException:
                if (made / "old").exists():
                    (made / "old").rename(target)
                raise
        finally:
            shutil.rmtree(made, ignore_errors=True)
    except OSError as error:
        raise NotWritten(f"cannot write: {error.strerror or error}", where=str(folder)) from error
    say_written(folder, len(files))
