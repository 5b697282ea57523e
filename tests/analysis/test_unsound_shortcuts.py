"""Shorter ways to the values of a parameter that give wrong answers, each carried out on a plant.

Every test runs the short-cut of its name, shows what it gets wrong, and that the answer is right.
"""

from __future__ import annotations

import copy
from fractions import Fraction
from typing import Any

import flint

from mcexact import MultiChannelSystem, ParametricSystem, check, fixed_spectrum
from mcexact.answer.protocol import document
from mcexact.derived.modular import PolynomialSystem
from mcexact.exact import bivariate
from mcexact.exact.matrix import Matrix
from mcexact.exact.parametric_polynomials import ParametricPolynomial, common_factors
from mcexact.exact.polynomial import to_fmpq_poly
from tests.checker.handmade import checked
from tests.checker.parametric_plants import exactly
from tests.oracle.parametric import fixed_radical
from tests.oracle.resultants import resultant

PRIME = 2**61 - 1


def loops(plant: ParametricSystem, *gains: list[int]) -> list[Any]:
    """det(xI − A), and det(xI − A_F) for scalar gains."""
    system = PolynomialSystem(plant)
    closed = [system.closed([Matrix.from_rows([[f]]) for f in F]) for F in gains]
    return [bivariate.characteristic(M) for M in (system.A, *closed)]


def coupled(entry: str) -> ParametricSystem:
    """1 and 3 are fixed where the entry vanishes, since nothing couples both states any more."""
    return ParametricSystem([[1, entry], [0, 3]], [[[0], [1]]], [[[1, 0]]], parameters=["t"])


def left_modulo(first: Any, listed: Any, second: Any, ell: int) -> bool:
    """Whether a resultant, divided modulo ℓ by a value as often as it goes, misses a second one."""
    rest, q = bivariate.residues(first, ell), bivariate.residues(listed, ell)
    while (pair := divmod(rest, q))[1] == 0:
        rest = pair[0]
    return bool(rest.gcd(second).degree() == 0)


def without_value(plant: ParametricSystem, value: Fraction) -> Any:
    """The certificate with a value left out."""
    found = copy.deepcopy(document(fixed_spectrum(plant)))
    values = [each["value"] for each in found["claim"]["exceptional"]]
    k = [-Fraction(q[0]) for q in values].index(value)
    gone = found["claim"]["exceptional"].pop(k)
    del found["witness"]["exceptional"][k]
    common = found["witness"]["common"]
    found["witness"]["common"] = [each for each in common if each["value"] != gone["value"]]
    return found


def test_dividing_values_out_modulo_a_prime_takes_congruent_values_for_one() -> None:
    plant = coupled(f"(t - 1)*(t - {1 + PRIME})")
    chi, first, second = loops(plant, [1], [2])
    one = flint.fmpq_poly([-1, 1])
    resultants = (
        resultant(chi, first),
        bivariate.of_rationals(chi, second, PRIME),
    )
    assert left_modulo(resultants[0], one, resultants[1], PRIME)  # 1 alone is accepted
    found = fixed_spectrum(plant)
    assert {each.exact for each in found.exceptional} == {1, 1 + PRIME}
    lie = without_value(plant, Fraction(1 + PRIME))
    lie["witness"]["modulus"] = PRIME
    assert checked(lie).verdict == checked(exactly(lie)).verdict == "INVALID"


def test_a_prime_that_divides_the_denominator_of_a_root_overlooks_it() -> None:
    plant = coupled(f"(t - 1)*({PRIME}*t - 1)")
    chi, first, second = loops(plant, [1], [2])
    whole = resultant(chi, first)
    modular = bivariate.of_rationals(chi, second, PRIME)
    assert left_modulo(whole, flint.fmpq_poly([-1, 1]), modular, PRIME)
    found = fixed_spectrum(plant)
    assert {each.exact for each in found.exceptional} == {1, Fraction(1, PRIME)}
    lie = without_value(plant, Fraction(1, PRIME))
    lie["witness"]["modulus"] = PRIME
    verdict = checked(lie)
    assert (verdict.verdict, verdict.code) == ("INVALID", "degree")
    verdict = checked(exactly(lie))
    assert (verdict.verdict, verdict.code) == ("INVALID", "unit")


