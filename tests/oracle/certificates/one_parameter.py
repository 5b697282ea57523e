"""Plants whose entries are rational functions of one parameter, and what moves their modes."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any

from flint import Ordering, acb, fmpq, fmpq_mpoly_ctx, fmpq_poly

from . import algebra
from .reading import demand, rational, record, text
from .roots import Sign, decided, roots_of
from .several_parameters import NAME, SeveralParameters, in_one, read_several

RING = fmpq_mpoly_ctx.get(("t", "x"), Ordering.lex)
SEED = 20
SIZES = (0, 10**4, 10**5, 10**6)
"""How large gains are drawn; the first ones are 0."""
Function = tuple[fmpq_poly, fmpq_poly]
Rows = list[list[Function]]


@dataclass(frozen=True)
class ParametricPlant:
    """A plant of rational functions of a parameter, each a numerator and a denominator.

    What is made of a plant keeps its poles, the denominators of all entries.
    """

    time: str
    names: tuple[str, ...]
    parameter: str
    range: tuple[Any, Any]
    tables: tuple[tuple[Rows, int, int], ...]
    poles: tuple[fmpq_poly, ...] = ()

    @property
    def n(self) -> int:
        """The number of states."""
        return self.tables[0][1]

    @property
    def m(self) -> int:
        """The number of channels."""
        return len(self.names)

    @property
    def denominators(self) -> list[fmpq_poly]:
        """The least common denominators of A, B_1, C_1, …"""
        return [common_denominator(rows) for rows, _, _ in self.tables]


def read_parametric(value: Any) -> ParametricPlant:
    """The user's plant, in canonical form."""
    plant = read_several(value)
    demand(len(plant.ranges) == 1, "expected one parameter")
    return line_through(plant)


def line_through(
    plant: SeveralParameters, k: int = 0, others: tuple[fmpq, ...] = ()
) -> ParametricPlant:
    """The plant with the parameter of position k alone, where the others have these values."""

    def function(entry: Any) -> Function:
        top, bottom = (in_one(p, k, others) for p in entry)
        demand(bottom != 0, "expected an entry that is defined")
        return in_lowest_terms(top, bottom)

    tables = tuple(
        ([[function(entry) for entry in row] for row in rows], nrows, ncols)
        for rows, nrows, ncols in plant.tables
    )
    parameter, ends = list(plant.ranges.items())[k]
    poles = tuple(common_denominator(rows) for rows, _, _ in tables)
    return ParametricPlant(plant.time, plant.names, parameter, ends, tables, poles)


def along(plant: SeveralParameters, step: Any) -> ParametricPlant:
    """The plant where each parameter is the value point + direction·s, for every s."""
    given = record(step, "construction", "parameter", "point", "direction")
    s = text(given["parameter"])
    demand(bool(NAME.fullmatch(s)) and s != "x" and s not in plant.ranges, "expected another name")
    ends = [record(given[key], *plant.ranges) for key in ("point", "direction")]
    points, slopes = ([rational(each[name]) for name in plant.ranges] for each in ends)
    demand(any(slope != 0 for slope in slopes), "expected a direction")
    values = [fmpq_poly([*pair]) for pair in zip(points, slopes, strict=True)]

    def at(p: Any) -> fmpq_poly:
        total = fmpq_poly([])
        for exponents, c in p.items():
            term = fmpq_poly([c])
            for value, e in zip(values, exponents, strict=True):
                term *= value**e
            total += term
        return total

    tables, poles = [], []
    for rows, nrows, ncols in plant.tables:
        found = [[(at(top), at(bottom)) for top, bottom in row] for row in rows]
        demand(all(bottom != 0 for row in found for _, bottom in row), "expected a defined entry")
        poles.append(common_denominator(found))
        tables.append(([[in_lowest_terms(*entry) for entry in row] for row in found], nrows, ncols))
    return ParametricPlant(plant.time, plant.names, s, (None, None), tuple(tables), tuple(poles))


