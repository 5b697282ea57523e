"""The equations of the distributed observer, evaluated at drawn vectors as they are printed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from mcexact.exact.matrix import Matrix, hstack
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.reproduce.equations import driven, outputs, stacked
from mcexact.reproduce.material import Numbers, graph_of
from mcexact.synthesis.channel_controller import ChannelController
from mcexact.synthesis.observer import observer_programs


@dataclass(frozen=True)
class Observer:
    """Drawn matrices of an observer, and the loop that the agents' programs make of them.

    Attributes
    ----------
    plant : MultiChannelSystem
    F : sequence of Matrix
    q : int
        The agent with the channel controller.
    K : list of Matrix
    H : list of dict of int to Matrix
        H_ij for j ∈ N_i∖{i}.
    channel : ChannelController
        Ā, [K̄, H̄_j …], C̄ and D̄, by which K_q and H_qj differ from K̃_q and H̃_qj.
    loop : ClosedLoop
    """

    plant: MultiChannelSystem
    F: Sequence[Matrix]
    q: int
    K: list[Matrix]
    H: list[dict[int, Matrix]]
    channel: ChannelController
    loop: ClosedLoop

    def assembled(self, gains: Matrix) -> tuple[Matrix, dict[int, Matrix]]:
        """The parts of a matrix for (C_q e_q, e_q − e_j, …): that of C_q e_q, and those of j."""
        n, width = self.plant.n, self.plant.q(self.q)
        parts = {
            j: gains.take(cols=range(width + k * n, width + (k + 1) * n))
            for k, j in enumerate(self.H[self.q])
        }
        return gains.take(cols=range(width)), parts


def drawn_observer(plant: MultiChannelSystem, F: Sequence[Matrix], numbers: Numbers) -> Observer:
    """Draw K̃_i, H̃_ij and a channel controller of order m − 1 at the last agent."""
    n, m, graph, q = plant.n, plant.m, graph_of(plant), plant.m - 1
    K = [numbers.matrix(n, plant.q(i)) for i in range(m)]
    H = [{j: numbers.matrix(n, n) for j in graph.neighborhood(i) if j != i} for i in range(m)]
    seen = plant.q(q) + n * len(H[q])
    channel = ChannelController(
        numbers.matrix(m - 1, m - 1),
        numbers.matrix(m - 1, seen),
        numbers.matrix(n, m - 1),
        numbers.matrix(n, seen),
        None,
    )
    gains = [hstack([K[i], *H[i].values()]) for i in range(m)]
    controller = observer_programs(plant, graph, q, F, gains, channel)
    return Observer(plant, F, q, K, H, channel, closed_loop(plant, controller))


def equations_agree(made: Observer, numbers: Numbers) -> tuple[bool, bool, bool, bool]:
    """Evaluate (9), (10) and (11), and the errors' (12) and (13); with F_i = 0 (3) to (6).

    Returns
    -------
    tuple of bool
        Whether the loop of the programs obeys (9), (10), (11); and (12) and (13) for e_i = x_i − x.
    """
    plant, q, channel = made.plant, made.q, made.channel
    x, z = numbers.column(plant.n), numbers.column(plant.m - 1)
    x_ = [numbers.column(plant.n) for _ in range(plant.m)]
    state = stacked(
        [x, *(part for i in range(plant.m) for part in ([x_[i], z] if i == q else [x_[i]]))]
    )
    moved = made.loop.matrix @ state
    found = {name: moved.take(rows=range(at, at + size)) for name, (at, size) in _places(made)}
    y = outputs(plant, x)
    extra_K, extra_H = made.assembled(channel.D)
    K_bar, H_bar = made.assembled(channel.B)
    fed = sum((plant.B(j) @ made.F[j] for j in range(plant.m)), Matrix.zeros(plant.n, plant.n))
    e = [each - x for each in x_]

    def gains(i: int) -> tuple[Matrix, dict[int, Matrix]]:
        if i != q:
            return made.K[i], made.H[i]
        return made.K[i] + extra_K, {j: made.H[i][j] + extra_H[j] for j in made.H[i]}

    plant_moves = driven(plant, x, [made.F[i] @ x_[i] for i in range(plant.m)])
    estimates, errors = [], []
    for i in range(plant.m):
        K, H = gains(i)
        here = channel.C @ z if i == q else Matrix.zeros(plant.n, 1)
        estimate = (plant.A + K @ plant.C(i)) @ x_[i] - K @ y[i] + fed @ x_[i] + here
        error = (plant.A + K @ plant.C(i)) @ e[i] + here
        for j, H_ij in H.items():
            estimate = estimate + H_ij @ (x_[i] - x_[j])
            error = error + H_ij @ (e[i] - e[j])
        for j in range(plant.m):
            error = error + plant.B(j) @ (made.F[j] @ (e[i] - e[j]))
        estimates.append(estimate)
        errors.append(error)
    z_moves = channel.A @ z + K_bar @ (plant.C(q) @ x_[q]) - K_bar @ y[q]
    z_of_errors = channel.A @ z + K_bar @ (plant.C(q) @ e[q])
    for j, H_j in H_bar.items():
        z_moves = z_moves + H_j @ (x_[q] - x_[j])
        z_of_errors = z_of_errors + H_j @ (e[q] - e[j])
    return (
        found["x"] == plant_moves,
        [found[f"x_{i}"] for i in range(plant.m)] == estimates and found["z"] == z_moves,
        [found[f"x_{i}"] - found["x"] for i in range(plant.m)] == errors,
        found["z"] == z_of_errors,
    )


def _places(made: Observer) -> list[tuple[str, tuple[int, int]]]:
    """Where x, the x_i and z are in the state of the loop."""
    blocks = made.loop.blocks
    places = [("x", blocks["x", 0, 0]), ("z", blocks["z_", made.q, 0])]
    return places + [(f"x_{i}", blocks["x_", i, 0]) for i in range(made.plant.m)]