def test_powers_of_a_generic_polynomial_divided_out_modulo_a_prime_take_roots_along() -> None:
    plant = ParametricSystem([[0, 0], [0, 5]], [[[0], ["t"]]], [[[0, 1]]], parameters=["t"])
    chi, first, second = loops(plant, [1], [2])
    p, ell = list(map(to_fmpq_poly, fixed_spectrum(plant).generic[0])), 5
    left, moved = (bivariate.without(f, p) for f in (chi, first))
    whole = resultant(left, moved)
    residue = [bivariate.residues(c, ell) for c in second]
    at_0 = flint.nmod_poly([int(c(0)) for c in residue], ell)
    x = flint.nmod_poly([0, 1], ell)
    while at_0 % x == 0:
        at_0 //= x
    assert whole(0) == 0 and at_0.degree() == 0  # so 0 is said not to be exceptional
    assert [each.exact for each in fixed_spectrum(plant).exceptional] == [0]
    assert bivariate.of_rationals(left, second, ell)(0) == 0


def test_a_companion_matrix_for_the_parameter_lets_gains_mix_conjugate_plants() -> None:
    parameter = ParametricSystem(
        [["t", 0, 0], [0, "t", 0], [0, 0, "-t"]],
        [[[1, 0], [0, 1], [0, 0]], [[0], [0], [1]]],
        [[[0, 0, 1]], [[1, 0, 0], [0, 1, 0]]],
        parameters=["t"],
    )
    t, zero = [[0, 2], [1, 0]], [[0, 0], [0, 0]]
    blocks = {"t": t, "-t": [[0, -2], [-1, 0]], 0: zero, 1: [[1, 0], [0, 1]]}

    def companion(rows: list[list[Any]]) -> list[list[int]]:
        return [[v for entry in row for v in blocks[entry][k]] for row in rows for k in (0, 1)]

    restricted = MultiChannelSystem(
        companion([["t", 0, 0], [0, "t", 0], [0, 0, "-t"]]),
        [companion([[1, 0], [0, 1], [0, 0]]), companion([[0], [0], [1]])],
        [companion([[0, 0, 1]]), companion([[1, 0, 0], [0, 1, 0]])],
    )
    assert fixed_spectrum(restricted).empty  # as if nothing were fixed where t² = 2
    found = fixed_spectrum(parameter)
    assert [[str(c) for c in p] for p in found.generic] == [["-x", "1"]]
    assert check(found, parameter).verdict == "VALID"
    assert not fixed_spectrum(parameter.at({"t": 2})).empty


def parallel(first: str, second: str) -> ParametricSystem:
    """One state, with two channels."""
    return ParametricSystem([[0]], [[[first]], [[second]]], [[[1]], [[1]]], parameters=["t"])


def test_small_gains_meet_by_accident_where_nothing_is_fixed() -> None:
    plant = parallel("t", "1")
    chi, first, second = loops(plant, [1, 1], [2, 2])
    common = resultant(chi, first).gcd(resultant(chi, second))
    assert str(common) == "x + 1"  # as if something were fixed at t = −1
    found = fixed_spectrum(plant)
    assert not found.generic and not found.exceptional
    assert check(found, plant).verdict == "VALID"
    assert fixed_radical(([[0]], [[[-1]], [[1]]], [[[1]], [[1]]])).degree() == 0


def test_a_resultant_that_is_zero_for_one_pair_of_gains_fixes_nothing() -> None:
    plant = parallel("t", "-t")
    chi, first = loops(plant, [1, 1])
    assert resultant(chi, first) == 0  # as if 0 were fixed for every t
    assert len(common_factors([ParametricPolynomial(("t",), f) for f in (chi, first)])) == 1
    found = fixed_spectrum(plant)
    assert not found.generic and [each.exact for each in found.exceptional] == [0]
    assert check(found, plant).verdict == "VALID"


def test_a_line_in_an_exceptional_set_has_generic_modes_that_the_plant_has_not() -> None:
    plant = ParametricSystem(
        [[0, 0], ["a - b", 1]], [[[1], [0]]], [[[0, 1]]], parameters=["a", "b"]
    )
    inside = fixed_spectrum(plant.along({"a": "s", "b": "s"}))
    assert inside.generic  # as if 1 and 0 were fixed for every a and b
    across = fixed_spectrum(plant.along({"a": "s", "b": 3}))
    assert not across.generic and [each.exact for each in across.exceptional] == [3]
    assert fixed_spectrum(plant.at({"a": 1, "b": 3})).empty
