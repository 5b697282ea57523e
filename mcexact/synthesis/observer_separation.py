"""Coordinates in which the loop of a distributed observer is block upper triangular."""

from __future__ import annotations

from mcexact.analysis.stability import Separation
from mcexact.exact.blocks import block, vstack
from mcexact.exact.matrix import Matrix
from mcexact.model.controller import Controller


def observer_separation(
    M: Matrix, n: int, controller: Controller, Y: Matrix | None = None
) -> Separation | None:
    """The separation of a loop made of a plant, m estimates of its state and a channel controller.

    Parameters
    ----------
    M : Matrix
        The matrix of the loop, state (x, x_1, z_1, …, x_m, z_m).
    n : int
        States of the plant.
    controller : Controller
    Y : Matrix, k × nm, optional
        z, all z_i together, estimates Y e; by default the identity, where the dimensions fit.

    Returns
    -------
    Separation or None
        None if the loop does not separate.

    Notes
    -----
    With e_i = x_i − x, and w = Y e − z, Y = I for an observer of full order::

        (x, e, w):  ⎡ A + Σ B_i F_i     *       *   ⎤      (x, e, z):  ⎡ A + Σ B_i F_i   *  ⎤
                    ⎢      0         E − B̃G     *   ⎥                  ⎣      0         M_E ⎦
                    ⎣      0            0    E − LC̃ ⎦

    The first where channel q has an observer of the errors; the second for every distributed
    observer.  Whether the blocks below are 0 is decided exactly.
    """
    if any(agent.shared != n for agent in controller.agents):
        return None
    private = [agent.private for agent in controller.agents]
    m, order = len(private), sum(private)
    if M.nrows != n + n * m + order:
        return None
    if Y is None and order == n * m:
        Y = Matrix.identity(order)
    for estimated in (Y, None):
        T, inverse = _coordinates(n, private, estimated)
        Delta = inverse @ (M @ T)
        sizes = (n, n * m + order) if estimated is None else (n, n * m, order)
        if _is_block_triangular(Delta, sizes):
            return Separation(T, Delta, tuple(size for size in sizes if size), inverse)
    return None


def _coordinates(n: int, private: list[int], Y: Matrix | None) -> tuple[Matrix, Matrix]:
    """T from (x, e, w), or (x, e, z) without Y, to (x, x_1, z_1, …), and its inverse."""
    m, order = len(private), sum(private)
    same = vstack([Matrix.identity(n)] * m, ncols=n)
    x, e, z = Matrix.identity(n), Matrix.identity(n * m), Matrix.identity(order)
    if Y is None:
        lower, sign, driven = Matrix.zeros(order, n * m), z, Matrix.zeros(order, n)
    else:
        lower, sign, driven = Y, -z, -(Y @ same)
    right = [Matrix.zeros(rows, order) for rows in (n, n * m)]
    T = block(
        [
            [x, Matrix.zeros(n, n * m), right[0]],
            [same, e, right[1]],
            [Matrix.zeros(order, n), lower, sign],
        ]
    )
    inverse = block(
        [
            [x, Matrix.zeros(n, n * m), right[0]],
            [-same, e, right[1]],
            [driven, lower, sign],
        ]
    )
    places, hidden = list(range(n)), n + n * m
    for i, k in enumerate(private):
        places += [*range(n + n * i, n + n * (i + 1)), *range(hidden, hidden + k)]
        hidden += k
    return T.take(rows=places), inverse.take(cols=places)


def _is_block_triangular(Delta: Matrix, sizes: tuple[int, ...]) -> bool:
    """Whether everything below the diagonal blocks is 0."""
    start = 0
    for size in sizes:
        stop = start + size
        if any(any(row[start:stop]) for row in Delta.numerators[stop:]):
            return False
        start = stop
    return True
