"""The copy of the checker whose conditions can be left out."""

from __future__ import annotations

from mcexact.checker.kinds import check_document
from tests.assurance.attack.campaign import checked
from tests.assurance.attack.conditions import GATES, weakened_checker
from tests.assurance.attack.forgeries import TRAPS
from tests.assurance.attack.harmless import HARMLESS
from tests.assurance.attack.tries import drawn_batch, tries
from tests.assurance.attack.weakened import search


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


def test_what_is_explained_is_a_condition_of_the_checker() -> None:
    weakened_checker()
    assert HARMLESS.keys() <= {site.key for site in GATES.sites}
