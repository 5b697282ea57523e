"""Fixed modes, controllability and set-points of every member.

A member is a plant in a box, where each entry has a radius, or the plant at one point of the ranges
of its parameters.  Each function proves its property for all members, or raises `LimitReached`,
which proves nothing.  A proof has three parts:

1. discs that contain all eigenvalues of all members (`boxes.cover`);
2. a tree of squares over these discs, without what lies inside of an allowed region;
3. for each leaf of the tree a matrix pencil that is regular on its disc for every member, by the
   exact test of `boxes.pencils`.

Floating point proposes all of these, and the tests are done in integers.  Each leaf costs the
inverse of a pencil.  The questions differ in the pencil:

- No mode is fixed (`box_fixed_modes`): λ is not fixed where [[λI − A, −B], [XC, W]] is nonsingular
  for some X and W that are block diagonal by channel.  One choice of gains X and W serves only a
  part of the plane, so a leaf tries gains known nearby, then λI − A alone, then its own.
  `best_gains` searches for those with which the radii can grow most: L-BFGS, from several starts,
  minimizes the logarithm of the spectral radius of |Z⁻¹| D, Z the pencil and D its radii.
- Each member has a stabilizing decentralized controller (`box_stabilizability`), or one that holds
  set-points (`box_setpoints`): the same outside of the region of stability, for set-points of the
  plant with an integrator of every output.
- Channels T control every mode (`box_controllability`): [λI − A, −B_T] has a right inverse, which
  needs no search for gains.  `box_observability` decides it of the dual system.

For plants with parameters the ranges are cut in half until each cell has such a proof
(`boxes.cells`).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any, overload

import numpy as np
import numpy.typing as npt

from mcexact.analysis.boxes.cells import CellBox, proofs_of_cells
from mcexact.analysis.boxes.cover import MANY, Cover, GainBox, Outside, disc_lists
from mcexact.analysis.boxes.pencils import (
    ComplexRows,
    FloatBox,
    Floats,
    Frames,
    Pencil,
    Point,
    RegularDiscs,
    column,
    dyadic,
    entries,
    gain_pencil,
    independent,
    one_thread,
    perron,
    radii_of,
    weights,
    whole_weights,
)
from mcexact.analysis.controllability import joint_controllability
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.answer.boxes import (
    BoxControllability,
    BoxFixedModes,
    ControlOfCell,
    FixedModesOfCell,
    ParametricBoxControllability,
    ParametricBoxFixedModes,
    PencilFrame,
    PencilGains,
    RightInverseFrame,
)
from mcexact.answer.evidence import ExteriorDiscs, RootDisc
from mcexact.answer.modes import FixedSpectrum
from mcexact.answer.structure import SetpointSolvability
from mcexact.derived.constructions import dual, moved, setpoint_system
from mcexact.errors import InputError, LimitReached
from mcexact.exact.matrix import Matrix, hstack, matrix_to_float, to_float
from mcexact.exact.roots import StabilityRegion
from mcexact.model.parametric import ParametricSystem
from mcexact.model.radii import Radii
from mcexact.model.system import MultiChannelSystem

# Gains with which the pencil of a box stays regular at a point, proposed in floating point.

Gains = tuple[tuple[Floats, ...], tuple[Floats, ...]]

_ROUNDS = 60
_DRAWS = 8
_KNOWN = 2
_ENOUGH, _GOOD = 8.0, 4.0
"""A start is used as it is from the first multiple of the target on, a result from the second."""
_GAIN_BITS = 20


@dataclass(frozen=True)
class _Shape:
    """Sizes p_i and q_i, and where the entries of X_i and W_i are in a vector."""

    sizes: tuple[tuple[int, int], ...]

    def gains(self, t: Floats) -> Gains:
        X, W, k = [], [], 0
        for p, q in self.sizes:
            X.append(t[k : k + p * q].reshape(p, q))
            W.append(t[k + p * q : k + p * q + p * p].reshape(p, p))
            k += p * q + p * p
        return tuple(X), tuple(W)

    def vector(self, gains: Gains) -> Floats:
        return np.concatenate([M.ravel() for both in zip(*gains, strict=True) for M in both])


def best_gains(
    box: FloatBox,
    point: complex,
    rng: np.random.Generator,
    *,
    starts: int = 4,
    target: float = 1.0,
    known: Sequence[Gains] = (),
) -> tuple[float, Gains] | None:
    """Search gains for a point, and return how far the radii can then grow, and the gains.

    Parameters
    ----------
    box : FloatBox
    point : complex
    rng : numpy.random.Generator
    starts : int
        How many local searches there are at most.
    target : float
        The factor of the radii that is needed; the search ends early far above it.
    known : sequence of gains
        Local searches begin at the best two of these, too.

    Returns
    -------
    (float, gains) or None
        None without inputs.
    """
    from scipy.optimize import minimize

    shape = _Shape(tuple((B.shape[1], C.shape[0]) for B, C in zip(box.B, box.C, strict=True)))
    if not any(p for p, _ in shape.sizes):
        return None

    def value(t: Floats) -> tuple[float, Floats]:
        return _logarithm(box, shape, t, point)

    def ranked(vectors: Iterable[Floats]) -> list[tuple[float, Floats]]:
        return sorted(((value(t)[0], t) for t in vectors), key=lambda each: each[0])

    begun = ranked(shape.vector(each) for each in known)[:_KNOWN]
    begun += ranked(_start(box, shape, rng) for _ in range(_DRAWS * starts))[:starts]
    best, found = min(begun, key=lambda each: each[0])
    if np.exp(-best) > _ENOUGH * target:
        return float(np.exp(-best)), shape.gains(found)
    for _, t in begun:
        unit = np.maximum(np.abs(t), 1e-3 * np.abs(t).max())

        def scaled(z: Floats, unit: Floats = unit) -> tuple[float, Floats]:
            size, gradient = value(z * unit)
            return size, gradient * unit

        result = minimize(
            scaled, t / unit, jac=True, method="L-BFGS-B", options={"maxiter": _ROUNDS}
        )
        if result.fun < best:
            best, found = float(result.fun), result.x * unit
        if np.exp(-best) > _GOOD * target:
            break
    return float(np.exp(-best)), shape.gains(found)


def exact_gains(gains: Gains) -> tuple[tuple[Matrix, ...], tuple[Matrix, ...]]:
    """Round gains to dyadic numbers; each row of [X_i, W_i] is scaled to a largest entry near 1."""
    X_exact, W_exact = [], []
    for X, W in zip(*gains, strict=True):
        both = np.hstack([X, W])
        top = np.abs(both).max(axis=1, initial=0.0)
        both = both / np.exp2(np.floor(np.log2(np.maximum(top, 1e-290))))[:, None]
        exact = Matrix.from_rows([[_short(x) for x in row] for row in both.tolist()], both.shape[1])
        q = X.shape[1]
        X_exact.append(exact.take(cols=range(q)))
        W_exact.append(exact.take(cols=range(q, q + W.shape[1])))
    return tuple(X_exact), tuple(W_exact)


def _short(x: float) -> Fraction:
    """A number with some significant bits."""
    mantissa, exponent = np.frexp(x)
    return Fraction(round(float(mantissa) * 2**_GAIN_BITS)) * Fraction(2) ** (
        int(exponent) - _GAIN_BITS
    )


def _start(box: FloatBox, shape: _Shape, rng: np.random.Generator) -> Floats:
    """Draw gains of a drawn size, with W = I."""
    size = 10 ** rng.uniform(-2, 2) * max(float(np.linalg.norm(box.A)), 1e-12)
    parts: list[Floats] = []
    for B, C, (p, q) in zip(box.B, box.C, shape.sizes, strict=True):
        around = max(float(np.linalg.norm(B)) * float(np.linalg.norm(C)), 1e-300)
        signs = rng.choice([-1, 0, 1], p=[0.4, 0.2, 0.4], size=(p, q))
        X = signs * rng.uniform(0.3, 1, size=(p, q)) * size / around
        parts += [X.ravel(), np.eye(p).ravel()]
    return np.concatenate(parts)


def _logarithm(box: FloatBox, shape: _Shape, t: Floats, point: complex) -> tuple[float, Floats]:
    """The logarithm of the spectral radius of |Z⁻¹| D, and its gradient by the entries of X and W.

    With positive vectors l and r, lᵀr = 1, and Y = Z⁻¹: dρ = lᵀ d(|Y| D) r, dY = −Y dZ Y.
    """
    X, W = shape.gains(t)
    Z, D = _pencil(box, X, W, point)
    try:
        Y = np.linalg.inv(Z)
    except np.linalg.LinAlgError:
        return 1e6, np.zeros_like(t)
    size = np.abs(Y)
    value, right, left = perron(size @ D)
    if not (np.isfinite(value) and value > 0):
        return 1e6 if not np.isfinite(value) else -700.0, np.zeros_like(t)
    left = left / (left @ right)
    phase = np.conj(Y) / np.maximum(size, 1e-300)
    K = phase * np.outer(left, D @ right)
    by_Z = -np.real(Y @ K.T @ Y).T
    by_D = np.outer(size.T @ left, right)
    gradient, n, start = [], box.n, box.n
    for X_i, W_i, C_i, DC_i in zip(X, W, box.C, box.DC, strict=True):
        rows = slice(start, start + len(W_i))
        by_X = by_Z[rows, :n] @ C_i.T + np.sign(X_i) * (by_D[rows, :n] @ DC_i.T)
        gradient += [by_X.ravel(), by_Z[rows, rows].ravel()]
        start += len(W_i)
    found = np.concatenate(gradient) / value
    return float(np.log(value)), np.where(np.isfinite(found), found, 0.0)


def _pencil(
    box: FloatBox, X: Sequence[Floats], W: Sequence[Floats], point: complex
) -> tuple[npt.NDArray[np.complex128], Floats]:
    """[[λI − A, −B], [XC, W]] at a point, and the radii of its entries."""
    n, p = box.n, sum(map(len, W))
    Z = np.zeros((n + p, n + p), dtype=np.complex128)
    D = np.zeros((n + p, n + p))
    Z[:n, :n], D[:n, :n] = point * np.eye(n) - box.A, box.DA
    start = n
    for B, DB, C, DC, X_i, W_i in zip(box.B, box.DB, box.C, box.DC, X, W, strict=True):
        rows = slice(start, start + len(W_i))
        Z[:n, rows], D[:n, rows] = -B, DB
        Z[rows, :n], D[rows, :n] = X_i @ C, np.abs(X_i) @ DC
        Z[rows, rows] = W_i
        start += len(W_i)
    return Z, D


# Fixed modes of the members, with other gains for each part of the plane.

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
    """Gains for a point, with their pencil; without gains (None) the pencil is λI − A."""

    point: complex
    gains: PencilGains | None
    pencil: Pencil


@dataclass
class FixedModeSearch:
    """The search for a proof about one system, which keeps its gains for further radii.

    Attributes
    ----------
    system : MultiChannelSystem
    radii : Radii
    starts : int
        How many local searches for gains there are at most at a point.
    most_squares : int
        The most discs and squares of a cover; there are fewer of a large plant.
    several : bool, optional
        Whether to intersect the exterior discs of several matrices A_F; by default for large
        plants only.
    tied : tuple of MultiChannelSystem
        What may be added to the system, each with a factor from −1 to 1.
    most_own : int
        For at most so many squares gains are searched that no other square has used before.
    tested : int
        The number of discs and squares tested so far.
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
        """Adopt the gains of another search, about a system of the same shapes."""
        for each in other.known:
            self.known.append(_Known(each.point, each.gains, self._pencil(each.gains)))

    def learn(self, point: complex, growth: float, size: float = 0.0) -> float:
        """Search gains for a point, and return how far the radii can grow there with them.

        The gains have to suffice on the disc of radius ``size`` around the point: those that are
        best at the point alone can make the pencil nearly singular beside it.
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

        A mode is left out if, for one of the lists, no disc contains it.
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
        """Search gains at the mode that limits the radii, and return how far these can grow."""
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
        """Search a proof for radii that are multiplied by a factor; None if the search fails.

        The answer names the box of the system itself: with a factor other than 1 it has to be
        rewritten for the larger or smaller box before it is a certificate.
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
        """The position of a frame that proves that a disc has no fixed mode; None without one."""
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
        The fixed spectrum of the nominal plant, which has no parameters, if it is known: if a
        fixed mode already violates the claim, no proof is searched.

    Raises
    ------
    LimitReached
        If no proof was found, which proves nothing.

    Notes
    -----
    Floating point proposes the proof; every square is tested exactly, in integers.  Gains that move
    the modes are searched for each part of the plane.

    Entries that depend on the same parameter change together, which proves more than independent
    radii would.  Ranges are cut in half until each cell is proved.

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
    """Raise `LimitReached` if the nominal plant itself fails."""
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
    No member has a fixed mode in the closed right half-plane, or, in discrete time, of modulus 1 or
    more.  `box_stability` proves that a single controller serves all members.

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


