"""What designs say of every loop in a box around theirs."""

from __future__ import annotations

import itertools
import time
from fractions import Fraction

import pytest

from mcexact import MultiChannelSystem, certify_controller, check
from mcexact.analysis.boxes import largest
from mcexact.boxes import Box
from mcexact.derived.sampling import sampled_system
from mcexact.designs import local_controllers
from mcexact.errors import UsageError
from mcexact.exact.roots import StabilityRegion
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.synthesis.decentralized import design_decentralized
from mcexact.synthesis.robustness import SIX_DIGITS, every_loop
from tests.wording import says

PLANT = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
WHOLE = StabilityRegion("continuous")


def loop(plant: MultiChannelSystem = PLANT, gain: str = "-3") -> ClosedLoop:
    """The loop of a plant with one state and a gain."""
    return closed_loop(plant, local_controllers(plant, [[[gain]]]))


def test_the_box_is_proved_and_a_plant_outside_of_it_fails() -> None:
    found = every_loop(loop(), WHOLE)
    assert found.proof is not None and found.part is not None and found.failing is not None
    assert Fraction(1, 5) < found.part < Fraction(1, 3) < found.failing.distance
    assert check(found.proof, Box.relative(PLANT, found.part).system).valid
    assert found.gains == SIX_DIGITS and found.proof.gain_radii is not None
    assert not certify_controller(found.failing.plant, loop().controller).stable
    assert not dict(found.rows()) and found.failing.refutation is not None
    refuted = found.failing.refutation
    assert check(refuted, found.failing.plant).valid and refuted.claim()["stable"] is False
    view = found.to_dict()
    assert view["certified"] and view["reason"] is None and view["gains"] == "1/100000"
    assert "every loop" in found._repr_html_() and repr(found).startswith(
        "EveryLoop(proved: Re λ < 0 within "
    )
    assert found.explain() == found.proof.explain()


def test_the_radii_of_a_plant_are_the_box_and_its_rate_comes_first() -> None:
    given = Box.absolute(PLANT, A=[["1/2"]]).system
    found = every_loop(loop(given), StabilityRegion("continuous", Fraction(1)))
    assert str(found.region) == "Re λ < -1" and found.proof is not None and found.part is None
    assert found.proof.about.plant == given
    found = every_loop(loop(given), StabilityRegion("continuous", Fraction(9, 5)))
    assert str(found.region) == "Re λ < 0" and found.proof is not None
    assert found.failing is not None and found.failing.distance <= 4 and not dict(found.rows())


def test_a_box_that_is_too_large_is_not_proved() -> None:
    found = every_loop(loop(Box.absolute(PLANT, A=[[3]]).system), WHOLE)
    assert found.proof is None and found.failing is not None and found.failing.distance < 1
    assert says(found.explain(), "proved radii")
    assert says(found.reason, "asks work")
    assert dict(found.rows())["eigenvalues of every loop"] == found.reason
    assert repr(found) == "EveryLoop(not proved: Re λ < 0)"
    assert found.to_dict()["part"] is None and "not proved" in found._repr_html_()


def test_a_fragile_loop_has_a_small_box_and_an_unstable_one_none() -> None:
    fragile = every_loop(loop(gain="-1.000000001"), WHOLE)
    assert fragile.part is not None and fragile.part < Fraction(1, 10**9)
    assert fragile.gains is None
    assert every_loop(loop(gain="-1"), WHOLE).proof is None


def test_large_loops_are_left_out() -> None:
    n = 81
    rows = [[-1 if i == j else 0 for j in range(n)] for i in range(n)]
    ones = [[1] for _ in range(n)]
    plant = MultiChannelSystem(rows, [ones], [rows])
    found = every_loop(closed_loop(plant, local_controllers(plant, [[[0] * n]])), WHOLE)
    told = "not tried, as the loop has 163 signals; `mcexact certify --uncertainty 0.1%` asks"
    assert found.proof is None and found.reason.startswith(told)


def test_little_work_proves_a_smaller_box_and_no_work_none() -> None:
    large, small = every_loop(loop(), WHOLE), every_loop(loop(), WHOLE, effort=0.004)
    assert large.part is not None and small.part is not None and small.part < large.part
    assert small.failing is not None and small.gains == SIX_DIGITS
    none = every_loop(loop(), WHOLE, effort=0)
    assert none.proof is None and none.failing is not None
    assert says(none.reason, "asks work")
    with pytest.raises(UsageError):
        every_loop(loop(), WHOLE, effort=-1)


