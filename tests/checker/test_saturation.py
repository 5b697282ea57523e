"""The rule of ``saturation``, and the limits and gains of a controller file."""

from __future__ import annotations

import json
from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.constructions import Loop
from mcexact.checker.core.arithmetic import Matrix
from mcexact.checker.core.reading import Limits, Refused
from mcexact.checker.core.system import System
from mcexact.checker.kinds import Expectation
from mcexact.checker.saturation import agrees, check_region, spread, windup
from tests.checker.handmade import Document, changed, checked, matrix
from tests.checker.performance_plants import form, static
from tests.checker.saturation_plants import (
    ALL,
    CUT,
    DOUBLED,
    EXACT,
    EXACT_NEAR,
    FALLING,
    INTEGRAL,
    NEAR,
    ONE_OF_TWO,
    RISEN,
    SIZED,
    UNMOVED,
    gains,
    held,
    integral,
)
from tests.checker.tables import accepts, rejects

ACCEPTED = [
    *ALL.items(),
    ("a valve that only opens", changed(CUT, ("claim.limits", [[[0, 2]]]))),
    ("no input has limits", changed(
        ONE_OF_TWO, ("claim.limits", [[None], [None]]), ("witness.scaling", []),
        ("witness.sectors", []),
    )),
    ("wider limits", changed(NEAR, ("claim.limits", [[[-2, 2]]]))),
    ("a smaller ball", changed(NEAR, ("claim.region.radius", "1/4"))),
    ("sizes of 1", changed(NEAR, ("claim.region.sizes", [1]))),
    ("samples of few decimals", changed(EXACT, ("subject", held(FALLING, 2, "-1")))),
]  # fmt: skip

