"""The rule of ``neighbor_graph``."""

from __future__ import annotations

import random

import networkx
import pytest

from mcexact.checker.core.reach import components
from tests.checker.handmade import COMPLETE, RING, Document, changed, checked, without

BROKEN = changed(RING, ("system.neighbors.3", []), ("claim.strongly_connected", False))
MENDED = changed(
    BROKEN,
    ("subject", [{"construction": "arcs", "added": [["1", "3"]]}]),
    ("claim.strongly_connected", True),
)

ACCEPTED = [
    ("a ring", RING),
    ("a ring that is broken", BROKEN),
    ("a ring that is mended", MENDED),
    ("a ring of derived systems", changed(RING, ("subject", [{"construction": "integrators"}]))),
]

REJECTED = [
    ("yes turned into no", changed(RING, ("claim.strongly_connected", False))),
    ("no turned into yes", changed(BROKEN, ("claim.strongly_connected", True))),
    ("a graph that is not there", without(RING, "system.neighbors")),
    ("the dual has no graph", changed(RING, ("subject", [{"construction": "dual"}]))),
    ("a witness that is not asked for", changed(RING, ("witness", {"arcs": []}))),
    ("an arc added twice", changed(MENDED, ("subject.0.added", [["1", "3"], ["1", "3"]]))),
    ("another kind", changed(COMPLETE, ("kind", "neighbor_graph"))),
]


@pytest.mark.parametrize(("reason", "document"), ACCEPTED)
def test_a_true_answer_is_accepted(reason: str, document: Document) -> None:
    verdict = checked(document)
    assert verdict.verdict == "VALID", verdict.line()


@pytest.mark.parametrize(("reason", "document"), REJECTED)
def test_anything_else_is_rejected(reason: str, document: Document) -> None:
    verdict = checked(document)
    assert verdict.verdict in ("INVALID", "MALFORMED"), verdict.line()


def test_strong_components_are_networkx_s_in_the_order_of_their_first_members() -> None:
    rng = random.Random(8)
    for _ in range(300):
        m = rng.randint(0, 7)
        arcs = [(j, i) for j in range(m) for i in range(m) if rng.random() < rng.choice([0.1, 0.3])]
        graph = networkx.DiGraph(arcs)
        graph.add_nodes_from(range(m))
        expected = sorted(sorted(part) for part in networkx.strongly_connected_components(graph))
        assert components(m, arcs) == expected
