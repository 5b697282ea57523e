"""Whether double precision can show an exact design."""

from __future__ import annotations

from fractions import Fraction

from mcexact.exact.matrix import Matrix
from mcexact.model.closed_loop import closed_loop_matrix
from mcexact.model.controller import Controller
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem

LARGEST_FOR_DOUBLES = 10**5


def largest_entry(M: Matrix) -> Fraction:
    """The largest absolute value of an entry; 0 without entries."""
    top = max((abs(entry) for row in M.numerators for entry in row), default=0)
    return Fraction(top, M.denominator)


def double_precision_warning(
    system: MultiChannelSystem, controller: Controller, graph: NeighborGraph | None = None
) -> str | None:
    """A sentence if the loop has entries of 10⁵ or more, else None.

    Parameters
    ----------
    system : MultiChannelSystem
    controller : Controller
    graph : NeighborGraph, optional

    Notes
    -----
    Rounding every entry once moves the eigenvalues of a matrix that is far from normal, and
    matrices with large entries and small eigenvalues are: at n = 6, m = 5 an exact abscissa of −1
    was seen as +9.
    """
    largest = largest_entry(closed_loop_matrix(system, controller, graph))
    if largest < LARGEST_FOR_DOUBLES:
        return None
    return (
        f"the closed loop has entries up to {_power(largest)}: the double-precision picture is not "
        "the exact design; use exact or multiprecision arithmetic"
    )


def _power(value: Fraction) -> str:
    """The size of a number of 1 or more, such as 3e+20."""
    digits = str(int(value))
    return f"{digits[0]}e+{len(digits) - 1:02d}"
