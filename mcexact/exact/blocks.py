"""Assembly of rational matrices from blocks."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import accumulate

from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix, Rows, from_cells, from_numerators
from mcexact.exact.matrix_sizes import require_sides


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
    width = sum(M.ncols for M in matrices)
    if any(M.is_sparse for M in matrices):
        left = offsets(M.ncols for M in matrices)
        return _placed((height, width), [(M, 0, j) for M, j in zip(matrices, left, strict=False)])
    tables, denominator = _over_one_denominator(matrices)
    rows = [[entry for table in tables for entry in table[i]] for i in range(height)]
    return from_numerators(rows, denominator, width)


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
    if any(M.is_sparse for M in matrices):
        top = offsets(M.nrows for M in matrices)
        shape = sum(M.nrows for M in matrices), width
        return _placed(shape, [(M, i, 0) for M, i in zip(matrices, top, strict=False)])
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
    top, left = offsets(M.nrows for M in matrices), offsets(M.ncols for M in matrices)
    shape = sum(M.nrows for M in matrices), sum(M.ncols for M in matrices)
    return _placed(shape, list(zip(matrices, top, left, strict=False)))


def kronecker(A: Matrix, B: Matrix) -> Matrix:
    """Return the Kronecker product, the block matrix of all a_ij B.

    Examples
    --------
    >>> kronecker(Matrix.from_rows([[1, 2]]), Matrix.identity(2)).numerators
    ((1, 0, 2, 0), (0, 1, 0, 2))
    """
    shape = A.nrows * B.nrows, A.ncols * B.ncols
    small = list(B.nonzero())
    found = {
        (i * B.nrows + k) * shape[1] + j * B.ncols + l: a * b
        for i, j, a in A.nonzero()
        for k, l, b in small
    }
    cells = sorted(found)
    return from_cells(shape, cells, map(found.__getitem__, cells), A.denominator * B.denominator)


def _placed(shape: tuple[int, int], parts: Sequence[tuple[Matrix, int, int]]) -> Matrix:
    """The matrix with each part at the place where its first row and column go, and zeros."""
    require_sides(*shape)
    denominator = math.lcm(*(M.denominator for M, _, _ in parts))
    found = {
        (top + i) * shape[1] + left + j: x * (denominator // M.denominator)
        for M, top, left in parts
        for i, j, x in M.nonzero()
    }
    cells = sorted(found)
    return from_cells(shape, cells, map(found.__getitem__, cells), denominator)


def offsets(sizes: Iterable[int]) -> list[int]:
    """Where parts of these sizes begin, one after the other, and where the last one ends.

    Examples
    --------
    >>> offsets([2, 0, 3])
    [0, 2, 2, 5]
    """
    return [0, *accumulate(sizes)]


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
