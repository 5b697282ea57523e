"""Polynomials in a parameter t from their values at 0, 1, …, over Q and modulo ℓ."""

from fractions import Fraction
from itertools import pairwise
from typing import Any

from . import budget
from .arithmetic import Polynomial, inverse, stripped


def interpolated(values: list[Polynomial], ell: int = 0) -> list[Polynomial]:
    """The coefficients with these values at t = 0, 1, …, one polynomial in t for each (Newton).

    Open: see ``proofs/OPEN.md``.
    """
    many, longest = len(values), max(map(budget.limbs_of, values))
    units = budget.reductions(1, longest) if ell else budget.fractions(1, longest + many // 8)
    budget.spend(2 * units * many * many * len(values[0]))
    inverses = [inverse(k, ell) if ell else Fraction(1, k) for k in range(1, many)]
    return [_of_column([*column], inverses, ell) for column in zip(*values, strict=True)]


def _of_column(values: list[Any], inverses: list[Any], ell: int) -> Polynomial:
    """Σ Δ^k / k! · t (t − 1) … (t − k + 1), Δ^k the differences of order k at 0."""
    slopes: list[Any] = values[:1]
    scale: Any = 1
    for f in inverses:
        scale = scale * f % ell if ell else scale * f
        differences = [b - a for a, b in pairwise(values)]
        values = [c % ell for c in differences] if ell else differences
        slopes.append(values[0] * scale)
    p: Polynomial = []
    for t in reversed(range(len(slopes))):
        p = [a - t * b for a, b in zip([slopes[t], *p], [*p, 0], strict=True)]
        p = [c % ell for c in p] if ell else p
    return stripped(p)
