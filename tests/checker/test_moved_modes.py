"""What gains move, for all values of a parameter but those named."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import partial
from typing import Any

import pytest

from mcexact.checker.core.arithmetic import NotAUnit
from mcexact.checker.core.reading import Refused
from mcexact.checker.parameters import MovedModes
from mcexact.checker.parametric_system import one_parameter, read_parametric
from tests.assurance.attack.forgeries.parametric_traps import LARGE, constant, plant, scalar

ELL = 101


def polynomial(*coefficients: list[Any]) -> list[list[Fraction]]:
    """A polynomial in x and t."""
    return [[Fraction(c) for c in part] for part in coefficients]


def value(*coefficients: Any) -> list[Fraction]:
    """A polynomial in t."""
    return [Fraction(c) for c in coefficients]


def moved(system: Any, first: list[Any], second: list[Any], *P: Any, ell: int = ELL) -> MovedModes:
    """What gains move beside those of 0; one matrix for each channel."""
    return MovedModes(
        [still(system), first, second], ell, list(P), one_parameter(read_parametric(system))
    )


def still(system: Any) -> list[Any]:
    """Gains of 0."""
    return [
        constant(*[[0] * len(channel["C"]) for _ in channel["B"][0]])
        for channel in system["channels"]
    ]


def refusal(ask: Callable[[], Any]) -> tuple[str, str]:
    """The code and the place where something is refused; nothing if it is not."""
    try:
        ask()
    except Refused as found:
        return found.code, found.place
    except NotAUnit:
        return "unit", ""
    return "", ""


X = polynomial([], [1])
WIDE = plant(
    [["t", 1], [0, 2]],
    ([[1, 0], [0, "t"]], [[0, 1]]),
    ([[0], [1]], [[1, 0], [0, "t^2"], [1, 1]]),
)
F1, F2 = constant([2], [3]), constant([1, -1, 5])


def test_loops_are_closed_by_their_gains() -> None:
    """A_F = [t, 1; 0, 2] + [0, 2; 0, 3 t] + [0, 0; 6, 5 − t²]."""
    found = moved(WIDE, [F1, F2], [constant([0], [0]), constant([0, 0, 0])])
    assert found.psi == polynomial([0, 2], [-2, -1], [1])
    # (x − t)(x − 7 − 3t + t²) − 18
    assert found.moved == polynomial([-18, 7, 3, -1], [-7, -4, 1], [1])
    assert found.chi_G == [[0, 2], [99, 100], [1]]
    other = moved(WIDE, [constant([0], [0]), constant([0, 0, 0])], [F1, F2])
    assert other.moved == other.psi == found.psi
    assert other.chi_G == [[83, 7, 3, 100], [94, 97, 1], [1]]
    third = MovedModes(
        [[F1, F2], *[still(WIDE)] * 2], ELL, [], one_parameter(read_parametric(WIDE))
    )
    assert (third.psi, third.moved) == (found.moved, found.psi)


def test_generic_polynomials_are_divided_out_one_after_the_other() -> None:
    apart = plant([[0, 0, 0], [0, 0, 0], [0, 0, "t"]], ([[0], [0], [1]], [[0, 0, 1]]))
    gains = [constant([2])], [constant([5])]
    found = moved(apart, *gains, X)
    assert found.psi == polynomial([0, -1], [1])
    assert found.moved == polynomial([-2, -1], [1])
    assert found.chi_G == [[], [], [96, 100], [1]]
    assert moved(apart, *gains).psi == polynomial([], [], [0, -1], [1])
    assert moved(apart, *gains, polynomial([0, -1], [1]), X).psi == [[1]]
    assert moved(apart, *gains, polynomial([1], [1])).psi == polynomial([], [], [0, -1], [1])


@pytest.mark.parametrize(
    ("first", "second", "code"),
    [
        ([F1, F2], [F1, F2], ""),
        ([F1], [F1, F2], "form"),
        ([F1, F2], [F1, F2, F2], "form"),
        ([F2, F1], [F1, F2], "form"),
        ([F1, constant([1, -1])], [F1, F2], "form"),
        ([constant([2]), F2], [F1, F2], "form"),
        ([F1, F2], [{**F1, "denominator": ELL}, F2], "unit"),
        ([{**F1, "denominator": ELL}, F2], [F1, F2], ""),
    ],
)
def test_gains_have_the_shapes_of_the_channels(first: Any, second: Any, code: str) -> None:
    assert refusal(lambda: moved(WIDE, first, second))[0] == code


def test_there_are_three_gains_and_a_modulus() -> None:
    system = one_parameter(read_parametric(WIDE))
    for gains in ([], [[F1, F2]] * 2, [[F1, F2]] * 4, None):
        assert refusal(partial(MovedModes, gains, ELL, [], system))[0] == "form"
    for ell in (1, 0, -3):
        found = refusal(partial(moved, WIDE, [F1, F2], [F1, F2], ell=ell))
        assert found == ("modulus", "witness.modulus")


def at(b: str, ell: int = ELL, *P: Any, first: int = 1, second: int = 2) -> MovedModes:
    """x' = b u, y = x."""
    return moved(scalar(b), [constant([first])], [constant([second])], *P, ell=ell)