# Controllability of the members, by right inverses of [λI − A, −B_T].

_MOST_SQUARES_CONTROLLABLE = 3000
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
        Z0 and D in balanced coordinates; here the moduli of the tied matrices are added to D.
    scale : ndarray, n
    tied : tuple of Matrix
        Matrices that may be added to Z0, each with a factor from −1 to 1.
    near_rest, near_tied : ndarray, tuple of ndarray
        The radii alone, and the tied matrices, in balanced coordinates.
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
        """Make the pencil of some channels of a box."""
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
        """Propose a proof that the pencil has full rank on a disc; None without a proposal."""
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
    """The search for a proof that channels control all members, for several factors of the radii.

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
        The number of discs and squares tested so far.
    """

    system: MultiChannelSystem
    radii: Radii
    channels: tuple[int, ...]
    most_squares: int = _MOST_SQUARES_CONTROLLABLE
    tied: tuple[MultiChannelSystem, ...] = ()
    rng: np.random.Generator = field(default_factory=lambda: np.random.default_rng(0))
    tested: int = 0

    def __post_init__(self) -> None:
        self.box = FloatBox.of(self.system, self.radii, self.tied)
        self.pencil = WidePencil.of(self.system, self.radii, self.box, self.channels, self.tied)

    def capacity(self, outside: Outside) -> float:
        """How far the radii can grow at the eigenvalues of A that the claim is about."""
        left = (mode for mode in self.box.modes() if not outside.covers(mode))
        return min((self.pencil.margin(mode) for mode in left), default=np.inf)

    def state_gains(self) -> GainBox:
        """The box of the plant whose channels measure the whole state without uncertainty."""
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
        """Search a proof for radii that are multiplied by a factor; None if the search fails."""
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
    Floating point proposes the proof; every square is tested exactly, in integers.

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


