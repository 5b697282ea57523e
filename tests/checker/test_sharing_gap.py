"""The rule of ``sharing_gap``."""

from __future__ import annotations

import itertools
import random

import pytest

from mcexact.checker.core.budget import Refused
from mcexact.checker.sharing_gap import bits, require_no_more_relays
from tests.checker.handmade import RING, Document, changed, checked, without
from tests.oracle import gaps

M = 5
NAMES = [str(i) for i in range(1, M + 1)]


def leaf(size: int) -> list[Document]:
    """A tree of one leaf: no two of so many agents send to the same agent."""
    return [{"multipliers": [[j, 1] for j in range(0, 2 * size, 2)]}]


def path() -> Document:
    """Agents in a row, each receives from the next: {1}, {3} are apart, and 2 is a relay."""
    system = {
        "time": "continuous",
        "A": [[0]],
        "channels": [{"name": name, "B": [[1]], "C": [[1]]} for name in NAMES],
        "neighbors": {str(i): [str(i + 1)] if i < M else [] for i in range(1, M + 1)},
    }
    claim = {"relays": 2, "relays_at_most": 2, "boundary": 2, "boundary_at_most": 2}
    witness = {
        "receivers": ["1", "4"],
        "senders": ["3"],
        "dominating": ["1", "3", "5"],
        "tree": leaf(3),
    }
    return changed(
        RING,
        ("kind", "sharing_gap"),
        ("system", system),
        ("claim", claim),
        ("witness", witness),
    )


ROW = changed(
    path(),
    ("claim.relays", 1),
    ("claim.relays_at_most", 2),
    ("witness.receivers", ["1"]),
    ("witness.senders", ["3", "4", "5"]),
)
"""{1} receives from {1, 2}, so that 2 relays from {3, 4, 5}."""

ACCEPTED = [
    ("sets that attain less than the bound", ROW),
    ("an exact number", changed(ROW, ("claim.relays_at_most", 1))),
    ("a number that needs no search", changed(ROW, ("claim.relays_at_most", 3))),
    ("no sets", changed(ROW, ("claim.relays", 0), ("witness.receivers", []))),
    ("fewer senders", changed(ROW, ("witness.senders", ["3"]))),
    (
        "a larger dominating set",
        changed(
            ROW,
            ("witness.dominating", ["1", "2", "3", "5"]),
            ("claim.boundary", 1),
        ),
    ),
    (
        "a weaker bound on boundaries, by a weaker leaf",
        changed(ROW, ("claim.boundary_at_most", 3), ("witness.tree", leaf(2))),
    ),
]

REJECTED = [
    ("more relays than the sets have", changed(ROW, ("claim.relays", 2))),
    ("fewer relays than the sets have", changed(ROW, ("claim.relays", 0))),
    ("a bound that sets exceed", changed(ROW, ("claim.relays_at_most", 0))),
    (
        "sets that are not apart",
        changed(ROW, ("witness.senders", ["2", "3"])),
    ),
    (
        "an agent that receives nothing from the senders",
        changed(ROW, ("witness.senders", ["4"])),
    ),
    (
        "an agent that sends nothing to the receivers",
        changed(ROW, ("witness.receivers", ["2"])),
    ),
    ("a set that does not dominate", changed(ROW, ("witness.dominating", ["1", "2", "3"]))),
    ("another number of agents outside", changed(ROW, ("claim.boundary", 3))),
    ("a smaller bound than the tree proves", changed(ROW, ("claim.boundary_at_most", 1))),
    ("a leaf with one agent twice", changed(ROW, ("witness.tree", [{"multipliers": [[0, 3]]}]))),
    ("no tree", changed(ROW, ("witness.tree", []))),
    ("a set out of order", changed(ROW, ("witness.senders", ["4", "3"]))),
    ("an agent that is not there", changed(ROW, ("witness.senders", ["6"]))),
    ("a negative number", changed(ROW, ("claim.relays", -1))),
    ("a number that is true", changed(ROW, ("claim.relays", True))),
    ("a graph that is not there", without(ROW, "system.neighbors")),
    ("a witness without its tree", without(ROW, "witness.tree")),
    ("the dual has no graph", changed(ROW, ("subject", [{"construction": "dual"}]))),
]


@pytest.mark.parametrize(("reason", "document"), ACCEPTED)
def test_a_true_answer_is_accepted(reason: str, document: Document) -> None:
    verdict = checked(document)
    assert verdict.verdict == "VALID", verdict.line()


@pytest.mark.parametrize(("reason", "document"), REJECTED)
def test_anything_else_is_rejected(reason: str, document: Document) -> None:
    verdict = checked(document)
    assert verdict.verdict in ("INVALID", "MALFORMED"), verdict.line()


@pytest.mark.parametrize("m", [2, 3])
def test_the_search_refuses_a_number_iff_two_sets_have_more_relays(m: int) -> None:
    for graph, most in itertools.product(gaps.all_graphs(m), range(m)):
        right = gaps.relay_number_of_all_pairs(graph) <= most
        try:
            require_no_more_relays([bits(N) for N in graph], most)
        except Refused:
            assert not right
        else:
            assert right


def test_the_search_agrees_with_enumeration_on_graphs_of_five() -> None:
    for seed in range(150):
        graph = gaps.drawn_graph(random.Random(seed), 5)
        true = gaps.relay_number(graph)
        require_no_more_relays([bits(N) for N in graph], true)
        if true:
            with pytest.raises(Refused):
                require_no_more_relays([bits(N) for N in graph], true - 1)
