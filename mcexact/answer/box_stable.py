"""Answer: every loop in a box is stable."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from mcexact.answer.evidence import InverseFrame
from mcexact.answer.protocol import Answer, answer, claim, witness
from mcexact.answer.stability import LyapunovMethod, PolynomialMethod
from mcexact.exact.roots import StabilityRegion


@answer("box_stable")
class BoxStability(Answer):
    """Every eigenvalue of every member of a box lies in a region: usually of a closed loop.

    Attributes
    ----------
    bound : Fraction or None
        A rate ≥ 0 (continuous time) or a radius in (0, 1] (discrete time); None means 0 or 1.
    gain_radii : dict or None
        The radii of the controller's gains, as the object of a controller with the same agents;
        None if they are certain.
    nominal : PolynomialMethod or LyapunovMethod
        That the nominal values are stable, as in the kind ``stability``.
    points : tuple of Fraction
        Where the upper half of the border of the region is cut.
    growth : tuple of int or None
        Weights of the states that exclude eigenvalues beyond the last point, in continuous time.
    segments : tuple of int
        For each part of the border the position of its frame.
    frames : tuple of InverseFrame
        About the pencil of the loop in x, the controller's states, all y_i and all u_i.
    """

    bound: Fraction | None = claim("every eigenvalue of every member")
    gain_radii: dict[str, Any] | None = claim("gains")
    nominal: PolynomialMethod | LyapunovMethod = witness()
    points: tuple[Fraction, ...] = witness()
    growth: tuple[int, ...] | None = witness()
    segments: tuple[int, ...] = witness()
    frames: tuple[InverseFrame, ...] = witness()

    @property
    def region(self) -> StabilityRegion:
        """The region in which all eigenvalues lie."""
        return StabilityRegion.of(self.about.time, bound=self.bound)

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield what notebooks show."""
        yield "every eigenvalue of every member", str(self.region)
        yield "gains", "certain" if self.gain_radii is None else "within radii of their own"
