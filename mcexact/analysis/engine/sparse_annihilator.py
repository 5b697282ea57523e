"""What channels of a large sparse system do not control, by products with sparse matrices.

Let h be the common divisor of the minimal polynomials of two closed loops whose feedback moves all
that the channels control, and m = h g that of A_F, g coprime to h.  Then the rows of g(A_F) span
the annihilator W of what they control.
"""

from __future__ import annotations

from itertools import islice
from typing import TYPE_CHECKING, Any

from mcexact.analysis.engine.sparse_loops import (
    MOST_COLUMNS,
    MOST_PRIMES,
    drawn_loop,
    exact_primes,
)
from mcexact.derived.modular import generator
from mcexact.exact.krylov import SparsePowers, row_echelon
from mcexact.exact.matrix import Matrix, from_cells
from mcexact.exact.modular import combine, rationals
from mcexact.model.system import MultiChannelSystem

if TYPE_CHECKING:
    import random


def annihilator(system: MultiChannelSystem, size: int) -> tuple[Matrix, tuple[int, ...]] | None:
    """The W of so many rows with WA = ZW and WB = 0, B all inputs, if it is found.

    Parameters
    ----------
    system : MultiChannelSystem
        Its closed loops are sparse, and its outputs such that all that is controlled is moved.
    size : int
        n − d, at least 1.

    Returns
    -------
    W : Matrix
        n − d rows; the columns ``pivots`` form the identity.
    pivots : tuple of int
    """
    if size > MOST_COLUMNS:
        return None
    rng = generator(system, "controllability")
    known: tuple[tuple[int, ...], list[list[int]], int] | None = None
    for ell in islice(exact_primes(system, rng), MOST_PRIMES):
        rows, pivots = _residues(system, size, ell, rng)
        if len(pivots) != size:
            continue
        table: list[list[int]] = rows.tolist()
        if known is not None and known[0] == pivots:
            table, ell = combine(known[1], known[2], table, ell), known[2] * ell
        known = pivots, table, ell
        lifted = rationals(table, ell)
        W = None if lifted is None else _matrix(*lifted, system.n)
        if W is not None and _annihilates(system, W, pivots):
            return W, pivots
    return None


def _residues(
    system: MultiChannelSystem, size: int, ell: int, rng: random.Random
) -> tuple[Any, tuple[int, ...]]:
    """The row space of g(A_F) modulo ℓ, as far as one vector more than it should have shows it."""
    import numpy as np

    first, second = (drawn_loop(system, ell, rng) for _ in range(2))
    g = first.polynomial // first.polynomial.gcd(second.polynomial)
    turned = SparsePowers(first.powers.M.T.tocsr(), ell)
    drawn = [[rng.randrange(ell) for _ in range(size + 1)] for _ in range(system.n)]
    return row_echelon(turned.applied(g, np.array(drawn)).T, ell)


def _matrix(numerators: list[list[int]], denominator: int, n: int) -> Matrix:
    entries = [(i * n + j, x) for i, row in enumerate(numerators) for j, x in enumerate(row) if x]
    cells, values = [cell for cell, _ in entries], [x for _, x in entries]
    return from_cells((len(numerators), n), cells, values, denominator)


def _annihilates(system: MultiChannelSystem, W: Matrix, pivots: tuple[int, ...]) -> bool:
    image = W @ system.A
    stays = (image - image.take(cols=pivots) @ W).is_zero()
    return stays and (W @ system.input_matrix()).is_zero()
