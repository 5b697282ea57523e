"""Costs of loops, bounds for every controller, and margins, proposed in floating point.

Each proof is a symmetric matrix that makes a matrix inequality strict.  Riccati and Lyapunov
equations with slightly worse weights have such solutions, with room for rounding: they are rounded
to as few bits as the exact test allows, since certificates of large loops consist of these numbers.

- `cost_of`: a Lyapunov equation of the loop with its noise.
- `bound_of`: the two Riccati equations of linear-quadratic control and of the filter.  Without room
  for rounding the bound would be the cost of the best controller.
- `margin_of`, `sectors_of`: Riccati equations of the bounded real lemma, solved by Newton's method.
  The scaling of several ports comes from the worst frequency, by Osborne's iteration.

These take a loop, and return None where floating point proposes nothing that holds.  `in_units`
has functions for users, which take a plant and a controller.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from itertools import chain, product
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from mcexact.analysis.lyapunov import is_positive
from mcexact.answer.performance import (
    CostBound,
    CostGraph,
    CostGroup,
    CostWeights,
    DiskMargin,
    LoopCost,
    MarginPart,
    SectorStability,
    Symmetric,
)
from mcexact.errors import InputError, UsageError
from mcexact.exact.matrix import (
    Matrix,
    block,
    dyadic_matrix,
    matrix_to_float,
    to_float,
)
from mcexact.exact.roots import is_discrete
from mcexact.model.loop import ClosedLoop
from mcexact.model.sizes import TypicalSizes
from mcexact.model.system import MultiChannelSystem
from mcexact.model.units import Units, inverted, system_in

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]
BITS = (12, 16, 20, 26, 34, 46, 60)
"""The bits to which a matrix is rounded, fewest first."""
_ROOM = (1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2)
"""The parts by which weights are made worse, to leave room for rounding."""
_HUGE = 1e100
"""The largest entry of a matrix that is rounded: others come from equations without solution."""
_LOST = 3e-4
"""More bits are tried while rounding loses more than this part of a bound."""


def rounded_form(P: Floats, bits: int) -> Symmetric | None:
    """Round a positive definite matrix to entries s_ij 2^(e_i + e_j) of so many bits."""
    if not np.all(np.isfinite(P)) or np.any(np.diag(P) <= 0) or np.max(P, initial=0) > _HUGE:
        return None
    e = [(math.frexp(x)[1] - bits) // 2 for x in np.diag(P)]
    n = len(P)
    entries = tuple(
        round(math.ldexp(float(P[i, j]), -e[i] - e[j])) for i in range(n) for j in range(i + 1)
    )
    return Symmetric(tuple(e), entries)


def lyapunov_difference(P: Matrix, M: Matrix, discrete: bool) -> Matrix:
    """−(PM + MᵀP), in discrete time P − MᵀPM."""
    half = P @ M
    return P - M.T @ half if discrete else -(half + half.T)


def diagonal_matrix(entries: Sequence[Fraction]) -> Matrix:
    """The diagonal matrix of rationals."""
    n = len(entries)
    cells = [(i, i, entry) for i, entry in enumerate(entries) if entry]
    return Matrix.from_entries((n, n), cells)


def trace(S: Matrix) -> Fraction:
    """The sum of the diagonal."""
    return sum((S[i, i] for i in range(S.nrows)), Fraction(0))


def solved(solve: Callable[[], Any]) -> Floats | None:
    """What a solver of scipy returns, made symmetric; None if it fails."""
    with warnings.catch_warnings():
        # An ill-conditioned equation may still give a matrix that passes the exact test.
        warnings.simplefilter("ignore")
        try:
            P = np.asarray(solve(), dtype=np.float64)
        except (np.linalg.LinAlgError, ValueError):
            return None
    return (P + P.T) / 2 if np.all(np.isfinite(P)) else None


def _decimal_above(x: Fraction, digits: int = 6) -> Fraction:
    """The least decimal of so many significant digits that is at least x > 0."""
    if x <= 0:
        return x
    power = digits - 1 - math.floor(math.log10(to_float(x)))
    return Fraction(math.ceil(x * Fraction(10) ** power)) / Fraction(10) ** power


def decimal_below(x: Fraction, digits: int = 6) -> Fraction:
    """The largest decimal of so many significant digits that is at most x > 0."""
    if x <= 0:
        return x
    power = digits - 1 - math.floor(math.log10(to_float(x)))
    return Fraction(math.floor(x * Fraction(10) ** power)) / Fraction(10) ** power


Side = Literal["inputs", "outputs"]


def default_weights(system: MultiChannelSystem) -> CostWeights:
    """Return the weights that follow from the typical sizes of a plant.

    Without sizes all states, inputs and disturbances are weighed by 1, and the noise of outputs by
    1/100, in the units of the file.

    Parameters
    ----------
    system : MultiChannelSystem
        Its ``typical_sizes`` x, u, r and errors e give Q = 1/x², R = 1/u², W = r x² and V = e².

    Returns
    -------
    CostWeights
        In continuous time with a bandwidth near ten times the largest modulus of an eigenvalue of
        the best regulator and of the best filter, rounded to a power of 10.

    Examples
    --------
    >>> default_weights(MultiChannelSystem([[1]], [[[1]]], [[[1]]])).bandwidth
    Fraction(100, 1)
    """
    InputError.require(system, MultiChannelSystem, "system")
    if (units := Units.of(system)) is not None:
        return weights_in(units.inverse(), default_weights(system_in(units, system)))
    n, sizes = system.n, system.typical_sizes or TypicalSizes()
    p, q = ([size(i) for i in range(system.m)] for size in (system.p, system.q))
    x, u, e = sizes.of_states(n), chain(*sizes.of_inputs(p)), chain(*sizes.of_errors(q))
    white = CostWeights(
        tuple(1 / size**2 for size in x),
        tuple(1 / size**2 for size in u),
        tuple(sizes.disturbances * size**2 for size in x),
        tuple(error**2 for error in e),
        bandwidth=None,
    )
    if is_discrete(system.time):
        return white
    plant = system.A, system.input_matrix(), system.output_matrix()
    solutions = _riccati(*plant, white, system.time, 0.0)
    largest = 1.0
    if solutions is not None and n:
        _, S, F = solutions
        a, b, c = _with_ports(plant)
        regulator = a + b[:, : len(F)] @ F
        # without outputs c has a row of zeros
        noise = [to_float(v) for v in white.noise] or [1.0]
        filtered = a - S @ c.T / noise @ c
        for M in (regulator, filtered):
            largest = max(largest, float(np.max(np.abs(np.linalg.eigvals(M)))))
    return replace(white, bandwidth=Fraction(10) ** round(math.log10(10 * largest)))


def weights_in(units: Units, weights: CostWeights) -> CostWeights:
    """The weights of the same cost, for signals that are measured in other units."""
    x, u, y = units.states, units.of_inputs, units.of_outputs

    def times(diagonal: Sequence[Fraction], by: Sequence[Fraction]) -> tuple[Fraction, ...]:
        return tuple(a * unit**2 for a, unit in zip(diagonal, by, strict=True))

    return CostWeights(
        times(weights.states, x),
        times(weights.inputs, u),
        times(weights.disturbances, inverted(x)),
        times(weights.noise, inverted(y)),
        bandwidth=weights.bandwidth,
    )


# The cost of a loop.


def cost_of(loop: ClosedLoop, weights: CostWeights) -> LoopCost | None:
    """Bound the stationary mean of xᵀQx + uᵀRu of a stable loop from above.

    Parameters
    ----------
    loop : ClosedLoop
    weights : CostWeights
        For the states and ports of the system that the loop was closed around.

    Returns
    -------
    LoopCost or None
        The bound is some 0.01 % above the cost.

    Raises
    ------
    UsageError
        If the cost is infinite, since white noise passes to an input at once.

    Notes
    -----
    P solves a Lyapunov equation with slightly larger weights.  O(N³) floating-point operations, and
    O(N³) products of short integers.
    """
    from scipy.linalg import solve_continuous_lyapunov, solve_discrete_lyapunov

    discrete = is_discrete(loop.plant.time)
    M, entering, spent = _spent(loop, weights)
    n, N, m = loop.plant.n, M.nrows, matrix_to_float(M)

    def equation(right: Floats) -> Floats | None:
        if not N:
            return right
        solver = solve_discrete_lyapunov if discrete else solve_continuous_lyapunov
        return solved(lambda: solver(m.T, right if discrete else -right))

    at_once = matrix_to_float(spent)
    P0 = equation(at_once)
    if P0 is None or np.any(np.diag(P0) < 0) or np.max(P0, initial=0) > _HUGE:
        return None
    W, V = (diagonal_matrix(d) for d in (weights.disturbances, weights.noise))
    noise = matrix_to_float(entering @ V @ entering.T)
    noise[:n, :n] += matrix_to_float(W)
    for more in _additions(m, P0, noise, equation, discrete=discrete):
        for room, bits in product(_ROOM, BITS[2:]):
            form = rounded_form(P0 + room * more, bits)
            if form is None:
                continue
            if bits <= _SURE_BITS and not _seems_strict(form, m, at_once, discrete=discrete):
                continue
            cost = cost_by(loop, weights, form)
            if cost is not None:
                return LoopCost(loop.system, weights, _decimal_above(cost), form)
    return None


_SURE_BITS = 34
"""Beyond so many bits floating point does not say whether a rounded inequality is strict."""


def _seems_strict(form: Symmetric, m: Floats, spent: Floats, *, discrete: bool) -> bool:
    """Whether rounding seems to leave the inequality of a cost strict, which proves nothing."""
    P = _in_floats(form)
    half = P @ m
    return _seems_positive((P - m.T @ half if discrete else -(half + half.T)) - spent)


def _seems_positive(S: Floats) -> bool:
    """Whether a symmetric matrix seems to be positive definite, with a diagonal of ones."""
    d = np.diag(S)
    if not np.all(d > 0):
        return False
    scale = 1 / np.sqrt(d)
    return not len(d) or bool(np.linalg.eigvalsh(S * scale[:, None] * scale)[0] > 0)


def _in_floats(form: Symmetric) -> Floats:
    """A rounded matrix in floating point."""
    n = len(form.exponents)
    P = np.zeros((n, n))
    P[np.tril_indices(n)] = form.entries
    scale = np.exp2(np.array(form.exponents, dtype=np.float64))
    whole: Floats = (P + np.tril(P, -1).T) * scale[:, None] * scale
    return whole


def _additions(
    m: Floats,
    P0: Floats,
    noise: Floats,
    equation: Callable[[Floats], Floats | None],
    *,
    discrete: bool,
) -> Iterator[Floats]:
    """Matrices that cost about as much as P0, a part of which makes its inequality strict.

    The first one is that of weights in proportion to P0.  Where one mode is far slower than the
    others, it takes nearly all of this; the second gives each mode the same part of the cost.
    """
    largest = float(np.max(np.diag(P0), initial=0.0)) or 1.0
    P1 = equation(np.diag(np.maximum(np.diag(P0), 1e-12 * largest)))
    if P1 is None or np.any(np.diag(P1) <= 0) or np.max(P1, initial=0) > _HUGE:
        return
    yield P1 * ((float(np.trace(P0)) or 1.0) / (float(np.trace(P1)) or 1.0))
    modal = _modal_weight(m, noise, float(np.trace(P0 @ noise)), discrete=discrete)
    P1 = None if modal is None else equation(modal)
    if P1 is not None:
        yield P1


_LEAST_SHARE = 1e-8
"""The least excitation of a mode that counts, as a part of the largest."""


def _modal_weight(m: Floats, noise: Floats, cost: float, *, discrete: bool) -> Floats | None:
    """The weight of states for which every mode has the same part of a cost; None if unknown.

    With the left eigenvectors w of m it is the sum of c(−2 Re λ)w̄wᵀ, in discrete time of
    c(1 − |λ|²)w̄wᵀ, which the Lyapunov equation takes to the sum of c w̄wᵀ.
    """
    if not len(m):
        return None
    modes, right = np.linalg.eig(m)
    try:
        left = np.linalg.inv(right)
    except np.linalg.LinAlgError:
        return None
    excited = np.real(np.einsum("ki,ij,kj->k", left, noise, left.conj()))
    if not np.all(np.isfinite(excited)) or not np.max(excited) > 0:
        return None
    excited = np.maximum(excited, _LEAST_SHARE * np.max(excited))
    decay = 1 - np.abs(modes) ** 2 if discrete else -2 * modes.real
    weight = np.real((left.conj().T * (decay * cost / len(m) / excited)) @ left)
    return np.asarray((weight + weight.T) / 2, dtype=np.float64)


def cost_by(loop: ClosedLoop, weights: CostWeights, form: Symmetric) -> Fraction | None:
    """The bound on the cost that a matrix proves; None if its inequality is not strict."""
    P, discrete, n = form.matrix(), is_discrete(loop.plant.time), loop.plant.n
    M, entering, spent = _spent(loop, weights)
    # The second one hardly ever fails alone.
    if not is_positive(lyapunov_difference(P, M, discrete) - spent) or not is_positive(P):
        return None
    _, R, W, V = (diagonal_matrix(d) for d in _diagonals(weights))
    K = loop.disturbed.K
    cost = trace(P.take(rows=range(n), cols=range(n)) @ W)
    cost += trace(entering.T @ (P @ entering) @ V)
    return cost + (trace(K.T @ (R @ K) @ V) if discrete else 0)


def _spent(loop: ClosedLoop, weights: CostWeights) -> tuple[Matrix, Matrix, Matrix]:
    """The loop with its noise, where the noise enters, and what its states cost at once."""
    M, U, entering = _with_noise(loop, weights)
    x = Matrix.identity(M.nrows).take(rows=range(loop.plant.n))
    Q, R = diagonal_matrix(weights.states), diagonal_matrix(weights.inputs)
    return M, entering, x.T @ (Q @ x) + U.T @ (R @ U)


def computed_cost(loop: ClosedLoop, weights: CostWeights) -> float:
    """The cost of a loop in floating point; infinite where it is not stable, NaN if unknown.

    Raises
    ------
    UsageError
        If the cost is infinite, since white noise passes to an input at once.
    """
    from scipy.linalg import solve_continuous_lyapunov, solve_discrete_lyapunov

    discrete = is_discrete(loop.plant.time)
    M, U, entering = map(matrix_to_float, _with_noise(loop, weights))
    n, N = loop.plant.n, len(M)
    Q, R, W, V = (np.diag([to_float(x) for x in d]) for d in _diagonals(weights))
    noise = entering @ V @ entering.T
    noise[:n, :n] += W
    solver = solve_discrete_lyapunov if discrete else solve_continuous_lyapunov
    X = solved(lambda: solver(M, noise if discrete else -noise)) if N else noise
    if X is None:
        return float("nan")
    K = matrix_to_float(loop.disturbed.K)
    at_once = float(np.trace(K.T @ R @ K @ V)) if discrete else 0.0
    cost = float(np.trace(Q @ X[:n, :n]) + np.trace(R @ U @ X @ U.T)) + at_once
    return cost if np.all(np.diag(X) >= 0) else math.inf


def computed_bound(plant: MultiChannelSystem, weights: CostWeights) -> float:
    """The cost of the best controller in floating point; NaN if it is not known."""
    matrices = plant.A, plant.input_matrix(), plant.output_matrix()
    solutions = _riccati(*matrices, weights, plant.time, 0.0)
    if solutions is None:
        return float("nan")
    P, S, F = solutions
    _, b, _ = _with_ports(matrices)
    R, W = _diagonal_floats(weights.inputs), _diagonal_floats(weights.disturbances)
    if not len(P):
        return 0.0
    b = b[:, : len(F)]
    spent = R[: len(F), : len(F)] + (b.T @ P @ b if is_discrete(plant.time) else 0)
    return float(np.trace(P @ W) + np.trace(F.T @ spent @ F @ S))


def _with_noise(loop: ClosedLoop, weights: CostWeights) -> tuple[Matrix, Matrix, Matrix]:
    """The loop with its filtered noise, [M, G; 0, −ωI], its inputs, and where the noise enters."""
    plant, disturbed = loop.plant, loop.disturbed
    M, G, U, K = disturbed.M, disturbed.G, disturbed.U, disturbed.K
    if is_discrete(plant.time):
        return M, U, G
    if weights.bandwidth is None:
        if not K.is_zero():
            raise UsageError(
                "white noise that an agent passes to its input at once has infinite power: give "
                "the bandwidth of the noise",
                where="weights",
            )
        return M, U, G
    q, omega = G.ncols, weights.bandwidth
    filters = Matrix.identity(q) * omega
    whole = block([[M, G], [Matrix.zeros(q, M.ncols), -filters]])
    entering = block([[Matrix.zeros(M.nrows, q)], [filters]])
    return whole, block([[U, K]]), entering


def _diagonals(weights: CostWeights) -> tuple[tuple[Fraction, ...], ...]:
    return weights.states, weights.inputs, weights.disturbances, weights.noise


# A bound for every controller.


def bound_of(
    plant: MultiChannelSystem, weights: CostWeights, graph: CostGraph | None = None
) -> CostBound | None:
    """Bound the stationary mean of xᵀQx + uᵀRu from below for every linear controller.

    Parameters
    ----------
    plant : MultiChannelSystem
    weights : CostWeights
    graph : CostGraph, optional
        Only controllers are meant by which agents act on each other along its edges alone; see
        `influences`.

    Returns
    -------
    CostBound or None
        Without a graph the bound is some 0.1 % below the cost of the best controller that knows
        everything.

    Notes
    -----
    P and S solve the Riccati equations of the regulator and of the filter with weights that are
    slightly smaller; F is the gain of the regulator, rounded.  With a graph the disturbances are
    divided among the sets of agents that an agent reaches, by multiplicative updates along the
    gradient of the sum of the bounds.
    """
    everyone = tuple(range(plant.m))
    owners = [0] * plant.n if graph is None else [plant.index(name) for name in graph.states]
    groups = [everyone] if graph is None else _closed_groups(plant, graph)
    parts = [Group(plant, owners, group) for group in groups]
    proofs = [
        (part, W, V, bound)
        for part, W, V in _divided(parts, weights, plant.time)
        if (bound := part.bound(weights, W, V, plant.time)) is not None
    ]
    if len(proofs) < len(parts):
        return None
    total = sum((bound[-1] for *_, bound in proofs), Fraction(0))
    proved = tuple(
        CostGroup(plant.named(part.agents), W, V, *bound[:-1]) for part, W, V, bound in proofs
    )
    return CostBound(plant, weights, decimal_below(total, 8), groups=proved, graph=graph)


def influences(plant: MultiChannelSystem, *, messages: bool = True) -> CostGraph | None:
    """The agents on whom each agent acts through the plant or by messages.

    Parameters
    ----------
    plant : MultiChannelSystem
    messages : bool
        Whether neighbors, if the plant has a neighbor graph, send each other messages; without them
        every agent uses its own outputs alone.

    Returns
    -------
    CostGraph or None
        None where everybody acts on everybody, so that a bound by groups gains nothing.

    Notes
    -----
    States that act on each other, or through an agent, are of one owner; states between agents
    belong to one that acts on them, or else to one on which they act.
    """
    import networkx as nx

    InputError.require(plant, MultiChannelSystem, "plant")
    acts: nx.DiGraph = nx.DiGraph()
    acts.add_nodes_from([("state", k) for k in range(plant.n)])
    acts.add_nodes_from([("agent", i) for i in range(plant.m)])
    acts.add_edges_from((("state", c), ("state", r)) for r, c, _ in plant.A.nonzero())
    for i in range(plant.m):
        acts.add_edges_from((("agent", i), ("state", r)) for r, _, _ in plant.B(i).nonzero())
        acts.add_edges_from((("state", c), ("agent", i)) for _, c, _ in plant.C(i).nonzero())
    if messages and plant.neighbors is not None:
        acts.add_edges_from((("agent", j), ("agent", i)) for j, i in plant.neighbors.edges())
    whole = nx.condensation(acts)
    agents = {c: [i for kind, i in whole.nodes[c]["members"] if kind == "agent"] for c in whole}
    if any(len(members) == plant.m for members in agents.values()) or not plant.n:
        return None
    owner: dict[int, int] = {}
    for c in nx.topological_sort(whole):
        before = [owner[b] for b in whole.predecessors(c) if b in owner]
        if agents[c]:
            owner[c] = min(agents[c])
        elif before:
            owner[c] = min(before)
    for c in reversed(list(nx.topological_sort(whole))):
        if c not in owner:
            after = [owner[a] for a in whole.successors(c) if a in owner]
            owner[c] = min(after, default=0)
    place = whole.graph["mapping"]
    owned = [owner[place["state", k]] for k in range(plant.n)]
    of = {node: node[1] if node[0] == "agent" else owned[node[1]] for node in acts}
    pairs = sorted({(of[a], of[b]) for a, b in acts.edges if of[a] != of[b]})
    names = plant.names
    return CostGraph(tuple(names[i] for i in owned), tuple((names[j], names[i]) for j, i in pairs))


def _closed_groups(plant: MultiChannelSystem, graph: CostGraph) -> list[tuple[int, ...]]:
    """Everybody, and for each agent those whom it reaches."""
    after: dict[int, set[int]] = {i: {i} for i in range(plant.m)}
    for source, target in graph.edges:
        after[plant.index(source)].add(plant.index(target))
    groups = [tuple(range(plant.m))]
    for i in range(plant.m):
        reached, new = set[int](), {i}
        while new:
            reached |= new
            new = set[int]().union(*(after[member] for member in new)) - reached
        groups.append(tuple(sorted(reached)))
    return list(dict.fromkeys(groups))


class Group:
    """The plant as a group of agents has it, and bounds of its cost."""

    def __init__(
        self, plant: MultiChannelSystem, owners: Sequence[int], agents: tuple[int, ...]
    ) -> None:
        whole, members = len(agents) == plant.m, set(agents)
        inputs, outputs = (
            [i for i in range(plant.m) for _ in range(size(i))] for size in (plant.p, plant.q)
        )
        self.agents, self.whole = agents, whole
        self.states = [k for k, owner in enumerate(owners) if whole or owner in members]
        self.inputs = [k for k, owner in enumerate(inputs) if owner in members]
        self.outputs = [k for k, owner in enumerate(outputs) if owner in members]
        self.exact = (
            plant.A.take(rows=self.states, cols=self.states),
            plant.input_matrix().take(rows=self.states, cols=self.inputs),
            plant.output_matrix().take(rows=self.outputs, cols=self.states),
        )

    def weights(
        self, weights: CostWeights, W: tuple[Fraction, ...], V: tuple[Fraction, ...]
    ) -> CostWeights:
        """The weights of the group with its part of the disturbances."""
        Q = tuple(weights.states[k] for k in self.states)
        R = tuple(weights.inputs[k] for k in self.inputs)
        return CostWeights(Q, R, W, V, bandwidth=weights.bandwidth)

    def bound(
        self, weights: CostWeights, W: tuple[Fraction, ...], V: tuple[Fraction, ...], time: str
    ) -> Found | None:
        """P, S, F, the share and the bound."""
        return _group(*self.exact, self.weights(weights, W, V), time)

    def slopes(
        self, weights: CostWeights, W: Floats, V: Floats, discrete: bool
    ) -> tuple[Floats, Floats] | None:
        """How the cost of the best controller of the group grows with each intensity."""
        if not self.states:
            return np.zeros(0), np.zeros(len(V))
        from scipy.linalg import (
            solve_continuous_are,
            solve_continuous_lyapunov,
            solve_discrete_are,
            solve_discrete_lyapunov,
        )

        a, b, c = _with_ports(self.exact)
        Q = _diagonal_floats([weights.states[k] for k in self.states])
        R = _diagonal_floats([weights.inputs[k] for k in self.inputs])
        outputs, V = len(V), V if len(V) else np.ones(1)
        if discrete:
            P = solved(lambda: solve_discrete_are(a, b, Q, R))
            S = solved(lambda: solve_discrete_are(a.T, c.T, np.diag(W), np.diag(V)))
            if P is None or S is None:
                return None
            spent = R + b.T @ P @ b
            F = np.linalg.solve(spent, b.T @ P @ a)
            L = S @ c.T @ np.linalg.inv(c @ S @ c.T + np.diag(V))
            kept = np.eye(len(a)) - L @ c
            Y = solved(lambda: solve_discrete_lyapunov((kept @ a).T, F.T @ spent @ F))
            if Y is None:
                return None
            return np.diag(P + kept.T @ Y @ kept), np.diag(L.T @ Y @ L)[:outputs]
        P = solved(lambda: solve_continuous_are(a, b, Q, R))
        S = solved(lambda: solve_continuous_are(a.T, c.T, np.diag(W), np.diag(V)))
        if P is None or S is None:
            return None
        F = np.linalg.solve(R, b.T @ P)
        L = S @ c.T / V
        Y = solved(lambda: solve_continuous_lyapunov((a - L @ c).T, -F.T @ R @ F))
        return None if Y is None else (np.diag(P + Y), np.diag(L.T @ Y @ L)[:outputs])


_ROUNDS = 40
"""The rounds in which disturbances are divided among groups."""
_LEAST = 2e-3
"""The part of a disturbance that every group which may take some takes at least."""
_UNIT = 2**20
_TINY = 1e-200

Divided = list[tuple[Group, tuple[Fraction, ...], tuple[Fraction, ...]]]


def _divided(parts: list[Group], weights: CostWeights, time: str) -> Divided:
    """The intensities W and V divided among groups, so that the sum of the bounds is large."""
    if len(parts) == 1:
        return [(parts[0], weights.disturbances, weights.noise)]
    takers = [
        [[g for g, part in enumerate(places) if k in part] for k in range(len(intensities))]
        for intensities, places in (
            (weights.disturbances, [set(part.states) for part in parts]),
            (weights.noise, [set(part.outputs) for part in parts]),
        )
    ]
    shares = [np.zeros((len(parts), len(each))) for each in takers]
    for share, able in zip(shares, takers, strict=True):
        for k, members in enumerate(able):
            for g in members:
                share[g, k] = 1 / len(parts[g].agents) ** 2
            share[:, k] /= share[:, k].sum()
    whole = [np.array([to_float(x) for x in d]) for d in (weights.disturbances, weights.noise)]
    for turn in range(_ROUNDS):
        slopes = [np.zeros_like(share) for share in shares]
        for g, part in enumerate(parts):
            where = part.states, part.outputs
            W, V = (s[g, w] * d[w] for s, w, d in zip(shares, where, whole, strict=True))
            found = part.slopes(weights, W, V, is_discrete(time))
            if found is None:
                break
            for slope, w, values in zip(slopes, where, found, strict=True):
                slope[g, w] = values
        for share, slope, able in zip(shares, slopes, takers, strict=True):
            for k, groups in enumerate(able):
                largest = float(slope[groups, k].max())
                if not _TINY < largest < _HUGE:
                    continue
                steep = slope[groups, k] / largest
                moved = share[groups, k] * np.exp(6 * (steep - 1) / (1 + turn / 10))
                moved = np.maximum(moved / moved.sum(), _LEAST / len(groups))
                share[groups, k] = moved / moved.sum()
    divided: Divided = []
    for g, part in enumerate(parts):
        W, V = (
            tuple(Fraction(int(share[g, k] * _UNIT), _UNIT) * d[k] for k in where)
            for share, where, d in zip(
                shares,
                (part.states, part.outputs),
                (weights.disturbances, weights.noise),
                strict=True,
            )
        )
        divided.append((part, W, V))
    return divided


Found = tuple[Symmetric, Symmetric, Matrix, Fraction, Fraction]


def _group(A: Matrix, B: Matrix, C: Matrix, weights: CostWeights, time: str) -> Found | None:
    """P, S, F, the share and the bound for a part of the plant."""
    best: Found | None = None
    for room in _ROOM:
        solutions = _riccati(A, B, C, weights, time, room)
        if solutions is None:
            continue
        for bits in BITS[2:]:
            found = _rounded_bound((A, B, C), weights, time, solutions, bits, room)
            if found is None:
                continue
            if best is None or found[-1] > best[-1] * (1 + Fraction(_LOST)):
                best = found
            else:
                break
        if best is not None:
            return best
    return best


def _with_ports(plant: tuple[Matrix, Matrix, Matrix]) -> tuple[Floats, Floats, Floats]:
    """A, B and C in floats, with an input and an output that do nothing where there is none."""
    a, b, c = map(matrix_to_float, plant)
    return a, b if b.shape[1] else np.zeros((len(a), 1)), c if len(c) else np.zeros((1, len(a)))


def _diagonal_floats(entries: Sequence[Fraction]) -> Floats:
    """The diagonal matrix in floats; 1 where it is empty."""
    return np.diag([to_float(x) for x in entries] or [1.0])


def _riccati(
    A: Matrix, B: Matrix, C: Matrix, weights: CostWeights, time: str, room: float
) -> tuple[Floats, Floats, Floats] | None:
    """P, S and F for weights that are smaller by a part."""
    n, p = B.shape
    if not n:
        return np.zeros((0, 0)), np.zeros((0, 0)), np.zeros((p, 0))
    less = 1 - room
    Q, R, W, V = (_diagonal_floats(d) * less for d in _diagonals(weights))
    bandwidth = None if weights.bandwidth is None else to_float(weights.bandwidth)
    discrete = is_discrete(time)
    solutions = riccati_solutions(
        _with_ports((A, B, C)), (Q, R, W, V), discrete=discrete, bandwidth=bandwidth
    )
    if solutions is None:
        return None
    P, S, F = solutions
    return P, S * (1 - room / 10) if discrete else S, F[:p]


def riccati_solutions(
    plant: tuple[Floats, Floats, Floats],
    weights: tuple[Floats, Floats, Floats, Floats],
    *,
    discrete: bool,
    bandwidth: float | None = None,
) -> tuple[Floats, Floats, Floats] | None:
    """Solve the Riccati equations of the best controller, in floating point.

    Parameters
    ----------
    plant : tuple of ndarray
        A, B and C, with at least one column of B and one row of C.
    weights : tuple of ndarray
        Q, R, W and V, which need not be diagonal.
    discrete : bool
    bandwidth : float, optional
        ω in continuous time; without it the noise of outputs is white.

    Returns
    -------
    P, S, F : ndarray, or None
        The cost of the states, the covariance of the error of the best estimate, and the gain of
        u = F x; with these the bound of `bound_of` is the cost of the best controller.
    """
    from scipy.linalg import solve_continuous_are, solve_discrete_are

    (a, b, c), (Q, R, W, V) = plant, weights
    if discrete:
        P = solved(lambda: solve_discrete_are(a, b, Q, R))
        ahead = solved(lambda: solve_discrete_are(a.T, c.T, W, V))
        if P is None or ahead is None:
            return None
        F = np.asarray(-np.linalg.solve(R + b.T @ P @ b, b.T @ P @ a), dtype=np.float64)
        S: Floats = ahead - ahead @ c.T @ np.linalg.solve(c @ ahead @ c.T + V, c @ ahead)
        return P, (S + S.T) / 2, F
    P = solved(lambda: solve_continuous_are(a, b, Q, R))
    slow = 0.0 if bandwidth is None else 1 / bandwidth
    H = c @ (a * slow + np.eye(len(a)))
    N = c @ W @ c.T * slow**2 + V
    S_ = solved(lambda: solve_continuous_are(a.T, H.T, W, N, s=W @ c.T * slow))
    if P is None or S_ is None:
        return None
    return P, S_, np.asarray(-np.linalg.solve(R, b.T @ P), dtype=np.float64)


def _rounded_bound(
    plant: tuple[Matrix, Matrix, Matrix],
    weights: CostWeights,
    time: str,
    solutions: tuple[Floats, Floats, Floats],
    bits: int,
    room: float,
) -> Found | None:
    """The bound of matrices that are rounded; None unless both inequalities are strict."""
    forms = [rounded_form(each, bits) for each in solutions[:2]]
    if forms[0] is None or forms[1] is None:
        return None
    F = dyadic_matrix(solutions[2], bits)
    share = Fraction(1) - Fraction(round(room * 2**20), 2**19)
    bound = bound_by(plant, weights, time, (forms[0], forms[1], F, share))
    return None if bound is None else (forms[0], forms[1], F, share, decimal_below(bound, 8))


def bound_by(
    plant: tuple[Matrix, Matrix, Matrix],
    weights: CostWeights,
    time: str,
    proof: tuple[Symmetric, Symmetric, Matrix, Fraction],
) -> Fraction | None:
    """The bound that P, S, F and s prove; None unless both inequalities are strict."""
    P, S = proof[0].matrix(), proof[1].matrix()
    first, second, bound = inequalities(plant, weights, time, (P, S, *proof[2:]))
    # The last two hardly ever fail alone.
    strict = all(is_positive(each) for each in (first, second, P, S))
    return bound if strict else None


def inequalities(
    plant: tuple[Matrix, Matrix, Matrix],
    weights: CostWeights,
    time: str,
    solution: tuple[Matrix, Matrix, Matrix, Fraction],
) -> tuple[Matrix, Matrix, Fraction]:
    """N₁ and N₂ of ``FORMAT.md`` (`cost_bound`), and the bound that holds if both are positive."""
    (A, B, C), (P, S, F, share) = plant, solution
    Q, R, W, V = (diagonal_matrix(d) for d in _diagonals(weights))
    p = B.ncols
    if is_discrete(time):
        spent, after = R + B.T @ (P @ B), A @ S @ A.T + W
        half = A.T @ P
        first = block([[half @ A + Q - P, half @ B], [(half @ B).T, spent]])
        second = block([[after - S, after @ C.T], [C @ after, C @ after @ C.T + V]])
        R_s = spent * share
    else:
        half, drift, SC = P @ A, A @ S, S @ C.T
        slow = Fraction(0) if weights.bandwidth is None else 1 / weights.bandwidth
        across = SC - A @ SC * slow
        first = block([[half + half.T + Q, P @ B], [(P @ B).T, R]])
        second = block([[drift + drift.T + W, across], [across.T, V - C @ SC * (2 * slow)]])
        R_s = R * share
    gain = block([[F, -Matrix.identity(p)]])
    first = first - gain.T @ (R_s @ gain)
    return first, second, trace(P @ W) + trace(F.T @ (R_s @ F) @ S)


# Disk margins and sectors.

_SLACK = (1.002, 1.01, 1.03, 1.1, 1.3)
"""By how much the proved gain may exceed the largest one that was seen at a frequency."""
_EXTRA = (1e-3, 1e-5, 1e-7)
"""What is added to the weight of the states, as a part, so that the inequality is strict."""
_SCALINGS = 2.0**6
"""The largest factor by which a scaling departs from 1."""
_SWEEPS, _BALANCED = 40, 1 + 1e-6
"""The most sweeps that balance a matrix, and the largest change in the last of them."""
_NO_GAIN = 1e-15
"""The part of an entry of the diagonal, both squared, below which the rest of its row or column
counts as 0: to balance what rounding errors leave there, scalings would grow without end."""
_FEW_POLES = 80
"""The poles around which gains are looked at densely; around more of them other poles are near."""
_CONDITION, _AT_ONCE = 1e8, 16
"""The largest condition number of eigenvectors that are used, and the norms computed at once."""


def margin_of(
    loop: ClosedLoop,
    at: Literal["inputs", "outputs"],
    *,
    together: bool = False,
    margin: Fraction | None = None,
    response: PortResponse | None = None,
) -> DiskMargin | None:
    """Prove how far inputs, or outputs, may be from 1 before a stable loop fails.

    Parameters
    ----------
    loop : ClosedLoop
    at : {"inputs", "outputs"}
    together : bool
        Whether all of them are multiplied at once, with a number for each; else one at a time.
    margin : Fraction, optional
        The margin to prove; by default about the largest one.
    response : PortResponse, optional
        `response_of` these ports, if it is known.

    Returns
    -------
    DiskMargin or None
        None also where the given margin is larger than the loop's.

    Notes
    -----
    The disk margin α of one loop is that of python-control's ``disk_margins`` with skew 0.  For
    several ports together it is a lower bound on the margin, with constant scalings.  O(N³) for
    each inequality.
    """
    system = response or response_of(loop, at)
    ports = system.ports
    if system.unstable:
        return None
    groups = [range(ports)] if together or not ports else [range(k, k + 1) for k in range(ports)]
    # far from all poles T is 0, so that no norm is below 1/2
    worst = max([0.5, *(system.scaled_norm(each)[0] for each in groups)])
    for slack in _SLACK:
        alpha = margin or decimal_below(Fraction(1 / (worst * slack)), 3)
        if parts := _margin_parts(system, alpha, groups):
            return DiskMargin(loop.system, at, together, alpha, parts)
    return None


def response_of(loop: ClosedLoop, at: Side) -> PortResponse:
    """The response T + I/2 of all inputs, or of all outputs, to what is added there."""
    disturbed = loop.disturbed
    enter, leave = (disturbed.E, disturbed.U) if at == "inputs" else (disturbed.G, disturbed.Y)
    return PortResponse((disturbed.M, enter, leave), is_discrete(loop.plant.time), HALF)


def single_margin(response: PortResponse, port: int) -> Fraction | None:
    """About the largest disk margin of one port by itself that is proved; None without a proof."""
    if response.unstable:
        return None
    worst = max(response.scaled_norm([port])[0], 0.5)
    tried = (decimal_below(Fraction(1 / (worst * slack)), 3) for slack in _SLACK)
    return next((alpha for alpha in tried if response.proved([port], alpha)), None)


def computed_margins(response: PortResponse) -> tuple[list[float], float]:
    """The disk margin of each port by itself, and that of all together, at many frequencies.

    All are 0 for a loop that is not stable, and prove nothing; without ports the latter is 2.
    """
    ports = range(response.ports)
    if response.unstable:
        return [0.0 for _ in ports], 0.0
    single = [1 / max(response.scaled_norm([k])[0], 0.5) for k in ports]
    return single, 1 / max(response.scaled_norm(ports)[0] if ports else 0.5, 0.5)


HALF = Fraction(1, 2)
"""The part of the perturbation that is added to T: f = (1 + d/2)/(1 − d/2) is d(u + w/2) = w."""


def sectors_of(
    loop: ClosedLoop, sectors: Sequence[tuple[Fraction, Fraction]]
) -> SectorStability | None:
    """Prove that a loop is stable whatever its inputs pass through, within sectors.

    Parameters
    ----------
    loop : ClosedLoop
    sectors : sequence of pairs of Fraction
        The ends (a, b), a < b, one pair for each input in the order of the channels: the plant
        receives f(t, v) between av and bv for the v that the agent computes.

    Returns
    -------
    SectorStability or None

    Notes
    -----
    The circle criterion: f(t, v) = mv + rg(t, v) with m = (a + b)/2, r = (b − a)/2 and |g| ≤ |v|,
    and the response from g to v has a norm below 1 with a constant scaling.
    """
    response, half = sector_response(loop, sectors)
    if response.unstable or not all(half):
        return None
    part = response.proved(range(len(half)), Fraction(1))
    if part is None:
        return None
    scaling = tuple(t / r**2 for t, r in zip(part.scaling, half, strict=True))
    return SectorStability(loop.system, tuple(sectors), scaling, part.P)


def sector_response(
    loop: ClosedLoop, sectors: Sequence[tuple[Fraction, Fraction]]
) -> tuple[PortResponse, list[Fraction]]:
    """The response from g to v of `sectors_of`, and half the width of each sector."""
    disturbed, discrete = loop.disturbed, is_discrete(loop.plant.time)
    middle = diagonal_matrix([(a + b) / 2 for a, b in sectors])
    half = [(b - a) / 2 for a, b in sectors]
    M = disturbed.M + disturbed.E @ (middle - Matrix.identity(len(half))) @ disturbed.U
    response = PortResponse(
        (M, disturbed.E @ diagonal_matrix(half), disturbed.U), discrete, Fraction(0)
    )
    return response, half


def _margin_parts(
    system: PortResponse, alpha: Fraction, groups: Sequence[Sequence[int]]
) -> tuple[MarginPart, ...]:
    """The parts that prove a margin: one for all ports if it is there, else one for each group."""
    whole = range(system.ports)
    if len(groups) > 1 and (part := system.proved(whole, alpha)) is not None:
        return (part,)
    parts = []
    for each in groups:
        part = system.proved(each, alpha)
        if part is None:
            return ()
        parts.append(part)
    return tuple(parts)


class PortResponse:
    """The response T + cI of some ports to what is added there, in floating point and exactly.

    Parameters
    ----------
    exact : tuple of Matrix
        M, E and Y of T = Y(xI − M)⁻¹E.
    discrete : bool
    direct : Fraction
        c.
    """

    def __init__(
        self, exact: tuple[Matrix, Matrix, Matrix], discrete: bool, direct: Fraction
    ) -> None:
        from scipy.linalg import matrix_balance

        self.exact, self.discrete, self.ports = exact, discrete, exact[2].nrows
        self.direct, self._through = direct, to_float(direct)
        self._floats = m, e, y = tuple(map(matrix_to_float, self.exact))
        self.scales: Floats = np.ones(len(m))
        if len(m):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                _, (scales, _) = matrix_balance(m, permute=False, separate=True)
            self.scales = np.asarray(scales, dtype=np.float64)
        s = self.scales
        self.m, self.e, self.y = m / s[:, None] * s, e / s[:, None], y * s
        self.poles = np.linalg.eigvals(self.m)
        edge = np.abs(self.poles) >= 1 if discrete else self.poles.real >= 0
        self.unstable = bool(np.any(edge))
        self._modal = modal_form(self.m, self.e, self.y)

    def _points(self) -> npt.NDArray[np.complex128]:
        """Points of the border of the stable region, close to each other near the poles."""
        # conjugate poles have the same points
        poles = np.unique(self.poles.real + 1j * np.abs(self.poles.imag))
        spread = np.linspace(-2, 2, 9) if len(poles) <= _FEW_POLES else np.zeros(1)
        if self.discrete:
            around = np.abs(np.angle(poles))[:, None]
            widths = np.log(np.maximum(np.abs(poles), 1e-3))[:, None]
            angles = [np.linspace(0, np.pi, 300), np.logspace(-5, 0, 60), around + widths * spread]
            on_circle = np.exp(1j * np.unique(np.concatenate([each.ravel() for each in angles])))
            return np.asarray(on_circle, dtype=np.complex128)
        sizes = np.abs(poles)
        low = np.log10(max(float(np.min(sizes, initial=1.0)), 1e-9)) - 2
        high = np.log10(float(np.max(sizes, initial=1.0))) + 2
        near = np.abs(poles.imag)[:, None] + poles.real[:, None] * spread
        upward = np.abs(np.concatenate([[0.0], np.logspace(low, high, 300), near.ravel()]))
        return np.asarray(1j * np.unique(upward), dtype=np.complex128)

    def nyquist(self, port: int) -> list[complex]:
        """The loop opened at a port, with the usual sign of feedback, along the border upward."""
        points, direct = self._points(), self._through
        T = [complex(G[port, port]) - direct for G in self._samples]
        # the response at a conjugate point is the conjugate one
        T = [t.conjugate() if z.imag < 0 else t for z, t in zip(points, T, strict=True)]
        order = np.argsort(np.abs(np.angle(points)) if self.discrete else points.imag)
        T = [T[k] for k in order]
        return [-t / (1 + t) for t in T if t != -1]

    def worst_point(self, port: int) -> complex:
        """The sampled point of the upper half of the border where a port's gain is largest."""
        gains = [abs(G[port, port]) for G in self._samples]
        z = complex(self._points()[int(np.argmax(gains))])
        return complex(z.real, abs(z.imag))

    @cached_property
    def _samples(self) -> Complexes:
        """T + cI at all points, Z × k × k for k ports."""
        points, direct = self._points(), self._through * np.eye(self.ports)
        if self._modal is not None:
            values, left, right = self._modal
            return np.asarray((left[None] / (points[:, None, None] - values)) @ right + direct)
        # the eigenvectors are too ill-conditioned: one triangular system for each point
        from scipy.linalg import schur, solve_triangular

        T, Z = schur(self.m, output="complex")
        left, right, eye = self.y @ Z, Z.conj().T @ self.e, np.eye(len(T))
        solved = [left @ solve_triangular(z * eye - T, right) for z in points]
        return np.asarray(solved, dtype=np.complex128).reshape(len(points), *direct.shape) + direct

    def scaled_norm(self, ports: Sequence[int]) -> tuple[float, Floats]:
        """The largest gain seen of some ports, and a scaling that makes it small."""
        places = list(ports)
        if not places:
            return 0.0, np.ones(0)
        if len(places) == 1:
            return float(np.max(np.abs(self._samples[:, places[0], places[0]]))), np.ones(1)
        whole = places == list(range(self.ports))
        samples = self._samples if whole else self._samples[:, places][:, :, places]
        return scaled_norm(samples)

    def proved(self, ports: Sequence[int], alpha: Fraction) -> MarginPart | None:
        """A matrix that proves the margin of these ports together; None if none holds."""
        places = list(ports)
        norm, theta = self.scaled_norm(places)
        if norm * to_float(alpha) >= 1:
            return None
        scaling = tuple(Fraction(float(x)) for x in theta)
        for P in self.forms(places, theta, alpha):
            for bits in BITS:
                form = rounded_form(P, bits)
                if form is None:
                    break
                part = MarginPart(tuple(places), scaling, form)
                if bits <= _SURE_BITS and not self._seems_to_hold(part, alpha):
                    continue
                if part_holds(self.exact, part, alpha, discrete=self.discrete, direct=self.direct):
                    return part
        return None

    def _seems_to_hold(self, part: MarginPart, alpha: Fraction) -> bool:
        """Whether rounding seems to leave an inequality strict, which proves nothing."""
        ports = list(part.ports)
        P, theta = _in_floats(part.P), np.array([to_float(x) for x in part.scaling])
        m, e, y = self._floats[0], self._floats[1][:, ports], self._floats[2][ports]
        seen, driven = y.T * theta, P @ e
        corner = np.diag(theta * (1 / to_float(alpha) ** 2 - self._through**2))
        half = P @ m
        state = (P - m.T @ half if self.discrete else -(half + half.T)) - seen @ y
        if self.discrete:
            corner, driven = corner - e.T @ driven, m.T @ driven
        across = -(driven + seen * self._through)
        return _seems_positive(np.block([[state, across], [across.T, corner]]))

    def forms(
        self,
        ports: list[int],
        theta: Floats,
        alpha: Fraction,
        extras: Sequence[float] = _EXTRA,
    ) -> Iterator[Floats]:
        """Solutions of the Riccati equation of the bounded real lemma, in the plant's units.

        ``extras`` are how much is added to the weight of the states, relative to what is seen.
        """
        h = np.sqrt(theta)
        e, y = self.e[:, ports] / h, self.y[ports] * h[:, None]
        k, gamma = len(ports), 1 / to_float(alpha)
        for modal, extra in product((False, True), extras):
            P = self._bounded_real(e, y, k, gamma, extra, modal=modal)
            if P is not None:
                yield P / self.scales[:, None] / self.scales

    def _bounded_real(
        self, e: Floats, y: Floats, k: int, gamma: float, extra: float, *, modal: bool
    ) -> Floats | None:
        """P of the Riccati equation, by Newton's method, whose steps are Lyapunov equations.

        What is added to the weight of the states is the same for every state, or such that every
        mode has the same part of the gain, for loops with one mode far slower than the others.
        """
        from scipy.linalg import solve_continuous_lyapunov, solve_discrete_lyapunov

        n, eye = len(self.m), np.eye(len(self.m))

        def lyapunov(M: Floats, right: Floats) -> Floats | None:
            solver = solve_discrete_lyapunov if self.discrete else solve_continuous_lyapunov
            return solved(lambda: solver(M.T, right if self.discrete else -right))

        seen, cross = y.T @ y, self._through * y.T
        X0, X1 = lyapunov(self.m, seen), lyapunov(self.m, eye)
        if X0 is None or X1 is None or n == 0:
            return X0
        more: Floats | None = (float(np.trace(X0)) or 1.0) / float(np.trace(X1)) * eye
        if modal:
            passed = float(np.trace(e.T @ X0 @ e))
            more = _modal_weight(self.m, e @ e.T, passed, discrete=self.discrete)
        if more is None:
            return None
        Q = seen + extra * more
        room = (gamma**2 - self._through**2) * np.eye(k)
        P = np.zeros((n, n))
        for _ in range(40):
            bound = room - e.T @ P @ e if self.discrete else room
            if k and np.linalg.eigvalsh(bound)[0] <= 0:
                return None
            right = (e.T @ P @ self.m if self.discrete else e.T @ P) + cross.T
            K = np.linalg.solve(bound, right) if k else np.zeros((0, n))
            step = lyapunov(self.m + e @ K, Q + cross @ K + K.T @ cross.T - K.T @ room @ K)
            if step is None:
                return None
            if np.linalg.norm(step - P) <= 1e-10 * np.linalg.norm(step):
                return step
            P = step
        return P


