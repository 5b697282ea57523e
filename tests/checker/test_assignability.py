"""The rule of ``assignability``: components of a graph, minimal realizations, degrees."""

from __future__ import annotations

from tests.checker.handmade import (
    CHAIN,
    GRAPH,
    PAIR,
    certificate,
    changed,
    matrix,
)
from tests.checker.tables import accepts, rejects

UNIT = matrix([1, 0], [0, 1])
SPLIT = certificate(
    "assignability",
    CHAIN,
    {
        "blocks": [{"channels": ["1"], "dimension": 1}, {"channels": ["2"], "dimension": 1}],
        "fixed_degree": 0,
    },
    {
        "modulus": 7,
        "transfer_graph": {"claim": GRAPH["claim"], "witness": GRAPH["witness"]},
        "realizations": [
            {"X": UNIT, "pivots": [0, 1], "W": matrix([1, 0]), "columns": [0]},
            {"X": matrix([0], [1]), "pivots": [1], "W": matrix([1]), "columns": [0]},
        ],
    },
)
STAYS = certificate(
    "assignability",
    PAIR,
    {"blocks": [{"channels": ["1"], "dimension": 1}], "fixed_degree": 1},
    {
        "modulus": 7,
        "transfer_graph": {
            "claim": {"arcs": [["1", "1"]], "components": [["1"]], "strongly_connected": True},
            "witness": {"modulus": 7, "powers": [0], "zeros": []},
        },
        "realizations": [{"X": matrix([1], [0]), "pivots": [0], "W": matrix([1]), "columns": [0]}],
    },
)

SPREAD = changed(
    STAYS,
    ("system.channels.0.B", [[1], [1]]),
    (
        "witness.realizations.0",
        {"X": UNIT, "pivots": [0, 1], "W": matrix([1, 0]), "columns": [0]},
    ),
)
"""The input moves both modes, the output sees the first."""

ACCEPTED = [
    ("a mode that is moved and not seen", SPREAD),
    ("a chain splits in two", SPLIT),
    ("a mode that no gain moves", STAYS),
    ("zeros that no path leads to", changed(SPLIT, ("witness.transfer_graph.witness.zeros", []))),
    ("another modulus", changed(SPLIT, ("witness.modulus", 15))),
    (
        "a larger invariant subspace",
        changed(
            STAYS,
            (
                "witness.realizations.0",
                {"X": UNIT, "pivots": [0, 1], "W": matrix([1, 0]), "columns": [0]},
            ),
        ),
    ),
]

WHOLE = {"X": UNIT, "pivots": [0, 1], "W": UNIT, "columns": [0, 1]}
TOO_MUCH = (
    ("claim.blocks.0.dimension", 2),
    ("claim.fixed_degree", 0),
    ("witness.realizations.0", WHOLE),
)

REJECTED = [
    (
        "a mode that is seen and not moved",
        changed(STAYS, ("system.channels.0.C", [[1, 1]])),
        TOO_MUCH,
        "INVALID",
    ),
    (
        "a mode that is moved and not seen",
        SPREAD,
        TOO_MUCH,
        "INVALID",
    ),
    ("a degree too high", STAYS, (("claim.blocks.0.dimension", 2), ("claim.fixed_degree", 0))),
    (
        "a degree too low",
        STAYS,
        (
            ("claim.blocks.0.dimension", 0),
            ("claim.fixed_degree", 2),
            ("witness.realizations.0.W", matrix()),
            ("witness.realizations.0.columns", []),
        ),
    ),
    (
        "a realization that is not controllable",
        STAYS,
        (
            ("claim.blocks.0.dimension", 2),
            ("claim.fixed_degree", 0),
            ("witness.realizations.0", {"X": UNIT, "pivots": [0, 1], "W": UNIT, "columns": [0, 1]}),
        ),
    ),
    (
        "a realization that is not observable",
        SPLIT,
        (
            ("claim.blocks.0.dimension", 2),
            ("claim.blocks.1.dimension", 0),
            ("witness.realizations.0.W", UNIT),
            ("witness.realizations.0.columns", [0, 1]),
        ),
    ),
    ("degrees that do not sum to n", SPLIT, (("claim.fixed_degree", 1),)),
    ("a negative fixed degree", SPLIT, (("claim.fixed_degree", -1),)),
    (
        "components joined",
        SPLIT,
        (
            ("claim.blocks", [{"channels": ["1", "2"], "dimension": 2}]),
            ("witness.realizations", SPLIT["witness"]["realizations"][:1]),
        ),
    ),
    ("components in another order", SPLIT, (("claim.blocks", SPLIT["claim"]["blocks"][::-1]),)),
    (
        "a component missing",
        SPLIT,
        (
            ("claim.blocks", SPLIT["claim"]["blocks"][:1]),
            ("witness.realizations", SPLIT["witness"]["realizations"][:1]),
            ("claim.fixed_degree", 1),
        ),
    ),
    (
        "a graph with an arc too many",
        SPLIT,
        (("witness.transfer_graph.claim.arcs", [["1", "1"], ["1", "2"], ["2", "1"], ["2", "2"]]),),
    ),
    (
        "a subspace that is not invariant",
        SPLIT,
        (
            (
                "witness.realizations.0",
                {"X": matrix([1], [0]), "pivots": [0], "W": matrix([1]), "columns": [0]},
            ),
        ),
    ),
    ("W that does not follow A", SPLIT, (("witness.realizations.0.W", matrix([1, 1])),)),
    ("W without an identity", SPLIT, (("witness.realizations.0.W", matrix([2, 0])),)),
    (
        "more columns than W has rows",
        SPLIT,
        (("witness.realizations.0.columns", [0, 1]),),
        "MALFORMED",
    ),
    ("as many columns as W has rows", SPLIT, (("witness.realizations.0.columns", []),)),
    ("modulus 1", SPLIT, (("witness.modulus", 1),)),
    ("a realization missing", SPLIT, (("witness.realizations", []),)),
    ("a plant without the mode", STAYS, (("system.channels.0.B", [[1], [1]]),)),
]


test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)
