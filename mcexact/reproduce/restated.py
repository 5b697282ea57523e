"""Section IV-C: distributed control restated as decentralized control of extended systems."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from mcexact.derived.constructions import extended_system
from mcexact.exact.matrix import Matrix
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.reproduce.equations import driven, outputs, stacked
from mcexact.reproduce.material import (
    PAPER,
    Numbers,
    graph_of,
    plants,
    three_channels,
    with_dimensions,
)
from mcexact.reproduce.notebook import Notebook, Procedure


@dataclass(frozen=True)
class ChannelLaw:
    """ū_i = F ȳ_i + G z_i and ż_i = P ȳ_i + Q z_i: a controller of one channel.

    Attributes
    ----------
    F, G, P, Q : Matrix
    """

    F: Matrix
    G: Matrix
    P: Matrix
    Q: Matrix


def drawn_laws(
    made: MultiChannelSystem, private: Sequence[int], numbers: Numbers
) -> list[ChannelLaw]:
    """Controllers of all channels of a system, with states of these dimensions."""
    return [
        ChannelLaw(
            numbers.matrix(made.p(i), made.q(i)),
            numbers.matrix(made.p(i), k),
            numbers.matrix(k, made.q(i)),
            numbers.matrix(k, k),
        )
        for i, k in enumerate(private)
    ]


def as_programs(
    plant: MultiChannelSystem, sizes: Sequence[int], laws: Sequence[ChannelLaw]
) -> Controller:
    """Cut the matrices of channel controllers of the extended system into agents' programs.

    ȳ_i has the y_j of all j ∈ N_i and then the x_j; ū_i has u_i and then v_i.
    """
    graph, agents = graph_of(plant), []
    for i, law in enumerate(laws):
        widths = [plant.q(j) for j in graph.neighborhood(i)]
        widths += [sizes[j] for j in graph.neighborhood(i)]
        rows = range(plant.p(i)), range(plant.p(i), plant.p(i) + sizes[i])
        input_, shared = (
            _cut(law.F.take(rows=part), widths, graph.neighborhood(i), law.G.take(rows=part))
            for part in rows
        )
        own = _cut(law.P, widths, graph.neighborhood(i), law.Q)
        agents.append(AgentProgram(plant.names[i], sizes[i], law.Q.nrows, shared, own, input_))
    return Controller(plant.time, "", tuple(agents))


def _cut(matrix: Matrix, widths: Sequence[int], heard: Sequence[int], private: Matrix) -> LinearMap:
    """A map of ȳ_i and z_i, as one of the y_j, of the x_j and of z_i."""
    starts = [sum(widths[:k]) for k in range(len(widths))]
    parts = [
        matrix.take(cols=range(start, start + width))
        for start, width in zip(starts, widths, strict=True)
    ]
    seen = dict(zip(heard, parts[: len(heard)], strict=True))
    shared = dict(zip(heard, parts[len(heard) :], strict=True))
    return LinearMap(seen, shared, private)


def loops_agree(
    plant: MultiChannelSystem,
    made: MultiChannelSystem,
    laws: Sequence[ChannelLaw],
    controller: Controller,
    numbers: Numbers,
) -> bool:
    """Whether the network of agents moves as the extended system under its channel controllers."""
    x_bar = numbers.column(made.n)
    z = [numbers.column(law.Q.nrows) for law in laws]
    y_bar = outputs(made, x_bar)
    ahead = driven(
        made,
        x_bar,
        [law.F @ y + law.G @ z_i for law, y, z_i in zip(laws, y_bar, z, strict=True)],
    )
    z_ahead = [law.P @ y + law.Q @ z_i for law, y, z_i in zip(laws, y_bar, z, strict=True)]
    loop = closed_loop(plant, controller).matrix

    def ordered(x_bar: Matrix, z: Sequence[Matrix]) -> Matrix:
        """x, and then x_i and z_i of one agent after another."""
        parts, at = [x_bar.take(rows=range(plant.n))], plant.n
        for agent, z_i in zip(controller.agents, z, strict=True):
            parts += [x_bar.take(rows=range(at, at + agent.shared)), z_i]
            at += agent.shared
        return stacked(parts)

    return loop @ ordered(x_bar, z) == ordered(ahead, z_ahead)


def equivalence(note: Notebook) -> None:
    """Every controller of the extended system's channels is a distributed one, and conversely."""
    numbers = Numbers(22)
    drawn = (*plants(6, connected=None), *plants(4, time="discrete"))
    for (name, plant), sizes in with_dimensions(drawn):
        note.on(f"{name}, {plant.time} time", plant)
        private = [(size + 1) % 3 for size in sizes]
        made = extended_system(plant, sizes)
        laws = drawn_laws(made, private, numbers)
        controller = as_programs(plant, sizes, laws)
        note.check(
            "the agents' loop is that of the extended system",
            loops_agree(plant, made, laws, controller, numbers),
        )
        entries = sum(part.nrows * part.ncols for law in laws for part in vars(law).values())
        note.check(
            "with as many free entries",
            entries == sum(M.nrows * M.ncols for M in controller.matrices()),
        )
    plant, sizes = three_channels(), [1, 2, 1]
    note.on(PAPER, plant)
    made = extended_system(plant, sizes)
    laws = drawn_laws(made, [1, 0, 2], numbers)
    controller = as_programs(plant, sizes, laws)
    for name, changed in _changed(controller):
        note.refute(name, not loops_agree(plant, made, laws, changed, numbers))


def _changed(controller: Controller) -> Iterator[tuple[str, Controller]]:
    """Agents that use the outputs of others alone, and agents without private states' updates."""

    def alone(each: LinearMap, i: int) -> LinearMap:
        return replace(each, shared={j: M for j, M in each.shared.items() if j == i})

    agents = controller.agents
    outputs_alone = tuple(
        replace(
            agent,
            shared_update=alone(agent.shared_update, i),
            private_update=alone(agent.private_update, i),
            input=alone(agent.input, i),
        )
        for i, agent in enumerate(agents)
    )
    still = tuple(replace(agent, private_update=LinearMap()) for agent in agents)
    yield "outputs-alone", replace(controller, agents=outputs_alone)
    yield "static", replace(controller, agents=still)


PROCEDURES: dict[str, Procedure] = {
    "equivalence": equivalence,
}
