"""The rule of ``shared_dimensions``."""

from __future__ import annotations

from typing import Any

import pytest

from mcexact.analysis.sharing import minimal_shared_dimensions
from mcexact.answer.protocol import document
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import read_plant
from mcexact.checker.sharing import read_cut
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from tests.checker.handmade import Document, changed, checked, matrix, plant
from tests.checker.polynomials import by_polynomials, generous
from tests.checker.tables import accepts, rejects
from tests.wording import says

PLANT = gallery.load("liu2020-3ch-no-communication")
RING = NeighborGraph.ring(PLANT.names)
SQUARE = MultiChannelSystem(
    [[0, 0], [0, 0]],
    [[[1], [0]], [[0], [1]]],
    [[[1, 0]], [[0, 1]]],
    neighbors={"1": ["2"], "2": ["1"]},
)


def by_a_tree(found: Document) -> Document:
    """The same with a branch tree of one leaf, whose multipliers are those of the nested sets."""
    [node] = found["witness"]["tree"]
    return changed(found, ("witness.tree", [{"multipliers": node["nested"]}]))


ROW = MultiChannelSystem(
    [[1]],
    [[[1]], [[0]], [[0]], [[0]], [[0]]],
    [[[0]], [[0]], [[0]], [[0]], [[1]]],
    neighbors={"1": ["2"], "2": ["3"], "3": ["4"], "4": ["5"]},
)
"""Agents in a row: what the last measures has to reach the first, which alone controls the mode."""

NESTED = document(minimal_shared_dimensions(ROW))
PRICED = document(minimal_shared_dimensions(ROW, costs=[1, 2, 1, "1/2", 1]))
BOTH = by_a_tree(document(minimal_shared_dimensions(PLANT, RING)))
STATES = by_a_tree(document(minimal_shared_dimensions(PLANT, RING, "states")))
MOVED = by_a_tree(by_polynomials(minimal_shared_dimensions, PLANT, RING, "states"))
CONNECTED = by_polynomials(
    minimal_shared_dimensions, SQUARE, share="states", free_assignability=True
)
NOTHING = document(minimal_shared_dimensions(PLANT, NeighborGraph.empty(PLANT.names)))
FREE = document(minimal_shared_dimensions(SQUARE, share="states", free_assignability=True))
STABLE = by_a_tree(
    document(minimal_shared_dimensions(PLANT, RING, "states", rate=1, costs=[2, 1, "1/3"]))
)
SPLIT: list[Document] = [{"agent": "1", "at_most": 0}, {"violated": 0}, {"violated": 0}]

WITHIN = document(generous(minimal_shared_dimensions(PLANT, RING)))
"""One state of each agent and one more of agent 3, at a cost of 4, where 1 is the least."""
CHAIN_WITHIN = document(generous(minimal_shared_dimensions(ROW)))

DECAYS = changed(
    NOTHING,
    ("system.A", [[-2, 0, 0], [0, -2, 0], [0, 1, -2]]),
    ("witness.cuts.0.polynomial", [2, 1]),
)
"""The fixed mode of the paper's example, moved to −2: nothing makes it not fixed."""

ACCEPTED = [
    ("nothing suffices for a mode that decays", DECAYS),
    ("nor where it may decay less", changed(DECAYS, ("claim.bound", 2))),
    ("the paper's example, outputs and sub-states", BOTH),
    ("the paper's example, sub-states alone", STATES),
    ("the same by two polynomials", MOVED),
    ("nothing suffices without a graph", NOTHING),
    ("a connected graph required as well", FREE),
    ("the same by two polynomials", CONNECTED),
    ("another modulus for the edges", changed(FREE, ("witness.absence.modulus", 15))),
    ("only modes beyond a rate, at other prices", STABLE),
    ("more split than needed", changed(
        STATES,
        ("witness.tree", [{"agent": "2", "at_most": 5}, *2 * STATES["witness"]["tree"]]),
    )),
    ("a tree deeper than a document may be", changed(
        STATES,
        ("witness.tree", [
            *({"agent": "2", "at_most": k} for k in range(100, 0, -1)),
            *101 * STATES["witness"]["tree"],
        ]),
    )),
    ("dimensions that suffice, with a lower bound", WITHIN),
    ("the same bound by a tree", by_a_tree(WITHIN)),
    ("a lower bound below what is proved", changed(WITHIN, ("claim.at_least", "1/2"))),
    ("a lower bound of 0", changed(WITHIN, ("claim.at_least", 0), ("witness.tree.0.nested", []))),
    ("a lower bound by nested sets", CHAIN_WITHIN),
    ("nested sets", NESTED),
    ("nested sets with multiplicities", PRICED),
    ("the same sets in a tree", by_a_tree(NESTED)),
    ("nested sets below upper bounds, which they need not", changed(
        NESTED, ("claim.upper", [0, 1, 1, 1, 0])
    )),
    ("an upper bound that does not bind", changed(BOTH, ("claim.upper", [0, 0, 1]))),
]  # fmt: skip


