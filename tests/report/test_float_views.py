"""What the tables say of floating-point designs, verdicts and cross-checks."""

import json

import pytest

from mcexact.crosscheck.table import crosscheck
from mcexact.model import gallery
from mcexact.model.local_controllers import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.report.certify_view import verdict_tables, verdict_view
from mcexact.report.crosscheck_view import crosscheck_tables, crosscheck_view
from mcexact.report.observer_float_view import (
    design_margins,
    observer_float_tables,
    observer_float_view,
)
from mcexact.report.text import plain
from mcexact.synthesis.certify import certify_controller
from mcexact.synthesis.observer import design_observer
from tests.synthesis.three_channels import three_channels


def test_what_is_proved_stands_apart_from_what_is_measured():
    design = design_observer(three_channels(), rate=1, arithmetic="float")
    proved, measured = observer_float_tables(design, design_margins(design))
    assert "certified" in proved.title and "not proved" in measured.title
    assert ("every eigenvalue of the loop", "Re λ < -1") in proved.rows


def test_infinite_margins_are_null_in_json():
    plant = MultiChannelSystem([], [[]], [[]], neighbors={"1": []})
    design = design_observer(plant, rate=1, arithmetic="float")
    view = observer_float_view(design, design_margins(design))
    assert view["floating_point"]["distance_to_instability"] is None
    json.dumps(view, allow_nan=False)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"rate": 1}, "by the characteristic polynomial"),
        ({"rate": 1, "method": "lyapunov"}, "by Lyapunov matrices"),
        ({"rate": 3, "method": "lyapunov"}, "no, not every one"),
        ({"largest": True}, "largest rate found"),
    ],
)
def test_a_verdict_says_how_it_was_decided(options, words):
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    found = certify_controller(plant, local_controllers(plant, [[[-3]]]), **options)
    assert words in plain(verdict_tables(found))
    assert verdict_view(found)["certified"] is found.verdict.stable


def test_blocks_are_listed():
    plant = three_channels()
    design = design_observer(plant, rate=1, arithmetic="float")
    found = certify_controller(plant, design.controller, rate=1, method="lyapunov")
    assert "blocks of 3, 9 and 9 states" in plain(verdict_tables(found))


@pytest.mark.parametrize(
    "name", ["compleib-tg1", "hidden-triple-mode", "compleib-he3", "quadruple-tank-pminus"]
)
def test_the_cross_check_counts_its_disagreements(name):
    found = crosscheck(gallery.load(name))
    count = len(found.disagreements)
    said = "no disagreement" if not count else f"{count} wrong in floating point"
    text = plain(crosscheck_tables(found))
    assert said in text and text.count("DISAGREE") == count
    json.dumps(crosscheck_view(found), allow_nan=False)
