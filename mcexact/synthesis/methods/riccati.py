"""Gains from shifted Riccati equations, in floating point, for a rate or a radius."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

from mcexact.exact.floats import to_float
from mcexact.exact.location import StabilityRegion

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]


def riccati_feedback(
    A: Floats, B: Floats, region: StabilityRegion, *, effort: float = 1.0
) -> Floats | None:
    """Compute F for which the spectrum of A + B F lies in a region, in floating point.

    Parameters
    ----------
    A : ndarray, n × n
    B : ndarray, n × p
    region : StabilityRegion
        The region of a rate α ≥ 0 or a radius ρ.
    effort : float
        The weight of the input against that of the state.

    Returns
    -------
    ndarray, p × n, or None
        None if the equation could not be solved, for example if a mode outside is not controllable.

    Notes
    -----
    A proposal in floating point: the gain of the regulator for A + αI, or for (A/ρ, B/ρ) in
    discrete time.  The gain of an observer is F' for (A', C').

    Examples
    --------
    >>> import numpy as np
    >>> A, B = np.array([[0.0, 1.0], [0.0, 0.0]]), np.array([[0.0], [1.0]])
    >>> F = riccati_feedback(A, B, StabilityRegion("continuous", 2))
    >>> bool(np.linalg.eigvals(A + B @ F).real.max() < -2)
    True
    """
    import numpy as np
    from scipy.linalg import LinAlgError, solve_continuous_are, solve_discrete_are

    (n, p), bound = B.shape, to_float(region.edge)
    if n == 0 or p == 0:
        return np.zeros((p, n))
    Q, R = np.eye(n), effort * np.eye(p)
    with warnings.catch_warnings():
        # The result is certified exactly or dropped.
        warnings.simplefilter("ignore")
        try:
            if region.discrete:
                scaled = B / bound
                X = solve_discrete_are(A / bound, scaled, Q, R)
                weighted = scaled.T @ X
                gain = np.linalg.solve(R + weighted @ scaled, weighted @ (A / bound))
            else:
                X = solve_continuous_are(A + bound * np.eye(n), B, Q, R)
                gain = (B.T @ X) / effort
            F: Floats = np.asarray(-gain, dtype=np.float64)
        except (LinAlgError, ValueError):
            return None
    return F if np.all(np.isfinite(F)) else None
