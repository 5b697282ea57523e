"""Which conditions of the checker the campaign needs: each is left out, and the hole is found.

Every try that one condition refuses is checked again without that condition.  What is accepted
then, and is false, is a hole that the condition closes.
"""

from __future__ import annotations

import json
import multiprocessing
from collections import Counter
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


def attempt(made: Try, holes: Holes, batch: Any) -> None:
    """Check one try, and once more without the condition that refused it."""
    check = weakened_checker().check_document
    GATES.open, GATES.last = None, None
    verdict = checked(made.document, check)
    holes.tries += 1
    if verdict is None or verdict.verdict in ("VALID", "ERROR"):
        return
    if isinstance(made.document, dict):
        batch.rejected = made.document, verdict.place
    GATES.open = GATES.last
    if GATES.open is None:
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


def _share(numbers: Sequence[int]) -> Holes:
    holes = Holes()
    weakened_checker()
    for number in numbers:
        batch = drawn_batch(number)
        for made in tries(number, batch):
            attempt(made, holes, batch)
    return holes


def attempt_traps(holes: Holes) -> None:
    """Check the documents made by hand, which come before all tries."""
    for k, (name, document) in enumerate(TRAPS.items()):
        made = Try(k - len(TRAPS), document["kind"], None, name, document)
        attempt(made, holes, SimpleNamespace(rejected=None))
    holes.tries = 0


def search(
    count: int, processes: int = 2, kinds: Collection[str] = ORDER
) -> tuple[list[Site], Holes]:
    """Leave out conditions in so many tries about some kinds."""
    numbers, holes = batch_numbers(count, kinds), Holes()
    weakened_checker()
    attempt_traps(holes)
    if processes == 1:
        holes.add(_share(numbers))
        return GATES.sites, holes
    shares = min(len(numbers), processes * 16)
    with multiprocessing.get_context("fork").Pool(processes) as pool:
        jobs = [pool.apply_async(_share, (numbers[k::shares],)) for k in range(shares)]
        for job in jobs:
            holes.add(job.get())
    return GATES.sites, holes


def table(sites: list[Site], holes: Holes, harmless: Mapping[str, str]) -> list[str]:
    """The conditions of every file, what found the hole, and why one without hole is there."""
    order = sorted(enumerate(sites), key=lambda pair: (pair[1].file, pair[1].line, pair[0]))
    found = len(holes.found)
    made = [
        HEADER.format(tries=holes.tries, sites=len(sites), found=found, left=len(sites) - found)
    ]
    for file, group in groupby(order, key=lambda pair: pair[1].file):
        rows = list(group)
        made += ["", f"## `{file}`", "", "| in | condition | refused | hole |", "|---|---|---|---|"]
        for k, site in rows:
            text = site.text.replace("|", "\\|")
            refused = holes.refused[k]
            if k in holes.found:
                number, mutator, why, _ = holes.found[k]
                how = f"try {number:,}, {mutator}" if number >= 0 else f"“{mutator}”"
                said = f"{how}: {why}".replace("|", "\\|")
            else:
                reason = harmless.get(site.key, "not explained")
                said = f"none ({holes.alone[k]} accepted and true): {reason}"
            made.append(f"| `{site.function}` | `{text}` | {refused:,} | {said} |")
    return made


HEADER = """# What the campaign finds when a condition of the checker is left out

`python -m tests.assurance.attack N --weakened FILE` writes this table.  Of {tries:,} tries each one
that a condition refuses is checked again without that condition; what is accepted then and is false
is the hole that the condition closes.  There are {sites} conditions: every `require`, each part of
one that joins several by `and`, and each `if` that does nothing but refuse a document.  A hole is
found for {found}; for each of the other {left} the reason stands in its row.

"Refused" counts the tries that the condition was the first to refuse.  The number of a try says how
many it took, all kinds together; `python -m tests.assurance.attack --only K` makes that document
again.  What is in quotation marks is a document made by hand, in `forgeries/`."""


def documents(holes: Holes) -> list[str]:
    """Every hole with its document, one a line."""
    return [json.dumps([site, *found]) for site, found in sorted(holes.found.items())]
