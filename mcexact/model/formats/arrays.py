"""Arrays in files to exact matrices, and exact matrices to arrays without loss."""

from __future__ import annotations

import math
from collections.abc import Iterable
from fractions import Fraction
from typing import Any

from mcexact.errors import InputError
from mcexact.exact.floats import Rounding, from_float, matrix_from_float, matrix_to_float
from mcexact.exact.matrix import Matrix, from_cells
from mcexact.exact.rational import Limits, decimal_or_quotient
from mcexact.exact.rows import common_width, is_sparse_array
from mcexact.exact.tables import is_mostly_zero
from mcexact.model.formats.reading import Reading
from mcexact.model.matrix_entry import as_matrix, require_shape
from mcexact.model.matrix_json import LONGEST_SIDE, read_number

HOW = (
    "a float is not exact: choose how it is rounded, such as by "
    "'mcexact convert FILE --rounding decimal -o plant.json'"
)
WHOLE = 2**53
"""Floats hold every integer up to here."""


def require_sides(sides: Any, where: str) -> None:
    """Refuse a shape that is not one of a matrix, before anything of that size is made.

    Raises
    ------
    InputError
        If there are more or fewer than two sides, or one is negative or longer than 2**20.
    """
    shape = " × ".join(map(str, sides))
    if len(sides) != 2:
        raise InputError(
            f"expected a matrix, found {len(sides)} dimensions" + (f", {shape}" if sides else ""),
            where=where,
        )
    if min(sides) < 0 or max(sides) > LONGEST_SIDE:
        raise InputError(
            f"expected 0 to {LONGEST_SIDE} rows and columns, found {shape}", where=where
        )


def require_entries(values: Iterable[Any], limits: Limits) -> None:
    """Refuse arrays that have more entries than a file of numbers of 64 bits can have.

    A compressed file can claim many more than it has bytes, and each takes time to convert; zeros
    take none.

    Raises
    ------
    InputError
        If there are too many, texts and numbers that are not 0.
    """
    import numpy as np

    most, count = limits.bytes // 8, 0
    for value in values:
        if is_sparse_array(value):
            count += value.nnz
        elif hasattr(value, "dtype"):
            count += value.size if value.dtype.kind == "U" else int(np.count_nonzero(value))
        elif isinstance(value, list):
            count += sum(len(row) - row.count("0") for row in value)
    if count > most:
        raise InputError(
            f"expected at most {most} entries that are not 0 (Limits.bytes), found {count}"
        )


def exact_matrix(
    value: Any, where: str, reading: Reading, nrows: int | None = None, ncols: int | None = None
) -> Matrix:
    """Convert a table of a file to an exact matrix of an expected shape.

    Parameters
    ----------
    value : array, sparse array, or list of rows of texts
        An array of texts has numbers in the grammar of system files.
    where : str
    reading : Reading
    nrows, ncols : int, optional
        The expected shape, which a table without rows and columns takes if it can be empty.

    Raises
    ------
    InputError
        If it is something else, or has a float that is not exact without a rounding.
    """
    if isinstance(value, Matrix):
        M = value
    elif isinstance(value, list) or value.dtype.kind == "U":
        M = _of_texts(value if isinstance(value, list) else value.tolist(), where, reading.limits)
        if not isinstance(value, list) and value.size == 0:
            M = Matrix.zeros(*value.shape)
    else:
        require_sides(value.shape, where)
        M = _of_numbers(value, where, reading)
    if M.shape == (0, 0) and (not nrows or not ncols):
        return Matrix.zeros(nrows or 0, ncols or 0)
    return require_shape(M, where, nrows, ncols)


def _of_texts(rows: list[list[str]], where: str, limits: Limits) -> Matrix:
    """Read numbers in the grammar of system files; each text is read once."""
    width = common_width(rows, where)
    known: dict[str, int] = {}
    exact: list[Fraction] = []
    places: list[list[int]] = []
    for i, row in enumerate(rows):
        for entry in sorted(set(row) - known.keys(), key=row.index):
            known[entry] = len(exact)
            exact.append(read_number(entry, f"{where}[{i}][{row.index(entry)}]", limits))
        places.append(list(map(known.__getitem__, row)))
    return _of_distinct(exact, places, width or 0)


