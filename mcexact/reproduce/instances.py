"""The plants and equations on which statements are checked.

There are three sources of plants: the example of section IV-B (`three_channels`), small named
plants that refute a false statement or show what drawn plants do not, and drawn plants with their
seed in the name, so that every instance can be reproduced.

The equations of the paper's constructions are evaluated at vectors of small integers, from the
plant alone: `messages_agree`, `errors_agree` and `integrators_agree` do not use the code that
constructs the systems, and so check it independently.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.answer.structure import TransferGraph
from mcexact.derived.drawn.networks import drawn_graph
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.derived.drawn.systems import (
    jointly_controllable_system,
    system_with_deficiency,
    system_with_fixed_mode,
)
from mcexact.exact.linear_algebra import rank
from mcexact.exact.matrix import Matrix, vstack
from mcexact.exact.roots import TIMES, is_discrete
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem

# The instances on which statements are checked: the paper's data, named plants, drawn plants.

PAPER = "the example of section IV-B"
Instance = tuple[str, MultiChannelSystem]

# The nonempty proper subsets of three channels, written out.
SUBSETS_OF_THREE = (("1",), ("2",), ("3",), ("1", "2"), ("1", "3"), ("2", "3"))
_PAIRS_OF_FOUR = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))
PROPER_SUBSETS: dict[int, tuple[tuple[int, ...], ...]] = {
    2: ((0,), (1,)),
    3: ((0,), (1,), (2,), (0, 1), (0, 2), (1, 2)),
    4: ((0,), (1,), (2,), (3,), *_PAIRS_OF_FOUR, (0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)),
}
"""The nonempty proper subsets of two, three and four channels, by positions."""


def three_channels(time: str = "continuous", delay: int = 0) -> MultiChannelSystem:
    """A, B_i, C_i of section IV-B over the cyclic graph N_1 = {1, 2}, N_2 = {2, 3}, N_3 = {3, 1}.

    Parameters
    ----------
    time : {"continuous", "discrete"}
    delay : int
        The delay of every link.

    Examples
    --------
    >>> three_channels().neighbors.neighborhood(2)
    (0, 2)
    """
    plant = gallery.load("liu2020-3ch-no-communication")
    ring = NeighborGraph.from_names(plant.names, {"1": ["2"], "2": ["3"], "3": ["1"]})
    delays = [(i, j, delay) for j, i in ring.edges()]
    return MultiChannelSystem(
        plant.A,
        [channel.B for channel in plant.channels],
        [channel.C for channel in plant.channels],
        time=time,
        neighbors=NeighborGraph(plant.names, ring.neighbors, delays),
        name="three channels",
    )


def drawn_plants(
    count: int,
    *,
    states: int = 3,
    channels: int = 3,
    time: str = "continuous",
    fixed: bool = False,
    longest_delay: int = 0,
    connected: bool | None = True,
    first: int = 1,
) -> Iterator[Instance]:
    """Jointly controllable and observable plants over drawn graphs, with the seed in their names.

    Parameters
    ----------
    count : int
    states, channels : int
        The largest numbers of states and channels; every second plant has one less of each.
    time : {"continuous", "discrete"}
    fixed : bool
        Whether a fixed mode is planted.
    longest_delay : int
        The largest delay of a link.
    connected : bool or None
        Whether the neighbor graph is strongly connected; None for graphs of both kinds.
    first : int
        The first seed.
    """
    for seed in range(first, first + count):
        choices = SeededChoices(seed)
        n, m = max(1, states - seed % 2), max(2, channels - seed % 2)
        if fixed:
            drawn = system_with_fixed_mode(choices, n, m, 1, time=time)
        else:
            drawn = jointly_controllable_system(choices, n, m, time=time)
        wanted = seed % 4 < 2 or None if connected is None else connected
        graph = drawn_graph(choices, drawn.system.names, wanted, longest_delay)
        kind = "planted fixed mode, " if fixed else ""
        yield f"drawn, {kind}seed {seed}: n={n}, m={m}", drawn.system.with_neighbors(graph)


# The arguments for the n-th deficient plant: bounds 1 to 3, tight ones and others, complex pairs,
# Jordan chains, large rationals.
_SHAPES: tuple[dict[str, Any], ...] = (
    {"deficiency": 1},
    {"deficiency": 2},
    {"deficiency": 2, "channels": 4, "boundary": 2, "transfer": False, "stable": True},
    {"deficiency": 1, "degree": 2, "stable": True},
    {"deficiency": 3, "stable": True},
    {"deficiency": 1, "channels": 4, "boundary": 2, "length": 2},
    {"deficiency": 2, "digits": 12},
)


def deficient_plants(
    count: int,
    *,
    share: str = "outputs+states",
    time: str = "continuous",
    longest_delay: int = 0,
    first: int = 1,
) -> Iterator[Instance]:
    """Plants over strongly connected graphs whose bound is 1, 2 or 3, with it in their names.

    Parameters
    ----------
    count : int
        At most 7, with different shapes.
    share : {"outputs+states", "states"}
        For which the bound is prescribed.
    time : {"continuous", "discrete"}
    longest_delay : int
    first : int
        The first seed.
    """
    way = "" if share == "outputs+states" else " for sub-states alone"
    for seed, shape in enumerate(_SHAPES[:count], first):
        drawn = system_with_deficiency(
            SeededChoices(seed), **{"share": share, "delay": longest_delay, "time": time, **shape}
        ).system
        bound = shape["deficiency"]
        yield f"drawn, bound {bound}{way}, seed {seed}: n={drawn.n}, m={drawn.m}", drawn


def plants(count: int, **options: object) -> Iterator[Instance]:
    """The paper's example, then drawn plants in the same time domain."""
    time = str(options.get("time", "continuous"))
    delay = 1 if options.get("longest_delay") else 0
    yield PAPER, three_channels(time, delay)
    yield from drawn_plants(count, **options)  # type: ignore[arg-type]


