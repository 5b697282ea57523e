"""Linear recurrences modulo primes, and the proof that one of them is the least.

The numbers s_0, s_1, … satisfy the recurrence d = Σ d_j x^j if Σ_j d_j s_{k+j} = 0 for all k.  The
numerator of d is num = Σ_i x^i Σ_{j>i} d_j s_{j−i−1}, the polynomial part of d·Σ s_k x^{−k−1}; d is
the least recurrence iff d and num are coprime.
"""

from __future__ import annotations

from collections.abc import Sequence

import flint

from mcexact.exact.modular_polynomial import ModularPolynomial
from mcexact.exact.prime_field import require_prime


def least_recurrence(sequence: Sequence[int], ell: int) -> ModularPolynomial:
    """The monic recurrence of least degree L of residues modulo a prime; 2L of them determine it.

    By flint's half-gcd.

    Examples
    --------
    >>> least_recurrence([0, 1, 1, 2, 3, 5, 8, 13], 31).coefficients
    (30, 30, 1)
    """
    require_prime(ell)
    ring = flint.fmpz_mod_poly_ctx(flint.fmpz_mod_ctx(ell))
    if not any(sequence):
        return ModularPolynomial.from_coefficients([1], ell)
    coefficients = list(map(int, ring.minpoly(list(sequence)).coeffs()))
    found = ModularPolynomial(ell, flint.nmod_poly(coefficients, ell))
    found.__dict__["coefficients"] = tuple(coefficients)
    return found


def cofactors(
    recurrence: ModularPolynomial, sequence: Sequence[int]
) -> tuple[ModularPolynomial, ModularPolynomial]:
    """The a and e with a·num + e·d = 1, of degrees below those of d and num.

    Parameters
    ----------
    recurrence : ModularPolynomial
        d, of degree L, the least one.
    sequence : sequence of int
        s_0, …, s_{L−1}, and perhaps more.

    Examples
    --------
    >>> a, e = cofactors(least_recurrence([0, 1, 1, 2], 31), [0, 1])
    >>> a.coefficients, e.coefficients
    ((1,), ())
    """
    ell, L = recurrence.modulus, recurrence.degree
    reverse = flint.nmod_poly(list(sequence[:L])[::-1], ell)
    numerator = (recurrence._poly * reverse).right_shift(L)
    _, a, e = numerator.xgcd(recurrence._poly)
    return ModularPolynomial(ell, a), ModularPolynomial(ell, e)
