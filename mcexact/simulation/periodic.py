"""Periodic controllers run as agents, each of which counts the steps modulo the period.

`simulate_periodic` has a network of agents for each phase (`mcexact.simulation.network`), which
hand on the states from one step to the next: agent i computes z_i(t+1) and u_i(t) from y_i(t) and
z_i(t) by its program of this step.  No matrix of the loop is used but for the default horizon.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import ceil, isfinite, log
from typing import Any

import numpy as np

from mcexact.errors import InputError, UsageError
from mcexact.exact.matrix import Rounding, matrix_to_float
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import ClosedLoop
from mcexact.model.periodic import PeriodicController, periodic_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.simulation.network import (
    Drive,
    InitialState,
    Network,
    Snapshot,
    arithmetic_named,
    initial_state,
    numbers_of,
    representable,
    set_initial,
    signal_of,
)
from mcexact.simulation.trajectory import Trajectory

_SMALL = 1e-3
"""The default horizon ends where the slowest mode has become so small."""
_PERIODS = 5, 100
"""The least and the largest number of periods of a default horizon."""


def simulate_periodic(
    system: MultiChannelSystem,
    controller: PeriodicController,
    *,
    initial: InitialState | Sequence[Any] | None = None,
    horizon: Any = None,
    disturbances: Sequence[tuple[Any, Sequence[Any]]] = (),
    arithmetic: str | None = None,
    digits: int = 60,
    rounding: Rounding | None = None,
) -> Trajectory:
    """Run a periodic controller as agents that use their own outputs.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant in discrete time.
    controller : PeriodicController
        Whose period begins at t = 0.
    initial : sequence of numbers or InitialState, optional
        x(0), or the states of the agents as well, which start at 0 otherwise.  By default every
        entry of x(0) is 1.
    horizon : int, optional
        The number of steps, by default chosen from the slowest mode of a period.
    disturbances : sequence of (time, numbers), optional
        What is added at the plant to the inputs of all channels from a time on.
    arithmetic : {"exact", "multiprecision", "float"}, optional
        By default exact.
    digits : int
        The number of decimal digits in multiple precision.
    rounding : {"decimal", "dyadic", "simplest"}, optional
        How floats among the numbers become exact; by default "dyadic" in the arithmetic float, and
        otherwise floats are refused.

    Returns
    -------
    Trajectory
        Its ``loop`` is that of the first phase.

    Raises
    ------
    InputError, UsageError
        If the controller does not fit the plant, or a number is not as expected.
    LimitReached
        If a number exceeds the range of double precision, where that is used.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = MultiChannelSystem([[2]], [[[1]]], [[[1]]], time="discrete")
    >>> phases = [local_controllers(plant, [[[gain]]]) for gain in ("-7/4", 0)]
    >>> run = simulate_periodic(plant, PeriodicController(tuple(phases)), horizon=4)
    >>> [str(snapshot.plant[0]) for snapshot in run.snapshots]
    ['1', '1/4', '1/2', '1/8', '1/4']
    """
    InputError.require(system, MultiChannelSystem, "system")
    InputError.require(controller, PeriodicController, "controller")
    M = periodic_loop(system, controller).A  # what does not fit is refused here
    numbers = arithmetic_named(arithmetic or "exact", digits)
    if rounding is None and numbers.name == "float":
        rounding = "dyadic"
    alone = NeighborGraph.empty(system.names)
    first = controller.phases[0]
    networks = [Network(system, phase, alone, numbers) for phase in controller.phases]
    start = initial_state(initial, system, first, rounding)
    set_initial(networks[0], start, system, first)
    inputs, outputs = ([size(i) for i in range(system.m)] for size in (system.p, system.q))
    drive = Drive(
        signal_of(outputs, None, (), (), rounding, ("", "", "")),
        signal_of(inputs, None, disturbances, (), rounding, ("", "disturbances", "")),
    )
    last = max((change.time for change in drive.changes), default=Fraction(0))
    steps = ceil(last) + _default_horizon(matrix_to_float(M), controller.period)
    if horizon is not None:
        [end] = numbers_of([horizon], rounding, "horizon")
        if end != int(end) or end < 0:
            raise UsageError(f"expected a number of steps, found {end}", where="horizon")
        steps = int(end)
    times = tuple(map(Fraction, range(steps + 1)))
    return Trajectory(
        system.time,
        numbers.name,
        system.names,
        times,
        tuple(_stepped(networks, times, drive)),
        None,
        f"the programs of the agents repeat after {controller.period} steps",
        ClosedLoop(system, first, alone),
        drive,
        start,
    )


def _default_horizon(M: Any, period: int) -> int:
    """So many steps that the slowest mode becomes small or, where it grows, large."""
    least, most = _PERIODS
    radius = float(abs(np.linalg.eigvals(M)).max(initial=0.0)) if np.isfinite(M).all() else 0.0
    change = abs(log(radius)) if radius > 0 else 0.0
    periods = -log(_SMALL) / change if change and isfinite(change) else least
    return period * min(max(ceil(periods), least), most)


def _stepped(
    networks: Sequence[Network], times: Sequence[Fraction], drive: Drive
) -> list[Snapshot]:
    """Run the steps, each by the agents of its phase."""
    snapshots: list[Snapshot] = []
    state, parts = networks[0].state, [(a.shared, a.private) for a in networks[0].agents]
    for t, time in enumerate(times):
        network = networks[t % len(networks)]
        network.set_state(state, parts)
        drive.apply(network, time)
        with np.errstate(over="ignore", invalid="ignore"):
            snapshot, state, parts = network.round()
        if network.arithmetic.name == "float":
            representable(network.state)
        snapshots.append(snapshot)
    return snapshots
