"""What a search for a controller aims at, besides the rate or the radius."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite
from numbers import Real
from typing import Any

from mcexact.arguments import require_seconds, told
from mcexact.errors import UsageError
from mcexact.exact.floats import as_requested, to_float
from mcexact.exact.rational import Entry
from mcexact.synthesis.optimum.shape import Shape
from mcexact.synthesis.request import Request

MARGIN = 0.3
SEEDS = 4


@dataclass(frozen=True)
class Aims:
    """What a search for a controller aims at.

    Of this only a damping ratio and a largest modulus in continuous time are certified: then no
    controller without them is a design.

    Parameters
    ----------
    weights : mapping of {"Q", "R", "W", "V"} to matrix, optional
        See `Weights.of`; by default Q = R = W = I and V = I/100.
    margin : float
        The margin at the inputs of the plant, which the search raises to this if it can.
    largest_gain : float, optional
        The largest entry that is not penalized; by default ten times that of the optimal controller
        of all agents together.
    largest_order : int, optional
        The largest number of states of each agent.
    damping : rational or float, optional
        The least damping ratio of an eigenvalue, −Re s/|s| for s = λ or in discrete time log λ,
        where it is aimed at and not certified.
    largest_modulus : rational or float, optional
        The largest modulus of an eigenvalue, in continuous time.
    digits : int, optional
        The largest number of significant decimal digits of an entry.
    effort : float, optional
        About how many seconds a processor of 2024 may search for each rate that is tried, one if
        a rate is given and else up to three.  Work is counted, not timed, so that the result does
        not depend on the machine's load.  With 0 there is no search, but the
        controller of the theorem at once.
    seeds : int
        The number of drawn starts of each order.

    Raises
    ------
    UsageError
        If a number is out of range.

    Examples
    --------
    >>> Aims(margin=0.4, digits=3).largest_order
    >>> Aims(margin=2)
    Traceback (most recent call last):
        ...
    mcexact.errors.UsageError: margin: expected a number above 0 and below 1, found 2
    """

    weights: Mapping[str, Any] | None = None
    margin: float = MARGIN
    largest_gain: float | None = None
    largest_order: int | None = None
    damping: Entry | None = None
    largest_modulus: Entry | None = None
    digits: int | None = None
    effort: float | None = None
    seeds: int = SEEDS

    def __post_init__(self) -> None:
        for name in ("margin", "largest_gain", "damping", "largest_modulus"):
            number = getattr(self, name)
            if isinstance(number, bool) or not isinstance(number, Real):
                _require(number is None and name != "margin", name, "a number", told(number))
        _require(0 < self.margin < 1, "margin", "a number above 0 and below 1", self.margin)
        if self.largest_gain is not None:
            good = 0 < self.largest_gain and isfinite(self.largest_gain)
            _require(good, "largest_gain", "a number above 0", self.largest_gain)
        if self.damping is not None:
            object.__setattr__(self, "damping", as_requested(self.damping, where="damping"))
            good = 0 < _number(self.damping) < 1
            _require(good, "damping", "a number above 0 and below 1", self.damping)
        if self.largest_modulus is not None:
            most = as_requested(self.largest_modulus, where="largest_modulus")
            object.__setattr__(self, "largest_modulus", most)
            good = 0 < _number(self.largest_modulus)
            _require(good, "largest_modulus", "a number above 0", self.largest_modulus)
        for name, least in (("largest_order", 0), ("digits", 1), ("seeds", 1)):
            number = getattr(self, name)
            if number is not None:
                good = type(number) is int and number >= least
                _require(good, name, f"an integer of at least {least}", number)
        if self.effort is not None:
            require_seconds(self.effort, "effort")

    def searched_for(self, request: Request) -> bool:
        """Whether there is a search: no spectrum, no agent with a channel controller, effort."""
        return request.spectrum is None and request.agent is None and self.effort != 0

    @property
    def shape(self) -> Shape:
        """The limits on the eigenvalues."""
        limits = (self.damping, self.largest_modulus)
        return Shape(*(None if limit is None else _number(limit) for limit in limits))


def _number(limit: Entry) -> float:
    return to_float(as_requested(limit))


def _require(good: bool, name: str, expected: str, found: object) -> None:
    if not good:
        raise UsageError(f"expected {expected}, found {found}", where=name)


THEOREM = Aims(effort=0)
"""No search: the controller of the theorem."""
