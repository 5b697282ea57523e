"""Gain matrices from which a search starts.

No construction is best for all plants, so a search tries several:

- `local_regulators` and `local_observers`: each agent takes a part of the plant for the whole, and
  uses the linear-quadratic regulator, or the whole Gaussian controller, of this part.  The coupling
  of the parts is ignored.
- `cut_gains` and `cut_observers`: the optimal controller of all agents together, without the
  products of what an agent does not receive.  The coupling counts, and what is cut is ignored.
- `drawn_dynamics`: stable random dynamics for orders for which there is no construction.

`tied` makes agents with similar surroundings use the same program, which reduces thousands of
entries to some ten in long networks.  The Riccati equations are solved for the plant that is
shifted by a rate or scaled by a radius.  No start has to lie in the region, or to be stable, and
none is proved to be anything.
"""

from __future__ import annotations

import warnings
from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import (
    LinAlgError,
    solve_continuous_are,
    solve_continuous_lyapunov,
    solve_discrete_are,
    solve_discrete_lyapunov,
)

from mcexact.synthesis.optimum.problem import (
    AgentPlaces,
    FeedbackProblem,
    Floats,
    Places,
    Ties,
    Weights,
)

# Linear-quadratic Gaussian controllers of one channel, for a rate or a radius.


@dataclass(frozen=True, eq=False)
class Model:
    """A system with one channel, ẋ = A x + B u, y = C x, and the weights of its cost.

    Attributes
    ----------
    A, B, C : ndarray, n × n, n × p and q × n
    Q, R, W, V : ndarray
        As in `Weights`.
    discrete : bool
    bandwidth : float or None
        As in `Weights`; the Riccati equations of starts have white noise.
    """

    A: Floats
    B: Floats
    C: Floats
    Q: Floats
    R: Floats
    W: Floats
    V: Floats
    discrete: bool
    bandwidth: float | None = None

    @property
    def dual(self) -> Model:
        """The model whose regulator is the transposed estimator."""
        return Model(self.A.T, self.C.T, self.B.T, self.W, self.V, self.Q, self.R, self.discrete)


def riccati(model: Model, shift: float) -> Floats | None:
    """Solve the Riccati equation of the regulator of a shifted model.

    Parameters
    ----------
    model : Model
    shift : float
        a in continuous time, for A + aI; ρ in discrete time, for A/ρ and B/ρ.

    Returns
    -------
    ndarray, n × n, or None
        None without a stabilizing solution in floating point.
    """
    A, B = model.A, model.B
    with warnings.catch_warnings():
        # What follows from the solution is certified exactly or dropped.
        warnings.simplefilter("ignore")
        try:
            if model.discrete:
                X = solve_discrete_are(A / shift, B / shift, model.Q, model.R)
            else:
                X = solve_continuous_are(A + shift * np.eye(len(A)), B, model.Q, model.R)
        except (LinAlgError, ValueError):
            return None
    solution = np.asarray(X, dtype=np.float64)
    return solution if np.all(np.isfinite(solution)) else None


def regulator(model: Model, shift: float) -> Floats | None:
    """Compute F for which u = F x is optimal for the shifted model; None without a solution.

    Examples
    --------
    >>> one = np.eye(1)
    >>> model = Model(one, one, one, one, one, one, one, False)
    >>> regulator(model, 0.0).round(3).tolist()
    [[-2.414]]
    """
    if not model.B.size:
        return np.zeros(model.B.T.shape)
    X = riccati(model, shift)
    if X is None:
        return None
    if not model.discrete:
        solved = _solved(model.R, model.B.T @ X)
    else:
        B = model.B / shift
        solved = _solved(model.R + B.T @ X @ B, B.T @ X @ (model.A / shift))
    return None if solved is None else -solved


def _solved(M: Floats, right: Floats) -> Floats | None:
    """Solve a linear system; None if that is impossible in floating point."""
    try:
        solution = np.asarray(np.linalg.solve(M, right), dtype=np.float64)
    except np.linalg.LinAlgError:
        return None
    return solution if np.all(np.isfinite(solution)) else None


