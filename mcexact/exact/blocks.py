"""Assembly of rational matrices from blocks."""

from __future__ import annotations

import math
from collections.abc import Sequence

from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix, Rows, from_numerators


def hstack(matrices: Sequence[Matrix], nrows: int | None = None) -> Matrix:
    """Return the matrix [M1 M2 …].

    Parameters
    ----------
    matrices : sequence of Matrix
        All with the same number of rows.
    nrows : int, optional
        This number, which is required if there may be no matrices.

    Examples
    --------
    >>> hstack([Matrix.identity(2), Matrix.column([5, 6])]).numerators
    ((1, 0, 5), (0, 1, 6))
    >>> hstack([], nrows=2).shape
    (2, 0)
    """
    height = _common(matrices, [M.nrows for M in matrices], nrows, "rows", "hstack")
    tables, denominator = _over_one_denominator(matrices)
    rows = [[entry for table in tables for entry in table[i]] for i in range(height)]
    return from_numerators(rows, denominator, sum(M.ncols for M in matrices))


def vstack(matrices: Sequence[Matrix], ncols: int | None = None) -> Matrix:
    """Return the matrix [M1; M2; …].

    Parameters
    ----------
    matrices : sequence of Matrix
        All with the same number of columns.
    ncols : int, optional
        This number, which is required if there may be no matrices.

    Raises
    ------
    InputError
        If the numbers of columns differ, or there are no matrices and no number.

    Examples
    --------
    >>> vstack([Matrix.identity(2), Matrix.from_rows([[5, "1/2"]])]).rows()[2]
    (Fraction(5, 1), Fraction(1, 2))
    """
    width = _common(matrices, [M.ncols for M in matrices], ncols, "columns", "vstack")
    tables, denominator = _over_one_denominator(matrices)
    return from_numerators([row for table in tables for row in table], denominator, width)


def block(rows: Sequence[Sequence[Matrix]]) -> Matrix:
    """Return the matrix assembled from rows of blocks.

    At least one row of blocks, each with at least one block.

    Examples
    --------
    >>> I = Matrix.identity(1)
    >>> block([[I, 2 * I], [3 * I, 4 * I]]).numerators
    ((1, 2), (3, 4))
    """
    if not rows:
        raise InputError("block: expected at least one row of blocks")
    return vstack([hstack(row) for row in rows])


def block_diagonal(matrices: Sequence[Matrix]) -> Matrix:
    """Return the matrix diag(M1, M2, …); blocks may have no rows or no columns.

    Examples
    --------
    >>> block_diagonal([Matrix.identity(1), Matrix.zeros(0, 2), Matrix.identity(1)]).numerators
    ((1, 0, 0, 0), (0, 0, 0, 1))
    """
    tables, denominator = _over_one_denominator(matrices)
    width = sum(M.ncols for M in matrices)
    rows: list[tuple[int, ...]] = []
    left = 0
    for M, table in zip(matrices, tables, strict=True):
        right = width - left - M.ncols
        rows += [(0,) * left + row + (0,) * right for row in table]
        left += M.ncols
    return from_numerators(rows, denominator, width)


def kronecker(A: Matrix, B: Matrix) -> Matrix:
    """Return the Kronecker product, the block matrix of all a_ij B.

    Examples
    --------
    >>> kronecker(Matrix.from_rows([[1, 2]]), Matrix.identity(2)).numerators
    ((1, 0, 2, 0), (0, 1, 0, 2))
    """
    rows = [
        [a * b for a in upper for b in lower] for upper in A.numerators for lower in B.numerators
    ]
    return from_numerators(rows, A.denominator * B.denominator, A.ncols * B.ncols)


def _common(
    matrices: Sequence[Matrix], sizes: list[int], given: int | None, name: str, caller: str
) -> int:
    found = set(sizes) | (set() if given is None else {given})
    if not found:
        raise InputError(f"{caller}: expected at least one matrix, or the number of {name}")
    if len(found) > 1:
        raise InputError(f"{caller}: expected equal numbers of {name}, found {sorted(found)}")
    return found.pop()


def _over_one_denominator(matrices: Sequence[Matrix]) -> tuple[list[Rows], int]:
    denominator = math.lcm(*(M.denominator for M in matrices))
    return [(M * denominator).numerators for M in matrices], denominator
