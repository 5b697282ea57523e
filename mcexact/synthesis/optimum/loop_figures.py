"""Figures of the closed loop of a controller from anywhere, and how its programs may be rounded."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from decimal import Context, Decimal
from fractions import Fraction

import numpy as np
import numpy.typing as npt

from mcexact.exact.floats import matrix_to_float, to_float
from mcexact.exact.location import StabilityRegion, is_discrete
from mcexact.exact.matrix import Matrix
from mcexact.floating.margins import is_within
from mcexact.model.controller import Controller, LinearMap
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.synthesis.optimum.figures import (
    Figures,
    damping_and_fastest,
    peak_of_state,
    unstable_figures,
)
from mcexact.synthesis.optimum.kernel import quiet_floats
from mcexact.synthesis.optimum.sensitivity import Complexes, Response, frequencies
from mcexact.synthesis.optimum.spectrum import SchurForm
from mcexact.synthesis.optimum.weights import Floats, Weights

_FREQUENCIES, _NEAR = 200, 60
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
    U = input_rows(loop)
    return Figures(
        order,
        gain,
        form.bound,
        margin_of(loop),
        peak_of_state(M, loop.given.n, form),
        _cost(loop, form, U, weights, integrators),
        *damping_and_fastest(form),
    )


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
    response = input_response(loop)
    largest = response.peak(boundary_points(response, discrete=is_discrete(loop.given.time)))
    return 1 / largest if largest else np.inf


def boundary_points(response: Response, *, discrete: bool) -> Complexes:
    """Return a grid of the boundary of stability, finer near the slowest eigenvalues."""
    values = response.eigenvalues
    distance = 1 - np.abs(values) if discrete else -values.real / np.maximum(np.abs(values), 1e-300)
    near = values[np.argsort(distance)[:_NEAR]]
    all_over = frequencies(values, discrete=discrete, count=_FREQUENCIES, widen=10.0)
    grid = all_over[: _FREQUENCIES + (not discrete)]
    on_it = np.exp(1j * np.abs(np.angle(near))) if discrete else 1j * np.abs(near.imag)
    return np.concatenate([grid, np.unique(on_it)])


def input_rows(loop: ClosedLoop) -> Floats:
    """Return U, the rows of all inputs over the state of the loop."""
    parts = [
        loop.rows(agent.input, i, loop.given.p(i)) for i, agent in enumerate(loop.controller.agents)
    ]
    found = [matrix_to_float(each) for each in parts]
    return np.vstack([np.zeros((0, loop.dimension)), *found])


def _cost(
    loop: ClosedLoop, form: SchurForm, U: Floats, weights: Weights, integrators: Sequence[int]
) -> float:
    """The linear-quadratic cost of a stable loop; infinite where its Gramian overflows."""
    size, n = loop.dimension, loop.given.n
    places = np.array([*range(n), *integrators], dtype=np.intp)
    N, D = _noise(loop)
    if integrators:
        N, D = _with_integrals(loop, N, D, U, places[n:])
    Q, W = np.zeros((size, size)), np.zeros((size, size))
    Q[np.ix_(places, places)] = weights.Q
    W[np.ix_(places, places)] = weights.W
    Q, W = Q + U.T @ weights.R @ U, W + N @ weights.V @ N.T
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
        Where the computed eigenvalues of the rounded loop lie.
    margin : float
        A margin that the rounded loop has, too.

    Returns
    -------
    int or None
        Found by bisection, as if more digits always were better; None if 16 do not suffice.
    """

    def holds(digits: int) -> bool:
        made = closed_loop(loop.given, rounded_controller(loop.controller, digits), loop.graph)
        M = matrix_to_float(made.matrix)
        if not np.all(np.isfinite(M)) or not is_within(M, region):
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
