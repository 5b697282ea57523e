"""Coordinates in which the loop of a distributed observer is block upper triangular."""

from __future__ import annotations

from mcexact.analysis.stability import Separation
from mcexact.exact.matrix import Matrix
from mcexact.model.controller import Controller


def observer_separation(M: Matrix, n: int, controller: Controller) -> Separation | None:
    """The separation of a loop made of a plant, m estimates of its state and a channel controller.

    Parameters
    ----------
    M : Matrix
        The matrix of the loop, state (x, x_1, z_1, …, x_m, z_m).
    n : int
        States of the plant.
    controller : Controller

    Returns
    -------
    Separation or None
        None if the loop does not separate.

    Notes
    -----
    With e_i = x_i − x, and w = e − z if z, all z_i together, has the dimension of e::

        (x, e, w):  ⎡ A + Σ B_i F_i     *       *   ⎤      (x, e, z):  ⎡ A + Σ B_i F_i   *  ⎤
                    ⎢      0         E − B̃G    B̃G   ⎥                  ⎣      0         M_E ⎦
                    ⎣      0            0    E − LC̃ ⎦

    The first where channel q has an observer of the errors, z' = (E − B̃G − LC̃) z + L ỹ and
    ũ = −G z; the second for every distributed observer.  Whether the blocks below are 0 is
    decided exactly.
    """
    if any(agent.shared != n for agent in controller.agents):
        return None
    private = [agent.private for agent in controller.agents]
    m, order = len(private), sum(private)
    if M.nrows != n + n * m + order:
        return None
    for observed in (True, False):
        if observed and order != n * m:
            continue
        T, inverse = _coordinates(n, private, observed=observed)
        Delta = inverse @ (M @ T)
        sizes = (n, n * m, order) if observed else (n, n * m + order)
        if _is_block_triangular(Delta, sizes):
            return Separation(T, Delta, tuple(size for size in sizes if size), inverse)
    return None


def _coordinates(n: int, private: list[int], *, observed: bool) -> tuple[Matrix, Matrix]:
    """T from (x, e, w) or (x, e, z) to (x, x_1, z_1, …), and its inverse."""
    m, total = len(private), n + n * len(private) + sum(private)
    rows: list[dict[int, int]] = [{i: 1} for i in range(n)]
    back: list[dict[int, int]] = [{i: 1} for i in range(n)] + [{} for _ in range(total - n)]
    first = hidden = n + n * m
    for i, k in enumerate(private):
        for a in range(n):
            back[n + n * i + a] = {len(rows): 1, a: -1}
            rows.append({a: 1, n + n * i + a: 1})
        for _ in range(k):
            if observed:
                back[hidden] = {len(rows): -1}
                rows.append({hidden - first + n: 1, hidden: -1})
            else:
                back[hidden] = {len(rows): 1}
                rows.append({hidden: 1})
            hidden += 1
    if observed:
        for a in range(first, total):
            back[a] |= back[n + a - first]
    return _filled(rows, total), _filled(back, total)


def _filled(rows: list[dict[int, int]], size: int) -> Matrix:
    """The square matrix with these entries."""
    return Matrix.from_integers([[row.get(j, 0) for j in range(size)] for row in rows], ncols=size)


def _is_block_triangular(Delta: Matrix, sizes: tuple[int, ...]) -> bool:
    """Whether everything below the diagonal blocks is 0."""
    start = 0
    for size in sizes:
        stop = start + size
        if any(any(row[start:stop]) for row in Delta.numerators[stop:]):
            return False
        start = stop
    return True
