"""Pencils λE − Z0 of boxes in floating point, and the evidence that they propose for a disc."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from mcexact.analysis.boxes.regular_discs import (
    ComplexRows,
    RegularDiscs,
    column,
    dyadic,
    entries,
    whole_weights,
)
from mcexact.exact.matrix import Matrix, hstack, matrix_to_float, vstack
from mcexact.model.radii import Radii, moduli
from mcexact.model.system import MultiChannelSystem

Complex = npt.NDArray[np.complexfloating[Any, Any]]
Floats = npt.NDArray[np.floating[Any]]

_ROOM = 0.998
"""The part of 1 below which the norm is to be in floating point."""
_ROOT = 4


@dataclass(frozen=True)
class FloatBox:
    """The matrices of a box in coordinates that are balanced by powers of 2.

    Attributes
    ----------
    A, DA : ndarray, n × n
    B, C, DB, DC : tuples of ndarray
        Radii are those of entries that are independent, with the moduli of those that are tied.
    rest_A : ndarray, n × n
        The radii of A without those of entries that are tied.
    tied_A : tuple of ndarray
        What may be added to A with a factor from −1 to 1.
    scale : ndarray, n
        x = scale · z, where z are the balanced states.
    """

    A: Floats
    B: tuple[Floats, ...]
    C: tuple[Floats, ...]
    DA: Floats
    DB: tuple[Floats, ...]
    DC: tuple[Floats, ...]
    rest_A: Floats
    tied_A: tuple[Floats, ...]
    scale: Floats

    @classmethod
    def of(
        cls, system: MultiChannelSystem, radii: Radii, tied: Sequence[MultiChannelSystem] = ()
    ) -> FloatBox:
        """Make it of a system, the radii of its entries, and what may be added to it."""
        from scipy.linalg import matrix_balance

        free = independent(radii, tied)

        A = matrix_to_float(system.A)
        s: Floats = np.ones(system.n)
        if system.n:
            _, (s, _) = matrix_balance(A, permute=False, separate=True)
        rows, cols = (1 / s)[:, None], s[None, :]
        return cls(
            A * rows * cols,
            tuple(matrix_to_float(M) * rows for M in system.B),
            tuple(matrix_to_float(M) * cols for M in system.C),
            matrix_to_float(free.A) * rows * cols,
            tuple(matrix_to_float(M) * rows for M in free.B),
            tuple(matrix_to_float(M) * cols for M in free.C),
            matrix_to_float(radii.A) * rows * cols,
            tuple(matrix_to_float(each.A) * rows * cols for each in tied),
            s,
        )

    def moved(self, Y: Complex, T: Complex) -> Floats:
        """An upper limit of the moduli of Y (A' − A) T for all members A'."""
        rest = np.abs(Y) @ self.rest_A @ np.abs(T)
        return np.asarray(rest + sum(np.abs(Y @ M @ T) for M in self.tied_A))

    def wider(self, size: float) -> FloatBox:
        """The box in which the diagonal of A may change by so much more.

        What is regular at a point for all its members is regular for those of this box on the disc
        around the point with that radius.
        """
        return replace(self, DA=self.DA + size * np.eye(self.n))

    @property
    def n(self) -> int:
        """The number of states."""
        return len(self.A)

    def modes(self) -> list[complex]:
        """One number near each group of eigenvalues of A in the closed upper half-plane."""
        found: list[complex] = []
        size = np.linalg.norm(self.A)
        for value in np.linalg.eigvals(self.A):
            near = (abs(value - x) <= 1e-3 * max(abs(value), 1e-9 * size) for x in found)
            if value.imag >= -1e-12 * abs(value) and not any(near):
                found.append(complex(value.real, max(value.imag, 0.0)))
        return found


@dataclass(frozen=True, eq=False)
class Pencil:
    """Z(λ) = λE − Z0 with E = diag(I_n, 0) and radii D, exactly.

    Attributes
    ----------
    Z0, D : Matrix, N × N
    n : int
    scale : ndarray, N
        Powers of 2, by which the coordinates are balanced.
    tied : tuple of Matrix
        What may be added to Z0, each with a factor from −1 to 1.
    """

    Z0: Matrix
    D: Matrix
    n: int
    scale: Floats
    tied: tuple[Matrix, ...] = ()

    @cached_property
    def balanced(self) -> tuple[Floats, Floats, Floats]:
        """Z0, D and the diagonal of E, in balanced coordinates."""
        rows, cols = (1 / self.scale)[:, None], self.scale[None, :]
        E = np.zeros(len(self.scale))
        E[: self.n] = 1
        return matrix_to_float(self.Z0) * rows * cols, matrix_to_float(self.D) * rows * cols, E

    @cached_property
    def balanced_ties(self) -> tuple[Floats, ...]:
        """What may be added to Z0, in balanced coordinates."""
        rows, cols = (1 / self.scale)[:, None], self.scale[None, :]
        return tuple(matrix_to_float(M) * rows * cols for M in self.tied)

    def moved(self, V: Complex) -> Floats:
        """An upper limit of the moduli of V (Z0' − Z0) for all members Z0'."""
        return np.asarray(
            np.abs(V) @ self.balanced[1] + sum(np.abs(V @ M) for M in self.balanced_ties)
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
        size, _, _ = perron(self.moved(Y))
        return 1 / size if size > 0 else np.inf

    def proposal(self, c: complex, rho: float, growth: Fraction) -> RegularDiscs | None:
        """Evidence that the pencil is regular on a disc, if floating point finds some.

        Parameters
        ----------
        c, rho
            Center and radius.
        growth : Fraction
            The factor of all radii.
        """
        g = float(growth)
        V = self.inverse(c)
        if V is None:
            return None
        Z0, D, E = self.balanced
        w = weights(g * self.moved(V) + rho * np.abs(V) @ np.diag(E))
        if w is None:
            return None
        free = D + sum(map(np.abs, self.balanced_ties))
        unit = w[:, None] / (len(w) * (np.abs(c * np.diag(E) - Z0) @ w + g * free @ w))[None, :]
        turned = self.scale[:, None] / self.scale[None, :]
        exact = dyadic(V * turned, unit * turned)
        return self.tested(exact, whole_weights(w * self.scale), growth)

    def tested(self, V: ComplexRows, w: tuple[int, ...], growth: Fraction) -> RegularDiscs:
        """The exact test with V and w, of radii that are multiplied by a factor."""
        N = len(w)
        one, heavy = ComplexRows.of(Matrix.identity(N)), column(w)
        K = one + V.before(self.Z0)
        E = Matrix.from_entries((N, N), ((i, i, 1) for i in range(self.n)))
        size = V.moduli()
        moved = size @ (self.D @ heavy)
        for M in self.tied:
            moved = moved + V.before(M).moduli() @ heavy
        return RegularDiscs(
            V,
            K,
            V.before(E),
            w,
            entries(moved * growth),
            entries(size @ (E @ heavy)),
        )


def independent(radii: Radii, tied: Sequence[MultiChannelSystem]) -> Radii:
    """The radii of a box of independent entries that contains all members."""
    A, B, C = radii.A, list(radii.B), list(radii.C)
    for each in tied:
        A = A + moduli(each.A)
        B = [D + moduli(M) for D, M in zip(B, each.B, strict=True)]
        C = [D + moduli(M) for D, M in zip(C, each.C, strict=True)]
    return Radii(A, B, C)


def gain_pencil(
    system: MultiChannelSystem,
    radii: Radii,
    scale: Floats,
    X: Sequence[Matrix] | None = None,
    W: Sequence[Matrix] | None = None,
    tied: Sequence[MultiChannelSystem] = (),
) -> Pencil:
    """The pencil [[λI − A, −B], [XC, W]], which is regular where λ is not fixed.

    Without gains it is λI − A.  X and W are block diagonal by channel:

        Z0 = [[A, B], [−X C, −W]],   D = [[D_A, D_B], [|X| D_C, 0]].
    """
    n = system.n
    if X is None or W is None:
        return Pencil(system.A, radii.A, n, scale, tuple(each.A for each in tied))
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
    moved = [moduli(X_i) @ DC_i for X_i, DC_i in zip(X, radii.C, strict=True)]
    return Pencil(
        of(system, [-W_i for W_i in W]),
        whole(radii.A, radii.B, moved, zeros),
        n,
        np.concatenate([scale, np.ones(p)]),
        tuple(of(each, zeros) for each in tied),
    )


def weights(N: Floats) -> Floats | None:
    """A vector w > 0 with N w < w, for N ≥ 0; None if floating point finds none."""
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
    """The spectral radius of a matrix N ≥ 0, and about its right and left positive vectors.

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