def with_dimensions(instances: Iterable[Instance]) -> Iterator[tuple[Instance, list[int]]]:
    """Instances with n_i = 1, 2, 0, 1, …, which their names tell."""
    for name, plant in instances:
        sizes = [k % 3 for k in range(1, plant.m + 1)]
        yield (f"{name}, n_i = {sizes}", plant), sizes


def graph_of(plant: MultiChannelSystem) -> NeighborGraph:
    """The neighbor graph, which every instance here has."""
    if plant.neighbors is None:
        raise ValueError("the instance has a neighbor graph")
    return plant.neighbors


def needs_gains(system: MultiChannelSystem) -> bool:
    """Whether some channel alone, without gains of the others, does not control and observe it."""
    single = (MultiChannelSystem(system.A, [channel.B], [channel.C]) for channel in system.channels)
    return any(
        not (joint_controllability(each).controllable and joint_observability(each).controllable)
        for each in single
    )


def uses_few_directions(plant: MultiChannelSystem) -> bool:
    """Whether all inputs together, or all outputs together, have a rank below n."""
    return min(rank(plant.input_matrix()), rank(plant.output_matrix())) < plant.n


def is_late(plant: MultiChannelSystem) -> bool:
    """Whether some link has a delay."""
    return any(delay for _, _, delay in graph_of(plant).delays)


class Numbers:
    """A source of small integers: vectors and gains at which equations are evaluated.

    Parameters
    ----------
    seed : int
    largest : int
        The largest absolute value.
    """

    def __init__(self, seed: int = 0, largest: int = 4) -> None:
        self._random, self._largest = random.Random(seed), largest

    def matrix(self, nrows: int, ncols: int) -> Matrix:
        """A matrix of such integers."""
        top = self._largest
        rows = [[self._random.randint(-top, top) for _ in range(ncols)] for _ in range(nrows)]
        return Matrix.from_integers(rows, ncols=ncols)

    def column(self, size: int) -> Matrix:
        """A vector."""
        return self.matrix(size, 1)

    def gains(self, system: MultiChannelSystem) -> list[Matrix]:
        """F_i, p_i × q_i."""
        return [self.matrix(system.p(i), system.q(i)) for i in range(system.m)]

    def feedbacks(self, system: MultiChannelSystem) -> list[Matrix]:
        """F_i, p_i × n."""
        return [self.matrix(system.p(i), system.n) for i in range(system.m)]