# Set-points of the members.


def box_setpoints(
    system: MultiChannelSystem, *, solvability: SetpointSolvability | None = None
) -> BoxFixedModes:
    """Prove that each plant in a box holds set-points by a decentralized controller of its own.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant with radii, such as ``Box.relative(plant, "1/1000").system``.
    solvability : SetpointSolvability, optional
        Whether all set-points of the nominal plant have equilibria, if it is known: if some have
        none, no proof is searched.

    Returns
    -------
    BoxFixedModes
        About the plant with an integrator of every output: no member has a fixed mode in the
        closed right half-plane, or, in discrete time, of modulus 1 or more.

    Raises
    ------
    LimitReached
        If no proof was found, which proves nothing.

    Notes
    -----
    A decentralized linear time-invariant controller that stabilizes the plant with its integrators
    holds every output at its set-point: at rest each integrator has a constant value, so that its
    input, the deviation, is 0.  `box_stability` proves that one controller serves all members.

    Examples
    --------
    >>> from mcexact import Box
    >>> ports = [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]]
    >>> plant = MultiChannelSystem([[1, 0], [1, -2]], *ports)
    >>> proof = box_setpoints(Box.relative(plant, "1/20").system)
    >>> print(proof.explain())
    within the radii: for every plant some decentralized linear time-invariant controller of its \
own holds all outputs at any constant set-points
    >>> twice = MultiChannelSystem([[-1]], [[[1]]], [[[1], [2]]])
    >>> box_setpoints(Box.relative(twice, "1/20").system)
    Traceback (most recent call last):
        ...
    mcexact.errors.LimitReached: no proof was found that no plant in the box has a fixed mode \
outside of the region
    """
    InputError.require(system, MultiChannelSystem, "system")
    known = SetpointSolvability.known(solvability, system, "solvability")
    if known is not None and not known.solvable:
        raise LimitReached("some set-points of the plant itself have no equilibrium")
    return box_stabilizability(setpoint_system(system))


