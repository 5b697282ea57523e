"""Defining equations, evaluated at drawn vectors without the matrices that a construction made."""

from __future__ import annotations

from collections.abc import Sequence

from mcexact.exact.blocks import vstack
from mcexact.exact.location import is_discrete
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem
from mcexact.reproduce.material import Numbers


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


def extended_agrees(
    plant: MultiChannelSystem,
    made: MultiChannelSystem,
    sizes: Sequence[int],
    share: str,
    numbers: Numbers,
) -> bool:
    """Whether `emcs` holds at drawn x, x_i, u_i, v_i.

    ẋ = Ax + Σ B_i u_i, ẋ_i = v_i, and agent i sees y_j (y_i alone for sub-states) and x_j, j ∈ N_i.
    """
    graph = plant.neighbors
    if graph is None or made.n != plant.n + sum(sizes):
        return False
    x = numbers.column(plant.n)
    shared = [numbers.column(size) for size in sizes]
    u = [numbers.column(plant.p(i)) for i in range(plant.m)]
    v = [numbers.column(size) for size in sizes]
    state = stacked([x, *shared])
    inputs = [stacked([u[i], v[i]]) for i in range(plant.m)]
    y = outputs(plant, x)
    for i in range(plant.m):
        heard = graph.neighborhood(i)
        seen = [y[j] for j in heard] if share == "outputs+states" else [y[i]]
        if made.C(i) @ state != stacked([*seen, *(shared[j] for j in heard)]):
            return False
    return driven(made, state, inputs) == stacked([driven(plant, x, u), *v])


def delayed_agrees(
    plant: MultiChannelSystem,
    made: MultiChannelSystem,
    sizes: Sequence[int],
    held: bool,
    numbers: Numbers,
    steps: int = 7,
) -> bool:
    """Whether a lifted or held system sees what links with these delays bring, step by step.

    Starts from rest; x_i(t+1) = v_i(t).  Agent i of the lifted system sees first what arrives at
    once, y_j(t) for d_ij = 0, then y_j(t−d_ij), then x_j(t−d_ij); agent i of the held system sees
    y_i(t) and x_j(t−d_j), j ∈ N_i.
    """
    graph = plant.neighbors
    if graph is None:
        return False
    x, state = Matrix.zeros(plant.n, 1), Matrix.zeros(made.n, 1)
    shared = [Matrix.zeros(size, 1) for size in sizes]
    sent: list[tuple[list[Matrix], list[Matrix]]] = []

    def past(delay: int, which: int, j: int) -> Matrix:
        if delay < len(sent):
            return sent[-1 - delay][which][j]
        return Matrix.zeros((plant.q(j), sizes[j])[which], 1)

    for _ in range(steps):
        sent.append((outputs(plant, x), shared))
        for i in range(plant.m):
            heard = graph.neighborhood(i)
            late = {j: graph.delay(i, j) for j in heard}
            if held:
                seen = [past(0, 0, i), *(past(graph.longest_delay(j), 1, j) for j in heard)]
            else:
                seen = [past(0, 0, j) for j in heard if not late[j]]
                seen += [past(late[j], 0, j) for j in heard if late[j]]
                seen += [past(late[j], 1, j) for j in heard]
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
    graph = plant.neighbors
    if graph is None or made.n != plant.n * plant.m:
        return False
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
    """Whether `b1` holds for r = 0: ẇ_i = y_i (discrete: w_i + y_i), and agent i sees w_i."""
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