# The named plants: those that refute, and those that show what drawn plants do not.

Columns = list[list[int]]
RING_OF_THREE = {"1": ["2"], "2": ["3"], "3": ["1"]}
PAIR = {"1": ["2"], "2": ["1"]}


def unit(n: int, *places: int) -> Columns:
    """The matrix whose columns are the unit vectors at some places, n × their number."""
    return [[int(row == place) for place in places] for row in range(n)]


def transposed(columns: Columns) -> Columns:
    """The matrix whose rows are these columns."""
    return [list(row) for row in zip(*columns, strict=True)]


def diagonal(*entries: int) -> Columns:
    """A diagonal matrix."""
    n = len(entries)
    return [[entries[i] * (i == j) for j in range(n)] for i in range(n)]


def still_pair() -> Instance:
    """Two agents that send each other messages, with one state that each controls and observes."""
    one = [[1]]
    plant = MultiChannelSystem([[0]], [one] * 2, [one] * 2)
    return "A = 0, two equal agents", plant.with_neighbors(NeighborGraph.complete(plant.names))


def two_between() -> Instance:
    """Agent 1 drives two integrators, 4 measures them, and 1 receives from 2 and 3 alone."""
    units: list[list[int]] = [[1, 0], [0, 1]]
    plant = MultiChannelSystem(
        [[0, 0], [0, 0]],
        [units, *[[[], []]] * 3],
        [*[[]] * 3, units],
        neighbors={"1": ["2", "3"], "2": ["4"], "3": ["4"], "4": ["1"]},
    )
    return "A = 0, two agents between those who drive and measure", plant


def four_agents() -> Instance:
    """The same with B_i and C_i that are not zero: the bound is 2, and n_i = 1 for all suffices."""
    first, last = unit(4, 0, 1, 3), transposed(unit(4, 0, 1, 2))
    middle, seen = unit(4, 2), transposed(unit(4, 3))
    plant = MultiChannelSystem(
        diagonal(0, 0, 5, 7),
        [first, middle, middle, middle],
        [seen, seen, seen, last],
        neighbors={"1": ["2", "3"], "2": ["4"], "3": ["4"], "4": ["1"]},
    )
    return "diag(0, 0, 5, 7) and four agents", plant


def split_spectrum(time: str = "continuous", delay: int = 0) -> Instance:
    """No mode is fixed, the bound is 0, and the spectrum splits over two strong components."""
    e1, e2 = unit(2, 0), unit(2, 1)
    ring = NeighborGraph.from_names(("1", "2", "3"), RING_OF_THREE)
    delays = [(i, j, delay) for j, i in ring.edges()]
    plant = MultiChannelSystem(
        diagonal(0, 0),
        [e1, e2, e2],
        [transposed(e1), transposed(e1), transposed(e2)],
        time=time,
        neighbors=NeighborGraph(ring.names, ring.neighbors, delays),
    )
    late = f", {delay} step{'s' if delay > 1 else ''} late" if delay else ""
    return f"A = 0 on a cycle{late}, nothing shared", plant


def apart(delay: int = 1) -> Instance:
    """Two integrators, each controlled and measured by its own agent, in discrete time."""
    e1, e2 = unit(2, 0), unit(2, 1)
    graph = NeighborGraph(("1", "2"), [[0, 1], [0, 1]], [(0, 1, delay), (1, 0, delay)])
    plant = MultiChannelSystem(
        diagonal(1, 1), [e1, e2], [transposed(e1), transposed(e2)], time="discrete", neighbors=graph
    )
    return "two decoupled agents", plant


def hidden_by_feedback() -> tuple[str, MultiChannelSystem, list[Columns]]:
    """A double integrator, and F_i after which the outputs miss an eigenvector of A + Σ B_i F_i."""
    position = [[1, 0]]
    plant = MultiChannelSystem(
        [[0, 1], [0, 0]], [unit(2, 0), unit(2, 1)], [position, position], neighbors=PAIR
    )
    return "a double integrator, fed back to diag(−1, −2)", plant, [[[-1, -1]], [[0, -2]]]


