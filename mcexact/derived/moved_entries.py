"""Constructions of systems with parameters: those that only put entries elsewhere, and lines."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from itertools import count
from typing import Any

from mcexact.errors import InputError, UsageError
from mcexact.exact.function_matrix import FunctionMatrix
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import as_fraction, written
from mcexact.exact.rational_function import RationalFunction
from mcexact.model.parametric import ParametricSystem, values_by_name
from mcexact.model.system import Construction, MultiChannelSystem

MOVING = frozenset(
    {
        "arcs",
        "augmented_outputs",
        "dual",
        "extended",
        "full_output",
        "integrators",
        "merged",
        "restricted",
    }
)
"""The constructions whose results have entries of the system, 0 and 1 for entries."""
LINE = "line"
"""The construction that comes before these."""


@dataclass(frozen=True, init=False, repr=False)
class DerivedParametricSystem(ParametricSystem):
    """A system with parameters that was constructed from another one."""

    origin: ParametricSystem
    steps: tuple[Construction, ...] = field(hash=False)

    @property
    def plant(self) -> ParametricSystem:
        """The system from which this one was constructed."""
        return self.origin

    @property
    def subject(self) -> tuple[Construction, ...]:
        """The constructions that lead from the plant to this system, in order."""
        return self.steps

    @cached_property
    def poles(self) -> tuple[Polynomial, ...]:
        """The irreducible polynomials at whose roots an entry of the plant is undefined."""
        if self.steps[0]["construction"] != LINE:
            return super().poles
        line = [*points_of(self).values()]
        zero = RationalFunction.constant(0, self.parameters)
        parts = [self.origin.A, *(M for c in self.origin.channels for M in (c.B, c.C))]
        entries = {entry for M in parts for row in M.rows for entry in row}
        below = {
            RationalFunction(e.parameters, e.denominator, e.denominator**0).substituted(line, zero)
            for e in entries
        }
        found = {q.monic() for each in below for q, _ in each.polynomials()[0].factor()}
        return tuple(sorted(found, key=lambda q: (q.degree, q.coefficients)))


def moved(
    system: ParametricSystem, construct: Callable[[MultiChannelSystem], MultiChannelSystem]
) -> ParametricSystem:
    """Apply constructions that only put entries elsewhere to a system with parameters.

    Parameters
    ----------
    system : ParametricSystem
        It has the neighbor graph without edges.
    construct : function of a MultiChannelSystem
        Applies constructions, all of `MOVING`.

    Returns
    -------
    ParametricSystem
        It records the plant and the constructions; at every value of the parameters it is what the
        constructions make from the plant there.

    Raises
    ------
    UsageError
        If a construction computes with entries.

    Notes
    -----
    They are applied once, to numbers in the places of the entries, 0 for 0 and else 2, 3, …, which
    tell from the result which entry stands where.

    Examples
    --------
    >>> from mcexact.derived.dual import dual
    >>> plant = ParametricSystem([[1, "t"], [0, 2]], [[[0], [1]]], [[[1, "t^2"]]], parameters=["t"])
    >>> found = moved(plant, dual)
    >>> print(found.A[1, 0], "|", found.channels[0].B[1, 0], "|", found.subject)
    t | t^2 | ({'construction': 'dual'},)
    """
    zero, one = (RationalFunction.constant(k, system.parameters) for k in (0, 1))
    known, free = {0: zero, 1: one}, count(2)

    def numbered(M: FunctionMatrix) -> Matrix:
        rows = [[_number(entry, known, free) for entry in row] for row in M.rows]
        return Matrix.from_integers(rows, ncols=M.ncols)

    def entries(M: Matrix) -> FunctionMatrix:
        return FunctionMatrix(tuple(tuple(known[k] for k in row) for row in M.numerators), M.ncols)

    start = MultiChannelSystem(
        numbered(system.A),
        [numbered(channel.B) for channel in system.channels],
        [numbered(channel.C) for channel in system.channels],
        time=system.time,
        names=system.names,
        neighbors={},
    )
    made = construct(start)
    for step in made.subject:
        if step["construction"] not in MOVING:
            raise UsageError(f"{step['construction']} does not apply to systems with parameters")
    result = object.__new__(DerivedParametricSystem)
    ParametricSystem.__init__(
        result,
        entries(made.A),
        [entries(channel.B) for channel in made.channels],
        [entries(channel.C) for channel in made.channels],
        parameters=system.parameters,
        assume=dict(zip(system.parameters, system.ranges, strict=True)),
        time=made.time,
        names=made.names,
    )
    object.__setattr__(result, "origin", system.plant)
    object.__setattr__(result, "steps", (*system.subject, *made.subject))
    return result


def along_line(
    system: ParametricSystem,
    point: Mapping[Any, Any],
    direction: Mapping[Any, Any],
    parameter: str = "s",
) -> ParametricSystem:
    """The system on a line through the space of its parameters, each a + b s, for every s.

    Parameters
    ----------
    system : ParametricSystem
        With one parameter or several; their ranges are of no account on the line.
    point, direction : mapping
        For each parameter, by symbol or name, the exact numbers a and b; not every b is 0.
    parameter : str
        The letter s, which is none of the parameters.

    Returns
    -------
    ParametricSystem
        It records the plant and the line, before all other constructions, so that certificates
        about it name the plant: ``mcexact check --system`` accepts them with its file.

    Raises
    ------
    InputError
        If a number is missing, the direction is 0, or an entry is undefined on all of the line.
    UsageError
        If the parameter is one of the system, or the system is on a line already.

    Notes
    -----
    Exact.  Nothing is claimed where an entry of the plant is undefined, also where its numerator
    vanishes with the denominator on the line.

    Examples
    --------
    >>> plant = ParametricSystem([["a + b"]], [[["a"]]], [[["1/b"]]], parameters=["a", "b"])
    >>> line = along_line(plant, {"a": 1, "b": 0}, {"a": "1/2", "b": -1})
    >>> print(line.A[0, 0], "|", line.channels[0].C[0, 0], "|", *line.poles)
    -1/2*s + 1 | (-1)/(s) | x
    >>> along_line(plant, {"a": 1, "b": 0}, {"a": 1, "b": 0})
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: channels[0].C: (1)/(b) is undefined there: its denominator is 0
    """
    InputError.require(system, ParametricSystem, "system")
    if parameter in system.parameters:
        raise UsageError(f"{parameter} is a parameter of the system: choose another letter")
    if any(step["construction"] == LINE for step in system.subject):
        raise UsageError("the system is on a line already: take one of the plant")
    start, slope = _numbers(system, point, "point"), _numbers(system, direction, "direction")
    if not any(slope.values()):
        raise InputError("expected a direction that is not 0", where="direction")
    line = _line(system, start, slope, parameter)
    made = system.along(line, [parameter])
    if system.subject:
        # also where an entry was left out that is undefined on the line
        system.plant.along(line, [parameter])
    result = object.__new__(DerivedParametricSystem)
    for key, value in vars(made).items():
        object.__setattr__(result, key, value)
    step = {
        "construction": LINE,
        "parameter": parameter,
        "point": {name: written(value) for name, value in start.items()},
        "direction": {name: written(value) for name, value in slope.items()},
    }
    object.__setattr__(result, "origin", system.plant)
    object.__setattr__(result, "steps", (step, *system.subject))
    return result


def points_of(line: ParametricSystem) -> dict[str, RationalFunction]:
    """The values of the parameters of the plant on the line that a system is on.

    Examples
    --------
    >>> plant = ParametricSystem([["a + b"]], [[[1]]], [[[1]]], parameters=["a", "b"])
    >>> [*map(str, points_of(along_line(plant, {"a": 1, "b": 0}, {"a": 2, "b": 1})).values())]
    ['2*s + 1', 's']
    """
    step = line.subject[0]
    point, direction = (
        {name: Fraction(value) for name, value in step[key].items()}
        for key in ("point", "direction")
    )
    return _line(line.plant, point, direction, step["parameter"])


def _numbers(system: ParametricSystem, value: Mapping[Any, Any], where: str) -> dict[str, Fraction]:
    """An exact number for each parameter."""
    known = values_by_name(value, system.parameters, where)
    missing = [name for name in system.parameters if name not in known]
    if missing:
        raise InputError(f"expected a number for the parameter {missing[0]!r}", where=where)
    return {name: as_fraction(known[name], where=f"{where}[{name}]") for name in system.parameters}


def _line(
    system: ParametricSystem,
    point: Mapping[str, Fraction],
    direction: Mapping[str, Fraction],
    parameter: str,
) -> dict[str, RationalFunction]:
    """For each parameter a + b s."""
    s = RationalFunction.parameter(parameter, (parameter,))
    return {name: direction[name] * s + point[name] for name in system.parameters}


def _number(
    entry: RationalFunction, known: dict[int, RationalFunction], free: Iterator[int]
) -> int:
    """0 for 0, and else a number that stands for the entry from now on."""
    if entry.is_constant and entry.value == 0:
        return 0
    k = next(free)
    known[k] = entry
    return k