def impossible(sources: list[str], X: list[list[int]]) -> tuple[tuple[str, Any], ...]:
    """What a cut proves behind which no agent has anything to share."""
    subset = [name for name in ("1", "2") if name not in sources]
    rows = X or [[], []]
    zero = {"from": sources, "X": matrix(*rows), "pivots": list(range(len(rows[0])))}
    return (
        ("claim.feasible", False),
        ("claim.dimensions", None),
        ("claim.cost", None),
        ("witness.absence", None),
        ("witness.cuts", [{"subset": subset, "zero": zero}]),
        ("witness.tree", [{"violated": 0}]),
    )


REJECTED = [
    ("a lower bound above what is proved", WITHIN, ("claim.at_least", 2)),
    ("the same by a tree", by_a_tree(WITHIN), ("claim.at_least", 2)),
    ("a lower bound as large as the cost", BOTH, ("claim.at_least", 1)),
    ("a lower bound above the cost", BOTH, ("claim.at_least", 2)),
    ("a negative lower bound", WITHIN, ("claim.at_least", -1)),
    ("a lower bound of null", BOTH, ("claim.at_least", None)),
    ("a lower bound in words", WITHIN, ("claim.at_least", "one")),
    ("the least, by the proof of a lower bound", changed(WITHIN), ("claim.cost", 1)),
    ("a lower bound where nothing suffices", NOTHING, ("claim.at_least", 0)),
    ("a lower bound of a set left out", CHAIN_WITHIN, ("witness.tree.0.nested", [[0, 1], [2, 1]])),
    ("nested sets, the largest first", NESTED, ("witness.tree.0.nested", [[2, 1], [1, 1], [0, 1]])),
    ("one nested set three times", NESTED, ("witness.tree.0.nested", [[0, 1], [0, 1], [0, 1]])),
    ("a nested set left out", NESTED, ("witness.tree.0.nested", [[0, 1], [2, 1]])),
    ("no nested set", NESTED, ("witness.tree.0.nested", [])),
    ("a nested set for more than an agent costs", NESTED, ("witness.tree.0.nested", [[0, 3]])),
    ("multipliers above the price by half", PRICED, ("witness.tree.0.nested.0.1", "5/2")),
    ("the prices of others", PRICED, ("claim.costs", [1, 1, 2, 1, 1])),
    ("a multiplier of 0", NESTED, ("witness.tree.0.nested.0.1", 0)),
    ("a negative multiplier of a nested set", NESTED, (
        "witness.tree.0.nested", [[0, 1], [1, -1], [2, 3]]
    )),
    ("a nested set that is not there", NESTED, ("witness.tree.0.nested.2.0", 3)),
    ("a nested set before the first", NESTED, ("witness.tree.0.nested.0.0", -1)),
    ("a nested set by its name", NESTED, ("witness.tree.0.nested.0.0", "1")),
    ("nested sets and a leaf", NESTED, ("witness.tree", [
        *NESTED["witness"]["tree"], {"multipliers": []}
    ])),
    ("nested sets in a branch", NESTED, ("witness.tree", [
        {"agent": "1", "at_most": 0}, *2 * NESTED["witness"]["tree"]
    ])),
    ("nested sets and a cut at once", NESTED, ("witness.tree.0.violated", 0)),
    ("nested sets for a connected graph", NESTED, ("claim.free_assignability", True)),
    ("nested sets where nothing suffices", NESTED, (
        ("claim.feasible", False), ("claim.dimensions", None), ("claim.cost", None),
        ("witness.absence", None),
    )),
    ("more dimensions than the nested sets prove", NESTED, (
        ("claim.dimensions", [0, 1, 1, 1, 1]), ("claim.cost", 4)
    )),
    ("a set that another one crosses", NESTED, ("witness.cuts.1.subset", ["2", "3"])),
    ("a node that is no object", NESTED, ("witness.tree", ["nested"])),
    ("a mode that may stay where it is", DECAYS, ("claim.bound", 1)),
    ("an unknown way of sharing, in which nothing suffices", NOTHING, ("claim.share", "outputs")),
    ("a cut of connectivity that something crosses", FREE, ("system.channels.1.C", [[1, 1]])),
    ("a cut around everyone", FREE, impossible([], [])),
    ("a cut around nobody", FREE, impossible(["1", "2"], [[1, 0], [0, 1]])),
    ("a price of nothing for what costs something", STATES, ("claim.cost", 0)),
    ("an optimum that is too high", BOTH, ("claim.dimensions", [1, 0, 1])),
    ("dimensions that leave the mode fixed", BOTH, ("claim.dimensions", [1, 0, 0])),
    ("the mode left fixed, at its own cost", STATES, ("claim.dimensions", [0, 0, 1])),
    ("a cost that is not that of the dimensions", BOTH, ("claim.cost", 0)),
    ("an upper bound that the dimensions exceed", BOTH, ("claim.upper", [None, None, 0])),
    ("free of charge", BOTH, ("claim.costs.0", 0)),
    ("a negative price", BOTH, ("claim.costs.0", -1)),
    ("another price", STABLE, ("claim.costs.0", 3)),
    ("a cut for another subset", STATES, ("witness.cuts.0.subset", ["1"])),
    ("a cut that demands too much", STATES, ("witness.cuts.0.deficiency", 2)),
    ("deg p = 0", STATES, ("witness.cuts.0.polynomial", [1])),
    ("no cut at all", STATES, ("witness.cuts", [])),
    ("a tree without proof", STATES, ("witness.tree", [{"multipliers": []}])),
    ("no tree", STATES, ("witness.tree", [])),
    ("a leaf too many", STATES, ("witness.tree", 2 * STATES["witness"]["tree"])),
    ("a violated cut that is not violated", STATES, ("witness.tree", [{"violated": 0}])),
    ("a negative multiplier", STATES, ("witness.tree.0.multipliers.0.1", -1)),
    ("the number of a cut that is not there", STATES, ("witness.tree.0.multipliers.0.0", 2)),
    ("a negative number", STATES, ("witness.tree.0.multipliers.0.0", -1)),
    ("a split without leaves", STATES, ("witness.tree", SPLIT[:1])),
    ("a split without its second leaf", STATES, ("witness.tree", SPLIT[:2])),
    ("leaves that prove nothing", STATES, ("witness.tree", SPLIT)),
    ("a split on nobody", NOTHING, ("witness.tree", [{"agent": "7", "at_most": 0}, *SPLIT[1:]])),
    ("the other way of sharing", STATES, ("claim.share", "outputs+states")),
    ("an unknown way of sharing", STATES, ("claim.share", "wishes")),
    ("a rate that the mode does not violate", STABLE, ("claim.bound", -2)),
    ("possible after all", NOTHING, ("claim.feasible", True)),
    ("impossible after all", BOTH, ("claim.feasible", False)),
    ("a mode allowed that violates the bound", MOVED, ("witness.absence.allowed", [[[-1, 1], 1]])),
    ("gains of zeros", MOVED, (
        "witness.absence.gains",
        [{"denominator": 1, "entries": [[0 for _ in row] for row in gain["entries"]]}
         for gain in MOVED["witness"]["absence"]["gains"]],
    )),
    ("modulus 1", MOVED, ("witness.absence.modulus", 1)),
    ("modulus 1 of the sequence", STATES, ("witness.absence.blocks.0.evidence.modulus", 1)),
    ("modulus 1 for the edges", FREE, ("witness.absence.modulus", 1)),
    ("no modulus for the edges", FREE, ("witness.absence.modulus", None), "INVALID"),
    ("a modulus for no edges", STATES, ("witness.absence.modulus", 7)),
    ("arcs forgotten", CONNECTED, ("witness.absence.arcs", None)),
    ("arcs and their modulus forgotten", FREE, (
        ("witness.absence.arcs", None), ("witness.absence.modulus", None),
    )),
    ("arcs that do not connect", CONNECTED, ("witness.absence.arcs", [])),
    ("arcs that do not connect, by a sequence", FREE, ("witness.absence.arcs", [])),
    ("a cut of connectivity for no such claim", FREE, ("claim.free_assignability", False)),
    ("a cut of connectivity for everyone", FREE, ("witness.cuts.0.subset", ["1", "2"])),
    ("another plant", STATES, ("system.A.2.1", 0)),
    ("one link less", STATES, ("system.neighbors.2", [])),
]  # fmt: skip


