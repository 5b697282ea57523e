"""Numbers and polynomials as text, shortened between terms and never inside a number."""

from __future__ import annotations

import re
from collections.abc import Callable
from decimal import MAX_EMAX, MIN_EMIN, ROUND_CEILING, ROUND_FLOOR, Decimal, localcontext
from fractions import Fraction
from typing import Protocol

from mcexact.exact.rational import decimal_or_quotient, rational_text


class Terms(Protocol):
    """What is shortened term by term: a polynomial."""

    @property
    def degree(self) -> int: ...

    def text(self, coefficient: Callable[[Fraction], str], /) -> str: ...


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


def approximated(x: Fraction) -> str:
    """Format a rational number: exactly if that is very short, otherwise rounded, after a sign.

    Examples
    --------
    >>> approximated(Fraction(1, 8)), approximated(Fraction(10**9, 7))
    ('0.125', '≈1.42857e+8')
    """
    exact = str(decimal_or_quotient(x))
    return exact if len(exact) <= 9 else f"≈{rounded(x)}"


def three_digits(x: Fraction, *, up: bool = False) -> str:
    """Format a rational number of any size with three digits, rounded down, or up.

    Examples
    --------
    >>> three_digits(Fraction(2, 3)), three_digits(Fraction(2, 3), up=True)
    ('0.666', '0.667')
    >>> three_digits(Fraction(123456)), three_digits(Fraction(5, 10**7), up=True)
    ('123000', '0.0000005')
    """
    rounding = ROUND_CEILING if up else ROUND_FLOOR
    with localcontext(prec=3, rounding=rounding, Emax=MAX_EMAX, Emin=MIN_EMIN):
        return f"{(Decimal(x.numerator) / Decimal(x.denominator)).normalize():f}"


def digits_outward(x: Fraction, *, up: bool, digits: int = 4) -> str:
    """Format a rational number of any size with some digits, rounded down, or up.

    Parameters
    ----------
    x : Fraction
    up : bool
        Whether what is written is at least x, and otherwise at most x.
    digits : int

    Examples
    --------
    >>> digits_outward(Fraction(2, 3), up=False), digits_outward(Fraction(-2, 3), up=False)
    ('0.6666', '-0.6667')
    >>> digits_outward(Fraction(1, 3 * 10**160), up=True), digits_outward(Fraction(40), up=True)
    ('3.334e-161', '40')
    """
    rounding = ROUND_CEILING if up else ROUND_FLOOR
    with localcontext(prec=digits, rounding=rounding, Emax=MAX_EMAX, Emin=MIN_EMIN):
        found = (Decimal(x.numerator) / Decimal(x.denominator)).normalize()
    return f"{found:f}" if -5 <= found.adjusted() <= 5 else f"{found:e}"


def power_of_ten_above(x: Fraction) -> int:
    """Return the least k with x ≤ 10^k, for x > 0.

    Examples
    --------
    >>> [power_of_ten_above(Fraction(each)) for each in ("1e-400", "1.1e-13", "10", "10.1")]
    [-400, -12, 1, 2]
    """
    with localcontext(prec=2, rounding=ROUND_CEILING, Emax=MAX_EMAX, Emin=MIN_EMIN):
        above = Decimal(x.numerator) / Decimal(x.denominator)
    return above.adjusted() + (above.normalize().as_tuple().digits != (1,))


def percent(part: Fraction, *, up: bool = False) -> str:
    """Format a part as a percentage with three digits, rounded down, or up.

    Examples
    --------
    >>> percent(Fraction(1, 3)), percent(Fraction(1, 200000)), percent(Fraction(123456))
    ('33.3 %', '0.0005 %', '12300000 %')
    >>> percent(Fraction(1, 3), up=True), percent(Fraction(0))
    ('33.4 %', '0 %')
    """
    return f"{three_digits(100 * part, up=up)} %"


def polynomial(p: Terms, limit: int = 60) -> str:
    """Format a polynomial: completely if that is short, otherwise its first and last terms.

    Examples
    --------
    >>> from mcexact.exact.polynomial import Polynomial
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


def _terms(p: Terms) -> list[str]:
    """The terms, highest power first, each except the first with its sign."""

    def coefficient(c: Fraction) -> str:
        text = number(c)
        return f"({text})" if text.startswith("about") else text

    return re.split(r" (?=[+-] )", p.text(coefficient))
