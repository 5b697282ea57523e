"""Text for people: what it says, and that it stays readable whatever the data."""

import io
from typing import Any

import pytest

from mcexact import MultiChannelSystem, NeighborGraph
from mcexact.report.assessment import assess
from mcexact.report.text import Table, assessment_tables, plain, shorten, show

EXAMPLE: dict[str, Any] = {
    "A": [[1, 0, 0], [0, 1, 0], [0, 1, 1]],
    "B": [[[1], [0], [0]], [[0], [1], [0]], [[1], [0], [0]]],
    "C": [[[1, 0, 0], [0, 0, 1]], [[0, 1, 0]], [[0, 1, 0]]],
}


def text_of(system: MultiChannelSystem, **question: Any) -> str:
    return plain(assessment_tables(assess(system, **question)))


def rows_of(text: str) -> dict[str, str]:
    """The names and values of a table without columns."""
    cells = (line.strip().split("  ", 1) for line in text.splitlines() if "  " in line.strip())
    return {name: value.strip() for name, value in cells}


def test_the_obstruction_is_named_with_its_channels_and_its_rank() -> None:
    text = text_of(MultiChannelSystem(**EXAMPLE))
    assert "3 states, 3 channels {1, 2, 3}, continuous time" in text
    row = next(line for line in text.splitlines() if line.startswith("  x - 1 "))
    assert row.split("  ")[-2:] == ["{2, 3}", "2 of 3"]
    assert "decentrally stabilizable  no" in text


def test_nothing_is_fixed_is_said_in_words() -> None:
    text = text_of(MultiChannelSystem([[0]], [[[1]]], [[[1]]]))
    assert "fixed spectrum            empty" in text
    assert "any: nothing is fixed" in text
    assert "fixed modes" not in text


def test_modes_out_of_reach_and_dead_channels_are_named() -> None:
    system = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [0]], [[0], [0]]], [[[1, 1]], [[1, 1]]])
    text = text_of(system)
    assert "no, out of reach: the roots of x - 2" in text
    assert "dead channels {2}" in text


def test_what_the_agents_have_to_share_is_said_when_they_have_neighbors() -> None:
    plant = MultiChannelSystem(**EXAMPLE)
    heard = plant.with_neighbors(NeighborGraph.ring(plant.names))
    rows = rows_of(text_of(heard, minimal=True))
    assert rows["enough to share (outputs+states)"] == "1 by each agent, 3 together"
    assert rows["least to share (outputs+states)"] == "1: 1 by 3"
    assert rows["least to share (states)"] == "2: 1 by 1, 1 by 3"


def test_the_ranks_for_a_subset_are_a_table_of_the_modes_of_A() -> None:
    text = text_of(MultiChannelSystem(**EXAMPLE), subset=["2"])
    assert "for s = {2}" in text
    assert "x - 1      2     yes" in text


def test_a_system_without_states_is_readable() -> None:
    assert "0 states" in text_of(MultiChannelSystem([], [[]], [[[]]]))


def test_long_data_are_cut_in_the_middle() -> None:
    big = 10**3999 + 7
    text = text_of(MultiChannelSystem([[big]], [[[0]]], [[[1]]]))
    assert max(map(len, text.splitlines())) < 300
    assert "…" in text
    assert shorten("short") == "short"


@pytest.mark.parametrize("name", ["[bold]u1[/bold]", "<script>alert(1)</script>"])
def test_markup_in_a_name_is_shown_and_not_obeyed(name: str) -> None:
    system = MultiChannelSystem([[1]], [[[1]]], [[[0]]], names=[name])
    stream = io.StringIO()
    show(assessment_tables(assess(system)), stream)
    assert name in text_of(system)
    assert name in stream.getvalue().replace("\n", "")


def test_plain_tables_are_aligned_and_have_no_trailing_blanks() -> None:
    table = Table("title", ("a", "long"), (("1", ""), ("100", "2")), note="why")
    assert plain([table]) == "title\n  a    long\n  1\n  100  2\n  (why)\n"


def test_indices_and_the_parts_of_the_spectrum_are_said() -> None:
    rows = rows_of(text_of(MultiChannelSystem(**EXAMPLE), subset=["2", "3"], channel="1"))
    assert rows["controllability indices"] == "2, 1; index 2"
    assert rows["spectrum"] == "moved in parts: 1 by {1}, 1 by {2}, 0 by {3}; 1 by no gain"
    assert rows["remnant polynomial"] == "x - 1"
    assert rows["complete"].startswith("no")
    assert rows["observable with gains"].startswith("yes, indices 2")
    assert "x - 1" in rows["both with gains"]


def test_gains_through_every_channel_are_shown() -> None:
    ring = MultiChannelSystem(
        [[1, 0], [0, 1]], [[[1], [0]], [[0], [1]]], [[[0, 1]], [[1, 0]]], names=["a", "b"]
    )
    rows = rows_of(text_of(ring, every_channel=True))
    assert rows["spectrum"] == "freely assignable"
    assert rows["through every channel"].startswith("yes, indices 2 and 2, 2 and 2, F_a = [[")


def test_indices_of_very_long_chains_are_left_out() -> None:
    n = 101
    chain = [[int(i == j + 1) for j in range(n)] for i in range(n)]
    system = MultiChannelSystem(
        chain, [[[int(i == 0)] for i in range(n)]], [[[int(i == 0) for i in range(n)]]]
    )
    assert rows_of(text_of(system))["controllability indices"].startswith("left out")
