"""A warning where double precision cannot represent a closed loop well enough to simulate it."""

from __future__ import annotations

from fractions import Fraction

from mcexact.exact.matrix import largest_entry
from mcexact.model.loop import ClosedLoop

LARGEST_FOR_DOUBLES = 10**5


def double_precision_warning(loop: ClosedLoop) -> str | None:
    """Return a warning if the matrix of a closed loop has an entry of 10⁵ or more, else None.

    Notes
    -----
    A matrix with large entries and small eigenvalues is far from normal, so rounding its entries
    moves its eigenvalues far.  In one example with n = 6 and m = 5 the spectral abscissa is −1, but
    +9 once the entries are rounded to double precision.
    """
    largest = largest_entry([loop.matrix])
    if largest < LARGEST_FOR_DOUBLES:
        return None
    return (
        f"the closed loop has entries up to {_power(largest)}, so that double precision does not "
        "show how the exact design behaves; use exact or multiprecision arithmetic"
    )


def _power(value: Fraction) -> str:
    """The order of magnitude of a number of 1 or more, such as 3e+20."""
    digits = str(int(value))
    return f"{digits[0]}e+{len(digits) - 1:02d}"
