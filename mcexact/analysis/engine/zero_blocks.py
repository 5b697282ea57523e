"""Zero blocks, which prove that a mode of a system with a parameter is fixed.

A set T of channels and matrices W, U over R = Q[t]/(q)[x]/(p), or Q[t][x]/(p), with

    W (xI − A) U = 0,   W B_T = 0,   C_i U = 0 for every i outside T

and more than n rows of W and columns of U together, independent, prove that p divides det(xI − A_F)
over R for every F: λI − A_F has a zero block that is too large.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import Any

from mcexact.analysis.engine.shrunk_subspace import obstruction_modulo
from mcexact.answer.evidence import ZeroBlock
from mcexact.derived.modular import PolynomialSystem, drawn_gains
from mcexact.errors import InternalError
from mcexact.exact.bivariate import (
    Bivariate,
    Element,
    Kernel,
    Tower,
    X,
    denominators,
    entries_of,
    line,
    matrix_of,
    modulus_at,
    over_functions,
    roots_modulo,
)
from mcexact.exact.modular import primes

_BITS = 60
_TRIES = 2000


def responsible_channels(
    system: PolynomialSystem, q: Any, p: Bivariate, rng: random.Random
) -> tuple[int, ...] | None:
    """T for the roots of p at the roots of q, or None if these are not fixed.

    Gains that move a root modulo a prime move it; so None is proved.
    """
    stream = primes(rng.getrandbits(64), _BITS)
    for _ in range(_TRIES):
        ell = next(stream)
        if not system.is_defined_modulo(ell) or any(d % ell == 0 for d in denominators([q, *p])):
            continue
        for tau, mu in roots_modulo(q, p, ell):
            modular = system.modulo(tau, ell)
            found = obstruction_modulo(modular, drawn_gains(modular, rng), mu)
            return None if found is None else found.channels_T
    raise InternalError("no prime has roots of both polynomials")


def zero_block(
    system: PolynomialSystem, T: Sequence[int], q: Any, p: Bivariate
) -> ZeroBlock | None:
    """The zero block for T over Q[t]/(q)[x]/(p), or None if T proves nothing there."""
    entries = _Entries(system, T)
    columns, W = Tower(q, X).kernel([[[e] for e in row] for row in entries.inputs], system.n)
    rows, U = Tower(q, p).kernel(entries.pencil([[e[0] for e in w] for w in W], q), system.n)
    return _block(system, T, rows, U, columns, W, len(p) - 1)


def generic_zero_block(
    system: PolynomialSystem, T: Sequence[int], p: Bivariate
) -> ZeroBlock | None:
    """The zero block for T over Q[t][x]/(p), or None if T proves nothing there."""
    entries, n = _Entries(system, T), system.n

    def left(t: int) -> Kernel:
        return Tower(line(t), X).kernel([[[e] for e in row] for row in entries.inputs], n)

    columns, W = over_functions(left)
    functions = [[e[0] for e in w] for w in W]

    def right(t: int) -> Kernel | None:
        value = modulus_at(p, t)
        if value is None:
            return None
        return Tower(line(t), value).kernel(entries.pencil(functions, line(t)), n)

    rows, U = over_functions(right)
    return _block(system, T, rows, U, columns, W, len(p) - 1)


def _block(
    system: PolynomialSystem,
    T: Sequence[int],
    rows: tuple[int, ...],
    U: list[list[Element]],
    columns: tuple[int, ...],
    W: list[list[Element]],
    degree: int,
) -> ZeroBlock | None:
    if len(rows) + len(columns) <= system.n:
        return None
    layers = tuple(
        matrix_of([[u[i][k] for u in U] for i in range(system.n)], len(U)) for k in range(degree)
    )
    return ZeroBlock(
        channels_T=tuple(system.system.names[i] for i in T),
        U=layers,
        W=matrix_of([[e[0] for e in w] for w in W], system.n),
        row_pivots=rows,
        column_pivots=columns,
    )


class _Entries:
    """The entries of B_T', A and C_s as polynomials of flint, s the complement of T."""

    def __init__(self, system: PolynomialSystem, T: Sequence[int]) -> None:
        self.n = system.n
        self.A = entries_of(system.A)
        self.inputs = [
            list(column) for i in T for column in zip(*entries_of(system.B[i]), strict=True)
        ]
        self.C = [
            row for i in range(system.m) if i not in set(T) for row in entries_of(system.C[i])
        ]

    def pencil(self, W: list[list[Any]], q: Any) -> list[list[Element]]:
        """The rows of [W (xI − A); C_s]."""
        rows: list[list[Element]] = []
        for w in W:
            used = [(k, c) for k, c in enumerate(w) if c != 0]
            row = []
            for j in range(self.n):
                total = 0 * w[j]
                for k, c in used:
                    total = total - c * self.A[k][j]
                row.append([total % q, w[j] % q])
            rows.append(row)
        return rows + [[[c] for c in row] for row in self.C]
