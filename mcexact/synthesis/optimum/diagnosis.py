"""What a request costs before any design: the sensible rate, and the modes that resist."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from mcexact.exact.floats import matrix_to_float, to_float
from mcexact.exact.location import StabilityRegion
from mcexact.floating.fixed_mode_distance import distance_at
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.optimum.figures import CentralOptimum, central_optimum
from mcexact.synthesis.optimum.weights import Weights

TIMES_THE_COST, MARGIN = 10.0, 0.3
_STEPS, _STEPS_IF_LARGE, _LARGE = 14, 4, 100
_WIDTH, _FACTOR, _FASTEST = 1.02, 4.0, 64.0


@dataclass(frozen=True)
class SlowMode:
    """A mode of the plant outside a region, and how little makes it a fixed mode.

    Attributes
    ----------
    mode : complex
    change : float
        An upper limit on the least change that makes it fixed, relative to ‖A‖.
    channels : tuple of str
        The channels that cannot move it then, by their outputs or by their inputs.
    """

    mode: complex
    change: float
    channels: tuple[str, ...]


@dataclass(frozen=True)
class Diagnosis:
    """What a request costs, computed in floating point and not proved.

    Attributes
    ----------
    region : StabilityRegion
    central, unhurried : CentralOptimum or None
        Of the optimal controller of all agents together, for the region and without one.
    sensible : StabilityRegion or None
        The fastest region found in which this controller has at most ten times the cost that it has
        without one, and a margin of 0.3; None if there is none.  The search does not go beyond 64
        times the given rate, nor for plants of more than 100 states beyond this rate.
    modes : tuple of SlowMode
        Those outside the region, the nearest to being fixed first.
    """

    region: StabilityRegion
    central: CentralOptimum | None
    unhurried: CentralOptimum | None
    sensible: StabilityRegion | None
    modes: tuple[SlowMode, ...]

    @property
    def is_sensible(self) -> bool:
        """Whether the region is one in which the central optimum is affordable."""
        return _affordable(self.central, self.unhurried)

    def __str__(self) -> str:
        word = self.region.word
        found = "none" if self.sensible is None else f"{to_float(self.sensible.edge):.3g}"
        told = [f"sensible {word} {found}"]
        for each in self.modes[:1]:
            told.insert(
                0, f"mode {_shown(each.mode)}: a relative change of {each.change:.0e} fixes it"
            )
        return "; ".join(told)


def _shown(mode: complex) -> str:
    real = f"{mode.real:.4g}"
    return real if not mode.imag else f"{real} ± {abs(mode.imag):.4g}i"


def _affordable(found: CentralOptimum | None, unhurried: CentralOptimum | None) -> bool:
    if found is None or unhurried is None:
        return False
    figures, least = found.figures, unhurried.figures.cost
    return figures.margin >= MARGIN and figures.cost <= TIMES_THE_COST * least


def diagnosed(
    system: MultiChannelSystem,
    region: StabilityRegion,
    weights: Weights | None = None,
    controlled: MultiChannelSystem | None = None,
) -> Diagnosis:
    """Compute what a region costs, and which modes resist.

    Parameters
    ----------
    system : MultiChannelSystem
        n states and m channels.
    region : StabilityRegion
    weights : Weights, optional
    controlled : MultiChannelSystem, optional
        The system whose decentralized controllers are sought, if it is not the given one.

    Notes
    -----
    O(n³) for each of about 12 steps of a bisection, and the search of `distance_at` for each mode.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1, 0], [0, -2]], [[["1"], ["1e-6"]]], [[[1, 1]]])
    >>> found = diagnosed(plant, StabilityRegion("continuous", 3))
    >>> found.is_sensible, found.modes[0].mode
    (False, (-2+0j))
    """
    weights = weights or Weights.unit(system)
    central = central_optimum(system, weights, region)
    unhurried = central_optimum(system, weights, StabilityRegion(system.time))
    sensible = _sensible(system, weights, region, central, unhurried)
    return Diagnosis(region, central, unhurried, sensible, slow_modes(controlled or system, region))


def slow_modes(system: MultiChannelSystem, region: StabilityRegion) -> tuple[SlowMode, ...]:
    """Return the computed modes outside a region, the nearest to being fixed first."""
    A = matrix_to_float(system.A)
    B = [matrix_to_float(system.B(i)) for i in range(system.m)]
    C = [matrix_to_float(system.C(i)) for i in range(system.m)]
    values, limit = np.linalg.eigvals(A).astype(np.complex128), to_float(region.limit)
    size = float(np.linalg.norm(A, 2)) or 1.0
    found = []
    for value in map(complex, values):
        height = abs(value) if region.discrete else value.real
        if value.imag < 0 or height < limit:
            continue
        change, channels = distance_at(A, B, C, value)
        found.append(SlowMode(value, change / size, system.named(channels)))
    return tuple(sorted(found, key=lambda each: each.change))


def _sensible(
    system: MultiChannelSystem,
    weights: Weights,
    region: StabilityRegion,
    central: CentralOptimum | None,
    unhurried: CentralOptimum | None,
) -> StabilityRegion | None:
    """Search, from a region, for the fastest one that is affordable, by factors and bisection."""
    if not _affordable(unhurried, unhurried):
        return None
    steps = _STEPS if system.n <= _LARGE else _STEPS_IF_LARGE
    if system.n > _LARGE and _affordable(central, unhurried):
        return region
    pace, holds, fails = _pace(region), 0.0, np.inf
    found = central
    for _ in range(steps):
        if _affordable(found, unhurried):
            holds = pace
        else:
            fails = pace
        if holds >= _FASTEST * _pace(region) or (holds and fails / holds < _WIDTH):
            break
        if holds and np.isfinite(fails):
            # Wide brackets are halved in the logarithm, too.
            pace = float(np.sqrt(holds * fails))
        else:
            pace = _FACTOR * holds if holds else fails / _FACTOR
        found = central_optimum(system, weights, _of_pace(system.time, pace))
    return _of_pace(system.time, holds) if holds else None


def _pace(region: StabilityRegion) -> float:
    """The rate, or −log of the radius, which is 0.02 for the radius 1."""
    if not region.discrete:
        return to_float(region.edge)
    return float(-np.log(to_float(region.edge))) or 0.02


def _of_pace(time: str, pace: float) -> StabilityRegion:
    """The region of a rate, or of the radius exp(−pace), to three digits."""
    bound = float(np.exp(-pace)) if StabilityRegion(time).discrete else pace
    return StabilityRegion.of(
        time, bound=Fraction(f"{bound:.2e}" if bound < 0.9 else f"{bound:.4g}")
    )
