"""What the sentences say that rest on a theorem is so, decided on drawn plants in other ways."""

from __future__ import annotations

import random
from functools import reduce

import pytest

from mcexact.analysis.fixed_spectrum import fixed_spectrum
from mcexact.derived.extended import extended_system
from mcexact.derived.feedback import feedback
from mcexact.derived.integrators import setpoint_system
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.report.assessment import Assessment, assess
from mcexact.report.assessment_tables import assessment_tables, bound_holds, movable
from tests.answer.test_sentences import drawn

SEEDS = range(0, 120, 10)


def plants(start: int) -> list[MultiChannelSystem]:
    """Ten drawn plants, all with a neighbor graph."""
    return [
        plant
        if plant.neighbors is not None
        else plant.with_neighbors(NeighborGraph.ring(plant.names))
        for plant in map(drawn, range(start, start + 10))
    ]


def row(assessment: Assessment, label: str) -> str:
    [found] = [value for name, value in assessment_tables(assessment)[0].rows if name == label]
    return found


def one_channel(system: MultiChannelSystem) -> MultiChannelSystem:
    """The system with all channels in one hand."""
    B, C = system.input_matrix(), system.output_matrix()
    return MultiChannelSystem(system.A, [B], [C], time=system.time)


@pytest.mark.parametrize("start", SEEDS)
def test_set_points_can_be_held_iff_the_plant_with_integrators_can_be_stabilized(
    start: int,
) -> None:
    for plant in plants(start):
        said = row(assess(plant), "set-points")
        centralized = fixed_spectrum(one_channel(setpoint_system(plant)))
        assert said.startswith("centralized control holds") == centralized.stabilizable, said


def drawn_loop(plant: MultiChannelSystem, rng: random.Random) -> Polynomial:
    """The characteristic polynomial under drawn gains."""
    F = [
        Matrix.from_rows(
            [[rng.randint(-99, 99) for _ in range(plant.q(i))] for _ in range(plant.p(i))],
            ncols=plant.q(i),
        )
        for i in range(plant.m)
    ]
    return characteristic_polynomial(feedback(plant, F).A)


@pytest.mark.parametrize("start", SEEDS)
def test_as_many_eigenvalues_are_said_to_move_as_drawn_gains_do_move(start: int) -> None:
    rng = random.Random(start)
    for plant in plants(start):
        least, most = movable(assess(plant))
        loops = [characteristic_polynomial(plant.A), *(drawn_loop(plant, rng) for _ in range(4))]
        stays = reduce(Polynomial.gcd, loops).degree
        assert least <= plant.n - stays <= most


@pytest.mark.parametrize("start", SEEDS)
def test_what_is_said_to_be_enough_to_share_leaves_nothing_fixed(start: int) -> None:
    for plant in plants(start):
        assessment = assess(plant)
        if not bound_holds(assessment):
            continue
        for share, bound in assessment.shared_dimension_bounds.items():
            sizes = [bound.per_agent] * plant.m
            assert fixed_spectrum(extended_system(plant, sizes, share)).empty


@pytest.mark.parametrize("start", SEEDS)
def test_what_no_amount_of_sharing_frees_stays_with_much_of_it(start: int) -> None:
    for plant in plants(start):
        assessment = assess(plant)
        lost = [
            found.uncontrollable_polynomial
            for found in (assessment.controllability, assessment.observability)
            if not found.controllable
        ]
        if not lost:
            continue
        names = plant.names
        complete = {name: [other for other in names if other != name] for name in names}
        everybody = plant.with_neighbors(NeighborGraph.from_names(names, complete))
        stays = fixed_spectrum(extended_system(everybody, [2] * plant.m, "outputs+states"))
        for polynomial in lost:
            for factor, _ in polynomial.factor():
                assert factor.divides(stays.polynomial)
