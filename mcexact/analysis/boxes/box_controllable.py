"""Whether channels control every plant in a box, by right inverses of [λI − A, −B_T]."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any, overload

import numpy as np

from mcexact.analysis.boxes.cover import Cover, Outside
from mcexact.analysis.boxes.disc_lists import MANY, GainBox, disc_lists
from mcexact.analysis.boxes.float_pencils import FloatBox, Floats, independent, perron, weights
from mcexact.analysis.boxes.one_thread import one_thread
from mcexact.analysis.boxes.radii import radii_of
from mcexact.analysis.boxes.regular_discs import (
    ComplexRows,
    Frames,
    Point,
    RegularDiscs,
    column,
    dyadic,
    entries,
    whole_weights,
)
from mcexact.answer.box_controllable import BoxControllability, RightInverseFrame
from mcexact.answer.parametric_box_controllable import ParametricBoxControllability
from mcexact.derived.constructions import dual, moved
from mcexact.errors import InputError, LimitReached
from mcexact.exact.matrix import Matrix, hstack, matrix_to_float, to_float
from mcexact.exact.roots import StabilityRegion
from mcexact.model.parametric import ParametricSystem
from mcexact.model.radii import Radii
from mcexact.model.system import MultiChannelSystem

_MOST_SQUARES = 3000
_REWEIGHTINGS, _FEW = 40, 10
_SMALL = 0.9
"""A right inverse with so small a norm is used as it is."""


@dataclass(frozen=True, eq=False)
class WidePencil:
    """[λI − A, −B] and its radii, exactly and in balanced coordinates.

    Attributes
    ----------
    Z0, D : Matrix, n × (n + p)
        [A, B] and the radii.
    near, near_D : ndarray
        The same in balanced coordinates; the radii with the moduli of what is tied.
    scale : ndarray, n
    tied : tuple of Matrix
        What may be added to Z0, each with a factor from −1 to 1.
    near_rest, near_tied : ndarray, tuple of ndarray
        The radii without what is tied, and this itself, in balanced coordinates.
    """

    Z0: Matrix
    D: Matrix
    near: Floats
    near_D: Floats
    scale: Floats
    tied: tuple[Matrix, ...]
    near_rest: Floats
    near_tied: tuple[Floats, ...]

    @classmethod
    def of(
        cls,
        system: MultiChannelSystem,
        radii: Radii,
        box: FloatBox,
        channels: Iterable[int],
        tied: Sequence[MultiChannelSystem] = (),
    ) -> WidePencil:
        """Make it of a box with some channels."""
        chosen, n = sorted(channels), system.n

        def wide(A: Matrix, B: Sequence[Matrix]) -> Matrix:
            return hstack([A, *(B[i] for i in chosen)], nrows=n)

        def near(M: Matrix) -> Floats:
            cols = np.concatenate([box.scale, np.ones(M.ncols - n)])
            return np.asarray(matrix_to_float(M) / box.scale[:, None] * cols[None, :])

        along = tuple(wide(each.A, each.B) for each in tied)
        D = wide(radii.A, radii.B)
        return cls(
            wide(system.A, system.B),
            D,
            np.hstack([box.A, *(box.B[i] for i in chosen)]),
            np.hstack([box.DA, *(box.DB[i] for i in chosen)]),
            box.scale,
            along,
            near(D),
            tuple(map(near, along)),
        )

    def moved(self, R: Any) -> Floats:
        """An upper limit of the moduli of (Z0' − Z0) R for all members Z0'."""
        return np.asarray(self.near_rest @ np.abs(R) + sum(np.abs(M @ R) for M in self.near_tied))

    def proposal(self, c: complex, rho: float, growth: Fraction) -> RegularDiscs | None:
        """Evidence that the pencil has full rank on a disc, if floating point finds some."""
        n, width = self.near.shape
        E = np.hstack([np.eye(n), np.zeros((n, width - n))])
        Z, D = c * E - self.near, float(growth) * self.near_D + rho * E
        R = _right_inverse(Z, D, _FEW)
        part = float(growth)
        w = None if R is None else weights(part * self.moved(R) + rho * E @ np.abs(R))
        if R is None or w is None:
            return None
        heavy = ((np.abs(Z) + D) / w[:, None]).max(axis=0)
        unit = 1 / (width * np.maximum(heavy, 1e-290)[:, None] * w[None, :])
        rows = np.concatenate([self.scale, np.ones(width - n)])
        turned = rows[:, None] / self.scale[None, :]
        return self.tested(dyadic(R * turned, unit * turned), whole_weights(w * self.scale), growth)

    def margin(self, c: complex) -> float:
        """The factor up to which the radii can grow while the rank at a point stays full."""
        n, width = self.near.shape
        E = np.hstack([np.eye(n), np.zeros((n, width - n))])
        R = _right_inverse(c * E - self.near, self.near_D, _REWEIGHTINGS)
        if R is None:
            return 0.0
        size, _, _ = perron(self.moved(R))
        return 1 / size if size > 0 else np.inf

    def tested(self, R: ComplexRows, w: tuple[int, ...], growth: Fraction) -> RegularDiscs:
        """The exact test with R and w, of radii that are multiplied by a factor."""
        n, heavy = len(w), column(w)
        R_1 = R.take(range(n), range(n))
        moved = self.D @ (R.moduli() @ heavy)
        for M in self.tied:
            moved = moved + R.after(M).moduli() @ heavy
        return RegularDiscs(
            R,
            ComplexRows.of(Matrix.identity(n)) + R.after(self.Z0),
            R_1,
            w,
            entries(moved * growth),
            entries(R_1.moduli() @ heavy),
        )


def _right_inverse(Z: Any, D: Floats, rounds: int) -> Any:
    """A right inverse R of Z for which the spectral radius of D |R| is small.

    Among all right inverses G Zᴴ (Z G Zᴴ)⁻¹ the positive diagonal G is changed so that it weighs
    each row of R by what it contributes, in the positive vectors of D |R|.
    """
    g, best, found = np.ones(Z.shape[1]), np.inf, None
    for _ in range(rounds):
        turned = g[:, None] * Z.conj().T
        try:
            R = turned @ np.linalg.inv(Z @ turned)
        except np.linalg.LinAlgError:
            return found
        if not np.all(np.isfinite(R)):
            return found
        size, right, left = perron(D @ np.abs(R))
        if size < best:
            best, found = size, R
        if best < _SMALL:
            return found
        cost, used = left @ D, np.abs(R) @ right
        g = np.sqrt(g * (used + 1e-9 * used.max()) / (cost + 1e-9 * cost.max()))
        g = g / g.max()
    return found


@dataclass
class ControllabilitySearch:
    """The search for evidence about some channels of one system, for several factors of the radii.

    Attributes
    ----------
    system : MultiChannelSystem
    radii : Radii
    channels : tuple of int
    most_squares : int
        The most discs and squares of a cover; there are fewer of a large plant.
    tied : tuple of MultiChannelSystem
        What may be added to the system, each with a factor from −1 to 1.
    tested : int
        How many were tested so far.
    """

    system: MultiChannelSystem
    radii: Radii
    channels: tuple[int, ...]
    most_squares: int = _MOST_SQUARES
    tied: tuple[MultiChannelSystem, ...] = ()
    rng: np.random.Generator = field(default_factory=lambda: np.random.default_rng(0))
    tested: int = 0

    def __post_init__(self) -> None:
        self.box = FloatBox.of(self.system, self.radii, self.tied)
        self.pencil = WidePencil.of(self.system, self.radii, self.box, self.channels, self.tied)

    def capacity(self, outside: Outside) -> float:
        """How far the radii can grow at each eigenvalue of A of which something is claimed."""
        left = (mode for mode in self.box.modes() if not outside.covers(mode))
        return min((self.pencil.margin(mode) for mode in left), default=np.inf)

    def state_gains(self) -> GainBox:
        """The box of gains from the state, which is measured exactly, to the channels."""
        near, n, chosen = self.box, self.system.n, self.channels
        B = hstack([self.system.B(i) for i in chosen], nrows=n)
        free = independent(self.radii, self.tied)
        D_B = hstack([free.B[i] for i in chosen], nrows=n)
        C, none = Matrix.identity(n), Matrix.zeros(n, n)
        floats = replace(
            near,
            B=(np.hstack([near.B[i] for i in chosen]),),
            C=(np.diag(near.scale),),
        )
        moved = (self.radii.A, *(each.A for each in self.tied))
        radii = Radii(free.A, [D_B], [none])
        return GainBox(self.system.A, (B,), (C,), radii, floats, moved)

    def cover(self, growth: Fraction, bound: Fraction | None) -> BoxControllability | None:
        """Evidence for radii that are multiplied by a factor; None if there is none."""
        outside = Outside(self.system.time, bound)
        lists = disc_lists(
            self.state_gains(), self.rng, growth, outside, several=self.system.n >= MANY
        )
        if lists is None:
            return None
        frames = Frames()

        def test(c: Point, rho: Fraction, depth: int) -> int | None:
            k = frames.one_for(c, rho)
            if k is not None:
                return k
            near = complex(to_float(c[0]), to_float(c[1]))
            proposed = self.pencil.proposal(near, to_float(rho), growth)
            return None if proposed is None else frames.added(proposed, c, rho)

        cover = Cover(test, outside, self.most_squares * MANY // max(self.system.n, MANY))
        trees = cover.of(*(each.discs for each in lists))
        self.tested += cover.tested
        if trees is None:
            return None
        return BoxControllability(
            self.system,
            self.system.named(self.channels),
            bound,
            lists,
            tuple(RightInverseFrame(R.evidence(), w) for R, w in frames.evidence),
            trees,
        )


@overload
def box_controllability(
    system: MultiChannelSystem, channels: Iterable[str] | None = ..., *, bound: Any = ...
) -> BoxControllability: ...
@overload
def box_controllability(
    system: ParametricSystem, channels: Iterable[str] | None = ..., *, bound: Any = ...
) -> ParametricBoxControllability: ...
def box_controllability(
    system: MultiChannelSystem | ParametricSystem,
    channels: Iterable[str] | None = None,
    *,
    bound: Any = None,
) -> BoxControllability | ParametricBoxControllability:
    """Prove that some channels control every mode of every plant in a box.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
        A plant with radii, such as ``Box.relative(plant, "1/1000").system``, or a system that
        constructions made from one; or one with parameters, each with a range of two ends: then
        about all values within the ranges (`ParametricBoxControllability`).
    channels : iterable of str, optional
        Names of channels, by default all.
    bound : rational, optional
        A rate from 0 on, or a radius up to 1: modes inside of this region need not be controlled.

    Raises
    ------
    LimitReached
        If no proof was found, which proves nothing.

    Notes
    -----
    Proposed in floating point, and tested exactly: one square after the other, in integers.

    Examples
    --------
    >>> from mcexact import Box
    >>> plant = MultiChannelSystem([[0, 1], [-2, -3]], [[[0], [1]]], [[[1, 0]]])
    >>> box_controllability(Box.relative(plant, "1/10").system).channels
    ('1',)
    >>> box_controllability(Box.absolute(plant, B=[[[0], [1]]]).system)
    Traceback (most recent call last):
        ...
    mcexact.errors.LimitReached: no proof was found that every plant in the box is controllable
    """
    if isinstance(system, ParametricSystem):
        from mcexact.analysis.boxes.parametric_box import parametric_box_controllability

        return parametric_box_controllability(system, channels, bound=bound)
    InputError.require(system, MultiChannelSystem, "system")
    chosen = range(system.m) if channels is None else system.indices(channels)
    limit = None if bound is None else StabilityRegion.of(system.time, bound=bound).edge
    with one_thread():
        search = ControllabilitySearch(system, radii_of(system), tuple(chosen))
        enough = search.capacity(Outside(system.time, limit)) > 1
        found = search.cover(Fraction(1), limit) if enough else None
    if found is None:
        raise LimitReached("no proof was found that every plant in the box is controllable")
    return found


@overload
def box_observability(
    system: MultiChannelSystem, channels: Iterable[str] | None = ..., *, bound: Any = ...
) -> BoxControllability: ...
@overload
def box_observability(
    system: ParametricSystem, channels: Iterable[str] | None = ..., *, bound: Any = ...
) -> ParametricBoxControllability: ...
def box_observability(
    system: MultiChannelSystem | ParametricSystem,
    channels: Iterable[str] | None = None,
    *,
    bound: Any = None,
) -> BoxControllability | ParametricBoxControllability:
    """Prove that some channels observe every mode of every plant in a box.

    The answer is about the controllability of the dual system.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
    channels : iterable of str, optional
    bound : rational, optional
        As for `box_controllability`.

    Raises
    ------
    LimitReached
        If no proof was found, which proves nothing.

    Examples
    --------
    >>> from mcexact import Box
    >>> plant = MultiChannelSystem([[0, 1], [-2, -3]], [[[0], [1]]], [[[1, 0]]])
    >>> box_observability(Box.relative(plant, "1/10").system).subject
    ({'construction': 'dual'},)
    >>> box_observability(Box.absolute(plant, C=[[[1, 0]]]).system)
    Traceback (most recent call last):
        ...
    mcexact.errors.LimitReached: no proof was found that every plant in the box is observable
    """
    try:
        if isinstance(system, ParametricSystem):
            return box_controllability(moved(system, dual), channels, bound=bound)
        InputError.require(system, MultiChannelSystem, "system")
        return box_controllability(dual(system), channels, bound=bound)
    except LimitReached as error:
        told = error.message.replace("is controllable", "is observable")
        raise LimitReached(told.replace("is not controlled", "is not observed")) from None
