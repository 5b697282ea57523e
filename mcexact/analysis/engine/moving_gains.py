"""Gains that move, modulo a prime, all that is not fixed for all values of a parameter."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mcexact.derived.modular import PolynomialSystem
from mcexact.exact import bivariate
from mcexact.exact.bivariate import Bivariate, difference, is_coprime_modulo, residues, without
from mcexact.exact.matrix import Matrix

_SHORT = 8
"""The degree of values outside the range up to which a common divisor there is computed."""


class MovingGains:
    """det(xI − A_G) for drawn G, and resultants of it and of ψ_1 with ψ_0, all modulo ℓ.

    ψ_0 and ψ_1 are what generic polynomials leave of det(xI − A_E) and det(xI − A_F).
    """

    def __init__(
        self,
        system: PolynomialSystem,
        psi: Bivariate,
        moved: Bivariate,
        gains: list[Matrix],
        ell: int,
    ) -> None:
        self.psi, self.moved, self.gains, self.ell = psi, moved, gains, ell
        self.loop = bivariate.characteristic_modulo(system.closed(gains), ell)
        left = bivariate.residues_in_x(psi, ell)
        right = bivariate.residues_in_x(moved, ell)
        self.first = bivariate.resultant_modulo(left, right, ell)
        self.other = bivariate.resultant_modulo(left, self.loop, ell)

    def is_complete(self, q: Any, known: Sequence[Bivariate]) -> bool:
        """Whether G moves what factors that are known leave of det(xI − A_E) at the roots of q."""
        left, bottom = bivariate.reduced(self.psi, q), residues(q, self.ell)
        for p in known:
            left = without(left, p, q)
        common = bivariate.resultant_modulo(
            bivariate.residues_in_x(left, self.ell),
            [c % bottom for c in self.loop],
            self.ell,
        )
        return is_coprime_modulo(q, common, self.ell)

    def is_nothing_else(self, values: Sequence[Any]) -> bool:
        """Whether all common roots of both resultants are among these values, modulo ℓ."""
        rest = self.first
        if rest.is_zero():
            return False
        for q in values:
            bottom = residues(q, self.ell)
            while (pair := divmod(rest, bottom))[1].is_zero():
                rest = pair[0]
        return bool(rest.gcd(self.other).degree() == 0)

    def is_needed(self, q: Any) -> bool:
        """Whether the second resultant vanishes at a root of q."""
        return not is_coprime_modulo(q, self.other, self.ell)

    def common(
        self, values: Sequence[Any], outside: Sequence[Any]
    ) -> list[tuple[Any, Bivariate]] | None:
        """Divisors of ψ_0 and ψ_1 at values that prove how often these divide the first resultant.

        None where they are not enough: a resultant can vanish more often than it has to, and its
        degree can be less than those of its factors allow.
        """
        if self.first.degree() < bivariate.resultant_degree_bound(
            self.psi, difference(self.moved, self.psi)
        ):
            return None
        found, rest = [], self.first
        for q in [*values, *outside]:
            bottom = residues(q, self.ell)
            if not self.is_needed(q) or not divmod(rest, bottom)[1].is_zero():
                continue
            if q in outside and q.degree() > _SHORT:
                return None
            first, second = (bivariate.reduced(f, q) for f in (self.psi, self.moved))
            found.append((q, bivariate.gcd(first, second, q)))
            for _ in found[-1][1][1:]:
                rest = divmod(rest, bottom)[0]
        return found if rest.gcd(self.other).degree() == 0 else None
