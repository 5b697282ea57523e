"""Polynomials in a parameter t from their values at 0, 1, …, over Q and modulo ℓ."""

from fractions import Fraction

from . import budget
from .arithmetic import Polynomial, inverse, stripped


def interpolated(values: list[Polynomial], ell: int = 0) -> list[Polynomial]:
    """The coefficients with these values at t = 0, 1, …, one polynomial in t for each (Newton).

    Open: see ``proofs/OPEN.md``.
    """
    many, longest = len(values), max(map(budget.limbs_of, values))
    units = budget.reductions(1, longest) if ell else budget.fractions(1, longest + many // 8)
    budget.spend(2 * units * many * many * len(values[0]))
    table = [list(value) for value in values]
    for k in range(1, many):
        f = inverse(k, ell) if ell else Fraction(1, k)
        for i in range(many - 1, k - 1, -1):
            pairs = zip(table[i], table[i - 1], strict=True)
            table[i] = [(a - b) * f % ell if ell else (a - b) * f for a, b in pairs]
    result = []
    for slopes in zip(*table, strict=True):
        p: Polynomial = []
        for t in reversed(range(many)):
            p = [a - t * b for a, b in zip([slopes[t], *p], [*p, 0], strict=True)]
            p = [c % ell for c in p] if ell else p
        result.append(stripped(p))
    return result
