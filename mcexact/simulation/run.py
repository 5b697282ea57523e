"""A simulation together with the spectrum of the closed loop, which the simulation does not use."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from mcexact.analysis.stability.closed_loop_spectrum import closed_loop_spectrum
from mcexact.answer.loop_spectrum import LoopSpectrum
from mcexact.errors import InputError
from mcexact.exact.floats import to_float
from mcexact.exact.location import is_discrete
from mcexact.model.controller import Controller
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.simulation.trajectory import InitialState, Trajectory, default_initial, simulate

# Beyond this size the exact characteristic polynomial takes too long.
_LARGEST_SPECTRUM = 60


@dataclass(frozen=True)
class SimulatedLoop:
    """A simulation, with the spectrum of the closed loop if it was computed.

    Attributes
    ----------
    title : str
    run : Trajectory
    spectrum : LoopSpectrum or None
    warnings : tuple of str
    """

    title: str
    run: Trajectory
    spectrum: LoopSpectrum | None
    warnings: tuple[str, ...]


def simulated_loop(
    system: MultiChannelSystem,
    controller: Controller,
    *,
    initial: Sequence[Fraction] | None = None,
    horizon: Fraction | None = None,
    reference: Sequence[Fraction] | None = None,
    arithmetic: str | None = None,
) -> SimulatedLoop:
    """Simulate a controller, and compute the spectrum of its loop and warnings.

    Parameters
    ----------
    system : MultiChannelSystem
    controller : Controller
    initial : sequence of Fraction, optional
        The plant's initial state.
    horizon : Fraction, optional
        By default chosen from the spectrum, long enough to show the decay.
    reference : sequence of Fraction, optional
        The set-points of all outputs, in the order of the channels.
    arithmetic : str, optional
        As in `simulate`.
    """
    M = closed_loop(system, controller).matrix
    spectrum = None
    if M.nrows <= _LARGEST_SPECTRUM:
        spectrum = closed_loop_spectrum(M, system.time)
    start = default_initial(system, controller)
    if initial is not None:
        if len(initial) != system.n:
            raise InputError(f"expected {system.n} numbers, found {len(initial)}", where="initial")
        start = InitialState(tuple(initial), start.shared, start.private)
    run = simulate(
        system,
        controller,
        initial=start,
        horizon=_horizon(system.time, spectrum, M.nrows) if horizon is None else horizon,
        reference=_by_channel(system, reference),
        arithmetic=arithmetic,
    )
    warnings = controller.warnings_for(system) + (() if run.warning is None else (run.warning,))
    return SimulatedLoop(system.name or "simulation", run, spectrum, warnings)


def _horizon(time: str, spectrum: LoopSpectrum | None, states: int) -> Fraction:
    """Return a horizon of some time constants, within limits."""
    rate = None if spectrum is None else spectrum.rate
    if is_discrete(time):
        radius = 0.9 if rate is None else min(0.95, to_float(rate.upper))
        steps = states if radius <= 0 else max(states, math.ceil(-10 / math.log(radius)))
        return Fraction(min(steps + 3, 200))
    lower = Fraction(1) if rate is None else Fraction(rate.lower)
    if lower <= 0:
        return Fraction(5)
    return min(Fraction(100), max(Fraction(1, 100), Fraction(math.ceil(2000 / lower), 100)))


def _by_channel(
    system: MultiChannelSystem, reference: Sequence[Fraction] | None
) -> list[list[Fraction]] | None:
    """Split set-points by channels."""
    if reference is None:
        return None
    total = sum(system.q(i) for i in range(system.m))
    if len(reference) != total:
        raise InputError(f"expected {total} numbers, found {len(reference)}", where="reference")
    rest, result = list(reference), []
    for i in range(system.m):
        result.append(rest[: system.q(i)])
        rest = rest[system.q(i) :]
    return result
