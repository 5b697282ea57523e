"""Designs that follow ramps, sinusoids and other signals, and why there is none."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from mcexact import MultiChannelSystem, check, design_setpoint, simulate
from mcexact.designs import Aims
from mcexact.errors import Impossible, InputError
from mcexact.exact.polynomial import Polynomial

THEOREM = Aims(effort=0)
LAG = MultiChannelSystem([[-1]], [[[1]]], [[[1]]])
STEPPED = MultiChannelSystem([["1/2"]], [[[1]]], [[[1]]], time="discrete")
TWO = MultiChannelSystem(
    [[0, 1], [1, -1]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]], names=["a", "b"]
)
APART = MultiChannelSystem([[-1, 0], [0, -1]], [[[1], [0]], [[0], [1]]], [[[1, 0], [0, 1]], []])
"""Agent 1 measures both states, each of which one agent moves."""


def keys(design: Any) -> list[str]:
    """The keys of what is said of the outputs."""
    known = [each.template.key for each in design.account.sentences]
    return [key for key in known if key.startswith("design-steady")]


def reason(refused: Any) -> str:
    """The key of the sentence that refuses."""
    return str(refused.value.message.template.key)


@pytest.mark.parametrize(
    ("plant", "signals", "alpha"),
    [
        (LAG, "ramp", (0, 0, 1)),
        (LAG, "sine:1/2", (Fraction(1, 4), 0, 1)),
        (LAG, Polynomial.of(2, 0, 1), (2, 0, 1)),
        (TWO, ["step", "sine:1"], (0, 1, 0, 1)),
        (STEPPED, "cosine:1/2", (1, -1, 1)),
        (STEPPED, "poly:z-2", (-2, 1)),
    ],
)
def test_a_design_has_a_model_for_every_output(plant: Any, signals: Any, alpha: Any) -> None:
    limit: Any = {"rate": "1/10"} if plant.time == "continuous" else {"radius": "9/10"}
    design = design_setpoint(plant, signals=signals, aims=THEOREM, **limit)
    assert design.name == "setpoint" and design.parts["followed"] == Polynomial.of(*alpha)
    assert all(check(proof, plant).valid for proof in design.certificates.values())
    assert ("setpoint" in design.certificates) == (
        Polynomial.of(*alpha)(design.region.discrete) == 0
    )
    assert keys(design) == ["design-steady-signals"]
    d = len(alpha) - 1
    for agent in design.controller.agents:
        model = agent.private_update.private.take(rows=range(d))
        assert model.rows()[d - 1][:d] == tuple(-Fraction(c) for c in alpha[:d])
        assert agent.private_update.reference.take(rows=range(d)).rows()[-1] == (-1,)


def test_constants_alone_are_set_points_as_ever() -> None:
    named = design_setpoint(LAG, signals="step", rate="1/10", aims=THEOREM)
    plain = design_setpoint(LAG, rate="1/10", aims=THEOREM)
    assert named.controller == plain.controller and named.parts.keys() == plain.parts.keys()
    assert keys(named) == keys(plain) == ["design-steady-state"]


def test_errors_tend_to_zero_on_a_ramp_and_not_with_integrators_alone() -> None:
    """In discrete time, exactly: a ramp of slope 2, and one that disturbs the input."""
    errors = []
    for signals in ("ramp", "step"):
        design = design_setpoint(STEPPED, signals=signals, radius="1/2", aims=THEOREM)
        run = simulate(STEPPED, design.controller, horizon=60, ramps=[(0, [2])], initial=[3])
        errors.append(abs(run.snapshots[-1].outputs[0][0] - 120))
    assert errors[0] < Fraction(1, 10**6) < 1 < errors[1]


def test_over_links_agents_follow_what_they_cannot_alone() -> None:
    """Without messages an agent with more outputs than inputs fixes the signals."""
    with pytest.raises(Impossible) as refused:
        design_setpoint(APART, signals="ramp", rate="1/10", aims=THEOREM)
    assert reason(refused) == "refused-models-alone"
    proof = refused.value.certificate
    assert proof.kind == "fixed_spectrum" and check(proof, APART).valid
    assert Polynomial.of(0, 1).divides(proof.polynomial)
    talking = APART.with_neighbors({"1": ["2"], "2": ["1"]})
    design = design_setpoint(talking, signals="ramp", rate="1/10", aims=THEOREM, method="extended")
    assert check(design.certificates["stability"], talking).valid


def test_signals_that_no_input_reaches_are_refused_with_a_proof() -> None:
    """The outputs x_1 and x_1' of one agent with two inputs follow no sinusoids together."""
    carts = MultiChannelSystem([[0, 1], [-1, 0]], [[[0, 0], [1, 2]]], [[[1, 0], [0, 1]]])
    with pytest.raises(Impossible) as refused:
        design_setpoint(carts, signals="sine:2", aims=THEOREM)
    assert reason(refused) == "refused-models-control"
    proof = refused.value.certificate
    assert proof.kind == "controllability" and check(proof, carts).valid
    with pytest.raises(Impossible) as refused:
        design_setpoint(carts, signals="ramp", aims=THEOREM)
    assert reason(refused).startswith("refused-no-equilibrium")


@pytest.mark.parametrize(("plant", "signals"), [(LAG, "poly:s+1"), (STEPPED, "step,poly:z")])
def test_signals_that_tend_to_zero_need_no_model(plant: Any, signals: str) -> None:
    with pytest.raises(InputError) as refused:
        design_setpoint(plant, signals=signals)
    assert refused.value.where == "signals"
