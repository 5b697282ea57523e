"""Decentralized control: a controller without any message."""

from __future__ import annotations

from typing import Any

from mcexact.errors import UsageError
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.network_candidates import ArithmeticKind, Progress
from mcexact.synthesis.network_design import NetworkDesign, design_network
from mcexact.synthesis.networks import decentralized_network


def design_decentralized(
    system: MultiChannelSystem,
    q: str | None = None,
    *,
    spectrum: Any = None,
    rate: Any = None,
    radius: Any = None,
    arithmetic: ArithmeticKind = "exact",
    progress: Progress | None = None,
) -> NetworkDesign:
    """Design a linear time-invariant controller without communication: u_i is made of y_i alone.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant.  Its neighbor graph is not used.
    q : str, optional
        An agent that is to carry a channel controller; by default those that need the least order.
    spectrum : polynomial, list of roots, or mapping ``{"closed_loop": …}``, optional
        See `design_network`.
    rate, radius : rational, optional
        Every eigenvalue gets real part below −rate (continuous time) or modulus below radius
        (discrete time).
    arithmetic : {"exact", "float"}
        In floating point only a rate or radius can be asked for.
    progress : callable, optional

    Raises
    ------
    Impossible
        If a fixed mode is not fast enough; the certificate is that of the fixed spectrum.  A
        controller that varies with time is not ruled out.

    Examples
    --------
    >>> system = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    >>> design = design_decentralized(system, spectrum=[-1, -2, -3])
    >>> design.order, str(design.kept)
    (1, '1')
    >>> apart = MultiChannelSystem([[1]], [[[1]], [[0]]], [[[0]], [[1]]])
    >>> design_decentralized(apart, rate=1)
    Traceback (most recent call last):
        ...
    mcexact.errors.Impossible: no linear time-invariant decentralized control moves the mode 1, \
fixed by s = {1}, and it is not fast enough
    """
    if system.subject:
        raise UsageError("a controller is designed for a plant, not for a derived system")
    return design_network(
        decentralized_network(system),
        q,
        spectrum=spectrum,
        rate=rate,
        radius=radius,
        arithmetic=arithmetic,
        progress=progress,
    )
