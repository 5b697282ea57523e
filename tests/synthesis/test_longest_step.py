"""The longest step of a controller is proved, and beside what is known of a small loop."""

from __future__ import annotations

import time
from fractions import Fraction

import numpy as np
import pytest

from mcexact import MultiChannelSystem, design_extended
from mcexact.answer.check import check
from mcexact.constructions import sampled_system
from mcexact.designs import local_controllers, longest_step
from mcexact.errors import UsageError
from mcexact.synthesis.optimum.figures import Aims
from tests.wording import says, worded

INTEGRATOR = MultiChannelSystem([[0]], [[[1]]], [[[1]]])


def margin_on_a_grid(gain: float, step: float, late: int) -> float:
    """The disk margin 1/max|S - 1/2| of the integrator with a gain; 0 if the loop is not stable."""
    characteristic = np.array([1.0, -1.0, *[0.0] * late])
    characteristic[-1] -= gain * step
    if max(abs(np.roots(characteristic))) >= 1:
        return 0.0
    z = np.exp(1j * np.linspace(1e-3, np.pi, 10_000))
    S = 1 / (1 - gain * step / ((z - 1) * z**late))
    return float(1 / max(abs(S - 0.5)))


@pytest.mark.parametrize(
    ("gain", "late", "margin"),
    [(-2, 0, "2/5"), (-2, 0, 1), (-1, 1, "2/5"), ("-1/2", 0, "9/5"), (-3, 2, "1/5")],
)
def test_the_step_is_the_longest_of_those_that_have_the_margin(
    gain: object, late: int, margin: object
) -> None:
    sampled = sampled_system(INTEGRATOR, "1/10", late)
    controller = local_controllers(sampled, [[[gain]]])
    found = longest_step(sampled, controller, margin=margin)  # type: ignore[arg-type]
    asked = float(Fraction(str(margin)))
    if found.longer is not None:
        assert margin_on_a_grid(float(Fraction(str(gain))), float(found.longer), late) < asked
    if found.step is None:
        assert found.longer == Fraction(1, 10) and not found.answers
        assert says(found.explain(), "proof step")
        return
    assert margin_on_a_grid(float(Fraction(str(gain))), float(found.step), late) >= asked - 1e-6
    assert {each.margin for each in found.answers.values()} == {Fraction(str(margin))}
    assert len(found.answers) == 2
    for answer in found.answers.values():
        assert check(answer).verdict == "VALID"
        assert answer.about.at_samples.sample_time == found.step
    assert found.longer is None or found.longer > found.step


def test_an_integrator_keeps_a_margin_up_to_the_step_that_is_known() -> None:
    # 1/(z - 1 + 2h) at z = -1: |S - 1/2| is at most 5/2 up to h = 2/3
    sampled = sampled_system(INTEGRATOR, "1/10")
    found = longest_step(sampled, local_controllers(sampled, [[[-2]]]))
    assert found.step == Fraction(3, 5) and found.longer == Fraction(4, 5)
    assert found.to_dict() == {
        "step": "3/5",
        "margin": "2/5",
        "proved": True,
        "not_found": "4/5",
    }
    assert "0.6" in found.explain() and "search" in found.explain()


def test_without_time_only_nothing_is_said() -> None:
    sampled = sampled_system(INTEGRATOR, "1/10")
    found = longest_step(
        sampled, local_controllers(sampled, [[[-2]]]), deadline=time.monotonic() - 1
    )
    assert found.step is None and found.longer is None and not found.answers
    assert worded(found.explain())


def test_large_proofs_are_left_out_unless_all_are_asked_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    sampled = sampled_system(INTEGRATOR, "1/10")
    controller = local_controllers(sampled, [[[-2]]])
    monkeypatch.setattr("mcexact.synthesis.longest_step.MOST_BYTES", 1)
    found = longest_step(sampled, controller)
    assert found.step == Fraction(3, 5) and not found.answers
    assert not found.to_dict()["proved"] and says(found.explain(), "computed proved")
    assert longest_step(sampled, controller, prove_all=True).answers


def test_what_is_in_discrete_time_and_not_sampled_is_refused() -> None:
    discrete = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
    with pytest.raises(UsageError, match="sampled plant"):
        longest_step(discrete, local_controllers(discrete, [[["-1/2"]]]))
    sampled = sampled_system(INTEGRATOR, 1)
    with pytest.raises(UsageError, match="above 0"):
        longest_step(sampled, local_controllers(sampled, [[["-1/2"]]]), margin=0)


def tustin_margin_on_a_grid(step: float) -> float:
    """The disk margin of x' = u with u = -3z + y/2, z' = -2z + y, held; 0 if it is not stable."""
    half = step / 2
    X = 1 / (1 + 2 * half)
    a, b, c, d = X * (1 - 2 * half), step * X, -3 * X, 0.5 - 3 * half * X
    M = np.array([[1 + step * d, step * c], [b, a]])
    if max(abs(np.linalg.eigvals(M))) >= 1:
        return 0.0
    z = np.exp(1j * np.linspace(1e-3, np.pi, 10_000))
    S = 1 / (1 - step / (z - 1) * (d + c * b / (z - a)))
    return float(1 / max(abs(S - 0.5)))


def test_a_controller_in_continuous_time_is_held_by_tustins_rule() -> None:
    lag = local_controllers(INTEGRATOR, [([[-2]], [[1]], [[-3]], [["1/2"]])])
    found = longest_step(INTEGRATOR, lag)
    assert found.step is not None and found.longer is not None and found.held
    assert tustin_margin_on_a_grid(float(found.step)) >= 0.4 - 1e-6
    assert tustin_margin_on_a_grid(float(found.longer)) < 0.4
    assert found.longer <= found.step * Fraction(4, 3)
    assert {each.margin for each in found.answers.values()} == {Fraction(2, 5)}
    for answer in found.answers.values():
        assert check(answer).verdict == "VALID"
        assert answer.about.at_samples.sample_time == found.step
        assert answer.subject[0]["late"] == 0


def test_what_is_not_sought_says_why() -> None:
    pair = MultiChannelSystem(
        [[0, 1], [0, -1]],
        [[[0], [1]], [[1], [0]]],
        [[[1, 0]], [[0, 1]]],
        neighbors={"1": ["2"], "2": ["1"]},
    )
    shared = design_extended(pair, dimensions=[0, 1], aims=Aims(effort=0)).controller
    assert "agents share states" in longest_step(pair, shared).explain()
    weak = local_controllers(INTEGRATOR, [[[-2]]])
    found = longest_step(INTEGRATOR, weak, margin="5/2")
    assert found.step is None and "in continuous time" in found.explain()
    assert found.to_dict()["left_out"] == found.left_out
    late = longest_step(INTEGRATOR, weak, deadline=time.monotonic() - 1)
    assert worded(late.explain())


def test_large_loops_are_left_out_unless_all_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mcexact.synthesis.longest_step._MOST_SIGNALS", 2)
    gain = local_controllers(INTEGRATOR, [[[-2]]])
    assert "3 states, inputs and outputs" in longest_step(INTEGRATOR, gain).explain()
    assert longest_step(INTEGRATOR, gain, prove_all=True).step == Fraction(3, 5)
