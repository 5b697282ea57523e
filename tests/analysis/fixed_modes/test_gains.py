"""Gains that make single channels reach a whole system: what is accepted has the properties."""

import random

import pytest

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.single_channel import error_gain_draws, reaching_gains
from mcexact.derived.constructions import error_system, feedback
from mcexact.derived.drawn.networks import drawn_graph
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.derived.drawn.systems import jointly_controllable_system
from mcexact.exact.linear_algebra import minimal_polynomial, rank
from mcexact.exact.matrix import Matrix, hstack
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from tests.synthesis.three_channels import three_channels


def errors_of(system, graph, seed):
    """An error system for drawn F_i, and the draws for it."""
    rng = random.Random(seed)
    F = [
        Matrix.from_integers(
            [[rng.randint(-1, 1) for _ in range(system.n)] for _ in range(system.p(i))],
            ncols=system.n,
        )
        for i in range(system.m)
    ]
    return error_system(system, F, graph), error_gain_draws(system, graph, F)


def hold_to(error, found, channels, index):
    """Check every property over Q, by means that the search does not use."""
    closed = feedback(error, found.gains)
    assert closed.A == found.matrix
    assert minimal_polynomial(closed.A).degree == error.n
    for q, reached, seen in zip(
        channels, found.controllability_indices, found.observability_indices, strict=True
    ):
        name = [error.names[q]]
        assert joint_controllability(closed, name).controllable
        assert joint_observability(closed, name).controllable
        assert reached == index
        for M, B, nu in ((closed.A, error.B(q), reached), (closed.A.T, error.C(q).T, seen)):
            blocks = [B]
            for _ in range(nu - 1):
                blocks.append(M @ blocks[-1])
            assert rank(hstack(blocks)) == error.n
            assert rank(hstack([Matrix.zeros(error.n, 0), *blocks[:-1]])) < error.n


def test_every_agent_of_the_paper_reaches_all_errors_with_index_m():
    system = three_channels()
    error, draw = errors_of(system, system.neighbors, 0)
    found = next(reaching_gains(error, [0, 1, 2], draw, index=3))
    hold_to(error, found, [0, 1, 2], 3)
    assert found.largest <= 20


@pytest.mark.parametrize("seed", range(12))
def test_proposition_1_on_drawn_strongly_connected_graphs(seed):
    rng, choices = random.Random(seed), SeededChoices(f"gains {seed}")
    m = rng.randint(2, 4)
    system = jointly_controllable_system(choices, rng.randint(1, 3), m).system
    graph = drawn_graph(choices, system.names, strongly_connected=True)
    error, draw = errors_of(system, graph, seed)
    found = next(reaching_gains(error, range(m), draw, index=m))
    hold_to(error, found, range(m), m)


def test_nothing_is_accepted_where_nothing_exists():
    system = MultiChannelSystem([[1]], [[[1]], [[0]]], [[[0]], [[1]]])
    error, draw = errors_of(system, NeighborGraph.empty(("1", "2")), 0)
    assert list(reaching_gains(error, [0], draw)) == []


def test_the_same_question_gets_the_same_gains():
    system = three_channels()
    error, draw = errors_of(system, system.neighbors, 0)
    first, second = (next(reaching_gains(error, [0], draw)) for _ in range(2))
    assert first.gains == second.gains
