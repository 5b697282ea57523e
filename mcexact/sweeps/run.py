"""`sweep`: records, resuming, distribution of jobs.

`sweep` asks the same questions about many systems.  Each system becomes a job, which any process
can decide from plain data; the certificates come back as texts, and the independent checker
verifies them in this process before an answer becomes a `Record`.  So no answer rests on the
process that computed it.  A certificate has to be about the system of the job, which this process
reads again; for draws alone this is not compared.

A `RecordFile` keeps one line for each record, appended when the system is finished.  Run the same
sweep again to resume it: finished systems are skipped, unless a limit or a failure ended their
work, and an incomplete last line is removed.  A lock refuses a second sweep that writes the same
file.  A job whose process dies is repeated once in a new process.
"""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from dataclasses import dataclass, field, replace
from io import FileIO
from typing import Any

from mcexact.analysis.nearby.plants import NearPlant
from mcexact.answer.check import answer_of, checked
from mcexact.answer.modes import PencilRank
from mcexact.answer.nearby import Lost
from mcexact.errors import InputError, InternalError, McexactError, NotWritten, UsageError, place_of
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import DEFAULT_LIMITS, Limits, written
from mcexact.model.box import Box
from mcexact.model.files import read_input
from mcexact.model.system import FORMAT as system_FORMAT
from mcexact.model.text import canonical
from mcexact.shown import LINE, Shown, fitting
from mcexact.sweeps.jobs import Job, Outcome, Reader, Source, decide, entries, failure
from mcexact.sweeps.questions import WITHIN_RADII, answered, chosen, denied
from mcexact.sweeps.workers import Workers, alone

# Records of the answers about systems, and the file that keeps them, one line for each.

FORMAT = "mcexact-sweep/1"
_AGAIN = (4, 70)  # another run may succeed after a limit or a failure


