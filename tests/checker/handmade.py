"""Certificates written by hand, one or two for every kind, and the means to change one place.

Plants are small enough for every number to be followed with a pencil.
"""

from __future__ import annotations

import copy
import json
from collections.abc import Sequence
from typing import Any

from mcexact.checker.kinds import Verdict, check_document

Document = dict[str, Any]


def matrix(*rows: Sequence[int], denominator: int = 1) -> Document:
    """A matrix of a certificate."""
    return {"denominator": denominator, "entries": [list(row) for row in rows]}


def listed(rows: Sequence[Sequence[Any]], ncols: int) -> Document:
    """A matrix of a system by its entries that are not 0."""
    entries = [[i, j, x] for i, row in enumerate(rows) for j, x in enumerate(row) if x]
    return {"shape": [len(rows), ncols], "entries": entries}


def layers(*parts: Sequence[Sequence[int]], denominator: int = 1) -> Document:
    """A polynomial matrix of a certificate, constant layer first."""
    rows = [[list(row) for row in part] for part in parts]
    return {"denominator": denominator, "coefficients": rows}


def plant(A: Any, *ports: tuple[Any, Any], time: str = "continuous", **graph: Any) -> Document:
    """A system object: channels 1, 2, … from pairs (B, C)."""
    channels = [{"name": str(i), "B": B, "C": C} for i, (B, C) in enumerate(ports, start=1)]
    return {"time": time, "A": A, "channels": channels, **graph}


def ranged(A: Any, *ports: Any, time: str = "continuous", **ranges: Any) -> Document:
    """A plant with parameters, by their ranges."""
    known = {name: {"range": list(ends)} for name, ends in ranges.items()}
    return {**plant(A, *ports, time=time), "parameters": known}


def certificate(
    kind: str, system: Document, claim: Document, witness: Document, *subject: Document
) -> Document:
    """A certificate, its parts copied."""
    parts = {"system": system, "subject": list(subject), "claim": claim, "witness": witness}
    return copy.deepcopy({"format": "mcexact-certificate/1", "kind": kind, **parts})


def changed(document: Document, *edits: tuple[str, Any]) -> Document:
    """A copy with other values at some places, each written as ``claim.factors.0.rank``."""
    result = copy.deepcopy(document)
    for place, value in edits:
        node, last = _parent(result, place)
        node[last] = copy.deepcopy(value)
    return result


def without(document: Document, place: str) -> Document:
    """A copy without the value at a place."""
    result = copy.deepcopy(document)
    node, last = _parent(result, place)
    del node[last]
    return result


def _parent(document: Any, place: str) -> tuple[Any, Any]:
    """What holds a place, and the key or position under which it does."""
    *path, last = place.split(".")
    for key in path:
        document = document[int(key)] if isinstance(document, list) else document[key]
    return document, int(last) if isinstance(document, list) else last


def checked(document: Any, **options: Any) -> Verdict:
    """The verdict on a document, through its text."""
    return check_document(json.dumps(document).encode(), **options)


PAPER = plant(
    [[1, 0, 0], [0, 1, 0], [0, 1, 1]],
    ([[1], [0], [0]], [[1, 0, 0], [0, 0, 1]]),
    ([[0], [1], [0]], [[0, 1, 0]]),
    ([[1], [0], [0]], [[0, 1, 0]]),
    neighbors={"1": ["2"], "2": ["3"], "3": ["1"]},
)
"""The paper's example, section IV-B: 1 is fixed, the pencil of {2, 3} has rank 2."""

INTEGRATOR = plant([[0]], ([[1]], [[1]]))
"""One state, one channel, nothing fixed."""

OSCILLATOR = plant([[0, 1], [-1, 0]], ([[0], [0]], [[1, 0]]))
"""x² + 1, and a channel whose input does nothing."""

CHAIN = plant([[0, 0], [1, 0]], ([[1], [0]], [[1, 0]]), ([[0], [1]], [[0, 1]]))
"""Channel 1 drives the first of two integrators, channel 2 the second."""

