"""Controllability of a pair by the numerical rank of its controllability matrix."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mcexact.errors import MissingExtra


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
    The columns A^k B differ in size, so that the tolerance, which is relative to the largest
    singular value, treats some nonzero directions as zero.

    Examples
    --------
    The rank of this pair is 20; the computed rank is smaller and depends on the processor:

    >>> controllability_rank(np.diag(np.arange(1.0, 21.0)), np.ones((20, 1))) < 20
    True
    """
    return int(np.linalg.matrix_rank(controllability_matrix(A, B)))


def ctrb_rank(A: NDArray[np.float64], B: NDArray[np.float64]) -> int:
    """Rank of python-control's controllability matrix, at numpy's default tolerance.

    Parameters
    ----------
    A : ndarray, shape (n, n)
    B : ndarray, shape (n, p)

    Raises
    ------
    MissingExtra
        If python-control is not installed.
    """
    with MissingExtra.named("control"):
        import control

    return int(np.linalg.matrix_rank(control.ctrb(A, B)))


def obsv_rank(A: NDArray[np.float64], C: NDArray[np.float64]) -> int:
    """Rank of python-control's observability matrix, at numpy's default tolerance.

    Parameters
    ----------
    A : ndarray, shape (n, n)
    C : ndarray, shape (q, n)

    Raises
    ------
    MissingExtra
        If python-control is not installed.
    """
    with MissingExtra.named("control"):
        import control

    return int(np.linalg.matrix_rank(control.obsv(A, C)))


def hautus_controllable(A: NDArray[np.float64], B: NDArray[np.float64]) -> bool:
    """Whether [λI − A, B] has full rank at every computed eigenvalue, at numpy's tolerance.

    Parameters
    ----------
    A : ndarray, shape (n, n)
    B : ndarray, shape (n, p)

    Notes
    -----
    A computed eigenvalue differs from the exact one.  For a multiple eigenvalue the error is of the
    order of a root of the machine precision, so that the rank does not drop.

    Examples
    --------
    The block of size 3 is not controllable:

    >>> hautus_controllable(np.array([[0.0, 1, 0], [0, 0, 1], [0, 0, 0]]), np.eye(3)[:, :1])
    False
    """
    n = A.shape[0]
    return all(
        np.linalg.matrix_rank(np.hstack([value * np.eye(n) - A, B])) == n
        for value in np.linalg.eigvals(A)
    )


def controllability_index(A: NDArray[np.float64], B: NDArray[np.float64]) -> int | None:
    """The least ν with rank [B, AB, …, A^(ν−1)B] = n at numpy's default tolerance, or None.

    Parameters
    ----------
    A : ndarray, shape (n, n)
    B : ndarray, shape (n, p)

    Examples
    --------
    >>> controllability_index(np.array([[0.0, 1.0], [0.0, 0.0]]), np.array([[0.0], [1.0]]))
    2
    """
    n, p = B.shape
    if n == 0:
        return 0
    K = controllability_matrix(A, B)
    ranks = (np.linalg.matrix_rank(K[:, : index * p]) for index in range(1, n + 1))
    return next((index for index, rank in enumerate(ranks, start=1) if rank == n), None)
