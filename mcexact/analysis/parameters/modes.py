"""Fixed modes for all values of one parameter, and what follows from them.

For a plant whose entries are rational functions of t, the answer has the modes that are fixed for
almost every value, as factors of polynomials in x and t, and the exceptional values at which
further modes are fixed.  It is exact, for every complex value at which all entries are defined.

- `parametric_fixed_spectrum` decides it.  Drawn gains F move all modes that are not fixed, so the
  greatest common divisor of several det(xI − A_F) has the generic fixed modes as roots.  Other
  modes can be fixed only at common roots of resultants of what is left; each irreducible candidate
  q(t) is decided over its number field.
- `parametric_controllability` decides it of the system that measures its whole state, whose fixed
  modes are the uncontrollable ones; observability is that of the dual system.
- `shared_dimensions_for_every_value` tries all dimensions of shared sub-states, sum after sum.

Two kinds of evidence prove an answer.  That a mode is fixed is proved by a zero block: a set T of
channels and matrices W, U over R = Q[t]/(q)[x]/(p), or Q[t][x]/(p), with

    W (xI − A) U = 0,   W B_T = 0,   C_i U = 0 for every i outside T

and more than n rows of W and columns of U together, independent, prove that p divides det(xI − A_F)
over R for every F: λI − A_F has a zero block that is too large.  That nothing else is fixed is
proved by gains modulo a prime that move all the rest (`MovingGains`).
"""

from __future__ import annotations

import functools
import math
import operator
import random
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

from mcexact.analysis.subspaces import obstruction_modulo
from mcexact.answer.evidence import RootDisc, ZeroBlock
from mcexact.answer.parameters import (
    CommonDivisor,
    ExceptionalEvidence,
    ExceptionalMode,
    ExceptionalValue,
    MovedModes,
    OutsideValue,
    ParametricFixedSpectrum,
    SettledValue,
    meets,
)
from mcexact.derived.constructions import (
    Share,
    dual,
    extended_system,
    full_output,
    merged,
    rearranged,
    restricted,
)
from mcexact.derived.modular import PolynomialSystem, drawn_gains, generator
from mcexact.errors import InternalError, LimitReached
from mcexact.exact.bivariate import Residues, characteristic_modulo
from mcexact.exact.linear_algebra import PolynomialMatrix, stacked
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import ModularPolynomial, long_prime, polynomial_residues, primes
from mcexact.exact.parametric_polynomials import (
    Basis,
    ParametricPolynomial,
    characteristic,
    common_divisor,
    common_factors,
    generic_nullspace,
    nullspace_over_field,
    reduced_residues,
    resultant_degree_bound,
    resultant_modulo,
)
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import root_discs
from mcexact.model.graph import NeighborGraph
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem

# Gains modulo a prime, which prove that no other mode is fixed and no other value exceptional.

_SHORT = 8
"""The degree of values outside the range up to which a common divisor there is computed."""


class MovingGains:
    """det(xI − A_G) for drawn G, and resultants of it and of ψ_1 with ψ_0, all modulo ℓ.

    ψ_0 and ψ_1 are det(xI − A_E) and det(xI − A_F) without the factors that are generically fixed.
    """

    def __init__(
        self,
        system: PolynomialSystem,
        psi: ParametricPolynomial,
        psi_1: ParametricPolynomial,
        gains: list[Matrix],
        ell: int,
    ) -> None:
        self.psi, self.psi_1, self.gains, self.ell = psi, psi_1, gains, ell
        self.loop: Residues = characteristic_modulo(system.closed(gains), ell)
        left = psi.residues(ell)
        self.first = resultant_modulo(left, psi_1.residues(ell), ell)
        self.other = resultant_modulo(left, self.loop, ell)

    def is_complete(self, q: Polynomial, fixed: Sequence[ParametricPolynomial]) -> bool:
        """Whether, at the roots of q, G moves all roots of ψ_0 but those of fixed factors."""
        left = functools.reduce(ParametricPolynomial.without, fixed, self.psi.modulo(q))
        loop = reduced_residues(self.loop, q, self.ell)
        return self._is_coprime(q, resultant_modulo(left.residues(self.ell), loop, self.ell))

    def _is_coprime(self, q: Polynomial, resultant: ModularPolynomial) -> bool:
        return polynomial_residues(q, self.ell).gcd(resultant).degree == 0

    def is_nothing_else(self, values: Sequence[Polynomial]) -> bool:
        """Whether modulo ℓ both resultants have common roots only among these values."""
        rest = self.first
        if rest.degree < 0:
            return False
        for q in values:
            divisor = polynomial_residues(q, self.ell)
            while divisor.divides(rest):
                rest //= divisor
        return rest.gcd(self.other).degree == 0

    def is_needed(self, q: Polynomial) -> bool:
        """Whether the second resultant vanishes at a root of q."""
        return not self._is_coprime(q, self.other)

    def common(
        self, values: Sequence[Polynomial], outside: Sequence[Polynomial]
    ) -> list[tuple[Polynomial, ParametricPolynomial]] | None:
        """Divisors of ψ_0 and ψ_1 at values that prove how often these divide the first resultant.

        None where they are not enough: a resultant can vanish more often than it has to, and its
        degree can be less than those of its factors allow.
        """
        if self.first.degree < resultant_degree_bound(self.psi, self.psi_1):
            return None
        divisors, rest = [], self.first
        for q in [*values, *outside]:
            divisor = polynomial_residues(q, self.ell)
            if not self.is_needed(q) or not divisor.divides(rest):
                continue
            if q in outside and q.degree > _SHORT:
                return None
            divisors.append((q, self.psi.modulo(q).gcd(self.psi_1.modulo(q))))
            for _ in range(divisors[-1][1].degree):
                rest //= divisor
        return divisors if rest.gcd(self.other).degree == 0 else None


