"""Kind ``closed_loop_spectrum``: the whole spectrum; ``proofs/closed_loop_spectrum.md``."""

import math

from . import budget
from .arithmetic import Matrix, Polynomial, poly_modulo
from .characteristic_polynomial import characteristic_polynomial, scaled_bound
from .reading import Json, fields, integer, items, polynomial, require
from .statement import polynomial_text
from .system import System


def check(claim: Json, witness: Json, system: System) -> None:
    """Compare with det(xI − A) modulo every ℓ; the moduli suffice to prove equality.

    Theorem ``closed_loop_spectrum.closed_loop_spectrum``.
    """
    (listed,) = fields(claim, "claim", "polynomial")
    (numbers,) = fields(witness, "witness", "moduli")
    p = polynomial(listed, "claim.polynomial")
    require_spectrum(system.A, p, "claim.polynomial", moduli(numbers, "witness.moduli"))


def statement(claim: Json, system: System) -> str:
    """The characteristic polynomial."""
    return f"the characteristic polynomial of A is {polynomial_text(claim['polynomial'])}"


def moduli(value: Json, place: str) -> list[int]:
    """Read integers ≥ 2 that are pairwise coprime."""
    found, product = [], 1
    for k, entry in enumerate(items(value, place)):
        found.append(integer(entry, f"{place}[{k}]", 2))
        longest, more = budget.limbs([product]), budget.limbs(found[-1:])
        budget.spend(budget.reductions(longest, more) + budget.fractions(1, more))
        coprime = math.gcd(product, found[-1]) == 1
        require(coprime, "modulus", f"{place}[{k}]", "not coprime to those before it")
        product *= found[-1]
    return found


def require_spectrum(A: Matrix, p: Polynomial, place: str, ells: list[int]) -> None:
    """Stop unless det(xI − A) = p, given that the moduli suffice.

    Theorem ``closed_loop_spectrum.closed_loop_spectrum``.
    """
    beta, D = scaled_bound(A)
    require(len(p) == A.nrows + 1, "degree", place, f"expected degree {A.nrows}")
    longest = budget.limbs([beta]) + budget.limbs_of(p)
    budget.spend(budget.fractions(3 * len(p), longest))
    small = all(D % c.denominator == 0 and abs(D * c) <= beta for c in p)
    require(small, "bound", place, "a coefficient that no matrix with these rows has")
    require(math.prod(ells) > 2 * beta, "moduli", "witness.moduli", "too few for these entries")
    for ell in budget.counted(ells):
        a = budget.limbs([ell])
        budget.spend(budget.reductions(1, longest, a) + budget.fractions(1, a))
        require(math.gcd(D, ell) == 1, "modulus", "witness.moduli", "divides a denominator")
        found = characteristic_polynomial(A, ell)
        require(found == poly_modulo(p, ell), "spectrum", place, f"differs modulo {ell}")
