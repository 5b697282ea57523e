"""Loops whose inputs are cut off at their limits: proofs, and anti-windup gains.

The plant receives sat(v) where the agents compute v = Uz, and each agent adds L (sat(v) − v) to its
states: z' = M₀z + E₀ sat(v), E₀ = E + L, M₀ = M − E₀U.  `saturation_of` proves by the circle
criterion that this loop is stable, globally, or else from an ellipsoid of states on which |v| is at
most 1/a times the limits.  For an unstable plant no loop is stable from all states.

`gains_for` chooses L.  What is cut off, w = v − sat(v), moves the loop by −E₀w, and costs w'E₀'XE₀w
from then on, X the cost-to-go of the loop.  Agent i moves its own states alone: its L_i minimizes
this cost, with the solution −X_ii⁻¹X_iE_i of linear equations.  Where the loop with these gains is
not proved to be stable, a part of them is tried, then those of a Kalman filter by which the agent
estimates its own states from what its inputs really were, and no gains.  The choice is made in
floating point; whatever it is, the proof is exact.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np
import numpy.typing as npt

from mcexact.analysis.lyapunov import is_positive
from mcexact.analysis.performance import (
    BITS,
    PortResponse,
    decimal_below,
    default_weights,
    diagonal_matrix,
    lyapunov_difference,
    rounded_form,
    solved,
)
from mcexact.answer.performance import Symmetric
from mcexact.answer.saturation import Ellipsoid, SaturationProof, SaturationStability
from mcexact.derived.sampling import is_sampled, sampled_within
from mcexact.errors import InputError, LimitReached, UsageError
from mcexact.exact.matrix import (
    Matrix,
    block,
    hstack,
    matrix_from_float,
    matrix_to_float,
    to_float,
    vstack,
)
from mcexact.exact.roots import is_discrete
from mcexact.model.box import Box
from mcexact.model.controller import Controller
from mcexact.model.graph import NeighborGraph
from mcexact.model.limits import InputLimits, Range, read_input_limits
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.radii import moduli
from mcexact.model.sizes import TypicalSizes
from mcexact.model.system import MultiChannelSystem
from mcexact.model.units import inverted, scaled

Floats = npt.NDArray[np.float64]

DIGITS = 3
"""The significant digits of anti-windup gains."""
_PARTS = (1.0, 0.7, 0.4, 0.2, 0.1)
"""The parts of the cheapest gains that are tried."""
_NOISE = (0.01, 0.1, 1.0, 10.0)
"""The noise of the filters that are tried, relative to what drives the states of an agent."""
_SECTORS = tuple(
    map(
        Fraction,
        ("1/50", "1/20", "1/10", "3/20", "1/5", "1/4", "3/10", "2/5", "1/2", "3/5", "7/10", "4/5"),
    )
)
"""The ends a of sectors [a, 1] that are tried for a region."""
_MOST_SECTORS = 2
"""So many of them are tried, from the widest one that seems to be covered on."""
_EXTRA = (0.3, 0.1, 0.03, 1e-3, 1e-5)
"""What is added to the weight of the states in the forms that are tried: with more of it an
ellipsoid is rounder, until there is none."""
_MOST_FORMS = 2
"""So many forms of each sector are rounded and tried exactly, those with the largest balls."""
_MOST_GAINS = 10
"""Of so many gains, those with the widest sectors, the largest balls are compared."""
_ROOM, _ROOMS = 1 + 1e-6, (1.0, 1.002, 1.02)
"""Factors of a form in whose ellipsoid inputs just stay in their sectors, up to rounding."""


def saturation_stability(
    system: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None = None,
    *,
    limits: Mapping[Any, Any] | None = None,
) -> SaturationStability:
    """Prove that a loop is stable where each input is cut off at its limits.

    Parameters
    ----------
    system : MultiChannelSystem
    controller : Controller
        With its anti-windup gains, if it has any; see `with_anti_windup`.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    limits : mapping, optional
        As for `MultiChannelSystem`; by default those of the controller, or else of the system.

    Returns
    -------
    SaturationStability
        Without a region, if that is proved; else with one.

    Raises
    ------
    UsageError
        If no input has limits.
    LimitReached
        If no proof was found.

    Notes
    -----
    The circle criterion, with a constant multiplier for each input: proposed in floating point,
    verified exactly.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> stable = MultiChannelSystem([["1/2"]], [[[1]]], [[[1]]], time="discrete")
    >>> deadbeat = local_controllers(stable, [[["-1/2"]]])
    >>> saturation_stability(stable, deadbeat, limits={"1": [[-1, 1]]}).region is None
    True
    >>> unstable = MultiChannelSystem([["3/2"]], [[[1]]], [[[1]]], time="discrete")
    >>> deadbeat = local_controllers(unstable, [[["-3/2"]]])
    >>> found = saturation_stability(unstable, deadbeat, limits={"1": [[-1, 1]]})
    >>> 1 < found.region.radius < 2  # from 2 on nothing holds it
    True
    """
    loop = _closed(system, controller, graph)
    own = _limits_of(loop, limits)
    found = saturation_of(loop, own, gains_of(loop))
    if found is None:
        raise LimitReached("no proof was found that the loop is stable with its inputs cut off")
    return found


def with_anti_windup(
    system: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None = None,
    *,
    limits: Mapping[Any, Any] | None = None,
) -> Controller:
    """Return a controller that cuts off its inputs at limits, with anti-windup gains.

    Parameters
    ----------
    system, controller, graph, limits
        As for `saturation_stability`.

    Returns
    -------
    Controller
        While an input v is cut off to u, agent i adds L_i (u − v) to its next states, in continuous
        time to their derivatives.  It uses its own u and v alone.

    Raises
    ------
    UsageError
        If no input has limits.

    Examples
    --------
    >>> from mcexact.model.controller import AgentProgram, LinearMap
    >>> plant = MultiChannelSystem([[-1]], [[[1]]], [[[1]]])
    >>> one = Matrix.from_rows([[1]])
    >>> integral = AgentProgram(
    ...     "1", 0, 1, private_update=LinearMap({0: -one}), input=LinearMap({0: -one}, private=one)
    ... )
    >>> saturated = with_anti_windup(
    ...     plant, Controller("continuous", "", (integral,)), limits={"1": [[-1, 1]]}
    ... )
    >>> saturated.agents[0].back_calculation[0, 0] > 0, saturated.agents[0].limits
    (True, ((Fraction(-1, 1), Fraction(1, 1)),))
    """
    loop = _closed(system, controller, graph)
    own = _limits_of(loop, limits)
    gains, _ = gains_for(loop, own)
    return controller.with_saturation(own, gains)


def _closed(
    system: MultiChannelSystem, controller: Controller, graph: NeighborGraph | None
) -> ClosedLoop:
    InputError.require(system, MultiChannelSystem, "system")
    InputError.require(controller, Controller, "controller")
    return closed_loop(system, controller, graph)


def _limits_of(loop: ClosedLoop, chosen: Mapping[Any, Any] | None) -> InputLimits:
    """The limits that are asked for, or else those of the controller, or those of the plant."""
    plant, own = loop.plant, loop.controller.limits_for(loop.plant)
    if chosen is not None:
        own = read_input_limits(chosen, plant.names, [plant.p(i) for i in range(plant.m)])
    if own is None:
        raise UsageError("no input has limits", where="limits")
    return own


def gains_of(loop: ClosedLoop) -> tuple[Matrix, ...]:
    """The anti-windup gains of all agents, zero where an agent has none."""
    return tuple(
        Matrix.zeros(agent.shared + agent.private, loop.plant.p(i))
        if agent.back_calculation is None
        else agent.back_calculation
        for i, agent in enumerate(loop.controller.agents)
    )


# The saturated loop, and proofs about it.


@dataclass(frozen=True)
class Saturated:
    """The loop z' = M₀z + E₀φ with the inputs v = Uz that are cut off to φ.

    Attributes
    ----------
    M, E, U : Matrix
        M₀, E₀ and U, of the inputs with limits.
    nearer : tuple of Fraction
        The modulus of the nearer limit of each.
    discrete : bool
    sizes : tuple of Fraction
        The typical size of each state of the plant.
    inputs : tuple of Fraction
        That of each input with limits.
    missed : Matrix or None
        Of the samples of a plant, the radii of [M₀, E₀] within which the exact samples are.
    """

    M: Matrix
    E: Matrix
    U: Matrix
    nearer: tuple[Fraction, ...]
    discrete: bool
    sizes: tuple[Fraction, ...]
    inputs: tuple[Fraction, ...]
    missed: Matrix | None = None

    @classmethod
    def of(cls, loop: ClosedLoop, limits: InputLimits, gains: Sequence[Matrix]) -> Saturated:
        """The loop with its inputs cut off, and with anti-windup gains."""
        disturbed, pairs = loop.disturbed, [each for own in limits for each in own]
        cut = [k for k, each in enumerate(pairs) if each is not None]
        E = (disturbed.E + entering(loop, gains)).take(cols=cut)
        U = disturbed.U.take(rows=cut)
        nearer = tuple(min(-low, high) for low, high in _known(pairs))
        plant, known = loop.plant, loop.plant.typical_sizes or TypicalSizes()
        widths = known.of_inputs([plant.p(i) for i in range(plant.m)])
        inputs = [x for own in widths for x in own]
        return cls(
            disturbed.M - E @ U,
            E,
            U,
            nearer,
            is_discrete(plant.time),
            tuple(known.of_states(plant.n)),
            tuple(inputs[k] for k in cut),
            _missed(loop, cut),
        )

    def in_sizes(self) -> Saturated:
        """The same loop, its states and inputs divided by their sizes."""
        states = [*self.sizes, *[Fraction(1)] * (self.M.nrows - len(self.sizes))]
        one, inputs = [Fraction(1)] * len(states), self.inputs
        if {*states, *inputs} <= {Fraction(1)}:
            return self
        back = inverted(states)
        return replace(
            self,
            M=scaled(self.M, back, states),
            E=scaled(self.E, back, inputs),
            U=scaled(self.U, inverted(inputs), states),
            nearer=tuple(x / size for x, size in zip(self.nearer, inputs, strict=True)),
            sizes=tuple(one[: len(self.sizes)]),
            inputs=tuple(Fraction(1) for _ in inputs),
            missed=None,
        )

    def response(self, a: Fraction) -> PortResponse:
        """The response from g to v for φ = (1 + a)/2 v + (1 − a)/2 g, and the sector [a, 1]."""
        M = self.M + self.E @ self.U * ((1 + a) / 2)
        return PortResponse((M, self.E * ((1 - a) / 2), self.U), self.discrete, Fraction(0))

    def norm(self, a: Fraction = Fraction(0)) -> float:
        """The gain of this response with a constant scaling; infinite if it is not stable."""
        response = self.response(a)
        if response.unstable:
            return np.inf
        with suppress(np.linalg.LinAlgError):
            return response.scaled_norm(range(response.ports))[0]
        # an eigenvalue on the border, up to rounding
        return np.inf

    def first_sector(self) -> int:
        """The position of the widest of `_SECTORS` that seems to be covered, or their number."""
        return bisect_left(_SECTORS, True, key=lambda a: self.norm(a) < 1)

    def falls(
        self, P: Matrix, scaling: Sequence[Fraction], a: Fraction, *, exact: bool = False
    ) -> bool:
        """Whether zᵀPz is positive and falls for all φ between av and v; ``exact`` of samples."""
        M, E, U = self.M, self.E, self.U
        corner = diagonal_matrix(scaling)
        if self.discrete:
            corner = corner - E.T @ (P @ E)
        right = M.T @ (P @ E) if self.discrete else P @ E
        across = -(right + U.T @ diagonal_matrix([t * (1 + a) / 2 for t in scaling]))
        products = U.T @ (diagonal_matrix([t * a for t in scaling]) @ U)
        top = lyapunov_difference(P, M, self.discrete) + products
        fall = block([[top, across], [across.T, corner]])
        if exact and self.missed is not None:
            R = self.missed
            size = R.T @ moduli(P @ hstack([M, E]))
            size = size + size.T + R.T @ (moduli(P) @ R)
            sums = [Fraction(sum(row), size.denominator) for row in size.numerators]
            fall = fall - diagonal_matrix(sums)
        return is_positive(fall) and is_positive(P)

    def holds_exactly(self, P: Matrix, scaling: Sequence[Fraction], a: Fraction) -> bool | None:
        """True if the form falls at the exact samples, too; None if that is not proved."""
        return True if self.missed is not None and self.falls(P, scaling, a, exact=True) else None


def _missed(loop: ClosedLoop, cut: Sequence[int]) -> Matrix | None:
    """The radii of [M₀, E₀] of exact samples, N × (N + cut); None for a plant without samples."""
    plant = loop.plant
    if not is_sampled(plant):
        return None
    (how,) = plant.subject
    certain = Box.relative(plant.plant, 0).radii
    radii = sampled_within(
        plant.plant, certain, Fraction(how["step"]), how["late"], how["decimals"]
    )
    B, N, n = hstack([*radii.B], nrows=plant.n), loop.dimension, plant.n
    free = [k for k in range(B.ncols) if k not in cut]
    own = hstack([radii.A, Matrix.zeros(n, N - n)])
    own = own + B.take(cols=free) @ moduli(loop.disturbed.U.take(rows=free))
    above = hstack([own, B.take(cols=list(cut))])
    return vstack([above, Matrix.zeros(N - n, above.ncols)])


def _known(pairs: Sequence[Range | None]) -> Iterator[Range]:
    return (each for each in pairs if each is not None)


def entering(loop: ClosedLoop, gains: Sequence[Matrix]) -> Matrix:
    """The anti-windup gains with the rows of the states of the loop, N × Σ p_i."""
    plant = loop.plant
    p = [plant.p(i) for i in range(plant.m)]
    rows = [Matrix.zeros(plant.n, sum(p))]
    for i, L in enumerate(gains):
        before, after = Matrix.zeros(L.nrows, sum(p[:i])), Matrix.zeros(L.nrows, sum(p[i + 1 :]))
        rows.append(block([[before, L, after]]))
    known = sum(M.nrows for M in rows)
    rows.append(Matrix.zeros(loop.dimension - known, sum(p)))
    return vstack(rows, ncols=sum(p))


def saturation_of(
    loop: ClosedLoop, limits: InputLimits, gains: Sequence[Matrix]
) -> SaturationStability | None:
    """Prove that a loop is stable with its inputs cut off, globally or from a region.

    Parameters
    ----------
    loop : ClosedLoop
    limits : InputLimits
    gains : sequence of m Matrix
        The anti-windup gains.
    """
    saturated = Saturated.of(loop, limits, gains)
    found = _circle(saturated)
    if found is not None:
        proof = SaturationProof(found[0], (Fraction(0),) * len(found[0]), P=found[1])
        exact = saturated.holds_exactly(found[1].matrix(), found[0], Fraction(0))
        return SaturationStability(
            loop.system, limits, tuple(gains), region=None, exact=exact, proof=proof
        )
    return _regional(loop, limits, gains, saturated, _ellipsoids(saturated, loop.plant.n))


_Candidate = tuple[float, Fraction, tuple[Fraction, ...], Floats]
"""1/ρ², ρ the radius of the largest ball, a sector, the scaling, and the form of the ellipsoid."""


def _regional(
    loop: ClosedLoop,
    limits: InputLimits,
    gains: Sequence[Matrix],
    saturated: Saturated,
    ellipsoids: Sequence[_Candidate],
) -> SaturationStability | None:
    """The proof from the first of some ellipsoids that is exactly one; None if none is."""
    for _, a, weights, form in ellipsoids:
        region = _region(saturated, loop.plant.n, a, weights, form)
        if region is not None:
            proof = SaturationProof(region[0], (a,) * len(region[0]))
            exact = saturated.holds_exactly(region[1].P.matrix(), region[0], a)
            return SaturationStability(
                loop.system, limits, tuple(gains), region=region[1], exact=exact, proof=proof
            )
    return None


def _ellipsoids(saturated: Saturated, n: int, first: int | None = None) -> list[_Candidate]:
    """Some forms for each sector, those first whose largest balls of the plant are largest.

    They are looked for where states and inputs are divided by their sizes, so that they do not
    depend on units; the forms and their scalings are returned for the units of the file.
    """
    sizes = np.array([to_float(x) for x in saturated.sizes] + [1.0] * (saturated.M.nrows - n))
    inputs = [x**2 for x in saturated.inputs]
    saturated = saturated.in_sizes()
    if first is None:
        first = saturated.first_sector() if all(saturated.nearer) else len(_SECTORS)
    found = list[_Candidate]()
    for a in _SECTORS[first : first + _MOST_SECTORS]:
        response = saturated.response(a)
        ports = list(range(response.ports))
        norm, theta = (np.inf, np.ones(0)) if response.unstable else response.scaled_norm(ports)
        if norm >= 1:
            continue
        weights = tuple(Fraction(float(t)) / ((1 - a) / 2) ** 2 for t in theta)
        file_weights = tuple(t / x for t, x in zip(weights, inputs, strict=True))
        own = list[_Candidate]()
        with suppress(np.linalg.LinAlgError):
            for P in response.forms(ports, theta, Fraction(1), _EXTRA):
                factor, largest = _factor(saturated, P, a), np.linalg.eigvalsh(P[:n, :n])
                size = factor * float(largest[-1]) if n else factor
                if 0 < size < np.inf:
                    own.append((size, a, file_weights, P / np.outer(sizes, sizes)))
        found += sorted(own, key=lambda each: each[0])[:_MOST_FORMS]
    return sorted(found, key=lambda each: each[0])


def _factor(saturated: Saturated, P: Floats, a: Fraction) -> float:
    """The least multiple of a form in whose ellipsoid all inputs stay in the sectors [a, 1]."""
    U = matrix_to_float(saturated.U)
    nearer = np.array([to_float(each) for each in saturated.nearer])
    widths = np.einsum("ki,ik->k", U, np.linalg.solve(P, U.T))
    return float(np.max(to_float(a) ** 2 * widths / nearer**2, initial=0.0)) * _ROOM


def _circle(saturated: Saturated) -> tuple[tuple[Fraction, ...], Symmetric] | None:
    """The scaling and the matrix that prove the circle criterion for the sectors [0, 1]."""
    response, part = saturated.response(Fraction(0)), None
    if response.unstable:
        return None
    with suppress(np.linalg.LinAlgError):
        part = response.proved(range(response.ports), Fraction(1))
    if part is None:
        return None
    scaling = tuple(4 * t for t in part.scaling)
    falls = saturated.falls(part.P.matrix(), scaling, Fraction(0))
    return (scaling, part.P) if falls else None


def _region(
    saturated: Saturated, n: int, a: Fraction, scaling: Sequence[Fraction], P: Floats
) -> tuple[tuple[Fraction, ...], Ellipsoid] | None:
    """The largest multiple of an ellipsoid in which the sectors hold, and the scaling for it."""
    factor = _factor(saturated, P, a)
    if not 0 < factor < np.inf:
        return None
    tried = (_inside(saturated, n, a, scaling, P, factor * room) for room in _ROOMS)
    return next((each for each in tried if each is not None), None)


def _inside(
    saturated: Saturated,
    n: int,
    a: Fraction,
    scaling: Sequence[Fraction],
    P: Floats,
    factor: float,
) -> tuple[tuple[Fraction, ...], Ellipsoid] | None:
    """A multiple of an ellipsoid that is proved with as few bits as suffice."""
    weights = tuple(t * Fraction(factor) for t in scaling)
    sizes = saturated.sizes
    units = np.array([to_float(x) for x in sizes])
    own = np.linalg.eigvalsh(P[:n, :n] * factor * np.outer(units, units))
    told = None if all(x == 1 for x in sizes) else sizes
    radius = decimal_below(Fraction(float(1 / np.sqrt(own[-1]) / _ROOM)) if n else Fraction(1), 3)
    for bits in BITS:
        rounded = rounded_form(P * factor, bits)
        if rounded is None:
            return None
        exact = rounded.matrix()
        # The cheaper conditions first: rounding breaks each of them at too few bits.
        inside = is_positive(
            diagonal_matrix([1 / (radius * x) ** 2 for x in sizes])
            - exact.take(rows=range(n), cols=range(n))
        ) and all(
            is_positive(exact - saturated.U.take(rows=[k]).T @ saturated.U.take(rows=[k]) * scale)
            for k, scale in enumerate((a / each) ** 2 for each in saturated.nearer)
        )
        if inside and saturated.falls(exact, weights, a):
            return weights, Ellipsoid(rounded, radius, sizes=told)
    return None


# The choice of anti-windup gains.


def gains_for(
    loop: ClosedLoop, limits: InputLimits
) -> tuple[tuple[Matrix, ...], SaturationStability | None]:
    """Choose anti-windup gains, and prove the loop with them.

    Parameters
    ----------
    loop : ClosedLoop
        Stable.
    limits : InputLimits

    Returns
    -------
    gains : tuple of m Matrix
        Zero where nothing was proved with any gains.
    proof : SaturationStability or None
        Global if that was proved with some gains, of which the cheapest are chosen; else with the
        largest region.
    """
    regional = list[tuple[int, tuple[Matrix, ...], Saturated]]()
    for gains in _candidates(loop, limits):
        saturated = Saturated.of(loop, limits, gains)
        if saturated.norm() < 1:
            proof = saturation_of(loop, limits, gains)
            if proof is not None and proof.region is None:
                return gains, proof
        if all(saturated.nearer):
            regional.append((saturated.first_sector(), gains, saturated))
    able = sorted((each for each in regional if each[0] < len(_SECTORS)), key=lambda each: each[0])
    forms = [
        (_ellipsoids(saturated, loop.plant.n, first), gains, saturated)
        for first, gains, saturated in able[:_MOST_GAINS]
    ]
    for ellipsoids, gains, saturated in sorted(
        (each for each in forms if each[0]), key=lambda each: each[0][0][0]
    ):
        proof = _regional(loop, limits, gains, saturated, ellipsoids)
        if proof is not None:
            return gains, proof
    return gains_none(loop), None


def gains_none(loop: ClosedLoop) -> tuple[Matrix, ...]:
    """No anti-windup gains."""
    plant, agents = loop.plant, loop.controller.agents
    return tuple(Matrix.zeros(a.shared + a.private, plant.p(i)) for i, a in enumerate(agents))


def _candidates(loop: ClosedLoop, limits: InputLimits) -> Iterator[tuple[Matrix, ...]]:
    """Gains to try, the cheapest first, and none at last."""
    kept = [[pair is not None for pair in own] for own in limits]

    def exact(gains: Sequence[Floats]) -> tuple[Matrix, ...]:
        chosen = zip(gains, kept, strict=True)
        return tuple(_rounded(L * np.array(own, dtype=float)) for L, own in chosen)

    cheapest = _cheapest(loop)
    if cheapest is not None:
        for part in _PARTS:
            yield exact([part * L for L in cheapest])
    for noise in _NOISE:
        estimating = [_estimating(loop, i, noise) for i in range(loop.plant.m)]
        if all(L is not None for L in estimating):
            yield exact([L for L in estimating if L is not None])
    yield gains_none(loop)


def _rounded(L: Floats) -> Matrix:
    """Gains of few digits."""
    short = [[float(f"{x:.{DIGITS - 1}e}") for x in row] for row in L]
    rows = np.array(short, dtype=np.float64).reshape(L.shape)
    return matrix_from_float(rows, "decimal")


def _cheapest(loop: ClosedLoop) -> list[Floats] | None:
    """The gains for which what is cut off costs least from then on: L_i = −X_ii⁻¹ X_i E_i."""
    from scipy.linalg import solve_continuous_lyapunov, solve_discrete_lyapunov

    plant, disturbed = loop.plant, loop.disturbed
    weights, x = default_weights(plant), loop.pick("x")
    Q, R, U = diagonal_matrix(weights.states), diagonal_matrix(weights.inputs), disturbed.U
    m, E = matrix_to_float(disturbed.M), matrix_to_float(disturbed.E)
    spent = matrix_to_float(x.T @ (Q @ x) + U.T @ (R @ U))
    discrete = is_discrete(plant.time)
    solver = solve_discrete_lyapunov if discrete else solve_continuous_lyapunov
    X = solved(lambda: solver(m.T, spent if discrete else -spent)) if len(m) else spent
    if X is None:
        return None
    gains, row, column = list[Floats](), plant.n, 0
    for i, agent in enumerate(loop.controller.agents):
        states = range(row, row + agent.shared + agent.private)
        inputs = range(column, column + plant.p(i))
        own = X[np.ix_(states, states)]
        right = X[states] @ E[:, inputs]
        gains.append(np.asarray(-np.linalg.lstsq(own, right, rcond=1e-10)[0], dtype=np.float64))
        row, column = row + len(states), column + len(inputs)
    return gains if all(np.all(np.isfinite(L)) for L in gains) else None


def _estimating(loop: ClosedLoop, i: int, noise: float) -> Floats | None:
    """The gain of a filter by which agent i estimates its states from its real inputs.

    For z' = Az + By and v = Cz + Dy with y a white signal and noise in what the inputs really were.
    """
    from scipy.linalg import solve_continuous_are, solve_discrete_are

    agent, plant = loop.controller.agents[i], loop.plant
    k, p, q = agent.shared + agent.private, plant.p(i), plant.q(i)
    if not k or not p:
        return np.zeros((k, p))
    A, B = np.zeros((k, k)), np.zeros((k, q))
    C, D = np.zeros((p, k)), np.zeros((p, q))
    split = agent.shared
    for each, left, right in (
        (agent.shared_update, A[:split], B[:split]),
        (agent.private_update, A[split:], B[split:]),
        (agent.input, C, D),
    ):
        used = each.without_zeros()
        if i in used.shared:
            left[:, :split] = matrix_to_float(used.shared[i])
        if used.private is not None:
            left[:, split:] = matrix_to_float(used.private)
        if i in used.outputs:
            right[:] = matrix_to_float(used.outputs[i])
    scale = float(np.trace(D @ D.T + C @ C.T)) / p or 1.0
    Q, S = B @ B.T + 1e-6 * scale * np.eye(k), B @ D.T
    R = D @ D.T + noise * scale * np.eye(p)
    solver = solve_discrete_are if is_discrete(plant.time) else solve_continuous_are
    P = solved(lambda: solver(A.T, C.T, Q, R, s=S))
    if P is None:
        return None
    if is_discrete(plant.time):
        return np.asarray(np.linalg.solve(C @ P @ C.T + R, (A @ P @ C.T + S).T).T)
    return np.asarray(np.linalg.solve(R, (P @ C.T + S).T).T)