P, L = "witness.P", "claim.back_calculation"
REJECTED: list[tuple[Any, ...]] = [
    # an unstable plant is not held from everywhere, whatever form there is
    ("everywhere for an unstable plant", CUT, ("system", DOUBLED), "INVALID"),
    ("an indefinite form", CUT, (P, form([-1])), "INVALID"),
    ("a form that does not fall", CUT, (P, form([3])), "INVALID"),
    ("M₀ unstable with a form that falls", CUT, (
        ("system", DOUBLED), (P, form([-1])), ("witness.scaling", [1])
    ), "INVALID"),
    ("a mode that no input moves, and an indefinite form", CUT, (
        ("system", UNMOVED), ("subject", [static(UNMOVED, 0)]), (P, form([-1])),
        ("witness.scaling", [1]),
    ), "INVALID"),
    ("a loop that grows", CUT, ("subject", [static(DOUBLED, 1)]), "INVALID"),
    ("an integral without anti-windup", INTEGRAL, (L, [matrix([0])]), "INVALID"),
    ("anti-windup of the wrong sign", INTEGRAL, (L, [matrix([-1])]), "INVALID"),
    ("anti-windup that is too strong", INTEGRAL, (L, [matrix([90])]), "INVALID"),
    ("an integral of the wrong sign", INTEGRAL, ("subject", [integral(1)]), "INVALID"),
    ("gains of another shape", INTEGRAL, (L, [matrix([1], [1])]), "MALFORMED"),
    ("gains of an agent too many", INTEGRAL, (L, [matrix([1]), matrix([1])]), "MALFORMED"),
    ("limits above 0", CUT, ("claim.limits", [[[1, 2]]]), "MALFORMED"),
    ("limits below 0", CUT, ("claim.limits", [[[-2, -1]]]), "MALFORMED"),
    ("limits in the wrong order", CUT, ("claim.limits", [[[1, -1]]]), "MALFORMED"),
    ("an input that is always 0", CUT, ("claim.limits", [[[0, 0]]]), "MALFORMED"),
    ("limits of an input too many", CUT, ("claim.limits", [[[-1, 1], None]]), "MALFORMED"),
    ("limits of an agent too many", CUT, ("claim.limits", [[[-1, 1]], []]), "MALFORMED"),
    ("three ends", CUT, ("claim.limits", [[[-1, 0, 1]]]), "MALFORMED"),
    ("a scaling of 0", CUT, ("witness.scaling", [0]), "INVALID"),
    ("a negative scaling", CUT, ("witness.scaling", [-2]), "MALFORMED"),
    ("a scaling too many", CUT, ("witness.scaling", [2, 2]), "MALFORMED"),
    ("a smaller sector everywhere", CUT, ("witness.sectors", ["1/2"]), "INVALID"),
    ("a sector beyond the input", NEAR, ("witness.sectors", ["3/2"]), "INVALID"),
    ("a negative sector", NEAR, ("witness.sectors", ["-3/4"]), "MALFORMED"),
    ("a sector from 0 on", NEAR, ("witness.sectors", [0]), "INVALID"),
    ("a region that leaves the sector", NEAR, (
        ("claim.region.P", form([2])), ("witness.scaling", ["12/5"])
    ), "INVALID"),
    ("narrower limits", NEAR, ("claim.limits", [[["-3/4", 1]]]), "INVALID"),
    ("narrower limits on the other side", NEAR, ("claim.limits", [[[-1, "3/4"]]]), "INVALID"),
    ("a valve that only opens, in a region", NEAR, ("claim.limits", [[[0, 1]]]), "INVALID"),
    ("a ball beyond the region", NEAR, ("claim.region.radius", "1/2"), "INVALID"),
    ("a ball of a negative radius", NEAR, ("claim.region.radius", "-1/3"), "INVALID"),
    ("a ball of the radius 0", NEAR, ("claim.region.radius", 0), "INVALID"),
    ("a ball beyond the region in sizes", SIZED, ("claim.region.radius", 1), "INVALID"),
    ("a ball in larger sizes", SIZED, ("claim.region.sizes", [1]), "INVALID"),
    ("a size of 0", SIZED, ("claim.region.sizes", [0]), "INVALID"),
    ("a negative size", SIZED, ("claim.region.sizes", ["-1/2"]), "INVALID"),
    ("a size too many", SIZED, ("claim.region.sizes", ["1/2", 1]), "MALFORMED"),
    ("no sizes", SIZED, ("claim.region.sizes", []), "MALFORMED"),
    ("exact samples of a plant that is not sampled", CUT, ("claim.exact", True), "INVALID"),
    ("exact samples behind another construction", EXACT, (
        "subject", [EXACT["subject"][0], *[{"construction": "dual"}] * 2, EXACT["subject"][1]]
    ), "INVALID"),
    ("exact samples of another system than the plant", EXACT, (
        "subject", [*[{"construction": "dual"}] * 2, *EXACT["subject"]]
    ), "INVALID"),
    ("samples that are not exact", EXACT, ("claim.exact", False), "INVALID"),
    ("samples without decimals", EXACT, (
        ("subject", held(FALLING, 0, "-1")), ("witness.scaling", [8])
    ), "INVALID"),
    ("samples of one decimal in a region", EXACT_NEAR, (
        "subject.0.decimals", 1
    ), "INVALID"),
    ("two forms", NEAR, (P, form([4])), "INVALID"),
    ("a wider sector in continuous time", RISEN, ("witness.sectors", ["1/4"]), "INVALID"),
    ("a weaker loop in continuous time", RISEN, (
        "subject", [static(RISEN["system"], -1)]
    ), "INVALID"),
    ("an input without limits that lets its state grow", ONE_OF_TWO, (
        "subject", [gains("-1", "1")]
    ), "INVALID"),
    ("limits of the other input", ONE_OF_TWO, (
        ("claim.limits", [[None], [[-1, 1]]]), ("subject", [gains("1", "-1")])
    ), "INVALID"),
    ("no loop", CUT, ("subject", []), "INVALID"),
]  # fmt: skip
test_valid_certificates_are_accepted = accepts(ACCEPTED)
test_each_condition_is_needed = rejects(REJECTED)


def test_without_a_region_the_form_is_in_the_witness() -> None:
    document = changed(CUT)
    del document["witness"]["P"]
    assert checked(document).verdict == "MALFORMED"


def controller_file(document: Document, **of_agent: Any) -> bytes:
    """The controller of a certificate as a file, with more keys of its agents."""
    controller = changed(document)["subject"][0]["controller"]
    for agent in controller["agents"]:
        agent.update(of_agent)
    head = {"format": "mcexact-controller/1", "system": ""}
    return json.dumps(head | controller).encode()


