"""Fixed modes, controllability and set-points of every member.

A member is a plant in a box, where each entry has a radius, or the plant at one point of the ranges
of its parameters.  Each function proves its property for all members of either family, or raises
`LimitReached`, which proves nothing.  `boxes.cells` cuts ranges in half until each cell is proved;
a box is one cell.  The proof of a cell has three parts:

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
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any, overload

import numpy as np
import numpy.typing as npt

from mcexact.analysis.boxes.cells import proofs
from mcexact.analysis.boxes.cover import (
    MANY,
    Cover,
    GainBox,
    Outside,
    Test,
    disc_lists,
    trees_beyond,
)
from mcexact.analysis.boxes.pencils import (
    ComplexRows,
    FloatBox,
    Floats,
    Frames,
    Members,
    Pencil,
    Point,
    RegularDiscs,
    column,
    dyadic,
    entries,
    gain_pencil,
    perron,
    radii_of,
    require_radii,
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
from mcexact.derived.constructions import dual, rearranged, setpoint_system
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

    ranking = ranked(shape.vector(each) for each in known)[:_KNOWN]
    ranking += ranked(_start(box, shape, rng) for _ in range(_DRAWS * starts))[:starts]
    least, best = min(ranking, key=lambda each: each[0])
    if np.exp(-least) > _ENOUGH * target:
        return float(np.exp(-least)), shape.gains(best)
    for _, t in ranking:
        unit = np.maximum(np.abs(t), 1e-3 * np.abs(t).max())

        def scaled(z: Floats, unit: Floats = unit) -> tuple[float, Floats]:
            size, gradient = value(z * unit)
            return size, gradient * unit

        result = minimize(
            scaled, t / unit, jac=True, method="L-BFGS-B", options={"maxiter": _ROUNDS}
        )
        if result.fun < least:
            least, best = float(result.fun), result.x * unit
        if np.exp(-least) > _GOOD * target:
            break
    return float(np.exp(-least)), shape.gains(best)


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
    by_t = np.concatenate(gradient) / value
    return float(np.log(value)), np.where(np.isfinite(by_t), by_t, 0.0)


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


@dataclass(frozen=True)
class _Work:
    """What the search for a proof may do.

    Attributes
    ----------
    squares : int
        The most discs and squares of a cover; there are fewer of a large plant.
    own_gains : int
        For at most so many squares gains are searched that no other square has used before.
    """

    squares: int
    own_gains: int


_OF_BOX, _OF_CELL = _Work(3000, 12), _Work(200, 1)
"""A cell that needs more is cut."""
_NEAREST = 10
_OWN_GAINS_AT = (3, 6, 10, 15)
"""A square that fails at one of these depths gets gains of its own."""
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
    """The search for a proof about all members, which keeps its gains for further radii.

    Attributes
    ----------
    members : Members
    starts : int
        How many local searches for gains there are at most at a point.
    several : bool, optional
        Whether to intersect the exterior discs of several matrices A_F; by default for large
        plants only.
    work : _Work
    tested : int
        The number of discs and squares tested so far.
    """

    members: Members
    starts: int = 4
    several: bool | None = None
    work: _Work = _OF_BOX
    known: list[_Known] = field(default_factory=list)
    rng: np.random.Generator = field(default_factory=lambda: np.random.default_rng(0))
    tested: int = 0

    def __post_init__(self) -> None:
        self.box = FloatBox.of(self.members)
        if self.several is None:
            self.several = self.members.system.n >= MANY
        self.alone = _Known(0j, None, self._pencil(None))

    def _pencil(self, gains: PencilGains | None) -> Pencil:
        X, W = (None, None) if gains is None else (gains.X, gains.W)
        return gain_pencil(self.members, self.box.scale, X, W)

    def reuse(self, other: FixedModeSearch) -> None:
        """Adopt the gains of another search, about a system of the same shapes."""
        for each in other.known:
            self.known.append(_Known(each.point, each.gains, self._pencil(each.gains)))

    def learn(self, point: complex, target: float, size: float = 0.0) -> float:
        """Search gains for a point, and return how far the radii can grow there with them.

        The search ends early far above the factor ``target`` of the radii.  The gains have to
        suffice on the disc of radius ``size`` around the point: those that are best at the point
        alone can make the pencil nearly singular beside it.
        """
        box = self.box.wider(size / target)
        known = [_floats(each.gains) for each in self.known if size and each.gains is not None]
        best = best_gains(box, point, self.rng, starts=self.starts, target=target, known=known)
        if best is None:
            return 0.0
        gains = PencilGains(*exact_gains(best[1]))
        self.known.append(_Known(point, gains, self._pencil(gains)))
        return self.known[-1].pencil.margin(point)

    def prepare(
        self, target: float, outside: Outside, lists: Sequence[ExteriorDiscs] = ()
    ) -> float:
        """Learn gains for all modes, and return how far the radii can grow at each of them.

        A mode is left out if, for one of the lists, no disc contains it.
        """
        least = np.inf
        for mode in self.box.modes():
            # A mode well inside of the region is left out, as its disc will be.
            if outside.has_point(mode) or not all(_among(mode, each.discs) for each in lists):
                continue
            best = max((each.pencil.margin(mode) for each in self.known), default=0.0)
            if best <= _REUSED * target:
                best = max(best, self.learn(mode, target))
            least = min(least, best)
        return float(least)

    def improve(self, outside: Outside, rounds: int) -> float:
        """Search gains at the mode that limits the radii, and return how far these can grow."""
        least = 0.0
        for k in range(rounds + 1):
            modes = [mode for mode in self.box.modes() if not outside.has_point(mode)]
            best = [(max(e.pencil.margin(mode) for e in self.known), mode) for mode in modes]
            if not best or not self.known:
                return np.inf
            least, mode = min(best, key=lambda each: each[0])
            if k < rounds:
                self.learn(mode, _NEVER_ENOUGH)
        return float(least)

    def capacity(self, outside: Outside) -> float:
        """How far the radii can grow at the modes; infinite if that is not known in advance.

        Of a large plant few modes are left where the discs of several matrices meet.
        """
        return np.inf if self.several else self.prepare(1.0, outside)

    def evidence(self, factor: Fraction, outside: Outside) -> FixedModesOfCell | None:
        """Search a proof for radii that are multiplied by a factor; None if the search fails."""
        whole = GainBox.of(self.members, self.box)
        lists = disc_lists(whole, self.rng, factor, outside, several=bool(self.several))
        if lists is None:
            return None
        if len(lists) > 1 and self.prepare(float(factor), outside, lists) <= factor:
            return None
        leaves = _Leaves(self, factor)
        trees, tested = _trees(leaves.test, outside, self.work, lists)
        self.tested += tested
        if trees is None:
            return None
        gains = list(dict.fromkeys(g for g in leaves.gains if g is not None))
        frames = tuple(
            PencilFrame(None if g is None else gains.index(g), V.evidence(), w)
            for g, (V, w) in zip(leaves.gains, leaves.frames.evidence, strict=True)
        )
        return FixedModesOfCell(lists, tuple(gains), frames, trees)


def _trees(
    test: Test, outside: Outside, work: _Work, lists: Sequence[ExteriorDiscs]
) -> tuple[tuple[tuple[int | None, ...], ...] | None, int]:
    """The trees of squares over the first discs, and how many discs and squares were tested."""
    n = len(lists[0].discs)
    cover = Cover(test, outside, work.squares * MANY // max(n, MANY))
    return cover.of(*(each.discs for each in lists)), cover.tested


@dataclass
class _Leaves:
    """The tests of discs for one factor of the radii, and the evidence that passed them."""

    search: FixedModeSearch
    factor: Fraction
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
            k = self._added(each, c, near, rho, size)
            if k is not None:
                return k
        if depth in _OWN_GAINS_AT and self.own < self.search.work.own_gains:
            self.own += 1
            if self.search.learn(near, 2 * float(self.factor), size) > float(self.factor):
                return self._added(self.search.known[-1], c, near, rho, size)
        return None

    def _added(
        self, each: _Known, c: Point, near: complex, rho: Fraction, size: float
    ) -> int | None:
        proposed = each.pencil.proposal(near, size, self.factor)
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
    """Prove that no member of a family has a fixed mode, or none outside of a region.

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
    UsageError
        If every entry of the plant is certain.
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
    >>> from mcexact.boxes import Box
    >>> plant = MultiChannelSystem([[0, 1], [-2, -3]], [[[0], [1]]], [[[1, 0]]])
    >>> box_fixed_modes(Box.relative(plant, "1/100").system).bound is None
    True
    >>> box_fixed_modes(Box.absolute(plant, B=[[[0], [1]]]).system)
    Traceback (most recent call last):
        ...
    mcexact.errors.LimitReached: no proof was found that no plant in the box has a fixed mode
    """
    spectrum = FixedSpectrum.known(spectrum, system, "spectrum")
    ranged = isinstance(system, ParametricSystem)
    require_radii(system)
    limit = None if bound is None else StabilityRegion.of(system.time, bound=bound).edge
    if spectrum is not None and not ranged:
        _require_nominal(spectrum, limit)
    outside = Outside(system.time, limit)
    several, work = (False, _OF_CELL) if ranged else (None, _OF_BOX)
    searches: list[FixedModeSearch] = []

    def evidence(members: Members) -> FixedModesOfCell | None:
        search = FixedModeSearch(members, starts, several, work)
        for latest in searches[-1:]:
            search.reuse(latest)
        searches.append(search)
        return search.evidence(Fraction(1), outside) if search.capacity(outside) > 1 else None

    def fails(plant: MultiChannelSystem) -> bool:
        nominal = fixed_spectrum(plant)
        if limit is None:
            return not nominal.empty
        return not nominal.stabilizable if limit == StabilityRegion(system.time).edge else False

    where = "" if limit is None else " outside of the region"
    cuts, parts = proofs(
        system,
        evidence,
        fails,
        claim=f"no plant in the box has a fixed mode{where}",
        failure=f"a mode{where} is fixed",
    )
    if isinstance(system, ParametricSystem):
        return ParametricBoxFixedModes(system, limit, cuts, parts)
    return BoxFixedModes(system, limit, **vars(parts[0]))


def _require_nominal(spectrum: FixedSpectrum, limit: Fraction | None) -> None:
    """Raise `LimitReached` if the nominal plant itself fails."""
    if limit is None and not spectrum.empty:
        raise LimitReached("the plant itself has a fixed mode, at its nominal values")
    if limit is not None and not spectrum.stabilizable:
        raise LimitReached("the plant itself is not stabilizable, at its nominal values")


@overload
def box_stabilizability(
    system: MultiChannelSystem,
    *,
    spectrum: FixedSpectrum | None = ...,
    nothing_fixed: BoxFixedModes | None = ...,
) -> BoxFixedModes: ...
@overload
def box_stabilizability(system: ParametricSystem) -> ParametricBoxFixedModes: ...
def box_stabilizability(
    system: MultiChannelSystem | ParametricSystem,
    *,
    spectrum: FixedSpectrum | None = None,
    nothing_fixed: BoxFixedModes | None = None,
) -> BoxFixedModes | ParametricBoxFixedModes:
    """Prove that each member of a family is stabilized by a decentralized controller of its own.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
        As for `box_fixed_modes`.
    spectrum : FixedSpectrum, optional
        As for `box_fixed_modes`.
    nothing_fixed : BoxFixedModes, optional
        The proof that no member has a fixed mode, if it is known: a part of it is the proof.

    Raises
    ------
    UsageError
        If every entry of the plant is certain.
    LimitReached
        If no proof was found, which proves nothing.

    Notes
    -----
    No member has a fixed mode in the closed right half-plane, or, in discrete time, of modulus 1 or
    more.  `box_stability` proves that a single controller serves all members.

    Examples
    --------
    >>> from mcexact.boxes import Box
    >>> plant = MultiChannelSystem([[1, 0], [0, -2]], [[[1], [0]]], [[[1, 0]]])
    >>> box_stabilizability(Box.relative(plant, "1/100").system).bound
    Fraction(0, 1)
    """
    spectrum = FixedSpectrum.known(spectrum, system, "spectrum")
    if isinstance(system, ParametricSystem):
        return box_fixed_modes(system, bound=StabilityRegion(system.time).edge)
    require_radii(system)
    edge = StabilityRegion(system.time).edge
    whole = BoxFixedModes.known(nothing_fixed, system, "nothing_fixed")
    if whole is not None and whole.bound is None and radii_of(whole.about) == radii_of(system):
        part = _beyond(whole, Outside(system.time, edge))
        return BoxFixedModes(system, edge, **vars(part))
    return box_fixed_modes(system, bound=edge, spectrum=spectrum)


def _beyond(proof: BoxFixedModes, outside: Outside) -> FixedModesOfCell:
    """The part of a proof about all complex numbers that a claim about fewer needs."""
    lists = [each.discs for each in proof.exterior]
    trees = trees_beyond(outside, proof.cover, *lists)
    frames = sorted({k for tree in trees for k in tree if k is not None})
    gains = sorted({g for k in frames if (g := proof.frames[k].gains) is not None})
    return FixedModesOfCell(
        proof.exterior,
        tuple(proof.gains[g] for g in gains),
        tuple(
            replace(each, gains=None if each.gains is None else gains.index(each.gains))
            for each in (proof.frames[k] for k in frames)
        ),
        tuple(tuple(None if k is None else frames.index(k) for k in tree) for tree in trees),
    )


# Controllability of the members, by right inverses of [λI − A, −B_T].

_REWEIGHTINGS, _FEW = 40, 10
_SMALL = 0.9
"""A right inverse with so small a norm is used as it is."""
_LITTLE = 0.01
"""A norm below 1 that falls by less is as good as one that falls further."""


@dataclass(frozen=True, eq=False)
class WidePencil:
    """[λI − A, −B] and its radii, exactly and in balanced coordinates.

    Attributes
    ----------
    Z0, D : Matrix, n × (n + p)
        [A, B] and the radii.
    near, near_D : ndarray
        Z0 and D in balanced coordinates; here the moduli of the generators are added to D.
    scale : ndarray, n
    generators : tuple of Matrix
        Matrices that may be added to Z0, each with a factor from −1 to 1.
    near_independent, near_generators : ndarray, tuple of ndarray
        The radii alone, and the generators, in balanced coordinates.
    """

    Z0: Matrix
    D: Matrix
    near: Floats
    near_D: Floats
    scale: Floats
    generators: tuple[Matrix, ...]
    near_independent: Floats
    near_generators: tuple[Floats, ...]

    @classmethod
    def of(cls, members: Members, box: FloatBox, channels: Iterable[int]) -> WidePencil:
        """Make the pencil of some channels of some members."""
        system, chosen, n = members.system, sorted(channels), members.system.n

        def wide(A: Matrix, B: Sequence[Matrix]) -> Matrix:
            return hstack([A, *(B[i] for i in chosen)], nrows=n)

        def near(M: Matrix) -> Floats:
            cols = np.concatenate([box.scale, np.ones(M.ncols - n)])
            return np.asarray(matrix_to_float(M) / box.scale[:, None] * cols[None, :])

        generators = tuple(wide(each.A, each.B) for each in members.generators)
        D = wide(members.radii.A, members.radii.B)
        return cls(
            wide(system.A, system.B),
            D,
            np.hstack([box.A, *(box.B[i] for i in chosen)]),
            np.hstack([box.DA, *(box.DB[i] for i in chosen)]),
            box.scale,
            generators,
            near(D),
            tuple(map(near, generators)),
        )

    def deviation(self, R: Any) -> Floats:
        """An upper limit of the moduli of (Z0' − Z0) R for all members Z0'."""
        own = self.near_independent @ np.abs(R)
        return np.asarray(own + sum(np.abs(M @ R) for M in self.near_generators))

    def proposal(self, c: complex, rho: float, factor: Fraction) -> RegularDiscs | None:
        """Propose a proof that the pencil has full rank on a disc; None without a proposal."""
        n, width = self.near.shape
        E = np.hstack([np.eye(n), np.zeros((n, width - n))])
        Z, D = c * E - self.near, float(factor) * self.near_D + rho * E
        R = _right_inverse(Z, D, _FEW, below_one=True)
        part = float(factor)
        w = None if R is None else weights(part * self.deviation(R) + rho * E @ np.abs(R))
        if R is None or w is None:
            return None
        heavy = ((np.abs(Z) + D) / w[:, None]).max(axis=0)
        unit = 1 / (width * np.maximum(heavy, 1e-290)[:, None] * w[None, :])
        rows = np.concatenate([self.scale, np.ones(width - n)])
        ratios = rows[:, None] / self.scale[None, :]
        return self.tested(dyadic(R * ratios, unit * ratios), whole_weights(w * self.scale), factor)

    def margin(self, c: complex) -> float:
        """The factor up to which the radii can grow while the rank at a point stays full."""
        n, width = self.near.shape
        E = np.hstack([np.eye(n), np.zeros((n, width - n))])
        R = _right_inverse(c * E - self.near, self.near_D, _REWEIGHTINGS)
        if R is None:
            return 0.0
        size, _, _ = perron(self.deviation(R))
        return 1 / size if size > 0 else np.inf

    def tested(self, R: ComplexRows, w: tuple[int, ...], factor: Fraction) -> RegularDiscs:
        """The exact test with R and w, of radii that are multiplied by a factor."""
        n, heavy = len(w), column(w)
        R_1 = R.take(range(n), range(n))
        deviation = self.D @ (R.moduli() @ heavy)
        for M in self.generators:
            deviation = deviation + R.after(M).moduli() @ heavy
        return RegularDiscs(
            R,
            ComplexRows.of(Matrix.identity(n)) + R.after(self.Z0),
            R_1,
            w,
            entries(deviation * factor),
            entries(R_1.moduli() @ heavy),
        )


def _right_inverse(Z: Any, D: Floats, rounds: int, *, below_one: bool = False) -> Any:
    """A right inverse R of Z for which the spectral radius of D |R| is small.

    Among all right inverses G Zᴴ (Z G Zᴴ)⁻¹ the positive diagonal G is changed so that it weighs
    each row of R by what it contributes, in the positive vectors of D |R|.  If any radius
    ``below_one`` serves, the search ends with one that hardly falls any more.
    """
    g, least, best = np.ones(Z.shape[1]), np.inf, None
    for _ in range(rounds):
        weighted = g[:, None] * Z.conj().T
        try:
            R = weighted @ np.linalg.inv(Z @ weighted)
        except np.linalg.LinAlgError:
            return best
        if not np.all(np.isfinite(R)):
            return best
        size, right, left = perron(D @ np.abs(R))
        fall = least - size
        if fall > 0:
            least, best = size, R
        if least < _SMALL or (below_one and least < 1 and fall < _LITTLE):
            return best
        cost, used = left @ D, np.abs(R) @ right
        g = np.sqrt(g * (used + 1e-9 * used.max()) / (cost + 1e-9 * cost.max()))
        g = g / g.max()
    return best


@dataclass
class ControllabilitySearch:
    """The search for a proof that channels control all members, for several factors of the radii.

    Attributes
    ----------
    members : Members
    channels : tuple of int
    work : _Work
    tested : int
        The number of discs and squares tested so far.
    """

    members: Members
    channels: tuple[int, ...]
    work: _Work = _OF_BOX
    rng: np.random.Generator = field(default_factory=lambda: np.random.default_rng(0))
    tested: int = 0

    def __post_init__(self) -> None:
        self.box = FloatBox.of(self.members)
        self.pencil = WidePencil.of(self.members, self.box, self.channels)

    def capacity(self, outside: Outside) -> float:
        """How far the radii can grow at the eigenvalues of A that the claim is about."""
        left = (mode for mode in self.box.modes() if not outside.has_point(mode))
        return min((self.pencil.margin(mode) for mode in left), default=np.inf)

    def state_gains(self) -> GainBox:
        """The box of the plant whose channels measure the whole state without uncertainty."""
        system, radii, near = self.members.system, self.members.independent, self.box
        n, chosen = system.n, self.channels
        B = hstack([system.B(i) for i in chosen], nrows=n)
        D_B = hstack([radii.B[i] for i in chosen], nrows=n)
        C, none = Matrix.identity(n), Matrix.zeros(n, n)
        floats = replace(
            near,
            B=(np.hstack([near.B[i] for i in chosen]),),
            C=(np.diag(near.scale),),
        )
        return GainBox(
            system.A,
            (B,),
            (C,),
            Radii(radii.A, [D_B], [none]),
            floats,
            self.members.radii.A,
            tuple(each.A for each in self.members.generators),
        )

    def evidence(self, factor: Fraction, outside: Outside) -> ControlOfCell | None:
        """Search a proof for radii that are multiplied by a factor; None if the search fails."""
        several = self.members.system.n >= MANY
        lists = disc_lists(self.state_gains(), self.rng, factor, outside, several=several)
        if lists is None:
            return None
        frames = Frames()

        def test(c: Point, rho: Fraction, depth: int) -> int | None:
            k = frames.one_for(c, rho)
            if k is not None:
                return k
            near = complex(to_float(c[0]), to_float(c[1]))
            proposed = self.pencil.proposal(near, to_float(rho), factor)
            return None if proposed is None else frames.added(proposed, c, rho)

        trees, tested = _trees(test, outside, self.work, lists)
        self.tested += tested
        if trees is None:
            return None
        inverses = tuple(RightInverseFrame(R.evidence(), w) for R, w in frames.evidence)
        return ControlOfCell(lists, inverses, trees)


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
    """Prove that some channels control every mode of every member of a family.

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
    UsageError
        If every entry of the plant is certain.
    LimitReached
        If no proof was found, which proves nothing.

    Notes
    -----
    Floating point proposes the proof; every square is tested exactly, in integers.

    Examples
    --------
    >>> from mcexact.boxes import Box
    >>> plant = MultiChannelSystem([[0, 1], [-2, -3]], [[[0], [1]]], [[[1, 0]]])
    >>> box_controllability(Box.relative(plant, "1/10").system).channels
    ('1',)
    >>> box_controllability(Box.absolute(plant, B=[[[0], [1]]]).system)
    Traceback (most recent call last):
        ...
    mcexact.errors.LimitReached: no proof was found that every plant in the box is controllable
    """
    require_radii(system)
    chosen = tuple(range(system.m)) if channels is None else tuple(system.indices(channels))
    named = system.named(chosen)
    limit = None if bound is None else StabilityRegion.of(system.time, bound=bound).edge
    outside = Outside(system.time, limit)
    work = _OF_CELL if isinstance(system, ParametricSystem) else _OF_BOX

    def evidence(members: Members) -> ControlOfCell | None:
        search = ControllabilitySearch(members, chosen, work)
        return search.evidence(Fraction(1), outside) if search.capacity(outside) > 1 else None

    def fails(plant: MultiChannelSystem) -> bool:
        return limit is None and not joint_controllability(plant, named).controllable

    cuts, parts = proofs(
        system,
        evidence,
        fails,
        claim="every plant in the box is controllable",
        failure="a mode is not controlled",
    )
    if isinstance(system, ParametricSystem):
        return ParametricBoxControllability(system, named, limit, cuts, parts)
    return BoxControllability(system, named, limit, **vars(parts[0]))


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
    """Prove that some channels observe every mode of every member of a family.

    The answer is about the controllability of the dual system.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
    channels : iterable of str, optional
    bound : rational, optional
        As for `box_controllability`.

    Raises
    ------
    UsageError
        If every entry of the plant is certain.
    LimitReached
        If no proof was found, which proves nothing.

    Examples
    --------
    >>> from mcexact.boxes import Box
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
            return box_controllability(rearranged(system, dual), channels, bound=bound)
        InputError.require(system, MultiChannelSystem, "system")
        return box_controllability(dual(system), channels, bound=bound)
    except LimitReached as error:
        message = error.message.replace("is controllable", "is observable")
        raise LimitReached(message.replace("is not controlled", "is not observed")) from None


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
    UsageError
        If every entry of the plant is certain.
    LimitReached
        If no proof was found, which proves nothing.

    Notes
    -----
    A decentralized linear time-invariant controller that stabilizes the plant with its integrators
    holds every output at its set-point: at rest each integrator has a constant value, so that its
    input, the deviation, is 0.  `box_stability` proves that one controller serves all members.

    Examples
    --------
    >>> from mcexact.boxes import Box
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
    require_radii(system)
    known = SetpointSolvability.known(solvability, system, "solvability")
    if known is not None and not known.solvable:
        raise LimitReached("some set-points of the plant itself have no equilibrium")
    return box_stabilizability(setpoint_system(system))
