"""Where a mode of a system with several parameters is fixed that is not for almost all values."""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Callable, Iterable
from fractions import Fraction
from typing import Any

from mcexact.analysis.engine.parameter_lines import DRAWS, confirming_lines, in_order, poles
from mcexact.analysis.engine.parametric_control import parametric_controllability
from mcexact.analysis.engine.parametric_modes import parametric_fixed_spectrum
from mcexact.answer.exceptional_hypersurfaces import (
    ExceptionalHypersurfaces,
    Hypersurface,
    Line,
)
from mcexact.answer.parametric_fixed_spectrum import ParametricFixedSpectrum
from mcexact.derived.modular import generator
from mcexact.errors import LimitReached
from mcexact.exact import rational_functions
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational_functions import FunctionMatrix, RationalFunction
from mcexact.model.entries import as_functions
from mcexact.model.parametric import ParametricSystem

_NUMBER = RationalFunction.constant(0, ())
"""What a function of parameters is when they have values."""


def mode_hypersurfaces(system: ParametricSystem) -> ExceptionalHypersurfaces:
    """Decide what is fixed for almost all values of several parameters, and where more is."""
    rng = generator(system, "exceptional_hypersurfaces")
    return _Search(system, system, parametric_fixed_spectrum, rng).found()


def controllability_hypersurfaces(
    system: ParametricSystem, channels: Iterable[str] | None = None, *, observed: bool = False
) -> ExceptionalHypersurfaces:
    """Decide which modes channels do not control for almost all values, and where others.

    Parameters
    ----------
    system : ParametricSystem
    channels : iterable of str, optional
        By default all.
    observed : bool
        Whether the question is about observability.
    """
    chosen = system.names if channels is None else system.named(system.indices(channels))
    rng = generator(system, "controllability_hypersurfaces")

    def decide(line: ParametricSystem) -> ParametricFixedSpectrum:
        return parametric_controllability(line, chosen, observed)

    return _Search(system, _with_full_ports(system, chosen, observed), decide, rng).found()


def _with_full_ports(
    system: ParametricSystem, chosen: tuple[str, ...], observed: bool
) -> ParametricSystem:
    """The system of one channel with some inputs and x as output, or some outputs and input x."""
    one = [[int(i == j) for j in range(system.n)] for i in range(system.n)]
    identity = as_functions(one, "identity", system.parameters, system.n).matrix()
    named = [channel for channel in system.channels if channel.name in chosen]
    if observed:
        outputs = tuple(row for channel in named for row in channel.C.rows)
        B, C = identity, FunctionMatrix(outputs, system.n)
    else:
        inputs = tuple(sum((channel.B.rows[i] for channel in named), ()) for i in range(system.n))
        B, C = FunctionMatrix(inputs, sum(channel.B.ncols for channel in named)), identity
    return ParametricSystem(system.A, [B], [C], parameters=system.parameters, time=system.time)


