"""Which conditions of the checker the campaign needs: each is left out, and the hole is found.

Every try that one condition refuses is checked again without that condition.  What is accepted
then, and is false, is a hole that the condition closes.
"""

from __future__ import annotations

import json
import multiprocessing
import re
from collections import Counter, defaultdict
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import groupby
from types import SimpleNamespace
from typing import Any

from tests.oracle.certificates.judge import FALSE, TRUE

from .campaign import checked, judged, parsed
from .conditions import GATES, Site, weakened_checker
from .forgeries import TRAPS
from .tries import ORDER, Try, batch_numbers, drawn_batch, tries


@dataclass
class Holes:
    """What leaving out each condition has led to.

    Attributes
    ----------
    refused : Counter
        How many tries a condition refused, as the only one or as the first.
    alone : Counter
        How many of them no other condition refused.
    found : dict
        The first try that is false and accepted without the condition.
    """

    refused: Counter[int] = field(default_factory=Counter)
    alone: Counter[int] = field(default_factory=Counter)
    true: Counter[int] = field(default_factory=Counter)
    found: dict[int, tuple[int, str, str, Any]] = field(default_factory=dict)
    tries: int = 0

    def add(self, other: Holes) -> None:
        """What another process has found."""
        self.refused.update(other.refused)
        self.alone.update(other.alone)
        self.true.update(other.true)
        self.tries += other.tries
        for site, hole in other.found.items():
            self.found[site] = min(self.found.get(site, hole), hole, key=lambda h: h[0])


def attempt(made: Try, holes: Holes, batch: Any, only: Collection[str] = ()) -> None:
    """Check one try, and once more without the condition that refused it.

    With ``only``, conditions of other functions are not left out.
    """
    check = weakened_checker().check_document
    GATES.open, GATES.last = None, None
    verdict = checked(made.document, check)
    holes.tries += 1
    if verdict is None or verdict.verdict in ("VALID", "ERROR"):
        return
    if isinstance(made.document, dict):
        batch.rejected = made.document, verdict.place
    GATES.open = GATES.last
    if GATES.open is None or (only and GATES.sites[GATES.open].function not in only):
        return
    holes.refused[GATES.open] += 1
    if GATES.open in holes.found:
        return
    again = checked(made.document, check, seconds=1.0)
    if again is None or again.verdict != "VALID":
        return
    holes.alone[GATES.open] += 1
    judgment, why = judged(parsed(made.document))
    if judgment == FALSE:
        holes.found[GATES.open] = made.number, made.mutator, why, made.document
    elif judgment == TRUE:
        holes.true[GATES.open] += 1


def _share(numbers: Sequence[int], only: Collection[str] = ()) -> Holes:
    holes = Holes()
    weakened_checker()
    for number in numbers:
        batch = drawn_batch(number)
        for made in tries(number, batch):
            attempt(made, holes, batch, only)
    return holes


def attempt_traps(holes: Holes, only: Collection[str] = ()) -> None:
    """Check the documents made by hand, which come before all tries."""
    for k, (name, document) in enumerate(TRAPS.items()):
        made = Try(k - len(TRAPS), document["kind"], None, name, document)
        attempt(made, holes, SimpleNamespace(rejected=None), only)
    holes.tries = 0


def search(
    count: int,
    processes: int = 2,
    kinds: Collection[str] = ORDER,
    only: Collection[str] = (),
) -> tuple[list[Site], Holes]:
    """Leave out conditions in so many tries about some kinds; ``only`` those of some functions."""
    numbers, holes = batch_numbers(count, kinds), Holes()
    weakened_checker()
    attempt_traps(holes, only)
    if processes == 1:
        holes.add(_share(numbers, only))
        return GATES.sites, holes
    shares = min(len(numbers), processes * 16)
    with multiprocessing.get_context("fork").Pool(processes) as pool:
        jobs = [pool.apply_async(_share, (numbers[k::shares], only)) for k in range(shares)]
        for job in jobs:
            holes.add(job.get())
    return GATES.sites, holes


def table(
    sites: list[Site],
    holes: Holes,
    harmless: Mapping[str, str],
    before: str = "",
    only: Collection[str] = (),
) -> list[str]:
    """The conditions of every file, what found the hole, and why one without hole is there.

    With ``only``, the rows of other functions are those of the table ``before``.
    """
    order = sorted(enumerate(sites), key=lambda pair: (pair[1].file, pair[1].line, pair[0]))
    known, made, found = rows_by_condition(before), list[str](), 0
    for file, group in groupby(order, key=lambda pair: pair[1].file):
        made += ["", f"## `{file}`", "", "| in | condition | refused | hole |", "|---|---|---|---|"]
        for k, site in group:
            start = start_of(site)
            if not only or site.function in only:
                row = f"{start} {_found(k, site, holes, harmless, partial=bool(only))}"
            else:
                rest = known[file, start]
                row = start + (rest.pop(0) if rest else f" 0 | {UNTRIED}")
            found += "| none (" not in row and UNTRIED not in row
            made.append(row)
    whole = re.search("Of ([0-9,]+) tries", before) if only else None
    tries = whole[1] if whole else f"{holes.tries:,}"
    left = len(sites) - found
    return [HEADER.format(tries=tries, sites=len(sites), found=found, left=left), *made]


def start_of(site: Site) -> str:
    """The start of the row of a condition."""
    text = site.text.replace("|", "\\|")
    return f"| `{site.function}` | `{text}` |"


def rows_by_condition(before: str) -> defaultdict[tuple[str, str], list[str]]:
    """What a table says of each condition: the rest of a row by its file and its start."""
    file, known = "", defaultdict[tuple[str, str], list[str]](list)
    for line in before.splitlines():
        if line.startswith("## "):
            file = line[4:-1]
        elif row := re.fullmatch("([|] `.*?` [|] `.*?` [|])( [0-9].*)", line):
            known[file, row[1]].append(row[2])
    return known


def _found(k: int, site: Site, holes: Holes, harmless: Mapping[str, str], partial: bool) -> str:
    """The end of a row: how often a condition refused, and its hole or the reason of none."""
    refused = f"{holes.refused[k]:,}" + (f" of {holes.tries:,}" if partial else "")
    if k not in holes.found:
        reason = harmless.get(site.key, UNEXPLAINED)
        return f"{refused} | none ({holes.alone[k]} accepted and true): {reason} |"
    number, mutator, why, _ = holes.found[k]
    how = f"try {number:,}, {mutator}" if number >= 0 else f"“{mutator}”"
    said = f"{how}: {why}".replace("|", "\\|")
    return f"{refused} | {said} |"


UNEXPLAINED, UNTRIED = "not explained", "not tried |"

HEADER = """# What the campaign finds when a condition of the checker is left out

`python -m tests.assurance.attack N --weakened FILE` writes this table.  Of {tries} tries each one
that a condition refuses is checked again without that condition; what is accepted then and is false
is the hole that the condition closes.  There are {sites} conditions: every `require`, each part of
one that joins several by `and`, and each `if` that does nothing but refuse a document.  A hole is
found for {found}; for each of the other {left} the reason stands in its row.

"Refused" counts the tries that the condition was the first to refuse; "12 of 20,000" stands where a
later run, `--functions NAME`, tried a function again that had changed.  The number of a try says
how many it took, all kinds together; `python -m tests.assurance.attack --only K` makes that
document again.  What is in quotation marks is a document made by hand, in `forgeries/`."""


def documents(holes: Holes) -> list[str]:
    """Every hole with its document, one a line."""
    return [json.dumps([site, *found]) for site, found in sorted(holes.found.items())]
