"""Plants with parameters, and the grammar of their entries.

An entry is a quotient of polynomials with rational coefficients.  It is brought to lowest terms,
so that equal plants have one canonical text and one digest.  With one parameter a polynomial is
the list of its coefficients, and Euclid's algorithm finds common factors.  With several it is a
mapping from exponents to coefficients, and `common_factor` takes remainders in one parameter after
another.  Such remainders grow very long if nothing is common.  So each parameter is first tried
modulo a prime, at values of the other ones: if the leading coefficient of one polynomial stays and
the results are coprime, no common factor contains this parameter, and the common factor is that of
all coefficients.

`FunctionSystem` is a plant as it is read, with any number of parameters.  `ParametricSystem` has
one parameter, and matrices of polynomials over common denominators, as the kinds for all values of
a parameter need them.  `plant_of` reads the canonical plant of a certificate, and `plant_of_file`
that of a system file.
"""

from __future__ import annotations

import math
import random
import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import zip_longest
from typing import Any, Generic, Protocol, TypeVar

from .core import budget, reading, system
from .core.arithmetic import Matrix, Polynomial, coprime, poly_divide, poly_product, stripped
from .core.budget import fractions, limbs_of, reductions, spend
from .core.reading import (
    Json,
    Limits,
    fields,
    incomplete,
    integer,
    items,
    malformed,
    printable,
    shown,
    string,
)
from .core.system import (
    System,
    as_typed,
    canonical,
    canonical_json,
    digest_of,
    number,
    parse_file,
    polynomial_text,
    read_plant,
    read_system,
)

# Common factors of polynomials in several parameters.

Terms = dict[tuple[int, ...], Fraction]
"""A polynomial: its coefficients, none of which is 0, by the exponents of the parameters."""
PRIME = 2**61 - 1
SEED = 61


class Arithmetic(Protocol):
    """Products and sums that are charged to the budget."""

    def times(self, a: Terms, b: Terms) -> Terms:
        """The product."""
        ...

    def plus(self, a: Terms, b: Terms, sign: str) -> Terms:
        """The sum, or the difference."""
        ...


def common_factor(a: Terms, b: Terms, by: Arithmetic) -> Terms:
    """The greatest common divisor of a and b ≠ 0, whose leading coefficient is 1.

    Open: see ``proofs/OPEN.md``.
    """
    if not a or is_constant(a) or is_constant(b):
        return monic(b) if not a else one_of(b)
    width, least = len(next(iter(b))), 0
    chosen = -1
    for v in range(width):
        sides = degree(a, v), degree(b, v)
        if max(sides) == 0:
            continue
        if min(sides) == 0 or _apart(a, b, v):
            return _of_all([*coefficients(a, v).values(), *coefficients(b, v).values()], by)
        if chosen < 0 or min(sides) < least:
            chosen, least = v, min(sides)
    (first, p), (second, q) = (_primitive(each, chosen, by) for each in (a, b))
    common = common_factor(first, second, by)
    while q:
        if degree(q, chosen) == 0:
            p = one_of(p)
            break
        rest = _remainder(p, q, chosen, by)
        p, q = q, _primitive(rest, chosen, by)[1] if rest else rest
    return monic(by.times(common, p))


def divided(a: Terms, b: Terms, by: Arithmetic) -> Terms:
    """The quotient of a by b ≠ 0, which divides it."""
    if is_constant(b):
        [c] = b.values()
        spend(fractions(len(a), limbs_of([*a.values(), c])))
        return {e: d / c for e, d in a.items()}
    lead, rest, quotient = max(b), a, Terms()
    while rest:
        top = max(rest)
        key = tuple(e - f for e, f in zip(top, lead, strict=True))
        term = {key: rest[top] / b[lead]}
        quotient |= term
        rest = by.plus(rest, by.times(term, b), "-")
    return quotient


def is_constant(p: Terms) -> bool:
    """Whether no parameter occurs."""
    return not any(map(any, p))


def one_of(p: Terms) -> Terms:
    """The constant 1, in as many parameters."""
    return {(0,) * len(next(iter(p))): Fraction(1)}


