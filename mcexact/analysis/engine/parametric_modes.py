"""The fixed modes of a system with a parameter, for all values of the parameter."""

from __future__ import annotations

import functools
import math
import random
from dataclasses import dataclass
from typing import Any

from mcexact.analysis.engine.moving_gains import MovingGains
from mcexact.analysis.engine.zero_blocks import (
    generic_zero_block,
    responsible_channels,
    zero_block,
)
from mcexact.answer.evidence import RootDisc, ZeroBlock
from mcexact.answer.parameter_values import (
    OutsideValue,
    meets,
)
from mcexact.answer.parametric_fixed_spectrum import (
    CommonDivisor,
    ExceptionalEvidence,
    ExceptionalMode,
    ExceptionalValue,
    MovedModes,
    ParametricFixedSpectrum,
    SettledValue,
)
from mcexact.derived.modular import PolynomialSystem, generator
from mcexact.errors import InternalError
from mcexact.exact import bivariate
from mcexact.exact.bivariate import Bivariate, characteristic, line, polynomials, without
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import long_prime, primes
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import root_discs
from mcexact.model.parametric import ParametricSystem

_DRAWS = 60
_TRIES = 2
"""Draws of gains without an exact resultant, which takes most of the work where it is needed."""
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
    Exact, for every complex value at which all entries of the plant are defined.  The greatest
    common divisor of det(xI − A_F) for some gains F, as polynomials in x and t, has the generic
    fixed modes as roots; the values at which others can be fixed are common roots of resultants,
    and each of them is decided over its number field.  Values without a real one in the range that
    is assumed are left out.

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


_Mode = tuple[Bivariate, tuple[int, ...], ZeroBlock]


@dataclass
class _Candidate:
    """A value q, what is fixed there besides generic modes, and divisors of generic ones."""

    q: Any
    modes: list[_Mode]
    divisors: list[Bivariate]


