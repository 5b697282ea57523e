"""The rule of ``communication``."""

from __future__ import annotations

from mcexact.analysis.sharing import minimal_communication
from mcexact.answer.protocol import document
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from tests.checker.handmade import certificate, changed, checked, layers, plant
from tests.checker.polynomials import by_polynomials
from tests.checker.tables import accepts, rejects

PLANT = gallery.load("liu2020-3ch-no-communication")
SILENT = NeighborGraph.empty(PLANT.names)
CHAIN = NeighborGraph.from_names(PLANT.names, {"1": ["2"], "3": ["1"]})

OUTPUTS = document(minimal_communication(PLANT, SILENT))
MOVED = by_polynomials(minimal_communication, PLANT, SILENT)
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

OSCILLATES = certificate(
    "communication",
    plant([[0, 1], [-1, 0]], ([[0], [0]], [[1, 0]]), ([[1], [0]], [[0, 0]])),
    BLOCKED["claim"],
    {
        "absence": None,
        "cuts": [
            {
                "polynomial": [1, 0, 1],
                "subspace": {
                    "channels_T": ["1"],
                    "U": layers([[1], [0]], [[0], [1]]),
                    "V": layers([[0]]),
                    "pivots": [0],
                },
            }
        ],
        "tree": [{"violated": 0}],
    },
)
"""Channel 1 measures an oscillator, channel 2 drives it: C_1 U = 1 + 0 x for U = (1, x)'."""

BOTH = document(
    minimal_communication(
        MultiChannelSystem(
            [[1, 0], [0, 2]],
            [[[0], [0]], [[1], [0]], [[0], [1]]],
            [[[1, 0], [0, 1]], [[0, 0]], [[0, 0]]],
        )
    )
)
"""Channel 1 measures two modes, and channels 2 and 3 drive one of them each: two links."""

TREE = [{"multipliers": [[2, 2], [3, 1]]}]
"""2 + 1 from cuts of one link each, less 1 for the first link, which is taken once at most."""

ACCEPTED = [
    ("two links for two modes", BOTH),
    ("a link is taken once at most", changed(BOTH, ("witness.tree", TREE))),
    ("an oscillation that nobody both measures and drives", OSCILLATES),
    ("no candidate for a mode that decays", DECAYS),
    ("nor where it may decay less", changed(DECAYS, ("claim.bound", 2))),
    ("outputs alone", OUTPUTS),
    ("a plant without a neighbor graph", WITHOUT_GRAPH),
    ("one more link for the extended system", EXTENDED),
    ("no candidate, no way", BLOCKED),
    ("by two polynomials", MOVED),
    ("another modulus", changed(MOVED, ("witness.absence.modulus", 2**31 - 1))),
]

REJECTED = [
    ("a link that sends only one part of an oscillation", OSCILLATES, (
        "claim.candidates", [["1", "2", 1]],
    )),
    ("the first of two links twice", BOTH, (
        "claim.added", [["1", "2"], ["1", "2"], ["1", "3"]],
    ), "INVALID"),
    ("links out of order", BOTH, ("claim.added", [["1", "3"], ["1", "2"]]), "INVALID"),
    ("a candidate twice", BOTH, (
        "claim.candidates", [["1", "2", 1], ["1", "3", 1], ["2", "1", 1], ["2", "1", 1],
                             ["2", "3", 1], ["3", "1", 1], ["3", "2", 1]],
    ), "MALFORMED"),
    ("one link of two", BOTH, (("claim.added", [["1", "2"]]), ("claim.cost", 1))),
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
    ("modulus 0", MOVED, ("witness.absence.modulus", 0)),
    ("modulus 0 of the sequence", OUTPUTS, ("witness.absence.blocks.0.evidence.modulus", 0)),
    ("another plant", OUTPUTS, ("system.A.2.1", 0)),
]  # fmt: skip


test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)


def test_a_plant_without_a_graph_gets_a_certificate_about_itself() -> None:
    assert "neighbors" not in WITHOUT_GRAPH["system"]
    assert WITHOUT_GRAPH["claim"] == OUTPUTS["claim"]


def test_a_polynomial_without_roots_is_refused_where_it_stands() -> None:
    verdict = checked(changed(EXTENDED, ("witness.cuts.0.polynomial", [1])))
    assert (verdict.verdict, verdict.place) == ("MALFORMED", "witness.cuts[0].polynomial")
