"""A simulation together with what is proved about its loop, which the simulation does not use."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from mcexact.analysis.stability.closed_loop_spectrum import closed_loop_spectrum
from mcexact.answer.loop_spectrum import LoopSpectrum
from mcexact.model.controller import Controller
from mcexact.model.system import MultiChannelSystem
from mcexact.simulation.envelope import LARGEST, Envelope, proved_envelope
from mcexact.simulation.trajectory import Trajectory, simulate


@dataclass(frozen=True)
class SimulatedLoop:
    """A simulation, with the spectrum of the closed loop if it was computed.

    Attributes
    ----------
    title : str
    run : Trajectory
    spectrum : LoopSpectrum or None
    envelope : Envelope or None
        Proved bounds on the trajectory.
    warnings : tuple of str
    """

    title: str
    run: Trajectory
    spectrum: LoopSpectrum | None
    envelope: Envelope | None
    warnings: tuple[str, ...]


def simulated_loop(
    system: MultiChannelSystem, controller: Controller, **options: Any
) -> SimulatedLoop:
    """Simulate a controller, and compute the spectrum of its loop, proved bounds and warnings.

    Parameters
    ----------
    system : MultiChannelSystem
    controller : Controller
    **options
        As in `simulate`.
    """
    run = simulate(system, controller, **options)
    spectrum = None
    if run.loop.dimension <= LARGEST:
        spectrum = closed_loop_spectrum(run.loop.matrix, system.time)
    return SimulatedLoop(
        system.name or "simulation",
        run,
        spectrum,
        proved_envelope(run, spectrum),
        controller.warnings_for(system) + (() if run.warning is None else (run.warning,)),
    )
