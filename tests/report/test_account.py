"""The text of `analyze`: what it says in words and tables, and that it stays readable."""

import io
from dataclasses import replace
from typing import Any

import pytest

from mcexact import MultiChannelSystem, NeighborGraph
from mcexact.analysis.analyze import Analysis
from mcexact.analysis.questions import QUESTIONS
from mcexact.exact.matrix import reading_in_words
from mcexact.model import gallery
from mcexact.report.html import shown_plant
from mcexact.report.text import answer, in_lines, plain, show, tables
from tests.answer.asking import account_of
from tests.wording import says, worded

EXAMPLE: dict[str, Any] = {
    "A": [[1, 0, 0], [0, 1, 0], [0, 1, 1]],
    "B": [[[1], [0], [0]], [[0], [1], [0]], [[1], [0], [0]]],
    "C": [[[1, 0, 0], [0, 0, 1]], [[0, 1, 0]], [[0, 1, 0]]],
}
WIDE = 10**6


def text_of(system: MultiChannelSystem, **question: Any) -> str:
    return plain(tables(account_of(system, **question).sentences), width=WIDE)


def rows_of(system: MultiChannelSystem, **question: Any) -> dict[str, str]:
    """The names and values of the tables without columns; values of one name are joined."""
    found: dict[str, str] = {}
    for table in tables(account_of(system, **question).sentences):
        for name, value in table.rows if not table.columns else ():
            found[name] = f"{found[name]}; {value}" if name in found else value
    return found


def test_the_obstruction_is_named_with_its_channels_and_its_rank() -> None:
    text = text_of(MultiChannelSystem(**EXAMPLE))
    assert "3 states, 3 channels {1, 2, 3}, continuous time" in text
    row = next(line for line in text.splitlines() if line.startswith("  x - 1 "))
    assert row.split() == ["x", "-", "1", "1", "no", "3", "1", "{2,", "3}", "2"]
    assert says(rows_of(MultiChannelSystem(**EXAMPLE))["stabilizable"], "linear time")


@pytest.mark.parametrize("rounding", ["decimal", "dyadic", "simplest"])
def test_an_answer_says_how_the_floats_of_its_plant_were_read(rounding: Any) -> None:
    plant = MultiChannelSystem.from_float([[1 / 3]], [[[1]]], [[[1]]], rounding=rounding)
    account, reading = account_of(plant), reading_in_words(rounding)
    assert account.reading == reading
    assert f"({reading})" in plain(tables(account.sentences, note=account.reading), width=WIDE)
    assert account.as_json()["system"]["rounding"] == rounding
    assert account.explain().endswith(f"floats: {reading}")
    assert reading in account._repr_html_() and reading in plant._repr_html_()
    assert ("source", reading) in shown_plant(plant)["rows"]


def test_an_answer_about_exact_numbers_says_nothing_of_floats() -> None:
    account = account_of(MultiChannelSystem([["1/3"]], [[[1]]], [[[1]]]))
    assert account.reading == "" and "rounding" not in account.as_json()["system"]
    assert "floats" not in account.explain() + account._repr_html_()


def test_nothing_is_fixed_is_said_in_words() -> None:
    rows = rows_of(MultiChannelSystem([[0]], [[[1]]], [[[1]]]))
    assert rows["fixed modes"] == "none"
    assert worded(rows["slowest fixed mode"])


@pytest.mark.parametrize(
    ("A", "time", "said"),
    [
        ([[1]], "continuous", "grows at the rate 1"),
        ([[-1]], "continuous", "decays at the rate 1"),
        ([[0]], "continuous", "does not decay"),
        ([[0, 1], [-1, 0]], "continuous", "does not decay"),
        ([[2]], "discrete", "becomes 2 times as large in each step"),
        ([["1/2"]], "discrete", "becomes 0.5 times as large in each step"),
        ([[-1]], "discrete", "does not decay"),
        ([[0, 1], [1, 1]], "continuous", "grows at the rate about 1.61803"),
        ([[0, 1], ["-99999999999997/100000000000000", 1]], "discrete", "decays very slowly"),
    ],
)
def test_a_fixed_mode_is_said_to_decay_or_to_grow_and_how_fast(A, time, said) -> None:
    n = len(A)
    plant = MultiChannelSystem(A, [[[0]] * n], [[[0] * n]], time=time)
    assert rows_of(plant)["slowest fixed mode"] == said


def test_modes_out_of_reach_and_inactive_channels_are_named() -> None:
    system = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [0]], [[0], [0]]], [[[1, 1]], [[1, 1]]])
    rows = rows_of(system)
    assert worded(rows["jointly controllable"])
    assert rows["inactive channels"].startswith("{2}:")


def test_eigenvalues_beside_a_fixed_mode_are_counted_and_not_called_assignable() -> None:
    # One strong component of degree 3, and yet one of the three eigenvalues is fixed.
    plant = gallery.load("davison-aghdam-miller-2020-p27")
    assert worded(rows_of(plant)["closed-loop spectrum"])
    assert rows_of(MultiChannelSystem(**EXAMPLE))["closed-loop spectrum"].startswith("2 of 3")