# The same questions for all values of parameters within their ranges.

_MOST_SQUARES_OF_CELL, _MOST_OWN_OF_CELL = 200, 1
"""A cell that needs more squares, or gains for more of them, is cut."""


def parametric_box_fixed_modes(
    system: ParametricSystem, *, bound: Any = None, starts: int = 4
) -> ParametricBoxFixedModes:
    """Prove that no mode is fixed at any values of the parameters within their ranges.

    Parameters
    ----------
    system : ParametricSystem
        Every parameter has a range with two ends.
    bound : rational, optional
        A rate from 0 on, or a radius up to 1: fixed modes inside of this region are allowed.
    starts : int
        How many local searches for gains there are at most at a point.

    Raises
    ------
    LimitReached
        If no proof was found; if a mode is fixed at some values, the message names them.

    Notes
    -----
    Floating point proposes the proof, which is tested exactly.  The ranges are cut in half, one
    parameter at a time, until each cell is proved like a box.  In the box of a cell, all entries
    change with one parameter by the same factor times their slopes.

    Examples
    --------
    >>> plant = ParametricSystem(
    ...     [["k", 1], [0, "-k"]], [[[0], [1]]], [[[1, 0]]], parameters=["k"], assume={"k": (1, 2)}
    ... )
    >>> parametric_box_fixed_modes(plant).cuts
    (None,)
    >>> parametric_box_fixed_modes(plant.along({"k": "k - 3/2"}, ["k"], {"k": (1, 3)})).bound
    """
    InputError.require(system, ParametricSystem, "system")
    limit = None if bound is None else StabilityRegion.of(system.time, bound=bound).edge
    outside = Outside(system.time, limit)
    before: list[FixedModeSearch] = []

    def proved(box: CellBox) -> FixedModesOfCell | None:
        search = FixedModeSearch(
            box.system,
            box.radii,
            starts,
            _MOST_SQUARES_OF_CELL,
            several=False,
            tied=box.tied,
            most_own=_MOST_OWN_OF_CELL,
        )
        for other in before[-1:]:
            search.reuse(other)
        before.append(search)
        found = search.cover(Fraction(1), limit) if search.prepare(1.0, outside) > 1 else None
        if found is None:
            return None
        return FixedModesOfCell(found.exterior, found.gains, found.frames, found.cover)

    def failing(plant: MultiChannelSystem) -> bool:
        spectrum = fixed_spectrum(plant)
        if limit is None:
            return not spectrum.empty
        return not spectrum.stabilizable if limit == StabilityRegion(system.time).edge else False

    said = "a mode is fixed" if limit is None else "a mode outside of the region is fixed"
    cuts, parts = proofs_of_cells(system, proved, failing, said)
    return ParametricBoxFixedModes(system, limit, cuts, parts)


