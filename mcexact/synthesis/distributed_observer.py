"""`design_observer` designs the distributed observer of Theorem 1 as m certified agent programs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal

from mcexact.derived.feedback import checked_gains
from mcexact.errors import InputError, LimitReached
from mcexact.exact.floats import Rounding
from mcexact.model.linked_system import with_graph
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.agreeing_observer import observers
from mcexact.synthesis.asking import request_for
from mcexact.synthesis.design import Design, designed
from mcexact.synthesis.optimum.diagnosis import with_diagnosis
from mcexact.synthesis.request import Arithmetic, Progress


def design_observer(
    system: MultiChannelSystem,
    graph: NeighborGraph | None = None,
    agent: str | None = None,
    *,
    spectrum: Mapping[str, Any] | None = None,
    rate: Any = None,
    radius: Any = None,
    gains: Sequence[Any] | None = None,
    order: Literal["least"] | None = None,
    rounding: Rounding | None = None,
    arithmetic: Arithmetic = "exact",
    progress: Progress | None = None,
) -> Design:
    """Design a distributed observer-based controller, with a proof of its closed-loop spectrum.

    Parameters
    ----------
    system : MultiChannelSystem
        A jointly controllable and observable plant or derived system, with n states and m channels.
    graph : NeighborGraph, optional
        A graph without delays; overrides ``system.neighbors``.
    agent : str, optional
        The agent that carries the channel controller; by default the first, in floating point and
        continuous time none if a loop without one is robust.
    spectrum : mapping, optional
        ``{"feedback": P, "error": P}``: n numbers for A + Σ B_i F_i and mn + m − 1 for the error
        system, see `spectrum_polynomial`.
    rate, radius : rational, optional
        A rate or radius to be certified, instead of a spectrum or in addition to it: every
        eigenvalue has real part below −rate (continuous time), or modulus below radius (discrete
        time).  Without a spectrum, the default is half the sensible rate.
    gains : sequence of m matrices, optional
        Given F_i (p_i×n); then ``spectrum`` has no ``"feedback"``.  With F_i = 0 this is the
        open-loop observer of section II-B, whose agents estimate the state and do not act.
    order : {"least"}, optional
        Use a channel controller of order one less than the smaller of the two indices, instead of m
        − 1.  In floating point, use an observer of reduced order instead of nm, if it can be
        certified.
    rounding : {"decimal", "dyadic"}, optional
        How floats in ``gains`` become exact; see `MultiChannelSystem.from_float`.
    arithmetic : {"exact", "float"}
        "exact" assigns the whole spectrum, for small systems.  "float" designs for a rate or a
        radius, with a proof that is exact as well (`float_proposals`).
    progress : callable, optional
        Is told, in a few words, what is being done.

    Returns
    -------
    Design
        See its ``parts``; agent i shares its estimate x_i of the state.

    Raises
    ------
    Impossible
        If all channels together do not control or do not observe a mode, or the error system for
        these F_i has a fixed mode or a cut; the certificate proves this.
    InputError
        If a spectrum has the wrong length; the message states the right one; or if gains are given
        that are not m matrices of p_i rows and n columns.
    LimitReached
        If no observer was found, or none could be certified; the message tells the mode that is
        nearest to being fixed, and the sensible rate.
    UsageError
        If a spectrum, rate and radius contradict each other, or the graph has delays.

    Notes
    -----
    Exact; paper, section II and Theorem 1.  F_i by state feedback; small K_i, H_ij with which
    channel q controls the error system with index m and observes it, and its matrix is cyclic; then
    the Brasch–Pearson controller.  Of several draws the one with the shortest numbers is kept.  The
    certificate (`proofs/distributed_observer.md`) contains the controller and proves the separation
    and both polynomials.  A strongly connected graph is sufficient, but not necessary, since the
    question is decided for the error system itself.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1]], [[[1]], [[0]]], [[[0]], [[1]]],
    ...                            neighbors={"1": ["2"], "2": ["1"]})
    >>> design = design_observer(plant, spectrum={"feedback": [-1], "error": [-1, -2, -3]})
    >>> str(design.parts["error_polynomial"])
    'x^3 + 6*x^2 + 11*x + 6'
    >>> design_observer(plant, {"1": [], "2": []}, rate=1)
    Traceback (most recent call last):
        ...
    mcexact.errors.Impossible: the error system for these F_i is not complete: no constant K_i, \
H_ij let one agent control and observe all estimation errors
    """
    InputError.require(system, MultiChannelSystem, "system")
    system, graph = with_graph(system, graph)
    request = request_for(system, agent, spectrum, rate, radius, arithmetic, progress)
    sizes = [system.n] * system.m
    exact = None if gains is None else checked_gains(system, gains, sizes, rounding=rounding)
    proposals = observers(system, graph, request, gains=exact, order=order)
    try:
        return designed("observer", request, system, graph, proposals)
    except LimitReached as limit:
        raise with_diagnosis(limit, system, request.region) from None