def regulated_covariance(model: Model, F: Floats) -> Floats | None:
    """Compute the covariance S of the states under u = F x; None if that is impossible.

    Notes
    -----
    M S + S M' + W = 0 (discrete time: M S M' − S + W = 0) with M = A + B F.
    """
    closed = model.A + model.B @ F
    if not closed.size:
        return closed  # SciPy 1.11 refuses a matrix without entries
    try:
        if model.discrete:
            S = solve_discrete_lyapunov(closed, model.W)
        else:
            S = solve_continuous_lyapunov(closed, -model.W)
    except (LinAlgError, ValueError):
        return None
    covariance = np.asarray(S, dtype=np.float64)
    return covariance if np.all(np.isfinite(covariance)) else None


def output_gain(F: Floats, S: Floats, C: Floats) -> Floats | None:
    """Compute F S C'(C S C')⁺, the gain of y = C x that is nearest to F x in the mean."""
    try:
        gain = np.asarray(F @ S @ C.T @ np.linalg.pinv(C @ S @ C.T), dtype=np.float64)
    except np.linalg.LinAlgError:
        return None
    return gain if np.all(np.isfinite(gain)) else None


def estimator(model: Model, shift: float) -> Floats | None:
    """The gain of the filter: of its derivative, or in discrete time of the newest output."""
    dual = model.dual
    if not dual.discrete:
        F = regulator(dual, shift)
        return None if F is None else -F.T
    if not model.C.size:
        return np.zeros(model.C.T.shape)
    Y, C = riccati(Model(dual.A, dual.B * shift, *_rest(dual)), shift), model.C
    if Y is None:
        return None
    solved = _solved(model.V + C @ Y @ C.T, C @ Y)
    return None if solved is None else solved.T


def _rest(model: Model) -> tuple[Floats, Floats, Floats, Floats, Floats, bool]:
    return model.C, model.Q, model.R, model.W, model.V, model.discrete


def gaussian_controller(model: Model, shift: float) -> tuple[Floats, Floats, Floats, Floats] | None:
    """Compute the controller ż = A_k z + B_k y, u = C_k z + D_k y that is optimal when shifted.

    Parameters
    ----------
    model : Model
    shift : float
        As in `riccati`.

    Returns
    -------
    A_k, B_k, C_k, D_k : ndarray, or None
        Of order n; in discrete time the controller uses the current measurement, and D_k ≠ 0.

    Notes
    -----
    With gains F and L, in continuous time A_k = A + BF − LC, B_k = L, C_k = F.  In discrete time
    the state is the prediction z of x, and x̂ = z + L(y − Cz) gives u = F x̂ and z⁺ = (A + BF) x̂.
    """
    F, L = regulator(model, shift), estimator(model, shift)
    if F is None or L is None:
        return None
    driven = model.A + model.B @ F
    if not model.discrete:
        return driven - L @ model.C, L, F, np.zeros((len(F), len(model.C)))
    newest = np.eye(len(driven)) - L @ model.C
    return driven @ newest, driven @ L, F @ newest, F @ L


# Starts from the agents' own parts of the plant, and drawn dynamics.

Realization = tuple[Floats, Floats, Floats, Floats]
"""A controller ż = A z + B y, u = C z + D y."""

_NEGLIGIBLE = 1e-9
_SLOWER = 8.0
_MUCH = 0.02


@dataclass(frozen=True, eq=False)
class Locality:
    """The part of the plant that one agent takes for the whole.

    Attributes
    ----------
    states : tuple of int
    model : Model
        The states with the agent's own input and output.
    """

    states: tuple[int, ...]
    model: Model


