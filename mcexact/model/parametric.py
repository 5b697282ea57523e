"""Multi-channel systems whose entries depend on parameters.

A `ParametricSystem` has rational functions of named parameters as entries, and perhaps a range for
each parameter.  `at` gives the system of numbers at one value of every parameter, `with_values`
fixes some of them, and `along` puts them on a line or another curve.  `generic` takes drawn
integers; what is true there is nearly always true of almost all values, but that is no proof.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import Any, ClassVar

from mcexact.errors import InputError, LimitReached, shown_value
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import as_fraction, rational_text, written
from mcexact.exact.rational_functions import FunctionMatrix, RationalFunction
from mcexact.exact.roots import require_time
from mcexact.model.entries import (
    as_function,
    as_functions,
    checked_parameter,
    matrix_json,
    require_square,
)
from mcexact.model.system import (
    ByChannel,
    Channel,
    Construction,
    MultiChannelSystem,
    channels_of,
)
from mcexact.model.text import canonical, checked_text, nearest, quoted

Range = tuple[Fraction | None, Fraction | None]
"""The least and the largest value of a parameter; None where there is none."""

_TRIES = 200


@dataclass(frozen=True, init=False, repr=False)
class ParametricSystem(ByChannel[FunctionMatrix]):
    """A multi-channel system whose entries are rational functions of parameters.

    Parameters
    ----------
    A : matrix, n×n
        A list of rows, a numpy array of objects or a sympy matrix.  Entries are numbers as
        `MultiChannelSystem` takes them, rational functions of sympy symbols, or strings such as
        "1/2 + 3*t^2".
    B : sequence of m matrices
        B_i is n×p_i.
    C : sequence of m matrices
        C_i is q_i×n.
    parameters : sequence of symbols or str
        The parameters, at least one; they are kept in alphabetical order.
    assume : mapping, optional
        For some parameters the least and the largest value; None where there is none.
    time : {"continuous", "discrete"}
    names : sequence of str, optional
        The channels, by default "1" … "m".
    name, source : str, optional
        A name and a source, which no decision uses.

    Attributes
    ----------
    ranges : tuple of (Fraction or None, Fraction or None)
        The assumed range of each parameter.

    Raises
    ------
    FloatRefused
        If an entry is a float, or an expression holds one.
    InputError
        If a shape, an entry, a name, a parameter or a range is not as expected.

    Notes
    -----
    Entries are functions: (t² − 1)/(t − 1) is t + 1, which is defined at 1 as well.

    Examples
    --------
    >>> from sympy import symbols
    >>> t = symbols("t")
    >>> plant = ParametricSystem(
    ...     [[1, t], [0, 2]], [[[0], [1]]], [[["1/(t - 2)", 0]]], parameters=[t], assume={t: (0, 1)}
    ... )
    >>> plant
    ParametricSystem(n=2, m=1, continuous time, parameters: t in [0, 1], channels: '1')
    >>> plant.at({t: "1/2"}).A[0, 1]
    Fraction(1, 2)
    >>> plant.at({t: 2})
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: channels[0].C: (1)/(t - 2) is undefined there: its denominator is 0
    >>> ParametricSystem([[0.5 * t]], [[[1]]], [[[1]]], parameters=[t])  # doctest: +ELLIPSIS
    Traceback (most recent call last):
        ...
    mcexact.errors.FloatRefused: A[0][0]: a float is not exact: ...
    """

    _made_by: ClassVar[str] = (
        "ParametricSystem(A, B, C, parameters=[t]), or with load_parametric_system(file)"
    )
    _becomes: ClassVar[dict[str, str]] = {
        "MultiChannelSystem": "give values to its parameters, plant.at({…}); `analyze`, "
        "`fixed_spectrum` and joint controllability are decided for all values"
    }
    """Advice in an error for a caller who passes such a system in place of something else."""
    neighbors: ClassVar[None] = None
    sample_time: ClassVar[None] = None
    regulated: ClassVar[None] = None
    limits: ClassVar[None] = None
    uncertainty: ClassVar[None] = None
    typical_sizes: ClassVar[None] = None
    D: ClassVar[None] = None
    rounding: ClassVar[None] = None

    parameters: tuple[str, ...]
    ranges: tuple[Range, ...]
    A: FunctionMatrix
    channels: tuple[Channel[FunctionMatrix], ...]
    time: str
    name: str | None = field(compare=False)
    source: str | None = field(compare=False)

    def __init__(
        self,
        A: Any,
        B: Sequence[Any],
        C: Sequence[Any],
        *,
        parameters: Sequence[Any],
        assume: Mapping[Any, tuple[Any, Any]] | None = None,
        time: str = "continuous",
        names: Sequence[str] | None = None,
        name: str | None = None,
        source: str | None = None,
    ) -> None:
        known = _checked_parameters(parameters)
        require_time(time)
        table = require_square(as_functions(A, "A", known), "A")
        channels = channels_of(
            table.shape[0],
            B,
            C,
            names,
            lambda value, where, ncols: as_functions(value, where, known, ncols),
        )
        fields = {
            "parameters": known,
            "ranges": _checked_ranges(assume or {}, known),
            "A": table.matrix(),
            "channels": channels,
            "time": time,
            "name": None if name is None else checked_text(name, "name"),
            "source": None if source is None else checked_text(source, "source"),
        }
        for key, value in fields.items():
            object.__setattr__(self, key, value)

    @property
    def parameters_in_words(self) -> tuple[str, ...]:
        """Each parameter with its range, such as "t in [0, 1]"."""
        return tuple(map(_with_range, self.parameters, self.ranges))

    @cached_property
    def poles(self) -> tuple[Polynomial, ...]:
        """With one parameter, the irreducible polynomials at whose roots an entry is undefined.

        For a system constructed from a plant these are the poles of the plant, even if the
        constructed system lacks the entries with these poles: all answers about the plant exclude
        the same values.
        """
        parts = [self.plant.A, *(M for c in self.plant.channels for M in (c.B, c.C))]
        factors = {q for M in parts for q, _ in M.reduced[1].factor()}
        return tuple(sorted(factors, key=lambda q: (q.degree, q.coefficients)))

    @property
    def plant(self) -> ParametricSystem:
        """This system, which was not constructed from another one."""
        return self

    @property
    def subject(self) -> tuple[Construction, ...]:
        """The constructions that lead from the plant to this system: none."""
        return ()

    def at(self, values: Any) -> MultiChannelSystem:
        """The system at a value of every parameter.

        Parameters
        ----------
        values : mapping, or exact number
            An exact number for each parameter, by symbol or name; a number alone is the value of
            the only parameter.

        Raises
        ------
        InputError
            If a value is missing or unknown, or an entry is undefined there.
        """
        if len(self.parameters) == 1 and not isinstance(values, Mapping):
            values = {self.parameters[0]: values}
        value_of = values_by_name(values, self.parameters, "values")
        missing = [name for name in self.parameters if name not in value_of]
        if missing:
            raise InputError(f"expected a value of the parameter {missing[0]!r}", where="values")
        numbers = [as_fraction(value_of[name], where=f"values[{name}]") for name in self.parameters]
        zero = RationalFunction.constant(0, ())
        parts = self._mapped(lambda entry: entry.substituted(numbers, zero))
        return MultiChannelSystem(
            parts[0].constants(),
            [B.constants() for B in parts[1 : self.m + 1]],
            [C.constants() for C in parts[self.m + 1 :]],
            time=self.time,
            names=self.names,
            name=self.name,
            source=self.source,
        )

    def with_values(self, values: Mapping[Any, Any]) -> MultiChannelSystem | ParametricSystem:
        """The system at values of some parameters, as a function of the others with their ranges.

        Parameters
        ----------
        values : mapping
            Exact numbers, by symbol or name; with one for each parameter this is `at`.

        Raises
        ------
        InputError
            If a parameter is unknown, or an entry is undefined.

        Examples
        --------
        >>> plant = ParametricSystem([["a + b"]], [[[1]]], [[[1]]], parameters=["a", "b"])
        >>> print(plant.with_values({"a": "1/2"}).A[0, 0])
        b + 1/2
        """
        value_of = values_by_name(values, self.parameters, "values")
        left = {
            name: bounds
            for name, bounds in zip(self.parameters, self.ranges, strict=True)
            if name not in value_of
        }
        return self.along(value_of, [*left], left) if left else self.at(value_of)

    def along(
        self,
        line: Mapping[Any, Any],
        parameters: Sequence[Any] = ("s",),
        assume: Mapping[Any, tuple[Any, Any]] | None = None,
    ) -> ParametricSystem:
        """The system along a line or another curve, as a function of other parameters.

        Parameters
        ----------
        line : mapping
            For each parameter a number or an expression in the new parameters; a parameter that is
            left out stands for itself, and has to be among the new ones.
        parameters : sequence of symbols or str
            The new parameters.
        assume : mapping, optional
            The ranges of the new parameters.

        Raises
        ------
        InputError
            If a parameter is unknown, or an entry is undefined everywhere.

        Examples
        --------
        >>> plant = ParametricSystem([["a + b"]], [[[1]]], [[["a*b"]]], parameters=["a", "b"])
        >>> line = plant.along({"a": "s", "b": "1 - s"})
        >>> print(line.A[0, 0], "|", line.channels[0].C[0, 0])
        1 | -s^2 + s
        """
        curve, new = values_by_name(line, self.parameters, "line"), _checked_parameters(parameters)
        values = [
            as_function(curve.get(name, name), f"line[{name}]", new) for name in self.parameters
        ]
        zero = RationalFunction.constant(0, new)
        parts = self._mapped(lambda entry: entry.substituted(values, zero))
        return ParametricSystem(
            parts[0],
            parts[1 : self.m + 1],
            parts[self.m + 1 :],
            parameters=new,
            assume=assume,
            time=self.time,
            names=self.names,
            name=self.name,
            source=self.source,
        )

    def generic(self, seed: int = 0) -> MultiChannelSystem:
        """The system at drawn integers, whose structure is nearly always that of almost all values.

        Parameters
        ----------
        seed : int

        Raises
        ------
        LimitReached
            If no draw gives a point at which every entry is defined.
        """
        rng = random.Random(seed)
        for _ in range(_TRIES):
            try:
                return self.at({name: rng.randrange(10**3, 10**6) for name in self.parameters})
            except InputError:
                continue
        raise LimitReached("no drawn point has all entries defined")

    def _mapped(self, function: Any) -> list[FunctionMatrix]:
        """A, all B_i and all C_i with a function applied to each entry."""
        places = ["A", *(f"channels[{i}].{part}" for part in "BC" for i in range(self.m))]
        parts = [self.A, *(c.B for c in self.channels), *(c.C for c in self.channels)]
        mapped = []
        for place, part in zip(places, parts, strict=True):
            with InputError.inside(place):
                mapped.append(part.mapped(function))
        return mapped

    def _as_canonical_text(self) -> str:
        return canonical(self.document())

    def _own_document(self) -> dict[str, Any]:
        return self.document()

    def document(self) -> dict[str, Any]:
        """The ``system`` object of a certificate, as plain data."""
        return {
            "time": self.time,
            "parameters": {
                name: {} if bounds == (None, None) else {"range": [*map(_end, bounds)]}
                for name, bounds in zip(self.parameters, self.ranges, strict=True)
            },
            "A": matrix_json(self.A),
            "channels": [
                {"name": channel.name, "B": matrix_json(channel.B), "C": matrix_json(channel.C)}
                for channel in self.channels
            ],
        }

    def __repr__(self) -> str:
        parameters = ", ".join(self.parameters_in_words)
        shown = ", ".join(quoted(name) for name in self.names[:8]) + (", …" if self.m > 8 else "")
        return (
            f"ParametricSystem(n={self.n}, m={self.m}, {self.time} time, parameters: {parameters}, "
            f"channels: {shown})"
        )


def _end(bound: Fraction | None) -> int | str | None:
    return None if bound is None else written(bound)


def _with_range(name: str, bounds: Range) -> str:
    low, high = bounds
    if low is None and high is None:
        return name
    left = "(-∞" if low is None else f"[{low}"
    return f"{name} in {left}, {'∞)' if high is None else f'{high}]'}"


def _checked_parameters(parameters: Sequence[Any]) -> tuple[str, ...]:
    if isinstance(parameters, str) or not hasattr(parameters, "__iter__"):
        raise InputError("expected a list of parameters, such as [t]", where="parameters")
    known = tuple(checked_parameter(name, "parameters") for name in parameters)
    if not known or len(set(known)) < len(known):
        raise InputError(
            f"expected at least one parameter and none twice, found {known}", where="parameters"
        )
    return tuple(sorted(known))


def values_by_name(values: Mapping[Any, Any], known: tuple[str, ...], where: str) -> dict[str, Any]:
    """The values of a mapping whose keys are symbols or names of parameters."""
    if not isinstance(values, Mapping):
        raise InputError(
            f"expected a mapping from parameters, such as {{{known[0]!r}: …}}, "
            f"found {shown_value(values)}",
            where=where,
        )
    by_name = {str(key): value for key, value in values.items()}
    for name in by_name:
        if name not in known:
            raise InputError(
                f"unknown parameter {quoted(name)}{nearest(name, known)}; "
                f"the parameters are {', '.join(known)}",
                where=where,
            )
    return by_name


def _checked_ranges(
    assume: Mapping[Any, tuple[Any, Any]], known: tuple[str, ...]
) -> tuple[Range, ...]:
    assumed = values_by_name(assume, known, "assume")
    ranges: list[Range] = []
    for name in known:
        where = f"assume[{name}]"
        bounds = list(assumed.get(name, (None, None)))
        if len(bounds) != 2:
            raise InputError(f"expected two ends, found {len(bounds)}", where=where)
        low, high = (None if end is None else as_fraction(end, where=where) for end in bounds)
        require_ascending(low, high, where)
        ranges.append((low, high))
    return tuple(ranges)


def require_ascending(low: Fraction | None, high: Fraction | None, where: str) -> None:
    """Refuse ends of a range of which the first is above the second.

    Raises
    ------
    InputError
        If the first end is above the second; None stands for no bound.
    """
    if low is not None and high is not None and low > high:
        raise InputError(
            f"expected an interval, found {rational_text(low)} above {rational_text(high)}",
            where=where,
        )
