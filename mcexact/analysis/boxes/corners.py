"""Corners of a box at which a loop fails first, in floating point.

The members of a box differ in each entry by at most its radius, and a corner is one in which all
entries differ by as much.  To the first order an eigenvalue moves most towards the border of the
region at the corner that the signs of its derivatives give; from where this corner fails the signs
are taken again.  Some rounds for the eigenvalues that seem to reach the border first give corners
at which the loop fails at a small part of the box (`first_to_fail`).  There may be nearer ones, and
nothing is proved.

The loops of a box are given by a `Family`: `PencilFamily` is that of `failing_loop`, and a search
of controllers has its own (`synthesis.optimum.corners`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]
Signs = tuple[Floats, ...]
"""−1, 0 or 1 for each entry of each matrix of a family."""
_MODES, _ROUNDS = 6, 3
_FIRST, _LEAST, _PRECISION, _CLOSE = 1e-4, 1e-12, 1e-6, 1e-13
WORK = 14
"""About how many spectra are computed for one distance."""


class Family(Protocol):
    """The loops of the members of a box, whose matrices depend on some matrices with radii.

    Attributes
    ----------
    discrete : bool
    edge : float
        The largest real part, or modulus, of an eigenvalue in the region.
    radii : tuple of ndarray
    """

    @property
    def discrete(self) -> bool: ...
    @property
    def edge(self) -> float: ...
    @property
    def radii(self) -> tuple[Floats, ...]: ...

    def loop(self, signs: Signs, size: float) -> Floats:
        """The loop of the member at a corner of the box whose radii are multiplied by a size."""

    def slopes(
        self, signs: Signs, size: float, left: Complexes, right: Complexes
    ) -> tuple[Complexes, ...]:
        """The derivatives of wMv in all entries at this member, for a row w and a column v."""


def first_to_fail(
    family: Family, modes: int = _MODES, spend: Callable[[], None] = lambda: None
) -> list[tuple[float, Signs]]:
    """Search corners at which a stable loop fails, and the sizes of the box: the least first.

    Parameters
    ----------
    family : Family
    modes : int
        From how many eigenvalues the search begins.
    spend : callable
        Called for every distance that is computed, which takes about `WORK` spectra.
    """
    middle = tuple(np.zeros(D.shape) for D in family.radii)
    values, left, right = _spectrum(family.loop(middle, 0.0))
    upper = [k for k, value in enumerate(values) if value.imag >= 0]
    starts = list[tuple[float, Signs]]()
    for k in upper:
        size = abs(values[k]) if family.discrete else values[k].real
        speed, signs = _towards_border(family, middle, 0.0, (values[k], left[:, k], right[:, k]))
        if speed > 0:
            starts.append(((family.edge - size) / speed, signs))
    starts.sort(key=lambda each: each[0])
    tried = [_from_corner(family, signs, near, spend) for near, signs in starts[:modes]]
    return sorted((each for each in tried if np.isfinite(each[0])), key=lambda each: each[0])


def distance_of(family: Family, signs: Signs, near: float = _FIRST) -> float:
    """The size of the box at which a loop fails at a corner; infinite from 1 on.

    Parameters
    ----------
    family : Family
    signs : tuple of ndarray
        The corner.
    near : float
        About the size that is expected.
    """

    from scipy.optimize import brentq

    def beyond(size: float) -> float:
        values = np.linalg.eigvals(family.loop(signs, size))
        sizes = np.abs(values) if family.discrete else values.real
        return float(np.max(sizes, initial=-np.inf)) - family.edge

    low = high = min(max(near, _LEAST), 1.0)
    while beyond(high) < 0:
        if high >= 1:
            return np.inf
        low, high = high, min(2 * high, 1.0)
    while low == high or beyond(low) >= 0:
        low, high = low / 2, low
        if high < _LEAST:
            return high
    size = float(brentq(beyond, low, high, rtol=_PRECISION, xtol=_PRECISION * low))
    # where entries of relative radii vanish the plant lacks a channel, which is no corner's doing
    return size if size < 1 - _PRECISION else np.inf


def _from_corner(
    family: Family, signs: Signs, near: float, spend: Callable[[], None]
) -> tuple[float, Signs]:
    """Go on from a corner to those that the eigenvalue on the border gives."""
    best = np.inf, signs
    for _ in range(_ROUNDS):
        distance = distance_of(family, signs, near)
        spend()
        if distance < best[0]:
            best = distance, signs
        if not np.isfinite(distance):
            break
        values, left, right = _spectrum(family.loop(signs, distance))
        k = int(np.argmax(np.abs(values) if family.discrete else values.real))
        mode = values[k], left[:, k], right[:, k]
        _, other = _towards_border(family, signs, distance, mode)
        if all(map(np.array_equal, other, signs)):
            break
        signs, near = other, distance
    return best


def _spectrum(M: Floats) -> tuple[Complexes, Complexes, Complexes]:
    """Eigenvalues, with left and right eigenvectors as columns."""
    from scipy.linalg import eig

    values, left, right = (np.asarray(each, dtype=np.complex128) for each in eig(M, left=True))
    return values, left, right


def _towards_border(
    family: Family, signs: Signs, size: float, mode: tuple[complex, Complexes, Complexes]
) -> tuple[float, Signs]:
    """How fast an eigenvalue moves towards the border of the region, and at which corner."""
    value, w, v = mode[0], mode[1].conj(), mode[2]
    paired = complex(w @ v) or _CLOSE
    outward = value.conjugate() / max(abs(value), 1e-300) if family.discrete else 1.0
    slopes = [
        np.real(outward / paired * S) * (D != 0)
        for S, D in zip(family.slopes(signs, size, w, v), family.radii, strict=True)
    ]
    speed = sum(float(np.sum(np.abs(S) * D)) for S, D in zip(slopes, family.radii, strict=True))
    return speed, tuple(map(np.sign, slopes))


@dataclass(frozen=True, eq=False)
class PencilFamily:
    """The loops of a pencil λE − Z with radii D of Z, of which the first rows and columns hold E.

    With Z = [Z₁₁, Z₁₂; Z₂₁, Z₂₂] the loop is M = Z₁₁ − Z₁₂Z₂₂⁻¹Z₂₁, and where wM = λw, Mv = λv

        d(wMv) = [w, −wZ₁₂Z₂₂⁻¹] dZ [v; −Z₂₂⁻¹Z₂₁v].

    Attributes
    ----------
    Z, D : ndarray
    states : int
    edge : float
    discrete : bool
    """

    Z: Floats
    D: Floats
    states: int
    edge: float
    discrete: bool

    @property
    def radii(self) -> tuple[Floats, ...]:
        """D."""
        return (self.D,)

    def loop(self, signs: Signs, size: float) -> Floats:
        """M at a corner."""
        Z, N = self.Z + size * signs[0] * self.D, self.states
        inner: Floats = Z[:N, :N] - Z[:N, N:] @ np.linalg.solve(Z[N:, N:], Z[N:, :N])
        return inner

    def slopes(
        self, signs: Signs, size: float, left: Complexes, right: Complexes
    ) -> tuple[Complexes, ...]:
        """The derivatives of wMv in the entries of Z."""
        Z, N = self.Z + size * signs[0] * self.D, self.states
        w = np.concatenate([left, -np.linalg.solve(Z[N:, N:].T, Z[:N, N:].T @ left)])
        v = np.concatenate([right, -np.linalg.solve(Z[N:, N:], Z[N:, :N] @ right)])
        return (np.outer(w, v),)
