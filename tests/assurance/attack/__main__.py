"""The command line of the campaign."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Collection
from pathlib import Path

from .campaign import run, run_batch, save
from .harmless import HARMLESS
from .report import Report
from .tries import ORDER, SIZE
from .weakened import UNEXPLAINED, UNTRIED, search, table


def main(arguments: list[str] | None = None) -> int:
    """Run so many tries, or one of them again."""
    parser = argparse.ArgumentParser(prog="python -m tests.assurance.attack", description=__doc__)
    parser.add_argument("tries", nargs="?", type=int, default=10_000)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--only", type=int, metavar="K", help="run one try, and print its document")
    parser.add_argument("--findings", type=Path, default=Path("attack-findings.jsonl"))
    parser.add_argument("--weakened", type=Path, metavar="FILE", help="leave out each condition")
    parser.add_argument(
        "--functions",
        nargs="+",
        default=[],
        metavar="NAME",
        help="with --weakened, leave out the conditions of these alone",
    )
    parser.add_argument("--kinds", nargs="+", choices=ORDER, default=ORDER, metavar="KIND")
    given = parser.parse_args(arguments)
    if given.weakened is not None:
        return weakened(given.tries, given.processes, given.kinds, given.weakened, given.functions)
    if given.only is not None:
        report = Report()
        attempt = run_batch(given.only // SIZE, report, given.only)
        print(
            json.dumps(
                {"mutator": attempt.mutator, "document": attempt.document} if attempt else None
            )
        )
        print(
            "\n".join(str(found["why"]) for found in report.findings if found["try"] == given.only)
        )
        return 0
    report = run(given.tries, given.processes, given.kinds)
    print("\n".join([*report.lines(), *report.shortfalls()]))
    if report.findings:
        save(report, given.findings)
        print(f"{len(report.findings)} findings: see {given.findings}", file=sys.stderr)
    return 1 if report.findings else 0


def weakened(
    count: int, processes: int, kinds: Collection[str], file: Path, only: Collection[str]
) -> int:
    """Write which conditions were missed; 1 if the reason of one is not known."""
    before = file.read_text() if file.exists() else ""
    sites, holes = search(count, processes, kinds, only)
    if not {*only} <= {site.function for site in sites}:
        print("no condition stands in some of these functions", file=sys.stderr)
        return 2
    lines = table(sites, holes, HARMLESS, before, only)
    file.write_text("\n".join(lines) + "\n")
    open_rows = [line for line in lines if UNEXPLAINED in line or UNTRIED in line]
    print("\n".join(open_rows))
    tried = [site for site in sites if not only or site.function in only]
    print(f"{holes.tries} tries, {len(tried)} conditions, {len(holes.found)} holes found")
    return 1 if open_rows else 0


if __name__ == "__main__":
    sys.exit(main())