def monic(p: Terms) -> Terms:
    """The polynomial divided by its leading coefficient."""
    spend(fractions(len(p), 2 * limbs_of(p.values())))
    c = p[max(p)]
    return {e: d / c for e, d in p.items()}


def degree(p: Terms, v: int) -> int:
    """The degree in the parameter of position v, 0 of 0."""
    spend(10 * len(p))
    return max((e[v] for e in p), default=0)


def coefficients(p: Terms, v: int) -> dict[int, Terms]:
    """The coefficients of the powers of a parameter, which are polynomials in the others."""
    spend(fractions(len(p), 1))
    by_power: dict[int, Terms] = {}
    for e, c in p.items():
        by_power.setdefault(e[v], {})[(*e[:v], 0, *e[v + 1 :])] = c
    return by_power


def _of_all(polynomials: Iterable[Terms], by: Arithmetic) -> Terms:
    """The greatest common divisor of some polynomials, the shortest first."""
    first, *others = sorted(polynomials, key=lambda p: (len(p), sorted(p)))
    divisor = monic(first)
    for p in others:
        if is_constant(divisor):
            break
        divisor = common_factor(p, divisor, by)
    return divisor


def _primitive(p: Terms, v: int, by: Arithmetic) -> tuple[Terms, Terms]:
    """The greatest common divisor of the coefficients of a parameter, and p divided by it."""
    inside = _of_all(coefficients(p, v).values(), by)
    return inside, divided(p, inside, by)


def _remainder(p: Terms, q: Terms, v: int, by: Arithmetic) -> Terms:
    """The remainder of p, times a power of the leading coefficient of q, by q."""
    known = coefficients(q, v)
    size = max(known)
    while p and degree(p, v) >= size:
        own = coefficients(p, v)
        top = max(own)
        power = {tuple((top - size) * (i == v) for i in range(len(next(iter(p))))): Fraction(1)}
        turned = by.times(by.times(own[top], power), q)
        p = by.plus(by.times(known[size], p), turned, "-")
    return p


def _apart(a: Terms, b: Terms, v: int) -> bool:
    """Whether values of the other parameters modulo a prime prove that no common factor has v."""
    rng = random.Random(SEED)
    values = [rng.randrange(1, PRIME) for _ in next(iter(b))]
    first, second = (_at(p, v, values) for p in (a, b))
    kept = len(first) > degree(a, v) or len(second) > degree(b, v)
    return kept and coprime(first, second, PRIME)


def _at(p: Terms, v: int, values: list[int]) -> Polynomial:
    """A multiple of p at values of all parameters but one, modulo the prime."""
    spend(fractions(len(p), limbs_of(p.values())) + reductions(40 * len(p) * len(values), 3))
    d = math.lcm(*(c.denominator for c in p.values()))
    polynomial = [0] * (degree(p, v) + 1)
    for exponents, c in p.items():
        term = int(c * d) % PRIME
        for i, (value, e) in enumerate(zip(values, exponents, strict=True)):
            if e and i != v:
                term = term * pow(value, e, PRIME) % PRIME
        polynomial[exponents[v]] = (polynomial[exponents[v]] + term) % PRIME
    return stripped(polynomial)


# Entries with a parameter, such as "1/2 + 3*t^2", by the grammar of ``FORMAT.md``.

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
        constant = sum(top, Fraction(0))
        return constant.numerator if constant.denominator == 1 else str(constant)
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
        if type(text) is not str or system.NUMBER.fullmatch(text):
            number = Fraction(system.number(text, place, self.limits))
            return self.number(number), self.number(Fraction(1))
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
        number = Fraction(system.number(token, self.place, self.limits))
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
    """Polynomials in one parameter, by their coefficients, constant first."""

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


# Entries with several parameters: quotients of polynomials in lowest terms.

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
        number = top[constant]
        return number.numerator if number.denominator == 1 else str(number)
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
    """Polynomials in several parameters, by their terms."""

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
        total = {key: a.get(key, Fraction(0)) + one * b.get(key, 0) for key in {**a, **b}}
        return {key: c for key, c in total.items() if c}

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


