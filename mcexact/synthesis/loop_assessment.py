"""The figures of a design or of a loop, computed for its assessment."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from mcexact.errors import InputError
from mcexact.exact.floats import to_float
from mcexact.exact.location import StabilityRegion
from mcexact.model.controller import Controller
from mcexact.model.loop import ClosedLoop
from mcexact.model.system import MultiChannelSystem, as_plant
from mcexact.synthesis.assessment import Assessment, Link, shown
from mcexact.synthesis.design import Design
from mcexact.synthesis.every_loop import EveryLoop
from mcexact.synthesis.integrated_plant import integrated_plant
from mcexact.synthesis.network.networks import decentralized_network
from mcexact.synthesis.optimum.aims import MARGIN, Aims
from mcexact.synthesis.optimum.diagnosis import Diagnosis, diagnosed
from mcexact.synthesis.optimum.figures import Figures, figures_of
from mcexact.synthesis.optimum.kernel import quiet_floats
from mcexact.synthesis.optimum.loop_figures import (
    digits_that_suffice,
    integrators_of,
    step_peak,
    sure_figures,
)
from mcexact.synthesis.optimum.problem import FeedbackProblem
from mcexact.synthesis.optimum.shape import NO_LIMITS, Shape
from mcexact.synthesis.optimum.weights import Weights

_HARDLY, _NEARLY = 1.02, 0.9


def assess(
    design: Design, aims: Aims | None = None, every_loop: EveryLoop | None = None
) -> Assessment:
    """Compute the figures that say whether to install the controller of a design.

    Parameters
    ----------
    design : Design
    aims : Aims, optional
        Those of the design, for its weights.
    every_loop : EveryLoop, optional
        What is known of all loops within the radii of the plant, if it has some: nobody who knows
        the data to these should install a controller that fails within them.

    Returns
    -------
    Assessment

    Notes
    -----
    In floating point: only what the certificates of the design say is proved.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> from mcexact.synthesis.decentralized import design_decentralized
    >>> plant = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    >>> assess(design_decentralized(plant, rate="1/2")).install
    'yes'
    >>> from mcexact.synthesis.optimum.aims import THEOREM
    >>> rooms = gallery.load("farina-three-rooms")
    >>> assess(design_decentralized(rooms, rate=1, aims=THEOREM)).install
    'no'
    """
    InputError.require(design, Design, "design")
    aims = Aims() if aims is None else aims
    InputError.require(aims, Aims, "aims")
    parts = design.parts.get("designed", design.parts)
    notes = list(design.notes)
    if "blocks" in parts and "diagnosis" in parts:
        notes.append(
            "no search found a controller: this is the one of the theorem, whose dynamics are all "
            "in one agent of each strong component"
        )
    if "observer_gains" in parts and design.order > design.loop.closed.given.m:
        other = "`design setpoint`" if design.name == "setpoint" else "`--order low`"
        notes.append(
            "every agent of a distributed observer estimates the whole state, with "
            f"{design.order} states together: where this is not wanted, {other} tries controllers "
            "of low order over the same links"
        )
    found = assessed_loop(
        design.loop.closed,
        design.region,
        certified=design.stable,
        weights=aims.weights,
        notes=tuple(notes),
        diagnosis=parts.get("diagnosis"),
        shape=(aims or Aims()).shape,
    )
    if design.loop.closed.given.uncertainty is None:
        return found
    return replace(found, within_radii="open" if every_loop is None else every_loop.within_radii)


def assessed_loop(
    loop: ClosedLoop,
    region: StabilityRegion,
    *,
    certified: bool,
    weights: Mapping[str, Any] | None = None,
    notes: tuple[str, ...] = (),
    diagnosis: Diagnosis | None = None,
    shape: Shape = NO_LIMITS,
) -> Assessment:
    """Compute the figures of a closed loop.

    Parameters
    ----------
    loop : ClosedLoop
    region : StabilityRegion
    certified : bool
        Whether it is certified that every eigenvalue lies in the region.
    weights : mapping, optional
        See `Weights.of`.
    notes : tuple of str
    diagnosis : Diagnosis, optional
        That of the plant, with integrators if the controller has them, for the same region.
    shape : Shape
        The limits on the eigenvalues that were aimed at.
    """
    given, places = loop.given, integrators_of(loop)
    about, weighed = as_plant(given), Weights.of(given, weights)
    if places:
        about, weighed = integrated_plant(given), weighed.with_integrators(given)
    known = diagnosis or diagnosed(about, region, weighed)
    with quiet_floats():
        figures = sure_figures(loop, weighed, places)
        alone = None if places else _uncontrolled(given, weighed)
        if certified and alone is not None and alone.cost <= _HARDLY * figures.cost:
            notes = (*notes, _hardly(alone, figures, region))
        return Assessment(
            {agent.name: agent.shared + agent.private for agent in loop.controller.agents},
            region,
            certified,
            figures,
            known,
            digits_that_suffice(loop, region, _kept(figures.margin)) if certified else None,
            _links(loop.controller, given),
            step_peak(loop) if places and certified else None,
            notes,
            shape,
            alone,
        )


def _kept(margin: float) -> float:
    """What rounding has to leave of a margin: enough not to be fragile, or else nearly all."""
    if np.isnan(margin):
        return 0.0
    return MARGIN if margin >= MARGIN else _NEARLY * margin


def _uncontrolled(system: MultiChannelSystem, weights: Weights) -> Figures:
    """The figures of the plant without a controller."""
    network = decentralized_network(as_plant(system))
    problem = FeedbackProblem.of(network, (0,) * system.m, weights)
    return figures_of(problem, np.zeros(problem.mask.shape))


def _hardly(alone: Figures, figures: Figures, region: StabilityRegion) -> str:
    """That a controller hardly improves on none."""
    inside = alone.bound < to_float(region.limit)
    told = f"it satisfies {region}, too" if inside else f"it does not satisfy {region}"
    return (
        f"without a controller the plant has {shown(alone.cost / figures.cost)} times this cost; "
        f"{told}"
    )


def _links(controller: Controller, system: MultiChannelSystem) -> tuple[Link, ...]:
    """The links that a controller uses."""
    found = []
    for j, i in controller.edges():
        maps = [each.without_zeros() for each in controller.agents[i].maps()]
        outputs = any(j in each.outputs for each in maps) * system.q(j)
        shared = any(j in each.shared for each in maps) * controller.agents[j].shared
        if outputs + shared:
            found.append(Link(system.names[j], system.names[i], outputs + shared))
    return tuple(found)
