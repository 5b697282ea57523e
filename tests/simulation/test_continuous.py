"""Continuous time: the agents' equations, integrated, against exponentials of the loop."""

from fractions import Fraction

import pytest

from mcexact.errors import LimitReached, UsageError
from mcexact.exact.matrix import Matrix
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.simulation.trajectory import double_precision_warning, simulate
from mcexact.synthesis.distributed_observer import design_observer
from tests.assurance.campaigns.observer import compare_double, compare_multiprecision, one_design
from tests.synthesis.three_channels import three_channels
from tests.wording import refusal


@pytest.fixture(scope="module")
def design():
    return design_observer(three_channels(), spectrum={"feedback": [-1] * 3, "error": [-2] * 11})


def test_the_agents_at_sixty_digits_agree_with_the_exponential_on_the_paper(design):
    assert compare_multiprecision(three_channels(), design, 0) < 1e-40


def test_the_agents_in_double_precision_agree_with_the_exponential_on_the_paper(design):
    assert compare_double(three_channels(), design, 0) < 1e-6


@pytest.mark.parametrize("seed", [2, 4])
def test_the_agents_agree_with_the_exponential_on_drawn_plants(seed):
    system, drawn = one_design(seed)
    assert compare_multiprecision(system, drawn, seed) < 1e-9
    assert compare_double(system, drawn, seed) < 1e-6


def test_a_decaying_scalar_is_the_exponential():
    from mpmath import mp

    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    agent = AgentProgram("1", 0, 0, input=LinearMap({0: Matrix.from_rows([[-3]])}))
    controller = Controller("continuous", "", (agent,))
    run = simulate(plant, controller, horizon=1, points=4, arithmetic="multiprecision", digits=40)
    with mp.workdps(40):
        for t, snapshot in zip(run.times, run.snapshots, strict=True):
            exact = mp.exp(-2 * mp.mpf(t.numerator) / t.denominator)
            assert abs(snapshot.plant[0] - exact) < mp.mpf(10) ** -38


def test_a_fast_mode_makes_the_taylor_steps_shorter():
    from mpmath import mp

    plant = MultiChannelSystem([[-300]], [[[0]]], [[[1]]])
    controller = Controller("continuous", "", (AgentProgram("1", 0, 0),))
    run = simulate(plant, controller, horizon=1, points=1, arithmetic="multiprecision", digits=30)
    with mp.workdps(30):
        assert abs(run.snapshots[-1].plant[0] / mp.exp(-300) - 1) < mp.mpf(10) ** -20


@pytest.mark.parametrize("arithmetic", ["float", "multiprecision"])
def test_a_set_point_is_reached(arithmetic):
    plant = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    program = LinearMap({0: Matrix.from_rows([[-1]])}, reference=Matrix.identity(1))
    controller = Controller("continuous", "", (AgentProgram("1", 0, 0, input=program),))
    run = simulate(
        plant, controller, horizon=30, points=3, reference=[[Fraction(5, 2)]], arithmetic=arithmetic
    )
    assert abs(float(run.snapshots[-1].plant[0]) - 2.5) < 1e-9


def test_the_solution_is_not_rational():
    plant = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    controller = Controller("continuous", "", (AgentProgram("1", 0, 0),))
    with pytest.raises(UsageError, match="not rational"):
        simulate(plant, controller, arithmetic="exact")
    with pytest.raises(UsageError, match="horizon above 0"):
        simulate(plant, controller, horizon=0)


@pytest.mark.parametrize(("entry", "horizon"), [("1e400", None), (-1, 10**400), (1000, 10)])
def test_what_double_precision_cannot_hold_is_a_limit(entry, horizon):
    plant = MultiChannelSystem([[entry]], [[[1]]], [[[1]]])
    controller = Controller("continuous", "", (AgentProgram("1", 0, 0),))
    with refusal(LimitReached):
        simulate(plant, controller, horizon=horizon)


def test_links_have_no_delay_in_continuous_time():
    graph = NeighborGraph(("1", "2"), [[], [0]], [(1, 0, 1)])
    plant = MultiChannelSystem([[0]], [[[1]]] * 2, [[[1]]] * 2, neighbors=graph)
    agents = (AgentProgram("1", 0, 0), AgentProgram("2", 0, 0))
    with refusal(UsageError):
        simulate(plant, Controller("continuous", "", agents))


def test_large_entries_are_warned_of(design):
    assert double_precision_warning(closed_loop(three_channels(), design.controller)) is None
    plant = MultiChannelSystem([[0, 10**6], [0, 0]], [[[1], [0]]], [[[1, 0]]])
    controller = Controller("continuous", "", (AgentProgram("1", 0, 0),))
    warning = double_precision_warning(closed_loop(plant, controller))
    assert warning is not None and "up to 1e+06" in warning
    run = simulate(plant, controller, horizon="1/100", points=1)
    assert run.warning == warning
    exact = simulate(plant, controller, horizon="1/100", points=1, arithmetic="multiprecision")
    assert exact.warning is None
