"""Entries with a parameter, such as "1/2 + 3*t^2", by the grammar of ``FORMAT.md``."""

import re
from fractions import Fraction
from itertools import zip_longest

from . import system_matrices
from .arithmetic import Polynomial, poly_divide, poly_product, stripped
from .budget import fractions, limbs_of, spend
from .reading import Json, Limits, malformed, shown
from .statement import polynomial_text

Function = tuple[Polynomial, Polynomial]
"""Numerator and monic denominator in lowest terms."""

TOKEN = re.compile(r" *+([0-9]++(?:\.[0-9]++)?|[A-Za-z][A-Za-z0-9_]*+|[-+*/^()])")
PARAMETER = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,63}")
MOST_DEGREE = 1000
LONGEST, DEEPEST = 100_000, 50


def function(value: Json, place: str, parameter: str, limits: Limits | None) -> Function:
    """An entry: a number, or an expression."""
    if type(value) is not str or system_matrices.NUMBER.fullmatch(value):
        found = Fraction(system_matrices.number(value, place, limits))
        return stripped([found]), [Fraction(1)]
    if len(value) > LONGEST:
        malformed(place, f"expected at most {LONGEST} characters")
    return _Reader(value, place, parameter, limits).whole()


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
    return [c / b[-1] for c in b]


class _Reader:
    """The tokens of an expression, and those that are left."""

    def __init__(self, text: str, place: str, parameter: str, limits: Limits | None) -> None:
        self.place, self.parameter, self.limits, self.depth = place, parameter, limits, 0
        self.tokens: list[str] = []
        end, text = 0, text.rstrip(" ")
        spend(100 * len(text))
        while end < len(text):
            match = TOKEN.match(text, end)
            if match is None:
                malformed(place, f"expected an expression, found {shown(text[end:])}")
            self.tokens.append(match[1])
            end = match.end()
        self.tokens = [*self.tokens[::-1]]

    def whole(self) -> Function:
        """All of the text."""
        result = self.sum()
        if self.tokens:
            malformed(self.place, f"expected an operator, found {shown(self.tokens[-1])}")
        return result

    def take(self, *choices: str) -> str:
        """The next token, which is then passed, if it is one of these."""
        return self.tokens.pop() if self.tokens and self.tokens[-1] in choices else ""

    def sum(self) -> Function:
        """Products, added and subtracted."""
        self.depth += 1
        if self.depth > DEEPEST:
            malformed(self.place, f"more than {DEEPEST} sums inside each other")
        sign = self.take("-") or "+"
        result = _negated(self.product()) if sign == "-" else self.product()
        while sign := self.take("+", "-"):
            (a, b), (c, d) = result, self.product()
            result = self.lowest([(a, d, "+"), (c, b, sign)], (b, d))
        self.depth -= 1
        return result

    def product(self) -> Function:
        """Powers, multiplied and divided."""
        a, b = self.power()
        while sign := self.take("*", "/"):
            c, d = self.power()
            if sign == "/":
                if not c:
                    malformed(self.place, "division by 0")
                c, d = d, c
            a, b = self.lowest([(a, c, "+")], (b, d))
        return a, b

    def power(self) -> Function:
        """An atom, perhaps with an exponent."""
        c, d = self.atom()
        if not self.take("^"):
            return c, d
        digits = self.tokens.pop() if self.tokens else ""
        if not digits.isdigit() or len(digits) > 9:
            malformed(self.place, f"expected an exponent, found {shown(digits)}")
        self.limit(int(digits) * max(len(c) - 1, len(d) - 1, 1))
        return _power(c, int(digits)), _power(d, int(digits))

    def atom(self) -> Function:
        """A number, the parameter, or a sum in parentheses."""
        token = self.tokens.pop() if self.tokens else ""
        if token == "(":
            result = self.sum()
            if not self.take(")"):
                malformed(self.place, "expected a closing parenthesis")
            return result
        if token == self.parameter:
            return [Fraction(0), Fraction(1)], [Fraction(1)]
        if not token[:1].isdigit():
            malformed(self.place, f"expected a number or the parameter, found {shown(token)}")
        return stripped([Fraction(system_matrices.number(token, self.place, self.limits))]), [
            Fraction(1)
        ]

    def limit(self, degree: int) -> None:
        """Stop where a degree is too large."""
        if degree > MOST_DEGREE:
            malformed(self.place, f"the degree {degree} exceeds {MOST_DEGREE}")

    def lowest(
        self, terms: list[tuple[Polynomial, Polynomial, str]], below: tuple[Polynomial, Polynomial]
    ) -> Function:
        """The sum or difference of products, over a product, in lowest terms."""
        top: Polynomial = []
        for a, b, sign in terms:
            self.limit(max(len(a) - 1, 0) + max(len(b) - 1, 0))
            part = _product(a, b) if sign == "+" else _negated((_product(a, b), []))[0]
            spend(fractions(len(part), limbs_of(part) + limbs_of(top)))
            top = stripped([x + y for x, y in zip_longest(top, part, fillvalue=Fraction(0))])
        self.limit(len(below[0]) + len(below[1]) - 2)
        bottom = _product(*below)
        g = common_divisor(top, bottom)
        top, bottom = poly_divide(top, g)[0], poly_divide(bottom, g)[0]
        return [c / bottom[-1] for c in top], [c / bottom[-1] for c in bottom]


def _negated(value: Function) -> Function:
    return [-c for c in value[0]], value[1]


def _power(p: Polynomial, exponent: int) -> Polynomial:
    result: Polynomial = [Fraction(1)]
    for bit in format(exponent, "b"):
        result = _product(result, result)
        result = _product(result, p) if bit == "1" else result
    return result


def _product(a: Polynomial, b: Polynomial) -> Polynomial:
    return poly_product(a, b) if a and b else []
