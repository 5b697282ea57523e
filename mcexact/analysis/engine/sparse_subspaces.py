"""Fixed factors of large sparse systems with shrunk subspaces, by products with sparse matrices.

With N = μI − A_F, m = (x − μ) g the minimal polynomial of A_F modulo a prime, and g(μ) ≠ 0,

    ker N = im g(A_F),      N x = b has the solution x = q(A_F) b / g(μ) or none,

where (x − μ) q = g − g(μ).  So the Wong sequence of `shrunk_subspace` takes n products with A_F for
each vector.  Its limit has a basis of few entries where the obstruction is local; it is lifted to
the rational numbers from residues modulo one prime, or several.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, islice
from typing import Any

from mcexact.analysis.engine.shrunk_subspace import ExactSubspace
from mcexact.analysis.engine.sparse_loops import (
    MOST_COLUMNS,
    MOST_PRIMES,
    DrawnLoop,
    drawn_loop,
    exact_primes,
)
from mcexact.derived.modular import generator
from mcexact.errors import InternalError, LimitReached
from mcexact.exact.krylov import row_echelon
from mcexact.exact.linear_algebra import PolynomialMatrix, rank, solve
from mcexact.exact.matrix import Matrix, from_cells
from mcexact.exact.modular import (
    ModularMatrix,
    ModularPolynomial,
    combine,
    polynomial_residues,
    rationals,
)
from mcexact.exact.polynomial import Polynomial, from_integer_coefficients
from mcexact.model.system import MultiChannelSystem

# One of n! primes splits a polynomial of degree n, mostly.
_MOST_DEGREE = 6
_SURE = 2**10


@dataclass(frozen=True)
class _Limit:
    """The limit of the Wong sequence at a point: T, and the rows of a basis in echelon form."""

    T: tuple[int, ...]
    basis: Any
    pivots: tuple[int, ...]

    @property
    def place(self) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """What the limits at all roots and primes have in common."""
        return self.T, self.pivots


def fixed_subspaces(system: MultiChannelSystem) -> tuple[tuple[Polynomial, ExactSubspace], ...]:
    """The irreducible factors that are fixed, each with a shrunk subspace of the least T.

    Parameters
    ----------
    system : MultiChannelSystem
        Its closed loops are sparse.

    Returns
    -------
    tuple of (Polynomial, ExactSubspace)
        Sorted by degree, then by coefficients.  Every factor is proved to be fixed, but nothing
        proves that these are all.

    Raises
    ------
    LimitReached
        A mode is fixed by a Jordan chain, or its factor has a high degree, or its subspace a high
        dimension or long entries.
    """
    rng = generator(system, "fixed_spectrum")
    moduli = exact_primes(system, rng)
    whole, loop = _common_factor(system, moduli, rng)
    found = []
    for p, often in whole.factor():
        if often > 1:
            raise LimitReached(f"the modes of {p} are fixed by Jordan chains of a large system")
        if p.degree > _MOST_DEGREE:
            raise LimitReached(f"a fixed factor of a large system has degree {p.degree}")
        fitting = (ell for ell in moduli if len(polynomial_residues(p, ell).roots()) == p.degree)
        loops = chain([loop], (drawn_loop(system, ell, rng) for ell in fitting))
        if len(polynomial_residues(p, loop.parts.ell).roots()) < p.degree:
            next(loops)
        found.append((p, _subspace(system, p, loops, rng)))
    return tuple(sorted(found, key=lambda each: (each[0].degree, each[0].coefficients)))


def _common_factor(
    system: MultiChannelSystem, moduli: Iterator[int], rng: random.Random
) -> tuple[Polynomial, DrawnLoop]:
    """The common divisor of the minimal polynomials of two loops, lifted to Q; and one of them."""
    residues: list[int] = []
    modulus = 1
    for ell in islice(moduli, MOST_PRIMES):
        first, second = (drawn_loop(system, ell, rng) for _ in range(2))
        common = first.polynomial.gcd(second.polynomial).coefficients
        if not residues or len(common) < len(residues):
            residues, modulus = list(common), ell
        elif len(common) == len(residues):
            [residues] = combine([residues], modulus, [common], ell)
            modulus *= ell
        lifted = rationals([residues], modulus)
        if lifted is not None:
            [numerators], d = lifted
            # few residues lift to numbers so short by accident
            if _SURE * max(*map(abs, numerators), d) ** 2 < modulus:
                return from_integer_coefficients(numerators, d), first
    raise LimitReached("the factors that are fixed have too long coefficients")


def _subspace(
    system: MultiChannelSystem, p: Polynomial, loops: Iterator[DrawnLoop], rng: random.Random
) -> ExactSubspace:
    """A shrunk subspace for an irreducible polynomial, from its residues where p has all roots."""
    known: tuple[_Limit, list[list[int]], int] | None = None
    for loop in islice(loops, MOST_PRIMES):
        ell, roots = loop.parts.ell, polynomial_residues(p, loop.parts.ell).roots()
        limits = [_limit(loop, mu, rng) for mu in roots]
        first = limits[0]
        if first is None or any(at is None or at.place != first.place for at in limits):
            continue
        layers = _interpolated([at.basis for at in limits if at], roots, ell)
        if known is not None and known[0].place == first.place:
            layers, ell = combine(known[1], known[2], layers, ell), known[2] * ell
        known = first, layers, ell
        lifted = rationals(layers, ell)
        found = None if lifted is None else _exact(system, p, first, *lifted)
        if found is not None:
            return found
    raise LimitReached(f"the subspace for {p} has too long entries")


def _limit(loop: DrawnLoop, mu: int, rng: random.Random) -> _Limit | None:
    """The limit of the Wong sequence at μ; None for gains that are not of greatest rank."""
    import numpy as np

    ell, powers, n = loop.parts.ell, loop.powers, loop.powers.n
    line = ModularPolynomial.from_coefficients([-mu, 1], ell)
    g = loop.polynomial // line
    if not g(mu):
        raise LimitReached("a mode of a large system is fixed by Jordan chains")
    size = 1
    while True:
        drawn = [[rng.randrange(ell) for _ in range(size)] for _ in range(n)]
        basis, _ = row_echelon(powers.applied(g, np.array(drawn)).T, ell)
        if len(basis) < size:
            break
        size *= 2
    # (x − μ) q = g − g(μ)
    q = (g - ModularPolynomial.from_coefficients([g(mu)], ell)) // line
    T: set[int] = set()
    new = _seen(loop, basis.T)
    while new:
        T |= new
        inputs = loop.parts.inputs
        columns = [j for i in sorted(new) for j in range(inputs[i], inputs[i + 1])]
        B = loop.parts.B[:, columns].toarray()
        if len(basis) + B.shape[1] > MOST_COLUMNS:
            raise LimitReached(f"a shrunk subspace has more than {MOST_COLUMNS} dimensions")
        X = powers.applied(q, B) * pow(g(mu), -1, ell) % ell
        if ((mu * X - powers.product(X) - B) % ell).any():
            return None
        basis = np.vstack([basis, X.T])
        new = _seen(loop, X) - T
    return _Limit(tuple(sorted(T)), *row_echelon(basis, ell))


def _seen(loop: DrawnLoop, X: Any) -> set[int]:
    """The channels whose outputs are not all 0 on the columns of X."""
    outputs, found = loop.parts.outputs, (loop.parts.C @ X % loop.parts.ell).any(axis=1)
    return {i for i in range(len(outputs) - 1) if found[outputs[i] : outputs[i + 1]].any()}


def _interpolated(values: Sequence[Any], roots: Sequence[int], ell: int) -> list[list[int]]:
    """The rows of U_0', U_1', …, one after the other, with Σ μ^t U_t the value at each root."""
    inverse = ModularMatrix.from_rows(
        [[pow(mu, t, ell) for t in range(len(roots))] for mu in roots], ell
    ).inverse()
    if inverse is None:
        raise InternalError("different roots have an invertible Vandermonde matrix")
    rows: list[list[int]] = []
    for weights in inverse.rows():
        layer = sum(w * value % ell for w, value in zip(weights, values, strict=True)) % ell
        rows += layer.tolist()
    return rows


def _exact(
    system: MultiChannelSystem,
    p: Polynomial,
    at: _Limit,
    numerators: list[list[int]],
    denominator: int,
) -> ExactSubspace | None:
    """The subspace over Q with these columns, if it is one."""
    n, u, k = system.n, len(at.pivots), p.degree
    B, rest = system.input_matrix(at.T), [i for i in range(system.m) if i not in set(at.T)]
    U = [_columns(numerators[t * u : (t + 1) * u], n, denominator) for t in range(k)]
    lost = u - rank(_nonzero_rows(B)[1])
    if lost < 1 or any(not (system.output_matrix(rest) @ M).is_zero() for M in U):
        return None
    V = []
    for t, M in enumerate(U):
        image = -(system.A @ M) - U[-1] * p.coefficients[t]
        V.append(_solution(B, image + U[t - 1] if t else image))
    if any(M is None for M in V):
        return None
    return ExactSubspace(
        channels_T=at.T,
        U=PolynomialMatrix.from_matrices(*U),
        V=PolynomialMatrix.from_matrices(*(M for M in V if M is not None)),
        pivots=at.pivots,
        deficiency=lost,
    )


def _columns(columns: Sequence[Sequence[int]], n: int, denominator: int) -> Matrix:
    """The matrix with these columns over a denominator."""
    size = len(columns)
    cells = sorted(
        (i * size + j, x) for j, column in enumerate(columns) for i, x in enumerate(column) if x
    )
    places, values = [cell for cell, _ in cells], [x for _, x in cells]
    return from_cells((n, size), places, values, denominator)


def _nonzero_rows(M: Matrix) -> tuple[list[int], Matrix]:
    """The rows of a sparse matrix that are not 0, and their numbers."""
    rows = sorted({i for i, _, _ in M.nonzero()})
    return rows, M.take(rows=rows)


def _solution(B: Matrix, right: Matrix) -> Matrix | None:
    """The V with B V = right, 0 in the rows of columns that depend on others; None without one."""
    rows, kept = _nonzero_rows(B)
    found = solve(kept, right.take(rows=rows))
    return found if found is not None and (B @ found - right).is_zero() else None
