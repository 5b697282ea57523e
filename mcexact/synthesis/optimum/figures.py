"""Cost, sensitivity, eigenvalues and aims of a loop, with their gradients.

Everything that an objective is made of is here, as a function of the gain matrix K with its
gradient in K:

- `quadratic_costs`: the linear-quadratic cost, from two Lyapunov equations; one Schur form of the
  loop serves several shifts.
- `Margins`: the disk margins of single loops and the margin of all inputs together, on a grid of
  frequencies; one eigendecomposition serves all frequencies and loops.
- `Sensitivity`: the complementary sensitivity at the inputs of the plant, for the figures of a
  loop; with a complex Schur form each frequency costs O(N²) for N states.
- `Eigenvalues` and `Shape`: eigenvalues with their slopes, and the limits on damping and modulus.

`Aims` is what a user may ask of a search besides a region.  `Figures` are the numbers by which
controllers are compared, and `central_optimum` gives those of the optimal controller that all
agents together would have: the reference for the cost of every other.  All numbers are floating
point and prove nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import isfinite
from numbers import Real
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.linalg import eig, expm, lapack, rsf2csf

from mcexact.analysis.performance import riccati_solutions, scaled_norm
from mcexact.derived.constructions import merged
from mcexact.errors import UsageError, require_seconds, shown_value
from mcexact.exact.matrix import as_requested, matrix_to_float, to_float
from mcexact.exact.rational import Entry
from mcexact.exact.roots import StabilityRegion, is_discrete
from mcexact.model.system import MultiChannelSystem, as_plant
from mcexact.synthesis.gate import Request
from mcexact.synthesis.networks import decentralized_network
from mcexact.synthesis.optimum.problem import (
    FeedbackProblem,
    Floats,
    SchurForm,
    Sizes,
    Weights,
    balanced,
    filtered_noise,
    solved_or_nan,
)
from mcexact.synthesis.optimum.starts import Model, gaussian_controller

# The linear-quadratic cost of a loop, and its gradient in the entries of K.

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

    (Levine and Athans 1970; Rautert and Sachs 1997).  In discrete time that is E[x'Qx + u'Ru]; in
    continuous time it is if the noise has a bandwidth, by which the states and the signals grow::

        [M, B K; 0, −ωI],   [C, I],   Wˢ = diag(W, ω² V)

    Then all products with V vanish above.  The Gramians of these are computed by blocks, from those
    of M and from linear systems in ωI − M.  One Schur form serves all shifts.
    """
    form = SchurForm.of(problem.closed(K), discrete=problem.discrete)
    if form is None:
        return [INFINITE for _ in shifts]
    if not problem.discrete and problem.bandwidth is not None:
        return [_filtered_cost(problem, K, form, problem.bandwidth, each) for each in shifts]
    return [_white_cost(problem, K, form, each) for each in shifts]


def _white_cost(problem: FeedbackProblem, K: Floats, form: SchurForm, shift: float) -> Valued:
    """The cost with white noise, as in discrete time."""
    A, B, C, R = problem.A, problem.B, problem.C, problem.R
    inside = form.bound < shift if problem.discrete else form.bound < -shift
    if not inside:
        return INFINITE
    BK, RK, KV = B @ K, R @ K, K @ problem.V
    Q, W = problem.Q + C.T @ (K.T @ RK) @ C, problem.W + B @ (KV @ BK.T)
    gramians = form.gramians(W, Q, shift)
    if gramians is None:
        return INFINITE
    S, P = gramians
    SC = S @ C.T
    forward = P @ ((A + BK @ C) @ SC) / shift**2 if problem.discrete else P @ SC
    G = 2 * (B.T @ (forward + P @ (B @ KV)) + RK @ (C @ SC) + R @ KV)
    return _finite(float(np.sum(S * Q)) + float(np.sum(RK * KV)), G)


