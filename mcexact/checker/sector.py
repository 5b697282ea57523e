"""A rate, a disc and the sector of a damping ratio, each as stability; ``proofs/stability.md``."""

from fractions import Fraction
from typing import NamedTuple

from . import budget
from .arithmetic import Matrix, Polynomial, beside, cleared, poly_product, stack
from .location import in_region, is_hurwitz
from .reading import Json, rational, require
from .region import inside, read_bound
from .system import System

LIMITS = ("damping", "largest_modulus")
"""The keys of a claim in continuous time that limit eigenvalues besides the rate."""


class Region(NamedTuple):
    """Real parts below −bound (discrete: moduli below it), −Re λ > ζ|λ| and |λ| < R, if given."""

    time: str
    bound: Fraction
    damping: Fraction | None
    largest: Fraction | None

    @property
    def limits(self) -> list[str]:
        """The keys of the limits that are given."""
        given = zip(LIMITS, (self.damping, self.largest), strict=True)
        return [key for key, limit in given if limit is not None]

    def contains(self, p: Polynomial) -> bool:
        """Whether all roots lie in the region.

        Theorems ``sector.damping_by_integers``, ``routh_integers.in_region_discrete``.
        """
        held = in_region(p, self.time, self.bound)
        if held and self.largest is not None:
            held = in_region(p, "discrete", self.largest)
        if held and self.damping is not None:
            held = is_hurwitz(turned(p, self.damping))
        return held

    def sides(self, M: Matrix) -> dict[str, tuple[Matrix, str, Fraction]]:
        """Matrices, each with the rate or the radius that it meets, iff M has the region.

        Theorem ``sector.damping_matrix``.
        """
        found = {"bound": (M, self.time, self.bound)}
        if self.damping is not None:
            found["damping"] = lifted(M, self.damping), "continuous", Fraction(0)
        if self.largest is not None:
            found["largest_modulus"] = M, "discrete", self.largest
        return found


def read_region(bound: Json, damping: Json, largest: Json, system: System) -> Region:
    """The region of a claim; the limits are for continuous time."""
    given, discrete = read_bound(bound, system), system.time == "discrete"
    zeta = None if damping is None else rational(damping, "claim.damping")
    R = None if largest is None else rational(largest, "claim.largest_modulus")
    fits = zeta is None or (not discrete and 0 < zeta < 1)
    require(fits, "bound", "claim.damping", "expected a ratio between 0 and 1, continuous time")
    fits = R is None or (not discrete and R > 0)
    require(fits, "bound", "claim.largest_modulus", "expected a number > 0, continuous time")
    return Region(system.time, Fraction(int(discrete)) if given is None else given, zeta, R)


def turned(p: Polynomial, zeta: Fraction) -> Polynomial:
    """A multiple of Π (x − wλ)(x − w̄λ) over the roots λ, w = h + r, r² = −a²h, h = b² − a².

    With ζ = a/b: all w λ have negative real part iff −Re λ > ζ|λ| for all λ, since they come in
    conjugate pairs.  Σ p_k w^(d−k) x^k = U + rV, and the product is U² + a²hV².

    Theorems ``sector.damping_rule``, ``sector.damping_by_integers``.
    """
    (numbers, _), a, b = cleared(p), zeta.numerator, zeta.denominator
    h, longest = b**2 - a**2, budget.limbs(numbers) + 2 * len(p) * budget.limbs([b])
    units = budget.products(4 * len(p), longest, longest)
    budget.spend(units + budget.table(6, len(p), longest))
    U, V, u, v = list[int](), list[int](), 1, 0
    for c in reversed(numbers):
        U.insert(0, c * u)
        V.insert(0, c * v)
        u, v = h * u - a**2 * h * v, u + h * v
    squares = zip(poly_product(U, U), poly_product(V, V), strict=True)
    return [x + a**2 * h * y for x, y in squares]


def lifted(M: Matrix, zeta: Fraction) -> Matrix:
    """[M, −cM; M, M], c = ζ²/(1 − ζ²), whose eigenvalues are (1 ± i√c) λ.

    Theorem ``sector.damping_matrix``.
    """
    n, c = M.nrows, zeta**2 / (1 - zeta**2)
    return stack([beside([M, M.times(-c)], n), beside([M, M], n)], 2 * n)


def within(claim: dict[str, Json], system: System) -> str:
    """The region of a claim, in words."""
    limit = claim["bound"]
    told = [inside(int(system.time == "discrete") if limit is None else limit, system)]
    words = zip(LIMITS, ("damping ratio above", "modulus below"), strict=True)
    told += [f"{word} {Fraction(claim[key])}" for key, word in words if key in claim]
    return " and ".join(told)
