"""The dual system: what is true of control becomes true of observation."""

from __future__ import annotations

from mcexact.model.system import MultiChannelSystem


def dual(system: MultiChannelSystem) -> MultiChannelSystem:
    """Transpose: (A', C_i', B_i') in place of (A, B_i, C_i), without a neighbor graph.

    Parameters
    ----------
    system : MultiChannelSystem

    Returns
    -------
    MultiChannelSystem
        Inputs and outputs of each channel change places.

    Examples
    --------
    >>> system = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    >>> dual(system).B(0).numerators
    ((1,), (0,))
    >>> dual(dual(system)).A == system.A
    True
    """
    return system.derived(
        system.A.T,
        [channel.C.T for channel in system.channels],
        [channel.B.T for channel in system.channels],
        {"construction": "dual"},
    )