def in_lowest_terms(top: fmpq_poly, bottom: fmpq_poly) -> Function:
    """A quotient in lowest terms with a monic denominator."""
    common = top.gcd(bottom)
    lead = (bottom // common).leading_coefficient()
    return top // common / lead, bottom // common / lead


def common_denominator(rows: Rows) -> fmpq_poly:
    """The least one, monic."""
    result = fmpq_poly([1])
    for row in rows:
        for _, bottom in row:
            result = result * (bottom // result.gcd(bottom))
    return algebra.monic(result)


def drawn_gains(plant: ParametricPlant, rng: random.Random, bound: int) -> list[list[list[int]]]:
    """Matrices F_i with entries from −bound to bound."""
    return [
        [
            [rng.randint(-bound, bound) for _ in range(plant.tables[2 * i + 2][1])]
            for _ in range(plant.tables[2 * i + 1][2])
        ]
        for i in range(plant.m)
    ]


def characteristic(plant: ParametricPlant, gains: list[list[list[int]]]) -> Any:
    """det(xI − A_F) of the matrices times their denominators, without division (Berkowitz)."""
    tables = [expanded(table) for table in plant.tables]
    M, n = [list(row) for row in tables[0]], plant.n
    for B, F, C in zip(tables[1::2], gains, tables[2::2], strict=True):
        for i in range(n):
            for a, f_row in enumerate(F):
                for b, f in enumerate(f_row):
                    for j in range(n):
                        M[i][j] = M[i][j] + B[i][a] * C[b][j] * f
    vector = [RING.constant(1)]
    for r in range(n):
        column, v = [RING.constant(1), -M[r][r]], [M[i][r] for i in range(r)]
        for _ in range(r):
            column.append(-sum((M[r][i] * v[i] for i in range(r)), RING.constant(0)))
            v = [sum((M[i][j] * v[j] for j in range(r)), RING.constant(0)) for i in range(r)]
        vector = [
            sum(
                (column[i - j] * vector[j] for j in range(min(i, r) + 1) if i - j < len(column)),
                RING.constant(0),
            )
            for i in range(r + 2)
        ]
    x = RING.gens()[1]
    return sum((c * x**k for k, c in enumerate(reversed(vector))), RING.constant(0))


def expanded(table: tuple[Rows, int, int]) -> list[list[Any]]:
    """The polynomials that the entries times their common denominator are."""
    delta = common_denominator(table[0])
    return [[in_t(top * (delta // bottom)) for top, bottom in row] for row in table[0]]


def in_t(p: fmpq_poly) -> Any:
    """A polynomial in t as one in t and x."""
    return RING.from_dict({(i, 0): c for i, c in enumerate(p.coeffs()) if c != 0})


def factors_in_x(f: Any) -> list[Any]:
    """The irreducible factors with x, monic in x."""
    found = []
    for p, _ in f.factor()[1]:
        degree = p.degrees()[1]
        if degree:
            [lead] = [c for (_, k), c in p.to_dict().items() if k == degree]
            found.append(p / lead)
    return found


def univariate(f: Any) -> fmpq_poly:
    """A polynomial without x as one in t."""
    found = {int(i): c for (i, _), c in f.to_dict().items()}
    return fmpq_poly([found.get(i, 0) for i in range(max(found, default=-1) + 1)])


def drawn_polynomials(plant: ParametricPlant, rng: random.Random) -> list[Any]:
    """det(xI − A_F) for no gains, and for drawn ones."""
    return [characteristic(plant, drawn_gains(plant, rng, size)) for size in SIZES]


def split(chis: Sequence[Any]) -> tuple[list[Any], list[Any]]:
    """The irreducible common factors, and each polynomial divided by them."""
    fixed, quotients = factors_in_x(reduce(lambda f, g: f.gcd(g), chis)), []
    for chi in chis:
        for p in fixed:
            while (pair := divmod(chi, p))[1] == 0:
                chi = pair[0]
        quotients.append(chi)
    return fixed, quotients


def common_roots(quotients: Sequence[Any]) -> fmpq_poly:
    """A polynomial that vanishes at every t where all polynomials have a root x in common."""
    first, *others = quotients
    return univariate(reduce(lambda f, g: f.gcd(g), (first.resultant(f, "x") for f in others)))


def meets(p: fmpq_poly, ends: tuple[Any, Any]) -> bool:
    """Whether a real root of a polynomial is in a range, its ends included."""
    if any(end is not None and p(end) == 0 for end in ends):
        return True
    return decided(lambda sign: bool(real_roots_within(p, ends, sign)))


def real_roots_within(p: fmpq_poly, ends: tuple[Any, Any], sign: Sign) -> list[Any]:
    """The real roots in a range, its ends included, as balls."""
    low, high = ends
    found = [acb(root).real for root in roots_of(p) if sign(root.imag) == 0]
    if low is not None:
        found = [root for root in found if sign(root - acb(low).real) >= 0]
    if high is not None:
        found = [root for root in found if sign(acb(high).real - root) >= 0]
    return found


def interpolated(points: Sequence[fmpq], values: Sequence[fmpq]) -> fmpq_poly:
    """The polynomial with these values (Newton)."""
    found, through = fmpq_poly([]), fmpq_poly([1])
    for t, value in zip(points, values, strict=True):
        found = found + through * ((value - found(t)) / through(t))
        through = through * fmpq_poly([-t, 1])
    return found
