"""An upper limit on the distance from a system to one with a fixed mode, from singular values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mcexact.floating.anderson_clements import few_subsets

Array = NDArray[np.float64]

_ROUNDS = 50


@dataclass(frozen=True)
class FixedModeDistance:
    """A perturbation, computed in floating point, that gives the system a fixed mode.

    Attributes
    ----------
    distance : float
        The largest singular value of [ΔA; ΔC_s], or of [ΔA, ΔB_T], an upper limit on the distance.
    mode : complex
        The fixed mode that the perturbed system has.
    channels : tuple of int
        T; the outputs of the other channels, s, do not show the mode.
    changed : {"outputs", "inputs"}
        Whether A and C_s, or A and B_T, are perturbed.
    dA : ndarray, shape (n, n)
    dB, dC : sequences of ndarray
        The perturbation, which is complex if the mode is.
    """

    distance: float
    mode: complex
    channels: tuple[int, ...]
    changed: str
    dA: NDArray[np.complex128]
    dB: tuple[NDArray[np.complex128], ...]
    dC: tuple[NDArray[np.complex128], ...]


def fixed_mode_distance(
    A: Array, B: Sequence[Array], C: Sequence[Array]
) -> FixedModeDistance | None:
    """Find a small perturbation that gives the system a fixed mode; None if there are no states.

    Parameters
    ----------
    A : ndarray, shape (n, n)
    B, C : sequences of ndarray, shapes (n, p_i) and (q_i, n)

    Notes
    -----
    Floating point, an upper bound.  With Π the projection onto the complement of im B_T and s the
    complement of T, (T, U) is a shrunk subspace at λ if M U = 0, M = [Π(λI − A); C_s], and U has
    rank B_T + 1 columns.  The least ‖MU‖ over orthonormal U is a singular value of M, and the
    perturbation ΔA = Π(λI − A)UUᴴ, ΔC_s = −C_sUUᴴ of this norm makes it 0.  The same for the dual
    system.  The search starts at the computed eigenvalues and at a few sets T; it then descends in
    λ and changes T by one channel at a time.

    Examples
    --------
    >>> B, C = [np.array([[1.0], [1e-3]])], [np.array([[1.0, 1.0]])]
    >>> found = fixed_mode_distance(np.diag([1.0, 2.0]), B, C)
    >>> found.distance <= 1e-3, found.changed, round(found.mode.real, 2)
    (True, 'inputs', 2.0)
    """
    n = A.shape[0]
    if n == 0:
        return None
    best: tuple[float, complex, frozenset[int], str] | None = None
    transposed = ([C_i.T for C_i in C], [B_i.T for B_i in B])
    for changed, A_, B_, C_ in (("outputs", A, B, C), ("inputs", A.T, *transposed)):
        for value in _distinct(np.linalg.eigvals(A_).astype(np.complex128)):
            T, size = _best_channels(A_, B_, C_, value)
            if best is None or size < best[0]:
                best = (size, value, T, changed)
    if best is None:
        return None
    _, value, T, changed = best
    A_, B_, C_ = (A, list(B), list(C)) if changed == "outputs" else (A.T, *transposed)
    value = _downhill(A_, B_, C_, T, value)
    return _perturbation(A_, B_, C_, T, value, changed)


def distance_at(
    A: Array, B: Sequence[Array], C: Sequence[Array], value: complex
) -> tuple[float, tuple[int, ...]]:
    """Return an upper limit on the least change that gives the system a fixed mode at a number.

    Returns
    -------
    distance : float
        As in `FixedModeDistance`.
    channels : tuple of int
        T, as there.

    Examples
    --------
    >>> B, C = [np.array([[1.0], [1e-3]])], [np.array([[1.0, 1.0]])]
    >>> distance_at(np.diag([1.0, 2.0]), B, C, 2.0)[0] <= 1e-3
    True
    """
    T, size = _best_channels(A, B, C, value)
    transposed = ([C_i.T for C_i in C], [B_i.T for B_i in B])
    s, dual = _best_channels(A.T, *transposed, value)
    if dual < size:
        return dual, tuple(i for i in range(len(B)) if i not in s)
    return size, tuple(sorted(T))


def _distinct(values: NDArray[np.complex128]) -> list[complex]:
    """Return one number of each conjugate pair."""
    return [complex(value) for value in values if value.imag >= 0]


def _obstruction(
    A: Array, B: Sequence[Array], C: Sequence[Array], T: frozenset[int], value: complex
) -> tuple[NDArray[np.complex128], int]:
    """Return M = [Π(λI − A); C_s] and the required number of columns of U."""
    n = A.shape[0]
    inputs = np.hstack([np.zeros((n, 0)), *(B[i] for i in sorted(T))])
    basis, sizes, _ = np.linalg.svd(inputs, full_matrices=False)
    rank = int(np.sum(sizes > np.finfo(float).eps * max(inputs.shape) * np.max(sizes, initial=0)))
    image = basis[:, :rank]
    project = np.eye(n) - image @ image.T
    rest = [C[i] for i in range(len(C)) if i not in T]
    return np.vstack([project @ (value * np.eye(n) - A), *rest]).astype(np.complex128), rank + 1


def _size(
    A: Array, B: Sequence[Array], C: Sequence[Array], T: frozenset[int], value: complex
) -> float:
    """The least ‖MU‖; infinite if im B_T is everything."""
    M, u = _obstruction(A, B, C, T, value)
    n = A.shape[0]
    if u > n:
        return np.inf
    return abs(float(np.linalg.svd(M, compute_uv=False)[n - u]))


def _best_channels(
    A: Array, B: Sequence[Array], C: Sequence[Array], value: complex
) -> tuple[frozenset[int], float]:
    """Find the best of a few sets T, then improve it one channel at a time."""
    T = min(few_subsets(len(B)), key=lambda each: (_size(A, B, C, each, value), sorted(each)))
    size = _size(A, B, C, T, value)
    for _ in range(_ROUNDS):
        near = [T ^ {i} for i in range(len(B))]
        sizes = [_size(A, B, C, each, value) for each in near]
        k = int(np.argmin(sizes))
        if not sizes[k] < size:
            break
        T, size = near[k], sizes[k]
    return T, size


def _downhill(
    A: Array, B: Sequence[Array], C: Sequence[Array], T: frozenset[int], value: complex
) -> complex:
    """Minimize the singular value over λ; a real λ stays real."""
    from scipy.optimize import minimize

    real = value.imag == 0

    def at(point: Array) -> float:
        moved = complex(point[0], 0.0 if real else point[1])
        return _size(A, B, C, T, moved)

    start = np.array([value.real] if real else [value.real, value.imag])
    if not np.isfinite(at(start)):
        return value
    found = minimize(at, start, method="Nelder-Mead", options={"maxiter": 200})
    if found.fun >= at(start):
        return value
    return complex(found.x[0], 0.0 if real else found.x[1])


def _perturbation(
    A: Array,
    B: Sequence[Array],
    C: Sequence[Array],
    T: frozenset[int],
    value: complex,
    changed: str,
) -> FixedModeDistance | None:
    """Make the perturbation of the given system, which is transposed for the dual."""
    n = A.shape[0]
    M, u = _obstruction(A, B, C, T, value)
    if u > n:
        return None
    _, sizes, right = np.linalg.svd(M, full_matrices=True)
    U = right[n - u :].conj().T
    onto = U @ U.conj().T
    dA = M[:n] @ onto
    dC = tuple(
        -C_i @ onto if i not in T else np.zeros(C_i.shape, complex) for i, C_i in enumerate(C)
    )
    size = abs(float(sizes[n - u]))
    none = tuple(np.zeros(B_i.shape, complex) for B_i in B)
    if changed == "outputs":
        return FixedModeDistance(size, value, tuple(sorted(T)), changed, dA, none, dC)
    acting = tuple(i for i in range(len(B)) if i not in T)
    turned = tuple(each.T for each in dC)
    return FixedModeDistance(
        size, value, acting, changed, dA.T, turned, tuple(each.T for each in none)
    )
