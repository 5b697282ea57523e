"""Requests: the arguments that all methods of design share, checked before any work."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, get_args

from mcexact.arguments import one_of, telling
from mcexact.errors import UsageError
from mcexact.exact.location import StabilityRegion
from mcexact.model.system import MultiChannelSystem

Arithmetic = Literal["exact", "float"]
Progress = Callable[[str], None]


class Warned(str):
    """The description of a step that a user ought to read before the design ends."""

    __slots__ = ()


@dataclass(frozen=True)
class Request:
    """The arguments that all methods of design share.

    Attributes
    ----------
    region : StabilityRegion
        The region in which every eigenvalue of the loop should lie; without a bound if only a
        spectrum is prescribed.
    agent : int or None
        The position of the agent with the channel controller, from 0.
    spectrum : object
        The prescribed numbers, in the form of the method; None if they are free.
    arithmetic : {"exact", "float"}
    tell : callable
        A function that is called with a short description of each step.
    notes : tuple of str
        What was chosen for the user.
    """

    region: StabilityRegion
    agent: int | None
    spectrum: Any
    arithmetic: Arithmetic
    tell: Progress
    notes: tuple[str, ...] = ()

    @classmethod
    def of(
        cls,
        system: MultiChannelSystem,
        agent: str | None = None,
        spectrum: Any = None,
        rate: Any = None,
        radius: Any = None,
        arithmetic: Arithmetic = "exact",
        progress: Progress | None = None,
    ) -> Request:
        """Check the arguments of a ``design_…`` function.

        Raises
        ------
        UsageError
            If there is no spectrum, rate or radius; if floating point gets a spectrum; if the agent
            or the arithmetic is unknown; if ``progress`` is no function; or as in
            `StabilityRegion.of`.
        """
        region = StabilityRegion.of(system.time, rate, radius)
        if spectrum is None and region.bound is None:
            raise UsageError(
                f"give a {region.word} or a spectrum, which says how fast the loop has to be"
            )
        one_of(arithmetic, get_args(Arithmetic), "arithmetic")
        if arithmetic == "float" and spectrum is not None:
            raise UsageError(
                "a design in floating point takes a rate or a radius; a spectrum needs exact "
                "arithmetic"
            )
        carrier = None if agent is None else system.index(agent)
        return cls(region, carrier, spectrum, arithmetic, telling(progress))
