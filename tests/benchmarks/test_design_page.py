"""The page of designs is made of the rows that were measured."""

from fractions import Fraction
from typing import Any

import pytest

from benchmarks.design_page import PAGE, REMARKS, exceptions, page, ratio_of, reason, written
from benchmarks.designed_rows import beyond_all
from benchmarks.kept_rows import ROWS, Row, kept
from mcexact.model.system import MultiChannelSystem
from tests.wording import says, worded

DESIGNED: dict[str, Any] = {
    "name": "plant decentralized", "answer": "designed", "rate": "1/2", "states": 3, "order": 1,
    "proved ratio": 1.25, "ratio": 1.25, "least": 8.0, "why not": {}, "disk": 0.5,
    "disk is proved": True, "joint": 0.4, "damping": 0.3, "margin": 0.4, "box": 0.02,
    "fails within": 0.1, "digits": 2, "step": "static gains", "install": "yes",
    "first line": "Worth installing", "warnings": [], "seconds": 0.5, "machine": "a machine",
    "by hand": {
        "local LQR": {"order": 0, "over bound": 3.5, "disk": 0.1},
        "local LQG": None,
        "python-control": {"order": 3, "over bound": 1.0, "disk": 0.9},
    },
}  # fmt: skip
BEFORE: dict[str, Any] = {
    "name": "plant decentralized", "answer": "designed", "order": 4, "cost": 2.0,
    "central": {"cost": 12.0}, "install": "yes",
}  # fmt: skip


def test_the_page_is_the_one_of_the_rows() -> None:
    """After a run: ``python -m benchmarks.design_page``."""
    assert PAGE.read_text(encoding="utf-8") == written()


def test_what_is_remarked_on_is_an_exception() -> None:
    known = kept(ROWS / "gallery_designs.jsonl") | kept(ROWS / "families.jsonl")
    assert all(exceptions(known[name]) for name in REMARKS)


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({}, []),
        ({"proved ratio": 2.5, "ratio": 2.5}, ["cost/bound 2.5"]),
        (
            {"proved ratio": None, "why not": {"cost_bound": "no proof was found"}},
            ["cost/bound is not proved (cost bound: no proof was found)"],
        ),
        ({"disk": 0.3}, ["disk margin 0.3"]),
        ({"disk": None}, ["disk margin –"]),
        ({"disk": 0.4, "damping": 0.05, "proved ratio": 2.0}, []),
        ({"damping": 0.04}, ["damping 0.04"]),
        ({"seconds": 61.0}, ["61 seconds"]),
        ({"install": "no"}, ["not to be installed"]),
        ({"install": "with care"}, ["with care"]),
        ({"answer": "theorem"}, ["the controller of the theorem"]),
        ({"answer": "refused", "told": "no control moves it"}, []),
        ({"answer": "limit", "told": "nothing was found"}, ["no controller: nothing was found"]),
    ],
)
def test_exceptions_are_what_a_practitioner_should_know(changed, told) -> None:
    row = {**DESIGNED, **changed}
    assert exceptions(row) == told
    text = page({row["name"]: row}, {}, {})
    above = text[text.index("## Exceptions") : text.index("## Published plants")]
    assert all(each in above for each in told) and (row["name"] in above) == bool(told)


def test_an_exception_of_a_plant_that_is_fragile_in_one_hand_says_so() -> None:
    hand: dict[str, Any] = {"python-control": {"order": 3, "over bound": 1.0, "disk": 0.05}}
    row: dict[str, Any] = {**DESIGNED, "by hand": hand, "warnings": ["a margin is low"]}
    assert worded(reason(row)) and "0.05" in reason(row)
    assert reason(DESIGNED) == ""


def test_an_exception_says_what_the_search_finds_for_one_agent() -> None:
    low: dict[str, Any] = {"disk": 0.06, "install": "no"}
    row, alone = {**DESIGNED, **low, "disk": 0.004}, {**DESIGNED, **low}
    told = "by the same search one controller for all agents has disk margin 0.06, do not install"
    assert reason(row, alone) == told
    assert f"| {told} |" in page({row["name"]: row}, {}, {}, {row["name"]: alone})
    assert reason(DESIGNED, alone) == ""
    assert says(
        reason({**row, "fails within": 0.005}, {**alone, "fails within": 0.005}), "plants fail"
    ) and "0.5" in reason({**row, "fails within": 0.005}, {**alone, "fails within": 0.005})
    none: Row = {"answer": "limit", "told": "nothing was found"}
    assert says(reason(row, none), "agents nothing")


