"""Decentralized control, without communication."""

from __future__ import annotations

from typing import Any

from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.design import Design
from mcexact.synthesis.network.network_design import network_design
from mcexact.synthesis.network.networks import decentralized_network
from mcexact.synthesis.request import Arithmetic, Progress, Request


def design_decentralized(
    system: MultiChannelSystem,
    agent: str | None = None,
    *,
    spectrum: Any = None,
    rate: Any = None,
    radius: Any = None,
    arithmetic: Arithmetic = "exact",
    progress: Progress | None = None,
) -> Design:
    """Design a linear time-invariant controller without communication: u_i depends on y_i alone.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant or a derived system, whose neighbor graph is not used.
    agent : str, optional
        The agent with a channel controller; by default those that need the least order.
    spectrum : polynomial, list of roots, or mapping ``{"closed_loop": …}``, optional
        See `network_proposals`.
    rate, radius : rational, optional
        Every eigenvalue gets real part below −rate (continuous time) or modulus below radius
        (discrete time).
    arithmetic : {"exact", "float"}
        Floating point needs a rate or a radius instead of a spectrum.
    progress : callable, optional

    Returns
    -------
    Design
        See its ``parts``.

    Raises
    ------
    Impossible
        If a fixed mode is not fast enough; the certificate is that of the fixed spectrum.
        Controllers that vary with time are not excluded.

    Examples
    --------
    >>> system = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    >>> design = design_decentralized(system, spectrum=[-1, -2, -3])
    >>> design.order, str(design.parts["kept"])
    (1, '1')
    >>> apart = MultiChannelSystem([[1]], [[[1]], [[0]]], [[[0]], [[1]]])
    >>> design_decentralized(apart, rate=1)
    Traceback (most recent call last):
        ...
    mcexact.errors.Impossible: no linear time-invariant decentralized control moves the mode 1, \
fixed by s = {1}, and it is not fast enough
    """
    request = Request.of(system, agent, spectrum, rate, radius, arithmetic, progress)
    return network_design("decentralized", decentralized_network(system), request)
