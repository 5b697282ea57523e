"""The line search accepts infinite values, and work is counted."""

import numpy as np
import pytest

from mcexact.synthesis.optimum.descent import minimize
from mcexact.synthesis.optimum.problem import Effort


def rosenbrock(x):
    a, b = x
    value = (1 - a) ** 2 + 100 * (b - a * a) ** 2
    return value, np.array([-2 * (1 - a) - 400 * a * (b - a * a), 200 * (b - a * a)])


def walled(x):
    """Infinite right of 1/2, where the slope still points to the wall."""
    return rosenbrock(x) if x[0] < 0.5 else (np.inf, x)


def pointed(x):
    """Not smooth at its minimum."""
    return float(np.abs(x[0]) + 3 * np.abs(x[1])), np.array([1.0, 3.0]) * np.sign(x)


@pytest.mark.parametrize(
    ("function", "start", "least"),
    [(rosenbrock, [-1.2, 1.0], 0.0), (walled, [-1.2, 1.0], 0.25), (pointed, [2.0, -1.7], 0.0)],
)
def test_a_minimum_is_found(function, start, least):
    _, value = minimize(function, np.array(start), steps=400, tolerance=1e-14)
    # Towards a wall, the steps become short before the least value.
    assert value == pytest.approx(least, abs=1e-2)


def test_an_infinite_start_is_returned():
    start = np.array([2.0, 0.0])
    x, value = minimize(walled, start)
    assert x is start and value == np.inf


def test_a_value_that_is_no_number_is_not_accepted():
    def torn(x):
        return (-x[0], np.array([-1.0])) if x[0] < 0.5 else (np.nan, np.array([0.0]))

    x, value = minimize(torn, np.array([0.0]))
    assert x[0] < 0.5 and value == -x[0]


def test_it_ends_when_told():
    calls = []

    def counted(x):
        calls.append(x)
        return rosenbrock(x)

    minimize(counted, np.array([-1.2, 1.0]), stop=lambda: True)
    assert len(calls) == 1
    _, value = minimize(rosenbrock, np.array([-1.2, 1.0]), enough=lambda value: value < 2)
    assert 0.01 < value < 2


def test_nothing_to_choose_is_no_error():
    x, value = minimize(lambda x: (3.0, x), np.zeros(0))
    assert not x.size and value == 3.0


def test_the_parts_of_an_effort_are_counted_in_the_whole():
    whole = Effort(1000.0)
    inner = whole.part(0.5).part(0.5)
    assert inner.limit == 250
    inner.take(48, times=100)
    assert inner.spent == whole.spent == 200
    assert not inner.over and whole.left == 800
    inner.take(0, times=900)
    assert inner.over and whole.over and whole.left == 0
