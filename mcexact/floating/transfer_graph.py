"""The transfer graph by computed transfer functions."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def transfer_edges(A: Array, B: Sequence[Array], C: Sequence[Array]) -> frozenset[tuple[int, int]]:
    """Find the pairs (j, i) for which `scipy.signal.ss2tf` gives a numerator not close to 0.

    Parameters
    ----------
    A : ndarray, shape (n, n)
    B, C : sequences of ndarray, shapes (n, p_i) and (q_i, n)

    Notes
    -----
    Close to 0 by `numpy.allclose` at its default tolerance.  The numerators are differences of
    characteristic polynomials, whose coefficients carry rounding errors of their own size.

    Examples
    --------
    >>> B = [np.array([[1.0], [0.0]]), np.array([[0.0], [1.0]])]
    >>> C = [np.array([[1.0, 0.0]]), np.array([[0.0, 1.0]])]
    >>> sorted(transfer_edges(np.array([[1.0, 0.0], [1.0, 2.0]]), B, C))
    [(0, 0), (0, 1), (1, 1)]
    """
    from scipy.signal import ss2tf

    sizes = [C_i.shape[0] for C_i in C]
    ends = np.cumsum([0, *sizes])
    outputs = np.vstack([np.zeros((0, A.shape[0])), *C])
    edges = set()
    with warnings.catch_warnings():
        # scipy warns of leading coefficients that are nearly 0, which are part of its answer.
        warnings.simplefilter("ignore")
        for j, B_j in enumerate(B):
            for k in range(B_j.shape[1]):
                if not len(outputs) or not len(A):
                    continue
                direct = np.zeros((len(outputs), B_j.shape[1]))
                numerators, _ = ss2tf(A, B_j, outputs, direct, input=k)
                for i in range(len(C)):
                    if not np.allclose(numerators[ends[i] : ends[i + 1]], 0):
                        edges.add((j, i))
    return frozenset(edges)
