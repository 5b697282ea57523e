"""Networks derived from a plant, and agent programs of their decentralized controllers."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from mcexact.derived.delayed import held_system, lifted_system
from mcexact.derived.extended import Share, extended_system
from mcexact.errors import UsageError
from mcexact.exact.matrix import Matrix
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.methods import ChannelController

NetworkKind = Literal["decentralized", "extended", "lifted", "held"]

Signal = tuple[Literal["y", "x"], int]


@dataclass(frozen=True)
class DerivedNetwork:
    """A plant with the dimensions that its agents share, and the resulting multi-channel system.

    Attributes
    ----------
    kind : {"decentralized", "extended", "lifted", "held"}
    given : MultiChannelSystem
        The plant or derived system on which the agents run.
    graph : NeighborGraph or None
        None if no signals are sent.
    dimensions : tuple of int
        n_1 … n_m.
    system : MultiChannelSystem
        The system whose decentralized controllers are the distributed controllers of the given one.
    signals : tuple
        The signals that each agent receives, in the order of its outputs: ("y", j) or ("x", j).
    """

    kind: NetworkKind
    given: MultiChannelSystem
    graph: NeighborGraph | None
    dimensions: tuple[int, ...]
    system: MultiChannelSystem
    signals: tuple[tuple[Signal, ...], ...]

    def size(self, signal: Signal) -> int:
        """The dimension of a signal."""
        what, j = signal
        return self.given.q(j) if what == "y" else self.dimensions[j]

    def holds(self, j: int) -> dict[int, int]:
        """The number of steps for which agent j holds x_j, for each follower and for itself."""
        if self.kind != "held" or self.graph is None or not self.dimensions[j]:
            return {}
        longest = self.graph.longest_delay(j)
        held = {i: longest - (self.graph.delay(i, j) if i != j else 0) for i in self._hearers(j)}
        return {i: steps for i, steps in held.items() if steps}

    def _hearers(self, j: int) -> list[int]:
        return [i for i, seen in enumerate(self.signals) if ("x", j) in seen]

    def split(self, i: int, gains: Matrix) -> LinearMap:
        """Split gains of ȳ_i by the signals that they multiply.

        Parameters
        ----------
        i : int
        gains : Matrix
            Its columns belong to the signals of agent i, in their order.

        Returns
        -------
        LinearMap
            The blocks of columns of each y_j and x_j, without those that are 0.
        """
        maps: dict[str, dict[int, Matrix]] = {"y": {}, "x": {}}
        start = 0
        for what, j in self.signals[i]:
            stop = start + self.size((what, j))
            maps[what][j] = gains.take(cols=range(start, stop))
            start = stop
        return LinearMap(maps["y"], maps["x"]).without_zeros()


def decentralized_network(system: MultiChannelSystem) -> DerivedNetwork:
    """Return the plant as a network in which agent i receives y_i alone."""
    signals: tuple[tuple[Signal, ...], ...] = tuple((("y", i),) for i in range(system.m))
    return DerivedNetwork("decentralized", system, None, (0,) * system.m, system, signals)


def shared_network(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    dimensions: Sequence[int],
    share: Share,
    kind: NetworkKind,
) -> DerivedNetwork:
    """Return the extended, lifted or held system for some dimensions.

    Raises
    ------
    UsageError
        If the links have delays and the kind does not, or outputs should be sent and held.
    """
    own_only = kind == "held" or share == "states"
    if kind == "held" and share != "states":
        raise UsageError('with holding, agents send sub-states only: share must be "states"')
    if kind == "extended" and graph.delays:
        raise UsageError('the links have delays: choose the network "lifted" or "held"')
    if kind == "held":
        derived = held_system(system, dimensions, graph)
    else:
        builder: Callable[..., MultiChannelSystem]
        builder = lifted_system if kind == "lifted" else extended_system
        derived = builder(system, dimensions, share, graph)
    signals = []
    for i in range(system.m):
        heard = graph.neighborhood(i)
        measured = [i] if own_only else list(heard)
        if kind == "lifted":
            measured.sort(key=lambda j: (graph.delay(i, j) > 0, j))
        seen: list[Signal] = [("y", j) for j in measured]
        signals.append((*seen, *(("x", j) for j in heard)))
    return DerivedNetwork(kind, system, graph, tuple(dimensions), derived, tuple(signals))


def network_programs(
    network: DerivedNetwork,
    gains: Sequence[Matrix],
    channels: Mapping[int, ChannelController],
) -> Controller:
    """Write the agent programs for ū_i = F̄_i ȳ_i, with channel controllers at some agents.

    Parameters
    ----------
    network : DerivedNetwork
    gains : sequence of Matrix
        F̄_i, (p_i + n_i) × the size of ȳ_i; ū_i = (u_i, v_i) and v_i updates x_i.
    channels : mapping of int to ChannelController
        ż = Az + Bȳ_q, with Cz + Dȳ_q added to ū_q.

    Notes
    -----
    Paper, sections IV-C to IV-E and V.  Delays belong to the links and holding to the agents, so
    programs contain no matrix of the lifted system.
    """
    given, programs = network.given, []
    for i in range(given.m):
        p_i, made = given.p(i), channels.get(i)
        F = gains[i] if made is None else gains[i] + made.D
        k = 0 if made is None else made.order
        upper, lower = range(p_i), range(p_i, F.nrows)
        used = [network.split(i, F.take(rows=rows)) for rows in (upper, lower)]
        own: list[Matrix | None] = [None, None]
        update = LinearMap()
        if made is not None and k:
            own = [made.C.take(rows=upper), made.C.take(rows=lower)]
            driven = network.split(i, made.B)
            update = LinearMap(driven.outputs, driven.shared, made.A).without_zeros()
        inputs, shared = (
            LinearMap(each.outputs, each.shared, z).without_zeros()
            for each, z in zip(used, own, strict=True)
        )
        programs.append(
            AgentProgram(
                given.names[i], network.dimensions[i], k, shared, update, inputs, network.holds(i)
            )
        )
    return Controller(given.time, given.digest_of_values(), tuple(programs))
