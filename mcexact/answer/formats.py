"""Modes, channels and names as text, shortened where they are many."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import number, polynomial


def modes(p: Polynomial, limit: int = 30) -> str:
    """Name the roots of a polynomial as modes; a rational mode by its value.

    Examples
    --------
    >>> modes(Polynomial.of("-1/2", 1)), modes(Polynomial.of(1, 0, 1))
    ('the mode 1/2', 'the 2 roots of x^2 + 1')
    """
    if p.degree == 1:
        return f"the mode {number(-p.coefficients[0] / p.coefficients[1])}"
    return f"the {p.degree} roots of {polynomial(p, limit)}"


def allowed(region: object | None) -> str:
    """Where modes may be that members of a box have, such as fixed ones; None for nowhere.

    Examples
    --------
    >>> allowed(None), allowed("Re λ < 0")
    ('none', 'only with Re λ < 0')
    """
    return "none" if region is None else f"only with {region}"


def count(size: int, noun: str) -> str:
    """Format a number with its noun, such as 2 nodes.

    Examples
    --------
    >>> count(1, "node"), count(2, "node")
    ('1 node', '2 nodes')
    """
    return f"{size} {noun}" if size == 1 else f"{size} {noun}s"


def listed(words: Sequence[str]) -> str:
    """Join words with commas and "and".

    Examples
    --------
    >>> listed(["1"]), listed(["1", "2", "3"])
    ('1', '1, 2 and 3')
    """
    return " and ".join(filter(None, [", ".join(words[:-1]), *words[-1:]]))


def channels(names: Iterable[str], limit: int = 8) -> str:
    """Name channels as a phrase.

    Examples
    --------
    >>> channels(["1"]), channels(["1", "2", "3"])
    ('channel 1', 'channels 1, 2 and 3')
    """
    shown = [name_text(name) for name in names]
    if len(shown) == 1:
        return f"channel {shown[0]}"
    return "channels " + listed(cut(shown, limit))


def name_set(names: Iterable[str], limit: int = 12) -> str:
    """Name channels in braces; of many channels the first few and the number of the others.

    Examples
    --------
    >>> name_set(["1", "2"]), name_set(map(str, range(20)), 2)
    ('{1, 2}', '{0, 1, 18 more}')
    """
    return "{" + ", ".join(cut([name_text(name) for name in names], limit)) + "}"


def cut(words: Sequence[str], limit: int, more: str = "{} more") -> list[str]:
    """Keep the first few words, and add the number of the others.

    Examples
    --------
    >>> cut(["a", "b", "c"], 2)
    ['a', 'b', '1 more']
    """
    return list(words) if len(words) <= limit else [*words[:limit], more.format(len(words) - limit)]


def name_text(name: str, limit: int = 40) -> str:
    """Format a name given by the user, shortened at its end."""
    return name if len(name) <= limit else name[: limit - 1] + "…"


def edges(edges: Sequence[tuple[str, str]], limit: int = 12) -> str:
    """Format edges of a graph as ``1 -> 2``; of many edges only the number.

    Examples
    --------
    >>> edges([("1", "2")]), edges([]), edges([("1", "1")] * 30)
    ('1 -> 2', 'no edges', '30 edges')
    """
    if not edges:
        return "no edges"
    if len(edges) > limit:
        return count(len(edges), "edge")
    return ", ".join(f"{name_text(start)} -> {name_text(end)}" for start, end in edges)
