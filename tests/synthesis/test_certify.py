"""Other people's controllers: from matrices, from python-control, from files."""

from fractions import Fraction

import pytest

from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.errors import Impossible, LimitReached, UsageError
from mcexact.exact.roots import StabilityRegion
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis import certify as certifying
from mcexact.synthesis.certify import certify_controller, enclosed_outside
from mcexact.synthesis.decentralized import design_decentralized
from mcexact.synthesis.distributed_observer import design_observer
from mcexact.synthesis.gate import Proposal, certify
from tests.synthesis.three_channels import three_channels
from tests.wording import refusal

PLANT = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
STATIC = local_controllers(PLANT, [[[-3]]])


def assert_valid(certificate):
    verdict = check_document(encode(certificate).encode())
    assert verdict.verdict == "VALID", verdict.line()


@pytest.mark.parametrize(("rate", "stable"), [(None, True), (1, True), (2, False), (3, False)])
@pytest.mark.parametrize("method", ["polynomial", "lyapunov"])
def test_the_eigenvalue_minus_two_is_faster_than_one(rate, stable, method):
    if (rate, method) == (2, "lyapunov"):
        with refusal(UsageError, where="method"):
            certify_controller(PLANT, STATIC, rate=rate, method=method)
        return
    found = certify_controller(PLANT, STATIC, rate=rate, method=method)
    assert found.stable is stable
    assert_valid(found)


def test_an_unknown_method_is_refused():
    with pytest.raises(UsageError, match=r"method: expected .* found 'guess'"):
        certify_controller(PLANT, STATIC, method="guess")  # type: ignore[arg-type]


def test_a_large_loop_is_recognized_and_goes_block_by_block():
    plant = three_channels()
    design = design_observer(plant, agent="1", rate=1, arithmetic="float")
    found = certify_controller(plant, design.controller, rate=1, method="lyapunov")
    assert found.stable and found.blocks == (3, 9, 9)
    assert_valid(found)


def test_the_largest_rate_is_certified(monkeypatch):
    plant = three_channels()
    design = design_observer(plant, rate=1, arithmetic="float")
    small = certify_controller(plant, design.controller, largest=True)
    assert small.stable and small.region.bound > 1
    assert_valid(small)
    monkeypatch.setattr(certifying, "POLYNOMIAL_LIMIT", 10)
    large = certify_controller(plant, design.controller, largest=True)
    assert large.stable and large.method == "lyapunov"
    assert 0 < large.region.bound <= small.region.bound + Fraction(1, 10**5)
    assert_valid(large)


def test_there_is_no_largest_rate_of_an_unstable_loop():
    for gain in ([[-3]], [[1]]):
        found = certify_controller(PLANT, local_controllers(PLANT, [gain]), largest=True)
        assert (found.region.bound is None) is not found.stable


def test_the_largest_rate_is_found_beside_entries_beyond_floats():
    far = [[-int(i == j) + 10**400 * int(j == i + 1) for j in range(41)] for i in range(41)]
    plant = MultiChannelSystem(far, [[[0]] * 41], [[[0] * 41]])
    found = certify_controller(plant, local_controllers(plant, [[[0]]]), largest=True)
    assert Fraction(999, 1000) < found.region.edge < 1


def test_a_loop_too_large_for_its_polynomial_says_so(monkeypatch):
    monkeypatch.setattr(certifying, "POLYNOMIAL_LIMIT", 0)
    assert not certify_controller(PLANT, STATIC, rate=2).stable
    monkeypatch.setattr(certifying, "_POLYNOMIAL_UNASKED", 0)
    with refusal(LimitReached):
        certify_controller(PLANT, STATIC, rate=2)


def test_a_region_is_certified_or_an_eigenvalue_outside_is_enclosed():
    spiral = MultiChannelSystem([[0, 1], [-25, -6]], [[[0], [1]]], [[[1, 0]]])  # -3 + 4i, -3 - 4i
    none = local_controllers(spiral, [[[0]]])
    held = certify_controller(spiral, none, rate=1, damping="1/2", largest_modulus=6)
    assert held.stable and enclosed_outside(held) is None
    for limits in ({"damping": "7/10"}, {"largest_modulus": 4}, {"rate": 4, "damping": "1/2"}):
        found = certify_controller(spiral, none, **limits)
        disc = enclosed_outside(found)
        assert not found.stable and disc is not None and Fraction(disc.re) == -3
        assert_valid(found)
    on_the_border = enclosed_outside(certify_controller(spiral, none, damping="3/5"))
    assert on_the_border is not None and on_the_border.radius == "0"


def test_the_largest_rate_is_searched_within_limits():
    found = certify_controller(PLANT, STATIC, largest=True, largest_modulus=3)
    assert found.stable and found.largest_modulus == 3 and found.bound is not None
    assert not certify_controller(PLANT, STATIC, largest=True, largest_modulus=1).stable


def test_a_bound_of_the_other_time_domain_is_wrong_usage():
    with refusal(UsageError):
        certify_controller(PLANT, STATIC, radius=1)
    with pytest.raises(UsageError, match="not both"):
        certify_controller(PLANT, STATIC, rate=1, largest=True)


def test_the_gate_lets_no_slow_loop_through():
    assert_valid(certify(PLANT, Proposal(STATIC), StabilityRegion("continuous", Fraction(1))).proof)
    with refusal(Impossible) as refused:
        certify(PLANT, Proposal(STATIC), StabilityRegion("continuous", Fraction(2)))
    assert_valid(refused.value.certificate)


@pytest.mark.parametrize("progress", [True, "print", 3])
def test_what_is_told_of_steps_has_to_be_a_function(progress):
    told = "progress: expected a function, such as print, found "
    with pytest.raises(UsageError, match=told):
        design_decentralized(PLANT, progress=progress)
    with pytest.raises(UsageError, match=told):
        design_decentralized(PLANT, rate=1, progress=progress)
    with pytest.raises(UsageError, match=told):
        certify_controller(PLANT, STATIC, progress=progress)