def modal_form(m: Floats, e: Floats, y: Floats) -> tuple[Complexes, Complexes, Complexes] | None:
    """λ, yV and V⁻¹e of m = V diag(λ) V⁻¹; None if the eigenvectors are too ill-conditioned."""
    values, V = np.linalg.eig(m)
    try:
        right = np.linalg.solve(V, e.astype(np.complex128))
    except np.linalg.LinAlgError:
        return None
    # Rounding in V⁻¹ is magnified by its condition number.
    if len(m) and np.linalg.cond(V) > _CONDITION:
        return None
    return np.asarray(values, dtype=np.complex128), np.asarray(y @ V), np.asarray(right)


def scaled_norm(samples: Complexes) -> tuple[float, Floats]:
    """The largest norm of Θ^½ G Θ^−½ among samples G, for a diagonal Θ that makes it small.

    The entries of Θ are powers of 2.
    """
    moduli = np.abs(samples)
    theta = chosen = np.ones(samples.shape[-1])
    best, worst = _largest_gain(samples, moduli, chosen)
    for _ in range(6):
        target = np.clip(_osborne(worst), 1 / _SCALINGS, _SCALINGS)
        theta = np.exp((np.log(theta) + np.log(target)) / 2)
        rounded = np.exp2(np.round(np.log2(theta)))
        value, worst = _largest_gain(samples, moduli, rounded)
        if value < best:
            best, chosen = value, rounded
    return best, chosen


