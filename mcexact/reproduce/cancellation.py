"""Section II-A: certainty equivalence, the cancellation rule, and the graphs that respect it."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

from mcexact.exact.linear_algebra import characteristic_polynomial, rank
from mcexact.exact.matrix import Matrix, block, hstack, vstack
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.reproduce.material import (
    PAPER,
    Numbers,
    drawn_plants,
    graph_of,
    plants,
    three_channels,
)
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.reproduce.plants import dependent_inputs


def one_agent(note: Notebook) -> None:
    """With one agent the spectrum is that of A + BF and that of A + KC."""
    numbers = Numbers(4)
    for plant in note.each(plants(8)):
        B, C = plant.input_matrix(), plant.output_matrix()
        F, K = numbers.matrix(B.ncols, plant.n), numbers.matrix(plant.n, C.nrows)
        loop = block([[plant.A, B @ F], [-(K @ C), plant.A + K @ C + B @ F]])
        x, e = numbers.column(plant.n), numbers.column(plant.n)
        moved = loop @ vstack([x, x + e])
        error = moved.take(rows=range(plant.n, 2 * plant.n)) - moved.take(rows=range(plant.n))
        note.check("ė = (A + KC)e, whatever x is", error == (plant.A + K @ C) @ e)
        apart = characteristic_polynomial(plant.A + B @ F) * characteristic_polynomial(
            plant.A + K @ C
        )
        note.check("the loop's polynomial is the product", characteristic_polynomial(loop) == apart)
        if note.here == PAPER:
            twice = characteristic_polynomial(plant.A + B @ F) ** 2
            wrong = characteristic_polynomial(plant.A + B @ F) * characteristic_polynomial(
                plant.A - K @ C
            )
            kept = block([[plant.A, B @ F], [-(K @ C), plant.A + K @ C]])
            note.refute("twice", characteristic_polynomial(loop) != twice)
            note.refute("sign", characteristic_polynomial(loop) != wrong)
            note.refute("without-input", characteristic_polynomial(kept) != apart)


def _moved(plant: MultiChannelSystem, F: Matrix, x: Matrix, errors: Sequence[Matrix]) -> Matrix:
    """The state after steps of x(t+1) = Ax + BF(x + e), with one e for each."""
    for e in errors:
        x = plant.A @ x + plant.input_matrix() @ (F @ (x + e))
    return x


def small_errors(note: Notebook) -> None:
    """The state under u = F(x + e) deviates from that under u = Fx by a linear function of e."""
    numbers = Numbers(20)
    for plant in note.each(plants(8, time="discrete")):
        F = numbers.matrix(plant.input_matrix().ncols, plant.n)
        x = numbers.column(plant.n)
        errors = [numbers.column(plant.n) for _ in range(plant.n + 2)]
        deviations = {
            size: _moved(plant, F, x, [e * size for e in errors])
            - _moved(plant, F, x, [e * 0 for e in errors])
            for size in (1, -3, 2, 1000)
        }
        note.check(
            "errors times g make g times the deviation",
            all(found == deviations[1] * size for size, found in deviations.items()),
        )
        note.refute("exact", not deviations[1].is_zero())
        note.refute("square", deviations[2] != deviations[1] * 4)


def respects(
    plant: MultiChannelSystem, feedbacks: Sequence[Matrix], graph: NeighborGraph, agent: int
) -> bool:
    """Whether Σ B_j F_j x_j is a function of the x_j that an agent receives."""
    unit = Matrix.identity(plant.n * plant.m)
    heard = graph.neighborhood(agent)
    received = vstack(
        [unit.take(rows=range(j * plant.n, (j + 1) * plant.n)) for j in heard], ncols=unit.ncols
    )
    needed = hstack([plant.B(j) @ feedbacks[j] for j in range(plant.m)])
    return rank(vstack([received, needed])) == rank(received)


def graphs(note: Notebook) -> None:
    """The rule respects a graph iff every agent hears all others, unless some B_j F_j is zero."""
    numbers = Numbers(21)
    complete = three_channels().with_neighbors(NeighborGraph.complete(("1", "2", "3")))
    for plant in note.each(
        [(f"{PAPER}, over the complete graph", complete)],
        plants(4),
        drawn_plants(4, connected=False),
    ):
        graph, agents = graph_of(plant), range(plant.m)
        F = [numbers.matrix(plant.p(i), plant.n) for i in agents]
        acting = {i for i in agents if not (plant.B(i) @ F[i]).is_zero()}
        note.check("no B_j F_j is zero", acting == set(agents))
        kept = all(respects(plant, F, graph, i) for i in agents)
        everybody = all(len(graph.neighborhood(i)) == plant.m for i in agents)
        note.check("the rule respects the graph just when the graph is complete", kept == everybody)
        for zero in product((False, True), repeat=plant.m):
            G = [F[j] * int(not zero[j]) for j in agents]
            some = {j for j in agents if not zero[j]}
            note.check(
                "and agent i just when all j with B_j F_j ≠ 0 are neighbors of i",
                all(
                    respects(plant, G, graph, i) == (some <= set(graph.neighborhood(i)))
                    for i in agents
                ),
            )
        if graph.is_strongly_connected() and not everybody:
            note.refute("connected", not kept)
    name, plant, gains = dependent_inputs()
    note.on(name, plant)
    note.print(plant)
    graph = graph_of(plant)
    kept = all(respects(plant, gains, graph, i) for i in range(plant.m))
    nonzero = all(not F.is_zero() for F in gains)
    note.refute("F_j", kept and nonzero and len(graph.neighborhood(0)) < plant.m)


PROCEDURES: dict[str, Procedure] = {
    "cancellation": one_agent,
    "small-errors": small_errors,
    "cancellation-graph": graphs,
}