def dependent_inputs() -> tuple[str, MultiChannelSystem, list[Matrix]]:
    """Two agents, and F_i that are not zero, with B_2 F_2 = 0; agent 1 receives nothing."""
    plant = MultiChannelSystem(
        [[0]], [[[1]], [[1, 1]]], [[[1]], [[1]]], neighbors={"1": [], "2": ["1"]}
    )
    gains = [Matrix.from_integers(rows) for rows in ([[-1]], [[1], [-1]])]
    return "A = 0, two agents, with B_2 = [1 1] and F_2 = [1; −1]", plant, gains


def late_example(delay: int) -> Instance:
    """The matrices of the paper's example in discrete time, with one delay on every link."""
    return (
        f"{PAPER}, discrete time, delay {delay} on every link",
        three_channels("discrete", delay),
    )


def unreached(time: str = "continuous") -> Instance:
    """Two agents over a connected graph, neither of which moves the mode 2."""
    e1, row = unit(2, 0), [[1, 1]]
    plant = MultiChannelSystem(diagonal(1, 2), [e1, e1], [row, row], time=time, neighbors=PAIR)
    return "diag(1, 2), of which 1 is driven", plant


def unseen(time: str = "continuous") -> Instance:
    """Two agents over a connected graph, neither of which measures the mode 2."""
    row, column = [[1, 0]], [[1], [1]]
    plant = MultiChannelSystem(
        diagonal(1, 2), [column, column], [row, row], time=time, neighbors=PAIR
    )
    return "diag(1, 2), of which 1 is measured", plant


def two_circles() -> Instance:
    """Agents 1 and 2 receive from each other, and so do 3 and 4: no agent is alone."""
    name, plant = four_agents()
    graph = {"1": ["2"], "2": ["1"], "3": ["4"], "4": ["3"]}
    return f"{name} in two pairs", plant.with_neighbors(graph)


def fixed_zero() -> Instance:
    """In discrete time the eigenvalue 2, and the fixed mode 0."""
    plant = MultiChannelSystem(
        diagonal(0, 0, 0, 2),
        [unit(4, 0, 1, 3), unit(4, 2)],
        [transposed(unit(4, 0, 3)), transposed(unit(4, 1, 2))],
        time="discrete",
    )
    return "diag(0, 0, 0, 2), with the fixed mode 0", plant


def washed_out() -> Instance:
    """A plant with an invariant zero at 0."""
    plant = MultiChannelSystem([[0, 1], [-2, -3]], [[[0], [1]]], [[[0, 1]]])
    return "a zero at 0: y = s/(s² + 3s + 2) u", plant


def two_tanks(time: str = "continuous") -> Instance:
    """Two scalar outputs; set-points can be held."""
    plant = MultiChannelSystem(
        [[0, 1], [2, -1]],
        [unit(2, 0), unit(2, 1)],
        [transposed(unit(2, 0)), transposed(unit(2, 1))],
        time=time,
        neighbors=PAIR,
        name="two tanks",
    )
    return "two states, two agents with one output each", plant


def hidden_zero() -> Instance:
    """A plant whose transfer matrix has a determinant without a zero at 0; set-points fail."""
    plant = MultiChannelSystem(
        [[0, 0, 0], [0, -2, -1], [0, 1, 0]],
        [unit(3, 0), unit(3, 1)],
        [transposed(unit(3, 0)), transposed(unit(3, 1))],
    )
    return "diag(1/s, s/(s+1)²)", plant


# The defining equations of constructions, evaluated at drawn vectors from the plant alone.


def driven(system: MultiChannelSystem, x: Matrix, inputs: Sequence[Matrix]) -> Matrix:
    """Ax + Σ B_i u_i."""
    total = system.A @ x
    for i, u in enumerate(inputs):
        total = total + system.B(i) @ u
    return total


def outputs(system: MultiChannelSystem, x: Matrix) -> list[Matrix]:
    """y_i = C_i x."""
    return [system.C(i) @ x for i in range(system.m)]


def stacked(parts: Sequence[Matrix]) -> Matrix:
    """column{…}, empty parts included."""
    return vstack(list(parts), ncols=1)


