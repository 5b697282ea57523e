"""Limits of inputs: between which values each input of an agent has to be.

An actuator gives at most so much: where an agent computes v, the plant receives v cut off at the
limits, sat(v).  Limits contain 0, so that a plant at rest can stay there.  They have one entry for
each input of each channel, which is None for an input without limits.  They say what a controller
is for, and are no part of a plant: no digest depends on them, and claims about inputs that are cut
off name their limits themselves.  `read_input_limits` reads them, also from a system file,
`limits_document` writes them, and `limits_in` reads what the option ``--limits`` takes.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from mcexact.errors import InputError
from mcexact.exact.rational import DEFAULT_LIMITS, Limits, as_fraction, rational_text, written
from mcexact.model.entries import read_number
from mcexact.model.text import NumberText, kind_of, nearest, quoted

Range = tuple[Fraction, Fraction]
InputLimits = tuple[tuple[Range | None, ...], ...]
"""For each channel, for each of its inputs, the least and the largest value, or None."""


def read_input_limits(
    value: Any,
    names: Sequence[str],
    counts: Sequence[int],
    where: str = "limits",
    reading: Limits = DEFAULT_LIMITS,
) -> InputLimits | None:
    """Read the limits of inputs.

    Parameters
    ----------
    value : mapping
        For some channels, by name or by position from 0 on, a list with an entry for each input:
        the least and the largest value, or None.  The inputs of other channels have no limits.
    names : sequence of str
    counts : sequence of int
        The numbers p_i of inputs.
    where : str
    reading : Limits
        On the numbers of a file.

    Returns
    -------
    InputLimits or None
        None where no input has limits.

    Raises
    ------
    InputError
        If a channel does not exist, the number of entries is not that of its inputs, or limits are
        not in order or do not contain 0.

    Examples
    --------
    >>> read_input_limits({"left": [[-1, "1/2"]], 1: [None]}, ["left", "right"], [1, 1])
    (((Fraction(-1, 1), Fraction(1, 2)),), (None,))
    >>> read_input_limits({"left": [[1, 2]]}, ["left"], [1])
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: limits['left'][0]: expected limits that contain 0, found 1 and 2
    """
    if not isinstance(value, Mapping):
        raise InputError(f"expected limits by channel, found {kind_of(value)}", where=where)
    by_name = {}
    for key, entries in value.items():
        name = key
        if isinstance(key, int) and not isinstance(key, bool) and 0 <= key < len(names):
            name = names[key]
        if name not in names:
            raise InputError(
                f"there is no channel {quoted(str(key))}{nearest(str(key), names)}", where=where
            )
        if name in by_name:
            raise InputError(f"the channel {quoted(name)} occurs twice", where=where)
        by_name[name] = entries
    limits = tuple(
        _of_channel(by_name[name], p, f"{where}[{quoted(name)}]", reading)
        if name in by_name
        else (None,) * p
        for name, p in zip(names, counts, strict=True)
    )
    return limits if any(each is not None for own in limits for each in own) else None


def _of_channel(value: Any, p: int, where: str, reading: Limits) -> tuple[Range | None, ...]:
    """Read the limits of the inputs of one channel."""
    if isinstance(value, str) or not isinstance(value, Sequence) or len(value) != p:
        raise InputError(f"expected {p} pairs, one for each input, or null", where=where)
    return tuple(
        None if pair is None else _pair(pair, f"{where}[{k}]", reading)
        for k, pair in enumerate(value)
    )


def _pair(pair: Any, where: str, reading: Limits) -> Range:
    """Read the least and the largest value of an input."""
    if isinstance(pair, str) or not isinstance(pair, Sequence) or len(pair) != 2:
        raise InputError("expected the least and the largest value", where=where)

    def number(x: Any) -> Fraction:
        if isinstance(x, NumberText):
            return read_number(x, where, reading)
        return as_fraction(x, where=where)

    low, high = map(number, pair)
    if not low <= 0 <= high or low == high:
        raise InputError(
            f"expected limits that contain 0, found {rational_text(low)} and {rational_text(high)}",
            where=where,
        )
    return low, high


def limits_document(limits: InputLimits, names: Sequence[str]) -> dict[str, Any]:
    """Write limits as the key ``limits`` of a system file has them.

    Examples
    --------
    >>> limits_document((((Fraction(-1), Fraction(1, 2)),), (None,)), ["left", "right"])
    {'left': [[-1, '1/2']]}
    """
    return {
        name: pairs_document(own)
        for name, own in zip(names, limits, strict=True)
        if any(each is not None for each in own)
    }


def pairs_document(own: Sequence[Range | None]) -> list[Any]:
    """Write the limits of the inputs of one channel."""
    return [None if each is None else [written(x) for x in each] for each in own]


_NUMBERED = re.compile(r"(.+)\[([0-9]{1,6})\]")


def limits_in(
    texts: Sequence[str], names: Sequence[str], counts: Sequence[int]
) -> InputLimits | None:
    """Read limits from texts such as ``-1,1``, ``left:0,2`` or ``left[2]:0,2``.

    They are those of every input, of every input of an agent, and of one input of an agent, counted
    from 1 on.  The closer text is the one that holds.

    Raises
    ------
    InputError
        If two numbers do not follow the last colon, the channel or its input does not exist, or
        limits are given twice.

    Examples
    --------
    >>> limits_in(["-1,1", "right:0,1/2"], ["left", "right"], [1, 1])
    (((Fraction(-1, 1), Fraction(1, 1)),), ((Fraction(0, 1), Fraction(1, 2)),))
    >>> limits_in(["left[2]:0,1/2"], ["left", "right"], [2, 1])
    ((None, (Fraction(0, 1), Fraction(1, 2))), (None,))
    """
    where, chosen = "--limits", dict[tuple[str, int | None], list[str]]()
    for text in texts:
        of, _, numbers = text.rpartition(":")
        pair = [part.strip() for part in numbers.split(",")]
        if len(pair) != 2 or not all(pair):
            raise InputError(
                f"expected two numbers, as in -1,1 or left:-1,1, found {quoted(text)}", where=where
            )
        place = _place_in(of, names, counts, where)
        if place in chosen:
            known = f"the channel {quoted(of)}" if of else "every input"
            raise InputError(f"limits of {known} are given twice", where=where)
        chosen[place] = pair
    every = chosen.get(("", None))
    pairs = {
        name: [chosen.get((name, k), chosen.get((name, None), every)) for k in range(p)]
        for name, p in zip(names, counts, strict=True)
    }
    return read_input_limits(pairs, names, counts, where)


def _place_in(
    of: str, names: Sequence[str], counts: Sequence[int], where: str
) -> tuple[str, int | None]:
    """The agent, and the position of one of its inputs; without a name all inputs."""
    if not of or of in names:
        return of, None
    numbered = _NUMBERED.fullmatch(of)
    name = numbered[1] if numbered else of
    if name not in names:
        raise InputError(f"there is no channel {quoted(name)}{nearest(name, names)}", where=where)
    k, p = int(numbered[2]) if numbered else 0, counts[names.index(name)]
    if not 1 <= k <= p:
        raise InputError(f"the channel {quoted(name)} has {p} inputs, from 1 on", where=where)
    return name, k - 1


def limits_in_words(limits: InputLimits, names: Sequence[str]) -> str:
    """Say what the limits are, inputs as in trajectories.

    Examples
    --------
    >>> limits_in_words((((Fraction(-1), Fraction(1, 2)),), (None,)), ["left", "right"])
    'left from -1 to 1/2'
    """
    parts = []
    for name, own in zip(names, limits, strict=True):
        inputs = [name] if len(own) == 1 else [f"{name}[{k + 1}]" for k in range(len(own))]
        parts += [
            f"{label} from {rational_text(each[0])} to {rational_text(each[1])}"
            for label, each in zip(inputs, own, strict=True)
            if each is not None
        ]
    return ", ".join(parts)