@pytest.mark.parametrize(
    ("of_agent", "verdict"),
    [
        ({"limits": [[-1, 1]], "back_calculation": [[1]]}, "VALID"),
        ({"back_calculation": [["2/2"]]}, "VALID"),
        ({"limits": [[-1, 2]], "back_calculation": [[1]]}, "NOT ABOUT"),
        ({"limits": [[-2, 1]], "back_calculation": [[1]]}, "NOT ABOUT"),
        ({"limits": [[-1, 1]], "back_calculation": [[2]]}, "NOT ABOUT"),
        ({"limits": [[-1, 1]]}, "NOT ABOUT"),
        ({}, "NOT ABOUT"),
    ],
)
def test_a_controller_file_has_the_limits_and_the_gains_of_the_claim(
    of_agent: Any, verdict: str
) -> None:
    expected = Expectation().controlled(controller_file(INTEGRAL, **of_agent), Limits())
    found = checked(INTEGRAL, expected=expected)
    assert found.verdict == verdict, found.line()


def test_a_claim_about_one_agent_is_not_about_a_file_of_two() -> None:
    claim = {"limits": [[[-1, 1]]], "back_calculation": [matrix()]}
    own = [(Fraction(-1), Fraction(1))]
    assert agrees(claim, ((own, None),))
    assert not agrees(claim, ((own, None), (own, None)))
    assert not agrees(claim | {"back_calculation": [matrix(), matrix()]}, ((own, None),))


def test_inputs_without_limits_and_both_factors_of_a_form_are_in_what_rounding_changes() -> None:
    # |dA| = 1/8, |dB| = [1/4, 1/2]; u_1 = 2z is cut off, u_2 = -3z is not: R = [13/8, 1/4]
    one = Matrix([[1]], 1)
    missed = System(
        "discrete", [], Matrix([[1]], 1, 8), [Matrix([[1]], 1, 4), Matrix([[1]], 1, 2)], []
    )
    samples = System("discrete", ["1", "2"], one, [one, one], [one, one], missed=missed)
    signals = Matrix([[1]], 1, 2), one, Matrix([[2], [-3]], 1)
    # with P = 3 the sums of the rows of R'|P[M, E]|, its transpose and R'|P|R
    assert spread(one.times(3), signals, [0], samples) == [Fraction(1233, 64), Fraction(261, 32)]


def test_anti_windup_acts_on_the_states_of_its_agent_alone() -> None:
    one = Matrix([[1]], 1)
    two = System("discrete", ["1", "2"], one, [one, one], [one, one])
    widths = [1, 1, 2, 3, 1, 5, 7]  # of the plant, of the two agents, and of stored messages
    loop = Loop(two, [], [(("x", 0, 0), width) for width in widths], [])
    gains = [matrix(*[[10 * i + k] for k in range(size)]) for i, size in ((1, 3), (2, 4))]
    made = windup(gains, two, loop)
    rows = [[10, 0], [11, 0], [12, 0], [0, 20], [0, 21], [0, 22], [0, 23]]
    assert made.rows == [[0, 0], *rows, *[[0, 0]] * 12]


def test_a_ball_of_states_is_within_the_region_up_to_the_last_digit() -> None:
    # 1/radius^2 is 64/9, a little more than 7
    inputs = ([(Fraction(-1), Fraction(1))], [Fraction(0)])
    region = {"P": form([7]), "radius": "3/8"}
    assert check_region(region, Matrix([[1]], 1), inputs, 1) == Matrix([[7]], 1)
    with pytest.raises(Refused):
        check_region(region | {"radius": "2/5"}, Matrix([[1]], 1), inputs, 1)


def test_without_gains_a_file_is_that_of_a_claim_without_gains() -> None:
    expected = Expectation().controlled(controller_file(CUT), Limits())
    assert checked(CUT, expected=expected).verdict == "VALID"


@pytest.mark.parametrize(
    "of_agent",
    [
        {"limits": [[1, 2]]},
        {"limits": [[-1, 1], None]},
        {"limits": [-1]},
        {"limits": {}},
        {"back_calculation": [[1, 1]]},
        {"back_calculation": [[1], [1]]},
        {"back_calculation": 1},
    ],
)
def test_a_controller_file_with_limits_or_gains_of_another_form_is_refused(of_agent: Any) -> None:
    with pytest.raises(Refused):
        Expectation().controlled(controller_file(INTEGRAL, **of_agent), Limits())
