"""Controllers with other gains: their radii, and how rounding to digits moves them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from typing import Any

from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import as_fraction
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.radii import moduli


def with_gains(controller: Controller, of: Callable[[Matrix], Matrix]) -> Controller:
    """The controller with a function of each matrix of gains in its place, without set-points."""

    def made(each: LinearMap) -> LinearMap:
        return LinearMap(
            {j: of(M) for j, M in each.outputs.items()},
            {j: of(M) for j, M in each.shared.items()},
            None if each.private is None else of(each.private),
        ).without_zeros()

    def program(agent: AgentProgram) -> AgentProgram:
        first, second, third = map(made, agent.maps())
        return replace(agent, shared_update=first, private_update=second, input=third)

    return replace(controller, agents=tuple(map(program, controller.agents)))


def gain_radii(controller: Controller, part: Any) -> Controller:
    """The radii of all entries of a controller that are a part of their moduli, as a controller.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> from mcexact.model.system import MultiChannelSystem
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> [agent] = gain_radii(local_controllers(plant, [[[-3]]]), "1/100").agents
    >>> agent.input.outputs[0][0, 0]
    Fraction(3, 100)
    """
    factor = as_fraction(part, where="gains")
    return with_gains(controller, lambda M: moduli(M) * factor)


def radii_of_gains(controller: Controller, gains: Any) -> Controller | None:
    """The radii of gains, given as a part of their moduli, as a controller, or None.

    Raises
    ------
    InputError
        If a radius is negative.
    """
    if gains is None:
        return None
    radii = gains if isinstance(gains, Controller) else gain_radii(controller, gains)
    if any(x < 0 for M in radii.matrices() for _, _, x in M.nonzero()):
        raise InputError("expected radii that are at least 0", where="gains")
    return radii


def digit_radii(controller: Controller, digits: int) -> Controller:
    """The radii by which rounding to significant digits, up or down, moves entries at most.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> from mcexact.model.system import MultiChannelSystem
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> [agent] = digit_radii(local_controllers(plant, [[["-31.4"]]]), 2).agents
    >>> agent.input.outputs[0][0, 0]
    Fraction(3, 5)
    """

    def moved(x: Fraction) -> Fraction:
        low, high = rounded_ends(x, digits)
        return max(x - low, high - x)

    def radii(M: Matrix) -> Matrix:
        entries = ((i, j, moved(Fraction(x, M.denominator))) for i, j, x in M.nonzero())
        return Matrix.from_entries(M.shape, entries)

    return with_gains(controller, radii)


def rounded_ends(x: Fraction, digits: int) -> tuple[Fraction, Fraction]:
    """The numbers with so many significant digits next to one that is not 0, below and above.

    Examples
    --------
    >>> rounded_ends(Fraction(-314, 10), 2), rounded_ends(Fraction(5), 1)
    ((Fraction(-32, 1), Fraction(-31, 1)), (Fraction(5, 1), Fraction(5, 1)))
    """
    unit = _unit(abs(x), digits)
    low = x // unit * unit
    return low, low if low == x else low + unit


def _unit(x: Fraction, digits: int) -> Fraction:
    """One unit of a significant digit of a number above 0."""
    bits = x.numerator.bit_length() - x.denominator.bit_length()
    e = int(bits * 0.30103)
    while Fraction(10) ** e > x:
        e -= 1
    while Fraction(10) ** (e + 1) <= x:
        e += 1
    return Fraction(10) ** (e - digits + 1)
