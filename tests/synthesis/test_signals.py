"""Designs that follow ramps, sinusoids and other signals, and why there is none."""

from __future__ import annotations

import random
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest

from mcexact import MultiChannelSystem, certify_controller, check, design_setpoint, simulate
from mcexact.checker.internal_model import largest_model
from mcexact.cli.audit import sentences_of
from mcexact.derived.constructions import companion_matrix
from mcexact.designs import Aims
from mcexact.errors import Impossible, InputError
from mcexact.exact.linear_algebra import inverse
from mcexact.exact.matrix import Matrix, block_diagonal, vstack
from mcexact.exact.polynomial import Polynomial
from mcexact.model.controller import AgentProgram, LinearMap
from mcexact.model.signals import followed_signals, signal_polynomial
from mcexact.synthesis.certify import account_of_verdict

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


# Which signals a given controller follows.


def transformed(agent: AgentProgram, T: Matrix) -> AgentProgram:
    """The agent with the private states T z."""
    back, each = inverse(T), agent.private_update
    assert back is not None

    def columns(M: Matrix | None) -> Matrix | None:
        return None if M is None else M @ back

    update = LinearMap(
        {j: T @ M for j, M in each.outputs.items()},
        {j: T @ M for j, M in each.shared.items()},
        None if each.private is None else T @ each.private @ back,
        None if each.reference is None else T @ each.reference,
    )
    shared, given = agent.shared_update, agent.input
    return replace(
        agent,
        shared_update=replace(shared, private=columns(shared.private)),
        private_update=update,
        input=replace(given, private=columns(given.private)),
    )


def drawn(rng: random.Random, nrows: int, ncols: int) -> Matrix:
    return Matrix.from_rows(
        [
            [rng.choice([0, 0, 1, -1, 2, Fraction(1, 3)]) for _ in range(ncols)]
            for _ in range(nrows)
        ],
        ncols,
    )


def plain_rows(M: Matrix | None, k: int) -> list[list[Fraction]]:
    """The rows of a matrix of k rows."""
    return [list(row) for row in M.rows()] if M is not None else [[Fraction(0)] for _ in range(k)]


@pytest.mark.parametrize("seed", range(12))
def test_a_model_is_found_in_any_coordinates_and_among_other_states(seed: int) -> None:
    """As it was made, and by the checker's elimination; nothing where another signal enters."""
    rng = random.Random(seed)
    alphas = [
        signal_polynomial(rng.choice(["ramp", "sine:2", "step,sine:1/3", "poly:s-1"]), "continuous")
        for _ in range(2)
    ]
    models = block_diagonal([companion_matrix(alpha) for alpha in alphas])
    d, more = models.nrows, rng.randint(0, 2)
    enters = Matrix.from_rows(
        [[int(k == alphas[0].degree - 1), int(k == d - 1)] for k in range(d)], 2
    )
    states = vstack(
        [
            block_diagonal([models, Matrix.zeros(0, more)]),
            drawn(rng, more, d + more),
        ],
        ncols=d + more,
    )
    measured, other = vstack([enters, drawn(rng, more, 2)]), drawn(rng, more, 1)
    program = LinearMap(
        {0: measured, 1: vstack([Matrix.zeros(d, 1), other + Matrix.from_rows([[1]] * more, 1)])},
        {},
        states,
        vstack([-enters, Matrix.zeros(more, 2)]),
    )
    agent = AgentProgram("1", 0, d + more, private_update=program)
    T = Matrix.identity(d + more)
    for _ in range(4):
        i, j = rng.sample(range(d + more), 2)
        step = [[int(a == b) for b in range(d + more)] for a in range(d + more)]
        step[i][j] = rng.choice([1, -1, 2])
        T = Matrix.from_rows(step) @ T
    moved = transformed(agent, T)
    update = moved.private_update
    outputs, disturbed = update.outputs[0], update.outputs[1]
    cases = [([1, 0], alphas[0]), ([0, 1], alphas[1])]
    cases += [([1, 2], alphas[0].gcd(alphas[1]).monic()), ([0, 3], alphas[1])]
    for s, alpha in cases:
        assert followed_signals(moved, 0, Matrix.from_rows([s])) == alpha
        inner, own, less, others = (
            plain_rows(M, d + more) for M in (update.private, outputs, update.reference, disturbed)
        )
        again = largest_model(inner, own, less, others, [Fraction(x) for x in s])
        assert Polynomial.of(*again) == alpha
    heard = replace(program, outputs={0: measured, 1: vstack([Matrix.column([1] * d), other])})
    deaf = transformed(replace(agent, private_update=heard), T)
    found = [followed_signals(deaf, 0, Matrix.from_rows([s])) for s in ([1, 0], [0, 1])]
    assert all(p.degree < alpha.degree for p, alpha in zip(found, alphas, strict=True))


@pytest.mark.parametrize("signals", ["step", "ramp", "step,sine:2"])
def test_a_certified_controller_is_said_to_follow_what_it_follows(signals: str) -> None:
    """Also in other coordinates of its states; and the sentence is made again of certificates."""
    regulated = {"a": [1], "b": [2]}
    plant = MultiChannelSystem(
        [[0, 1], [1, -1]],
        [[[1], [0]], [[0], [1]]],
        [[[1, 0]], [[1, 1], [0, 1]]],
        names=["a", "b"],
        regulated=regulated,
    )
    design = design_setpoint(plant, signals=signals, rate="1/10", aims=THEOREM)
    account = design.account
    assert {(each.template.key, each.line) for each in account.sentences} <= sentences_of(
        account.answers
    )
    first, k = design.controller.agents[0], design.controller.agents[0].private
    T = Matrix.from_rows([[2 * int(a == b) + int(b == a + 1) for b in range(k)] for a in range(k)])
    moved = replace(
        design.controller, agents=(transformed(first, T), *design.controller.agents[1:])
    )
    for controller in (design.controller, moved):
        verdict = certify_controller(plant, controller)
        account = account_of_verdict(verdict)
        lines = {each.template.key: each.line for each in account.sentences}
        key = "design-steady-regulated" if signals == "step" else "design-steady-signals"
        assert "a, b[2]" in lines[key]
        assert set(lines.items()) <= sentences_of(account.answers)
