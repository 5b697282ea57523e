"""Covers of discs by discs and squares, each of which is proved; ``proofs/boxes.md``."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import NamedTuple

from . import budget
from .reading import Json, integer, items, malformed, require
from .region import Bound
from .regular_discs import Regular
from .root_discs import Disc

ROOT_2 = Fraction(1414214, 1000000)
"""More than the square root of 2."""


ZERO = Fraction(0)


class Cell(NamedTuple):
    """A disc around re + i·im of this radius, or a square of half this side."""

    re: Fraction
    im: Fraction
    size: Fraction
    square: bool

    def outside(self, time: str, bound: Bound) -> bool:
        """Whether it lies below the real axis, or inside the region where modes are allowed.

        Theorems ``cells.conjugate_fixed``, ``cells.conjugate_rank``.
        """
        re, im, size, square = self
        if im + size < 0:
            return True
        if bound is None:
            return False
        if time == "continuous":
            return re + size < -bound
        if square:
            return (abs(re) + size) ** 2 + (abs(im) + size) ** 2 < bound**2
        return bound > size and re**2 + im**2 < (bound - size) ** 2

    def meets(self, disc: Disc) -> bool:
        """Whether it has a point in common with a disc."""
        re, im, radius = disc
        x, y, reach = abs(re - self.re), abs(im - self.im), radius + self.size
        if max(x, y) > reach:
            return False
        if self.square:
            x, y, reach = max(x - self.size, ZERO), max(y - self.size, ZERO), radius
        return x**2 + y**2 <= reach**2

    def parts(self) -> list["Cell"]:
        """Four squares that cover it, in the order in which they are taken from the end.

        Theorems ``cells.disc_in_square``, ``cells.four_parts``.
        """
        re, im, size, _ = self
        h = size / 2
        return [Cell(re + x, im + y, h, True) for x in (h, -h) for y in (h, -h)]

    def regular(self, on_disc: Regular) -> bool:
        """Whether a pencil is regular on the disc around it."""
        return on_disc(self.re, self.im, self.size * ROOT_2 if self.square else self.size)


def require_covered(
    value: Json,
    place: str,
    exterior: list[list[Disc]],
    outside: Callable[[Cell], bool],
    frames: Sequence[Regular],
) -> None:
    """Stop unless all points in a disc of each list are in cells that are regular by one frame.

    The discs of the first list are cut into cells; those that are outside, or that meet no disc of
    another list, are left out.

    Theorems ``boxes.square_in_disc``, ``cells.cover_disc``.
    """
    first, *others = exterior
    longest = max((budget.limbs_of(disc) for discs in others for disc in discs), default=0)
    for k, nodes in enumerate(items(value, place, len(first))):
        where, used = f"{place}[{k}]", 0
        left = [(Cell(*first[k], False), others)]
        while left:
            cell, near = left.pop()
            turns = 12 + 3 * sum(map(len, near))
            budget.spend(budget.fractions(turns, 2 * budget.limbs_of(cell[:3]) + longest))
            if outside(cell):
                continue
            near = [[disc for disc in discs if cell.meets(disc)] for discs in near]
            if not all(near):
                continue
            require(used < len(items(nodes, where)), "cover", where, "a cell is not covered")
            node, used = nodes[used], used + 1
            if node is None:
                left += [(part, near) for part in cell.parts()]
                continue
            if integer(node, where) >= len(frames):
                malformed(where, f"expected null or a position below {len(frames)}")
            regular = cell.regular(frames[node])
            require(regular, "cell", f"{where}[{used - 1}]", "not regular by this frame")
        if used < len(items(nodes, where)):
            malformed(where, f"expected {used} cells, found {len(nodes)}")
