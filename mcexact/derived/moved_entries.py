"""Constructions that only put entries elsewhere, applied to systems with parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import count

from mcexact.errors import UsageError
from mcexact.exact.function_matrix import FunctionMatrix
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational_function import RationalFunction
from mcexact.model.parametric import ParametricSystem
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


def _number(
    entry: RationalFunction, known: dict[int, RationalFunction], free: Iterator[int]
) -> int:
    """0 for 0, and else a number that stands for the entry from now on."""
    if entry.is_constant and entry.value == 0:
        return 0
    k = next(free)
    known[k] = entry
    return k
