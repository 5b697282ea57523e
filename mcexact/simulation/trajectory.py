"""`simulate` runs a controller as a network of agents and returns the trajectory."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import chain
from typing import Any

from mcexact.arguments import told
from mcexact.errors import InputError, UsageError
from mcexact.exact.matrix import Rounding, to_float
from mcexact.exact.rational import number
from mcexact.exact.roots import is_discrete
from mcexact.model.controller import Controller
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.system import MultiChannelSystem, with_links
from mcexact.plot.responses import responses
from mcexact.shown import Shown
from mcexact.simulation.arithmetic import arithmetic_named, representable
from mcexact.simulation.continuous import integrated, taylor
from mcexact.simulation.horizon import Grid, chosen_grid
from mcexact.simulation.network import Network, Snapshot
from mcexact.simulation.precision import double_precision_warning
from mcexact.simulation.signals import Drive, numbers_of, signal_of
from mcexact.simulation.start import InitialState, initial_state, set_initial

SIGNALS = {"outputs": "y", "inputs": "u", "reference": "r"}
"""The letters of the signals of all agents, keyed by their names in a `Snapshot`."""


@dataclass(frozen=True, repr=False)
class Trajectory(Shown):
    """The trajectory of a plant and its agents.

    Attributes
    ----------
    time : {"continuous", "discrete"}
    arithmetic : str
    agents : tuple of str
    times : tuple of Fraction
    snapshots : tuple of Snapshot
        One for each time.
    warning : str or None
        A warning if the closed loop has entries too large for double precision, where that was
        used.
    note : str or None
        What the times do not show.
    loop : ClosedLoop
        The plant, the controller and the links.
    drive : Drive
        The set-points and disturbances.
    start : InitialState
    """

    time: str
    arithmetic: str
    agents: tuple[str, ...]
    times: tuple[Fraction, ...]
    snapshots: tuple[Snapshot, ...]
    warning: str | None
    note: str | None
    loop: ClosedLoop = field(compare=False)
    drive: Drive = field(compare=False)
    start: InitialState = field(compare=False)

    def __repr__(self) -> str:
        start, end = self.times[0], self.times[-1]
        return (
            f"Trajectory({len(self.agents)} agents, {len(self.times)} times from {start} to {end}, "
            f"{self.time} time, {self.arithmetic})"
        )

    def explain(self) -> str:
        """Say in plain words what was run, and where it ended."""
        start, end = self.times[0], self.times[-1]
        unit = "step" if is_discrete(self.time) else "time"
        told = [
            f"{len(self.agents)} agents ran from {unit} {start} to {end} in {self.arithmetic} "
            "arithmetic.",
            *(f"At the end {name} = {value}." for name, value in self.to_rows()[-1].items()),
        ]
        return "\n".join([*told, *filter(None, (self.warning, self.note))])

    def _labeled(self) -> Iterator[tuple[str, str]]:
        """Yield the signals, each at the first and at the last time."""
        first, last = self.to_rows()[0], self.to_rows()[-1]
        for name, value in first.items():
            yield name, f"{_short(value)} → {_short(last[name])}"

    def to_rows(self) -> list[dict[str, Any]]:
        """Return a flat row for each time: t, the state x of the plant, and y, u and r of agents.

        The names are those of the columns of ``mcexact simulate -o FILE.csv``.  Numbers are those
        of the arithmetic: Fractions in exact runs.
        """
        kinds = {kind: self.names(kind) for kind in SIGNALS}
        rows = []
        for time, at in zip(self.times, self.snapshots, strict=True):
            row = {"t": time, **{f"x[{k + 1}]": value for k, value in enumerate(at.plant)}}
            for kind, names in kinds.items():
                row |= zip(names, chain(*getattr(at, kind)), strict=True)
            rows.append(row)
        return rows

    def to_dict(self) -> dict[str, list[Any]]:
        """Return the signals by name, each as a list of its numbers at all times."""
        rows = self.to_rows()
        return {name: [row[name] for row in rows] for name in rows[0]}

    def has_estimates(self) -> bool:
        """Whether each agent's shared sub-state has the dimension of the plant's state."""
        first = self.snapshots[0]
        return all(len(x_i) == len(first.plant) for x_i in first.shared)

    def names(self, kind: str) -> list[str]:
        """Return the names of all entries of a signal, such as "y pump" or "u 2[1]".

        Parameters
        ----------
        kind : {"outputs", "inputs", "reference"}
        """
        letter, first = SIGNALS[kind], getattr(self.snapshots[0], kind)
        return [
            f"{letter} {name}" if len(values) == 1 else f"{letter} {name}[{k + 1}]"
            for name, values in zip(self.agents, first, strict=True)
            for k in range(len(values))
        ]

    def values(self, kind: str) -> dict[str, list[float]]:
        """Return all entries of a signal at all times as floats, keyed by their names.

        Parameters
        ----------
        kind : {"outputs", "inputs", "reference"}
        """
        rows = [list(map(as_float, chain(*getattr(each, kind)))) for each in self.snapshots]
        columns = zip(*rows, strict=True)
        return dict(zip(self.names(kind), map(list, columns), strict=True))

    def state_norms(self, rest: Sequence[float] | None = None) -> list[float]:
        """Return the largest absolute value of an entry of x, or of x minus a state, at every time.

        Parameters
        ----------
        rest : sequence of float, optional
        """
        if rest is None or not any(rest):
            return [_largest(snapshot.plant) for snapshot in self.snapshots]
        return [
            max(abs(as_float(x) - r) for x, r in zip(snapshot.plant, rest, strict=True))
            for snapshot in self.snapshots
        ]

    def error_norms(self) -> dict[str, list[float]]:
        """Return the largest absolute entry of e_i = x_i − x for every agent with an estimate.

        The result is empty if the agents share no estimates of the plant's state.
        """
        if not self.has_estimates():
            return {}
        rows = [[_largest(e) for e in self.errors(k)] for k in range(len(self.times))]
        return {name: [row[i] for row in rows] for i, name in enumerate(self.agents)}

    def plot(self, ax: Any = None, *, envelope: Any = None) -> Any:
        """Draw the outputs with their set-points, and the inputs; see `mcexact.plot.responses`.

        Parameters
        ----------
        ax : two axes of matplotlib, optional
        envelope : Envelope, optional
            Proved bounds, from `proved_envelope`.

        Returns
        -------
        matplotlib.figure.Figure
        """
        return responses(self, ax, envelope=envelope)

    def errors(self, k: int) -> list[list[Any]]:
        """The errors e_i = x_i − x at the k-th time, where agents share state estimates.

        Parameters
        ----------
        k : int
            A position in ``times``.

        Returns
        -------
        list of list
            e_i, n native numbers, for each agent.
        """
        snapshot = self.snapshots[k]
        return [
            [a - b for a, b in zip(x_i, snapshot.plant, strict=True)] for x_i in snapshot.shared
        ]


def as_float(value: Any) -> float:
    """A native number as the nearest float; infinity beyond floats."""
    return to_float(value) if isinstance(value, (int, Fraction)) else float(value)


def _largest(values: list[Any]) -> float:
    """Return the largest absolute value as a float: infinity beyond floats, 0 without entries."""
    return as_float(max((abs(value) for value in values), default=0))


def _short(value: Any) -> str:
    return number(value) if isinstance(value, Fraction) else f"{as_float(value):.6g}"


def simulate(
    system: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None = None,
    *,
    initial: InitialState | Sequence[Any] | None = None,
    horizon: Any = None,
    points: int | None = None,
    reference: Sequence[Any] | None = None,
    steps: Sequence[tuple[Any, Sequence[Any]]] = (),
    ramps: Sequence[tuple[Any, Sequence[Any]]] = (),
    disturbances: Sequence[tuple[Any, Sequence[Any]]] = (),
    arithmetic: str | None = None,
    digits: int = 60,
    rounding: Rounding | None = None,
) -> Trajectory:
    """Run a controller as a network of agents that exchange messages, with their delays.

    Parameters
    ----------
    system : MultiChannelSystem
        The plant.
    controller : Controller
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    initial : sequence of numbers or InitialState, optional
        x(0), or the states of the agents as well, which start at 0 otherwise.  By default every
        entry of x(0) is 1.
    horizon : int or rational, optional
        Steps in discrete time, the final time in continuous time.  By default chosen from the
        slowest mode of the loop; see `chosen_grid`.
    points : int, optional
        The number of equal intervals into which the horizon is divided, in continuous time.  By
        default chosen from the fastest mode.
    reference : sequence, optional
        The set-points r_i from the start on: one sequence of numbers for each channel, or all
        numbers in the order of the channels; 0 by default.
    steps, ramps : sequences of (time, numbers), optional
        What is added to the set-points from a time on: the numbers, or the numbers times the time
        that has passed since.
    disturbances : sequence of (time, numbers), optional
        What is added at the plant to the inputs of all channels from a time on.
    arithmetic : {"exact", "multiprecision", "float"}, optional
        By default exact in discrete time, and in continuous time float, which is an adaptive
        Runge–Kutta method of order 8 from scipy (an implicit one of order 5, if fast modes need
        it).  Continuous time also has multiprecision, which sums Taylor series of the linear
        equations.
    digits : int
        The number of decimal digits in multiple precision.
    rounding : {"decimal", "dyadic"}, optional
        How floats among the numbers become exact, as in `MultiChannelSystem.from_float`.  By
        default "dyadic" in the arithmetic float, which changes no float; otherwise floats are
        refused.

    Raises
    ------
    SignalNotReceived
        If a program uses a signal that its agent does not receive.
    FloatRefused
        If a number is a float in a run that is not in floating point, and no rounding is given.
    UsageError
        If the time domain does not have this arithmetic, or the horizon is not as expected.

    Examples
    --------
    >>> from mcexact import AgentProgram, Controller, LinearMap, Matrix, MultiChannelSystem
    >>> plant = MultiChannelSystem([[2]], [[[1]]], [[[1]]], time="discrete")
    >>> agent = AgentProgram("1", 0, 0, input=LinearMap({0: Matrix.from_rows([["-3/2"]])}))
    >>> run = simulate(plant, Controller("discrete", "", (agent,)), horizon=2)
    >>> [snapshot.plant for snapshot in run.snapshots]
    [[Fraction(1, 1)], [Fraction(1, 2)], [Fraction(1, 4)]]
    >>> [snapshot.inputs for snapshot in run.snapshots]
    [[[Fraction(-3, 2)]], [[Fraction(-3, 4)]], [[Fraction(-3, 8)]]]
    """
    InputError.require(system, MultiChannelSystem, "system")
    InputError.require(controller, Controller, "controller")
    given = system
    system, found = with_links(system, graph)
    discrete = is_discrete(system.time)
    numbers = arithmetic_named(arithmetic or ("exact" if discrete else "float"), digits)
    if rounding is None and numbers.name == "float":
        rounding = "dyadic"
    network = Network(system, controller, found, numbers)
    if found.delays and not discrete:
        raise UsageError("delays are for discrete time; remove them from the graph")
    if not discrete and numbers.name == "exact":
        raise UsageError("in continuous time the solution is not rational; use multiprecision")
    # A round at rest changes nothing, and shows whether an agent uses a signal that it lacks.
    network.evolution()
    start = initial_state(initial, system, controller, rounding)
    set_initial(network, start, system, controller)
    outputs = [system.q(i) for i in range(system.m)]
    inputs = [system.p(i) for i in range(system.m)]
    drive = Drive(
        signal_of(outputs, reference, steps, ramps, rounding, ("reference", "steps", "ramps")),
        signal_of(inputs, None, disturbances, (), rounding, ("", "disturbances", "")),
    )
    loop = closed_loop(given, controller, graph)
    grid = _grid(loop, drive, horizon, points, rounding)
    if discrete:
        snapshots = _stepped(network, grid.times, drive)
    elif numbers.name == "float":
        snapshots = integrated(network, grid.times, drive, grid.fastest)
    else:
        snapshots = taylor(network, grid.times, drive, digits)
    warning = None
    if numbers.name == "float":
        warning = double_precision_warning(loop)
    return Trajectory(
        system.time,
        numbers.name,
        system.names,
        grid.times,
        tuple(snapshots),
        warning,
        grid.note,
        loop,
        drive,
        start,
    )


def _grid(
    loop: ClosedLoop, drive: Drive, horizon: Any, points: int | None, rounding: Rounding | None
) -> Grid:
    """The times of a run, and the fastest mode."""
    discrete = is_discrete(loop.given.time)
    end = None
    if horizon is not None:
        [end] = numbers_of([horizon], rounding, "horizon")
    if discrete and end is not None and (end != int(end) or end < 0):
        raise UsageError(f"expected a number of steps, found {end}", where="horizon")
    if points is not None and (isinstance(points, bool) or not isinstance(points, int)):
        raise InputError(f"expected an integer, found {told(points)}", where="points")
    if not discrete and ((end is not None and end <= 0) or (points is not None and points < 1)):
        raise UsageError("expected a horizon above 0 and at least one interval")
    last = max((change.time for change in drive.changes), default=Fraction(0))
    return chosen_grid(loop, last, end, points)


def _stepped(network: Network, times: Sequence[Fraction], drive: Drive) -> list[Snapshot]:
    """Run the steps of discrete time.

    Raises
    ------
    LimitReached
        If a number exceeds the range of double precision, where that is used.
    """
    import numpy as np

    snapshots = []
    for time in times:
        drive.apply(network, time)
        with np.errstate(over="ignore", invalid="ignore"):
            snapshot, state, parts = network.round()
        if network.arithmetic.name == "float":
            representable(network.state)
        snapshots.append(snapshot)
        network.set_state(state, parts)
    return snapshots
