"""Whether a plant in a box has a fixed mode, by gains of its own for each part of the plane."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, overload

import numpy as np

from mcexact.analysis.boxes.cover import Cover, Outside
from mcexact.analysis.boxes.disc_lists import MANY, GainBox, disc_lists
from mcexact.analysis.boxes.float_pencils import FloatBox, Pencil, gain_pencil, independent
from mcexact.analysis.boxes.gain_search import Gains, best_gains, exact_gains
from mcexact.analysis.boxes.one_thread import one_thread
from mcexact.analysis.boxes.radii import radii_of
from mcexact.analysis.boxes.regular_discs import Frames, Point
from mcexact.answer.box_fixed import BoxFixedModes, PencilFrame, PencilGains
from mcexact.answer.evidence import ExteriorDiscs, RootDisc
from mcexact.answer.fixed_spectrum import FixedSpectrum
from mcexact.answer.parametric_box_fixed import ParametricBoxFixedModes
from mcexact.errors import InputError, LimitReached
from mcexact.exact.matrix import matrix_to_float, to_float
from mcexact.exact.roots import StabilityRegion
from mcexact.model.parametric import ParametricSystem
from mcexact.model.radii import Radii
from mcexact.model.system import MultiChannelSystem

_MOST_SQUARES = 3000
_NEAREST = 10
_OWN_GAINS_AT = (3, 6, 10, 15)
"""A square that fails at one of these depths gets gains of its own."""
_MOST_OWN = 12
_NEVER_ENOUGH = 1e30
_REUSED = 8.0
"""Gains that suffice for so many times the radii at a mode are used there again."""


@dataclass(frozen=True, eq=False)
class _Known:
    """Gains that were found at a point, with their pencil; None stands for λI − A."""

    point: complex
    gains: PencilGains | None
    pencil: Pencil


@dataclass
class FixedModeSearch:
    """The search for evidence about one system, which keeps its gains for other radii.

    Attributes
    ----------
    system : MultiChannelSystem
    radii : Radii
    starts : int
        How many local searches for gains there are at most at a point.
    most_squares : int
        The most discs and squares of a cover; there are fewer of a large plant.
    several : bool, optional
        Whether exterior discs are those of several matrices; by default those of large plants are.
    tied : tuple of MultiChannelSystem
        What may be added to the system, each with a factor from −1 to 1.
    most_own : int
        For how many squares gains of their own are searched.
    tested : int
        How many were tested so far.
    """

    system: MultiChannelSystem
    radii: Radii
    starts: int = 4
    most_squares: int = _MOST_SQUARES
    several: bool | None = None
    tied: tuple[MultiChannelSystem, ...] = ()
    most_own: int = _MOST_OWN
    known: list[_Known] = field(default_factory=list)
    rng: np.random.Generator = field(default_factory=lambda: np.random.default_rng(0))
    tested: int = 0

    def __post_init__(self) -> None:
        self.box = FloatBox.of(self.system, self.radii, self.tied)
        if self.several is None:
            self.several = self.system.n >= MANY
        self.alone = _Known(0j, None, self._pencil(None))

    def _pencil(self, gains: PencilGains | None) -> Pencil:
        X, W = (None, None) if gains is None else (gains.X, gains.W)
        return gain_pencil(self.system, self.radii, self.box.scale, X, W, self.tied)

    def reuse(self, other: FixedModeSearch) -> None:
        """Try the gains that were found for another system of the same shapes."""
        for each in other.known:
            self.known.append(_Known(each.point, each.gains, self._pencil(each.gains)))

    def learn(self, point: complex, growth: float, size: float = 0.0) -> float:
        """Search gains for a point, and return how far the radii can grow there with them.

        The gains are to suffice for the disc of a size, too: those that are best for the point
        alone can make the pencil nearly singular beside it.
        """
        box = self.box.wider(size / growth)
        known = [_floats(each.gains) for each in self.known if size and each.gains is not None]
        best = best_gains(box, point, self.rng, starts=self.starts, target=growth, known=known)
        if best is None:
            return 0.0
        gains = PencilGains(*exact_gains(best[1]))
        self.known.append(_Known(point, gains, self._pencil(gains)))
        return self.known[-1].pencil.margin(point)

    def prepare(
        self, growth: float, outside: Outside, lists: Sequence[ExteriorDiscs] = ()
    ) -> float:
        """Learn gains for all modes, and return how far the radii can grow at each of them.

        Modes that are in no disc of one of some lists are left out.
        """
        least = np.inf
        for mode in self.box.modes():
            # A mode well inside of the region is left out, as its disc will be.
            if outside.covers(mode) or not all(_among(mode, each.discs) for each in lists):
                continue
            best = max((each.pencil.margin(mode) for each in self.known), default=0.0)
            if best <= _REUSED * growth:
                best = max(best, self.learn(mode, growth))
            least = min(least, best)
        return float(least)

    def improve(self, outside: Outside, rounds: int) -> float:
        """Search more gains where the radii can grow least, and return how far they can grow."""
        least = 0.0
        for k in range(rounds + 1):
            modes = [mode for mode in self.box.modes() if not outside.covers(mode)]
            best = [(max(e.pencil.margin(mode) for e in self.known), mode) for mode in modes]
            if not best or not self.known:
                return np.inf
            least, mode = min(best, key=lambda each: each[0])
            if k < rounds:
                self.learn(mode, _NEVER_ENOUGH)
        return float(least)

    def cover(self, growth: Fraction, bound: Fraction | None) -> BoxFixedModes | None:
        """Evidence for radii that are multiplied by a factor; None if there is none.

        The answer is about the radii of the system: with another factor it is a witness only.
        """
        system, outside = self.system, Outside(self.system.time, bound)
        free, along = independent(self.radii, self.tied), [each.A for each in self.tied]
        moved = (self.radii.A, *along)
        whole = GainBox(system.A, system.B, system.C, free, self.box, moved)
        lists = disc_lists(whole, self.rng, growth, outside, several=bool(self.several))
        if lists is None:
            return None
        if len(lists) > 1 and self.prepare(float(growth), outside, lists) <= growth:
            return None
        leaves = _Leaves(self, growth)
        cover = Cover(leaves.test, outside, self.most_squares * MANY // max(self.system.n, MANY))
        trees = cover.of(*(each.discs for each in lists))
        self.tested += cover.tested
        if trees is None:
            return None
        gains = list(dict.fromkeys(g for g in leaves.gains if g is not None))
        frames = tuple(
            PencilFrame(None if g is None else gains.index(g), V.evidence(), w)
            for g, (V, w) in zip(leaves.gains, leaves.frames.evidence, strict=True)
        )
        return BoxFixedModes(system, bound, lists, tuple(gains), frames, trees)


@dataclass
class _Leaves:
    """The tests of discs for one factor of the radii, and the evidence that passed them."""

    search: FixedModeSearch
    growth: Fraction
    frames: Frames = field(default_factory=Frames)
    gains: list[PencilGains | None] = field(default_factory=list)
    own: int = 0

    def test(self, c: Point, rho: Fraction, depth: int) -> int | None:
        """The position of a frame that shows a disc to be free of fixed modes."""
        k = self.frames.one_for(c, rho)
        if k is not None:
            return k
        near = complex(to_float(c[0]), to_float(c[1]))
        size = to_float(rho)
        ranked = sorted(self.search.known, key=lambda each: _distance(each.point, near))
        for each in [*ranked[:_NEAREST], self.search.alone]:
            k = self._made(each, c, near, rho, size)
            if k is not None:
                return k
        if depth in _OWN_GAINS_AT and self.own < self.search.most_own:
            self.own += 1
            if self.search.learn(near, 2 * float(self.growth), size) > float(self.growth):
                return self._made(self.search.known[-1], c, near, rho, size)
        return None

    def _made(
        self, each: _Known, c: Point, near: complex, rho: Fraction, size: float
    ) -> int | None:
        proposed = each.pencil.proposal(near, size, self.growth)
        k = None if proposed is None else self.frames.added(proposed, c, rho)
        if k is not None:
            self.gains.append(each.gains)
        return k


def _floats(gains: PencilGains) -> Gains:
    X, W = (tuple(map(matrix_to_float, matrices)) for matrices in (gains.X, gains.W))
    return X, W


def _among(mode: complex, discs: Sequence[RootDisc]) -> bool:
    return any(
        abs(mode - complex(float(disc.re), float(disc.im))) <= 1.01 * float(disc.radius)
        for disc in discs
    )


def _distance(point: complex, near: complex) -> float:
    return min(abs(point - near), abs(point.conjugate() - near))


@overload
def box_fixed_modes(
    system: MultiChannelSystem,
    *,
    bound: Any = ...,
    starts: int = ...,
    spectrum: FixedSpectrum | None = ...,
) -> BoxFixedModes: ...
@overload
def box_fixed_modes(
    system: ParametricSystem, *, bound: Any = ..., starts: int = ...
) -> ParametricBoxFixedModes: ...
def box_fixed_modes(
    system: MultiChannelSystem | ParametricSystem,
    *,
    bound: Any = None,
    starts: int = 4,
    spectrum: FixedSpectrum | None = None,
) -> BoxFixedModes | ParametricBoxFixedModes:
    """Prove that no plant in a box has a fixed mode, or none outside of a region.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
        A plant with radii, such as ``Box.relative(plant, "1/1000").system``, or a system that
        constructions made from one; or one with parameters, each with a range of two ends: then no
        mode is fixed at any values within the ranges (`ParametricBoxFixedModes`).
    bound : rational, optional
        A rate from 0 on, or a radius up to 1: fixed modes inside of this region are allowed.
    starts : int
        How many local searches for gains there are at most at a point.
    spectrum : FixedSpectrum, optional
        The fixed modes of the nominal plant, which has no parameters, if they are known: with one
        of them no proof is searched.

    Raises
    ------
    LimitReached
        If no proof was found, which proves nothing.

    Notes
    -----
    Proposed in floating point, and tested exactly: one square after the other, in integers.  The
    gains with which a mode is moved are searched for each part of the plane.

    Entries that depend on the same parameter are moved together, which proves more than a radius
    for each of them.  Ranges are cut in half until each cell is proved.

    Examples
    --------
    >>> from mcexact import Box
    >>> plant = MultiChannelSystem([[0, 1], [-2, -3]], [[[0], [1]]], [[[1, 0]]])
    >>> box_fixed_modes(Box.relative(plant, "1/100").system).bound is None
    True
    >>> box_fixed_modes(Box.absolute(plant, B=[[[0], [1]]]).system)
    Traceback (most recent call last):
        ...
    mcexact.errors.LimitReached: no proof was found that no plant in the box has a fixed mode
    """
    spectrum = FixedSpectrum.known(spectrum, system, "spectrum")
    if isinstance(system, ParametricSystem):
        from mcexact.analysis.boxes.parametric_box import parametric_box_fixed_modes

        return parametric_box_fixed_modes(system, bound=bound, starts=starts)
    InputError.require(system, MultiChannelSystem, "system")
    limit = None if bound is None else StabilityRegion.of(system.time, bound=bound).edge
    if spectrum is not None:
        _require_moved(spectrum, limit)
    with one_thread():
        search = FixedModeSearch(system, radii_of(system), starts)
        # Of a large plant few modes are left where the discs of several matrices meet.
        outside = Outside(system.time, limit)
        least = np.inf if search.several else search.prepare(1.0, outside)
        found = search.cover(Fraction(1), limit) if least > 1 else None
    if found is None:
        where = "" if limit is None else " outside of the region"
        raise LimitReached(f"no proof was found that no plant in the box has a fixed mode{where}")
    return found


def _require_moved(spectrum: FixedSpectrum, limit: Fraction | None) -> None:
    """End the search if the nominal plant itself fails."""
    if limit is None and not spectrum.empty:
        raise LimitReached("the plant itself has a fixed mode, at its nominal values")
    if limit is not None and not spectrum.stabilizable:
        raise LimitReached("the plant itself is not stabilizable, at its nominal values")


@overload
def box_stabilizability(
    system: MultiChannelSystem, *, spectrum: FixedSpectrum | None = ...
) -> BoxFixedModes: ...
@overload
def box_stabilizability(system: ParametricSystem) -> ParametricBoxFixedModes: ...
def box_stabilizability(
    system: MultiChannelSystem | ParametricSystem, *, spectrum: FixedSpectrum | None = None
) -> BoxFixedModes | ParametricBoxFixedModes:
    """Prove that each plant in a box is stabilized by a decentralized controller of its own.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
        As for `box_fixed_modes`.
    spectrum : FixedSpectrum, optional
        As for `box_fixed_modes`.

    Raises
    ------
    LimitReached
        If no proof was found, which proves nothing.

    Notes
    -----
    No member has a fixed mode in the closed right half-plane, or of modulus 1 or more.  One
    controller for all members is a matter of `box_stability`.

    Examples
    --------
    >>> from mcexact import Box
    >>> plant = MultiChannelSystem([[1, 0], [0, -2]], [[[1], [0]]], [[[1, 0]]])
    >>> box_stabilizability(Box.relative(plant, "1/100").system).bound
    Fraction(0, 1)
    """
    spectrum = FixedSpectrum.known(spectrum, system, "spectrum")
    if isinstance(system, ParametricSystem):
        return box_fixed_modes(system, bound=StabilityRegion(system.time).edge)
    InputError.require(system, MultiChannelSystem, "system")
    edge = StabilityRegion(system.time).edge
    return box_fixed_modes(system, bound=edge, spectrum=spectrum)
