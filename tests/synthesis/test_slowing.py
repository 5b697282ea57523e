"""A rate that nobody gave becomes slower where the loop would be fragile."""

from dataclasses import replace
from functools import cache

import pytest

from mcexact import design_decentralized
from mcexact.errors import LimitReached
from mcexact.model import gallery
from mcexact.synthesis.design import Design
from mcexact.synthesis.gate import Request, Warned
from mcexact.synthesis.rate import at_a_robust_rate, request_for

PLANT = gallery.load("lexalutyi-two-double-integrators")


@cache
def made() -> Design:
    """A design whose figures are replaced."""
    return design_decentralized(PLANT, rate="1/4")


def with_margin(
    asked: Request, margin: float, searched: bool = True, central: float = 0.1
) -> Design:
    """A design whose loop has a margin, by a search or not, and that of one controller for all."""
    found = made().parts["optimum"]
    for_all = replace(found.central, margin=central)
    found = replace(found, figures=replace(found.figures, margin=margin), central=for_all)
    parts = {**made().parts, "optimum": found} if searched else {}
    return replace(made(), region=asked.region, notes=asked.notes, parts=parts)


def counted(asked: Request, tried: list[Request], fails: int) -> Design:
    """A design the first attempts at which reach a limit."""
    tried.append(asked)
    if len(tried) <= fails:
        raise LimitReached(f"limit {len(tried)}")
    return with_margin(asked, 0.5)


@pytest.mark.parametrize(
    ("margins", "searched", "kept"),
    [
        ([0.4], True, 0),
        ([0.02, 0.15, 0.31], True, 2),
        ([0.1, 0.2, 0.05], True, 1),
        ([0.02], False, 0),
    ],
)
def test_a_fragile_loop_becomes_slower(margins, searched, kept):
    chosen, left = request_for(PLANT), list(margins)
    slowed = at_a_robust_rate(chosen, lambda asked: with_margin(asked, left.pop(0), searched))
    assert not left and slowed.region.edge == chosen.region.edge / 2**kept
    [note] = slowed.notes
    assert note.startswith(chosen.notes[0]) and ("no faster loop" in note) == bool(kept)


@pytest.mark.parametrize(
    ("margins", "kept"),
    [([0.02, 0.06, 0.1, 0.35], 3), ([0.02, 0.06, 0.1, 0.2, 0.25], 4), ([0.1, 0.2, 0.3], 2)],
)
def test_it_becomes_slower_still_where_one_controller_for_all_is_robust(
    margins: list[float], kept: int
) -> None:
    chosen, left = request_for(PLANT), list(margins)
    slowed = at_a_robust_rate(chosen, lambda asked: with_margin(asked, left.pop(0), central=0.7))
    assert not left and slowed.region.edge == chosen.region.edge / 2**kept


@pytest.mark.parametrize("fails", [0, 1, 2])
def test_a_chosen_rate_is_halved_until_a_controller_is_found(fails):
    chosen, tried = request_for(PLANT), list[Request]()
    slowed = at_a_robust_rate(chosen, lambda asked: counted(asked, tried, fails))
    edges = [each.region.edge for each in tried]
    assert edges == [chosen.region.edge / 2**k for k in range(fails + 1)]
    assert slowed.region == tried[-1].region


def test_the_first_limit_is_told_if_none_is_found():
    tried = list[Request]()
    with pytest.raises(LimitReached, match="limit 1"):
        at_a_robust_rate(request_for(PLANT), lambda asked: counted(asked, tried, 9))
    assert len(tried) == 3


def test_a_given_rate_stays():
    given, tried = Request.of(PLANT, rate=1), list[Request]()
    with pytest.raises(LimitReached, match="limit 1"):
        at_a_robust_rate(given, lambda asked: counted(asked, tried, 9))
    assert tried == [given]


def test_what_is_hard_is_told_once():
    told = list[str]()
    chosen = replace(request_for(PLANT), tell=told.append)

    def hard(asked: Request) -> Design:
        asked.tell(Warned(f"{asked.region} is hard"))
        return with_margin(asked, 0.1)

    at_a_robust_rate(chosen, hard)
    assert told == [f"{chosen.region} is hard", "a slower rate", "a slower rate"]
