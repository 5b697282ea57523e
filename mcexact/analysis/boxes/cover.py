"""The cover of discs by a tree of squares, each of which passes a test of its own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

from mcexact.analysis.boxes.regular_discs import Point
from mcexact.answer.evidence import RootDisc
from mcexact.exact.roots import exact_decimal, is_discrete

SQUARE = Fraction(1414214, 1000000)
"""A number above √2: a square of half side h is inside of the disc of radius √2 h."""
_MOST_CUTS = 24

Disc = tuple[Point, Fraction]
"""The center and the radius of a disc."""
Test = Callable[[Point, Fraction, int], int | None]
"""Of a center, a radius and a depth, the index of evidence for the disc."""


@dataclass(frozen=True)
class Outside:
    """What a claim does not speak of: the lower half-plane, and what lies inside of a region.

    Attributes
    ----------
    time : str
    bound : Fraction or None
        A rate or a radius; None if the claim is about all complex numbers.
    """

    time: str
    bound: Fraction | None

    def covers(self, mode: complex) -> bool:
        """Whether a number and what is near it is outside."""
        c = Fraction(mode.real), Fraction(mode.imag)
        return self.bound is not None and self.disc(c, Fraction(abs(mode) / 1000))

    def disc(self, c: Point, r: Fraction) -> bool:
        """Whether a disc is outside."""
        re, im = c
        if im + r < 0:
            return True
        if self.bound is None:
            return False
        if not is_discrete(self.time):
            return re + r < -self.bound
        return self.bound > r and re**2 + im**2 < (self.bound - r) ** 2

    def square(self, c: Point, h: Fraction) -> bool:
        """Whether a square of half side h is outside."""
        re, im = c
        if im + h < 0:
            return True
        if self.bound is None:
            return False
        if not is_discrete(self.time):
            return re + h < -self.bound
        return (abs(re) + h) ** 2 + (abs(im) + h) ** 2 < self.bound**2


@dataclass
class Cover:
    """The trees over discs, and how many squares were tested.

    Attributes
    ----------
    test : function
    outside : Outside
    limit : int
        The most discs and squares that are tested.
    """

    test: Test
    outside: Outside
    limit: int
    tested: int = field(default=0)

    def of(self, *lists: Sequence[RootDisc]) -> tuple[tuple[int | None, ...], ...] | None:
        """The tree over each disc of the first list, in preorder; None without a cover.

        Squares that meet no disc of another list are left out.
        """
        first, *others = ([_exact(disc) for disc in discs] for discs in lists)
        found = []
        for c, radius in first:
            tree: list[int | None] = []
            near = [[each for each in discs if meets(c, radius, each)] for discs in others]
            skipped = self.outside.disc(c, radius) or not all(near)
            if not skipped and not (
                self._leaf(c, radius, 0, tree) or self._cut(c, radius, 0, tree, near)
            ):
                return None
            found.append(tuple(tree))
        return tuple(found)

    def _leaf(self, c: Point, rho: Fraction, depth: int, tree: list[int | None]) -> bool:
        self.tested += 1
        k = self.test(c, rho, depth)
        if k is not None:
            tree.append(k)
        return k is not None

    def _cut(
        self,
        c: Point,
        h: Fraction,
        depth: int,
        tree: list[int | None],
        near: list[list[Disc]],
    ) -> bool:
        """Cut a square of half side h into four, each of which is a leaf or is cut again."""
        if depth == _MOST_CUTS or self.tested >= self.limit:
            return False
        tree.append(None)
        q = h / 2
        for x in (-q, q):
            for y in (-q, q):
                part = c[0] + x, c[1] + y
                if self.outside.square(part, q):
                    continue
                left = [
                    [each for each in discs if meets(part, q, each, square=True)] for discs in near
                ]
                if not all(left):
                    continue
                if not (
                    self._leaf(part, q * SQUARE, depth + 1, tree)
                    or self._cut(part, q, depth + 1, tree, left)
                ):
                    return False
        return True


def meets(c: Point, size: Fraction, disc: Disc, *, square: bool = False) -> bool:
    """Whether a disc of this radius, or else a square of this half side, meets a disc."""
    (re, im), radius = disc
    x, y = abs(re - c[0]), abs(im - c[1])
    if max(x, y) > size + radius:
        return False
    if not square:
        return x**2 + y**2 <= (size + radius) ** 2
    x, y = max(x - size, Fraction(0)), max(y - size, Fraction(0))
    return x**2 + y**2 <= radius**2


def _exact(disc: RootDisc) -> Disc:
    return (exact_decimal(disc.re), exact_decimal(disc.im)), exact_decimal(disc.radius)
