"""What does a bad system file cost until it is refused, beside a good one that is analyzed?"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from benchmarks.fixed_spectrum import Row
from tests.end_to_end import bad_input_files

_TABLE = Path(bad_input_files.__file__).with_name("bad_inputs.json")
_MEASURED = Path(__file__).with_name("measured.py")


@dataclass(frozen=True)
class Cost:
    """What one run used: seconds of processor time, and MiB of memory at most."""

    name: str
    seconds: float
    mebibytes: float


def rows() -> Iterator[Row]:
    """The two questions of this file."""
    table = json.loads(_TABLE.read_text(encoding="utf-8"))
    documents = {"system": table["base_system"], "plant": {}, "certificate": {}}
    good = _cost({"id": "a good file", "argv": ["analyze", "{system}"]}, documents)
    bad = [
        _cost(entry, documents)
        for entry in table["entries"]
        if entry["argv"][0] == "analyze" and entry["exit"] == 3 and _is_plain(entry)
    ]
    slowest = max(bad, key=lambda cost: cost.seconds)
    largest = max(bad, key=lambda cost: cost.mebibytes)
    time, memory = slowest.seconds / good.seconds, largest.mebibytes / good.mebibytes
    yield Row(
        f"the slowest of {len(bad)} refusals, against an analysis",
        time,
        "<= 2",
        time <= 2,
        f"{slowest.name}: {slowest.seconds:.2f} s / {good.seconds:.2f} s",
    )
    yield Row(
        f"the largest of {len(bad)} refusals, against an analysis",
        memory,
        "<= 3",
        memory <= 3,
        f"{largest.name}: {largest.mebibytes:.0f} MiB / {good.mebibytes:.0f} MiB",
    )


def _is_plain(entry: bad_input_files.Entry) -> bool:
    """Whether an entry is about a system file, and run as it stands."""
    return entry.get("base", "system") == "system" and not {"shell", "closed_stdin"} & entry.keys()


def _cost(entry: bad_input_files.Entry, documents: bad_input_files.Entry) -> Cost:
    """Run the program on an entry of the table."""
    with tempfile.TemporaryDirectory() as folder:
        usage = Path(folder) / "usage.txt"
        program = [sys.executable, "-m", "mcexact"]
        program += bad_input_files.arguments(entry, Path(folder), documents)
        subprocess.run(
            [sys.executable, "-S", "-E", str(_MEASURED), str(usage), *program],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            check=False,
        )
        seconds, mebibytes = map(float, usage.read_text(encoding="ascii").split())
    return Cost(f"{entry['id']} {entry.get('title', '')}".strip(), seconds, mebibytes)