# Zero blocks, which prove that a mode is fixed.

_BLOCK_BITS = 60
_BLOCK_TRIES = 2000


def responsible_channels(
    system: PolynomialSystem, q: Polynomial, p: ParametricPolynomial, rng: random.Random
) -> tuple[int, ...] | None:
    """T for the roots of p at the roots of q, or None if these are not fixed.

    None is proved, since gains that move a root modulo a prime also move it over the numbers.
    """
    stream = primes(rng.getrandbits(64), _BLOCK_BITS)
    for _ in range(_BLOCK_TRIES):
        ell = next(stream)
        if not system.is_defined_modulo(ell) or q.denominator * p.denominator % ell == 0:
            continue
        for tau, mu in p.roots_modulo(q, ell):
            modular = system.modulo(tau, ell)
            obstruction = obstruction_modulo(modular, drawn_gains(modular, rng), mu)
            return None if obstruction is None else obstruction.channels_T
    raise InternalError("no prime has roots of both polynomials")


def zero_block(
    system: PolynomialSystem, T: Sequence[int], q: Polynomial, p: ParametricPolynomial
) -> ZeroBlock | None:
    """The zero block for T over Q[t]/(q)[x]/(p), or None if T proves nothing there."""
    return _block(system, T, p, functools.partial(nullspace_over_field, q=q))


def generic_zero_block(
    system: PolynomialSystem, T: Sequence[int], p: ParametricPolynomial
) -> ZeroBlock | None:
    """The zero block for T over Q[t][x]/(p), or None if T proves nothing there."""
    return _block(system, T, p, generic_nullspace)


def _block(
    system: PolynomialSystem,
    T: Sequence[int],
    p: ParametricPolynomial,
    null_space: Callable[..., Basis],
) -> ZeroBlock | None:
    """W' spans the null space of B_T', and U that of [W (xI − A); C_s] at the roots of p."""
    n = system.n
    inputs = stacked([system.B[i].T for i in T], n)
    outputs = stacked([system.C[i] for i in range(system.m) if i not in set(T)], n)
    columns, (W,) = null_space([inputs])
    W = W.T
    below = PolynomialMatrix.from_matrices(Matrix.zeros(*outputs.shape))
    rows, U = null_space([stacked([-(W @ system.A), outputs], n), stacked([W, below], n)], p=p)
    if len(rows) + len(columns) <= n:
        return None
    names = tuple(system.system.names[i] for i in T)
    return ZeroBlock(channels_T=names, U=U, W=W, row_pivots=rows, column_pivots=columns)


