"""The search for the fixed spectrum: gains that move as many modes as possible, and subspaces."""

from __future__ import annotations

import itertools
import random
from dataclasses import dataclass

from mcexact.analysis.engine.shrunk_subspace import ExactSubspace, shrunk_subspace
from mcexact.derived.modular import (
    Gains,
    ModularSystem,
    drawn_gains,
    loop_polynomials,
    quick_bits,
    residue_systems,
)
from mcexact.errors import InternalError
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.modular import ModularPolynomial, combine, integers, polynomial_residues
from mcexact.exact.polynomial import Polynomial, from_integer_coefficients, product
from mcexact.model.system import MultiChannelSystem


@dataclass(frozen=True)
class Obstruction:
    """An irreducible factor of χ_A that is fixed, with a proof.

    Attributes
    ----------
    polynomial : Polynomial
        p, monic and irreducible.
    multiplicity_in_A : int
        The exponent of p in χ_A.
    subspace : ExactSubspace
        A shrunk subspace for the least T, with the largest deficiency.
    """

    polynomial: Polynomial
    multiplicity_in_A: int
    subspace: ExactSubspace


@dataclass(frozen=True)
class Decision:
    """All fixed factors of a system, and gains that move all others.

    Attributes
    ----------
    modular : ModularSystem
        The system modulo ℓ.
    gains : tuple
        F modulo ℓ: χ_A / Π p^a and χ_{A_F} are coprime modulo ℓ.
    closed : ModularPolynomial
        χ_{A_F} modulo ℓ.
    obstructions : tuple of Obstruction
        Sorted by degree, then by coefficients.
    """

    modular: ModularSystem
    gains: Gains
    closed: ModularPolynomial
    obstructions: tuple[Obstruction, ...]


def decide(system: MultiChannelSystem, rng: random.Random) -> Decision:
    """Find all fixed factors of a system, with the evidence.

    Parameters
    ----------
    system : MultiChannelSystem
    rng : random.Random
        The source of primes and gains, which affects the running time but not the answer.

    Notes
    -----
    F is uniform modulo a prime.  If no mode is fixed, χ_A and χ_{A_F} are nearly always coprime
    modulo the prime, and the search ends after these two characteristic polynomials.  For many
    states the prime has some 22 bits (see `mcexact.exact.krylov`). Otherwise their common factors
    modulo one or more primes are lifted to a factor of χ_A over Q, which is factored; from then on
    primes have 61 bits, so that the exponents in χ_{A_F} are nearly always the least ones.  Each
    irreducible factor has a shrunk subspace or is dropped.  The search ends when the remaining
    factor of χ_A is coprime to χ_{A_F}.
    """
    lift: CommonFactor | None = None
    known: dict[Polynomial, ExactSubspace | None] = {}
    quick = itertools.islice(residue_systems(system, rng, quick_bits(system)), 1)
    for modular in itertools.chain(quick, residue_systems(system, rng, bits=61)):
        gains = drawn_gains(modular, rng)
        opened, closed = loop_polynomials(modular, gains)
        common = opened.gcd(closed)
        if common.degree == 0:
            return Decision(modular, gains, closed, ())
        if modular.modulus < 2**30:
            continue
        if lift is None:
            lift = CommonFactor(characteristic_polynomial(system.A), system.A.denominator)
        candidate = lift.lifted(common)
        if candidate is None:
            continue
        found = []
        for p, _ in candidate.factor():
            if p not in known:
                known[p] = shrunk_subspace(system, p, rng, first=modular)
            subspace = known[p]
            if subspace is not None:
                found.append(Obstruction(p, p.multiplicity_in(lift.characteristic), subspace))
        if _rest_is_free(lift.characteristic, closed, found):
            found.sort(key=lambda o: (o.polynomial.degree, o.polynomial.coefficients))
            return Decision(modular, gains, closed, tuple(found))
    raise InternalError("the stream of primes is endless")


class CommonFactor:
    """The factor of χ_A that all closed loops share, collected from its residues."""

    def __init__(self, characteristic: Polynomial, denominator: int) -> None:
        self.characteristic = characteristic
        self._denominator = denominator
        self._residues: list[int] = []
        self._modulus = 1

    def lifted(self, common: ModularPolynomial) -> Polynomial | None:
        """A monic factor of χ_A with the residues seen so far, if they determine one.

        Notes
        -----
        With A = N/d, N integer, d^k times the coefficient of x^{deg−k} is an integer: symmetric
        residues of these are the candidates.  Only the gcds of least degree count, since a gcd
        has more only by accident.
        """
        degree, ell, d = common.degree, common.modulus, self._denominator
        scaled = [c * pow(d, degree - k, ell) % ell for k, c in enumerate(common.coefficients)]
        if not self._residues or degree < len(self._residues) - 1:
            self._residues, self._modulus = scaled, ell
        elif degree == len(self._residues) - 1:
            [self._residues] = combine([self._residues], self._modulus, [scaled], ell)
            self._modulus *= ell
        else:
            return None
        values = integers(self._residues, self._modulus)
        size = len(values) - 1
        candidate = from_integer_coefficients(
            [value * d**k for k, value in enumerate(values)], d**size
        )
        return candidate if candidate.divides(self.characteristic) else None


def _rest_is_free(
    characteristic: Polynomial, closed: ModularPolynomial, found: list[Obstruction]
) -> bool:
    """Whether χ_A / Π p^a and χ_{A_F} are coprime modulo ℓ, and the p are, pairwise."""
    ell = closed.modulus
    rest = characteristic // product(o.polynomial**o.multiplicity_in_A for o in found)
    if polynomial_residues(rest, ell).gcd(closed).degree > 0:
        return False
    residues = [polynomial_residues(o.polynomial, ell) for o in found]
    return all(p.gcd(q).degree == 0 for p, q in itertools.combinations(residues, 2))
