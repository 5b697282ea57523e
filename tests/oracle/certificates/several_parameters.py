"""Plants whose entries are quotients of polynomials in parameters, and their reader."""

from __future__ import annotations

import random
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from typing import Any

from flint import Ordering, fmpq, fmpq_mat, fmpq_mpoly_ctx, fmpq_poly

from .reading import demand, integer, listed, rational, record, text
from .systems import System, require_names

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,63}", re.ASCII)
QUOTIENT = re.compile(r"\((.*)\)/\((.*)\)", re.DOTALL)
FACTOR = re.compile(r"([A-Za-z][A-Za-z0-9_]*)(?:\^([1-9][0-9]*))?")
SIZE = re.compile(r"[0-9]+(?:/[0-9]+)?")
MOST = 12
"""The lines in the direction of one parameter."""
Terms = Mapping[tuple[int, ...], fmpq]
Function = tuple[Terms, Terms]


@dataclass(frozen=True)
class SeveralParameters:
    """A plant by the terms of its functions; tables are A, B_1, C_1, B_2, …"""

    time: str
    names: tuple[str, ...]
    ranges: Mapping[str, tuple[Any, Any]]
    tables: tuple[tuple[list[list[Function]], int, int], ...]

    def at(self, values: tuple[fmpq, ...]) -> System:
        """The plant at values of the parameters; it must be defined there."""
        found = []
        for rows, nrows, ncols in self.tables:
            entries = [value_of(entry, values) for row in rows for entry in row]
            found.append(fmpq_mat(nrows, ncols, entries))
        A, *ports = found
        alone = tuple((i,) for i in range(len(self.names)))
        return System(
            self.time, A, self.names, tuple(ports[0::2]), tuple(ports[1::2]), neighborhoods=alone
        )

    def points(self) -> Iterator[tuple[fmpq, ...]]:
        """Some values within the ranges, the ends and the middle among them."""
        sides = []
        for low, high in self.ranges.values():
            demand(low is not None and high is not None, "expected ranges with two ends")
            sides.append([low + (high - low) * fmpq(k, 8) for k in (0, 3, 4, 8)])
        yield from product(*sides)

    def lines(self) -> Iterator[tuple[int, tuple[fmpq, ...]]]:
        """Each parameter in turn, and some values of the others: also where an entry vanishes."""
        ends = list(self.ranges.values())
        sides = [{low + (high - low) * fmpq(k, 7) for k in (0, 3, 7)} for low, high in ends]
        entries = [entry for rows, _, _ in self.tables for row in rows for entry in row]
        zeros = (fmpq(0),) * (len(ends) - 1)
        for k, (low, high) in enumerate(ends):
            alone = [p for p, _ in entries if all(e[k] == sum(e) for e in p)]
            for factor in (f for p in alone if p for f, _ in in_one(p, k, zeros).factor()[1]):
                root = -factor[0] / factor[1] if factor.degree() == 1 else low
                sides[k] |= {root} if low <= root <= high else set()
        for k in range(len(ends)):
            others = [*product(*map(sorted, [*sides[:k], *sides[k + 1 :]]))]
            yield from (
                (k, values) for values in random.Random(k).sample(others, min(MOST, len(others)))
            )


def value_of(entry: Function, values: tuple[fmpq, ...]) -> fmpq:
    """The value of a function."""
    top, bottom = (sum((c * power(values, e) for e, c in p.items()), fmpq(0)) for p in entry)
    demand(bottom != 0, "expected an entry that is defined")
    return top / bottom


def power(values: tuple[fmpq, ...], exponents: tuple[int, ...]) -> fmpq:
    """A product of powers."""
    result = fmpq(1)
    for value, e in zip(values, exponents, strict=True):
        result *= value**e
    return result


def in_one(p: Terms, k: int = 0, others: tuple[fmpq, ...] = ()) -> fmpq_poly:
    """The polynomial in the parameter of position k, where the others have these values."""
    found: dict[int, fmpq] = {}
    for e, c in p.items():
        found[e[k]] = found.get(e[k], fmpq(0)) + c * power(others, (*e[:k], *e[k + 1 :]))
    return fmpq_poly([found.get(i, fmpq(0)) for i in range(max(found, default=-1) + 1)])


