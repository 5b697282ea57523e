"""The spectrum of a matrix, every eigenvalue enclosed, and the rate that follows from it."""

from __future__ import annotations

from dataclasses import dataclass

from mcexact.analysis.rate import located
from mcexact.certificate.evidence import RateInterval, RootDisc
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.location import StabilityRegion
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial


@dataclass(frozen=True)
class LoopSpectrum:
    """The eigenvalues of a closed loop.

    Attributes
    ----------
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

    polynomial: Polynomial
    discs: tuple[RootDisc, ...]
    stable: bool
    rate: RateInterval | None


def closed_loop_spectrum(M: Matrix, time: str) -> LoopSpectrum:
    """Enclose every eigenvalue of a rational matrix.

    Parameters
    ----------
    M : Matrix, N×N
    time : {"continuous", "discrete"}

    Notes
    -----
    Exact: the discs are those of `located` for the squarefree part of the characteristic
    polynomial.  Meant for small loops; the numbers in it grow with N².

    Examples
    --------
    >>> found = closed_loop_spectrum(Matrix.from_rows([[-1, 5], [0, -2]]), "continuous")
    >>> found.stable, found.rate
    (True, RateInterval(lower='1', upper='1'))
    >>> closed_loop_spectrum(Matrix.from_rows([[1]]), "continuous").stable
    False
    """
    polynomial = characteristic_polynomial(M)
    distinct = polynomial.squarefree_part()
    discs, rate = located(time, [distinct] if distinct.degree > 0 else [])
    stable = StabilityRegion(time).contains_roots_of(polynomial)
    return LoopSpectrum(polynomial, discs[0] if discs else (), stable, rate)
