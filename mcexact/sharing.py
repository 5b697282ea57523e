"""What agents have to share so that no mode stays fixed: arcs, numbers of signals, bounds.

    >>> import mcexact
    >>> from mcexact.sharing import common_dimension
    >>> plant = mcexact.gallery("liu2020-3ch-no-communication")
    >>> common_dimension(plant, mcexact.NeighborGraph.ring(plant.names)).dimension
    1

`mcexact.minimal_communication` finds the least arcs.
"""

from mcexact.analysis.sharing import (
    common_dimension,
    minimal_shared_dimensions,
    neighbor_graph,
    shared_dimension_bound,
)
from mcexact.analysis.sharing_gap import extremal_plant, sharing_gap
from mcexact.answer.sharing import (
    CommonDimension,
    Deficiency,
    MinimalCommunication,
    NeighborGraphVerdict,
    SharedDimensions,
)
from mcexact.answer.sharing_gap import SharingGap

__all__ = [
    "CommonDimension",
    "Deficiency",
    "MinimalCommunication",
    "NeighborGraphVerdict",
    "SharedDimensions",
    "SharingGap",
    "common_dimension",
    "extremal_plant",
    "minimal_shared_dimensions",
    "neighbor_graph",
    "shared_dimension_bound",
    "sharing_gap",
]
