"""One real Schur form of a loop: its eigenvalues, and the Gramians of its shifts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import lapack

from mcexact.synthesis.optimum.weights import Floats


@dataclass(frozen=True, eq=False)
class SchurForm:
    """M = Z T Z', Z orthogonal and T quasi upper triangular.

    Attributes
    ----------
    T, Z : ndarray, N × N
    eigenvalues : ndarray of complex, N
    discrete : bool
    """

    T: Floats
    Z: Floats
    eigenvalues: npt.NDArray[np.complex128]
    discrete: bool

    @classmethod
    def of(cls, M: Floats, *, discrete: bool) -> SchurForm | None:
        """Compute the Schur form; None if M is not finite or the iteration fails.

        Examples
        --------
        >>> form = SchurForm.of(np.array([[0.0, 1.0], [-2.0, -3.0]]), discrete=False)
        >>> round(form.bound, 6)
        -1.0
        """
        if not len(M):
            return cls(M, M, np.zeros(0, dtype=np.complex128), discrete)
        if not np.all(np.isfinite(M)):
            return None
        T, _, real, imaginary, Z, _, info = lapack.dgees(lambda *_: 0, M, lwork=8 * len(M))
        return None if info else cls(T, Z, real + 1j * imaginary, discrete)

    @property
    def bound(self) -> float:
        """The largest real part (continuous time) or modulus (discrete time) of an eigenvalue."""
        if not len(self.T):
            return 0.0 if self.discrete else -np.inf
        sizes = np.abs(self.eigenvalues) if self.discrete else self.eigenvalues.real
        return float(np.max(sizes))

    def gramians(self, W: Floats, Q: Floats, shift: float) -> tuple[Floats, Floats] | None:
        """Solve the two Lyapunov equations of the shifted loop.

        Parameters
        ----------
        W, Q : ndarray, N × N
            Symmetric, positive semidefinite.
        shift : float
            a in continuous time, where the shifted loop is M + aI, or ρ in discrete time, where it
            is M/ρ; it has to be stable.

        Returns
        -------
        S, P : ndarray, N × N, or None
            M S + S M' + W = 0 and M'P + P M + Q = 0 (discrete time: M S M' − S + W = 0 and
            M'P M − P + Q = 0) for the shifted M.  None if they are not finite, or not positive
            semidefinite up to rounding.

        Notes
        -----
        In discrete time (T + I)⁻¹(T − I) is quasi triangular with T, with zeros where T has them,
        and has the equations of continuous time with 2(T + I)⁻¹W(T + I)⁻ᵀ.
        """
        T, Z = self.T, self.Z
        if not len(T):
            return W, Q
        W, Q = Z.T @ W @ Z, Z.T @ Q @ Z
        if self.discrete:
            inverse = np.linalg.inv(T / shift + np.eye(len(T)))
            W, Q = 2 * inverse @ W @ inverse.T, 2 * inverse.T @ Q @ inverse
            T = np.eye(len(T)) - 2 * inverse
        else:
            T = T + shift * np.eye(len(T))
        S, scale, _ = lapack.dtrsyl(T, T, -W, trana="N", tranb="T")
        P, dual, _ = lapack.dtrsyl(T, T, -Q, trana="T", tranb="N")
        if not scale or not dual:
            return None
        S, P = Z @ (S / scale) @ Z.T, Z @ (P / dual) @ Z.T
        for each in (S, P):
            if not np.all(np.isfinite(each)) or np.min(np.diag(each)) < -1e-9 * np.max(
                np.abs(each)
            ):
                return None
        return S, P
