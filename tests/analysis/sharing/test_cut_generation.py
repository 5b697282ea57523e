"""Cut generation: what the oracle is asked, and what is proved of the answer."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from mcexact.analysis.covering import CoveringCut, CoveringProgram
from mcexact.analysis.sharing import CoveringProblem, covering_optimum
from mcexact.errors import LimitReached
from mcexact.model.system import MultiChannelSystem
from tests.wording import refusal

PAIRS = ((0, 1), (1, 2), (0, 2), (3, 4), (4, 5), (3, 5))
"""The edges of two triangles: each pair has to have one member bought."""
INTEGRATOR = MultiChannelSystem([[0]], [[[1]]], [[[1]]])


def two_triangles(asked: list[tuple[int, ...]]) -> CoveringProblem:
    """Buy members of pairs, one pair found missing at a time."""

    def violated(values: Sequence[int], system: MultiChannelSystem) -> list[CoveringCut]:
        assert system is INTEGRATOR
        asked.append(tuple(values))
        missing = [pair for pair in PAIRS if not sum(values[i] for i in pair)]
        return [CoveringCut(frozenset(pair), 1, pair) for pair in missing[:1]]

    program = CoveringProgram((Fraction(1),) * 6, (None,) * 6)
    return CoveringProblem("shared_dimensions", program, lambda _: INTEGRATOR, violated)


def test_the_cheapest_point_is_asked_for_until_the_oracle_is_content() -> None:
    asked: list[tuple[int, ...]] = []
    found = covering_optimum(two_triangles(asked), 100)
    assert asked[0] == (0,) * 6 and asked[-1] == found.values == (0, 1, 1, 0, 1, 1)
    assert found.cost == 4 and found.absence is not None
    assert len(found.nodes) > 1
    needed = found.with_cuts_of_leaves()
    assert {cut.evidence for cut in needed.cuts} <= set(PAIRS)
    assert len(needed.tree("agent", "abcdef")) == len(found.nodes)


def test_the_node_limit_tells_between_which_bounds_the_least_cost_lies() -> None:
    with refusal(LimitReached) as stopped:
        covering_optimum(two_triangles([]), 1)
    assert (stopped.value.lower, stopped.value.upper) == (3, 4)
