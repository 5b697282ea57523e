"""Arguments of callers: lists and choices, and what a message calls something else."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from math import inf
from numbers import Real
from typing import Any

from mcexact.errors import InputError, UsageError


def told(value: object) -> str:
    """What a message calls a value: a number or a short text itself, of others their type.

    Examples
    --------
    >>> told(3), told("fast"), told([1, 2]), told(None)
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
        What a list is expected of, for the message.

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
        advice = f": write [{told(value)}]" if single else ""
        raise InputError(f"expected a list of {what}, found {told(value)}{advice}", where=where)
    if getattr(value, "ndim", 1) != 1:
        raise InputError(
            f"expected a list of {what}, found {told(value)} with {value.ndim} dimensions",
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
        If it is another text, or no text; or an error of the kind that is given.

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
        raise kind(f"expected {listed}, found {told(value)}", where=where)


def telling(progress: Callable[[str], None] | None) -> Callable[[str], None]:
    """Return the function that is told of each step, or one that does nothing.

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
            f"expected a function, such as print, found {told(progress)}", where="progress"
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
        raise UsageError(f"expected a number of seconds, found {told(value)}", where=where)