# The fixed spectrum for all values of a parameter.

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
    and each of them is decided over its number field.  If a range of the parameter is assumed, only
    polynomials with a real root in it count.

    Examples
    --------
    >>> from mcexact import ParametricSystem
    >>> plant = ParametricSystem(
    ...     [["t", 1], [0, 2]], [[[1], ["t^2 - 2"]]], [[[1, 0]]], parameters=["t"]
    ... )
    >>> answer = parametric_fixed_spectrum(plant)
    >>> answer.generic
    ()
    >>> print(*answer.words, sep="\\n")
    the roots of x - t (no channel controls it) where t^2 + t - 4 = 0 (t about -2.56155, 1.56155)
    the roots of x - 2 (no channel controls it) where t^2 - 2 = 0 (t about -1.41421, 1.41421)
    """
    return _Search(
        PolynomialSystem(system), generator(system, "parametric_fixed_spectrum")
    ).answer()


_Mode = tuple[ParametricPolynomial, tuple[int, ...], ZeroBlock]


@dataclass
class _Candidate:
    """A value q, the further modes that are fixed there, and divisors of generic factors there."""

    q: Polynomial
    modes: list[_Mode]
    divisors: list[ParametricPolynomial]


class _Search:
    """Draws gains until the modes that they do not move are the fixed ones."""

    def __init__(self, system: PolynomialSystem, rng: random.Random) -> None:
        self.system, self.rng = system, rng
        self.generic: list[tuple[ParametricPolynomial, ZeroBlock]] = []
        self.psi: list[ParametricPolynomial] = []
        self.gains: list[list[Matrix]] = []
        self.modes: dict[Polynomial, list[_Mode]] = {}

    def answer(self) -> ParametricFixedSpectrum:
        """The answer."""
        for attempt in range(_DRAWS):
            if self._draw(1 + attempt):
                answer = self._answer(exactly=attempt >= _TRIES)
                if answer is not None:
                    return answer
        raise InternalError("no drawn gains leave the fixed modes alone")

    def _answer(self, *, exactly: bool) -> ParametricFixedSpectrum | None:
        """The answer; without an exact resultant there may be none for these gains."""
        candidates = self._values()
        undefined = [q for q in candidates if q in self.system.poles]
        rest = [q for q in candidates if q not in self.system.poles]
        outside = [] if not self._has_range else [q for q in rest if not self._in_range(q)]
        decided = [self._decided(q) for q in rest if q not in outside]
        moving = self._moving_gains(decided, [*undefined, *outside])
        exceptional = [each for each in decided if each.modes]
        # Small gains can agree at a value where nothing happens: it needs no entry.
        needed = [each for each in decided if not each.modes and moving.is_needed(each.q)]
        values = [*(each.q for each in [*exceptional, *needed]), *undefined]
        common = moving.common(values, outside)
        if common is None and not exactly:
            return None
        evidence = MovedModes(
            gains=(tuple(self.gains[0]), tuple(self.gains[1]), tuple(moving.gains)),
            modulus=moving.ell,
            moduli=self._moduli() if common is None else (),
            common=tuple(CommonDivisor(q, h.polynomials()) for q, h in common or ()),
            generic=tuple(block for _, block in self.generic),
            exceptional=tuple(
                ExceptionalEvidence(
                    modes=tuple(block for _, _, block in each.modes),
                    divisors=_coefficients(each.divisors),
                )
                for each in exceptional
            ),
            settled=tuple(SettledValue(each.q, _coefficients(each.divisors)) for each in needed),
            undefined=tuple(undefined),
        )
        return ParametricFixedSpectrum(
            self.system.system,
            generic=_coefficients(p for p, _ in self.generic),
            exceptional=tuple(map(self._exceptional, exceptional)),
            outside=tuple(OutsideValue(q, _discs(q)) for q in outside),
            evidence=evidence,
        )

    def _draw(self, size: int) -> bool:
        """Draw gains of this size; whether all modes that they leave are generically fixed."""
        self.gains = [
            self.system.drawn_gains(lambda: self.rng.randint(-size, size)) for _ in range(3)
        ]
        names = self.system.system.parameters
        loops = [characteristic(self.system.closed(F), names) for F in self.gains]
        self.generic = []
        for p in common_factors(loops):
            t = self.rng.randrange(10**3, 10**6)
            block = self._generic_block(p, t)
            if block is None:
                return False
            self.generic.append((p, block))
        self.psi = loops
        for p, _ in self.generic:
            self.psi = [psi.without(p) for psi in self.psi]
        return all(self.psi[0].is_coprime(psi) for psi in self.psi[1:])

    def _generic_block(self, p: ParametricPolynomial, t: int) -> ZeroBlock | None:
        """A zero block for the roots of p, if they are fixed at a drawn value of t."""
        at_t = Polynomial.of(-t, 1)
        T = responsible_channels(self.system, at_t, p.modulo(at_t).factors()[-1], self.rng)
        return None if T is None else generic_zero_block(self.system, T, p)

    @property
    def _has_range(self) -> bool:
        return self.system.system.ranges[0] != (None, None)

    def _in_range(self, q: Polynomial) -> bool:
        bounds = self.system.system.ranges[0]
        return any(meets(disc, bounds) for disc in _discs(q))

    def _decided(self, q: Polynomial) -> _Candidate:
        """What is fixed at the roots of an irreducible polynomial."""
        common = functools.reduce(ParametricPolynomial.gcd, [psi.modulo(q) for psi in self.psi])
        generic = [p.modulo(q) for p, _ in self.generic]
        if q not in self.modes:
            new = [p for p in common.factors() if not any(p.divides(g) for g in generic)]
            self.modes[q] = [mode for p in new if (mode := self._mode(q, p)) is not None]
        return _Candidate(q, self.modes[q], self._shared(q, generic))

    def _mode(self, q: Polynomial, p: ParametricPolynomial) -> _Mode | None:
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
        second = functools.reduce(operator.mul, (p for p, _ in self.generic), self.psi[2])
        usable = (ell for ell in stream if self._is_defined([*self.psi, second], ell))
        common = common_divisor(self.psi[0], self.psi[1], second, usable)
        return [q for q, _ in common.factor()]

    def _is_defined(
        self, polynomials: Iterable[ParametricPolynomial | Polynomial], ell: int
    ) -> bool:
        """Whether a prime divides no denominator."""
        return self.system.is_defined_modulo(ell) and all(p.denominator % ell for p in polynomials)

    def _shared(
        self, q: Polynomial, generic: list[ParametricPolynomial]
    ) -> list[ParametricPolynomial]:
        """Divisors of generic factors that also divide ψ_0 at the roots of q."""
        left, divisors = self.psi[0].modulo(q), []
        for p in generic:
            while (g := left.gcd(p)).degree:
                divisors.append(g)
                left = left.without(g)
        return divisors

    def _moving_gains(self, decided: list[_Candidate], others: list[Polynomial]) -> MovingGains:
        """A prime ℓ, and gains that move, modulo ℓ, all modes that are not fixed."""
        stream = primes(self.rng.getrandbits(64), _BITS)
        values = [*(each.q for each in decided), *others]
        for _ in range(_DRAWS):
            ell = next(stream)
            if not self._is_defined([*self.psi, *values], ell):
                continue
            gains = self.system.drawn_gains(lambda ell=ell: self.rng.randrange(ell))
            moving = MovingGains(self.system, self.psi[0], self.psi[1], gains, ell)
            if all(
                moving.is_complete(each.q, [*(mode for mode, _, _ in each.modes), *each.divisors])
                for each in decided
            ) and moving.is_nothing_else(values):
                return moving
        raise InternalError("no drawn gains move all that is not fixed")

    def _moduli(self) -> tuple[int, ...]:
        """Primes whose product is above twice the coefficients of the first resultant."""
        first, second = self.psi[0], self.psi[1]
        least = 2 * first.size() ** second.degree * second.size() ** first.degree
        moduli: list[int] = []
        while math.prod(moduli) <= least:
            moduli.append(long_prime(self.rng, _LONG_BITS))
        return tuple(moduli)

    def _exceptional(self, each: _Candidate) -> ExceptionalValue:
        names = self.system.system.names
        return ExceptionalValue(
            value=each.q,
            roots=_discs(each.q),
            modes=tuple(
                ExceptionalMode(
                    p.polynomials(), tuple(n for i, n in enumerate(names) if i not in set(T))
                )
                for p, T, _ in each.modes
            ),
        )


def _coefficients(
    polynomials: Iterable[ParametricPolynomial],
) -> tuple[tuple[Polynomial, ...], ...]:
    return tuple(p.polynomials() for p in polynomials)


def _discs(q: Polynomial) -> tuple[RootDisc, ...]:
    return tuple(RootDisc(disc.re, disc.im, disc.radius) for disc in root_discs(q))


# Controllability and observability for all values of a parameter.


def parametric_controllability(
    system: ParametricSystem, channels: Iterable[str] | None = None, observed: bool = False
) -> ParametricFixedSpectrum:
    """Decide for which values of a parameter (A, B_T) is controllable.

    Parameters
    ----------
    system : ParametricSystem
    channels : iterable of str, optional
        T, names of channels, at least one; by default all.
    observed : bool
        Whether to ask for observability of (C_T, A), which is controllability of the dual system.

    Returns
    -------
    ParametricFixedSpectrum
        The answer about the system whose one channel has the inputs of T and measures the whole
        state: its fixed modes are the modes that T does not control.

    Examples
    --------
    >>> plant = ParametricSystem([[1, "t"], [0, 2]], [[[0], [1]]], [[[1, 0]]], parameters=["t"])
    >>> print(*parametric_controllability(plant).words)
    the roots of x - 1 where t = 0
    """
    chosen = system.names if channels is None else system.named(system.indices(channels))

    def alone(plain: MultiChannelSystem) -> MultiChannelSystem:
        subject = dual(plain) if observed else plain
        if set(chosen) != set(subject.names):
            subject = restricted(subject, chosen)
        if subject.m > 1:
            subject = merged(subject, [subject.names])
        return full_output(subject, 0)

    return parametric_fixed_spectrum(rearranged(system, alone))


# Dimensions of shared sub-states for every value of a parameter.

_MOST = 10_000
"""The most dimensions that are tried with one sum."""


@dataclass(frozen=True)
class ParametricSharing:
    """The least dimensions of shared sub-states with which no mode is fixed for any value.

    Attributes
    ----------
    dimensions : tuple of int or None
        n_1 … n_m with the least sum, the lexicographically least of these; None if none suffice.
    spectrum : ParametricFixedSpectrum
        The answer about the extended system with these dimensions, or if none suffice with n for
        each agent.
    refused : tuple of ParametricFixedSpectrum
        The answers for all dimensions whose sum is one less, with each of which a mode is fixed for
        almost every value or at some.  With fewer dimensions the same modes stay fixed.
    """

    dimensions: tuple[int, ...] | None
    spectrum: ParametricFixedSpectrum
    refused: tuple[ParametricFixedSpectrum, ...]

    @property
    def certificates(self) -> tuple[ParametricFixedSpectrum, ...]:
        """The answers that prove it."""
        return self.spectrum, *self.refused


def shared_dimensions_for_every_value(
    system: ParametricSystem, graph: NeighborGraph, share: Share = "outputs+states"
) -> ParametricSharing:
    """Compute the least dimensions that suffice for every complex value of a parameter.

    Parameters
    ----------
    system : ParametricSystem
        With one parameter.
    graph : NeighborGraph
        The directed graph of who receives whose messages, without delays.
    share : {"outputs+states", "states"}

    Raises
    ------
    LimitReached
        If too many dimensions would have to be tried.

    Notes
    -----
    Exact.  All dimensions are tried, sum after sum.  A sum is excluded if a mode is fixed with each
    of its dimensions; the answers for the last excluded sum are kept.  If a range of the parameter
    is assumed, values outside of it do not count.

    Examples
    --------
    >>> plant = ParametricSystem(
    ...     [[1, 0, 0], ["t", 1, 0], [0, 1, 1]],
    ...     [[[1], [0], [0]], [[0], [1], [0]], [[1], [0], [0]]],
    ...     [[[1, 0, 0], [0, 0, 1]], [[0, 1, 0]], [[0, 1, 0]]],
    ...     parameters=["t"],
    ... )
    >>> sharing = shared_dimensions_for_every_value(plant, NeighborGraph.ring(plant.names))
    >>> sharing.dimensions, len(sharing.refused)
    ((0, 0, 1), 1)
    >>> alone = shared_dimensions_for_every_value(plant, NeighborGraph.empty(plant.names))
    >>> alone.dimensions, [str(each.value) for each in alone.spectrum.exceptional]
    (None, ['x'])
    """

    def asked(sizes: tuple[int, ...]) -> ParametricFixedSpectrum:
        return parametric_fixed_spectrum(extended_system(system, sizes, share, graph))

    enough = asked((system.n,) * system.m)
    if _fixes(enough):
        return ParametricSharing(None, enough, ())
    refused: list[ParametricFixedSpectrum] = []
    for total in range(system.n * system.m):
        tried: list[ParametricFixedSpectrum] = []
        for sizes in _with_sum(total, system.m):
            if len(tried) >= _MOST:
                raise LimitReached(f"more than {_MOST} dimensions have the sum {total}")
            tried.append(asked(sizes))
            if not _fixes(tried[-1]):
                return ParametricSharing(sizes, tried[-1], tuple(refused))
        refused = tried
    return ParametricSharing((system.n,) * system.m, enough, tuple(refused))


def _fixes(answer: ParametricFixedSpectrum) -> bool:
    """Whether a mode is fixed for almost every value, or at some."""
    return bool(answer.generic or answer.exceptional)


def _with_sum(total: int, m: int) -> Iterator[tuple[int, ...]]:
    """All dimensions of m agents with this sum, in lexicographic order."""
    if m == 1:
        yield (total,)
        return
    for first in range(total + 1):
        for rest in _with_sum(total - first, m - 1):
            yield (first, *rest)
