"""Linear-quadratic Gaussian controllers of one channel, for a rate or a radius."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from scipy.linalg import (
    LinAlgError,
    solve_continuous_are,
    solve_continuous_lyapunov,
    solve_discrete_are,
    solve_discrete_lyapunov,
)

from mcexact.synthesis.optimum.weights import Floats


@dataclass(frozen=True, eq=False)
class Model:
    """A system with one channel, ẋ = A x + B u, y = C x, and the weights of its cost.

    Attributes
    ----------
    A, B, C : ndarray, n × n, n × p and q × n
    Q, R, W, V : ndarray
        As in `Weights`.
    discrete : bool
    """

    A: Floats
    B: Floats
    C: Floats
    Q: Floats
    R: Floats
    W: Floats
    V: Floats
    discrete: bool

    @property
    def dual(self) -> Model:
        """The model whose regulator is the transposed estimator."""
        return Model(self.A.T, self.C.T, self.B.T, self.W, self.V, self.Q, self.R, self.discrete)


def riccati(model: Model, shift: float) -> Floats | None:
    """Solve the Riccati equation of the regulator of a shifted model.

    Parameters
    ----------
    model : Model
    shift : float
        a in continuous time, for A + aI; ρ in discrete time, for A/ρ and B/ρ.

    Returns
    -------
    ndarray, n × n, or None
        None without a stabilizing solution in floating point.
    """
    A, B = model.A, model.B
    with warnings.catch_warnings():
        # What follows from the solution is certified exactly or dropped.
        warnings.simplefilter("ignore")
        try:
            if model.discrete:
                X = solve_discrete_are(A / shift, B / shift, model.Q, model.R)
            else:
                X = solve_continuous_are(A + shift * np.eye(len(A)), B, model.Q, model.R)
        except (LinAlgError, ValueError):
            return None
    found = np.asarray(X, dtype=np.float64)
    return found if np.all(np.isfinite(found)) else None


def regulator(model: Model, shift: float) -> Floats | None:
    """Compute F for which u = F x is optimal for the shifted model; None without a solution.

    Examples
    --------
    >>> one = np.eye(1)
    >>> model = Model(one, one, one, one, one, one, one, False)
    >>> regulator(model, 0.0).round(3).tolist()
    [[-2.414]]
    """
    if not model.B.size:
        return np.zeros(model.B.T.shape)
    X = riccati(model, shift)
    if X is None:
        return None
    if not model.discrete:
        solved = _solved(model.R, model.B.T @ X)
    else:
        B = model.B / shift
        solved = _solved(model.R + B.T @ X @ B, B.T @ X @ (model.A / shift))
    return None if solved is None else -solved


def _solved(M: Floats, right: Floats) -> Floats | None:
    """Solve a linear system; None if that is impossible in floating point."""
    try:
        found = np.asarray(np.linalg.solve(M, right), dtype=np.float64)
    except np.linalg.LinAlgError:
        return None
    return found if np.all(np.isfinite(found)) else None


def regulated_covariance(model: Model, F: Floats) -> Floats | None:
    """Compute the covariance S of the states under u = F x; None if that is impossible.

    Notes
    -----
    M S + S M' + W = 0 (discrete time: M S M' − S + W = 0) with M = A + B F.
    """
    closed = model.A + model.B @ F
    if not closed.size:
        return closed  # SciPy 1.11 refuses a matrix without entries
    try:
        if model.discrete:
            S = solve_discrete_lyapunov(closed, model.W)
        else:
            S = solve_continuous_lyapunov(closed, -model.W)
    except (LinAlgError, ValueError):
        return None
    found = np.asarray(S, dtype=np.float64)
    return found if np.all(np.isfinite(found)) else None


def output_gain(F: Floats, S: Floats, C: Floats) -> Floats | None:
    """Compute F S C'(C S C')⁺, the gain of y = C x that is nearest to F x in the mean."""
    try:
        found = np.asarray(F @ S @ C.T @ np.linalg.pinv(C @ S @ C.T), dtype=np.float64)
    except np.linalg.LinAlgError:
        return None
    return found if np.all(np.isfinite(found)) else None


def estimator(model: Model, shift: float) -> Floats | None:
    """The gain of the filter: of its derivative, or in discrete time of the newest output."""
    dual = model.dual
    if not dual.discrete:
        F = regulator(dual, shift)
        return None if F is None else -F.T
    if not model.C.size:
        return np.zeros(model.C.T.shape)
    Y, C = riccati(Model(dual.A, dual.B * shift, *_rest(dual)), shift), model.C
    if Y is None:
        return None
    solved = _solved(model.V + C @ Y @ C.T, C @ Y)
    return None if solved is None else solved.T


def _rest(model: Model) -> tuple[Floats, Floats, Floats, Floats, Floats, bool]:
    return model.C, model.Q, model.R, model.W, model.V, model.discrete


def gaussian_controller(model: Model, shift: float) -> tuple[Floats, Floats, Floats, Floats] | None:
    """Compute the controller ż = A_k z + B_k y, u = C_k z + D_k y that is optimal when shifted.

    Parameters
    ----------
    model : Model
    shift : float
        As in `riccati`.

    Returns
    -------
    A_k, B_k, C_k, D_k : ndarray, or None
        Of order n; in discrete time the controller uses the current measurement, and D_k ≠ 0.

    Notes
    -----
    With gains F and L, in continuous time A_k = A + BF − LC, B_k = L, C_k = F.  In discrete time
    the state is the prediction z of x, and x̂ = z + L(y − Cz) gives u = F x̂ and z⁺ = (A + BF) x̂.
    """
    F, L = regulator(model, shift), estimator(model, shift)
    if F is None or L is None:
        return None
    driven = model.A + model.B @ F
    if not model.discrete:
        return driven - L @ model.C, L, F, np.zeros((len(F), len(model.C)))
    newest = np.eye(len(driven)) - L @ model.C
    return driven @ newest, driven @ L, F @ newest, F @ L
