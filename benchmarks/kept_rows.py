"""Rows of a long benchmark, kept in a file, so that the next run goes on where one stopped.

A file has one JSON document a line, with the machine on which it was measured.  ``rows/`` holds
those of the project; remove a row to measure it anew.
"""

from __future__ import annotations

import json
import os
import platform
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

Row = dict[str, Any]
ROWS = Path(__file__).parent / "rows"


def chosen(arguments: list[str], name: str) -> tuple[Path, list[str]]:
    """The file of rows, by default the project's of this name, and the other arguments."""
    if arguments and arguments[0].endswith(".jsonl"):
        return Path(arguments[0]), arguments[1:]
    return ROWS / f"{name}.jsonl", arguments


def machine() -> str:
    """The processor, and how many there are."""
    told = Path("/proc/cpuinfo")
    lines = told.read_text("utf-8").splitlines() if told.exists() else []
    models = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    model = models[0] if models else platform.processor() or platform.machine()
    return f"{model}, {os.cpu_count()} processors"


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
    """The row of this name: the kept one, or else a new one, which is appended to the file.

    Seconds are those of the whole measurement, unless the row says them itself.
    """
    if name in known:
        return known[name]
    began = time.process_time()
    found = {"name": name, **measure()}
    found.setdefault("seconds", round(time.process_time() - began, 1))
    found["machine"] = machine()
    with path.open("a", encoding="utf-8") as file:
        if path.stat().st_size and not path.read_bytes().endswith(b"\n"):
            file.write("\n")
        file.write(json.dumps(found) + "\n")
    return found
