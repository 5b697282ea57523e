"""Standard output, also when its reader closes the pipe.

Every start of the command line loads this module, and none of the package besides errors.  `emit`
stops without an error where the reader of a pipe has seen enough, as `head` has; `deliver` raises
one, for `mcexact check`, whose status must not speak of verdicts that nobody received.
`has_written` says whether a document was begun, since an error as JSON may only stand alone.
"""

from __future__ import annotations

import json
import os
import sys
from typing import Any, TextIO

from mcexact.errors import NotWritten

_PLACE = "standard output"
_run = {"written": False}


def begin() -> None:
    """Begin a run, which has written nothing."""
    _run["written"] = False


def has_written() -> bool:
    """Whether this run has written to standard output, or tried to."""
    return _run["written"]


def deliver(text: str) -> None:
    """Write text to standard output.

    A character that the terminal's encoding lacks is written as an escape.

    Raises
    ------
    NotWritten
        If that is impossible, also because the reader of a pipe has closed it.
    """
    _run["written"] = True
    stream: TextIO | None = sys.stdout
    if stream is None:
        raise NotWritten("cannot be written: it is closed", where=_PLACE)
    try:
        try:
            stream.write(text)
        except UnicodeEncodeError:
            encoding = stream.encoding or "ascii"
            stream.write(text.encode(encoding, "backslashreplace").decode(encoding))
        stream.flush()
    except OSError as error:
        # The interpreter flushes again when it exits, which must not raise another error.
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
        left = isinstance(error, BrokenPipeError)
        reason = f"cannot be written: {error.strerror}"
        raise NotWritten(reason, where=_PLACE, reader_left=left) from None


def emit(text: str) -> None:
    """Write text to standard output, and stop without an error if its reader has closed it.

    Raises
    ------
    NotWritten
        If it cannot be written for another reason.
    """
    try:
        deliver(text)
    except NotWritten as error:
        if not error.reader_left:
            raise


def emit_json(document: Any) -> None:
    """Write one JSON document to standard output."""
    emit(json_text(document))


def json_text(document: Any) -> str:
    """The text of one JSON document, as it is printed."""
    return json.dumps(document, indent=2, ensure_ascii=True) + "\n"