class _Search:
    """Draws gains, then lines, until what gains leave is what is fixed along the lines.

    Parameters
    ----------
    about : ParametricSystem
        The system of the answer.
    system : ParametricSystem
        That whose fixed modes are looked for.
    decide : callable
        Answers the question about ``about`` along a line.
    rng : random.Random
    """

    def __init__(
        self,
        about: ParametricSystem,
        system: ParametricSystem,
        decide: Callable[[ParametricSystem], ParametricFixedSpectrum],
        rng: random.Random,
    ) -> None:
        self.about, self.decide = about, decide
        self.system, self.rng, self.names = system, rng, system.parameters
        parts = [system.A, *(M for c in system.channels for M in (c.B, c.C))]
        rows = [rational_functions.cleared(M, self.names)[0] for M in parts]
        entries = [about.A, *(M for c in about.channels for M in (c.B, c.C))]
        self.A, self.B, self.C = rows[0], rows[1::2], rows[2::2]
        self.poles = poles(entries, self.names)
        self.chi = rational_functions.characteristic(self.A, self.names)

    def found(self) -> ExceptionalHypersurfaces:
        """The answer."""
        for attempt in range(DRAWS):
            drawn = self._candidates(1 + attempt)
            if drawn is None:
                continue
            generic, candidates = drawn
            degree = sum(map(rational_functions.degree, generic))

            def is_generic(answer: ParametricFixedSpectrum, degree: int = degree) -> bool:
                return sum(len(p) - 1 for p in answer.generic) == degree

            made = confirming_lines(self.about, self.decide, is_generic, candidates, self.rng)
            if made is not None:
                break
        else:
            raise LimitReached("no drawn gains leave the fixed modes alone")
        lines, confirmed = made
        # Where a line meets two hypersurfaces at once, modes are fixed because of either.
        met = Counter(id(value) for values in confirmed.values() for value in values)
        alone = {
            h: [value for value in values if met[id(value)] == 1] or values
            for h, values in confirmed.items()
        }
        sets = {
            h: {mode.channels for value in values for mode in value.modes}
            for h, values in alone.items()
        }
        return ExceptionalHypersurfaces(
            about=self.about,
            hypersurfaces=tuple(
                Hypersurface(
                    h,
                    channels=() if self.system is not self.about else tuple(sorted(sets[h])),
                    example=_example(alone[h], lines),
                )
                for h in in_order(sets)
            ),
            undefined_at=tuple(in_order(self.poles)),
            lines=lines,
            generic=tuple(rational_functions.coefficients(p, self.names) for p in generic),
        )

    def _loop(self, size: int) -> Any:
        """det(xI − A − Σ B_i F_i C_i) for drawn gains of this size."""
        inside = rational_functions.ring(self.names)
        zero, closed = inside.constant(0), self.A
        for B_i, C_i, (p, q) in zip(self.B, self.C, self.system.sizes, strict=True):
            if p and q and self.system.n:
                F = [
                    [inside.constant(self.rng.randint(-size, size)) for _ in range(q)]
                    for _ in range(p)
                ]
                gained = rational_functions.product(B_i, F, zero)
                closed = rational_functions.total(
                    closed, rational_functions.product(gained, C_i, zero)
                )
        return rational_functions.characteristic(closed, self.names)

    def _candidates(self, size: int) -> tuple[list[Any], list[RationalFunction]] | None:
        """What drawn gains leave, and where more is common to what they move.

        None if one of both loops keeps more than the other: its resultants are 0, and their factors
        say nothing.
        """
        psi = [self.chi, self._loop(size), self._loop(size)]
        common = rational_functions.common_divisor(psi)
        generic = [p for p in rational_functions.factors(common) if rational_functions.degree(p)]
        for p in generic:
            psi = [rational_functions.without(f, p) for f in psi]
        if not all(rational_functions.is_coprime(psi[0], f) for f in psi[1:]):
            return None
        left, first, second = map(rational_functions.factors, psi)
        in_both = rational_functions.resultant_factors(left, first, self.names)
        in_both &= rational_functions.resultant_factors(left, [*second, *generic], self.names)
        return generic, [h for h in in_both if h not in self.poles]


def _example(
    values: Iterable[Any], lines: Iterable[Line[ParametricFixedSpectrum]]
) -> tuple[dict[str, Fraction], tuple[Polynomial, ...]] | None:
    """One of the values at which lines meet a hypersurface, and what is fixed only there."""
    known = {id(value) for value in values}
    for line in lines:
        for each in line.answer.exceptional:
            s = each.exact
            if s is not None and id(each) in known:
                at = {
                    name: value.substituted([s], _NUMBER).value for name, value in line.at.items()
                }
                scale = line.answer.scale(s)
                modes = {
                    p.monic()
                    for mode in each.modes
                    for p, _ in Polynomial.from_coefficients([c(s) for c in mode.polynomial])
                    .scale(scale)
                    .factor()
                }
                return at, tuple(sorted(modes, key=lambda p: (p.degree, p.coefficients)))
    return None
