"""Radii, pencils in floating point, and the exact test of a disc.

All proofs about boxes rest on one test (`RegularDiscs`): that a matrix function Z(λ) is nonsingular
on a disc, for every member of a box.  For a square V with I − V Z(λ) = K − λ L, a member's Z(λ) is
nonsingular on |λ − c| ≤ ρ if, for some w > 0,

    Σ_j |K − c L|_ij w_j + p_i + ρ r_i < w_i    for every row i,

where p_i and r_i bound what the radii and the distance from c contribute: the matrix I − V Z(λ)
then has a norm below 1.  With R on the other side, I − Z(λ) R is of the same form, and proves that
a wide pencil has full row rank.

Floating point proposes V, the inverse of the pencil at c, and the weights w, a positive vector of
Perron's kind; both are rounded to short dyadic numbers and integers, and the test is done in
integers.  `Pencil` has the exact matrices and makes the proposals; `FloatBox` has those of a box in
coordinates that are balanced by powers of 2.  A frame, V and w, often passes on neighboring discs
as well, so `Frames` tries recent ones first.

`Members` are the systems that a proof is about: a nominal system, the radii of its entries, and
generators, systems of matrices that may be added with one factor from −1 to 1 each.  A box has no
generators; a cell of the ranges of parameters has one for each parameter (`boxes.cells`).
`radii_of` gives the radii of a plant, or of a system that constructions made from one.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from math import isqrt, lcm
from operator import mul
from typing import Any

import numpy as np
import numpy.typing as npt
from threadpoolctl import threadpool_limits

from mcexact.answer.check import constructed
from mcexact.answer.evidence import ComplexMatrix
from mcexact.derived.modulo import MODULO
from mcexact.derived.sampling import sampled_within
from mcexact.errors import InputError, LimitReached, UsageError
from mcexact.exact.matrix import Matrix, hstack, matrix_to_float, to_float, vstack
from mcexact.model.box import Box
from mcexact.model.parametric import ParametricSystem
from mcexact.model.radii import Radii, moduli
from mcexact.model.system import MultiChannelSystem

# The exact test of a disc.

Complex = npt.NDArray[np.complexfloating[Any, Any]]
Floats = npt.NDArray[np.floating[Any]]

Point = tuple[Fraction, Fraction]
"""The real and the imaginary part of a complex number."""

_MARGIN = 2**20
"""A disc is used only if each sum is below w_i by this part of it, whoever rounds the moduli."""
_WEIGHT_BITS, _LARGEST_WEIGHT = 16, 2.0**900
_STEP = 2.0**-26
_RECENT = 12


@dataclass(frozen=True)
class ComplexRows:
    """A complex matrix, M = (re + i·im) / d with integer rows."""

    re: Matrix
    im: Matrix

    @classmethod
    def of(cls, re: Matrix, im: Matrix | None = None) -> ComplexRows:
        """Make the matrix from its real and imaginary parts."""
        return cls(re, re * 0 if im is None else im)

    @property
    def denominator(self) -> int:
        """The least common denominator."""
        return lcm(self.re.denominator, self.im.denominator)

    def integers(self, denominator: int) -> tuple[list[list[int]], list[list[int]]]:
        """The rows times a multiple of the denominator."""
        parts = []
        for part in (self.re, self.im):
            f = denominator // part.denominator
            parts.append([[x * f for x in row] for row in part.numerators])
        return parts[0], parts[1]

    def __matmul__(self, other: ComplexRows) -> ComplexRows:
        return ComplexRows(
            self.re @ other.re - self.im @ other.im, self.re @ other.im + self.im @ other.re
        )

    def before(self, M: Matrix) -> ComplexRows:
        """The product with a real matrix on the right."""
        return ComplexRows(self.re @ M, self.im @ M)

    def after(self, M: Matrix) -> ComplexRows:
        """The product with a real matrix on the left."""
        return ComplexRows(M @ self.re, M @ self.im)

    def __add__(self, other: ComplexRows) -> ComplexRows:
        return ComplexRows(self.re + other.re, self.im + other.im)

    def scaled(self, factor: Fraction) -> ComplexRows:
        """The multiple by a rational number."""
        return ComplexRows(self.re * factor, self.im * factor)

    def take(self, rows: range, cols: range) -> ComplexRows:
        """The submatrix of some rows and columns."""
        return ComplexRows(self.re.take(rows, cols), self.im.take(rows, cols))

    def evidence(self) -> ComplexMatrix:
        """The matrix as a part of a witness."""
        d = self.denominator
        re, im = (tuple(map(tuple, rows)) for rows in self.integers(d))
        return ComplexMatrix(d, re, im)

    def moduli(self) -> Matrix:
        """Upper limits of the moduli of the entries."""
        d = self.denominator
        rows = [list(map(modulus_above, a, b)) for a, b in zip(*self.integers(d), strict=True)]
        return Matrix.from_integers(rows, d, self.re.ncols)


def modulus_above(a: int, b: int) -> int:
    """An integer that is at least |a + bi|, and at most 1 more.

    Examples
    --------
    >>> modulus_above(3, 4), modulus_above(0, -2), modulus_above(1, 1)
    (5, 2, 2)
    """
    if not a or not b:
        return abs(a) + abs(b)
    square = a * a + b * b
    root = isqrt(square)
    return root + (root * root < square)


@dataclass(frozen=True, eq=False)
class RegularDiscs:
    """The test of discs with one V and w, by the inequality at the top of this module.

    Attributes
    ----------
    V : ComplexRows
        The approximate inverse from which K and L are made.
    K, L : ComplexRows
        N × N: I − V Z(λ) = K − λ L.
    w : tuple of int
        The weights, above 0.
    fixed : tuple of Fraction
        p_i.
    step : tuple of Fraction
        r_i.
    """

    V: ComplexRows
    K: ComplexRows
    L: ComplexRows
    w: tuple[int, ...]
    fixed: tuple[Fraction, ...]
    step: tuple[Fraction, ...]

    def __post_init__(self) -> None:
        d = lcm(self.K.denominator, self.L.denominator)
        object.__setattr__(self, "_d", d)
        object.__setattr__(self, "_K", self.K.integers(d))
        object.__setattr__(self, "_L", self.L.integers(d))
        w = np.array([float(x) for x in self.w])
        ratio = w[None, :] / w[:, None]

        def floats(M: ComplexRows) -> Any:
            return (matrix_to_float(M.re) + 1j * matrix_to_float(M.im)) * ratio

        object.__setattr__(self, "_near", (floats(self.K), floats(self.L)))
        for key, part in (("_p", self.fixed), ("_r", self.step)):
            ratios = np.array([to_float(x / y) for x, y in zip(part, self.w, strict=True)])
            object.__setattr__(self, key, ratios)

    def seem(self, c: complex, rho: float) -> bool:
        """Whether a disc passes the test in floating point, which proves nothing."""
        own: Any = self
        K, L = own._near
        sums = np.abs(K - c * L).sum(axis=1) + own._p + rho * own._r
        return bool(np.all(sums < 0.9999))

    def hold(self, c: Point, rho: Fraction) -> bool:
        """Whether a disc passes the test, done in integers and with a small margin."""
        rows, scale = self.moduli(c)
        return all(
            within(Fraction(sum(map(mul, row, self.w)), scale) + p + rho * r, w)
            for row, p, r, w in zip(rows, self.fixed, self.step, self.w, strict=True)
        )

    def moduli(self, c: Point) -> tuple[list[list[int]], int]:
        """Upper limits of the moduli of K − cL, integers over a common denominator."""
        own: Any = self
        dc = lcm(c[0].denominator, c[1].denominator)
        a, b = int(c[0] * dc), int(c[1] * dc)
        (K_re, K_im), (L_re, L_im) = own._K, own._L
        rows = [
            [
                modulus_above(p * dc - a * r + b * s, q * dc - a * s - b * r)
                for p, q, r, s in zip(k, l, x, y, strict=True)
            ]
            for k, l, x, y in zip(K_re, K_im, L_re, L_im, strict=True)
        ]
        return rows, own._d * dc

    @property
    def near(self) -> tuple[Complex, Complex]:
        """K and L in floating point, their columns weighed and their rows divided by weights."""
        own: Any = self
        pair: tuple[Complex, Complex] = own._near
        return pair


def within(total: Fraction, weight: int) -> bool:
    """Whether a sum is below a weight, with a small margin."""
    return total * _MARGIN < weight * (_MARGIN - 1)


@dataclass
class Frames:
    """The frames, V and w, that passed on some disc; they are tried on further discs.

    Attributes
    ----------
    evidence : list of (ComplexRows, tuple of int)
        V and w of each frame.
    """

    evidence: list[tuple[ComplexRows, tuple[int, ...]]] = field(default_factory=list)
    tests: list[RegularDiscs] = field(default_factory=list)

    def one_for(self, c: Point, rho: Fraction) -> int | None:
        """The position of a recent frame that passes on a disc; None if none does."""
        near, size = complex(to_float(c[0]), to_float(c[1])), to_float(rho)
        for k in range(len(self.tests) - 1, max(len(self.tests) - 1 - _RECENT, -1), -1):
            if self.tests[k].seem(near, size) and self.tests[k].hold(c, rho):
                return k
        return None

    def added(self, proposed: RegularDiscs, c: Point, rho: Fraction) -> int | None:
        """Add a frame if it passes on a disc, and return its position; None if it fails."""
        if not proposed.hold(c, rho):
            return None
        self.tests.append(proposed)
        self.evidence.append((proposed.V, proposed.w))
        return len(self.tests) - 1


def whole_weights(w: Floats) -> tuple[int, ...]:
    """Round weights above 0 to integers, to 16 bits each, the largest ones down.

    Any positive weights are valid proposals.  16 bits keep their sums within the range of floats.
    """
    with np.errstate(over="ignore"):
        mantissa, exponent = np.frexp(np.minimum(w / w.min(), _LARGEST_WEIGHT))
    integers = []
    for m, e in zip(mantissa, exponent, strict=True):
        integers.append(int(np.ceil(np.ldexp(m, _WEIGHT_BITS))) << max(int(e), 0))
    return tuple(integers)


def dyadic(V: Complex, unit: Floats) -> ComplexRows:
    """Round a complex matrix so that no entry changes by more than a small part of its unit.

    Parameters
    ----------
    V : ndarray of complex, r × c
    unit : ndarray of float, r × c
        What each entry may change by, times 2²⁶.
    """
    steps = np.floor(np.log2(np.maximum(unit * _STEP, 1e-290))).astype(int)
    finest = int(steps.min(initial=0))
    parts = []
    for part in (V.real, V.imag):
        whole = np.rint(np.ldexp(part, -steps))
        rows = [
            [int(x) << int(e - finest) for x, e in zip(row, exponents, strict=True)]
            for row, exponents in zip(whole.tolist(), steps, strict=True)
        ]
        parts.append(Matrix.from_integers(rows, 1, V.shape[1]) * (Fraction(2) ** finest))
    return ComplexRows(parts[0], parts[1])


def column(values: tuple[int, ...]) -> Matrix:
    """Integers as a matrix with one column."""
    return Matrix.from_integers([[x] for x in values], 1, 1)


def entries(M: Matrix) -> tuple[Fraction, ...]:
    """The entries of a matrix with one column."""
    return tuple(Fraction(row[0], M.denominator) for row in M.numerators)


# Members, their pencils λE − Z0, and the frames that these propose for a disc.


@dataclass(frozen=True)
class Members:
    """The systems near a nominal one that a proof is about: those of a box, or of a cell of ranges.

    A member is the nominal system, plus any change of each entry within its radius, plus each
    generator times a factor from −1 to 1, the same for all its entries.

    Attributes
    ----------
    system : MultiChannelSystem
        The nominal system.
    radii : Radii
        The radii of the independent changes.
    generators : tuple of MultiChannelSystem
        Matrices A, B_i and C_i of the shapes of the system; a box has none.
    """

    system: MultiChannelSystem
    radii: Radii
    generators: tuple[MultiChannelSystem, ...] = ()

    @classmethod
    def of(cls, system: MultiChannelSystem) -> Members:
        """Make the members of the box of a system, which are those within its radii (`radii_of`).

        Raises
        ------
        LimitReached
            If floating point cannot search with the entries.
        UsageError
            If a construction closes a loop.
        """
        return cls(system, radii_of(system))

    @cached_property
    def independent(self) -> Radii:
        """The radii of a box with independent entries that contains all members."""
        A, B, C = self.radii.A, list(self.radii.B), list(self.radii.C)
        for each in self.generators:
            A = A + moduli(each.A)
            B = [D + moduli(M) for D, M in zip(B, each.B, strict=True)]
            C = [D + moduli(M) for D, M in zip(C, each.C, strict=True)]
        return Radii(A, B, C)


_ROOM = 0.998
"""The part of 1 below which the norm is to be in floating point."""
_ROOT = 4


@dataclass(frozen=True)
class FloatBox:
    """The matrices of some members in coordinates that are balanced by powers of 2.

    Attributes
    ----------
    A, DA : ndarray, n × n
    B, C, DB, DC : tuples of ndarray
        DA, DB and DC are radii plus the moduli of the generators.
    independent_A : ndarray, n × n
        The radii of A alone.
    generators_A : tuple of ndarray
        Matrices that may be added to A, each with a factor from −1 to 1.
    scale : ndarray, n
        x = scale · z, where z are the balanced states.
    """

    A: Floats
    B: tuple[Floats, ...]
    C: tuple[Floats, ...]
    DA: Floats
    DB: tuple[Floats, ...]
    DC: tuple[Floats, ...]
    independent_A: Floats
    generators_A: tuple[Floats, ...]
    scale: Floats

    @classmethod
    def of(cls, members: Members) -> FloatBox:
        """Round the matrices of some members, in coordinates in which A is balanced."""
        from scipy.linalg import matrix_balance

        system, radii = members.system, members.independent
        A = matrix_to_float(system.A)
        s: Floats = np.ones(system.n)
        if system.n:
            _, (s, _) = matrix_balance(A, permute=False, separate=True)
        rows, cols = (1 / s)[:, None], s[None, :]
        return cls(
            A * rows * cols,
            tuple(matrix_to_float(M) * rows for M in system.B),
            tuple(matrix_to_float(M) * cols for M in system.C),
            matrix_to_float(radii.A) * rows * cols,
            tuple(matrix_to_float(M) * rows for M in radii.B),
            tuple(matrix_to_float(M) * cols for M in radii.C),
            matrix_to_float(members.radii.A) * rows * cols,
            tuple(matrix_to_float(each.A) * rows * cols for each in members.generators),
            s,
        )

    def deviation(self, Y: Complex, T: Complex) -> Floats:
        """An upper limit of the moduli of Y (A' − A) T for all members A'."""
        own = np.abs(Y) @ self.independent_A @ np.abs(T)
        return np.asarray(own + sum(np.abs(Y @ M @ T) for M in self.generators_A))

    def wider(self, size: float) -> FloatBox:
        """The box in which the diagonal of A may also change by ``size``.

        A pencil that is regular at a point for all members of the wider box is regular for those of
        this box on the whole disc of radius ``size`` around the point.
        """
        return replace(self, DA=self.DA + size * np.eye(self.n))

    @property
    def n(self) -> int:
        """The number of states."""
        return len(self.A)

    def modes(self) -> list[complex]:
        """One number near each group of eigenvalues of A in the closed upper half-plane."""
        modes: list[complex] = []
        size = np.linalg.norm(self.A)
        for value in np.linalg.eigvals(self.A):
            near = (abs(value - x) <= 1e-3 * max(abs(value), 1e-9 * size) for x in modes)
            if value.imag >= -1e-12 * abs(value) and not any(near):
                modes.append(complex(value.real, max(value.imag, 0.0)))
        return modes


@dataclass(frozen=True, eq=False)
class Pencil:
    """Z(λ) = λE − Z0 with E = diag(I_n, 0) and radii D, exactly.

    Attributes
    ----------
    Z0, D : Matrix, N × N
    n : int
    scale : ndarray, N
        Powers of 2, by which the coordinates are balanced.
    generators : tuple of Matrix
        Matrices that may be added to Z0, each with a factor from −1 to 1.
    """

    Z0: Matrix
    D: Matrix
    n: int
    scale: Floats
    generators: tuple[Matrix, ...] = ()
    ports: tuple[int, ...] = ()
    """The signals that are multiplied (`boxes.margins`)."""

    @property
    def readers(self) -> Fraction:
        """What a signal is multiplied by at most, in absolute value."""
        return Fraction(1)

    @cached_property
    def balanced(self) -> tuple[Floats, Floats, Floats]:
        """Z0, D and the diagonal of E, in balanced coordinates."""
        rows, cols = (1 / self.scale)[:, None], self.scale[None, :]
        E = np.zeros(len(self.scale))
        E[: self.n] = 1
        return matrix_to_float(self.Z0) * rows * cols, matrix_to_float(self.D) * rows * cols, E

    @cached_property
    def balanced_generators(self) -> tuple[Floats, ...]:
        """The generators, in balanced coordinates."""
        rows, cols = (1 / self.scale)[:, None], self.scale[None, :]
        return tuple(matrix_to_float(M) * rows * cols for M in self.generators)

    def deviation(self, V: Complex) -> Floats:
        """An upper limit of the moduli of V (Z0' − Z0) for all members Z0'."""
        return np.asarray(
            np.abs(V) @ self.balanced[1] + sum(np.abs(V @ M) for M in self.balanced_generators)
        )

    def inverse(self, c: complex) -> Complex | None:
        """Z(c)⁻¹ of the nominal pencil in balanced coordinates, if it exists."""
        Z0, _, E = self.balanced
        try:
            Y = np.linalg.inv(c * np.diag(E) - Z0)
        except np.linalg.LinAlgError:
            return None
        return np.asarray(Y, dtype=np.complex128) if np.all(np.isfinite(Y)) else None

    def margin(self, c: complex) -> float:
        """The factor up to which the radii can grow while the pencil stays regular at a point."""
        Y = self.inverse(c)
        if Y is None:
            return 0.0
        size, _, _ = perron(self.deviation(Y))
        return 1 / size if size > 0 else np.inf

    def proposal(self, c: complex, rho: float, factor: Fraction) -> RegularDiscs | None:
        """Propose V and w for a disc, as a test in which they are rounded; None without a proposal.

        Parameters
        ----------
        c, rho
            Center and radius.
        factor : Fraction
            The factor of all radii.
        """
        g = float(factor)
        V = self.inverse(c)
        if V is None:
            return None
        Z0, D, E = self.balanced
        w = weights(g * self.deviation(V) + rho * np.abs(V) @ np.diag(E))
        if w is None:
            return None
        free = D + sum(map(np.abs, self.balanced_generators))
        unit = w[:, None] / (len(w) * (np.abs(c * np.diag(E) - Z0) @ w + g * free @ w))[None, :]
        ratios = self.scale[:, None] / self.scale[None, :]
        exact = dyadic(V * ratios, unit * ratios)
        return self.tested(exact, whole_weights(w * self.scale), factor)

    def tested(self, V: ComplexRows, w: tuple[int, ...], factor: Fraction) -> RegularDiscs:
        """Make the exact test with V and w, for radii that are multiplied by a factor."""
        N = len(w)
        one, heavy = ComplexRows.of(Matrix.identity(N)), column(w)
        K = one + V.before(self.Z0)
        E = Matrix.from_entries((N, N), ((i, i, 1) for i in range(self.n)))
        size = V.moduli()
        deviation = size @ (self.D @ heavy)
        for M in self.generators:
            deviation = deviation + V.before(M).moduli() @ heavy
        return RegularDiscs(
            V,
            K,
            V.before(E),
            w,
            entries(deviation * factor),
            entries(size @ (E @ heavy)),
        )


def gain_pencil(
    members: Members,
    scale: Floats,
    X: Sequence[Matrix] | None = None,
    W: Sequence[Matrix] | None = None,
) -> Pencil:
    """The pencil [[λI − A, −B], [XC, W]]; where it is regular for some X and W, λ is not fixed.

    Without gains it is λI − A.  X and W are block diagonal by channel:

        Z0 = [[A, B], [−X C, −W]],   D = [[D_A, D_B], [|X| D_C, 0]].
    """
    system, radii, n = members.system, members.radii, members.system.n
    if X is None or W is None:
        return Pencil(system.A, radii.A, n, scale, tuple(each.A for each in members.generators))
    p = sum(system.p(i) for i in range(system.m))

    def whole(A: Matrix, B: Sequence[Matrix], XC: list[Matrix], W: list[Matrix]) -> Matrix:
        rows, start = [hstack([A, *B], nrows=n)], 0
        for below, W_i in zip(XC, W, strict=True):
            size = W_i.nrows
            left, right = Matrix.zeros(size, start), Matrix.zeros(size, p - start - size)
            rows.append(hstack([below, left, W_i, right], nrows=size))
            start += size
        return vstack(rows, ncols=n + p)

    def of(each: MultiChannelSystem, last: list[Matrix]) -> Matrix:
        XC = [-(X_i @ C_i) for X_i, C_i in zip(X, each.C, strict=True)]
        return whole(each.A, each.B, XC, last)

    zeros = [Matrix.zeros(*W_i.shape) for W_i in W]
    XD = [moduli(X_i) @ DC_i for X_i, DC_i in zip(X, radii.C, strict=True)]
    return Pencil(
        of(system, [-W_i for W_i in W]),
        whole(radii.A, radii.B, XD, zeros),
        n,
        np.concatenate([scale, np.ones(p)]),
        tuple(of(each, zeros) for each in members.generators),
    )


def weights(N: Floats) -> Floats | None:
    """Propose a vector w > 0 with N w < w, for N ≥ 0; None if there seems to be none."""
    if not np.all(np.isfinite(N)):
        return None
    try:
        w = np.linalg.solve(np.eye(len(N)) - N / _ROOM, np.ones(len(N)))
    except np.linalg.LinAlgError:
        return None
    # For N ≥ 0, a positive solution exists exactly if the spectral radius is below the room.
    good = np.all(np.isfinite(w)) and np.all(w > 0) and np.all(N @ w < w)
    return w if good else None


def perron(N: Floats, squarings: int = 8) -> tuple[float, Floats, Floats]:
    """The spectral radius of a matrix N ≥ 0, and approximate right and left positive eigenvectors.

    Examples
    --------
    >>> round(perron(np.array([[0, 1e6], [1e-6, 0]]))[0], 6)
    1.0
    """
    size = len(N)
    top = N.sum(axis=1).max(initial=0.0)
    if not (np.isfinite(top) and top > 0):
        return float(top), np.ones(size), np.ones(size)
    top *= _root_of_power(N / top)
    # The shift keeps powers from alternating, and all entries above 0.
    P = N / top + 0.1 * np.eye(size) + 1e-13 / size
    for _ in range(squarings):
        P = P @ P
        P /= P.max()
    right, left = P.sum(axis=1), P.sum(axis=0)
    right, left = right / right.max(), left / left.max()
    value = float(left @ N @ right / (left @ right))
    return value, right, left


def _root_of_power(N: Floats) -> float:
    """The k-th root of the largest entry of N^k, k a power of 2; 1 if the power is 0.

    Where states are badly scaled, row sums are far above the spectral radius, and this is near it.
    """
    logarithm = 0.0
    for _ in range(_ROOT):
        N = N @ N
        largest = N.max()
        if not largest > 0:
            return 1.0
        logarithm = 2 * logarithm + float(np.log(largest))
        N = N / largest
    return float(np.exp(logarithm / 2**_ROOT))


# Limits of floating point.

_BITS = 200
"""Products of a few such numbers are still floats."""


def require_float_range(values: Iterable[Matrix], radii: Iterable[Matrix]) -> None:
    """Require entries whose products stay within the range of floating point.

    Parameters
    ----------
    values, radii : iterable of Matrix
        Radii have no lower limit.

    Raises
    ------
    LimitReached
        If the modulus of an entry other than 0 is above about 2²⁰⁰ or below about 2⁻²⁰⁰.

    Examples
    --------
    >>> require_float_range([Matrix.from_rows([[0, "1e60", "1e-60"]])], [])
    >>> require_float_range([Matrix.from_rows([["1e61"]])], [])
    Traceback (most recent call last):
        ...
    mcexact.errors.LimitReached: an entry is above 1e60 or below 1e-60, where floating point finds \
no proof: choose other units
    """
    sizes = [size for M in values for size in _sizes(M)]
    spread = [size for M in radii for size in _sizes(M)]
    if max([*sizes, *spread], default=0) > _BITS or min(sizes, default=0) < -_BITS:
        raise LimitReached(
            "an entry is above 1e60 or below 1e-60, where floating point finds no proof: "
            "choose other units"
        )


def _sizes(M: Matrix) -> Iterator[int]:
    """About the binary logarithms of the moduli of all entries that are not 0."""
    below = M.denominator.bit_length()
    return (abs(int(x)).bit_length() - below for _, _, x in M.nonzero())


# The radii of the entries of a plant, or of a system that constructions made from it.


def require_radii(system: MultiChannelSystem | ParametricSystem) -> None:
    """Raise an error if every entry of a plant is certain, and none of its samples rounded.

    Raises
    ------
    UsageError
        If there is no box to decide about.
    """
    if isinstance(system, ParametricSystem):
        return
    InputError.require(system, MultiChannelSystem, "system")
    sampled = any(each["construction"] == "sampled" for each in system.subject)
    if system.plant.uncertainty is None and not sampled:
        raise UsageError(
            "every entry of the plant is certain, so there is no box: give it radii, such as "
            'Box.relative(plant, "1%").system',
            where="system",
        )


def radii_of(system: MultiChannelSystem) -> Radii:
    """Return the radii of all entries of a system; those of constants are 0.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant, or a system made from one by constructions.

    Raises
    ------
    LimitReached
        If floating point cannot search with the entries.
    UsageError
        If a construction closes a loop: use `box_stability` for its stability.

    Notes
    -----
    Let |S| be the moduli of all entries, D their radii, and T the constructions, which add and
    multiply entries, with gains replaced by their moduli.  Then every T(S') is within
    T(|S| + D) − T(|S|) of T(S).  A copied entry keeps its radius.  The radius of a sum, such as
    A + Σ B_i F_i C_i, may be larger than any member attains, since its terms count as independent.
    What is sampled has the radii of `sampled_within`.

    Examples
    --------
    >>> from mcexact.constructions import dual
    >>> from mcexact.derived.constructions import feedback
    >>> plant = MultiChannelSystem([[1]], [[[2, 3]]], [[[4]]])
    >>> box = Box.relative(plant, "1/2").system
    >>> radii_of(dual(box)).C[0].numerators
    ((2,), (3,))
    >>> radii_of(feedback(box, [[[0], [-1]]])).A[0, 0]  # 1/2, and 9/2 · 6 − 3 · 4
    Fraction(31, 2)
    """
    radii = Box(system.plant).radii
    require_float_range(_matrices(system), (D for _, D in radii.matrices()))
    if not system.subject:
        return radii
    low, high = _ends(system.plant, radii)
    for k, each in enumerate(system.subject):
        if each["construction"] == "closed_loop":
            raise UsageError("radii of a closed loop are a matter of box_stability")
        if each["construction"] == MODULO:
            raise UsageError("a part of the nominal plant is none of every plant in a box")
        if each["construction"] == "sampled":
            before = constructed(system.plant, _records(system.subject[:k]))
            how = Fraction(each["step"]), each["late"], each["decimals"]
            spread = sampled_within(before, _difference(high, low), *how)
            low, high = _ends(constructed(before, [each]), spread)
        else:
            low, high = (_moduli_constructed(each, moduli_of) for moduli_of in (low, high))
    return _difference(high, low)


def _ends(
    system: MultiChannelSystem, radii: Radii
) -> tuple[MultiChannelSystem, MultiChannelSystem]:
    """The moduli of all entries, and the largest ones within the radii."""
    low = _with_entries(system, map(moduli, _matrices(system)))
    both = zip(_matrices(low), radii.matrices(), strict=True)
    return low, _with_entries(low, (M + D for M, (_, D) in both))


def _difference(high: MultiChannelSystem, low: MultiChannelSystem) -> Radii:
    """By how much entries are larger."""
    A, *ports = (M - N for M, N in zip(_matrices(high), _matrices(low), strict=True))
    return Radii(A, ports[: high.m], ports[high.m :])


def _records(subject: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Constructions as in certificates."""
    records = [dict(each) for each in subject]
    for record in records:
        if "gains" in record:
            gains = record["gains"]
            record["gains"] = [
                {"denominator": F.denominator, "entries": F.numerators} for F in gains
            ]
    return records


def _moduli_constructed(
    construction: Mapping[str, Any], system: MultiChannelSystem
) -> MultiChannelSystem:
    """Apply a construction, with its gains replaced by their moduli, and return the moduli."""
    record = dict(construction)
    if "gains" in record:
        record["gains"] = [moduli(F) for F in record["gains"]]
    result: MultiChannelSystem = constructed(system, _records([record]))
    return _with_entries(result, map(moduli, _matrices(result)))


def _matrices(system: MultiChannelSystem) -> list[Matrix]:
    return [system.A, *(c.B for c in system.channels), *(c.C for c in system.channels)]


def _with_entries(system: MultiChannelSystem, entries: Iterable[Matrix]) -> MultiChannelSystem:
    """The plant with these A, B_i and C_i, and with the channels and neighbors of a system."""
    A, *ports = entries
    return MultiChannelSystem(
        A,
        ports[: system.m],
        ports[system.m :],
        time=system.time,
        names=system.names,
        neighbors=system.neighbors,
    )


# Floating point for proposals: in one thread, and without warnings.


@contextmanager
def one_thread() -> Iterator[None]:
    """Run floating point in one thread without warnings: all its proposals are tested exactly."""
    with threadpool_limits(1, "blas"), np.errstate(all="ignore"):
        yield
