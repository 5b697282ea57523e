"""The nearest members that fail: small changes by which a pencil loses rank.

A mode is fixed, or not controlled, or on the border of a region, exactly if a pencil λE − Z has too
small a rank.  `Uncertain` looks for the smallest change Δ of Z that makes it so, measured as the
largest |Δ_ij| / D_ij with radii D, in two steps:

1. Sequential linear programs in floating point (`Uncertain.drop`).  With L and R about the left and
   right vectors of the smallest singular values, Lᴴ (λE − Z − Δ) R = 0 is linear in Δ and the
   change of λ, and the largest |Δ_ij| / D_ij is minimized.
2. An exact change near that one, by linear algebra over Q (`Uncertain.exact`).

This is a local search: a nearer plant that fails may exist, and finding none proves nothing.
`failing_plant` tries the pencils of several sets of channels, those that seem nearest first;
`severed_plants` has the plants whose channels have no effect, at a distance that is known without a
search.  Callers decide by an exact analysis that a plant really fails.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from typing import Any, Literal

import numpy as np

from mcexact.analysis.boxes.pencils import Floats
from mcexact.analysis.nearby.corrections import changed, pencil_matrix
from mcexact.answer.protocol import Answer
from mcexact.exact.linear_algebra import nullspace, row_echelon, solve_nonsingular
from mcexact.exact.matrix import Matrix, hstack, matrix_to_float, to_float, vstack
from mcexact.exact.roots import StabilityRegion
from mcexact.model.box import Box
from mcexact.model.radii import Radii
from mcexact.model.system import MultiChannelSystem

# Small changes of a pencil λE − Z that let its rank drop.

Freedom = Literal["plane", "line", "circle"]
"""Where λ may move: anywhere, parallel to the imaginary axis, or on a circle around 0."""

_PROGRAMS = 12
_SINGULAR, _ALIKE = 1e-10, 1e-12
_TOO_FAR = 5.0
_ROUND_OFF = 0.9
"""An exact change may be larger than the one in floating point near which it is."""
_BITS = 24
_CHOICES = 8


@dataclass(frozen=True)
class Drop:
    """A change in floating point with which the rank at λ is at most the one asked for.

    Attributes
    ----------
    size : float
        The largest |Δ_ij| / D_ij.
    point : complex
        λ.
    change : ndarray
        Δ.
    """

    size: float
    point: complex
    change: Floats


@dataclass(frozen=True, eq=False)
class Uncertain:
    """λE − Z with radii D of Z, of which the first rows and columns hold E = I.

    Attributes
    ----------
    Z, D : Matrix
    states : int
    rank : int
        The rank to which the pencil shall drop.
    enough : Fraction, optional
        A change of at most this size ends the search; by default the smallest one is wanted.
    """

    Z: Matrix
    D: Matrix
    states: int
    rank: int
    enough: Fraction = Fraction(0)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_Z", matrix_to_float(self.Z))
        object.__setattr__(self, "_D", matrix_to_float(self.D))
        E = np.zeros(self.Z.shape)
        E[: self.states, : self.states] = np.eye(self.states)
        object.__setattr__(self, "_E", E)

    def smallest(self, point: complex) -> float:
        """The singular value that is 0 when the rank drops, after scaling of rows and columns."""
        own: Any = self
        P, _, _ = _scaled(point * own._E - own._Z, own._D)
        values = np.linalg.svd(P, compute_uv=False)
        return float(values[self.rank]) if self.rank < len(values) else 0.0

    def drop(self, point: complex, freedom: Freedom = "plane") -> Drop | None:
        """Search a small change that lets the rank drop near a point; None if the search fails."""
        own: Any = self
        Z, D, E = own._Z, own._D, own._E
        I, J = np.nonzero(D)
        if not len(I):
            return None
        real = abs(point.imag) <= 1e-12 * max(1.0, abs(point))
        point = complex(point.real, 0.0) if real else point
        part: Floats = np.zeros(len(I))
        best: Drop | None = None
        for _ in range(_PROGRAMS):
            P = point * E - Z
            P = P.astype(complex)
            P[I, J] -= part * D[I, J]
            scaled, rows, cols = _scaled(P, D)
            U, sizes, Vh = np.linalg.svd(scaled)
            if self.rank >= len(sizes):
                return None
            size = float(np.abs(part).max())
            if sizes[self.rank] < _SINGULAR and (best is None or size < best.size):
                change = np.zeros(Z.shape)
                change[I, J] = part * D[I, J]
                best = Drop(size, point, change)
                if size < _ROUND_OFF * float(self.enough):
                    return best
            L = U[:, self.rank :].conj() / rows[:, None]
            R = Vh[self.rank :].conj().T / cols[:, None]
            directions = _directions(point, freedom, real)
            # Every entry of Δ contributes −L_i R_j; λ contributes Lᵀ E R.
            per_entry = -np.einsum("ea,eb->eab", L[I] * D[I, J][:, None], R[J]).reshape(len(I), -1)
            base = (L.T @ P @ R).ravel() - part @ per_entry
            along = (L.T @ E @ R).ravel()
            solution = _program(per_entry.T, [each * along for each in directions], base, real)
            if solution is None:
                return best
            part, steps = solution
            point = _after_steps(point, freedom, directions, steps)
            if np.abs(part).max() > _TOO_FAR * max(1.0, size):
                return best
        return best

    def exact(self, near: Drop, freedom: Freedom = "plane") -> tuple[Matrix, Fraction] | None:
        """An exact change near one in floating point, and its size; None if the search fails.

        λ is rounded, and so are all rows but a few, which then stay as they are.  Their null
        space is computed exactly, and the entries of the few other rows are changed as little as
        possible so that they vanish on it.  The same is tried for columns.
        """
        point = rational_point(near.point, freedom)
        change = _rounded(near.change)
        best: tuple[Matrix, Fraction] | None = None
        for transposed in (False, True):
            made = self._by_rows(change, point, transposed)
            if made is not None and (best is None or made[1] < best[1]):
                best = made
            if best is not None and best[1] <= self.enough:
                break
        return best

    def _by_rows(
        self, change: Matrix, point: tuple[Fraction, Fraction], transposed: bool
    ) -> tuple[Matrix, Fraction] | None:
        Z, D = (self.Z.T, self.D.T) if transposed else (self.Z, self.D)
        change = change.T if transposed else change
        entries = ((i, i, point[0]) for i in range(self.states))
        P = Matrix.from_entries(Z.shape, entries) - Z - change
        turn = Matrix.from_entries(Z.shape, ((i, i, point[1]) for i in range(self.states)))
        known = [[j for j in range(D.ncols) if D[i, j]] for i in range(D.nrows)]
        best: tuple[Matrix, Fraction] | None = None
        for free in _choices(P, turn, known, D.nrows - self.rank):
            correction = _correction(P, turn, D, known, free)
            if correction is not None:
                total = change + correction
                sizes = (abs(total[i, j]) / D[i, j] for i, j, _ in total.nonzero())
                size = max(sizes, default=Fraction(0))
                if best is None or size < best[1]:
                    best = (total.T if transposed else total), size
                if size <= self.enough:
                    break
        return best


def _choices(P: Matrix, turn: Matrix, known: list[list[int]], few: int) -> Iterator[list[int]]:
    """Sets of ``few`` rows to correct: those nearest to the span of others, or uncertain ones."""
    from scipy.linalg import qr

    size = len(known)
    floats = matrix_to_float(P) + 1j * matrix_to_float(turn)
    floats = floats / np.maximum(np.abs(floats).sum(axis=1), 1e-300)[:, None]
    for certain in (1.0, 4.0, 16.0):
        weight = np.array([certain if len(each) < few else 1.0 for each in known])
        pivots = qr((floats * weight[:, None]).T, mode="r", pivoting=True)[1]
        yield sorted(int(i) for i in pivots[size - few :])
    order = sorted(range(size), key=lambda i: (-len(known[i]), i))
    for start in range(min(_CHOICES, size - few + 1)):
        yield sorted(order[start : start + few])


def _correction(
    P: Matrix, turn: Matrix, D: Matrix, known: list[list[int]], free: list[int]
) -> Matrix | None:
    """Entries of some rows that let P − Δ vanish in these rows on the null space of all others."""
    others = [i for i in range(P.nrows) if i not in free]
    width = P.ncols
    # Complex numbers are pairs of real ones: P + i·turn acts on x + iy.
    top = hstack([P.take(rows=others), -turn.take(rows=others)], nrows=len(others))
    low = hstack([turn.take(rows=others), P.take(rows=others)], nrows=len(others))
    real = turn.is_zero()
    V = nullspace(P.take(rows=others)) if real else nullspace(vstack([top, low], ncols=2 * width))
    parts = []
    for i in free:
        row = P.take(rows=[i]) if real else hstack([P.take(rows=[i]), -turn.take(rows=[i])])
        right = (row @ V).T
        M = V.take(rows=known[i]).T
        # The least change in the radii as units: Δ = D² Mᵀ (M D² Mᵀ)⁻¹ right.
        weight = Matrix.from_entries(
            (len(known[i]),) * 2, ((k, k, D[i, j] ** 2) for k, j in enumerate(known[i]))
        )
        spread = weight @ M.T
        basis = _independent(M @ spread, right)
        if basis is None:
            return None
        entries = spread.take(cols=basis[0]) @ basis[1]
        if M @ entries != right:
            return None
        parts += [(i, j, entries[k, 0]) for k, j in enumerate(known[i])]
    return Matrix.from_entries(P.shape, parts)


def _independent(G: Matrix, right: Matrix) -> tuple[list[int], Matrix] | None:
    """A solution of G y = right with support in independent columns, and these; G is symmetric."""
    pivots = list(row_echelon(G)[1])
    y = solve_nonsingular(G.take(rows=pivots, cols=pivots), right.take(rows=pivots))
    return None if y is None else (pivots, y)


def _scaled(P: Any, D: Floats) -> tuple[Any, Floats, Floats]:
    """The matrix with rows and columns divided by their sizes, and these sizes."""
    size = np.abs(P) + D
    rows = np.maximum(size.sum(axis=1), 1e-300)
    cols = np.maximum((size / rows[:, None]).sum(axis=0), 1e-300)
    return P / rows[:, None] / cols[None, :], rows, cols


def _directions(point: complex, freedom: Freedom, real: bool) -> list[complex]:
    """The directions in which λ can move."""
    if freedom == "plane":
        return [1.0] if real else [1.0, 1j]
    if real:
        return []
    return [1j] if freedom == "line" else [1j * point]


def _after_steps(
    point: complex, freedom: Freedom, directions: list[complex], steps: Floats
) -> complex:
    """λ after steps along the directions, or along the circle."""
    if freedom == "circle" and directions:
        return complex(point * np.exp(1j * float(steps[0])))
    return point + complex(sum(d * s for d, s in zip(directions, steps, strict=True)))


def _program(
    entries: Any, directions: list[Any], base: Any, real: bool
) -> tuple[Floats, Floats] | None:
    """Minimize the largest |part| subject to entries · part + directions · steps + base = 0."""
    columns = [entries, *(each[:, None] for each in directions)]
    equations, right = np.hstack(columns), -base
    if real:
        equations, right = equations.real, right.real
    else:
        equations = np.vstack([equations.real, equations.imag])
        right = np.concatenate([right.real, right.imag])
    size = np.maximum(np.abs(equations).max(axis=1, initial=0.0), 1e-300)
    equations, right = equations / size[:, None], right / size
    if not (np.all(np.isfinite(equations)) and np.all(np.isfinite(right))):
        return None
    if len(equations) == len(directions) + 1:
        found = _least_part(equations, right, entries.shape[1])
        if found is not None:
            return found
    return _optimum(equations, right, entries.shape[1])


def _least_part(equations: Floats, right: Floats, count: int) -> tuple[Floats, Floats] | None:
    """The optimum where steps leave one equation: all parts that matter have the same modulus.

    None where the steps leave none, or more than one.
    """
    entries, along = equations[:, :count], equations[:, count:]
    y = np.ones(1) if not along.shape[1] else np.linalg.svd(along)[0][:, -1]
    if along.shape[1] and np.linalg.matrix_rank(along) < along.shape[1]:
        return None
    left = y @ entries
    size = float(np.abs(left).sum())
    if not size > _SINGULAR:
        return None
    part = float(y @ right) / size * np.sign(np.where(np.abs(left) > _ALIKE * size, left, 0.0))
    if not along.shape[1]:
        return part, np.zeros(0)
    return part, np.linalg.lstsq(along, right - entries @ part, rcond=None)[0]


def _optimum(equations: Floats, right: Floats, count: int) -> tuple[Floats, Floats] | None:
    """The optimum by a linear program."""
    from scipy.optimize import linprog

    free = equations.shape[1] - count
    eye, none, one = np.eye(count), np.zeros((count, free)), np.ones((count, 1))
    limits = np.vstack([np.hstack([eye, none, -one]), np.hstack([-eye, none, -one])])
    cost = np.zeros(count + free + 1)
    cost[-1] = 1
    optimum = linprog(
        cost,
        A_ub=limits,
        b_ub=np.zeros(2 * count),
        A_eq=np.hstack([equations, np.zeros((len(equations), 1))]),
        b_eq=right,
        bounds=[(None, None)] * (count + free) + [(0, None)],
        method="highs",
    )
    if optimum.status != 0 or optimum.x is None:
        return None
    return optimum.x[:count], optimum.x[count : count + free]


def rational_point(point: complex, freedom: Freedom) -> tuple[Fraction, Fraction]:
    """A rational point near λ, which keeps to the line or the circle.

    Examples
    --------
    >>> re, im = rational_point(0.6 + 0.8j, "circle")
    >>> re**2 + im**2
    Fraction(1, 1)
    """
    if freedom == "circle" and point.imag:
        size = Fraction(abs(point)).limit_denominator(10**6)
        t = Fraction(float(np.tan(np.angle(point) / 2))).limit_denominator(2**_BITS)
        return size * (1 - t * t) / (1 + t * t), size * 2 * t / (1 + t * t)
    re, im = (Fraction(x).limit_denominator(2**_BITS) for x in (point.real, point.imag))
    return re, im


def _rounded(change: Floats) -> Matrix:
    """Entries with some significant bits each."""
    rows = []
    for row in change.tolist():
        kept = []
        for x in row:
            m, e = np.frexp(x)
            kept.append(Fraction(round(float(m) * 2**_BITS)) * Fraction(2) ** (int(e) - _BITS))
        rows.append(kept)
    return Matrix.from_rows(rows, change.shape[1])


# Plants near a nominal one that have a fixed mode, or that their channels do not control.

_PAIRS = 6
FAILING = "failing_loop"
"""The name of the answer that the loop of a plant nearby is not stable."""


@dataclass(frozen=True)
class FailingPlant:
    """A plant near a nominal one that lacks the property in question.

    Attributes
    ----------
    plant : MultiChannelSystem
    distance : Fraction
        The largest change of an entry, as a multiple of its radius.
    mode : complex
        The approximate mode that is fixed, or not controlled, or on the border.
    channels : tuple of str
        The channels s, from whose outputs the mode cannot be observed.
    refutation : Answer or None
        The exact answer that the plant, or its loop, fails, where it was decided.
    """

    plant: MultiChannelSystem
    distance: Fraction
    mode: complex
    channels: tuple[str, ...]
    refutation: Answer | None = None

    def facts(self, system: MultiChannelSystem) -> dict[str, Any]:
        """The values for a sentence about it: its distance from a plant, and the unit of that.

        The unit is the radii of the plant, or the moduli of its entries if the plant has no radii
        or if the radii are a common part of these moduli.
        """
        if system.uncertainty is None:
            return {"fails_within": self.distance, "of_radii": False}
        part = Box(system).part
        distance = self.distance if part is None else self.distance * part
        return {"fails_within": distance, "of_radii": part is None}


def tried_sets(m: int) -> list[tuple[int, ...]]:
    """The sets of channels that are tried: those of at most two channels, and their complements.

    With up to five channels these are all sets; with many channels pairs are left out.
    """
    small: list[tuple[int, ...]] = [(), *((i,) for i in range(m))]
    if m <= _PAIRS:
        small += combinations(range(m), 2)
    rests = [tuple(j for j in range(m) if j not in s) for s in small]
    return sorted({*small, *rests}, key=lambda s: (len(s), s))


def failing_plant(
    system: MultiChannelSystem,
    radii: Radii,
    sets: Iterable[tuple[int, ...]],
    tries: int,
    region: StabilityRegion | None = None,
    enough: Fraction = Fraction(0),
) -> FailingPlant | None:
    """Search a plant near a system with a fixed mode, the pencil of a set s of which loses rank.

    Parameters
    ----------
    system : MultiChannelSystem
    radii : Radii
        The units in which changes of entries are measured.
    sets : iterable of tuples of int
        The sets s.
    tries : int
        How many sets and modes are tried, those that seem nearest first.
    region : StabilityRegion, optional
        The fixed mode is to be on its border, or outside.
    enough : Fraction, optional
        A plant at most so far away ends the search; by default the nearest one is wanted.
    """
    starts = sorted(
        _starts(system, radii, sets, region, enough) if tries >= 1 else (),
        key=lambda each: each[0],
    )
    best: FailingPlant | None = None
    for _, s, pencil, point, freedom in starts[:tries]:
        near = pencil.drop(point, freedom)
        if near is not None and freedom == "plane" and _is_inside(near.point, region):
            continue
        limit = None if best is None else best.distance
        if near is None or (limit is not None and near.size >= limit):
            continue
        exact = pencil.exact(near, freedom)
        if exact is None or (limit is not None and exact[1] >= limit):
            continue
        change, size = exact
        plant = changed(system, s, change)
        best = FailingPlant(plant, size, near.point, system.named(s))
        if size <= enough:
            break
    return best


def _is_inside(point: complex, region: StabilityRegion | None) -> bool:
    if region is None:
        return False
    return (abs(point) if region.discrete else point.real) < to_float(region.limit)


def _points(
    modes: list[complex], region: StabilityRegion | None
) -> Iterator[tuple[complex, Freedom]]:
    """Starting points: the modes outside of the region, and the points of its border near all."""
    for mode in modes:
        if not _is_inside(mode, region):
            yield mode, "plane"
        if region is not None and region.discrete:
            yield (mode / abs(mode) if mode else 1.0) * to_float(region.limit), "circle"
        elif region is not None:
            yield complex(to_float(region.limit), mode.imag), "line"


def _starts(
    system: MultiChannelSystem,
    radii: Radii,
    sets: Iterable[tuple[int, ...]],
    region: StabilityRegion | None,
    enough: Fraction,
) -> Iterator[tuple[float, tuple[int, ...], Uncertain, complex, Freedom]]:
    """For each set and starting point the singular value, and the pencil to search with."""
    values = np.linalg.eigvals(matrix_to_float(system.A)) if system.n else np.zeros(0)
    points = [*_points([complex(value) for value in values if value.imag >= 0], region)]
    for s in sets:
        T = [i for i in range(system.m) if i not in s]
        pencil = Uncertain(
            pencil_matrix(system.A, [system.B[i] for i in T], [system.C[i] for i in s]),
            pencil_matrix(radii.A, [radii.B[i] for i in T], [radii.C[i] for i in s]),
            system.n,
            system.n - 1,
            enough,
        )
        for point, freedom in points:
            yield pencil.smallest(point), s, pencil, point, freedom


def severed_plants(
    system: MultiChannelSystem, radii: Radii, *, inputs: bool = False
) -> Iterator[FailingPlant]:
    """Plants in which every channel has B_i = 0 or C_i = 0, the nearer of both; then with A = 0.

    Every mode of these is fixed.  If each radius is the same part of its entry, such a plant
    exists where the radii grow to whole entries.

    Parameters
    ----------
    system : MultiChannelSystem
    radii : Radii
        The units in which changes of entries are measured; an entry of radius 0 never vanishes.
    inputs : bool
        Whether all channels lose their inputs.

    Examples
    --------
    >>> from mcexact.model.box import Box
    >>> plant = MultiChannelSystem([[2]], [[[1]]], [[[1]]])
    >>> halves = Box.absolute(plant, B=[[["1/2"]]]).radii
    >>> [(near.distance, near.plant.B[0].is_zero()) for near in severed_plants(plant, halves)]
    [(Fraction(2, 1), True)]
    """
    B, C, distance = list(system.B), list(system.C), Fraction(0)
    shown = []
    for i in range(system.m):
        ways = [(_whole(B[i], radii.B[i]), B), (None if inputs else _whole(C[i], radii.C[i]), C)]
        able = [(size, matrices) for size, matrices in ways if size is not None]
        if not able:
            return
        size, matrices = min(able, key=lambda each: each[0])
        matrices[i] = matrices[i] * 0
        distance = max(distance, size)
        shown += [system.names[i]] if matrices is C else []
    for A, stop in ((system.A, Fraction(0)), (system.A * 0, _whole(system.A, radii.A))):
        if stop is not None:
            plant = MultiChannelSystem(
                A, B, C, time=system.time, names=system.names, neighbors=system.neighbors
            )
            yield FailingPlant(plant, max(distance, stop), 0j, tuple(shown))


def _whole(M: Matrix, D: Matrix) -> Fraction | None:
    """The least multiple of the radii within which all entries can be 0; None without one."""
    factor = Fraction(0)
    for i, j, x in M.nonzero():
        if not D[i, j]:
            return None
        factor = max(factor, Fraction(abs(x), M.denominator) / D[i, j])
    return factor
