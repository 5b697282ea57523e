"""Whether every output can be held at any set-point; section III of the paper."""

from __future__ import annotations

import random
from functools import reduce
from typing import overload

from mcexact.analysis.structure.parametric_ranks import parametric_setpoints
from mcexact.answer.parametric_rank import ParametricRank
from mcexact.answer.setpoint import SetpointSolvability
from mcexact.derived.modular import generator
from mcexact.errors import InputError, InternalError
from mcexact.exact.linear_algebra import (
    PolynomialMatrix,
    characteristic_polynomial,
    left_nullspace,
    row_echelon,
)
from mcexact.exact.matrix import Matrix, block, hstack, vstack
from mcexact.exact.modular import primes, residues
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import steady_point
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem

_POINTS = 8
_MINORS = 3


@overload
def setpoint_solvability(system: MultiChannelSystem) -> SetpointSolvability: ...


@overload
def setpoint_solvability(system: ParametricSystem) -> ParametricRank: ...


def setpoint_solvability(
    system: MultiChannelSystem | ParametricSystem,
) -> SetpointSolvability | ParametricRank:
    """Decide whether linear time-invariant set-point control of all outputs is possible.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
        For a plant with one parameter the answer is the rank of [A, B; C, 0] (discrete time: A − I)
        for all values, and where it is less (`ParametricRank`): set-points are possible where it is
        n + Σ q_i.

    Notes
    -----
    Exact; paper, section III, equation (21).  The certificate for yes is a rank modulo a prime,
    that for no a matrix W with W S = 0.  A row (w_1, w_2) of W gives w_2 r = 0 for every
    equilibrium Ax + Bu = 0, r = Cx; w_2 = 0 only if the mode is not controllable.  An invariant
    zero is claimed only if the pencil has full rank somewhere; otherwise the certificate has a
    polynomial row that annihilates the pencil everywhere.  The paper's "no zero of the determinant
    at 0" is this condition unless 0 is an eigenvalue of A.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> plant = MultiChannelSystem([[-1, 0], [0, -2]], [[[1], [0]], [[0], [1]]], [[[1, 1]]] * 2)
    >>> found = setpoint_solvability(plant)
    >>> found.solvable, found.invariant_zero, found.combinations.numerators
    (False, False, ((-1, 1),))
    >>> wash = MultiChannelSystem([[0, 1], [-2, -3]], [[[0], [1]]], [[[0, 1]]])
    >>> setpoint_solvability(wash).invariant_zero
    True
    """
    if isinstance(system, ParametricSystem):
        return parametric_setpoints(system)
    InputError.require(system, MultiChannelSystem, "system")
    n, B, C = system.n, system.input_matrix(), system.output_matrix()
    place, unit, none = steady_point(system.time), Matrix.identity(n), Matrix.zeros
    lower = none(C.nrows, B.ncols)
    S = block([[system.A - unit * place, B], [C, lower]])
    M0 = block([[-system.A, B], [C, lower]])
    M1 = block([[unit, none(n, B.ncols)], [none(C.nrows, n), lower]])
    rng = generator(system, "setpoint")
    W, pivots = row_echelon(left_nullspace(S))
    rank = S.nrows - W.nrows
    modulus = _modulus(S, rank, rng)
    point, normal = None, None
    if W.nrows:
        point = _full_rank_point(M0, M1, modulus, rng)
        normal = None if point is not None else _annihilating_row(system, M0, M1, rng)
    zero = None if not W.nrows else point is not None
    return SetpointSolvability(
        system,
        solvable=not W.nrows,
        rank=rank,
        invariant_zero=zero,
        modulus=modulus,
        left=W,
        pivots=pivots,
        point=point,
        normal=normal,
    )


def _modulus(S: Matrix, rank: int, rng: random.Random) -> int:
    """A prime modulo which S keeps its rank."""
    for ell in primes(rng.getrandbits(64), bits=61):
        if S.denominator % ell and residues(S, ell).rank() == rank:
            return ell
    raise InternalError("the stream of primes is endless")


