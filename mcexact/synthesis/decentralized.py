"""Decentralized control, without communication."""

from __future__ import annotations

from typing import Any

from mcexact.errors import InputError
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.asking import request_for
from mcexact.synthesis.design import Design
from mcexact.synthesis.network.network_design import network_design
from mcexact.synthesis.network.networks import decentralized_network
from mcexact.synthesis.optimum.aims import Aims
from mcexact.synthesis.optimum.proposals import searched_proposals
from mcexact.synthesis.optimum.structures import Family
from mcexact.synthesis.request import Arithmetic, Progress, Request
from mcexact.synthesis.slowing import at_a_robust_rate


def design_decentralized(
    system: MultiChannelSystem,
    agent: str | None = None,
    *,
    spectrum: Any = None,
    rate: Any = None,
    radius: Any = None,
    arithmetic: Arithmetic = "exact",
    aims: Aims | None = None,
    progress: Progress | None = None,
) -> Design:
    """Design a linear time-invariant controller without communication: u_i depends on y_i alone.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant or a derived system, whose neighbor graph is not used.
    agent : str, optional
        The agent with the channel controller of the theorem, which is then constructed without a
        search.
    spectrum : polynomial, list of roots, or mapping ``{"closed_loop": …}``, optional
        A spectrum to be placed exactly by the controller of the theorem; see `network_proposals`.
    rate, radius : rational, optional
        Every eigenvalue gets real part below −rate (continuous time) or modulus below radius
        (discrete time).  Without a spectrum, the default is half the sensible rate, or less if that
        leads to a fragile loop.
    arithmetic : {"exact", "float"}
        The arithmetic of the theorem's controller.  Floating point takes no spectrum.
    aims : Aims, optional
        What the search aims at.
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
    LimitReached
        If no controller was found, or already the rate is out of reach for all agents together
        (`OutOfReach`); the message names the mode that is nearest to being fixed, and the sensible
        rate.

    Notes
    -----
    For a rate or a radius, static gains and then controllers of low order are searched by local
    descent, in floating point, and rounded to few digits (`searched_proposals`).  The controller of
    the theorem, whose dynamics are all in one agent of a strong component and which often is
    fragile, is the last resort.  `assess` tells what a controller is good for.

    Examples
    --------
    >>> system = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    >>> design = design_decentralized(system, spectrum=[-1, -2, -3])
    >>> design.order, str(design.parts["kept"])
    (1, '1')
    >>> design_decentralized(system, rate="1/2").parts["optimum"].digits <= 4
    True
    >>> apart = MultiChannelSystem([[1]], [[[1]], [[0]]], [[[0]], [[1]]])
    >>> design_decentralized(apart, rate=1)
    Traceback (most recent call last):
        ...
    mcexact.errors.Impossible: no linear time-invariant decentralized control moves the mode 1, \
which channel 2 does not control and channel 1 does not observe, and it is not fast enough
    """
    InputError.require(system, MultiChannelSystem, "system")
    given = system, agent, spectrum, rate, radius, arithmetic, progress
    request = request_for(*given, aims=aims, avoids_fixed_modes=True)
    network = decentralized_network(system)

    def attempt(asked: Request) -> Design:
        proposals = searched_proposals(Family(network), asked, aims)
        return network_design("decentralized", network, asked, proposals)

    return at_a_robust_rate(request, attempt)
