"""Polynomials modulo word-size primes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import flint

from mcexact.errors import InputError
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.prime_field import require_prime, residue


@dataclass(frozen=True, eq=False)
class ModularPolynomial:
    """A polynomial over the field with ℓ elements.

    Attributes
    ----------
    modulus : int
        A prime ℓ below 2**63.

    Examples
    --------
    >>> p = ModularPolynomial.from_coefficients([-1, 0, 1], 7)
    >>> p.degree, p.roots(), p.gcd(ModularPolynomial.from_coefficients([1, 1], 7)).coefficients
    (2, [1, 6], (1, 1))
    """

    modulus: int
    _poly: flint.nmod_poly

    @classmethod
    def from_coefficients(cls, coefficients: Iterable[int], modulus: int) -> ModularPolynomial:
        """The polynomial with integer coefficients, constant term first, reduced modulo ℓ."""
        require_prime(modulus)
        return cls(modulus, flint.nmod_poly([int(c) % modulus for c in coefficients], modulus))

    @cached_property
    def coefficients(self) -> tuple[int, ...]:
        """Residues from 0 to ℓ − 1, constant term first, the last one not 0."""
        return tuple(map(int, self._poly.coeffs()))

    @property
    def degree(self) -> int:
        """The degree; −1 for 0."""
        return int(self._poly.degree())

    def __call__(self, value: int) -> int:
        """The value at a residue."""
        return int(self._poly(value % self.modulus))

    def _same(self, other: ModularPolynomial) -> None:
        if self.modulus != other.modulus:
            raise InputError(f"moduli do not match: {self.modulus} and {other.modulus}")

    def __add__(self, other: ModularPolynomial) -> ModularPolynomial:
        self._same(other)
        return ModularPolynomial(self.modulus, self._poly + other._poly)

    def __sub__(self, other: ModularPolynomial) -> ModularPolynomial:
        self._same(other)
        return ModularPolynomial(self.modulus, self._poly - other._poly)

    def __mul__(self, other: ModularPolynomial) -> ModularPolynomial:
        self._same(other)
        return ModularPolynomial(self.modulus, self._poly * other._poly)

    def __divmod__(self, other: ModularPolynomial) -> tuple[ModularPolynomial, ModularPolynomial]:
        self._same(other)
        if other.degree < 0:
            raise ZeroDivisionError("division by the zero polynomial")
        quotient, remainder = divmod(self._poly, other._poly)
        return (
            ModularPolynomial(self.modulus, quotient),
            ModularPolynomial(self.modulus, remainder),
        )

    def __floordiv__(self, other: ModularPolynomial) -> ModularPolynomial:
        return divmod(self, other)[0]

    def __mod__(self, other: ModularPolynomial) -> ModularPolynomial:
        return divmod(self, other)[1]

    def gcd(self, other: ModularPolynomial) -> ModularPolynomial:
        """The monic greatest common divisor; 0 only of two zeros."""
        self._same(other)
        return ModularPolynomial(self.modulus, self._poly.gcd(other._poly))

    def inverse_modulo(self, other: ModularPolynomial) -> ModularPolynomial | None:
        """The inverse modulo another polynomial; None if they have a common factor."""
        self._same(other)
        divisor, inverse, _ = self._poly.xgcd(other._poly)
        return ModularPolynomial(self.modulus, inverse) if divisor.degree() == 0 else None

    def divides(self, other: ModularPolynomial) -> bool:
        """Whether other is a multiple of this polynomial."""
        if self.degree < 0:
            return other.degree < 0
        return (other % self).degree < 0

    def multiplicity_in(self, other: ModularPolynomial) -> int:
        """The largest e with this polynomial, of degree ≥ 1, to the e dividing other, not 0."""
        if self.degree < 1 or other.degree < 0:
            raise InputError("expected a divisor of degree at least 1 and a nonzero polynomial")
        count = 0
        quotient, remainder = divmod(other, self)
        while remainder.degree < 0:
            count += 1
            quotient, remainder = divmod(quotient, self)
        return count

    def roots(self) -> list[int]:
        """The distinct roots in the field with ℓ elements, ascending."""
        if self.degree < 0:
            raise InputError("expected a nonzero polynomial: every residue is a root of 0")
        if self.degree == 0:
            return []
        return sorted(int(root) for root, _ in self._poly.roots())

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ModularPolynomial):
            return NotImplemented
        return self.modulus == other.modulus and self.coefficients == other.coefficients

    def __hash__(self) -> int:
        return hash((self.modulus, self.coefficients))

    def __reduce__(self) -> tuple[Any, ...]:
        return ModularPolynomial.from_coefficients, (self.coefficients, self.modulus)

    def __repr__(self) -> str:
        return f"ModularPolynomial({list(self.coefficients)}, modulus={self.modulus})"


def polynomial_residues(p: Polynomial, ell: int) -> ModularPolynomial:
    """A rational polynomial modulo a prime that divides no denominator of its coefficients."""
    return ModularPolynomial.from_coefficients([residue(c, ell) for c in p.coefficients], ell)
