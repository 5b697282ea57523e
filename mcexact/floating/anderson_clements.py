"""Fixed modes by the numerical rank of Anderson and Clements' pencil at computed eigenvalues."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def pencil_fixed_modes(
    A: Array, B: Sequence[Array], C: Sequence[Array], subsets: Iterable[frozenset[int]]
) -> tuple[complex, ...]:
    """Computed eigenvalues of A at which a pencil [λI − A, B_{m−s}; C_s, 0] has rank below n.

    Parameters
    ----------
    A : ndarray, shape (n, n)
    B, C : sequences of ndarray, shapes (n, p_i) and (q_i, n)
    subsets : iterable of frozenset
        The sets s of channels to try.

    Returns
    -------
    tuple of complex
        Where `numpy.linalg.matrix_rank`, at its default tolerance, finds the rank below n; sorted.

    Examples
    --------
    >>> B, C = [np.array([[1.0], [0.0]])], [np.array([[1.0, 0.0]])]
    >>> pencil_fixed_modes(np.diag([1.0, 2.0]), B, C, [frozenset()])
    ((2+0j),)
    """
    n, found = A.shape[0], []
    chosen = list(subsets)
    for value in np.linalg.eigvals(A):
        ranks = (np.linalg.matrix_rank(pencil(A, B, C, s, value)) for s in chosen)
        if any(rank < n for rank in ranks):
            found.append(complex(value))
    return tuple(sorted(found, key=lambda each: (each.real, each.imag)))


def pencil(
    A: Array, B: Sequence[Array], C: Sequence[Array], subset: frozenset[int], value: complex
) -> NDArray[np.complex128]:
    """P_s(λ) = [λI − A, B_{m−s}; C_s, 0] as one array."""
    n = A.shape[0]
    inputs = np.hstack([np.zeros((n, 0)), *(B_i for i, B_i in enumerate(B) if i not in subset)])
    outputs = np.vstack([np.zeros((0, n)), *(C_i for i, C_i in enumerate(C) if i in subset)])
    corner = np.zeros((outputs.shape[0], inputs.shape[1]))
    return np.block([[value * np.eye(n) - A, inputs], [outputs, corner]]).astype(np.complex128)


def few_subsets(m: int) -> frozenset[frozenset[int]]:
    """No channel, all, every single one, and every complement of one: 2m + 2 sets at most."""
    everyone = frozenset(range(m))
    singles = {frozenset({i}) for i in range(m)}
    return frozenset({frozenset(), everyone} | singles | {everyone - single for single in singles})