test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)


def test_the_statement_says_whether_a_connected_graph_is_required() -> None:
    for each, required in ((FREE, True), (BOTH, False), (STATES, False), (NOTHING, False)):
        said = checked(each).statement
        assert says(said, "connected") if required else "strongly connected" not in said


def test_a_mode_is_a_root_of_a_polynomial_that_is_not_constant() -> None:
    verdict = checked(changed(STATES, ("witness.cuts.0.polynomial", [1])))
    assert (verdict.verdict, verdict.place) == ("MALFORMED", "witness.cuts[0]")


@pytest.mark.parametrize("C", [[[1, 0]], [[0, 0]], [[0, 1]]])
def test_a_cut_of_connectivity_is_crossed_by_nothing_that_any_agent_sees(C: list[Any]) -> None:
    """Channel 3 moves the second state, which channels 1 and 2 must not see."""
    outside = ([[1], [0]], [[1, 0]])
    for ports in ((outside, ([[0], [0]], C)), (([[0], [0]], C), outside)):
        base = read_plant(plant([[1, 0], [0, 2]], *ports, ([[0], [1]], [[0, 1]])))
        zero = {"from": ["3"], "X": matrix([0], [1]), "pivots": [1]}
        entry = {"subset": ["1", "2"], "zero": zero}
        if C[0][1]:
            with pytest.raises(Refused) as refused:
                read_cut(entry, "cut", base, None, free=True)
            assert (refused.value.verdict, refused.value.code) == ("INVALID", "identity")
        else:
            assert read_cut(entry, "cut", base, None, free=True) == ([0, 1], 1)