COMPLETE = {"1": ["2"], "2": ["1"]}


def test_sharing_is_said_to_be_in_vain_where_a_mode_is_not_controlled() -> None:
    plant = MultiChannelSystem(
        [[1, 0], [0, 2]], [[[1], [0]]] * 2, [[[1, 1]]] * 2, neighbors=COMPLETE
    )
    rows = rows_of(plant, minimal=True)
    assert worded(rows["sufficient to share"])
    assert "no dimensions suffice" in rows["least to share"]


def test_sharing_is_said_to_be_in_vain_where_a_mode_is_not_observed() -> None:
    plant = MultiChannelSystem(
        [[1, 0], [0, 2]], [[[1], [1]]] * 2, [[[1, 0]]] * 2, neighbors=COMPLETE
    )
    rows = rows_of(plant)
    assert says(rows["sufficient to share"], "together observe")


def test_without_a_strongly_connected_graph_no_bound_is_claimed() -> None:
    plant = MultiChannelSystem(**EXAMPLE, neighbors={"2": ["1"], "3": ["1"]})
    rows = rows_of(plant, minimal=True)
    assert worded(rows["sufficient to share"])
    assert rows["least to share"].startswith("outputs alone")


def test_what_the_agents_have_to_share_is_said_when_they_have_neighbors() -> None:
    plant = MultiChannelSystem(**EXAMPLE)
    rows = rows_of(plant.with_neighbors(NeighborGraph.ring(plant.names)), minimal=True)
    assert worded(rows["sufficient to share"])
    assert worded(rows["least to share"])


def test_set_points_are_not_promised_where_an_unstable_mode_is_out_of_reach() -> None:
    hidden = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [0]]], [[[1, 1]]])
    assert worded(rows_of(hidden)["set-points"])
    stable = MultiChannelSystem([[1, 0], [0, -2]], [[[1], [0]]], [[[1, 1]]])
    assert says(rows_of(stable)["set-points"], "centralized holds")


@pytest.mark.parametrize(("time", "place"), [("continuous", 0), ("discrete", 1)])
def test_an_invariant_zero_and_dependent_outputs_are_told_apart(time: str, place: int) -> None:
    A = [[place, 1], [-2, place - 3]]
    wash = MultiChannelSystem(A, [[[0], [1]]], [[[0, 1]]], time=time)
    assert says(rows_of(wash)["set-points"], "invariant zero")
    twice = MultiChannelSystem([["1/2"]], [[[1]], [[1]]], [[[1]], [[1]]], time=time)
    assert says(rows_of(twice)["set-points"], "move independently")
    few = MultiChannelSystem(A, [[[0], [1]]], [[[0, 1], [1, 0]]], time=time)
    assert rows_of(few)["set-points"].endswith("1 input for 2 outputs")


def test_the_ranks_for_a_subset_are_a_table_of_the_modes_of_A_proved_to_be_all() -> None:
    account = account_of(MultiChannelSystem(**EXAMPLE), subset=["2"])
    text = plain(tables(account.sentences), width=WIDE)
    assert "for s = {2}" in text
    assert "x - 1                2     yes" in text
    assert "spectrum_of_A.json" in account.certificates


def test_a_system_without_states_is_readable() -> None:
    assert "0 states" in text_of(MultiChannelSystem([], [[]], [[[]]]))


def test_long_numbers_are_rounded_and_never_cut() -> None:
    text = text_of(MultiChannelSystem([[10**3999 + 7]], [[[0]]], [[[1]]]))
    assert max(map(len, text.splitlines())) < 300
    assert "the mode about 1e+3999" in text


@pytest.mark.parametrize("name", ["[bold]u1[/bold]", "<script>alert(1)</script>"])
def test_markup_in_a_name_is_shown_and_not_obeyed(name: str) -> None:
    system = MultiChannelSystem([[1]], [[[1]]], [[[0]]], names=[name])
    stream = io.StringIO()
    show(tables(account_of(system).sentences), stream)
    assert name in text_of(system)
    assert name in stream.getvalue().replace("\n", "")


def test_indices_and_what_a_channel_reaches_are_said() -> None:
    plant = MultiChannelSystem(**EXAMPLE)
    rows = rows_of(plant, subset=["2", "3"], channel="1")
    assert rows["controllability indices"] == "2, 1; index 2"
    assert rows["remnant polynomial"] == "x - 1"
    assert rows["complete"].startswith("no")
    assert rows["observable with gains"] == "yes, index 2"
    assert rows["both with gains"].endswith("at the mode 1")


def test_gains_through_every_channel_are_announced() -> None:
    ring = MultiChannelSystem(
        [[1, 0], [0, 1]], [[[1], [0]], [[0], [1]]], [[[0, 1]], [[1, 0]]], names=["a", "b"]
    )
    rows = rows_of(ring, every_channel=True)
    assert rows["closed-loop spectrum"] == "freely assignable"
    assert rows["through every channel"] == "yes, indices 2 and 2, 2 and 2"


