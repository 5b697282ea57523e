"""The campaign: every try is checked, what is accepted is judged, and everything is counted."""

from __future__ import annotations

import json
import multiprocessing
import signal
import sys
import time
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from mcexact.checker.kinds import Verdict, check_document
from tests.oracle.certificates.judge import TRUE, UNDECIDED, judge
from tests.oracle.certificates.statement import statement
from tests.oracle.certificates.words import sha256

from .meaning import meaning
from .report import Report
from .tries import ORDER, Batch, Try, batch_numbers, drawn_batch, tries

SECONDS = 20.0
"""Of processor time, after which a check is given up; an honest one takes milliseconds."""

Check = Callable[[bytes | Mapping[str, Any]], Verdict]


class Hung(BaseException):
    """No handler of errors takes this for one of its own."""


@contextmanager
def patience(seconds: float) -> Iterator[None]:
    """Stop what does not end."""

    def stop(*_: Any) -> None:
        raise Hung

    before = signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)


def checked(made: Any, check: Check = check_document, seconds: float = SECONDS) -> Verdict | None:
    """The checker's verdict, or None if it does not end."""
    data = made.encode("utf-8", "surrogatepass") if isinstance(made, str) else made
    try:
        with patience(seconds):
            return check(data)
    except Hung:
        return None


def judged(document: Mapping[str, Any]) -> tuple[str, str]:
    """The oracle's verdict."""
    try:
        with patience(SECONDS):
            return judge(document)
    except Hung:
        return UNDECIDED, "the oracle takes too long"


def parsed(made: Any) -> Any:
    """The document of a try that was accepted; a key that is given twice makes it none."""
    if not isinstance(made, str):
        return made

    def object_of(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        found = dict(pairs)
        return found if len(found) == len(pairs) else {"twice": True}

    return json.loads(made, object_pairs_hook=object_of)


def rows_of(attempt: Try, batch: Batch) -> list[tuple[str, str]]:
    """The rows of the report in which a try is counted."""
    rows = [("all", "all"), ("kind", attempt.kind), ("mutator", attempt.mutator)]
    steps = {step["construction"] for step in batch.original["subject"]}
    return rows + [("construction", name) for name in sorted(steps or {"none"})]


def run_batch(number: int, report: Report, only: int | None = None) -> Try | None:
    """All tries of a batch; with ``only``, those up to one of them, which is given back."""
    batch = drawn_batch(number)
    for attempt in tries(number, batch):
        verdict = checked(attempt.document)
        outcome, why = _outcome(attempt, verdict, report)
        if outcome == "rejected" and isinstance(attempt.document, dict) and verdict is not None:
            batch.rejected = attempt.document, verdict.place
        found = "none" if verdict is None else verdict.verdict
        if found == "INCOMPLETE" and verdict is not None:
            found = f"INCOMPLETE {verdict.code}"
        report.count([*rows_of(attempt, batch), ("verdict", found)], outcome)
        if outcome in ("false", "errors", "time-outs"):
            report.findings.append(_finding(attempt, outcome, why))
        if attempt.number == only:
            return attempt
    return None


def _finding(attempt: Try, what: str, why: str) -> dict[str, Any]:
    return {
        "what": what,
        "why": why,
        "try": attempt.number,
        "kind": attempt.kind,
        "mutator": attempt.mutator,
        "document": attempt.document,
    }


def _outcome(attempt: Try, verdict: Verdict | None, report: Report) -> tuple[str, str]:
    if verdict is None:
        return "time-outs", "the check does not end"
    if verdict.verdict == "ERROR":
        return "errors", verdict.line()
    if verdict.verdict != "VALID":
        if attempt.mutator == "original":
            return "errors", f"a true certificate is refused: {verdict.line()}"
        return "rejected", ""
    document = parsed(attempt.document)
    judgment, why = judged(document)
    if judgment == TRUE:
        why = misstated(document, verdict, report)
        return ("false" if why else "true"), why
    return judgment, why


def misstated(document: Mapping[str, Any], verdict: Verdict, report: Report) -> str:
    """What is wrong with the statement of an accepted certificate, if anything is."""
    expected = statement(document)
    if verdict.statement != expected:
        return f"another statement is specified: {expected}"
    if verdict.statement_digest != sha256(expected):
        return "another digest of the statement is specified"
    said = sha256(meaning(document))
    if report.statements.setdefault(verdict.statement_digest, said) != said:
        return "the same statement as that of a certificate that means something else"
    if report.meanings.setdefault(said, verdict.statement_digest) != verdict.statement_digest:
        return "another statement than that of a certificate that means the same"
    return ""


def _share(numbers: Sequence[int]) -> Report:
    """Some batches as one process runs them."""
    report, start = Report(), time.process_time()
    for number in numbers:
        run_batch(number, report)
    report.seconds = time.process_time() - start
    return report


def run(count: int, processes: int = 2, kinds: Collection[str] = ORDER) -> Report:
    """At least so many tries about some kinds, in several processes."""
    numbers = batch_numbers(count, kinds)
    report = Report()
    if processes == 1:
        report.add(_share(numbers))
        return report
    # many small shares, so that a report is there soon and no process waits long for the others
    shares = min(len(numbers), processes * 16)
    with multiprocessing.get_context("fork").Pool(processes) as pool:
        jobs = [pool.apply_async(_share, (numbers[k::shares],)) for k in range(shares)]
        seen: list[Any] = []
        for job in jobs:
            report.add(job.get())
            done, found = report.total("tries"), len(report.findings)
            print(f"{done:,} tries, {found} findings", file=sys.stderr, flush=True)
            for finding in report.findings[len(seen) :]:
                print(f"  {finding['what']}: {finding.get('why')}", file=sys.stderr, flush=True)
            seen = report.findings[:]
    return report


def save(report: Report, path: Path) -> None:
    """Write every finding to a file, one a line."""
    path.write_text("".join(json.dumps(found) + "\n" for found in report.findings))
