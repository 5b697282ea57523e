"""Rational numbers: conversion, the grammar in which they are written, shortened texts.

`as_fraction` converts an entry from Python, and `parse_rational` a text from a file: "1/3",
"0.25" and "1e-3" are the rational numbers that they denote.  Floats are refused, since they are
not what was meant.  `Limits` bounds the length of input.  Exact texts are written by
`rational_text` and `written` (for certificates); the functions of the last part shorten numbers
and polynomials for messages.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from decimal import MAX_EMAX, MIN_EMIN, ROUND_CEILING, ROUND_FLOOR, Decimal, localcontext
from fractions import Fraction
from typing import Any, Protocol

from mcexact.errors import FloatRefused, InputError, LimitReached

# Rational numbers: conversion of entries, and the grammar in which they are written.

Entry = Any
"""int, Fraction, Decimal, str in the grammar of files, or a sympy Rational."""


@dataclass(frozen=True)
class Limits:
    """Limits on input, beyond which it is refused.

    Parameters
    ----------
    bytes : int
        Length of a document.
    depth : int
        Nesting of a JSON document.
    digits : int
        Digits of one number, numerator and denominator counted separately.
    exponent : int
        Largest absolute value of a decimal exponent.
    """

    bytes: int = 64 * 2**20
    depth: int = 16
    digits: int = 4300
    exponent: int = 1000


DEFAULT_LIMITS = Limits()

_NUMBER = re.compile(
    r"(?P<sign>-?)(?:(?P<numerator>[0-9]+)/(?P<denominator>[0-9]+)"
    r"|(?P<whole>[0-9]+)(?:\.(?P<decimals>[0-9]+))?(?:[eE](?P<exponent>[+-]?[0-9]+))?)",
    re.ASCII,
)
_PARAMETRIC = "a system with parameters is a ParametricSystem(A, B, C, parameters=[…])"
_EXPRESSION = re.compile(r"-?[A-Za-z][0-9]?|(?=.*[A-Za-z])(?=.*[*^]).*")
_GRAMMAR = 'an integer, a decimal such as "-0.25" or "1e-3", or a quotient such as "1/3"'
TWO_WAYS_IN = (
    "a float is not exact: write the number as an integer, a Fraction or a string such as "
    '"0.25" or "1/3"; matrices of floats are read by MultiChannelSystem.from_float(A, B, C)'
)
# CPython refuses int() of longer digit strings; below it, conversion is quick enough.
_CHUNK = 4000
_MOST_BITS = 2**31


def parse_rational(
    text: str, limits: Limits = DEFAULT_LIMITS, *, where: str | None = None
) -> Fraction:
    """Parse a number exactly: a decimal is the rational number that it denotes.

    Parameters
    ----------
    text : str
        An optional minus sign and either ``p/q``, or digits with an optional decimal part and an
        optional exponent.  ASCII only; no blanks, no plus sign in front, no underscores.
    limits : Limits
    where : str, optional
        The place to name in an error.

    Returns
    -------
    Fraction

    Raises
    ------
    InputError
        The text is not in the grammar, has a zero denominator, or exceeds a limit.

    Examples
    --------
    >>> parse_rational("0.1"), parse_rational("-6/4"), parse_rational("25e-2")
    (Fraction(1, 10), Fraction(-3, 2), Fraction(1, 4))
    >>> parse_rational("1_000")
    Traceback (most recent call last):
    ...
    mcexact.errors.InputError: expected an integer, a decimal such as "-0.25" or "1e-3", or a \
