"""Judges of the sentences about plants with parameters, at drawn and at exceptional values.

An algebraic value, a root of q, is put in by the companion matrix of q: the plant then stands for
those at all roots at once, and a rank is so many times larger.  A condition on several parameters
is met by drawing all of them but one.
"""

from __future__ import annotations

import itertools
import random
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

import sympy
from flint import fmpq, fmpq_mat, fmpq_poly

from tests.oracle.certificates.algebra import identity, krylov
from tests.oracle.certificates.systems import System
from tests.oracle.sentences.analysis import judge
from tests.oracle.sentences.cases import (
    Case,
    Facts,
    Said,
    index_ranks,
    irreducible,
    number,
    partition,
)

Point = Mapping[str, fmpq_mat]
"""For each parameter a square matrix, all of one size, which commute."""
SPECIAL = (
    (0, 1),
    (-1, 1),
    (1, 1),
    (2, 1),
    (-3, 2),
    (-2, 0, 1),
    (1, 0, 1),
    (1, 1, 1),
    (-2, 0, 0, 1),
)
"""Polynomials at whose roots plants of few digits are often exceptional."""


def companion(p: fmpq_poly) -> fmpq_mat:
    """A matrix whose minimal polynomial is p, monic."""
    d = p.degree()
    M = fmpq_mat(d, d)
    for i in range(d):
        if i:
            M[i, i - 1] = 1
        M[i, d - 1] = -p[i] / p[d]
    return M


@dataclass(frozen=True)
class Family:
    """A plant whose entries are expressions in parameters.

    Attributes
    ----------
    parameters : tuple of str
    ranges : tuple of (Fraction or None, Fraction or None)
    time, names
    tables : for A, all B_i and all C_i the rows of expressions, and the number of columns
    """

    parameters: tuple[str, ...]
    ranges: tuple[tuple[Any, Any], ...]
    time: str
    names: tuple[str, ...]
    tables: tuple[tuple[tuple[tuple[str, ...], ...], int], ...]

    @cached_property
    def fractions(self) -> list[tuple[list[list[tuple[Any, Any]]], int]]:
        """Each entry as a numerator and a denominator in sympy's polynomials."""
        return [([[self.split(e) for e in row] for row in rows], w) for rows, w in self.tables]

    def split(self, expression: str) -> tuple[Any, Any]:
        """A rational function as two polynomials."""
        letters = sympy.symbols(self.parameters)
        known = dict(zip(self.parameters, letters, strict=True))
        value = sympy.sympify(expression.replace("^", "**"), locals=known)
        over, under = sympy.fraction(sympy.cancel(sympy.together(value)))
        return tuple(sympy.Poly(p, *letters, domain="QQ") for p in (over, under))  # type: ignore[return-value]

    def value(self, p: Any, point: Point) -> fmpq_mat:
        """A polynomial at a point."""
        size = next(iter(point.values())).nrows()
        total = fmpq_mat(size, size)
        for powers, c in p.terms():
            term = identity(size) * fmpq(int(c.p), int(c.q))
            for name, k in zip(self.parameters, powers, strict=True):
                for _ in range(k):
                    term = term * point[name]
            total = total + term
        return total

    def at(self, point: Point) -> System:
        """The plant at a point; ZeroDivisionError where an entry has a pole."""
        size = next(iter(point.values())).nrows()
        made = []
        for rows, width in self.fractions:
            large = fmpq_mat(len(rows) * size, width * size)
            for (i, row), j in itertools.product(enumerate(rows), range(width)):
                over, under = (self.value(p, point) for p in row[j])
                block = over * under.inv()
                for a, b in itertools.product(range(size), repeat=2):
                    large[i * size + a, j * size + b] = block[a, b]
            made.append(large)
        m = len(self.names)
        return System(self.time, made[0], self.names, tuple(made[1 : m + 1]), tuple(made[m + 1 :]))

    def words(self) -> str:
        """The parameters with their ranges, as a sentence names them."""
        told = []
        for name, (low, high) in zip(self.parameters, self.ranges, strict=True):
            left = "(-inf" if low is None else f"[{low}"
            right = "inf)" if high is None else f"{high}]"
            told.append(name if (low, high) == (None, None) else f"{name} in {left}, {right}")
        return ", ".join(told)

    def inside(self, point: Point) -> bool:
        """Whether rational values are in their ranges; others are taken to be."""
        for name, (low, high) in zip(self.parameters, self.ranges, strict=True):
            M = point[name]
            if M.nrows() == 1:
                x = Fraction(int(M[0, 0].p), int(M[0, 0].q))
                if (low is not None and x < low) or (high is not None and x > high):
                    return False
            elif (low, high) != (None, None):
                return False
        return True


