"""Matrices, polynomials and gains as a witness writes them."""

from __future__ import annotations

import math
import random
from typing import Any

from flint import fmpq, fmpq_mat, fmpq_poly

from tests.oracle.certificates.systems import System
from tests.oracle.drawn.plants import Document
from tests.oracle.drawn.subjects import text_of

PRIME = 2305843009213693951


def written(M: fmpq_mat) -> Document:
    """Integers over one denominator."""
    rows = M.tolist()
    d = math.lcm(1, *(int(v.q) for row in rows for v in row))
    return {
        "denominator": d,
        "entries": [[int(v.p) * (d // int(v.q)) for v in row] for row in rows],
    }


def coefficients(p: fmpq_poly) -> list[Any]:
    """A polynomial, constant term first."""
    return [text_of(c) for c in p.coeffs()]


def zeros(nrows: int, ncols: int) -> Document:
    """A matrix of zeros."""
    return {"denominator": 1, "entries": [[0] * ncols for _ in range(nrows)]}


def unit(n: int) -> Document:
    """The identity matrix."""
    return {"denominator": 1, "entries": [[int(i == j) for j in range(n)] for i in range(n)]}


def drawn(rng: random.Random, nrows: int, ncols: int, bound: int = 10**6) -> Document:
    """A matrix of drawn integers."""
    rows = [[rng.randint(-bound, bound) for _ in range(ncols)] for _ in range(nrows)]
    return {"denominator": 1, "entries": rows}


def drawn_gains(rng: random.Random, system: System) -> list[Document]:
    """A drawn F_i for every channel."""
    return [drawn(rng, B.ncols(), C.nrows()) for B, C in zip(system.B, system.C, strict=True)]


def left_kernel(M: fmpq_mat) -> tuple[fmpq_mat, list[int]]:
    """Rows that annihilate M, with an identity matrix in the columns that are given."""
    n = M.nrows()
    reduced, rank = M.transpose().rref()
    rows = reduced.tolist()[:rank]
    leading = [next(j for j in range(n) if row[j] != 0) for row in rows]
    free = [j for j in range(n) if j not in leading]
    entries = []
    for f in free:
        line = [fmpq(int(j == f)) for j in range(n)]
        for row, j in zip(rows, leading, strict=True):
            line[j] = -row[f]
        entries += line
    return fmpq_mat(len(free), n, entries), free


def names_of(system: System, positions: Any) -> list[str]:
    """Names of channels."""
    return [system.names[i] for i in positions]
