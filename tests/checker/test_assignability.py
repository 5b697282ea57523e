"""The rule of ``assignability``: components of a graph, and the degrees within them."""

from __future__ import annotations

from typing import Any

from tests.checker.handmade import (
    CHAIN,
    GRAPH,
    PAIR,
    Document,
    certificate,
    changed,
    matrix,
    plant,
)
from tests.checker.tables import accepts, rejects

UNIT = matrix([1, 0], [0, 1])


def sequence(recurrence: list[int], **others: Any) -> Document:
    """The sequence of one input and one output without feedback, of a first number 1."""
    return {
        "modulus": 7,
        "gains": [matrix([0])],
        "channel": "1",
        "inputs": [1],
        "outputs": [1],
        "recurrence": recurrence,
        "cofactors": [[1], []],
        **others,
    }


def degree(proof: Document | None, states: list[int] | None = None, **others: Any) -> Document:
    """The evidence for one component, by default with all states that matter."""
    none = {"annihilator": matrix(), "pivots": [], "kernel": matrix(), "kernel_pivots": []}
    return {"states": states, "sequence": proof, **none, **others}


ALONE = degree(sequence([0, 1]), [0])


def apart(order: list[int], arcs: Any = (), zeros: Any = (), modulus: int = 7) -> Document:
    """Components in this order, with the edges that connect each."""
    shown = {"modulus": modulus, "arcs": list(arcs), "order": order, "zeros": list(zeros)}
    return {"components": shown}


BOTH, ONE = apart([0, 1]), apart([0])
APART = certificate(
    "assignability",
    CHAIN,
    {
        "blocks": [{"channels": ["1"], "dimension": 1}, {"channels": ["2"], "dimension": 1}],
        "fixed_degree": 0,
    },
    {**BOTH, "degrees": [ALONE, degree(sequence([0, 1]), [1])]},
)
"""A chain in two parts, each by the states on its paths."""
ALL = certificate(
    "assignability",
    CHAIN,
    APART["claim"],
    {
        **BOTH,
        "degrees": [
            degree(sequence([0, 1]), kernel=matrix([0, 1]), kernel_pivots=[1]),
            degree(sequence([0, 1]), annihilator=matrix([1, 0]), pivots=[0]),
        ],
    },
)
"""The same by a state that is not observed, and by one that is not controlled."""
FIXED_MODE = certificate(
    "assignability",
    PAIR,
    {"blocks": [{"channels": ["1"], "dimension": 1}], "fixed_degree": 1},
    {**ONE, "degrees": [degree(sequence([6, 1]), annihilator=matrix([0, 1]), pivots=[1])]},
)
MOVED = changed(
    FIXED_MODE,
    ("system.channels.0.B", [[1], [1]]),
    ("witness.degrees.0", degree(sequence([6, 1]), kernel=matrix([0, 1]), kernel_pivots=[1])),
)
"""The input moves both modes, the output sees the first."""
WHOLE_CHAIN = certificate(
    "assignability",
    plant([[0, 0], [1, 0]], ([[1], [0]], [[0, 1]])),
    {"blocks": [{"channels": ["1"], "dimension": 2}], "fixed_degree": 0},
    # s = 0, 1, 0: x² s = 1
    {**ONE, "degrees": [degree(sequence([0, 0, 1]))]},
)
UNUSED = certificate(
    "assignability",
    plant([[1]], ([[0]], [[1]])),
    {"blocks": [{"channels": ["1"], "dimension": 0}], "fixed_degree": 1},
    {**ONE, "degrees": [degree(None, [])]},
)
FOUR = certificate(
    "assignability",
    plant(
        [[0, 0, 0, 0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]],
        ([[1], [0], [0], [0]], [[0, 0, 0, 1]]),
    ),
    {"blocks": [{"channels": ["1"], "dimension": 4}], "fixed_degree": 0},
    {**ONE, "degrees": [degree(sequence([0, 0, 0, 0, 1]))]},
)
"""A chain of four states, the first of which is driven and the last measured."""
NO_DEGREE = (("claim.blocks.0.dimension", 0), ("claim.fixed_degree", 4))

