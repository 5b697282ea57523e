"""Drawn graphs, and large sparse plants as engineers have them.

`drawn_graph` draws a neighbor graph, strongly connected or not.  `network_system` draws a plant of
one of the kinds below.  Its matrix A has a handful of entries in each row, whatever its size, and
its agents act and measure at some of the places.  Its fixed modes are not known by construction.

=================  =================================================================================
``swing-grid``     swing equations on a mesh of transmission lines
``swing-hubs``     swing equations on a network in which a few buses have many lines
``swing-speed``    the same as ``swing-grid``, where agents measure frequencies alone
``platoon``        vehicles in a row, which measure the gap to the one before and their speeds
``consensus``      nodes that average with their neighbors on a mesh; some are led by agents
``building``       rooms with walls on floors, heated by air handling units
=================  =================================================================================

References
----------
.. [1] P. Kundur, Power System Stability and Control, McGraw-Hill 1994, section 3.9: M θ″ + D θ′ =
   P − Σ b_ij (θ_i − θ_j), linearized.
.. [2] A.-L. Barabási and R. Albert, Emergence of scaling in random networks, Science 286 (1999),
   509–512: a new bus is joined to buses drawn in proportion to their lines.
.. [3] S. S. Stanković, M. J. Stanojević and D. D. Šiljak, Decentralized overlapping control of a
   platoon of vehicles, IEEE Transactions on Control Systems Technology 8 (2000), 816–832.
.. [4] R. Olfati-Saber, J. A. Fax and R. M. Murray, Consensus and cooperation in networked
   multi-agent systems, Proceedings of the IEEE 95 (2007), 215–233: x′ = −L x.
.. [5] S. Goyal and P. Barooah, A method for model-reduction of non-linear thermal dynamics of
   multi-zone buildings, Energy and Buildings 47 (2012), 332–340: resistances and capacities.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise
from math import isqrt
from types import MappingProxyType

from mcexact.derived.drawn.primary_form import Choices, shuffled
from mcexact.errors import UsageError
from mcexact.exact.matrix import Matrix
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem

# Drawn neighbor graphs.


def drawn_graph(
    choices: Choices,
    names: Sequence[str],
    strongly_connected: bool | None = None,
    longest_delay: int = 0,
) -> NeighborGraph:
    """Draw a neighbor graph.

    Parameters
    ----------
    choices : Choices
    names : sequence of str
        The agents.
    strongly_connected : bool, optional
        True draws an ear decomposition, which every such graph has.  False draws a graph with a set
        of agents that receive no messages from outside the set.  None draws any graph.
    longest_delay : int
        Every edge has a delay from 0 to this.

    Raises
    ------
    UsageError
        If a graph on one agent is not to be strongly connected.

    Examples
    --------
    >>> from mcexact.derived.drawn.primary_form import SeededChoices
    >>> drawn_graph(SeededChoices(5), ("1", "2", "3"), True).is_strongly_connected()
    True
    >>> drawn_graph(SeededChoices(5), ("1", "2", "3"), False).is_strongly_connected()
    False
    """
    m = len(names)
    heard: list[set[int]] = [{i} for i in range(m)]
    deaf: set[int] = set()
    if strongly_connected:
        _ears(choices, heard)
    elif strongly_connected is not None:
        if m < 2:
            raise UsageError("a graph on one agent is strongly connected")
        order = shuffled(choices, range(m))
        deaf = set(order[: choices.integer(1, m - 1)])
    for i in range(m):
        for j in range(m):
            outside = i in deaf and j not in deaf
            if i != j and not outside and choices.integer(0, 2) == 2:
                heard[i].add(j)
    delays = [
        (i, j, choices.integer(0, longest_delay))
        for i in range(m)
        for j in sorted(heard[i])
        if i != j and longest_delay
    ]
    return NeighborGraph(names, heard, delays)


def _ears(choices: Choices, heard: list[set[int]]) -> None:
    """Add paths through unconnected agents that begin and end at connected ones."""
    order = shuffled(choices, range(len(heard)))
    connected, rest = order[:1], order[1:]
    while rest:
        length = choices.integer(1, len(rest))
        ear, rest = rest[:length], rest[length:]
        path = [choices.option(connected), *ear, choices.option(connected)]
        for sender, receiver in itertools.pairwise(path):
            heard[receiver].add(sender)
        connected += ear


# Large sparse plants: power grids, platoons, consensus, and buildings.

Entries = dict[tuple[int, int], Fraction]
Lines = list[tuple[int, int]]


@dataclass
class _Plant:
    """The entries of A, and for each agent those of its inputs and outputs, as they are drawn."""

    n: int
    A: Entries = field(default_factory=dict)
    channels: list[tuple[list[Entries], list[Entries]]] = field(default_factory=list)

    def add(self, i: int, j: int, value: Fraction | int) -> None:
        """Add to an entry of A."""
        self.A[i, j] = self.A.get((i, j), Fraction(0)) + value

    def join(self, i: int, j: int, value: Fraction) -> None:
        """Let state i approach state j at a rate."""
        self.add(i, j, value)
        self.add(i, i, -value)

    def agent(self, inputs: list[dict[int, Fraction]], outputs: list[dict[int, Fraction]]) -> None:
        """Append an agent, with the entries of each input and output by states."""
        columns = [{(i, 0): value for i, value in each.items()} for each in inputs]
        rows = [{(0, j): value for j, value in each.items()} for each in outputs]
        self.channels.append((columns, rows))

    def system(self, name: str, source: str) -> MultiChannelSystem:
        """The system, with sparse matrices."""
        B, C = [], []
        for columns, rows in self.channels:
            inputs = [(i, k, v) for k, part in enumerate(columns) for (i, _), v in part.items()]
            outputs = [(k, j, v) for k, part in enumerate(rows) for (_, j), v in part.items()]
            B.append(Matrix.from_entries((self.n, len(columns)), inputs))
            C.append(Matrix.from_entries((len(rows), self.n), outputs))
        cells = [(i, j, value) for (i, j), value in self.A.items() if value]
        A = Matrix.from_entries((self.n, self.n), cells)
        return MultiChannelSystem(A, B, C, name=name, source=source)


def network_system(
    choices: Choices, network: str, states: int, channels: int
) -> MultiChannelSystem:
    """Draw a plant of a kind of network, in continuous time.

    Parameters
    ----------
    choices : Choices
        Where agents act, and the numbers: inertias, lines, resistances.
    network : str
        A key of ``NETWORKS``.
    states : int
        n, at least 2; for a platoon a multiple of 3, for grids and buildings of 2.
    channels : int
        m, at most the number of buses, vehicles, nodes or rooms.

    Raises
    ------
    UsageError
        If there is no such network, or not of this size.

    Examples
    --------
    >>> from mcexact.derived.drawn.primary_form import SeededChoices
    >>> plant = network_system(SeededChoices(0), "swing-grid", states=4000, channels=200)
    >>> plant.n, plant.m, plant.A.is_sparse
    (4000, 200, True)
    """
    if network not in NETWORKS:
        raise UsageError(f"expected a network out of {', '.join(NETWORKS)}, found {network!r}")
    kind = NETWORKS[network]
    places, rest = divmod(states, kind.states)
    if rest or places < 2:
        unit = f"a multiple of {kind.states}, " if kind.states > 1 else ""
        raise UsageError(f"expected {unit}at least {2 * kind.states} states, found {states}")
    if not 1 <= channels <= places:
        raise UsageError(f"expected 1 to {places} channels for {states} states, found {channels}")
    plant = _Plant(states)
    kind.lay(choices, plant, places, _chosen(choices, places, channels))
    name = f"{network}, {states} states, {channels} channels"
    return plant.system(name, f"drawn numbers in the equations of {kind.source}")


def _chosen(choices: Choices, places: int, channels: int) -> list[int]:
    """One place for each agent, in order: one out of each of as many equal parts."""
    bounds = [k * places // channels for k in range(channels + 1)]
    return [choices.integer(a, b - 1) for a, b in pairwise(bounds)]


def _mesh(places: int) -> Iterator[tuple[int, int]]:
    """The lines of a rectangle of places with about as many rows as columns."""
    width = isqrt(places - 1) + 1
    for i in range(places):
        if (i + 1) % width and i + 1 < places:
            yield i, i + 1
        if i + width < places:
            yield i, i + width


def _hubs(choices: Choices, places: int) -> Iterator[tuple[int, int]]:
    """The lines of a network in which each place is joined to two earlier ones, often to hubs."""
    ends = [0, 1]
    yield 0, 1
    for i in range(2, places):
        first = choices.option(ends)
        second = choices.option(ends)
        for j in {first, second}:
            yield j, i
            ends += [j, i]


def _swing(
    choices: Choices, plant: _Plant, lines: Iterator[tuple[int, int]], buses: int
) -> list[Fraction]:
    """Add the states θ_i, ω_i of each bus, and return the inverse inertias."""
    inverse = [Fraction(1, choices.option((2, 4, 5, 8, 10))) for _ in range(buses)]
    for i, per_mass in enumerate(inverse):
        plant.add(2 * i, 2 * i + 1, 1)
        plant.add(2 * i + 1, 2 * i + 1, -choices.integer(1, 9) * per_mass / 10)
    for i, j in lines:
        strength = choices.integer(5, 40)
        for a, b in ((i, j), (j, i)):
            plant.add(2 * a + 1, 2 * b, strength * inverse[a])
            plant.add(2 * a + 1, 2 * a, -strength * inverse[a])
    return inverse


def _swing_on(
    lines: Callable[[Choices, int], Iterator[tuple[int, int]]], angles: bool
) -> Callable[[Choices, _Plant, int, list[int]], None]:
    """Agents with the power of a bus, who measure its angle and frequency, or the latter alone."""

    def lay(choices: Choices, plant: _Plant, buses: int, chosen: list[int]) -> None:
        inverse = _swing(choices, plant, lines(choices, buses), buses)
        one = Fraction(1)
        for i in chosen:
            seen = [{2 * i: one}, {2 * i + 1: one}]
            plant.agent([{2 * i + 1: inverse[i]}], seen if angles else seen[1:])

    return lay


def _platoon(choices: Choices, plant: _Plant, vehicles: int, chosen: list[int]) -> None:
    """The gap, the speed and the drive of each vehicle; an agent drives its own until the next."""
    one = Fraction(1)
    rates = [Fraction(choices.integer(5, 40), 10) for _ in range(vehicles)]
    for i, rate in enumerate(rates):
        plant.add(3 * i, 3 * i + 1, -1)
        if i:
            plant.add(3 * i, 3 * i - 2, 1)
        plant.add(3 * i + 1, 3 * i + 2, 1)
        plant.add(3 * i + 2, 3 * i + 2, -rate)
    bounds = [0, *chosen[1:], vehicles]
    for first, end in pairwise(bounds):
        own = range(first, end)
        inputs = [{3 * i + 2: rates[i]} for i in own]
        plant.agent(inputs, [{3 * i + k: one} for i in own for k in (0, 1)])


def _consensus(choices: Choices, plant: _Plant, nodes: int, chosen: list[int]) -> None:
    """x′ = −L x with drawn weights; an agent pushes one node and sees it."""
    for i, j in _mesh(nodes):
        weight = Fraction(choices.integer(1, 9))
        plant.join(i, j, weight)
        plant.join(j, i, weight)
    one = Fraction(1)
    for i in chosen:
        plant.agent([{i: one}], [{i: one}])


def _building(choices: Choices, plant: _Plant, rooms: int, chosen: list[int]) -> None:
    """The air and the walls of each room; a unit heats rooms in a row and has one thermostat.

    Rooms lie on floors of 40, in two rows along a corridor.
    """
    for i in range(rooms):
        air, wall = 2 * i, 2 * i + 1
        plant.join(air, wall, Fraction(choices.integer(5, 20), 10))
        plant.join(wall, air, Fraction(choices.integer(1, 5), 10))
        plant.add(wall, wall, -Fraction(choices.integer(1, 9), 100))
        for j in (i + 1, i + 20, i + 40):
            if j < rooms and (j == i + 40 or j // 40 == i // 40) and (j != i + 1 or j % 20):
                through = Fraction(choices.integer(1, 9), 10)
                plant.join(air, 2 * j, through)
                plant.join(2 * j, air, through)
    bounds = [k * rooms // len(chosen) for k in range(len(chosen) + 1)]
    for (first, end), seen in zip(pairwise(bounds), chosen, strict=True):
        heat = {2 * i: Fraction(choices.integer(5, 15), 10) for i in range(first, end)}
        plant.agent([heat], [{2 * seen: Fraction(1)}])


@dataclass(frozen=True)
class Network:
    """A kind of network: the states of each place, what lays it out, and where it is from."""

    states: int
    lay: Callable[[Choices, _Plant, int, list[int]], None]
    source: str


_KUNDUR = "P. Kundur, Power System Stability and Control, 1994, section 3.9"
_STANKOVIC = "S. S. Stankovic, M. J. Stanojevic and D. D. Siljak 2000"
_GOYAL = "S. Goyal and P. Barooah 2012"
_OLFATI = "R. Olfati-Saber, J. A. Fax and R. M. Murray 2007"

NETWORKS: Mapping[str, Network] = MappingProxyType(
    {
        "swing-grid": Network(2, _swing_on(lambda _, buses: _mesh(buses), True), _KUNDUR),
        "swing-hubs": Network(2, _swing_on(_hubs, True), _KUNDUR),
        "swing-speed": Network(2, _swing_on(lambda _, buses: _mesh(buses), False), _KUNDUR),
        "platoon": Network(3, _platoon, _STANKOVIC),
        "consensus": Network(1, _consensus, _OLFATI),
        "building": Network(2, _building, _GOYAL),
    }
)
"""The kinds of networks by name."""
