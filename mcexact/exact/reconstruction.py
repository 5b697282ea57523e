"""Rational numbers from their residues: Chinese remainders and rational reconstruction."""

from __future__ import annotations

from collections.abc import Sequence
from math import isqrt


def combine(
    first: Sequence[Sequence[int]], modulus: int, second: Sequence[Sequence[int]], ell: int
) -> list[list[int]]:
    """Compute residues modulo ``modulus·ell`` that agree with both tables of residues.

    Parameters
    ----------
    first : rows of int
        Residues modulo ``modulus``.
    modulus, ell : int
        Coprime.
    second : rows of int
        Residues modulo ``ell``, the same shape as ``first``.

    Examples
    --------
    >>> combine([[2]], 3, [[3]], 5)
    [[8]]
    """
    inverse = pow(modulus, -1, ell)
    return [
        [a + modulus * ((b - a) * inverse % ell) for a, b in zip(row, other, strict=True)]
        for row, other in zip(first, second, strict=True)
    ]


def rational(residue: int, modulus: int, bound: int) -> tuple[int, int] | None:
    """Find the fraction p/q with |p| ≤ bound, 0 < q ≤ bound, p ≡ q·residue, if it exists.

    Examples
    --------
    >>> rational(pow(7, -1, 10007) * 3 % 10007, 10007, 70)
    (3, 7)
    """
    r0, r1, s0, s1 = modulus, residue % modulus, 0, 1
    while r1 > bound:
        quotient = r0 // r1
        r0, r1 = r1, r0 - quotient * r1
        s0, s1 = s1, s0 - quotient * s1
    if s1 == 0 or abs(s1) > bound:
        return None
    return (r1, s1) if s1 > 0 else (-r1, -s1)


def rationals(rows: Sequence[Sequence[int]], modulus: int) -> tuple[list[list[int]], int] | None:
    """Find numerators over one denominator with the given residues; None if an entry has none.

    Returns
    -------
    numerators : rows of int
    denominator : int
        At least 1.

    Notes
    -----
    The result must be verified: residues determine only entries whose numerator and denominator are
    below √(modulus/2).  The denominators found so far are tried first, since the entries of one
    matrix mostly share them.

    Examples
    --------
    >>> rationals([[pow(2, -1, 101), 100]], 101)
    ([[1, -2]], 2)
    """
    bound = isqrt(modulus // 2)
    denominator = 1
    numerators: list[list[tuple[int, int]]] = []
    for row in rows:
        found: list[tuple[int, int]] = []
        for value in row:
            if value == 0:
                found.append((0, 1))
                continue
            scaled = value * denominator % modulus
            if 2 * scaled > modulus:
                scaled -= modulus
            if -bound <= scaled <= bound:
                found.append((scaled, denominator))
                continue
            guess = rational(value * denominator, modulus, bound)
            if guess is None:
                return None
            denominator *= guess[1]
            found.append((guess[0], denominator))
        numerators.append(found)
    return [[p * (denominator // q) for p, q in found] for found in numerators], denominator


def integers(residues: Sequence[int], modulus: int) -> list[int]:
    """The representatives in −modulus/2 … modulus/2."""
    return [value - modulus if 2 * value > modulus else value for value in residues]