def family_of(plant: Any) -> Family:
    """The expressions of a plant of the package with parameters."""
    matrices = [plant.A, *(c.B for c in plant.channels), *(c.C for c in plant.channels)]
    tables = tuple(
        (tuple(tuple(map(str, row)) for row in M.rows), int(M.shape[1])) for M in matrices
    )
    return Family(plant.parameters, plant.ranges, plant.time, tuple(plant.names), tables)


# Points.


def scalar(x: Any) -> fmpq_mat:
    """A rational value."""
    return fmpq_mat(1, 1, [number(x)])


def drawn_value(rng: random.Random, low: Any, high: Any) -> Fraction:
    """A value in a range with a denominator that hardly anything is exceptional at."""
    part = Fraction(rng.randint(1, 9972), 9973)
    if low is None and high is None:
        return rng.randint(-9, 9) + part
    if high is None:
        return Fraction(low) + 9 * part
    return Fraction(high) - (9 if low is None else Fraction(high) - Fraction(low)) * part


def generic_points(family: Family, count: int = 3) -> Iterator[Point]:
    """Drawn values within the ranges."""
    rng = random.Random(5)
    for _ in range(count):
        pairs = zip(family.parameters, family.ranges, strict=True)
        yield {name: scalar(drawn_value(rng, *bounds)) for name, bounds in pairs}


def inner_points(family: Family) -> Iterator[Point]:
    """The corners of the ranges, and drawn values in them."""
    for corner in itertools.product(*family.ranges):
        yield {name: scalar(x) for name, x in zip(family.parameters, corner, strict=True)}
    yield from generic_points(family, 16)


def special_points(family: Family) -> Iterator[Point]:
    """Values of few digits, algebraic ones among them."""
    rng = random.Random(7)
    for coefficients in SPECIAL:
        p = fmpq_poly(list(coefficients))
        for name in family.parameters:
            d = p.degree()
            point = {name: companion(p / p[d])}
            for other, bounds in zip(family.parameters, family.ranges, strict=True):
                if other != name:
                    point[other] = identity(d) * number(drawn_value(rng, *bounds))
            if family.inside(point):
                yield point


def conditions(where: Sequence[str], family: Family) -> list[Any]:
    """Conditions such as "t = 1/2" and "t^2 - 2 = 0 (t about 1.41)" as polynomials that vanish."""
    found = []
    for text in where:
        left, right = re.sub(r"\(no real.*\)$|\(\w+ about.*\)$", "", text).split("=")
        found.append(family.split(f"({left}) - ({right})")[0])
    return found


def points_on(q: Any, family: Family) -> Iterator[Point]:
    """Points where a polynomial in the parameters vanishes, one for each parameter in it."""
    rng = random.Random(11)
    for name in family.parameters:
        others = [each for each in family.parameters if each != name]
        values = {
            each: drawn_value(rng, *family.ranges[family.parameters.index(each)]) for each in others
        }
        known = {
            sympy.Symbol(n): sympy.Rational(v.numerator, v.denominator) for n, v in values.items()
        }
        rest = sympy.Poly(q.as_expr().subs(known), sympy.Symbol(name), domain="QQ")
        if rest.degree() < 1:
            continue
        parts = irreducible(
            fmpq_poly([fmpq(int(c.p), int(c.q)) for c in reversed(rest.all_coeffs())])
        )
        for p, _ in parts[:2]:
            if p.degree() > 4:
                continue
            point = {name: companion(p)}
            point |= {each: identity(p.degree()) * number(v) for each, v in values.items()}
            yield point
        return