@dataclass(frozen=True, repr=False)
class Record(Shown):
    """The answers about one system.

    Attributes
    ----------
    number : int
        The position of the system in the sweep, from 0.
    name : str
    key : str
        The hash of the system's source and of the questions; empty if the source cannot be read.
    system : mapping or None
        ``n``, ``m`` and ``time``.
    digest : str
        The digest of the system; empty if there is an error.
    answers : mapping from questions to mappings
        ``claim``, as in the certificate, and ``statement``, which the checker verified; if the
        property fails, both are about ``member``, a plant within the radii that lacks it.
    nearby : sequence of mappings
        Plants that the data allow as well as this one, of which an answer is another one: what each
        has ``lost``, the largest ``part`` of an entry by which it differs, whether ``rounding``
        errors or ``digits`` that were not typed explain that (``within``), the ``text`` that says
        so, and the ``statement`` that the checker verified.
    seconds : float or None
        The time for deciding and for making certificates.
    error : mapping or None
        ``status``, an exit status, and ``message``; ``other_format`` for a file of another format.
        If there are answers as well, the error is about a question that is left open.
    certificates : mapping from questions to texts
        The verified certificates.  The file does not keep them, so a record read from it has none.
    """

    number: int
    name: str
    key: str
    system: Mapping[str, Any] | None = None
    digest: str = ""
    answers: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    nearby: Sequence[Mapping[str, Any]] = field(default_factory=list)
    seconds: float | None = None
    error: Mapping[str, Any] | None = None
    certificates: Mapping[str, str] = field(default_factory=dict, compare=False, repr=False)

    @property
    def final(self) -> bool:
        """Whether another run would give the same answers: no limit was reached, nothing failed."""
        return self.error is None or self.error["status"] not in _AGAIN

    def __repr__(self) -> str:
        state = f"error {self.error['status']}" if self.error is not None else self._asked()
        return fitting(f"Record({self.number}, {self.name!r}, {state}", LINE - 1) + ")"

    def _asked(self) -> str:
        return f"{self.digest[:12]}…, answers: {', '.join(self.answers)}"

    def explain(self) -> str:
        """Say what plants nearby are, what the checker verified of the answers, and what failed."""
        sentences = [str(each["text"]) for each in self.nearby]
        sentences += [str(answer["statement"]) for answer in self.answers.values()]
        if self.error is not None:
            sentences.append(f"{self.name}: {self.error['message']}")
        return "\n".join(sentences)

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the columns of a table with their contents; empty columns are left out."""
        for name, value in self.to_row().items():
            if isinstance(value, dict):
                yield name, ", ".join(f"{key} {each}" for key, each in value.items())
            elif value is not None:
                yield name, value

    def to_row(self) -> dict[str, Any]:
        """Return one flat row for a table: sizes, and the claims that fit into a cell.

        The columns of a claim are ``question.claim``.  A polynomial is written as text; another
        list, such as ``fixed_spectrum.factors``, as the number of its items.

        Examples
        --------
        >>> from mcexact import sweep
        >>> from mcexact.model import gallery
        >>> [record] = sweep([gallery.load("hidden-triple-mode")], ["completeness"])
        >>> record.to_row()["n"], record.to_row()["completeness.complete"]
        (5, False)
        """
        system = self.system or {}
        row = {"number": self.number, "name": self.name, **system, "digest": self.digest}
        for question, answer in self.answers.items():
            for key, value in answer["claim"].items():
                if key.endswith("polynomial"):
                    value = str(Polynomial.from_coefficients(value))
                row[f"{question}.{key}"] = len(value) if isinstance(value, list) else value
        row["nearby"] = "; ".join(str(each["text"]) for each in self.nearby) or None
        row["seconds"] = self.seconds
        row["error"] = None if self.error is None else self.error["message"]
        return row

    def to_dict(self) -> dict[str, Any]:
        """Return the record as plain data, as in the file."""
        kept = {"format": FORMAT, "number": self.number, "name": self.name, "key": self.key}
        if self.error is not None:
            kept["error"] = dict(self.error)
        if self.error is not None and not self.answers:
            return kept
        return kept | {
            "system": self.system,
            "digest": self.digest,
            "answers": self.answers,
            **({"nearby": [*self.nearby]} if self.nearby else {}),
            "seconds": self.seconds,
        }


def read_records(path: str | os.PathLike[str]) -> dict[str, Record]:
    """Read the last record of each key from a file; a missing file has none, and a stream neither.

    Raises
    ------
    InputError
        If it cannot be read, or is not a file of records.
    """
    if os.path.exists(path) and not os.path.isfile(path) and not os.path.isdir(path):
        return {}  # a stream, such as /dev/null
    try:
        with open(path, "rb") as stream:
            return dict(_records(stream.read(), os.fspath(path)))
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise InputError(
            f"cannot be read: {error.strerror or error}", where=os.fspath(path)
        ) from error


def _records(data: bytes, place: str) -> Iterator[tuple[str, Record]]:
    """Yield every complete line; an interrupted sweep may leave an incomplete last line."""
    for k, line in enumerate(data.split(b"\n")[:-1]):
        try:
            document = json.loads(line)
            if document.pop("format") != FORMAT:
                raise ValueError
            record = Record(**document)
            kept = record.error is not None or set(record.system or ()) == {"n", "m", "time"}
            if not (isinstance(record.key, str) and kept):
                raise ValueError
        except (ValueError, TypeError, KeyError, AttributeError):
            raise InputError(
                f"expected a record of {FORMAT}; name a new file, or one that a sweep wrote",
                where=f"{place}: line {k + 1}",
            ) from None
        yield record.key, record


class RecordFile:
    """A file to which one sweep at a time appends records.

    Parameters
    ----------
    path : path
        The file is made if it is missing.  An incomplete last line of an interrupted sweep is
        removed.

    Raises
    ------
    InputError
        If it cannot be read, or is not a file of records.
    NotWritten
        If it cannot be written.
    UsageError
        If another sweep is writing it.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        place_of(path)
        self.path = os.fspath(path)
        self.known = read_records(path)
        try:
            self._stream = open(path, "ab", buffering=0)  # noqa: SIM115 (close closes it)
        except OSError as error:
            raise self._unwritable(error) from error
        try:
            _lock(self._stream, self.path)
            if os.path.isfile(path):
                self._stream.truncate(_whole_lines(self.path))
        except OSError as error:
            self.close()
            raise self._unwritable(error) from error
        except UsageError:
            self.close()
            raise

    def add(self, record: Record) -> None:
        """Append a record as one complete line."""
        line = canonical(record.to_dict()).encode("ascii") + b"\n"
        try:
            self._stream.write(line)
        except OSError as error:
            raise self._unwritable(error) from error

    def _unwritable(self, error: OSError) -> NotWritten:
        return NotWritten(f"cannot be written: {error.strerror or error}", where=self.path)

    def close(self) -> None:
        """Close the file and release its lock."""
        self._stream.close()


