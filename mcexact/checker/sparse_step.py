"""Products of a row with a matrix of few entries, modulo ℓ."""

from collections.abc import Sequence
from operator import add, itemgetter, mul
from typing import Any

from . import sparse
from .arithmetic import Matrix
from .budget import spend
from .packed_rows import SMALL, byte_sum, multiples
from .sparse import Entry, SparseMatrix, entries_of, residues
from .system import System

LONG = 32
"""Columns of more entries are added up one by one."""


class SparseStep:
    """u ↦ uM modulo ℓ for an n × n matrix M, given by its residues that are not 0.

    The entries of u are in another ``order``: first the columns of at most ``LONG`` entries, those
    with the most entries first.  So the first entries of all columns are added to the second ones
    of the first columns, which have two, and so on.
    """

    def __init__(self, entries: Sequence[Entry], n: int, ell: int) -> None:
        self.ell = ell
        spend(300 * (len(entries) + n))
        columns: list[list[tuple[int, int]]] = [[] for _ in range(n)]
        for i, j, x in entries:
            columns[j].append((i, x))
        sizes = [(len(column) > LONG, -len(column), j) for j, column in enumerate(columns)]
        self.order = [j for _, _, j in sorted(sizes)]
        place = {j: k for k, j in enumerate(self.order)}
        ordered = [[(place[i], x) for i, x in columns[j]] for j in self.order]
        short = [column for column in ordered if len(column) <= LONG]
        self.short, self.n = len(short), n
        self.values = sorted({x for _, _, x in entries}) if ell <= SMALL else []
        slot = {x: k * n for k, x in enumerate(self.values)}
        self.layers: list[tuple[Any, list[int]]] = []
        for e in range(len(short[0]) if short else 0):
            layer = [column[e] for column in short if len(column) > e]
            places = [i + slot.get(x, 0) for i, x in layer]
            # of two places or more a tuple is made; those at the end are not looked at
            self.layers.append((itemgetter(*places, 0, 0), [x for _, x in layer]))
        self.long = [
            (itemgetter(*(i for i, _ in column)), [x for _, x in column])
            for column in ordered[self.short :]
        ]
        self.units = 1000 + len(entries) * (1 if self.values else 4) + n * len(self.values) // 32

    def start(self, row: Sequence[int]) -> Sequence[int]:
        """A row in the order of the entries here."""
        placed = [row[j] for j in self.order]
        return bytes(placed) if self.ell <= SMALL else placed

    def __call__(self, u: Sequence[int]) -> Sequence[int]:
        """The product with a row; ``units`` is what it takes."""
        long = [sum(map(mul, gather(u), xs)) % self.ell for gather, xs in self.long]
        if isinstance(u, bytes):
            return self._added(u) + bytes(long)
        total = [0] * self.short
        for gather, xs in self.layers:
            part = list(map(mul, gather(u), xs))
            total[: len(part)] = map(add, total, part)
        return [x % self.ell for x in total] + long

    def _added(self, u: bytes) -> bytes:
        """The short columns: multiples of u, looked up, and added."""
        tables = multiples(self.ell)
        products = b"".join(u.translate(tables[x]) for x in self.values)
        layers = (bytes(gather(products)[: len(xs)]) for gather, xs in self.layers)
        return byte_sum(layers, self.short, self.ell)


def loop_entries(system: System, gains: Sequence[Matrix], ell: int) -> list[Entry] | None:
    """The residues of A + Σ B_i F_i C_i that are not 0; None if there may be many, for some F."""
    A, n = system.A, system.n
    if not isinstance(A, SparseMatrix):
        return None
    ports = [(entries_of(B), entries_of(C)) for B, C in zip(system.B, system.C, strict=True)]
    most = len(A.entries) + sum(len(B) * len(C) for B, C in ports)
    if sparse.SHARE * most > n * n:
        return None
    spend(200 * (most + system.m))
    found = {(i, j): x for i, j, x in residues(A, ell)}
    for B, F, C in zip(system.B, gains, system.C, strict=True):
        inputs, outputs, gain = residues(B, ell), residues(C, ell), F.modulo(ell)
        for a, g, x in inputs:
            for h, b, y in outputs:
                found[a, b] = (found.get((a, b), 0) + x * gain[g][h] * y) % ell
    return [(i, j, x) for (i, j), x in found.items() if x]