def _largest_gain(samples: Complexes, moduli: Floats, scaling: Floats) -> tuple[float, Complexes]:
    """The largest norm of Θ^½ G Θ^−½ among samples G with their moduli, and the G that has it.

    No norm exceeds the Frobenius norm, nor the geometric mean of the largest sums of a row and of a
    column; norms are computed in the order of these bounds, until none can be larger.
    """
    h = np.sqrt(scaling)
    # the sums of all rows, of all columns, and of all squares
    rows, columns = (moduli @ (1 / h)) * h, (h @ moduli) / h
    squares = ((moduli**2) @ (1 / scaling)) @ scaling
    bounds = np.minimum(np.sqrt(rows.max(axis=1) * columns.max(axis=1)), np.sqrt(squares))
    order, best, place = np.argsort(-bounds), -1.0, 0
    for first in range(0, len(order), _AT_ONCE):
        some = order[first : first + _AT_ONCE]
        # rounding may make a bound a little too small
        if bounds[some[0]] * (1 + 1e-9) <= best:
            break
        sizes = np.linalg.norm(h[:, None] * samples[some] / h, 2, axis=(1, 2))
        k = int(np.argmax(sizes))
        if sizes[k] > best:
            best, place = float(sizes[k]), int(some[k])
    return best, samples[place]