class _Search:
    """Draws gains until what they leave is what is fixed."""

    def __init__(self, system: PolynomialSystem, rng: random.Random) -> None:
        self.system, self.rng = system, rng
        self.generic: list[tuple[Bivariate, ZeroBlock]] = []
        self.psi: list[Bivariate] = []
        self.gains: list[list[Matrix]] = []
        self.modes: dict[Polynomial, list[_Mode]] = {}

    def found(self) -> ParametricFixedSpectrum:
        """The answer."""
        for attempt in range(_DRAWS):
            if self._draw(1 + attempt):
                found = self._answer(exactly=attempt >= _TRIES)
                if found is not None:
                    return found
        raise InternalError("no drawn gains leave the fixed modes alone")

    def _answer(self, *, exactly: bool) -> ParametricFixedSpectrum | None:
        """The answer; without an exact resultant there may be none for these gains."""
        values = self._values()
        undefined = [q for q in values if q in self.system.poles]
        rest = [q for q in values if q not in self.system.poles]
        outside = [] if not self._has_range else [q for q in rest if not self._in_range(q)]
        decided = [self._decided(q) for q in rest if q not in outside]
        moved = self._moved(decided, [*undefined, *outside])
        exceptional = [each for each in decided if each.modes]
        # Small gains can agree at a value where nothing happens: it needs no entry.
        needed = [each for each in decided if not each.modes and moved.is_needed(each.q)]
        named = [each.q for each in [*exceptional, *needed]] + [q._rational for q in undefined]
        common = moved.common(named, [q._rational for q in outside])
        if common is None and not exactly:
            return None
        evidence = MovedModes(
            gains=(tuple(self.gains[0]), tuple(self.gains[1]), tuple(moved.gains)),
            modulus=moved.ell,
            moduli=self._moduli() if common is None else (),
            common=tuple(CommonDivisor(_polynomial(q), polynomials(h)) for q, h in common or ()),
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
            self.system.drawn_gains(lambda: self.rng.randint(-size, size)) for _ in range(3)
        ]
        loops = [characteristic(self.system.closed(F)) for F in self.gains]
        self.generic = []
        for p in bivariate.common_factors(loops):
            t = self.rng.randrange(10**3, 10**6)
            block = self._generic_block(p, t)
            if block is None:
                return False
            self.generic.append((p, block))
        self.psi = loops
        for p, _ in self.generic:
            self.psi = [without(psi, p) for psi in self.psi]
        return all(bivariate.are_coprime(self.psi[0], psi) for psi in self.psi[1:])

    def _generic_block(self, p: Bivariate, t: int) -> ZeroBlock | None:
        """A zero block for the roots of p, if they are fixed at a drawn value of t."""
        at_t = line(t)
        factor = bivariate.factors(bivariate.reduced(p, at_t), at_t)[-1]
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
        common = bivariate.reduced(self.psi[0], q)
        for psi in self.psi[1:]:
            common = bivariate.gcd(common, bivariate.reduced(psi, q), q)
        known = [bivariate.reduced(g, q) for g, _ in self.generic]
        if value not in self.modes:
            new = [
                p
                for p in bivariate.factors(common, q)
                if all(bivariate.divided(g, p, q)[1] for g in known)
            ]
            self.modes[value] = [found for p in new if (found := self._mode(q, p)) is not None]
        return _Candidate(q, self.modes[value], self._shared(q, known))

    def _mode(self, q: Any, p: Bivariate) -> _Mode | None:
        """A mode at the roots of q with its evidence, if it is fixed."""
        T = responsible_channels(self.system, q, p, self.rng)
        if T is None:
            return None
        block = zero_block(self.system, T, q, p)
        if block is None:
            raise InternalError("a mode that is fixed modulo a prime is not fixed")
        return p, T, block

    def _values(self) -> list[Polynomial]:
        """Candidates: the irreducible factors that two resultants have in common."""
        stream = primes(self.rng.getrandbits(64), _BITS)
        # det(xI − A_G) keeps its generic factors, so the second resultant has their roots as well
        second = functools.reduce(bivariate.product, (p for p, _ in self.generic), self.psi[2])
        known = [c for f in (*self.psi, second) for c in f]
        usable = (ell for ell in stream if self._is_defined(known, ell))
        common = bivariate.common_divisor(self.psi[0], self.psi[1], second, usable)
        found = {q for q, _ in _polynomial(common).factor()}
        return sorted(found, key=lambda q: (q.degree, q.coefficients))

    def _is_defined(self, known: list[Any], ell: int) -> bool:
        """Whether a prime divides no denominator."""
        denominators = bivariate.denominators(known)
        return self.system.is_defined_modulo(ell) and all(d % ell for d in denominators)

    def _shared(self, q: Any, known: list[Bivariate]) -> list[Bivariate]:
        """Divisors of generic polynomials that divide what is left of det(xI − A_E)."""
        left, found = bivariate.reduced(self.psi[0], q), []
        for p in known:
            while len(g := bivariate.gcd(left, p, q)) > 1:
                found.append(g)
                left = without(left, g, q)
        return found

    def _moved(self, decided: list[_Candidate], others: list[Polynomial]) -> MovingGains:
        """A prime ℓ, and gains that move all that is not fixed, modulo it."""
        stream = primes(self.rng.getrandbits(64), _BITS)
        values = [*(each.q for each in decided), *(q._rational for q in others)]
        known = [c for psi in self.psi for c in psi] + values
        for _ in range(_DRAWS):
            ell = next(stream)
            if not self._is_defined(known, ell):
                continue
            gains = self.system.drawn_gains(lambda ell=ell: self.rng.randrange(ell))
            moved = MovingGains(self.system, self.psi[0], self.psi[1], gains, ell)
            if all(
                moved.is_complete(each.q, [*(mode for mode, _, _ in each.modes), *each.divisors])
                for each in decided
            ) and moved.is_nothing_else(values):
                return moved
        raise InternalError("no drawn gains move all that is not fixed")

    def _moduli(self) -> tuple[int, ...]:
        """Primes whose product is above twice the coefficients of the first resultant."""
        first, second = self.psi[0], self.psi[1]
        sizes = bivariate.size(first), bivariate.size(second)
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


def _discs(q: Polynomial) -> tuple[RootDisc, ...]:
    return tuple(RootDisc(disc.re, disc.im, disc.radius) for disc in root_discs(q))