def complete(found: MovedModes, q: Any, modes: Any = (), divisors: Any = ()) -> tuple[str, str]:
    return refusal(lambda: found.require_complete(q, list(modes), list(divisors), "w"))


def test_no_mode_is_left_at_a_value() -> None:
    assert complete(at("t"), value(-1, 1)) == ("", "")
    assert complete(at("t"), value(0, 1)) == ("common_factor", "w")
    assert complete(at("t"), value(0, 1), [X]) == ("", "")
    assert complete(at("t"), value(0, 1), [polynomial([1], [1])]) == ("common_factor", "w")
    assert complete(at("t^2 - 2"), value(-2, 0, 1)) == ("common_factor", "w")
    assert complete(at("t^2 - 2"), value(-2, 0, 1), [X]) == ("", "")
    assert complete(at("t^2 - 2"), value(-3, 0, 1)) == ("", "")
    # t = 0 and 1 together, where 0 alone is exceptional
    assert complete(at("t"), value(0, -1, 1)) == ("common_factor", "w")
    # a value that is congruent to one
    assert complete(at("t"), value(ELL, 1)) == ("common_factor", "w")
    assert complete(at("t", 7, second=7), value(1, 1)) == ("common_factor", "w")


def test_divisors_divide_what_is_known_to_be_fixed() -> None:
    grows = plant([[0, 0], [0, "t"]], ([[0], ["t"]], [[0, 1]]))  # at t = 0 there are two of 0
    known = moved(grows, [constant([1])], [constant([2])], X)
    assert complete(known, value(-1, 1)) == ("", "")
    assert complete(known, value(0, 1)) == ("common_factor", "w")
    assert complete(known, value(0, 1), (), [[[], [1]]]) == ("", "")
    assert complete(known, value(0, 1), (), [[[1], [1]]]) == ("divisor", "w")
    assert complete(known, value(0, 1), [X]) == ("", "")
    # x² − t² has the divisor x − t of its own, and x + t where t = 0 alone
    pair = plant([[0, 1], ["t^2", 0]], ([[0], [0]], [[1, 0]]))
    whole = moved(pair, [constant([1])], [constant([2])], polynomial([0, 0, -1], [], [1]))
    assert whole.psi == [[1]]
    q = value(-2, 0, 1)
    assert complete(whole, q, (), [[[0, 1], [1]]]) == ("", "")
    assert complete(whole, q, (), [[[1, 1], [1]]]) == ("divisor", "w")
    assert complete(whole, q, (), [[[0, 0, 1], [1]]])[0] == "form"
    assert complete(whole, q, [polynomial([-5], [1])], [[[-5], [1]]]) == ("", "")
    assert complete(whole, q, (), [[[-5], [1]]]) == ("divisor", "w")