def _filtered_cost(
    problem: FeedbackProblem, K: Floats, form: SchurForm, bandwidth: float, shift: float
) -> Valued:
    """The cost with filtered noise, in continuous time.

    Notes
    -----
    With X, Y as in `filtered_noise`, and Z = E[P-block of ν] from (ω − 2a − M')Z = P G + C'K'R K_ν.
    """
    if not form.bound < -shift or not bandwidth > 2 * shift:
        return INFINITE
    B, C, RK = problem.B, problem.C, problem.R @ K
    noisy = np.flatnonzero(np.diag(problem.V) > 0)
    M, G, KC = problem.closed(K), B @ K[:, noisy], K @ C
    X, Y = filtered_noise(M, G, problem.V[np.ix_(noisy, noisy)], bandwidth, shift)
    Q, across = problem.Q + KC.T @ (RK @ C), KC.T @ RK[:, noisy]
    gramians = form.gramians(problem.W + G @ X.T + X @ G.T, Q, shift)
    if gramians is None:
        return INFINITE
    S, P = gramians
    Z = solved_or_nan((bandwidth - 2 * shift) * np.eye(len(M)) - M.T, P @ G + across)
    SC, XC = S @ C.T, X.T @ C.T
    SC[:, noisy] += X
    XC[:, noisy] += Y
    seen = C @ SC
    seen[noisy] += XC
    cost = float(np.sum(S * Q)) + 2 * float(np.sum(X * across))
    cost += float(np.sum((K[:, noisy] @ Y) * RK[:, noisy]))
    return _finite(cost, 2 * (B.T @ (P @ SC + Z @ XC) + RK @ seen))


def _finite(cost: float, G: Floats) -> Valued:
    return (cost, G) if cost > 0 and bool(np.all(np.isfinite(G))) else INFINITE


# The complementary sensitivity at the inputs of the plant, on a grid of frequencies.

Complexes = npt.NDArray[np.complex128]

_BEYOND_SENSE = 1e30


