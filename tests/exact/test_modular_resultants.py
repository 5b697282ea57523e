"""Resultants modulo primes, the bound of their degree, and common divisors by residues."""

from __future__ import annotations

import random
from collections.abc import Iterator
from typing import Any

import flint
import pytest

from mcexact.errors import InternalError
from mcexact.exact.bivariate import (
    common_divisor,
    difference,
    interpolated_modulo,
    of_rationals,
    product,
    residues,
    resultant_degree_bound,
)
from mcexact.exact.modular import primes
from tests.oracle.resultants import resultant

P = flint.fmpq_poly
ELL = 2**61 - 1


def drawn(rng: random.Random, degree: int) -> list[Any]:
    """A polynomial that is monic in x, with some coefficients 0."""
    parts = [
        P([flint.fmpq(rng.randint(-4, 4), rng.choice((1, 2, 3))) for _ in range(rng.randint(0, 3))])
        for _ in range(degree)
    ]
    return [*parts, P([1])]


@pytest.mark.parametrize("seed", range(16))
def test_resultants_have_the_residues_of_exact_ones_and_no_larger_degree(seed: int) -> None:
    rng = random.Random(seed)
    f, g = drawn(rng, rng.randint(0, 4)), drawn(rng, rng.randint(1, 3))
    whole = resultant(f, g)
    assert of_rationals(f, g, ELL) == residues(whole, ELL)
    assert whole.degree() <= resultant_degree_bound(f, g)
    assert whole.degree() <= resultant_degree_bound(f, difference(g, f))


def test_the_bound_is_reached_by_most_polynomials() -> None:
    f = [P([0, 0, 1]), P([1, 1]), P([3]), P([1])]
    g = [P([5, 2]), P([0, 3]), P([1])]
    assert resultant(f, g).degree() == resultant_degree_bound(f, g) == resultant_degree_bound(g, f)
    # -t + 1 and -t + 2 are alike at infinity
    f, g = [P([1, -1]), P([1])], [P([2, -1]), P([1])]
    assert (resultant_degree_bound(f, g), resultant_degree_bound(f, difference(g, f))) == (1, 0)
    # the root 0, and a polynomial that vanishes there
    assert resultant_degree_bound([P([]), P([1])], [P([0, 0, 7])]) == 2
    assert resultant_degree_bound([P([]), P([1])], [P([]), P([0, 0, 7])]) == 0


@pytest.mark.parametrize("many", [1, 2, 3, 5, 8, 13])
def test_a_polynomial_is_found_from_its_values(many: int) -> None:
    rng = random.Random(many)
    p = flint.nmod_poly([rng.randrange(ELL) for _ in range(many)], ELL)
    assert interpolated_modulo([int(p(t)) for t in range(many)], ELL) == p
    assert interpolated_modulo([int(p(t)) for t in range(many + 2)], ELL) == p
    assert interpolated_modulo([0] * many, ELL) == flint.nmod_poly([], ELL)


def stream() -> Iterator[int]:
    return primes(1, 61)


@pytest.mark.parametrize("value", ["1", f"{2**70}/3", f"1/{3**50}", f"-{7**60}"])
def test_what_two_resultants_have_in_common_is_found_whatever_its_size(value: str) -> None:
    """x is a root of f, of g and of h where t is the value, and where t² = 2 of f and g alone."""
    top, _, bottom = value.partition("/")
    q = P([-flint.fmpq(int(top), int(bottom or 1)), 1])
    f = [P([]), P([1])]
    g, h = [q * P([-2, 0, 1]), P([3, 1]), P([1])], [q * P([1, 1]), P([1])]
    assert common_divisor(f, g, h, stream()) == q
    assert common_divisor(f, g, product(h, h), stream()) == q
    assert common_divisor(f, g, [q + 1, P([1])], stream()) == 1
    assert common_divisor(f, g, h, stream()) == resultant(f, g).gcd(resultant(f, h))


def test_primes_at_which_more_is_common_are_left_out() -> None:
    """t − 1 and t − 8 are the same modulo 7."""
    f = [P([]), P([1])]
    g, h = [P([-1, 1]) * P([0, 1]), P([1])], [P([-8, 1]) * P([0, 1]), P([1])]
    for first in ([7], [ELL, 7], [7, ELL, 11]):
        chosen = iter([*first, *(ell for _, ell in zip(range(9), stream(), strict=False))])
        assert common_divisor(f, g, h, chosen) == P([0, 1])
    with pytest.raises(InternalError):
        common_divisor(f, g, h, iter([7]))