def test_a_mode_at_a_value_is_no_generic_one() -> None:
    def new(found: MovedModes, q: Any, mode: Any) -> tuple[str, str]:
        return refusal(lambda: found.require_new(q, mode, "c"))

    found = at("t", ELL, polynomial([0, -1], [1]), polynomial([3], [1]))
    assert new(found, value(-2, 1), X) == ("", "")
    assert new(found, value(0, 1), X) == ("common_factor", "c")
    assert new(found, value(-2, 1), polynomial([-2], [1])) == ("common_factor", "c")
    assert new(found, value(-2, 0, 1), polynomial([-2], [], [1])) == ("common_factor", "c")
    assert new(found, value(-5, 1), polynomial([3], [1])) == ("common_factor", "c")
    assert new(found, value(-5, 1), polynomial([3 + ELL], [1])) == ("common_factor", "c")
    assert new(at("t"), value(0, 1), X) == ("", "")


def others(
    found: MovedModes, *values: Any, moduli: Any = (LARGE,), common: Any = ()
) -> tuple[str, str]:
    return refusal(lambda: found.require_no_other(values, list(common), list(moduli)))


FACTOR, PRODUCT = ("common_factor", "witness"), ("product", "witness.gains")


def test_every_other_value_is_excluded() -> None:
    assert others(at("t")) == FACTOR
    assert others(at("t"), value(0, 1)) == ("", "")
    assert others(at("t"), value(-1, 1)) == FACTOR
    assert others(at("t^2"), value(0, 1)) == ("", "")
    assert others(at("t^3 - t^2"), value(0, 1)) == FACTOR
    assert others(at("t^3 - t^2"), value(0, 1), value(-1, 1)) == ("", "")
    assert others(at("t^3 - t^2"), value(-1, 1), value(5, 1), value(0, 1)) == ("", "")
    assert others(at("1")) == ("", "")
    assert others(at("t"), moduli=(2,))[0] == "modulus"


def test_resultants_that_vanish_show_nothing() -> None:
    assert others(at("t", first=0), value(0, 1)) == PRODUCT
    assert others(at("t", second=0), value(0, 1)) == ("", "")  # R is 1, and 1 has no roots
    assert others(at("t^2 - t", second=0), value(0, 1)) == FACTOR
    assert others(at("7*t + 1", 7, first=0)) == PRODUCT


def test_what_is_left_is_monic_before_it_is_reduced() -> None:
    assert others(at("7*t + 1", 7))[0] == "unit"
    assert others(at("7*t + 1", 7), value("1/7", 1)) == ("", "")
    assert others(at("7*t + 1"), value("1/7", 1)) == ("", "")
    assert others(at("t^2 - 9*t + 8", 7), value(-1, 1)) == FACTOR
    assert others(at("t^2 - 9*t + 8", 7), value(-1, 1), value(-8, 1)) == ("", "")


def test_polynomials_of_the_second_gains_are_not_divided() -> None:
    apart = plant([[0, 0], [0, 7]], ([[0], ["t"]], [[1, 1]]))
    assert others(moved(apart, [constant([1])], [constant([7])], X, ell=7)) == FACTOR
    assert others(moved(apart, [constant([1])], [constant([7])], X, ell=7), value(0, 1)) == ("", "")
    assert others(moved(apart, [constant([1])], [constant([2])], X), value(0, 1)) == ("", "")


def modular(found: MovedModes, *values: Any, common: Any = ()) -> tuple[str, str]:
    """What the resultant modulo ℓ alone shows, with values and what divides polynomials there."""
    named = [{"value": [*map(int, q)], "divisor": divisor} for q, divisor in common]
    return others(found, *values, moduli=(), common=named)


ZERO, ONE, MODE = value(0, 1), value(-1, 1), [[], [1]]


