"""Exact plants near a suspected one, with the same zeros, at which a pencil loses rank.

`Target` is a pencil λE − Z, Z = [A, B_T; C_s, 0], that is to have rank n − 1.  The smallest change
of its entries, in units that the data allow, is looked for in floating
point, and is then made exact.

1. `approached` (Gauss and Newton).  With L and R about the left and right null spaces,
   Lᴴ (λE − Z − Δ) R = 0 is linear in Δ and λ, and the least Δ in its units is a least-squares
   problem with (q_s + 1)(p_T + 1) equations.
2. `corrected`.  The null space R and λ are rounded to short numbers K and Λ, E K Λ being what Z K
   should be; for a pair of complex modes K has the real and the imaginary part, and Λ is a real
   matrix of two rows.  Then each row of Δ K = E K Λ − Z K is solved exactly by itself.  A row that
   has too few entries to change, such as x' = v, determines a row of K instead: this is elimination
   over the field Q[Λ].  The same is done with columns in place of rows where their null space is
   smaller.

What comes out is exact, and `pencil_rank` decides that the rank is below n.  That no plant is found
proves nothing.

The units of entries are those of `allowances`.  Zeros do not change, and integers change only where
nothing is found otherwise.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from mcexact.analysis.nearby.allowances import in_floats
from mcexact.exact.linear_algebra import inverse
from mcexact.exact.matrix import Matrix, block, hstack, matrix_to_float, vstack
from mcexact.exact.polynomial import Polynomial
from mcexact.model.system import MultiChannelSystem

Floats = Any

# Pencils, and plants with a change of the matrix of a pencil.


def pencil_matrix(A: Matrix, B: list[Matrix], C: list[Matrix]) -> Matrix:
    """[A, B_T; C_s, 0], T the complement of s: λE minus this has the rank of P_s(λ)."""
    n = A.nrows
    top, low = hstack([A, *B], nrows=n), vstack(C, ncols=n)
    return vstack([top, hstack([low, Matrix.zeros(low.nrows, top.ncols - n)])])


def changed(system: MultiChannelSystem, s: tuple[int, ...], change: Matrix) -> MultiChannelSystem:
    """The plant with a change of the matrix of the pencil of s."""
    n, column, row = system.n, system.n, system.n
    B, C = list(system.B), list(system.C)
    for i in range(system.m):
        if i in s:
            C[i] = C[i] + change.take(range(row, row + system.q(i)), range(n))
            row += system.q(i)
        else:
            B[i] = B[i] + change.take(range(n), range(column, column + system.p(i)))
            column += system.p(i)
    return MultiChannelSystem(
        system.A + change.take(range(n), range(n)),
        B,
        C,
        time=system.time,
        names=system.names,
        neighbors=system.neighbors,
    )


@dataclass(frozen=True, eq=False)
class Target:
    """A pencil λE − Z that is to have rank n − 1, its first n rows and columns those of E = I.

    Attributes
    ----------
    Z : Matrix
    n : int
    entries : mapping of (int, int) to Fraction
        The entries that are not 0.
    allowed : mapping of (int, int) to Fraction
        What these may be changed by, as a unit; 0 of those that do not change.
    rows, columns : ndarray of int
        Exponents of 2: a row times 2^rows and a column times 2^columns is balanced.
    time : int
        The balanced λ is 2^−time λ.
    """

    Z: Matrix
    n: int
    entries: dict[tuple[int, int], Fraction]
    allowed: dict[tuple[int, int], Fraction]
    rows: Floats
    columns: Floats
    time: int

    def transposed(self) -> Target:
        """The same for the columns; the exponent of time moves from the rows to the columns."""
        flip = {(j, i): x for (i, j), x in self.entries.items()}
        units = {(j, i): x for (i, j), x in self.allowed.items()}
        return Target(self.Z.T, self.n, flip, units, self.columns, self.rows, self.time)

    @property
    def wanted(self) -> int:
        """The dimension of the null space of columns that rank n − 1 leaves."""
        return self.Z.ncols - self.n + 1

    def balanced(self) -> tuple[Floats, Floats]:
        """Z and the units of its entries in floating point, in balanced units."""
        Z, D = np.zeros(self.Z.shape), np.zeros(self.Z.shape)
        for (i, j), x in self.entries.items():
            shift = int(self.rows[i] + self.columns[j])
            Z[i, j] = math.ldexp(in_floats(x), shift)
            D[i, j] = math.ldexp(in_floats(self.allowed[i, j]), shift)
        return Z, D


# The smallest change in floating point.

_STEPS = 8
_LARGEST_PROGRAM = 4_000_000
_NOISE = 1e-14


@dataclass(frozen=True)
class Approach:
    """A change in floating point with which the pencil loses rank, in balanced units.

    Attributes
    ----------
    size : float
        The largest |Δ_ij| in its unit; infinite if it is not known.
    part : float
        The largest |Δ_ij / Z_ij|.
    point : complex
        λ.
    change : ndarray
    factors : (ndarray, ndarray, ndarray)
        The singular value decomposition of the changed pencil at λ.
    """

    size: float
    part: float
    point: complex
    change: Floats
    factors: tuple[Floats, Floats, Floats]


def approached(target: Target, point: complex) -> Approach | None:
    """Let the pencil lose rank near a point by a change that is small in the units of entries."""
    Z, D = target.balanced()
    n, wanted, other = target.n, target.wanted, target.Z.nrows - target.n + 1
    I, J = np.nonzero(D)
    E = np.zeros(Z.shape)
    E[:n, :n] = np.eye(n)
    change, size = np.zeros(Z.shape), 0.0
    units = D[I, J]
    real = not point.imag
    solvable = len(I) and len(I) * wanted * other * (1 if real else 2) <= _LARGEST_PROGRAM
    for step in range(_STEPS if solvable else 1):
        P = (point.real if real else point) * E - Z - change
        U, sizes, Vh = np.linalg.svd(P)
        R, L = Vh[-wanted:].conj().T, U[:, -other:]
        if not solvable:
            return Approach(math.inf, 0.0, point, change, (U, sizes, Vh))
        small = sizes[n - 1] if n - 1 < len(sizes) else 0.0
        if step and (small <= 1e-15 * sizes[0] or step == _STEPS - 1):
            largest = float(np.abs(change[I, J] / Z[I, J]).max())
            return Approach(size, largest, point, change, (U, sizes, Vh))
        base = L.conj().T @ (P + change) @ R
        solution = _step(L, R, n, (I, J, units), base, real, _NOISE * float(sizes[0]))
        if solution is None:
            return None
        part, steps = solution
        point += complex(*steps)
        change = np.zeros(Z.shape)
        change[I, J] = part * units
        size = float(np.abs(part).max(initial=0.0))
        if not math.isfinite(size) or abs(point) > 1e12:
            return None
    return None


def _step(
    L: Floats, R: Floats, n: int, entries: Any, base: Floats, real: bool, noise: float
) -> tuple[Floats, list[float]] | None:
    """The least Δ, in units, with Lᴴ (P + y E − Δ) R = 0 for some y, and y; Lᴴ P R is known."""
    I, J, units = entries
    terms = np.einsum("ka,kb->kab", L[I].conj() * units[:, None], R[J]).reshape(len(I), -1).T
    along = (L[:n].conj().T @ R[:n]).ravel()[:, None]
    right = base.ravel()
    if real:
        terms, along, right = terms.real, along.real, right.real
    else:
        along = np.hstack([along, 1j * along])
        terms, along, right = (np.concatenate([M.real, M.imag]) for M in (terms, along, right))
    U, sizes, _ = np.linalg.svd(along)
    moves = int((sizes > 1e-12 * max(float(np.abs(along).max()), 1e-300)).sum())
    across = U[:, moves:].T
    part = _least(across @ terms, across @ right, noise)
    if part is None:
        return None
    steps = np.linalg.lstsq(along, terms @ part - right, rcond=1e-12)[0] if moves else [0.0]
    return part, [float(y) for y in steps]


def _least(system: Floats, right: Floats, noise: float = 0.0) -> Floats | None:
    """The least solution of equations of full or smaller rank; None if there is none."""
    if not len(right):
        return np.zeros(system.shape[1])
    lengths = np.maximum(np.linalg.norm(system, axis=1), 1e-300)
    reach = np.maximum(1e-6 * float(np.abs(right).max()), noise) / lengths
    system, right = system / lengths[:, None], right / lengths
    if not (np.isfinite(system).all() and np.isfinite(right).all()):
        return None
    gram = system @ system.T
    values, vectors = np.linalg.eigh(gram)
    kept = values > 1e-13 * values[-1]
    solution = system.T @ (vectors[:, kept] @ ((vectors[:, kept].T @ right) / values[kept]))
    return solution if (np.abs(system @ solution - right) <= reach).all() else None


# The same with exact residuals, so that rounding errors of the search do not matter.

_REFINEMENTS = 2


@dataclass(frozen=True)
class Refined:
    """λ and the null space to more digits than floats have.

    Attributes
    ----------
    K : Matrix
        The null space; of a complex mode the real parts and then the imaginary parts.
    L : list of lists of Fraction
        [λ I], or [[a I, b I], [−b I, a I]] of λ = a + bi: Z K is about E K L.
    width : int
        The dimension of the null space.
    point : complex
        λ in balanced units.
    change : ndarray
    """

    K: Matrix
    L: list[list[Fraction]]
    width: int
    point: complex
    change: Floats


def refined(target: Target, near: Approach) -> Refined:
    """Improve an approach by steps of Newton with residuals that are computed exactly."""
    (U, sizes, Vh), n, wanted = near.factors, target.n, target.wanted
    R, left = Vh[-wanted:].conj().T, U[:, n - 1 :]
    real = not near.point.imag
    _, D = target.balanced()
    I, J = np.nonzero(D)
    units = D[I, J]
    best = _State.of(target, near)
    for _ in range(_REFINEMENTS if math.isfinite(near.size) else 0):
        G = best.residual
        noise = 1e-10 * float(np.abs(G).max(initial=0.0))
        step = _step(left, R, n, (I, J, units), left.conj().T @ G, real, noise)
        if step is None:
            break
        change = np.zeros(D.shape)
        change[I, J] = step[0] * units
        rest = G - change @ R
        rest[:n] += (step[1][0] if real else complex(*step[1])) * R[:n]
        slope = U[:, : n - 1].conj().T @ rest / sizes[: n - 1, None]
        moved = best.moved(-Vh[: n - 1].conj().T @ slope, step[1], change)
        if not moved.rest(R) < best.rest(R) / 2:
            break
        best = moved
    return best.refined


@dataclass(frozen=True, eq=False)
class _State:
    """λ = a + bi and K in balanced units, exact, and the change of the entries for them."""

    target: Target
    K: list[list[Fraction]]
    a: Fraction
    b: Fraction
    width: int
    change: Floats

    @classmethod
    def of(cls, target: Target, near: Approach) -> _State:
        R = near.factors[2][-target.wanted :].conj().T
        parts = [R.real, R.imag] if near.point.imag else [R.real]
        K = [[Fraction(x) for x in row] for row in np.hstack(parts).tolist()]
        a, b = Fraction(near.point.real), Fraction(near.point.imag)
        return cls(target, K, a, b, R.shape[1], near.change)

    def moved(self, slope: Floats, steps: list[float], change: Floats) -> _State:
        """Move K and λ."""
        parts = [slope.real, slope.imag] if self.b else [slope.real]
        K = [
            [x + Fraction(y) for x, y in zip(*both, strict=True)]
            for both in zip(self.K, np.hstack(parts).tolist(), strict=True)
        ]
        b = self.b + Fraction(steps[1]) if self.b else self.b
        return replace(self, K=K, a=self.a + Fraction(steps[0]), b=b, change=change)

    @cached_property
    def refined(self) -> Refined:
        """The same in the units of the plant."""
        exponents = [int(e) for e in self.target.columns]
        K = [[x * _power(e) for x in row] for row, e in zip(self.K, exponents, strict=True)]
        time = _power(self.target.time)
        L = _turn(self.a * time, self.b * time, self.width)
        point = complex(self.a, self.b)
        return Refined(Matrix.from_rows(K), L, self.width, point, self.change)

    @cached_property
    def residual(self) -> Floats:
        """(λE − Z) K, computed exactly, in balanced units."""
        target, K = self.target, self.refined.K
        moved = K.take(rows=range(target.n)) @ Matrix.from_rows(self.refined.L)
        moved = vstack([moved, Matrix.zeros(target.Z.nrows - target.n, moved.ncols)])
        scales = [_power(int(e)) for e in target.rows]
        rest = zip((moved - target.Z @ K).rows(), scales, strict=True)
        G = np.array([[in_floats(x * scale) for x in row] for row, scale in rest])
        G = G.reshape(target.Z.nrows, K.ncols)
        return G[:, : self.width] + 1j * G[:, self.width :] if self.b else G

    def rest(self, R: Floats) -> float:
        """How far the change is from making the residual 0."""
        return float(np.abs(self.residual - self.change @ R).max(initial=0.0))


def _turn(a: Fraction, b: Fraction, width: int) -> list[list[Fraction]]:
    """[a I], or [[a I, b I], [−b I, a I]] if b is not 0."""
    size = width if not b else 2 * width
    rows = [[Fraction(0)] * size for _ in range(size)]
    for k in range(size):
        rows[k][k] = a
        if b:
            rows[k][(k + width) % size] = b if k < width else -b
    return rows


# The exact change.

_LONG, _LONGEST = 60, 120
"""Bits behind the point of numbers that are no short fractions, in balanced units."""
_SHORT = 1000
_ROUGH = 30
_PASSES = 12
_ZERO = Fraction(0)
Coefficient = tuple[Fraction, Fraction]
"""a + bΛ, an element of the field Q[Λ]; b = 0 for a rational mode."""


@dataclass(frozen=True)
class Correction:
    """An exact change with which the pencil loses rank at the roots of a polynomial.

    Attributes
    ----------
    change : mapping of (int, int) to Fraction
    polynomial : Polynomial
    kernel : tuple of tuples of Fraction
        The rows of K, which (Z + Δ) maps to E K Λ.
    """

    change: dict[tuple[int, int], Fraction]
    polynomial: Polynomial
    kernel: tuple[tuple[Fraction, ...], ...]


class Failed(Exception):
    """The search for an exact change ends here."""


def corrected(target: Target, near: Refined, tolerance: float) -> Correction | None:
    """Make a change exact, with numbers as short as a tolerance admits; None if that fails.

    Parameters
    ----------
    target : Target
    near : Refined
    tolerance : float
        By what part of its size each number of K and Λ may be rounded to a short fraction; with 0
        none is, and they are longer.
    """
    try:
        basis = _Basis.of(target, near, tolerance)
        return _Rows(target, near, basis).solved()
    except (Failed, ZeroDivisionError, OverflowError, np.linalg.LinAlgError):
        return None


@dataclass
class _Basis:
    """K and Λ, exact; K has the identity in its rows `pivots`.

    Attributes
    ----------
    K : list of lists of Fraction
    L : list of lists of Fraction
        Λ.
    pivots : list of int
    sizes : ndarray
        About the sizes of the entries of K.
    """

    K: list[list[Fraction]]
    L: list[list[Fraction]]
    pivots: list[int]
    sizes: Floats

    @classmethod
    def of(cls, target: Target, near: Refined, tolerance: float) -> _Basis:
        """Round the null space and the mode; `Failed` if the rows cannot be told apart."""
        K, L, width = near.K, near.L, near.width
        floats = matrix_to_float(K)
        if len(L) == 2 and width == 1:
            pivots = _pivots(floats)
            S = K.take(rows=pivots)
        elif len(L) > width:
            pivots = _pivots(floats[:, :width] + 1j * floats[:, width:])
            top = K.take(rows=pivots)
            x, y = top.take(cols=range(width)), top.take(cols=range(width, 2 * width))
            S = block([[x, y], [-y, x]])
        else:
            pivots = _pivots(floats)
            S = K.take(rows=pivots)
        S_inverse = inverse(S)
        if S_inverse is None:
            raise Failed
        unit = np.array(pivots * (K.ncols // len(pivots)))
        exponents = target.columns[:, None] - target.columns[unit][None, :]
        sizes = np.ldexp(1.0, exponents.astype(int))
        rows = [
            [_short(x, int(e), tolerance) for x, e in zip(values, shifts, strict=True)]
            for values, shifts in zip((K @ S_inverse).rows(), exponents.tolist(), strict=True)
        ]
        for c, j in enumerate(pivots):
            rows[j] = [Fraction(int(k == c)) for k in range(K.ncols)]
        across = target.time + target.columns[unit][:, None] - target.columns[unit][None, :]
        level = max(0, math.frexp(abs(near.point))[1])
        turn = S @ Matrix.from_rows(L) @ S_inverse
        rounded = [
            [_short(x, int(e) + level, tolerance) for x, e in zip(values, shifts, strict=True)]
            for values, shifts in zip(turn.rows(), across.tolist(), strict=True)
        ]
        return cls(rows, rounded, pivots, sizes)

    @property
    def polynomial(self) -> Polynomial:
        """The polynomial of Λ, irreducible."""
        L = self.L
        if all(L[i][j] == 0 for i in range(len(L)) for j in range(len(L)) if i != j):
            if len({L[i][i] for i in range(len(L))}) != 1:
                raise Failed
            return Polynomial.from_roots([L[0][0]])
        half = len(L) // 2
        a, b, c, d = L[0][0], L[0][half], L[half][0], L[half][half]
        trace, determinant = a + d, a * d - b * c
        if trace * trace >= 4 * determinant:
            raise Failed
        return Polynomial.from_coefficients([determinant, -trace, 1])

    def times(self, row: list[Fraction], by: Coefficient) -> list[Fraction]:
        """A row of K times a + bΛ."""
        a, b = by
        if not b:
            return [a * x for x in row]
        L = self.L
        turned = [sum((x * L[k][c] for k, x in enumerate(row) if x), _ZERO) for c in range(len(L))]
        return [a * x + b * y for x, y in zip(row, turned, strict=True)]


def _pivots(R: Floats) -> list[int]:
    """Rows in which combinations of the columns of R can be the identity, by complete pivoting."""
    rest, pivots = R.copy(), []
    for c in range(R.shape[1]):
        i, k = divmod(int(np.argmax(np.abs(rest[:, c:]))), R.shape[1] - c)
        k += c
        if abs(rest[i, k]) < 1e-9:
            raise Failed
        rest[:, [c, k]] = rest[:, [k, c]]
        pivots.append(i)
        others = rest[i, :] / rest[i, c]
        others[c] = 0
        rest = rest - np.outer(rest[:, c], others)
    return pivots


def _short(x: Fraction, size: int, tolerance: float) -> Fraction:
    """A short number within a part of 2^size of x: a fraction, or a multiple of 2^(size − bits).

    Tolerance 0 takes the most bits: a null space may have tiny entries that count.
    """
    reach = Fraction(tolerance) * _power(size)
    if abs(x) <= reach:
        return _ZERO
    bits = _LONG if tolerance else _LONGEST
    rough = Fraction(round(x * _power(bits - size))) * _power(size - bits)
    simple = rough.limit_denominator(_SHORT)
    return simple if simple and abs(simple - x) <= reach else rough


def _power(exponent: int) -> Fraction:
    return Fraction(1 << exponent) if exponent >= 0 else Fraction(1, 1 << -exponent)


class _Rows:
    """The rows of Δ K = E K Λ − Z K, each solved by itself.

    Rows with too few entries to change are `rigid`: they determine rows of K.
    """

    def __init__(self, target: Target, near: Refined, basis: _Basis) -> None:
        self.target, self.near, self.basis = target, near, basis
        self.polynomial = basis.polynomial
        self.pencil: dict[int, dict[int, Fraction]] = {i: {} for i in range(target.Z.nrows)}
        for (i, j), x in target.entries.items():
            self.pencil[i][j] = x
        self.fixed: dict[tuple[int, int], Fraction] = {}
        self.rational = not any(L for k, row in enumerate(basis.L) for L in row[:k] + row[k + 1 :])

    def solved(self) -> Correction:
        """Solve all rows; those that fail determine rows of K, and all are solved again."""
        rigid: set[int] = set()
        for _ in range(_PASSES):
            change, failed = self._solve(rigid)
            if not failed:
                kernel = tuple(map(tuple, self.basis.K))
                return Correction(change, self.polynomial, kernel)
            if failed & rigid:
                break
            # Rows without a choice first: what they determine may let the others be solved.
            bound = {
                i for i in failed if not any(self.target.allowed[i, j] for j in self.pencil[i])
            }
            bound = bound or {min(failed, key=lambda i: (len(self.pencil[i]), i))}
            for i in bound:
                self._fix(i)
            rigid |= bound
            self._determine(sorted(rigid, key=lambda i: (len(self.pencil[i]), i)))
        raise Failed

    def _fix(self, i: int) -> None:
        """Change the entries of a row as they were in floating point, and no more."""
        target, change = self.target, self.near.change
        for j in self.pencil[i]:
            if target.allowed[i, j] and change[i, j]:
                exact = Fraction(change[i, j]) * Fraction(2) ** -int(
                    target.rows[i] + target.columns[j]
                )
                self.fixed[i, j] = exact
                self.pencil[i][j] += exact

    def _determine(self, rigid: list[int]) -> None:
        """Eliminate: each rigid row expresses one row of K by others, which are kept."""
        known: dict[int, dict[int, Coefficient]] = {}
        for i in rigid:
            row: dict[int, Coefficient] = {j: (-x, _ZERO) for j, x in self.pencil[i].items()}
            if i < self.target.n:
                a, b = row.get(i, (_ZERO, _ZERO))
                shift = (self.basis.L[0][0], _ZERO) if self.rational else (_ZERO, Fraction(1))
                row[i] = (a + shift[0], b + shift[1])
            for j in list(row):
                if j in known:
                    self._add(row, known[j], row.pop(j))
            able = [j for j in row if j not in self.basis.pivots]
            if not able:
                if any(row.values()) and any(a or b for a, b in row.values()):
                    raise Failed
                continue
            j = max(able, key=lambda j: self._weight(row[j], j))
            factor = self._inverse(row.pop(j))
            express = {k: self._product((-a, -b), factor) for k, (a, b) in row.items()}
            for other in known.values():
                if j in other:
                    self._add(other, express, other.pop(j))
            known[j] = express
        K, times = self.basis.K, self.basis.times
        for j, express in known.items():
            terms = [times(K[k], by) for k, by in express.items() if any(K[k])]
            K[j] = (
                [sum(column, _ZERO) for column in zip(*terms, strict=True)]
                if terms
                else [_ZERO] * len(K[j])
            )

    def _weight(self, by: Coefficient, j: int) -> float:
        a, b = by
        size = float(np.abs(self.basis.sizes[j]).max())
        return (abs(float(a)) + abs(float(b)) * abs(self.near.point)) * size

    def _add(
        self, row: dict[int, Coefficient], other: dict[int, Coefficient], factor: Coefficient
    ) -> None:
        for k, by in other.items():
            a, b = self._product(by, factor)
            c, d = row.get(k, (_ZERO, _ZERO))
            if a + c or b + d:
                row[k] = (a + c, b + d)
            else:
                row.pop(k, None)

    def _product(self, x: Coefficient, y: Coefficient) -> Coefficient:
        """(a + bΛ)(c + dΛ), with Λ² = tΛ − q."""
        (a, b), (c, d) = x, y
        if not (b or d):
            return (a * c, _ZERO)
        q, minus, *_ = self.polynomial.coefficients
        return (a * c - b * d * q, a * d + b * c - b * d * minus)

    def _inverse(self, x: Coefficient) -> Coefficient:
        a, b = x
        if not b:
            return (1 / a, _ZERO)
        q, minus, *_ = self.polynomial.coefficients
        norm = a * a - a * b * minus + b * b * q
        return ((a - b * minus) / norm, -b / norm)

    def _solve(self, rigid: set[int]) -> tuple[dict[tuple[int, int], Fraction], set[int]]:
        """The change of all rows, and the rows that have no solution."""
        rest = self._rest()
        change, failed = dict(self.fixed), set()
        floats = np.array([[in_floats(x) for x in row] for row in self.basis.K])
        rough, rows = {}, {}
        for i, right in enumerate(rest):
            if any(right):
                free = (
                    [] if i in rigid else [j for j in self.pencil[i] if self.target.allowed[i, j]]
                )
                first = self._rough(i, free, right, floats) if free else None
                if first is None:
                    failed.add(i)
                else:
                    rows[i], rough[i] = free, first
        if rough:
            rest = self._without(rest, rough)
        for i, free in rows.items():
            last = self._exact(free, rest[i], floats)
            if last is None:
                failed.add(i)
                continue
            for j in free:
                moved = rough[i].get(j, _ZERO) + last.get(j, _ZERO)
                if moved:
                    change[i, j] = moved
        return change, failed

    def _rest(self) -> list[list[Fraction]]:
        """E K Λ − Z K, row by row."""
        K, target, basis = self.basis.K, self.target, self.basis
        Z = target.Z
        if self.fixed:
            Z = Z + Matrix.from_entries(Z.shape, ((i, j, x) for (i, j), x in self.fixed.items()))
        exact = Matrix.from_rows(K)
        moved = exact.take(rows=range(target.n)) @ Matrix.from_rows(basis.L)
        moved = vstack([moved, Matrix.zeros(Z.nrows - target.n, moved.ncols)])
        return [list(row) for row in (moved - Z @ exact).rows()]

    def _without(
        self, rest: list[list[Fraction]], rough: dict[int, dict[int, Fraction]]
    ) -> list[list[Fraction]]:
        """What a first change, row by row, leaves."""
        entries = ((i, j, x) for i, row in rough.items() for j, x in row.items())
        change = Matrix.from_entries(self.target.Z.shape, entries)
        product = (change @ Matrix.from_rows(self.basis.K)).rows()
        return [
            [x - y for x, y in zip(row, moved, strict=True)]
            for row, moved in zip(rest, product, strict=True)
        ]

    def _rough(
        self, i: int, free: list[int], right: list[Fraction], floats: Floats
    ) -> dict[int, Fraction] | None:
        """The least change of a row in floating point, rounded to some bits."""
        units = np.array([in_floats(self.target.allowed[i, j]) for j in free])
        system = (floats[free] * units[:, None]).T
        active = np.abs(system).max(axis=1) > 0
        if any(right[c] for c in np.nonzero(~active)[0]):
            return None
        if not active.any():
            return None
        goal = np.array([in_floats(x) for x in right])[active]
        system = system[active]
        if len(goal) == 1:
            total = np.abs(system[0]).sum()
            part = np.sign(system[0]) * (goal[0] / total)
        else:
            found = _least(system, goal)
            if found is None:
                return None
            part = found
        moved = part * units
        if not np.isfinite(moved).all():
            return None
        bits = _ROUGH - math.frexp(float(np.abs(moved).max()))[1]
        power = Fraction(2) ** -bits
        rounded = {
            j: round(math.ldexp(x, bits)) * power for j, x in zip(free, moved.tolist(), strict=True)
        }
        return {j: x for j, x in rounded.items() if x}

    def _exact(
        self, free: list[int], rest: list[Fraction], floats: Floats
    ) -> dict[int, Fraction] | None:
        """The small rest of a row, in as few entries as there are equations."""
        if not any(rest):
            return {}
        K, pivots = self.basis.K, self.basis.pivots
        inside = set(free)
        needed = [c for c, x in enumerate(rest) if x]
        if len(pivots) == len(rest) and all(pivots[c] in inside for c in needed):
            return {pivots[c]: rest[c] for c in needed}
        chosen, equations = _independent(floats[free].T)
        columns = [free[k] for k in chosen]
        solution = _gauss([[K[j][e] for j in columns] + [rest[e]] for e in equations])
        if solution is None:
            return None
        for e, x in enumerate(rest):
            if sum((K[j][e] * y for j, y in zip(columns, solution, strict=True)), _ZERO) != x:
                return None
        return dict(zip(columns, solution, strict=True))


def _independent(M: Floats) -> tuple[list[int], list[int]]:
    """Columns and rows of a large minor, by complete pivoting."""
    rest = M / np.maximum(np.abs(M).max(axis=1, keepdims=True), 1e-300)
    columns, rows = [], []
    for _ in range(min(M.shape)):
        i, j = np.unravel_index(int(np.argmax(np.abs(rest))), rest.shape)
        if abs(rest[i, j]) < 1e-9:
            break
        columns.append(int(j))
        rows.append(int(i))
        rest = rest - np.outer(rest[:, j], rest[i, :] / rest[i, j])
    return columns, rows


def _gauss(rows: list[list[Fraction]]) -> list[Fraction] | None:
    """The solution of a small square system [M, b] over Q; None if M is singular."""
    size = len(rows)
    for c in range(size):
        p = next((r for r in range(c, size) if rows[r][c]), None)
        if p is None:
            return None
        rows[c], rows[p] = rows[p], rows[c]
        rows[c] = [x / rows[c][c] for x in rows[c]]
        for r in range(size):
            if r != c and rows[r][c]:
                factor = rows[r][c]
                rows[r] = [x - factor * y for x, y in zip(rows[r], rows[c], strict=True)]
    return [row[-1] for row in rows]
