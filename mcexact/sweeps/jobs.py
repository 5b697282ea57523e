"""A system with its questions, decided from plain data to plain data in any process."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass
from typing import Any

from mcexact.analysis.analyze import Analysis
from mcexact.analysis.boxes.largest import failing_member
from mcexact.answer import protocol
from mcexact.answer.protocol import Answer
from mcexact.derived.drawn.systems import Draw, drawn_system
from mcexact.derived.variants import Variant
from mcexact.errors import InputError, LimitReached, McexactError, OtherFormat, UsageError
from mcexact.exact.rational import DEFAULT_LIMITS, Limits
from mcexact.model.arrays import Reading
from mcexact.model.files import read_any
from mcexact.model.properties import PROPERTIES
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import system_text
from mcexact.model.text import canonical, sha256
from mcexact.sweeps.questions import KNOWN, NEAR_QUESTIONS

Source = str | os.PathLike[str] | MultiChannelSystem | Draw | Variant
Reader = Callable[[str | os.PathLike[str], Limits], bytes]
_SECONDS = 10.0
"""What the search for plants nearby of one system may take."""
Outcome = dict[str, Any]
"""The plain data that `decide` returns: the answers, or the error that prevented them."""


@dataclass(frozen=True)
class Job:
    """A system with the questions about it.

    Attributes
    ----------
    name : str
        The name in the record: the path, the system's name, or the seed.
    source : bytes or Draw
        The contents of a system file, or the description of a draw.
    questions : tuple of str
    limits : Limits
        The limits on the system file.
    """

    name: str
    source: bytes | Draw
    questions: tuple[str, ...]
    limits: Limits = DEFAULT_LIMITS

    def key(self) -> str:
        """A hash of the source and the questions; jobs with equal hashes have equal answers."""
        source = asdict(self.source) if isinstance(self.source, Draw) else sha256(self.source)
        return sha256(canonical([source, list(self.questions)]))

    def system(self) -> MultiChannelSystem:
        """Read or draw the system.

        Raises
        ------
        InputError
            If the text is malformed.
        """
        if isinstance(self.source, Draw):
            return drawn_system(self.source)
        return read_any(self.source, self.name, Reading(self.limits))


def job(
    source: Source, number: int, questions: tuple[str, ...], limits: Limits, read: Reader
) -> Job:
    """Make the job for one entry of a sweep.

    Raises
    ------
    InputError, LimitReached
        If a file cannot be read.
    UsageError
        If the entry is not a path, a system, a variant or a draw.
    """
    if isinstance(source, Draw):
        return Job(f"seed {source.seed}", source, questions, limits)
    if isinstance(source, Variant):
        return Job(source.name, system_text(source.system()).encode(), questions, limits)
    if isinstance(source, MultiChannelSystem):
        name = source.name or f"system {number + 1}"
        return Job(name, system_text(source).encode(), questions, limits)
    if isinstance(source, str | os.PathLike):
        return Job(os.fspath(source), read(source, limits), questions, limits)
    raise UsageError(
        f"expected paths, systems, variants or draws to sweep over, found {type(source).__name__}"
    )


def decide(job: Job, seconds: float = _SECONDS) -> Outcome:
    """Decide all questions about one system.

    Parameters
    ----------
    job : Job
    seconds : float
        What the search for plants nearby may take.

    Returns
    -------
    dict
        ``system`` {n, m, time}, ``digest``, ``seconds`` and ``certificates``, one text for each
        question; or the ``error`` that ended the work, or that left a question open.  Where no
        proof about every plant within the radii is found, the certificate may be about one of them
        that fails.  ``nearby`` has certificates about plants of which the data of this one allow
        another answer, by what these plants lack.
    """
    start = time.perf_counter()
    try:
        system = job.system()
        answers, left = _decided(job.questions, system)
        # The numbers of a draw are exact.
        beside = {} if isinstance(job.source, Draw) else _nearby(system, answers, seconds)
    except Exception as error:
        return failure(error)
    certificates = {name: protocol.encode(answer) for name, answer in answers.items()}
    return left | {
        "nearby": beside,
        "system": {"n": system.n, "m": system.m, "time": system.time},
        "digest": system.digest(),
        "seconds": round(time.perf_counter() - start, 6),
        "certificates": certificates,
    }


def _decided(
    questions: Iterable[str], system: MultiChannelSystem
) -> tuple[dict[str, Answer], Outcome]:
    """The answers, and the error if a question about a box is left open."""
    answers, left = dict[str, Answer](), list[str]()
    for name in questions:
        try:
            answer = KNOWN[name].decide(system)
        except LimitReached as error:
            if name not in PROPERTIES:
                raise
            answer = failing_member(system, PROPERTIES[name])
            left += [] if answer is not None else [str(error)]
        if answer is not None:
            answers[name] = answer
    return answers, failure(LimitReached("; ".join(left))) if left else {}


def _nearby(
    system: MultiChannelSystem, answers: Mapping[str, Answer], seconds: float
) -> dict[str, str]:
    """Certificates about plants nearby that the data allow as well, by what they lack."""
    analysis = Analysis(system, NEAR_QUESTIONS & answers.keys())
    if not analysis.asked or analysis.nearby_left_out:
        return {}
    for name in analysis.asked:
        analysis.know(name, answers[name])
    analysis.nearby_seconds = seconds
    return {each.lost: protocol.encode(each.proof) for each in analysis.nearby.leading}


def failure(error: BaseException) -> Outcome:
    """Return the exit status and the message of an error.

    ``other_format`` says that the file's key ``format`` names another format.
    """
    if isinstance(error, McexactError):
        kept: dict[str, Any] = {"status": error.exit_status, "message": str(error)}
        return {"error": kept | ({"other_format": True} if isinstance(error, OtherFormat) else {})}
    status = 4 if isinstance(error, MemoryError) else 70
    return {"error": {"status": status, "message": f"{type(error).__name__}: {error}"}}


def entries(
    sources: Iterable[Source], questions: tuple[str, ...], limits: Limits, read: Reader
) -> Iterable[tuple[int, str, Job | McexactError]]:
    """Yield number, name and job of every entry, or the error instead of the job.

    Parameters
    ----------
    sources : iterable of Source
        Read one at a time, so that it may be a generator of any length.
    questions : tuple of str
    limits : Limits
    read : Reader
        Reads the file of a source that is a path.

    Notes
    -----
    A source that cannot be read, or is too large, gives its error; the sources after it go on.
    """
    for number, source in enumerate(sources):
        try:
            entry: Job | McexactError = job(source, number, questions, limits, read)
        except (InputError, LimitReached) as error:
            entry = error
        name = entry.name if isinstance(entry, Job) else getattr(source, "name", str(source))
        yield number, name, entry
