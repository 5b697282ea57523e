"""Static decentralized feedback, and a channel that measures the whole state."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mcexact.arguments import several
from mcexact.errors import InputError, UsageError
from mcexact.exact.blocks import vstack
from mcexact.exact.floats import Rounding, matrix_from_float
from mcexact.exact.matrix import Matrix
from mcexact.model.matrix_entry import as_matrix, require_shape
from mcexact.model.system import MultiChannelSystem


def checked_gains(
    system: MultiChannelSystem,
    gains: Sequence[Any],
    widths: Sequence[int],
    *,
    rounding: Rounding | None = None,
) -> list[Matrix]:
    """Check and return gains F_i of p_i rows and ``widths[i]`` columns as exact matrices.

    Parameters
    ----------
    system : MultiChannelSystem
    gains : sequence of m matrices
    widths : sequence of m int
    rounding : {"decimal", "dyadic"}, optional
        How floats become exact; see `MultiChannelSystem.from_float`.

    Raises
    ------
    InputError
        If the number of gains is not m, a gain has the wrong shape, or there are floats and no
        rounding.
    """
    gains = several(gains, "gains", "matrices")
    if len(gains) != system.m:
        raise InputError(f"expected {system.m} gains, found {len(gains)}", where="gains")

    def exact(F: Any, i: int) -> Matrix:
        where = f"gains[{i}]"
        if rounding is not None and not isinstance(F, Matrix):
            return matrix_from_float(F, rounding, where=where)
        return as_matrix(F, where, ncols=widths[i])

    return [
        require_shape(exact(F, i), f"gains[{i}]", system.p(i), widths[i])
        for i, F in enumerate(gains)
    ]


def closed_by(system: MultiChannelSystem, gains: Sequence[Matrix]) -> Matrix:
    """Return A_F = A + Σ B_i F_i C_i, n×n, for gains whose shapes were checked.

    Parameters
    ----------
    system : MultiChannelSystem
    gains : sequence of m Matrix
        F_i, p_i×q_i; `checked_gains` makes them of what a user gives.
    """
    fed = [F @ channel.C for channel, F in zip(system.channels, gains, strict=True)]
    return system.A + system.input_matrix() @ vstack(fed, ncols=system.n)


def feedback(system: MultiChannelSystem, gains: Sequence[Any]) -> MultiChannelSystem:
    """Close the loop u_i = F_i y_i + v_i: A_F = A + Σ B_i F_i C_i in place of A.

    Parameters
    ----------
    system : MultiChannelSystem
    gains : sequence of m matrices
        F_i is p_i×q_i.

    Returns
    -------
    MultiChannelSystem
        (A_F, B_i, C_i).

    Raises
    ------
    InputError
        If a gain has the wrong shape.

    Examples
    --------
    >>> system = MultiChannelSystem([[1]], [[[1]], [[1]]], [[[1]], [[2]]])
    >>> feedback(system, [[[-3]], [[-4]]]).A.numerators
    ((-10,),)
    """
    exact = checked_gains(system, gains, [system.q(i) for i in range(system.m)])
    return system.derived(
        closed_by(system, exact),
        [channel.B for channel in system.channels],
        [channel.C for channel in system.channels],
        {"construction": "feedback", "gains": tuple(exact)},
        neighbors=system.neighbors,
    )


def full_output(system: MultiChannelSystem, channel: int) -> MultiChannelSystem:
    """Let one channel measure the whole state: C_q becomes the n×n identity.

    Parameters
    ----------
    system : MultiChannelSystem
    channel : int
        q, counted from 0.

    Returns
    -------
    MultiChannelSystem
        It has no fixed mode, and every i with C_i ≠ 0 is reached from q, iff some F makes
        (A_F, B_q) controllable.

    Raises
    ------
    UsageError
        If there is no such channel.

    Examples
    --------
    >>> system = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    >>> full_output(system, 0).C(0).numerators
    ((1, 0), (0, 1))
    """
    if not 0 <= channel < system.m:
        raise UsageError(f"expected a channel 0 … {system.m - 1}, found {channel}")
    C = [each.C for each in system.channels]
    C[channel] = Matrix.identity(system.n)
    return system.derived(
        system.A,
        [each.B for each in system.channels],
        C,
        {"construction": "full_output", "channel": system.names[channel]},
        neighbors=system.neighbors,
    )
