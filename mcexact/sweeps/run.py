"""`sweep` distributes jobs, verifies the certificates that come back, and keeps the records."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from dataclasses import replace
from typing import Any

from mcexact.answer.check import checked
from mcexact.answer.reading import answer_of
from mcexact.errors import InternalError, McexactError, UsageError
from mcexact.exact.rational import DEFAULT_LIMITS, Limits
from mcexact.model.box import Box
from mcexact.model.files import read_input
from mcexact.model.system import FORMAT
from mcexact.sweeps.jobs import Job, Outcome, Reader, Source, decide, entries, failure
from mcexact.sweeps.questions import WITHIN_RADII, answered, chosen, denied
from mcexact.sweeps.records import Record, RecordFile
from mcexact.sweeps.workers import Workers, alone

_AHEAD = 2  # jobs queued for each process, so that no process is idle


def sweep(
    sources: Iterable[Source],
    questions: Iterable[str] = ("fixed_spectrum",),
    *,
    results: str | os.PathLike[str] | None = None,
    executor: Executor | None = None,
    workers: int = 1,
    limits: Limits = DEFAULT_LIMITS,
    read: Reader = read_input,
    work: Callable[[Job], Outcome] = decide,
) -> Iterator[Record]:
    """Ask the same questions about many systems.

    Parameters
    ----------
    sources : iterable
        Paths as `load_system` takes them, `MultiChannelSystem`, `Draw`; consumed as processes
        become free.
    questions : iterable of str
        Names of questions that `analyze` asks by default and that need the plant alone.
    results : path, optional
        A file to which every record is appended when it is finished.  Systems with a record in it
        are skipped, unless the record says that a limit or a failure ended the work.
    executor : concurrent.futures.Executor, optional
        The executor that decides; by default processes that the sweep starts.
    workers : int
        The number of processes, or half the number of jobs submitted to the executor at once.
    limits : Limits, optional
        The limits on the system files.
    read : callable, optional
        A replacement for `read_input`, for example with a time limit.
    work : callable, optional
        A replacement for `decide`, for example with limits.

    Yields
    ------
    Record
        The records as they are finished.  An error with one system is in its record; the sweep
        continues.

    Raises
    ------
    UsageError
        If questions, executor or workers are invalid; and, when the first record is requested, if
        another sweep is writing ``results``.
    InputError
        If ``results`` cannot be used, when the first record is requested.

    Notes
    -----
    The independent checker verifies each certificate in this process.  It must be about the system
    of the job, which this process reads again; only for draws this is not compared.  A job whose
    process dies is repeated once in a new process.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> [record] = sweep([gallery.load("liu2020-3ch-no-communication")])
    >>> record.name, record.answers["fixed_spectrum"]["claim"]["polynomial"]
    ('liu2020_3ch_no_communication', [-1, 1])
    """
    if isinstance(sources, str) or not isinstance(sources, Iterable):
        raise UsageError("expected several systems, such as [plant]", where="sources")
    asked = chosen(questions)
    team = Workers(executor, workers)
    return _swept(entries(sources, asked, limits, read), team, results, work)


def _swept(
    jobs: Iterable[tuple[int, str, Job | McexactError]],
    team: Workers,
    results: str | os.PathLike[str] | None,
    work: Callable[[Job], Outcome],
) -> Iterator[Record]:
    """Yield every record after it is kept; at the end, files and processes are closed."""
    kept = None if results is None else RecordFile(results)
    known = {} if kept is None else kept.known
    try:
        for record, new in _finished(_open(jobs, known), team, work):
            if new and kept is not None and record.key:
                kept.add(record)
            yield record
    finally:
        team.end()
        if kept is not None:
            kept.close()


def _open(
    jobs: Iterable[tuple[int, str, Job | McexactError]], known: dict[str, Record]
) -> Iterator[tuple[int, Job] | tuple[Record, bool]]:
    """Separate the jobs to be done from finished ones, whose records are yielded."""
    for number, name, job in jobs:
        if not isinstance(job, Job):
            yield Record(number, name, "", error=failure(job)["error"]), True
            continue
        record = known.get(job.key())
        if record is None or not record.final:
            yield number, job
        else:
            yield replace(record, number=number, name=name), False


def _finished(
    jobs: Iterator[tuple[int, Job] | tuple[Record, bool]],
    team: Workers,
    work: Callable[[Job], Outcome],
) -> Iterator[tuple[Record, bool]]:
    """Yield records, and whether they are new, with only as many jobs queued as the team needs."""
    waiting: dict[Future[Outcome], tuple[int, Job]] = {}
    more = True
    while more or waiting:
        while more and len(waiting) < _AHEAD * team.count:
            entry = next(jobs, None)
            if entry is None:
                more = False
            elif isinstance(entry[0], Record):
                yield entry
            else:
                waiting[team.submit(work, entry[1])] = entry
        done, _ = wait(waiting, return_when=FIRST_COMPLETED)
        lost = []
        for future in done:
            number, job = waiting.pop(future)
            try:
                outcome = future.result()
            except BrokenExecutor:
                lost.append((number, job))
                continue
            except Exception as error:
                outcome = failure(error)
            yield _believed(number, job, outcome), True
        for number, job in lost:
            yield _believed(number, job, _once_more(job, work)), True


def _once_more(job: Job, work: Callable[[Job], Outcome]) -> Outcome:
    """Repeat a job, whose process died or that was queued then, in a process of its own."""
    try:
        outcome: Outcome = alone(work, job)
    except BrokenExecutor:
        return failure(InternalError("the process died twice while deciding"))
    except Exception as error:
        return failure(error)
    return outcome


def _believed(number: int, job: Job, outcome: Outcome) -> Record:
    """Make the record of a job after verifying every certificate."""
    key = job.key()
    left = outcome.get("error")
    if not outcome.get("certificates"):
        return Record(number, job.name, key, error=left)
    try:
        expected = outcome["digest"] if not isinstance(job.source, bytes) else job.system().digest()
        answers = {
            name: _checked(name, text, expected, job)
            for name, text in outcome["certificates"].items()
        }
        if tuple(answers) != job.questions and left is None:
            raise InternalError("the answers do not belong to the questions")
    except McexactError as error:
        return Record(number, job.name, key, error=failure(error)["error"])
    return Record(
        number,
        job.name,
        key,
        system=outcome["system"],
        digest=expected,
        answers=answers,
        seconds=outcome["seconds"],
        error=left,
        certificates=outcome["certificates"],
    )


def _checked(name: str, text: str, expected: str, job: Job) -> dict[str, Any]:
    """Return the claim of a certificate and the statement that the checker verified.

    A certificate about another plant within the radii says that this one fails; it is the
    ``member``.

    Raises
    ------
    InternalError
        If the certificate is not VALID for this system, or does not answer the question.
    """
    document = json.loads(text)
    fails = name in WITHIN_RADII and denied(name, document)
    verdict = checked(text.encode("ascii"), "" if fails else expected)
    if verdict.verdict != "VALID":
        raise InternalError(f"the certificate for {name} is not accepted: {verdict.line()}")
    found = {"claim": document["claim"], "statement": verdict.statement}
    if fails and Box(job.system()).contains(answer_of(document).about.plant):
        return found | {"member": {"format": FORMAT, **document["system"]}}
    if fails or not answered(name, document):
        raise InternalError(f"the certificate for {name} is about something else")
    return found
