"""Least recurrences modulo primes, and the proof that they are the least."""

from __future__ import annotations

import random

import pytest

from mcexact.exact.krylov import cofactors, least_recurrence
from mcexact.exact.modular import ModularPolynomial


def satisfied(d: list[int], s: list[int], ell: int) -> bool:
    """Whether Σ_j d_j s_{k+j} = 0 for every k for which all terms are given."""
    turns = range(len(s) - len(d) + 1)
    return not any(sum(c * s[k + j] for j, c in enumerate(d)) % ell for k in turns)


def least_degree(s: list[int], ell: int) -> int:
    """The largest order of a leading block (s_{i+j}) that is regular, by Gaussian elimination."""

    def regular(size: int) -> bool:
        rows = [[s[i + j] % ell for j in range(size)] for i in range(size)]
        for k in range(size):
            pivot = next((i for i in range(k, size) if rows[i][k]), None)
            if pivot is None:
                return False
            rows[k], rows[pivot] = rows[pivot], rows[k]
            for row in rows[k + 1 :]:
                f = row[k] * pow(rows[k][k], -1, ell)
                row[k:] = [(a - f * b) % ell for a, b in zip(row[k:], rows[k][k:], strict=True)]
        return True

    return max(size for size in range(len(s) // 2 + 1) if regular(size))


@pytest.mark.parametrize("ell", [2, 3, 7, 524287])
def test_the_recurrence_is_the_least_one_and_coprime_to_its_numerator(ell: int) -> None:
    rng = random.Random(ell)
    for _ in range(60):
        L = rng.randint(0, 5)
        rule = [rng.randrange(ell) for _ in range(L)]
        s = [rng.randrange(ell) for _ in range(L)]
        while len(s) < 2 * L + 2:
            s.append(-sum(c * v for c, v in zip(rule, s[len(s) - L :], strict=True)) % ell)
        d = least_recurrence(s, ell)
        assert satisfied(list(d.coefficients), s, ell)
        assert d.coefficients[-1] == 1
        assert d.degree == least_degree(s, ell)
        a, e = cofactors(d, s)
        numerator = [
            sum(d.coefficients[j] * s[j - i - 1] for j in range(i + 1, d.degree + 1))
            for i in range(d.degree)
        ]
        num = ModularPolynomial.from_coefficients(numerator, ell)
        assert (a * num + e * d).coefficients == (1,)
        assert a.degree < max(d.degree, 1)


def test_numbers_that_are_all_zero_have_the_recurrence_of_degree_0() -> None:
    assert least_recurrence([0, 0, 0, 0], 7).coefficients == (1,)
    assert least_recurrence([], 7).coefficients == (1,)
