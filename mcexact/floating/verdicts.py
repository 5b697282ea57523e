"""Fixed modes, controllability and transfer graph in floating point.

These are the usual numerical methods, at the default tolerances of numpy and scipy, to compare with
exact answers; some of their verdicts are wrong, and the docstrings say why.

- Fixed modes: the rank of [λI − A, B_{m−s}; C_s, 0] at computed eigenvalues (Anderson and
  Clements), at every given set s; or the rounded eigenvalues that several random gains share.
  The second method can miss modes that are multiple eigenvalues.
- An upper limit on the distance from the system to one with a fixed mode (`distance_at`), from
  singular values, over a few sets of channels improved one channel at a time.
- Controllability: the rank of [B, AB, …, A^(n−1)B], here and by python-control, and the Hautus test
  at computed eigenvalues.
- The transfer graph: the numerators that `scipy.signal.ss2tf` computes.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from mcexact.errors import MissingExtra

# Fixed modes by the numerical rank of Anderson and Clements' pencil at computed eigenvalues.

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
    n, modes = A.shape[0], []
    chosen = list(subsets)
    for value in np.linalg.eigvals(A):
        ranks = (np.linalg.matrix_rank(pencil(A, B, C, s, value)) for s in chosen)
        if any(rank < n for rank in ranks):
            modes.append(complex(value))
    return tuple(sorted(modes, key=lambda each: (each.real, each.imag)))


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


# Fixed modes by intersecting the rounded closed-loop eigenvalues of drawn gains.


def rounded_fixed_modes(
    A: Array,
    B: Sequence[Array],
    C: Sequence[Array],
    *,
    digits: int,
    seed: int,
    draws: int = 5,
) -> tuple[complex, ...]:
    """Find the rounded eigenvalues that occur in the closed loop of every drawn gain.

    Parameters
    ----------
    A : ndarray, shape (n, n)
    B, C : sequences of ndarray, shapes (n, p_i) and (q_i, n)
    digits : int
        Decimal digits to which the eigenvalues are rounded.
    seed : int
        The seed of the generator that draws the gains.
    draws : int
        The number of closed loops that are intersected.

    Returns
    -------
    tuple of complex
        The apparent fixed modes, sorted.

    Notes
    -----
    A fixed mode that is a multiple eigenvalue is computed with an error of the order of a root of
    the machine precision, so that its rounded values differ between draws.

    Examples
    --------
    A simple uncontrollable mode, here 2, is found:

    >>> import numpy as np
    >>> B, C = [np.array([[1.0], [0.0]])], [np.array([[1.0, 0.0]])]
    >>> rounded_fixed_modes(np.diag([1.0, 2.0]), B, C, digits=8, seed=0)
    ((2+0j),)
    """
    generator = np.random.default_rng(seed)
    common: set[complex] | None = None
    for _ in range(draws):
        closed_loop = A.copy()
        for B_i, C_i in zip(B, C, strict=True):
            gain = generator.standard_normal((B_i.shape[1], C_i.shape[0]))
            closed_loop += B_i @ gain @ C_i
        rounded = np.round(np.linalg.eigvals(closed_loop), digits)
        spectrum = {complex(value) + 0 for value in rounded}
        common = spectrum if common is None else common & spectrum
    return tuple(sorted(common or (), key=lambda value: (value.real, value.imag)))


# An upper limit on the distance from a system to one with a fixed mode, from singular values.

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
) -> tuple[Array | NDArray[np.complex128], int]:
    """Return M = [Π(λI − A); C_s] and the required number of columns of U."""
    n = A.shape[0]
    inputs = np.hstack([np.zeros((n, 0)), *(B[i] for i in sorted(T))])
    basis, sizes, _ = np.linalg.svd(inputs, full_matrices=False)
    rank = int(np.sum(sizes > np.finfo(float).eps * max(inputs.shape) * np.max(sizes, initial=0)))
    image = basis[:, :rank]
    project = np.eye(n) - image @ image.T
    rest = [C[i] for i in range(len(C)) if i not in T]
    at = value if value.imag else value.real
    return np.vstack([project @ (at * np.eye(n) - A), *rest]), rank + 1


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
    known = dict[frozenset[int], float]()

    def size_of(each: frozenset[int]) -> float:
        if each not in known:
            known[each] = _size(A, B, C, each, value)
        return known[each]

    T = min(few_subsets(len(B)), key=lambda each: (size_of(each), sorted(each)))
    for _ in range(_ROUNDS):
        near = min((T ^ {i} for i in range(len(B))), key=size_of, default=T)
        if not size_of(near) < size_of(T):
            break
        T = near
    return T, size_of(T)


# Controllability of a pair by the numerical rank of its controllability matrix.


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


def control_rank(function: str, A: NDArray[np.float64], M: NDArray[np.float64]) -> int:
    """Rank of python-control's controllability or observability matrix, at numpy's tolerance.

    Parameters
    ----------
    function : {"ctrb", "obsv"}
        The function of python-control that makes the matrix.
    A : ndarray, shape (n, n)
    M : ndarray, shape (n, p) or (q, n)
        B for ``ctrb``, C for ``obsv``.

    Raises
    ------
    MissingExtra
        If python-control is not installed.
    """
    with MissingExtra.named("control"):
        import control

    matrix = control.ctrb(A, M) if function == "ctrb" else control.obsv(A, M)
    return int(np.linalg.matrix_rank(matrix))


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


# The transfer graph by computed transfer functions.


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
