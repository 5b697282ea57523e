"""Where eigenvalues lie besides the rate: how well damped, and how fast at most."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mcexact.synthesis.optimum.cost import Valued
from mcexact.synthesis.optimum.eigenvalues import Eigenvalues
from mcexact.synthesis.optimum.problem import FeedbackProblem
from mcexact.synthesis.optimum.sensitivity import Complexes
from mcexact.synthesis.optimum.weights import Floats

_GONE = 1e-3
_AIMED_FURTHER = 1.05


def least_damping(eigenvalues: Complexes, *, discrete: bool) -> float:
    """Compute the least damping ratio −Re s/|s|, s = λ or in discrete time s = log λ.

    In discrete time an eigenvalue of a modulus below 1/1000 has the ratio 1.

    Examples
    --------
    >>> round(least_damping(np.array([-3 + 4j, -3 - 4j, -1]), discrete=False), 3)
    0.6
    >>> round(least_damping(np.exp(np.array([-0.3 + 0.4j, -0.3 - 0.4j])), discrete=True), 3)
    0.6
    """
    s = np.log(eigenvalues[np.abs(eigenvalues) >= _GONE]) if discrete else eigenvalues
    ratios = -s.real / np.maximum(np.abs(s), np.finfo(float).tiny)
    return float(np.min(ratios, initial=1.0))


@dataclass(frozen=True)
class Shape:
    """Limits on the eigenvalues of a loop, which a search aims at.

    Attributes
    ----------
    damping : float or None
        The least damping ratio.
    largest : float or None
        The largest modulus, in continuous time.
    """

    damping: float | None = None
    largest: float | None = None

    @property
    def free(self) -> bool:
        """Whether there is no limit."""
        return self.damping is None and self.largest is None

    def met(self, damping: float, fastest: float) -> bool:
        """Whether a least damping ratio and a largest modulus keep the limits."""
        damped = self.damping is None or damping >= self.damping
        return damped and (self.largest is None or fastest <= self.largest)

    def excess(self, problem: FeedbackProblem, K: Floats) -> Valued:
        """Compute Σ max(0, ζ − d_k)² + Σ max(0, |λ_k|/R − 1)², and its gradient in K.

        Parameters
        ----------
        problem : FeedbackProblem
        K : ndarray, P × L

        Notes
        -----
        d_k are the damping ratios; ζ is 1.05 times the limit, and R the limit over 1.05.
        """
        seen = Eigenvalues.of(problem, problem.closed(K))
        total, G = 0.0, np.zeros(K.shape)
        for k, value in enumerate(map(complex, seen.values)):
            size, slope = self._of(value, discrete=problem.discrete)
            if size:
                total += size
                G += seen.slope(k, slope)
        return total, G

    def _of(self, value: complex, *, discrete: bool) -> tuple[float, complex]:
        """What an eigenvalue adds, and c with Re(c dλ) its differential."""
        total, slope = 0.0, 0j
        modulus = abs(value)
        if modulus < (_GONE if discrete else np.finfo(float).tiny):
            return total, slope
        if self.largest is not None and not discrete:
            over = _AIMED_FURTHER * modulus / self.largest - 1
            if over > 0:
                total += over**2
                slope += 2 * over * _AIMED_FURTHER / self.largest * value.conjugate() / modulus
        if self.damping is not None:
            s = complex(np.log(value)) if discrete else value
            r, inner = abs(s), 1 / value if discrete else 1 + 0j
            # At λ = 1 every direction is as good.
            lacking = min(_AIMED_FURTHER * self.damping, 0.99) + s.real / r if r else 0.0
            if lacking > 0:
                total += lacking**2
                # d(Re s/|s|) = Re(g ds).
                g = complex(s.imag**2, s.real * s.imag) / r**3
                slope += 2 * lacking * g * inner
        return total, slope


NO_LIMITS = Shape()
"""Eigenvalues may lie anywhere in the region."""
