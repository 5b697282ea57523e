"""Polynomials in one variable over Q, and their forms.

A `Polynomial` is the tuple of its rational coefficients, constant term first.  It is immutable;
flint computes products, divisions, greatest common divisors and factors over Q.
`PolynomialForms` has its conversions to sympy and numpy, text, HTML and LaTeX.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import flint

from mcexact import shown
from mcexact.errors import InputError
from mcexact.exact.rational import (
    Entry,
    as_fraction,
    digits_of,
    polynomial,
    rational_latex,
    rational_text,
    require_power,
    written,
)

# Conversions and display.


class PolynomialForms:
    """The conversions and the display of `Polynomial`, which alone inherits them."""

    def to_sympy(self: Any, symbol: Any = "x") -> Any:
        """The polynomial as a ``sympy.Poly`` over the rational numbers, with equal coefficients.

        Parameters
        ----------
        symbol : sympy.Symbol or str

        Examples
        --------
        >>> from mcexact.exact.polynomial import Polynomial
        >>> Polynomial.of("1/3", 0, 1).to_sympy("s")
        Poly(s**2 + 1/3, s, domain='QQ')
        """
        import sympy

        variable = sympy.Symbol(symbol) if isinstance(symbol, str) else symbol
        descending = [sympy.Rational(c.numerator, c.denominator) for c in self.coefficients[::-1]]
        return sympy.Poly(descending or [0], variable, domain="QQ")

    def _sympy_(self) -> Any:
        return self.to_sympy().as_expr()

    def to_numpy(self: Any) -> Any:
        """The polynomial as a ``numpy.polynomial.Polynomial``, whose coefficients are rounded.

        Each coefficient becomes the float nearest to it, so that roots can be wrong.

        Examples
        --------
        >>> from mcexact.exact.polynomial import Polynomial
        >>> Polynomial.of(-4, 0, 1).to_numpy().roots()
        array([-2.,  2.])
        """
        from numpy.polynomial import Polynomial

        from mcexact.exact.matrix import to_float

        return Polynomial([to_float(c) for c in self.coefficients] or [0.0])

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:
        printer.text(repr(self))

    def _html(self: Any) -> str:
        """The polynomial as a piece of HTML."""
        return _html(self)

    def _repr_html_(self) -> str:
        return shown.framed(self._html())

    def _latex(self: Any) -> str:
        """The polynomial as a piece of LaTeX; of a long one the first and last terms."""
        if len(str(self)) > 2 * shown.LINE:
            return shown.words(_short(self).replace("*", " "))
        return str(self.latex())

    def _repr_latex_(self) -> str:
        return rf"$\displaystyle {self._latex()}$"


def pasted(p: Any) -> str:
    """Return an expression that makes the polynomial again, or of a long one a summary."""
    written = (repr(c) if isinstance(c, str) else digits_of(c) for c in p.as_json())
    text = f"Polynomial.of({', '.join(written)})"
    return text if len(text) <= shown.LINE else f"<polynomial {_short(p)}>"


def _short(p: Any) -> str:
    return polynomial(p, shown.LINE // 2)


def _html(p: Any) -> str:
    """Return the polynomial, of a long one the first and last terms, with raised exponents."""
    text = str(p)
    text = text if len(text) <= 2 * shown.LINE else _short(p)
    return re.sub(r"\^(\d+)", r"<sup>\1</sup>", text).replace("*", " ")


# Polynomials in one variable over the rational numbers.


@dataclass(frozen=True, repr=False)
class Polynomial(PolynomialForms):
    """A polynomial c_0 + c_1 x + … + c_d x^d with rational coefficients.

    Parameters
    ----------
    coefficients : tuple of Fraction
        Constant term first, the last one not 0; () is the zero polynomial.  `of` takes any exact
        entries and drops zeros at the end.

    Examples
    --------
    >>> p = Polynomial.of(-2, 0, 1)
    >>> str(p), p.degree, p(Fraction(3, 2))
    ('x^2 - 2', 2, Fraction(1, 4))
    >>> [(str(q), e) for q, e in (p * p * Polynomial.of(1, 1)).factor()]
    [('x + 1', 1), ('x^2 - 2', 2)]
    """

    coefficients: tuple[Fraction, ...]

    def __post_init__(self) -> None:
        if type(self.coefficients) is not tuple or not all(
            type(c) is Fraction for c in self.coefficients
        ):
            raise InputError("expected a tuple of Fractions; use Polynomial.of")
        if self.coefficients and not self.coefficients[-1]:
            raise InputError("expected a last coefficient that is not 0; use Polynomial.of")

    @classmethod
    def of(cls, *coefficients: Entry) -> Polynomial:
        """The polynomial with these coefficients, constant term first."""
        return cls.from_coefficients(coefficients)

    @classmethod
    def from_coefficients(
        cls, coefficients: Iterable[Entry], *, where: str | None = None
    ) -> Polynomial:
        """The polynomial with a list of exact coefficients, constant term first."""
        entries = [as_fraction(c, where=where) for c in coefficients]
        while entries and not entries[-1]:
            entries.pop()
        return cls(tuple(entries))

    @classmethod
    def from_roots(cls, roots: Iterable[Entry]) -> Polynomial:
        """The monic polynomial with these rational roots, repeated as given.

        Examples
        --------
        >>> str(Polynomial.from_roots([1, 1, "1/2"]))
        'x^3 - 5/2*x^2 + 2*x - 1/2'
        """
        return product(cls((-as_fraction(root), Fraction(1))) for root in roots)

    @classmethod
    def x(cls) -> Polynomial:
        """The variable."""
        return cls.of(0, 1)

    @property
    def degree(self) -> int:
        """The degree; −1 for the zero polynomial."""
        return len(self.coefficients) - 1

    @property
    def leading(self) -> Fraction:
        """The last coefficient; 0 for the zero polynomial."""
        return self.coefficients[-1] if self.coefficients else Fraction(0)

    def is_zero(self) -> bool:
        """Whether this is the zero polynomial."""
        return not self.coefficients

    @cached_property
    def denominator(self) -> int:
        """The least common denominator of the coefficients."""
        return math.lcm(*(c.denominator for c in self.coefficients))

    @cached_property
    def numerators(self) -> tuple[int, ...]:
        """The coefficients times `denominator`."""
        d = self.denominator
        return tuple(c.numerator * (d // c.denominator) for c in self.coefficients)

    @cached_property
    def _integer(self) -> flint.fmpz_poly:
        """The numerators in flint's form; the object is shared, so nothing may change it."""
        return flint.fmpz_poly(list(self.numerators))

    @property
    def _rational(self) -> flint.fmpq_poly:
        return flint.fmpq_poly(self._integer, self.denominator)

    def __getstate__(self) -> dict[str, Any]:
        return {"coefficients": self.coefficients}

    def monic(self) -> Polynomial:
        """This polynomial divided by its leading coefficient; refuses 0."""
        if self.is_zero():
            raise InputError("the zero polynomial has no monic multiple")
        lead = self.leading
        return self if lead == 1 else Polynomial(tuple(c / lead for c in self.coefficients))

    def derivative(self) -> Polynomial:
        """The derivative."""
        return Polynomial(tuple(k * c for k, c in enumerate(self.coefficients))[1:])

    def __call__(self, value: Fraction | int) -> Fraction:
        """The value at a rational number.

        The numerator is accumulated in integers, which spares a greatest common divisor per step.
        """
        if not self.coefficients:
            return Fraction(0)
        p, q = value.numerator, value.denominator
        total, power = 0, 1
        for c in reversed(self.numerators):
            total = total * p + c * power
            power *= q
        return Fraction(total, self.denominator * (power // q))

    def _coerced(self, other: Any) -> Polynomial | None:
        if isinstance(other, Polynomial):
            return other
        if isinstance(other, (int, Fraction)) and not isinstance(other, bool):
            return Polynomial.of(other)
        return None

    def __add__(self, other: Polynomial | int | Fraction) -> Polynomial:
        addend = self._coerced(other)
        return (
            NotImplemented if addend is None else from_fmpq_poly(self._rational + addend._rational)
        )

    __radd__ = __add__

    def __sub__(self, other: Polynomial | int | Fraction) -> Polynomial:
        addend = self._coerced(other)
        return (
            NotImplemented if addend is None else from_fmpq_poly(self._rational - addend._rational)
        )

    def __rsub__(self, other: int | Fraction) -> Polynomial:
        return -self + other

    def __neg__(self) -> Polynomial:
        return Polynomial(tuple(-c for c in self.coefficients))

    def __mul__(self, other: Polynomial | int | Fraction) -> Polynomial:
        factor = self._coerced(other)
        return (
            NotImplemented if factor is None else from_fmpq_poly(self._rational * factor._rational)
        )

    __rmul__ = __mul__

    def __pow__(self, exponent: int) -> Polynomial:
        heights = (
            max(c.numerator.bit_length(), c.denominator.bit_length()) for c in self.coefficients
        )
        exponent = require_power(exponent, max(self.degree, *heights, 1))
        result, square = Polynomial.of(1), self
        while exponent:
            if exponent & 1:
                result = result * square
            exponent >>= 1
            square = square * square if exponent else square
        return result

    def __divmod__(self, other: Polynomial) -> tuple[Polynomial, Polynomial]:
        if not isinstance(other, Polynomial):
            return NotImplemented
        if other.is_zero():
            raise ZeroDivisionError("division by the zero polynomial")
        quotient, remainder = divmod(self._rational, other._rational)
        return from_fmpq_poly(quotient), from_fmpq_poly(remainder)

    def __floordiv__(self, other: Polynomial) -> Polynomial:
        return divmod(self, other)[0]

    def __mod__(self, other: Polynomial) -> Polynomial:
        return divmod(self, other)[1]

    def divides(self, other: Polynomial) -> bool:
        """Whether other is a multiple of this polynomial.

        Every polynomial divides 0, and 0 divides nothing else.

        Examples
        --------
        >>> Polynomial.of(1, 1).divides(Polynomial.of(-1, 0, 1))
        True
        >>> Polynomial.of(2, 1).divides(Polynomial.of(-1, 0, 1))
        False
        """
        if self.is_zero():
            return other.is_zero()
        return (other % self).is_zero()

    def multiplicity_in(self, other: Polynomial) -> int:
        """The largest e with this polynomial to the e dividing other.

        This polynomial has degree at least 1, other is not 0.

        Raises
        ------
        InputError
            If this polynomial is constant, or the other one is 0.

        Examples
        --------
        >>> p = Polynomial.from_roots([1, 1, 3])
        >>> Polynomial.of(-1, 1).multiplicity_in(p), Polynomial.of(1, 1).multiplicity_in(p)
        (2, 0)
        """
        if self.degree < 1 or other.is_zero():
            raise InputError("expected a divisor of degree at least 1 and a nonzero polynomial")
        count = 0
        quotient, remainder = divmod(other, self)
        while remainder.is_zero():
            count += 1
            quotient, remainder = divmod(quotient, self)
        return count

    def gcd(self, other: Polynomial) -> Polynomial:
        """The monic greatest common divisor; 0 only of two zeros.

        Examples
        --------
        >>> str(Polynomial.from_roots([1, 2]).gcd(Polynomial.from_roots([2, 3])))
        'x - 2'
        """
        return from_fmpq_poly(self._rational.gcd(other._rational))

    def squarefree_part(self) -> Polynomial:
        """The monic product of the distinct irreducible factors; refuses 0."""
        p = self.monic()
        return (p // p.gcd(p.derivative())).monic() if p.degree > 0 else p

    def is_squarefree(self) -> bool:
        """Whether no factor of degree at least 1 occurs twice; false for 0."""
        return not self.is_zero() and self.gcd(self.derivative()).degree <= 0

    def factor(self) -> list[tuple[Polynomial, int]]:
        """The monic irreducible factors over Q with their multiplicities.

        Sorted by degree, then by coefficients.  Constants have none; 0 is refused.
        """
        if self.is_zero():
            raise InputError("the zero polynomial has no factorization")
        _, factors = self._integer.factor()
        found = [
            (from_fmpq_poly(flint.fmpq_poly(factor)).monic(), int(multiplicity))
            for factor, multiplicity in factors
        ]
        return sorted(found, key=lambda pair: (pair[0].degree, pair[0].coefficients))

    def is_irreducible(self) -> bool:
        """Whether the degree is at least 1 and there is no proper factor over Q."""
        if self.degree < 1:
            return False
        factors = self.factor()
        return len(factors) == 1 and factors[0][1] == 1

    def compose_shift(self, a: Fraction | int) -> Polynomial:
        """p(x + a), whose roots are those of p reduced by a.

        Examples
        --------
        >>> Polynomial.from_roots([5]).compose_shift(2) == Polynomial.from_roots([3])
        True
        """
        return from_fmpq_poly(self._rational(flint.fmpq_poly([to_fmpq(a), 1])))

    def scale(self, a: Fraction | int) -> Polynomial:
        """p(a x), whose roots are those of p divided by a; the constant p(0) if a = 0.

        Examples
        --------
        >>> str(Polynomial.of(-6, 1).scale(2))
        '2*x - 6'
        """
        power, scaled = Fraction(1), []
        for c in self.coefficients:
            scaled.append(c * power)
            power *= a
        return Polynomial.from_coefficients(scaled)

    def as_json(self) -> list[int | str]:
        """The coefficients as certificates write them: integers or ``"p/q"``.

        Examples
        --------
        >>> Polynomial.of("1/2", -3).as_json()
        ['1/2', -3]
        """
        return [written(c) for c in self.coefficients]

    def __str__(self) -> str:
        return self.text(rational_text)

    def text(self, coefficient: Callable[[Fraction], str]) -> str:
        """The polynomial, highest power first; ``coefficient`` writes the absolute values."""
        return _rendered(self, "x^{}", lambda c: coefficient(abs(c)), "*")

    def latex(self) -> str:
        """LaTeX source.

        Examples
        --------
        >>> print(Polynomial.of(1, "-1/2", 1).latex())
        x^{2} - \\frac{1}{2} x + 1
        """

        return _rendered(self, "x^{{{}}}", lambda c: rational_latex(abs(c)), " ")

    def __repr__(self) -> str:
        return pasted(self)


def product(polynomials: Iterable[Polynomial]) -> Polynomial:
    """The product; 1 for none.

    Examples
    --------
    >>> str(product([Polynomial.of(1, 1), Polynomial.of(-1, 1)]))
    'x^2 - 1'
    """
    level = list(polynomials)
    while len(level) > 1:
        pairs = [a * b for a, b in zip(level[::2], level[1::2], strict=False)]
        level = pairs + (level[-1:] if len(level) % 2 else [])
    return level[0] if level else Polynomial.of(1)


# Conversion to and from flint.


def to_fmpq(value: Fraction | int) -> flint.fmpq:
    """A rational number in flint's form."""
    return flint.fmpq(value.numerator, value.denominator)


def from_fmpq(value: flint.fmpq) -> Fraction:
    """A rational number of flint's."""
    return Fraction(int(value.p), int(value.q))


def to_fmpz_poly(p: Polynomial) -> flint.fmpz_poly:
    """The numerators in flint's form, which nothing may change."""
    return p._integer


def to_fmpq_poly(p: Polynomial) -> flint.fmpq_poly:
    """A polynomial in flint's form."""
    return p._rational


def from_fmpq_poly(p: flint.fmpq_poly) -> Polynomial:
    """A polynomial of flint's."""
    denominator = int(p.denom())
    return Polynomial(tuple(Fraction(int(c), denominator) for c in p.numer().coeffs()))


def from_integer_coefficients(numerators: Iterable[int], denominator: int = 1) -> Polynomial:
    """The polynomial Σ numerators[k] x^k / denominator."""
    return Polynomial.from_coefficients([Fraction(int(c), denominator) for c in numerators])


def _rendered(p: Polynomial, power: str, coefficient: Any, times: str) -> str:
    """Terms from the highest power down, with signs between them."""
    terms: list[str] = []
    for k in range(p.degree, -1, -1):
        c = p.coefficients[k]
        if not c:
            continue
        variable = "" if k == 0 else "x" if k == 1 else power.format(k)
        if abs(c) == 1 and variable:
            body = variable
        else:
            body = coefficient(c) + (times + variable if variable else "")
        sign = ("-" if c < 0 else "") if not terms else (" - " if c < 0 else " + ")
        terms.append(sign + body)
    return "".join(terms) or "0"
