"""Modes that depend on parameters, and which channels cause that they are fixed, in words."""

from __future__ import annotations

from collections.abc import Sequence


def blame(s: Sequence[str], names: Sequence[str]) -> str:
    """Say what it means that the pencil [xI − A, B_{m−s}; C_s, 0] of a set s loses rank.

    Examples
    --------
    >>> blame(["2", "3"], ["1", "2", "3"])
    'channel 1 does not control it, channels 2, 3 do not observe it'
    >>> blame([], ["1", "2"]), blame(["1"], ["1"])
    ('no channel controls it', 'no channel observes it')
    """
    others = [name for name in names if name not in s]
    if not s:
        return "no channel controls it"
    if not others:
        return "no channel observes it"
    return f"{_subject(others)} not control it, {_subject(s)} not observe it"


def _subject(names: Sequence[str]) -> str:
    several = len(names) > 1
    return f"channel{'s' if several else ''} {', '.join(names)} do{'' if several else 'es'}"


def polynomial_in_x(coefficients: Sequence[str]) -> str:
    """A polynomial in x by the texts of its coefficients, constant first.

    Examples
    --------
    >>> polynomial_in_x(["-t", "2", "1"]), polynomial_in_x(["t^2 - 2", "0", "1"])
    ('x^2 + 2*x - t', 'x^2 + (t^2 - 2)')
    """
    text = ""
    for k, each in reversed(list(enumerate(coefficients))):
        if each == "0":
            continue
        power = "" if k == 0 else "x" if k == 1 else f"x^{k}"
        negative = each.startswith("-") and " " not in each
        body = f"({each})" if " " in each else each.removeprefix("-")
        term = power if power and body == "1" else "*".join(filter(None, (body, power)))
        text += f" {'-' if negative else '+'} " if text else "-" if negative else ""
        text += term
    return text or "0"