def plants(family: Family, points: Iterator[Point]) -> Iterator[tuple[Point, Facts]]:
    """The plants at points, without those where an entry has a pole."""
    for point in points:
        try:
            yield point, Facts(family.at(point))
        except ZeroDivisionError:
            continue


def vanishes(q: Any, point: Point, family: Family) -> bool:
    """Whether a condition holds at a point, at some of its conjugates at least."""
    return family.value(q, point).det() == 0


Holds = Callable[[Facts, Point], bool]


def as_told(
    said: Said, case: Case, where: Sequence[str], normal: Holds, exceptional: Holds | None = None
) -> bool:
    """Whether something holds at drawn values, and at conditions what is told of these instead.

    Where "every" value is spoken of without "almost", values of few digits that meet no condition
    are tried as well.
    """
    family = case.parametric
    known = conditions(where, family)
    every = str(said.values.get("every", ""))
    if not _names_values(every, family):
        return False
    tried = [generic_points(family)]
    if not every.startswith("almost") or where:
        tried.append(special_points(family))
    for point, facts in plants(family, itertools.chain(*tried)):
        if not any(vanishes(q, point, family) for q in known) and not normal(facts, point):
            return False
    for q in known:
        for point, facts in plants(family, points_on(q, family)):
            if exceptional is not None and not exceptional(facts, point):
                return False
    return True


def _names_values(every: str, family: Family) -> bool:
    """Whether the values that a sentence speaks of are of these parameters and ranges."""
    if not every:
        return True
    named = re.sub(r"^(almost )?(every value|all values) of ", "", every)
    named = named.partition(" with ")[0]  # the values where an entry has no pole
    return named in (family.words(), ", ".join(family.parameters))


def size_of(point: Point) -> int:
    """How many conjugates a point stands for."""
    return int(next(iter(point.values())).nrows())


# Modes.


def listed_modes(told: str, family: Family) -> list[tuple[str, str]]:
    """The polynomials in x of a sentence, each with what the roots of all are divided by."""
    listed, _, scale = told.removesuffix(",").partition(", divided by ")
    return [(each, scale or "1") for each in listed.split(", ")] if told else []


def modes_at(told: str, point: Point, family: Family) -> set[str]:
    """The irreducible factors of the polynomials of a sentence at a point."""
    factors: set[str] = set()
    d = size_of(point)
    for polynomial, scale in listed_modes(told, family):
        letters = sympy.symbols(("x", *family.parameters))
        known = dict(zip(("x", *family.parameters), letters, strict=True))
        p = sympy.Poly(sympy.sympify(polynomial.replace("^", "**"), locals=known), letters[0])
        k = p.degree()
        coefficients = [family.split(str(c)) for c in reversed(p.all_coeffs())]
        values = [family.value(a, point) * family.value(b, point).inv() for a, b in coefficients]
        over = values[-1].inv()
        large = fmpq_mat(k * d, k * d)
        for i in range(k):
            for a, b in itertools.product(range(d), repeat=2):
                if i and a == b:
                    large[i * d + a, (i - 1) * d + b] = 1
                large[i * d + a, (k - 1) * d + b] = -(over * values[i])[a, b]
        split = family.split(scale)
        delta = family.value(split[0], point) * family.value(split[1], point).inv()
        spread = fmpq_mat(k * d, k * d)
        for i in range(k):
            for a, b in itertools.product(range(d), repeat=2):
                spread[i * d + a, i * d + b] = delta[a, b]
        factors |= {str(q) for q, _ in irreducible((large * spread.inv()).charpoly())}
    return factors


Lost = Callable[[Facts, Case], Sequence[fmpq_poly]]


