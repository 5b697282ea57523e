"""Small plants, in both time domains, and the networks of the structures of control."""

from __future__ import annotations

from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.networks import DerivedNetwork, decentralized_network, shared_network

NAMES = ("1", "2", "3")


def coupled(time: str = "continuous") -> MultiChannelSystem:
    """Three coupled agents of one or two states, with entries that floats hold."""
    A = [
        ["-1/2", "1/4", 0, "1/8"],
        [0, "1/4", "1/2", 0],
        ["1/4", 0, "-1/4", "1/4"],
        [0, "1/8", "1/4", "1/2"],
    ]
    B = [[[1], [0], [0], [0]], [[0], [1], ["1/2"], [0]], [[0], [0], [0], [1]]]
    C = [[[1, "1/2", 0, 0]], [[0, 1, 0, 0], [0, 0, 1, 0]], [[0, 0, "1/4", 1]]]
    return MultiChannelSystem(A, B, C, time=time, neighbors=NeighborGraph.ring(NAMES))


def delayed() -> MultiChannelSystem:
    """The plant in discrete time, with links of delays 0, 1 and 2."""
    graph = NeighborGraph.from_names(
        NAMES, {"1": ["3"], "2": ["1"], "3": ["2"]}, {"1": {"3": 2}, "2": {"1": 1}}
    )
    return coupled("discrete").with_neighbors(graph)


def networks() -> dict[str, DerivedNetwork]:
    """A network of each kind."""
    moving, sampled, late = coupled(), coupled("discrete"), delayed()
    graphs = {id(each): each.neighbors for each in (moving, sampled, late)}

    def shared(plant: MultiChannelSystem, share: str, kind: str) -> DerivedNetwork:
        graph = graphs[id(plant)]
        assert graph is not None
        return shared_network(plant, graph, (1, 0, 2), share, kind)  # type: ignore[arg-type]

    return {
        "decentralized": decentralized_network(moving),
        "decentralized, discrete": decentralized_network(sampled),
        "extended": shared(moving, "outputs+states", "extended"),
        "extended, states": shared(sampled, "states", "extended"),
        "lifted": shared(late, "outputs+states", "lifted"),
        "held": shared(late, "states", "held"),
    }
