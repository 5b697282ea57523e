"""Designs that follow signals for plants whose inputs act on outputs at once."""

from __future__ import annotations

import random
from collections import Counter
from typing import Any

import pytest

from mcexact import (
    MultiChannelSystem,
    certify_controller,
    check,
    design_setpoint,
    fixed_spectrum,
)
from mcexact.answer.check import followed_in
from mcexact.constructions import input_filters, plant_controller
from mcexact.designs import Aims
from mcexact.errors import Impossible, InputError, LimitReached
from mcexact.exact.linear_algebra import solve_nonsingular
from mcexact.exact.matrix import Matrix, block_diagonal, hstack, vstack
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model.controller import Controller
from mcexact.model.loop import closed_loop
from mcexact.synthesis.setpoint import selected
from tests.assurance.campaigns.signals import ALPHAS, coefficients, drawn
from tests.oracle.enumeration import plain
from tests.oracle.signals import fixed_signals

THEOREM = Aims(effort=0)


def errors_vanish(
    plant: MultiChannelSystem, controller: Controller, alpha: Polynomial, selection: Any
) -> bool:
    """Whether S (y − r) tends to 0 for all solutions of α, as references and disturbances.

    Exact.  With X' = L X + N f and e = E X + F f, f a solution of α, the error of the trajectory
    of solutions of α is 0 iff V L^j N = 0 for j < d − 1 and V L^(d−1) N = F, V = E α(L)^(−1).
    Agents use their own signals, and their inputs are states, so that y = C x + D u.
    """
    loop, n = closed_loop(plant, controller), plant.n
    L, q = loop.matrix, sum(width for _, width in plant.sizes)
    inputs, enters, column = [], Matrix.zeros(L.nrows, 0), 0
    for i, agent in enumerate(controller.agents):
        first, _ = loop.blocks["z_", i, 0]
        u, r = agent.input.private, agent.private_update.reference
        assert not agent.input.outputs and agent.input.reference is None and not agent.shared
        u = Matrix.zeros(plant.p(i), agent.private) if u is None else u
        r = Matrix.zeros(agent.private, plant.q(i)) if r is None else r
        after = L.nrows - first - agent.private
        inputs.append(hstack([Matrix.zeros(u.nrows, first), u, Matrix.zeros(u.nrows, after)]))
        rows = [Matrix.zeros(first, r.ncols), r, Matrix.zeros(after, r.ncols)]
        enters, column = hstack([enters, vstack(rows, ncols=r.ncols)]), column + r.ncols
    C = vstack([plant.C(i) for i in range(plant.m)], ncols=n)
    outputs = hstack([C, Matrix.zeros(q, L.nrows - n)])
    outputs += plant.feedthrough_matrix() @ vstack(inputs, ncols=L.nrows)
    S = block_diagonal(selection)
    N = hstack([enters, Matrix.identity(L.nrows).take(cols=range(n))])
    F = hstack([-S, Matrix.zeros(S.nrows, n)])
    value, power = Matrix.zeros(*L.shape), Matrix.identity(L.nrows)
    for c in alpha.coefficients:
        value, power = value + power * c, power @ L
    V = solve_nonsingular(value.T, (S @ outputs).T)
    assert V is not None
    row = V.T
    for _ in range(alpha.degree - 1):
        if not (row @ N).is_zero():
            return False
        row = row @ L
    return row @ N == F


def designed(number: int) -> str:
    """What becomes of the plant with a number, compared with the ranks of its pencils."""
    rng = random.Random(f"signals with feedthrough {number}")
    time = rng.choice(["continuous", "discrete"])
    region = StabilityRegion(time)
    lasting = [
        alpha
        for alpha in map(coefficients, ALPHAS[time])
        if not any(region.contains_roots_of(p) for p, _ in Polynomial.of(*alpha).factor())
    ]
    alpha = rng.choice(lasting)
    plant = drawn(rng, alpha, time)
    while plant.D is None or plant.D.is_zero() or not any(q for _, q in plant.sizes):
        plant = drawn(rng, alpha, time)
    filtered, signals = input_filters(plant), Polynomial.of(*alpha)
    direct = [list(row) for row in plant.feedthrough_matrix().rows()]
    stays = fixed_spectrum(filtered).polynomial
    possible = region.contains_roots_of(stays) and not fixed_signals(plain(plant), direct, alpha)
    try:
        design = design_setpoint(filtered, signals=signals, aims=THEOREM)
    except Impossible as refused:
        assert not possible, number
        assert check(refused.certificate, plant).valid
        return "refused"
    except LimitReached:
        return "open"
    assert possible, number
    controller = plant_controller(design.controller, plant)
    verdict = certify_controller(plant, controller)
    assert verdict.stable and check(verdict, plant, controller).valid
    every = tuple(Matrix.identity(plant.q(i)) for i in range(plant.m))
    assert errors_vanish(plant, controller, signals, every), number
    for told, rows in followed_in(verdict)["follows"].items():
        held = [dict(rows).get(name, []) for name in plant.names]
        kept = [Matrix.from_rows(S, plant.q(i)) for i, S in enumerate(held)]
        assert signals.divides(told) and errors_vanish(plant, controller, told, kept), number
    return "designed"