def _whole_lines(path: str) -> int:
    """Return the number of bytes up to the last line feed."""
    with open(path, "rb") as stream:
        return stream.read().rfind(b"\n") + 1


def _lock(stream: FileIO, path: str) -> None:
    """Lock the file; a file that another sweep has locked is refused."""
    with contextlib.suppress(ImportError):
        import fcntl

        try:
            fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise UsageError("another sweep is writing to this file", where=path) from None


# `sweep`: distribution of jobs, verification of their certificates.

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
    """Make the record of a job, after the checker has verified every certificate."""
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
        beside = outcome.get("nearby", {}).items()
        nearby = [_beside(lost, text, answers, job) for lost, text in beside]
    except McexactError as error:
        return Record(number, job.name, key, error=failure(error)["error"])
    return Record(
        number,
        job.name,
        key,
        system=outcome["system"],
        digest=expected,
        answers=answers,
        nearby=nearby,
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
    verified = {"claim": document["claim"], "statement": verdict.statement}
    if fails and Box(job.system()).contains(answer_of(document).about.plant):
        return verified | {"member": {"format": system_FORMAT, **document["system"]}}
    if fails or not answered(name, document):
        raise InternalError(f"the certificate for {name} is about something else")
    return verified


_WITHIN = {"rounding": "rounding errors", "digits": "digits that were not typed"}
_ASKED: Mapping[str, tuple[str, str]] = {
    "unstable": ("fixed_spectrum", "stabilizable"),
    "fixed": ("fixed_spectrum", "factors"),
    "uncontrollable": ("joint_controllability", "controllable"),
    "unobservable": ("joint_observability", "controllable"),
}
"""The question that is about what a plant lacks, and the claim that the given plant has it."""


def _beside(
    lost: Lost, text: str, answers: Mapping[str, Mapping[str, Any]], job: Job
) -> dict[str, Any]:
    """Return what a certificate proves of a plant nearby, as plain data.

    Raises
    ------
    InternalError
        If it is not VALID, or not about a plant that the data of the job's system allow, or the
        answer about the latter is the same.
    """
    verdict = checked(text.encode("ascii"))
    if verdict.verdict != "VALID":
        raise InternalError(f"the certificate for {lost} is not accepted: {verdict.line()}")
    proof, (question, key) = answer_of(json.loads(text)), _ASKED.get(lost, ("", ""))
    near = NearPlant.of(job.system(), lost, proof) if isinstance(proof, PencilRank) else None
    known = answers.get(question, {}).get("claim", {}).get(key)
    differs = known == [] if lost == "fixed" else known is True
    if near is None or near.within is None or not differs:
        raise InternalError(f"the certificate for {lost} is about something else")
    return {
        "lost": lost,
        "part": written(near.part),
        "within": near.within,
        "text": f"this depends on {_WITHIN[near.within]}: {near.explain()}",
        "statement": verdict.statement,
    }
