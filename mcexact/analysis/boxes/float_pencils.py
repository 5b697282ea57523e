"""Pencils λE − Z0 of boxes in floating point, and the evidence that they propose for a disc."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
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
from mcexact.exact.blocks import hstack, vstack
from mcexact.exact.floats import matrix_to_float
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem
from mcexact.model.uncertainty import Radii, moduli

Complex = npt.NDArray[np.complexfloating[Any, Any]]
Floats = npt.NDArray[np.floating[Any]]

_ROOM = 0.998
"""The part of 1 below which the norm is to be in floating point."""


@dataclass(frozen=True)
class FloatBox:
    """The matrices of a box in coordinates that are balanced by powers of 2.

    Attributes
    ----------
    A, DA : ndarray, n × n
    B, C, DB, DC : tuples of ndarray
    scale : ndarray, n
        x = scale · z, where z are the balanced states.
    """

    A: Floats
    B: tuple[Floats, ...]
    C: tuple[Floats, ...]
    DA: Floats
    DB: tuple[Floats, ...]
    DC: tuple[Floats, ...]
    scale: Floats

    @classmethod
    def of(cls, system: MultiChannelSystem, radii: Radii) -> FloatBox:
        """Make it of a system and the radii of its entries."""
        from scipy.linalg import matrix_balance

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
            s,
        )

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
    """

    Z0: Matrix
    D: Matrix
    n: int
    scale: Floats

    @cached_property
    def balanced(self) -> tuple[Floats, Floats, Floats]:
        """Z0, D and the diagonal of E, in balanced coordinates."""
        rows, cols = (1 / self.scale)[:, None], self.scale[None, :]
        E = np.zeros(len(self.scale))
        E[: self.n] = 1
        return matrix_to_float(self.Z0) * rows * cols, matrix_to_float(self.D) * rows * cols, E

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
        size, _, _ = perron(np.abs(Y) @ self.balanced[1])
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
        size = np.abs(V)
        w = weights(size @ (g * D + rho * np.diag(E)))
        if w is None:
            return None
        unit = w[:, None] / (len(w) * (np.abs(c * np.diag(E) - Z0) @ w + g * D @ w))[None, :]
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
        return RegularDiscs(
            V,
            K,
            V.before(E),
            w,
            entries(size @ (self.D * growth @ heavy)),
            entries(size @ (E @ heavy)),
        )


def gain_pencil(
    system: MultiChannelSystem,
    radii: Radii,
    scale: Floats,
    X: Sequence[Matrix] | None = None,
    W: Sequence[Matrix] | None = None,
) -> Pencil:
    """The pencil [[λI − A, −B], [XC, W]], which is regular where λ is not fixed.

    Without gains it is λI − A.  X and W are block diagonal by channel:

        Z0 = [[A, B], [−X C, −W]],   D = [[D_A, D_B], [|X| D_C, 0]].
    """
    if X is None or W is None:
        return Pencil(system.A, radii.A, system.n, scale)
    p = sum(system.p(i) for i in range(system.m))
    Z0 = [hstack([system.A, *system.B], nrows=system.n)]
    D = [hstack([radii.A, *radii.B], nrows=system.n)]
    start = 0
    for X_i, W_i, C_i, DC_i in zip(X, W, system.C, radii.C, strict=True):
        size = W_i.nrows
        left, right = Matrix.zeros(size, start), Matrix.zeros(size, p - start - size)
        Z0.append(hstack([-(X_i @ C_i), left, -W_i, right], nrows=size))
        D.append(hstack([moduli(X_i) @ DC_i, Matrix.zeros(size, p)], nrows=size))
        start += size
    width = system.n + p
    full = np.concatenate([scale, np.ones(p)])
    return Pencil(vstack(Z0, ncols=width), vstack(D, ncols=width), system.n, full)


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


def perron(N: Floats, squarings: int = 10) -> tuple[float, Floats, Floats]:
    """The spectral radius of a matrix N ≥ 0, and about its right and left positive vectors."""
    size = len(N)
    top = N.sum(axis=1).max(initial=0.0)
    if not (np.isfinite(top) and top > 0):
        return float(top), np.ones(size), np.ones(size)
    # The shift keeps powers from alternating, and all entries above 0.
    P = N / top + 0.1 * np.eye(size) + 1e-13 / size
    for _ in range(squarings):
        P = P @ P
        P /= P.max()
    right, left = P.sum(axis=1), P.sum(axis=0)
    right, left = right / right.max(), left / left.max()
    value = float(left @ N @ right / (left @ right))
    return value, right, left
