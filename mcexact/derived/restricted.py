"""The plant with some of its channels alone."""

from __future__ import annotations

from collections.abc import Sequence

from mcexact.errors import InputError, UsageError
from mcexact.model.system import MultiChannelSystem


def restricted(system: MultiChannelSystem, channels: Sequence[str]) -> MultiChannelSystem:
    """Leave out all channels but these: nobody sets the other inputs or measures the other outputs.

    Parameters
    ----------
    system : MultiChannelSystem
    channels : sequence of str
        Names of channels, at least one.

    Returns
    -------
    MultiChannelSystem
        (A, B_i, C_i), i among the channels, in the order of the system, without a neighbor graph.

    Raises
    ------
    UsageError
        If there is no channel, or a name is unknown.

    Notes
    -----
    A controller of the result is one of the plant that does nothing at the other channels, so every
    fixed mode of the plant is one of the result.

    Examples
    --------
    >>> system = MultiChannelSystem([[0]], [[[1]], [[2]]], [[[3]], [[4]]], names=["left", "right"])
    >>> restricted(system, ["right"])
    MultiChannelSystem(n=1, m=1, continuous time, channels: 'right', restricted)
    >>> restricted(system, [])
    Traceback (most recent call last):
        ...
    mcexact.errors.UsageError: channels: expected at least one channel, found none
    """
    InputError.require(system, MultiChannelSystem, "system")
    chosen = system.indices(channels)
    if not chosen:
        raise UsageError("expected at least one channel, found none", where="channels")
    names = list(system.named(chosen))
    return system.derived(
        system.A,
        [system.B[i] for i in chosen],
        [system.C[i] for i in chosen],
        {"construction": "restricted", "channels": names},
        names=names,
    )
