"""Markov parameters of all channels at once, modulo a byte; ``proofs/transfer_graph.md``."""

from itertools import accumulate

from .budget import counted, spend
from .packed_rows import byte_sum, multiples
from .sparse import Entry, residues
from .system import System

Triples = list[tuple[int, int, int]]
"""Edges (j, i) with a power k each."""


def unseen(system: System, triples: Triples, ell: int) -> tuple[int, int, int] | None:
    """An edge (j, i, k) with C_i A^k B_j = 0 modulo ℓ, if there is one; ℓ is at most ``SMALL``.

    Each row of A^k [B_1 … B_m] is a string of bytes, and sums of rows are sums of long integers.

    Theorem ``transfer_graph.arc_rule``.
    """
    sizes = [0, *accumulate(B.ncols for B in system.B)]
    A, width = _lines(residues(system.A, ell), system.n), sizes[-1]
    outputs = [_lines(residues(C, ell), C.nrows) for C in system.C]
    power = _inputs(system, sizes, ell)
    wanted: dict[int, dict[int, list[int]]] = {}
    for j, i, k in triples:
        wanted.setdefault(k, {}).setdefault(i, []).append(j)
    for k in counted(range(max(wanted, default=-1) + 1)):
        for i, sources in wanted.get(k, {}).items():
            seen = _products(outputs[i], power, width, ell)
            spend(sum(40 + system.B[j].ncols * len(seen) for j in sources))
            for j in sources:
                if not any(any(row[sizes[j] : sizes[j + 1]]) for row in seen):
                    return j, i, k
        power = _products(A, power, width, ell)
    return None


def _inputs(system: System, sizes: list[int], ell: int) -> list[bytes]:
    """The rows of [B_1 … B_m] modulo ℓ, a byte for each column."""
    spend(system.n * (64 + sizes[-1]))
    rows = [bytearray(sizes[-1]) for _ in range(system.n)]
    for B, start in zip(system.B, sizes, strict=False):
        for a, u, x in residues(B, ell):
            rows[a][start + u] = x
    return [bytes(row) for row in rows]


def _lines(entries: list[Entry], nrows: int) -> list[list[tuple[int, int]]]:
    """The columns and values of the entries of each row."""
    spend(100 * (len(entries) + nrows))
    lines: list[list[tuple[int, int]]] = [[] for _ in range(nrows)]
    for i, j, x in entries:
        lines[i].append((j, x))
    return lines


def _products(
    lines: list[list[tuple[int, int]]], power: list[bytes], width: int, ell: int
) -> list[bytes]:
    """The rows of a product with a matrix of so many columns, modulo ℓ."""
    tables, terms = multiples(ell), sum(map(len, lines))
    spend(len(lines) * (60 + width // 8) + terms * (40 + width // 4))
    return [
        byte_sum((power[j].translate(tables[x]) for j, x in line), width, ell) for line in lines
    ]