def frequencies(
    eigenvalues: Complexes, *, discrete: bool, count: int, widen: float = 3.0
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
    """The largest singular value; infinite where entries overflow.

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
        resolvent: Complexes = solved
        return resolvent

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


# The margins of single loops and of all inputs together, with gradients.

_ACCURATE = 1e-9
GRID_OF_PEAKS = 200
"""The frequencies among which peaks are searched, besides those of the eigenvalues."""
_LISTED = 0.7
_HIGHEST = 3


@dataclass(frozen=True)
class Limits:
    """Limits on the peaks of a loop, which are those of its margins.

    Attributes
    ----------
    disk : float
        α: a disk margin of this size in every single loop is |T_ii + ½| ≤ 1/α.
    margin : float
        The margin of all inputs together: σ_max(T) ≤ 1/margin.
    together : float
        β: a disk margin of this size of all inputs together, and of all outputs together, is
        σ_max(Θ^½ (T + ½I) Θ^−½) ≤ 1/β for a diagonal Θ > 0; 0 if it is not looked at.
    """

    disk: float
    margin: float
    together: float = 0.0

    def tightened(self, factor: float) -> Limits:
        """Return the limits for margins that are larger by a factor."""
        return Limits(factor * self.disk, factor * self.margin, factor * self.together)


MARGIN, DISK, TOGETHER = 0.3, 0.4, 0.2
MARGINS = Limits(DISK, MARGIN)
"""The margins that designs aim at; `TOGETHER` where it costs little."""
NO_MARGINS = Limits(0.0, 0.0)
LEAST_DAMPING, FEW_DIGITS = 0.05, 4
"""A controller of less damping, or whose programs need more digits, is installed with care."""


class Margins:
    """T at the inputs of the plant and at its outputs, with all agents' other loops closed.

    Parameters
    ----------
    problem : FeedbackProblem
    K : ndarray, P × L

    Notes
    -----
    With H(z) = C X B, X = (zI − M)⁻¹, S the rows of K for inputs of the plant, and E the columns of
    its outputs, newest ones only::

        T_in = SK H S',    dT_in = (S + SKH) dK H S'
        T_out = E'H K E,   dT_out = E'H dK (E + HKE)

    The loop at one input is opened alone where T_ii is used, and that at all inputs where T is.
    Outputs that come late by messages under way keep their values; the integral of an output is an
    output of its own.
    One eigendecomposition of M serves all frequencies and loops; where the eigenvectors are too
    ill-conditioned there is one linear system for each frequency.
    """

    def __init__(self, problem: FeedbackProblem, K: Floats) -> None:
        self._problem, self._K, p = problem, K, problem.p
        self._seen = np.concatenate([agent.own for agent in problem.agents]).astype(np.intp)
        self._driving = np.eye(p, len(K))
        M = problem.closed(K)
        self._M, self.valid = M, bool(np.all(np.isfinite(M)))
        self.eigenvalues: Complexes = np.zeros(0, dtype=np.complex128)
        self._left: Complexes | None = None
        if not self.valid:
            return
        values, vectors = np.linalg.eig(M)
        self.eigenvalues = np.asarray(values, dtype=np.complex128)
        try:
            entering = np.linalg.solve(vectors, problem.B.astype(np.complex128))
        except np.linalg.LinAlgError:
            return
        again = np.linalg.norm(vectors @ (self.eigenvalues[:, None] * entering) - M @ problem.B)
        if again <= _ACCURATE * max(float(np.linalg.norm(M) * np.linalg.norm(problem.B)), 1e-300):
            self._left, self._right = problem.C @ vectors, entering

    def _responses(self, points: Complexes) -> Complexes:
        """H at some points, Z × L × P."""
        problem = self._problem
        if self._left is None:
            each = points[:, None, None] * np.eye(len(self._M)) - self._M
            solved = np.linalg.solve(
                each, np.broadcast_to(problem.B, (len(points), *problem.B.shape))
            )
            return np.asarray(problem.C @ solved)
        scaled = self._left[None] / (points[:, None, None] - self.eigenvalues)
        return np.asarray(scaled @ self._right)

    def _loops(self, H: Complexes) -> tuple[Complexes, Complexes, Complexes]:
        """T at all inputs, T_ii + ½ at the inputs, and at the outputs."""
        p, K, seen = self._problem.p, self._K, self._seen
        T = K[:p] @ H[:, :, :p]
        at_outputs = np.einsum("zjk,kj->zj", H[:, seen], K[:, seen]) + 0.5
        return T, np.einsum("zii->zi", T) + 0.5, at_outputs

    def _seen_loops(self, points: Complexes) -> tuple[Complexes, Complexes, Complexes]:
        """As `_loops`, without H where there are eigenvectors: O(N p²) for each point."""
        if self._left is None:
            return self._loops(self._responses(points))
        p, K, seen = self._problem.p, self._K, self._seen
        poles = 1 / (points[:, None] - self.eigenvalues)
        T = ((K[:p] @ self._left)[None] * poles[:, None]) @ self._right[:, :p]
        at_outputs = poles @ (self._left[seen].T * (self._right @ K[:, seen]))
        return T, np.einsum("zii->zi", T) + 0.5, at_outputs + 0.5

    def _together(self, H: Complexes) -> tuple[Complexes, Complexes]:
        """T + ½I at all inputs, and at all outputs."""
        p, K, seen = self._problem.p, self._K, self._seen
        at_inputs = K[:p] @ H[:, :, :p] + 0.5 * np.eye(p)
        return at_inputs, H[:, seen] @ K[:, seen] + 0.5 * np.eye(len(seen))

    def curves(self, points: Complexes) -> tuple[Floats, Floats]:
        """Return |T_ii + ½| of every input and output, and σ_max(T), at some points.

        Returns
        -------
        single, together : ndarray, Z × (p + q) and Z
        """
        T, inputs, outputs = self._seen_loops(points)
        sizes = np.linalg.norm(T, 2, axis=(1, 2)) if T.size else np.zeros(len(points))
        return np.abs(np.hstack([inputs, outputs])), np.asarray(sizes, dtype=np.float64)

    def excess(self, points: Complexes, limits: Limits, scalings: Scalings | None = None) -> Valued:
        """Compute the excess of all peaks over their limits, and its gradient in K.

        Parameters
        ----------
        points : ndarray of complex
        limits : Limits
        scalings : pair of ndarray, optional
            Those of `Peaks`, without which the margins together are not looked at.

        Returns
        -------
        float, ndarray
            Σ_z [Σ_i max(0, α|T_ii + ½| − 1)² + max(0, mσ_max(T) − 1)²] for the limits α and m; with
            scalings also max(0, βσ_max(Θ^½(T + ½I)Θ^−½) − 1)² at the inputs and at the outputs.
        """
        K, p, seen, G = self._K, self._problem.p, self._seen, np.zeros(self._K.shape)
        if not self.valid:
            return INFINITE
        H = self._responses(points)
        T, inputs, outputs = self._loops(H)
        if not all(np.all(np.isfinite(each)) for each in (T, inputs, outputs)):
            return INFINITE
        over, beyond = (np.maximum(limits.disk * np.abs(each) - 1, 0) for each in (inputs, outputs))
        total, sizes = float(np.sum(over**2) + np.sum(beyond**2)), np.zeros(len(points))
        if p:
            left, values, right = np.linalg.svd(T)
            sizes = np.maximum(limits.margin * values[:, 0] - 1, 0)
            total += float(np.sum(sizes**2))
        active = np.flatnonzero(np.any(over > 0, axis=1) | (sizes > 0))
        if active.size:
            # The differential is Re tr(D dT), D of the single loops and of the singular vectors.
            slopes = 2 * limits.disk * _slopes(over[active], inputs[active])
            D = slopes[:, :, None] * np.eye(p)
            weights = 2 * limits.margin * sizes[active]
            u, v = left[active, :, 0], right[active, 0, :]
            D = D + weights[:, None, None] * v.conj()[:, :, None] * u.conj()[:, None, :]
            h = H[active]
            before = self._driving + K[:p] @ h
            G += np.real(np.tensordot(h[:, :, :p] @ D, before, ([0, 2], [0, 1]))).T
        active = np.flatnonzero(np.any(beyond > 0, axis=1))
        if active.size:
            h = H[active]
            after = h @ K[:, seen]
            after[:, seen, np.arange(len(seen))] += 1
            slopes = 2 * limits.disk * _slopes(beyond[active], outputs[active])
            G += np.real(np.tensordot(after * slopes[:, None], h[:, seen], ([0, 2], [0, 1]))).T
        if scalings is not None and limits.together:
            size, slope = self._excess_together(H, limits.together, scalings)
            total, G = total + size, G + slope
        return total, G

    def _excess_together(self, H: Complexes, limit: float, scalings: Scalings) -> Valued:
        """The excess of the margins of all inputs and of all outputs together, and its gradient."""
        K, p, seen = self._K, self._problem.p, self._seen
        total, G = 0.0, np.zeros(K.shape)
        for side, (T, theta) in enumerate(zip(self._together(H), scalings, strict=True)):
            if not T.shape[1]:
                continue
            h = np.sqrt(theta)
            left, values, right = np.linalg.svd(h[:, None] * T / h)
            over = np.maximum(limit * values[:, 0] - 1, 0)
            active = np.flatnonzero(over > 0)
            if not active.size:
                continue
            total += float(np.sum(over**2))
            # The differential is Re tr(D dT).
            u, v = left[active, :, 0].conj() * h, right[active, 0, :].conj() / h
            D = (2 * limit * over[active])[:, None, None] * v[:, :, None] * u[:, None, :]
            seen_at = H[active]
            if side == 0:
                before = self._driving + K[:p] @ seen_at
                slope = np.tensordot(seen_at[:, :, :p] @ D, before, ([0, 2], [0, 1]))
            else:
                after = seen_at @ K[:, seen]
                after[:, seen, np.arange(len(seen))] += 1
                slope = np.tensordot(after @ D, seen_at[:, seen], ([0, 2], [0, 1]))
            G += np.real(slope).T
        return total, G

    def peaks(self, limits: Limits) -> Peaks:
        """Search the highest peaks of all curves on a grid over the eigenvalues of the loop."""
        points = frequencies(
            self.eigenvalues, discrete=self._problem.discrete, count=GRID_OF_PEAKS, widen=10.0
        )
        place = np.angle(points) if self._problem.discrete else points.imag
        points = points[np.unique(place, return_index=True)[1]]
        single, together = self.curves(points)
        curves, margin, scalings = (
            [limits.disk * single, (limits.margin * together)[:, None]],
            np.inf,
            None,
        )
        if limits.together:
            joint, scalings = self._joint_curves(points)
            curves.append(limits.together * joint)
            margin = 1 / max(float(np.max(joint, initial=0.0)), 0.5)
        scaled = np.hstack(curves)
        border = np.full((1, scaled.shape[1]), -1.0)
        tops = (scaled >= np.vstack([border, scaled[:-1]])) & (
            scaled >= np.vstack([scaled[1:], border])
        )
        chosen = set[int]()
        for curve, top in zip(scaled.T, (tops & (scaled > _LISTED)).T, strict=True):
            places = np.flatnonzero(top)
            for k in places[np.argsort(-curve[places])][:_HIGHEST]:
                chosen |= {max(int(k) - 1, 0), int(k), min(int(k) + 1, len(points) - 1)}
        # Far from all eigenvalues T is 0.
        worst = max(float(np.max(single, initial=0.0)), 0.5)
        largest = float(np.max(together, initial=0.0))
        return Peaks(
            points[sorted(chosen)],
            1 / worst,
            1 / largest if largest else np.inf,
            margin,
            scalings,
        )

    def _joint_curves(self, points: Complexes) -> tuple[Floats, Scalings]:
        """σ_max(Θ^½(T + ½I)Θ^−½) at all inputs and at all outputs, and the Θ, at some points."""
        columns, scalings = list[Floats](), list[Floats]()
        for T in self._together(self._responses(points)):
            theta = scaled_norm(T)[1] if T.shape[1] else np.ones(0)
            h = np.sqrt(theta)
            sizes = np.linalg.norm(h[:, None] * T / h, 2, axis=(1, 2)) if T.shape[1] else 0.0
            columns.append(np.broadcast_to(sizes, len(points)))
            scalings.append(theta)
        return np.column_stack(columns), (scalings[0], scalings[1])


Scalings = tuple[Floats, Floats]
"""The diagonals Θ of the margins of all inputs, and of all outputs, together."""


def _slopes(over: Floats, values: Complexes) -> Complexes:
    """The excess times the conjugate direction of each value."""
    sizes = np.maximum(np.abs(values), np.finfo(float).tiny)
    return np.asarray(over * values.conj() / sizes)


@dataclass(frozen=True, eq=False)
class Peaks:
    """The margins of a loop on a grid of frequencies, and where its curves are highest.

    Attributes
    ----------
    points : ndarray of complex
        The three highest peaks of each curve that is near its limit, with their neighbors.
    disk : float
        The least disk margin of a single loop; see python-control's ``disk_margins``, skew 0.
    margin : float
        That of all inputs together, 1/max σ_max(T).
    together : float
        The smaller disk margin of all inputs together and of all outputs together; infinite if it
        was not looked at.
    scalings : pair of ndarray or None
        With which this margin was found.
    """

    points: Complexes
    disk: float
    margin: float
    together: float = np.inf
    scalings: Scalings | None = None

    def keep(self, limits: Limits) -> bool:
        """Whether all margins are as large as limits ask."""
        single = self.disk >= limits.disk and self.margin >= limits.margin
        return single and self.together >= limits.together


# The eigenvalues of a loop, and their derivatives in the gains.

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
        decomposition = (np.asarray(each, dtype=np.complex128) for each in eig(M, left=True))
        return cls(problem, *decomposition)

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
        derivative: Floats = np.real(direction / paired * np.outer(w @ problem.B, problem.C @ v))
        return derivative


# Limits on the damping and the modulus of eigenvalues.

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
        """The term of one eigenvalue, and c for which the differential of the term is Re(c dλ)."""
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


# The aims of a search besides the rate or the radius.

SEEDS = 4


@dataclass(frozen=True)
class Aims:
    """What a search for a controller aims at.

    Of this only a damping ratio and a largest modulus in continuous time are certified: then no
    controller without them is a design.

    Parameters
    ----------
    weights : mapping of {"Q", "R", "W", "V"} to matrix, optional
        See `Weights.of`; by default Q = R = W = I and V = I/100.
    margin : float
        The margin of all inputs of the plant together, which the search raises to this if it can.
    disk : float
        The disk margin of every single loop, at each input and at each output, alike.
    largest_gain : float, optional
        The largest entry that is not penalized; by default ten times that of the optimal controller
        of all agents together.
    largest_order : int, optional
        The largest number of states of each agent.
    damping : rational or float, optional
        The least damping ratio of an eigenvalue, −Re s/|s| for s = λ or in discrete time log λ,
        where it is aimed at and not certified.
    largest_modulus : rational or float, optional
        The largest modulus of an eigenvalue, in continuous time.
    digits : int, optional
        The largest number of significant decimal digits of an entry.
    effort : float, optional
        About how many seconds a processor of 2024 may search for each rate that is tried: half of
        them for a controller of least cost, the others for margins that were missed, for more
        starts, and for what else is asked of the best controller, such as damping or a box.  Work
        is counted, not timed, so that the result does not depend on the machine's load; what
        precedes and follows a search, such as the choice of a rate, is not counted.  By default
        the search is as long as the plant is large, and what follows adds to it.  With 0 there is
        no search, but the controller of the theorem at once.
    seeds : int
        The number of drawn starts of each order.
    box : rational or float, optional
        The part of each entry by which plants may differ while every loop is stable, at which the
        search aims by faster loops; without a rate by default 1/100 where that costs little.
    seconds : float, optional
        The time by the clock after which a search ends with the best controller so far, which is
        then rounded and certified.

    Raises
    ------
    UsageError
        If a number is out of range.

    Examples
    --------
    >>> Aims(margin=0.4, digits=3).largest_order
    >>> Aims(margin=2)
    Traceback (most recent call last):
        ...
    mcexact.errors.UsageError: margin: expected a number above 0 and below 1, found 2
    """

    weights: Mapping[str, Any] | None = None
    margin: float = MARGIN
    disk: float = DISK
    largest_gain: float | None = None
    largest_order: int | None = None
    damping: Entry | None = None
    largest_modulus: Entry | None = None
    digits: int | None = None
    effort: float | None = None
    seeds: int = SEEDS
    box: Entry | None = None
    seconds: float | None = None

    def __post_init__(self) -> None:
        for name in ("margin", "disk", "box", "largest_gain", "damping", "largest_modulus"):
            number = getattr(self, name)
            if isinstance(number, bool) or not isinstance(number, Real):
                optional = number is None and name not in ("margin", "disk")
                _require(optional, name, "a number", shown_value(number))
        _require(0 < self.margin < 1, "margin", "a number above 0 and below 1", self.margin)
        _require(0 < self.disk < 2, "disk", "a number above 0 and below 2", self.disk)
        if self.largest_gain is not None:
            good = 0 < self.largest_gain and isfinite(self.largest_gain)
            _require(good, "largest_gain", "a number above 0", self.largest_gain)
        if self.box is not None:
            object.__setattr__(self, "box", as_requested(self.box, where="box"))
            _require(0 < _number(self.box) < 1, "box", "a number above 0 and below 1", self.box)
        if self.damping is not None:
            object.__setattr__(self, "damping", as_requested(self.damping, where="damping"))
            good = 0 < _number(self.damping) < 1
            _require(good, "damping", "a number above 0 and below 1", self.damping)
        if self.largest_modulus is not None:
            most = as_requested(self.largest_modulus, where="largest_modulus")
            object.__setattr__(self, "largest_modulus", most)
            good = 0 < _number(self.largest_modulus)
            _require(good, "largest_modulus", "a number above 0", self.largest_modulus)
        for name, least in (("largest_order", 0), ("digits", 1), ("seeds", 1)):
            number = getattr(self, name)
            if number is not None:
                good = type(number) is int and number >= least
                _require(good, name, f"an integer of at least {least}", number)
        for name in ("effort", "seconds"):
            if getattr(self, name) is not None:
                require_seconds(getattr(self, name), name)

    def searched_for(self, request: Request) -> bool:
        """Whether there is a search: no spectrum, no agent with a channel controller, effort."""
        return request.spectrum is None and request.agent is None and self.effort != 0

    @property
    def shape(self) -> Shape:
        """The limits on the eigenvalues."""
        limits = (self.damping, self.largest_modulus)
        return Shape(*(None if limit is None else _number(limit) for limit in limits))


def _number(limit: Entry) -> float:
    return to_float(as_requested(limit))


def _require(good: bool, name: str, expected: str, actual: object) -> None:
    if not good:
        raise UsageError(f"expected {expected}, found {actual}", where=name)


THEOREM = Aims(effort=0)
"""No search: the controller of the theorem."""


# Figures of a loop, and those of the optimal controller of all agents together.

STEPS = 400
_FIGURE_BEYOND_SENSE = 1e30


@dataclass(frozen=True)
class Figures:
    """Figures of a loop, computed in floating point and not proved.

    Attributes
    ----------
    order : int
        The dimension of all agents' states.
    largest_gain : float
        The largest absolute entry of the programs.
    bound : float
        The largest real part, or modulus, of an eigenvalue.
    margin : float
        1/max σ_max(T), T the complementary sensitivity at all inputs of the plant together; 0 if
        the loop is not stable.  A relative error of every input below this keeps the loop stable.
    peak : float
        The largest ‖x(t)‖ from a unit state of the plant, the agents' states being 0.  Where the
        plant is one with integrators, these count, and their sizes depend on the unit of time.
    cost : float
        E[x'Qx + u'Ru], as `loop_cost` defines it.
    damping : float
        The least damping ratio of an eigenvalue; see `least_damping`.
    fastest : float
        The largest modulus of an eigenvalue.
    """

    order: int
    largest_gain: float
    bound: float
    margin: float
    peak: float
    cost: float
    damping: float = np.nan
    fastest: float = np.nan


def figures_of(
    problem: FeedbackProblem, K: Floats, *, peak: bool = True, margin: float | None = None
) -> Figures:
    """Compute the figures of a loop; without ``peak`` that one is not computed and is NaN.

    The margin is computed unless it is given.
    """
    M = problem.closed(K)
    form = SchurForm.of(M, discrete=problem.discrete)
    bound, gain = np.inf if form is None else form.bound, float(np.max(np.abs(K), initial=0.0))
    if form is None or not bound < (1.0 if problem.discrete else 0.0):
        return unstable_figures(problem.order, gain, form)
    [(cost, _)] = quadratic_costs(problem.bare, K, (1.0 if problem.discrete else 0.0,))
    if margin is None:
        points = frequencies(
            form.eigenvalues, discrete=problem.discrete, count=GRID_OF_PEAKS, widen=10.0
        )
        largest = Sensitivity(problem, K).peak(points)
        margin = 1 / largest if largest else np.inf
    return Figures(
        problem.order,
        gain,
        bound,
        margin,
        peak_of_state(M, problem.n, form) if peak else np.nan,
        cost,
        *damping_and_fastest(form.eigenvalues, discrete=form.discrete),
    )


def unstable_figures(order: int, gain: float, form: SchurForm | None) -> Figures:
    """The figures of a loop that is not stable, or whose numbers overflow."""
    if form is None:
        return Figures(order, gain, np.inf, 0.0, np.inf, np.inf)
    return Figures(
        order,
        gain,
        form.bound,
        0.0,
        np.inf,
        np.inf,
        *damping_and_fastest(form.eigenvalues, discrete=form.discrete),
    )


def damping_and_fastest(
    eigenvalues: npt.NDArray[np.complex128], *, discrete: bool
) -> tuple[float, float]:
    """The least damping ratio and the largest modulus of an eigenvalue."""
    largest = float(np.max(np.abs(eigenvalues), initial=0.0))
    return least_damping(eigenvalues, discrete=discrete), largest


def peak_of_state(M: Floats, n: int, form: SchurForm, scales: Floats | None = None) -> float:
    """Compute max ‖E‖ over time, E the block of n plant states of exp(Mt) or M^t.

    With scales d the matrix is that of the loop in the coordinates x/d, and E that of x.

    Notes
    -----
    In continuous time at times that grow geometrically, eight to an octave, from a fraction of the
    fastest time constant to eight times the slowest; in discrete time at the first 400 steps, and
    then alike.  A lower estimate.
    """
    d = np.ones(n) if scales is None else scales[:n]
    blocks = (E[:n, :n] * d[:, None] / d for E in _powers(M, form))
    return max(1.0, max(map(norm, blocks), default=1.0))


def _powers(M: Floats, form: SchurForm) -> Iterator[Floats]:
    """Yield exp(Mt) or M^t at the times of `peak_of_state`; ends where numbers overflow."""
    if form.discrete:
        power = np.eye(len(M))
        for _ in range(STEPS):
            power = M @ power
            yield power
        step, elapsed, start = np.linalg.matrix_power(M, STEPS // 8), STEPS / 8, 1.0
        slowest = -float(np.log(max(form.bound, 1e-300)))
    else:
        start = 0.05 / float(np.max(np.abs(form.eigenvalues), initial=1e-9))
        step, elapsed, slowest = expm(M * start), 1.0, -form.bound
    end = 8 / max(slowest, 1e-300) / start
    while elapsed < end and np.all(np.abs(step) < _FIGURE_BEYOND_SENSE):
        power = step
        for _ in range(8):
            yield power
            power = power @ step
        step, elapsed = step @ step, 2 * elapsed


def shift_of(region: StabilityRegion, factor: float = 1.0) -> float:
    """Return the shift of a region tightened by a factor: factor·R, or R^factor.

    A radius of 1 becomes 0.98 where the factor exceeds 1.

    Examples
    --------
    >>> shift_of(StabilityRegion("continuous", 2), 1.5), shift_of(StabilityRegion("discrete"), 1.02)
    (3.0, 0.98)
    """
    edge = to_float(region.edge)
    if not region.discrete:
        return factor * edge
    if edge == 1.0 and factor > 1:
        return float(0.98 ** (50 * (factor - 1)))
    return float(edge**factor)


@dataclass(frozen=True, eq=False)
class CentralOptimum:
    """The optimal controller that all agents together would have.

    Attributes
    ----------
    figures : Figures
    sizes : Sizes
        The standard deviations of the signals of the plant, and the pace of its loop.
    """

    figures: Figures
    sizes: Sizes


def central_optimum(
    system: MultiChannelSystem, weights: Weights, region: StabilityRegion, *, peak: bool = False
) -> CentralOptimum | None:
    """Compute the optimal controller that all agents together would have.

    Parameters
    ----------
    system : MultiChannelSystem
    weights : Weights
    region : StabilityRegion
        The controller is the optimal one of the shifted plant, and its cost is that of the plant.
    peak : bool
        Whether the peak of the state is computed, too; else it is NaN.

    Returns
    -------
    CentralOptimum or None
        None if the Riccati equations have no stabilizing solution in floating point.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> region = StabilityRegion("continuous", 1)
    >>> round(central_optimum(plant, Weights.unit(plant), region).figures.bound, 3)
    -3.236
    """
    one = merged(as_plant(system), [list(system.names)])
    problem = FeedbackProblem.of(decentralized_network(one), [one.n], weights)
    n, [agent] = one.n, problem.agents
    model = Model(
        problem.A[:n, :n],
        problem.B[:n, agent.inputs],
        problem.C[agent.heard][:, :n],
        weights.Q,
        weights.R,
        weights.W,
        weights.V,
        problem.discrete,
    )
    controller = gaussian_controller(model, shift_of(region))
    if controller is None:
        return None
    A_k, B_k, C_k, D_k = controller
    K = balanced(problem, np.block([[D_k, C_k], [B_k, A_k]]))
    figures = figures_of(problem, K, peak=peak)
    return CentralOptimum(figures, _sizes(problem, K, region))


def least_cost(system: MultiChannelSystem, weights: Weights) -> float | None:
    """Compute the cost of the best linear controller, in floating point.

    Parameters
    ----------
    system : MultiChannelSystem
    weights : Weights

    Returns
    -------
    float or None
        The bound of `cost_bound`, without room for rounding; None where the Riccati equations have
        no stabilizing solution in floating point.

    Examples
    --------
    >>> plant = MultiChannelSystem([[0]], [[[1]]], [[[1]]], time="discrete")
    >>> round(least_cost(plant, Weights.unit(plant)), 2)
    1.0
    """
    A, B, C = map(matrix_to_float, (system.A, system.input_matrix(), system.output_matrix()))
    if not A.size:
        return None
    Q, R, W, V = weights.Q, weights.R, weights.W, weights.V
    if not B.size:
        B, R = np.zeros((len(A), 1)), np.eye(1)
    if not C.size:
        C, V = np.zeros((1, len(A))), np.eye(1)
    discrete = is_discrete(system.time)
    solutions = riccati_solutions(
        (A, B, C), (Q, R, W, V), discrete=discrete, bandwidth=weights.bandwidth
    )
    if solutions is None:
        return None
    P, S, F = solutions
    spent = R + B.T @ P @ B if discrete else R
    cost = float(np.sum(P * W)) + float(np.sum((F.T @ spent @ F) * S))
    return cost if cost > 0 and isfinite(cost) else None


def _sizes(problem: FeedbackProblem, K: Floats, region: StabilityRegion) -> Sizes:
    """Compute the standard deviations of inputs and outputs; 1 where they cannot be computed.

    The pace is the ratio of the deviations of the inputs' derivatives, without noise, and of the
    inputs.
    """
    p, q = problem.p, problem.mask.shape[1] - sum(problem.orders)
    M = problem.closed(K)
    form, noise = SchurForm.of(M, discrete=problem.discrete), problem.B @ K
    pace, gramians = max(to_float(region.edge), 1e-6), None
    if form is not None and form.bound < (1.0 if problem.discrete else 0.0):
        W = problem.bare.W + noise @ problem.V @ noise.T
        gramians = form.gramians(W, W, 1.0 if problem.discrete else 0.0)
    if gramians is None:
        return Sizes(np.ones(p), np.ones(q), 1.0 if problem.discrete else pace)
    S = gramians[0]
    seen, driven = problem.C[:q], (K @ problem.C)[:p]
    inputs, faster = _deviations(driven, S), np.linalg.norm(_deviations(driven @ M, S))
    if problem.discrete:
        pace = 1.0
    elif inputs.any():
        pace = max(pace, float(faster / np.linalg.norm(inputs)))
    return Sizes(inputs, _deviations(seen, S), pace)


def _deviations(rows: Floats, S: Floats) -> Floats:
    """The standard deviations of some signals, none of them negligible beside the others."""
    deviations = np.sqrt(np.maximum(np.einsum("ij,jk,ik->i", rows, S, rows), 0.0))
    largest = float(np.max(deviations, initial=0.0))
    floored: Floats = np.maximum(deviations, 1e-6 * largest) if largest else np.ones(len(rows))
    return floored