def test_a_resultant_modulo_one_number_is_divided_as_often_as_is_proved() -> None:
    assert modular(at("t")) == modular(at("t"), ZERO) == FACTOR
    assert modular(at("t"), ZERO, common=[(ZERO, MODE)]) == ("", "")
    assert modular(at("t^2"), ZERO, common=[(ZERO, MODE)]) == FACTOR
    assert modular(at("t^2 - t"), ZERO, ONE, common=[(ZERO, MODE)]) == FACTOR
    assert modular(at("t^2 - t"), ZERO, ONE, common=[(ONE, MODE), (ZERO, MODE)]) == ("", "")
    assert modular(at("t^2 - t"), value(0, -1, 1), common=[(value(0, -1, 1), MODE)]) == ("", "")
    assert modular(at("1")) == ("", "")
    assert modular(at("t", 4, second=3), ZERO, common=[(ZERO, MODE)]) == ("", "")
    two = moved(
        plant([[0, 0], [0, 5]], ([["t"], ["t"]], [[1, 1]])), *[[constant([k])] for k in (1, 2)]
    )
    assert modular(two, ZERO, common=[(ZERO, MODE)]) == FACTOR
    assert modular(two, ZERO, common=[(ZERO, [[], [-5], [1]])]) == ("", "")


def test_divisors_at_values_are_those_of_both_polynomials() -> None:
    pair = plant([[0, 0], [1, 5]], ([["t"], [0]], [[1, 1]]), ([[0], [1]], [[1, 1]]))
    F, G = [constant([2]), constant([3])], [constant([7]), constant([11])]
    found = moved(pair, F, G)  # (x − 5) x and (x − 8) x at t = 0
    assert modular(found, ZERO, common=[(ZERO, MODE)]) == ("", "")
    for divisor in ([[], [-5], [1]], [[], [-8], [1]], [[-1], [1]]):
        refused = modular(found, ZERO, common=[(ZERO, divisor)])
        assert refused == ("divisor", "witness.common[0]")
    assert modular(found, ZERO, common=[(ZERO, [[0, 1], [1]])])[0] == "form"
    assert modular(found, ZERO, common=[(ZERO, [[1]])])[0] == "form"


def test_values_that_are_divided_out_are_named_and_coprime() -> None:
    found, twice = at("t^2 - t"), [(ZERO, MODE), (ZERO, MODE)]
    assert modular(found, ZERO, common=[(ZERO, MODE), (ONE, MODE)]) == (
        "claim",
        "witness.common[1]",
    )
    assert modular(at("t^2"), ZERO, common=twice) == ("common_factor", "witness.common[1]")
    near = value(-1 - ELL, 1)
    plain = at(f"t^2 - {2 + ELL}*t + {1 + ELL}")
    assert modular(plain, ONE, near, common=[(ONE, MODE), (near, MODE)])[0] == "common_factor"
    assert modular(plain, ONE, common=[(ONE, MODE)]) == FACTOR
    assert modular(at("t"), value(-1), common=[(value(-1), MODE)])[0] == "form"


def test_a_modulus_loses_no_degree() -> None:
    assert modular(at("7*t + 1", 7)) == ("degree", "witness.gains")
    assert modular(at("7*t + 1", 14))[0] == "unit"
    assert modular(at("t", 7, first=7), ZERO, common=[(ZERO, MODE)])[0] == "degree"
    assert modular(at("t", first=0), ZERO, common=[(ZERO, MODE)])[0] == "degree"


def test_moduli_leave_nothing_to_divisors() -> None:
    common = [{"value": [0, 1], "divisor": MODE}]
    assert others(at("t"), ZERO, common=common) == ("form", "witness.common")
    assert others(at("t"), ZERO, moduli=(), common=common) == ("", "")
    assert others(at("t"), ZERO, moduli=(), common=[{**common[0], "more": 1}])[0] == "form"
