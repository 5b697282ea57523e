"""Rows of a long benchmark, kept in a file, so that the next run goes on where one stopped.

A file has one JSON document a line.  Remove it to measure anew.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

Row = dict[str, Any]


def kept(path: Path) -> dict[str, Row]:
    """The rows of a file by their names; a last line that is cut off is left out."""
    found: dict[str, Row] = {}
    if path.exists():
        for line in path.read_text("utf-8").splitlines():
            try:
                row = json.loads(line)
            except json.JSONDecodeError:
                continue
            found[row["name"]] = row
    return found


def measured(path: Path, name: str, measure: Callable[[], Row], known: dict[str, Row]) -> Row:
    """The row of this name: the kept one, or else a new one, which is appended to the file."""
    if name in known:
        return known[name]
    began = time.process_time()
    found = {"name": name, **measure(), "seconds": round(time.process_time() - began, 1)}
    with path.open("a", encoding="utf-8") as file:
        if path.stat().st_size and not path.read_bytes().endswith(b"\n"):
            file.write("\n")
        file.write(json.dumps(found) + "\n")
    return found
