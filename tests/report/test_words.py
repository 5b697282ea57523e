"""The answer in plain words: true for multiple modes, and never more than it may be long."""

import pytest

from mcexact.model import gallery
from mcexact.model.system import MultiChannelSystem
from mcexact.report.assessment import assess
from mcexact.report.assessment_tables import assessment_tables
from mcexact.report.text import plain
from mcexact.report.words import answer, in_lines


def test_the_answer_says_who_does_not_control_a_mode_and_who_does_not_observe_it() -> None:
    plant = MultiChannelSystem(
        [[1]], [[[1]], [[0]]], [[[0]], [[1]]], neighbors={"1": [], "2": ["1"]}
    )
    assert answer(assess(plant, minimal=True)) == [
        "The plant cannot be stabilized by linear time-invariant decentralized control: the "
        "slowest fixed mode grows at the rate 1.",
        "No sharing over the neighbor graph frees every mode.",
        "The mode 1 (once in A) is fixed: channel 2 does not control it, channel 1 does not "
        "observe it, and no constant gains help.",
    ]


def test_a_channel_without_effect_on_a_mode_is_not_said_to_reach_it() -> None:
    # s = {1, 2}, and B_2 misses the mode 1 as well.
    plant = MultiChannelSystem(
        [[1, 0], [0, 2]], [[[1], [0]], [[0], [1]], [[0], [0]]], [[[0, 1]], [[0, 1]], [[1, 1]]]
    )
    [told] = answer(assess(plant))[1:]
    assert "channel 3 does not control it, channels 1 and 2 do not observe it" in told
    assert "reach" not in told


def test_modes_that_no_channel_controls_or_observes_are_told_apart() -> None:
    lost = MultiChannelSystem([[1]], [[[0]], [[0]]], [[[1]], [[1]]])
    assert answer(assess(lost))[1].endswith("all channels together do not control it.")
    unseen = MultiChannelSystem([[1]], [[[1]], [[1]]], [[[0]], [[0]]])
    assert answer(assess(unseen))[1].endswith("all channels together do not observe it.")


def test_links_come_with_the_certificate_that_they_suffice_and_that_fewer_do_not() -> None:
    plant = gallery.load("liu2020-unimodular")
    assert not any("Sending" in told for told in answer(assess(plant)))
    asked = assess(plant, links=True)
    assert "Sending outputs along 3 → 2 leaves no mode fixed, and no fewer links do." in answer(
        asked
    )
    assert "minimal_communication.json" in asked.certificates()


def test_free_assignment_is_claimed_only_of_what_is_complete() -> None:
    chain = MultiChannelSystem([[0, 0], [1, 0]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]])
    assert "in parts, one for each of 2 strong components" in answer(assess(chain))[1]
    single = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    assert "any one channel" in answer(assess(single))[1]


@pytest.mark.parametrize("most", [1, 2, 3, 5, 9])
def test_no_sentence_is_cut(most: int) -> None:
    assessment = assess(gallery.load("liu2020-3ch-no-communication"), links=True)
    shown = in_lines(assessment, most)
    assert len(shown.splitlines()) <= most or not shown.strip()
    sentences = answer(assessment, 8)
    told = " ".join(shown.split())
    assert told == " ".join(sentences[: told.count(". ") + told.endswith(".")])


@pytest.mark.parametrize("name", gallery.names())
def test_the_answer_fits_a_terminal_and_five_lines_of_words_come_first(name: str) -> None:
    assessment = assess(gallery.load(name))
    words = in_lines(assessment, 5).splitlines()
    table = plain(assessment_tables(assessment, most_factors=6)).splitlines()
    shown = [*words, "", *table, "", "10 certificates re-checked"]
    assert 1 <= len(words) <= 5
    assert len(shown) <= 30 and max(map(len, shown)) <= 80