def _modes(stem: str, lost: Lost) -> None:
    def here(facts: Facts, case: Case) -> set[str]:
        return {str(p) for p in lost(facts, case)}

    def decides(said: Said, case: Case) -> bool:
        """Exactly the modes told are lost, and at the conditions others, too."""
        told = said.values.get("modes", "")
        if bool(told) != said.rule.endswith(("-some", "-more")):
            return False
        where = said.values.get("where", [])
        if bool(where) != said.rule.endswith(("-unless", "-more")):
            return False

        def normal(facts: Facts, point: Point) -> bool:
            return here(facts, case) == modes_at(told, point, case.parametric)

        def more(facts: Facts, point: Point) -> bool:
            return here(facts, case) > modes_at(told, point, case.parametric)

        return as_told(said, case, where, normal, more)

    judge(*(f"parametric-{stem}-{way}" for way in ("always", "unless", "some", "more")))(decides)


def _stays(facts: Facts, _: Case) -> list[fmpq_poly]:
    return [p for p, _ in irreducible(facts.fixed_polynomial)]


def _channel(case: Case) -> list[int]:
    return [case.parametric.names.index(case.asked["channel"])]


_modes("modes", _stays)
_modes("controllable", lambda facts, _: facts.uncontrolled())
_modes("observable", lambda facts, _: facts.unobserved())
_modes("channel-controllable", lambda facts, case: facts.uncontrolled(_channel(case)))
_modes("channel-observable", lambda facts, case: facts.unobserved(_channel(case)))


@judge("parametric-heading")
def _heading(said: Said, case: Case) -> bool:
    v, family = said.values, case.parametric
    sizes = (v["n"], v["m"], v["time"], tuple(v["names"]))
    right = (family.tables[0][1], len(family.names), family.time, family.names)
    return sizes == right and v["parameters"] == family.words()


@judge("parametric-nothing-fixed", "parametric-fixed")
def _fixed(said: Said, case: Case) -> bool:
    """The modes told are fixed, and no others, away from what another sentence names."""
    told = said.values.get("modes", "")
    if bool(told) != (said.rule == "parametric-fixed"):
        return False
    almost = said.values["every"].startswith("almost")
    where = [q for row in case.others("parametric-another") for q in row.values["where"]]

    def normal(facts: Facts, point: Point) -> bool:
        return {str(p) for p in _stays(facts, case)} == modes_at(told, point, case.parametric)

    return as_told(said, case, where if almost else [], normal)


@judge("parametric-another")
def _another(said: Said, case: Case) -> bool:
    """More modes are fixed than for almost all values; "another" if there are some anyway."""
    generic = case.others("parametric-fixed")
    told = generic[0].values["modes"] if generic else ""
    family = case.parametric

    def more(facts: Facts, point: Point) -> bool:
        return {str(p) for p in _stays(facts, case)} > modes_at(told, point, family)

    right = said.values["another"] == bool(told) and bool(said.values["where"])
    return right and as_told(said, case, said.values["where"], lambda *_: True, more)


# The transfer graph and completeness.


def _edges(facts: Facts) -> set[tuple[str, str]]:
    names = facts.system.names
    return {(names[j], names[i]) for j, i in facts.arcs}


@judge("parametric-graph-always")
def _graph(said: Said, case: Case) -> bool:
    told = {tuple(edge) for edge in said.values["edges"]}
    return as_told(said, case, [], lambda facts, _: _edges(facts) == told)


@judge("parametric-graph-lost")
def _graph_lost(said: Said, case: Case) -> bool:
    """Each edge is there where none of its conditions holds, and not where one does."""
    family = case.parametric
    told = {tuple(edge) for edge in said.values["edges"]}
    lost = {tuple(edge): conditions(where, family) for edge, where in said.values["lost"]}
    if not lost or not set(lost) <= told:
        return False
    every = [q for known in lost.values() for q in known]
    tried = [generic_points(family), special_points(family)]
    tried += [points_on(q, family) for q in every]
    for point, facts in plants(family, itertools.chain(*tried)):
        gone = {e for e, known in lost.items() if any(vanishes(q, point, family) for q in known)}
        if _edges(facts) != told - gone:
            return False
    return True


def _is_complete(facts: Facts, _: Point) -> bool:
    return len(facts.components) == 1 and facts.fixed_polynomial.degree() == 0


@judge("parametric-complete-always")
def _complete(said: Said, case: Case) -> bool:
    return as_told(said, case, [], _is_complete)


