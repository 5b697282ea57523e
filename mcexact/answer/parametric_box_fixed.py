"""Answer: no mode is fixed at any values of the parameters within their ranges."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.answer.box_fixed import PencilFrame, PencilGains
from mcexact.answer.evidence import Cover, ExteriorDiscs
from mcexact.answer.formats import allowed
from mcexact.answer.protocol import Answer, Part, answer, claim, witness
from mcexact.exact.roots import StabilityRegion
from mcexact.model.parametric import ParametricSystem

Cuts = tuple[int | None, ...]
"""In preorder: the position of the parameter in whose middle a cell is cut, or None for a cell."""


@dataclass(frozen=True)
class FixedModesOfCell(Part):
    """What `BoxFixedModes` needs for the plants at all values of a cell.

    Attributes
    ----------
    exterior : tuple of ExteriorDiscs
    gains : tuple of PencilGains
    frames : tuple of PencilFrame
    cover : tuple of tuples of int or None
    """

    exterior: tuple[ExteriorDiscs, ...]
    gains: tuple[PencilGains, ...]
    frames: tuple[PencilFrame, ...]
    cover: Cover


@answer("parametric_box_fixed")
class ParametricBoxFixedModes(Answer):
    """No mode is fixed at any real values of the parameters within their ranges.

    Attributes
    ----------
    bound : Fraction or None
        None: no plant has a fixed mode.  A rate ≥ 0 (continuous time) or a radius in (0, 1]
        (discrete time): every plant has its fixed modes in this region.  With 0, or 1, each plant
        is stabilized by a decentralized controller of its own.
    cuts : tuple of int or None
        How the ranges are cut into cells.
    parts : tuple of FixedModesOfCell
        One for each cell.
    """

    about: ParametricSystem  # type: ignore[assignment]
    bound: Fraction | None = claim("fixed modes at all values")
    cuts: Cuts = witness()
    parts: tuple[FixedModesOfCell, ...] = witness()

    @property
    def region(self) -> StabilityRegion | None:
        """The region in which plants may have fixed modes, if any."""
        return None if self.bound is None else StabilityRegion.of(self.about.time, bound=self.bound)

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield what notebooks show."""
        yield "fixed modes at all values", allowed(self.region)
