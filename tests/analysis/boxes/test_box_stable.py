"""One controller keeps every plant in a box stable: what is proved holds for drawn members."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mcexact import Controller, Matrix, MultiChannelSystem, certify_controller, check, testing
from mcexact.analysis.boxes.loops import box_stability, gain_radii
from mcexact.boxes import Box
from mcexact.designs import AgentProgram, LinearMap, local_controllers
from mcexact.errors import LimitReached, UsageError
from mcexact.exact.linear_algebra import solve
from mcexact.model.loop import LoopPencil, closed_loop
from tests.wording import refusal

PLANT = MultiChannelSystem(
    [[1, "1/2"], ["1/3", -1]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]]
)
GAINS = local_controllers(PLANT, [[[-4]], [[-2]]])


@pytest.mark.parametrize("gains", [None, "1/20", "controller"])
def test_members_and_rounded_gains_stay_in_the_region(gains: str | None) -> None:
    box = Box.relative(PLANT, "1/20")
    radii = gain_radii(GAINS, "1/20") if gains == "controller" else gains
    answer = box_stability(box.system, GAINS, rate="1/2", gains=radii)
    assert check(answer, box.system).verdict == "VALID"
    assert answer.bound == Fraction(1, 2) and (answer.gain_radii is None) == (gains is None)
    moved = local_controllers(PLANT, [[["-4.2"]], [["-1.9"]]])
    for k in range(6):
        member = box.member(random.Random(k), vertex=k % 2 == 0)
        assert certify_controller(member, GAINS, rate="1/2").stable
        assert gains is None or certify_controller(member, moved, rate="1/2").stable


def test_a_nominal_loop_that_is_not_stable_has_no_box() -> None:
    with refusal(LimitReached):
        box_stability(Box.relative(PLANT, "1/1000").system, GAINS, rate=5)
    with refusal(UsageError):
        box_stability(PLANT, GAINS)


def test_a_member_that_is_not_stable_prevents_a_proof() -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    gain = local_controllers(plant, [[[-2]]])
    box_stability(Box.absolute(plant, A=[["9/10"]]).system, gain)
    with pytest.raises(LimitReached):
        box_stability(Box.absolute(plant, A=[["11/10"]]).system, gain)
    with pytest.raises(LimitReached):
        box_stability(plant, gain, gains="11/20")


def test_loops_in_discrete_time_stay_in_a_disc() -> None:
    plant = MultiChannelSystem([["3/2"]], [[[1]]], [[[1]]], time="discrete")
    gain = local_controllers(plant, [[["-5/4"]]])
    box = Box.relative(plant, "1/50")
    answer = box_stability(box.system, gain, radius="9/10", gains="1/100")
    assert check(answer, box.system).verdict == "VALID" and answer.growth is None
    with pytest.raises(LimitReached, match=r"\|λ\| < 1/4"):
        box_stability(box.system, gain, radius="1/4")


@given(
    testing.systems(min_states=1, max_states=3, max_channels=2),
    st.sampled_from(["1/1000", "1/10"]),
    st.integers(-3, 3),
)
@settings(max_examples=25)
def test_what_is_proved_holds_for_members(drawn: testing.Drawn, part: str, gain: int) -> None:
    box = Box.relative(drawn.system, part)
    sizes = drawn.system.sizes
    controller = local_controllers(drawn.system, [[[gain] * q] * p for p, q in sizes])
    try:
        answer = box_stability(box.system, controller, gains=part)
    except LimitReached:
        return
    assert check(answer, box.system).verdict == "VALID"
    for k in range(2):
        member = box.member(random.Random(k), vertex=bool(k))
        assert certify_controller(member, controller).stable


@given(
    testing.systems_on_graphs(
        testing.systems(max_states=3, max_channels=3, time="discrete"), longest_delay=2
    ),
    st.integers(0, 10**6),
)
@settings(max_examples=25)
def test_signals_that_are_eliminated_from_the_pencil_leave_the_loop(
    drawn: testing.Drawn, seed: int
) -> None:
    """[λ − P, −Q; −R, −S] has the loop P − Q S⁻¹ R, and rows y, u that are unit triangular."""
    system, rng = drawn.system, random.Random(seed)
    controller = drawn_controller(system, rng)
    loop = closed_loop(system, controller)
    pencil = LoopPencil(loop.plant, controller, loop.graph)
    Z0, N, k = pencil.matrix, pencil.states, pencil.dimension
    assert N == loop.dimension
    S = Z0.take(range(N, k), range(N, k))
    assert all(S[i, i] == -1 and not any(S[i][i + 1 :]) for i in range(k - N))
    X = solve(S, Z0.take(range(N, k), range(N)))
    assert X is not None
    assert Z0.take(range(N), range(N)) - Z0.take(range(N), range(N, k)) @ X == loop.matrix


def drawn_controller(system: MultiChannelSystem, rng: random.Random) -> Controller:
    """A controller with one shared and one private state for each agent."""
    graph = system.neighbors
    assert graph is not None

    def matrix(nrows: int, ncols: int) -> Matrix:
        return Matrix.from_rows(
            [[rng.randint(-2, 2) for _ in range(ncols)] for _ in range(nrows)], ncols
        )

    def program(i: int, rows: int) -> LinearMap:
        heard = graph.neighborhood(i)
        outputs = {j: matrix(rows, system.q(j)) for j in heard}
        return LinearMap(outputs, {j: matrix(rows, 1) for j in heard}, matrix(rows, 1))

    agents = tuple(
        AgentProgram(name, 1, 1, program(i, 1), program(i, 1), program(i, system.p(i)))
        for i, name in enumerate(system.names)
    )
    return Controller(system.time, "", agents)
