"""Periodic decentralized control: what is found, that it is certified, and what is refused."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import mcexact
from mcexact.constructions import periodic_loop
from mcexact.designs import PeriodicController, certify_periodic, design_periodic
from mcexact.errors import Impossible, InputError, LimitReached, UsageError
from mcexact.exact.matrix import matrix_to_float
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model import gallery
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis import periodic
from tests.oracle.periodic import blocked, monodromy_by_hand, planted

PLANT = gallery.load("movable-by-periodic-gains")


def verify(system: MultiChannelSystem, controller: PeriodicController, radius: str = "1") -> None:
    """Multiply the phases step by step, and locate the eigenvalues in floating point."""
    rows = monodromy_by_hand(system, controller.to_dict()["phases"])
    assert rows == [list(row) for row in periodic_loop(system, controller).A.rows()]
    largest = max(abs(np.linalg.eigvals(np.array(rows, float))), default=0.0)
    assert largest < float(Fraction(radius)) ** controller.period


def test_a_plant_that_no_constant_gains_stabilize_gets_a_periodic_controller() -> None:
    assert not mcexact.fixed_spectrum(PLANT).stabilizable
    design = design_periodic(PLANT)
    assert (design.period, design.proof.kind) == (2, "stability")
    assert mcexact.check(design.proof, PLANT).valid
    verify(PLANT, design.controller)
    assert "periodic-stabilizes" in {each.template.key for each in design.account.sentences}


def test_the_radius_of_a_step_is_met_over_the_period() -> None:
    design = design_periodic(PLANT, radius="1/2")
    assert design.proof.bound == Fraction(1, 2) ** design.period
    verify(PLANT, design.controller, "1/2")
    assert certify_periodic(PLANT, design.controller, radius="1/2").stable
    assert not certify_periodic(PLANT, design.controller, radius="1/1000").stable


@pytest.mark.parametrize("seed", range(3))
def test_planted_plants_are_stabilized(seed: int) -> None:
    examine(seed, 2)


def examine(seed: int, channels: int) -> int:
    """Design for a planted plant, and return the period."""
    system, mode = planted(seed, channels)
    spectrum = mcexact.fixed_spectrum(system)
    assert Polynomial.from_roots([mode]).divides(spectrum.polynomial)
    assert not spectrum.stabilizable
    design = design_periodic(system)
    assert mcexact.check(design.proof, system).valid
    verify(system, design.controller)
    return design.period


def test_forty_planted_plants_are_stabilized_nearly_all_with_period_2() -> None:
    periods = [examine(seed, 2 + seed % 2) for seed in range(100, 140)]
    assert periods.count(2) >= 36


def test_a_link_with_zeros_at_both_signs_needs_period_3() -> None:
    system = blocked()
    assert not mcexact.fixed_spectrum(system).stabilizable
    with pytest.raises(LimitReached, match="a period up to 2"):
        design_periodic(system, longest=2)
    design = design_periodic(system)
    assert design.period == 3
    verify(system, design.controller)


def test_no_gains_of_period_2_move_the_mode_through_both_zeros() -> None:
    """Whatever the gains, λ² stays an eigenvalue over two steps."""
    system = blocked()
    for k in range(5):
        gains = [[[[k + t]], [[k - 2 * t]]] for t in range(2)]
        steps = [mcexact.designs.local_controllers(system, each) for each in gains]
        M = periodic_loop(system, PeriodicController(tuple(steps))).A
        n = system.n
        shifted = M - mcexact.Matrix.identity(n) * Fraction(121, 100)
        assert np.linalg.matrix_rank(matrix_to_float(shifted), tol=1e-9) < n


def test_a_fixed_mode_0_stays_and_is_no_obstacle() -> None:
    rows = [[*row, Fraction(0)] for row in PLANT.A.rows()]
    A = [*rows, [Fraction(0)] * 4]
    B = [[*PLANT.B(i).rows(), [0]] for i in range(2)]
    C = [[[*PLANT.C(i).rows()[0], 0]] for i in range(2)]
    system = MultiChannelSystem(A, B, C, time="discrete")
    design = design_periodic(system, radius="3/4")
    verify(system, design.controller, "3/4")
    loop = periodic_loop(system, design.controller).A
    assert np.linalg.matrix_rank(matrix_to_float(loop)) < loop.nrows


def beside(one: MultiChannelSystem, other: MultiChannelSystem) -> MultiChannelSystem:
    """Two plants, the first of which also acts on the second: two strong components."""
    n, k = one.n, other.n
    pushed = [one.C(0).rows()[0] if i == 0 else [Fraction(0)] * n for i in range(k)]
    A = [[*row, *[0] * k] for row in one.A.rows()]
    A += [[*left, *row] for left, row in zip(pushed, other.A.rows(), strict=True)]
    B = [[*one.B(i).rows(), *[[0]] * k] for i in range(one.m)]
    B += [[*[[0]] * n, *other.B(i).rows()] for i in range(other.m)]
    C = [[[*one.C(i).rows()[0], *[0] * k]] for i in range(one.m)]
    C += [[[*[0] * n, *other.C(i).rows()[0]]] for i in range(other.m)]
    return MultiChannelSystem(A, B, C, time="discrete")


def test_each_strong_component_is_closed_on_its_own() -> None:
    system = beside(PLANT, PLANT)
    assert len(mcexact.transfer_graph(system).components) == 2
    design = design_periodic(system)
    assert mcexact.check(design.proof, system).valid
    verify(system, design.controller)


def test_the_controller_of_the_theorem_serves_where_no_static_gains_are_found(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(periodic, "_STARTS", 0)
    design = design_periodic(PLANT, radius="9/10")
    assert design.order == PLANT.n
    verify(PLANT, design.controller, "9/10")


def test_what_no_causal_control_moves_is_refused_with_its_certificate() -> None:
    apart = MultiChannelSystem([[2]], [[[1]], [[0]]], [[[0]], [[1]]], time="discrete")
    with pytest.raises(Impossible, match="x - 2") as refused:
        design_periodic(apart)
    assert mcexact.check(refused.value.certificate, apart).valid
    with pytest.raises(Impossible):
        design_periodic(beside(PLANT, apart))


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"longest": 1}, UsageError, "from 2 on"),
        ({"longest": True}, UsageError, "from 2 on"),
        ({"radius": 2}, UsageError, "at most 1"),
    ],
)
def test_arguments_are_refused(
    arguments: dict[str, Any], error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        design_periodic(PLANT, **arguments)


def test_plants_that_have_no_periodic_controllers_here_are_refused() -> None:
    with pytest.raises(UsageError, match="sample the plant"):
        design_periodic(MultiChannelSystem([[1]], [[[1]]], [[[1]]]))
    direct = MultiChannelSystem([[2]], [[[1]]], [[[1]]], time="discrete", D=[[1]])
    with pytest.raises(InputError, match="feedthrough"):
        design_periodic(direct)
    with pytest.raises(UsageError, match="sample the plant"):
        certify_periodic(
            MultiChannelSystem([[1]], [[[1]], [[1]]], [[[1]], [[1]]]),
            design_periodic(PLANT).controller,
        )
    large = MultiChannelSystem(
        [[int(i == j) * 2 for j in range(61)] for i in range(61)],
        [[[int(i == j) for j in range(61)] for i in range(61)]],
        [[[int(i == j) for j in range(61)] for i in range(61)]],
        time="discrete",
    )
    with pytest.raises(LimitReached, match="60 states"):
        design_periodic(large)


def test_an_unstable_loop_is_told_as_such() -> None:
    idle = mcexact.designs.local_controllers(PLANT, [[[0]], [[0]]])
    controller = PeriodicController((idle, idle))
    for radius, key in ((None, "periodic-unstable"), ("1/2", "periodic-slow")):
        verdict = certify_periodic(PLANT, controller, radius=radius)
        assert mcexact.check(verdict, PLANT).valid
        region = StabilityRegion.of("discrete", None, radius)
        account = periodic.account_of_period(verdict, controller, region)
        assert key in {each.template.key for each in account.sentences}