def test_a_cost_of_set_points_stands_over_a_bound_without_them() -> None:
    row = {**DESIGNED, "name": "plant setpoint", "ratio": 20.0}
    assert worded(reason(row))


def test_a_plant_nearby_that_no_controller_stabilizes_is_a_reason() -> None:
    row = {**DESIGNED, "install": "with care", "beyond all": 0.00036, "warnings": ["it fails"]}
    told = "stabilizes a plant within 0.036 % of each entry (proved); it fails"
    assert worded(reason(row)) and told in reason(row)
    assert "beyond all" not in reason({**row, "beyond all": None})


def test_no_controller_stabilizes_a_plant_whose_unstable_mode_is_fixed_for_all_agents() -> None:
    plant = MultiChannelSystem([[1, 0], [0, -1]], [[["1/10"], [1]]], [[[1, 1]]])
    assert beyond_all(plant) == 1
    near = MultiChannelSystem([[1, 1], [1, 1]], [[[1], ["9/10"]]], [[[1, 0]]])
    part = beyond_all(near)
    assert part is not None and part < Fraction(1, 5)


def test_a_refusal_is_listed_with_its_reason_and_counts_nowhere() -> None:
    row: Row = {"name": "stuck decentralized", "answer": "refused", "told": "no control moves it",
           "by hand": {}, "seconds": 0.1, "machine": "a machine"}  # fmt: skip
    text = page({"stuck decentralized": row, "plant decentralized": DESIGNED}, {}, {})
    assert says(text, "stuck moves") and "0.1" in text
    assert says(text, "requests median") and "1.25" in text


def test_a_limit_counts_as_an_infinite_cost() -> None:
    row: Row = {"name": "lost decentralized", "answer": "limit", "told": "nothing was found",
           "by hand": {}, "seconds": 9.0, "machine": "a machine"}  # fmt: skip
    assert ratio_of(row) == float("inf") and ratio_of(DESIGNED) == 1.25
    text = page({row["name"]: row}, {}, {})
    assert "median of cost/bound inf" in text and "| lost decentralized | ∞ |" in text


def test_what_was_recorded_before_stands_beside_over_the_same_bound() -> None:
    text = page({DESIGNED["name"]: DESIGNED}, {}, {BEFORE["name"]: BEFORE})
    assert "| plant decentralized | 1.25 (3) | 0.5 | 0.4 | 0.3 | 2 % | 1 (4) | 0.5 |" in text
    assert "before 3 of 1, computed" in text and "worth installing 1 (before 1" in text
    assert "| 3.5, 0.1 | not stable | 1, 0.9 |" in text


def test_requests_that_are_not_measured_are_named() -> None:
    other = {**BEFORE, "name": "other decentralized"}
    rows = {each["name"]: each for each in (BEFORE, other)}
    text = page({DESIGNED["name"]: DESIGNED}, {}, rows)
    assert "Not measured yet, 1 of 2 requests: other decentralized." in text


def test_rows_that_no_longer_are_worth_installing_are_counted_by_why() -> None:
    lost = {**DESIGNED, "name": "lost decentralized", "install": "with care"}
    beyond = {**DESIGNED, "name": "beyond extended", "install": "no", "beyond all": 0.002}
    new = {**DESIGNED, "name": "new extended"}
    rest = {**DESIGNED, "name": "rest 10 continuous"}
    before = {each["name"]: {**BEFORE, "name": each["name"]} for each in (DESIGNED, lost, beyond)}
    before[new["name"]] = {**BEFORE, "name": new["name"], "install": "no"}
    rows = {each["name"]: each for each in (DESIGNED, lost, beyond, new)}
    text = page(rows, {rest["name"]: rest}, before)
    assert "recorded for 4 rows. 3 of them were" in text and "and 1 of these 3 are so now" in text
    assert "besides 1 others of the 4 (new extended) and 1 rows without" in text
    assert says(text, "longer cannot") and "proved (beyond extended)" in text
    assert says(text, "lost decentralized")
