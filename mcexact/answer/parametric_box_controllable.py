"""Answer: channels control every mode at all values of the parameters within their ranges."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.answer.box_controllable import RightInverseFrame
from mcexact.answer.evidence import Cover, ExteriorDiscs
from mcexact.answer.formats import allowed
from mcexact.answer.parametric_box_fixed import Cuts
from mcexact.answer.protocol import Answer, Part, answer, claim, witness
from mcexact.exact.roots import StabilityRegion
from mcexact.model.parametric import ParametricSystem


@dataclass(frozen=True)
class ControlOfCell(Part):
    """What `BoxControllability` needs for the plants at all values of a cell.

    Attributes
    ----------
    exterior : tuple of ExteriorDiscs
    frames : tuple of RightInverseFrame
    cover : tuple of tuples of int or None
    """

    exterior: tuple[ExteriorDiscs, ...]
    frames: tuple[RightInverseFrame, ...]
    cover: Cover


@answer("parametric_box_controllable")
class ParametricBoxControllability(Answer):
    """Channels control every mode at all real values of the parameters within their ranges.

    About the dual of a system it says what the channels observe.

    Attributes
    ----------
    channels : tuple of str
        T, in the order of the system.
    bound : Fraction or None
        None: (A, B_T) is controllable for every plant.  A rate ≥ 0 or a radius in (0, 1]: every
        plant has its uncontrollable modes in this region.
    cuts : tuple of int or None
        How the ranges are cut into cells.
    parts : tuple of ControlOfCell
        One for each cell.
    """

    about: ParametricSystem  # type: ignore[assignment]
    channels: tuple[str, ...] = claim()
    bound: Fraction | None = claim("modes at any values that these do not control")
    cuts: Cuts = witness()
    parts: tuple[ControlOfCell, ...] = witness()

    @property
    def region(self) -> StabilityRegion | None:
        """The region in which plants may have uncontrollable modes, if any."""
        return None if self.bound is None else StabilityRegion.of(self.about.time, bound=self.bound)

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield what notebooks show."""
        yield "channels", ", ".join(self.channels)
        yield "modes at any values that these do not control", allowed(self.region)
