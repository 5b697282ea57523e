"""Closed loops of every member.

`box_stability` proves that one controller keeps the loops of all members in a region: the stable
region, a half-plane of a rate, or a disc of a radius.  The members are the plants of a box, or
those at all values of parameters in ranges, which `boxes.cells` cuts in half until each cell is
proved.  The gains can have radii, too: parts of their moduli, or those of rounding to some digits.
If no proof is found, it raises `LimitReached`, which proves nothing.

The argument is continuity.  The nominal loop is in the region, by `certify_stability`; the set of
members is connected; and no member has an eigenvalue on the border.  So no eigenvalue crosses it.

That the border is free of eigenvalues is tested on the pencil of the loop, whose entries are those
of the plant and of the controller, so that no radius is enlarged by a product.  In continuous time
the border is the line Re λ = −rate from 0 up to a number R: weights of the states prove that no
member has an eigenvalue of modulus R or more.  In discrete time it is the upper half circle.  It is
cut into segments until each, by the disc of which it is a diameter or a chord, passes the exact
test of `boxes.pencils`, in integers.  The lower half follows by symmetry.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from math import lcm
from typing import Any, overload

import numpy as np

from mcexact.analysis.boxes.cells import Family, proofs
from mcexact.analysis.boxes.pencils import (
    Frames,
    Members,
    Pencil,
    Point,
    modulus_above,
    perron,
    require_float_range,
    require_radii,
    whole_weights,
)
from mcexact.analysis.stability import certify_stability
from mcexact.answer.boxes import (
    BoxStability,
    ParametricBoxStability,
    SingleDisk,
    StabilityOfCell,
)
from mcexact.answer.evidence import InverseFrame
from mcexact.answer.loops import LyapunovMethod, PolynomialMethod, StabilityVerdict
from mcexact.derived.constructions import add_links, looped
from mcexact.errors import InputError, InternalError
from mcexact.exact.matrix import Matrix, matrix_to_float, to_float
from mcexact.exact.rational import as_fraction
from mcexact.exact.roots import StabilityRegion
from mcexact.model.box import Box
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import ClosedLoop, LoopPencil, closed_loop
from mcexact.model.parametric import ParametricSystem
from mcexact.model.radii import moduli
from mcexact.model.system import MultiChannelSystem

# Radii of the gains of a controller, held in a controller of the same form.


def with_gains(controller: Controller, of: Callable[[Matrix], Matrix]) -> Controller:
    """The controller with each matrix of gains replaced by a function of it, without set-points."""

    def mapped(each: LinearMap) -> LinearMap:
        return LinearMap(
            {j: of(M) for j, M in each.outputs.items()},
            {j: of(M) for j, M in each.shared.items()},
            None if each.private is None else of(each.private),
        ).without_zeros()

    def program(agent: AgentProgram) -> AgentProgram:
        first, second, third = map(mapped, agent.maps())
        return replace(agent, shared_update=first, private_update=second, input=third)

    return replace(controller, agents=tuple(map(program, controller.agents)))


def gain_radii(controller: Controller, part: Any) -> Controller:
    """A controller whose entries are the given part of the moduli of another's: radii of its gains.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> from mcexact.model.system import MultiChannelSystem
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> [agent] = gain_radii(local_controllers(plant, [[[-3]]]), "1/100").agents
    >>> agent.input.outputs[0][0, 0]
    Fraction(3, 100)
    """
    factor = as_fraction(part, where="gains")
    return with_gains(controller, lambda M: moduli(M) * factor)


def radii_of_gains(controller: Controller, gains: Any) -> Controller | None:
    """The radii of gains as a controller, from a part of their moduli or from a controller.

    Raises
    ------
    InputError
        If a radius is negative.
    """
    if gains is None:
        return None
    radii = gains if isinstance(gains, Controller) else gain_radii(controller, gains)
    if any(x < 0 for M in radii.matrices() for _, _, x in M.nonzero()):
        raise InputError("expected radii that are at least 0", where="gains")
    return radii


def digit_radii(controller: Controller, digits: int) -> Controller:
    """The radii by which rounding to significant digits, up or down, moves entries at most.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> from mcexact.model.system import MultiChannelSystem
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> [agent] = digit_radii(local_controllers(plant, [[["-31.4"]]]), 2).agents
    >>> agent.input.outputs[0][0, 0]
    Fraction(3, 5)
    """

    def radius(x: Fraction) -> Fraction:
        low, high = rounded_ends(x, digits)
        return max(x - low, high - x)

    def radii(M: Matrix) -> Matrix:
        entries = ((i, j, radius(Fraction(x, M.denominator))) for i, j, x in M.nonzero())
        return Matrix.from_entries(M.shape, entries)

    return with_gains(controller, radii)


def rounded_ends(x: Fraction, digits: int) -> tuple[Fraction, Fraction]:
    """The nearest numbers with so many significant digits below and above a number other than 0.

    Examples
    --------
    >>> rounded_ends(Fraction(-314, 10), 2), rounded_ends(Fraction(5), 1)
    ((Fraction(-32, 1), Fraction(-31, 1)), (Fraction(5, 1), Fraction(5, 1)))
    """
    unit = _unit(abs(x), digits)
    low = x // unit * unit
    return low, low if low == x else low + unit


def _unit(x: Fraction, digits: int) -> Fraction:
    """One unit of a significant digit of a number above 0."""
    bits = x.numerator.bit_length() - x.denominator.bit_length()
    e = int(bits * 0.30103)
    while Fraction(10) ** e > x:
        e -= 1
    while Fraction(10) ** (e + 1) <= x:
        e += 1
    return Fraction(10) ** (e - digits + 1)


# The border of a region, cut into segments that pass the test of a disc.

_MOST_SEGMENTS, _MOST_SEGMENTS_OF_CELL = 4000, 1000
"""The parts of the border that are tried at most; a cell that needs more is cut."""
_SHORTEST = Fraction(1, 10**12)
"""The part of the whole border below which a segment is not cut again."""


@dataclass
class StabilitySearch:
    """The search for a proof about the loops of all members, for several factors of all radii.

    Attributes
    ----------
    loop : ClosedLoop
        The loop of the nominal plant.
    region : StabilityRegion
    radii : Controller or None
        The radii of the gains, as a controller; None if they are certain.
    most : int
        The largest number of segments of the border that are tested for one factor.
    members : Members, optional
        By default those of the box of the plant.
    tested : int
        The number of segments tested so far.
    disk : SingleDisk, optional
        What single inputs or outputs are multiplied by (`boxes.margins`).
    deadline : float, optional
        The time of `time.monotonic` after which no further segment is tested.
    """

    loop: ClosedLoop
    region: StabilityRegion
    radii: Controller | None = None
    most: int = _MOST_SEGMENTS
    members: Members | None = None
    tested: int = 0
    disk: SingleDisk | None = None
    deadline: float | None = None

    def __post_init__(self) -> None:
        from scipy.linalg import matrix_balance

        signals = LoopPencil(self.loop.plant, self.loop.controller, self.loop.graph)
        plant = self.loop.plant
        members = self.members or Members.of(plant)
        A, B, C = members.radii.A, members.radii.B, members.radii.C
        radii = MultiChannelSystem(A, B, C, time=plant.time)
        certain = gain_radii(self.loop.controller, 0)
        Z0, D = signals.matrix, signals.with_entries(radii, self.radii or certain, 0)
        generators = tuple(signals.with_entries(each, certain, 0) for each in members.generators)
        require_float_range([Z0], [D, *generators])
        _, (s, _) = matrix_balance(matrix_to_float(Z0), permute=False, separate=True)
        self.pencil = Pencil(Z0, D, signals.states, s, generators)
        self._margins: list[tuple[float, complex]] | None = None

    def margins(self) -> list[tuple[float, complex]]:
        """About how far the radii can grow at points of the border, the least first.

        The least is an upper limit of what can be proved, and itself proves nothing.
        """
        if self._margins is None:
            margins = ((self.pencil.margin(point), point) for point in self.points())
            self._margins = sorted(margins, key=lambda each: each[0])
        return self._margins

    def points(self) -> list[complex]:
        """Points of the upper half of the border, near eigenvalues and between them."""
        Z0, _, _ = self.pencil.balanced
        N, edge = self.pencil.n, to_float(self.region.edge)
        S = Z0[N:, N:]
        M = Z0[:N, :N] - Z0[:N, N:] @ np.linalg.solve(S, Z0[N:, :N]) if len(S) else Z0[:N, :N]
        values = np.linalg.eigvals(M)
        if self.region.discrete:
            angles = np.concatenate([np.abs(np.angle(values)), np.linspace(0, np.pi, 100)])
            return [complex(edge * np.exp(1j * angle)) for angle in np.unique(angles)]
        top = max(np.abs(values).max(initial=1e-6), 1e-12)
        spread = np.geomspace(max(np.abs(values).min(initial=top), 1e-6 * top) / 10, 10 * top, 100)
        heights = np.concatenate([[0.0], np.abs(values), np.abs(values.imag), spread])
        return [complex(-edge, height) for height in np.unique(heights)]

    def border(self, factor: Fraction) -> BoxStability | None:
        """The answer for radii that are multiplied by a factor; None if no proof is found."""
        evidence = self.evidence(factor)
        if evidence is None:
            return None
        radii = None if self.radii is None else _scaled(self.radii, factor).document()
        about, bound = self._about(factor), self.region.bound
        return BoxStability(about, bound, radii, disk=self.disk, **vars(evidence))

    def evidence(self, factor: Fraction) -> StabilityOfCell | None:
        """Search a proof for radii that are multiplied by a factor; None if the search fails."""
        nominal = certify_stability(self.loop.system, self.region)
        if not nominal.stable:
            return None
        evidence = nominal.evidence
        if not isinstance(evidence, (PolynomialMethod, LyapunovMethod)):
            raise InternalError("a stable loop has another proof than its own two")
        far = None if self.region.discrete else _last_point(self.pencil, factor)
        if far is None and not self.region.discrete:
            return None
        frames = Frames()
        segment, last = arc(self.region.edge), Fraction(2)
        if far is not None:
            segment, last = _interval(self.region.edge), far[0]

        def test(a: Fraction, b: Fraction) -> int | None:
            self.tested += 1
            c, rho = segment(a, b)
            k = frames.one_for(c, rho)
            if k is not None:
                return k
            near = complex(to_float(c[0]), to_float(c[1]))
            proposed = self.pencil.proposal(near, to_float(rho), factor)
            return None if proposed is None else frames.added(proposed, c, rho)

        segments = cut(test, last, self.most, self.late)
        if segments is None:
            return None
        ends = [b for _, b, _ in segments]
        points = ends if far is not None else [_tangent(b) for b in ends[:-1]]
        return StabilityOfCell(
            evidence,
            tuple(points),
            None if far is None else far[1],
            tuple(k for _, _, k in segments),
            tuple(InverseFrame(V.evidence(), w) for V, w in frames.evidence),
        )

    def late(self) -> bool:
        """Whether the deadline has passed."""
        return self.deadline is not None and time.monotonic() >= self.deadline

    def _about(self, factor: Fraction) -> MultiChannelSystem:
        """The loop of the box whose radii are multiplied by a factor."""
        if factor == 1:
            return self.loop.system
        if self.loop.plant.subject:
            raise InternalError("the radii of a derived plant are not those of its plant")
        return replace(self.loop, plant=Box(self.loop.plant).scaled(factor).system).system


def _scaled(radii: Controller, factor: Fraction) -> Controller:
    return radii if factor == 1 else gain_radii(radii, factor)


def cut(
    test: Callable[[Fraction, Fraction], int | None],
    last: Fraction,
    most: int,
    late: Callable[[], bool],
) -> list[tuple[Fraction, Fraction, int]] | None:
    """Cut [0, last] into intervals that pass a test, each with what the test returns.

    None after ``most`` failures, or once it is late.
    """
    left = [(Fraction(0), last)]
    segments: list[tuple[Fraction, Fraction, int]] = []
    tested = 0
    while left:
        if late():
            return None
        a, b = left.pop()
        tested += 1
        k = test(a, b)
        if k is not None:
            segments.append((a, b, k))
            continue
        if tested > most or b - a < _SHORTEST * last:
            return None
        middle = b / 4 if a == 0 and b > 4 else (a + b) / 2 if b < 4 * a or a == 0 else 2 * a
        left += [(middle, b), (a, middle)]
    return segments


def _interval(rate: Fraction) -> Callable[[Fraction, Fraction], tuple[Point, Fraction]]:
    """The disc whose diameter is the segment from a to b of the line Re λ = −rate."""
    return lambda a, b: ((-rate, (a + b) / 2), (b - a) / 2)


def arc(radius: Fraction) -> Callable[[Fraction, Fraction], tuple[Point, Fraction]]:
    """The disc whose diameter is the chord between two points of the upper half circle."""

    def point(a: Fraction) -> Point:
        if a == 2:
            return -radius, Fraction(0)
        t = _tangent(a)
        return radius * (1 - t * t) / (1 + t * t), radius * 2 * t / (1 + t * t)

    def disc(a: Fraction, b: Fraction) -> tuple[Point, Fraction]:
        p, q = point(a), point(b)
        x, y = (p[0] - q[0]) / 2, (p[1] - q[1]) / 2
        d = lcm(x.denominator, y.denominator) << 32
        size = Fraction(modulus_above(int(x * d), int(y * d)), d)
        return ((p[0] + q[0]) / 2, (p[1] + q[1]) / 2), size

    return disc


def _tangent(a: Fraction) -> Fraction:
    """The tangent of half the angle, for a from 0 to 1 itself, and above 1 that of 1/(2 − a)."""
    return a if a <= 1 else 1 / (2 - a)


def _last_point(pencil: Pencil, factor: Fraction) -> tuple[Fraction, tuple[int, ...]] | None:
    """A number R, and weights of the states by which no member has an eigenvalue of modulus ≥ R."""
    Z0, D, _ = pencil.balanced
    radii = D + sum(map(np.abs, pencil.balanced_generators))
    top, N = np.abs(Z0) + float(factor) * radii, pencil.n
    top[:, list(pencil.ports)] *= float(pencil.readers)
    X = np.vstack([np.eye(N), np.zeros((len(top) - N, N))])
    for i in range(N, len(top)):
        X[i] = top[i, :i] @ X[:i]
    H = top[:N] @ X
    if not N or not np.all(np.isfinite(H)):
        return (Fraction(1), ()) if not N else None
    w = np.maximum(perron(H, 20)[1], 1e-6)
    g = whole_weights(w * pencil.scale[:N])
    return _least_radius(pencil, factor, g), g


def _least_radius(pencil: Pencil, factor: Fraction, g: tuple[int, ...]) -> Fraction:
    """An integer R above Σ_j (|Z0| + D)_ij g_j / g_i for every dynamic row i, D of all changes."""
    most = moduli(pencil.Z0) + sum(map(moduli, pencil.generators), pencil.D) * factor
    if pencil.ports:
        factors = [pencil.readers if j in pencil.ports else Fraction(1) for j in range(most.ncols)]
        most = most @ Matrix.from_entries(most.shape, ((j, j, x) for j, x in enumerate(factors)))
    rows, d = most.numerators, most.denominator
    sizes = [Fraction(x) for x in g]
    for row in rows[pencil.n :]:
        sizes.append(sum((x * y for x, y in zip(row, sizes, strict=False) if x), Fraction(0)) / d)
    ratios: list[Fraction] = []
    for i, row in enumerate(rows[: pencil.n]):
        ratios.append(
            sum((x * y for x, y in zip(row, sizes, strict=True) if x), Fraction(0)) / d / g[i]
        )
    return Fraction(int(max(ratios)) + 1)


@overload
def box_stability(
    system: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None = ...,
    *,
    rate: Any = ...,
    radius: Any = ...,
    gains: Any = ...,
) -> BoxStability: ...
@overload
def box_stability(
    system: ParametricSystem,
    controller: Controller,
    graph: NeighborGraph | None = ...,
    *,
    rate: Any = ...,
    radius: Any = ...,
    gains: Any = ...,
) -> ParametricBoxStability: ...
def box_stability(
    system: MultiChannelSystem | ParametricSystem,
    controller: Controller,
    graph: NeighborGraph | None = None,
    *,
    rate: Any = None,
    radius: Any = None,
    gains: Any = None,
) -> BoxStability | ParametricBoxStability:
    """Prove that one controller keeps every member of a family stable, or fast enough.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
        A plant with radii, such as ``Box.relative(plant, "1/100").system``; or one with parameters,
        each with a range of two ends: then the loop is proved for all values within the ranges
        (`ParametricBoxStability`).
    controller : Controller
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.  A plant with parameters has no links by default, and the
        links of a graph have no delays then.
    rate, radius : rational, optional
        A rate in continuous time, a radius in discrete time; by default stability is proved.
    gains : rational or Controller, optional
        The radii of the controller's entries: a part of their moduli, such as "1/100", or a
        controller that has radii as its entries.  By default the gains are certain.

    Raises
    ------
    InputError
        If a radius of a gain is negative.
    UsageError
        If every entry of the plant and every gain is certain.
    LimitReached
        If no proof was found, which proves nothing; if the loop is unstable at some values of
        parameters, the message names them.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> gain = local_controllers(plant, [[[-3]]])
    >>> str(box_stability(Box.relative(plant, "1/10").system, gain, rate="1/2").bound)
    '1/2'
    >>> box_stability(Box.relative(plant, "6/10").system, gain)
    Traceback (most recent call last):
        ...
    mcexact.errors.LimitReached: no proof was found that every loop in the box has Re λ < 0
    >>> family = ParametricSystem(
    ...     [["k"]], [[["k"]]], [[[1]]], parameters=["k"], assume={"k": ("1/2", 2)}
    ... )
    >>> box_stability(family, gain, rate=2)
    Traceback (most recent call last):
        ...
    mcexact.errors.LimitReached: not every eigenvalue has Re λ < -2 at k = 1/2
    """
    if not isinstance(system, ParametricSystem):
        InputError.require(system, MultiChannelSystem, "system")
    InputError.require(controller, Controller, "controller")
    if gains is None:
        require_radii(system)
    region = StabilityRegion.of(system.time, rate, radius)
    most = _MOST_SEGMENTS_OF_CELL if isinstance(system, ParametricSystem) else _MOST_SEGMENTS
    return LoopSearch(system, controller, graph, region, gains, most).proof(system)


@dataclass
class LoopSearch:
    """The search for a proof about one controller, for a box or for several ranges of parameters.

    Attributes
    ----------
    system : MultiChannelSystem or ParametricSystem
    controller : Controller
    graph : NeighborGraph or None
        As for `box_stability`.
    region : StabilityRegion
    gains : rational or Controller, optional
        As for `box_stability`.
    most : int
        The largest number of segments of the border that are tested in a cell.
    limit : float
        The number of tested segments after which the search gives up.
    tested : int
        About how many segments were tested so far.
    """

    system: Family
    controller: Controller
    graph: NeighborGraph | None
    region: StabilityRegion
    gains: Any = None
    most: int = _MOST_SEGMENTS_OF_CELL
    limit: float = math.inf
    tested: int = 0

    def __post_init__(self) -> None:
        InputError.require(self.controller, Controller, "controller")
        self.radii = radii_of_gains(self.controller, self.gains)

    def loop(self, plant: MultiChannelSystem) -> ClosedLoop:
        """The loop of the plant, or of the plant at some values."""
        if not isinstance(self.system, ParametricSystem):
            return closed_loop(plant, self.controller, self.graph)
        # A plant with parameters has no graph of its own: links are a construction.
        if self.graph is not None:
            plant = add_links(plant.with_neighbors({}), self.graph.edges())
        return closed_loop(plant, self.controller)

    def refuted(self, plant: MultiChannelSystem) -> StabilityVerdict | None:
        """The exact answer that a loop leaves the region; None if it does not."""
        verdict = certify_stability(self.loop(plant).system, self.region)
        return None if verdict.stable else verdict

    @overload
    def proof(self, system: MultiChannelSystem) -> BoxStability: ...
    @overload
    def proof(self, system: ParametricSystem) -> ParametricBoxStability: ...
    def proof(self, system: Family) -> BoxStability | ParametricBoxStability:
        """The answer for the system with these radii, or with these ranges.

        Raises
        ------
        LimitReached
            If no proof was found.
        """
        if isinstance(system, ParametricSystem):
            ranges = looped(system, lambda plant: self.loop(plant).system)
        else:
            loop = self.loop(system)
        cuts, parts = proofs(
            system,
            self._evidence,
            lambda plant: self.refuted(plant) is not None,
            claim=f"every loop in the box has {self.region}",
            failure=f"not every eigenvalue has {self.region}",
        )
        radii = None if self.radii is None else self.radii.document()
        if isinstance(system, ParametricSystem):
            return ParametricBoxStability(ranges, self.region.bound, radii, cuts, parts)
        return BoxStability(loop.system, self.region.bound, radii, **vars(parts[0]))

    def _evidence(self, members: Members) -> StabilityOfCell | None:
        """The evidence about the members of a box, or of a cell."""
        if self.tested > self.limit:
            return None
        loop = self.loop(members.system)
        search = StabilitySearch(loop, self.region, self.radii, self.most, members)
        if isinstance(self.system, ParametricSystem):
            # A cell is cut, and no segment tested, if its radii seem too large in floating point.
            least = min((each for each, _ in search.margins()), default=0.0)
            if least <= 1:
                self.tested += 1
                return None
        evidence = search.evidence(Fraction(1))
        self.tested += self.most if evidence is None else len(evidence.segments)
        return evidence
