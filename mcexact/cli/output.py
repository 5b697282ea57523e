"""Writing to standard output, also when the reader closes the pipe."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mcexact.report.text import Table


def emit(text: str) -> None:
    """Write text to standard output, and stop without an error if its reader has closed it.

    A character that the terminal's encoding lacks is written as an escape.
    """
    stream = sys.stdout
    try:
        try:
            stream.write(text)
        except UnicodeEncodeError:
            encoding = stream.encoding or "ascii"
            stream.write(text.encode(encoding, "backslashreplace").decode(encoding))
        stream.flush()
    except BrokenPipeError:
        # The interpreter flushes again when it exits, which must not raise another error.
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def emit_json(document: Any) -> None:
    """Write one JSON document to standard output."""
    emit(json.dumps(document, indent=2, ensure_ascii=True) + "\n")


def emit_tables(tables: Sequence[Table], width: int | None = None) -> None:
    """Draw tables if standard output is a terminal, otherwise write plain lines.

    Parameters
    ----------
    tables : sequence of Table
    width : int, optional
        The width of plain lines in characters.
    """
    from mcexact.report.text import WIDTH, plain, show

    if sys.stdout.isatty():
        show(tables, sys.stdout)
    else:
        emit(plain(tables, width or WIDTH))
