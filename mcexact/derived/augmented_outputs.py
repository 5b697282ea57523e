"""The system in which each agent also receives its neighbors' measured outputs."""

from __future__ import annotations

from mcexact.errors import InputError
from mcexact.model.linked_system import with_graph
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem


def augmented_outputs(
    system: MultiChannelSystem, graph: NeighborGraph | None = None
) -> MultiChannelSystem:
    """Replace every C_i by C_{N_i}, the rows of C_j, j ∈ N_i, in the order of the channels.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.

    Returns
    -------
    MultiChannelSystem
        (A, B_i, C_{N_i}); a fixed mode of it cannot be moved by any linear time-invariant
        distributed controller whose agents send nothing but their measured outputs.  (Paper,
        section IV-B, equation `mss`.)

    Raises
    ------
    UsageError
        If there is no neighbor graph.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> plant = gallery.load("liu2020-3ch-no-communication")
    >>> cyclic = NeighborGraph.ring(plant.names)
    >>> augmented_outputs(plant, cyclic).C(1).numerators
    ((0, 1, 0), (0, 1, 0))
    >>> augmented_outputs(plant)
    Traceback (most recent call last):
        ...
    mcexact.errors.UsageError: a neighbor graph is needed, and the system has none: add 'neighbors'
        to it
    """
    InputError.require(system, MultiChannelSystem, "system")
    system, found = with_graph(system, graph)
    return system.derived(
        system.A,
        [channel.B for channel in system.channels],
        [system.output_matrix(found.neighborhood(i)) for i in range(system.m)],
        {"construction": "augmented_outputs"},
        neighbors=found,
    )
