"""Entries with a parameter, such as "1/2 + 3*t^2", by the grammar of ``FORMAT.md``."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from fractions import Fraction
from itertools import zip_longest
from typing import Generic, TypeVar

from . import system_matrices
from .arithmetic import Polynomial, poly_divide, poly_product, stripped
from .budget import fractions, limbs_of, spend
from .reading import Json, Limits, malformed, shown
from .statement import polynomial_text

P = TypeVar("P")
Function = tuple[Polynomial, Polynomial]
"""Numerator and monic denominator in lowest terms."""

TOKEN = re.compile(r" *+([0-9]++(?:\.[0-9]++)?|[A-Za-z][A-Za-z0-9_]*+|[-+*/^()])")
PARAMETER = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,63}")
MOST_DEGREE = 1000
LONGEST, DEEPEST = 100_000, 50


def function(value: Json, place: str, parameter: str, limits: Limits | None) -> Function:
    """An entry: a number, or an expression."""
    return _OneParameter(value, place, (parameter,), limits).whole()


def function_text(value: Function, parameter: str) -> Json:
    """The canonical form of an entry: a rational, or a text."""
    top, bottom = value
    if max(len(top), len(bottom)) < 2:
        found = sum(top, Fraction(0))
        return found.numerator if found.denominator == 1 else str(found)
    text = polynomial_text(top, parameter)
    if len(bottom) == 1:
        return text
    return f"({text})/({polynomial_text(bottom, parameter)})"


def common_divisor(a: Polynomial, b: Polynomial) -> Polynomial:
    """The monic greatest common divisor of a and b ≠ 0 over Q."""
    while a:
        a, b = poly_divide(b, a)[1], a
    return _over(b, b[-1])


def _over(p: Polynomial, number: Fraction) -> Polynomial:
    """The polynomial divided by a number."""
    spend(fractions(len(p), 2 * limbs_of([*p, number])))
    return [c / number for c in p]


def in_lowest_terms(top: Polynomial, bottom: Polynomial) -> Function:
    """The quotient by bottom ≠ 0 without common factors, with a monic denominator."""
    g = common_divisor(top, bottom)
    top, bottom = poly_divide(top, g)[0], poly_divide(bottom, g)[0]
    return _over(top, bottom[-1]), _over(bottom, bottom[-1])


class Reader(ABC, Generic[P]):
    """The tokens of an expression, those that are left, and how polynomials are computed with."""

    def __init__(
        self, value: Json, place: str, parameters: tuple[str, ...], limits: Limits | None
    ) -> None:
        self.place, self.parameters, self.limits, self.depth = place, parameters, limits, 0
        self.value, self.tokens = value, list[str]()

    def whole(self) -> tuple[P, P]:
        """All of the text, or the number that it is."""
        text, place = self.value, self.place
        spend(200 + 10 * len(self.parameters))
        if type(text) is not str or system_matrices.NUMBER.fullmatch(text):
            found = Fraction(system_matrices.number(text, place, self.limits))
            return self.number(found), self.number(Fraction(1))
        if len(text) > LONGEST:
            malformed(place, f"expected at most {LONGEST} characters")
        end, text = 0, text.rstrip(" ")
        spend(100 * len(text))
        while end < len(text):
            match = TOKEN.match(text, end)
            if match is None:
                malformed(place, f"expected an expression, found {shown(text[end:])}")
            self.tokens.append(match[1])
            end = match.end()
        self.tokens.reverse()
        result = self.sum()
        if self.tokens:
            malformed(place, f"expected an operator, found {shown(self.tokens[-1])}")
        return result

    def take(self, *choices: str) -> str:
        """The next token, which is then passed, if it is one of these."""
        return self.tokens.pop() if self.tokens and self.tokens[-1] in choices else ""

    def sum(self) -> tuple[P, P]:
        """Products, added and subtracted."""
        self.depth += 1
        if self.depth > DEEPEST:
            malformed(self.place, f"more than {DEEPEST} sums inside each other")
        sign = self.take("-") or "+"
        a, b = self.product()
        result = (self.times(a, self.number(Fraction(-1))) if sign == "-" else a), b
        while sign := self.take("+", "-"):
            (a, b), (c, d) = result, self.product()
            result = self.fraction([(a, d, "+"), (c, b, sign)], (b, d))
        self.depth -= 1
        return result

    def product(self) -> tuple[P, P]:
        """Powers, multiplied and divided."""
        a, b = self.power()
        while sign := self.take("*", "/"):
            c, d = self.power()
            if sign == "/":
                if not c:
                    malformed(self.place, "division by 0")
                c, d = d, c
            a, b = self.fraction([(a, c, "+")], (b, d))
        return a, b

    def power(self) -> tuple[P, P]:
        """An atom, perhaps with an exponent."""
        c, d = self.atom()
        if not self.take("^"):
            return c, d
        digits = self.tokens.pop() if self.tokens else ""
        if not digits.isdigit() or len(digits) > 9:
            malformed(self.place, f"expected an exponent, found {shown(digits)}")
        self.limit(int(digits) * max(self.degree(c), self.degree(d), 1))
        return self.raised(c, int(digits)), self.raised(d, int(digits))

    def atom(self) -> tuple[P, P]:
        """A number, a parameter, or a sum in parentheses."""
        token = self.tokens.pop() if self.tokens else ""
        if token == "(":
            result = self.sum()
            if not self.take(")"):
                malformed(self.place, "expected a closing parenthesis")
            return result
        one = Fraction(1)
        if token in self.parameters:
            return self.parameter(token), self.number(one)
        if not token[:1].isdigit():
            malformed(self.place, f"expected a number or the parameter, found {shown(token)}")
        number = Fraction(system_matrices.number(token, self.place, self.limits))
        return self.number(number), self.number(one)

    def limit(self, degree: int) -> None:
        """Stop where a degree is too large."""
        if degree > MOST_DEGREE:
            malformed(self.place, f"the degree {degree} exceeds {MOST_DEGREE}")

    def fraction(self, terms: list[tuple[P, P, str]], below: tuple[P, P]) -> tuple[P, P]:
        """The sum or difference of products, over a product, in lowest terms."""
        top = self.number(Fraction(0))
        for a, b, sign in terms:
            self.limit(self.degree(a) + self.degree(b))
            top = self.plus(top, self.times(a, b), sign)
        self.limit(self.degree(below[0]) + self.degree(below[1]))
        return self.lowest(top, self.times(*below))

    def raised(self, p: P, exponent: int) -> P:
        """A power."""
        result = self.number(Fraction(1))
        for bit in format(exponent, "b"):
            result = self.times(result, result)
            result = self.times(result, p) if bit == "1" else result
        return result

    @abstractmethod
    def number(self, c: Fraction) -> P:
        """A constant."""

    @abstractmethod
    def parameter(self, name: str) -> P:
        """A parameter."""

    @abstractmethod
    def degree(self, p: P) -> int:
        """The total degree, 0 of 0."""

    @abstractmethod
    def times(self, a: P, b: P) -> P:
        """The product."""

    @abstractmethod
    def plus(self, a: P, b: P, sign: str) -> P:
        """The sum, or the difference."""

    @abstractmethod
    def lowest(self, top: P, bottom: P) -> tuple[P, P]:
        """A quotient in lowest terms, the leading coefficient of its denominator being 1."""


class _OneParameter(Reader[Polynomial]):
    """Polynomials by their coefficients, constant first."""

    def number(self, c: Fraction) -> Polynomial:
        return stripped([c])

    def parameter(self, name: str) -> Polynomial:
        return [Fraction(0), Fraction(1)]

    def degree(self, p: Polynomial) -> int:
        return max(len(p) - 1, 0)

    def times(self, a: Polynomial, b: Polynomial) -> Polynomial:
        return poly_product(a, b) if a and b else []

    def plus(self, a: Polynomial, b: Polynomial, sign: str) -> Polynomial:
        spend(fractions(len(a) + len(b), limbs_of(a) + limbs_of(b)))
        b = [-c for c in b] if sign == "-" else b
        return stripped([x + y for x, y in zip_longest(a, b, fillvalue=Fraction(0))])

    def lowest(self, top: Polynomial, bottom: Polynomial) -> Function:
        return in_lowest_terms(top, bottom)
