"""Section I: multi-channel systems, neighbor graphs, and the paper's assumptions."""

from __future__ import annotations

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.derived.constructions import feedback
from mcexact.exact.matrix import Matrix
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.system import MultiChannelSystem
from mcexact.reproduce.equations import driven, outputs, stacked
from mcexact.reproduce.material import PAPER, Numbers, graph_of, plants, three_channels
from mcexact.reproduce.notebook import Notebook, Procedure
from mcexact.simulation.network import InitialState
from mcexact.simulation.trajectory import simulate


def continuous(note: Notebook) -> None:
    """Equation (1): u_i = F_i y_i gives the matrix A + Σ B_i F_i C_i."""
    numbers = Numbers(1)
    for plant in note.each(plants(10)):
        gains = numbers.gains(plant)
        x = numbers.column(plant.n)
        y = outputs(plant, x)
        u = [F @ y_i for F, y_i in zip(gains, y, strict=True)]
        closed = feedback(plant, gains)
        note.check("A + Σ B_i F_i C_i is the closed loop", driven(plant, x, u) == closed.A @ x)
        opposite = feedback(plant, [F * -1 for F in gains])
        if note.here == PAPER:
            note.refute("sign", driven(plant, x, u) != opposite.A @ x)
            note.refute("late", driven(plant, x, u[1:] + u[:1]) != closed.A @ x)


def discrete(note: Notebook) -> None:
    """Equation (2): one agent for each channel gives the same closed loop."""
    numbers = Numbers(2)
    for plant in note.each(plants(10, time="discrete")):
        gains = numbers.gains(plant)
        agents = tuple(
            AgentProgram(agent, 0, 0, input=LinearMap({i: gains[i]}))
            for i, agent in enumerate(plant.names)
        )
        x = numbers.column(plant.n)
        start = tuple(row[0] for row in x.rows())
        empty: tuple[tuple[()], ...] = ((),) * plant.m
        run = simulate(
            plant,
            Controller("discrete", plant.digest(), agents),
            initial=InitialState(start, empty, empty),
            horizon=5,
        )
        last = Matrix.column(run.snapshots[-1].plant)
        note.check(
            "five steps of the agents are five powers of A + Σ B_i F_i C_i",
            last == feedback(plant, gains).A.power(5) @ x,
        )
        if note.here == PAPER:
            loop = feedback(plant, gains).A
            note.refute("late", last != loop.power(4) @ x)
            note.refute("continuous", last != (Matrix.identity(plant.n) + loop).power(5) @ x)


def assumptions(note: Notebook) -> None:
    """Joint controllability and observability; B_i ≠ 0 and C_i ≠ 0."""
    for plant in note.each(plants(10)):
        note.joint(plant)
        live = all(not c.B.is_zero() and not c.C.is_zero() for c in plant.channels)
        note.check("B_i and C_i are not zero", live)
    plant = note.at((PAPER, three_channels()))
    for i, name in enumerate(plant.names):
        single = MultiChannelSystem(plant.A, [plant.B(i)], [plant.C(i)], names=[name])
        reach, sight = joint_controllability(single), joint_observability(single)
        note.certify(reach, sight)
        note.refute("one-channel", not (reach.controllable and sight.controllable))


def neighbor_sets(note: Notebook) -> None:
    """Agent i receives messages of j if and only if j → i is an edge; N_i contains i."""
    for plant in note.each(plants(10, connected=None)):
        graph = graph_of(plant)
        own = all(i in graph.neighborhood(i) for i in range(plant.m))
        note.check("every agent is its own neighbor", own)
        edges = {(j, i) for i in range(plant.m) for j in graph.neighborhood(i) if j != i}
        note.check("the edges are the neighbors", set(graph.edges()) == edges)
        x = Numbers(3).column(plant.n)
        y = outputs(plant, x)
        for i in range(plant.m):
            heard = graph.neighborhood(i)
            note.check(
                f"C of the neighbors of {plant.names[i]} stacks their outputs",
                plant.output_matrix(heard) @ x == stacked([y[j] for j in heard]),
            )
    plant = note.at((PAPER, three_channels()))
    graph = graph_of(plant)
    followers = [{i for i in range(3) if j in graph.neighborhood(i)} for j in range(3)]
    sets = [set(graph.neighborhood(i)) for i in range(3)]
    note.check("N_1, N_2, N_3 are as printed", sets == [{0, 1}, {1, 2}, {0, 2}])
    note.refute("followers", sets != followers)
    note.refute("without-itself", all(i in N for i, N in enumerate(sets)))


PROCEDURES: dict[str, Procedure] = {
    "equation-1": continuous,
    "equation-2": discrete,
    "jointly": assumptions,
    "neighbor-graph": neighbor_sets,
}
