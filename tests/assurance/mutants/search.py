"""Find documents that tell changes of the checker from the checker.

    python -m tests.assurance.mutants.search [--batches N] [--kinds KIND…] [--files N]
        [--workers K] [STEM…]

Draws certificates as the campaign does, and system files and controller files as the comparisons
of the readers do, loads the checker with each change of its files in turn, and looks for the
shortest document on which it answers otherwise.  What is found is added to
``tests/checker/corpus/kept.jsonl`` unless a document that is there already tells them apart, so
that the tests of the checker notice the change from then on.  With ``--kinds`` only certificates of
these kinds are drawn.  ``--again`` searches for nothing, and answers what is kept anew: after a
change of what the checker says.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
import random
import sys
import time
from collections import defaultdict
from collections.abc import Collection, Iterator
from pathlib import Path

from tests.assurance.attack.campaign import checked
from tests.assurance.attack.tries import ORDER, SIZE, batch_numbers, drawn_batch, tries
from tests.assurance.campaigns import controller_grammar, grammar
from tests.assurance.mutants import explained, operators, session, topics
from tests.assurance.mutants.documents import HANGS, NONE, UNLOADABLE, telling
from tests.checker.kept import KEPT, Case, answer, group

CHECKER = Path("mcexact/checker")
LONGEST = 6000
"""Bytes of a document that may be kept."""
MOST = 1500
"""Documents of one kind that are tried on a change of the module that checks this kind."""
MIXED = 3000
"""Documents of all kinds that are tried on a change of another module, about as many of each."""


def certificates(batches: int, kinds: Collection[str]) -> Iterator[Case]:
    """Documents of the campaign, in its first batches about some kinds."""
    for number in batch_numbers(batches * SIZE, kinds):
        batch = drawn_batch(number)
        for attempt in tries(number, batch):
            found = checked(attempt.document)
            if found is not None and found.status and isinstance(attempt.document, dict):
                batch.rejected = attempt.document, found.place
            yield {"read": "certificate", "document": attempt.document}


def files(number: int) -> Iterator[Case]:
    """Files of systems and of controllers, drawn and damaged."""
    for k in range(number):
        for name, module in (("system", grammar), ("controller", controller_grammar)):
            rng = random.Random(f"{name} {k}")
            data, _ = grammar.damaged_file(module.drawn_document(rng), rng)
            limits = grammar.drawn_limits(rng)
            given = {
                key: getattr(limits, key)
                for key in ("bytes", "depth", "digits", "exponent")
                if getattr(limits, key) != getattr(grammar.Limits(), key)
            }
            yield {
                "read": name,
                "document": data.decode("utf-8", "surrogateescape"),
                **({"limits": given} if given else {}),
            }


def pool(batches: int, kinds: Collection[str], number: int) -> dict[str, list[Case]]:
    """Documents by what they are about, short ones first, each with the answer of the checker."""
    found: dict[str, dict[str, Case]] = defaultdict(dict)
    for case in (*certificates(batches, kinds), *files(number)):
        line = json.dumps(case)
        if len(line) <= LONGEST and line not in found[group(case)]:
            said = answer(case)
            if not said.startswith(("INCOMPLETE work", "ERROR")):
                found[group(case)][line] = {**case, "answer": said}
    return {name: [cases[k] for k in sorted(cases, key=len)] for name, cases in found.items()}


def tried_on(stem: str, known: dict[str, list[Case]]) -> list[Case]:
    """The documents for changes of one module: of its kinds, or some of every kind."""
    mixed: list[Case] = []
    if own := sorted(topics.kinds(stem) & known.keys()):
        mixed = [case for name in own for case in spread(known[name], MOST)]
        return sorted(mixed, key=lambda case: len(json.dumps(case)))
    for k, name in enumerate(sorted(known, key=lambda name: len(known[name]))):
        mixed += spread(known[name], (MIXED - len(mixed)) // (len(known) - k))
    if stem in ("reading", "system"):
        mixed += [case for name in ("system", "controller") for case in spread(known[name], MOST)]
    return sorted(mixed, key=lambda case: len(json.dumps(case)))


def spread(cases: list[Case], most: int) -> list[Case]:
    """At most so many, of every length; as many VALID ones as others if they are there."""
    good = [case for case in cases if case["answer"].startswith("VALID")]
    rest = [case for case in cases if not case["answer"].startswith("VALID")]
    first = good[:: max(1, -(-len(good) * 2 // most))]
    others = rest[:: max(1, -(-len(rest) // max(1, most - len(first))))]
    return sorted([*first, *others], key=lambda case: len(json.dumps(case)))


def search(stem: str, known: dict[str, list[Case]]) -> list[Case]:
    """The documents that tell the changes of one file apart."""
    begun = time.monotonic()
    path = topics.sources()[stem]
    source, cases = path.read_text(encoding="utf-8"), tried_on(stem, known)
    listed, kept = explained.read(), []
    counts: dict[str, int] = defaultdict(int)
    for changed in session.every(path):
        number, before, after = session.differing(source, changed)
        if listed.holds(stem, before, after):
            continue
        code = compile(changed, str(path), "exec", dont_inherit=True)
        if kept and telling(stem, code, kept[::-1]) >= 0:
            counts["known"] += 1
            continue
        k = telling(stem, code, cases)
        counts[{NONE: "none", HANGS: "hangs", UNLOADABLE: "cannot be loaded"}.get(k, "new")] += 1
        if k >= 0:
            kept.append(cases[k])
        elif k == NONE:
            print(f"{stem}:{number}\n    {before}\n    {after}", flush=True)
    seconds = time.monotonic() - begun
    print(f"{stem}: {dict(counts)}, {len(kept)} kept, {seconds:.0f} s", flush=True)
    return kept


def _share(job: tuple[str, dict[str, list[Case]]]) -> list[Case]:
    operators.register()
    return search(*job)


def write(cases: list[Case]) -> None:
    """Write the documents that are kept, each once."""
    lines = sorted({json.dumps(case) for case in cases})
    KEPT.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")


def main() -> int:
    """Search, and write what is kept."""
    parser = argparse.ArgumentParser(prog="tests.assurance.mutants.search", description=__doc__)
    parser.add_argument("stems", nargs="*", metavar="STEM")
    parser.add_argument("--batches", type=int, default=1500)
    parser.add_argument("--kinds", nargs="+", choices=ORDER, default=ORDER, metavar="KIND")
    parser.add_argument("--files", type=int, default=4000)
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--again", action="store_true")
    options = parser.parse_args()
    text = KEPT.read_text(encoding="utf-8") if KEPT.exists() else ""
    kept = [json.loads(line) for line in text.splitlines()]
    if options.again:
        write([{**case, "answer": answer(case)} for case in kept])
        return 0
    stems = options.stems or sorted(topics.sources())
    known = pool(options.batches, options.kinds, options.files)
    print({name: len(cases) for name, cases in known.items()}, flush=True)
    jobs = [(stem, known) for stem in stems]
    with multiprocessing.get_context("fork").Pool(options.workers) as workers:
        for found in workers.imap_unordered(_share, jobs):
            kept += found
            write(kept)
    return 0


if __name__ == "__main__":
    sys.exit(main())
