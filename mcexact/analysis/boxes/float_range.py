"""The entries with which floating point can search."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from mcexact.errors import LimitReached
from mcexact.exact.matrix import Matrix

_BITS = 200
"""Products of a few such numbers are still floats."""


def require_float_range(values: Iterable[Matrix], radii: Iterable[Matrix]) -> None:
    """Stop if an entry is so large or so small that its products leave floating point.

    Parameters
    ----------
    values, radii : iterable of Matrix
        Radii may be as small as they like.

    Raises
    ------
    LimitReached
        If the modulus of an entry that is not 0 is above 2²⁰⁰ or below 2⁻²⁰⁰, or about that.

    Examples
    --------
    >>> require_float_range([Matrix.from_rows([[0, "1e60", "1e-60"]])], [])
    >>> require_float_range([Matrix.from_rows([["1e61"]])], [])
    Traceback (most recent call last):
        ...
    mcexact.errors.LimitReached: an entry is above 1e60 or below 1e-60, where floating point finds \
no proof: choose other units
    """
    sizes = [size for M in values for size in _sizes(M)]
    spread = [size for M in radii for size in _sizes(M)]
    if max([*sizes, *spread], default=0) > _BITS or min(sizes, default=0) < -_BITS:
        raise LimitReached(
            "an entry is above 1e60 or below 1e-60, where floating point finds no proof: "
            "choose other units"
        )


def _sizes(M: Matrix) -> Iterator[int]:
    """About the binary logarithms of the moduli of all entries that are not 0."""
    below = M.denominator.bit_length()
    return (abs(int(x)).bit_length() - below for _, _, x in M.nonzero())
