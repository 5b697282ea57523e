"""The exact test that a matrix function is nonsingular on a disc, for every member of a box.

For a square V with I − V Z(λ) = K − λ L, a member's Z(λ) is nonsingular on |λ − c| ≤ ρ if

    Σ_j |K − c L|_ij w_j + p_i + ρ r_i < w_i    for every row i,

w > 0, where p_i and r_i bound what the radii and the distance from c contribute: the matrix
I − V Z(λ) then has a norm below 1.  With R on the other side, I − Z(λ) R is of the same form.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from math import isqrt, lcm
from operator import mul
from typing import Any

import numpy as np
import numpy.typing as npt

from mcexact.answer.evidence import ComplexMatrix
from mcexact.exact.matrix import Matrix, matrix_to_float, to_float

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
        """Make it of its real and imaginary parts."""
        return cls(re, re * 0 if im is None else im)

    @property
    def denominator(self) -> int:
        """The least common denominator."""
        return lcm(self.re.denominator, self.im.denominator)

    def integers(self, denominator: int) -> tuple[list[list[int]], list[list[int]]]:
        """The rows times a multiple of the denominator."""
        found = []
        for part in (self.re, self.im):
            f = denominator // part.denominator
            found.append([[x * f for x in row] for row in part.numerators])
        return found[0], found[1]

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
    """The test of discs with one V and w.

    Attributes
    ----------
    V : ComplexRows
        The evidence from which K and L are made.
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
        import numpy as np

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
            found = np.array([to_float(x / y) for x, y in zip(part, self.w, strict=True)])
            object.__setattr__(self, key, found)

    def seem(self, c: complex, rho: float) -> bool:
        """Whether a disc passes in floating point."""
        import numpy as np

        own: Any = self
        K, L = own._near
        sums = np.abs(K - c * L).sum(axis=1) + own._p + rho * own._r
        return bool(np.all(sums < 0.9999))

    def hold(self, c: Point, rho: Fraction) -> bool:
        """Whether a disc passes, in integers, with a margin."""
        own: Any = self
        dc = lcm(c[0].denominator, c[1].denominator)
        a, b = int(c[0] * dc), int(c[1] * dc)
        scale, one = own._d * dc, _MARGIN - 1
        weights = self.w
        (K_re, K_im), (L_re, L_im) = own._K, own._L
        for i, (k, l, x, y) in enumerate(zip(K_re, K_im, L_re, L_im, strict=True)):
            moduli = (
                modulus_above(p * dc - a * r + b * s, q * dc - a * s - b * r)
                for p, q, r, s in zip(k, l, x, y, strict=True)
            )
            total = Fraction(sum(map(mul, moduli, weights)), scale)
            if (total + self.fixed[i] + rho * self.step[i]) * _MARGIN >= weights[i] * one:
                return False
        return True


@dataclass
class Frames:
    """The evidence that passed tests, for use on other discs as well.

    Attributes
    ----------
    evidence : list of (ComplexRows, tuple of int)
        V and w of each frame.
    """

    evidence: list[tuple[ComplexRows, tuple[int, ...]]] = field(default_factory=list)
    tests: list[RegularDiscs] = field(default_factory=list)

    def one_for(self, c: Point, rho: Fraction) -> int | None:
        """The position of a recent frame that passes on a disc."""
        near, size = complex(to_float(c[0]), to_float(c[1])), to_float(rho)
        for k in range(len(self.tests) - 1, max(len(self.tests) - 1 - _RECENT, -1), -1):
            if self.tests[k].seem(near, size) and self.tests[k].hold(c, rho):
                return k
        return None

    def added(self, proposed: RegularDiscs, c: Point, rho: Fraction) -> int | None:
        """The position of a new frame, if it passes."""
        if not proposed.hold(c, rho):
            return None
        self.tests.append(proposed)
        self.evidence.append((proposed.V, proposed.w))
        return len(self.tests) - 1


def whole_weights(w: Floats) -> tuple[int, ...]:
    """Round weights above 0 to integers, to 16 bits each, the largest ones down.

    Weights are only proposed; sums of them are to remain within the range of floats.
    """
    import numpy as np

    with np.errstate(over="ignore"):
        mantissa, exponent = np.frexp(np.minimum(w / w.min(), _LARGEST_WEIGHT))
    found = []
    for m, e in zip(mantissa, exponent, strict=True):
        found.append(int(np.ceil(np.ldexp(m, _WEIGHT_BITS))) << max(int(e), 0))
    return tuple(found)


def dyadic(V: Complex, unit: Floats) -> ComplexRows:
    """Round a complex matrix so that no entry changes by more than a small part of its unit.

    Parameters
    ----------
    V : ndarray of complex, r × c
    unit : ndarray of float, r × c
        What each entry may change by, times 2²⁶.
    """
    import numpy as np

    steps = np.floor(np.log2(np.maximum(unit * _STEP, 1e-290))).astype(int)
    finest = int(steps.min(initial=0))
    parts = []
    for part in (V.real, V.imag):
        whole = np.rint(np.ldexp(part, -steps))
        rows = [
            [int(x) << int(e - finest) for x, e in zip(row, exponents, strict=True)]
            for row, exponents in zip(whole.tolist(), steps, strict=True)
        ]
        made = Matrix.from_integers(rows, 1, V.shape[1])
        parts.append(made * (Fraction(2) ** finest))
    return ComplexRows(parts[0], parts[1])


def column(values: tuple[int, ...]) -> Matrix:
    """Integers as a matrix with one column."""
    return Matrix.from_integers([[x] for x in values], 1, 1)


def entries(M: Matrix) -> tuple[Fraction, ...]:
    """The entries of a matrix with one column."""
    return tuple(Fraction(row[0], M.denominator) for row in M.numerators)