def localities(
    problem: FeedbackProblem, weights: Weights, *, driven: bool = False, much: bool = False
) -> list[Locality]:
    """Return the part of the plant of each agent.

    These are the states that its outputs read and its inputs drive; a state of no agent is added to
    the agent with whose states it is coupled most.

    Parameters
    ----------
    problem : FeedbackProblem
    weights : Weights
    driven : bool
        Take the states that its inputs drive alone; then an output may read states of others, too.
    much : bool
        Take the states on which its inputs have more than a fiftieth of their largest effect: where
        inputs are held between samples, every state near by is driven a little.

    Examples
    --------
    >>> from mcexact.model.system import MultiChannelSystem
    >>> from mcexact.synthesis.networks import decentralized_network
    >>> plant = MultiChannelSystem(
    ...     [[0, 1, 0], [0, 0, 1], [0, 0, 0]], [[[1], [0], [0]], [[0], [0], [1]]],
    ...     [[[1, 0, 0]], [[0, 0, 1]]])
    >>> problem = FeedbackProblem.of(decentralized_network(plant), [0, 0], Weights.unit(plant))
    >>> [each.states for each in localities(problem, Weights.unit(plant))]
    [(0, 1), (2,)]
    """
    n, plant = problem.n, problem.network.plant
    A, B, C = problem.A[:n, :n], problem.B[:n], problem.C[:, :n]
    sets = []
    for agent in problem.agents:
        effects = np.max(np.abs(B[:, agent.inputs]), axis=1, initial=0.0)
        touched = effects > (_MUCH * np.max(effects, initial=0.0) if much else 0.0)
        if not driven:
            touched = touched | np.any(C[agent.own] != 0, axis=0)
        sets.append(set(map(int, np.flatnonzero(touched))))
    _adopt(np.abs(A) + np.abs(A).T, sets)
    parts, start = [], 0
    for i, (agent, states) in enumerate(zip(problem.agents, sets, strict=True)):
        s = np.array(sorted(states), dtype=np.intp)
        square, inputs = np.ix_(s, s), agent.inputs
        outputs = np.arange(start, start + plant.q(i))
        start += plant.q(i)
        model = Model(
            A[square],
            B[np.ix_(s, inputs)],
            C[np.ix_(agent.own, s)],
            weights.Q[square],
            weights.R[np.ix_(inputs, inputs)],
            weights.W[square],
            weights.V[np.ix_(outputs, outputs)],
            problem.discrete,
            weights.bandwidth,
        )
        parts.append(Locality(tuple(sorted(states)), model))
    return parts


def _adopt(coupling: Floats, sets: list[set[int]]) -> None:
    """Add every state of no agent to the set with which it is coupled most."""
    negligible = _NEGLIGIBLE * float(np.max(coupling, initial=0.0))
    missing = set(range(len(coupling))).difference(*sets)
    grown = True
    while missing and grown:
        grown = False
        for state in sorted(missing):
            strengths = [float(np.sum(coupling[state, sorted(each)])) for each in sets]
            if max(strengths, default=0.0) > negligible:
                sets[int(np.argmax(strengths))].add(state)
                missing.discard(state)
                grown = True


def local_regulators(problem: FeedbackProblem, parts: Sequence[Locality], shift: float) -> Floats:
    """Compute static gains of each agent's own output from the regulators of its own states.

    Parameters
    ----------
    problem : FeedbackProblem
    parts : sequence of Locality
    shift : float
        As in `riccati`.

    Returns
    -------
    ndarray, P × L
        K with u_i = F S C'(C S C')⁺ y_i, S the covariance of the states that F leads to: F itself
        where the outputs determine the states, else what is nearest to it in the mean.
    """
    K = np.zeros(problem.mask.shape)
    for agent, part in zip(problem.agents, parts, strict=True):
        model = part.model
        if not (model.B.any() and model.C.any()):
            continue
        F = regulator(model, shift)
        S = None if F is None else regulated_covariance(model, F)
        gain = None if F is None or S is None else output_gain(F, S, model.C)
        if gain is not None:
            K[np.ix_(agent.inputs, agent.own)] = gain
    return K


