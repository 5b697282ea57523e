"""The gate: a certified loop comes from it alone, and it refuses what is not so."""

from dataclasses import replace
from fractions import Fraction

import pytest

from mcexact.analysis.stability import agreeing_moduli, coefficient_bound
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.errors import Impossible, InternalError, LimitReached, UsageError
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model.controller import LinearMap
from mcexact.synthesis.distributed_observer import design_observer
from mcexact.synthesis.gate import CertifiedLoop, Proposal, certify, first_certified
from mcexact.synthesis.observer import observer_coordinates
from tests.synthesis.three_channels import three_channels
from tests.wording import refusal

ANY = StabilityRegion("continuous")


@pytest.fixture(scope="module")
def design():
    return design_observer(three_channels(), spectrum={"feedback": [-1] * 3, "error": [-1] * 11})


def proposed(design, controller=None, polynomials=None):
    """What was put before the gate, or something else."""
    made = controller or design.controller
    found = design.parts["feedback_polynomial"], design.parts["error_polynomial"]
    return Proposal(made, polynomials or found, observer_coordinates(3, made)[-1:])


def test_the_whole_spectrum_is_certified_for_any_controller(design):
    proposal = Proposal(design.controller, (design.loop.polynomial,))
    for region, kinds in ((ANY, 1), (StabilityRegion("continuous", Fraction(1, 2)), 2)):
        made = certify(three_channels(), proposal, region)
        assert len(made.proofs) == kinds
        for each in made.proofs:
            verdict = check_document(encode(each).encode())
            assert verdict.verdict == "VALID", verdict.line()


def test_another_polynomial_does_not_pass(design):
    wrong = design.loop.polynomial + Polynomial.of(1)
    with refusal(InternalError):
        certify(three_channels(), Proposal(design.controller, (wrong,)), ANY)
    feedback, error = design.parts["feedback_polynomial"], design.parts["error_polynomial"]
    with refusal(InternalError):
        certify(
            three_channels(),
            proposed(design, polynomials=(feedback, error + Polynomial.of(1))),
            ANY,
        )


def test_another_program_does_not_pass(design):
    first, *rest = design.controller.agents
    louder = LinearMap(
        shared={0: first.input.shared.get(0, Matrix.zeros(1, 3)) + Matrix.from_rows([[1, 0, 0]])}
    )
    changed = replace(design.controller, agents=(replace(first, input=louder), *rest))
    with pytest.raises(InternalError):
        certify(three_channels(), proposed(design, changed), ANY)


def test_a_region_that_is_not_met_does_not_pass(design):
    with refusal(UsageError):
        certify(three_channels(), proposed(design), StabilityRegion("continuous", Fraction(1)))
    unstable = Proposal(design.controller, (Polynomial.from_roots([1] * 14),))
    with pytest.raises(UsageError, match="violates Re λ < 0"):
        certify(three_channels(), unstable, ANY, stable=True)


def test_what_is_only_tried_may_fail_until_nothing_is_left(design):
    controller = design.controller
    tried = Proposal(controller, coordinates=observer_coordinates(3, controller))
    fast, said = StabilityRegion("continuous", Fraction(5)), []
    with refusal(LimitReached):
        first_certified(three_channels(), [tried, tried], fast, tell=said.append)
    assert said == ["certificate"] * 2
    with pytest.raises(Impossible):
        first_certified(three_channels(), [Proposal(controller), tried], fast, tell=said.append)


def test_nobody_else_makes_a_certified_loop(design):
    loop = design.loop
    with refusal(InternalError):
        CertifiedLoop(loop.closed, loop.polynomial, loop.proofs, object())
    with refusal(InternalError):
        replace(loop, key=None)


def test_the_bound_covers_every_coefficient():
    M = Matrix.from_rows([[1, "1/2", -3], ["2/3", 0, 5], [7, -1, "1/4"]])
    D, beta = coefficient_bound(M)
    assert all(abs(D * c) <= beta for c in characteristic_polynomial(M).coefficients)
    assert agreeing_moduli([(M, characteristic_polynomial(M))], 0)
