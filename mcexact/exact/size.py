"""The bit length and the size of the entries of matrices."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from mcexact.exact.matrix import Matrix


def bit_length(matrices: Iterable[Matrix]) -> int:
    """Return the bits of the longest reduced numerator or denominator of the entries, or 0.

    Examples
    --------
    >>> bit_length([Matrix.from_rows([["1/8", 3]]), Matrix.zeros(0, 2)])
    4
    """
    longest = 0
    for M in matrices:
        d = M.denominator
        for entry in {x for _, _, x in M.nonzero()}:
            # For most entries the bound without cancellation is already small enough.
            if max(entry.bit_length(), d.bit_length()) > longest:
                p, q = Fraction(entry, d).as_integer_ratio()
                longest = max(longest, p.bit_length(), q.bit_length())
    return longest


def largest_entry(matrices: Iterable[Matrix]) -> Fraction:
    """Return the largest absolute value of the entries; 0 without entries.

    Examples
    --------
    >>> largest_entry([Matrix.from_rows([["-3/2", 1]]), Matrix.identity(2)])
    Fraction(3, 2)
    """
    return max(
        (
            Fraction(max((abs(x) for _, _, x in M.nonzero()), default=0), M.denominator)
            for M in matrices
        ),
        default=Fraction(0),
    )