def test_indices_of_a_plant_beyond_the_limit_are_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    name = "controllability_indices"
    fewer = dict(QUESTIONS) | {name: replace(QUESTIONS[name], most=1)}
    monkeypatch.setattr(Analysis, "questions", fewer)
    system = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    rows = rows_of(system)
    assert rows["controllability indices"].startswith("left out")
    assert not rows["observability indices"].startswith("left out")


def test_of_many_factors_the_first_are_listed() -> None:
    n = 9
    diagonal = [[(k + 1) * (k == j) for j in range(n)] for k in range(n)]
    plant = MultiChannelSystem(diagonal, [[[0]] * n], [[[1] * n]])
    table = tables(account_of(plant).sentences, most_modes=6)[1]
    assert len(table.rows) == 6
    assert table.note.startswith("the first 6; the JSON document and the HTML page list all.")
    assert len(tables(account_of(plant).sentences)[1].rows) == n


def test_a_graph_with_delays_is_said_to_be_taken_without_them() -> None:
    graph = NeighborGraph.from_names(["1", "2"], {"1": ["2"], "2": ["1"]}, {"1": {"2": 2}})
    plant = MultiChannelSystem(
        [[2]], [[[1]], [[0]]], [[[0]], [[1]]], time="discrete", neighbors=graph
    )
    rows = rows_of(plant, minimal=True, links=True, information="outputs")
    assert rows["information"].endswith("received without delay")
    assert says(rows["stabilizable"], "neighbors delay")
    for label in ("sufficient to share", "least to share", "fewest links to add"):
        assert says(rows[label], "messages took")


def test_links_have_a_row_whenever_they_were_asked_for() -> None:
    free = MultiChannelSystem([[0]], [[[1]], [[1]]], [[[1]], [[1]]])
    assert rows_of(free, links=True)["fewest links to add"] == "none"
    lost = MultiChannelSystem([[1]], [[[0]], [[0]]], [[[1]], [[1]]])
    assert rows_of(lost, links=True)["fewest links to add"] == "no links suffice"


def said(system: MultiChannelSystem, **question: Any) -> list[str]:
    """The answer in sentences."""
    return answer(account_of(system, **question).sentences)


def test_the_answer_says_who_does_not_control_a_mode_and_who_does_not_observe_it() -> None:
    plant = MultiChannelSystem(
        [[1]], [[[1]], [[0]]], [[[0]], [[1]]], neighbors={"1": [], "2": ["1"]}
    )
    assert worded(said(plant, minimal=True))


def test_a_channel_without_effect_on_a_mode_is_not_said_to_reach_it() -> None:
    # s = {1, 2}, and B_2 misses the mode 1 as well.
    plant = MultiChannelSystem(
        [[1, 0], [0, 2]], [[[1], [0]], [[0], [1]], [[0], [0]]], [[[0, 1]], [[0, 1]], [[1, 1]]]
    )
    *_, told = said(plant)
    assert says(told, "control observe")
    assert "reach" not in told


def test_modes_that_no_channel_controls_or_observes_are_told_apart() -> None:
    lost = MultiChannelSystem([[1]], [[[0]], [[0]]], [[[1]], [[1]]])
    assert says(said(lost)[1], "together control")
    unseen = MultiChannelSystem([[1]], [[[1]], [[1]]], [[[0]], [[0]]])
    assert says(said(unseen)[1], "together observe")


def test_links_come_with_the_certificate_that_they_suffice_and_that_fewer_do_not() -> None:
    plant = gallery.load("liu2020-unimodular")
    account = account_of(plant)
    told = "Sending outputs along 3 → 2 leaves no mode fixed, and no fewer links do."
    assert told in answer(account.sentences)
    assert "minimal_communication.json" in account.certificates


def test_free_assignment_is_claimed_only_of_what_is_complete() -> None:
    chain = MultiChannelSystem([[0, 0], [1, 0]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]])
    assert says(said(chain)[1], "strong components")
    single = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    assert "any one channel" in said(single)[1]


@pytest.mark.parametrize("most", [1, 2, 3, 5, 9])
def test_no_sentence_is_cut(most: int) -> None:
    sentences = account_of(gallery.load("liu2020-3ch-no-communication"), links=True).sentences
    shown = in_lines(sentences, most)
    assert len(shown.splitlines()) <= most or not shown.strip()
    told = " ".join(shown.split())
    assert told == " ".join(answer(sentences)[: told.count(". ") + told.endswith(".")])


@pytest.mark.parametrize("name", gallery.names())
def test_the_answer_fits_a_terminal_and_eight_lines_of_words_come_first(name: str) -> None:
    sentences = account_of(gallery.load(name)).sentences
    words = in_lines(sentences, 8).splitlines()
    table = plain(tables(sentences, most_modes=6)).splitlines()
    shown = [*words, "", *table, "", "10 certificates re-checked"]
    assert 1 <= len(words) <= 8
    # where all channels together miss a mode, five lines more tell it from the other fixed modes
    most = 40 if any(line.startswith("  joint fixed modes") for line in table) else 35
    assert len(shown) <= most and max(map(len, shown)) <= 80
