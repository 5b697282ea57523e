"""Everything that is decided about one system, together."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from mcexact.errors import LimitReached, UsageError

if TYPE_CHECKING:
    from mcexact.analysis.allocation import SharedDimensionBound, SharedDimensions
    from mcexact.analysis.assignability import Assignability
    from mcexact.analysis.closed_loop_spectrum import OpenLoopSpectrum
    from mcexact.analysis.communication import MinimalCommunication
    from mcexact.analysis.complementary_subsystem import ComplementarySubsystem
    from mcexact.analysis.completeness import Completeness
    from mcexact.analysis.controllability import JointControllability
    from mcexact.analysis.controllability_indices import ControllabilityIndices
    from mcexact.analysis.delays import NetworkVerdict
    from mcexact.analysis.neighbor_graph import NeighborGraphVerdict
    from mcexact.analysis.pencil import PencilRank
    from mcexact.analysis.single_channel_gains import SingleChannelGains
    from mcexact.analysis.transfer_graph import TransferGraph
    from mcexact.answer.fixed_spectrum import FixedSpectrum
    from mcexact.answer.setpoint import SetpointSolvability
    from mcexact.derived.extended import Share
    from mcexact.exact.polynomial import Polynomial
    from mcexact.model.system import MultiChannelSystem

SHARING: tuple[Share, ...] = ("outputs+states", "states")


@dataclass(frozen=True)
class ChannelAnswers:
    """What one channel can do, by itself and with the help of gains in all channels.

    Attributes
    ----------
    name : str
    controllability, observability : JointControllability
        Of this channel alone.
    gains : mapping from ``"controllable"``, ``"observable"`` and ``"both"`` to SingleChannelGains
        With decentralized gains.
    """

    name: str
    controllability: JointControllability
    observability: JointControllability
    gains: Mapping[str, SingleChannelGains]

    def answers(self) -> dict[str, Any]:
        """The answers under the stems of their certificates' names."""
        alone = {
            "channel_controllability": self.controllability,
            "channel_observability": self.observability,
        }
        return alone | {f"channel_gains_{want}": found for want, found in self.gains.items()}


@dataclass(frozen=True)
class DelayedNetworks:
    """What is fixed when sub-states are shared over wires with delays.

    Attributes
    ----------
    lifted, held : NetworkVerdict
        Without holding, where outputs are sent too, and with holding.
    lifted_dimensions, held_dimensions : tuple of int
        What is shared: the bound of Theorem 2 (Remark 2) by every agent.
    """

    lifted: NetworkVerdict
    held: NetworkVerdict
    lifted_dimensions: tuple[int, ...]
    held_dimensions: tuple[int, ...]

    def answers(self) -> dict[str, Any]:
        """The answers under the stems of their certificates' names."""
        found: dict[str, Any] = {}
        for name, verdict in (("lifted", self.lifted), ("held", self.held)):
            found[f"{name}_fixed_spectrum"] = verdict.spectrum
            found[f"{name}_joint_controllability"] = verdict.controllability
            found[f"{name}_joint_observability"] = verdict.observability
        return found