# Plants whose entries are rational functions of a parameter, and plants of either sort.

Layers = list[Matrix]
"""The coefficients of a matrix of polynomials in the parameter, constant term first."""
Range = tuple[Fraction | None, Fraction | None]
"""The least and the largest value of t; None where there is none."""
Table = tuple[list[list[Any]], int]
"""Rows of functions, of one parameter or of several, and the number of columns."""
Entries = Callable[[Json, str, Limits | None], Any]
"""How an entry is read, at a place."""
ONE = [Fraction(1)]
HASHES = 150
"""What a rational costs as a part of a key."""


@dataclass(frozen=True, kw_only=True)
class FunctionSystem:
    """A plant of rational functions of parameters.

    ``ranges`` has the least and the largest value of each parameter, None where there is none.
    ``tables`` are A, B_1, C_1, B_2, … as functions, each a numerator and a denominator, and
    ``document`` is the canonical object of the plant; ``ports`` is as in `System`.
    """

    time: str
    names: list[str]
    ranges: dict[str, Range]
    tables: list[Table]
    document: Json
    neighbors: list[list[int]] | None = None
    words: str = "the plant"
    controller: str = ""
    ports: str = ""

    @property
    def n(self) -> int:
        """The number of states."""
        return len(self.tables[0][0])

    @property
    def m(self) -> int:
        """The number of channels."""
        return len(self.names)

    def number(self, value: int) -> Any:
        """A number as a function."""
        return quotient(value, "", tuple(self.ranges), None)

    def terms(self, entry: Any) -> Quotient:
        """Numerator and denominator by the exponents of the parameters."""
        quotient_of_terms: Quotient = entry
        return quotient_of_terms

    def remade(self, tables: list[Table], **parts: Any) -> FunctionSystem:
        """The same with other functions."""
        return replace(self, tables=tables, **parts)


@dataclass(frozen=True, kw_only=True)
class ParametricSystem(FunctionSystem):
    """x' = A/δ x + Σ B_i/β_i u_i, y_i = C_i/γ_i x with polynomials in t in A, B_i and C_i.

    ``scale`` is δ, monic, and ``poles`` are the monic denominators of the plant: what is made of it
    is about the same values of t, even without the entries that have these denominators.
    """

    parameter: str
    range: Range
    A: Layers
    B: list[Layers]
    C: list[Layers]
    scale: Polynomial
    poles: list[Polynomial]

    def number(self, value: int) -> Any:
        """A number as a function."""
        return function(value, "", self.parameter, None)

    def terms(self, entry: Any) -> Quotient:
        """Numerator and denominator by the exponents of the parameter."""

        def of(p: Polynomial) -> Terms:
            return {(k,): c for k, c in enumerate(p) if c}

        return of(entry[0]), of(entry[1])

    def remade(self, tables: list[Table], **parts: Any) -> FunctionSystem:
        """The same with other functions."""
        return replace(self, **cleared_tables(tables) | {"poles": self.poles}, **parts)

    def others(self, channels: list[int]) -> list[int]:
        """The channels that are not among these."""
        return [i for i in range(self.m) if i not in channels]


def plant_of(value: Json) -> System | FunctionSystem:
    """The plant of a certificate, which must be canonical."""
    if not has_parameters(value):
        return read_plant(value)
    plant = read_parametric(value)
    if plant.document != value:
        malformed("system", "expected the canonical form: lowest terms, expanded")
    return plant


def plant_of_file(data: bytes, limits: Limits) -> Json:
    """The canonical object of the plant in a system file, numbers as typed."""
    with budget.limited(budget.current(limits.work), len(data)):
        document = parse_file(data, limits)
        if not isinstance(document, dict) or document.get("format") != "mcexact-system/1":
            malformed("format", 'expected a system file, "format": "mcexact-system/1"')
        if has_parameters(document):
            return read_parametric(document, limits).document
        return canonical(read_system(document, limits, as_typed(data, document, limits)))


