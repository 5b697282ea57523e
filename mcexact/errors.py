"""Errors with exit statuses, the checks of arguments, and a warning of rounding.

    >>> import mcexact
    >>> try:
    ...     mcexact.MultiChannelSystem([[0.1]], [[[1]]], [[[1]]])
    ... except mcexact.errors.FloatRefused as refused:
    ...     print(refused.where)
    A[0][0]

Every error is a `McexactError`.  An `InputError` says what is wrong with what was given, an
`Impossible` carries the certificate of why there is no such controller, and a `LimitReached` says
which limit was met, so nothing is decided.
"""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from fractions import Fraction
from importlib.util import find_spec
from math import inf
from numbers import Real
from typing import Any, TypeVar

__all__ = [
    "FloatRefused",
    "Impossible",
    "InputError",
    "InternalError",
    "LimitReached",
    "McexactError",
    "MissingExtra",
    "NotWritten",
    "OtherFormat",
    "OutOfReach",
    "RoundingWarning",
    "UsageError",
]

Plant = TypeVar("Plant")

# The errors that this package raises, each with the exit status of the command line.


def place_of(path: str | os.PathLike[str], advice: str = "") -> str:
    """Return the name by which messages call a file.

    Parameters
    ----------
    path : path
    advice : str, optional
        The end of the message if the path is no name of a file.

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
        """Refuse an argument of another type than the one expected, and say how to make one.

        A value of the type may still be unfit, such as a system with feedthrough: its ``_unfit``
        says why.
        """
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
        if unfit := getattr(value, "_unfit", ""):
            raise InputError(unfit, where=where)

    exit_status = 3


class FloatRefused(InputError):
    """A float where an exact number is needed."""


class OtherFormat(InputError):
    """The file says that it has another format than the expected one."""


class UsageError(McexactError, ValueError):
    """The arguments contradict each other."""

    exit_status = 2


class Impossible(McexactError):
    """It is proved that the requested object does not exist.

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


# The warning of plants whose answers depend on rounding errors.


class RoundingWarning(UserWarning):
    """A plant was made of floats, and rounding errors alone decide an answer about it.

    `MultiChannelSystem.from_float`, `from_stacked`, `from_statespace` and `load_system` warn with
    it.  It says which plant nearby, with the same zeros, has another answer.  Nothing is looked for
    where the category is ignored::

        warnings.simplefilter("ignore", mcexact.errors.RoundingWarning)
    """


_examine: Callable[[Any], tuple[str, ...]] | None = None


def examine_rounded_by(examine: Callable[[Any], tuple[str, ...]]) -> None:
    """Set what says of a plant in floats how its answers depend on rounding errors.

    The package sets it: those who read plants stand below those who examine them.
    """
    global _examine
    _examine = examine


def warn_of_rounding(system: Plant) -> Plant:
    """Warn the caller of the package where a plant has other answers but for rounding errors.

    Returns
    -------
    MultiChannelSystem
        The same plant.
    """
    if _examine is None or _ignores(RoundingWarning):
        return system
    for text in _examine(system):
        warnings.warn(text, RoundingWarning, stacklevel=_callers_level())
    return system


def _ignores(category: type[Warning]) -> bool:
    """Whether the first filter that is about a category ignores it, wherever it is warned of."""
    for action, message, of, module, line in warnings.filters:
        if issubclass(category, of):
            return action == "ignore" and message is None and module is None and not line
    return False


def _callers_level() -> int:
    """How far above `warn_of_rounding` the first function outside of the package is."""
    frame, level = sys._getframe(1), 1
    package = __name__.partition(".")[0]
    while frame.f_back and frame.f_globals.get("__name__", "").partition(".")[0] == package:
        frame, level = frame.f_back, level + 1
    return level


# Checks of callers' arguments, and how messages show values.