@judge("parametric-complete-unless")
def _complete_unless(said: Said, case: Case) -> bool:
    where = said.values["where"]
    return bool(where) and as_told(
        said, case, where, _is_complete, lambda facts, point: not _is_complete(facts, point)
    )


@judge("parametric-complete-never")
def _complete_never(said: Said, case: Case) -> bool:
    named = said.values["t"] in (case.parametric.words(), ", ".join(case.parametric.parameters))
    return named and as_told(said, case, [], lambda facts, at: not _is_complete(facts, at))


# Indices and set-points.


def _indices(stem: str, transposed: bool) -> None:
    def here(facts: Facts, point: Point) -> list[int]:
        system, d = facts.system, size_of(point)
        A, B = system.A, system.inputs()
        if transposed:
            A, B = A.transpose(), system.outputs().transpose()
        return [k for k in partition([rank // d for rank in index_ranks(A, B)]) if k]

    @judge(f"parametric-{stem}-indices-always")
    def _always(said: Said, case: Case) -> bool:
        told = said.values["indices"]
        return as_told(said, case, [], lambda facts, at: here(facts, at) == told)

    @judge(f"parametric-{stem}-indices-unless")
    def _unless(said: Said, case: Case) -> bool:
        told, where = said.values["indices"], said.values["where"]
        return bool(where) and as_told(
            said, case, where,
            lambda facts, at: here(facts, at) == told,
            lambda facts, at: here(facts, at) != told,
        )  # fmt: skip


_indices("controllability", False)
_indices("observability", True)


def _solvable(facts: Facts, _: Point) -> bool:
    return facts.steady_rank() == facts.n + int(facts.system.outputs().nrows())


@judge("parametric-setpoint-always")
def _setpoint(said: Said, case: Case) -> bool:
    return as_told(said, case, [], _solvable)


@judge("parametric-setpoint-unless")
def _setpoint_unless(said: Said, case: Case) -> bool:
    where = said.values["where"]
    return bool(where) and as_told(
        said, case, where, _solvable, lambda facts, at: not _solvable(facts, at)
    )


@judge("parametric-setpoint-never")
def _setpoint_never(said: Said, case: Case) -> bool:
    return as_told(said, case, [], lambda facts, at: not _solvable(facts, at))


# Almost all values of several parameters.


def _almost(stem: str, holds: Holds) -> None:
    @judge(f"parametric-almost-{stem}")
    def _decides(said: Said, case: Case) -> bool:
        family = case.parametric
        named = said.values["parameters"] in (family.words(), ", ".join(family.parameters))
        points = plants(family, generic_points(family))
        return named and all(holds(facts, point) for point, facts in points)


_almost("nothing-fixed", lambda facts, _: facts.fixed_polynomial.degree() == 0)
_almost("controllable", lambda facts, _: not facts.uncontrolled())
_almost("observable", lambda facts, _: not facts.unobserved())
_almost("complete", _is_complete)
_almost("setpoint", _solvable)


@judge("parametric-almost-channel-controllable", "parametric-almost-channel-observable")
def _almost_channel(said: Said, case: Case) -> bool:
    """The channel that was asked about controls, or observes, everything at drawn values."""
    family, chosen = case.parametric, _channel(case)
    named = said.values["parameters"] in (family.words(), ", ".join(family.parameters))
    seen = said.rule.endswith("observable")
    found = plants(family, generic_points(family))
    return named and not any(
        facts.unobserved(chosen) if seen else facts.uncontrolled(chosen) for _, facts in found
    )


@judge("parametric-almost-graph")
def _almost_graph(said: Said, case: Case) -> bool:
    family = case.parametric
    told = {tuple(edge) for edge in said.values["edges"]}
    named = said.values["parameters"] in (family.words(), ", ".join(family.parameters))
    return named and all(
        _edges(facts) == told for _, facts in plants(family, generic_points(family))
    )


# One line of several parameters.


def _line(said: Said, case: Case) -> Family:
    """The plant along the line that a sentence names, in the parameter of the line."""
    family = case.parametric
    told = dict(part.split(" = ") for part in said.values["line"].split(", "))
    if tuple(told) != family.parameters:
        raise ValueError(f"a line of {tuple(told)}, not of {family.parameters}")
    (name,) = {found for right in told.values() for found in re.findall("[A-Za-z_]\\w*", right)}
    letters = {each: sympy.Symbol(each) for each in (*family.parameters, name)}
    ways = {letters[each]: sympy.sympify(right, locals=letters) for each, right in told.items()}

    def along(expression: str) -> str:
        value = sympy.sympify(expression.replace("^", "**"), locals=letters)
        return str(sympy.cancel(value.subs(ways, simultaneous=True)))

    tables = tuple(
        (tuple(tuple(map(along, row)) for row in rows), width) for rows, width in family.tables
    )
    return replace(family, parameters=(name,), ranges=((None, None),), tables=tables)


def _denominator(family: Family) -> str:
    """The least common denominator of the entries of A, monic."""
    letters = sympy.symbols(family.parameters)
    below = [under for row in family.fractions[0][0] for _, under in row]
    found = sympy.Poly(1, *letters, domain="QQ")
    for each in below:
        found = sympy.lcm(found, each)
    return str(found.monic().as_expr())


def _modes_on_line(stem: str, lost: Lost) -> None:
    @judge(f"parametric-line-{stem}")
    def _decides(said: Said, case: Case) -> bool:
        """Exactly the modes told are lost along the line, and at the conditions others, too."""
        family = _line(said, case)
        always, _, where = re.sub("; others, too,|, but", ";", said.values["found"]).partition(
            "; where "
        )
        told = "" if always == "none" else always.removeprefix("the roots of ")
        told = told.replace("the denominator of A", _denominator(family))

        def here(facts: Facts) -> set[str]:
            return {str(p) for p in lost(facts, case)}

        return as_told(
            replace(said, values={}),
            replace(case, parametric=family),
            where.split(" or ") if where else [],
            lambda facts, point: here(facts) == modes_at(told, point, family),
            lambda facts, point: here(facts) > modes_at(told, point, family),
        )


_modes_on_line("modes", _stays)
_modes_on_line("controllable", lambda facts, _: facts.uncontrolled())
_modes_on_line("observable", lambda facts, _: facts.unobserved())
_modes_on_line("channel-controllable", lambda facts, case: facts.uncontrolled(_channel(case)))
_modes_on_line("channel-observable", lambda facts, case: facts.unobserved(_channel(case)))


def _rank_on_line(stem: str, rank: Callable[[Facts, Point, str], int]) -> None:
    @judge(f"parametric-line-{stem}")
    def _decides(said: Said, case: Case) -> bool:
        """The rank told is that along the line, and at the conditions it is less."""
        family = _line(said, case)
        told, _, where = said.values["found"].partition(", less where ")
        named, _, size = told.rpartition("rank ")
        return as_told(
            replace(said, values={}),
            replace(case, parametric=family),
            where.split(" or ") if where else [],
            lambda facts, point: rank(facts, point, named) == int(size),
            lambda facts, point: rank(facts, point, named) < int(size),
        )


def _krylov_rank(transposed: bool) -> Callable[[Facts, Point, str], int]:
    def rank(facts: Facts, point: Point, named: str) -> int:
        """The rank of so many blocks."""
        A, B = facts.system.A, facts.system.inputs()
        if transposed:
            A, B = A.transpose(), facts.system.outputs().transpose()
        return int(krylov(A, B, int(named.split(" ")[0])).rank()) // size_of(point)

    return rank


def _edge_rank(facts: Facts, _: Point, named: str) -> int:
    """Whether there is an edge: its matrix is a column."""
    left, right = named.removesuffix(": ").split(" -> ")
    return int((left, right) in _edges(facts))


_rank_on_line("controllability-indices", _krylov_rank(False))
_rank_on_line("observability-indices", _krylov_rank(True))
_rank_on_line("graph", _edge_rank)
_rank_on_line("setpoint", lambda facts, point, _: facts.steady_rank() // size_of(point))
