"""Campaigns over drawn systems by number, whose rows are kept: an interrupted one continues."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

Examined = tuple[list[str], Mapping[str, int]]
"""What is wrong with one system, and what was looked at, in numbers."""


def main(
    arguments: Sequence[str],
    usual: int,
    usual_file: Path,
    examined: Callable[[int], Examined],
    wrong_are: str,
    one: str = "system",
) -> int:
    """Examine the drawn systems that are not in the file yet; print what was found in all.

    Parameters
    ----------
    arguments : sequence of str
        How many systems, the first of them, and the file of rows; each may be left out.
    usual, usual_file
        How many there are, and their file, if nothing is said.
    examined : callable
        What was found of the system with a number.
    wrong_are : str
        What is printed of the number of things that are wrong.
    one : str
        What is printed in front of the number of one of them.
    """
    number_of, first_of, file_of, *_ = [
        *arguments,
        *[str(usual), "0", str(usual_file)][len(arguments) :],
    ]
    path = Path(file_of)
    path.parent.mkdir(parents=True, exist_ok=True)
    numbers = range(int(first_of), int(first_of) + int(number_of))
    done: dict[int, Any] = {}
    if path.exists():
        rows = map(json.loads, path.read_text(encoding="utf-8").splitlines())
        done = {row["number"]: row for row in rows}
    with path.open("a", encoding="utf-8") as file:
        for number in numbers:
            if number not in done:
                wrong, seen = examined(number)
                done[number] = {"number": number, "wrong": wrong, "seen": dict(seen)}
                print(json.dumps(done[number]), file=file, flush=True)
    total: Counter[str] = Counter()
    for number in numbers:
        total.update(done[number]["seen"])
        total[wrong_are] += len(done[number]["wrong"])
        for what in done[number]["wrong"]:
            print(f"{one} {number}: {what}")
    print(", ".join(f"{value} {key}" for key, value in total.items()))
    return int(total[wrong_are] > 0)
