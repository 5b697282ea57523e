"""How long and how large the entries of matrices are."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from mcexact.exact.matrix import Matrix


def bit_length(matrices: Iterable[Matrix]) -> int:
    """Bits of the longest reduced numerator or denominator among the entries; 0 without entries."""
    longest = 0
    for M in matrices:
        d = M.denominator
        for entry in {x for row in M.numerators for x in row}:
            # Most entries would not be longer even if nothing canceled.
            if max(entry.bit_length(), d.bit_length()) > longest:
                p, q = Fraction(entry, d).as_integer_ratio()
                longest = max(longest, p.bit_length(), q.bit_length())
    return longest


def largest_entry(matrices: Iterable[Matrix]) -> Fraction:
    """The largest absolute value among the entries; 0 without entries."""
    return max(
        (
            Fraction(max((abs(x) for row in M.numerators for x in row), default=0), M.denominator)
            for M in matrices
        ),
        default=Fraction(0),
    )
