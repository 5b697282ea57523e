"""The errors that this package raises, each with the exit status of the command line."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from importlib.util import find_spec
from typing import Any


def place_of(path: str | os.PathLike[str], advice: str = "") -> str:
    """What messages call a file.

    Parameters
    ----------
    path : path
    advice : str, optional
        The end of the message for something else.

    Raises
    ------
    InputError
        If it is no name of a file.
    """
    if not isinstance(path, (str, os.PathLike)):
        raise InputError(
            f"expected the name of a file, found {type(path).__name__}{advice}", where="path"
        )
    return "standard input" if os.fspath(path) == "-" else os.fspath(path)


class McexactError(Exception):
    """The base class of all errors that this package raises.

    Parameters
    ----------
    message : str
        One sentence that says what was expected, what was found, and how to correct it.
    where : str, optional
        The place, such as ``channels[2].B`` or a file name; it is put before the message.

    Attributes
    ----------
    exit_status : int
        The exit status of the command line.

    Examples
    --------
    >>> print(InputError("expected 4 rows, found 3", where="channels[2].B"))
    channels[2].B: expected 4 rows, found 3
    """

    exit_status = 70

    def __init__(self, message: str, *, where: str | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.where = where

    def __str__(self) -> str:
        return self.message if self.where is None else f"{self.where}: {self.message}"

    def within(self, place: str) -> McexactError:
        """Put a place before the one that the error names, and return the error."""
        self.where = place if self.where is None else f"{place}: {self.where}"
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return (_rebuilt, (type(self), self.message, self.where, self.__dict__))


def _rebuilt(
    kind: type[McexactError], message: str, where: str | None, state: dict[str, Any]
) -> McexactError:
    """Rebuild an error in another process."""
    error = kind(message, where=where)
    error.__dict__.update(state)
    return error


class InputError(McexactError, ValueError):
    """The input is missing, unreadable or malformed."""

    @staticmethod
    @contextmanager
    def inside(place: str) -> Iterator[None]:
        """Name a place in every such error that is raised in the block."""
        try:
            yield
        except InputError as error:
            raise error.within(place) from None

    @staticmethod
    def require(value: object, kind: type, where: str) -> None:
        """Refuse an argument of another type than the one expected, and say how to make one."""
        if not isinstance(value, kind):
            article = "an" if kind.__name__[0] in "AEIO" else "a"
            advice = getattr(kind, "_made_by", "")
            advice = getattr(value, "_becomes", {}).get(kind.__name__) or (
                advice and f"make one with {advice}"
            )
            raise InputError(
                f"expected {article} {kind.__name__}, found {type(value).__name__}"
                f"{advice and f'; {advice}'}",
                where=where,
            )

    exit_status = 3


class FloatRefused(InputError):
    """A float where an exact number is needed."""


class OtherFormat(InputError):
    """The file says that it has another format than the expected one."""


class UsageError(McexactError, ValueError):
    """The arguments contradict each other."""

    exit_status = 2


class Impossible(McexactError):
    """What was requested does not exist, which is proved.

    Parameters
    ----------
    message : str
    certificate : object, optional
        The certificate that proves this.
    where : str, optional
    """

    exit_status = 1

    def __init__(self, message: str, certificate: Any = None, *, where: str | None = None) -> None:
        super().__init__(message, where=where)
        self.certificate = certificate


class LimitReached(McexactError):
    """A limit on time, memory or work was reached before a decision.

    Parameters
    ----------
    message : str
    where : str, optional
    lower, upper : Fraction, optional
        The proved lower and upper limits of the requested number.
    """

    exit_status = 4

    def __init__(
        self,
        message: str,
        *,
        where: str | None = None,
        lower: Fraction | None = None,
        upper: Fraction | None = None,
    ) -> None:
        super().__init__(message, where=where)
        self.lower, self.upper = lower, upper


class OutOfReach(LimitReached):
    """Even the optimal controller of all agents together is one that nobody would install."""


class MissingExtra(McexactError, ModuleNotFoundError):
    """A library is needed that an extra of this package installs.

    Examples
    --------
    >>> with MissingExtra.named("plot"):
    ...     import a_library_that_is_missing
    Traceback (most recent call last):
    mcexact.errors.MissingExtra: this needs a_library_that_is_missing, which is not installed: \
pip install 'mcexact[plot]'
    """

    exit_status = 69

    @staticmethod
    @contextmanager
    def named(extra: str) -> Iterator[None]:
        """Name the extra that installs what an import in the block does not find."""
        try:
            yield
        except ModuleNotFoundError as error:
            raise MissingExtra._of(extra, error.name or "a library") from None

    @staticmethod
    def require(extra: str, library: str) -> None:
        """Refuse to start work that would end without a library."""
        if find_spec(library) is None:
            raise MissingExtra._of(extra, library)

    @staticmethod
    def _of(extra: str, library: str) -> MissingExtra:
        missing = MissingExtra(
            f"this needs {library}, which is not installed: pip install 'mcexact[{extra}]'"
        )
        missing.name = library
        return missing


class NotWritten(McexactError):
    """An output cannot be written: standard output, a file or a folder.

    Parameters
    ----------
    message : str
    where : str, optional
    reader_left : bool
        Whether the reader of a pipe has closed it.
    """

    exit_status = 74

    def __init__(
        self, message: str, *, where: str | None = None, reader_left: bool = False
    ) -> None:
        super().__init__(message, where=where)
        self.reader_left = reader_left


class InternalError(McexactError):
    """A check inside this package failed, which is a bug in it."""

    exit_status = 70
