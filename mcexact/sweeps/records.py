"""Records of the answers about systems, and the file that keeps them, one line for each."""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from io import FileIO
from typing import Any

from mcexact.errors import InputError, NotWritten, UsageError, place_of
from mcexact.exact.polynomial import Polynomial
from mcexact.model.text import canonical
from mcexact.shown import LINE, Shown, fitting

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
        ``claim``, as in the certificate, and ``statement``, which the checker verified; ``member``
        is a plant within the radii that both are about, where it lacks what was asked.
    seconds : float or None
        The time for deciding and for making certificates.
    error : mapping or None
        ``status``, an exit status, and ``message``; ``other_format`` for a file of another format.
        Beside answers it is about a question that is left open.
    certificates : mapping from questions to texts
        The verified certificates.  The file does not keep them, so a record read from it has none.
    """

    number: int
    name: str
    key: str
    system: Mapping[str, Any] | None = None
    digest: str = ""
    answers: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    seconds: float | None = None
    error: Mapping[str, Any] | None = None
    certificates: Mapping[str, str] = field(default_factory=dict, compare=False, repr=False)

    @property
    def final(self) -> bool:
        """Whether another run would find the same: no limit was reached and nothing failed."""
        return self.error is None or self.error["status"] not in _AGAIN

    def __repr__(self) -> str:
        told = f"error {self.error['status']}" if self.error is not None else self._asked()
        return fitting(f"Record({self.number}, {self.name!r}, {told}", LINE - 1) + ")"

    def _asked(self) -> str:
        return f"{self.digest[:12]}…, answers: {', '.join(self.answers)}"

    def explain(self) -> str:
        """Say what was found, in the statements that the checker verified, one a line."""
        said = [str(answer["statement"]) for answer in self.answers.values()]
        if self.error is not None:
            said.append(f"{self.name}: {self.error['message']}")
        return "\n".join(said)

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the columns of a table, and what they hold; those that are empty are left out."""
        for name, value in self.to_row().items():
            if isinstance(value, dict):
                yield name, ", ".join(f"{key} {each}" for key, each in value.items())
            elif value is not None:
                yield name, value

    def to_row(self) -> dict[str, Any]:
        """Return one flat row for a table: sizes, and the claims that fit into a cell.

        The columns of a claim are ``question.claim``.  A polynomial is written as text; of another
        list the number of its items is told, as of ``fixed_spectrum.factors``.

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
