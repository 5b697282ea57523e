"""The sweep: hand out jobs, take back certificates, check them, keep the records."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from dataclasses import replace
from typing import Any

from mcexact.checker import check_document
from mcexact.errors import InternalError, McexactError
from mcexact.exact.rational import DEFAULT_LIMITS, Limits
from mcexact.model.json_text import read_bytes
from mcexact.model.system_file import digest
from mcexact.sweep.jobs import Job, Outcome, Reader, Source, decide, entries, failure
from mcexact.sweep.questions import answered, chosen
from mcexact.sweep.records import Record, RecordFile
from mcexact.sweep.workers import Workers, alone

_AHEAD = 2  # jobs that wait for each process, so that none waits for a job


def sweep(
    sources: Iterable[Source],
    questions: Iterable[str] = ("fixed_spectrum",),
    *,
    results: str | os.PathLike[str] | None = None,
    executor: Executor | None = None,
    workers: int = 1,
    limits: Limits = DEFAULT_LIMITS,
    read: Reader = read_bytes,
    work: Callable[[Job], Outcome] = decide,
) -> Iterator[Record]:
    """Ask the same questions about many systems.

    Parameters
    ----------
    sources : iterable
        Paths of system files, `MultiChannelSystem`, `Draw`; taken one by one as there is room.
    questions : iterable of str
        Names out of ``QUESTIONS``.
    results : path, optional
        A file that keeps every record as soon as it is there.  What it holds already is not done
        again, unless it ended at a limit or by a failure.
    executor : concurrent.futures.Executor, optional
        Where to decide; by default in processes of our own.
    workers : int
        How many processes, or how many jobs the executor is given at once, two for each.
    limits : Limits, optional
        What the files may ask for.
    read : callable, optional
        Reads a file as `read_bytes` does, perhaps with a limit on the time that this may take.
    work : callable, optional
        Does what `decide` does, somewhere else or with limits.

    Yields
    ------
    Record
        As they are finished.  An error of one system is in its record and stops nothing.

    Raises
    ------
    UsageError
        If questions, executor or workers make no sense; and, when the first record is asked for,
        if another sweep is writing ``results``.
    InputError
        If ``results`` cannot be used, when the first record is asked for.

    Notes
    -----
    A certificate that comes back is checked in this process by the independent checker, and must
    be about the system of the job, which this process reads again; for a draw that is left out.
    A job whose process dies is done once more in a fresh process of its own.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> [record] = sweep([gallery.load("liu2020-3ch-no-communication")])
    >>> record.name, record.answers["fixed_spectrum"]["claim"]["polynomial"]
    ('liu2020_3ch_no_communication', [-1, 1])
    """
    asked = chosen(questions)
    team = Workers(executor, workers)
    return _swept(entries(sources, asked, limits, read), team, results, work)


def _swept(
    jobs: Iterable[tuple[int, str, Job | McexactError]],
    team: Workers,
    results: str | os.PathLike[str] | None,
    work: Callable[[Job], Outcome],
) -> Iterator[Record]:
    """Every record, kept before it is handed on; at the end or at an exception all is let go."""
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
    """The jobs that are still to be done; of the others the records, and whether they are new."""
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
    """The records as they come, and whether they are new; no more jobs wait than the team needs."""
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
    """A job whose process died, or that was waiting when another's did, in a process of its own."""
    try:
        outcome: Outcome = alone(work, job)
    except BrokenExecutor:
        return failure(InternalError("the process that decided it died, twice"))
    except Exception as error:
        return failure(error)
    return outcome


def _believed(number: int, job: Job, outcome: Outcome) -> Record:
    """The record of a job, every certificate checked."""
    key = job.key()
    if "error" in outcome:
        return Record(number, job.name, key, error=outcome["error"])
    try:
        expected = outcome["digest"] if not isinstance(job.source, bytes) else digest(job.system())
        answers = {
            name: _checked(name, text, expected) for name, text in outcome["certificates"].items()
        }
        if tuple(answers) != job.questions:
            raise InternalError("the answers are not those to the questions")
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
        certificates=outcome["certificates"],
    )


def _checked(name: str, text: str, expected: str) -> dict[str, Any]:
    """The claim of a certificate and the theorem that the checker read in it.

    Raises
    ------
    InternalError
        If the checker does not say VALID of it, about this system, or it answers something else.
    """
    verdict = check_document(text.encode("ascii"), expected)
    if verdict.verdict != "VALID":
        raise InternalError(f"the certificate for {name} is not accepted: {verdict.line()}")
    document = json.loads(text)
    if not answered(name, document):
        raise InternalError(f"the certificate for {name} is about something else")
    return {"claim": document["claim"], "theorem": verdict.theorem}
