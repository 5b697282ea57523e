"""Word-size primes, and rational numbers modulo them."""

from __future__ import annotations

import random
from collections.abc import Iterator
from fractions import Fraction
from functools import lru_cache

import flint

from mcexact.errors import InputError

# A product of two residues below 2**30 has two digits of a Python integer, so the checker, which
# has # no library, is fast at such moduli; flint is fast at any modulus below 2**63.
_BITS = 30


@lru_cache(maxsize=1024)
def _is_prime(ell: int) -> bool:
    return bool(flint.fmpz(ell).is_prime())


def require_prime(ell: int) -> None:
    """Raise an error for a modulus for which flint would abort."""
    if type(ell) is not int or not 2 <= ell < 2**63 or not _is_prime(ell):
        raise InputError(f"expected a prime modulus below 2**63, found {ell!r}")


def primes(seed: int, bits: int = _BITS) -> Iterator[int]:
    """Yield primes with exactly this many bits, drawn from a seed, without end.

    Parameters
    ----------
    seed : int
        The same seed gives the same primes, on every machine.
    bits : int
        From 8 to 63.

    Examples
    --------
    >>> stream = primes(7)
    >>> all(2**29 < next(stream) < 2**30 for _ in range(5))
    True
    """
    if not 8 <= bits <= 63:
        raise InputError(f"expected primes of 8 to 63 bits, found {bits}")
    rng = random.Random(seed)
    while True:
        candidate = rng.getrandbits(bits) | 1 << bits - 1 | 1
        if flint.fmpz(candidate).is_prime():
            yield candidate


def long_prime(rng: random.Random, bits: int) -> int:
    """Draw a prime with exactly this many bits, more than a machine word has."""
    while True:
        candidate = rng.getrandbits(bits) | 1 << bits - 1 | 1
        if flint.fmpz(candidate).is_probable_prime() and flint.fmpz(candidate).is_prime():
            return candidate


def residue(q: Fraction | int, ell: int) -> int:
    """A rational number modulo a prime that does not divide its denominator.

    Examples
    --------
    >>> residue(Fraction(1, 2), 7)
    4
    """
    if q.denominator % ell == 0:
        raise divides_denominator(ell)
    return q.numerator * pow(q.denominator, -1, ell) % ell


def divides_denominator(ell: int) -> InputError:
    return InputError(f"the modulus {ell} divides a denominator; draw another")
