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


class Cell(NamedTuple):
    """A disc around re + i·im of this radius, or a square of half this side."""

    re: Fraction
    im: Fraction
    size: Fraction
    square: bool

    def outside(self, time: str, bound: Bound) -> bool:
        """Whether it lies below the real axis, or inside the region where modes are allowed."""
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

    def parts(self) -> list["Cell"]:
        """Four squares that cover it, in the order in which they are taken from the end."""
        re, im, size, _ = self
        h = size / 2
        return [Cell(re + x, im + y, h, True) for x in (h, -h) for y in (h, -h)]

    def regular(self, on_disc: Regular) -> bool:
        """Whether a pencil is regular on the disc around it."""
        return on_disc(self.re, self.im, self.size * ROOT_2 if self.square else self.size)


def require_covered(
    value: Json,
    place: str,
    discs: list[Disc],
    outside: Callable[[Cell], bool],
    frames: Sequence[Regular],
) -> None:
    """Stop unless discs are covered by cells, each of them outside or regular by one frame.

    Theorem ``boxes.square_in_disc``.
    """
    for k, nodes in enumerate(items(value, place, len(discs))):
        where, used = f"{place}[{k}]", 0
        left = [Cell(*discs[k], False)]
        while left:
            cell = left.pop()
            budget.spend(budget.fractions(12, 2 * budget.limbs_of(cell[:3])))
            if outside(cell):
                continue
            require(used < len(items(nodes, where)), "cover", where, "a cell is not covered")
            node, used = nodes[used], used + 1
            if node is None:
                left += cell.parts()
                continue
            if integer(node, where) >= len(frames):
                malformed(where, f"expected null or a position below {len(frames)}")
            regular = cell.regular(frames[node])
            require(regular, "cell", f"{where}[{used - 1}]", "not regular by this frame")
        if used < len(items(nodes, where)):
            malformed(where, f"expected {used} cells, found {len(nodes)}")
