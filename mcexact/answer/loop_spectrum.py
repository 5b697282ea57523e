"""The spectrum of a matrix, with every eigenvalue enclosed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from mcexact.answer.evidence import RateInterval, RootDisc
from mcexact.exact.polynomial import Polynomial
from mcexact.plot.eigenvalues import eigenvalues


@dataclass(frozen=True)
class LoopSpectrum:
    """The eigenvalues of a closed loop.

    Attributes
    ----------
    time : {"continuous", "discrete"}
    polynomial : Polynomial
        The characteristic polynomial.
    discs : tuple of RootDisc
        One around each distinct eigenvalue.
    stable : bool
        Whether all lie in the stability region, decided on the polynomial.
    rate : RateInterval or None
        Encloses minus the largest real part (continuous time) or the largest modulus (discrete
        time); None if there are no eigenvalues.
    """

    time: str
    polynomial: Polynomial
    discs: tuple[RootDisc, ...]
    stable: bool
    rate: RateInterval | None

    def plot(self, ax: Any = None) -> Any:
        """Draw the eigenvalues with their multiplicities; see `mcexact.plot.eigenvalues`."""
        return eigenvalues(self, ax, time=self.time)
