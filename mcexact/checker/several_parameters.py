"""Entries with several parameters: quotients of polynomials in lowest terms."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from .budget import fractions, limbs_of, spend
from .common_factors import Terms, common_factor, divided
from .expressions import Reader
from .reading import Json, Limits

Quotient = tuple[Terms, Terms]
"""Numerator and denominator in lowest terms, the leading coefficient of the latter being 1."""


def quotient(
    value: Json, place: str, parameters: tuple[str, ...], limits: Limits | None
) -> Quotient:
    """An entry: a number, or an expression."""
    return _SeveralParameters(value, place, parameters, limits).whole()


def quotient_text(value: Quotient, parameters: tuple[str, ...]) -> Json:
    """The canonical form of an entry: a rational, or a text."""
    top, bottom = value
    if not top:
        return 0
    constant = (0,) * len(parameters)
    if {*top, *bottom} == {constant}:
        found = top[constant]
        return found.numerator if found.denominator == 1 else str(found)
    text = terms_text(top, parameters)
    return text if {*bottom} == {constant} else f"({text})/({terms_text(bottom, parameters)})"


def terms_text(p: Terms, parameters: tuple[str, ...]) -> str:
    """A polynomial, its terms in decreasing lexicographic order of the exponents."""
    spend(fractions(len(p) * _keys(parameters), limbs_of(list(p.values()))))
    words = []
    for exponents, c in sorted(p.items(), reverse=True):
        powers = zip(parameters, exponents, strict=True)
        factors = [name if e == 1 else f"{name}^{e}" for name, e in powers if e]
        size = [str(abs(c))] if abs(c) != 1 or not factors else []
        words += ["-" if c < 0 else "+", "*".join(size + factors)]
    sign = "-" if words[0] == "-" else ""
    return sign + " ".join(words[1:])


def _keys(parameters: Sequence[str]) -> int:
    """How many times as long as with few parameters it takes to make a key, its exponents."""
    return len(parameters) // 8 + 1


class _SeveralParameters(Reader[Terms]):
    """Polynomials by their terms."""

    def number(self, c: Fraction) -> Terms:
        return {(0,) * len(self.parameters): c} if c else {}

    def parameter(self, name: str) -> Terms:
        return {tuple(int(name == other) for other in self.parameters): Fraction(1)}

    def degree(self, p: Terms) -> int:
        spend(10 * len(p) * len(self.parameters))
        return max(map(sum, p), default=0)

    def times(self, a: Terms, b: Terms) -> Terms:
        turns = (len(a) * len(b) + 2) * _keys(self.parameters)
        longest = limbs_of(list(a.values())) + limbs_of(list(b.values()))
        spend(fractions(turns, 2 * longest))
        result: Terms = {}
        for exponents, c in a.items():
            for more, d in b.items():
                key = tuple(map(sum, zip(exponents, more, strict=True)))
                result[key] = result.get(key, Fraction(0)) + c * d
        return {key: c for key, c in result.items() if c}

    def plus(self, a: Terms, b: Terms, sign: str) -> Terms:
        turns = (len(a) + len(b)) * _keys(self.parameters)
        spend(fractions(turns, limbs_of([*a.values(), *b.values()])))
        one = -1 if sign == "-" else 1
        found = {key: a.get(key, Fraction(0)) + one * b.get(key, 0) for key in {**a, **b}}
        return {key: c for key, c in found.items() if c}

    def lowest(self, top: Terms, bottom: Terms) -> Quotient:
        """A denominator of one term has common factors that are parameters; others are searched."""
        if len(bottom) > 1:
            shared = common_factor(top, bottom, self)
            top, bottom = (divided(p, shared, self) for p in (top, bottom))
            lead = {(0,) * len(self.parameters): bottom[max(bottom)]}
            return divided(top, lead, self), divided(bottom, lead, self)
        [(below, d)] = bottom.items()
        turns = (3 * len(top) + 3) * _keys(self.parameters)
        spend(fractions(turns, limbs_of([*top.values(), d])))
        common = [min(each) for each in zip(below, *top, strict=True)] if top else below

        def without(exponents: tuple[int, ...]) -> tuple[int, ...]:
            return tuple(e - g for e, g in zip(exponents, common, strict=True))

        return {without(e): c / d for e, c in top.items()}, {without(below): Fraction(1)}
