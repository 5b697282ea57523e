"""Discs that contain all eigenvalues of all members: Gershgorin's, in coordinates T.

For G = YT, H = Y A0 T and e = |Y| D_A |T| 1, no member has an eigenvalue λ with |λ − a_i| > rad_i
for every i if s_i = |G_ii| − Σ_{j≠i} |G_ij| > 0 and rad_i s_i > Σ_j |a_i G_ij − H_ij| + e_i.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from mcexact.analysis.boxes.float_pencils import Complex, FloatBox, Floats, perron
from mcexact.analysis.boxes.regular_discs import ComplexRows, dyadic, modulus_above
from mcexact.answer.evidence import RootDisc
from mcexact.exact.matrix import Matrix
from mcexact.exact.roots import decimal

_PERTURBATIONS = (0.0, 1e-11, 1e-8, 1e-6, 1e-4, 1e-2)
"""Eigenvectors of a matrix that is not diagonalizable are taken of one so close to it."""
_FINE, _FINEST = 2.0**10, 2.0**-26
_PARTS = (1e-1, 1e-2, 1e-3)
_VERY_WELL, _WELL = 1e2, 1e6
_MOST_DIGITS = 60
_SQUARINGS = 40


@dataclass(frozen=True)
class Exterior:
    """Y and T, and the disc of each row."""

    Y: ComplexRows
    T: ComplexRows
    discs: tuple[RootDisc, ...]


def exterior(
    box: FloatBox,
    A: Matrix,
    D: Matrix,
    rng: np.random.Generator,
    growth: Fraction = Fraction(1),
    tied: Sequence[Matrix] = (),
) -> Exterior | None:
    """Compute the discs for radii that are multiplied by a factor; None if there are none.

    Parameters
    ----------
    box : FloatBox
        In whose coordinates eigenvectors are computed.
    A, D : Matrix, n × n
        The nominal matrix and its radii.
    rng : numpy.random.Generator
    growth : Fraction
    tied : sequence of Matrix
        What may be added to A, each with a factor from −1 to 1.
    """
    if not box.n:
        none = ComplexRows.of(Matrix.zeros(0, 0))
        return Exterior(none, none, ())
    along = [M * growth for M in tied]
    ranked = coordinates(box, rng, growth)
    proposed = (each.exact(box.scale, A, D * growth, along) for each in ranked)
    return next((found for found in proposed if found is not None), None)


@dataclass(frozen=True, eq=False)
class Coordinates:
    """Y, T and the discs in floating point, in balanced coordinates.

    Attributes
    ----------
    Y, T : ndarray of complex, n × n
    centers : ndarray of complex, n
    radii : ndarray of float, n
    size : ndarray of float, n × n
        |A|.
    """

    Y: Complex
    T: Complex
    centers: Complex
    radii: Floats
    size: Floats

    def exact(
        self, scale: Floats, A: Matrix, D: Matrix, tied: Sequence[Matrix] = ()
    ) -> Exterior | None:
        """Round Y and T, and compute the discs of a matrix exactly; None if there are none.

        No entry of Y or T is finer than what a small part of the radii asks for.
        """
        n, Y, T = len(scale), np.abs(self.Y), np.abs(self.T)
        far, most = np.abs(self.centers)[:, None], np.maximum(self.radii, 1e-290)[:, None]
        after, before = self.size @ T.sum(axis=1), Y @ self.size
        heavy_Y = np.maximum((after + far * T.sum(axis=1)) / most, T.sum(axis=1))
        heavy_T = np.maximum((before + far * Y) / most, Y).max(axis=0)[:, None]
        unit_Y = np.maximum(_FINE / (n * heavy_Y), _FINEST * Y.max(axis=1)[:, None])
        unit_T = np.maximum(_FINE / (n * n * heavy_T), _FINEST * T.max(axis=0))
        exact_Y = dyadic(self.Y / scale[None, :], unit_Y / scale[None, :])
        exact_T = dyadic(self.T * scale[:, None], unit_T * scale[:, None])
        discs = _discs(exact_Y, exact_T, A, (D, *tied), self.centers)
        return None if discs is None else Exterior(exact_Y, exact_T, discs)


def coordinates(
    box: FloatBox, rng: np.random.Generator, growth: Fraction = Fraction(1)
) -> list[Coordinates]:
    """Y, T and the discs in balanced coordinates, those with the smallest radii first."""
    A, size = box.A, np.abs(box.A)
    found: list[Coordinates] = []
    for T in _candidates(A, box.DA, rng):
        try:
            Y = np.linalg.inv(T)
        except np.linalg.LinAlgError:
            continue
        H = Y @ A @ T
        centers = np.diag(H).copy()
        size_Y, size_T = np.abs(Y), np.abs(T)
        spread = np.abs(H - np.diag(centers)) + float(growth) * box.moved(Y, T)
        spread += 1e-12 * (size_Y @ size @ size_T)
        if not np.all(np.isfinite(spread)):
            continue
        for weight in _weights(spread, np.abs(centers)):
            radii = (spread @ weight) / weight
            turned: tuple[Any, Any] = Y / weight[:, None], T * weight[None, :]
            if np.all(np.isfinite(turned[0])):
                found.append(Coordinates(*turned, centers, radii, size))
    return sorted(found, key=lambda each: float(each.radii.sum()))


def _weights(spread: Floats, sizes: Floats) -> Iterator[Floats]:
    """Weights w > 0 for which the sums of spread_ij w_j / w_i, the radii, are small."""
    n = len(spread)
    yield np.ones(n)
    yield np.maximum(perron(spread, _SQUARINGS)[1], 1e-12)
    own, largest = np.diag(spread), float(sizes.max(initial=0.0)) or float(spread.max(initial=0.0))
    for part in _PARTS:
        # Where a solution is positive, each radius is below the disc's own part and this target.
        target = part * np.maximum(sizes, 1e-6 * max(largest, 1e-290))
        try:
            w = np.linalg.solve(np.diag(target) - (spread - np.diag(own)), target)
        except np.linalg.LinAlgError:
            continue
        if np.all(np.isfinite(w)) and np.all(w > 0):
            yield w / w.max()


def _candidates(A: Floats, D: Floats, rng: np.random.Generator) -> Iterator[Any]:
    """Bases in which A is nearly diagonal, or in which it is triangular.

    Those of single blocks leave zeros of a block triangular matrix where they are: weights then
    make what couples the blocks as small as one likes.
    """
    from scipy.linalg import schur
    from scipy.sparse.csgraph import connected_components

    n, size = len(A), float(np.linalg.norm(A))
    yield np.eye(n)
    count, block = connected_components(np.abs(A) + D > 0, connection="strong")
    if count > 1:
        whole = np.zeros((n, n), dtype=complex)
        for k in range(count):
            own = np.ix_(block == k, block == k)
            whole[own] = np.linalg.eig(A[own])[1]
        yield whole
    T = np.linalg.eig(A)[1]
    if np.linalg.cond(T) < _VERY_WELL:
        yield T
        return
    yield schur(A, output="complex")[1]
    for part in _PERTURBATIONS:
        noise = part * rng.standard_normal((n, n))
        near = A * (1 + noise) + part * size / max(n, 1) * rng.standard_normal((n, n))
        T = np.linalg.eig(near)[1]
        yield T
        if part == 0 and np.linalg.cond(T) < _WELL:
            return


def _discs(
    Y: ComplexRows,
    T: ComplexRows,
    A: Matrix,
    moved: tuple[Matrix, ...],
    centers: Complex,
) -> tuple[RootDisc, ...] | None:
    """The discs with radii as small as the exact matrices allow, rounded up to three digits."""
    G, H = Y @ T, Y @ T.after(A)
    ones = Matrix.from_integers([[1]] * len(centers), 1, 1)
    D, *tied = moved
    e = Y.moduli() @ (D @ (T.moduli() @ ones))
    for M in tied:
        e = e + (Y @ (ComplexRows.of(M) @ T)).moduli() @ ones
    d = math.lcm(G.denominator, H.denominator)
    (G_re, G_im), (H_re, H_im) = G.integers(d), H.integers(d)
    found = []
    for i, a in enumerate(centers):
        others = sum(
            modulus_above(x, y)
            for j, (x, y) in enumerate(zip(G_re[i], G_im[i], strict=True))
            if j != i
        )
        slack = math.isqrt(G_re[i][i] ** 2 + G_im[i][i] ** 2) - others
        if slack <= 0:
            return None
        row = G_re[i], G_im[i], H_re[i], H_im[i]
        spread = e[i, 0] * d
        # The center is rounded to a small part of the radius, which is first taken at the float.
        first = (_distance(row, Fraction(float(a.real)), Fraction(float(a.imag))) + spread) / slack
        digits = _digits(first)
        re, im = (round(Fraction(float(x)) * 10**digits) for x in (a.real, a.imag))
        unit = Fraction(1, 10**digits)
        radius = (_distance(row, re * unit, im * unit) + spread) / slack
        above = math.ceil(radius * 10**digits * (1 + Fraction(1, 10**6))) + 1
        found.append(RootDisc(decimal(re, digits), decimal(im, digits), decimal(above, digits)))
    return tuple(found)


def _distance(
    row: tuple[list[int], list[int], list[int], list[int]], re: Fraction, im: Fraction
) -> Fraction:
    """An upper limit of Σ_j |a G_ij − H_ij|, in units of the common denominator."""
    d = math.lcm(re.denominator, im.denominator)
    a, b = int(re * d), int(im * d)
    total = sum(
        modulus_above(a * p - b * q - d * r, a * q + b * p - d * s)
        for p, q, r, s in zip(*row, strict=True)
    )
    return Fraction(total, d)


def _digits(radius: Fraction) -> int:
    """The decimal places with which a radius has about three digits."""
    if radius <= 0:
        return _MOST_DIGITS
    size = math.log10(radius.numerator) - math.log10(radius.denominator)
    return min(max(3 - math.floor(size), 0), _MOST_DIGITS)
