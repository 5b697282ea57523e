"""Channel controllers for drawn gains in each strong component, and the choice of the best."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import ceil
from typing import Any

from mcexact.answer.fixed_spectrum import FixedSpectrum
from mcexact.derived.feedback import closed_by
from mcexact.derived.modular_system import generator
from mcexact.errors import InputError, InternalError
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial, product
from mcexact.synthesis.methods import (
    ChannelController,
    ChannelReach,
    DrawnGains,
    assigning_controllers,
    channel_part,
    riccati_channel_controller,
    scaled_polynomial,
    spectrum_polynomial,
)
from mcexact.synthesis.network.networks import DerivedNetwork
from mcexact.synthesis.request import Request

_KEPT = 8
_KEPT_FLOAT = 6
_SMALL_GAIN = 1000


@dataclass(frozen=True)
class NetworkTask:
    """The task of a network design, before gains are drawn."""

    network: DerivedNetwork
    components: tuple[tuple[int, ...], ...]
    choices: tuple[tuple[int, ...], ...]
    spectrum: FixedSpectrum
    prescribed: Any
    request: Request

    def component_of(self, channel: int) -> int:
        return next(c for c, members in enumerate(self.components) if channel in members)

    def polynomial(self, channel: int, own: Polynomial, degree: int, *, only: bool) -> Polynomial:
        """The polynomial of the block with this channel: prescribed, or near its own."""
        if self.prescribed is None:
            return scaled_polynomial(own, self.request.region, degree)
        if only and not isinstance(self.prescribed, Mapping):
            return spectrum_polynomial(self.prescribed, degree, where="spectrum.closed_loop")
        names = self.network.given.names
        members = [names[i] for i in self.components[self.component_of(channel)]]
        if isinstance(self.prescribed, Mapping):
            given = [name for name in members if name in self.prescribed]
            if len(given) == 1:
                where = f"spectrum.closed_loop.{given[0]}"
                return spectrum_polynomial(self.prescribed[given[0]], degree, where=where)
        raise InputError(
            "the spectrum splits into one set for each strong component of the transfer graph: "
            f"expected {{agent: numbers, …}} with {degree} numbers for one agent of "
            f"{', '.join(members)}",
            where="spectrum.closed_loop",
        )


def best_candidate(task: NetworkTask, drawn: Sequence[DrawnGains]) -> NetworkCandidate | None:
    """Return the best candidate of the most promising draws, or None.

    Exact designs minimize the order, then the length of numbers; in floating point the order is
    given, and the gains are minimized.
    """
    if not drawn:
        return None
    first = drawn[0]
    if task.request.arithmetic == "float":
        alike = [d for d in drawn if d.degree == first.degree][:_KEPT_FLOAT]
    else:
        alike = [d for d in drawn if (d.degree, d.order) == (first.degree, first.order)][:_KEPT]
    best: NetworkCandidate | None = None
    for k, each in enumerate(alike):
        task.request.tell(f"channel controllers, candidate {k + 1}")
        candidate = _candidate(task, each)
        if candidate is not None and (best is None or candidate.cost < best.cost):
            best = candidate
            if task.request.arithmetic == "float" and best.largest <= _SMALL_GAIN:
                break
    return best


@dataclass(frozen=True)
class NetworkCandidate:
    """Gains, channel controllers, the polynomials of the blocks, and the remaining fixed modes."""

    gains: tuple[Matrix, ...]
    channels: Mapping[int, ChannelController]
    polynomials: Mapping[int, Polynomial]
    kept: Polynomial

    @property
    def largest(self) -> Fraction:
        """The largest entry of a channel controller."""
        return max((made.largest for made in self.channels.values()), default=Fraction(0))

    @property
    def cost(self) -> int:
        """A measure of the length of numbers, dominated by the largest ones."""
        return sum(
            made.bit_length + 3 * ceil(made.largest).bit_length() for made in self.channels.values()
        )


def _candidate(task: NetworkTask, drawn: DrawnGains) -> NetworkCandidate | None:
    """Make channel controllers for drawn gains; None if a mode that is not fixed would remain."""
    system = task.network.system
    rng = generator(system, "channel_controller")
    M = closed_by(system, drawn.gains)
    parts = {
        reach.channel: channel_part(M, system.B(reach.channel), system.C(reach.channel), rng)
        for reach in drawn.reaches
    }
    own = {channel: characteristic_polynomial(part.A) for channel, part in parts.items()}
    moved = product(own.values())
    kept, remainder = divmod(characteristic_polynomial(M), moved)
    if not remainder.is_zero():
        raise InternalError("a part of a loop has modes that the loop does not have")
    if not _only(kept, task.spectrum.polynomial):
        return None
    made, wanted = {}, {}
    for reach in drawn.reaches:
        if task.request.arithmetic == "float":
            channel, found = _riccati_controller(task, M, reach)
        else:
            part, channel = parts[reach.channel], reach.channel
            degree = part.A.nrows + reach.index - 1
            polynomial = task.polynomial(channel, own[channel], degree, only=len(parts) == 1)
            controllers = assigning_controllers(
                part.A, part.B, part.C, polynomial, index=reach.index, side=reach.side, rng=rng
            )
            found = next(controllers, None)
        if found is None or found.polynomial is None:
            return None
        made[channel], wanted[channel] = found, found.polynomial
    return NetworkCandidate(drawn.gains, made, wanted, kept)


def _riccati_controller(
    task: NetworkTask, M: Matrix, reach: ChannelReach
) -> tuple[int, ChannelController | None]:
    """Return the controller with the smallest gains among channels that move equally many modes."""
    system = task.network.system
    rng = generator(system, "channel_controller")
    best: tuple[int, ChannelController | None] = (reach.channel, None)
    for q in next(choice for choice in task.choices if reach.channel in choice):
        part = channel_part(M, system.B(q), system.C(q), rng)
        if part.A.nrows != reach.degree:
            continue
        found = riccati_channel_controller(part, task.request.region)
        if found is not None and (best[1] is None or found.largest < best[1].largest):
            best = (q, found)
    return best


def _only(p: Polynomial, allowed: Polynomial) -> bool:
    """Whether every root of p is one of the other polynomial."""
    while p.degree > 0:
        common = p.gcd(allowed)
        if common.degree < 1:
            return False
        p = p // common
    return True