def positions(plant: MultiChannelSystem, graph: TransferGraph) -> set[tuple[int, int]]:
    """The edges of a transfer graph from one channel to another, by position."""
    at = {name: i for i, name in enumerate(plant.names)}
    return {(at[j], at[i]) for j, i in graph.arcs if j != i}


def union_of_graphs(plant: MultiChannelSystem, transfer: TransferGraph) -> NeighborGraph:
    """The union of the neighbor graph and the transfer graph."""
    return graph_of(plant).with_edges(positions(plant, transfer))


def messages_agree(
    plant: MultiChannelSystem,
    system: MultiChannelSystem,
    sizes: Sequence[int],
    share: str,
    delays: Mapping[tuple[int, int], int],
    numbers: Numbers,
    steps: int = 7,
) -> bool:
    """Whether agents of an extended system see what links with these delays bring, step by step.

    Starts from a drawn x with nothing sent before, x_i(t+1) = v_i(t); without delays that says the
    same of ẋ_i = v_i.  Agent i sees y_j(t) for the delay 0, then y_j late (y_i(t) alone where only
    sub-states are shared), then x_j late, j ∈ N_i.
    """
    graph, both = graph_of(plant), share == "outputs+states"
    x, shared = numbers.column(plant.n), [Matrix.zeros(size, 1) for size in sizes]
    state = stacked([x, Matrix.zeros(system.n - plant.n, 1)])
    sent: list[tuple[list[Matrix], list[Matrix]]] = []

    def past(late: int, which: int, j: int) -> Matrix:
        if late < len(sent):
            return sent[-1 - late][which][j]
        return Matrix.zeros((plant.q(j), sizes[j])[which], 1)

    for _ in range(steps):
        sent.append((outputs(plant, x), shared))
        for i in range(plant.m):
            late = {j: delays.get((i, j), 0) for j in graph.neighborhood(i)}
            measured = sorted(late, key=lambda j: late[j] > 0) if both else [i]
            seen = [past(late[j] if both else 0, 0, j) for j in measured]
            seen += [past(late[j], 1, j) for j in late]
            if system.C(i) @ state != stacked(seen):
                return False
        u = [numbers.column(plant.p(i)) for i in range(plant.m)]
        v = [numbers.column(size) for size in sizes]
        state = driven(system, state, [stacked([u[i], v[i]]) for i in range(plant.m)])
        x, shared = driven(plant, x, u), v
    return True


def errors_agree(
    plant: MultiChannelSystem,
    system: MultiChannelSystem,
    feedbacks: Sequence[Matrix],
    numbers: Numbers,
) -> bool:
    """Whether e_i = x_i − x obeys the error system under the substitution rule.

    ẋ = Ax + Σ B_j F_j x_j and ẋ_i = Ax_i + (Σ B_j F_j) x_i + ṽ_i; agent i sees C_i e_i and
    e_i − e_j, j ∈ N_i∖{i}.
    """
    graph = graph_of(plant)
    x = numbers.column(plant.n)
    estimates = [numbers.column(plant.n) for _ in range(plant.m)]
    v = [numbers.column(plant.n) for _ in range(plant.m)]
    plant_ahead = driven(plant, x, [F @ x_j for F, x_j in zip(feedbacks, estimates, strict=True)])
    errors = [x_i - x for x_i in estimates]
    ahead = [
        driven(plant, x_i, [F @ x_i for F in feedbacks]) + v_i - plant_ahead
        for x_i, v_i in zip(estimates, v, strict=True)
    ]
    epsilon = stacked(errors)
    for i in range(plant.m):
        others = [errors[i] - errors[j] for j in graph.neighborhood(i) if j != i]
        if system.C(i) @ epsilon != stacked([plant.C(i) @ errors[i], *others]):
            return False
    return driven(system, epsilon, v) == stacked(ahead)


def integrators_agree(
    plant: MultiChannelSystem, system: MultiChannelSystem, numbers: Numbers
) -> bool:
    """Whether (18) holds for r = 0: ẇ_i = y_i (discrete: w_i + y_i), and agent i sees w_i."""
    x = numbers.column(plant.n)
    w = [numbers.column(plant.q(i)) for i in range(plant.m)]
    u = [numbers.column(plant.p(i)) for i in range(plant.m)]
    y = outputs(plant, x)
    if is_discrete(plant.time):
        y = [a + b for a, b in zip(w, y, strict=True)]
    state = stacked([x, *w])
    return outputs(system, state) == w and driven(system, state, u) == stacked(
        [driven(plant, x, u), *y]
    )


