"""Robustness measures of a closed loop, in floating point."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mcexact.exact.matrix import to_float
from mcexact.exact.roots import StabilityRegion, is_discrete

Array = NDArray[np.float64]

_STARTS = 4
_ANGLES = 16


@dataclass(frozen=True)
class LoopMargins:
    """Robustness measures of the matrix of a closed loop, computed in floating point.

    Attributes
    ----------
    spectral : float
        The largest real part (continuous time) or modulus (discrete time) of a computed
        eigenvalue: the abscissa or the radius.
    numerical : float
        The same for the numerical range {vᴴMv : |v| = 1}: the numerical abscissa or radius, which
        limits the growth of transients.
    distance_to_instability : float
        An upper limit on the least norm of a complex matrix E for which M + E is not stable; 0 if M
        is not stable.
    """

    spectral: float
    numerical: float
    distance_to_instability: float


def loop_margins(M: Array, time: str) -> LoopMargins:
    """Compute the robustness measures of a closed loop.

    Parameters
    ----------
    M : ndarray, N × N
    time : {"continuous", "discrete"}

    Examples
    --------
    >>> margins = loop_margins(np.array([[-1.0, 10.0], [0.0, -2.0]]), "continuous")
    >>> round(margins.spectral, 3), round(margins.numerical, 3)
    (-1.0, 3.525)
    >>> round(margins.distance_to_instability, 3)
    0.195
    """
    if len(M) == 0:
        return LoopMargins(spectral_bound(M, time), 0.0, np.inf)
    eigenvalues = np.linalg.eigvals(M).astype(np.complex128)
    return LoopMargins(
        spectral_bound(M, time),
        _numerical_bound(M, time),
        _distance_to_instability(M, time, eigenvalues),
    )


def spectral_bound(M: Array, time: str) -> float:
    """The largest real part or modulus of an eigenvalue, as `numpy.linalg.eigvals` computes it."""
    if len(M) == 0:
        return 0.0 if is_discrete(time) else -np.inf
    eigenvalues = np.linalg.eigvals(M).astype(np.complex128)
    return float(np.max(np.abs(eigenvalues) if is_discrete(time) else eigenvalues.real))


def is_within(M: Array, region: StabilityRegion) -> bool:
    """Whether the computed eigenvalues lie in a region, with its limits."""
    if not spectral_bound(M, region.time) < to_float(region.limit):
        return False
    if not region.limits:
        return True
    eigenvalues = np.linalg.eigvals(M).astype(np.complex128)
    sizes = np.abs(eigenvalues)
    damping, most = region.damping, region.largest_modulus
    if most is not None and not np.all(sizes < to_float(most)):
        return False
    return damping is None or bool(np.all(-eigenvalues.real > to_float(damping) * sizes))


def _numerical_bound(M: Array, time: str) -> float:
    """The numerical abscissa; the numerical radius over a grid of angles."""
    angles = np.linspace(0.0, np.pi, _ANGLES + 1) if is_discrete(time) else [0.0]
    turned = [np.exp(1j * angle) * M for angle in angles]
    return max(float(np.linalg.eigvalsh((each + each.conj().T) / 2)[-1]) for each in turned)


def _distance_to_instability(M: Array, time: str, eigenvalues: NDArray[np.complex128]) -> float:
    """Find the least σ_min(zI − M) on the boundary, by local searches from near eigenvalues."""
    from scipy.optimize import minimize_scalar

    discrete = is_discrete(time)
    sizes = np.abs(eigenvalues) if discrete else eigenvalues.real
    if np.max(sizes) >= to_float(StabilityRegion(time).limit):
        return 0.0
    order, positions = np.argsort(-sizes), np.angle(eigenvalues) if discrete else eigenvalues.imag

    def least(position: float) -> float:
        return smallest_singular_value(
            M, complex(np.exp(1j * position)) if discrete else 1j * position
        )

    starts = {abs(float(positions[k])) for k in order[: 2 * _STARTS]}
    distance = min(least(start) for start in starts | {0.0})
    for start in sorted(starts, key=least)[:_STARTS]:
        width = 0.5 if discrete else max(0.5, abs(start) / 2)
        search = minimize_scalar(
            least,
            bounds=(start - width, start + width),
            method="bounded",
            options={"maxiter": 12},
        )
        distance = min(distance, float(search.fun))
    return distance


def smallest_singular_value(M: Array, z: complex) -> float:
    """σ_min(zI − M), from above: inverse iteration on one factorization, 0 if it is singular."""
    from scipy.linalg import lu_factor, lu_solve

    N = len(M)
    with warnings.catch_warnings():
        # A singular matrix means that the distance is 0.
        warnings.simplefilter("ignore")
        factored = lu_factor(z * np.eye(N) - M)
        if not np.all(np.diag(factored[0])):
            return 0.0
        v = np.ones(N, dtype=np.complex128) / np.sqrt(N)
        length = 0.0
        for _ in range(8):
            w = lu_solve(factored, lu_solve(factored, v), trans=2)
            length = float(np.linalg.norm(w))
            if not np.isfinite(length) or length == 0.0:
                return 0.0
            v = w / length
    return float(1 / np.sqrt(length))
