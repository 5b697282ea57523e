"""The matrices of systems, of controllers and of radii: their numbers, and their canonical form."""

import math
import re
from fractions import Fraction
from itertools import chain

from . import budget, reading, sparse
from .arithmetic import Matrix
from .reading import Json, Limits, fields, integer, items, malformed, shown
from .sparse import SparseMatrix

LONGEST = 2**20
"""The most rows and columns of a matrix that lists its entries."""

NUMBER = re.compile(r"-?[0-9]++(?:/0*+[1-9][0-9]*+|(?:\.[0-9]++)?(?:[eE][+-]?[0-9]++)?)")


def number(value: Json, place: str, limits: Limits | None = None) -> Fraction | int:
    """A number of a system file: an integer, a decimal as typed, or a string "p/q".

    ``limits`` are those of a file; a certificate's numbers were limited when it was parsed.
    """
    result: Fraction | int
    if type(value) is int or isinstance(value, Fraction):
        result, typed = value, 0
    else:
        good = type(value) is str and NUMBER.fullmatch(value)
        mantissa, exponent, *_ = [*re.split("[eE]", value), "0"] if good else ["", "0"]
        if not good or abs(int(exponent)) > (limits or Limits).exponent:
            malformed(place, f'expected an integer, a decimal or "p/q", found {shown(value)}')
        typed = 0 if "/" in mantissa else len(mantissa.strip("-").replace(".", ""))
        budget.spend(300 + (len(value) + abs(int(exponent))) ** 2 // 500)
        result = Fraction(value)
    if limits is None:
        return result
    size = max(abs(result.numerator), result.denominator)
    if typed > limits.digits or too_long(size, limits.digits):
        reading.incomplete("size", place, f"needs more than {limits.digits} digits (Limits.digits)")
    return result


def too_long(value: int, digits: int) -> bool:
    """Whether an integer that is not negative has more than so many digits."""
    return value.bit_length() > 3 * digits and value >= 10**digits


def read_matrix(
    value: Json, place: str, nrows: int | None, ncols: int | None, limits: Limits | None = None
) -> Matrix:
    """A matrix of a system: a list of rows, or an object that lists its nonzero entries."""
    rows: list[list[Json]] = []
    cells: dict[tuple[int, int], Json] = {}
    if isinstance(value, dict):
        shape, entries = fields(value, place, "shape", "entries")
        r, c = (integer(size, f"{place}.shape") for size in items(shape, f"{place}.shape", 2))
        if max(r, c) > LONGEST:
            reading.incomplete("size", f"{place}.shape", f"{r} by {c} is too large")
        for i, j, entry in (items(triple, place, 3) for triple in items(entries, place)):
            if integer(i, place) >= r or integer(j, place) >= c or (i, j) in cells:
                malformed(place, f"expected a position of its own inside {r} by {c}")
            cells[i, j] = number(entry, place, limits)
    else:
        r, listed = len(items(value, place)), value
        c = len(items(listed[0], place)) if listed else ncols or 0
        plain = limits is None and _are_integers(listed, c)
        rows = listed if plain else [_numbers(items(x, place, c), place, limits) for x in listed]
    if nrows not in (None, r) or ncols not in (None, c):
        malformed(place, f"expected another shape, found {r} by {c}")
    given = [*chain(*rows), *cells.values()]
    whole = set(map(type, given)) <= {int}
    different = {1} if whole else {entry.denominator for entry in given}
    budget.spend(budget.fractions(len(different), sum(budget.limbs([d]) for d in different)))
    d = math.lcm(*different)
    size = budget.limbs(given if whole else [entry.numerator for entry in given])
    size += budget.limbs([d])
    budget.build(r if rows else 1, c if rows else len(cells), size, size)
    if isinstance(value, dict):
        known = sorted(
            (i, j, e.numerator * (d // e.denominator)) for (i, j), e in cells.items() if e
        )
        found = SparseMatrix(r, c, known, d)
        return sparse.listed(found) or Matrix(found.rows, c, d)
    if whole:
        return Matrix(rows, c)
    return Matrix([[e.numerator * (d // e.denominator) for e in row] for row in rows], c, d)


def _are_integers(rows: list[Json], ncols: int) -> bool:
    """Whether each row is a list of so many integers; a row at a time takes three times as long."""
    lists = set(map(type, rows)) <= {list} and set(map(len, rows)) <= {ncols}
    return lists and set(map(type, chain.from_iterable(rows))) <= {int}


def _numbers(row: list[Json], place: str, limits: Limits | None) -> list[Json]:
    """The numbers of a row; integers of a certificate are as they should be."""
    known = limits is None and set(map(type, row)) <= {int}
    return row if known else [number(entry, place, limits) for entry in row]


def rows_of(M: Matrix) -> list[list[Json]]:
    """The rows of a matrix as in JSON: integers, or "p/q" in lowest terms."""
    budget.spend(budget.fractions(M.nrows * M.ncols, M.limbs))
    if M.denominator == 1:
        return M.rows
    return [[in_json(entry, M.denominator) for entry in row] for row in M.rows]


def in_json(numerator: int, denominator: int) -> Json:
    value = Fraction(numerator, denominator)
    return value.numerator if value.denominator == 1 else str(value)


def form_of(M: Matrix) -> Json:
    """The canonical form of a matrix: its rows, or the entries of a large one that is sparse."""
    found = sparse.listed(M)
    if found is None and (M.nrows or not M.ncols):
        return rows_of(M)
    entries = [] if found is None else found.entries
    budget.spend(budget.fractions(len(entries), M.limbs))
    triples = [[i, j, in_json(x, M.denominator)] for i, j, x in entries]
    return {"shape": [M.nrows, M.ncols], "entries": triples}
