"""The controller of all agents together, cut: whole where agents know everything."""

import numpy as np
import pytest

from mcexact.exact.roots import StabilityRegion
from mcexact.model.graph import NeighborGraph
from mcexact.synthesis.networks import decentralized_network, shared_network
from mcexact.synthesis.optimum.figures import central_optimum, figures_of, shift_of
from mcexact.synthesis.optimum.problem import FeedbackProblem, Weights
from mcexact.synthesis.optimum.starts import (
    Locality,
    cut_gains,
    cut_observers,
    held_states,
    localities,
    regulator,
    whole_model,
)
from tests.synthesis.optimum.plants import NAMES, coupled

TIMES = ("continuous", "discrete")


def complete(time):
    everyone = {name: [other for other in NAMES if other != name] for name in NAMES}
    return coupled(time).with_neighbors(NeighborGraph.from_names(NAMES, everyone))


@pytest.mark.parametrize("time", TIMES)
@pytest.mark.parametrize("bound", [None, "9/10"])
def test_agents_that_hear_everything_are_together_the_optimal_controller(time, bound):
    plant = complete(time)
    region, weights = StabilityRegion.of(time, bound=bound), Weights.unit(plant)
    held = [(0,), (1, 2), (3,)]
    network = shared_network(
        plant, plant.neighbors, [len(each) for each in held], "outputs+states", "extended"
    )
    problem = FeedbackProblem.of(network, (0, 0, 0), weights)
    K = cut_observers(problem, held, whole_model(problem, weights), shift_of(region))
    found, central = figures_of(problem, K), central_optimum(plant, weights, region).figures
    assert found.cost == pytest.approx(central.cost)
    assert found.margin == pytest.approx(central.margin, rel=1e-2)
    assert found.bound == pytest.approx(central.bound, rel=1e-4)


@pytest.mark.parametrize("time", TIMES)
def test_agents_that_hear_nothing_use_their_own_outputs_alone(time):
    plant = coupled(time)
    weights = Weights.unit(plant)
    problem = FeedbackProblem.of(decentralized_network(plant), (1, 2, 1), weights)
    held = held_states(localities(problem, weights, driven=True))
    assert sorted(sum(held, ())) == [0, 1, 2, 3]
    K = cut_observers(problem, held, whole_model(problem, weights), shift_of(StabilityRegion(time)))
    assert K.any()
    assert not K[~problem.mask].any()


@pytest.mark.parametrize("time", TIMES)
def test_static_gains_of_all_states_are_the_regulator(time):
    """Where the outputs of each agent are all states, its gains are its rows of the regulator."""
    plant = complete(time)
    full = type(plant).from_float(
        np.array(plant.A.rows(), dtype=float),
        [np.array(plant.B(i).rows(), dtype=float) for i in range(3)],
        [np.eye(4)] * 3,
        rounding="dyadic",
        time=time,
    )
    weights = Weights.unit(full)
    problem = FeedbackProblem.of(decentralized_network(full), (0, 0, 0), weights)
    model, shift = whole_model(problem, weights), shift_of(StabilityRegion(time))
    K = cut_gains(problem, model, shift)
    M = problem.loop(problem.entries(K))

    assert np.allclose(M, problem.A + model.B @ regulator(model, shift), atol=1e-9)


def test_no_state_is_held_twice():
    parts = [Locality((0, 1), None), Locality((1, 2), None)]
    assert held_states(parts) == [(0, 1), (2,)]