NOT_SEEN = degree(None, kernel=matrix([1, 0], [0, 1]), kernel_pivots=[0, 1])
NOT_MOVED = degree(None, [0, 2], annihilator=matrix([1, 0], [0, 1]), pivots=[0, 1])
SMALLER = (("claim.blocks.0.dimension", 0), ("claim.fixed_degree", 2))

LOOP = certificate(
    "assignability",
    plant([[0, 1], [1, 0]], ([[1], [0]], [[1, 0]]), ([[0], [1]], [[0, 1]])),
    {"blocks": [{"channels": ["1", "2"], "dimension": 2}], "fixed_degree": 0},
    {
        **apart([0], [["1", "2", 1], ["2", "1", 1]]),
        "degrees": [
            degree(
                # y A x, y A² x, … = 1, 0, 1 for x = e_1, y = e_2'
                sequence([6, 0, 1], gains=[matrix([0, 0], [0, 0])], inputs=[1, 0], outputs=[0, 1])
            )
        ],
    },
)
"""Two channels that act on each other."""
CANCELS = certificate(
    "assignability",
    plant([[0, 0], [0, 0]], ([[1], [-1]], [[1, 0]]), ([[0], [1]], [[1, 1]])),
    {
        "blocks": [{"channels": ["1"], "dimension": 1}, {"channels": ["2"], "dimension": 1}],
        "fixed_degree": 0,
    },
    {
        **apart([1, 0], zeros=[{"from": ["1"], "X": matrix([-1], [1]), "pivots": [1]}]),
        "degrees": [
            degree(sequence([0, 1]), kernel=matrix([0, 1]), kernel_pivots=[1]),
            degree(sequence([0, 1]), annihilator=matrix([1, 0]), pivots=[0]),
        ],
    },
)
"""A path leads from channel 1 to channel 2, and no edge."""
JOINED = {"channels": ["1", "2"], "dimension": 2}
THREE = certificate(
    "assignability",
    plant(
        [[0, 0, 1], [0, 0, 0], [0, 0, 0]],
        *[([[int(i == k)] for i in range(3)], [[int(i == k) for i in range(3)]]) for k in range(3)],
    ),
    {
        "blocks": [{"channels": [name], "dimension": 1} for name in ("1", "2", "3")],
        "fixed_degree": 0,
    },
    {**apart([2, 1, 0]), "degrees": [degree(sequence([0, 1]), [k]) for k in range(3)]},
)
"""Channel 3 acts on channel 1, and nothing else on another."""

WRITTEN = [
    ("a chain splits in two, by paths", APART),
    ("a chain splits in two, by what is not controlled or not observed", ALL),
    ("a mode that no gain moves", FIXED_MODE),
    ("a mode that no gain moves, by paths", changed(
        FIXED_MODE, ("witness.degrees.0", degree(sequence([6, 1]), [0])),
    )),
    ("a mode that is moved and not seen", MOVED),
    ("a mode that is moved and not seen, by paths", changed(
        MOVED, ("witness.degrees.0", degree(sequence([6, 1]), [0])),
    )),
    ("two states that the channel moves and sees", WHOLE_CHAIN),
    ("more states than are on paths", changed(
        FIXED_MODE, ("witness.degrees.0.states", [0, 1]),
    )),
    ("a chain of four states", FOUR),
    ("a channel without inputs", UNUSED),
    ("a channel without inputs, by rows", changed(UNUSED, (
        "witness.degrees.0", degree(None, annihilator=matrix([1]), pivots=[0]),
    ))),
    ("a sequence of a loop", changed(
        FIXED_MODE, ("witness.degrees.0.sequence", sequence([5, 1], gains=[matrix([1])])),
    )),
    ("channels that act on each other", LOOP),
    ("three components in an order", THREE),
    ("the same in another order", changed(THREE, ("witness.components.order", [2, 0, 1]))),
    ("edges that are not needed", changed(LOOP, ("witness.components.arcs", [
        ["1", "1", 0], ["1", "2", 1], ["2", "1", 1], ["2", "2", 0],
    ]))),
    ("an edge from an earlier component to a later one", changed(
        APART, ("witness.components.arcs", [["1", "2", 1]]),
    )),
    ("another modulus", changed(LOOP, ("witness.components.modulus", 15))),
    ("a path that is no edge, by a zero transfer", CANCELS),
    ("a path forwards needs no zero transfer", changed(
        CANCELS, ("witness.components", apart([0, 1])["components"]),
    )),
]  # fmt: skip

