"""Controllability of a pair by the numerical rank of its controllability matrix."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def controllability_matrix(A: NDArray[np.float64], B: NDArray[np.float64]) -> NDArray[np.float64]:
    """Build [B, AB, …, A^(n−1)B], shape (n, n·p).

    Parameters
    ----------
    A : ndarray, shape (n, n)
    B : ndarray, shape (n, p)

    Returns
    -------
    ndarray, shape (n, n·p)

    Examples
    --------
    >>> A = np.array([[0.0, 1.0], [0.0, 0.0]])
    >>> controllability_matrix(A, np.array([[0.0], [1.0]]))
    array([[0., 1.],
           [1., 0.]])
    """
    blocks = [B]
    for _ in range(A.shape[0] - 1):
        blocks.append(A @ blocks[-1])
    return np.hstack(blocks)


def controllability_rank(A: NDArray[np.float64], B: NDArray[np.float64]) -> int:
    """Rank of the controllability matrix at the default tolerance of `numpy.linalg.matrix_rank`.

    Parameters
    ----------
    A : ndarray, shape (n, n)
    B : ndarray, shape (n, p)

    Returns
    -------
    int

    Notes
    -----
    Powers of A grow apart, so the tolerance, which is relative to the largest singular value, takes
    directions for zero that are not.

    Examples
    --------
    The rank of this pair is 20:

    >>> controllability_rank(np.diag(np.arange(1.0, 21.0)), np.ones((20, 1)))
    7
    """
    return int(np.linalg.matrix_rank(controllability_matrix(A, B)))
