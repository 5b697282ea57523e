"""Networks derived from a plant, with shared sub-states and integrators.

A distributed controller with shared sub-states is a decentralized controller of a larger system:
the extended system without delays, the lifted system over links with delays, the held system if
agents also hold what they send (sections IV-C to V of the paper).  `shared_network` makes it,
`sharing_network` also chooses the dimensions of the sub-states, and `network_programs` translates
gains of the larger system back to agent programs.  Delays belong to the links and holding to the
agents, so the programs contain no matrix of the lifted system.

`integrated_plant` adds integrators of the outputs, or models of other signals, for a search of
set-point controllers.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain
from typing import Literal

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.sharing import minimal_shared_dimensions, shared_dimension_bound
from mcexact.answer import loops as say
from mcexact.answer.loops import refusal
from mcexact.answer.modes import FixedSpectrum
from mcexact.answer.sharing import Deficiency, SharedDimensions
from mcexact.derived.constructions import (
    Share,
    augmented_outputs,
    checked_dimensions,
    closure,
    extended_system,
    held_system,
    internal_model,
    lifted_system,
    servo_system,
)
from mcexact.errors import InputError, UsageError, one_of
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.graph import NeighborGraph
from mcexact.model.sizes import STANDARD_ERROR, TypicalSizes
from mcexact.model.system import MultiChannelSystem, as_plant, with_graph
from mcexact.model.units import Units
from mcexact.synthesis.channel_controller import ChannelController
from mcexact.synthesis.gate import Request

# Networks derived from a plant, and agent programs of their decentralized controllers.

NetworkKind = Literal["decentralized", "extended", "lifted", "held"]

Signal = tuple[Literal["y", "x"], int]


@dataclass(frozen=True)
class DerivedNetwork:
    """A plant with the dimensions that its agents share, and the resulting multi-channel system.

    Attributes
    ----------
    kind : {"decentralized", "extended", "lifted", "held"}
    plant : MultiChannelSystem
        The plant or derived system on which the agents run.
    graph : NeighborGraph or None
        None if no signals are sent.
    dimensions : tuple of int
        n_1 … n_m.
    system : MultiChannelSystem
        The system whose decentralized controllers are the distributed controllers of the plant.
    signals : tuple
        The signals that each agent receives, in the order of its outputs: ("y", j) or ("x", j).
    """

    kind: NetworkKind
    plant: MultiChannelSystem
    graph: NeighborGraph | None
    dimensions: tuple[int, ...]
    system: MultiChannelSystem
    signals: tuple[tuple[Signal, ...], ...]

    def size(self, signal: Signal) -> int:
        """The dimension of a signal."""
        what, j = signal
        return self.plant.q(j) if what == "y" else self.dimensions[j]

    def holds(self, j: int) -> dict[int, int]:
        """The number of steps for which agent j holds x_j, for each follower and for itself."""
        if self.kind != "held" or self.graph is None or not self.dimensions[j]:
            return {}
        longest = self.graph.longest_delay(j)
        held = {i: longest - (self.graph.delay(i, j) if i != j else 0) for i in self._hearers(j)}
        return {i: steps for i, steps in held.items() if steps}

    def _hearers(self, j: int) -> list[int]:
        return [i for i, seen in enumerate(self.signals) if ("x", j) in seen]

    def split(self, i: int, gains: Matrix) -> LinearMap:
        """Split gains of ȳ_i by the signals that they multiply.

        Parameters
        ----------
        i : int
        gains : Matrix
            Its columns belong to the signals of agent i, in their order.

        Returns
        -------
        LinearMap
            The blocks of columns of each y_j and x_j, without those that are 0.
        """
        maps: dict[str, dict[int, Matrix]] = {"y": {}, "x": {}}
        start = 0
        for what, j in self.signals[i]:
            stop = start + self.size((what, j))
            maps[what][j] = gains.take(cols=range(start, stop))
            start = stop
        return LinearMap(maps["y"], maps["x"]).without_zeros()


def decentralized_network(system: MultiChannelSystem) -> DerivedNetwork:
    """Return the plant as a network in which agent i receives y_i alone."""
    signals: tuple[tuple[Signal, ...], ...] = tuple((("y", i),) for i in range(system.m))
    return DerivedNetwork("decentralized", system, None, (0,) * system.m, system, signals)


def shared_network(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    dimensions: Sequence[int],
    share: Share,
    kind: NetworkKind,
) -> DerivedNetwork:
    """Return the extended, lifted or held system for some dimensions.

    Raises
    ------
    UsageError
        If the links have delays and the kind does not, or outputs should be sent and held.
    """
    own_only = kind == "held" or share == "states"
    if kind == "held" and share != "states":
        raise UsageError('with holding, agents send sub-states only: share must be "states"')
    if kind == "extended" and graph.delays:
        raise UsageError('the links have delays: choose the network "lifted" or "held"')
    if kind == "held":
        derived = held_system(system, dimensions, graph)
    else:
        builder: Callable[..., MultiChannelSystem]
        builder = lifted_system if kind == "lifted" else extended_system
        derived = builder(system, dimensions, share, graph)
    signals = []
    for i in range(system.m):
        heard = graph.neighborhood(i)
        measured = [i] if own_only else list(heard)
        if kind == "lifted":
            measured.sort(key=lambda j: (graph.delay(i, j) > 0, j))
        seen: list[Signal] = [("y", j) for j in measured]
        signals.append((*seen, *(("x", j) for j in heard)))
    return DerivedNetwork(kind, system, graph, tuple(dimensions), derived, tuple(signals))


def network_programs(
    network: DerivedNetwork,
    gains: Sequence[Matrix],
    channels: Mapping[int, ChannelController],
) -> Controller:
    """Write the agent programs for ū_i = F̄_i ȳ_i, with channel controllers at some agents.

    Parameters
    ----------
    network : DerivedNetwork
    gains : sequence of Matrix
        F̄_i, (p_i + n_i) × the size of ȳ_i; ū_i = (u_i, v_i) and v_i updates x_i.
    channels : mapping of int to ChannelController
        ż = Az + Bȳ_q, with Cz + Dȳ_q added to ū_q.

    Notes
    -----
    Paper, sections IV-C to IV-E and V.  Delays belong to the links and holding to the agents, so
    programs contain no matrix of the lifted system.
    """
    plant, programs = network.plant, []
    for i in range(plant.m):
        p_i, channel = plant.p(i), channels.get(i)
        F = gains[i] if channel is None else gains[i] + channel.D
        k = 0 if channel is None else channel.order
        upper, lower = range(p_i), range(p_i, F.nrows)
        used = [network.split(i, F.take(rows=rows)) for rows in (upper, lower)]
        own: list[Matrix | None] = [None, None]
        update = LinearMap()
        if channel is not None and k:
            own = [channel.C.take(rows=upper), channel.C.take(rows=lower)]
            driven = network.split(i, channel.B)
            update = LinearMap(driven.outputs, driven.shared, channel.A).without_zeros()
        inputs, shared = (
            LinearMap(each.outputs, each.shared, z).without_zeros()
            for each, z in zip(used, own, strict=True)
        )
        programs.append(
            AgentProgram(
                plant.names[i], network.dimensions[i], k, shared, update, inputs, network.holds(i)
            )
        )
    return Controller(plant.time, plant.digest_of_values(), tuple(programs))


# The networks of shared sub-states, and the dimensions with which they are controlled.

Dimensions = str | Sequence[int]
"""``"minimal"``, ``"bound"``, or n_1 … n_m."""


def sharing_of(kind: NetworkKind, share: Share | None = None) -> Share:
    """Return what agents send: by default both, but with holding sub-states alone."""
    return share or ("states" if kind == "held" else "outputs+states")


def sharing_network(
    system: MultiChannelSystem,
    graph: NeighborGraph | None,
    request: Request,
    *,
    dimensions: Dimensions = "minimal",
    share: Share | None = None,
    network: Literal["extended", "lifted", "held"] | None = None,
    free_assignability: bool = False,
) -> tuple[DerivedNetwork, SharedDimensions | Deficiency | None]:
    """Return the network that `design_extended` controls, and the allocation of its dimensions.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    request : Request
    dimensions, share, network, free_assignability
        As in `design_extended`; without ``network`` links with delays give the lifted system.

    Raises
    ------
    UsageError
        If there is no neighbor graph, there is no such network, or it does not fit the delays or
        the way of sharing.
    """
    system, graph = with_graph(system, graph)
    one_of(network, (None, "extended", "lifted", "held"), "network")
    kind: NetworkKind = network or ("lifted" if graph.delays else "extended")
    sharing = sharing_of(kind, share)
    request.tell("shared dimensions")
    allocation, sizes = _sizes(system, dimensions, sharing, request.region, free_assignability)
    return shared_network(system, graph, sizes, sharing, kind), allocation


def _sizes(
    system: MultiChannelSystem,
    dimensions: Dimensions,
    share: Share,
    region: StabilityRegion,
    free_assignability: bool,
) -> tuple[SharedDimensions | Deficiency | None, tuple[int, ...]]:
    """Return the dimensions n_1 … n_m, and the answer that determined them."""
    if not isinstance(dimensions, str):
        return None, checked_dimensions(system, dimensions)
    if dimensions == "bound":
        most = shared_dimension_bound(system, share=share)
        return most, (most.deficiency,) * system.m
    if dimensions != "minimal":
        raise InputError(
            f'expected "minimal", "bound" or {system.m} numbers, found {dimensions!r}',
            where="dimensions",
        )
    plant = system if not system.subject else as_plant(system)
    least = minimal_shared_dimensions(
        plant,
        share=share,
        region=None if region.bound is None else region,
        free_assignability=free_assignability,
    )
    if least.dimensions is None and region.bound is None:
        # Not every mode can be moved; the stable ones may be fixed.
        stable = _region_of_stable_modes(system)
        least = minimal_shared_dimensions(
            plant, share=share, region=stable, free_assignability=free_assignability
        )
    if system.subject:
        # The answer is about the system taken for a plant, so it is only followed.  Where no
        # dimensions suffice, neither do as many as there are states.
        return None, least.dimensions or (system.n,) * system.m
    if least.dimensions is None:
        refuse_what_stays(system, stays_over(*with_graph(system, None)), region)
        refuse_joint_modes(system, region)
        raise refusal("connection", least)
    return least, least.dimensions


def refuse_joint_modes(system: MultiChannelSystem, region: StabilityRegion) -> None:
    """Raise an error for a mode outside a region that all channels together do not move.

    Raises
    ------
    Impossible
    """
    for verb, answer in (
        ("move", joint_controllability(system)),
        ("see", joint_observability(system)),
    ):
        if not region.contains_roots_of(answer.uncontrollable_polynomial):
            raise refusal("unreached", answer, template=say.UNREACHED[verb], region=region)


def stays_over(system: MultiChannelSystem, graph: NeighborGraph) -> FixedSpectrum | None:
    """Decide which modes stay however much agents share over a graph.

    Returns
    -------
    FixedSpectrum or None
        Of the plant in which each agent has the outputs of all agents from which a path leads to
        it.  None for strongly connected graphs, over which only modes stay that all channels
        together do not move: other decisions are about these.
    """
    if graph.is_strongly_connected():
        return None
    return fixed_spectrum(augmented_outputs(closure(system, graph)))


def refuse_what_stays(
    system: MultiChannelSystem, stays: FixedSpectrum | None, region: StabilityRegion
) -> None:
    """Raise an error for a mode of a system outside a region that `stays_over` has found.

    Raises
    ------
    Impossible
    """
    if stays is not None and stays.outside(region):
        refuse_joint_modes(system, region)
        raise refusal("over links", stays, region=region)


def _region_of_stable_modes(system: MultiChannelSystem) -> StabilityRegion:
    """Return the region of a rate that every stable mode of A meets, or of the radius 1."""
    region = StabilityRegion(system.time)
    if region.discrete:
        return region
    modes = [p for p, _ in characteristic_polynomial(system.A).factor()]
    stable = [p for p in modes if region.contains_roots_of(p)]
    region, rate = StabilityRegion(system.time, Fraction(1)), Fraction(1)
    while not all(region.contains_roots_of(p) for p in stable):
        rate /= 2
        region = StabilityRegion(system.time, rate)
    return region


def integrated_plant(
    system: MultiChannelSystem,
    selection: Sequence[Matrix] | None = None,
    signals: Polynomial | None = None,
) -> MultiChannelSystem:
    """Return the plant with its integrators, of which agent i measures σ_i, and y_i, too.

    Parameters
    ----------
    system : MultiChannelSystem
        n states and the outputs y_i = C_i x.
    selection : sequence of m Matrix, optional
        S_i, of which S_i y_i is integrated; by default every y_i is.
    signals : Polynomial, optional
        α of degree d, for models of other signals than constants in place of the integrators.

    Returns
    -------
    MultiChannelSystem
        A plant with the matrices of `servo_system`, or of `internal_model`.

    Notes
    -----
    Agents measure y_i as well, since with σ_i alone an agent would have to differentiate to act on
    y_i in proportion.

    Examples
    --------
    >>> plant = MultiChannelSystem([[2]], [[[1]]], [[[3]]])
    >>> integrated_plant(plant).C(0).numerators
    ((0, 1), (3, 0))
    """
    held = selection or every_output(system)
    made = servo_system(system, held) if signals is None else internal_model(system, signals, held)
    plant = as_plant(made)
    sizes = system.typical_sizes
    if sizes is None:
        return plant
    return plant.with_typical_sizes(_with_integrators(system, sizes, held, degree_of(signals)))


def degree_of(signals: Polynomial | None) -> int:
    """The states of a model of one output: the degree of α, or 1 for an integrator."""
    return 1 if signals is None else signals.degree


def _with_integrators(
    system: MultiChannelSystem, sizes: TypicalSizes, selection: Sequence[Matrix], degree: int
) -> TypicalSizes:
    """The sizes of a plant with its integrators, which are as large as ten errors of S_i y_i.

    So is each of the ``degree`` blocks of a model of other signals.
    """
    errors = sizes.of_errors([system.q(i) for i in range(system.m)])
    summed = [
        [sum((abs(x) * e for x, e in zip(row, each, strict=True)), Fraction(0)) for row in S.rows()]
        for S, each in zip(selection, errors, strict=True)
    ]
    integrated = [[e or STANDARD_ERROR for e in each] * degree for each in summed]
    return TypicalSizes(
        [*sizes.of_states(system.n), *(e / STANDARD_ERROR for e in chain(*integrated))],
        sizes.inputs,
        [[*first, *second] for first, second in zip(integrated, errors, strict=True)],
        sizes.disturbances,
    )


def without_integrators(units: Units, selection: Sequence[Matrix], degree: int = 1) -> Units:
    """The units of a plant, for those of the plant with its integrators, or with such models."""
    sizes = [degree * S.nrows for S in selection]
    count = sum(sizes)
    outputs = tuple(each[size:] for each, size in zip(units.outputs, sizes, strict=True))
    return Units(units.states[: len(units.states) - count], units.inputs, outputs)


def every_output(system: MultiChannelSystem) -> tuple[Matrix, ...]:
    """Return the identities S_i, by which every output is regulated."""
    return tuple(Matrix.identity(system.q(i)) for i in range(system.m))
