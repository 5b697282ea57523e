"""Everything that is decided about one system, together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from mcexact.errors import UsageError

if TYPE_CHECKING:
    from mcexact.analysis.completeness import Completeness
    from mcexact.analysis.controllability import JointControllability
    from mcexact.analysis.fixed_spectrum import FixedSpectrum
    from mcexact.analysis.neighbor_graph import NeighborGraphVerdict
    from mcexact.analysis.pencil import PencilRank
    from mcexact.analysis.transfer_graph import TransferGraph
    from mcexact.model.system import MultiChannelSystem

SHARING = ("outputs+states", "states")


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
        None if the plant has no neighbor graph, as the next two.
    shared_dimension_bound : SharedDimensionBound or None
    minimal_shared_dimensions : mapping from the way of sharing, or None
        None unless it was asked for.
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
    shared_dimension_bound: Any = None
    minimal_shared_dimensions: Mapping[str, Any] | None = None

    def certificates(self) -> dict[str, Any]:
        """The certificates under the names of their files, in the order of the answers."""
        answers: dict[str, Any] = {
            "joint_controllability": self.controllability,
            "joint_observability": self.observability,
            "transfer_graph": self.transfer_graph,
            "fixed_spectrum": self.fixed_spectrum,
            "completeness": self.completeness,
            "neighbor_graph": self.neighbor_graph,
            "shared_dimension_bound": self.shared_dimension_bound,
        }
        for number, rank in enumerate(self.pencil_ranks, start=1):
            answers[f"pencil_rank_{number}"] = rank
        for share, answer in (self.minimal_shared_dimensions or {}).items():
            answers[f"minimal_shared_dimensions_{share.replace('+', '_')}"] = answer
        return {
            f"{name}.json": answer.certificate
            for name, answer in answers.items()
            if getattr(answer, "certificate", None) is not None
        }


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
    heard = None
    if plant.neighbors is not None:
        from mcexact.analysis.neighbor_graph import neighbor_graph

        heard = neighbor_graph(plant)
    return Assessment(
        system=system,
        information=information,
        controllability=joint_controllability(system),
        observability=joint_observability(system),
        transfer_graph=transfer_graph(system),
        fixed_spectrum=fixed_spectrum(system),
        completeness=completeness(system),
        pencil_ranks=() if subset is None else _pencil_ranks(system, subset),
        neighbor_graph=heard,
    )


def _pencil_ranks(system: MultiChannelSystem, subset: Sequence[str]) -> tuple[PencilRank, ...]:
    """The rank of P_s at the roots of each irreducible factor of the polynomial of A."""
    from mcexact.analysis.pencil import pencil_rank
    from mcexact.exact.linear_algebra import characteristic_polynomial

    modes = characteristic_polynomial(system.A).factor()
    return tuple(pencil_rank(system, subset, mode) for mode, _ in modes)
