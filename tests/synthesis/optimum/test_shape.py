"""Limits on the eigenvalues besides the rate: damping, and the largest modulus."""

import numpy as np
import pytest

from mcexact.errors import UsageError
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.decentralized import design_decentralized
from mcexact.synthesis.loop_assessment import assess
from mcexact.synthesis.optimum.aims import Aims
from mcexact.synthesis.optimum.shape import NO_LIMITS, Shape, least_damping


def oscillator() -> MultiChannelSystem:
    """A hardly damped mass, of which position and speed are measured."""
    return MultiChannelSystem([[0, 1], [-4, "-1/10"]], [[[0], [1]]], [[[1, 0], [0, 1]]])


def test_a_search_aims_at_a_damping_ratio():
    plain = assess(design_decentralized(oscillator(), rate="1/10"))
    aims = Aims(damping=0.8)
    damped = assess(design_decentralized(oscillator(), rate="1/10", aims=aims), aims)
    assert plain.figures.damping < 0.8 <= damped.figures.damping
    assert not any("as aimed at" in each for each in damped.warnings)


def test_a_search_aims_at_slow_eigenvalues():
    aims = Aims(largest_modulus=2.2)
    slow = assess(design_decentralized(oscillator(), rate="1/10", aims=aims), aims)
    assert slow.figures.fastest <= 2.2


def test_what_is_not_reached_is_said():
    aims = Aims(largest_modulus=0.5, seeds=1, effort=1)
    found = assess(design_decentralized(oscillator(), rate="3/4", aims=aims), aims)
    assert found.install == "with care"
    assert any("not as aimed at" in each for each in found.warnings)


@pytest.mark.parametrize(
    "given", [{"damping": 0}, {"damping": 1}, {"largest_modulus": 0}, {"damping": float("nan")}]
)
def test_limits_are_checked(given):
    with pytest.raises(UsageError):
        Aims(**given)


def test_without_limits_everything_is_met():
    assert NO_LIMITS.free and NO_LIMITS.met(-1.0, np.inf)
    assert not Shape(damping=0.5).met(0.4, 0.0)
    assert least_damping(np.zeros(0, dtype=complex), discrete=True) == 1.0
    assert least_damping(np.array([0j, 1j]), discrete=True) == pytest.approx(0.0)
