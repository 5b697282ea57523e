"""Answer: the characteristic polynomial of a closed loop, coefficient by coefficient."""

from __future__ import annotations

from typing import Any

from mcexact.answer.protocol import Answer, answer, claim, witness
from mcexact.exact.polynomial import Polynomial
from mcexact.plot.eigenvalues import eigenvalues


@answer("closed_loop_spectrum")
class ClosedLoopSpectrum(Answer):
    """The characteristic polynomial of the matrix A of a system, usually a closed loop.

    Attributes
    ----------
    polynomial : Polynomial
        Monic, of degree n.
    moduli : tuple of int
        Pairwise coprime, modulo each of which the polynomials agree; their product exceeds twice a
        bound on the coefficients.
    """

    polynomial: Polynomial = claim()
    moduli: tuple[int, ...] = witness()

    def plot(self, ax: Any = None) -> Any:
        """Draw the eigenvalues with their multiplicities; see `mcexact.plot.eigenvalues`."""
        return eigenvalues(self, ax, time=self.about.time)