def shown_value(value: object) -> str:
    """A value as a message shows it: a number or a short text itself, the type of anything else.

    Examples
    --------
    >>> shown_value(3), shown_value("fast"), shown_value([1, 2]), shown_value(None)
    ('3', "'fast'", 'list', 'None')
    """
    if value is None or isinstance(value, (bool, int, float)):
        return f"{value!r:.40}"
    if isinstance(value, str):
        return ascii(value) if len(value) <= 40 else ascii(value[:40]) + "…"
    return type(value).__name__


def several(value: Any, where: str, what: str = "names") -> tuple[Any, ...]:
    """Return the members of a list or another collection.

    Parameters
    ----------
    value : iterable
    where : str
        The name of the argument.
    what : str
        The expected members of the list, for the message.

    Raises
    ------
    InputError
        If it is a text or a single value.

    Examples
    --------
    >>> several(["1", "2"], "channels")
    ('1', '2')
    >>> several("12", "channels")
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: channels: expected a list of names, found '12': write ['12']
    >>> several(2, "dimensions", "integers")
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: dimensions: expected a list of integers, found 2: write [2]
    """
    if isinstance(value, (str, bytes, Mapping)) or not hasattr(value, "__iter__"):
        single = isinstance(value, (str, int, float)) and not isinstance(value, bool)
        advice = f": write [{shown_value(value)}]" if single else ""
        raise InputError(
            f"expected a list of {what}, found {shown_value(value)}{advice}", where=where
        )
    if getattr(value, "ndim", 1) != 1:
        raise InputError(
            f"expected a list of {what}, found {shown_value(value)} with {value.ndim} dimensions",
            where=where,
        )
    members: Iterable[Any] = value
    return tuple(members)


def one_of(
    value: Any,
    options: Collection[str | None],
    where: str,
    kind: type[InputError | UsageError] = UsageError,
) -> None:
    """Refuse a value that is none of some texts.

    Parameters
    ----------
    value : object
    options : collection of str or None
    where : str
        The name of the argument.
    kind : type
        The error to raise.

    Raises
    ------
    UsageError
        If it is another text, or no text; or an error of this `kind`.

    Examples
    --------
    >>> one_of("own", ("own", "outputs"), "information")
    >>> one_of(3, ("own", "outputs"), "information")
    Traceback (most recent call last):
        ...
    mcexact.errors.UsageError: information: expected "own" or "outputs", found 3
    """
    if not (value is None or isinstance(value, str)) or value not in options:
        texts = [f'"{option}"' for option in options if option is not None]
        listed = " or ".join(filter(None, (", ".join(texts[:-1]), texts[-1])))
        raise kind(f"expected {listed}, found {shown_value(value)}", where=where)


def telling(progress: Callable[[str], None] | None) -> Callable[[str], None]:
    """Return the function to call with each step, or one that does nothing if there is none.

    Parameters
    ----------
    progress : callable or None

    Raises
    ------
    UsageError
        If it is something else.

    Examples
    --------
    >>> telling(print)("search")
    search
    >>> telling(None)("search")
    >>> telling(True)
    Traceback (most recent call last):
        ...
    mcexact.errors.UsageError: progress: expected a function, such as print, found True
    """
    if progress is None:
        return lambda _: None
    if not callable(progress):
        raise UsageError(
            f"expected a function, such as print, found {shown_value(progress)}", where="progress"
        )
    return progress


def require_seconds(value: Any, where: str) -> None:
    """Refuse what is no number of seconds.

    Raises
    ------
    UsageError
        If it is negative, not finite, or no number.

    Examples
    --------
    >>> require_seconds(2.5, "effort")
    >>> require_seconds(-1, "effort")
    Traceback (most recent call last):
        ...
    mcexact.errors.UsageError: effort: expected a number of seconds, found -1
    """
    good = isinstance(value, Real) and not isinstance(value, bool)
    if not (good and 0 <= value < inf):
        raise UsageError(f"expected a number of seconds, found {shown_value(value)}", where=where)
