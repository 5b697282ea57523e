"""Lines through the space of several parameters, along which candidates are confirmed by proofs."""

from __future__ import annotations

import random
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any

from mcexact.answer.exceptional_hypersurfaces import A, Line
from mcexact.answer.parametric_fixed_spectrum import ParametricFixedSpectrum
from mcexact.answer.parametric_rank import ParametricRank
from mcexact.derived.constructions import along_line, points_of
from mcexact.errors import InputError
from mcexact.exact import rational_functions
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational_functions import FunctionMatrix, RationalFunction
from mcexact.model.parametric import ParametricSystem

DRAWS = 60
"""How often gains or minors are drawn."""
_LINES = 2
"""The number of lines along which the answer is proved."""
Along = ParametricFixedSpectrum | ParametricRank
Confirmed = dict[RationalFunction, list[Any]]
"""The exceptional values of all lines on each hypersurface."""


def confirming_lines(
    about: ParametricSystem,
    decide: Callable[[ParametricSystem], A],
    is_generic: Callable[[A], bool],
    candidates: Sequence[RationalFunction],
    rng: random.Random,
) -> tuple[tuple[Line[A], ...], Confirmed] | None:
    """Draw lines along which the candidates are the exceptional values, or some of them are.

    Parameters
    ----------
    about : ParametricSystem
    decide : callable
        Answers the question about the system along a line, with a proof.
    is_generic : callable
        Whether an answer says for almost all values of a line what holds for almost all values.
    candidates : sequence of RationalFunction
    rng : random.Random

    Returns
    -------
    tuple or None
        The lines, and the candidates that are exceptional; None if lines disagree.
    """
    lines: list[Line[A]] = []
    confirmed: Confirmed = {}
    for attempt in range(_LINES + 2):
        try:
            line = _line(about, rng, 3 + attempt)
        except InputError:
            continue
        at = points_of(line)
        met = {h: _values(h, at) for h in candidates}
        if any(values & {*line.poles} for values in met.values()):
            continue  # nothing is said where an entry is undefined
        answer = decide(line)
        found = _confirmed(answer, met)
        if found is None or not is_generic(answer):
            continue
        if lines and found.keys() != confirmed.keys():
            return None
        for h, values in found.items():
            confirmed.setdefault(h, []).extend(values)
        lines.append(Line(at, answer))
        if len(lines) == _LINES:
            return tuple(lines), confirmed
    return None


def poles(parts: Collection[FunctionMatrix], names: tuple[str, ...]) -> set[RationalFunction]:
    """The irreducible factors of the denominators of matrices."""
    return {
        rational_functions.in_parameters(q, names)
        for M in parts
        for q in rational_functions.factors(rational_functions.cleared(M, names)[1])
    }


def in_order(surfaces: Collection[RationalFunction]) -> list[RationalFunction]:
    """Polynomials in parameters in a fixed order, those of low degree first."""
    return sorted(surfaces, key=lambda h: (int(h.numerator.total_degree()), str(h)))


def _line(about: ParametricSystem, rng: random.Random, size: int) -> ParametricSystem:
    """The system on a line through a drawn point in a drawn direction.

    Raises
    ------
    InputError
        If an entry is undefined on all of the line.
    """
    slopes = [k for k in range(-size, size + 1) if k]
    drawn = {name: (rng.choice(slopes), rng.randint(-size, size)) for name in about.parameters}
    point, direction = ({name: ends[k] for name, ends in drawn.items()} for k in (1, 0))
    return along_line(about, point, direction, _letter(about.parameters))


def _letter(parameters: Collection[str]) -> str:
    """The parameter of the lines, which is none of the system: s, or s1, s2, …"""
    known = ("s" + str(k or "") for k in range(len(parameters) + 1))
    return next(s for s in known if s not in parameters)


def _values(h: RationalFunction, at: Mapping[str, RationalFunction]) -> set[Polynomial]:
    """The values at which a line meets a hypersurface, as monic irreducible polynomials.

    None of them says that all do, or none: along such a line nothing is confirmed.
    """
    values = [at[name] for name in h.parameters]
    met = h.substituted(values, values[0] * 0).polynomials()[0]
    return set() if met.is_zero() else {q.monic() for q, _ in met.factor()}


def _confirmed(answer: Along, met: Mapping[RationalFunction, set[Polynomial]]) -> Confirmed | None:
    """The candidates that are exceptional; None if they are not all that is."""
    found = {each.value: each for each in answer.exceptional}
    if found.keys() - set().union(*met.values()):
        return None
    confirmed: Confirmed = {}
    for h, values in met.items():
        if not values or 0 < len(values & found.keys()) < len(values):
            return None
        if values <= found.keys():
            confirmed[h] = [found[q] for q in values]
    return confirmed
