"""The complementary sensitivity at the inputs of the plant, on a grid of frequencies."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.linalg import lapack, rsf2csf

from mcexact.synthesis.optimum.cost import Valued
from mcexact.synthesis.optimum.problem import FeedbackProblem
from mcexact.synthesis.optimum.spectrum import SchurForm
from mcexact.synthesis.optimum.weights import Floats

Complexes = npt.NDArray[np.complex128]

GRID = 80
_BEYOND_SENSE = 1e30


def frequencies(
    eigenvalues: Complexes, *, discrete: bool, count: int = GRID, widen: float = 3.0
) -> Complexes:
    """Choose points of the boundary of stability, which cover the eigenvalues of a loop.

    Parameters
    ----------
    eigenvalues : ndarray of complex
    discrete : bool
    count : int
        The number of points besides those nearest to eigenvalues.
    widen : float
        In continuous time, the frequencies reach this factor beyond the moduli.

    Returns
    -------
    ndarray of complex
        jω, ω ≥ 0, or e^{jθ}, 0 ≤ θ ≤ π.

    Examples
    --------
    >>> frequencies(np.array([-1 + 2j, -1 - 2j]), discrete=False, count=2).imag.round(2).tolist()
    [0.0, 0.75, 6.71, 2.0]
    """
    if discrete:
        near = np.unique(np.abs(np.angle(eigenvalues)))
        return np.exp(1j * np.concatenate([np.linspace(0, np.pi, count), near]))
    sizes = np.abs(eigenvalues)
    sizes = sizes[sizes > 1e-9 * np.max(sizes, initial=0.0)]
    low, high = np.min(sizes, initial=1.0) / widen, np.max(sizes, initial=1e-9) * widen
    if sizes.size:
        low = float(np.min(sizes)) / widen
    near = np.unique(np.abs(eigenvalues.imag))
    points = np.concatenate([[0.0], np.geomspace(low, high, count), near[near > 0]])
    return 1j * points


def norm(M: Floats | Complexes) -> float:
    """The largest singular value; infinite where numbers exceed any sense.

    Examples
    --------
    >>> round(norm(np.diag([2.0, -3.0])), 9), norm(np.array([[np.nan]]))
    (3.0, inf)
    """
    sensible = bool(np.all(np.abs(M) < _BEYOND_SENSE))
    return float(np.linalg.norm(M, 2)) if sensible and M.size else 0.0 if sensible else np.inf


class Response:
    """T(z) = U (zI − M)⁻¹ B, on the boundary of stability.

    Parameters
    ----------
    M : ndarray, N × N
    entering, leaving : ndarray, N × p and p' × N
        B and U.
    discrete : bool

    Notes
    -----
    With a complex Schur form of M each frequency costs O(N²).
    """

    def __init__(self, M: Floats, entering: Floats, leaving: Floats, *, discrete: bool) -> None:
        form = SchurForm.of(M, discrete=discrete)
        self.eigenvalues: Complexes = np.zeros(0, dtype=np.complex128)
        self.valid = form is not None
        if form is None:
            return
        self.eigenvalues = form.eigenvalues
        upper, unitary = rsf2csf(form.T, form.Z) if len(M) else (M, M)
        self._T = np.asarray(upper, dtype=np.complex128)
        self._Z = np.asarray(unitary, dtype=np.complex128)
        self._entering = self._Z.conj().T @ entering
        self._leaving = leaving @ self._Z

    def _resolvent(self, z: complex, right: Complexes, trans: int = 0) -> Complexes:
        """Solve (zI − T) X = right, or its transpose."""
        solved, _ = lapack.ztrtrs(z * np.eye(len(self._T)) - self._T, right, trans=trans)
        found: Complexes = solved
        return found

    def sizes(self, points: Complexes) -> Floats:
        """Return the largest singular value of T at each of some points."""
        if not self._leaving.size or not self._entering.size:
            return np.zeros(len(points))
        return np.array(
            [norm(self._leaving @ self._resolvent(z, self._entering)) for z in points], dtype=float
        )

    def peak(self, points: Complexes) -> float:
        """Return the largest singular value of T at some points."""
        return float(np.max(self.sizes(points), initial=0.0))


class Sensitivity(Response):
    """T(z) = U (zI − M)⁻¹ B_u, with u = U x̄ the inputs of the plant and B_u where these enter.

    Parameters
    ----------
    problem : FeedbackProblem
    K : ndarray, P × L

    Notes
    -----
    The loop is opened at all inputs of the plant at once.
    """

    def __init__(self, problem: FeedbackProblem, K: Floats) -> None:
        self._problem, self._K = problem, K
        entering, leaving = problem.B[:, : problem.p], (K @ problem.C)[: problem.p]
        super().__init__(problem.closed(K), entering, leaving, discrete=problem.discrete)

    def excess(self, points: Complexes, limit: float) -> Valued:
        """Compute Σ max(0, σ_max(T(z))/limit − 1)² over some points, and its gradient in K.

        Notes
        -----
        With u, v the singular vectors of σ_max, dσ = Re(uᴴ dT v), and dT = E dK C X B_u + U X B dK
        C X B_u, X = (zI − M)⁻¹, where E picks the inputs of the plant.
        """
        problem, K = self._problem, self._K
        total, G = 0.0, np.zeros(K.shape)
        if not self._leaving.size:
            return total, G
        for z in points:
            inner = self._resolvent(z, self._entering)
            left, sizes, right = np.linalg.svd(self._leaving @ inner)
            excess = float(sizes[0]) / limit - 1
            if not excess > 0:
                continue
            total += excess**2
            u, v = left[:, 0], right[0].conj()
            back = self._resolvent(z, self._leaving.T @ u.conj(), trans=1)
            row = problem.B.T @ (self._Z.conj() @ back)
            row[: problem.p] += u.conj()
            G += 2 * excess / limit * np.real(np.outer(row, problem.C @ (self._Z @ (inner @ v))))
        return total, G
