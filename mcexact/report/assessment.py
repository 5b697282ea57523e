"""Everything that is decided about one system, together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from mcexact.errors import LimitReached, UsageError

if TYPE_CHECKING:
    from mcexact.analysis.allocation import SharedDimensionBound, SharedDimensions
    from mcexact.analysis.completeness import Completeness
    from mcexact.analysis.controllability import JointControllability
    from mcexact.analysis.fixed_spectrum import FixedSpectrum
    from mcexact.analysis.neighbor_graph import NeighborGraphVerdict
    from mcexact.analysis.pencil import PencilRank
    from mcexact.analysis.transfer_graph import TransferGraph
    from mcexact.derived.extended import Share
    from mcexact.model.system import MultiChannelSystem

SHARING: tuple[Share, ...] = ("outputs+states", "states")


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
    pencil_ranks : tuple of PencilRank
        For the subset that was asked about, at every mode of A.
    neighbor_graph : NeighborGraphVerdict or None
        None if the plant has no neighbor graph.
    shared_dimension_bounds : mapping from the way of sharing to SharedDimensionBound
        Empty if the plant has no neighbor graph.
    minimal_shared_dimensions : mapping from the way of sharing to SharedDimensions, or None
        None unless it was asked for; a `LimitReached` where the node limit was reached.
    """

    system: MultiChannelSystem
    information: str
    controllability: JointControllability
    observability: JointControllability
    transfer_graph: TransferGraph
    fixed_spectrum: FixedSpectrum
    completeness: Completeness
    pencil_ranks: tuple[PencilRank, ...] = ()
    neighbor_graph: NeighborGraphVerdict | None = None
    shared_dimension_bounds: Mapping[Share, SharedDimensionBound] = field(default_factory=dict)
    minimal_shared_dimensions: Mapping[Share, SharedDimensions | LimitReached] | None = None

    def certificates(self) -> dict[str, Any]:
        """The certificates under the names of their files, in the order of the answers."""
        answers: dict[str, Any] = {
            "joint_controllability": self.controllability,
            "joint_observability": self.observability,
            "transfer_graph": self.transfer_graph,
            "fixed_spectrum": self.fixed_spectrum,
            "completeness": self.completeness,
            "neighbor_graph": self.neighbor_graph,
        }
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
    minimal: bool = False,
) -> Assessment:
    """Decide everything that applies to a plant.

    Parameters
    ----------
    plant : MultiChannelSystem
    information : {"own", "outputs"}
        What agent i feeds back: y_i, or the y_j of all j in N_i.
    subset : sequence of str, optional
        Names of channels s: the rank of P_s at every mode of A is computed, too.
    minimal : bool
        Solve for the least dimensions that agents must share, too.

    Returns
    -------
    Assessment

    Raises
    ------
    UsageError
        If the question needs a neighbor graph and the plant has none.
    """
    from mcexact.analysis.completeness import completeness
    from mcexact.analysis.controllability import joint_controllability, joint_observability
    from mcexact.analysis.fixed_spectrum import fixed_spectrum
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
    spectrum = fixed_spectrum(system)
    spectrum = fixed_spectrum(system)
    return Assessment(
        system=system,
        information=information,
        controllability=joint_controllability(system),
        observability=joint_observability(system),
        transfer_graph=transfer_graph(system),
        fixed_spectrum=spectrum,
        completeness=completeness(system, spectrum=spectrum),
        pencil_ranks=() if subset is None else _pencil_ranks(system, subset),
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


def _pencil_ranks(system: MultiChannelSystem, subset: Sequence[str]) -> tuple[PencilRank, ...]:
    """The rank of P_s at the roots of each irreducible factor of the polynomial of A."""
    from mcexact.analysis.pencil import pencil_rank
    from mcexact.exact.linear_algebra import characteristic_polynomial

    modes = characteristic_polynomial(system.A).factor()
    return tuple(pencil_rank(system, subset, mode) for mode, _ in modes)
