"""Matrices of which only the entries that are not 0 are kept."""

from collections.abc import Iterable, Mapping
from functools import cached_property
from itertools import chain, compress

from . import budget
from .arithmetic import Matrix, Rows, inverse
from .budget import spend

Entry = tuple[int, int, int]
"""Row, column and numerator."""

LEAST, SHARE = 2**11, 8
"""A matrix of so many cells lists its entries if at most one cell of so many is not 0."""


class SparseMatrix(Matrix):
    """A rational matrix by its entries, row by row, which become rows where these are used."""

    entries: list[Entry]

    def __init__(self, nrows: int, ncols: int, entries: list[Entry], denominator: int = 1) -> None:
        found = {"nrows": nrows, "ncols": ncols, "entries": entries, "denominator": denominator}
        self.__dict__.update(found)

    @cached_property
    def rows(self) -> Rows:
        """The rows with all zeros."""
        spend(budget.table(self.nrows, self.ncols))
        found = [[0] * self.ncols for _ in range(self.nrows)]
        for i, j, entry in self.entries:
            found[i][j] = entry
        return found

    @cached_property
    def limbs(self) -> int:
        """The limbs of the longest entry, or of the denominator."""
        spend(8 + len(self.entries))
        return budget.limbs([self.denominator, *(entry for _, _, entry in self.entries)])

    @property
    def T(self) -> Matrix:
        """The transpose."""
        spend(100 * len(self.entries))
        turned = sorted((j, i, entry) for i, j, entry in self.entries)
        return SparseMatrix(self.ncols, self.nrows, turned, self.denominator)

    def __matmul__(self, other: Matrix) -> Matrix:
        if self.ncols != other.nrows:
            raise ValueError(f"no product of {self.ncols} columns and {other.nrows} rows")
        a, b, width = self.limbs, other.limbs, other.ncols
        spend(budget.table(self.nrows, width, a + b + 1) + 100 * len(self.entries))
        spend(budget.products(len(self.entries) * width, a, b))
        rows = [[0] * width for _ in range(self.nrows)]
        for i, k, x in self.entries:
            rows[i] = [
                total + x * entry for total, entry in zip(rows[i], other.rows[k], strict=True)
            ]
        return Matrix(rows, width, self.denominator * other.denominator)

    def __rmatmul__(self, other: Matrix) -> Matrix:
        return (self.T @ other.T).T

    def is_zero(self) -> bool:
        """Whether there is no entry."""
        return not self.entries

    def at(self, rows: Iterable[int]) -> Matrix:
        """The submatrix of these rows."""
        chosen = list(rows)
        spend(100 * (len(chosen) + len(self.entries)))
        lines: dict[int, list[Entry]] = {}
        for entry in self.entries:
            lines.setdefault(entry[0], []).append(entry)
        moved = [(new, j, x) for new, i in enumerate(chosen) for _, j, x in lines.get(i, ())]
        return SparseMatrix(len(chosen), self.ncols, moved, self.denominator)


def listed(M: Matrix) -> SparseMatrix | None:
    """A matrix by its entries, if it is large and most cells are 0; otherwise None."""
    cells = M.nrows * M.ncols
    if isinstance(M, SparseMatrix):
        return M if SHARE * len(M.entries) <= cells and cells >= LEAST else None
    if cells < LEAST:
        return None
    spend(M.nrows * (8 + M.ncols))
    nonzero = sum(map(bool, chain.from_iterable(M.rows)))
    if SHARE * nonzero > cells:
        return None
    spend(100 * nonzero)
    entries = [(i, j, x) for i, row in enumerate(M.rows) for j, x in enumerate(row) if x]
    return SparseMatrix(M.nrows, M.ncols, entries, M.denominator)


def entries_of(M: Matrix) -> list[Entry]:
    """The entries of any matrix that are not 0, row by row."""
    if isinstance(M, SparseMatrix):
        return M.entries
    spend(M.nrows * (8 + M.ncols))
    places = [(i, j) for i, row in enumerate(M.rows) for j in compress(range(M.ncols), row)]
    spend(100 * len(places))
    return [(i, j, M.rows[i][j]) for i, j in places]


def within(M: Matrix, rows: Mapping[int, int] | None, cols: Mapping[int, int] | None) -> Matrix:
    """The submatrix of some rows and columns, whose new places increase; None stands for all."""
    nrows = M.nrows if rows is None else len(rows)
    ncols = M.ncols if cols is None else len(cols)
    if not isinstance(M, SparseMatrix):
        return M.take(rows, cols)
    spend(100 * len(M.entries))
    down = [(i if rows is None else rows.get(i), j, x) for i, j, x in M.entries]
    kept = [(i, j if cols is None else cols.get(j), x) for i, j, x in down if i is not None]
    moved = [(i, j, x) for i, j, x in kept if j is not None]
    return SparseMatrix(nrows, ncols, moved, M.denominator)


def residues(M: Matrix, ell: int) -> list[Entry]:
    """The entries modulo ℓ, which is coprime to the denominator."""
    entries, a, b = entries_of(M), M.limbs, budget.limbs([ell])
    spend(budget.inversions(1, b) + budget.reductions(len(entries) + 1, a + b, b))
    f = inverse(M.denominator, ell)
    return [(i, j, f * x % ell) for i, j, x in entries]
