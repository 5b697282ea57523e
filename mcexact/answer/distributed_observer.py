"""Answer: the loop of a distributed observer separates, and both parts have known spectra."""

from __future__ import annotations

from fractions import Fraction

from mcexact.answer.protocol import Answer, answer, claim, witness
from mcexact.exact.polynomial import Polynomial


@answer("distributed_observer")
class DistributedObserver(Answer):
    """In the coordinates (x, e_1, z_1, …), e_i = x_i − x, the loop is [M_F, *; 0, M_E].

    Attributes
    ----------
    feedback : Polynomial
        The characteristic polynomial of M_F = A + Σ B_i F_i, of degree n.
    error : Polynomial
        The characteristic polynomial of M_E, the matrix of the error system.
    bound : Fraction or None
        A certified rate (every real part is below −bound) or radius (every modulus is below it).
    moduli : tuple of int
        As in ``closed_loop_spectrum``, enough for both polynomials.
    """

    feedback: Polynomial = claim()
    error: Polynomial = claim()
    bound: Fraction | None = claim()
    moduli: tuple[int, ...] = witness()
