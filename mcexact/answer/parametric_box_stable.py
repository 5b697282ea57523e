"""Answer: a loop is stable at all values of the parameters within their ranges."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.answer.evidence import InverseFrame
from mcexact.answer.parametric_box_fixed import Cuts
from mcexact.answer.protocol import Answer, Part, answer, claim, witness
from mcexact.answer.stability import LyapunovMethod, PolynomialMethod
from mcexact.derived.constructions import ParametricLoop
from mcexact.exact.roots import StabilityRegion
from mcexact.model.parametric import ParametricSystem


@dataclass(frozen=True)
class StabilityOfCell(Part):
    """What `BoxStability` needs for the loops at all values of a cell.

    Attributes
    ----------
    nominal : PolynomialMethod or LyapunovMethod
    points : tuple of Fraction
    growth : tuple of int or None
    segments : tuple of int
    frames : tuple of InverseFrame
    """

    nominal: PolynomialMethod | LyapunovMethod
    points: tuple[Fraction, ...]
    growth: tuple[int, ...] | None
    segments: tuple[int, ...]
    frames: tuple[InverseFrame, ...]


@answer("parametric_box_stable")
class ParametricBoxStability(Answer):
    """Every eigenvalue lies in a region at all real values of the parameters within their ranges.

    Attributes
    ----------
    about : ParametricLoop or ParametricSystem
        Usually a closed loop.
    bound : Fraction or None
        A rate ≥ 0 (continuous time) or a radius in (0, 1] (discrete time); None means 0 or 1.
    gain_radii : dict or None
        The radii of the controller's gains, as for `BoxStability`.
    cuts : tuple of int or None
        How the ranges are cut into cells.
    parts : tuple of StabilityOfCell
        One for each cell.
    """

    about: ParametricLoop | ParametricSystem  # type: ignore[assignment]
    bound: Fraction | None = claim()
    gain_radii: dict[str, Any] | None = claim()
    cuts: Cuts = witness()
    parts: tuple[StabilityOfCell, ...] = witness()

    @property
    def region(self) -> StabilityRegion:
        """The region in which all eigenvalues lie."""
        return StabilityRegion.of(self.about.time, bound=self.bound)