quotient such as "1/3", found '1_000'
    """
    if len(text) > 2 * limits.digits + 16:
        raise _too_long(limits, where)
    match = _NUMBER.fullmatch(text)
    if match is None:
        raise InputError(f"expected {_GRAMMAR}, found {_shown(text)}", where=where)
    sign = -1 if match["sign"] else 1
    if match["numerator"] is not None:
        if max(len(match["numerator"]), len(match["denominator"])) > limits.digits:
            raise _too_long(limits, where)
        denominator = _integer(match["denominator"])
        if denominator == 0:
            raise InputError(
                f"the denominator is zero in {_shown(text)}; write a nonzero one", where=where
            )
        return Fraction(sign * _integer(match["numerator"]), denominator)
    decimals = match["decimals"] or ""
    if len(match["whole"]) + len(decimals) > limits.digits:
        raise _too_long(limits, where)
    exponent = _exponent(match["exponent"] or "0", limits, where)
    mantissa = sign * _integer(match["whole"] + decimals)
    power = exponent - len(decimals)
    if power >= 0:
        return Fraction(mantissa * 10**power)
    return Fraction(mantissa, 10**-power)


def _integer(digits: str) -> int:
    """Convert a string of ASCII digits of any length to an integer."""
    if len(digits) <= _CHUNK:
        return int(digits)
    half = len(digits) // 2
    power: int = 10**half
    return _integer(digits[:-half]) * power + _integer(digits[-half:])


def _exponent(digits: str, limits: Limits, where: str | None) -> int:
    if len(digits.lstrip("+-")) > limits.digits:
        raise _too_long(limits, where)
    significant = digits.lstrip("+-").lstrip("0")
    if len(significant) > 18 or int(significant or "0") > limits.exponent:
        raise InputError(
            f"expected an exponent of at most {limits.exponent} in absolute value, "
            f"found {_shown(digits)}; write the number with fewer digits or raise Limits.exponent",
            where=where,
        )
    return int(digits)


def _too_long(limits: Limits, where: str | None) -> InputError:
    return InputError(
        f"the number has more than {limits.digits} digits; shorten it or raise Limits.digits",
        where=where,
    )


def _shown(text: str) -> str:
    return repr(text) if len(text) <= 40 else f"{text[:37]!r}..."


def as_part(value: Entry, *, where: str | None = None) -> Fraction:
    """Convert a part of something, such as "10%", "0.1" or "1/10", to a rational number.

    Python and the command line read parts so.

    Parameters
    ----------
    value : int, Fraction, Decimal, str or sympy Rational
    where : str, optional
        The place to name in an error.

    Raises
    ------
    FloatRefused
        If the part is a float.
    InputError
        If it is not rational or negative, or a text above 1 that is no percentage.

    Examples
    --------
    >>> as_part("0.1%"), as_part("1/50"), as_part("200%")
    (Fraction(1, 1000), Fraction(1, 50), Fraction(2, 1))
    >>> as_part("10")
    Traceback (most recent call last):
    ...
    mcexact.errors.InputError: found 10, more than the whole: write "10%" for 10 percent
    """
    if is_inexact(value):
        raise FloatRefused(
            f'a float is not exact: write a part such as "10%", "0.1" or "1/10", found {value!r}',
            where=where,
        )
    percent = isinstance(value, str) and value.endswith("%")
    if isinstance(value, str):
        ratio = parse_rational(value.removesuffix("%").rstrip(), where=where)
    else:
        ratio = as_fraction(value, where=where)
    if ratio < 0:
        raise InputError(
            f"expected a part from 0 on, such as 0.1% or 1/1000, found {value}", where=where
        )
    if isinstance(value, str) and ratio > 1 and not percent:
        raise InputError(
            f'found {value}, more than the whole: write "{value}%" for {value} percent', where=where
        )
    return ratio / 100 if percent else ratio


def as_fraction(entry: Entry, *, where: str | None = None) -> Fraction:
    """Convert an entry to a rational number; floats and Booleans are refused.

    Parameters
    ----------
    entry : int, Fraction, Decimal, str or sympy Rational
        Integers of numpy count as int.
    where : str, optional
        The place to name in an error.

    Raises
    ------
    FloatRefused
        If the entry is a float; the message says how to convert floats.
    InputError
        The entry is not a rational number.

    Examples
    --------
    >>> as_fraction("1/3") + as_fraction(2)
    Fraction(7, 3)
    >>> as_fraction(0.5)
    Traceback (most recent call last):
    ...
    mcexact.errors.FloatRefused: a float is not exact: write the number as an integer, a Fraction \
