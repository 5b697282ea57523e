"""An upper limit on the distance from a system to one with a fixed mode, from singular values."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mcexact.floating.anderson_clements import few_subsets

Array = NDArray[np.float64]

_ROUNDS = 50


def distance_at(
    A: Array, B: Sequence[Array], C: Sequence[Array], value: complex
) -> tuple[float, tuple[int, ...]]:
    """Return an upper limit on the least change that gives the system a fixed mode at a number.

    Returns
    -------
    distance : float
        The largest singular value of a change [ΔA; ΔC_s], or of [ΔA, ΔB_T], that does it.
    channels : tuple of int
        T; the outputs of the other channels, s, do not show the mode.

    Notes
    -----
    Floating point, an upper bound.  With Π the projection onto the complement of im B_T and s the
    complement of T, (T, U) is a shrunk subspace at λ if M U = 0, M = [Π(λI − A); C_s], and U has
    rank B_T + 1 columns.  The least ‖MU‖ over orthonormal U is a singular value of M, and the
    perturbation ΔA = Π(λI − A)UUᴴ, ΔC_s = −C_sUUᴴ of this norm makes it 0.  The same for the dual
    system.  A few sets T are tried, and then changed by one channel at a time.

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
