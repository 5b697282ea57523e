"""Plants near a given one, with the same zeros, of which an answer is another one.

An exact answer about data that are off in the last digit is an exact answer about another plant.
`nearby_plants` looks for plants beside a given one that have a fixed mode, cannot be stabilized, or
are not controlled or observed by all channels together, although the given plant is not so.

1. `suspects` computes where that is likely, in floating point.
2. `corrections` makes such a plant exact, the nearest that it finds, in the units of what the data
   allow: rounding errors first, then digits that were not typed.
3. `pencil_rank` proves that the mode is fixed there, of the pencil or of that of the dual plant,
   whichever has the smaller null space.  How far the plant is follows from both plants.

What is within the data, or within 10⁻⁶ of every entry, is told.  What is only suspected is called
computed.  That nothing is found proves nothing.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, TypeVar

import numpy as np
from threadpoolctl import threadpool_limits

from mcexact.analysis.fixed_modes import pencil_rank
from mcexact.analysis.nearby.allowances import (
    FARTHEST,
    Allowance,
    Unit,
    explained,
    is_typed,
    rounding,
    typed,
)
from mcexact.analysis.nearby.corrections import (
    Correction,
    Target,
    approached,
    changed,
    corrected,
    pencil_matrix,
    refined,
)
from mcexact.analysis.nearby.plants import Nearby, NearPlant, Suspicion
from mcexact.analysis.nearby.suspects import Suspect, balanced, by_bottleneck, suspects
from mcexact.answer.nearby import LOST, Lost
from mcexact.derived.constructions import dual
from mcexact.errors import InputError, several
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion, is_discrete
from mcexact.model.system import MultiChannelSystem

T = TypeVar("T")
_FARTHEST = float(FARTHEST)
_TRIES, _TRIES_OF_LARGE, _LARGE = 4, 2, 100
_HOPELESS = 100.0
"""A change in floating point so many times too large is not made exact."""
_LOOKED_AT = 1000
"""Of about so many entries the digits are counted."""
_CLOSE = 4
_MOVED = 4
_TOLERANCES = (1e-8, 1e-12, 0.0)


def nearby_plants(
    system: MultiChannelSystem, lost: Iterable[Lost] = LOST, *, seconds: float | None = None
) -> Nearby:
    """Search plants near a given one that lack what it has.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant, no derived system.
    lost : iterable of {"unstable", "fixed", "uncontrollable", "unobservable"}
        What to look for; what the given plant lacks itself is not to be among them.
    seconds : float, optional
        After so many seconds no further suspect is looked at: what was found until then is told.

    Raises
    ------
    InputError
        If something else is asked for.

    Notes
    -----
    The search is in floating point, and its result can depend on the processor; what it returns is
    exact.  A plant with a fixed mode is left out if the data allow one that cannot be stabilized.

    Examples
    --------
    The sum of both states cannot be controlled but for a rounding error:

    >>> plant = MultiChannelSystem(
    ...     [["-0.30000000000000004", "0.7"], ["0.3", "-0.7"]],
    ...     [[["0.1"], ["-0.1"]]],
    ...     [[[1, 0]]],
    ... )
    >>> near = nearby_plants(plant).get("unstable")
    >>> near.about, near.within, near.part < Fraction(1, 10**15)
    ('0', 'rounding', True)
    """
    InputError.require(system, MultiChannelSystem, "system")
    wanted = several(lost, "lost")
    if unknown := [each for each in wanted if each not in LOST]:
        raise InputError(f"expected some of {', '.join(LOST)}, found {unknown[0]!r}", where="lost")
    if system.subject:
        raise InputError("expected a plant, found a derived system", where="system")
    chosen = tuple(each for each in LOST if each in wanted)
    if not system.n or not chosen:
        return Nearby(system, chosen, (), ())
    with _one_thread():
        search = _Search.of(system, seconds)
        if search is None:
            return Nearby(system, chosen, (), ())
        plants = {each: search.nearest(each) for each in chosen}
    unstable = plants.get("unstable")
    if unstable is not None and unstable.within is not None:
        plants.pop("fixed", None)
    found = tuple(each for each in plants.values() if each is not None)
    left = [each for each in plants if plants[each] is None]
    ended = f"the time limit of its search, {seconds:.2g} s, was reached" if search.ended else ""
    return Nearby(system, chosen, found, tuple(search.suspicions(left)), ended)


@contextmanager
def _one_thread() -> Iterator[None]:
    """Run floating point in one thread without warnings: all that it finds is made exact."""
    with threadpool_limits(1, "blas"), np.errstate(all="ignore"):
        yield


class _Search:
    """The search near one plant: each suspect is made exact once, whatever is looked for."""

    def __init__(
        self, system: MultiChannelSystem, floats: Any, seconds: float | None = None
    ) -> None:
        self.system, self.floats, self.ended = system, floats, False
        self._end = math.inf if seconds is None else time.monotonic() + seconds
        self.region = StabilityRegion(system.time)
        self.discrete = is_discrete(system.time)
        self.suspects = by_bottleneck(self._in_time(suspects(floats, self.discrete)))
        matrices = (system.A, *system.B, *system.C)
        entries = [(x, M.denominator) for M in matrices for *_, x in M.nonzero()]
        broken = [(x, d) for x, d in entries if x % d]
        values = [Fraction(x, d) for x, d in broken[:: 1 + len(broken) // _LOOKED_AT]]
        # Of floats some have few digits by chance.
        self.has_typed = 4 * sum(map(is_typed, values)) > len(values)
        self._known: dict[Suspect, NearPlant | None] = {}
        self._computed: dict[Suspect, float] = {}

    @classmethod
    def of(cls, system: MultiChannelSystem, seconds: float | None = None) -> _Search | None:
        """Begin; None if the plant is beyond the range of floats."""
        floats = balanced(system)
        try:
            return None if floats is None else cls(system, floats, seconds)
        except np.linalg.LinAlgError:
            return None

    def _in_time(self, work: Iterable[T]) -> Iterator[T]:
        """Yield what follows until the time is over."""
        for each in work:
            if time.monotonic() > self._end:
                self.ended = True
                return
            yield each

    def nearest(self, lost: Lost) -> NearPlant | None:
        """Return the nearest plant that was found without a property."""
        most = _TRIES if self.system.n < _LARGE else _TRIES_OF_LARGE
        best: NearPlant | None = None
        able = [each for each in self.suspects if self._fits(each, lost)][:most]
        for suspect in self._in_time(able):
            near = self._plant(suspect)
            if near is None or (lost == "unstable" and self._is_stable(near)):
                continue
            if best is None or _order(near) < _order(best):
                best = replace(near, lost=lost)
            if best.within == "rounding":
                break
        return best

    def suspicions(self, lost: Iterable[Lost]) -> Iterator[Suspicion]:
        """Yield for each property the nearest plant that was computed, and not made exact."""
        for each in lost:
            able = [
                suspect
                for suspect in self._computed
                if self._fits(suspect, each) and self._known.get(suspect) is None
            ]
            if able:
                suspect = min(able, key=self._computed.__getitem__)
                s = self.system.named(self._inside(suspect))
                yield Suspicion(each, self._point(suspect), s, self._computed[suspect])

    def _fits(self, suspect: Suspect, lost: Lost) -> bool:
        if lost == "uncontrollable":
            return len(suspect.outside) == self.system.m
        if lost == "unobservable":
            return not suspect.outside
        if lost == "unstable":
            point, unit = self._point(suspect), 2.0**self.floats.units.time
            # The mode of the plant nearby is elsewhere, about as far as the path is wide.
            margin = (1e-6 + _MOVED * suspect.bottleneck) * max(abs(point), unit)
            return bool(abs(point) >= 1 - margin if self.discrete else point.real >= -margin)
        return True

    def _is_stable(self, near: NearPlant) -> bool:
        return self.region.contains_roots_of(near.mode)

    def _point(self, suspect: Suspect) -> complex:
        return complex(suspect.point * 2.0**self.floats.units.time)

    def _inside(self, suspect: Suspect) -> tuple[int, ...]:
        return tuple(i for i in range(self.system.m) if i not in suspect.outside)

    def _plant(self, suspect: Suspect) -> NearPlant | None:
        """The nearest plant that was found for one suspect."""
        if suspect not in self._known:
            best: _Change | None = None
            for each in self._in_time(self._changes(suspect)):
                if best is None or _order(each) < _order(best):
                    best = each
                if best.within == "rounding":
                    break
            self._known[suspect] = None if best is None else self._proved(suspect, best)
        return self._known[suspect]

    def _changes(self, suspect: Suspect) -> Iterator[_Change]:
        """Exact changes, found in several units, first those that keep integers."""
        for whole in (True, False):
            for unit, widest in ((abs, 1e-3), (rounding, 1e-6), (typed, 1.0)):
                target = None
                if suspect.bottleneck < widest and (unit is not typed or self.has_typed):
                    target = self._target(suspect, unit, whole)
                if target is None:
                    continue
                side = min((target, target.transposed()), key=lambda each: each.wanted)
                near = approached(side, suspect.point)
                if near is None:
                    continue
                limit = _FARTHEST if unit is abs else 1.0
                if near.size <= limit:
                    known = self._computed.get(suspect, math.inf)
                    self._computed[suspect] = min(near.part, known)
                if _HOPELESS * limit < near.size < math.inf:
                    continue
                exact = refined(side, near)
                for tolerance in _TOLERANCES:
                    made = corrected(side, exact, tolerance)
                    if made is not None and not made.change:
                        # The given plant has this mode itself.
                        self._computed.pop(suspect, None)
                        return
                    change = None if made is None else _Change.of(target, made, side is not target)
                    if change is not None:
                        yield change
                        if change.part <= _CLOSE * Fraction(near.part):
                            break

    def _target(self, suspect: Suspect, unit: Unit, whole: bool) -> Target | None:
        """The pencil of a suspect; None if there are no integers to change."""
        system, floats = self.system, self.floats
        T, s = suspect.outside, self._inside(suspect)
        Z = pencil_matrix(system.A, [system.B[i] for i in T], [system.C[i] for i in s])
        entries = {(i, j): Fraction(x, Z.denominator) for i, j, x in Z.nonzero()}
        if not whole and not any(x.denominator == 1 for x in entries.values()):
            return None
        allowed = {
            at: Fraction(0) if whole and x.denominator == 1 else unit(x)
            for at, x in entries.items()
        }
        states, time = floats.units.states, floats.units.time
        inputs = floats.units.inputs[np.isin(floats.of_inputs, T)]
        outputs = floats.units.outputs[np.isin(floats.of_outputs, s)]
        rows = np.concatenate([-states - time, outputs])
        columns = np.concatenate([states, inputs + time])
        return Target(Z, system.n, entries, allowed, rows, columns, time)

    def _proved(self, suspect: Suspect, change: _Change) -> NearPlant | None:
        """The plant with a change, if the rank of its pencil is below n."""
        system, T, s = self.system, suspect.outside, self._inside(suspect)
        plant = changed(system, s, change.matrix)
        if sum(system.p(i) for i in T) <= sum(system.q(i) for i in s):
            proof = pencil_rank(plant, system.named(s), change.mode)
        else:
            proof = pencil_rank(dual(plant), system.named(T), change.mode)
        if proof.rank >= system.n:
            return None
        names = system.named(s)
        return NearPlant("fixed", plant, change.part, change.within, change.mode, names, proof)


@dataclass(frozen=True, eq=False)
class _Change:
    """An exact change of the matrix of a pencil, and how large it is."""

    matrix: Matrix
    mode: Polynomial
    part: Fraction
    within: Allowance | None

    @classmethod
    def of(cls, target: Target, made: Correction, turned: bool) -> _Change | None:
        """Measure a change; None if the plant is the same or too far."""
        change = {(at[::-1] if turned else at): x for at, x in made.change.items()}
        entries = target.entries
        if any(x == -entries[at] for at, x in change.items()):
            return None
        part, within = explained((entries[at], x) for at, x in change.items())
        if not change or not (within or part <= FARTHEST):
            return None
        listed = ((i, j, x) for (i, j), x in change.items())
        matrix = Matrix.from_entries(target.Z.shape, listed)
        return cls(matrix, made.polynomial, part, within)


def _order(found: NearPlant | _Change) -> tuple[bool, bool, Fraction]:
    """How near a plant is: what the data allow comes first."""
    return found.within != "rounding", found.within is None, found.part
