"""The rule of ``communication``."""

from __future__ import annotations

from mcexact.analysis.sharing.communication import minimal_communication
from mcexact.answer.codec import document
from mcexact.model import gallery
from mcexact.model.neighbor_graph import NeighborGraph
from tests.checker.handmade import changed
from tests.checker.tables import accepts, rejects

PLANT = gallery.load("liu2020-3ch-no-communication")
SILENT = NeighborGraph.empty(PLANT.names)
CHAIN = NeighborGraph.from_names(PLANT.names, {"1": ["2"], "3": ["1"]})

OUTPUTS = document(minimal_communication(PLANT, SILENT))
WITHOUT_GRAPH = document(minimal_communication(PLANT))
EXTENDED = document(minimal_communication(PLANT, CHAIN, dimensions=(0, 0, 1)))
BLOCKED = document(
    minimal_communication(PLANT, SILENT, forbidden=[(j, i) for j in "123" for i in "123"])
)

DECAYS = changed(
    BLOCKED,
    ("system.A", [[-2, 0, 0], [0, -2, 0], [0, 1, -2]]),
    ("witness.cuts.0.polynomial", [2, 1]),
)
"""The fixed mode of the paper's example, moved to −2."""

ACCEPTED = [
    ("no candidate for a mode that decays", DECAYS),
    ("nor where it may decay less", changed(DECAYS, ("claim.bound", 2))),
    ("outputs alone", OUTPUTS),
    ("a plant without a neighbor graph", WITHOUT_GRAPH),
    ("one more link for the extended system", EXTENDED),
    ("no candidate, no way", BLOCKED),
    ("another modulus", changed(OUTPUTS, ("witness.absence.modulus", 2**31 - 1))),
]

REJECTED = [
    ("a mode that may stay where it is", DECAYS, ("claim.bound", 1)),
    ("sub-states of no dimensions", OUTPUTS, ("claim.share", "outputs+states")),
    ("an unknown way of sharing", EXTENDED, ("claim.share", "wishes")),
    ("a price of nothing for what costs something", EXTENDED, ("claim.cost", 0)),
    ("no arc for a plant without a neighbor graph", WITHOUT_GRAPH, ("claim.added", [])),
    ("an arc that does not help", EXTENDED, ("claim.added", [["2", "3"]])),
    ("no arc at all", EXTENDED, ("claim.added", [])),
    ("an arc that is no candidate", EXTENDED, ("claim.added", [["2", "1"]])),
    ("an arc twice", EXTENDED, ("claim.added", [["3", "2"], ["3", "2"]])),
    ("a cost that is not the arcs'", EXTENDED, ("claim.cost", 2)),
    ("other dimensions", EXTENDED, ("claim.dimensions", [0, 0, 0])),
    ("dimensions for outputs alone", OUTPUTS, ("claim.dimensions", [0, 0, 0])),
    ("sub-states without dimensions", EXTENDED, ("claim.dimensions", None)),
    ("another thing carried", EXTENDED, ("claim.share", "outputs")),
    ("a candidate that the graph has", EXTENDED, ("claim.candidates.0", ["2", "1", 1])),
    ("candidates out of order", EXTENDED, ("claim.candidates", [["3", "2", 1], ["1", "2", 1]])),
    ("a free candidate", EXTENDED, ("claim.candidates.0.2", 0)),
    ("no cut", EXTENDED, ("witness.cuts", [])),
    ("deg p = 0", EXTENDED, ("witness.cuts.0.polynomial", [1])),
    ("another T", EXTENDED, ("witness.cuts.0.subspace.channels_T", ["1", "2", "3"])),
    ("a tree without proof", EXTENDED, ("witness.tree", [{"multipliers": []}])),
    ("a violated cut that is not", EXTENDED, ("witness.tree", [{"violated": 0}])),
    ("possible after all", BLOCKED, ("claim.feasible", True)),
    ("a candidate forgotten", BLOCKED, ("claim.candidates", [["1", "2", 1]])),
    ("modulus 0", OUTPUTS, ("witness.absence.modulus", 0)),
    ("another plant", OUTPUTS, ("system.A.2.1", 0)),
]


test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)


def test_a_plant_without_a_graph_gets_a_certificate_about_itself() -> None:
    assert "neighbors" not in WITHOUT_GRAPH["system"]
    assert WITHOUT_GRAPH["claim"] == OUTPUTS["claim"]
