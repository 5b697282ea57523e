"""The page of designs is made of the rows that were measured."""

from typing import Any

import pytest

from benchmarks.design_page import PAGE, REMARKS, exceptions, page, reason, written
from benchmarks.kept_rows import ROWS, kept

DESIGNED: dict[str, Any] = {
    "name": "plant decentralized", "answer": "designed", "rate": "1/2", "order": 0, "gain": 2.0,
    "margin": 0.5, "cost": 1.2, "peak": 3.0, "digits": 2, "step": "static gains", "seconds": 0.5,
    "central": {"gain": 1.0, "margin": 0.6, "peak": 2.0, "cost": 10.0}, "machine": "a machine",
    "by hand": {
        "local LQR": {
            "order": 0, "gain": 1.0, "bound": -0.1, "margin": 0.4, "cost": 0.5, "peak": 1.0
        },
        "local LQG": None,
    },
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
        ({"margin": 0.02}, ["margin 0.02"]),
        ({"disk": 0.3}, ["disk margin 0.3"]),
        ({"disk": 0.41, "damping": 0.05, "over bound": 2.0}, []),
        ({"damping": 0.04}, ["damping 0.04"]),
        (
            {"slower": "Re λ < -1/4"},
            ["Re λ < -1/4, the fastest that was found with the margins"],
        ),
        ({"peak": 101.0}, ["peak 101"]),
        ({"gain": 11.0}, ["gain 11, 1 for all agents together"]),
        ({"cost": 11.0}, ["11 times the cost of one controller for all agents"]),
        ({"digits": 5}, ["5 digits"]),
        ({"digits": None}, ["more than 12 digits"]),
        ({"seconds": 61.0}, ["61 seconds"]),
        ({"rate": "1/20"}, ["dearer than local LQR, 0.50"]),
        ({"answer": "refused", "told": "no control moves it"}, []),
        ({"answer": "limit", "told": "nothing was found"}, ["nothing was found"]),
    ],
)
def test_exceptions_are_what_a_practitioner_should_know(changed, told) -> None:
    row = {**DESIGNED, **changed}
    assert exceptions(row) == told
    text = page({row["name"]: row}, {})
    above = text[: text.index("## Published plants")]
    assert all(each in above for each in told) and (row["name"] in above) == bool(told)


def test_an_exception_of_a_plant_that_is_fragile_in_one_hand_says_so() -> None:
    fragile = {**DESIGNED, "margin": 0.1, "central": {**DESIGNED["central"], "margin": 0.05}}
    assert reason(fragile) == "the margin of one controller for all agents is 0.05"
    assert reason(DESIGNED) == ""


def test_a_refusal_is_listed_with_its_reason() -> None:
    row = {"name": "stuck", "answer": "refused", "told": "no control moves it", "by hand": {},
           "seconds": 0.1, "machine": "a machine"}  # fmt: skip
    assert "| stuck | no control moves it | 0.1 |" in page({"stuck": row}, {})
