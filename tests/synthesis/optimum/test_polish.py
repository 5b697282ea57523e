"""Ways from a start into a region."""

from fractions import Fraction

import numpy as np
import pytest

from mcexact.exact.roots import StabilityRegion
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.networks import decentralized_network
from mcexact.synthesis.optimum.descent import Target, bound_of, calmed, inside, settled
from mcexact.synthesis.optimum.figures import Eigenvalues
from mcexact.synthesis.optimum.problem import Effort, FeedbackProblem, Weights


def problem_with(A, orders=(0,), time="continuous") -> FeedbackProblem:
    """A plant of two states, of which one agent measures and drives the first."""
    plant = MultiChannelSystem(A, [[[1], [0]]], [[[1, 0]]], time=time)
    return FeedbackProblem.of(decentralized_network(plant), orders, Weights.unit(plant))


def test_agents_that_disturb_each_other_are_calmed():
    problem = problem_with([[-1, 1], [1, -2]])
    x = np.array([3.0])
    assert bound_of(problem, x) > 0
    found, bound = calmed(problem, x, Effort(100))
    assert 0 < found[0] < 3 and bound < 0 and bound == bound_of(problem, found)


def test_what_an_unstable_plant_needs_is_not_reduced():
    problem = problem_with([[1, 1], [0, -2]])
    x = np.array([-0.5])
    found, bound = calmed(problem, x, Effort(100))
    assert found.tolist() == x.tolist() and bound == bound_of(problem, x)


def test_a_stable_loop_stays_as_it_is():
    problem = problem_with([["-1/2", "1/4"], ["1/4", "1/2"]], time="discrete")
    x, effort = np.array([0.5]), Effort(100)
    assert calmed(problem, x, effort)[0].tolist() == [0.5] and effort.spent == 0


def test_a_search_gets_inside_from_a_start_that_disturbs():
    problem = problem_with([[-1, 1], [1, -2]], orders=(1,))
    target = Target(StabilityRegion("continuous", Fraction(1)))
    x = inside(problem, np.array([5.0, 1.0, 1.0, -1.0]), target, Effort(20_000))
    assert x is not None and target.reached(bound_of(problem, x))


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_a_stable_loop_outside_gets_cheaper_until_it_is_inside(time):
    A = [["-1/10", 1], [0, -2]] if time == "continuous" else [["9/10", 1], [0, "1/10"]]
    problem = problem_with(A, time=time)
    target = Target(StabilityRegion.of(time, bound="1/2"))
    found = settled(problem, np.array([0.0]), target, Effort(1e4))
    assert target.reached(bound_of(problem, found))


def test_only_a_stable_loop_outside_is_settled():
    problem = problem_with([[-1, 1], [1, -2]])
    target = Target(StabilityRegion.of("continuous", bound="1/5"))
    for x in (np.array([3.0]), np.array([-3.0])):
        assert target.reached(bound_of(problem, x)) == (x[0] < 0)
        effort = Effort(1e4)
        assert settled(problem, x, target, effort).tolist() == x.tolist() and not effort.spent


@pytest.mark.parametrize("c", [1.0, 1j, 2 - 1j])
def test_slopes_of_eigenvalues_are_those_of_differences(c):
    problem = problem_with([[0, 1], [-2, -1]], orders=(1,))
    K = np.array([[-0.3, 0.7], [0.4, -1.1]])
    seen = Eigenvalues.of(problem, problem.closed(K))
    for k, value in enumerate(seen.values):
        slope = seen.slope(k, c)
        for i, j in np.ndindex(K.shape):
            moved = K.copy()
            moved[i, j] += 1e-6
            others = Eigenvalues.of(problem, problem.closed(moved)).values
            nearest = others[np.argmin(abs(others - value))]
            assert abs((c * (nearest - value)).real / 1e-6 - slope[i, j]) < 1e-4
