"""The instances on which statements are checked: the paper's data, named plants, drawn plants."""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator
from typing import Any

from mcexact.derived.drawn.networks import drawn_graph
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.derived.drawn.systems import (
    jointly_controllable_system,
    system_with_deficiency,
    system_with_fixed_mode,
)
from mcexact.exact.matrix import Matrix
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem

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
"""The same for two, three and four channels, by positions."""


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
    found = gallery.load("liu2020-3ch-no-communication")
    ring = NeighborGraph.from_names(found.names, {"1": ["2"], "2": ["3"], "3": ["1"]})
    delays = [(i, j, delay) for j, i in ring.edges()]
    return MultiChannelSystem(
        found.A,
        [channel.B for channel in found.channels],
        [channel.C for channel in found.channels],
        time=time,
        neighbors=NeighborGraph(found.names, ring.neighbors, delays),
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
