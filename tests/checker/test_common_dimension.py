"""The rule of ``common_dimension``, and its answers against enumeration of all subsets."""

from __future__ import annotations

import hashlib
import json
import random
from collections import Counter
from fractions import Fraction
from typing import Any

import pytest

from mcexact.analysis.sharing import absence, common_dimension, shared_dimension_bound
from mcexact.answer.protocol import document
from mcexact.derived.constructions import extended_system
from mcexact.derived.modular import generator
from mcexact.errors import UsageError
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import read_system
from mcexact.model.text import plain
from tests.assurance.campaigns.allocation import drawn, drawn_neighbors
from tests.checker.handmade import CHAIN, GRAPH, Document, certificate, changed, checked
from tests.checker.polynomials import by_polynomials
from tests.checker.tables import accepts, rejects
from tests.oracle.allocation import Neighbors, demands
from tests.oracle.draws import exact
from tests.oracle.enumeration import PlainSystem
from tests.wording import refusal

SHARES = ("outputs+states", "states")


def enumerated(small: PlainSystem, heard: Neighbors, share: str) -> int | None:
    """The largest ⌈δ_s(λ) / |N_s∖s|⌉ over all s and λ; None if some N_s∖s with δ_s > 0 is empty."""
    needs = demands(small, heard, outputs=share == "outputs+states")
    if any(not around for around, _ in needs):
        return None
    return max((-(-demand // len(around)) for around, demand in needs), default=0)


def starved(rng: random.Random) -> tuple[PlainSystem, list[list[int]]]:
    """Two agents drive everything, two others measure everything, over a dense connected graph."""
    n, m = rng.randint(4, 6), rng.randint(4, 5)
    A = [[Fraction(int(i == j > 3)) for j in range(n)] for i in range(n)]
    A[n - 2][n - 1] += rng.choice([0, 0, 1])
    order = rng.sample(range(m), m)
    unit = [[Fraction(int(i == k)) for k in range(n)] for i in range(n)]
    drives, sees = ([rng.choice(pair) for _ in range(n)] for pair in (order[:2], order[2:4]))
    B = [[[row[k] for k in range(n) if drives[k] == i] for row in unit] for i in range(m)]
    C = [[unit[k] for k in range(n) if sees[k] == i] for i in range(m)]
    rng.shuffle(order)
    after = dict(zip(order, order[1:] + order[:1], strict=True))
    heard = [{i, after[i], *(j for j in range(m) if rng.random() < 0.4)} for i in range(m)]
    return PlainSystem(A, B, C), [sorted(N_i) for N_i in heard]


PLANT = gallery.load("liu2020-3ch-no-communication")
RING = NeighborGraph.ring(PLANT.names)
UNITS = [[int(i == k) for k in range(4)] for i in range(4)]
BETWEEN = MultiChannelSystem(
    [[0] * 4] * 4,
    [UNITS, *3 * [[[]] * 4]],
    [*3 * [[]], UNITS],
    neighbors={"1": ["2", "3"], "2": ["4"], "3": ["4"], "4": ["1"]},
)
"""Agent 1 drives four integrators, agent 4 measures them, and agents 2 and 3 stand between."""


def sharing(system: MultiChannelSystem, *arguments: Any) -> Document:
    """The certificate as a document."""
    return document(common_dimension(system, *arguments))


def enough(made: Document, k: int) -> Document:
    """The evidence that k dimensions of each agent are enough."""
    plant = read_system(json.dumps({"format": "mcexact-system/1", **made["system"]}))
    share = made["claim"]["share"]
    extended = extended_system(plant, [k] * plant.m, share)
    found: Document = plain(absence(extended, None, generator(extended, "common_dimension")))
    return found


BOTH = sharing(PLANT, RING)
MOVED = by_polynomials(common_dimension, PLANT, RING)
STATES = sharing(PLANT, RING, "states")
NOTHING = sharing(PLANT, NeighborGraph.empty(PLANT.names))
FREE = sharing(PLANT, NeighborGraph.complete(PLANT.names))
HALVES = sharing(BETWEEN)
CUT = HALVES["witness"]["cut"]
WIDER = ("system.neighbors.1", ["2", "3", "4"])

ACCEPTED = [
    ("the paper's example, outputs and sub-states", BOTH),
    ("the paper's example by two polynomials", MOVED),
    ("the paper's example, sub-states alone", STATES),
    ("nothing suffices without a graph", NOTHING),
    ("outputs suffice where everybody hears everybody", FREE),
    ("two agents between, half of the bound each", HALVES),
    ("a larger cut around the same subset is claimed smaller", changed(
        HALVES, ("witness.cut.deficiency", 3)
    )),
]  # fmt: skip

PROOF = "witness.absence.blocks.0.evidence"
REJECTED = [
    ("enough, but not the least", BOTH, (
        ("claim.dimension", 2), ("witness.absence", enough(BOTH, 2)),
    ), "INVALID"),
    ("Theorem 2's bound, which half of it meets", HALVES, (
        ("claim.dimension", 4), ("witness.absence", enough(HALVES, 4)),
    ), "INVALID"),
    ("one more than the least", HALVES, (
        ("claim.dimension", 3), ("witness.absence", enough(HALVES, 3)),
    ), "INVALID"),
    ("less than the least", HALVES, ("claim.dimension", 1)),
    ("outputs alone", BOTH, (("claim.dimension", 0), ("witness.cut", None))),
    ("outputs alone, and a cut", BOTH, ("claim.dimension", 0)),
    ("more than outputs where these are enough", FREE, (
        ("claim.dimension", 1), ("witness.absence", enough(FREE, 1)),
    ), "INVALID"),
    ("the same, by the cut of another graph", FREE, (
        ("claim.dimension", 1), ("witness.absence", enough(FREE, 1)),
        ("witness.cut", BOTH["witness"]["cut"]),
    ), "INVALID"),
    ("a cut where outputs are enough", FREE, ("witness.cut", BOTH["witness"]["cut"]), "INVALID"),
    ("no cut", BOTH, ("witness.cut", None), "INVALID"),
    ("a cut that demands too little", HALVES, ("witness.cut.deficiency", 2), "INVALID"),
    ("a cut that demands too much", HALVES, ("witness.cut.deficiency", 5), "INVALID"),
    ("a cut that demands nothing", HALVES, ("witness.cut.deficiency", 0)),
    ("a cut around another subset", HALVES, ("witness.cut.subset", ["1", "2"]), "INVALID"),
    ("a cut around nobody", HALVES, ("witness.cut.subset", []), "INVALID"),
    ("a cut around a stranger", HALVES, ("witness.cut.subset", ["5"])),
    ("a cut at a number that is no mode", HALVES, ("witness.cut.polynomial", [-1, 1]), "INVALID"),
    ("a cut at no number", HALVES, ("witness.cut.polynomial", [1])),
    ("a cut by a zero transfer", HALVES, (
        "witness.cut", {"subset": ["1"], "zero": {"from": ["2"], "X": [], "pivots": []}},
    )),
    ("a subspace that is none", HALVES, ("witness.cut.subspace.U.coefficients.0.0.0", 2)),
    ("no subspace", HALVES, ("witness.cut.subspace", None)),
    ("no evidence that it is enough", BOTH, ("witness.absence", None)),
    ("a mode allowed to stay", MOVED, ("witness.absence.allowed", [[[-1, 1], 3]]), "INVALID"),
    ("a mode allowed to stay besides", BOTH, ("witness.absence.allowed", []), "MALFORMED"),
    ("gains of zeros", MOVED, (
        "witness.absence.gains",
        [{"denominator": 1, "entries": [[0 for _ in row] for row in gain["entries"]]}
         for gain in MOVED["witness"]["absence"]["gains"]],
    ), "INVALID"),
    ("a channel of other sizes", BOTH, (f"{PROOF}.channel", "3"), "MALFORMED"),
    ("a sequence of fewer degrees", BOTH, (
        (f"{PROOF}.recurrence", [1]),
        (f"{PROOF}.cofactors", [[], [1]]),
    ), "INVALID"),
    ("modulus 1", MOVED, ("witness.absence.modulus", 1)),
    ("modulus 1 of the sequence", BOTH, (f"{PROOF}.modulus", 1), "INVALID"),
    ("a modulus for no edges", BOTH, ("witness.absence.modulus", 7), "INVALID"),
    ("arcs nobody asked for", MOVED, ("witness.absence.arcs", [])),
    ("arcs and a modulus nobody asked for", BOTH, (
        ("witness.absence.arcs", []), ("witness.absence.modulus", 7),
    ), "INVALID"),
    ("the other way of sharing", STATES, ("claim.share", "outputs+states")),
    ("an unknown way of sharing", BOTH, ("claim.share", "outputs")),
    ("a dimension that is true", BOTH, ("claim.dimension", True), "MALFORMED"),
    ("a negative dimension", BOTH, ("claim.dimension", -1), "MALFORMED"),
    ("a dimension in words", BOTH, ("claim.dimension", "1"), "MALFORMED"),
    ("a dimension that no machine holds", BOTH, ("claim.dimension", 10**9), "INCOMPLETE"),
    ("possible after all", NOTHING, ("claim.feasible", True)),
    ("possible after all, with a number", NOTHING, (
        ("claim.feasible", True), ("claim.dimension", 1),
    )),
    ("impossible after all", BOTH, (
        ("claim.feasible", False), ("claim.dimension", None), ("witness.absence", None),
    ), "INVALID"),
    ("impossible, and a dimension", NOTHING, ("claim.dimension", 1), "INVALID"),
    ("impossible, and evidence that it is not", NOTHING, (
        "witness.absence", BOTH["witness"]["absence"],
    ), "INVALID"),
    ("impossible for no reason", NOTHING, ("witness.cut", None), "INVALID"),
    ("somebody hears after all", NOTHING, ("system.neighbors.2", ["1"])),
    ("one link more", HALVES, WIDER),
    ("one link less", HALVES, ("system.neighbors.1", ["2"])),
    ("no graph", HALVES, ("system.neighbors", {})),
    ("another plant", BOTH, ("system.A.2.1", 0)),
    ("another subject", BOTH, ("subject", [{"construction": "augmented_outputs"}])),
    ("a claim besides", BOTH, ("claim.cost", 1), "MALFORMED"),
    ("a witness besides", BOTH, ("witness.tree", []), "MALFORMED"),
]  # fmt: skip

test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)


def test_two_agents_between_can_share_half_of_the_bound_each() -> None:
    found = common_dimension(BETWEEN)
    assert shared_dimension_bound(BETWEEN).deficiency == 4
    assert found.dimension == 2 and found.feasible
    assert found.cut is not None and found.cut.subset == ("1",)


@pytest.mark.parametrize("seed", range(4))
def test_drawn_answers_are_those_of_enumeration_and_their_certificates_valid(seed: int) -> None:
    rng, seen = random.Random(seed), Counter[object]()
    for number in range(60):
        small = drawn(rng, 5, 4)
        heard = drawn_neighbors(rng, small.m)
        if number % 3:
            small, heard = starved(rng)
        system = exact(small, rng.choice(["continuous", "discrete"]))
        graph = NeighborGraph(system.names, heard)
        share: Any = rng.choice(SHARES)
        found = common_dimension(system, graph, share)
        least = enumerated(small, heard, share)
        assert (found.dimension, found.feasible) == (least, least is not None)
        assert checked(document(found)).verdict == "VALID"
        seen[share] += 1
        if graph.is_strongly_connected() and least is not None:
            seen[shared_dimension_bound(system, graph, share).deficiency, least] += 1
        seen["infeasible"] += least is None
    assert all(seen[share] for share in SHARES) and seen["infeasible"] and seen[4, 2]


def test_what_makes_no_sense_is_refused() -> None:
    with refusal(UsageError):
        common_dimension(PLANT)
    with pytest.raises(UsageError, match="give the plant"):
        common_dimension(extended_system(PLANT, [1, 1, 1], graph=RING))


@pytest.mark.parametrize(
    ("made", "digest"),
    [
        (BOTH, "4a9560c8c34ff358"),
        (STATES, "072a84e5ece8181c"),
        (MOVED, "c53a28c54d2d81fc"),
        (NOTHING, "3667fe8d7b085b3d"),
        (HALVES, "6b7fbbb8459022dd"),
    ],
)
def test_the_bytes_stay(made: Document, digest: str) -> None:
    text = json.dumps(made, sort_keys=True, separators=(",", ":"))
    assert hashlib.sha256(text.encode("ascii")).hexdigest()[:16] == digest


def test_channels_that_nothing_reaches_are_no_reason_for_a_fixed_mode() -> None:
    zero = GRAPH["witness"]["zeros"][0]
    nothing = certificate(
        "common_dimension",
        {**CHAIN, "neighbors": {"1": [], "2": []}},
        {"share": "outputs+states", "feasible": False, "dimension": None},
        {"absence": None, "cut": {"subset": ["1"], "zero": zero}},
    )
    assert checked(nothing).verdict == "MALFORMED"
