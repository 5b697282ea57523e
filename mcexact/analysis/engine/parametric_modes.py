"""The fixed modes of a system with a parameter, for all values of the parameter."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from mcexact.analysis.engine.zero_blocks import (
    generic_zero_block,
    responsible_channels,
    zero_block,
)
from mcexact.answer.evidence import RootDisc, ZeroBlock
from mcexact.answer.parametric_fixed_spectrum import (
    ExceptionalEvidence,
    ExceptionalMode,
    ExceptionalValue,
    MovedModes,
    OutsideValue,
    ParametricFixedSpectrum,
    SettledValue,
    meets,
)
from mcexact.derived.modular_system import generator
from mcexact.derived.polynomial_system import PolynomialSystem
from mcexact.errors import InternalError
from mcexact.exact import parameter_field, two_variables
from mcexact.exact.enclosures import root_discs
from mcexact.exact.function_kernels import line
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import primes
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.prime_field import long_prime
from mcexact.exact.two_variables import Bivariate, characteristic, polynomials, without
from mcexact.model.parametric import ParametricSystem

_DRAWS = 60
_BITS = 61
_LONG_BITS = 300
"""The bits of the moduli of the exact resultant."""


def parametric_fixed_spectrum(system: ParametricSystem) -> ParametricFixedSpectrum:
    """Decide which modes are fixed for all values of a parameter, and at which values others are.

    Parameters
    ----------
    system : ParametricSystem
        With one parameter; `ParametricSystem.along` makes one from several.

    Raises
    ------
    UsageError
        If there are several parameters.

    Notes
    -----
    Exact, for every complex value at which all entries are defined.  The greatest common divisor of
    det(xI − A_F) for some gains F, as polynomials in x and t, has the generic fixed modes as roots;
    the values at which others can be fixed are common roots of resultants, and each of them is
    decided over its number field.  Values without a real one in the range that is assumed are left
    out.

    Examples
    --------
    >>> from mcexact import ParametricSystem
    >>> plant = ParametricSystem(
    ...     [["t", 1], [0, 2]], [[[1], ["t^2 - 2"]]], [[[1, 0]]], parameters=["t"]
    ... )
    >>> found = parametric_fixed_spectrum(plant)
    >>> found.generic
    ()
    >>> print(*found.words, sep="\\n")
    the roots of x - t (no channel controls it) where t^2 + t - 4 = 0 (t about -2.56155, 1.56155)
    the roots of x - 2 (no channel controls it) where t^2 - 2 = 0 (t about -1.41421, 1.41421)
    """
    return _Search(PolynomialSystem(system), generator(system, "parametric_fixed_spectrum")).found()


@dataclass
class _Candidate:
    """A value q, what is fixed there besides generic modes, and divisors of generic ones."""

    q: Any
    modes: list[tuple[Bivariate, tuple[int, ...], ZeroBlock]]
    divisors: list[Bivariate]


class _Search:
    """Draws gains until what they leave is what is fixed."""

    def __init__(self, system: PolynomialSystem, rng: random.Random) -> None:
        self.system, self.rng = system, rng
        self.chi = characteristic(system.A)
        self.generic: list[tuple[Bivariate, ZeroBlock]] = []
        self.psi: list[Bivariate] = []
        self.gains: list[list[Matrix]] = []

    def found(self) -> ParametricFixedSpectrum:
        """The answer."""
        for attempt in range(_DRAWS):
            if self._draw(1 + attempt):
                break
        else:
            raise InternalError("no drawn gains leave the fixed modes alone")
        first = two_variables.resultant(self.psi[0], self.psi[1])
        # det(xI − A_G) keeps its generic factors, so the second resultant has their roots as well
        others = [self.psi[2], *(p for p, _ in self.generic)]
        values = self._common_factors(first, others)
        undefined = [q for q in values if q in self.system.poles]
        rest = [q for q in values if q not in self.system.poles]
        outside = [] if not self._has_range else [q for q in rest if not self._in_range(q)]
        decided = [self._decided(q) for q in rest if q not in outside]
        modulus, moving = self._moving(first, decided, [*outside, *undefined])
        exceptional = [each for each in decided if each.modes]
        # Small gains can agree at a value where nothing happens: it needs no entry.
        needed = [each for each in decided if not each.modes and self._is_needed(each, modulus)]
        evidence = MovedModes(
            gains=(tuple(self.gains[0]), tuple(moving)),
            modulus=modulus,
            moduli=self._moduli(),
            generic=tuple(block for _, block in self.generic),
            exceptional=tuple(
                ExceptionalEvidence(
                    modes=tuple(block for _, _, block in each.modes),
                    divisors=tuple(map(polynomials, each.divisors)),
                )
                for each in exceptional
            ),
            settled=tuple(
                SettledValue(_polynomial(each.q), tuple(map(polynomials, each.divisors)))
                for each in needed
            ),
            undefined=tuple(undefined),
        )
        return ParametricFixedSpectrum(
            self.system.system,
            generic=tuple(polynomials(p) for p, _ in self.generic),
            exceptional=tuple(map(self._exceptional, exceptional)),
            outside=tuple(OutsideValue(q, _discs(q)) for q in outside),
            evidence=evidence,
        )

    def _draw(self, size: int) -> bool:
        """Draw gains of this size, and whether what they leave in common is generically fixed."""
        self.gains = [
            self.system.drawn_gains(lambda: self.rng.randint(-size, size)) for _ in range(2)
        ]
        loops = [characteristic(self.system.closed(F)) for F in self.gains]
        self.generic = []
        for p in two_variables.common_factors([self.chi, *loops]):
            t = self.rng.randrange(10**3, 10**6)
            block = self._generic_block(p, t)
            if block is None:
                return False
            self.generic.append((p, block))
        self.psi = [self.chi, *loops]
        for p, _ in self.generic:
            self.psi = [without(psi, p) for psi in self.psi]
        return all(two_variables.are_coprime(self.psi[0], psi) for psi in self.psi[1:])

    def _generic_block(self, p: Bivariate, t: int) -> ZeroBlock | None:
        """A zero block for the roots of p, if they are fixed at a drawn value of t."""
        at_t = line(t)
        factor = parameter_field.factors(parameter_field.reduced(p, at_t), at_t)[-1]
        T = responsible_channels(self.system, at_t, factor, self.rng)
        return None if T is None else generic_zero_block(self.system, T, p)

    @property
    def _has_range(self) -> bool:
        return self.system.system.ranges[0] != (None, None)

    def _in_range(self, q: Polynomial) -> bool:
        bounds = self.system.system.ranges[0]
        return any(meets(disc, bounds) for disc in _discs(q))

    def _decided(self, value: Polynomial) -> _Candidate:
        """What is fixed at the roots of an irreducible polynomial."""
        q = value._rational
        common = parameter_field.reduced(self.psi[0], q)
        for psi in self.psi[1:]:
            common = parameter_field.gcd(common, parameter_field.reduced(psi, q), q)
        known = [parameter_field.reduced(g, q) for g, _ in self.generic]
        found = _Candidate(q, [], self._shared(q, known))
        for p in parameter_field.factors(common, q):
            if any(not two_variables.divided(g, p, q)[1] for g in known):
                continue
            T = responsible_channels(self.system, q, p, self.rng)
            if T is not None:
                block = zero_block(self.system, T, q, p)
                if block is None:
                    raise InternalError("a mode that is fixed modulo a prime is not fixed")
                found.modes.append((p, T, block))
        return found

    def _common_factors(self, first: Any, others: Sequence[Bivariate]) -> list[Polynomial]:
        """The irreducible factors that a resultant has in common with another one."""
        found = {
            q
            for f in others
            for q, _ in _factors(first.gcd(two_variables.resultant(self.psi[0], f)))
        }
        return sorted(found, key=lambda q: (q.degree, q.coefficients))

    def _shared(self, q: Any, known: list[Bivariate]) -> list[Bivariate]:
        """Divisors of generic polynomials that divide what is left of det(xI − A)."""
        left, found = parameter_field.reduced(self.psi[0], q), []
        for p in known:
            while len(g := parameter_field.gcd(left, p, q)) > 1:
                found.append(g)
                left = without(left, g, q)
        return found

    def _moving(
        self, first: Any, decided: list[_Candidate], others: list[Polynomial]
    ) -> tuple[int, list[Matrix]]:
        """A prime ℓ, and gains that move all that is not fixed, modulo it."""
        stream = primes(self.rng.getrandbits(64), _BITS)
        known = [c for psi in self.psi for c in psi] + [each.q for each in decided]
        for _ in range(_DRAWS):
            ell = next(stream)
            if not self.system.is_defined_modulo(ell) or any(
                d % ell == 0 for d in two_variables.denominators(known)
            ):
                continue
            gains = self.system.drawn_gains(lambda ell=ell: self.rng.randrange(ell))
            self.loop = characteristic(self.system.closed(gains))
            if all(self._is_complete(each, ell) for each in decided) and self._no_other(
                first, decided, others, ell
            ):
                return ell, gains
        raise InternalError("no drawn gains move all that is not fixed")

    def _is_complete(self, each: _Candidate, ell: int) -> bool:
        """Whether gains move what is left of det(xI − A) at the roots of q."""
        left = parameter_field.reduced(self.psi[0], each.q)
        for p in [*(mode for mode, _, _ in each.modes), *each.divisors]:
            left = without(left, p, each.q)
        common = two_variables.resultant_modulo(left, self.loop, ell)
        return two_variables.is_coprime_modulo(each.q, common, ell)

    def _no_other(
        self, first: Any, decided: list[_Candidate], others: list[Polynomial], ell: int
    ) -> bool:
        """Whether all common roots of both resultants are named."""
        named = [*(each.q for each in decided), *(q._rational for q in others)]
        self.other = two_variables.resultant_modulo(self.psi[0], self.loop, ell)
        return two_variables.is_coprime_modulo(two_variables.freed(first, named), self.other, ell)

    def _is_needed(self, each: _Candidate, ell: int) -> bool:
        """Whether a settled value is a root of the second resultant as well."""
        return not two_variables.is_coprime_modulo(each.q, self.other, ell)

    def _moduli(self) -> tuple[int, ...]:
        """Primes whose product is above twice the coefficients of the first resultant."""
        first, second = self.psi[0], self.psi[1]
        sizes = two_variables.size(first), two_variables.size(second)
        least = 2 * sizes[0] ** (len(second) - 1) * sizes[1] ** (len(first) - 1)
        found: list[int] = []
        while math.prod(found) <= least:
            found.append(long_prime(self.rng, _LONG_BITS))
        return tuple(found)

    def _exceptional(self, each: _Candidate) -> ExceptionalValue:
        q, names = _polynomial(each.q), self.system.system.names
        return ExceptionalValue(
            value=q,
            roots=_discs(q),
            modes=tuple(
                ExceptionalMode(
                    polynomials(p), tuple(n for i, n in enumerate(names) if i not in set(T))
                )
                for p, T, _ in each.modes
            ),
        )


def _polynomial(q: Any) -> Polynomial:
    return polynomials([q])[0]


def _factors(p: Any) -> list[tuple[Polynomial, int]]:
    return _polynomial(p).factor()


def _discs(q: Polynomial) -> tuple[RootDisc, ...]:
    return tuple(RootDisc(disc.re, disc.im, disc.radius) for disc in root_discs(q))