def test_the_part_that_is_asked_for_is_tried_first() -> None:
    most = every_loop(loop(), WHOLE).part
    assert most is not None and most > Fraction(1, 50)
    assert every_loop(loop(), WHOLE, part=Fraction(1, 50)).part == Fraction(1, 50)
    assert every_loop(loop(), WHOLE, part=Fraction(99, 100)).part == most


def test_after_its_deadline_a_search_begins_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    late = every_loop(loop(), WHOLE, deadline=time.monotonic())
    assert late.proof is None and late.failing is None and not late.margins
    assert says(dict(late.rows())["eigenvalues of every loop"], "limit ended")
    ticks = itertools.count()
    monkeypatch.setattr(time, "monotonic", lambda: float(next(ticks)))
    short = every_loop(loop(), WHOLE, deadline=3.0)
    assert short.proof is None and short.failing is not None and next(ticks) < 20


def test_a_search_about_samples_ends_with_its_deadline_too() -> None:
    plant = sampled_system(PLANT, "1/10")
    about = closed_loop(plant, local_controllers(plant, [[[-3]]]))
    assert every_loop(about, StabilityRegion("discrete")).proof is not None
    late = every_loop(about, StabilityRegion("discrete"), deadline=time.monotonic())
    assert late.proof is None and late.failing is None and not late.margins
    assert says(late.reason, "limit ended")


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_a_design_says_for_which_box_it_holds(time: str) -> None:
    plant = MultiChannelSystem([[2]], [[[1]]], [[[1]]], time=time)
    design = design_decentralized(plant)
    around = design.every_loop()
    account = design.account_with(around)
    assert around.proof is not None and "box_stability.json" in account.certificates
    [told] = [each for each in account.sentences if each.template.key == "members-in-region-part"]
    assert says(told, "plant within") and "6 digits, however rounded" in told
    assert "box_stability.json" not in design.account.certificates


def test_a_loop_with_numbers_that_are_no_floats_is_left_out() -> None:
    plant = MultiChannelSystem([["-1e400"]], [[[1]]], [[[1]]])
    found = every_loop(closed_loop(plant, local_controllers(plant, [[[0]]])), WHOLE)
    assert found.proof is None and found.reason.startswith("not tried: ")


def test_a_plant_that_fails_differs_in_short_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    plant = MultiChannelSystem(
        [["1/3", "2/7", 1], [0, "-5/11", "1/13"], ["1/17", 1, "-3/19"]],
        [[[1], [0], [0]], [[0], ["1/23"], [1]]],
        [[[1, "1/9", 0]], [[0, 0, 1]]],
    )
    about = closed_loop(plant, local_controllers(plant, [[["-10/7"]], [["-12/11"]]]))
    short = every_loop(about, WHOLE).failing
    monkeypatch.setattr(largest, "_LONG", 10**6)
    border = every_loop(about, WHOLE).failing
    assert short is not None and border is not None
    assert border.distance < short.distance < border.distance * Fraction(10001, 10000)
    lengths = [
        max(len(str(x)) for row in each.plant.A.rows() for x in row) for each in (short, border)
    ]
    assert lengths[0] < 25 < 100 < lengths[1]
    assert short.refutation is not None and check(short.refutation, short.plant).valid


@pytest.mark.parametrize("states", [21, pytest.param(61, marks=pytest.mark.slow)])
def test_a_large_loop_has_a_plant_that_fails_a_little_beyond_the_border(states: int) -> None:
    agents = 21
    rows = [[0] * states for _ in range(states)]
    for i in range(states):
        rows[i][i] = 1 if i < agents else -1
    B = [[[int(i == k)] for i in range(states)] for k in range(agents)]
    C = [[[int(i == k) for i in range(states)]] for k in range(agents)]
    plant = MultiChannelSystem(rows, B, C)
    about = closed_loop(plant, local_controllers(plant, [[["-3"]]] * agents))
    failing = every_loop(about, WHOLE, effort=0).failing
    # 1 + d = 3 (1 − d)² has the root d = 1/3.
    assert failing is not None and 1 / 3 < failing.distance < 0.334
    assert failing.refutation is not None and check(failing.refutation, failing.plant).valid
    largest_change = max(
        abs(x - y)
        for one, other in zip(failing.plant.A.rows(), plant.A.rows(), strict=True)
        for x, y in zip(one, other, strict=True)
    )
    assert largest_change <= failing.distance
