"""Polynomials of a sparse matrix modulo a prime, applied to vectors in exact floating point."""

from __future__ import annotations

import random
from math import isqrt
from typing import TYPE_CHECKING, Any

from mcexact.exact.krylov import reduce
from mcexact.exact.modular_polynomial import ModularPolynomial
from mcexact.exact.recurrence import least_recurrence

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Floats = npt.NDArray[np.floating[Any]]
    Residues = npt.NDArray[np.int64]

_EXACT = 2**53


class SparsePowers:
    """An n × n sparse array M of symmetric residues modulo ℓ.

    Parameters
    ----------
    M : csr_array of int64
    ell : int
        A prime for which `largest_prime` is not exceeded.
    """

    def __init__(self, M: Any, ell: int) -> None:
        import numpy as np

        self.M, self.ell, self.n = M.astype(np.float64), ell, M.shape[0]

    def applied(self, p: ModularPolynomial, V: Any) -> Residues:
        """p(M) V modulo ℓ, V n × k residues, by Horner's rule."""
        import numpy as np

        V = reduce(np.array(V, dtype=np.float64), self.ell)
        found: Floats = np.zeros_like(V)
        for c in reversed(p.coefficients):
            factor = c - self.ell if 2 * c > self.ell else c
            found = reduce(self.M @ found + factor * V, self.ell)
        return self._residues(found)

    def product(self, V: Any) -> Residues:
        """M V modulo ℓ, V n × k residues."""
        import numpy as np

        return self._residues(reduce(self.M @ reduce(V.astype(np.float64), self.ell), self.ell))

    def _residues(self, table: Floats) -> Residues:
        import numpy as np

        found: Residues = table.astype(np.int64) % self.ell
        return found

    def minimal_polynomial(self, rng: random.Random) -> ModularPolynomial:
        """The least recurrence of the numbers c Mᵏ b, c and b drawn: a divisor, and mostly all."""
        import numpy as np

        small = max(1, _EXACT // (max(self.n, 1) * self.ell))
        row = np.array([rng.randrange(small) for _ in range(self.n)], dtype=np.float64)
        drawn = np.array([rng.randrange(self.ell) for _ in range(self.n)], dtype=np.float64)
        v: Floats = reduce(drawn, self.ell)
        numbers = []
        for _ in range(2 * self.n):
            numbers.append(int(row @ v) % self.ell)
            v = reduce(self.M @ v, self.ell)
        return least_recurrence(numbers, self.ell)


def row_echelon(rows: Residues, ell: int) -> tuple[Residues, tuple[int, ...]]:
    """The reduced row echelon form of residues, without rows of zeros, and its pivots."""
    import numpy as np

    left, pivots = np.array(rows, dtype=np.int64) % ell, []
    found = 0
    while found < len(left):
        columns = np.flatnonzero(left[found:].any(axis=0))
        if not len(columns):
            break
        column = int(columns[0])
        at = found + int(np.flatnonzero(left[found:, column])[0])
        left[[found, at]] = left[[at, found]]
        left[found] = left[found] * pow(int(left[found, column]), -1, ell) % ell
        for i in range(len(left)):
            if i != found and left[i, column]:
                left[i] = (left[i] - left[i, column] * left[found]) % ell
        pivots.append(column)
        found += 1
    return left[:found], tuple(pivots)


def largest_prime(n: int, terms: int) -> int:
    """A bound for primes modulo which all sums are exact: of so many products and one more.

    Examples
    --------
    >>> largest_prime(10**4, 8).bit_length()
    26
    """
    return min(2**26, 2 * isqrt(_EXACT // (terms + 2)) - 8, 2**52 // max(n, 1))