or a string such as "0.25" or "1/3"; matrices of floats are read by \
MultiChannelSystem.from_float(A, B, C)
    """
    if type(entry) is int:
        return Fraction(entry)
    # A Fraction of numpy integers would keep them, and they overflow.
    if type(entry) is Fraction and type(entry.numerator) is type(entry.denominator) is int:
        return entry
    if isinstance(entry, str):
        if _EXPRESSION.fullmatch(entry):
            raise InputError(
                f"expected {_GRAMMAR}, found the expression {_shown(entry)}; {_PARAMETRIC}",
                where=where,
            )
        return parse_rational(entry, where=where)
    kind = type(entry)
    if isinstance(entry, bool) or kind.__name__ in ("bool_", "bool"):
        raise InputError(f"expected a number, found the Boolean {entry!r}", where=where)
    if isinstance(entry, complex) or getattr(getattr(entry, "dtype", None), "kind", "") == "c":
        raise InputError(f"expected a real number, found the complex number {entry}", where=where)
    if is_inexact(entry):
        raise FloatRefused(TWO_WAYS_IN, where=where)
    if isinstance(entry, Decimal):
        return _from_decimal(entry, where)
    if isinstance(entry, (int, Fraction)):
        return Fraction(int(entry.numerator), int(entry.denominator))
    if hasattr(entry, "__index__") and not getattr(entry, "shape", ()):
        return Fraction(entry.__index__())
    if getattr(entry, "is_Rational", False) is True:
        return Fraction(int(entry.p), int(entry.q))
    if getattr(entry, "free_symbols", None):
        raise InputError(
            f"expected a rational number, found the expression {_shown(str(entry))} with symbols; "
            f"{_PARAMETRIC}",
            where=where,
        )
    raise InputError(
        f"expected a rational number ({_GRAMMAR}), found {_shown(repr(entry))} "
        f"of type {kind.__name__}",
        where=where,
    )


def is_inexact(entry: Any) -> bool:
    """Whether an entry is a float of Python, numpy or sympy."""
    return (
        isinstance(entry, float)
        or getattr(getattr(entry, "dtype", None), "kind", "") in ("f", "c")
        or (getattr(entry, "is_Float", False) is True)
    )


def _from_decimal(entry: Decimal, where: str | None) -> Fraction:
    if not entry.is_finite():
        raise InputError(f"expected a finite number, found {entry!r}", where=where)
    sign, digits, exponent = entry.as_tuple()
    limit = DEFAULT_LIMITS.exponent
    if not isinstance(exponent, int) or abs(exponent) > limit + DEFAULT_LIMITS.digits:
        raise InputError(
            f"expected a Decimal with an exponent of at most {limit} in absolute value, found "
            f"exponent {exponent}; pass a Fraction instead",
            where=where,
        )
    mantissa = _integer("".join(map(str, digits)) or "0") * (-1 if sign else 1)
    return mantissa * Fraction(10) ** exponent


def require_power(exponent: Any, bits: int) -> int:
    """Check and return the exponent of a power that fits into memory.

    Parameters
    ----------
    exponent : object
        Should be an integer that is at least 0.
    bits : int
        The number of bits by which each further factor can lengthen a number.

    Raises
    ------
    InputError
        If it is not such an integer.
    LimitReached
        If the power could be too large for memory.

    Examples
    --------
    >>> require_power(10**12, bits=2)
    Traceback (most recent call last):
        ...
    mcexact.errors.LimitReached: the power 1000000000000 would be too large for memory
    """
    if type(exponent) is not int or exponent < 0:
        raise InputError(f"expected an exponent that is at least 0, found {exponent!r}")
    if exponent * max(bits, 1) > _MOST_BITS:
        raise LimitReached(f"the power {exponent} would be too large for memory")
    return exponent


# CPython converts integers of up to 4300 digits to text, and this many bits are fewer.
PRINTABLE_BITS = 14_000


def digits_of(value: int) -> str:
    """Return the decimal digits of an integer of any length; `str` refuses more than 4300.

    Examples
    --------
    >>> digits_of(-12), len(digits_of(10**5000))
    ('-12', 5001)
    """
    return str(value) if value.bit_length() < PRINTABLE_BITS else str(Decimal(value))


def rational_text(q: Fraction) -> str:
    """Return a rational number of any length as text."""
    if q.denominator == 1:
        return digits_of(q.numerator)
    return f"{digits_of(q.numerator)}/{digits_of(q.denominator)}"


def rational_latex(q: Fraction, command: str = "frac") -> str:
    r"""A rational number in LaTeX, a quotient set by ``command``.

    Examples
    --------
    >>> print(rational_latex(Fraction(-1, 2)))
    -\frac{1}{2}
    """
    top, bar, bottom = rational_text(abs(q)).partition("/")
    return ("-" if q < 0 else "") + (rf"\{command}{{{top}}}{{{bottom}}}" if bar else top)


def written(q: Fraction) -> int | str:
    """Return a rational number as in certificates: an integer, or ``"p/q"`` in lowest terms.

    Examples
    --------
    >>> written(Fraction(3)), written(Fraction(-1, 2))
    (3, '-1/2')
    """
    return q.numerator if q.denominator == 1 else rational_text(q)


def decimal_or_quotient(q: Fraction, most: int = 15) -> int | str:
    """Return an integer, a decimal of a few places at most if it is exact, or ``"p/q"``.

    Examples
    --------
    >>> decimal_or_quotient(Fraction(-13, 1250)), decimal_or_quotient(Fraction(2, 3))
    ('-0.0104', '2/3')
    >>> decimal_or_quotient(Fraction(7)), decimal_or_quotient(Fraction(1, 2**16))
    (7, '1/65536')
    """
    if q.denominator == 1 or 10**most % q.denominator:
        return written(q)
    places = next(k for k in range(1, most + 1) if not 10**k % q.denominator)
    whole, rest = divmod(abs(q.numerator) * (10**places // q.denominator), 10**places)
    return f"{'-' if q < 0 else ''}{digits_of(whole)}.{rest:0{places}d}"


# Numbers and polynomials as text, shortened between terms and never inside a number.


class Terms(Protocol):
    """A polynomial, as these functions shorten it: term by term."""

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
        Whether the result is at least x; otherwise it is at most x.
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
        decimal = (Decimal(x.numerator) / Decimal(x.denominator)).normalize()
    return f"{decimal:f}" if -5 <= decimal.adjusted() <= 5 else f"{decimal:e}"


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
