"""What the fixed spectrum is measured against, each as strong as it could be written.

- ``heuristic``: what practice does in floating point: the eigenvalues of A and of one drawn closed
  loop, matched.  Not rigorous.
- ``pencil_enumeration``: the rank of every pencil P_s modulo a word-size prime at a root of each
  irreducible factor of χ_A, over Q[x]/(p) only where it drops.  Rigorous.
- ``reduced_enumeration``: the same, with λI − A eliminated once for each factor, so that only a
  block as wide as the channels is left for every subset.  Rigorous, and faster.
"""

from __future__ import annotations

from typing import Any

import flint
import numpy as np

from mcexact.exact.linear_algebra import PolynomialMatrix, characteristic_polynomial
from mcexact.exact.linear_algebra import field_rank as rank_over_field
from mcexact.exact.matrix import Matrix, hstack, vstack
from mcexact.exact.modular import polynomial_residues, primes, residues
from mcexact.exact.polynomial import Polynomial
from mcexact.model.system import MultiChannelSystem

Found = dict[Polynomial, int]
"""The fixed irreducible factors and the least rank of their pencils."""


def arrays(system: MultiChannelSystem) -> tuple[Any, Any, Any, list[tuple[int, int]]]:
    """A, B, C as numpy arrays of integers, and the widths (p_i, q_i)."""
    n = system.n
    A = np.array(system.A.numerators, dtype=np.int64).reshape(n, n)
    B = np.array(system.input_matrix().numerators, dtype=np.int64).reshape(n, -1)
    C = np.array(system.output_matrix().numerators, dtype=np.int64).reshape(-1, n)
    return A, B, C, [(system.p(i), system.q(i)) for i in range(system.m)]


def heuristic(A: Any, B: Any, C: Any, widths: list[tuple[int, int]], seed: int) -> int:
    """The number of eigenvalues of A that a drawn closed loop keeps, to 8 digits."""
    rng = np.random.default_rng(seed)
    F = np.zeros((B.shape[1], C.shape[0]))
    row = column = 0
    for p, q in widths:
        F[row : row + p, column : column + q] = rng.standard_normal((p, q))
        row, column = row + p, column + q
    before = np.linalg.eigvals(A.astype(np.float64))
    after = np.linalg.eigvals(A + B @ F @ C)
    scale = max(1.0, float(np.max(np.abs(before), initial=0.0)))
    gaps = np.abs(before[:, None] - after[None, :]).min(axis=1)
    return int(np.count_nonzero(gaps < 1e-8 * scale))


def pencil_enumeration(system: MultiChannelSystem, seed: int) -> Found:
    """Every pencil of every subset, as the definition has it."""
    found: Found = {}
    n, m = system.n, system.m
    for p, ell, mu in _points(system, seed):
        N = [[int(v) for v in row] for row in residues(_shifted(system, mu), ell).rows()]
        B = [residues(system.B(i), ell).rows() for i in range(m)]
        C = [list(residues(system.C(i), ell).rows()) for i in range(m)]
        for subset in range(1 << m):
            inside = [i for i in range(m) if subset >> i & 1]
            outside = [i for i in range(m) if not subset >> i & 1]
            width = n + sum(system.p(i) for i in outside)
            entries: list[int] = []
            for r in range(n):
                entries += N[r]
                for i in outside:
                    entries += B[i][r]
            rows = n
            padding = [0] * (width - n)
            for i in inside:
                for row in C[i]:
                    entries += row
                    entries += padding
                    rows += 1
            rank = int(flint.nmod_mat(rows, width, entries, ell).rank())
            if rank < n:
                _record(found, system, p, inside)
    return found