def local_observers(parts: Sequence[Locality], shift: float) -> list[Realization | None]:
    """Compute the optimal controller (A, B, C, D) of each agent's own part; None where it fails."""
    return [
        gaussian_controller(part.model, shift)
        if part.model.B.any() and part.model.C.any()
        else None
        for part in parts
    ]


def with_private_parts(
    problem: FeedbackProblem,
    parts: Sequence[Realization | None],
) -> Floats:
    """Return K in which agents use their controllers of their own outputs, and nothing else."""
    K = np.zeros(problem.mask.shape)
    for agent, part in zip(problem.agents, parts, strict=True):
        if part is None:
            continue
        A, B, C, D = part
        K[np.ix_(agent.private_rows, agent.private_columns)] = A
        K[np.ix_(agent.private_rows, agent.own)] = B
        K[np.ix_(agent.inputs, agent.private_columns)] = C
        K[np.ix_(agent.inputs, agent.own)] = D
    return K


def drawn_dynamics(
    problem: FeedbackProblem,
    seed: int,
    static: tuple[FeedbackProblem, Floats] | None = None,
) -> Floats:
    """Draw K with stable dynamics of the agents' states, weakly coupled with their signals.

    Parameters
    ----------
    problem : FeedbackProblem
    seed : int
    static : pair of FeedbackProblem and ndarray, optional
        A gain matrix of a problem with the same agents, whose gains from outputs of the plant to
        its inputs are taken.

    Notes
    -----
    The numbers are drawn by numpy's PCG64, which gives the same ones everywhere.  Higher seeds give
    slower dynamics.
    """
    rng = np.random.Generator(np.random.PCG64(seed))
    K = 0.1 * rng.standard_normal(problem.mask.shape) * problem.scale
    own, slower = rng.random(len(problem.columns_of_states)), _SLOWER ** (seed // 2)
    for row, columns in enumerate(problem.columns_of_states, start=problem.p):
        part = own[row - problem.p]
        K[row, columns] = 0.3 * part if problem.discrete else -(1 + 0.5 * part) / slower
        K[row, columns] *= problem.scale[row, columns]
    for agent in problem.agents:
        for (what, _), columns in agent.signals.items():
            if what == "y":
                K[np.ix_(agent.inputs, columns)] = 0.0
    if static is not None:
        source, gains = static
        for agent, other in zip(problem.agents, source.agents, strict=True):
            for signal, columns in agent.signals.items():
                if signal[0] == "y" and signal in other.signals:
                    taken = gains[np.ix_(other.inputs, other.signals[signal])]
                    K[np.ix_(agent.inputs, columns)] = taken
    return K * problem.mask


# Starts from the optimal controller of all agents together, cut to what each one knows.


def whole_model(problem: FeedbackProblem, weights: Weights) -> Model:
    """Return the plant with all inputs and all outputs, in the order of the channels.

    Parameters
    ----------
    problem : FeedbackProblem
    weights : Weights
    """
    n = problem.n
    C = [problem.C[agent.own][:, :n] for agent in problem.agents]
    return Model(
        problem.A[:n, :n],
        problem.B[:n, : problem.p],
        np.vstack([np.zeros((0, n)), *C]),
        weights.Q,
        weights.R,
        weights.W,
        weights.V,
        problem.discrete,
        weights.bandwidth,
    )


def cut_gains(problem: FeedbackProblem, model: Model, shift: float) -> Floats | None:
    """Compute static gains of what each agent receives from the regulator of the whole plant.

    Parameters
    ----------
    problem : FeedbackProblem
    model : Model
        See `whole_model`.
    shift : float
        As in `riccati`.

    Returns
    -------
    ndarray, P × L, or None
        K with u_i = F_i S C̄_i'(C̄_i S C̄_i')⁺ ȳ_i, F the regulator, S the covariance of the states
        that it leads to, and ȳ_i the outputs that agent i receives; None without a regulator.
    """
    F = regulator(model, shift)
    S = None if F is None else regulated_covariance(model, F)
    if F is None or S is None:
        return None
    K = np.zeros(problem.mask.shape)
    for agent in problem.agents:
        outputs = _outputs(agent)
        gain = output_gain(F[agent.inputs], S, problem.C[outputs][:, : problem.n])
        if gain is None:
            return None
        K[np.ix_(agent.inputs, outputs)] = gain
    return K


def _outputs(agent: AgentPlaces) -> Places:
    """The columns of the outputs of the plant that an agent receives."""
    own = [columns for (what, _), columns in agent.signals.items() if what == "y"]
    return np.concatenate([np.zeros(0, dtype=np.intp), *own])


def held_states(parts: Sequence[Locality]) -> list[tuple[int, ...]]:
    """Give each state of some parts of the plant to the first agent that has it."""
    taken: set[int] = set()
    held = []
    for part in parts:
        own = tuple(each for each in part.states if each not in taken)
        taken.update(own)
        held.append(own)
    return held


def cut_observers(
    problem: FeedbackProblem, held: Sequence[tuple[int, ...]], model: Model, shift: float
) -> Floats | None:
    """Compute K in which the agents estimate all states together, each some of them.

    Parameters
    ----------
    problem : FeedbackProblem
        Each agent has as many states as it estimates, or more; these have drawn dynamics.
    held : sequence of m tuple of int
        The states of the plant that each agent estimates, no state twice.
    model : Model
        See `whole_model`.
    shift : float
        As in `riccati`.

    Returns
    -------
    ndarray, P × L, or None
        With gains F and L of the optimal controller, in continuous time
        ẋ̂ = (A + BF) x̂ + L(y − C x̂) and u = F x̂, without the products of what an agent does not
        receive.  In discrete time x̂ is the prediction, and x̂ + L(y − C x̂) takes its place in
        u and in the next one.  None without such gains.
    """
    F, L = regulator(model, shift), estimator(model, shift)
    if F is None or L is None:
        return None
    K, updates = drawn_dynamics(problem, 0), _updates(problem)
    measured = [int(column) for agent in problem.agents for column in agent.own]
    number = {column: k for k, column in enumerate(measured)}
    for i, agent in enumerate(problem.agents):
        known = _known(problem, held, i)
        states, places = _places(known), _places(known.values())
        heard = _places(c for c in map(int, _outputs(agent)) if c in number)
        seen = _places(number[int(c)] for c in heard)
        rows, own = updates[i][: len(held[i])], _places(held[i])
        K[rows] = 0.0
        K[agent.inputs] = 0.0
        C, driven = model.C[np.ix_(seen, states)], (model.A + model.B @ F)[np.ix_(own, states)]
        used = F[np.ix_(agent.inputs, states)]
        if model.discrete:
            correction = L[np.ix_(states, seen)]
            newest = np.eye(len(states)) - correction @ C
            K[np.ix_(rows, places)] = driven @ newest
            K[np.ix_(rows, heard)] = driven @ correction
            K[np.ix_(agent.inputs, places)] = used @ newest
            K[np.ix_(agent.inputs, heard)] = used @ correction
        else:
            K[np.ix_(rows, places)] = driven - L[np.ix_(own, seen)] @ C
            K[np.ix_(rows, heard)] = L[np.ix_(own, seen)]
            K[np.ix_(agent.inputs, places)] = used
    return K * problem.mask


def _places(numbers: Iterable[int]) -> Places:
    return np.array([*numbers], dtype=np.intp)


def _updates(problem: FeedbackProblem) -> list[Places]:
    """The rows of the updates of each agent's states, those that it sends first."""
    return [np.concatenate([each.updates, each.private_rows]) for each in problem.agents]


def _known(problem: FeedbackProblem, held: Sequence[tuple[int, ...]], i: int) -> dict[int, int]:
    """The columns of the estimates that agent i knows: its own, and those that it receives."""
    agent, known = problem.agents[i], dict[int, int]()
    for (what, j), columns in agent.signals.items():
        if what == "x" and j != i:
            known |= dict(zip(held[j], map(int, columns), strict=False))
    own = agent.signals.get(("x", i), np.zeros(0, dtype=np.intp))
    places = np.concatenate([own, agent.private_columns])
    return known | dict(zip(held[i], map(int, places), strict=False))


# Equal programs for similar agents, which leave few entries to search.

_SMALL = 0.01
"""Entries below this part of the largest one do not make agents different."""


def tied(problem: FeedbackProblem, weights: Weights) -> FeedbackProblem:
    """Let agents that look alike use the same program.

    Parameters
    ----------
    problem : FeedbackProblem
    weights : Weights
        Of the plant.

    Returns
    -------
    FeedbackProblem
        The problem itself if no two agents look alike.

    Notes
    -----
    Agents look alike if their matrices have the same shapes, if they receive the same signals from
    agents that stand equally far from them in the order of the channels, around its end, and if the
    parts of the plant that they drive have entries at the same places, small ones aside.  A program
    for all vehicles of a platoon but the first and the last has some ten entries where the programs
    of all have thousands, and its search takes as many fewer steps.

    Examples
    --------
    >>> from mcexact.model.system import MultiChannelSystem
    >>> from mcexact.synthesis.networks import decentralized_network
    >>> plant = MultiChannelSystem(
    ...     [[1, 0], [0, 2]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]])
    >>> weights = Weights.unit(plant)
    >>> problem = FeedbackProblem.of(decentralized_network(plant), [0, 0], weights)
    >>> alike = tied(problem, weights)
    >>> alike.size, alike.gain(np.array([-3.0])).tolist()
    (1, [[-3.0, 0.0], [0.0, -3.0]])
    """
    alike = _alike(problem, localities(problem, weights, driven=True))
    if len(alike) == len(problem.agents):
        return problem
    number = np.full(problem.mask.shape, -1)
    chosen = np.zeros(problem.mask.shape, dtype=np.bool_)
    start = 0
    for group in alike:
        typical = group[len(group) // 2]
        for i in group:
            agent = problem.agents[i]
            where = np.ix_(agent.rows, _columns(agent, i, len(problem.agents)))
            shape = number[where].shape
            number[where] = start + np.arange(np.prod(shape, dtype=int)).reshape(shape)
            chosen[where] = i == typical
        start = int(np.max(number, initial=-1)) + 1
    return problem.with_ties(Ties(number[problem.mask], chosen[problem.mask]))


def _alike(problem: FeedbackProblem, parts: list[Locality]) -> list[list[int]]:
    """Group the agents that look alike."""
    groups: dict[Hashable, list[int]] = {}
    m = len(problem.agents)
    for i, (agent, part) in enumerate(zip(problem.agents, parts, strict=True)):
        signals = tuple(
            (*_stands(signal, i, m), len(agent.signals[signal])) for signal in agent.signals
        )
        sizes = len(agent.inputs), len(agent.updates), len(agent.private_rows)
        model = part.model
        entries = tuple(map(_pattern, (model.A, model.B, model.C)))
        groups.setdefault((sizes, frozenset(signals), entries), []).append(i)
    return [*groups.values()]


def _stands(signal: tuple[str, int], i: int, m: int) -> tuple[str, int]:
    """The kind of a signal, and how far its sender is from an agent in the order of channels."""
    what, j = signal
    return what, (j - i) % m


def _columns(agent: AgentPlaces, i: int, m: int) -> Places:
    """The columns of everything that an agent uses, in an order that agents alike share."""
    signals = sorted(agent.signals, key=lambda each: _stands(each, i, m))
    return np.concatenate([*(agent.signals[each] for each in signals), agent.private_columns])


def _pattern(M: Floats) -> tuple[tuple[int, ...], bytes]:
    """The shape of a matrix, and where its entries are not small."""
    return M.shape, (np.abs(M) > _SMALL * np.max(np.abs(M), initial=0.0)).tobytes()
