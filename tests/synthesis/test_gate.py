"""The gate: a certified loop comes from it alone, and it refuses what is not so."""

from dataclasses import replace

import pytest

from mcexact.analysis.closed_loop_spectrum import agreeing_moduli, coefficient_bound
from mcexact.answer.codec import encode
from mcexact.checker import check_document
from mcexact.errors import InternalError
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.location import StabilityRegion
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.controller import LinearMap
from mcexact.synthesis.gate import (
    CertifiedClosedLoop,
    certify_observer,
    certify_spectrum,
)
from mcexact.synthesis.observer import design_observer
from tests.synthesis.three_channels import three_channels


@pytest.fixture(scope="module")
def design():
    return design_observer(three_channels(), spectrum={"feedback": [-1] * 3, "error": [-1] * 11})


def test_the_whole_spectrum_is_certified_for_any_controller(design):
    made = certify_spectrum(three_channels(), design.controller, design.loop.polynomial)
    verdict = check_document(encode(made.certificate).encode())
    assert verdict.verdict == "VALID", verdict.line()


def test_another_polynomial_does_not_pass(design):
    wrong = design.loop.polynomial + Polynomial.of(1)
    with pytest.raises(InternalError, match="does not have the spectrum"):
        certify_spectrum(three_channels(), design.controller, wrong)
    with pytest.raises(InternalError, match="does not have the spectrum"):
        certify_observer(
            three_channels(),
            design.controller,
            design.feedback.polynomial,
            design.error + Polynomial.of(1),
        )


def test_another_program_does_not_pass(design):
    first, *rest = design.controller.agents
    louder = LinearMap(
        shared={0: first.input.shared.get(0, Matrix.zeros(1, 3)) + Matrix.from_rows([[1, 0, 0]])}
    )
    changed = replace(design.controller, agents=(replace(first, input=louder), *rest))
    with pytest.raises(InternalError):
        certify_observer(three_channels(), changed, design.feedback.polynomial, design.error)


def test_a_bound_that_does_not_hold_does_not_pass(design):
    with pytest.raises(InternalError, match="a root is not in the region"):
        certify_observer(
            three_channels(),
            design.controller,
            design.feedback.polynomial,
            design.error,
            region=StabilityRegion("continuous", 1),
        )


def test_nobody_else_makes_a_certified_loop(design):
    with pytest.raises(InternalError, match="functions of the gate"):
        CertifiedClosedLoop(design.loop.loop, design.controller, None, design.certificate, object())
    with pytest.raises(InternalError, match="functions of the gate"):
        replace(design.loop, key=None)


def test_the_bound_covers_every_coefficient():
    M = Matrix.from_rows([[1, "1/2", -3], ["2/3", 0, 5], [7, -1, "1/4"]])
    D, beta = coefficient_bound(M)
    assert all(abs(D * c) <= beta for c in characteristic_polynomial(M).coefficients)
    assert agreeing_moduli([(M, characteristic_polynomial(M))], 0)
