"""The copy of the checker whose conditions can be left out."""

from __future__ import annotations

from pathlib import Path

from mcexact.checker.kinds import check_document
from tests.assurance.attack import weakened
from tests.assurance.attack.campaign import checked
from tests.assurance.attack.conditions import GATES, weakened_checker
from tests.assurance.attack.forgeries import TRAPS
from tests.assurance.attack.harmless import HARMLESS
from tests.assurance.attack.tries import drawn_batch, tries
from tests.assurance.attack.weakened import (
    UNEXPLAINED,
    UNTRIED,
    rows_by_condition,
    search,
    start_of,
    table,
)

WEAKENED = Path(weakened.__file__).parent / "WEAKENED.md"


def test_the_copy_says_what_the_checker_says() -> None:
    copy = weakened_checker().check_document
    GATES.open = None
    for number in range(4):
        for made in tries(number, drawn_batch(number)):
            found, expected = checked(made.document, copy), checked(made.document, check_document)
            assert found is not None
            assert expected is not None
            assert found.line() == expected.line()


def test_forgeries_pass_where_a_condition_is_left_out() -> None:
    sites, holes = search(2000, processes=1)
    assert len(sites) > 150
    assert len(holes.found) > 15
    by_hand = [found for found in holes.found.values() if found[0] < 0]
    assert len(by_hand) > 15 and {name for _, name, *_ in by_hand} <= TRAPS.keys()


def test_conditions_of_one_function_are_left_out_alone_and_other_rows_stay() -> None:
    sites, holes = search(0, processes=1, only=["_without_links"])
    assert {sites[k].function for k in holes.found} == {"_without_links"}
    untried = table(sites, holes, HARMLESS, only=["_without_links"])
    assert not any(UNTRIED in row for row in untried if "| `_without_links`" in row)
    assert any(UNTRIED in row for row in untried)
    text = WEAKENED.read_text(encoding="utf-8")
    rows = table(sites, holes, HARMLESS, text, ["_without_links"])
    kept = [row for row in rows if row.startswith("| `") and "| `_without_links`" not in row]
    assert len(kept) == len(sites) - 4 and {*kept} <= {*text.splitlines()}


def test_every_condition_has_a_row_and_every_row_a_hole_or_a_reason() -> None:
    weakened_checker()
    text = WEAKENED.read_text(encoding="utf-8")
    known = {start for _, start in rows_by_condition(text)}
    assert known == {start_of(site) for site in GATES.sites}
    assert UNEXPLAINED not in text and UNTRIED not in text


def test_what_is_explained_is_a_condition_of_the_checker() -> None:
    weakened_checker()
    assert HARMLESS.keys() <= {site.key for site in GATES.sites}