FALSE = [
    ("a degree too high", FIXED_MODE, (
        ("claim.blocks.0.dimension", 2), ("claim.fixed_degree", 0),
        ("witness.degrees.0", degree(sequence([2, 4, 1]))),
    ), "INVALID"),
    ("a degree too high, by the dimension alone", FIXED_MODE, (
        ("claim.blocks.0.dimension", 2), ("claim.fixed_degree", 0),
        ("witness.degrees.0", degree(sequence([6, 1]))),
    ), "INVALID"),
    ("a degree too low, by nothing", FIXED_MODE, (
        *SMALLER, ("witness.degrees.0.sequence", None),
    ), "INVALID"),
    ("a degree too low, by all states as kernel", FIXED_MODE, (
        *SMALLER, ("witness.degrees.0", NOT_SEEN),
    ), "INVALID"),
    ("a degree too low, by no states", FIXED_MODE, (
        *SMALLER, ("witness.degrees.0", degree(None, [])),
    ), "INVALID"),
    ("a chain without a state between its ends", FOUR, (*NO_DEGREE, (
        "witness.degrees.0", degree(
            None, [0, 1, 3], annihilator=matrix([0, 0, 1]), pivots=[2],
            kernel=matrix([1, 0, 0], [0, 1, 0]), kernel_pivots=[0, 1],
        ),
    )), "INVALID"),
    ("a chain without all states between its ends", FOUR, (*NO_DEGREE, (
        "witness.degrees.0", degree(
            None, [0, 3], annihilator=matrix([0, 1]), pivots=[1],
            kernel=matrix([1, 0]), kernel_pivots=[0],
        ),
    )), "INVALID"),
    ("a state that counts twice, for rows and for columns", FIXED_MODE, (
        *SMALLER, ("witness.degrees.0.sequence", None),
        ("witness.degrees.0.kernel", matrix([0, 1])), ("witness.degrees.0.kernel_pivots", [1]),
    ), "INVALID"),
    ("rows that the input moves", FIXED_MODE, ("system.channels.0.B", [[1], [1]])),
    ("rows that do not follow A", FIXED_MODE, ("system.A.1.0", 1)),
    ("columns that the output sees", MOVED, ("system.channels.0.C", [[1, 1]])),
    ("columns that do not follow A", MOVED, ("system.A.0.1", 1)),
    ("a path that ends outside", WHOLE_CHAIN, (
        ("claim.blocks.0.dimension", 0), ("claim.fixed_degree", 2),
        ("witness.degrees.0", degree(None, [0], annihilator=matrix([1]), pivots=[0])),
    ), "INVALID"),
    ("a path that begins outside", WHOLE_CHAIN, (
        ("claim.blocks.0.dimension", 0), ("claim.fixed_degree", 2),
        ("witness.degrees.0", degree(None, [1], annihilator=matrix([1]), pivots=[0])),
    ), "INVALID"),
    ("a path through a state outside", changed(
        WHOLE_CHAIN,
        ("system", plant([[0, 0, 0], [1, 0, 0], [0, 1, 0]], ([[1], [0], [0]], [[0, 0, 1]]))),
        ("claim.blocks.0.dimension", 3),
        ("witness.degrees.0", degree(sequence([0, 0, 0, 1]))),
    ), (
        ("claim.blocks.0.dimension", 0), ("claim.fixed_degree", 3),
        ("witness.degrees.0", NOT_MOVED),
    ), "INVALID"),
    ("a sequence of zeros", WHOLE_CHAIN, ("witness.degrees.0.sequence.inputs", [0])),
    ("a recurrence that does not hold", FIXED_MODE, (
        "witness.degrees.0.sequence.cofactors", [[], [1]],
    )),
    ("a sequence of another channel", APART, ("witness.degrees.0.sequence.channel", "2")),
    ("degrees that do not sum to n", APART, ("claim.fixed_degree", 1)),
    ("components in another order", APART, ("claim.blocks", APART["claim"]["blocks"][::-1])),
    ("a degree missing", APART, ("witness.degrees", [ALONE]), "MALFORMED"),
    ("states beyond all", APART, ("witness.degrees.0.states", [2]), "MALFORMED"),
    ("states twice", APART, ("witness.degrees.0.states", [0, 0]), "MALFORMED"),
    ("a key more", APART, ("witness.degrees.0.more", 1), "MALFORMED"),
    ("components in an order in which an edge leads back", APART, (
        "witness.components.order", [1, 0],
    )),
    ("an edge leads back over a component between", THREE, (
        "witness.components.order", [0, 1, 2],
    )),
    ("a component twice in the order", APART, ("witness.components.order", [0, 0])),
    ("a component missing in the order", APART, ("witness.components.order", [0]), "MALFORMED"),
    ("a component beyond all in the order", APART, ("witness.components.order", [0, 2])),
    ("channels joined without edges", APART, (
        ("claim.blocks", [JOINED]), ("witness.components.order", [0]),
        ("witness.degrees", LOOP["witness"]["degrees"]),
    ), "INVALID"),
    ("channels joined by an edge one way", LOOP, ("witness.components.arcs", [["1", "2", 1]])),
    ("channels joined by an edge that is not there", LOOP, (
        "witness.components.arcs", [["1", "2", 1], ["2", "1", 0]],
    )),
    ("an edge of too high a power", LOOP, (
        "witness.components.arcs", [["1", "2", 1], ["2", "1", 3]],
    )),
    ("channels that act on each other apart", LOOP, (
        ("claim.blocks", APART["claim"]["blocks"]), ("witness.components", BOTH["components"]),
        ("witness.degrees", [ALONE, degree(sequence([0, 1]), [1])]),
    ), "INVALID"),
    ("a modulus that divides an edge", LOOP, ("system.A.0.1", 7)),
    ("a path that is no edge, without proof", CANCELS, ("witness.components.zeros", [])),
    ("a zero transfer of another channel", CANCELS, (
        "witness.components.zeros.0", {"from": ["2"], "X": matrix([0], [1]), "pivots": [1]},
    )),
    ("a zero transfer that the output sees", CANCELS, ("system.channels.1.C", [[1, 2]])),
    ("edges that are not sorted", LOOP, (
        "witness.components.arcs", [["2", "1", 1], ["1", "2", 1]],
    ), "MALFORMED"),
    ("no modulus", LOOP, ("witness.components.modulus", None), "MALFORMED"),
    ("components and a transfer graph", APART, (
        "witness.transfer_graph", {"claim": GRAPH["claim"], "witness": GRAPH["witness"]},
    ), "MALFORMED"),
    ("degrees beside a transfer graph", APART, ("witness", {
        "transfer_graph": {"claim": GRAPH["claim"], "witness": GRAPH["witness"]},
        "degrees": APART["witness"]["degrees"],
    }), "MALFORMED"),
    ("components with realizations", APART, ("witness.realizations", []), "MALFORMED"),
]  # fmt: skip

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
        "blocks that are not those of the transfer graph",
        SPLIT,
        (
            ("claim.blocks", [JOINED]),
            ("witness.realizations", [WHOLE]),
        ),
        "INVALID",
    ),
    ("an edge that is not there", SPLIT, ("witness.transfer_graph.witness.powers", [0, 0, 0])),
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


test_sound_evidence_is_accepted = accepts(WRITTEN)
test_a_change_of_one_place_is_rejected = rejects(FALSE)
test_sound_evidence_of_earlier_versions_is_accepted = accepts(ACCEPTED)
test_a_change_in_what_earlier_versions_wrote_is_rejected = rejects(REJECTED)