def has_parameters(value: Json) -> bool:
    """Whether a plant depends on parameters."""
    return isinstance(value, dict) and "parameters" in value


def digest(plant: System | FunctionSystem) -> str:
    """The SHA-256 of the canonical object of a plant."""
    known = plant.document if isinstance(plant, FunctionSystem) else canonical(plant)
    return digest_of(canonical_json(known))


def digest_of_values(plant: System | FunctionSystem, known: str) -> str:
    """The digest of a plant without its radii; ``known`` is the one with them."""
    if isinstance(plant, FunctionSystem) or plant.uncertainty is None:
        return known
    return digest(replace(plant, uncertainty=None))


def read_parametric(value: Json, limits: Limits | None = None) -> FunctionSystem:
    """A plant with parameters by the grammar of system files; without limits, of a certificate."""
    extra = () if limits is None else ("format", "name", "source")
    keys = ("time", "parameters", "A", "channels")
    time, known, entries, listed, *texts = fields(value, "system", *keys, optional=extra)
    for key, text in zip(extra[1:], texts[1:], strict=True):
        printable("" if text is None else text, key, 10_000, allowed="\n\t")
    if not isinstance(known, dict) or not known:
        malformed("parameters", "expected an object keyed by parameters")
    for name in known:
        if not PARAMETER.fullmatch(name) or name == "x":
            malformed(
                "parameters", f"expected the name of a parameter, found {reading.shown(name)}"
            )
    ranges = {name: _range(known[name], f"parameters.{name}", limits) for name in sorted(known)}
    read, write = _entries(tuple(ranges))
    tables = [_table(entries, "A", read, limits, None, 0)]
    n, names = len(tables[0][0]), []
    for k, channel in enumerate(budget.counted(items(listed, "channels"))):
        where = f"channels[{k}]"
        B, C, name = fields(channel, where, "B", "C", optional=("name",))
        tables.append(_table(B, f"{where}.B", read, limits, n, 0))
        tables.append(_table(C, f"{where}.C", read, limits, None, n))
        names.append(str(k + 1) if name is None else name)
    if tables[0][1] != n or not names or any(width != n for _, width in tables[2::2]):
        malformed("system", "expected a square A, at least one channel, and matching shapes")
    own = reading.own_names(names, [f"channels[{k}].name" for k in range(len(names))])
    forms = [_form(table, write) for table in tables]
    channels = [
        {"name": name, "B": B, "C": C}
        for name, B, C in zip(own, forms[1::2], forms[2::2], strict=True)
    ]
    domains = {
        name: {} if bounds == (None, None) else {"range": [_end(bound) for bound in bounds]}
        for name, bounds in ranges.items()
    }
    document = {"time": string(time, "time", "continuous", "discrete"), "parameters": domains}
    document |= {"A": forms[0], "channels": channels}
    parts = {"time": time, "names": own, "ranges": ranges, "document": document}
    if len(ranges) > 1:
        return FunctionSystem(tables=tables, **parts)
    [(t, bounds)] = ranges.items()
    return ParametricSystem(parameter=t, range=bounds, **cleared_tables(tables), **parts)


def one_parameter(plant: FunctionSystem) -> ParametricSystem:
    """The plant, of which a claim is known for one parameter alone."""
    if not isinstance(plant, ParametricSystem):
        incomplete("parameters", "parameters", "more than one parameter")
    return plant


def _entries(parameters: tuple[str, ...]) -> tuple[Entries, Callable[[Any], Json]]:
    """How entries with these parameters are read, and written."""
    if len(parameters) > 1:
        return (
            lambda value, place, limits: quotient(value, place, parameters, limits),
            lambda entry: quotient_text(entry, parameters),
        )
    [t] = parameters
    return (
        lambda value, place, limits: function(value, place, t, limits),
        lambda entry: function_text(entry, t),
    )