@pytest.mark.parametrize("number", [0, 1, 137, 281])
def test_what_is_designed_follows_and_what_is_refused_has_no_design(number: int) -> None:
    designed(number)


def test_120_plants_follow_signals_or_have_no_design() -> None:
    met = Counter(designed(number) for number in range(120))
    assert met["designed"] > 25 and met["refused"] > 30 and not met["open"]


# Traps.


@pytest.mark.parametrize("time", ["continuous", "discrete"])
@pytest.mark.parametrize("sign", [1, -1])
def test_the_sign_of_the_feedthrough_decides(time: str, sign: int) -> None:
    """y = x + D u is 0 at rest for D = −1, as the transfer function there is 1 + D."""
    A = [[-1]] if time == "continuous" else [[0]]
    plant = MultiChannelSystem(A, [[[1]]], [[[1]]], D=[[sign]], time=time)
    wave = "sine:2" if time == "continuous" else "cosine:1/2"
    steady: dict[str, Any] = {"signals": ["step", wave]}
    if sign == 1:
        design = design_setpoint(input_filters(plant), **steady, aims=THEOREM)
        controller, alpha = plant_controller(design.controller, plant), design.parts["followed"]
        assert certify_controller(plant, controller).stable
        assert errors_vanish(plant, controller, alpha, [Matrix.identity(1)])
        wrong = MultiChannelSystem(A, [[[1]]], [[[1]]], D=[[-1]], time=time)
        assert not certify_controller(wrong, controller).stable
        return
    with pytest.raises(Impossible) as refused:
        design_setpoint(input_filters(plant), **steady, aims=THEOREM)
    assert refused.value.certificate.kind == "setpoint"
    assert check(refused.value.certificate, plant).valid


def test_a_mode_at_0_in_discrete_time_is_followed_through_a_feedthrough() -> None:
    """x(t+1) = u, y = x + 2 u, whose mode 0 is that of the inputs as states, too."""
    plant = MultiChannelSystem([[0]], [[[1]]], [[[1]]], D=[[2]], time="discrete")
    design = design_setpoint(input_filters(plant), signals="ramp", radius="1/2", aims=THEOREM)
    controller = plant_controller(design.controller, plant)
    assert certify_controller(plant, controller, radius="1/2").stable
    assert errors_vanish(plant, controller, design.parts["followed"], [Matrix.identity(1)])
    with pytest.raises(InputError):
        design_setpoint(input_filters(plant), signals="step,poly:z")


def test_an_agent_with_fewer_inputs_than_outputs_follows_no_two_signals() -> None:
    """A feedthrough does not help; one of the two outputs can be followed."""
    apart = MultiChannelSystem(
        [[-1, 0], [0, -2]], [[[1], [0]], [[0], [1]]], [[[1, 0], [0, 1]], []], D=[[1, 2], [0, 1]]
    )
    with pytest.raises(Impossible) as refused:
        design_setpoint(input_filters(apart), signals="sine:1", aims=THEOREM)
    proof = refused.value.certificate
    assert proof.kind == "fixed_spectrum" and check(proof, apart).valid
    design = design_setpoint(
        input_filters(apart), signals="sine:1", regulate={"1": [1]}, aims=THEOREM
    )
    controller, first = plant_controller(design.controller, apart), Matrix.from_rows([[1, 0]])
    assert certify_controller(apart, controller).stable
    alpha, kept = design.parts["followed"], [first, Matrix.zeros(0, 0)]
    assert errors_vanish(apart, controller, alpha, kept)
    assert not errors_vanish(apart, controller, alpha, [Matrix.identity(2), Matrix.zeros(0, 0)])


def test_measured_inputs_are_never_held() -> None:
    """Neither by default nor by number; what the plant names is what is held."""
    parts = [[-1]], [[[1]]], [[[1], [2]]]
    plant = MultiChannelSystem(*parts, D=[[1], [1]], regulated={"1": [2]})
    assert selected(input_filters(plant), None) == (Matrix.from_rows([[0, 1, 0]]),)
    assert selected(input_filters(plant), {"1": [1]}) == (Matrix.from_rows([[1, 0, 0]]),)
    with pytest.raises(InputError):
        selected(input_filters(plant), {"1": [3]})