PAIR = plant([[1, 0], [0, 2]], ([[1], [0]], [[1, 0]]))
"""Two modes; the channel moves only the first."""

PAPER_SUBSPACE = {
    "channels_T": ["1"],
    "U": layers([[1, 0], [0, 0], [0, 1]]),
    "V": layers([[0, 0]]),
    "pivots": [0, 2],
}
PAPER_GAINS = [matrix([1, 0]), matrix([2]), matrix([0])]
E3 = {"B0": matrix([0], [0], [1]), "C0": matrix([0, 0, 1])}

FIXED = certificate(
    "fixed_spectrum",
    PAPER,
    {
        "polynomial": [-1, 1],
        "factors": [
            {
                "polynomial": [-1, 1],
                "multiplicity_in_A": 3,
                "multiplicity_at_most": 1,
                "channels": ["2", "3"],
                "rank": 2,
                "stable": False,
                "roots": [{"re": "1", "im": "0", "radius": "0"}],
            }
        ],
        "stabilizable": False,
        "best_rate": {"lower": "-1", "upper": "-1"},
    },
    {"gains": PAPER_GAINS, "modulus": 101, "subspaces": [PAPER_SUBSPACE], "completion": E3},
)
OSCILLATION = certificate(
    "fixed_spectrum",
    OSCILLATOR,
    {
        "polynomial": [1, 0, 1],
        "factors": [
            {
                "polynomial": [1, 0, 1],
                "multiplicity_in_A": 1,
                "multiplicity_at_most": 1,
                "channels": [],
                "rank": 1,
                "stable": False,
                "roots": [
                    {"re": "0", "im": "-1", "radius": "0.25"},
                    {"re": "0", "im": "1", "radius": "0.25"},
                ],
            }
        ],
        "stabilizable": False,
        "best_rate": {"lower": "-0.25", "upper": "0.25"},
    },
    {
        "gains": [matrix([0])],
        "modulus": 101,
        "subspaces": [
            {
                "channels_T": ["1"],
                "U": layers([[1], [0]], [[0], [1]]),
                "V": layers([[0]]),
                "pivots": [0],
            }
        ],
        "completion": {"B0": matrix([1], [0]), "C0": matrix([1, 0])},
    },
)
FREE = certificate(
    "fixed_spectrum",
    INTEGRATOR,
    {"polynomial": [1], "factors": [], "stabilizable": True, "best_rate": None},
    {"gains": [matrix([1])], "modulus": 7, "subspaces": [], "completion": None},
)
UNCONTROLLABLE = certificate(
    "controllability",
    PAIR,
    {
        "channels": ["1"],
        "dimension": 1,
        "controllable": False,
        "uncontrollable_polynomial": [-2, 1],
    },
    {"modulus": 7, "annihilator": matrix([0, 1]), "pivots": [1]},
)
CONTROLLABLE = certificate(
    "controllability",
    CHAIN,
    {
        "channels": ["1"],
        "dimension": 2,
        "controllable": True,
        "uncontrollable_polynomial": [1],
    },
    {"modulus": 7, "annihilator": matrix(), "pivots": []},
)
GENERIC = {
    "modulus": 7,
    "annihilator": matrix(),
    "pivots": [],
    "relations": {"denominator": 1, "coefficients": [[[]]]},
    "inputs": [],
}
"""All the evidence for indices of one input, if no rank is less than generic."""
INDICES = certificate(
    "controllability_indices",
    CHAIN,
    {"channels": ["1"], "ranks": [1, 2], "index": 2, "indices": [2]},
    GENERIC,
)
NO_INDEX = certificate(
    "controllability_indices",
    PAIR,
    {"channels": ["1"], "ranks": [1], "index": None, "indices": [1]},
    {**GENERIC, "annihilator": matrix([0, 1]), "pivots": [1]},
)
GRAPH = certificate(
    "transfer_graph",
    CHAIN,
    {
        "arcs": [["1", "1"], ["1", "2"], ["2", "2"]],
        "components": [["1"], ["2"]],
        "strongly_connected": False,
    },
    {
        "modulus": 7,
        "powers": [0, 1, 0],
        "zeros": [{"from": ["2"], "X": matrix([0], [1]), "pivots": [1]}],
    },
)
COMPLETE = certificate(
    "completeness",
    INTEGRATOR,
    {"complete": True},
    {"modulus": 7, "gains": [matrix([1])], "arcs": [["1", "1", 0]]},
)
CUT = certificate(
    "completeness",
    CHAIN,
    {"complete": False},
    {"zero": {"from": ["2"], "X": matrix([0], [1]), "pivots": [1]}},
)
MODE = certificate(
    "completeness",
    PAPER,
    {"complete": False},
    {"polynomial": [-1, 1], "subspace": PAPER_SUBSPACE},
)
RING = certificate("neighbor_graph", PAPER, {"strongly_connected": True}, {})
RANK = certificate(
    "pencil_rank",
    PAPER,
    {"subset": ["2"], "polynomial": [-1, 1], "rank": 2},
    {
        "modulus": 101,
        "kernel": layers([[1, 0, 0], [0, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, -1]]),
        "pivots": [0, 2, 3],
    },
)
OSCILLATOR_RANK = certificate(
    "pencil_rank",
    OSCILLATOR,
    {"subset": ["1"], "polynomial": [1, 0, 1], "rank": 2},
    {"modulus": 101, "kernel": layers([[], []]), "pivots": []},
)
STAR = certificate(
    "structural_fixed_modes",
    plant(
        [[7, 0, 0, 0], [0, 0, 0, 0], [0, 1, 0, 0], [0, 2, 0, 0]],
        ([[0], [1], [0], [0]], [[0, 0, 3, 1]]),
        ([[1], [0], [0], [0]], [[0, 0, 0, 0]]),
        neighbors={"1": [], "2": ["1"]},
    ),
    {"information": "own", "without_feedback": [0], "at_zero": 1, "polynomial": [0, -7, 1]},
    {
        # States 2, 3, 4, inputs of 1 and 2, outputs of 1 and 2, at the places 1 to 7.
        "rows": [0, 1, 1, 0, 0, 0, 0],
        "columns": [-1, 0, 0, 0, 0, 0, 0],
        "matching": [4, 1, 3, 6, 5, 2, 7],
    },
)
"""State 1 is seen by nobody.  States 3 and 4 are integrals of state 2: paths cover one of these."""
LOSS = certificate(
    "deficiency",
    PAPER,
    {"deficiency": 1},
    {
        "modulus": 101,
        "gains": PAPER_GAINS,
        **E3,
        "polynomial": [-1, 1],
        "subspace": PAPER_SUBSPACE,
    },
)
NO_LOSS = certificate(
    "deficiency",
    INTEGRATOR,
    {"deficiency": 0},
    {
        "modulus": 7,
        "gains": [matrix([1])],
        "B0": matrix([]),
        "C0": matrix(),
        "polynomial": None,
        "subspace": None,
    },
)

VALID = {
    "the paper's fixed mode": FIXED,
    "a pair of fixed modes": OSCILLATION,
    "nothing fixed": FREE,
    "an uncontrollable mode": UNCONTROLLABLE,
    "a controllable chain": CONTROLLABLE,
    "indices of a chain": INDICES,
    "no index": NO_INDEX,
    "a transfer graph": GRAPH,
    "a complete system": COMPLETE,
    "a cut": CUT,
    "incomplete by a fixed mode": MODE,
    "a ring": RING,
    "a pencil that drops": RANK,
    "a pencil of full rank": OSCILLATOR_RANK,
    "a loss": LOSS,
    "no loss": NO_LOSS,
}
"""Every one of them is VALID, and says something true."""
