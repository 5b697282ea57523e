"""What the tables say of floating-point designs, verdicts and cross-checks."""

import json

import pytest

from mcexact.crosschecks.demonstration import (
    Demonstration,
    FloatingAnswers,
    demonstration_text,
    demonstration_view,
)
from mcexact.crosschecks.gallery import (
    crosscheck_tables,
    crosscheck_view,
    exhibit,
    exhibit_tables,
    exhibits_page,
    exhibits_view,
    shown,
)
from mcexact.crosschecks.table import Libraries, crosscheck
from mcexact.model import gallery
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.report.text import measured, plain, tables
from mcexact.synthesis.assessment import assess
from mcexact.synthesis.certify import account_of_verdict, certify_controller
from mcexact.synthesis.distributed_observer import design_observer
from tests.report.strict_html import Page, external_addresses
from tests.synthesis.three_channels import three_channels
from tests.wording import says, worded


def test_what_is_proved_stands_apart_from_what_is_measured():
    design = design_observer(three_channels(), rate=1, arithmetic="float")
    said = design.account.sentences
    [proved] = tables(said)
    figures = measured(design.measures(), assess(design).rows(), said, discrete=False)
    assert "certified" in proved.title and "not certified" in figures.title
    assert worded(figures.title) and not figures.note
    told = {row[0]: row[1] for row in figures.rows}
    assert {"margin at the plant's inputs", "numerical abscissa"} <= told.keys()
    assert "no eigenvalue" in told["numerical abscissa"]
    assert ("every eigenvalue of the loop", "Re λ < -1") in proved.rows


def test_infinite_margins_are_null_in_json():
    plant = MultiChannelSystem([], [[]], [[]], neighbors={"1": []})
    design = design_observer(plant, rate=1, arithmetic="float")
    view = design.to_dict()
    assert view["floating_point"]["distance_to_instability"] is None
    json.dumps(view, allow_nan=False)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"rate": 1}, "by the characteristic polynomial"),
        ({"rate": 1, "method": "lyapunov"}, "by Lyapunov matrices"),
        ({"rate": 3, "method": "lyapunov"}, "not every one"),
        ({"largest": True}, "largest rate found"),
    ],
)
def test_a_verdict_says_how_it_was_decided(options, words):
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    found = certify_controller(plant, local_controllers(plant, [[[-3]]]), **options)
    account = account_of_verdict(found, largest="largest" in options)
    assert words in plain(tables(account.sentences))


def test_blocks_are_listed():
    plant = three_channels()
    design = design_observer(plant, agent="1", rate=1, arithmetic="float")
    found = certify_controller(plant, design.controller, rate=1, method="lyapunov")
    assert "blocks of 3, 9 and 9 states" in plain(tables(account_of_verdict(found).sentences))


@pytest.mark.parametrize(
    "name", ["compleib-tg1", "hidden-triple-mode", "compleib-he3", "quadruple-tank-pminus"]
)
def test_the_cross_check_counts_its_disagreements(name):
    found = crosscheck(gallery.load(name))
    count = len(found.disagreements)
    said = "no disagreement" if not count else f"{count} wrong in floating point"
    text = plain(crosscheck_tables(found), width=10**6)
    assert said in text and text.count("DISAGREE") == count
    json.dumps(crosscheck_view(found), allow_nan=False)


ELSEWHERE = Libraries((("numpy", "1.26"), ("OpenBLAS", "0.3.23")), "Haswell")
HERE = Libraries((("numpy", "2.4"), ("OpenBLAS", "0.3.31")), None)


def test_an_exhibit_shows_its_record_beside_what_this_machine_says():
    weak, zero = shown(exhibit("weak-input")), shown(exhibit("siljak-two-subsystems-farina"))
    answers, machines, reasons = exhibit_tables([weak, zero])
    assert answers.rows[0] == (
        "weak-input",
        "joint controllability",
        *("no, rank 1 of 2", "no, rank 1 of 2", "yes, rank 2 of 2"),
    )
    assert answers.rows[1][2:] == ("yes", zero.here.floating, "no")
    assert {row[0]: row[1] for row in machines.rows} == {
        "recorded": str(weak.exhibit.record.libraries),
        "here": str(weak.libraries),
    }
    assert [name for name, _ in reasons.rows] == ["weak-input", "siljak-two-subsystems-farina"]
    json.dumps(exhibits_view([weak, zero]), allow_nan=False)


def test_the_page_of_the_exhibits_names_the_machines_and_needs_no_other_file():
    weak = shown(exhibit("weak-input"))
    text = exhibits_page([weak])
    assert Page(text).text and not external_addresses(text)
    assert f"Recorded with {weak.exhibit.record.libraries}." in text
    assert f"Here: {weak.libraries}." in text
    assert "no, rank 1 of 2" in text and "yes, rank 2 of 2" in text


def test_the_cross_check_of_an_exhibit_shows_the_record_too():
    text = plain(crosscheck_tables(crosscheck(exhibit("weak-input").make())))
    assert says(text, "recorded wrong")
    found = crosscheck(MultiChannelSystem([[1]], [[[1]]], [[[1]]]))
    assert "recorded" not in plain(crosscheck_tables(found))
    assert crosscheck_view(found)["exhibits"] == []


@pytest.mark.parametrize(
    ("rank", "none", "words"),
    [
        (7, 200, "they are the same"),
        (8, 200, "1. matrix_rank([B AB ... A^19B]) = 8"),
        (7, 199, "2. eigenvalues of 5 drawn closed loops, rounded to 6 digits: none, in 199 of"),
    ],
)
def test_the_demonstration_tells_what_is_other_on_this_machine(rank, none, words):
    recorded = FloatingAnswers(7, ((6, 200),), ELSEWHERE)
    here = FloatingAnswers(rank, ((6, none),), HERE)
    demonstration = Demonstration(20, "plant", (("x - 1", 3),), recorded, here)
    before, _, after = demonstration_text(demonstration).partition("On this machine")
    assert words in after and str(HERE) in after and "kernel unknown" in after
    assert str(ELSEWHERE) in before and "(x - 1)^3" in before
    view = demonstration_view(demonstration)["numpy"]
    assert view["recorded"]["rank"] == 7 and view["here"]["rank"] == rank
