"""Feedback, full output, integrators and the error system."""

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mcexact import testing
from mcexact.derived.constructions import error_system, feedback, full_output, setpoint_system
from mcexact.errors import InputError, UsageError
from mcexact.exact.matrix import Matrix, hstack, vstack
from mcexact.model.system import MultiChannelSystem
from tests.wording import refusal


def gains(rng, system, widths):
    return [
        Matrix.from_integers(
            [[rng.randint(-2, 2) for _ in range(w)] for _ in range(system.p(i))], ncols=w
        )
        for i, w in enumerate(widths)
    ]


@given(testing.systems(), st.integers(0, 99))
def test_feedback_is_undone_by_the_opposite_feedback(drawn, seed):
    system = drawn.system
    F = gains(random.Random(seed), system, [system.q(i) for i in range(system.m)])
    closed = feedback(system, F)
    assert feedback(closed, [-each for each in F]).A == system.A
    assert closed.channels == system.channels
    assert closed.subject[-1] == {"construction": "feedback", "gains": tuple(F)}


@given(testing.systems(), st.integers(0, 99))
def test_closed_loops_are_the_plant_plus_all_b_f_c(drawn, seed):
    system = drawn.system
    F = gains(random.Random(seed), system, [system.q(i) for i in range(system.m)])
    expected = system.A
    for i in range(system.m):
        expected = expected + system.B(i) @ F[i] @ system.C(i)
    assert expected == feedback(system, F).A


def test_wrong_gains_are_refused():
    system = MultiChannelSystem([[1]], [[[1, 2]]], [[[1]]])
    with pytest.raises(InputError, match="gains: expected 1 gains, found 2"):
        feedback(system, [[[1], [2]]] * 2)
    with pytest.raises(InputError, match=r"gains\[0\]: expected 2 rows, found 1"):
        feedback(system, [[[1]]])
    with refusal(InputError, where="gains[0][0][0]"):
        feedback(system, [[[0.5], [1]]])


def test_a_channel_that_sees_everything():
    system = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [0]]] * 2, [[[1, 1]]] * 2)
    made = full_output(system, 1)
    assert made.C(1) == Matrix.identity(2) and made.C(0) == system.C(0)
    assert made.subject == ({"construction": "full_output", "channel": "2"},)
    with pytest.raises(UsageError, match="expected a channel 0 … 1, found 2"):
        full_output(system, 2)


@given(testing.systems())
def test_integrators_add_up_the_outputs(drawn):
    system = drawn.system
    made = setpoint_system(system)
    total = sum(system.q(i) for i in range(system.m))
    x = Matrix.from_integers([[k + 1] for k in range(system.n)], ncols=1)
    w = Matrix.from_integers([[10 + k] for k in range(total)], ncols=1)
    step = made.A @ vstack([x, w], ncols=1)
    grown = system.output_matrix() @ x + (w if system.time == "discrete" else 0 * w)
    assert step == vstack([system.A @ x, grown], ncols=1)
    assert vstack([c.C for c in made.channels], ncols=made.n) @ vstack([x, w], ncols=1) == w
    assert made.input_matrix() == vstack(
        [system.input_matrix(), Matrix.zeros(total, system.input_matrix().ncols)]
    )
    assert made.neighbors == system.neighbors


@given(testing.systems_on_graphs(testing.systems(max_states=3, max_channels=3)), st.integers(0, 99))
def test_the_error_system_has_the_paper_s_equations(drawn, seed):
    """ė_i = A e_i + Σ_j B_jF_j (e_i − e_j), outputs C_i e_i and e_i − e_j."""
    system, rng = drawn.system, random.Random(seed)
    n, m = system.n, system.m
    F = gains(rng, system, [n] * m)
    made = error_system(system, F)
    e = [Matrix.from_integers([[rng.randint(-5, 5)] for _ in range(n)], ncols=1) for _ in range(m)]
    stacked = vstack(e, ncols=1)
    rates = []
    for i in range(m):
        rate = system.A @ e[i]
        for j in range(m):
            rate = rate + system.B(j) @ F[j] @ (e[i] - e[j])
        rates.append(rate)
        others = [j for j in system.neighbors.neighborhood(i) if j != i]
        seen = [system.C(i) @ e[i], *(e[i] - e[j] for j in others)]
        assert made.C(i) @ stacked == vstack(seen, ncols=1)
    assert made.A @ stacked == vstack(rates, ncols=1)
    assert hstack([c.B for c in made.channels]) == Matrix.identity(n * m)
    assert made.subject == ({"construction": "error", "gains": tuple(F)},)
