"""Agents that look alike use one program, and a search moves all of them at once."""

import numpy as np
import pytest

from mcexact import design_extended
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.networks import decentralized_network, shared_network
from mcexact.synthesis.optimum import search
from mcexact.synthesis.optimum.descent import Objective
from mcexact.synthesis.optimum.problem import FeedbackProblem, Weights, balanced
from mcexact.synthesis.optimum.starts import drawn_dynamics, tied


def string(m, time="continuous", masses=None):
    """Vehicles in a row that measure the distance to the one before and talk to the next ones."""
    A = np.kron(np.eye(m), [[0.0, 1.0], [0.0, 0.0]])
    A = A if time == "continuous" else np.eye(2 * m) + A / 5
    B = [np.eye(2 * m)[:, [2 * i + 1]] * (masses[i] if masses else 1.0) for i in range(m)]
    C = [np.eye(2 * m)[[2 * i]] - (np.eye(2 * m)[[2 * i - 2]] if i else 0) for i in range(m)]
    names = [str(i) for i in range(m)]
    heard = {a: [names[j] for j in (i - 1, i + 1) if 0 <= j < m] for i, a in enumerate(names)}
    plant = MultiChannelSystem.from_float(A, B, C, time=time, rounding="decimal", names=names)
    return plant.with_neighbors(NeighborGraph.from_names(names, heard))


def shared(plant, orders):
    given = [1] * plant.m
    network = shared_network(plant, plant.neighbors, given, "outputs+states", "extended")
    return FeedbackProblem.of(network, orders, Weights.unit(plant))


def ring(m):
    """Equal agents in a ring, each of which hears the one before."""
    A = -np.eye(m) + 0.3 * np.roll(np.eye(m), 1, axis=0)
    unit = np.eye(m)
    names = [str(i) for i in range(m)]
    plant = MultiChannelSystem.from_float(
        A, [unit[:, [i]] for i in range(m)], [unit[[i]] for i in range(m)],
        rounding="decimal", names=names,
    )  # fmt: skip
    return plant.with_neighbors(NeighborGraph.ring(plant.names))


def test_vehicles_between_others_use_one_program():
    plant = string(6)
    free = shared(plant, (1,) * 6)
    alike = tied(free, Weights.unit(plant))
    first, middle, last = (
        len(free.agents[i].rows) * len(free.agents[i].columns) for i in (0, 2, 5)
    )
    assert alike.size == first + middle + last < free.size
    K = alike.gain(np.arange(1.0, alike.size + 1))
    used = [K[np.ix_(agent.rows, agent.columns)] for agent in alike.agents]
    assert (used[1] == used[2]).all() and (used[2] == used[4]).all()
    assert used[0].shape != used[1].shape


def test_where_agents_stand_counts_around_the_end_of_their_order():
    plant = ring(5)
    weights = Weights.unit(plant)
    network = shared_network(plant, plant.neighbors, (0,) * 5, "outputs+states", "extended")
    alike = tied(FeedbackProblem.of(network, (0,) * 5, weights), weights)
    assert alike.size == 2
    M = alike.loop(np.array([-2.0, 3.0]))
    turned = np.roll(np.roll(M, 1, axis=0), 1, axis=1)
    assert np.allclose(M, turned)


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_the_values_of_a_gain_are_what_it_was_made_from(time):
    plant = string(5, time)
    alike = tied(shared(plant, (2,) * 5), Weights.unit(plant))
    x = np.linspace(-1, 1, alike.size)
    assert np.allclose(alike.entries(alike.gain(x)), x)
    assert not alike.gain(x)[~alike.mask].any()


def test_the_value_of_drawn_entries_is_that_of_the_agent_in_the_middle():
    plant = string(7)
    free = shared(plant, (1,) * 7)
    alike = tied(free, Weights.unit(plant))
    K = drawn_dynamics(free, 0)
    found, typical = alike.gain(alike.entries(K)), free.agents[3]
    where = np.ix_(typical.rows, typical.columns)
    assert np.allclose(found[where], K[where])


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_the_gradient_is_that_of_the_values(time):
    plant = string(4, time)
    alike = tied(shared(plant, (1,) * 4), Weights.unit(plant))
    rng = np.random.default_rng(0)
    x = 0.3 * rng.standard_normal(alike.size)
    # A region that holds every loop, so that the cost is finite.
    bound = np.max(np.abs(np.linalg.eigvals(alike.loop(x))))
    scale = 0.5 / bound if time == "discrete" else 1.0
    moved = FeedbackProblem(**{
        **{each: getattr(alike, each) for each in alike.__dataclass_fields__},
        "A": alike.A * scale if time == "discrete" else alike.A - 2 * bound * np.eye(len(alike.A)),
        "B": alike.B * scale,
    })  # fmt: skip
    objective = Objective(moved, 0.9 if time == "discrete" else 0.1)
    value, gradient = objective(x)
    assert np.isfinite(value) and gradient.shape == x.shape
    for k in range(0, alike.size, 7):
        step = np.zeros(alike.size)
        step[k] = 1e-6
        slope = (objective(x + step)[0] - objective(x - step)[0]) / 2e-6
        assert slope == pytest.approx(gradient[k], rel=1e-4, abs=1e-5 * abs(value))


def test_agents_of_other_numbers_look_alike_and_those_of_other_structure_do_not():
    masses = [1.0, 0.5, 2.0, 3.0, 1.5]
    plant = string(5, masses=masses)
    assert tied(shared(plant, (1,) * 5), Weights.unit(plant)).size < shared(plant, (1,) * 5).size
    different = MultiChannelSystem(
        [[1, 0, 0], [0, 2, 1], [0, 0, 1]], [[[1], [0], [0]], [[0], [0], [1]]],
        [[[1, 0, 0]], [[0, 1, 0]]],
    )  # fmt: skip
    weights = Weights.unit(different)
    free = FeedbackProblem.of(decentralized_network(different), (1, 1), weights)
    assert tied(free, weights) is free


def test_tied_agents_are_not_scaled_one_by_one():
    plant = string(5)
    alike = tied(shared(plant, (1,) * 5), Weights.unit(plant))
    K = alike.gain(np.geomspace(1e-3, 1e3, alike.size))
    assert (balanced(alike, K) == K).all()
    assert (balanced(alike.untied, K) != K).any()


@pytest.mark.parametrize("bound", [{"rate": "1/5"}, {"radius": "24/25"}])
def test_a_long_string_is_designed_with_one_program_for_the_vehicles_between(bound, monkeypatch):
    monkeypatch.setattr(search, "MOST_STATES", 8)
    plant = string(5, "continuous" if "rate" in bound else "discrete")
    made = design_extended(plant, arithmetic="float", **bound)
    found = made.parts["optimum"]
    assert found.figures.margin >= 0.3 and found.relative_cost < 3
    assert found.problem.ties is None