# What the instances of an examination have in common, in words.

_ORIGINS = (
    ("drawn, bound", "drawn over strongly connected graphs for a bound of 1, 2 or 3 that is known"),
    ("drawn, planted", "drawn with a planted fixed mode"),
    ("drawn, a fixed mode", "drawn with a fixed mode by two channels"),
    ("drawn pair", "drawn pairs of matrices"),
    ("three agents, links", "graphs with three agents"),
    ("drawn", "drawn"),
)
_MOST_NAMES = 5


def in_common(names: Sequence[str], plants: Mapping[str, MultiChannelSystem]) -> str:
    """Describe instances: where they come from, their sizes, and what all or some of them are.

    Parameters
    ----------
    names : sequence of str
    plants : mapping of str to MultiChannelSystem
        The plants of those instances that are one.

    Examples
    --------
    >>> from mcexact.reproduce.instances import three_channels
    >>> in_common([PAPER], {PAPER: three_channels()})
    'the matrices of the example of IV-B; 3 states, 3 channels, continuous time; jointly \
controllable and observable; over a strongly connected graph'
    """
    chosen = [plants[name] for name in names if name in plants]
    return "; ".join([*_origins(names), *_sizes(chosen), *_properties(chosen)])


def _origins(names: Sequence[str]) -> list[str]:
    """How many instances come from where; a few named ones by their names."""
    by_origin: dict[str, list[str]] = {}
    for name in names:
        origin = next((text for start, text in _ORIGINS if name.startswith(start)), "named")
        by_origin.setdefault("" if name.startswith(PAPER) else origin, []).append(name)
    origins = []
    for origin, members in by_origin.items():
        if not origin:
            many = f", in {len(members)} instances" if len(members) > 1 else ""
            origins.append(f"the matrices of the example of IV-B{many}")
        elif origin == "named" and len(members) <= _MOST_NAMES:
            origins += members
        else:
            origins.append(f"{len(members)} {origin}")
    return origins


def _sizes(plants: Sequence[MultiChannelSystem]) -> list[str]:
    """The numbers of states and channels, the time domains, and the longest delay."""
    if not plants:
        return []
    times = {plant.time for plant in plants}
    domain = "both time domains" if times == set(TIMES) else f"{times.pop()} time"
    states = _span((plant.n for plant in plants), "state")
    channels = _span((plant.m for plant in plants), "channel")
    delays = [d for p in plants if p.neighbors is not None for _, _, d in p.neighbors.delays]
    late = [f"delays up to {max(delays)}"] if any(delays) else []
    return [", ".join([states, channels, domain, *late])]


def _span(sizes: Iterable[int], noun: str) -> str:
    """From the smallest to the largest number of something."""
    ordered = sorted(sizes)
    least, most = ordered[0], ordered[-1]
    if least == most:
        return f"{most} {noun}{'' if most == 1 else 's'}"
    return f"{least} {'or' if most == least + 1 else 'to'} {most} {noun}s"


def _properties(plants: Sequence[MultiChannelSystem]) -> list[str]:
    """How many are jointly controllable and observable, and have strongly connected graphs."""
    joint = [
        joint_controllability(plant).controllable and joint_observability(plant).controllable
        for plant in plants
    ]
    graphs = [
        plant.neighbors.is_strongly_connected() for plant in plants if plant.neighbors is not None
    ]
    words = _how_many(joint, "jointly controllable and observable")
    over = (
        "over a strongly connected graph" if len(graphs) == 1 else "over strongly connected graphs"
    )
    return [*words, *_how_many(graphs, over)]


def _how_many(holds: Sequence[bool], property_: str) -> list[str]:
    """A property, with the number of instances that have it."""
    if not holds:
        return []
    if all(holds):
        return [property_ if len(holds) == 1 else f"all {property_}"]
    return [f"{sum(holds)} of {len(holds)} {property_}"]
