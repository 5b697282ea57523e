"""Resultants with respect to x of polynomials in x and t, modulo ℓ and over Q."""

import math
from fractions import Fraction
from operator import mul

from . import budget
from .arithmetic import Polynomial, cleared, inverse, poly_modulo, stripped
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
    many = degree_bound(f, g) + 1
    values = [
        [_of_values(_at(f, t, ell), _at(g, t, ell), ell)] for t in budget.counted(range(many))
    ]
    return interpolated(values, ell)[0]


def degree_bound(f: Bivariate, g: Bivariate) -> int:
    """A bound for the degree in t of the resultant of f, monic in x, and g.

    It is the product of g(α) over the roots x = α of f, which are series in t at infinity.

    Open: see ``proofs/OPEN.md``.
    """
    budget.spend(budget.fractions(len(f) * (len(f) + len(g)), 1))
    total: float | Fraction = 0
    for slope, steps in _degrees_of_roots(f):
        values = (len(c) - 1 + (k and k * slope) for k, c in enumerate(g) if c)
        total += steps * max(values, default=-math.inf)
    return int(max(total, 0))


def _degrees_of_roots(f: Bivariate) -> list[tuple[Fraction | float, int]]:
    """The degrees in t of the roots x, each with their number: slopes of the Newton polygon.

    The root 0 has the degree −∞.
    """
    found: list[tuple[Fraction | float, int]] = []
    k = len(f) - 1
    while k > 0:
        lines = ((Fraction(len(f[j]) - len(f[k]), k - j), k - j) for j in range(k) if f[j])
        found.append(max(lines, default=(-math.inf, k)))
        k -= found[-1][1]
    return found


def _at(f: Residues, t: int, ell: int) -> Polynomial:
    a = budget.limbs([ell])
    budget.spend(budget.STEP + budget.reductions(sum(map(len, f)) + 2 * len(f) + degree(f), a))
    powers = [1]
    for _ in range(degree(f)):
        powers.append(powers[-1] * t % ell)
    return [sum(map(mul, c, powers)) % ell for c in f]


def _of_values(f: Polynomial, g: Polynomial, ell: int) -> int:
    """Res(f, g) by remainders r of c·f, c a power of b, b leading in g, and one inverse at the end.

    Res(f, g) = (−1)^(deg f · deg g) b^(deg f − deg r) Res(g, r) / c^(deg g).
    """
    top, bottom, a = 1, 1, budget.limbs([ell])
    budget.spend(budget.inversions(2, a) + budget.reductions(20, a))
    while len(g) > 1:
        rest, power, b = _remainder(f, g, ell)
        # a power modulo ℓ, by the square and multiply method, of a number or of its inverse
        budget.spend(budget.inversions(1, a) + budget.reductions(20, a))
        # one b more above and below: the last inverse tells whether every b is a unit
        top, lost = top * b, (len(f) - len(rest)) - power * (len(g) - 1)
        bottom = bottom * pow(b, 1 - lost, ell) % ell
        if not rest:
            return 0 * inverse(bottom, ell)
        if (len(f) - 1) * (len(g) - 1) % 2:
            top = -top
        top, f, g = top % ell, g, rest
    return top * inverse(bottom, ell) * pow(g[0], len(f) - 1, ell) % ell


def _remainder(f: Polynomial, g: Polynomial, ell: int) -> tuple[Polynomial, int, int]:
    """The remainder of b^k f by g, k ≥ 2, with k and b, the leading coefficient of g."""
    rest, b, k = [*f, *[0] * (len(g) + 1 - len(f))], g[-1], 2
    turns = len(rest) - len(g)
    budget.spend(100 + 2 * budget.reductions(turns * len(rest) + 16, budget.limbs([ell])))
    while len(rest) > len(g) + 1:
        last, k = rest.pop(), k + 1
        shifted = [*[0] * (len(rest) + 1 - len(g)), *g]
        rest = [(b * c - last * d) % ell for c, d in zip(rest, shifted, strict=False)]
    # the last two turns at once, with one reduction for each coefficient
    last, factor = rest[-1], b * b % ell
    both, before = b * last % ell, (b * rest[-2] - last * g[-2]) % ell
    triples = zip(rest[:-2], g, [0, *g], strict=False)
    return stripped([(factor * c - before * d - both * e) % ell for c, d, e in triples]), k, b


def integer_resultant(f: Bivariate, g: Bivariate, moduli: list[int]) -> list[int]:
    """The resultant of the least integer multiples of f and g, both monic in x, over Z.

    Its coefficients are at most |f|₁^(deg g) |g|₁^(deg f), |f|₁ the sum of the absolute values of
    all coefficients of the multiple, and the product of the moduli, pairwise coprime, is larger
    than twice this.
    """
    (c, first), (d, second) = map(_multiple, (f, g))
    a, b = budget.limbs([first, c]) * (len(g) - 1), budget.limbs([second, d]) * (len(f) - 1)
    budget.spend(budget.products(8, a + b + 1, a + b + 1))
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
    budget.spend(10 * sum(map(len, f)))
    numbers, d = cleared([c for part in f for c in part])
    return d, sum(map(abs, numbers))
