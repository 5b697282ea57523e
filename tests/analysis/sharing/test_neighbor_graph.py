"""Whether agents can hear each other."""

import pytest

from mcexact.analysis.sharing import neighbor_graph
from mcexact.answer import protocol
from mcexact.checker.kinds import check_document
from mcexact.errors import UsageError
from mcexact.model.system import MultiChannelSystem


@pytest.mark.parametrize(
    ("neighbors", "connected"),
    [
        ({"1": ["2"], "2": ["3"], "3": ["1"]}, True),
        ({"1": ["2"], "2": ["3"], "3": []}, False),
        ({"1": [], "2": [], "3": []}, False),
    ],
)
def test_a_cycle_connects_and_a_path_does_not(
    neighbors: dict[str, list[str]], connected: bool
) -> None:
    system = MultiChannelSystem([[0]], [[[1]]] * 3, [[[1]]] * 3, neighbors=neighbors)
    verdict = neighbor_graph(system)
    assert verdict.strongly_connected == connected
    assert check_document(protocol.encode(verdict).encode()).verdict == "VALID"


def test_without_a_graph_there_is_no_answer() -> None:
    with pytest.raises(UsageError, match="neighbor"):
        neighbor_graph(MultiChannelSystem([[0]], [[[1]]], [[[1]]]))
