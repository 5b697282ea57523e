"""Fixed modes by intersecting the rounded closed-loop eigenvalues of drawn gains."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


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
        found = {complex(value) + 0 for value in rounded}
        common = found if common is None else common & found
    return tuple(sorted(common or (), key=lambda value: (value.real, value.imag)))
