"""What the sentences say that rest on a theorem is so, decided on drawn plants in other ways."""

from __future__ import annotations

import random
import re
from functools import reduce

import pytest

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.answer.account import Account
from mcexact.derived.constructions import Share, extended_system, feedback, setpoint_system
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from tests.answer.asking import account_of
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


def row(account: Account, label: str) -> str:
    [found] = [each for each in account.sentences.at("table") if each.template.label == label]
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
        said = row(account_of(plant), "set-points")
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


def movable(account: Account) -> tuple[int, int]:
    """How many eigenvalues are said to move, at least and at most."""
    said = row(account, "closed-loop spectrum")
    if numbers := [int(number) for number in re.findall(r"\d+", said.partition(" of ")[0])]:
        return numbers[0], numbers[-1]
    return account.given.n, account.given.n


@pytest.mark.parametrize("start", SEEDS)
def test_as_many_eigenvalues_are_said_to_move_as_drawn_gains_do_move(start: int) -> None:
    rng = random.Random(start)
    for plant in plants(start):
        least, most = movable(account_of(plant))
        loops = [characteristic_polynomial(plant.A), *(drawn_loop(plant, rng) for _ in range(4))]
        stays = reduce(Polynomial.gcd, loops).degree
        assert least <= plant.n - stays <= most


@pytest.mark.parametrize("start", SEEDS)
def test_what_is_said_to_be_enough_to_share_leaves_nothing_fixed(start: int) -> None:
    for plant in plants(start):
        account = account_of(plant)
        for told in account.sentences:
            if told.template.key.startswith(("enough-outputs", "enough-states", "enough-nothing")):
                [(name, _, k), *_] = told.because[-1:]
                share: Share = "outputs+states" if "outputs" in name else "states"
                assert fixed_spectrum(extended_system(plant, [k] * plant.m, share)).empty


@pytest.mark.parametrize("start", SEEDS)
def test_a_mode_that_no_sharing_allows_to_move_is_fixed_with_much_of_it(start: int) -> None:
    for plant in plants(start):
        account = account_of(plant)
        told = [each for each in account.sentences if "no sharing allows" in each]
        reach = (account.answers["joint_controllability"], account.answers["joint_observability"])
        lost = [found.uncontrollable_polynomial for found in reach if not found.controllable]
        assert len(told) == len(lost)
        if not lost:
            continue
        names = plant.names
        complete = {name: [other for other in names if other != name] for name in names}
        everybody = plant.with_neighbors(NeighborGraph.from_names(names, complete))
        stays = fixed_spectrum(extended_system(everybody, [2] * plant.m, "outputs+states"))
        for polynomial in lost:
            for factor, _ in polynomial.factor():
                assert factor.divides(stays.polynomial)
