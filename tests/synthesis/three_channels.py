"""The paper's three-channel example over its cyclic graph, in either time domain."""

from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem

CYCLE = {"1": ["2"], "2": ["3"], "3": ["1"]}


def three_channels(time: str = "continuous") -> MultiChannelSystem:
    """A, B, C of section IV-B; N_1 = {1, 2}, N_2 = {2, 3}, N_3 = {3, 1}."""
    plant = gallery.load("liu2020-3ch-no-communication")
    return MultiChannelSystem(
        plant.A,
        [channel.B for channel in plant.channels],
        [channel.C for channel in plant.channels],
        time=time,
        neighbors=NeighborGraph.from_names(plant.names, CYCLE),
    )
