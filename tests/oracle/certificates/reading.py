"""The values of a certificate, read as ``FORMAT.md`` specifies them and not more generously."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from flint import fmpq, fmpq_mat, fmpq_poly

RATIONAL = re.compile(r"-?(0|[1-9][0-9]*)/[1-9][0-9]*", re.ASCII)
TYPED = re.compile(r"-?[0-9]+/0*[1-9][0-9]*|-?[0-9]+(\.[0-9]+)?([eE][+-]?[0-9]+)?", re.ASCII)
DECIMAL = re.compile(r"-?[0-9]+(\.[0-9]+)?", re.ASCII)


LEAST, SHARE = 2048, 8
"""The cells of the smallest matrix that lists its entries, and that one in so many is not 0."""


class Unspecified(Exception):
    """A document that is not written as the format says."""


class Undecided(Exception):
    """A claim of which this oracle cannot tell whether it is true."""


def demand(condition: bool, what: str) -> None:
    """Raise an error unless a condition holds."""
    if not condition:
        raise Unspecified(what)


def record(value: Any, *keys: str, optional: Sequence[str] = ()) -> Mapping[str, Any]:
    """An object with exactly these keys."""
    demand(isinstance(value, Mapping), "expected an object")
    demand(set(keys) <= set(value) <= {*keys, *optional}, f"expected the keys {keys}")
    found: Mapping[str, Any] = value
    return found


def listed(value: Any, length: int | None = None) -> list[Any]:
    """A list, of a given length."""
    demand(isinstance(value, list | tuple), "expected a list")
    demand(length is None or len(value) == length, f"expected {length} entries")
    return list(value)


def integer(value: Any, least: int | None = None) -> int:
    """A JSON integer."""
    demand(isinstance(value, int) and not isinstance(value, bool), "expected an integer")
    demand(least is None or value >= least, f"expected at least {least}")
    return int(value)


def truth(value: Any) -> bool:
    """A truth value."""
    demand(isinstance(value, bool), "expected true or false")
    return bool(value)


def text(value: Any) -> str:
    """A string."""
    demand(isinstance(value, str), "expected a string")
    return str(value)


def rational(value: Any) -> fmpq:
    """An integer, or a fraction in lowest terms with a denominator of at least 2."""
    if isinstance(value, str):
        demand(RATIONAL.fullmatch(value) is not None, "expected a fraction")
        p, q = map(int, value.split("/"))
        demand(q >= 2 and math.gcd(p, q) == 1, "expected lowest terms")
        return fmpq(p, q)
    return fmpq(integer(value))


def typed(value: Any) -> fmpq:
    """A number of a system or controller file: an integer, or a string as it may be typed."""
    if not isinstance(value, str):
        return fmpq(integer(value))
    demand(TYPED.fullmatch(value) is not None, "expected a number")
    found = Fraction(value)
    return fmpq(found.numerator, found.denominator)


def decimal(value: Any) -> fmpq:
    """A string such as "-1.25"."""
    demand(isinstance(value, str), "expected a decimal")
    demand(DECIMAL.fullmatch(value) is not None, "expected a decimal")
    whole, _, digits = value.partition(".")
    return fmpq(int(whole + digits), 10 ** len(digits))


def polynomial(value: Any, *, monic: bool = False) -> fmpq_poly:
    """A list of coefficients, constant term first, the last not 0."""
    values = [rational(v) for v in listed(value)]
    demand(bool(values) and values[-1] != 0, "expected a last coefficient other than 0")
    demand(not monic or values[-1] == 1, "expected a monic polynomial")
    return fmpq_poly(values)


def matrix(value: Any, nrows: int, ncols: int) -> fmpq_mat:
    """A matrix of a claim or a witness: integers over one denominator."""
    found = record(value, "denominator", "entries")
    d = integer(found["denominator"], 1)
    rows = [listed(row, ncols) for row in listed(found["entries"], nrows)]
    return fmpq_mat(nrows, ncols, [fmpq(integer(v), d) for row in rows for v in row])


def table(value: Any, nrows: int | None, ncols: int | None) -> fmpq_mat:
    """A matrix of a system: rows of rationals, or its shape and entries in the form prescribed."""
    if isinstance(value, Mapping):
        found = record(value, "shape", "entries")
        r, c = (integer(v, 0) for v in listed(found["shape"], 2))
        demand(nrows in (None, r) and ncols in (None, c), "expected another shape")
        entries = [listed(entry, 3) for entry in listed(found["entries"])]
        places = [(integer(i, 0), integer(j, 0)) for i, j, _ in entries]
        demand(places == sorted(set(places)), "expected sorted positions")
        demand(all(i < r and j < c for i, j in places), "expected positions inside")
        demand((r == 0 < c) or is_sparse(r, c, len(places)), "expected rows")
        M = fmpq_mat(r, c)
        for (i, j), (_, _, v) in zip(places, entries, strict=True):
            M[i, j] = rational(v)
            demand(M[i, j] != 0, "expected an entry other than 0")
        return M
    rows = [listed(row) for row in listed(value, nrows)]
    width = len(rows[0]) if rows else 0
    demand(all(len(row) == width for row in rows), "expected rows of one length")
    demand(bool(rows) or not ncols, "expected a matrix without rows to say its columns")
    demand(ncols in (None, width), f"expected {ncols} columns")
    values = [rational(v) for row in rows for v in row]
    nonzero = sum(v != 0 for v in values)
    demand(not is_sparse(len(rows), width, nonzero), "expected a list of entries")
    return fmpq_mat(len(rows), width, values)


def is_sparse(nrows: int, ncols: int, nonzero: int) -> bool:
    """Whether a matrix of a system lists its entries."""
    return nrows * ncols >= LEAST and SHARE * nonzero <= nrows * ncols


def positions(value: Any, names: Sequence[str]) -> list[int]:
    """A set of channels: names in the order of the system, without repetition."""
    found = [place(name, names) for name in listed(value)]
    demand(found == sorted(set(found)), "expected channels in the order of the system")
    return found


def place(value: Any, names: Sequence[str]) -> int:
    """The position of a channel."""
    demand(isinstance(value, str) and value in names, "expected the name of a channel")
    return list(names).index(value)


def edges(value: Any, names: Sequence[str]) -> list[tuple[int, int]]:
    """Edges [j, i], sorted by (from, to) in the order of the channels, without repetition."""
    found = [(place(j, names), place(i, names)) for j, i in (listed(e, 2) for e in listed(value))]
    demand(found == sorted(set(found)), "expected sorted edges")
    return found
