"""The eigenvalues of a loop, and how gains move them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eig

from mcexact.synthesis.optimum.problem import FeedbackProblem
from mcexact.synthesis.optimum.sensitivity import Complexes
from mcexact.synthesis.optimum.weights import Floats

_CLOSE = 1e-13


@dataclass(frozen=True, eq=False)
class Eigenvalues:
    """The eigenvalues of M = A + B K C, with left and right eigenvectors as columns.

    Attributes
    ----------
    problem : FeedbackProblem
    values : ndarray of complex, N
    left, right : ndarray of complex, N × N
    """

    problem: FeedbackProblem
    values: Complexes
    left: Complexes
    right: Complexes

    @classmethod
    def of(cls, problem: FeedbackProblem, M: Floats) -> Eigenvalues:
        """Compute the eigenvalues of the loop M of a problem, whose entries are finite."""
        found = (np.asarray(each, dtype=np.complex128) for each in eig(M, left=True))
        return cls(problem, *found)

    def slope(self, k: int, direction: complex) -> Floats:
        """Return the gradient of Re(c λ_k) in K, for a number c.

        Parameters
        ----------
        k : int
        direction : complex
            c.

        Notes
        -----
        With left and right eigenvectors w, v, dλ = wᴴ dM v/(wᴴ v).  Where wᴴ v vanishes, 1e-13
        takes its place.
        """
        w, v, problem = self.left[:, k].conj(), self.right[:, k], self.problem
        paired = complex(w @ v)
        paired = paired if abs(paired) > _CLOSE else complex(_CLOSE)
        found: Floats = np.real(direction / paired * np.outer(w @ problem.B, problem.C @ v))
        return found
