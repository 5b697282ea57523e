"""One session of Cosmic Ray for each file: its mutants, the tests for each, and what came out."""

from __future__ import annotations

import ast
import hashlib
import json
import os
import tempfile
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cosmic_ray.commands import init
from cosmic_ray.mutating import mutate_code
from cosmic_ray.plugins import get_operator
from cosmic_ray.work_db import WorkDB, use_db
from cosmic_ray.work_item import MutationSpec, TestOutcome, WorkerOutcome, WorkItem, WorkResult

from tests.assurance.mutants import explained, operators, topics, warm
from tests.assurance.mutants import selection as selecting
from tests.assurance.mutants.documents import UNLOADABLE, telling
from tests.checker.kept import Case, by_group, group

OUTCOMES = ("killed", "survived", "timeout", "not covered", "abnormal")


@dataclass(frozen=True)
class Selection:
    """The tests that run each line of the checker, and the seconds that each test takes."""

    seconds: list[tuple[str, float]]
    lines: Mapping[str, Mapping[str, list[int]]]

    @staticmethod
    def read(path: Path) -> Selection:
        """Read what ``tests.assurance.mutants.selection`` wrote."""
        written = json.loads(path.read_text(encoding="utf-8"))
        return Selection(written["seconds"], written["lines"])

    def tests(self, stem: str, first: int, last: int) -> list[int]:
        """The tests that run one of some lines; all tests, if loading the file runs them."""
        known = self.lines.get(stem, {})
        found = {k for line in range(first, last + 1) for k in known.get(str(line), ())}
        own = sorted(found - {-1})
        return own + sorted(set(range(len(self.seconds))) - found) if -1 in found else own

    def ordered(self, stem: str, tests: list[int], most: float) -> tuple[list[str], float]:
        """Tests by what they promise: those of the module, those of documents, short ones.

        They end where they would take more than ``most`` seconds.
        """
        chosen, total = [], 0.0
        for k in sorted(tests, key=lambda k: (stage(self.seconds[k][0], stem), self.seconds[k][1])):
            name, seconds = self.seconds[k]
            if total + seconds <= most or not chosen:
                chosen.append(name)
                total += seconds
        return chosen, total


def stage(test: str, stem: str) -> int:
    """0 for a test of the module, 1 for documents that are kept, else 2."""
    if Path(test.partition("::")[0]).name in topics.tests(stem):
        return 0
    return 1 if test.startswith(topics.DOCUMENTS) else 2


def headers(source: str) -> list[tuple[int, int]]:
    """The first and last line of every statement, of a compound one without what it contains."""
    found = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.stmt | ast.ExceptHandler):
            first = min([node.lineno, *(d.lineno for d in getattr(node, "decorator_list", ()))])
            body = getattr(node, "body", None)
            last = body[0].lineno - 1 if body else node.end_lineno or node.lineno
            found.append((first, max(first, last)))
    return found


def plan(path: Path, database: Path) -> None:
    """Write the mutants of a file to its session, unless that is there and the file is the same."""
    if is_current(path, database):
        return
    source = path.read_text(encoding="utf-8")
    database.unlink(missing_ok=True)
    with use_db(str(database), WorkDB.Mode.create) as session:
        init([path], session, {})
        spans = operators.outside(source) + operators.dimensions(source)
        ranks = operators.same_comparisons(source)
        seen, counts = {source}, {"outside": 0, "same comparison": 0, "same or no program": 0}
        for item in session.work_items:
            spec = item.mutations[0]
            reason = _needless(spec, source, spans, ranks, seen)
            if reason:
                counts[reason] += 1
                session.set_result(item.job_id, WorkResult(WorkerOutcome.SKIPPED))
    about = {"source": _digest(path), "operators": _digest(Path(operators.__file__))}
    database.with_suffix(".json").write_text(json.dumps(about | counts), encoding="utf-8")


def is_current(path: Path, database: Path) -> bool:
    """Whether a session is about a file as it is now, and about the operators of now."""
    mark = database.with_suffix(".json")
    if not database.exists() or not mark.exists():
        return False
    about = json.loads(mark.read_text(encoding="utf-8"))
    now = (_digest(path), _digest(Path(operators.__file__)))
    return (about.get("source"), about.get("operators")) == now


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _needless(
    spec: MutationSpec,
    source: str,
    spans: list[operators.Span],
    ranks: list[tuple[operators.Span, tuple[str, ...]]],
    seen: set[str],
) -> str | None:
    """Why a mutant is left out, if it is."""
    for span, suffixes in ranks:
        same = spec.operator_name.endswith(suffixes)
        if same and operators.within(spec.start_pos, spec.end_pos, [span]):
            return "same comparison"
    if operators.within(spec.start_pos, spec.end_pos, spans):
        return "outside"
    code = mutated(spec, source)
    try:
        compile(code, "changed", "exec", dont_inherit=True)
    except SyntaxError:
        return "same or no program"
    if code in seen:
        return "same or no program"
    seen.add(code)
    return None


def every(path: Path) -> Iterator[str]:
    """The text of a file with each change that is tried."""
    with tempfile.TemporaryDirectory() as folder:
        database = Path(folder, "every.sqlite")
        plan(path, database)
        source = path.read_text(encoding="utf-8")
        with use_db(str(database), WorkDB.Mode.open) as found:
            specs = [item.mutations[0] for item in found.pending_work_items]
    yield from (mutated(spec, source) for spec in specs)


def mutated(spec: MutationSpec, source: str) -> str:
    """The file with one change."""
    operator = get_operator(spec.operator_name)()
    return mutate_code(source, operator, spec.occurrence) or source


