"""Figures of a loop that say whether a person would install its controller."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import expm

from mcexact.derived.merged import merged
from mcexact.exact.floats import to_float
from mcexact.exact.location import StabilityRegion
from mcexact.model.system import MultiChannelSystem, as_plant
from mcexact.synthesis.network.networks import decentralized_network
from mcexact.synthesis.optimum.cost import quadratic_costs
from mcexact.synthesis.optimum.problem import FeedbackProblem, Sizes
from mcexact.synthesis.optimum.programs import balanced
from mcexact.synthesis.optimum.regulator import Model, gaussian_controller
from mcexact.synthesis.optimum.sensitivity import Sensitivity, frequencies, norm
from mcexact.synthesis.optimum.shape import least_damping
from mcexact.synthesis.optimum.spectrum import SchurForm
from mcexact.synthesis.optimum.weights import Floats, Weights

_FREQUENCIES = 200
STEPS = 400
_BEYOND_SENSE = 1e30


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
        E[x'Qx + u'Ru], with tr(R K_y V K_y') also in continuous time.
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


def figures_of(problem: FeedbackProblem, K: Floats, *, peak: bool = True) -> Figures:
    """Compute the figures of a loop; without ``peak`` that one is not computed and is NaN."""
    M = problem.closed(K)
    seen = Sensitivity(problem, K)
    form = SchurForm.of(M, discrete=problem.discrete)
    bound, gain = np.inf if form is None else form.bound, float(np.max(np.abs(K), initial=0.0))
    if form is None or not bound < (1.0 if problem.discrete else 0.0):
        return unstable_figures(problem.order, gain, form)
    points = frequencies(
        form.eigenvalues, discrete=problem.discrete, count=_FREQUENCIES, widen=10.0
    )
    [(cost, _)] = quadratic_costs(problem.bare, K, (1.0 if problem.discrete else 0.0,))
    largest = seen.peak(points)
    return Figures(
        problem.order,
        gain,
        bound,
        1 / largest if largest else np.inf,
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


def peak_of_state(M: Floats, n: int, form: SchurForm) -> float:
    """Compute max ‖E‖ over time, E the block of n plant states of exp(Mt) or M^t.

    Notes
    -----
    In continuous time at times that grow geometrically, eight to an octave, from a fraction of the
    fastest time constant to eight times the slowest; in discrete time at the first 400 steps, and
    then alike.  A lower estimate.
    """
    return max(1.0, max((norm(E[:n, :n]) for E in _powers(M, form)), default=1.0))


def _powers(M: Floats, form: SchurForm) -> Iterator[Floats]:
    """Yield exp(Mt) or M^t at the times that `peak_of_state` tells; ends where numbers overflow."""
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
    while elapsed < end and np.all(np.abs(step) < _BEYOND_SENSE):
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
    system: MultiChannelSystem, weights: Weights, region: StabilityRegion
) -> CentralOptimum | None:
    """Compute the optimal controller that all agents together would have.

    Parameters
    ----------
    system : MultiChannelSystem
    weights : Weights
    region : StabilityRegion
        The controller is the optimal one of the shifted plant, and its cost is that of the plant.

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
    found = gaussian_controller(model, shift_of(region))
    if found is None:
        return None
    A_k, B_k, C_k, D_k = found
    K = balanced(problem, np.block([[D_k, C_k], [B_k, A_k]]))
    figures = figures_of(problem, K)
    return CentralOptimum(figures, _sizes(problem, K, region))


def _sizes(problem: FeedbackProblem, K: Floats, region: StabilityRegion) -> Sizes:
    """Compute the standard deviations of inputs and outputs; 1 where they are not to be had.

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
    found = np.sqrt(np.maximum(np.einsum("ij,jk,ik->i", rows, S, rows), 0.0))
    largest = float(np.max(found, initial=0.0))
    floored: Floats = np.maximum(found, 1e-6 * largest) if largest else np.ones(len(rows))
    return floored
