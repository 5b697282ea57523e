"""The named plants: those that refute, and those that show what drawn plants do not."""

from __future__ import annotations

from mcexact.exact.matrix import Matrix
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.reproduce.material import PAPER, Instance, three_channels

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
    """Two agents that exchange messages, with one state that each controls and observes."""
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
    """Two agents, and F_i that are not zero, with B_2 F_2 = 0; agent 1 does not hear agent 2."""
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
    """Agents 1 and 2 receive from each other, 3 and 4 too: every agent hears another one."""
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
