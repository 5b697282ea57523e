"""Families of systems made from one: grids of parameters, neighbor graphs, and owners of sensors.

Each function yields `Variant` objects, which make their system only when it is asked for: a
family may have up to a million members.  `tolerance_variants` makes the entries uncertain by
parts of their values.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import Any, Literal

from mcexact.derived.constructions import augmented_outputs
from mcexact.errors import InputError, LimitReached, UsageError, several
from mcexact.exact.rational import as_fraction, written
from mcexact.model.box import Box
from mcexact.model.graph import NeighborGraph
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem, as_plant

MOST = 10**6
"""The most members of a family."""


@dataclass(frozen=True)
class Variant:
    """A member of a family, which is made when it is asked for.

    Attributes
    ----------
    name : str
        What distinguishes it, such as ``t=1/2``.
    make : callable
        Makes the system.
    """

    name: str
    make: Callable[[], MultiChannelSystem]

    def system(self) -> MultiChannelSystem:
        """Make the system.

        Raises
        ------
        InputError
            If there is none, since an entry is undefined at these values.
        """
        return self.make()


def parameter_grid(
    plant: ParametricSystem, values: Mapping[Any, Iterable[Any]]
) -> Iterator[Variant]:
    """The plant at all combinations of values of its parameters.

    Parameters
    ----------
    plant : ParametricSystem
    values : mapping
        For each parameter, by symbol or name, exact numbers as `MultiChannelSystem` takes them.

    Raises
    ------
    UsageError
        If a parameter has no values, or a name is no parameter.
    LimitReached
        If there are more than a million combinations.

    Examples
    --------
    >>> plant = ParametricSystem([["t"]], [[["1/t"]]], [[[1]]], parameters=["t"])
    >>> [variant.name for variant in parameter_grid(plant, {"t": [0, "1/2"]})]
    ['t=0', 't=1/2']
    >>> next(parameter_grid(plant, {"t": ["1/2"]})).system().B(0).numerators
    ((2,),)
    """
    InputError.require(plant, ParametricSystem, "plant")
    InputError.require(values, Mapping, "values")
    grid = {
        str(name): [as_fraction(x) for x in several(listed, "values", "numbers")]
        for name, listed in values.items()
    }
    if grid.keys() != set(plant.parameters):
        wrong = sorted(grid.keys() ^ set(plant.parameters))
        raise UsageError(
            f"expected values for the parameters {', '.join(plant.parameters)}, "
            f"and {wrong[0]!r} is {'no parameter' if wrong[0] in grid else 'without any'}"
        )
    _require_few(math.prod(map(len, grid.values())), "combinations of values")

    def variants() -> Iterator[Variant]:
        for point in itertools.product(*(grid[name] for name in plant.parameters)):
            at = dict(zip(plant.parameters, point, strict=True))
            name = ", ".join(f"{key}={written(x)}" for key, x in at.items())
            yield Variant(name, lambda at=at: plant.at(at))  # type: ignore[misc]

    return variants()


def neighbor_graph_variants(
    plant: MultiChannelSystem,
    *,
    strongly_connected: bool = False,
    up_to_isomorphism: bool = False,
    information: Literal["own", "outputs"] = "own",
) -> Iterator[Variant]:
    """The plant with all neighbor graphs, of which there are 2^(m(m−1)).

    Parameters
    ----------
    plant : MultiChannelSystem
    strongly_connected : bool
        Whether graphs that are not strongly connected are left out.
    up_to_isomorphism : bool
        Whether only one of those graphs is taken that differ by the names of the agents: for plants
        whose agents are alike.
    information : {"own", "outputs"}
        With "outputs" every agent also measures what its neighbors measure, as
        `augmented_outputs` has it, and the result is a plant of its own.

    Raises
    ------
    LimitReached
        If there are more than a million graphs, of six agents or more.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> plant = gallery.load("liu2020-3ch-no-communication")
    >>> len(list(neighbor_graph_variants(plant)))
    64
    >>> len(list(neighbor_graph_variants(plant, up_to_isomorphism=True)))
    16
    >>> [variant.name for variant in neighbor_graph_variants(
    ...     plant, strongly_connected=True, up_to_isomorphism=True)][-1]
    '1→2, 1→3, 2→1, 2→3, 3→1, 3→2'
    """
    InputError.require(plant, MultiChannelSystem, "system")
    m, names = plant.m, plant.names
    pairs = [(j, i) for j in range(m) for i in range(m) if i != j]
    if len(pairs) > math.log2(MOST):
        raise LimitReached(f"{m} agents have 2^{len(pairs)} neighbor graphs, more than {MOST}")

    def variants() -> Iterator[Variant]:
        for edges in _graphs(pairs, m, up_to_isomorphism):
            graph = NeighborGraph(names, [[j for j, i in edges if i == k] for k in range(m)])
            if strongly_connected and not graph.is_strongly_connected():
                continue
            links = ", ".join(f"{names[j]}→{names[i]}" for j, i in edges) or "no links"
            yield Variant(links, lambda graph=graph: with_graph(graph))  # type: ignore[misc]

    def with_graph(graph: NeighborGraph) -> MultiChannelSystem:
        system = plant.with_neighbors(graph)
        return system if information == "own" else as_plant(augmented_outputs(system))

    return variants()


Edge = tuple[int, int]


def _graphs(pairs: Sequence[Edge], m: int, up_to_isomorphism: bool) -> Iterator[list[Edge]]:
    """All sets of edges; or of each class of isomorphic graphs the first one."""
    bit = {pair: 1 << k for k, pair in enumerate(pairs)}
    orders = list(itertools.permutations(range(m))) if up_to_isomorphism else []
    images = [[bit[order[j], order[i]] for j, i in pairs] for order in orders]
    seen: set[int] = set()
    for chosen in itertools.product((False, True), repeat=len(pairs)):
        if up_to_isomorphism:
            if sum(itertools.compress(bit.values(), chosen)) in seen:
                continue
            seen.update(sum(itertools.compress(image, chosen)) for image in images)
        yield list(itertools.compress(pairs, chosen))


def sensor_variants(plant: MultiChannelSystem, *, unused: bool = False) -> Iterator[Variant]:
    """The plant with its sensors assigned to channels in all ways.

    Parameters
    ----------
    plant : MultiChannelSystem
        Its sensors are the rows of all C_i; each goes to one channel.
    unused : bool
        Whether a sensor may also go to no channel.

    Raises
    ------
    LimitReached
        If there are more than a million ways.

    Examples
    --------
    >>> plant = MultiChannelSystem([[0]], [[[1]], [[1]]], [[[1]], []], names=["left", "right"])
    >>> [variant.name for variant in sensor_variants(plant, unused=True)]
    ['left[0] at left', 'left[0] at right', 'left[0] unused']
    >>> list(sensor_variants(plant))[1].system().C(1).numerators
    ((1,),)
    """
    InputError.require(plant, MultiChannelSystem, "system")
    C = plant.output_matrix()
    sensors = [f"{name}[{k}]" for i, name in enumerate(plant.names) for k in range(plant.q(i))]
    owners = [*range(plant.m), *([-1] if unused else [])]
    _require_few(len(owners) ** len(sensors), "ways of giving sensors to channels")

    def with_sensors(chosen: tuple[int, ...]) -> MultiChannelSystem:
        rows = [[k for k, owner in enumerate(chosen) if owner == i] for i in range(plant.m)]
        return MultiChannelSystem(
            plant.A,
            [channel.B for channel in plant.channels],
            [C.take(rows=each) for each in rows],
            time=plant.time,
            names=plant.names,
            neighbors=plant.neighbors,
            sample_time=plant.sample_time,
        )

    def variants() -> Iterator[Variant]:
        for chosen in itertools.product(owners, repeat=len(sensors)):
            placement = ", ".join(
                f"{sensor} unused" if owner < 0 else f"{sensor} at {plant.names[owner]}"
                for sensor, owner in zip(sensors, chosen, strict=True)
            )
            yield Variant(placement, lambda chosen=chosen: with_sensors(chosen))  # type: ignore[misc]

    return variants()


def tolerance_variants(plant: MultiChannelSystem, parts: Iterable[Any]) -> Iterator[Variant]:
    """The plant with every nonzero entry uncertain by a part of its value, for each of the parts.

    Parameters
    ----------
    plant : MultiChannelSystem
    parts : iterable of exact numbers
        Such as "1/1000" for 0.1 %.

    Examples
    --------
    >>> plant = MultiChannelSystem([[2]], [[[1]]], [[[1]]])
    >>> [variant.name for variant in tolerance_variants(plant, ["1/1000", "1/3"])]
    ['within 1/1000', 'within 1/3']
    >>> next(tolerance_variants(plant, ["1/2"])).system().uncertainty.A[0, 0]
    Fraction(1, 1)
    """
    InputError.require(plant, MultiChannelSystem, "system")
    sizes = [as_fraction(part) for part in several(parts, "parts", "numbers")]

    def within(part: Fraction) -> MultiChannelSystem:
        return Box.relative(plant, part).system

    return (Variant(f"within {written(part)}", partial(within, part)) for part in sizes)


def _require_few(count: int, what: str) -> None:
    if count > MOST:
        raise LimitReached(f"there are {count} {what}, more than {MOST}")
