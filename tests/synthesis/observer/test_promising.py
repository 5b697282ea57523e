"""Observers in discrete time honor the radius asked for."""

from itertools import islice

import pytest

from mcexact import design_observer
from mcexact.exact.roots import StabilityRegion
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.assessment import assess
from mcexact.synthesis.observer import rounds


def vehicles() -> MultiChannelSystem:
    """Two sampled vehicles; each agent pushes one, the second measures the distance."""
    step = ["1", "1/10"]
    A = [[*step, 0, 0], [0, 1, 0, 0], [0, 0, *step], [0, 0, 0, 1]]
    B = [[["1/200"], ["1/10"], [0], [0]], [[0], [0], ["1/200"], ["1/10"]]]
    C = [[[1, 0, 0, 0]], [[-1, 0, 1, 0]]]
    return MultiChannelSystem(A, B, C, time="discrete", neighbors={"1": ["2"], "2": ["1"]})


def test_a_loop_is_not_much_faster_than_asked():
    found = assess(design_observer(vehicles(), radius="0.99", arithmetic="float"))
    assert 0.96 <= found.figures.bound < 0.99
    assert found.figures.margin >= 0.3


@pytest.mark.parametrize("errors", [4, 100, 1000])
@pytest.mark.parametrize("radius", [None, "99/100", "1/100000", "99999/100000"])
def test_every_target_lies_inside_the_region_and_today_s_come_last(radius, errors):
    region = StabilityRegion.of("discrete", radius=radius)
    found = list(rounds(region, errors))
    assert all(0 < target.edge < region.edge for each in found for target, _ in each.targets)
    assert [each.ranked for each in found[-3:]] == [False] * 3
    assert [each.targets[0][0] for each in found[-3:]] == [
        region.tightened(each) for each in _PARTS
    ]


_PARTS = [StabilityRegion.of("discrete", radius=each).edge for each in ("1/4", "1/16", "1/256")]


def test_in_continuous_time_nothing_changed():
    region = StabilityRegion.of("continuous", rate=2)
    (first,) = islice(rounds(region, 10), 1)
    assert first.targets == ((StabilityRegion.of("continuous", rate="5/2"), 1.0),)
