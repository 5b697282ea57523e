"""A counterexample is printed as code: pasted, it makes an equal system."""

from __future__ import annotations

import re
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis.strategies import SearchStrategy

import mcexact
from mcexact import testing
from mcexact.testing import Drawn
from tests.public import PUBLIC

ONCE = settings(
    max_examples=60,
    database=None,
    print_blob=False,
    derandomize=True,
    phases=[Phase.generate],
    report_multiple_bugs=False,
    suppress_health_check=list(HealthCheck),
)
NAMES = {"Drawn": Drawn, **PUBLIC}


def reported(strategy: SearchStrategy[Any], fails: Any) -> tuple[str, Any]:
    """What Hypothesis prints of a counterexample, and the counterexample itself."""
    seen = []

    @ONCE
    @given(strategy)
    def refuted(drawn: Any) -> None:
        if fails(drawn):
            seen.append(drawn)
            raise AssertionError

    with pytest.raises(AssertionError) as caught:
        refuted()
    text = "\n".join(caught.value.__notes__)
    found = re.search(r"refuted\(\s*drawn=(.*?),?\s*\)\s*(?:Explanation:.*)?$", text, re.DOTALL)
    assert found, text
    return found[1], seen[-1]


@pytest.mark.parametrize(
    ("strategy", "fails"),
    [
        (testing.systems(), lambda d: d.system.n > 1),
        (testing.systems(), lambda d: not d.system.n),
        (testing.systems(feedthrough=True), lambda d: d.system.D is not None),
        (testing.systems(), lambda d: any(not c.B.ncols for c in d.system.channels)),
        (testing.systems(), lambda d: any(not c.C.nrows for c in d.system.channels)),
        (
            testing.jointly_controllable_systems(denominators=True),
            lambda d: d.system.denominator > 1,
        ),
        (testing.systems_with_fixed_mode(), lambda d: d.fixed_mode.degree > 1),
        (testing.systems_on_graphs(longest_delay=2), lambda d: d.system.neighbors.delays),
        (testing.systems_with_deficiency(), lambda d: True),
        (testing.systems_with_indices(), lambda d: d.system.n > 2),
        (testing.systems_with_remnant(), lambda d: True),
        (testing.incomplete_systems(), lambda d: True),
        (testing.sparse_systems(), lambda d: d.system.n > 1),
        (testing.uncontrollable_systems(), lambda d: True),
    ],
)
def test_the_text_of_a_counterexample_makes_it_again(
    strategy: SearchStrategy[Drawn], fails: Any
) -> None:
    text, found = reported(strategy, fails)
    assert " at 0x" not in text and "None" not in text
    again = eval(text, NAMES)
    assert again == found and again.system == found.system


def test_a_graph_of_any_size_is_printed_as_code() -> None:
    names = tuple(f"agent {k}" for k in range(12))
    graphs = testing.neighbor_graphs(names, strongly_connected=True, longest_delay=1)
    text, found = reported(graphs, lambda graph: True)
    assert eval(text, {"NeighborGraph": mcexact.NeighborGraph}) == found
