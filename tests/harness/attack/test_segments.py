"""The oracle about boxes finds members between vertices for which a claim is false."""

from __future__ import annotations

from typing import Any

import pytest
from flint import fmpq

from tests.checker.box_plants import ALL, uncertain
from tests.checker.handmade import certificate, plant
from tests.oracle.certificates import boxes
from tests.oracle.certificates.judge import FALSE, TRUE, judge
from tests.oracle.certificates.segments import segments

NOWHERE: dict[str, Any] = {"bound": None}
ALONE: dict[str, Any] = {"channels": ["1"], "bound": None}
STAYS: dict[str, Any] = {"bound": None, "gain_radii": None}
MEET = plant(
    [[1, 0], [0, 2]], ([[1], [1]], [[1, 1]]), uncertainty=uncertain([["5/4", 0], [0, "1/3"]])
)
"""One input moves both modes unless they are equal, as they are for some members inside."""
APART = plant(
    [[1, 0], [0, 2]], ([[1], [1]], [[1, 1]]), uncertainty=uncertain([["1/3", 0], [0, "1/3"]])
)
FADING = plant([[1]], ([[3]], [[1]]), uncertainty=uncertain(None, {"1": [["16/5"]]}))
"""The input vanishes at 15/16 of its radius."""


@pytest.mark.parametrize(
    ("kind", "system", "claim", "expected"),
    [
        ("box_fixed", MEET, NOWHERE, FALSE),
        ("box_controllable", MEET, ALONE, FALSE),
        ("box_fixed", APART, NOWHERE, TRUE),
        ("box_controllable", APART, ALONE, TRUE),
        ("box_fixed", FADING, NOWHERE, FALSE),
        ("box_controllable", FADING, ALONE, FALSE),
    ],
)
def test_every_member_of_a_segment_is_decided(
    kind: str, system: Any, claim: Any, expected: str
) -> None:
    document = certificate(kind, system, claim, {})
    assert judge(document)[0] == expected
    by_points = boxes.fixed if kind == "box_fixed" else boxes.controllable
    assert by_points(claim, document, next(boxes.members(document)))


def test_a_loop_that_is_stable_at_vertices_is_decided_between_them() -> None:
    """The eigenvalues are −1 ± √(x y), both entries from −2 to 2."""
    system = plant(
        [[-1, 0], [0, -1]], ([[1], [0]], [[1, 0]]), uncertainty=uncertain([[0, 2], [2, 0]])
    )
    assert judge(certificate("box_stable", system, STAYS, {}))[0] == FALSE
    quiet = {**system, "uncertainty": uncertain([[0, "9/10"], ["9/10", 0]])}
    assert judge(certificate("box_stable", quiet, STAYS, {}))[0] == TRUE


@pytest.mark.parametrize("name", [name for name, each in ALL.items() if each["claim"].get("bound")])
def test_the_middle_of_a_segment_between_opposite_vertices_has_the_values(name: str) -> None:
    """Also what linear constructions make of them."""
    document = {**ALL[name], "kind": "box_fixed", "subject": [{"construction": "dual"}]}
    line, *_ = segments(document)
    middle, values = fmpq(1, 2), next(boxes.members(document))
    pairs = [M for pair in zip(values.B, values.C, strict=True) for M in pair]
    for (rows, nrows, ncols), M in zip(line.tables, [values.A, *pairs], strict=True):
        assert [p(middle) for row in rows for p, _ in row] == M.entries()
        assert (nrows, ncols) == (M.nrows(), M.ncols())
