"""Controllers in fixed point: integers of 32 bits, and sums of 64 bits.

Every signal is an integer of 32 bits times a power of two, which the range of its kind decides: of
a range R the largest power 2^f with R·2^f < 2^31 is taken.  Every number of the controller is
rounded to F fractional bits, so that the code is a controller of its own, `FixedPoint.rounded`,
which is certified as any other.  A sum Σ c_k s_k becomes

    value = nearest((Σ m_k s_k) / 2^d),   m_k = c_k 2^F 2^(t − f_k),   d = F + t − f,

t the largest f_k of its signals and f that of its value: products are exact, and one rounding
follows, halves upwards.  Values beyond the range stay at its end.  `FixedPoint.sum` refuses sums
that could leave 64 bits, for any signals; so no step overflows, whatever it is given.

`least_fixed_point` finds the fewest fractional bits with a proof that every controller whose
entries differ by at most half of the last bit makes a stable loop.  The rounding of signals in each
step is not part of it: it acts as a disturbance of at most half a unit of each signal.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import partial
from math import ceil, floor
from typing import Any

from mcexact.answer.boxes import BoxStability
from mcexact.errors import InputError, LimitReached, UsageError, shown_value
from mcexact.exact.matrix import Matrix, as_requested, matrix_to_float, to_float
from mcexact.exact.rational import Entry, rational_text
from mcexact.exact.roots import StabilityRegion
from mcexact.export import MOST_BITS
from mcexact.export.equations import AgentStep, Kind, Row, Signal, steps_of
from mcexact.model.controller import Controller, with_limits, with_matrices
from mcexact.model.graph import NeighborGraph
from mcexact.model.limits import Range
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem

WORD, LONG = 31, 63
"""The bits of a signal and of a sum, without the sign."""
LARGEST: int = 2**WORD - 1
"""The largest integer of a signal; the least is its negative."""
USUAL = Fraction(1000)
"""The range of signals for which none is given."""
SIGNALS = ("y", "r", "u", "x", "z")
_MORE = 12
"""How many more bits are tried than the first number that seems to be enough."""


@dataclass(frozen=True)
class FixedPoint:
    """An arithmetic of integers for the code of a controller.

    Attributes
    ----------
    bits : int
        F, the fractional bits of every number of the controller.
    ranges : mapping of str to rational
        The largest modulus of each kind of signal: "y" outputs, "r" set-points, "u" inputs, "x"
        shared and "z" private states; 1000 for those that are left out.

    Raises
    ------
    UsageError
        If bits are below 0 or above `MOST_BITS`, a kind does not exist, or a range is not above 0.

    Examples
    --------
    >>> fixed = FixedPoint(10, {"y": 2})
    >>> fixed.fractional("y"), fixed.fractional("z")
    (29, 21)
    >>> fixed.number(Fraction(1, 3))
    Fraction(341, 1024)
    """

    bits: int
    ranges: Mapping[str, Entry] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if isinstance(self.bits, bool) or not isinstance(self.bits, int):
            raise UsageError(f"expected a number of bits, found {shown_value(self.bits)}")
        if not 0 <= self.bits <= MOST_BITS:
            raise UsageError(f"expected 0 to {MOST_BITS} fractional bits, found {self.bits}")
        ranges = {kind: as_requested(each, where=kind) for kind, each in self.ranges.items()}
        for kind, each in ranges.items():
            if kind not in SIGNALS:
                expected = ", ".join(SIGNALS)
                raise UsageError(f"expected one of the signals {expected}, found {kind!r}")
            if not 0 < each < LARGEST:
                raise UsageError(
                    f"expected a range above 0 and below 2^{WORD}, found {rational_text(each)}",
                    where=kind,
                )
        object.__setattr__(self, "ranges", ranges)

    def fractional(self, kind: str) -> int:
        """The fractional bits of a kind of signal, at most 30; e is as large as u."""
        reach = LARGEST / Fraction(self.ranges.get("u" if kind == "e" else kind, USUAL))
        return min(int(reach).bit_length(), WORD) - 1

    def number(self, c: Fraction) -> Fraction:
        """A number of the controller as it is in the code; halves away from 0."""
        steps = floor(abs(c) * 2**self.bits + Fraction(1, 2))
        return Fraction(steps if c >= 0 else -steps, 2**self.bits)

    def rounded(self, controller: Controller) -> Controller:
        """The controller that the code is, its limits those at which the code cuts off.

        Raises
        ------
        InputError
            If the limits of an input are nearer to 0 than a unit of u.
        """

        def matrix(M: Matrix) -> Matrix:
            entries = ((i, j, Fraction(x, M.denominator)) for i, j, x in M.nonzero())
            return Matrix.from_entries(M.shape, [(i, j, self.number(c)) for i, j, c in entries])

        return with_limits(with_matrices(controller, matrix), self.ends)

    def steps(self, controller: Controller) -> tuple[AgentStep, ...]:
        """The steps of all agents, which start at the rest of the rounded controller.

        Where a sum for that could leave 64 bits, or the rounded agent has no such rest, it starts
        at 0.
        """
        pairs = zip(steps_of(controller), steps_of(self.rounded(controller)), strict=True)
        return tuple(replace(step, start=self._rest(other)) for step, other in pairs)

    def _rest(self, step: AgentStep) -> tuple[Row, ...] | None:
        kinds = ["x"] * len(step.x) + ["z"] * len(step.z)
        with suppress(InputError):
            for row, kind in zip(step.start or (), kinds, strict=step.start is not None):
                self.sum(row, kind, step.name)
            return step.start
        return None

    def sum(self, row: Row, kind: str, agent: str = "") -> FixedSum:
        """Return a sum for a signal of a kind.

        Raises
        ------
        InputError
            If the sum could leave 64 bits.
        """
        f = self.fractional(kind)
        scales = [self.fractional(signal.kind) for _, signal in row]
        top = max([*scales, f - self.bits])
        terms = []
        for (c, signal), scale in zip(row, scales, strict=True):
            m = int(self.number(c) * 2**self.bits) << (top - scale)
            if m:
                terms.append((m, signal))
        unit = 1 << (self.bits + top - f)
        reached = sum(abs(m) for m, _ in terms) * 2**WORD + unit
        if reached >= 2**LONG:
            over = (reached >> LONG).bit_length()
            raise InputError(
                f"a sum of agent {agent} could leave 64 bits: take {over} fractional bits less, "
                "larger ranges, or ranges that differ less"
            )
        return FixedSum(tuple(terms), unit)

    def limits(self, low: float, high: float) -> tuple[int, int]:
        """The integers of an input nearest to its limits, within them."""
        scale = 2 ** self.fractional("u")
        return max(ceil(Fraction(low) * scale), -LARGEST), min(
            floor(Fraction(high) * scale), LARGEST
        )

    def ends(self, pair: Range) -> Range:
        """The limits of an input at which the code cuts it off, exactly."""
        unit = Fraction(1, 2 ** self.fractional("u"))
        low, high = self.limits(to_float(pair[0]), to_float(pair[1]))
        return low * unit, high * unit

    def integers(self, kind: str, values: Sequence[float]) -> list[int]:
        """Signals of a kind as the nearest integers, halves upwards, within the range."""
        scale, end = 2.0 ** self.fractional(kind), float(LARGEST)
        return [floor(min(max(v * scale, -end), end) + 0.5) for v in values]

    def doubles(self, kind: str, values: Sequence[int]) -> list[float]:
        """Integers of a kind of signal as doubles, exactly."""
        scale = 2.0 ** self.fractional(kind)
        return [v / scale for v in values]

    def __str__(self) -> str:
        return f"fixed point, {self.bits} fractional bits"

    def document(self) -> dict[str, Any]:
        """Return plain data, for the equations."""
        return {
            "fractional bits of numbers": self.bits,
            "fractional bits of signals": {kind: self.fractional(kind) for kind in SIGNALS},
        }


@dataclass(frozen=True)
class FixedSum:
    """A sum of integers times signals, divided by a unit, which is a power of two."""

    terms: tuple[tuple[int, Signal], ...]
    unit: int

    def value(self, known: Callable[[Signal], int]) -> int:
        """The value, an integer of 32 bits."""
        total = sum(m * known(signal) for m, signal in self.terms)
        nearest = (total + self.unit // 2) // self.unit
        return min(max(nearest, -LARGEST), LARGEST)


class FixedAgent:
    """An agent that computes in fixed point, as the exported code does.

    Signals are doubles here, as for `AgentRun`: what is given is rounded to the nearest integer of
    its kind, within the range; what is returned is an integer times a power of two exactly.

    Parameters
    ----------
    step : AgentStep
    fixed : FixedPoint

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> from mcexact.designs import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
    >>> fixed = FixedPoint(2, {"u": 2**20})  # -1/3 becomes -1/4, and u has 10 fractional bits
    >>> [step] = steps_of(local_controllers(plant, [[["-1/3"]]]))
    >>> FixedAgent(step, fixed)([3.0], [], {})
    [-0.75]
    """

    def __init__(self, step: AgentStep, fixed: FixedPoint) -> None:
        self.step, self.fixed = step, fixed
        self._z = [0] * len(step.z)
        self._past = [[0] * len(step.x) for _ in range(step.remembered + 1)]
        self._sums = {
            part: [fixed.sum(row, part, step.name) for row in getattr(step, part)]
            for part in ("u", "x", "z")
        }

    def start(self, y: Sequence[float], r: Sequence[float]) -> None:
        """Put the states at rest for these outputs and set-points, or at 0; see `AgentRun`."""
        i, states = self.step.position, len(self.step.x)
        known = {(kind, i): self.fixed.integers(kind, own) for kind, own in (("y", y), ("r", r))}
        kinds = ["x"] * states + ["z"] * len(self.step.z)
        rows = self.step.start or ((),) * len(kinds)
        rest = [
            self.fixed.sum(row, kind).value(lambda s: known[s.kind, s.agent][s.entry])
            for row, kind in zip(rows, kinds, strict=True)
        ]
        self._z, self._past = rest[states:], [rest[:states] for _ in self._past]

    def sent_to(self, follower: int) -> list[float]:
        """What a follower receives of x in this step, before delays."""
        return self.fixed.doubles("x", self._past[self.step.sent[follower]])

    def __call__(
        self,
        y: Sequence[float],
        r: Sequence[float],
        received: Mapping[tuple[Kind, int], Sequence[float]],
    ) -> list[float]:
        """Run one step, and return the inputs; see `AgentRun`."""
        own: dict[tuple[Kind, int], Sequence[float]] = {
            ("y", self.step.position): y,
            ("r", self.step.position): r,
            **received,
        }
        known = {key: self.fixed.integers(key[0], values) for key, values in own.items()}
        known["x", self.step.position] = self._past[self.step.held]
        known["z", self.step.position] = self._z

        def sums(part: str) -> list[int]:
            return [
                each.value(lambda s: known[s.kind, s.agent][s.entry]) for each in self._sums[part]
            ]

        u = sums("u")
        computed = list(u)
        for k, *ends in self.step.cut():
            low, high = self.fixed.limits(*ends)
            u[k] = min(max(u[k], low), high)
        # what was cut off is smaller than what was computed, since limits contain 0
        known["e", self.step.position] = [a - v for a, v in zip(u, computed, strict=True)]
        x, z = sums("x"), sums("z")
        self._past, self._z = [x, *self._past[:-1]], z
        return self.fixed.doubles("u", u)


# How many bits are enough.


@dataclass(frozen=True)
class SafeBits:
    """An arithmetic whose rounded numbers are proved to keep every loop stable.

    Attributes
    ----------
    fixed : FixedPoint
    proof : BoxStability
        About every plant within the radii of the plant, and every controller whose entries differ
        by at most half of the last bit; of a sampled plant the samples are exact.
    """

    fixed: FixedPoint
    proof: BoxStability


def least_fixed_point(
    system: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None = None,
    *,
    ranges: Mapping[str, Any] | None = None,
) -> SafeBits:
    """Find the fewest fractional bits with which a controller is proved to keep its loop stable.

    Parameters
    ----------
    system : MultiChannelSystem
        The plant, in discrete time or sampled; with radii, all plants within them are meant.
    controller : Controller
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    ranges : mapping, optional
        As in `FixedPoint`.

    Raises
    ------
    LimitReached
        If no number of bits has a proof.
    InputError
        If so many bits are needed that sums could leave 64 bits.

    Notes
    -----
    The proof holds for every rounding of the entries by at most half a bit.  The disk margins of
    single loops are kept as well, in floating point: the rounded loop has at least 0.4, or nine
    tenths of a smaller one.  Bits are tried one after the other, each with one proof of
    `box_stability` at most.

    Examples
    --------
    >>> from mcexact.designs import local_controllers
    >>> plant = MultiChannelSystem([["33/20"]], [[[1]]], [[[1]]], time="discrete")
    >>> safe = least_fixed_point(plant, local_controllers(plant, [[["-4/5"]]]))
    >>> safe.fixed.bits, str(safe.fixed.number(Fraction(4, 5)))
    (4, '13/16')
    """
    # Code is written without numpy, which the search alone needs.
    from mcexact.analysis.boxes.loops import box_stability, with_gains
    from mcexact.floating.margins import is_within
    from mcexact.synthesis.optimum.diagnosis import kept_disk_margin, least_disk_margin

    InputError.require(system, MultiChannelSystem, "system")
    InputError.require(controller, Controller, "controller")
    loop = closed_loop(system, controller, graph)
    kept, first = kept_disk_margin(least_disk_margin(loop)), MOST_BITS
    steps = steps_of(controller)
    for bits in range(MOST_BITS + 1):
        if bits - first >= _MORE:
            break
        fixed = FixedPoint(bits, ranges or {})
        rounded = closed_loop(system, fixed.rounded(controller), graph)
        if not is_within(matrix_to_float(rounded.matrix), StabilityRegion(system.time)):
            continue
        if kept > 0 and least_disk_margin(rounded) < kept:
            continue
        first = min(first, bits)
        for step in steps:
            for kind, rows in (("u", step.u), ("x", step.x), ("z", step.z)):
                for row in rows:
                    fixed.sum(row, kind, step.name)
        with suppress(LimitReached):
            gains = with_gains(controller, partial(_half_bits, bits=bits))
            return SafeBits(fixed, box_stability(system, controller, graph, gains=gains))
    raise LimitReached(
        "no number of fractional bits was proved to keep the loop stable: give one, and certify "
        "the controller that is written beside the code"
    )


def _half_bits(M: Matrix, bits: int) -> Matrix:
    """The radii by which entries move at most when they are rounded; integers do not move."""
    half = Fraction(1, 2 ** (bits + 1))
    moved = [(i, j) for i, j, x in M.nonzero() if x % M.denominator]
    return Matrix.from_entries(M.shape, [(i, j, half) for i, j in moved])