@dataclass(frozen=True)
class Assessment:
    """The answers of `mcexact analyze`.

    Attributes
    ----------
    system : MultiChannelSystem
        What the answers are about: the plant, or the plant with the outputs that agents hear.
    information : str
        ``"own"`` (agent i feeds back y_i) or ``"outputs"`` (the y_j of all j in N_i).
    controllability, observability : JointControllability
    transfer_graph : TransferGraph
    fixed_spectrum : FixedSpectrum
    completeness : Completeness
    controllability_indices, observability_indices : ControllabilityIndices or None
        Of all channels together; None where the least possible index is so large that the evidence
        would be out of proportion (n² > 10⁴ times the number of inputs, or outputs).
    assignability : Assignability
    setpoint : SetpointSolvability
        Whether integrators can hold all outputs of the plant at set-points.
    delayed : DelayedNetworks or None
        If it was asked for.
    complementary_subsystem : ComplementarySubsystem or None
        For the subset that was asked about, where it is nonempty and proper.
    channel : ChannelAnswers or None
        For the channel that was asked about.
    every_channel : SingleChannelGains or None
        Gains with which every channel controls and observes, if they were asked for.
    pencil_ranks : tuple of PencilRank
        For the subset that was asked about, at every mode of A.
    spectrum_of_A : OpenLoopSpectrum or None
        That these are all modes of A.
    neighbor_graph : NeighborGraphVerdict or None
        None if the plant has no neighbor graph.
    shared_dimension_bounds : mapping from the way of sharing to SharedDimensionBound
        Empty if the plant has no neighbor graph.
    minimal_shared_dimensions : mapping from the way of sharing to SharedDimensions, or None
        None unless it was asked for; a `LimitReached` where the node limit was reached.
    minimal_communication : MinimalCommunication, LimitReached or None
        The fewest links, over and above those of the neighbor graph, over which sending outputs
        leaves nothing fixed; None unless it was asked for.
    """

    system: MultiChannelSystem
    information: str
    controllability: JointControllability
    observability: JointControllability
    transfer_graph: TransferGraph
    fixed_spectrum: FixedSpectrum
    completeness: Completeness
    controllability_indices: ControllabilityIndices | None
    observability_indices: ControllabilityIndices | None
    assignability: Assignability
    setpoint: SetpointSolvability
    delayed: DelayedNetworks | None = None
    complementary_subsystem: ComplementarySubsystem | None = None
    channel: ChannelAnswers | None = None
    every_channel: SingleChannelGains | None = None
    pencil_ranks: tuple[PencilRank, ...] = ()
    spectrum_of_A: OpenLoopSpectrum | None = None
    neighbor_graph: NeighborGraphVerdict | None = None
    shared_dimension_bounds: Mapping[Share, SharedDimensionBound] = field(default_factory=dict)
    minimal_shared_dimensions: Mapping[Share, SharedDimensions | LimitReached] | None = None
    minimal_communication: MinimalCommunication | LimitReached | None = None

    @property
    def instant(self) -> str:
        """Whether what is said of messages supposes that they take no time: "delays" if it does."""
        graph = self.system.plant.neighbors
        return "delays" if graph is not None and graph.delays else "none"

    @property
    def control(self) -> str:
        """What the controllers are that the fixed spectrum is about."""
        if self.information == "outputs" and self.instant == "delays":
            return "instant"
        return self.information

    def certificates(self) -> dict[str, Any]:
        """The certificates under the names of their files, in the order of the answers."""
        answers: dict[str, Any] = {
            "joint_controllability": self.controllability,
            "joint_observability": self.observability,
            "transfer_graph": self.transfer_graph,
            "fixed_spectrum": self.fixed_spectrum,
            "completeness": self.completeness,
            "controllability_indices": self.controllability_indices,
            "observability_indices": self.observability_indices,
            "assignability": self.assignability,
            "complementary_subsystem": self.complementary_subsystem,
            "setpoint": self.setpoint,
            "every_channel": self.every_channel,
            "neighbor_graph": self.neighbor_graph,
            "spectrum_of_A": self.spectrum_of_A,
            "minimal_communication": self.minimal_communication,
        }
        if self.channel is not None:
            answers |= self.channel.answers()
        if self.delayed is not None:
            answers |= self.delayed.answers()
        for number, rank in enumerate(self.pencil_ranks, start=1):
            answers[f"pencil_rank_{number}"] = rank
        for share, bound in self.shared_dimension_bounds.items():
            answers[f"shared_dimension_bound_{stem(share)}"] = bound
        for share, least in (self.minimal_shared_dimensions or {}).items():
            answers[f"minimal_shared_dimensions_{stem(share)}"] = least
        return {
            f"{name}.json": answer.certificate
            for name, answer in answers.items()
            if getattr(answer, "certificate", None) is not None
        }


def stem(share: Share) -> str:
    """How a way of sharing appears in the name of a file."""
    return share.replace("+", "_")


def assess(
    plant: MultiChannelSystem,
    *,
    information: str = "own",
    subset: Sequence[str] | None = None,
    channel: str | None = None,
    every_channel: bool = False,
    minimal: bool = False,
    links: bool = False,
    delayed: bool = False,
) -> Assessment:
    """Decide everything that applies to a plant.

    Parameters
    ----------
    plant : MultiChannelSystem
    information : {"own", "outputs"}
        What agent i feeds back: y_i, or the y_j of all j in N_i.
    subset : sequence of str, optional
        Names of channels s: the rank of P_s at every mode of A is computed, too, and what the
        complementary subsystem is, where s is nonempty and proper.
    channel : str, optional
        The name of a channel: what it can control and observe is decided, too.
    every_channel : bool
        Look for gains with which every channel controls and observes, too.
    minimal : bool
        Solve for the least dimensions that agents must share, too.
    links : bool
        Solve for the fewest links, over and above those of the neighbor graph, over which sending
        outputs leaves nothing fixed, too.
    delayed : bool
        Decide the networks with the plant's delays, too.

    Returns
    -------
    Assessment

    Raises
    ------
    UsageError
        If the question needs a neighbor graph and the plant has none.
    """
    from mcexact.analysis.assignability import assignability
    from mcexact.analysis.completeness import completeness
    from mcexact.analysis.controllability import joint_controllability, joint_observability
    from mcexact.analysis.controllability_indices import (
        controllability_indices,
        observability_indices,
    )
    from mcexact.analysis.fixed_spectrum import fixed_spectrum
    from mcexact.analysis.setpoint import setpoint_solvability
    from mcexact.analysis.transfer_graph import transfer_graph

    system = plant
    if information == "outputs":
        from mcexact.derived.augmented_outputs import augmented_outputs

        if plant.neighbors is None:
            raise UsageError(
                "--information outputs asks what the agents can do with the outputs of their "
                "neighbors, and this system names no neighbors: add 'neighbors' to the file"
            )
        system = augmented_outputs(plant)
    if minimal and plant.neighbors is None:
        raise UsageError(
            "--minimal asks what the agents must share with their neighbors, and this system "
            "names no neighbors: add 'neighbors' to the file"
        )
    spectrum, graph = fixed_spectrum(system), transfer_graph(system)
    return Assessment(
        system=system,
        information=information,
        controllability=joint_controllability(system),
        observability=joint_observability(system),
        transfer_graph=graph,
        fixed_spectrum=spectrum,
        completeness=completeness(system, spectrum=spectrum),
        controllability_indices=_within_reason(
            system, system.input_matrix().ncols, controllability_indices
        ),
        observability_indices=_within_reason(
            system, system.output_matrix().nrows, observability_indices
        ),
        assignability=assignability(system, spectrum=spectrum, graph=graph),
        setpoint=setpoint_solvability(plant),
        delayed=_delayed(plant) if delayed else None,
        channel=None if channel is None else _of_the_channel(system, channel),
        **({} if subset is None else _of_the_subset(system, subset)),
        every_channel=_every_channel(system) if every_channel else None,
        minimal_communication=_links(plant) if links else None,
        **({} if plant.neighbors is None else _of_the_graph(plant, minimal)),
    )


