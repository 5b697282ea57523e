"""Disk margins of single inputs and outputs, for every plant in a box.

`box_disk_margin` proves that every loop of a box stays in a region while any one input, or any one
output, is multiplied by (1 + δ/2)/(1 − δ/2) for complex numbers δ with |δ| ≤ α.  The proof is that
of `boxes.loops`, about a pencil with two more signals for each port: with v the mean of the port's
signal before and after it is multiplied, w = δv is what is added, and v + w/2 is what everybody
reads.  So δ is an entry of its own, of the radius α, beside the radii of the plant.

Members are complex then.  As the conjugate of each of them is a member, too, the upper half of the
border is enough.  One V serves all ports, since the inverse of the pencil of each port at δ = 0 is
made from that of the loop; only the weights differ.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import floor, inf
from operator import mul
from typing import Any, Literal

import numpy as np

from mcexact.analysis.boxes.loops import StabilitySearch, arc, cut
from mcexact.analysis.boxes.pencils import (
    Complex,
    ComplexRows,
    Floats,
    Pencil,
    Point,
    RegularDiscs,
    column,
    dyadic,
    entries,
    one_thread,
    weights,
    whole_weights,
    within,
)
from mcexact.answer.boxes import BoxStability, SingleDisk
from mcexact.errors import InputError, LimitReached
from mcexact.exact.matrix import Matrix, to_float
from mcexact.exact.rational import as_fraction
from mcexact.exact.roots import StabilityRegion
from mcexact.model.controller import Controller
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.system import MultiChannelSystem

Side = Literal["inputs", "outputs"]


@dataclass(frozen=True, eq=False)
class PortDiscs:
    """The tests of a disc for all ports, by one V and the weights of each port.

    With e the unit vector of the signal k and V_k = Ve, the pencil of the port k, whose two signals
    stand behind all others, has by the inverse that `extended` makes of V

            ⎡ K'  0  K_k − V_k(1 + z) ⎤
        K = ⎢ 0   0          0        ⎥,   z = e'(Z_0)e,
            ⎣ e'K'  0  e'(K_k − V_k(1 + z)) ⎦

    where K' is K = I + VZ_0 of the loop with the column V_k(1 + z) in place of K_k.  L is that of
    the loop, with a row of zeros and with its row k once more.  So the moduli |K − λL| of the loop
    are computed once for all ports.

    Attributes
    ----------
    V : ComplexRows
        N × N, of the loop.
    pencil : PortPencil
    w : tuple of tuple of int
        The N + 2 weights of each port.
    """

    V: ComplexRows
    pencil: PortPencil
    w: tuple[tuple[int, ...], ...]

    @cached_property
    def loop(self) -> RegularDiscs:
        """The test of the loop alone, of which K and L are used."""
        N = self.V.re.nrows
        return self.pencil.tested(self.V, (1,) * N, Fraction(1))

    @cached_property
    def sums(self) -> tuple[tuple[list[Fraction], list[Fraction]], ...]:
        """For each port what does not depend on λ, and what is multiplied by the radius.

        Both have N + 2 entries, one for each row.
        """
        pencil, N, alpha = self.pencil, self.V.re.nrows, self.pencil.alpha
        size, half = self.V.moduli(), Fraction(1, 2)
        Z0, D, K = pencil.Z0, pencil.D, self.loop.K
        result = []
        for k, w in zip(pencil.ports, self.w, strict=True):
            before, after = w[k], w[N + 1]
            read = column((*w[:k], after, *w[k + 1 : N]))
            spread = [*entries(D @ read)]
            spread[k] += Fraction(D[k, k]) * (before - after)
            step = entries(size @ column((*w[: pencil.n], *[0] * (N - pencil.n))))
            known = entries(size @ Matrix.from_rows([[x] for x in spread]))
            V_k, K_k = self.V.take(range(N), range(k, k + 1)), K.take(range(N), range(k, k + 1))
            own = V_k.scaled(1 + Fraction(Z0[k, k]))
            rest = ComplexRows(K_k.re - own.re, K_k.im - own.im)
            unit = Matrix.from_entries((N, 1), [(k, 0, half)])
            added = ComplexRows(V_k.re - unit, V_k.im)
            moved = [
                before * x + after * y + alpha * before * v
                for x, y, v in zip(*map(_moduli, (own, rest, added)), strict=True)
            ]
            fixed = [x + y for x, y in zip(known, moved, strict=True)]
            last = fixed[k] + alpha * before * (Fraction(size[k, k]) - _moduli(added)[k])
            result.append(([*fixed, alpha * before, last], [*step, Fraction(0), step[k]]))
        return tuple(result)

    @cached_property
    def _floats(self) -> Any:
        w = [np.array([float(x) for x in own]) for own in self.w]
        sums = [
            np.array([[to_float(x / y) for x, y in zip(part, own, strict=True)] for part in both])
            for both, own in zip(self.sums, self.w, strict=True)
        ]
        return w, sums, self.loop.near

    def seem(self, c: complex, rho: float) -> bool:
        """Whether a disc passes all tests in floating point, which proves nothing."""
        weighed, sums, (K, L) = self._floats
        moduli, N = np.abs(K - c * L), len(K)
        for k, w, (fixed, step) in zip(self.pencil.ports, weighed, sums, strict=True):
            inside = moduli @ np.where(np.arange(N) == k, 0.0, w[:N])
            rows = np.concatenate([inside, [0.0, inside[k]]]) / w
            if not np.all(rows + fixed + rho * step < 0.9999):
                return False
        return True

    def hold(self, c: Point, rho: Fraction) -> bool:
        """Whether a disc passes all tests, done in integers and with a small margin."""
        rows, scale = self.loop.moduli(c)
        for k, w, (fixed, step) in zip(self.pencil.ports, self.w, self.sums, strict=True):
            seen = [*w[:k], 0, *w[k + 1 : len(rows)]]
            inside = [Fraction(sum(map(mul, row, seen)), scale) for row in rows]
            inside += [Fraction(0), inside[k]]
            if not all(
                within(x + y + rho * z, weight)
                for x, y, z, weight in zip(inside, fixed, step, w, strict=True)
            ):
                return False
        return True


def _moduli(M: ComplexRows) -> list[Fraction]:
    """Upper limits of the moduli of the entries of a column."""
    return list(entries(M.moduli()))


@dataclass(frozen=True, eq=False)
class PortPencil(Pencil):
    """The pencil of a loop, some signals of which are multiplied, one at a time.

    Attributes
    ----------
    ports : tuple of int
        The places of the signals.
    alpha : Fraction
        The radius of δ, below 2.
    """

    ports: tuple[int, ...] = ()
    alpha: Fraction = Fraction(0)

    @property
    def readers(self) -> Fraction:
        """What a signal is multiplied by at most, in absolute value."""
        return (1 + self.alpha / 2) / (1 - self.alpha / 2)

    @cached_property
    def parts(self) -> tuple[Pencil, ...]:
        """The pencil of each port, with its two signals behind all others."""
        return tuple(self._part(k) for k in self.ports)

    def _part(self, k: int) -> Pencil:
        N, half = self.Z0.nrows, Fraction(1, 2)
        shape = N + 2, N + 2
        fixed = ((k, N, half), (N, N, -1), (N + 1, k, 1), (N + 1, N, half), (N + 1, N + 1, -1))

        def read(M: Matrix) -> Iterator[tuple[int, int, Any]]:
            for i, j, x in M.nonzero():
                yield i, N + 1 if j == k and i != k else j, Fraction(x, M.denominator)

        Z0 = Matrix.from_entries(shape, (*read(self.Z0), *fixed))
        D = Matrix.from_entries(shape, (*read(self.D), (N, k, self.alpha)))
        scale = np.concatenate([self.scale, self.scale[[k, k]]])
        return Pencil(Z0, D, self.n, scale)

    def margin(self, c: complex) -> float:
        """The largest α for which the pencils of the ports that matter seem regular at a point."""
        V = self.inverse(c)
        if V is None:
            return 0.0
        least, gains = inf, self._gains(V)
        for k, part, gain in zip(self.ports, self.parts, gains, strict=True):
            if gain < _MATTERS * np.max(gains):
                continue
            wide, D, N = extended(V, k), part.balanced[1].copy(), len(V)
            D[N, k] = 0.0
            spread = np.abs(wide) @ D
            w = weights(spread)
            if w is None:
                return 0.0
            gain = np.linalg.solve(np.eye(N + 2) - spread, np.abs(wide[:, N]))[k]
            least = min(least, 1 / gain if gain > 0 else inf)
        return float(least)

    def _gains(self, V: Complex) -> Floats:
        """|T_kk + ½| of each port, for the nominal plant."""
        return np.asarray(np.abs(np.diag(V)[list(self.ports)] - 0.5), dtype=np.float64)

    def gain(self, c: complex) -> float:
        """The largest |T_kk + ½| of a port at a point, for the nominal plant."""
        V = self.inverse(c)
        return inf if V is None else float(np.max(self._gains(V), initial=0.0))

    def proposal(self, c: complex, rho: float, factor: Fraction) -> Any:
        """Propose one V, and weights for each port; None without a proposal."""
        V = self.inverse(c)
        if V is None or factor != 1:
            return None
        N, unit, heavy = len(V), np.full(V.shape, inf), []
        for k, part in zip(self.ports, self.parts, strict=True):
            wide, (Z0, D, E) = extended(V, k), part.balanced
            w = weights(np.abs(wide) @ D + rho * np.abs(wide) @ np.diag(E))
            if w is None:
                return None
            spent = np.abs(c * np.diag(E) - Z0) @ w + D @ w
            spent[k] += spent[N] + spent[N + 1]
            room = w[:N].copy()
            room[k] = min(w[k], w[N + 1])
            unit = np.minimum(unit, room[:, None] / (len(w) * spent[:N])[None, :])
            heavy.append(whole_weights(w * part.scale))
        ratios = self.scale[:, None] / self.scale[None, :]
        return PortDiscs(dyadic(V * ratios, unit * ratios), self, tuple(heavy))

    def seems(self, c: complex, rho: float) -> bool:
        """Whether there seem to be weights of all ports for a disc, in floating point."""
        V = self.inverse(c)
        return V is not None and all(
            weights(np.abs(wide) @ D + rho * np.abs(wide) @ np.diag(E)) is not None
            for wide, (_, D, E) in (
                (extended(V, k), part.balanced)
                for k, part in zip(self.ports, self.parts, strict=True)
            )
        )


def extended(V: Complex, k: int) -> Complex:
    """[V, Ve − e/2, Ve − e; 0, 1, 0; e'V, e'Ve, e'Ve], e the unit vector of the signal k."""
    wide = np.vstack(
        [np.hstack([V, V[:, [k, k]]]), np.zeros((1, len(V) + 2)), np.zeros(len(V) + 2)]
    )
    wide[-1] = wide[k]
    wide[k, -2:] -= (0.5, 1.0)
    wide[-2, -2] = 1.0
    return wide


class MarginSearch(StabilitySearch):
    """The search for a proof that every loop of a box keeps a disk margin."""

    seconds = inf
    """How long the checker may take."""

    def with_disk(self, at: Side, alpha: Fraction) -> None:
        """Multiply the inputs, or the outputs, by numbers of the disk of a margin."""
        loop, N = self.loop, self.pencil.Z0.nrows
        p, q = (sum(size(i) for i in range(loop.plant.m)) for size in (loop.plant.p, loop.plant.q))
        first, number = (N - p, p) if at == "inputs" else (N - p - q, q)
        ports = tuple(range(first, first + number))
        base = self.pencil
        self.pencil = PortPencil(
            base.Z0, base.D, base.n, base.scale, base.generators, ports=ports, alpha=alpha
        )
        self.disk = SingleDisk(at, alpha)

    def is_short(self) -> bool:
        """Whether a proof seems to be there, in floating point, and to be short enough.

        Only in discrete time it is looked at; elsewhere the answer is yes.
        """
        pencil = self.pencil
        if not self.region.discrete or not isinstance(pencil, PortPencil):
            return True
        segment = arc(self.region.edge)

        def test(a: Fraction, b: Fraction) -> int | None:
            c, rho = segment(a, b)
            near = complex(to_float(c[0]), to_float(c[1]))
            return 0 if pencil.seems(near, to_float(rho)) else None

        segments = cut(test, Fraction(2), _TRIED * self.most, self.late)
        if segments is None or len(segments) > self.most:
            return False
        tests = len(segments) * len(pencil.ports)
        return tests * len(pencil.scale) ** 2 * _SECONDS <= self.seconds

    def proved(self) -> BoxStability | None:
        """The proof, where `is_short`: failures on the way cost little."""
        most, self.most = self.most, _TRIED * self.most
        try:
            return self.border(Fraction(1))
        finally:
            self.most = most

    def largest(self) -> float:
        """About the largest margin of which a proof can be found.

        What radii take away is looked at where the nominal margins are least.
        """
        pencil = self.pencil
        if not isinstance(pencil, PortPencil):
            return 0.0
        points = sorted(self.points(), key=pencil.gain, reverse=True)
        return min(map(pencil.margin, points[:_LOOKED_AT]), default=0.0)


SIDES: tuple[Side, ...] = ("inputs", "outputs")
PARTS = (0.95, 0.8, 0.5)
"""The parts of what seems to be the largest margin that are tried."""
_LARGEST = 1.9
_TRIED = 4
"""How many parts of the border are tried for each one that a proof may have."""
_SECONDS = 1.3e-5
"""The seconds of the checker for the square of the size of a pencil, for each segment and port."""
_LOOKED_AT, _MATTERS = 20, 0.5
"""The points at which radii are looked at, and the part of the largest gain that matters there."""


def margin_in_box(
    loop: ClosedLoop,
    at: Side,
    alpha: Fraction | None = None,
    most: int = 4000,
    deadline: float | None = None,
    seconds: float = inf,
) -> BoxStability | None:
    """Search a proof that every loop within the radii of the plant keeps a disk margin.

    Parameters
    ----------
    loop : ClosedLoop
        Of a plant with radii.
    at : "inputs" or "outputs"
        Each of them is multiplied by itself.
    alpha : Fraction, optional
        The margin; by default a large part of what seems to be possible.
    most : int
        The largest number of segments of the border that are tested for one margin.
    deadline : float, optional
        The time of `time.monotonic` after which no further segment is tested.
    seconds : float
        About how long the checker may take for the proof.
    """
    region = StabilityRegion(loop.plant.time)
    if not sum((loop.plant.p if at == "inputs" else loop.plant.q)(i) for i in range(loop.plant.m)):
        return None
    with one_thread():
        search = MarginSearch(loop, region, most=most, deadline=deadline)
        search.seconds = seconds
        if alpha is not None:
            search.with_disk(at, alpha)
            return search.border(Fraction(1))
        search.with_disk(at, Fraction(0))
        limit = min(search.largest(), _LARGEST)
        sizes = [Fraction(floor(part * limit * 100), 100) for part in PARTS]
        tried = [size for size in dict.fromkeys(sizes) if size > 0]
        for k, size in enumerate([*tried[-1:], *tried]):
            search.with_disk(at, size)
            if search.is_short():
                # the smallest one is only looked at first, and proved last
                proof = search.proved() if k else None
                if proof is not None:
                    return proof
            elif not k:
                return None
    return None


def box_disk_margin(
    system: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None = None,
    *,
    at: Side = "inputs",
    margin: Any = None,
) -> BoxStability:
    """Prove a disk margin of each input, or of each output, for every plant within its radii.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant with radii, such as ``Box.relative(plant, "1/100").system``.
    controller : Controller
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    at : "inputs" or "outputs"
        Which signals are multiplied, each by itself.
    margin : rational, optional
        α, above 0 and below 2; by default a large one is searched.

    Raises
    ------
    InputError
        If the margin is not above 0 and below 2.
    LimitReached
        If no proof was found, which proves nothing.

    Examples
    --------
    >>> from mcexact.model.box import Box
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> gain = local_controllers(plant, [[[-3]]])
    >>> box_disk_margin(Box.relative(plant, "1/10").system, gain, margin="1/2").disk.margin
    Fraction(1, 2)
    >>> box_disk_margin(Box.relative(plant, "1/10").system, gain, margin="99/100")
    Traceback (most recent call last):
        ...
    mcexact.errors.LimitReached: no proof was found that each of the inputs has a disk margin of \
99/100 for every plant within the radii
    """
    InputError.require(system, MultiChannelSystem, "system")
    alpha = None if margin is None else as_fraction(margin, where="margin")
    if alpha is not None and not 0 < alpha < 2:
        raise InputError("expected a number above 0 and below 2", where="margin")
    if at not in ("inputs", "outputs"):
        raise InputError('expected "inputs" or "outputs"', where="at")
    proof = margin_in_box(closed_loop(system, controller, graph), at, alpha)
    if proof is None:
        size = "" if alpha is None else f" of {alpha}"
        raise LimitReached(
            f"no proof was found that each of the {at} has a disk margin{size} for every plant "
            "within the radii"
        )
    return proof
