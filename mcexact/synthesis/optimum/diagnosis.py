"""What a request costs before any design: the sensible rate, and the modes that resist."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import ROUND_FLOOR, Context
from fractions import Fraction

import numpy as np
from scipy.linalg import eig

from mcexact.errors import LimitReached
from mcexact.exact.floats import matrix_to_float, to_float
from mcexact.exact.location import StabilityRegion
from mcexact.floating.fixed_mode_distance import distance_at
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.optimum.figures import CentralOptimum, Figures, central_optimum
from mcexact.synthesis.optimum.kernel import quiet_floats
from mcexact.synthesis.optimum.sensitivity import norm
from mcexact.synthesis.optimum.weights import Weights

TIMES_THE_COST, MARGIN = 10.0, 0.3
TIMES_OUT_OF_REACH, OUT_OF_REACH_MARGIN = 1000.0, 0.05
_STEPS, _STEPS_IF_LARGE, _LARGE = 14, 4, 100
_FEWEST_MODES, _WORK = 3, 20_000_000
_FASTER = (2.0, 4.0, 8.0)
_WIDTH, _FACTOR, _FASTEST = 1.02, 4.0, 64.0
_FAST_ENOUGH = 2.3026


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
        without one, and a margin of 0.3; None if none was found.  The search does not go beyond 64
        times the given rate, nor for plants of more than 100 states beyond this rate.
    modes : tuple of SlowMode
        Those outside the region, or some of them if there are many: the nearest to being fixed
        first.
    """

    region: StabilityRegion
    central: CentralOptimum | None
    unhurried: CentralOptimum | None
    sensible: StabilityRegion | None
    modes: tuple[SlowMode, ...]

    @property
    def is_sensible(self) -> bool:
        """Whether the region is one in which the central optimum is affordable."""
        return self.central is not None and self.allows(self.central.figures)

    def allows(self, figures: Figures) -> bool:
        """Whether a loop has a margin of 0.3, and at most ten times the least cost."""
        return self.unhurried is not None and _is_affordable(figures, self.unhurried)

    @property
    def is_out_of_reach(self) -> bool:
        """Whether another rate is sensible, and for this one the central optimum is of no use.

        Its margin is below 0.05; or it is below 0.3, and the cost is 1000 times the least.
        """
        if self.sensible is None or self.unhurried is None or self.is_sensible:
            return False
        if self.central is None:
            return True
        figures, least = self.central.figures, self.unhurried.figures.cost
        dear = not figures.cost <= TIMES_OUT_OF_REACH * least
        return figures.margin < (MARGIN if dear else OUT_OF_REACH_MARGIN)

    @property
    def sensible_bound(self) -> str:
        """The sensible rate or radius to three digits, or that there is none."""
        if self.sensible is None:
            return "none"
        edge = to_float(self.sensible.edge)
        return f"{edge:.4g}" if self.sensible.discrete else f"{edge:.3g}"

    def __str__(self) -> str:
        told = [f"sensible {self.region.word} {self.sensible_bound}"]
        for each in self.modes[:1]:
            told.insert(
                0, f"mode {_shown(each.mode)}: a relative change of {each.change:.0e} fixes it"
            )
        return f"{'; '.join(told)} (computed)"

    def view(self) -> dict[str, object]:
        """Return the diagnosis as plain data."""
        nearest = self.modes[0] if self.modes else None
        return {
            f"sensible_{self.region.word}": None
            if self.sensible is None
            else to_float(self.sensible.edge),
            "within": self.is_sensible,
            "nearest_to_fixed": None
            if nearest is None
            else {
                "mode": {"re": nearest.mode.real, "im": nearest.mode.imag},
                "relative_change": nearest.change,
                "channels": list(nearest.channels),
            },
        }


def _shown(mode: complex) -> str:
    real = f"{mode.real:.4g}"
    return real if not mode.imag else f"{real} ± {abs(mode.imag):.4g}i"


def _affordable(found: CentralOptimum | None, unhurried: CentralOptimum | None) -> bool:
    if found is None or unhurried is None:
        return False
    return _is_affordable(found.figures, unhurried)