def _of_the_graph(plant: MultiChannelSystem, minimal: bool) -> dict[str, Any]:
    """The answers that need a neighbor graph."""
    from mcexact.analysis.allocation import minimal_shared_dimensions, shared_dimension_bound
    from mcexact.analysis.neighbor_graph import neighbor_graph

    def least(share: Share) -> SharedDimensions | LimitReached:
        try:
            return minimal_shared_dimensions(plant, share=share)
        except LimitReached as reached:
            return reached

    return {
        "neighbor_graph": neighbor_graph(plant),
        "shared_dimension_bounds": {
            share: shared_dimension_bound(plant, share=share) for share in SHARING
        },
        "minimal_shared_dimensions": {share: least(share) for share in SHARING}
        if minimal
        else None,
    }


def _delayed(plant: MultiChannelSystem) -> DelayedNetworks:
    """Both networks over the plant's wires, with the bounds on what is shared."""
    from mcexact.analysis.allocation import shared_dimension_bound
    from mcexact.analysis.delays import held_verdict, lifted_verdict

    if plant.neighbors is None:
        raise UsageError(
            "--delayed asks about messages between neighbors, and this system names no neighbors: "
            "add 'neighbors' to the file"
        )
    both, alone = (
        (shared_dimension_bound(plant, share=share).per_agent,) * plant.m for share in SHARING
    )
    return DelayedNetworks(lifted_verdict(plant, both), held_verdict(plant, alone), both, alone)


def _within_reason(
    system: MultiChannelSystem,
    ports: int,
    decide: Callable[[MultiChannelSystem], ControllabilityIndices],
) -> ControllabilityIndices | None:
    """The indices, unless the least possible one, n / ports, makes their evidence too long."""
    return decide(system) if system.n**2 <= 10**4 * max(ports, 1) else None


def _of_the_channel(system: MultiChannelSystem, name: str) -> ChannelAnswers:
    """What one channel can do."""
    from mcexact.analysis.controllability import joint_controllability, joint_observability
    from mcexact.analysis.single_channel_gains import SIDES, single_channel_gains

    return ChannelAnswers(
        name,
        joint_controllability(system, [name]),
        joint_observability(system, [name]),
        {want: single_channel_gains(system, name, want=want) for want in SIDES},
    )


def _links(plant: MultiChannelSystem) -> MinimalCommunication | LimitReached:
    """The fewest links for outputs, over and above those of the neighbor graph."""
    from mcexact.analysis.communication import minimal_communication

    try:
        return minimal_communication(plant)
    except LimitReached as reached:
        return reached


def _every_channel(system: MultiChannelSystem) -> SingleChannelGains:
    """Gains with which every channel controls and observes."""
    from mcexact.analysis.single_channel_gains import single_channel_gains

    return single_channel_gains(system)


def _of_the_subset(system: MultiChannelSystem, subset: Sequence[str]) -> dict[str, Any]:
    """The pencil of a set of channels."""
    from mcexact.analysis.closed_loop_spectrum import open_loop_spectrum
    from mcexact.analysis.complementary_subsystem import complementary_subsystem

    spectrum = open_loop_spectrum(system)
    answers: dict[str, Any] = {
        "pencil_ranks": _pencil_ranks(system, subset, spectrum.polynomial),
        "spectrum_of_A": spectrum,
    }
    if 0 < len(set(subset)) < system.m:
        answers["complementary_subsystem"] = complementary_subsystem(system, subset)
    return answers


def _pencil_ranks(
    system: MultiChannelSystem, subset: Sequence[str], polynomial: Polynomial
) -> tuple[PencilRank, ...]:
    """The rank of P_s at the roots of each irreducible factor of the polynomial of A."""
    from mcexact.analysis.pencil import pencil_rank

    return tuple(pencil_rank(system, subset, mode) for mode, _ in polynomial.factor())