def parametric_box_controllability(
    system: ParametricSystem, channels: Iterable[str] | None = None, *, bound: Any = None
) -> ParametricBoxControllability:
    """Prove that channels control every mode at all values of the parameters within their ranges.

    Parameters
    ----------
    system : ParametricSystem
        Every parameter has a range with two ends.
    channels : iterable of str, optional
        Names of channels, by default all.
    bound : rational, optional
        A rate from 0 on, or a radius up to 1: modes inside of this region need not be controlled.

    Raises
    ------
    LimitReached
        If no proof was found; if a mode is not controlled at some values, the message names them.

    Examples
    --------
    >>> plant = ParametricSystem(
    ...     [[1, "k"], [0, 2]], [[[0], [1]]], [[[1, 0]]], parameters=["k"], assume={"k": (1, 2)}
    ... )
    >>> parametric_box_controllability(plant).channels
    ('1',)
    """
    InputError.require(system, ParametricSystem, "system")
    chosen = range(system.m) if channels is None else system.indices(channels)
    named = system.named(chosen)
    limit = None if bound is None else StabilityRegion.of(system.time, bound=bound).edge
    outside = Outside(system.time, limit)

    def proved(box: CellBox) -> ControlOfCell | None:
        search = ControllabilitySearch(
            box.system, box.radii, tuple(chosen), _MOST_SQUARES_OF_CELL, tied=box.tied
        )
        found = search.cover(Fraction(1), limit) if search.capacity(outside) > 1 else None
        return None if found is None else ControlOfCell(found.exterior, found.frames, found.cover)

    def failing(plant: MultiChannelSystem) -> bool:
        return limit is None and not joint_controllability(plant, named).controllable

    cuts, parts = proofs_of_cells(system, proved, failing, "a mode is not controlled")
    return ParametricBoxControllability(system, named, limit, cuts, parts)
