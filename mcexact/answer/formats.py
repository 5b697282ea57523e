"""Numbers, polynomials and names as text, shortened between terms and never inside a number."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from decimal import MAX_EMAX, MIN_EMIN, Decimal, localcontext
from fractions import Fraction

from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import rational_text


def number(x: Fraction, limit: int = 24) -> str:
    """Format a rational number: exactly if that is short, otherwise rounded.

    Examples
    --------
    >>> number(Fraction(-1, 3)), number(Fraction(10**50 + 1, 3))
    ('-1/3', 'about 3.33333e+49')
    """
    exact = rational_text(x)
    return exact if len(exact) <= limit else f"about {rounded(x)}"


def decimal_number(text: str, limit: int = 24) -> str:
    """Format a decimal string: exactly if that is short, otherwise rounded.

    Examples
    --------
    >>> decimal_number("0.25"), decimal_number("0." + "3" * 40)
    ('0.25', 'about 0.333333')
    """
    return text if len(text) <= limit else f"about {rounded(Fraction(Decimal(text)))}"


def rounded(x: Fraction) -> str:
    """Format a rational number of any size with six significant digits.

    Examples
    --------
    >>> rounded(Fraction(2, 3)), rounded(Fraction(-1, 10**400))
    ('0.666667', '-1e-400')
    """
    with localcontext(prec=6, Emax=MAX_EMAX, Emin=MIN_EMIN):
        return f"{(Decimal(x.numerator) / Decimal(x.denominator)).normalize():g}"


def polynomial(p: Polynomial, limit: int = 60) -> str:
    """Format a polynomial: completely if that is short, otherwise its first and last terms.

    Examples
    --------
    >>> polynomial(Polynomial.of(-1, 1))
    'x - 1'
    >>> polynomial(Polynomial.of(*range(1, 20)), 40)
    '19*x^18 + 18*x^17 + … + 1 (degree 18)'
    """
    exact = str(p)
    if len(exact) <= limit:
        return exact
    terms = _terms(p)
    tail = f" (degree {p.degree})"
    # The term of least degree is kept if it is short; the leading term always is.
    last = f" {terms[-1]}" if len(terms) > 1 and len(terms[-1]) <= limit // 3 else ""
    shown = terms[0]
    for term in terms[1:-1]:
        if len(f"{shown} {term} + …{last}{tail}") > limit:
            break
        shown = f"{shown} {term}"
    return f"{shown} + …{last}{tail}" if len(terms) > 2 else f"{shown} {terms[-1]}"


def _terms(p: Polynomial) -> list[str]:
    """The terms, highest power first, each except the first with its sign."""

    def coefficient(c: Fraction) -> str:
        text = number(c)
        return f"({text})" if text.startswith("about") else text

    return re.split(r" (?=[+-] )", p.text(coefficient))


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
