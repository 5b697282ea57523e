"""Limits on the eigenvalues besides the rate: damping, and the largest modulus."""

from fractions import Fraction

import numpy as np
import pytest

from mcexact.answer.loops import StabilityVerdict
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.errors import InputError, LimitReached, UsageError
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.assessment import assess
from mcexact.synthesis.decentralized import design_decentralized
from mcexact.synthesis.design import Design
from mcexact.synthesis.optimum.figures import NO_LIMITS, Aims, Shape, least_damping
from tests.wording import refusal


def oscillator() -> MultiChannelSystem:
    """A hardly damped mass, of which position and speed are measured."""
    return MultiChannelSystem([[0, 1], [-4, "-1/10"]], [[[0], [1]]], [[[1, 0], [0, 1]]])


def proof_of(made: Design) -> StabilityVerdict:
    found = made.certificates["stability"]
    assert isinstance(found, StabilityVerdict)
    return found


def test_a_damping_ratio_is_aimed_at_and_certified():
    plain = assess(design_decentralized(oscillator(), rate="1/10"))
    aims = Aims(damping=0.8)
    made = design_decentralized(oscillator(), rate="1/10", aims=aims)
    damped, proof = assess(made, aims), proof_of(made)
    assert plain.figures.damping < 0.8 <= damped.figures.damping
    assert not any("as aimed at" in each for each in damped.warnings)
    assert proof.stable and proof.damping == Fraction(4, 5) and proof.bound == Fraction(1, 10)
    assert check_document(encode(proof).encode()).verdict == "VALID"
    assert "damping ratio > 4/5" in made.explain()


def test_slow_eigenvalues_are_aimed_at_and_certified():
    aims = Aims(largest_modulus=2.2)
    made = design_decentralized(oscillator(), rate="1/10", aims=aims)
    assert assess(made, aims).figures.fastest <= 2.2
    assert proof_of(made).largest_modulus == Fraction(11, 5)


def test_what_is_not_reached_is_no_design():
    aims = Aims(largest_modulus=1.9, damping=0.99, largest_gain=0.01, seeds=1, effort=0.1)
    with pytest.raises(LimitReached, match="no controller"):
        design_decentralized(oscillator(), rate="3/2", aims=aims)
    with refusal(UsageError):
        design_decentralized(oscillator(), rate="3/4", aims=Aims(largest_modulus=0.5))


def test_in_discrete_time_a_damping_ratio_is_aimed_at_alone():
    plant = MultiChannelSystem([[1, 1], [0, 1]], [[[0], [1]]], [[[1, 0], [0, 1]]], time="discrete")
    made = design_decentralized(plant, radius="9/10", aims=Aims(damping=0.5))
    assert proof_of(made).damping is None and not made.region.limits


@pytest.mark.parametrize(
    "given", [{"damping": 0}, {"damping": 1}, {"largest_modulus": 0}, {"damping": float("nan")}]
)
def test_limits_are_checked(given):
    with pytest.raises((InputError, UsageError)):
        Aims(**given)


def test_without_limits_everything_is_met():
    assert NO_LIMITS.free and NO_LIMITS.met(-1.0, np.inf)
    assert not Shape(damping=0.5).met(0.4, 0.0)
    assert least_damping(np.zeros(0, dtype=complex), discrete=True) == 1.0
    assert least_damping(np.array([0j, 1j]), discrete=True) == pytest.approx(0.0)