def _of_distinct(exact: list[Fraction], places: list[list[int]], width: int) -> Matrix:
    """The matrix of rows of positions in a list of numbers, most of which can occur often."""
    denominator = math.lcm(*{number.denominator for number in exact})
    numerators = [number.numerator * (denominator // number.denominator) for number in exact]
    rows = [tuple(map(numerators.__getitem__, row)) for row in places]
    return Matrix.from_integers(rows, denominator, width)


def _of_numbers(value: Any, where: str, reading: Reading) -> Matrix:
    """Convert an array of numbers; integers are exact in every form."""
    import numpy as np

    kind = value.dtype.kind
    if kind == "b":
        value = value.astype("u1")
    elif kind == "f" and reading.rounding is not None:
        if is_sparse_array(value):
            return matrix_from_float(value, reading.rounding, where=where)
        _require_finite(value.ravel(), where)
        distinct, places = np.unique(value, return_inverse=True)
        exact = [from_float(number, reading.rounding, where=where) for number in distinct]
        return _of_distinct(exact, places.reshape(value.shape).tolist(), value.shape[1])
    elif kind == "f":
        _require_integers(value, where)
        value = value.astype("i8")
    elif kind not in "iu":
        found = {"c": "complex numbers", "O": "objects"}.get(kind, f"entries of type {value.dtype}")
        raise InputError(f"expected real numbers, found {found}", where=where)
    if is_sparse_array(value):
        return as_matrix(value, where)
    cells = np.flatnonzero(value)
    if is_mostly_zero(value.size, cells.size):
        return from_cells(value.shape, cells.tolist(), value.ravel()[cells].tolist())
    return as_matrix(value, where)


def _require_finite(entries: Any, where: str) -> None:
    """Refuse an infinity and NaN."""
    import numpy as np

    wrong = entries[~np.isfinite(entries)]
    if wrong.size:
        raise InputError(f"expected finite numbers, found {wrong[0]}", where=where)


def _require_integers(value: Any, where: str) -> None:
    """Refuse floats that are not integers, and those of which not every integer is one."""
    import numpy as np

    entries = value.data if is_sparse_array(value) else value.ravel()
    wrong = entries[~(np.abs(entries) <= WHOLE) | (entries != np.round(entries))]
    if not wrong.size:
        return
    _require_finite(wrong, where)
    raise InputError(f"found {wrong[0]!s}: {HOW}", where=where)


def integers_or_none(M: Matrix) -> Any:
    """The matrix as an array of integers of 64 bits, or None if it is none."""
    import numpy as np

    if M.denominator != 1 or any(abs(x) >= 2**63 for row in M.numerators for x in row):
        return None
    rows = [list(row) for row in M.numerators]
    return np.array(rows, dtype=np.int64).reshape(M.shape)


def floats_of(M: Matrix, where: str, rounding: Rounding | None, *, nearest: bool) -> Any:
    """The matrix as an array of floats from which the rounding makes it again.

    Raises
    ------
    InputError
        If there is none, and the nearest floats are not asked for.
    """
    import numpy as np

    floats = matrix_to_float(M)
    if not np.all(np.isfinite(floats)):
        raise InputError("a number is beyond the range of floats", where=where)
    if nearest:
        return floats
    again = matrix_from_float(floats, rounding or "dyadic", where=where)
    if again != M:
        i, j = next(
            (i, j) for i in range(M.nrows) for j in range(M.ncols) if again[i, j] != M[i, j]
        )
        by = f" with the rounding '{rounding}'" if rounding else ""
        hint = "" if rounding else "--rounding decimal, or "
        raise InputError(
            f"no float is read as {decimal_or_quotient(M[i, j])}{by}: write .json or .csv files, "
            f"or add {hint}--nearest for the nearest floats",
            where=f"{where}[{i}][{j}]",
        )
    return floats
