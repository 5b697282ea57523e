"""What is asked of a design, whatever its method; checked before any work."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from mcexact.errors import UsageError
from mcexact.exact.location import StabilityRegion
from mcexact.model.system import MultiChannelSystem

Arithmetic = Literal["exact", "float"]
Progress = Callable[[str], None]


@dataclass(frozen=True)
class Request:
    """The part of the arguments that all methods of design share.

    Attributes
    ----------
    region : StabilityRegion
        Where every eigenvalue of the loop is asked to lie; without a bound if a spectrum is
        prescribed and nothing else.
    agent : int or None
        Who is to carry the channel controller, counted from 0.
    spectrum : object
        The prescribed numbers, in the form of the method; None if they are free.
    arithmetic : {"exact", "float"}
    tell : callable
        Is told, in a few words, what is being done.
    """

    region: StabilityRegion
    agent: int | None
    spectrum: Any
    arithmetic: Arithmetic
    tell: Progress

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
            If there is neither a spectrum nor a rate or radius, a spectrum in floating point, no
            such agent or arithmetic; or as in `StabilityRegion.of`.
        """
        region = StabilityRegion.of(system.time, rate, radius)
        if spectrum is None and region.bound is None:
            raise UsageError(
                f"give a {region.word} or a spectrum: nothing says how fast the loop must be"
            )
        if arithmetic not in ("exact", "float"):
            raise UsageError(
                f'expected "exact" or "float", found {arithmetic!r}', where="arithmetic"
            )
        if arithmetic == "float" and spectrum is not None:
            raise UsageError(
                "a design in floating point takes a rate or a radius; a spectrum needs exact "
                "arithmetic"
            )
        carrier = None if agent is None else system.index(agent)
        return cls(region, carrier, spectrum, arithmetic, progress or (lambda _: None))