def _osborne(G: npt.NDArray[np.complex128]) -> Floats:
    """A diagonal that balances the rows and columns of a matrix (Osborne's iteration)."""
    size = np.abs(G) ** 2
    nothing = _NO_GAIN * size.diagonal()
    np.fill_diagonal(size, 0.0)
    columns, theta, inverse = size.T.copy(), np.ones(len(G)), np.ones(len(G))
    for _ in range(_SWEEPS):
        largest = 1.0
        for i in range(len(G)):
            row, column = float(size[i] @ inverse), float(columns[i] @ theta)
            if row * theta[i] > nothing[i] and column * inverse[i] > nothing[i]:
                before, theta[i] = theta[i], math.sqrt(column / row)
                inverse[i] = 1 / theta[i]
                largest = max(largest, theta[i] / before, before / theta[i])
        if largest < _BALANCED:
            break
    return theta


def part_holds(
    signals: tuple[Matrix, Matrix, Matrix],
    part: MarginPart,
    alpha: Fraction,
    *,
    discrete: bool,
    direct: Fraction = HALF,
) -> bool:
    """Whether a matrix proves ‖Θ^½(T + cI)Θ^−½‖ < 1/α for its ports, T of all ports as given."""
    M, enter, leave = signals
    chosen = M, enter.take(cols=part.ports), leave.take(rows=part.ports)
    P, Theta = part.P.matrix(), diagonal_matrix(part.scaling)
    gain = bounded_real(P, chosen, Theta, 1 / alpha**2, discrete, direct)
    return is_positive(gain) and is_positive(P)


def bounded_real(
    P: Matrix,
    signals: tuple[Matrix, Matrix, Matrix],
    Theta: Matrix,
    square: Fraction,
    discrete: bool,
    direct: Fraction,
) -> Matrix:
    """The matrix which is positive definite only if ‖Θ^½(T + cI)Θ^−½‖² is below ``square``.

    With c = 1/2 it is that of `disk_margin` in ``FORMAT.md``.
    """
    M, E, Y = signals
    seen = Y.T @ Theta
    corner = Theta * (square - direct**2)
    if discrete:
        corner = corner - E.T @ (P @ E)
    half = M.T @ (P @ E) if discrete else P @ E
    across = -(half + seen * direct)
    return block([[lyapunov_difference(P, M, discrete) - seen @ Y, across], [across.T, corner]])