def _is_affordable(figures: Figures, unhurried: CentralOptimum) -> bool:
    return figures.margin >= MARGIN and figures.cost <= TIMES_THE_COST * unhurried.figures.cost


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
    >>> diagnosed(plant, StabilityRegion("continuous")).sensible.edge > 1
    True
    """
    weights = weights or Weights.unit(system)
    with quiet_floats():
        central = central_optimum(system, weights, region)
        unhurried = central_optimum(system, weights, StabilityRegion(system.time))
        start, found = region, central
        if region.edge == StabilityRegion(system.time).edge and unhurried:
            # The sensible rate is searched around a rate, of which stability alone gives none.
            start = _own_region(system.time, unhurried) or region
            found = central_optimum(system, weights, start)
        sensible = _sensible(system, weights, start, found, unhurried)
        modes = slow_modes(controlled or system, region)
    return Diagnosis(region, central, unhurried, sensible, modes)


def with_diagnosis(
    limit: LimitReached,
    system: MultiChannelSystem,
    region: StabilityRegion,
    weights: Weights | None = None,
    controlled: MultiChannelSystem | None = None,
) -> LimitReached:
    """Return a limit that also tells the diagnosis; the other arguments are those of `diagnosed`.

    Without a diagnosis the limit is the same, for plants whose numbers exceed floats.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> limit = LimitReached("2000 draws found nothing")
    >>> str(with_diagnosis(limit, plant, StabilityRegion("continuous"))).split("; ")[:2]
    ['2000 draws found nothing', 'mode 1: a relative change of 1e+00 fixes it']
    """
    matrices = (system.A, system.input_matrix(), system.output_matrix())
    if not all(np.all(np.isfinite(matrix_to_float(each))) for each in matrices):
        return limit
    return LimitReached(f"{limit}; {diagnosed(system, region, weights, controlled)}")


def chosen_region(
    system: MultiChannelSystem, weights: Weights | None = None
) -> tuple[StabilityRegion, str] | None:
    """Choose a region: of half the sensible rate, or of the root of the sensible radius.

    Parameters
    ----------
    system : MultiChannelSystem
    weights : Weights, optional

    Returns
    -------
    (StabilityRegion, str) or None
        The rate has two digits, in discrete time the distance of the radius to 1.  The text says
        how it was chosen: where half the sensible rate is not sensible it is the sensible one, and
        where none is, half the rate of the optimal controller of all agents together; no radius is
        below a tenth.  None without such a controller in floating point.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> region, told = chosen_region(plant)
    >>> print(region, told, sep=", ")
    Re λ < -21/5, half the sensible rate
    """
    weights, stable = weights or Weights.unit(system), StabilityRegion(system.time)
    part = "the root of" if stable.discrete else "half"
    with quiet_floats():
        unhurried = central_optimum(system, weights, stable)
        if unhurried is None:
            return None
        region = _own_region(system.time, unhurried)
        if region is None:
            return None
        central = central_optimum(system, weights, region)
        sensible = _sensible(system, weights, region, central, unhurried)
        pace, told = _pace(sensible or region) / 2, f"{part} the sensible {stable.word}"
        if sensible is None:
            told = f"{part} that of the optimal controller of all agents together"
        else:
            slower = central_optimum(system, weights, _of_pace(system.time, pace))
            if not _affordable(slower, unhurried):
                pace, told = 2 * pace, f"the sensible {stable.word}"
    if stable.discrete and pace > _FAST_ENOUGH:
        pace, told = _FAST_ENOUGH, f"fast enough, and slower than {told}"
    return _rounded_region(system.time, pace), told


def slow_modes(system: MultiChannelSystem, region: StabilityRegion) -> tuple[SlowMode, ...]:
    """Return the computed modes outside a region, the nearest to being fixed first.

    Notes
    -----
    The distance is searched for the modes that agents control or observe least, in terms of their
    eigenvectors: for all of a small plant, and for a few of a large one.
    """
    if not system.n:
        return ()  # SciPy 1.11 refuses a matrix without entries
    A = matrix_to_float(system.A)
    B = [matrix_to_float(system.B(i)) for i in range(system.m)]
    C = [matrix_to_float(system.C(i)) for i in range(system.m)]
    solved = eig(A, left=True)
    values, left, right = (np.asarray(each, dtype=np.complex128) for each in solved)
    limit, size = to_float(region.limit), float(np.linalg.norm(A, 2)) or 1.0
    slow = []
    for k, value in enumerate(map(complex, values)):
        if value.imag < 0 or (abs(value) if region.discrete else value.real) < limit:
            continue
        moved = [norm(left[:, k].conj() @ each) for each in B]
        seen = [norm(each @ right[:, k]) for each in C]
        slow.append((max(map(min, moved, seen), default=0.0), value))
    slow.sort(key=lambda each: (each[0], each[1].real, each[1].imag))
    count = max(_FEWEST_MODES, _WORK // max(system.n**3 * system.m, 1))
    found = []
    for _, value in slow[:count]:
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
    if unhurried is None:
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
    if not holds and system.n <= _LARGE:
        # Without a rate the optimum can be fragile where that of a moderate rate is not.
        for factor in _FASTER:
            faster = _of_pace(system.time, factor * _pace(region))
            if _affordable(central_optimum(system, weights, faster), unhurried):
                return faster
    return _of_pace(system.time, holds) if holds else None


def _rounded_region(time: str, pace: float) -> StabilityRegion:
    """A region, not faster, whose rate or distance of the radius to 1 has two digits.

    Examples
    --------
    >>> print(_rounded_region("continuous", 0.259), _rounded_region("discrete", 0.001), sep=", ")
    Re λ < -1/4, |λ| < 99901/100000
    """
    discrete = StabilityRegion(time).discrete
    exact = float(-np.expm1(-pace)) if discrete else pace
    edge = Fraction(Context(prec=2, rounding=ROUND_FLOOR).create_decimal_from_float(exact))
    return StabilityRegion(time, 1 - edge if discrete else edge)


def _own_region(time: str, unhurried: CentralOptimum) -> StabilityRegion | None:
    """The region of the slowest eigenvalue of the optimal controller for which no rate is asked."""
    bound = unhurried.figures.bound
    pace = -float(np.log(max(bound, 1e-3))) if StabilityRegion(time).discrete else -bound
    return _of_pace(time, pace) if 0 < pace < np.inf else None


def _pace(region: StabilityRegion) -> float:
    """The rate, or −log of the radius, which is 0.02 for the radius 1."""
    if not region.discrete:
        return to_float(region.edge)
    return float(-np.log(to_float(region.edge))) or 0.02


def _of_pace(time: str, pace: float) -> StabilityRegion:
    """The region of a rate, or of the radius exp(−pace), to three digits."""
    bound = float(np.exp(-pace)) if StabilityRegion(time).discrete else pace
    # Beyond four digits a radius is 1.
    bound = min(bound, 0.9999) if StabilityRegion(time).discrete else bound
    return StabilityRegion.of(
        time, bound=Fraction(f"{bound:.2e}" if bound < 0.9 else f"{bound:.4g}")
    )
