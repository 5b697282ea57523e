"""How many digits of a controller's entries are enough, whichever way they are rounded."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from mcexact.analysis.boxes.box_stable import box_stability
from mcexact.analysis.boxes.gain_radii import digit_radii
from mcexact.answer.box_stable import BoxStability
from mcexact.answer.stability import StabilityVerdict
from mcexact.errors import LimitReached
from mcexact.exact.location import StabilityRegion
from mcexact.model.controller import Controller
from mcexact.model.loop import closed_loop
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.unsafe_rounding import unsafe_rounding


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
        The largest number of digits for which a rounding was found that fails; None if none was.
    rounded : Controller or None
        The controller that is rounded so.
    refutation : StabilityVerdict or None
        The exact verdict on its loop.
    """

    safe: int | None
    proof: BoxStability | None
    unsafe: int | None
    rounded: Controller | None
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
    All numbers to which an entry is rounded, up or down, are in a box, about which `box_stability`
    has a proof.  `unsafe_rounding` searches a rounding with which the loop fails, which is decided
    exactly; between the two numbers of digits nothing is known.

    Examples
    --------
    >>> from mcexact.model.local_controllers import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> found = safe_digits(plant, local_controllers(plant, [[["-1.04"]]]))
    >>> found.safe, found.unsafe
    (3, 2)
    """
    given: dict[str, Any] = {"rate": rate, "radius": radius}
    loop = closed_loop(system, controller, graph)
    region = StabilityRegion.of(system.time, rate, radius)
    unsafe, found = 0, None
    for digits in range(most, 0, -1):
        found = unsafe_rounding(loop, digits, region)
        if found is not None:
            unsafe = digits
            break
    for digits in range(unsafe + 1, most + 1):
        try:
            gains = digit_radii(controller, digits)
            proof = box_stability(system, controller, graph, gains=gains, **given)
        except LimitReached:
            continue
        return SafeDigits(digits, proof, unsafe or None, *(found or (None, None)))
    return SafeDigits(None, None, unsafe or None, *(found or (None, None)))
