"""Shrunk subspaces of some states, on which nothing acts that they drive."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.core.evidence import Losses
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import read_plant
from tests.checker.handmade import Document, changed, layers, plant

Row = tuple[str, Document, Document, list[int], int]

# State 2 is driven by state 0 (channel 1) and drives state 1 (channel 2).
BETWEEN = plant(
    [[3, 0, 0], [0, 4, 1], [1, 0, 7]],
    ([[1], [0], [0]], [[1, 0, 0]]),
    ([[0], [1], [0]], [[0, 1, 0]]),
)
ALONE = {"channels_T": [], "U": layers([[1]]), "V": layers([]), "pivots": [0]}
SEVEN: Document = {"channels_T": ["2"], "states": [2], "subspace": ALONE}
# State 1 leads back to state 0, by A or through channel 2.
BACK = changed(BETWEEN, ("A", [[3, 1, 0], [0, 4, 1], [1, 0, 7]]))
RETURNED = plant(
    [[3, 0, 0], [0, 4, 1], [1, 0, 7]],
    ([[1], [0], [0]], [[1, 0, 0]]),
    ([[1], [1], [0]], [[0, 1, 0]]),
)
DIRECT = plant([[7]], ([[1]], [[1]]))
"""A channel acts on the state."""
UNSEEN = plant([[7, 0], [0, 7]], ([[1], [0]], [[0, 1]]), ([[0], [1]], [[0, 0]]))
"""Channel 1 measures state 1 and drives state 0; channel 2 measures nothing."""
PAIR = plant([[1, 0, 0], [2, 1, 0], [0, 0, 5]], ([[0], [0], [1]], [[0, 0, 1]]))
"""A Jordan chain of two states that no channel drives or measures."""
TWO = plant([[1, 0, 0], [0, 1, 0], [1, 1, 5]], ([[0], [0], [1]], [[0, 0, 1]]))
BOTH = {
    "channels_T": ["1"],
    "states": [0, 1],
    "subspace": {**ALONE, "U": layers([[1, 0], [0, 1]]), "V": layers([]), "pivots": [0, 1]},
}
TURNING = plant([[0, -1, 0], [1, 0, 0], [1, 0, 5]], ([[0], [0], [1]], [[0, 0, 1]]))
CIRCLE = {
    "channels_T": ["1"],
    "states": [0, 1],
    "subspace": {**ALONE, "U": layers([[0], [1]], [[1], [0]]), "V": layers([]), "pivots": [1]},
}
# In the states 0 and 1 channel 2 acts, and moves 1 alone; state 2 is beyond.
INNER = plant(
    [[2, 0, 0], [0, 3, 0], [1, 1, 5]],
    ([[0], [0], [1]], [[0, 0, 1]]),
    ([[0], [1], [1]], [[0, 1, 0]]),
)
MEASURED: Document = {
    "channels_T": ["1"],
    "states": [0, 1],
    "subspace": {"channels_T": [], "U": layers([[1], [0]]), "V": layers([]), "pivots": [0]},
}
DRIVEN: Document = {
    "channels_T": ["1", "2"],
    "states": [0, 1],
    "subspace": {
        "channels_T": ["2"],
        "U": layers([[1, 0], [0, 1]]),
        "V": layers([[0, -1]]),
        "pivots": [0, 1],
    },
}
# State 0 drives state 1, channel 1 measures that and drives state 2, which drives state 0.
AROUND = plant([[0, 0, 1], [1, 0, 0], [0, 0, 0]], ([[0], [0], [1]], [[0, 1, 0]]))
# Channel 1 measures state 1, which it does not see move, and state 2, which state 0 drives; it
# drives state 0.
BOTH_SIDES = plant(
    [[0, 0, 0], [0, 0, 0], [1, 0, 0]],
    ([[1], [0], [0]], [[0, 1, 1]]),
    ([[0], [1], [0]], [[0, 1, 0]]),
)
# Channel 1 drives states 0 and 1, of which it measures 0; state 0 drives state 2, channel 2 drives
# and measures that.  Left eigenvectors take one row where the inputs take two columns.
ACROSS = plant(
    [[2, 0, 0], [0, 2, 0], [1, 0, 5]],
    ([[1], [1], [0]], [[1, 1, 0]]),
    ([[0], [0], [1]], [[0, 0, 1]]),
)
LEFT: Document = {
    "channels_T": ["1", "2"],
    "states": [0, 1],
    "subspace": {"channels_T": ["1"], "dual": {**ALONE, "U": layers([[1], [-1]])}},
}

CHAINED = {
    "channels_T": [],
    "states": [0, 1],
    "subspace": {**ALONE, "U": layers([[0], [1]]), "pivots": [1]},
}
TWO_MODES = plant([[1, 0], [1, 2]], ([[0], [0]], [[0, 0]]))
# (x − 2, 1)' is an eigenvector at 1 and at 2
REDUCIBLE = {
    "channels_T": [],
    "states": [0, 1],
    "subspace": {**ALONE, "U": layers([[-2], [1]], [[1], [0]]), "pivots": [1]},
}

ROW = ("subspace.dual.U", layers([[1], [1]]))

VALID: list[Row] = [
    ("a state between two channels", BETWEEN, SEVEN, [-7, 1], 1),
    ("two states of one mode", TWO, BOTH, [-1, 1], 2),
    ("one loss of two", TWO, BOTH, [-1, 1], 1),
    ("a pair of modes", TURNING, CIRCLE, [1, 0, 1], 1),
    ("a channel within the states that does not see the mode", INNER, MEASURED, [-2, 1], 1),
    ("a channel within the states, in T", INNER, DRIVEN, [-2, 1], 1),
    ("the eigenvector of a Jordan chain", PAIR, CHAINED, [-1, 1], 1),
    ("a row of the states that no channel drives", ACROSS, LEFT, [-2, 1], 1),
    ("a reducible polynomial", TWO_MODES, REDUCIBLE, [2, -3, 1], 1),
]
INVALID: list[Row] = [
    (
        "what the state drives acts on it",
        BACK,
        changed(SEVEN, ("channels_T", ["1", "2"])),
        [-7, 1],
        1,
    ),
    ("a channel leads back", RETURNED, changed(SEVEN, ("channels_T", ["1", "2"])), [-7, 1], 1),
    (
        "a channel leads to a state that leads back",
        AROUND,
        changed(SEVEN, ("states", [0]), ("channels_T", ["1"])),
        [0, 1],
        1,
    ),
    (
        "a channel of the states measures what they drive",
        BOTH_SIDES,
        changed(MEASURED, ("channels_T", [])),
        [0, 1],
        1,
    ),
    ("a channel acts on the state", DIRECT, changed(SEVEN, ("states", [0])), [-7, 1], 1),
    ("T too small", BETWEEN, changed(SEVEN, ("channels_T", [])), [-7, 1], 1),
    ("T too large", BETWEEN, changed(SEVEN, ("channels_T", ["1", "2"])), [-7, 1], 1),
    ("another T", BETWEEN, changed(SEVEN, ("channels_T", ["1"])), [-7, 1], 1),
    ("another state", BETWEEN, changed(SEVEN, ("states", [1])), [-7, 1], 1),
    ("another polynomial", BETWEEN, SEVEN, [-3, 1], 1),
    ("more than is lost", BETWEEN, SEVEN, [-7, 1], 2),
    ("nothing lost", BETWEEN, SEVEN, [-7, 1], 0),
    # (x − 7)(x − 3) divides (x − 7) u for u = x − 3, which is 0 at the other root
    (
        "a column that vanishes at a root",
        BETWEEN,
        changed(SEVEN, ("subspace.U", layers([[-3]], [[1]]))),
        [21, -10, 1],
        1,
    ),
    ("a row that a channel drives", ACROSS, changed(LEFT, ROW), [-2, 1], 1),
    ("a row at another mode", ACROSS, LEFT, [-5, 1], 1),
    ("T without a channel of the states", ACROSS, changed(LEFT, ("channels_T", ["2"])), [-2, 1], 1),
    ("no eigenvectors", PAIR, changed(BOTH, ("channels_T", [])), [-1, 1], 2),
    ("the mode that the inner channel measures", INNER, MEASURED, [-3, 1], 1),
    (
        "an inner channel left out of T",
        INNER,
        changed(DRIVEN, ("channels_T", ["1"])),
        [-2, 1],
        1,
    ),
    ("both modes by one input", INNER, DRIVEN, [6, -5, 1], 1),
    ("a state that a channel drives and no channel measures", UNSEEN, SEVEN, [-7, 1], 1),
]


def verdict(system: Document, value: Any, p: list[int], deficiency: int) -> str:
    """VALID, or the verdict of what is refused."""
    try:
        losses = Losses(read_plant(system))
        losses.checked(value, "witness", [Fraction(c) for c in p], deficiency)
    except Refused as refused:
        return refused.verdict
    return "VALID"


@pytest.mark.parametrize(("why", "system", "value", "p", "deficiency"), VALID)
def test_what_is_accepted(
    why: str, system: Document, value: Any, p: list[int], deficiency: int
) -> None:
    assert verdict(system, value, p, deficiency) == "VALID", why


@pytest.mark.parametrize(("why", "system", "value", "p", "deficiency"), INVALID)
def test_what_is_refused(
    why: str, system: Document, value: Any, p: list[int], deficiency: int
) -> None:
    assert verdict(system, value, p, deficiency) != "VALID", why
