"""Coordinates in which the loop of a distributed observer is block upper triangular."""

from __future__ import annotations

from mcexact.exact.blocks import block, vstack
from mcexact.exact.matrix import Matrix
from mcexact.model.controller import Controller
from mcexact.synthesis.gate import Coordinates


def observer_coordinates(
    n: int, controller: Controller, Y: Matrix | None = None
) -> tuple[Coordinates, ...]:
    """Return coordinates in which the loop of a distributed observer may separate.

    Parameters
    ----------
    n : int
    controller : Controller
    Y : Matrix, k × nm, optional
        All z_i together, z, estimate Y e; by default Y is the identity, if the dimensions fit.

    Returns
    -------
    tuple of Coordinates
        The finest first; none if an agent shares something other than a state estimate.

    Notes
    -----
    With e_i = x_i − x, and w = Y e − z, Y = I for an observer of full order::

        (x, e, w):  ⎡ A + Σ B_i F_i     *       *   ⎤      (x, e, z):  ⎡ A + Σ B_i F_i   *  ⎤
                    ⎢      0         E − B̃G     *   ⎥                  ⎣      0         M_E ⎦
                    ⎣      0            0    E − LC̃ ⎦

    The first form applies if channel q has an observer of the errors, the second to every
    distributed observer.
    """
    if any(agent.shared != n for agent in controller.agents):
        return ()
    private = [agent.private for agent in controller.agents]
    if Y is None and sum(private) == n * len(private):
        Y = Matrix.identity(sum(private))
    fine = () if Y is None else (_coordinates(n, private, Y),)
    return (*fine, _coordinates(n, private, None))


def _coordinates(n: int, private: list[int], Y: Matrix | None) -> Coordinates:
    """(x, e, w), or (x, e, z) without Y, for the state (x, x_1, z_1, …)."""
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
    sizes = (n, n * m + order) if Y is None else (n, n * m, order)
    return Coordinates(T.take(rows=places), inverse.take(cols=places), sizes)
