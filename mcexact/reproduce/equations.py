"""The defining equations of constructions, evaluated at drawn vectors from the plant alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from mcexact.answer.structure import TransferGraph
from mcexact.exact.matrix import Matrix, vstack
from mcexact.exact.roots import is_discrete
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.reproduce.material import Numbers, graph_of


def driven(system: MultiChannelSystem, x: Matrix, inputs: Sequence[Matrix]) -> Matrix:
    """Ax + Σ B_i u_i."""
    total = system.A @ x
    for i, u in enumerate(inputs):
        total = total + system.B(i) @ u
    return total


def outputs(system: MultiChannelSystem, x: Matrix) -> list[Matrix]:
    """y_i = C_i x."""
    return [system.C(i) @ x for i in range(system.m)]


def stacked(parts: Sequence[Matrix]) -> Matrix:
    """column{…}, empty parts included."""
    return vstack(list(parts), ncols=1)


def positions(plant: MultiChannelSystem, graph: TransferGraph) -> set[tuple[int, int]]:
    """The edges of a transfer graph from one channel to another, by position."""
    at = {name: i for i, name in enumerate(plant.names)}
    return {(at[j], at[i]) for j, i in graph.arcs if j != i}


def union_of_graphs(plant: MultiChannelSystem, transfer: TransferGraph) -> NeighborGraph:
    """The union of the neighbor graph and the transfer graph."""
    return graph_of(plant).with_edges(positions(plant, transfer))


def messages_agree(
    plant: MultiChannelSystem,
    made: MultiChannelSystem,
    sizes: Sequence[int],
    share: str,
    delays: Mapping[tuple[int, int], int],
    numbers: Numbers,
    steps: int = 7,
) -> bool:
    """Whether agents of an extended system see what links with these delays bring, step by step.

    Starts from a drawn x with nothing sent before, x_i(t+1) = v_i(t); without delays that says the
    same of ẋ_i = v_i.  Agent i sees y_j(t) for the delay 0, then y_j late (y_i(t) alone where only
    sub-states are shared), then x_j late, j ∈ N_i.
    """
    graph, both = graph_of(plant), share == "outputs+states"
    x, shared = numbers.column(plant.n), [Matrix.zeros(size, 1) for size in sizes]
    state = stacked([x, Matrix.zeros(made.n - plant.n, 1)])
    sent: list[tuple[list[Matrix], list[Matrix]]] = []

    def past(late: int, which: int, j: int) -> Matrix:
        if late < len(sent):
            return sent[-1 - late][which][j]
        return Matrix.zeros((plant.q(j), sizes[j])[which], 1)

    for _ in range(steps):
        sent.append((outputs(plant, x), shared))
        for i in range(plant.m):
            late = {j: delays.get((i, j), 0) for j in graph.neighborhood(i)}
            measured = sorted(late, key=lambda j: late[j] > 0) if both else [i]
            seen = [past(late[j] if both else 0, 0, j) for j in measured]
            seen += [past(late[j], 1, j) for j in late]
            if made.C(i) @ state != stacked(seen):
                return False
        u = [numbers.column(plant.p(i)) for i in range(plant.m)]
        v = [numbers.column(size) for size in sizes]
        state = driven(made, state, [stacked([u[i], v[i]]) for i in range(plant.m)])
        x, shared = driven(plant, x, u), v
    return True


def errors_agree(
    plant: MultiChannelSystem,
    made: MultiChannelSystem,
    feedbacks: Sequence[Matrix],
    numbers: Numbers,
) -> bool:
    """Whether e_i = x_i − x obeys the error system under the substitution rule.

    ẋ = Ax + Σ B_j F_j x_j and ẋ_i = Ax_i + (Σ B_j F_j) x_i + ṽ_i; agent i sees C_i e_i and
    e_i − e_j, j ∈ N_i∖{i}.
    """
    graph = graph_of(plant)
    x = numbers.column(plant.n)
    estimates = [numbers.column(plant.n) for _ in range(plant.m)]
    v = [numbers.column(plant.n) for _ in range(plant.m)]
    moved = driven(plant, x, [F @ x_j for F, x_j in zip(feedbacks, estimates, strict=True)])
    errors = [x_i - x for x_i in estimates]
    ahead = [
        driven(plant, x_i, [F @ x_i for F in feedbacks]) + v_i - moved
        for x_i, v_i in zip(estimates, v, strict=True)
    ]
    epsilon = stacked(errors)
    for i in range(plant.m):
        others = [errors[i] - errors[j] for j in graph.neighborhood(i) if j != i]
        if made.C(i) @ epsilon != stacked([plant.C(i) @ errors[i], *others]):
            return False
    return driven(made, epsilon, v) == stacked(ahead)


def integrators_agree(
    plant: MultiChannelSystem, made: MultiChannelSystem, numbers: Numbers
) -> bool:
    """Whether (18) holds for r = 0: ẇ_i = y_i (discrete: w_i + y_i), and agent i sees w_i."""
    x = numbers.column(plant.n)
    w = [numbers.column(plant.q(i)) for i in range(plant.m)]
    u = [numbers.column(plant.p(i)) for i in range(plant.m)]
    y = outputs(plant, x)
    if is_discrete(plant.time):
        y = [a + b for a, b in zip(w, y, strict=True)]
    state = stacked([x, *w])
    return outputs(made, state) == w and driven(made, state, u) == stacked(
        [driven(plant, x, u), *y]
    )