@dataclass(frozen=True)
class Limits:
    """Which changes of a file are tried.

    Attributes
    ----------
    seconds : float
        Of tests for each of them.
    only : str
        The end of the names of their operators.
    sample : int
        How many of all changes, drawn by the name of the file; 0 means all.
    minutes : float
        By the clock, after which none is begun.
    """

    seconds: float
    only: str = ""
    sample: int = 0
    minutes: float = float("inf")


def work(stem: str, path: Path, database: Path, selection: Selection, limits: Limits) -> None:
    """Try what is left of a session, within limits.

    A change that is explained counts as one that survives, and takes no time.
    """
    known, cases = explained.read(), [case for found in by_group().values() for case in found]
    source = path.read_text(encoding="utf-8")
    stamp = os.stat(path).st_mtime_ns
    lines, begun = headers(source), time.monotonic()
    with use_db(str(database), WorkDB.Mode.open) as session:
        specs = [item.mutations[0] for item in _not_left_out(session)]
        every = [(spec.operator_name, spec.occurrence) for spec in specs]
        chosen = selecting.drawn(stem, every, limits.sample)
        for number, item in enumerate(session.pending_work_items, start=1):
            spec = item.mutations[0]
            if (spec.operator_name, spec.occurrence) not in chosen:
                continue
            if not spec.operator_name.endswith(limits.only):
                continue
            if time.monotonic() - begun > 60 * limits.minutes:
                break
            first, last = spec.start_pos[0], spec.end_pos[0]
            around = [(a, b) for a, b in lines if a <= first <= b] or [(first, last)]
            first, last = max(around)[0], max(last, max(around)[1])
            tests, seconds = selection.ordered(
                stem, selection.tests(stem, first, last), limits.seconds
            )
            outcome = "survived" if tests else "not covered"
            changed = mutated(spec, source)
            if known.holds(stem, *differing(source, changed)[1:]):
                tests = []
            elif tests and _tells(stem, changed, cases):
                outcome = "killed"
            try:
                path.write_text(changed, encoding="utf-8")
                # as if it were changed much later: no compiled file fits
                os.utime(path, ns=(stamp, stamp + number * 10**10))
                # few files of tests are collected in no time, and mostly enough
                stages = [stage(name, stem) for name in tests]
                for which in range(3):
                    part = [name for name, k in zip(tests, stages, strict=True) if k == which]
                    if part and outcome == "survived":
                        outcome = warm.run(part, 10 + 5 * seconds)
            finally:
                path.write_text(source, encoding="utf-8")
                os.utime(path, ns=(stamp, stamp))
            session.set_result(item.job_id, _result(outcome))


def _tells(stem: str, changed: str, cases: list[Case]) -> bool:
    """Whether ``test_kept.py`` fails after a change, in a small part of its time."""
    first = {stem, *topics.kinds(stem)}
    own = sorted(cases, key=lambda case: group(case) not in first)
    found = telling(stem, compile(changed, stem, "exec", dont_inherit=True), own)
    return found >= 0 or found == UNLOADABLE


def _result(outcome: str) -> WorkResult:
    """What came out, as Cosmic Ray records it; the word itself stands in the output."""
    worker = {
        "not covered": WorkerOutcome.NO_TEST,
        "abnormal": WorkerOutcome.ABNORMAL,
    }.get(outcome, WorkerOutcome.NORMAL)
    verdict = TestOutcome.KILLED if outcome in ("killed", "timeout") else TestOutcome.SURVIVED
    return WorkResult(worker_outcome=worker, output=outcome, test_outcome=verdict)


@dataclass(frozen=True)
class Mutant:
    """A mutant, what came out, and the lines that differ."""

    item: WorkItem
    outcome: str
    line: int
    before: str
    after: str


def _not_left_out(session: Any) -> list[WorkItem]:
    """The mutants that are to be tried, and those that were."""
    tried = [
        item
        for item, result in session.completed_work_items
        if result.worker_outcome != WorkerOutcome.SKIPPED
    ]
    return [*session.pending_work_items, *tried]


def untried(database: Path) -> int:
    """How many mutants of a session were not tried."""
    with use_db(str(database), WorkDB.Mode.open) as session:
        return len(list(session.pending_work_items))


def mutants(path: Path, database: Path) -> Iterator[Mutant]:
    """The mutants of a session that were tried."""
    source = path.read_text(encoding="utf-8")
    with use_db(str(database), WorkDB.Mode.open) as session:
        for item, result in session.completed_work_items:
            if result.worker_outcome != WorkerOutcome.SKIPPED:
                lines = differing(source, mutated(item.mutations[0], source))
                yield Mutant(item, str(result.output), *lines)


def differing(source: str, changed: str) -> tuple[int, str, str]:
    """The number of the first line that differs, and this line before and after."""
    old, new = source.splitlines(), changed.splitlines()
    pairs = enumerate(zip(old, new, strict=False))
    k = next((k for k, pair in pairs if len(set(pair)) > 1), 0)
    return k + 1, old[k].strip(), new[k].strip()


def forget(path: Path, database: Path, outcomes: set[str], only: str) -> None:
    """Let mutants with some outcomes be tried again."""
    again = [
        mutant.item
        for mutant in mutants(path, database)
        if mutant.outcome in outcomes and mutant.item.mutations[0].operator_name.endswith(only)
    ]
    if again:
        with use_db(str(database), WorkDB.Mode.open) as session:
            _delete(session, [item.job_id for item in again])


def _delete(session: Any, jobs: list[str]) -> None:
    from cosmic_ray.work_db import WorkResultStorage

    with session._session_maker.begin() as transaction:
        for job in jobs:
            transaction.query(WorkResultStorage).filter_by(job_id=job).delete()
