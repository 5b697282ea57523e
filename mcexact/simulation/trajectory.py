"""`simulate` runs a controller as a network of agents and returns the trajectory."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.errors import InputError, UsageError
from mcexact.exact.location import is_discrete
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import as_fraction
from mcexact.model.controller import Controller
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_links
from mcexact.simulation.arithmetic import Native, arithmetic_named
from mcexact.simulation.continuous import integrated, taylor
from mcexact.simulation.network import Network, Snapshot
from mcexact.simulation.precision import double_precision_warning


@dataclass(frozen=True)
class InitialState:
    """The state in which a simulation starts.

    Attributes
    ----------
    plant : tuple of Fraction
        x(0).
    shared, private : tuple of tuples of Fraction
        x_i(0) and z_i(0) of each agent.
    """

    plant: tuple[Fraction, ...]
    shared: tuple[tuple[Fraction, ...], ...]
    private: tuple[tuple[Fraction, ...], ...]


@dataclass(frozen=True)
class Trajectory:
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
    """

    time: str
    arithmetic: str
    agents: tuple[str, ...]
    times: tuple[Fraction, ...]
    snapshots: tuple[Snapshot, ...]
    warning: str | None = None

    def __repr__(self) -> str:
        start, end = self.times[0], self.times[-1]
        return (
            f"Trajectory({len(self.agents)} agents, {len(self.times)} times from {start} to {end}, "
            f"{self.time} time, {self.arithmetic})"
        )

    def has_estimates(self) -> bool:
        """Whether each agent's shared sub-state has the dimension of the plant's state."""
        first = self.snapshots[0]
        return all(len(x_i) == len(first.plant) for x_i in first.shared)

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


def simulate(
    system: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None = None,
    *,
    initial: InitialState | None = None,
    horizon: Any = None,
    points: int = 200,
    reference: Sequence[Sequence[Any]] | None = None,
    arithmetic: str | None = None,
    digits: int = 60,
) -> Trajectory:
    """Run a controller as a network of agents that exchange messages, with their delays.

    Parameters
    ----------
    system : MultiChannelSystem
        The plant.
    controller : Controller
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    initial : InitialState, optional
        By default every entry of x(0) is 1, and the agents start at 0.
    horizon : int or rational, optional
        Steps in discrete time (40 by default), the final time in continuous time (10 by default).
    points : int
        The number of equal intervals into which the horizon is divided, in continuous time.
    reference : sequence of sequences, optional
        The set-points r_i, one number for each output of each channel; 0 by default.
    arithmetic : {"exact", "multiprecision", "float"}, optional
        By default exact in discrete time, and in continuous time float, which is an adaptive
        Runge–Kutta method of order 8 from scipy.  Continuous time also has multiprecision, which
        sums Taylor series of the linear equations.
    digits : int
        The number of decimal digits in multiple precision.

    Raises
    ------
    SignalNotReceived
        If a program uses a signal that its agent does not receive.
    UsageError
        If the time domain does not have this arithmetic, or the horizon is not as expected.

    Examples
    --------
    >>> from mcexact.model.controller import AgentProgram, LinearMap
    >>> plant = MultiChannelSystem([[2]], [[[1]]], [[[1]]], time="discrete")
    >>> agent = AgentProgram("1", 0, 0, input=LinearMap({0: Matrix.from_rows([["-3/2"]])}))
    >>> run = simulate(plant, Controller("discrete", "", (agent,)), horizon=2)
    >>> [snapshot.plant for snapshot in run.snapshots]
    [[Fraction(1, 1)], [Fraction(1, 2)], [Fraction(1, 4)]]
    """
    system, found = with_links(system, graph)
    discrete = is_discrete(system.time)
    numbers = arithmetic_named(arithmetic or ("exact" if discrete else "float"), digits)
    network = Network(system, controller, found, numbers)
    start = default_initial(system, controller) if initial is None else initial
    _set_initial(network, start, system, controller)
    _set_reference(network, reference, system)
    if discrete:
        times, snapshots = _stepped(network, _steps(horizon))
    else:
        end = Fraction(10) if horizon is None else as_fraction(horizon, where="horizon")
        if end <= 0 or points < 1:
            raise UsageError("expected a horizon above 0 and at least one interval")
        times = [end * k / points for k in range(points + 1)]
        if found.delays:
            raise UsageError("delays are for discrete time; remove them from the graph")
        if numbers.name == "exact":
            raise UsageError("in continuous time the solution is not rational; use multiprecision")
        if numbers.name == "float":
            snapshots = integrated(network, times)
        else:
            snapshots = taylor(network, times, digits)
    warning = None
    if numbers.name == "float":
        warning = double_precision_warning(system, controller, found)
    return Trajectory(
        system.time, numbers.name, system.names, tuple(times), tuple(snapshots), warning
    )


def default_initial(system: MultiChannelSystem, controller: Controller) -> InitialState:
    """Return the initial state in which x(0) = (1, …, 1) and all agents are at 0."""
    zero, one = Fraction(0), Fraction(1)
    return InitialState(
        (one,) * system.n,
        tuple((zero,) * agent.shared for agent in controller.agents),
        tuple((zero,) * agent.private for agent in controller.agents),
    )


def _steps(horizon: Any) -> int:
    """The number of steps that a horizon gives in discrete time."""
    steps = 40 if horizon is None else as_fraction(horizon, where="horizon")
    if steps != int(steps) or steps < 0:
        raise UsageError(f"expected a number of steps, found {steps}", where="horizon")
    return int(steps)


def _set_initial(
    network: Network, start: InitialState, system: MultiChannelSystem, controller: Controller
) -> None:
    """Check the sizes of an initial state, convert it and set it."""
    if not len(start.shared) == len(start.private) == system.m:
        raise InputError(
            f"expected shared and private states of {system.m} agents, "
            f"found {len(start.shared)} and {len(start.private)}",
            where="initial",
        )
    expected = [
        (system.n, start.plant, "x"),
        *(
            (size, values, f"agent {agent.name!r}")
            for agent, x_i, z_i in zip(controller.agents, start.shared, start.private, strict=True)
            for size, values in ((agent.shared, x_i), (agent.private, z_i))
        ),
    ]
    for size, values, where in expected:
        if len(values) != size:
            raise InputError(f"expected {size} numbers, found {len(values)}", where=where)

    def column(values: Sequence[Fraction]) -> Native:
        return network.arithmetic.convert(Matrix.column(values))

    parts = [
        (column(x_i), column(z_i)) for x_i, z_i in zip(start.shared, start.private, strict=True)
    ]
    network.set_state(column(start.plant), parts)


def _set_reference(
    network: Network, reference: Sequence[Sequence[Any]] | None, system: MultiChannelSystem
) -> None:
    """Give every agent its own set-point."""
    if reference is None:
        return
    if len(reference) != system.m:
        raise InputError(f"expected {system.m} set-points, found {len(reference)}")
    for i, (agent, values) in enumerate(zip(network.agents, reference, strict=True)):
        if len(values) != system.q(i):
            raise InputError(
                f"expected {system.q(i)} numbers, found {len(values)}", where=f"reference[{i}]"
            )
        agent.reference = network.arithmetic.convert(Matrix.column(values))


def _stepped(network: Network, steps: int) -> tuple[list[Fraction], list[Snapshot]]:
    """Run a number of steps in discrete time."""
    snapshots = [network.snapshot()]
    for _ in range(steps):
        network.step()
        snapshots.append(network.snapshot())
    return [Fraction(k) for k in range(steps + 1)], snapshots
