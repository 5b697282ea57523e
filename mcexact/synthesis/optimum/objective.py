"""The objective of a design: cost, barrier of the region, margin and size of the gains."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mcexact.synthesis.optimum.cost import INFINITE, Valued, quadratic_costs
from mcexact.synthesis.optimum.problem import FeedbackProblem
from mcexact.synthesis.optimum.sensitivity import Complexes, Sensitivity
from mcexact.synthesis.optimum.shape import NO_LIMITS, Shape
from mcexact.synthesis.optimum.weights import Floats

_SHAPE = 100.0
SHARE_OF_SHIFTED = 0.0005
"""The weight σ of the cost of the shifted loop, which makes the border of the region a barrier.

With larger weights loops become faster than is asked, and dearer.
"""


@dataclass(frozen=True, eq=False)
class Objective:
    """J_0 + σ J_a + μ Σ max(0, σ_max(T)/τ − 1)² + J_0 (Σ max(0, |K_ij|/g − 1)² + 100 e).

    Here e is `Shape.excess`.

    Attributes
    ----------
    problem : FeedbackProblem
    shift : float
        The shift a (continuous time) or ρ (discrete time) of J_a.
    largest_gain : float
        g; infinite without a limit.
    weight : float
        μ.
    limit : float
        τ.
    points : ndarray of complex or None
        The frequencies of the sum.
    shape : Shape
    """

    problem: FeedbackProblem
    shift: float
    largest_gain: float = np.inf
    weight: float = 0.0
    limit: float = np.inf
    points: Complexes | None = None
    shape: Shape = NO_LIMITS

    def __call__(self, x: Floats) -> Valued:
        """Compute the objective and its gradient in the free entries of K.

        Returns
        -------
        float, ndarray
            Infinite unless every eigenvalue of the shifted loop is stable.
        """
        problem = self.problem
        K, unshifted = problem.gain(x), 1.0 if problem.discrete else 0.0
        (plain, G0), (shifted, Ga) = quadratic_costs(problem, K, (unshifted, self.shift))
        if not np.isfinite(plain) or not np.isfinite(shifted):
            return INFINITE
        value, G = plain + SHARE_OF_SHIFTED * shifted, G0 + SHARE_OF_SHIFTED * Ga
        if self.points is not None and self.weight:
            excess, Gm = Sensitivity(problem, K).excess(self.points, self.limit)
            value, G = value + self.weight * excess, G + self.weight * Gm
        if np.isfinite(self.largest_gain):
            over = np.maximum(np.abs(K) / self.largest_gain - 1, 0)
            size = float(np.sum(over**2))
            if size:
                value += plain * size
                G = G + size * G0 + plain * 2 * over * np.sign(K) / self.largest_gain
        if not self.shape.free:
            excess, Ge = self.shape.excess(problem, K)
            value += _SHAPE * plain * excess
            G = G + _SHAPE * (excess * G0 + plain * Ge)
        if not np.isfinite(value):
            return INFINITE
        return value, problem.gradient(G)
