"""Where a mode of a system with several parameters is fixed that is not for almost all values."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

from mcexact.analysis.engine import parametric_controllability
from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.answer.exceptional_hypersurfaces import (
    ExceptionalHypersurfaces,
    Hypersurface,
    Line,
)
from mcexact.answer.parametric_fixed_spectrum import ParametricFixedSpectrum
from mcexact.derived.modular_system import generator
from mcexact.errors import InputError, InternalError
from mcexact.exact import several_variables
from mcexact.exact.function_matrix import FunctionMatrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational_function import RationalFunction
from mcexact.model.function_entry import as_functions
from mcexact.model.parametric import ParametricSystem

_DRAWS = 60
_LINES = 2
"""The number of lines along which the answer is proved."""
_ALONG = ("s",)


def exceptional_hypersurfaces(system: ParametricSystem) -> ExceptionalHypersurfaces:
    """Decide what is fixed for almost all values of several parameters, and where more is.

    Parameters
    ----------
    system : ParametricSystem

    Raises
    ------
    LimitReached
        If a degree exceeds a limit.

    Notes
    -----
    Exact.  The irreducible factors that resultants for several drawn gains have in common are the
    candidates; of these, the ones are kept at whose points a mode is fixed on drawn lines.  There
    everything is decided for every value and proved by a certificate.  The resultants are
    polynomials in all parameters, which limits this to some ten states.

    Examples
    --------
    >>> plant = ParametricSystem(
    ...     [[0, "a"], [0, 1]], [[[0], [1]]], [[["b - a", 1]]], parameters=["a", "b"]
    ... )
    >>> found = exceptional_hypersurfaces(plant)
    >>> [str(each) for each in found.hypersurfaces]
    ['a = 0', 'a - b = 0', 'a^2 - a*b - 1 = 0']
    """
    InputError.require(system, ParametricSystem, "system")
    rng = generator(system, "exceptional_hypersurfaces")
    return _Search(system, system, fixed_spectrum, rng).found()


def controllability_hypersurfaces(
    system: ParametricSystem, *, observed: bool = False
) -> ExceptionalHypersurfaces:
    """Decide which modes no channel controls for almost all values, and where others are not.

    Parameters
    ----------
    system : ParametricSystem
    observed : bool
        Whether the question is about observability.

    Raises
    ------
    LimitReached
        If a degree exceeds a limit.
    """
    rng = generator(system, "controllability_hypersurfaces")

    def decide(line: ParametricSystem) -> ParametricFixedSpectrum:
        return parametric_controllability(line, observed=observed)

    return _Search(system, _with_full_ports(system, observed), decide, rng).found()


def _with_full_ports(system: ParametricSystem, observed: bool) -> ParametricSystem:
    """The system of one channel with all inputs and x as output, or all outputs and input x."""
    one = [[int(i == j) for j in range(system.n)] for i in range(system.n)]
    identity = as_functions(one, "identity", system.parameters, system.n).matrix()
    if observed:
        outputs = tuple(row for M in system.C for row in M.rows)
        B, C = identity, FunctionMatrix(outputs, system.n)
    else:
        inputs = tuple(sum((M.rows[i] for M in system.B), ()) for i in range(system.n))
        B, C = FunctionMatrix(inputs, sum(p for p, _ in system.sizes)), identity
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
        rows, denominators = zip(
            *(several_variables.cleared(M, self.names) for M in parts), strict=True
        )
        self.A, self.B, self.C = rows[0], rows[1::2], rows[2::2]
        self.poles = {
            several_variables.in_parameters(q, self.names): None
            for delta in denominators
            for q in several_variables.factors(delta)
        }
        self.chi = several_variables.characteristic(self.A, self.names)

    def found(self) -> ExceptionalHypersurfaces:
        """The answer."""
        for attempt in range(_DRAWS):
            generic, candidates = self._candidates(1 + attempt)
            lines, confirmed = self._lines(generic, candidates)
            if len(lines) == _LINES:
                break
        else:
            raise InternalError("no drawn gains leave the fixed modes alone")
        return ExceptionalHypersurfaces(
            self.about,
            tuple(several_variables.coefficients(p, self.names) for p in generic),
            tuple(
                Hypersurface(h, tuple(sorted(sets)))
                for h, sets in sorted(confirmed.items(), key=lambda each: _order(each[0]))
            ),
            tuple(sorted(self.poles, key=_order)),
            tuple(lines),
        )

    def _loop(self, size: int) -> Any:
        """det(xI − A − Σ B_i F_i C_i) for drawn gains of this size."""
        inside = several_variables.ring(self.names)
        zero, closed = inside.constant(0), self.A
        for B_i, C_i, (p, q) in zip(self.B, self.C, self.system.sizes, strict=True):
            if p and q and self.system.n:
                F = [
                    [inside.constant(self.rng.randint(-size, size)) for _ in range(q)]
                    for _ in range(p)
                ]
                gained = several_variables.product(B_i, F, zero)
                closed = several_variables.total(
                    closed, several_variables.product(gained, C_i, zero)
                )
        return several_variables.characteristic(closed, self.names)

    def _candidates(self, size: int) -> tuple[list[Any], list[RationalFunction]]:
        """What drawn gains leave, and where more is common to what they move."""
        psi = [self.chi, self._loop(size), self._loop(size)]
        common = several_variables.common_divisor(psi)
        generic = [p for p in several_variables.factors(common) if several_variables.degree(p)]
        for p in generic:
            psi = [several_variables.without(f, p) for f in psi]
        left, first, second = map(several_variables.factors, psi)
        in_both = several_variables.resultant_factors(left, first, self.names)
        in_both &= several_variables.resultant_factors(left, [*second, *generic], self.names)
        return generic, [h for h in in_both if h not in self.poles]

    def _lines(
        self, generic: Sequence[Any], candidates: Sequence[RationalFunction]
    ) -> tuple[list[Line], dict[RationalFunction, set[tuple[str, ...]]]]:
        """Lines along which the candidates are the exceptional values, or some of them are."""
        degree = sum(map(several_variables.degree, generic))
        lines: list[Line] = []
        confirmed: dict[RationalFunction, set[tuple[str, ...]]] = {}
        for attempt in range(_LINES + 2):
            at = self._line(3 + attempt)
            met = {h: _factors(h, at) for h in candidates}
            try:
                answer = self.decide(self.about.along(at, _ALONG))
            except InputError:
                continue
            found = _confirmed(answer, met)
            if found is None or sum(len(p) - 1 for p in answer.generic) != degree:
                continue
            if lines and found.keys() != confirmed.keys():
                return [], {}
            for h, sets in found.items():
                confirmed.setdefault(h, set()).update(sets)
            lines.append(Line(at, answer))
            if len(lines) == _LINES:
                break
        return lines, confirmed

    def _line(self, size: int) -> dict[str, RationalFunction]:
        """A line through a drawn point in a drawn direction."""
        s = RationalFunction.parameter(*_ALONG, _ALONG)
        slopes = [k for k in range(-size, size + 1) if k]
        return {
            name: self.rng.choice(slopes) * s + self.rng.randint(-size, size) for name in self.names
        }


def _factors(h: RationalFunction, at: dict[str, RationalFunction]) -> set[Polynomial]:
    """The values at which a line meets a hypersurface, as monic irreducible polynomials."""
    values = [at[name] for name in h.parameters]
    met = h.substituted(values, RationalFunction.constant(0, _ALONG)).polynomials()[0]
    return {q * (Fraction(1) / q.leading) for q, _ in met.factor()} if met else set()


def _confirmed(
    answer: ParametricFixedSpectrum, met: dict[RationalFunction, set[Polynomial]]
) -> dict[RationalFunction, set[tuple[str, ...]]] | None:
    """The candidates at which more is fixed; None if they are not what is exceptional."""
    sets = {each.value: {mode.channels for mode in each.modes} for each in answer.exceptional}
    if sets.keys() - set().union(*met.values()):
        return None
    found = {}
    for h, values in met.items():
        if not values or 0 < len(values & sets.keys()) < len(values):
            return None
        if values <= sets.keys():
            found[h] = set().union(*(sets[q] for q in values))
    return found


def _order(h: RationalFunction) -> tuple[int, str]:
    return int(h.numerator.total_degree()), str(h)
