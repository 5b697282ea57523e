"""The linear-quadratic cost of a loop, and its gradient in the entries of K."""

from __future__ import annotations

import numpy as np

from mcexact.synthesis.optimum.problem import FeedbackProblem
from mcexact.synthesis.optimum.spectrum import SchurForm
from mcexact.synthesis.optimum.weights import Floats

Valued = tuple[float, Floats]
"""A value and its gradient; where the value is infinite the gradient is not used."""

_NO_GRADIENT = np.zeros((0, 0))
INFINITE: Valued = (np.inf, _NO_GRADIENT)


def quadratic_costs(problem: FeedbackProblem, K: Floats, shifts: tuple[float, ...]) -> list[Valued]:
    """Compute the costs of shifted loops, and their gradients.

    Parameters
    ----------
    problem : FeedbackProblem
    K : ndarray, P × L
    shifts : tuple of float
        a in continuous time: the loop is M + aI; ρ in discrete time: the loop is M/ρ.

    Returns
    -------
    list of (float, ndarray)
        J for each shift, infinite unless the shifted loop is stable; and the P × L gradient.

    Notes
    -----
    With the noises Wˢ = W + B K V K'B' and the weights Qˢ = Q + C'K'R K C, the Gramians S, P of M::

        J = tr(S Qˢ) + tr(R K V K')
        ∇J = 2 (B'P M S C' + R K C S C' + B'P B K V + R K V)     (without M in continuous time)

    (Levine and Athans 1970; Rautert and Sachs 1997).  The second term of J is the power of the
    noise that K passes on to its inputs at once: a part of E[u'Ru] in discrete time, and kept as a
    definition in continuous time, where that power would be infinite.  One Schur form serves all
    shifts.
    """
    A, B, C, R = problem.A, problem.B, problem.C, problem.R
    BK, RK, KV = B @ K, R @ K, K @ problem.V
    M = A + BK @ C
    form = SchurForm.of(M, discrete=problem.discrete)
    if form is None:
        return [INFINITE for _ in shifts]
    Q, W = problem.Q + C.T @ (K.T @ RK) @ C, problem.W + B @ (KV @ BK.T)
    through = float(np.sum(RK * KV))
    found = []
    for shift in shifts:
        inside = form.bound < shift if problem.discrete else form.bound < -shift
        gramians = form.gramians(W, Q, shift) if inside else None
        if gramians is None:
            found.append(INFINITE)
            continue
        S, P = gramians
        SC = S @ C.T
        forward = P @ (M @ SC) / shift**2 if problem.discrete else P @ SC
        G = 2 * (B.T @ (forward + P @ (B @ KV)) + RK @ (C @ SC) + R @ KV)
        cost = float(np.sum(S * Q)) + through
        found.append((cost, G) if cost > 0 and np.all(np.isfinite(G)) else INFINITE)
    return found
