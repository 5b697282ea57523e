"""Decentralized controllers from matrices or python-control systems, one for each channel."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mcexact.arguments import several
from mcexact.errors import FloatRefused, InputError
from mcexact.exact.floats import Rounding, matrix_from_float
from mcexact.exact.matrix import Matrix
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.matrix_entry import as_matrix, require_shape, require_square
from mcexact.model.statespace import sampling
from mcexact.model.system import MultiChannelSystem


def local_controllers(
    system: MultiChannelSystem, parts: Sequence[Any], *, rounding: Rounding | None = None
) -> Controller:
    """Make a controller from local controllers z_i' = A z_i + B y_i, u_i = C z_i + D y_i.

    Parameters
    ----------
    system : MultiChannelSystem
        m channels.
    parts : sequence of m parts
        Each part is four matrices (A, B, C, D) of shapes k×k, k×q_i, p_i×k and p_i×q_i; or a
        `control.StateSpace`; or one matrix D, a static gain.  The sign is u_i = +K y_i: negate a
        controller made for negative feedback.
    rounding : {"decimal", "dyadic"}, optional
        How floats become exact numbers; required if there are floats.

    Returns
    -------
    Controller

    Raises
    ------
    InputError
        If a shape or the number of parts is not as expected, or there are floats and no rounding.

    Examples
    --------
    >>> from mcexact.model.loop import closed_loop
    >>> plant = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    >>> controller = local_controllers(plant, [([[-5]], [[1]], [[-6]], [[0]])])
    >>> closed_loop(plant, controller).matrix.numerators
    ((0, -6), (1, -5))
    """
    InputError.require(system, MultiChannelSystem, "system")
    parts = several(parts, "parts", "controllers, one for each channel")
    if len(parts) != system.m:
        raise InputError(f"expected {system.m} controllers, found {len(parts)}", where="parts")
    agents = tuple(
        _program(system, i, part, f"parts[{i}]", rounding) for i, part in enumerate(parts)
    )
    return Controller(system.time, system.digest_of_values(), agents)


def _program(
    system: MultiChannelSystem, i: int, part: Any, where: str, rounding: Rounding | None
) -> AgentProgram:
    """Make the program of agent i, whose state is private."""
    p, q = system.p(i), system.q(i)
    if all(hasattr(part, name) for name in ("A", "B", "C", "D", "dt")):
        time, _ = sampling(part.dt, "decimal")
        if time != system.time:
            raise InputError(f"the controller is in {time} time", where=where)
        given: tuple[Any, ...] = (part.A, part.B, part.C, part.D)
    elif isinstance(part, tuple) and len(part) == 4:
        given = part
    elif isinstance(part, tuple):
        raise InputError(f"expected (A, B, C, D), found {len(part)} matrices", where=where)
    else:
        given = ((), Matrix.zeros(0, q), Matrix.zeros(p, 0), part)

    def matrix(k: int, ncols: int | None = None) -> Matrix:
        value, place = given[k], f"{where}.{'ABCD'[k]}"
        empty = hasattr(value, "__len__") and not len(value)
        if rounding is not None and not empty and not isinstance(value, Matrix):
            return matrix_from_float(value, rounding, where=place)
        try:
            return as_matrix(value, place, ncols=ncols)
        except FloatRefused:
            raise FloatRefused(
                'a float is not exact: give local_controllers the rounding "decimal", which reads '
                '0.1 as 1/10, or "dyadic", which takes the binary value',
                where=place,
            ) from None

    A = require_square(matrix(0), f"{where}.A")
    k = A.nrows
    B = require_shape(matrix(1, q), f"{where}.B", k, q)
    C = require_shape(matrix(2, k), f"{where}.C", p, k)
    D = require_shape(matrix(3, q), f"{where}.D", p, q)
    return AgentProgram(
        system.names[i],
        0,
        k,
        private_update=LinearMap({i: B}, private=A).without_zeros(),
        input=LinearMap({i: D}, private=C).without_zeros(),
    )
