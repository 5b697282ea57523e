"""Matrices made from those of a system, by name, over the polynomials in one or more parameters."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from mcexact.answer.parametric_rank import (
    ControllabilityMatrix,
    SetpointMatrix,
    TransferColumn,
)

Named = SetpointMatrix | ControllabilityMatrix | TransferColumn
Rows = list[list[Any]]


@dataclass(frozen=True)
class Entries:
    """A', B_i' and C_i' by their entries, polynomials of one ring, and how these are multiplied.

    Attributes
    ----------
    names : sequence of str
        The channels.
    A, B, C
        The rows of A', and of each B_i' and C_i'.
    widths : sequence of int
        The number of columns of each B_i'.
    shift : polynomial
        What is subtracted on the diagonal of A' for equilibria: 0, or in discrete time δ.
    zero : polynomial
    product : callable
        Multiplies two matrices.
    """

    names: Sequence[str]
    A: Rows
    B: Sequence[Rows]
    C: Sequence[Rows]
    widths: Sequence[int]
    shift: Any
    zero: Any
    product: Callable[[Rows, Rows], Rows]

    def matrix(self, named: Named) -> Rows:
        """The rows of a matrix, the rank of which is that of the same matrix from A, B_i, C_i."""
        if isinstance(named, ControllabilityMatrix):
            return self._controllability(named)
        if isinstance(named, TransferColumn):
            return self._transfer(named)
        width = sum(self.widths)
        upper = [
            [entry - self.shift if i == j else entry for j, entry in enumerate(row)]
            + [entry for M in self.B for entry in M[i]]
            for i, row in enumerate(self.A)
        ]
        return upper + [[*row, *[self.zero] * width] for M in self.C for row in M]

    def columns(self, named: Named) -> int:
        """How many columns it has."""
        if isinstance(named, TransferColumn):
            return 1
        if isinstance(named, ControllabilityMatrix):
            pairs = zip(self.names, self.widths, strict=True)
            return named.blocks * sum(width for name, width in pairs if name in named.channels)
        return len(self.A) + sum(self.widths)

    def _controllability(self, named: ControllabilityMatrix) -> Rows:
        chosen = [B for B, name in zip(self.B, self.names, strict=True) if name in named.channels]
        power = [[entry for M in chosen for entry in M[k]] for k in range(len(self.A))]
        rows: Rows = [[] for _ in self.A]
        for _ in range(named.blocks):
            rows = [row + more for row, more in zip(rows, power, strict=True)]
            power = self.product(self.A, power)
        return rows

    def _transfer(self, named: TransferColumn) -> Rows:
        power = self.B[self.names.index(named.source)]
        outputs, found = self.C[self.names.index(named.to)], []
        for _ in self.A:
            columns = zip(*self.product(outputs, power), strict=True)
            found += [[entry] for column in columns for entry in column]
            power = self.product(self.A, power)
        return found
