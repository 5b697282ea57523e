"""Which distributed observer in floating point is tried first."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import islice

from mcexact.exact.floats import to_float
from mcexact.exact.location import StabilityRegion
from mcexact.model.loop import closed_loop
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.gate import Proposal
from mcexact.synthesis.optimum.aims import MARGIN
from mcexact.synthesis.optimum.loop_figures import plain_figures

_MARGINS = (Fraction(1, 4), Fraction(1, 16), Fraction(1, 256))
_POWERS, _OF_ONE = (17 / 16, 5 / 4), (0.98, 0.9)
_MUCH_FASTER = 4.0
_EFFORTS = (1.0, 10.0, 100.0)
_SMALL = 60
_SHOWN, _DRAWS = 8, 3


@dataclass(frozen=True)
class Round:
    """Regions for which observers are designed, and how the best of them is found.

    Attributes
    ----------
    targets : tuple of (StabilityRegion, float)
        Each inside the region asked for, with the price of the inputs for the gains F_i.
    ranked : bool
        Whether the figures of the loops decide which of all the observers is proposed first.
    """

    targets: tuple[tuple[StabilityRegion, float], ...]
    ranked: bool = False

    @property
    def draws(self) -> int | None:
        """The largest number of draws of observer gains for each target; None without a limit."""
        return _DRAWS if self.ranked else None


def rounds(region: StabilityRegion, errors: int) -> Iterator[Round]:
    """Yield the rounds of a search, the most promising first.

    Parameters
    ----------
    region : StabilityRegion
    errors : int
        The dimension of the error system.

    Notes
    -----
    In discrete time a part of the radius would make a loop much faster than asked, so that the
    targets are powers of it.  Dear inputs make F_i that leave slow modes as slow as is asked.

    Examples
    --------
    >>> first, *_ = rounds(StabilityRegion.of("discrete", radius="0.99"), 27)
    >>> [str(target.bound) for target, price in first.targets if price == 1]
    ['98937/100000', '98751/100000']
    """
    if region.discrete:
        edge = to_float(region.edge)
        radii = _OF_ONE if edge == 1.0 else tuple(edge**power for power in _POWERS)
        targets = [
            (StabilityRegion.of(region.time, bound=bound), price)
            for bound in (Fraction(int(1e5 * radius), 10**5) for radius in radii)
            for price in _EFFORTS
            if 0 < bound < region.edge
        ]
        small = errors <= _SMALL
        if targets:
            # Without a comparison, a price in the middle.
            yield Round(tuple(targets if small else targets[1:2]), ranked=small)
    for margin in _MARGINS:
        yield Round(((region.tightened(margin), 1.0),))


def honors(region: StabilityRegion, bound: float) -> bool:
    """Whether a loop is about as slow as asked: its slowest eigenvalue has a modulus above ρ⁴.

    Every loop is in continuous time, and for a radius of 1, which asks for no rate.

    Examples
    --------
    >>> asked = StabilityRegion.of("discrete", radius="0.99")
    >>> honors(asked, 0.98), honors(asked, 0.9)
    (True, False)
    """
    return not region.discrete or region.edge >= 1 or bound >= to_float(region.edge) ** _MUCH_FASTER


def most_promising(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    region: StabilityRegion,
    proposals: Iterable[Proposal],
    *,
    by_order: bool = True,
) -> Iterator[Proposal]:
    """Yield proposals, the first of them sorted by order, margin, radius and cost.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph
    region : StabilityRegion
        In discrete time loops that `honors` accepts come first.
    proposals : iterable of Proposal
        Of these the first 8 are compared.
    by_order : bool
        Whether the order counts.
    """
    rest = iter(proposals)

    def rank(each: Proposal) -> tuple[int, bool, bool, float]:
        seen = plain_figures(closed_loop(system, each.controller, graph))
        order = each.controller.order if by_order else 0
        if not seen.margin >= MARGIN:
            return order, True, True, -seen.margin
        return order, False, not honors(region, seen.bound), seen.cost

    yield from sorted(islice(rest, _SHOWN), key=rank)
    yield from rest
