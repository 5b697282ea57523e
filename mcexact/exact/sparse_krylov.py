"""Krylov sequences of sparse matrices modulo primes, by products in floating point that are exact.

A closed loop with few entries in each row is a compressed sparse array of symmetric residues, of at
most ℓ/2 each.  As long as they are integers that floats represent exactly, products are reduced
modulo ℓ after several steps only: modulo 7 with 6 entries a row after 5 steps in singles.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from mcexact.exact.blocks import offsets
from mcexact.exact.krylov import Start, products_at_once, reduce
from mcexact.exact.matrix import Matrix
from mcexact.exact.tables import is_mostly_zero

if TYPE_CHECKING:
    import numpy as np
    import scipy.sparse

    Integers = scipy.sparse.csr_array[np.int64]

_EXACT = 2**53
_EXACT_IN_SINGLE = 2**24

# So many numbers of a sequence are computed from what is seen of the vectors at once.
_TOGETHER = 1024


def stays_sparse(A: Matrix, B: Sequence[Matrix], C: Sequence[Matrix]) -> bool:
    """Whether A is sparse, and A + Σ B_i F_i C_i is for all F.

    Examples
    --------
    >>> ring = Matrix.from_entries((99, 99), [(i, (i + 1) % 99, 1) for i in range(99)])
    >>> stays_sparse(ring, [ring.take(cols=[0])], [ring.take(rows=[0])])
    True
    >>> stays_sparse(ring, [Matrix.column([1] * 99)], [Matrix.from_rows([[1] * 99])])
    False
    """
    if not A.is_sparse:
        return False
    most = _entries(A) + sum(_entries(M) * _entries(N) for M, N in zip(B, C, strict=True))
    return is_mostly_zero(A.nrows * A.ncols, most)


def _entries(M: Matrix) -> int:
    return sum(1 for _ in M.nonzero())


class SparseLoop:
    """A, B = [B_1 … B_m] and C = [C_1; …; C_m] modulo ℓ, as sparse arrays of integers.

    Parameters
    ----------
    A : Matrix
        n × n.
    B, C : sequences of Matrix
        n × p_i and q_i × n.
    ell : int
        A prime below 2**24, which divides no denominator.
    """

    def __init__(self, A: Matrix, B: Sequence[Matrix], C: Sequence[Matrix], ell: int) -> None:
        self.ell, self.n = ell, A.nrows
        self.inputs, self.outputs = offsets([M.ncols for M in B]), offsets([M.nrows for M in C])
        self.A = _residues([(A, 0, 0)], A.shape, ell)
        across = [(M, 0, j) for M, j in zip(B, self.inputs, strict=False)]
        down = [(M, i, 0) for M, i in zip(C, self.outputs, strict=False)]
        self.B = _residues(across, (self.n, self.inputs[-1]), ell)
        self.C = _residues(down, (self.outputs[-1], self.n), ell)

    def closed(self, gains: Sequence[Any]) -> Integers:
        """A + Σ B_i F_i C_i, for p_i × q_i rows of integers."""
        import numpy as np
        import scipy.sparse

        listed_gains = [
            (self.inputs[i] + g, self.outputs[i] + h, x)
            for i, rows in enumerate(gains)
            for g, row in enumerate(rows)
            for h, x in enumerate(row)
        ]
        places = np.array(listed_gains, dtype=np.int64).reshape(-1, 3)
        shape = self.inputs[-1], self.outputs[-1]
        F = scipy.sparse.csr_array((places[:, 2], (places[:, 0], places[:, 1])), shape=shape)
        moved = self._reduced(self.B @ self._reduced(F @ self.C))
        return self._reduced(self.A + moved)

    def _reduced(self, M: Any) -> Integers:
        """Symmetric residues, of which none is kept that is 0."""
        import scipy.sparse

        found = scipy.sparse.csr_array(M)
        found.data = _symmetric(found.data, self.ell)
        found.eliminate_zeros()
        return found

    def sequences(self, M: Integers, starts: Iterable[Start]) -> Iterator[list[int]] | None:
        """The numbers y C_q Mᵏ B_q x modulo ℓ, k < 2n, for each (q, x, y).

        None if not even one step of M is exact in floating point.
        """

        if not steps_at_once(M, self.ell, _EXACT):
            return None
        vectors = (
            (
                _symmetric(self._placed(y, self.outputs[q], self.outputs[-1]) @ self.C, self.ell),
                _symmetric(self.B @ self._placed(x, self.inputs[q], self.inputs[-1]), self.ell),
            )
            for q, x, y in starts
        )
        return (sequence(M, row, column, self.ell, 2 * self.n) for row, column in vectors)

    def _placed(self, entries: Sequence[int], start: int, size: int) -> Any:
        import numpy as np

        found = np.zeros(size, dtype=np.int64)
        found[start : start + len(entries)] = entries
        return found


def steps_at_once(M: Integers, ell: int, exact: int) -> int:
    """How many products with M keep residues below a number, so that a multiple of ℓ can go."""
    return products_at_once(int(abs(M).sum(axis=1).max()), ell, exact) if M.nnz else 1


def sequence(M: Integers, row: Any, column: Any, ell: int, length: int) -> list[int]:
    """The numbers c Mᵏ b modulo ℓ for k below a length, one product with M for each.

    Parameters
    ----------
    M : csr_array of symmetric residues
        `steps_at_once` is at least 1.
    row, column : arrays of symmetric residues
        c and b.
    """
    import numpy as np

    single = steps_at_once(M, ell, _EXACT_IN_SINGLE)
    kind, exact = (np.float32, _EXACT_IN_SINGLE) if single > 1 else (np.float64, _EXACT)
    step, steps = M.astype(kind), steps_at_once(M, ell, exact)
    step.indices, step.indptr = step.indices.astype(np.int32), step.indptr.astype(np.int32)
    where = np.flatnonzero(row)
    v: Any = column.astype(kind)
    found: list[int] = []
    for start in range(0, length, _TOGETHER):
        seen = np.empty((min(_TOGETHER, length - start), len(where)), dtype=np.int64)
        for k in range(len(seen)):
            seen[k] = v[where]
            v = step @ v
            if (start + k) % steps == steps - 1:
                v = reduce(v, ell)
        found += (seen % ell @ row[where] % ell).tolist()
    return found


def _residues(
    parts: Sequence[tuple[Matrix, int, int]], shape: tuple[int, int], ell: int
) -> Integers:
    """The symmetric residues of rational matrices, each placed at its first row and column."""
    import numpy as np
    import scipy.sparse

    found: list[tuple[int, int, int]] = []
    for M, top, left in parts:
        factor = pow(M.denominator, -1, ell)
        found += [(top + i, left + j, x * factor % ell) for i, j, x in M.nonzero()]
    table = np.array(found, dtype=np.int64).reshape(-1, 3)
    values = _symmetric(table[:, 2], ell)
    return scipy.sparse.csr_array((values, (table[:, 0], table[:, 1])), shape=shape)


def _symmetric(values: Any, ell: int) -> Any:
    """Integers less multiples of ℓ, between −ℓ/2 and ℓ/2."""
    return (values + ell // 2) % ell - ell // 2
