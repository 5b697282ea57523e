"""Corners of boxes: where a loop fails first, and loops that are stable there, too."""

from __future__ import annotations

import re
from fractions import Fraction

import numpy as np
import pytest

from mcexact.analysis.boxes.largest import failing_loop
from mcexact.analysis.boxes.loops import StabilitySearch
from mcexact.analysis.boxes.samples import Held
from mcexact.derived.sampling import sampled_system
from mcexact.exact.matrix import Matrix, matrix_to_float
from mcexact.exact.roots import StabilityRegion
from mcexact.model.box import Box
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.decentralized import design_decentralized
from mcexact.synthesis.networks import decentralized_network, shared_network
from mcexact.synthesis.optimum.corners import Corner, Corners
from mcexact.synthesis.optimum.figures import Aims
from mcexact.synthesis.optimum.problem import Effort, FeedbackProblem, Weights, controller_of

TWO = MultiChannelSystem(
    [[1, "1/2", 0], [0, -1, 2], ["1/3", 1, -3]],
    [[[1], [0], ["1/4"]], [[0], [1], [1]]],
    [[[1, 0, "1/5"]], [[0, 1, 0], [0, 0, 1]]],
    neighbors=NeighborGraph.complete(("1", "2")),
)
SAMPLED = MultiChannelSystem(
    [["1.1", "0.1"], ["0.2", "0.7"]], [[[1], ["0.2"]]], [[[1, 0], ["0.1", 1]]], time="discrete"
)
DECAYING = np.array([-1.0, 0.3, -0.4, 0.2, -0.1])


def problems() -> list[tuple[FeedbackProblem, np.ndarray]]:
    """Loops that are stable, of structures with and without shared states."""
    weights = Weights.unit(TWO)
    static = FeedbackProblem.of(decentralized_network(TWO), (0, 0), weights)
    K = np.zeros(static.mask.shape)
    K[0, static.agents[0].own], K[1, static.agents[1].own] = -4.0, [-1.0, -0.5]
    assert TWO.neighbors is not None
    network = shared_network(TWO, TWO.neighbors, (1, 0), "outputs+states", "extended")
    sharing = FeedbackProblem.of(network, (0, 1), weights)
    L = np.where(sharing.mask, 0.05, 0.0)
    L[0, sharing.agents[0].own] = -4.0
    for row, columns in enumerate(sharing.columns_of_states, start=sharing.p):
        L[row, columns] = -2.0
    one = FeedbackProblem.of(decentralized_network(SAMPLED), (0,), Weights.unit(SAMPLED))
    return [(static, K), (sharing, L), (one, np.array([[-0.6, -0.1]]))]


@pytest.mark.parametrize("number", range(3))
def test_a_member_is_the_problem_of_the_plant_at_the_corner(number: int) -> None:
    problem, K = problems()[number]
    plant, graph = problem.network.plant, problem.network.graph
    corners = Corners.of(problem)
    [(distance, corner), *_] = corners.failing(K, Effort(1e4))
    box = Box.relative(plant, Fraction(1))
    n = plant.n
    member = corners.member(corner, distance)
    assert all(set(np.unique(M)) <= {-1.0, 0.0, 1.0} for M in corner.signs)
    # The same plant, with its entries moved, gives the same loop by the package's exact model.
    factor = Fraction(distance).limit_denominator(10**6)

    def moved(M, D, S):
        rows = [
            [x + factor * int(s) * d for x, d, s in zip(*row, strict=True)]
            for row in zip(M.rows(), D.rows(), S, strict=True)
        ]
        return rows

    p = np.cumsum([0, *(plant.p(i) for i in range(plant.m))])
    q = np.cumsum([0, *(plant.q(i) for i in range(plant.m))])
    far = MultiChannelSystem(
        moved(plant.A, box.radii.A, corner.A),
        [moved(plant.B(i), box.radii.B[i], corner.B[:, p[i] : p[i + 1]]) for i in range(plant.m)],
        [moved(plant.C(i), box.radii.C[i], corner.C[q[i] : q[i + 1]]) for i in range(plant.m)],
        time=plant.time,
        neighbors=plant.neighbors,
    )
    exact = closed_loop(far, controller_of(problem, K), graph).matrix
    values = np.sort_complex(np.linalg.eigvals(np.array(exact.rows(), dtype=float)))
    assert n and np.allclose(
        np.sort_complex(np.linalg.eigvals(member.closed(K))), values, atol=1e-4
    )
    # It is on the border of stability.
    size = np.max(np.abs(values)) - 1 if problem.discrete else np.max(values.real)
    assert abs(size) < 1e-2