def reduced_enumeration(system: MultiChannelSystem, seed: int) -> Found:
    """The same with λI − A brought to diag(I, 0) once: only a small block is left to rank.

    With X N Y = diag(I_r, 0), X B = [B'; B''] and C Y = [C', C''], the rank of P_s is r plus that
    of [0, B''_{m−s}; C''_s, −C'_s B'_{m−s}].
    """
    found: Found = {}
    n, m = system.n, system.m
    for p, ell, mu in _points(system, seed):
        N = residues(_shifted(system, mu), ell)._table
        left, right, r = _normal_form(N, n, ell)
        B = left * residues(system.input_matrix(), ell)._table
        C = residues(system.output_matrix(), ell)._table * right
        P, Q, d = B.ncols(), C.nrows(), n - r
        BB = [[int(B[i, j]) for j in range(P)] for i in range(n)]
        CC = [[int(C[i, j]) for j in range(n)] for i in range(Q)]
        low, high = BB[r:], [row[r:] for row in CC]
        inner = [
            [-sum(CC[i][k] * BB[k][j] for k in range(r)) % ell for j in range(P)] for i in range(Q)
        ]
        inputs, outputs = _ranges(system)
        for subset in range(1 << m):
            inside = [i for i in range(m) if subset >> i & 1]
            rows = [k for i in inside for k in outputs[i]]
            cols = [k for i in range(m) if not subset >> i & 1 for k in inputs[i]]
            entries = []
            zeros = [0] * d
            for row in low:
                entries += zeros
                entries += [row[k] for k in cols]
            for i in rows:
                entries += high[i]
                line = inner[i]
                entries += [line[k] for k in cols]
            small = flint.nmod_mat(d + len(rows), d + len(cols), entries, ell)
            if r + int(small.rank()) < n:
                _record(found, system, p, inside)
    return found


def _points(system: MultiChannelSystem, seed: int) -> list[tuple[Polynomial, int, int]]:
    """For each irreducible factor of χ_A a prime and a root of the factor modulo it."""
    points = []
    for p, _ in characteristic_polynomial(system.A).factor():
        for ell in primes(seed):
            roots = polynomial_residues(p, ell).roots()
            if roots:
                points.append((p, ell, min(roots)))
                break
    return points


def _shifted(system: MultiChannelSystem, mu: int) -> Matrix:
    return Matrix.identity(system.n) * mu - system.A


def _ranges(system: MultiChannelSystem) -> tuple[list[range], list[range]]:
    inputs, outputs, p, q = [], [], 0, 0
    for i in range(system.m):
        inputs.append(range(p, p + system.p(i)))
        outputs.append(range(q, q + system.q(i)))
        p, q = p + system.p(i), q + system.q(i)
    return inputs, outputs


def _normal_form(N: flint.nmod_mat, n: int, ell: int) -> tuple[Any, Any, int]:
    """X, Y and r with X N Y = diag(I_r, 0)."""
    wide = flint.nmod_mat(n, 2 * n, ell)
    for i in range(n):
        for j in range(n):
            wide[i, j] = N[i, j]
        wide[i, n + i] = 1
    reduced, _ = wide.rref()
    rows = [[int(reduced[i, j]) for j in range(2 * n)] for i in range(n)]
    pivots = [next((j for j in range(n) if row[j]), None) for row in rows]
    bound = [j for j in pivots if j is not None]
    free = [j for j in range(n) if j not in bound]
    Y = flint.nmod_mat(n, n, ell)
    for k, j in enumerate(bound):
        Y[j, k] = 1
    for k, j in enumerate(free, start=len(bound)):
        Y[j, k] = 1
        for i, b in enumerate(bound):
            Y[b, k] = -rows[i][j] % ell
    X = flint.nmod_mat(n, n, [v for row in rows for v in row[n:]], ell)
    return X, Y, len(bound)


def _record(found: Found, system: MultiChannelSystem, p: Polynomial, inside: list[int]) -> None:
    """Decide the rank over Q[x]/(p), and keep the least one below n."""
    n = system.n
    outside = [i for i in range(system.m) if i not in inside]
    B, C = system.input_matrix(outside), system.output_matrix(inside)
    constant = vstack([hstack([-system.A, B]), hstack([C, Matrix.zeros(C.nrows, B.ncols)])])
    rows = [[int(i == j and i < n) for j in range(n + B.ncols)] for i in range(n + C.nrows)]
    shift = Matrix.from_integers(rows, ncols=n + B.ncols)
    rank = rank_over_field(PolynomialMatrix.pencil(constant, shift), p)
    if rank < n:
        found[p] = min(rank, found.get(p, n))
