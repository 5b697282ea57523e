"""Figures and curves of any loop, and what a request costs.

The figures of a loop (cost, margin, peak, damping) are computed in two ways.

- `figures_of_loop` uses double precision; it is quick, and compares candidates.
- `sure_figures` is for display.  Rounding moves multiple eigenvalues far more than other figures:
  double precision gives -0.83 for an eightfold eigenvalue -1, as loops by the theorems have them.
  Therefore the eigenvalues are roots of the exact characteristic polynomial, the peak of the state
  is computed in ball arithmetic, and the margin is confirmed there, so that all processors show the
  same digits.  Beyond 40 states it falls back to double precision, and gives NaN where that is not
  reliable.

`rounded_controller` and `digits_that_suffice` round the entries of a controller, `curves_of`
computes the curves of its page.

`diagnosed` says before any search what a region costs: the optimal controller that all agents
together would have, the fastest region for which this controller is affordable (ten times the least
cost, margin 0.3), and the modes outside the region that are nearest to being fixed.
`chosen_regions` derives the slowest rate of a request that names none from it.  Nothing here is
proved.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import ROUND_FLOOR, Context, Decimal
from fractions import Fraction
from itertools import takewhile
from math import isnan

import numpy as np
from scipy.linalg import eig, expm, matrix_balance

from mcexact.analysis.performance import modal_form
from mcexact.analysis.stability import POLYNOMIAL_LIMIT, closed_loop_spectrum
from mcexact.errors import LimitReached
from mcexact.exact.balls import even_powers, response, states_at_doubling_steps
from mcexact.exact.linear_algebra import characteristic_polynomial, solve_nonsingular
from mcexact.exact.matrix import (
    Matrix,
    block_diagonal,
    matrix_from_float,
    matrix_to_float,
    to_float,
    vstack,
)
from mcexact.exact.roots import StabilityRegion, is_discrete, steady_point
from mcexact.floating.margins import is_within
from mcexact.floating.verdicts import distance_at
from mcexact.model.controller import AgentProgram, Controller, LinearMap, with_matrices
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.regulated import Selection, positions_of
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.networks import decentralized_network
from mcexact.synthesis.optimum.figures import (
    DISK,
    STEPS,
    CentralOptimum,
    Complexes,
    Figures,
    Response,
    central_optimum,
    damping_and_fastest,
    frequencies,
    norm,
    peak_of_state,
    unstable_figures,
)
from mcexact.synthesis.optimum.problem import (
    FeedbackProblem,
    Floats,
    SchurForm,
    Weights,
    filtered_noise,
    quiet_floats,
    solved_or_nan,
)
from mcexact.synthesis.optimum.starts import regulator, whole_model

# Figures of any closed loop, in double precision and accurately; rounding of programs.

_FREQUENCIES, _NEAR = 200, 60
_SAME = 0.005
_MOST_EXACT_RESPONSES = 24
"""The most states of a loop whose response is computed in ball arithmetic at all frequencies."""
MOST_DIGITS = 16
_MANY, _NEAR_WORST = 60, 0.7
"""The states of a large loop, and the part of the worst gain at which a frequency matters."""
_NEARLY = 0.9


def figures_of_loop(
    loop: ClosedLoop, weights: Weights, integrators: Integrators | None = None
) -> Figures:
    """Compute the figures of a closed loop.

    Parameters
    ----------
    loop : ClosedLoop
        With n states of the plant.
    weights : Weights
        Of the plant, with its integrators if there are any.
    integrators : Integrators, optional
        Those of `integrators_of`.

    Notes
    -----
    In floating point.  The loop is M, its inputs are u = U x + D ν with the noise ν of all outputs,
    which enters the loop by N: at once, or by the messages under way; with integrators it is
    also the noise of the integrals.  With the Gramian S,
    M S + S M' + W + N V N' = 0 (discrete time: M S M' − S + … = 0)::

        J = tr(S (Q + U'R U)) + tr(R D V D')

    In continuous time N V N' becomes N X' + X N', and J becomes tr(S (Q + U'R U)) + 2 tr(X'U'R D) +
    tr(R D Y D'), with X and Y as in `filtered_noise`.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> from mcexact.model.system import MultiChannelSystem
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> loop = closed_loop(plant, local_controllers(plant, [[[-3]]]))
    >>> figures = figures_of_loop(loop, Weights.unit(plant))
    >>> figures.bound, round(figures.margin, 3), round(figures.cost, 3)
    (-2.0, 0.667, 6.956)
    """
    M, discrete = matrix_to_float(loop.matrix), is_discrete(loop.plant.time)
    order, gain = loop.controller.order, to_float(loop.controller.largest_entry())
    form = SchurForm.of(M, discrete=discrete)
    if form is None or not form.bound < (1.0 if discrete else 0.0):
        return unstable_figures(order, gain, form)
    return Figures(
        order,
        gain,
        form.bound,
        margin_of(loop),
        peak_of_state(M, loop.plant.n, form),
        _cost(loop, form, weights, integrators),
        *damping_and_fastest(form.eigenvalues, discrete=discrete),
    )


def sure_figures(
    loop: ClosedLoop, weights: Weights, integrators: Integrators | None = None
) -> Figures:
    """Compute the figures of a closed loop as `figures_of_loop` does, accurately.

    Returns
    -------
    Figures
        NaN stands for a figure that is not known: of a loop with more than 40 states the peak and
        the rate where double precision in two kinds of coordinates disagrees about it, and of any
        loop such a cost, and a margin that is not confirmed.  The margin is 0 where the loop, with
        its entries rounded to double precision, is not stable.

    Notes
    -----
    The eigenvalues are those of `loop_eigenvalues`.  The peak is computed by `_trajectory`, and
    the margin is confirmed in ball arithmetic at the frequency where it is least.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> from mcexact.model.system import MultiChannelSystem
    >>> plant = MultiChannelSystem([[-1, 9], [0, -1]], [[[0], [1]]], [[[1, 0]]])
    >>> loop = closed_loop(plant, local_controllers(plant, [[[0]]]))
    >>> figures = sure_figures(loop, Weights.unit(plant))
    >>> figures.bound, figures.damping, round(figures.peak, 3)
    (-1.0, 1.0, 3.351)
    """
    M, discrete = matrix_to_float(loop.matrix), is_discrete(loop.plant.time)
    order, gain = loop.controller.order, to_float(loop.controller.largest_entry())
    form, limit = SchurForm.of(M, discrete=discrete), 1.0 if discrete else 0.0
    values = loop_eigenvalues(loop.matrix, discrete=discrete)
    if form is None or (values is None and not form.bound < limit):
        return unstable_figures(order, gain, form)
    other = _balanced(M)
    again = SchurForm.of(other, discrete=discrete)
    if values is None:
        sizes = [each.bound for each in (form, again) if each is not None]
        bound = form.bound if _agree(sizes, limit) else np.nan
        values, peak = form.eigenvalues, np.nan
        if again is not None and again.bound < limit:
            peaks = [
                peak_of_state(M, loop.plant.n, form),
                peak_of_state(other, loop.plant.n, again, _scales(M)),
            ]
            peak = peaks[0] if _agree(peaks) else np.nan
        stays = True
    else:
        bound = _bound_of(values, discrete=discrete)
        if not bound < limit:
            shape = damping_and_fastest(values, discrete=discrete)
            return Figures(order, gain, bound, 0.0, np.inf, np.inf, *shape)
        peak = _sure_peak(loop, values)
        stays = _is_stable_in_doubles(loop, M)
    cost = _cost(loop, form, weights, integrators) if form.bound < limit else np.nan
    if again is not None and again.bound < limit and np.isfinite(cost):
        scaled = _cost(loop, again, weights, integrators, _scales(M))
        cost = cost if _agree([cost, scaled]) else np.nan
    return Figures(
        order,
        gain,
        bound,
        _confirmed_margin(loop, values) if stays else 0.0,
        peak,
        cost,
        *damping_and_fastest(values, discrete=discrete),
    )


def loop_eigenvalues(M: Matrix, *, discrete: bool) -> Complexes | None:
    """Return the distinct eigenvalues of a rational matrix, rounded to floats.

    Returns
    -------
    ndarray of complex, or None
        None beyond 40 states, or where an eigenvalue exceeds floats.

    Examples
    --------
    >>> loop_eigenvalues(Matrix.from_rows([[-1, 1, 0], [0, -1, 1], [0, 0, -1]]), discrete=False)
    array([-1.+0.j])
    """
    if M.nrows > POLYNOMIAL_LIMIT:
        return None
    spectrum = closed_loop_spectrum(M, "discrete" if discrete else "continuous")
    values = np.array(
        [complex(to_float(disc.re), to_float(disc.im)) for disc in spectrum.discs],
        dtype=np.complex128,
    )
    return values if np.all(np.isfinite(values)) else None


def bound_of_eigenvalues(M: Matrix, *, discrete: bool) -> float | None:
    """Return the largest real part, or modulus, of `loop_eigenvalues`; None if these are None."""
    values = loop_eigenvalues(M, discrete=discrete)
    return None if values is None else _bound_of(values, discrete=discrete)


def _bound_of(values: Complexes, *, discrete: bool) -> float:
    if not len(values):
        return 0.0 if discrete else -np.inf
    return float(np.max(np.abs(values) if discrete else values.real))


def _is_stable_in_doubles(loop: ClosedLoop, M: Floats) -> bool:
    """Whether the loop is stable with its entries rounded to double precision, exactly."""
    if not np.all(np.isfinite(M)):
        return False
    rounded = matrix_from_float(M, "dyadic")
    region = StabilityRegion(loop.plant.time)
    return region.contains_roots_of(characteristic_polynomial(rounded))


def _agree(figures: Sequence[float], limit: float = 0.0) -> bool:
    """Whether two figures differ by less than half a percent."""
    sizes = [each - limit for each in figures]
    return len(sizes) == 2 and abs(sizes[0] - sizes[1]) <= _SAME * abs(sizes[0])


def _scales(M: Floats) -> Floats:
    """The powers of 2 that balance a matrix."""
    _, (scales, _) = matrix_balance(M, permute=False, separate=True)
    return np.asarray(scales)


def _balanced(M: Floats) -> Floats:
    """D⁻¹ M D with the scales of `_scales`, exactly but for underflow."""
    if not len(M):
        return M
    scales = _scales(M)
    balanced: Floats = M / scales[:, None] * scales[None, :]
    return balanced


def _trajectory(
    M: Matrix, start: Matrix, values: Complexes, rows: int, *, discrete: bool
) -> list[Floats] | None:
    """The first rows of exp(Mt) or M^t times a matrix, at the times of `peak_of_state`."""
    bound = _bound_of(values, discrete=discrete)
    if discrete:
        first, whole, end = 0.0, STEPS, 8 / max(-float(np.log(max(bound, 1e-300))), 1e-300)
    else:
        first = 0.05 / float(np.max(np.abs(values), initial=1e-9))
        whole, end = 0, 8 / max(-bound, 1e-300) / first
    return states_at_doubling_steps(M, start, rows, first=first, whole=whole, end=end)


def _sure_peak(loop: ClosedLoop, values: Complexes) -> float:
    """The peak of the state, as `peak_of_state` has it."""
    n, N = loop.plant.n, loop.dimension
    start = Matrix.identity(N).take(cols=range(n))
    states = _trajectory(loop.matrix, start, values, n, discrete=is_discrete(loop.plant.time))
    if states is None:
        return np.nan
    return max(1.0, max((norm(E) for E in states), default=1.0))


def step_peak(loop: ClosedLoop, integrators: Integrators) -> float:
    """Compute the largest regulated output of a loop while its own set-point steps from 0 to 1.

    Parameters
    ----------
    loop : ClosedLoop
        Stable.
    integrators : Integrators
        Those of `integrators_of`.

    Returns
    -------
    float
        NaN if it is not known: beyond 40 states.

    Examples
    --------
    >>> from mcexact.synthesis.setpoint import design_setpoint
    >>> from mcexact.model.system import MultiChannelSystem
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], neighbors={"1": []})
    >>> controller = design_setpoint(plant, rate=1).controller
    >>> loop = closed_loop(plant, controller)
    >>> 1 <= step_peak(loop, integrators_of(loop)) < 10
    True
    """
    discrete, N, n = is_discrete(loop.plant.time), loop.dimension, loop.plant.n
    values = loop_eigenvalues(loop.matrix, discrete=discrete)
    at_rest = Matrix.identity(N) * Fraction(steady_point(loop.plant.time))
    entering = -Matrix.identity(N).take(cols=integrators.places)
    rest = solve_nonsingular(at_rest - loop.matrix, entering)
    if values is None or rest is None:
        return np.nan
    states = _trajectory(loop.matrix, rest, values, n, discrete=discrete)
    if states is None:
        return np.nan
    C = matrix_to_float(block_diagonal(integrators.selection) @ loop.plant.output_matrix())
    reached = C @ matrix_to_float(rest.take(rows=range(n)))
    peaks = (float(np.max(np.abs(np.diag(reached - C @ E)), initial=0.0)) for E in states)
    return max(peaks, default=0.0)


def _confirmed_margin(loop: ClosedLoop, values: Complexes) -> float:
    """The margin of a stable loop; NaN if ball arithmetic has another one at its frequency."""
    discrete = is_discrete(loop.plant.time)
    response = input_response(loop)
    points = boundary_points(values, discrete=discrete)
    sizes = response.sizes(points)
    if not np.any(sizes):
        return np.inf
    if _is_confirmed(loop, complex(points[int(np.argmax(sizes))]), float(np.max(sizes))):
        return float(1 / np.max(sizes))
    if loop.dimension > _MOST_EXACT_RESPONSES:
        return np.nan
    exact = [_ball_response(loop, complex(z)) for z in points]
    return float(1 / max(exact)) if all(map(np.isfinite, exact)) else np.nan


def _is_confirmed(loop: ClosedLoop, z: complex, size: float) -> bool:
    return loop.dimension > POLYNOMIAL_LIMIT or _agree([size, _ball_response(loop, z)])


def _ball_response(loop: ClosedLoop, z: complex) -> float:
    """The largest singular value of T(z), from ball arithmetic; NaN if it is not accurate."""
    N, n = loop.dimension, loop.plant.n
    entering = loop.plant.input_matrix()
    B = vstack([entering, Matrix.zeros(N - n, entering.ncols)], ncols=entering.ncols)
    T = response(loop.matrix, B, _inputs(loop), z)
    return np.nan if T is None else norm(T)


def plain_figures(loop: ClosedLoop) -> Figures:
    """Compute the figures of a closed loop for weights of 1, without warnings about its numbers."""
    with quiet_floats():
        return figures_of_loop(loop, Weights.unit(loop.plant))


def input_response(loop: ClosedLoop) -> Response:
    """Return the complementary sensitivity at all inputs of the plant together."""
    M, B = matrix_to_float(loop.matrix), matrix_to_float(loop.plant.input_matrix())
    entering = np.vstack([B, np.zeros((len(M) - len(B), B.shape[1]))])
    return Response(M, entering, input_rows(loop), discrete=is_discrete(loop.plant.time))


def margin_of(loop: ClosedLoop) -> float:
    """Compute the margin of a stable loop at the inputs of the plant."""
    response, discrete = input_response(loop), is_discrete(loop.plant.time)
    largest = response.peak(boundary_points(response.eigenvalues, discrete=discrete))
    return 1 / largest if largest else np.inf


def least_disk_margin(loop: ClosedLoop) -> float:
    """Compute the least disk margin of a single input or output of a stable loop.

    Notes
    -----
    1/max |T_ii + ½| on a grid of frequencies; 2 at most.  One eigendecomposition serves all; where
    the eigenvectors are too ill-conditioned, there is one linear system for each frequency.
    """
    return _disk_margins(loop)[0]


def _disk_margins(loop: ClosedLoop, points: Complexes | None = None) -> tuple[float, Complexes]:
    """The least disk margin at some frequencies, by default all, and those where it is near."""
    seen, discrete = loop.disturbed, is_discrete(loop.plant.time)
    M = matrix_to_float(seen.M)
    entering = np.hstack([matrix_to_float(seen.E), matrix_to_float(seen.G)])
    leaving = np.vstack([matrix_to_float(seen.U), matrix_to_float(seen.Y)])
    with quiet_floats():
        modal = modal_form(M, entering, leaving)
        if points is None:
            values = np.linalg.eigvals(M).astype(np.complex128) if modal is None else modal[0]
            points = boundary_points(values, discrete=discrete)
        if modal is not None:
            values, left, right = modal
            T = (1 / (points[:, None] - values)) @ (left * right.T).T
        else:
            eye, columns = np.eye(len(M)), entering.astype(np.complex128)
            solved = (solved_or_nan(z * eye - M, columns) for z in points)
            T = np.array([np.einsum("ik,ki->i", leaving, X) for X in solved])
        sizes = np.nanmax(np.abs(T + 0.5), axis=1, initial=0.0)
    largest = max(float(np.max(sizes, initial=0.0)), 0.5)
    return 1 / largest, points[sizes >= _NEAR_WORST * largest]


def boundary_points(values: Complexes, *, discrete: bool) -> Complexes:
    """Return a grid of the boundary of stability, finer near the slowest eigenvalues."""
    distance = 1 - np.abs(values) if discrete else -values.real / np.maximum(np.abs(values), 1e-300)
    near = values[np.argsort(distance)[:_NEAR]]
    all_over = frequencies(values, discrete=discrete, count=_FREQUENCIES, widen=10.0)
    grid = all_over[: _FREQUENCIES + (not discrete)]
    on_it = np.exp(1j * np.abs(np.angle(near))) if discrete else 1j * np.abs(near.imag)
    return np.concatenate([grid, np.unique(on_it)])


def input_rows(loop: ClosedLoop) -> Floats:
    """Return U, the rows of all inputs over the state of the loop."""
    return matrix_to_float(_inputs(loop))


def _inputs(loop: ClosedLoop) -> Matrix:
    """Return U exactly, the rows of all inputs over the state of the loop."""
    agents = enumerate(loop.controller.agents)
    return vstack(
        [loop.rows(agent.input, i, loop.plant.p(i)) for i, agent in agents], ncols=loop.dimension
    )


def _cost(
    loop: ClosedLoop,
    form: SchurForm,
    weights: Weights,
    integrators: Integrators | None,
    scales: Floats | None = None,
) -> float:
    """The linear-quadratic cost of a stable loop; infinite where its Gramian overflows.

    The form is that of D⁻¹MD, D with scales on the diagonal if there are some.
    """
    U = input_rows(loop)
    size, n = loop.dimension, loop.plant.n
    added = () if integrators is None else integrators.places
    places = np.array([*range(n), *added], dtype=np.intp)
    N, D = _noise(loop)
    if integrators is not None:
        N, D = _with_integrals(loop, N, D, U, integrators)
    Q, W = np.zeros((size, size)), np.zeros((size, size))
    Q[np.ix_(places, places)] = weights.Q
    W[np.ix_(places, places)] = weights.W
    X, Y = np.zeros(N.shape), weights.V
    if weights.bandwidth is not None and not form.discrete:
        M = matrix_to_float(loop.matrix)
        X, Y = filtered_noise(M, N, weights.V, weights.bandwidth)
        W = W + N @ X.T + X @ N.T
    else:
        W = W + N @ weights.V @ N.T
    Q = Q + U.T @ weights.R @ U
    if scales is not None:
        Q, W = Q * np.outer(scales, scales), W / np.outer(scales, scales)
    gramians = form.gramians(W, Q, 1.0 if form.discrete else 0.0)
    if gramians is None:
        return np.inf
    cost = float(np.sum(gramians[0] * Q)) + float(np.sum(weights.R * (D @ Y @ D.T)))
    cost += 2 * float(np.sum(X * (U.T @ weights.R @ D)))
    return cost if cost > 0 and np.isfinite(cost) else np.inf


def _with_integrals(
    loop: ClosedLoop, N: Floats, D: Floats, U: Floats, integrators: Integrators
) -> tuple[Floats, Floats]:
    """Extend the N and D of `_noise` by noise of the integrals; integrators get no output noise.

    The columns are in the order of the channels, for each channel the integrals first.
    """
    places = np.array(integrators.places, dtype=np.intp)
    measured = matrix_to_float(loop.matrix)[:, places]
    N, measured = N.copy(), measured.copy()
    N[places] = measured[places] = 0.0
    columns, first, second = list[tuple[Floats, Floats]](), 0, 0
    for S in integrators.selection:
        held, own = slice(first, first + S.nrows), slice(second, second + S.ncols)
        columns += [(measured[:, held], U[:, places[held]]), (N[:, own], D[:, own])]
        first, second = held.stop, own.stop
    return np.hstack([each for each, _ in columns]), np.hstack([each for _, each in columns])


def _noise(loop: ClosedLoop) -> tuple[Floats, Floats]:
    """Return N and D: how noise of all outputs enters the state of the loop, and the inputs."""
    plant, agents = loop.plant, loop.controller.agents
    starts = np.concatenate([[0], np.cumsum([plant.q(j) for j in range(plant.m)])]).astype(int)

    def at_once(each: LinearMap, i: int, nrows: int) -> Floats:
        matrix = np.zeros((nrows, int(starts[-1])))
        for j, M in each.without_zeros().outputs.items():
            if not loop.waits(j, i)[1]:
                matrix[:, starts[j] : starts[j + 1]] += matrix_to_float(M)
        return matrix

    N, inputs = np.zeros((loop.dimension, int(starts[-1]))), []
    for i, agent in enumerate(agents):
        inputs.append(at_once(agent.input, i, plant.p(i)))
        N[: plant.n] += matrix_to_float(plant.B(i)) @ inputs[-1]
        for kind, each, count in (
            ("x_", agent.shared_update, agent.shared),
            ("z_", agent.private_update, agent.private),
        ):
            place, _ = loop.blocks[kind, i, 0]
            N[place : place + count] += at_once(each, i, count)
        if ("y_", i, 1) in loop.blocks:
            place, count = loop.blocks["y_", i, 1]
            N[place : place + count, starts[i] : starts[i + 1]] = np.eye(count)
    return N, np.vstack([np.zeros((0, int(starts[-1]))), *inputs])


@dataclass(frozen=True)
class Integrators:
    """The integrators of outputs less set-points in a controller.

    Attributes
    ----------
    places : tuple of int
        Their positions in the state of the loop.
    selection : tuple of Matrix
        S_i, of which agent i integrates S_i (y_i − r_i); without rows for one that integrates
        nothing.
    """

    places: tuple[int, ...]
    selection: Selection


def integrators_of(loop: ClosedLoop) -> Integrators | None:
    """Return the integrators of a controller that holds outputs at set-points; None without any.

    These are the first private states of each agent that nothing but S_i (y_i − r_i) moves, as in
    the controllers of `design_setpoint`.

    Parameters
    ----------
    loop : ClosedLoop
    """
    places, selection = list[int](), list[Matrix]()
    for i, agent in enumerate(loop.controller.agents):
        S = _integrated(agent, i, loop.plant)
        place, _ = loop.blocks["z_", i, 0]
        places += range(place, place + S.nrows)
        selection.append(S)
    return Integrators(tuple(places), tuple(selection)) if places else None


def _integrated(agent: AgentProgram, i: int, plant: MultiChannelSystem) -> Matrix:
    """The rows of S_i: those of the first private states that S_i (y_i − r_i) alone moves."""
    update, stay = agent.private_update, Matrix.identity(agent.private) * steady_point(plant.time)
    own, less = update.outputs.get(i), update.reference
    if own is None or less is None:
        return Matrix.zeros(0, plant.q(i))
    others = [M for j, M in update.outputs.items() if j != i] + [*update.shared.values()]
    others.append((update.private or Matrix.zeros(*stay.shape)) - stay)

    def is_integrated(row: int) -> bool:
        taken = own.take(rows=[row])
        alone = all(M.take(rows=[row]).is_zero() for M in others)
        return alone and not taken.is_zero() and less.take(rows=[row]) == -taken

    return own.take(rows=list(takewhile(is_integrated, range(agent.private))))


def digits_that_suffice(loop: ClosedLoop, region: StabilityRegion) -> int | None:
    """Return a number of significant decimal digits to which all programs may be rounded.

    Parameters
    ----------
    loop : ClosedLoop
    region : StabilityRegion
        Where the eigenvalues of the rounded loop lie; computed ones beyond 40 states.

    Returns
    -------
    int or None
        By bisection, which assumes that more digits are never worse; None if 16 do not suffice.

    Notes
    -----
    The least disk margin of a single input or output is to stay above 0.4, or above nine tenths of
    a smaller one.  It is a ratio, which does not depend on units.  For large loops the bisection
    looks at the frequencies where the margin is small, and all of them confirm its result.
    """
    margin, near = _disk_margins(loop)
    kept = kept_disk_margin(margin)

    def holds(digits: int, points: Complexes | None) -> bool:
        rounded = closed_loop(loop.plant, rounded_controller(loop.controller, digits), loop.graph)
        if not _is_inside(rounded.matrix, region):
            return False
        return kept <= 0 or _disk_margins(rounded, points)[0] >= kept

    some = near if loop.dimension > _MANY else None
    fails, suffice = 0, MOST_DIGITS
    if not holds(suffice, None):
        return None
    while suffice - fails > 1:
        middle = (suffice + fails) // 2
        if holds(middle, some):
            suffice = middle
        else:
            fails = middle
    while some is not None and suffice < MOST_DIGITS and not holds(suffice, None):
        suffice += 1
    return suffice


def kept_disk_margin(margin: float) -> float:
    """The least disk margin of which rounded gains are to leave a loop of this one."""
    return 0.0 if isnan(margin) else DISK if margin >= DISK else _NEARLY * margin


def _is_inside(M: Matrix, region: StabilityRegion) -> bool:
    """Whether the eigenvalues of a matrix lie in a region, exactly where that is quick."""
    if M.nrows <= POLYNOMIAL_LIMIT:
        return region.contains_roots_of(characteristic_polynomial(M))
    floats = matrix_to_float(M)
    return bool(np.all(np.isfinite(floats))) and is_within(floats, region)


def rounded_controller(controller: Controller, digits: int) -> Controller:
    """Round every entry of all programs to some significant decimal digits, exactly.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> from mcexact.model.system import MultiChannelSystem
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> rounded = rounded_controller(local_controllers(plant, [[["-10/3"]]]), 3)
    >>> rounded.agents[0].input.outputs[0].rows()
    ((Fraction(-333, 100),),)
    """
    context = Context(prec=digits)

    def entry(x: Fraction) -> Fraction:
        return Fraction(context.divide(Decimal(x.numerator), Decimal(x.denominator)))

    def matrix(M: Matrix) -> Matrix:
        return Matrix.from_rows([[entry(x) for x in row] for row in M.rows()], ncols=M.ncols)

    return with_matrices(controller, matrix)


# Curves of a loop: sensitivity over the frequency, decay and step responses over time.

_POINTS, _CONSTANTS, _STEPS = 300, 6.0, 400


@dataclass(frozen=True, eq=False)
class Curves:
    """Curves of a stable loop, computed in floating point and not proved.

    Attributes
    ----------
    region : StabilityRegion
        Where eigenvalues should lie.
    eigenvalues : list of complex
    frequencies, sensitivity : list of float
        The largest singular value of the complementary sensitivity at the inputs of the plant, over
        the frequency.
    times, growth, effort : list of float
        The largest ‖x(t)‖ and ‖u(t)‖ from a unit state of the plant, the agents' states being 0.
    steps : list of (str, list of float)
        For a controller that holds set-points: each output after a unit step of its own set-point,
        with its name.
    """

    region: StabilityRegion
    eigenvalues: list[complex]
    frequencies: list[float]
    sensitivity: list[float]
    times: list[float]
    growth: list[float]
    effort: list[float]
    steps: list[tuple[str, list[float]]]

    def keeps(self, eigenvalue: complex) -> bool:
        """Whether an eigenvalue lies in the region."""
        region, size = self.region, abs(eigenvalue)
        if region.discrete:
            return size < region.edge
        damping, most = region.damping, region.largest_modulus
        damped = damping is None or -eigenvalue.real > damping * size
        return eigenvalue.real < -region.edge and damped and (most is None or size < most)


def curves_of(loop: ClosedLoop, region: StabilityRegion) -> Curves | None:
    """Compute the curves of a loop; None if it is not stable.

    Parameters
    ----------
    loop : ClosedLoop
    region : StabilityRegion
        The region that was asked for.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> from mcexact.model.loop import closed_loop
    >>> from mcexact.model.system import MultiChannelSystem
    >>> plant, region = MultiChannelSystem([[1]], [[[1]]], [[[1]]]), StabilityRegion("continuous")
    >>> curves = curves_of(closed_loop(plant, local_controllers(plant, [[[-3]]])), region)
    >>> round(max(curves.sensitivity), 3), curves.growth[0], curves.growth[-1] < 0.01
    (1.5, 1.0, True)
    >>> curves.effort[0], curves.eigenvalues
    (3.0, [(-2+0j)])
    >>> curves_of(closed_loop(plant, local_controllers(plant, [[[0]]])), region)
    """
    M, n = matrix_to_float(loop.matrix), loop.plant.n
    with quiet_floats():
        form = SchurForm.of(M, discrete=region.discrete)
        if form is None or not form.bound < (1.0 if region.discrete else 0.0):
            return None
        response, U = input_response(loop), input_rows(loop)
        values = loop_eigenvalues(loop.matrix, discrete=region.discrete)
        values = form.eigenvalues if values is None else values
        points = boundary_points(values, discrete=region.discrete)
        places = np.abs(np.angle(points)) if region.discrete else points.imag
        order = np.argsort(places)
        times, step = _times(M, form)
        interval = 0.0 if region.discrete else float(times[1])
        powers = None
        if len(M) <= POLYNOMIAL_LIMIT:
            powers = even_powers(loop.matrix, n, interval, len(times))
        if powers is None:
            powers = [power[:, :n] for power in _powers(step, len(times))]
        return Curves(
            region,
            values.tolist(),
            places[order].tolist(),
            response.sizes(points[order]).tolist(),
            times.tolist(),
            [norm(power[:n]) for power in powers],
            [norm(U @ power) for power in powers],
            _steps(loop, M, step, len(times), discrete=region.discrete),
        )


def _times(M: Floats, form: SchurForm) -> tuple[Floats, Floats]:
    """Times over some time constants of the slowest mode, and the matrix of one step."""
    if form.discrete:
        constants = _CONSTANTS / max(-np.log(max(form.bound, 1e-3)), 1e-3)
        count = int(min(max(constants, 10), _STEPS))
        return np.arange(count + 1, dtype=np.float64), M
    times = np.linspace(0.0, _CONSTANTS / -form.bound, _POINTS)
    return times, np.asarray(expm(M * times[1]), dtype=np.float64)


def _powers(step: Floats, count: int) -> Iterator[Floats]:
    """Yield the identity, and powers of a matrix."""
    power = np.eye(len(step))
    for _ in range(count):
        yield power
        power = step @ power


def _steps(
    loop: ClosedLoop, M: Floats, step: Floats, count: int, *, discrete: bool
) -> list[tuple[str, list[float]]]:
    """Each regulated output after a unit step of its own set-point; () without integrators."""
    integrators = integrators_of(loop)
    if integrators is None:
        return []
    n, plant = loop.plant.n, loop.plant
    C = matrix_to_float(block_diagonal(integrators.selection) @ plant.output_matrix())
    R = -np.eye(len(M))[:, np.array(integrators.places, dtype=np.intp)]
    at_rest = np.linalg.solve((np.eye(len(M)) if discrete else 0.0) - M, R)
    names = list[str]()
    for i, S in enumerate(integrators.selection):
        listed = positions_of(S) or range(1, S.nrows + 1)
        names += [plant.names[i] if plant.q(i) == 1 else f"{plant.names[i]}, {k}" for k in listed]
    state, outputs = -at_rest, [list[float]() for _ in names]
    for _ in range(count):
        reached = C @ (at_rest + state)[:n]
        for each, output in zip(outputs, np.diag(reached).tolist(), strict=True):
            each.append(output)
        state = step @ state
    return list(zip(names, outputs, strict=True))


# The diagnosis of a request: the sensible rate, and the modes that are nearly fixed.

TIMES_THE_COST, MARGIN = 10.0, 0.3
TIMES_OUT_OF_REACH, OUT_OF_REACH_MARGIN = 1000.0, 0.05
_STEPS_OF_RATE, _STEPS_IF_LARGE, _LARGE = 14, 4, 100
_FEWEST_MODES, _WORK, _EQUAL = 3, 8_000_000, 1e-9
_FASTER = (2.0, 4.0, 8.0)
_WIDTH, _FACTOR, _FASTEST = 1.02, 4.0, 64.0
_FAST_ENOUGH = 2.3026


@dataclass(frozen=True)
class SlowMode:
    """A mode of the plant outside a region, and how little makes it a fixed mode.

    Attributes
    ----------
    mode : complex
    change : float
        An upper limit on the least change that makes it fixed, relative to ‖A‖.
    channels : tuple of str
        The channels that cannot move it then, by their outputs or by their inputs.
    """

    mode: complex
    change: float
    channels: tuple[str, ...]


@dataclass(frozen=True)
class Diagnosis:
    """What a request costs, computed in floating point and not proved.

    Attributes
    ----------
    region : StabilityRegion
    central, unhurried : CentralOptimum or None
        Of the optimal controller of all agents together, for the region and without one.
    sensible : StabilityRegion or None
        The fastest region found in which this controller has at most ten times the cost that it has
        without one, and a margin of 0.3; None if none was found.  The search does not go beyond 64
        times the given rate, nor for plants of more than 100 states beyond this rate.
    modes : tuple of SlowMode
        Those outside the region, or some of them if there are many: the nearest to being fixed
        first.
    """

    region: StabilityRegion
    central: CentralOptimum | None
    unhurried: CentralOptimum | None
    sensible: StabilityRegion | None
    modes: tuple[SlowMode, ...]

    @property
    def is_sensible(self) -> bool:
        """Whether the region is one in which the central optimum is affordable."""
        return self.central is not None and self.allows(self.central.figures)

    def allows(self, figures: Figures) -> bool:
        """Whether a loop has a margin of 0.3, and at most ten times the least cost."""
        return self.unhurried is not None and _is_affordable(figures, self.unhurried)

    @property
    def is_out_of_reach(self) -> bool:
        """Whether another rate is sensible, and for this one the central optimum is of no use.

        Its margin is below 0.05; or it is below 0.3, and the cost is 1000 times the least.
        """
        if self.sensible is None or self.unhurried is None or self.is_sensible:
            return False
        if self.central is None:
            return True
        figures, least = self.central.figures, self.unhurried.figures.cost
        dear = not figures.cost <= TIMES_OUT_OF_REACH * least
        return figures.margin < (MARGIN if dear else OUT_OF_REACH_MARGIN)

    @property
    def sensible_bound(self) -> str:
        """The sensible rate or radius to three digits, or that there is none."""
        if self.sensible is None:
            return "none"
        edge = to_float(self.sensible.edge)
        return f"{edge:.4g}" if self.sensible.discrete else f"{edge:.3g}"

    def __str__(self) -> str:
        parts = [f"sensible {self.region.word} {self.sensible_bound}"]
        for each in self.modes[:1]:
            parts.insert(
                0, f"mode {_shown(each.mode)}: a relative change of {each.change:.0e} fixes it"
            )
        return f"{'; '.join(parts)} (computed)"

    def view(self) -> dict[str, object]:
        """Return the diagnosis as plain data."""
        nearest = self.modes[0] if self.modes else None
        return {
            f"sensible_{self.region.word}": None
            if self.sensible is None
            else to_float(self.sensible.edge),
            "within": self.is_sensible,
            "nearest_to_fixed": None
            if nearest is None
            else {
                "mode": {"re": nearest.mode.real, "im": nearest.mode.imag},
                "relative_change": nearest.change,
                "channels": list(nearest.channels),
            },
        }


def _shown(mode: complex) -> str:
    real = f"{mode.real:.4g}"
    return real if not mode.imag else f"{real} ± {abs(mode.imag):.4g}i"


def _affordable(optimum: CentralOptimum | None, unhurried: CentralOptimum | None) -> bool:
    if optimum is None or unhurried is None:
        return False
    return _is_affordable(optimum.figures, unhurried)


def _is_affordable(figures: Figures, unhurried: CentralOptimum) -> bool:
    return figures.margin >= MARGIN and figures.cost <= TIMES_THE_COST * unhurried.figures.cost


def diagnosed(
    system: MultiChannelSystem,
    region: StabilityRegion,
    weights: Weights | None = None,
    controlled: MultiChannelSystem | None = None,
    chosen: ChosenRegions | None = None,
) -> Diagnosis:
    """Compute what a region costs, and which modes outside it are nearly fixed.

    Parameters
    ----------
    system : MultiChannelSystem
        n states and m channels.
    region : StabilityRegion
    weights : Weights, optional
    controlled : MultiChannelSystem, optional
        The system whose decentralized controllers are sought; by default the first one.
    chosen : ChosenRegions, optional
        What `chosen_regions` has computed of the same system and weights.

    Notes
    -----
    O(n³) for each of about 12 steps of a bisection, and the search of `distance_at` for each mode.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1, 0], [0, -2]], [[["1"], ["1e-6"]]], [[[1, 1]]])
    >>> diagnosis = diagnosed(plant, StabilityRegion("continuous", 3))
    >>> diagnosis.is_sensible, diagnosis.modes[0].mode
    (False, (-2+0j))
    >>> diagnosed(plant, StabilityRegion("continuous")).sensible.edge > 1
    True
    """
    weights = weights or Weights.unit(system)
    with quiet_floats():
        central = central_optimum(system, weights, region, peak=True)
        sensible = None if chosen is None else chosen.sensible
        unhurried = None if chosen is None else chosen.unhurried
        if unhurried is None:
            unhurried = central_optimum(system, weights, StabilityRegion(system.time))
        if sensible is None:
            start, optimum = region, central
            if region.edge == StabilityRegion(system.time).edge and unhurried:
                # It is searched around a rate, of which stability alone gives none.
                start = _own_region(system.time, unhurried) or region
                optimum = central_optimum(system, weights, start)
            sensible = _sensible(system, weights, start, optimum, unhurried)
        modes = slow_modes(controlled or system, region)
    return Diagnosis(region, central, unhurried, sensible, modes)


def with_diagnosis(
    limit: LimitReached,
    system: MultiChannelSystem,
    region: StabilityRegion,
    weights: Weights | None = None,
    controlled: MultiChannelSystem | None = None,
) -> LimitReached:
    """Append the diagnosis to the message of a limit; further arguments as in `diagnosed`.

    The limit stays as it is for plants whose numbers exceed floats, which have no diagnosis.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> limit = LimitReached("2000 draws found nothing")
    >>> str(with_diagnosis(limit, plant, StabilityRegion("continuous"))).split("; ")[:2]
    ['2000 draws found nothing', 'mode 1: a relative change of 1e+00 fixes it']
    """
    matrices = (system.A, system.input_matrix(), system.output_matrix())
    if not all(np.all(np.isfinite(matrix_to_float(each))) for each in matrices):
        return limit
    return LimitReached(f"{limit}; {diagnosed(system, region, weights, controlled)}")


@dataclass(frozen=True)
class ChosenRegions:
    """The regions of a request that names no rate.

    Attributes
    ----------
    slowest : StabilityRegion
        That of the smaller of half the rate of the optimal state feedback and a tenth of the
        sensible rate, with two digits; no radius is below a tenth.
    reason : str
        What it is.
    brisk : StabilityRegion
        That of half the sensible rate, or of the root of the sensible radius; where this is not
        sensible, that of the sensible one.
    brisk_reason : str
    unhurried : CentralOptimum
        Of the optimal controller of all agents together, for which no rate is asked.
    sensible : StabilityRegion or None
        The sensible region, if there is one.
    """

    slowest: StabilityRegion
    reason: str
    brisk: StabilityRegion
    brisk_reason: str
    unhurried: CentralOptimum
    sensible: StabilityRegion | None


def chosen_regions(
    system: MultiChannelSystem, weights: Weights | None = None
) -> ChosenRegions | None:
    """Choose the regions of a request that names no rate.

    Parameters
    ----------
    system : MultiChannelSystem
    weights : Weights, optional

    Returns
    -------
    ChosenRegions or None
        Where no rate is sensible, the rate of the optimal controller of all agents together takes
        its place.  None without such a controller in floating point.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> regions = chosen_regions(plant)
    >>> print(regions.slowest, regions.reason, regions.brisk, sep=", ")
    Re λ < -7/10, half that of the optimal state feedback, Re λ < -49/10
    """
    weights, stable = weights or Weights.unit(system), StabilityRegion(system.time)
    with quiet_floats():
        unhurried = central_optimum(system, weights, stable)
        region = None if unhurried is None else _own_region(system.time, unhurried)
        if unhurried is None or region is None:
            return None
        central = central_optimum(system, weights, region)
        sensible = _sensible(system, weights, region, central, unhurried)
        pace, fed_back = pace_of(sensible or region), _regulated_pace(system, weights)
        part = "the root of" if stable.discrete else "half"
        brisk, brisk_reason = pace / 2, f"{part} the sensible {stable.word}"
        if sensible is None:
            brisk_reason = f"{part} that of the optimal controller of all agents together"
        elif not _affordable(
            central_optimum(system, weights, region_of_pace(system.time, brisk)), unhurried
        ):
            brisk, brisk_reason = pace, f"the sensible {stable.word}"
    word = f"sensible {stable.word}"
    if sensible is None:
        word = f"{stable.word} of the optimal controller of all agents together"
    slowest = pace / 10
    reason = f"{'the tenth root' if stable.discrete else 'a tenth'} of the {word}"
    if fed_back is not None and fed_back / 2 < slowest:
        slowest, reason = fed_back / 2, f"{part} that of the optimal state feedback"
    (slowest, reason), (brisk, brisk_reason) = (
        _not_instant(*each, discrete=stable.discrete)
        for each in ((slowest, reason), (brisk, brisk_reason))
    )
    return ChosenRegions(
        rounded_region(system.time, slowest),
        reason,
        rounded_region(system.time, brisk),
        brisk_reason,
        unhurried,
        sensible,
    )


def _not_instant(pace: float, reason: str, *, discrete: bool) -> tuple[float, str]:
    """The pace, or one whose radius is a tenth where that is slower."""
    if discrete and pace > _FAST_ENOUGH:
        return _FAST_ENOUGH, f"fast enough, and slower than {reason}"
    return pace, reason


def _regulated_pace(system: MultiChannelSystem, weights: Weights) -> float | None:
    """The pace of the optimal state feedback; None if floating point has none."""
    problem = FeedbackProblem.of(decentralized_network(system), (0,) * system.m, weights)
    model = whole_model(problem, weights)
    F = regulator(model, 1.0 if model.discrete else 0.0)
    form = None if F is None else SchurForm.of(model.A + model.B @ F, discrete=model.discrete)
    if form is None:
        return None
    pace = -float(np.log(max(form.bound, 1e-12))) if model.discrete else -form.bound
    return pace if 0 < pace < np.inf else None


def slow_modes(system: MultiChannelSystem, region: StabilityRegion) -> tuple[SlowMode, ...]:
    """Return the computed modes outside a region, the nearest to being fixed first.

    Notes
    -----
    The distance is searched for the modes that agents control or observe least, in terms of their
    eigenvectors: for all of a small plant, and for a few of a large one, of equal modes for one.
    """
    if not system.n:
        return ()  # SciPy 1.11 refuses a matrix without entries
    A = matrix_to_float(system.A)
    B = [matrix_to_float(system.B(i)) for i in range(system.m)]
    C = [matrix_to_float(system.C(i)) for i in range(system.m)]
    solved = eig(A, left=True)
    values, left, right = (np.asarray(each, dtype=np.complex128) for each in solved)
    limit, size = to_float(region.limit), float(np.linalg.norm(A, 2)) or 1.0
    slow = []
    for k, value in enumerate(map(complex, values)):
        if value.imag < 0 or (abs(value) if region.discrete else value.real) < limit:
            continue
        reached = [norm(left[:, k].conj() @ each) for each in B]
        seen = [norm(each @ right[:, k]) for each in C]
        slow.append((max(map(min, reached, seen), default=0.0), value))
    slow.sort(key=lambda each: (each[0], each[1].real, each[1].imag))
    fewest = _FEWEST_MODES if system.n <= _LARGE else 1
    count = max(fewest, _WORK // max(system.n**3 * system.m, 1))
    modes, distinct = list[SlowMode](), list[complex]()
    for _, value in slow[:count]:
        if any(abs(value - other) <= _EQUAL * size for other in distinct):
            continue
        distinct.append(value)
        change, channels = distance_at(A, B, C, value)
        modes.append(SlowMode(value, change / size, system.named(channels)))
    return tuple(sorted(modes, key=lambda each: each.change))


def _sensible(
    system: MultiChannelSystem,
    weights: Weights,
    region: StabilityRegion,
    central: CentralOptimum | None,
    unhurried: CentralOptimum | None,
) -> StabilityRegion | None:
    """Search, from a region, for the fastest one that is affordable, by factors and bisection."""
    if unhurried is None:
        return None
    steps = _STEPS_OF_RATE if system.n <= _LARGE else _STEPS_IF_LARGE
    if system.n > _LARGE and _affordable(central, unhurried):
        return region
    pace, holds, fails = pace_of(region), 0.0, np.inf
    optimum = central
    for _ in range(steps):
        if _affordable(optimum, unhurried):
            holds = pace
        else:
            fails = pace
        if holds >= _FASTEST * pace_of(region) or (holds and fails / holds < _WIDTH):
            break
        if holds and np.isfinite(fails):
            # Wide brackets are halved in the logarithm, too.
            pace = float(np.sqrt(holds * fails))
        else:
            pace = _FACTOR * holds if holds else fails / _FACTOR
        optimum = central_optimum(system, weights, region_of_pace(system.time, pace))
    if not holds and system.n <= _LARGE:
        # Without a rate the optimum can be fragile where that of a moderate rate is not.
        for factor in _FASTER:
            faster = region_of_pace(system.time, factor * pace_of(region))
            if _affordable(central_optimum(system, weights, faster), unhurried):
                return faster
    return region_of_pace(system.time, holds) if holds else None


def rounded_region(time: str, pace: float) -> StabilityRegion:
    """A region, not faster, whose rate or distance of the radius to 1 has two digits.

    Examples
    --------
    >>> print(rounded_region("continuous", 0.259), rounded_region("discrete", 0.001), sep=", ")
    Re λ < -1/4, |λ| < 99901/100000
    """
    discrete = StabilityRegion(time).discrete
    exact = float(-np.expm1(-pace)) if discrete else pace
    edge = Fraction(Context(prec=2, rounding=ROUND_FLOOR).create_decimal_from_float(exact))
    return StabilityRegion(time, 1 - edge if discrete else edge)


def _own_region(time: str, unhurried: CentralOptimum) -> StabilityRegion | None:
    """The region of the slowest eigenvalue of the optimal controller for which no rate is asked."""
    bound = unhurried.figures.bound
    pace = -float(np.log(max(bound, 1e-3))) if StabilityRegion(time).discrete else -bound
    return region_of_pace(time, pace) if 0 < pace < np.inf else None


def pace_of(region: StabilityRegion) -> float:
    """The rate, or −log of the radius, which is 0.02 for the radius 1."""
    if not region.discrete:
        return to_float(region.edge)
    return float(-np.log(to_float(region.edge))) or 0.02


def region_of_pace(time: str, pace: float) -> StabilityRegion:
    """The region of a rate, or of the radius exp(−pace), to three digits."""
    bound = float(np.exp(-pace)) if StabilityRegion(time).discrete else pace
    # Beyond four digits a radius is 1.
    bound = min(bound, 0.9999) if StabilityRegion(time).discrete else bound
    return StabilityRegion.of(
        time, bound=Fraction(f"{bound:.2e}" if bound < 0.9 else f"{bound:.4g}")
    )