@pytest.mark.parametrize("number", range(3))
def test_corners_fail_about_where_linear_programs_find_plants_that_fail(number: int) -> None:
    problem, K = problems()[number]
    plant = problem.network.plant
    [(distance, _), *_] = Corners.of(problem).failing(K, Effort(1e4))
    loop = closed_loop(
        Box.relative(plant, 1).system, controller_of(problem, K), problem.network.graph
    )
    search = StabilitySearch(loop, StabilityRegion(plant.time))
    nearest = failing_loop(search, 4)
    assert nearest is not None
    assert min(each for each, _ in search.margins()) <= 1.01 * distance
    assert distance <= 1.1 * float(nearest.distance)


def test_a_corner_beyond_the_box_does_not_fail() -> None:
    plant = MultiChannelSystem([[-1]], [[[1]]], [[[1]]])
    problem = FeedbackProblem.of(decentralized_network(plant), (0,), Weights.unit(plant))
    assert Corners.of(problem).failing(np.array([[-0.1]]), Effort(100)) == []


CARTS = MultiChannelSystem(
    [[0, 1, 0], [-2, "-1/2", 1], [1, 0, "-1/2"]],
    [[[0], [1], ["1/4"]], [[0], [0], [1]]],
    [[[1, "1/2", 0]], [[0, 0, 1], [1, 0, 1]]],
)
GAINS = np.array([[-0.5, 0.0, 0.0], [0.0, -0.6, -0.1]])


@pytest.mark.parametrize("late", [0, 1, 2])
def test_a_corner_of_a_sampled_plant_is_one_in_continuous_time(late: int) -> None:
    sampled = sampled_system(CARTS, "1/5", late)
    problem = FeedbackProblem.of(decentralized_network(sampled), (0, 0), Weights.unit(sampled))
    corners = Corners.of(problem)
    [(distance, corner), *_] = corners.failing(GAINS, Effort(1e4))
    factor, box = Fraction(distance).limit_denominator(10**6), Box.relative(CARTS, 1).radii

    def moved(M: Matrix, D: Matrix, S: np.ndarray) -> list[list[Fraction]]:
        entries = zip(M.rows(), D.rows(), S.tolist(), strict=True)
        return [[x + factor * int(s) * d for x, d, s in zip(*row, strict=True)] for row in entries]

    far = MultiChannelSystem(
        moved(CARTS.A, box.A, corner.A),
        [moved(CARTS.B(i), box.B[i], corner.B[:, [i]]) for i in range(2)],
        [
            moved(CARTS.C(0), box.C[0], corner.C[:1]),
            moved(CARTS.C(1), box.C[1], corner.C[1:]),
        ],
    )
    exact = closed_loop(sampled_system(far, "1/5", late), controller_of(problem, GAINS)).matrix
    seen = corners.member(corner, float(factor)).closed(GAINS)
    assert np.allclose(seen, matrix_to_float(exact), atol=1e-9)
    assert abs(np.max(np.abs(np.linalg.eigvals(seen))) - 1) < 1e-4
    # no corner that was drawn is nearer
    rng = np.random.default_rng(late)
    for _ in range(10):
        signs = (rng.choice([-1.0, 1.0], M.shape) for M in corner.signs)
        assert corners.distance(GAINS, Corner(*signs)) >= distance - 1e-6


@pytest.mark.slow
def test_a_box_of_a_sampled_plant_is_an_aim_of_a_search() -> None:
    sampled = sampled_system(CARTS, "1/5", 1)
    wide = design_decentralized(sampled, aims=Aims(effort=1, box=Fraction(3, 20)))
    around = wide.every_loop()
    assert around.part is not None and around.failing is not None
    (seen,) = re.findall(r"within about ([0-9.]+) % of each entry: .* 15 %", wide.notes[-1])
    assert float(around.part) < float(seen) / 90 and float(seen) < 100 * around.failing.distance
    near = design_decentralized(sampled, aims=Aims(effort=1, box=Fraction(1, 20)))
    assert near.every_loop(part=Fraction(1, 20)).part == Fraction(1, 20)
    assert not any("of each entry" in note for note in near.notes)


@pytest.mark.parametrize("late", [0, 1])
def test_slopes_of_a_sampled_plant_are_those_of_differences(late: int) -> None:
    held = Held(np.array([[0.0, 1.0, 0.2], [-2.0, -0.5, 1.0]]), 0.3, bool(late))
    rng = np.random.default_rng(3)
    W, moved = rng.normal(size=(2, 3)) + 1j * rng.normal(size=(2, 3)), rng.normal(size=(2, 3)) / 9
    slopes = held.slopes(moved, W)
    for i, j in np.ndindex(2, 3):
        unit = np.zeros((2, 3))
        unit[i, j] = 1e-6
        change = held.change(moved + unit) - held.change(moved - unit)
        assert abs(np.sum(W * change) / 2e-6 - slopes[i, j]) < 1e-6
