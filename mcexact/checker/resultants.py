"""Resultants with respect to x of polynomials in x and t, modulo ℓ and over Q."""

from . import budget
from .arithmetic import Polynomial, cleared, inverse, poly_divide, poly_modulo, stripped
from .interpolation import interpolated
from .reading import require
from .two_variables import Bivariate, degree

Residues = list[list[int]]


def residues(f: Bivariate, ell: int) -> Residues:
    """f modulo ℓ, which divides no denominator."""
    return [poly_modulo(c, ell) for c in f]


def resultant(f: Residues, g: Residues, ell: int) -> Polynomial:
    """The resultant of f and g, both monic in x, modulo ℓ, through its values at t = 0, 1, …

    Open: see ``proofs/OPEN.md``.
    """
    many = (len(f) - 1) * max(degree(g), 0) + (len(g) - 1) * max(degree(f), 0) + 1
    values = [
        [_of_values(_at(f, t, ell), _at(g, t, ell), ell)] for t in budget.counted(range(many))
    ]
    return interpolated(values, ell)[0]


def _at(f: Residues, t: int, ell: int) -> Polynomial:
    longest = budget.limbs([ell])
    budget.spend(budget.reductions(sum(map(len, f)), longest))
    result = []
    for c in f:
        total = 0
        for entry in reversed(c):
            total = (total * t + entry) % ell
        result.append(total)
    return result


def _of_values(f: Polynomial, g: Polynomial, ell: int) -> int:
    """Res(f, g) = (−1)^(deg f · deg g) b^(deg f − deg r) Res(g, r), b leading in g, r = f mod g."""
    result = 1
    while len(g) > 1:
        rest = poly_divide(f, g, ell)[1]
        if not rest:
            return 0
        if (len(f) - 1) * (len(g) - 1) % 2:
            result = -result
        result = result * pow(g[-1], len(f) - len(rest), ell) % ell
        f, g = g, rest
    return result * pow(g[0], len(f) - 1, ell) % ell


def integer_resultant(f: Bivariate, g: Bivariate, moduli: list[int]) -> list[int]:
    """The resultant of the least integer multiples of f and g, both monic in x, over Z.

    Its coefficients are at most |f|₁^(deg g) |g|₁^(deg f), |f|₁ the sum of the absolute values of
    all coefficients of the multiple, and the product of the moduli, pairwise coprime, is larger
    than twice this.
    """
    (c, first), (d, second) = map(_multiple, (f, g))
    size = first ** (len(g) - 1) * second ** (len(f) - 1)
    factor, product, found = c ** (len(g) - 1) * d ** (len(f) - 1), 1, [0]
    for ell in budget.counted(moduli):
        part = resultant(residues(f, ell), residues(g, ell), ell)
        part = [factor * entry % ell for entry in part]
        length, shift = max(len(part), len(found)), inverse(product, ell)
        found, part = ([*p, *[0] * (length - len(p))] for p in (found, part))
        longest = budget.limbs([product, ell]) * 2
        budget.spend(budget.products(4 * length, longest, longest))
        pairs = zip(found, part, strict=True)
        found = [old + (new - old) * shift % ell * product for old, new in pairs]
        product *= ell
    enough = product > 2 * size
    require(enough, "modulus", "witness.moduli", f"expected a product above 2^{size.bit_length()}")
    return stripped([entry - product if 2 * entry > product else entry for entry in found])


def _multiple(f: Bivariate) -> tuple[int, int]:
    """The least d ≥ 1 that makes d·f integer, and the sum of the absolute values of d·f."""
    numbers, d = cleared([c for part in f for c in part])
    return d, sum(map(abs, numbers))
