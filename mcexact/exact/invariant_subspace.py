"""The smallest A-invariant subspace that contains im B, exactly, from its residues."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass

from mcexact.errors import InternalError
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import ModularMatrix, primes, residues, vstack
from mcexact.exact.reconstruction import combine, rationals


@dataclass(frozen=True)
class InvariantSubspace:
    """⟨A | B⟩ = im B + A im B + …, as the column space of X.

    Attributes
    ----------
    X : Matrix
        n × d in reduced column echelon form: the rows ``pivots`` form the identity,
        AX = X (AX)[pivots] and B = X B[pivots].
    pivots : tuple of int
    modulus : int
        A prime ℓ modulo which [B, AB, …] has rank d, too.
    """

    X: Matrix
    pivots: tuple[int, ...]
    modulus: int

    @property
    def dimension(self) -> int:
        """d."""
        return len(self.pivots)

    @property
    def free(self) -> tuple[int, ...]:
        """The n − d rows that are not pivots."""
        chosen = set(self.pivots)
        return tuple(i for i in range(self.X.nrows) if i not in chosen)

    def annihilator(self) -> Matrix:
        """W, (n−d) × n with WX = 0, its columns ``free`` the identity."""
        n, free = self.X.nrows, self.free
        place = {pivot: k for k, pivot in enumerate(self.pivots)}
        rows = []
        for f in free:
            row = [0] * n
            for j in range(n):
                if j in place:
                    row[j] = -self.X.numerators[f][place[j]]
            row[f] = self.X.denominator
            rows.append(row)
        return Matrix.from_integers(rows, self.X.denominator, ncols=n)


def krylov_rows(A: Matrix, B: Matrix, ell: int) -> tuple[ModularMatrix, tuple[int, ...]]:
    """The reduced row echelon form of a basis of ⟨A | B⟩', modulo a prime.

    Parameters
    ----------
    A : Matrix
        n × n.
    B : Matrix
        n × p.
    ell : int
        A prime that divides neither denominator.

    Returns
    -------
    rows : ModularMatrix
        d × n; its columns ``pivots`` form the identity.
    pivots : tuple of int

    Notes
    -----
    With S' a basis of im [B, …, A^{k−1}B], [S, A^k S] spans the first 2k blocks: at most 1 + log₂ n
    products.  A doubling that adds nothing ends it.
    """
    n = A.nrows
    span, pivots = _row_space(residues(B.T, ell))
    power = residues(A.T, ell)
    while 0 < span.nrows < n:
        wider, found = _row_space(vstack([span, span @ power]))
        if wider.nrows == span.nrows:
            break
        span, pivots = wider, found
        if span.nrows < n:
            power = power @ power
    return span, pivots


def _row_space(rows: ModularMatrix) -> tuple[ModularMatrix, tuple[int, ...]]:
    """The nonzero rows of the reduced row echelon form, and its pivots."""
    reduced, pivots = rows.rref()
    return reduced.take(rows=range(len(pivots))), pivots


def _usable_primes(A: Matrix, B: Matrix, rng: random.Random) -> Iterator[int]:
    for ell in primes(rng.getrandbits(64)):
        if (A.denominator * B.denominator) % ell:
            yield ell


def controllable_subspace(A: Matrix, B: Matrix, rng: random.Random) -> InvariantSubspace:
    """Compute ⟨A | B⟩ exactly.

    Parameters
    ----------
    A : Matrix
        n × n.
    B : Matrix
        n × p.
    rng : random.Random
        Chooses the primes.

    Notes
    -----
    The reduced echelon form is one matrix over Q; its residues modulo word-size primes are
    combined until a rational matrix of the right pattern passes the exact test AX = X (AX)[pivots],
    B = X B[pivots].  The test makes im X an invariant subspace that contains im B; that its
    dimension is not too large is the rank modulo ℓ.  O(n³ log n) word operations for each prime.
    """
    n = A.nrows
    best: tuple[int, list[int]] = (-1, [])
    table: list[list[int]] = []
    modulus, last, count = 1, 0, 0
    for ell in _usable_primes(A, B, rng):
        span, pivots = krylov_rows(A, B, ell)
        if len(pivots) == n:
            return InvariantSubspace(Matrix.identity(n), tuple(range(n)), ell)
        if not pivots:
            if B.is_zero():
                return InvariantSubspace(Matrix.zeros(n, 0), (), ell)
            continue
        # Primes where the rank drops or the pivots move right are the bad ones.
        pattern = (len(pivots), [-j for j in pivots])
        if pattern < best:
            continue
        rows = span.rows()
        if pattern > best:
            best, table, modulus, count = pattern, [list(row) for row in rows], ell, 1
        else:
            table, modulus, count = combine(table, modulus, rows, ell), modulus * ell, count + 1
        last = ell
        if count & (count - 1) == 0:
            found = _verified(A, B, table, modulus, tuple(pivots))
            if found is not None:
                return InvariantSubspace(found, tuple(pivots), last)
    raise InternalError("the stream of primes is endless")


def _verified(
    A: Matrix, B: Matrix, table: list[list[int]], modulus: int, pivots: tuple[int, ...]
) -> Matrix | None:
    """The rational matrix with these residues, if im X is invariant and contains im B."""
    found = rationals(table, modulus)
    if found is None:
        return None
    X = Matrix.from_integers(found[0], found[1], ncols=A.nrows).T
    AX = A @ X
    if X @ AX.take(rows=pivots) != AX or X @ B.take(rows=pivots) != B:
        return None
    return X
