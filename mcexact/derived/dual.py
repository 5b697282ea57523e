"""The dual system, in which controllability becomes observability."""

from __future__ import annotations

from mcexact.errors import InputError
from mcexact.model.system import MultiChannelSystem


def dual(system: MultiChannelSystem) -> MultiChannelSystem:
    """Return the system (A', C_i', B_i'), without a neighbor graph.

    Parameters
    ----------
    system : MultiChannelSystem

    Returns
    -------
    MultiChannelSystem
        The inputs of each channel correspond to its outputs in the given system, and conversely.

    Examples
    --------
    >>> system = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    >>> dual(system).B(0).numerators
    ((1,), (0,))
    >>> dual(dual(system)).A == system.A
    True
    """
    InputError.require(system, MultiChannelSystem, "system")
    return system.derived(
        system.A.T,
        [channel.C.T for channel in system.channels],
        [channel.B.T for channel in system.channels],
        {"construction": "dual"},
    )
