"""Figures of the closed loop of a controller from anywhere, and how its programs may be rounded.

Eigenvalues that coincide, as those of loops by the theorems do, are moved by rounding far more than
other figures: double precision has -0.83 for an eightfold -1.  `figures_of_loop` is quick, and
compares candidates.  `sure_figures` is what is shown: eigenvalues are roots of the exact
characteristic polynomial, the state moves by powers in ball arithmetic, and the margin is confirmed
there, so that all processors show the same.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from decimal import Context, Decimal
from fractions import Fraction

import numpy as np
import numpy.typing as npt
from scipy.linalg import matrix_balance

from mcexact.analysis.stability.closed_loop_spectrum import closed_loop_spectrum
from mcexact.analysis.stability.stability import POLYNOMIAL_LIMIT
from mcexact.exact.balls import response, states_at_doubling_steps
from mcexact.exact.blocks import vstack
from mcexact.exact.floats import matrix_from_float, matrix_to_float, to_float
from mcexact.exact.linear_algebra import characteristic_polynomial, solve_nonsingular
from mcexact.exact.location import StabilityRegion, is_discrete, steady_point
from mcexact.exact.matrix import Matrix
from mcexact.floating.margins import is_within
from mcexact.model.controller import Controller, LinearMap
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.synthesis.optimum.figures import (
    STEPS,
    Figures,
    damping_and_fastest,
    peak_of_state,
    unstable_figures,
)
from mcexact.synthesis.optimum.kernel import quiet_floats
from mcexact.synthesis.optimum.sensitivity import Complexes, Response, frequencies, norm
from mcexact.synthesis.optimum.spectrum import SchurForm
from mcexact.synthesis.optimum.weights import Floats, Weights

_FREQUENCIES, _NEAR = 200, 60
_SAME = 0.005
_MOST_EXACT_RESPONSES = 24
"""The most states of a loop whose response is computed in ball arithmetic at all frequencies."""
MOST_DIGITS = 16


def figures_of_loop(loop: ClosedLoop, weights: Weights, integrators: Sequence[int] = ()) -> Figures:
    """Compute the figures of a closed loop.

    Parameters
    ----------
    loop : ClosedLoop
        With n states of the plant.
    weights : Weights
        Of the plant, with its integrators if there are any.
    integrators : sequence of int
        The positions of the integrators of all outputs in the state of the loop.

    Notes
    -----
    In floating point.  The loop is M, its inputs are u = U x + D ν with the noise ν of all outputs,
    which enters the loop by N: at once, or by the messages under way; with integrators it is
    also the noise of the integrals.  With the Gramian S,
    M S + S M' + W + N V N' = 0 (discrete time: M S M' − S + … = 0)::

        J = tr(S (Q + U'R U)) + tr(R D V D')

    Examples
    --------
    >>> from mcexact.model.local_controllers import local_controllers
    >>> from mcexact.model.system import MultiChannelSystem
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> loop = closed_loop(plant, local_controllers(plant, [[[-3]]]))
    >>> found = figures_of_loop(loop, Weights.unit(plant))
    >>> found.bound, round(found.margin, 3), round(found.cost, 3)
    (-2.0, 0.667, 2.815)
    """
    M, discrete = matrix_to_float(loop.matrix), is_discrete(loop.given.time)
    order, gain = loop.controller.order, to_float(loop.controller.largest_entry())
    form = SchurForm.of(M, discrete=discrete)
    if form is None or not form.bound < (1.0 if discrete else 0.0):
        return unstable_figures(order, gain, form)
    return Figures(
        order,
        gain,
        form.bound,
        margin_of(loop),
        peak_of_state(M, loop.given.n, form),
        _cost(loop, form, weights, integrators),
        *damping_and_fastest(form.eigenvalues, discrete=discrete),
    )


def sure_figures(loop: ClosedLoop, weights: Weights, integrators: Sequence[int] = ()) -> Figures:
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
    The eigenvalues are those of `loop_eigenvalues`.  The peak is computed by `_moved`, the margin
    is confirmed in ball arithmetic at the frequency where it is least.

    Examples
    --------
    >>> from mcexact.model.local_controllers import local_controllers
    >>> from mcexact.model.system import MultiChannelSystem
    >>> plant = MultiChannelSystem([[-1, 9], [0, -1]], [[[0], [1]]], [[[1, 0]]])
    >>> loop = closed_loop(plant, local_controllers(plant, [[[0]]]))
    >>> found = sure_figures(loop, Weights.unit(plant))
    >>> found.bound, found.damping, round(found.peak, 3)
    (-1.0, 1.0, 3.351)
    """
    M, discrete = matrix_to_float(loop.matrix), is_discrete(loop.given.time)
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
                peak_of_state(M, loop.given.n, form),
                peak_of_state(other, loop.given.n, again),
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
    found = closed_loop_spectrum(M, "discrete" if discrete else "continuous")
    values = np.array(
        [complex(to_float(disc.re), to_float(disc.im)) for disc in found.discs], dtype=np.complex128
    )
    return values if np.all(np.isfinite(values)) else None


def bound_of_eigenvalues(M: Matrix, *, discrete: bool) -> float | None:
    """Return the largest real part, or modulus, of `loop_eigenvalues`; None where these are."""
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
    region = StabilityRegion(loop.given.time)
    return region.contains_roots_of(characteristic_polynomial(rounded))


def _agree(found: Sequence[float], limit: float = 0.0) -> bool:
    """Whether two figures differ by less than half a percent."""
    sizes = [each - limit for each in found]
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


def _moved(
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
    n, N = loop.given.n, loop.dimension
    start = Matrix.identity(N).take(cols=range(n))
    moved = _moved(loop.matrix, start, values, n, discrete=is_discrete(loop.given.time))
    if moved is None:
        return np.nan
    return max(1.0, max((norm(E) for E in moved), default=1.0))


def step_peak(loop: ClosedLoop) -> float:
    """Compute the largest output of a loop while one set-point steps from 0 to 1.

    Parameters
    ----------
    loop : ClosedLoop
        Stable, with integrators.

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
    >>> 1 <= step_peak(closed_loop(plant, controller)) < 10
    True
    """
    discrete, N, n = is_discrete(loop.given.time), loop.dimension, loop.given.n
    values = loop_eigenvalues(loop.matrix, discrete=discrete)
    at_rest = Matrix.identity(N) * Fraction(steady_point(loop.given.time))
    rest = solve_nonsingular(at_rest - loop.matrix, loop.reference)
    if values is None or rest is None:
        return np.nan
    moved = _moved(loop.matrix, rest, values, n, discrete=discrete)
    if moved is None:
        return np.nan
    C = matrix_to_float(loop.given.output_matrix())
    reached = C @ matrix_to_float(rest.take(rows=range(n)))
    peaks = (float(np.max(np.abs(reached - C @ E), initial=0.0)) for E in moved)
    return max(peaks, default=0.0)


def _confirmed_margin(loop: ClosedLoop, values: Complexes) -> float:
    """The margin of a stable loop; NaN if ball arithmetic has another one at its frequency."""
    discrete = is_discrete(loop.given.time)
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
    N, n = loop.dimension, loop.given.n
    entering = loop.given.input_matrix()
    B = vstack([entering, Matrix.zeros(N - n, entering.ncols)], ncols=entering.ncols)
    T = response(loop.matrix, B, _inputs(loop), z)
    return np.nan if T is None else norm(T)


def plain_figures(loop: ClosedLoop) -> Figures:
    """Compute the figures of a closed loop for weights of 1, without warnings about its numbers."""
    with quiet_floats():
        return figures_of_loop(loop, Weights.unit(loop.given))


def input_response(loop: ClosedLoop) -> Response:
    """Return the complementary sensitivity at all inputs of the plant together."""
    M, B = matrix_to_float(loop.matrix), matrix_to_float(loop.given.input_matrix())
    entering = np.vstack([B, np.zeros((len(M) - len(B), B.shape[1]))])
    return Response(M, entering, input_rows(loop), discrete=is_discrete(loop.given.time))


def margin_of(loop: ClosedLoop) -> float:
    """Compute the margin of a stable loop at the inputs of the plant."""
    response, discrete = input_response(loop), is_discrete(loop.given.time)
    largest = response.peak(boundary_points(response.eigenvalues, discrete=discrete))
    return 1 / largest if largest else np.inf


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
    """The same, exactly."""
    agents = enumerate(loop.controller.agents)
    return vstack(
        [loop.rows(agent.input, i, loop.given.p(i)) for i, agent in agents], ncols=loop.dimension
    )


def _cost(
    loop: ClosedLoop,
    form: SchurForm,
    weights: Weights,
    integrators: Sequence[int],
    scales: Floats | None = None,
) -> float:
    """The linear-quadratic cost of a stable loop; infinite where its Gramian overflows.

    The form is that of D⁻¹MD, D with scales on the diagonal if there are some.
    """
    U = input_rows(loop)
    size, n = loop.dimension, loop.given.n
    places = np.array([*range(n), *integrators], dtype=np.intp)
    N, D = _noise(loop)
    if integrators:
        N, D = _with_integrals(loop, N, D, U, places[n:])
    Q, W = np.zeros((size, size)), np.zeros((size, size))
    Q[np.ix_(places, places)] = weights.Q
    W[np.ix_(places, places)] = weights.W
    Q, W = Q + U.T @ weights.R @ U, W + N @ weights.V @ N.T
    if scales is not None:
        Q, W = Q * np.outer(scales, scales), W / np.outer(scales, scales)
    gramians = form.gramians(W, Q, 1.0 if form.discrete else 0.0)
    if gramians is None:
        return np.inf
    cost = float(np.sum(gramians[0] * Q)) + float(np.sum(weights.R * (D @ weights.V @ D.T)))
    return cost if cost > 0 and np.isfinite(cost) else np.inf


def _with_integrals(
    loop: ClosedLoop, N: Floats, D: Floats, U: Floats, places: npt.NDArray[np.intp]
) -> tuple[Floats, Floats]:
    """The same for the noise of all integrals and outputs; the integrators have no noise of these.

    It is in the order of the channels, of each the integrals first.
    """
    measured = matrix_to_float(loop.matrix)[:, places]
    N, measured = N.copy(), measured.copy()
    N[places] = measured[places] = 0.0
    columns, start = list[tuple[Floats, Floats]](), 0
    for i in range(loop.given.m):
        own = slice(start, start + loop.given.q(i))
        columns += [(measured[:, own], U[:, places[own]]), (N[:, own], D[:, own])]
        start = own.stop
    return np.hstack([each for each, _ in columns]), np.hstack([each for _, each in columns])


def _noise(loop: ClosedLoop) -> tuple[Floats, Floats]:
    """Return N and D: how noise of all outputs enters the state of the loop, and the inputs."""
    given, agents = loop.given, loop.controller.agents
    starts = np.concatenate([[0], np.cumsum([given.q(j) for j in range(given.m)])]).astype(int)

    def at_once(each: LinearMap, i: int, nrows: int) -> Floats:
        found = np.zeros((nrows, int(starts[-1])))
        for j, M in each.without_zeros().outputs.items():
            if not loop.waits(j, i)[1]:
                found[:, starts[j] : starts[j + 1]] += matrix_to_float(M)
        return found

    N, inputs = np.zeros((loop.dimension, int(starts[-1]))), []
    for i, agent in enumerate(agents):
        inputs.append(at_once(agent.input, i, given.p(i)))
        N[: given.n] += matrix_to_float(given.B(i)) @ inputs[-1]
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


def integrators_of(loop: ClosedLoop) -> tuple[int, ...]:
    """Return where a controller integrates all outputs less set-points; () if it does not.

    These are the first q_i private states of each agent, as in the controllers of
    `design_setpoint`.

    Parameters
    ----------
    loop : ClosedLoop
    """
    found: list[int] = []
    for i, agent in enumerate(loop.controller.agents):
        q, update = loop.given.q(i), agent.private_update
        own, less = update.outputs.get(i), update.reference
        if q and (own is None or less is None or agent.private < q):
            return ()
        if own is not None and less is not None:
            rows = range(q)
            one = Matrix.identity(q)
            if own.take(rows=rows) != one or less.take(rows=rows) != -one:
                return ()
        place, _ = loop.blocks["z_", i, 0]
        found += range(place, place + q)
    return tuple(found)


def digits_that_suffice(
    loop: ClosedLoop, region: StabilityRegion, margin: float = 0.0
) -> int | None:
    """Return a number of significant decimal digits to which all programs may be rounded.

    Parameters
    ----------
    loop : ClosedLoop
    region : StabilityRegion
        Where the eigenvalues of the rounded loop lie; computed ones beyond 40 states.
    margin : float
        A margin that the rounded loop has, too.

    Returns
    -------
    int or None
        Found by bisection, as if more digits always were better; None if 16 do not suffice.
    """

    def holds(digits: int) -> bool:
        made = closed_loop(loop.given, rounded_controller(loop.controller, digits), loop.graph)
        if not _is_inside(made.matrix, region):
            return False
        return margin <= 0 or margin_of(made) >= margin

    fails, found = 0, MOST_DIGITS
    if not holds(found):
        return None
    while found - fails > 1:
        middle = (found + fails) // 2
        if holds(middle):
            found = middle
        else:
            fails = middle
    return found


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
    >>> from mcexact.model.local_controllers import local_controllers
    >>> from mcexact.model.system import MultiChannelSystem
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> made = rounded_controller(local_controllers(plant, [[["-10/3"]]]), 3)
    >>> made.agents[0].input.outputs[0].rows()
    ((Fraction(-333, 100),),)
    """
    context = Context(prec=digits)

    def entry(x: Fraction) -> Fraction:
        return Fraction(context.divide(Decimal(x.numerator), Decimal(x.denominator)))

    def matrix(M: Matrix) -> Matrix:
        return Matrix.from_rows([[entry(x) for x in row] for row in M.rows()], ncols=M.ncols)

    return _each_matrix(controller, matrix)


def _each_matrix(controller: Controller, change: Callable[[Matrix], Matrix]) -> Controller:
    """Apply a function to all matrices of all programs."""

    def of(each: LinearMap) -> LinearMap:
        return LinearMap(
            {j: change(M) for j, M in each.outputs.items()},
            {j: change(M) for j, M in each.shared.items()},
            None if each.private is None else change(each.private),
            None if each.reference is None else change(each.reference),
        )

    agents = tuple(
        replace(
            agent,
            shared_update=of(agent.shared_update),
            private_update=of(agent.private_update),
            input=of(agent.input),
        )
        for agent in controller.agents
    )
    return replace(controller, agents=agents)