def read_several(value: Any) -> SeveralParameters:
    """The user's plant, in canonical form."""
    found = record(value, "time", "parameters", "A", "channels")
    demand(found["time"] in ("continuous", "discrete"), "expected a time domain")
    demand(isinstance(found["parameters"], Mapping), "expected parameters")
    ranges = {}
    for name, said in sorted(found["parameters"].items()):
        demand(NAME.fullmatch(name) is not None and name != "x", "expected a name")
        ends = listed(record(said, optional=("range",)).get("range", [None, None]), 2)
        low, high = (None if end is None else rational(end) for end in ends)
        demand("range" not in said or low is not None or high is not None, "expected an end")
        demand(low is None or high is None or low <= high, "expected a range")
        ranges[name] = low, high
    parameters = tuple(ranges)
    A = table(found["A"], parameters, None, None)
    demand(A[1] == A[2], "expected a square matrix")
    channels = [record(c, "name", "B", "C") for c in listed(found["channels"])]
    names = tuple(text(c["name"]) for c in channels)
    require_names(names)
    tables = [A]
    for c in channels:
        tables.append(table(c["B"], parameters, A[1], None))
        tables.append(table(c["C"], parameters, None, A[1]))
    return SeveralParameters(found["time"], names, ranges, tuple(tables))


def table(
    value: Any, parameters: tuple[str, ...], nrows: int | None, ncols: int | None
) -> tuple[list[list[Function]], int, int]:
    """A matrix of functions."""
    if isinstance(value, Mapping):
        shape, entries = (record(value, "shape", "entries")[key] for key in ("shape", "entries"))
        demand(entries == [] and shape[:1] == [0] and len(shape) == 2, "expected rows")
        width = integer(shape[1], 1)
        demand(nrows in (None, 0) and ncols in (None, width), "expected another shape")
        return [], 0, width
    rows = [[function(e, parameters) for e in listed(row)] for row in listed(value, nrows)]
    width = len(rows[0]) if rows else 0
    demand(all(len(row) == width for row in rows), "expected rows of one length")
    demand(ncols in (None, width), "expected another number of columns")
    return rows, len(rows), width


def function(value: Any, parameters: tuple[str, ...]) -> Function:
    """A rational, or the canonical text of a function that is not constant."""
    constant = (0,) * len(parameters)
    one = {constant: fmpq(1)}
    demand(not isinstance(value, str) or len(value) <= 100_000, "expected a shorter text")
    if not isinstance(value, str) or re.fullmatch(r"-?[0-9/]+", value):
        return {constant: rational(value)}, one
    quotient = QUOTIENT.fullmatch(value)
    top = terms(quotient[1] if quotient else value, parameters)
    bottom = terms(quotient[2], parameters) if quotient else one
    if quotient:
        lead = max(bottom)
        demand(lead != constant and bottom[lead] == 1, "expected a denominator")
        ring = fmpq_mpoly_ctx.get(parameters, Ordering.lex)
        common = ring.from_dict(dict(top)).gcd(ring.from_dict(dict(bottom)))
        demand(common.is_constant(), "expected lowest terms")
    demand(quotient is not None or set(top) != {constant}, "expected a number")
    return top, bottom


def terms(value: str, parameters: tuple[str, ...]) -> Terms:
    """A polynomial as statements write it, and nothing else."""
    found: dict[tuple[int, ...], fmpq] = {}
    last: tuple[int, ...] | None = None
    demand(" + -" not in value, "expected a minus for the plus")
    for term in value.replace(" - ", " + -").split(" + "):
        sign, size, exponents = (-1 if term[:1] == "-" else 1), fmpq(1), [0] * len(parameters)
        factors = term.removeprefix("-").split("*")
        if SIZE.fullmatch(factors[0]):
            whole, _, below = factors[0].partition("/")
            demand(int(below or 1) > 0, "expected a denominator")
            size = fmpq(int(whole), int(below or 1))
            demand(str(size) == factors[0], "expected lowest terms")
            demand(size != 1 or len(factors) == 1, "expected no factor 1")
            factors = factors[1:]
        places = []
        for factor in factors:
            match = FACTOR.fullmatch(factor)
            demand(match is not None and match[1] in parameters, "expected a parameter")
            name, e = match.groups() if match else ("", "")
            demand(e != "1", "expected no power 1")
            places.append(parameters.index(name))
            exponents[places[-1]] = int(e or 1)
        demand(places == sorted(set(places)), "expected parameters in order")
        key = tuple(exponents)
        demand(sum(key) <= 1000, "expected a smaller degree")
        demand(last is None or key < last, "expected terms in order")
        demand(size != 0, "expected a term")
        last, found[key] = key, sign * size
    return found