def _full_rank_point(M0: Matrix, M1: Matrix, modulus: int, rng: random.Random) -> int | None:
    """A place where M0 + x M1 has full row rank modulo the prime, or None if a few had not."""
    for _ in range(_POINTS):
        x = rng.randrange(2, 10**6)
        if residues(M0 + M1 * x, modulus).rank() == M0.nrows:
            return x
    return None


def _annihilating_row(
    system: MultiChannelSystem, M0: Matrix, M1: Matrix, rng: random.Random
) -> PolynomialMatrix:
    """A nonzero polynomial row w(x) with w(x) (M0 + x M1) = 0.

    Its degree is about n over the rank of the transfer matrix: where that rank is small the row
    comes from minors, else degree after degree from linear equations.
    """
    for ell in primes(rng.getrandbits(64), bits=61):
        if M0.denominator % ell:
            x = rng.randrange(2, 10**6)
            rank = residues(M0 + M1 * x, ell).rank() - system.n
            if rank > _MINORS:
                return _row_of_least_degree(M0, M1)
            found = _row_of_minors(system, x, ell)
            if found is not None and (found @ PolynomialMatrix.pencil(M0, M1)).is_zero():
                return found
    raise InternalError("the stream of primes is endless")


def _row_of_minors(system: MultiChannelSystem, x: int, ell: int) -> PolynomialMatrix | None:
    """(−w C adj(xI − A), w χ_A) without its common factor, w N = 0 for N = C adj(xI − A) B.

    The entries of w are minors of N; None if the rows of N look independent modulo the prime.
    """
    A, B, C = system.A, system.input_matrix(), system.output_matrix()
    chi = characteristic_polynomial(A)
    parts: list[Matrix] = []
    for c in reversed(chi.coefficients[1:]):
        parts.append(parts[-1] @ A + C * c if parts else C)
    adjugate = PolynomialMatrix.from_matrices(*(parts[::-1] or [C]))
    N = adjugate @ B
    if N.denominator % ell == 0:
        return None
    value = N.at_residue(x, ell)
    columns, rows = list(value.rref()[1]), list(value.T.rref()[1])
    extra = next((i for i in range(C.nrows) if i not in rows), None)
    if extra is None:
        return None
    chosen = [*rows, extra]
    table = [[N.entry(i, j) for j in columns] for i in chosen]
    w = [Polynomial.of()] * C.nrows
    for k, i in enumerate(chosen):
        minor = _minor([row for other, row in enumerate(table) if other != k])
        w[i] = -minor if k % 2 else minor
    row = PolynomialMatrix.from_polynomials([w])
    left = -(row @ adjugate)
    entries = [left.entry(0, j) for j in range(system.n)] + [p * chi for p in w]
    common = reduce(Polynomial.gcd, entries)
    return PolynomialMatrix.from_polynomials([[p // common for p in entries]])


def _minor(rows: list[list[Polynomial]]) -> Polynomial:
    """The determinant of a small matrix of polynomials, along its first row."""
    total = Polynomial.of() if rows else Polynomial.of(1)
    for j, p in enumerate(rows[0] if rows else ()):
        rest = [row[:j] + row[j + 1 :] for row in rows[1:]]
        total = total + p * _minor(rest) * (-1) ** j
    return total


def _row_of_least_degree(M0: Matrix, M1: Matrix) -> PolynomialMatrix:
    """Find an annihilating row of least degree, for pencils that have one of small degree.

    Σ w_k x^k annihilates iff w_0 M0 = 0, w_k M0 + w_{k−1} M1 = 0 and w_d M1 = 0.
    """
    rows, width = M0.shape
    for degree in range(rows + 1):
        blocks = []
        for k in range(degree + 1):
            parts = [Matrix.zeros(rows, width)] * (degree + 2)
            parts[k], parts[k + 1] = M0, M1
            blocks.append(hstack(parts))
        found = left_nullspace(vstack(blocks))
        if found.nrows:
            row = found.take(rows=[0])
            return PolynomialMatrix.from_matrices(
                *(row.take(cols=range(k * rows, (k + 1) * rows)) for k in range(degree + 1))
            )
    raise InternalError("a pencil without full row rank anywhere has no annihilating row")
