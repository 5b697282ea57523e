"""A rate that nobody gave becomes slower where no controller is found."""

from dataclasses import replace
from functools import cache

import pytest

from mcexact import design_decentralized
from mcexact.errors import LimitReached
from mcexact.model import gallery
from mcexact.synthesis.design import Design
from mcexact.synthesis.gate import Request, Warned
from mcexact.synthesis.rate import at_a_reachable_rate, request_for

PLANT = gallery.load("lexalutyi-two-double-integrators")


@cache
def made() -> Design:
    return design_decentralized(PLANT, rate="1/4")


def counted(asked: Request, tried: list[Request], fails: int) -> Design:
    """A design the first attempts at which reach a limit."""
    tried.append(asked)
    if len(tried) <= fails:
        raise LimitReached(f"limit {len(tried)}")
    return replace(made(), region=asked.region, notes=asked.notes)


@pytest.mark.parametrize("fails", [0, 1, 2])
def test_a_chosen_rate_is_halved_until_a_controller_is_found(fails: int) -> None:
    chosen, tried = request_for(PLANT), list[Request]()
    slowed = at_a_reachable_rate(chosen, lambda asked: counted(asked, tried, fails))
    edges = [each.region.edge for each in tried]
    assert edges == [chosen.region.edge / 2**k for k in range(fails + 1)]
    assert slowed.region == tried[-1].region
    [note] = slowed.notes
    assert note.startswith(chosen.notes[0]) and ("no faster loop" in note) == bool(fails)


def test_the_first_limit_is_told_if_none_is_found() -> None:
    tried = list[Request]()
    with pytest.raises(LimitReached, match="limit 1"):
        at_a_reachable_rate(request_for(PLANT), lambda asked: counted(asked, tried, 9))
    assert len(tried) == 3


def test_a_given_rate_stays() -> None:
    given, tried = Request.of(PLANT, rate=1), list[Request]()
    with pytest.raises(LimitReached, match="limit 1"):
        at_a_reachable_rate(given, lambda asked: counted(asked, tried, 9))
    assert tried == [given]


def test_what_is_hard_is_told_once() -> None:
    told = list[str]()
    chosen = replace(request_for(PLANT), tell=told.append)

    def hard(asked: Request) -> Design:
        asked.tell(Warned(f"{asked.region} is hard"))
        raise LimitReached("a limit")

    with pytest.raises(LimitReached):
        at_a_reachable_rate(chosen, hard)
    assert told == [f"{chosen.region} is hard", "a slower rate", "a slower rate"]
