"""Everything that is decided about one system, together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from mcexact.errors import UsageError

if TYPE_CHECKING:
    from mcexact.analysis.completeness import Completeness
    from mcexact.analysis.controllability import JointControllability
    from mcexact.analysis.fixed_spectrum import FixedSpectrum
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
    neighbor_graph: Any = None
    shared_dimension_bound: Any = None
    minimal_shared_dimensions: Mapping[str, Any] | None = None

    def certificates(self) -> dict[str, Any]:
        """The certificates under the names of their files, in the order of the answers."""
        answers = {
            "joint_controllability": self.controllability,
            "joint_observability": self.observability,
            "transfer_graph": self.transfer_graph,
            "fixed_spectrum": self.fixed_spectrum,
            "completeness": self.completeness,
            "neighbor_graph": self.neighbor_graph,
            "shared_dimension_bound": self.shared_dimension_bound,
        }
        for share, answer in (self.minimal_shared_dimensions or {}).items():
            answers[f"minimal_shared_dimensions_{share.replace('+', '_')}"] = answer
        return {
            f"{name}.json": answer.certificate
            for name, answer in answers.items()
            if getattr(answer, "certificate", None) is not None
        }


def assess(
    plant: MultiChannelSystem, *, information: str = "own", minimal: bool = False
) -> Assessment:
    """Decide everything that applies to a plant.

    Parameters
    ----------
    plant : MultiChannelSystem
    information : {"own", "outputs"}
        What agent i feeds back: y_i, or the y_j of all j in N_i.
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
    return Assessment(
        system=system,
        information=information,
        controllability=joint_controllability(system),
        observability=joint_observability(system),
        transfer_graph=transfer_graph(system),
        fixed_spectrum=fixed_spectrum(system),
        completeness=completeness(system),
    )