def _range(value: Json, place: str, limits: Limits | None) -> Range:
    (ends,) = fields(value, place, optional=("range",))
    if ends is None:
        return None, None
    place += ".range"
    low, high = (
        None if end is None else Fraction(number(end, place, limits))
        for end in items(ends, place, 2)
    )
    if low is not None and high is not None and low > high:
        malformed(place, "expected an interval")
    return low, high


def _end(bound: Fraction | None) -> Json:
    return None if bound is None else function_text(([bound] if bound else [], ONE), "")


def _table(
    value: Json, place: str, read: Entries, limits: Limits | None, nrows: int | None, ncols: int
) -> Table:
    """A matrix of functions: a list of rows, or an object that lists its nonzero entries."""
    if isinstance(value, dict):
        shape, entries = fields(value, place, "shape", "entries")
        r, c = (integer(side, f"{place}.shape") for side in items(shape, f"{place}.shape", 2))
        budget.spend(budget.table(r, c, 1))
        rows = [[read(0, place, limits)] * c for _ in range(r)]
        seen = set()
        for i, j, entry in (items(triple, place, 3) for triple in items(entries, place)):
            if integer(i, place) >= r or integer(j, place) >= c or (i, j) in seen:
                malformed(place, f"expected a position of its own inside {r} by {c}")
            seen.add((i, j))
            rows[i][j] = read(entry, place, limits)
    else:
        listed = [items(row, place) for row in items(value, place)]
        c = len(listed[0]) if listed else ncols
        rows = [[read(entry, place, limits) for entry in items(row, place, c)] for row in listed]
    if nrows not in (None, len(rows)):
        malformed(place, f"expected {nrows} rows, found {len(rows)}")
    return rows, c


def _form(table: Table, write: Callable[[Any], Json]) -> Json:
    """The canonical form of a matrix."""
    rows, ncols = table
    if not rows and ncols:
        return {"shape": [0, ncols], "entries": []}
    return [[write(entry) for entry in row] for row in rows]


def cleared_tables(tables: list[Table]) -> dict[str, Any]:
    """The parts of a plant that these matrices determine."""
    (A, *ports), denominators = zip(*map(_cleared, tables), strict=True)
    matrices = {"A": A, "B": ports[0::2], "C": ports[1::2], "scale": denominators[0]}
    return {"tables": tables, **matrices, "poles": [*denominators]}


def least_denominator(denominators: list[Polynomial]) -> Polynomial:
    """The least common multiple of polynomials, monic; 1 of none."""
    delta: Polynomial = ONE
    for bottom in denominators:
        rest = poly_divide(bottom, common_divisor(delta, bottom))[0]
        delta = poly_product(delta, [c / rest[-1] for c in rest])
    return delta


def _cleared(table: Table) -> tuple[Layers, Polynomial]:
    """The layers of M, and δ, with M/δ the matrix and δ the least common denominator."""
    rows, ncols = table
    # a hash of a rational takes the inverse of its denominator modulo a prime
    budget.spend(sum(HASHES * (1 + len(bottom)) for row in rows for _, bottom in row))
    different = dict.fromkeys(tuple(bottom) for row in rows for _, bottom in row)
    delta = least_denominator([*map(list, different)])
    factors = {bottom: poly_divide(delta, [*bottom])[0] for bottom in different}
    above = [
        [poly_product(top, factors[tuple(bottom)]) if top else [] for top, bottom in row]
        for row in rows
    ]
    values = [c for row in above for entry in row for c in entry]
    longest = budget.limbs_of(values)
    d = _least_multiple(values)
    length = max((len(entry) for row in above for entry in row), default=1)
    layers = []
    for k in range(max(length, 1)):
        budget.build(len(rows), ncols, longest, budget.limbs([d]))
        layer = [
            [e[k].numerator * (d // e[k].denominator) if k < len(e) else 0 for e in row]
            for row in above
        ]
        layers.append(Matrix(layer, ncols, d))
    return layers, delta


def _least_multiple(values: list[Fraction]) -> int:
    """The least common denominator."""
    different = {c.denominator for c in values}
    budget.spend(budget.fractions(len(different), sum(budget.limbs([d]) for d in different)))
    return math.lcm(*different)
