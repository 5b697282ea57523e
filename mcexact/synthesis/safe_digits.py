"""How many digits of a controller's entries are enough, whichever way they are rounded."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from mcexact.analysis.boxes.box_stable import box_stability, digit_radii
from mcexact.answer.box_stable import BoxStability
from mcexact.answer.stability import StabilityVerdict
from mcexact.errors import LimitReached
from mcexact.model.controller import Controller
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.certify import certify_controller


@dataclass(frozen=True)
class SafeDigits:
    """The digits that are enough, and those that are too few.

    Attributes
    ----------
    safe : int or None
        With so many significant digits every rounding of the entries is certified; None if that was
        proved for no number of digits up to the one asked for.
    proof : BoxStability or None
    unsafe : int or None
        The largest number of digits with which rounding to the nearest fails; None if there is
        none.
    refutation : StabilityVerdict or None
    """

    safe: int | None
    proof: BoxStability | None
    unsafe: int | None
    refutation: StabilityVerdict | None


def safe_digits(
    system: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None = None,
    *,
    rate: Any = None,
    radius: Any = None,
    most: int = 6,
) -> SafeDigits:
    """Find the fewest digits of a controller's entries that keep every loop in a region.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant; with radii, all plants within them are meant.
    controller : Controller
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    rate, radius : rational, optional
        A rate in continuous time, a radius in discrete time; by default stability is meant.
    most : int
        The largest number of digits that is tried.

    Notes
    -----
    All gains within half a unit of the last digit are a box, about which `box_stability` has a
    proof.  A failure is an exact decision about the gains rounded to the nearest.

    Examples
    --------
    >>> from mcexact.model.local_controllers import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> found = safe_digits(plant, local_controllers(plant, [[["-1.04"]]]))
    >>> found.safe, found.unsafe
    (3, 2)
    """
    region = {"rate": rate, "radius": radius}
    unsafe, refutation = None, None
    for digits in range(most, 0, -1):
        verdict = certify_controller(system, controller, graph, round_gains=digits, **region)
        if not verdict.stable:
            unsafe, refutation = digits, verdict
            break
    for digits in range((unsafe or 0) + 1, most + 1):
        try:
            gains = digit_radii(controller, digits)
            proof = box_stability(system, controller, graph, gains=gains, **region)
        except LimitReached:
            continue
        return SafeDigits(digits, proof, unsafe, refutation)
    return SafeDigits(None, None, unsafe, refutation)
