"""Matrices made from those of a system, by name, over the polynomials in one or more parameters."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from mcexact.answer.parametric_rank import (
    ControllabilityMatrix,
    SetpointMatrix,
    SignalMatrix,
    TransferColumn,
)
from mcexact.exact.polynomial import Polynomial

Named = SetpointMatrix | SignalMatrix | ControllabilityMatrix | TransferColumn
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
    scale : polynomial
        δ.
    steady : int
        The mode of constant signals: 0, or in discrete time 1.
    zero : polynomial
    product : callable
        Multiplies two matrices.
    """

    names: Sequence[str]
    A: Rows
    B: Sequence[Rows]
    C: Sequence[Rows]
    widths: Sequence[int]
    scale: Any
    steady: int
    zero: Any
    product: Callable[[Rows, Rows], Rows]

    def matrix(self, named: Named) -> Rows:
        """The rows of a matrix, the rank of which is that of the same matrix from A, B_i, C_i."""
        if isinstance(named, ControllabilityMatrix):
            return self._controllability(named)
        if isinstance(named, TransferColumn):
            return self._transfer(named)
        p = Polynomial.of(-self.steady, 1)
        return self._signal(named.polynomial if isinstance(named, SignalMatrix) else p)

    def columns(self, named: Named) -> int:
        """How many columns it has."""
        if isinstance(named, TransferColumn):
            return 1
        if isinstance(named, ControllabilityMatrix):
            pairs = zip(self.names, self.widths, strict=True)
            return named.blocks * sum(width for name, width in pairs if name in named.channels)
        times = named.polynomial.degree if isinstance(named, SignalMatrix) else 1
        return times * (len(self.A) + sum(self.widths))

    def _signal(self, p: Polynomial) -> Rows:
        """[I⊗A' − K⊗δI, I⊗B'; I⊗C', 0], K the companion matrix of p."""
        d, n, width = p.degree, len(self.A), sum(self.widths)
        inputs = [[entry for M in self.B for entry in M[k]] for k in range(n)]
        outputs = [row for M in self.C for row in M]
        upper, lower = [], []
        for i in range(d):
            for k, row in enumerate(self.A):
                made = [self.zero] * (d * (n + width))
                made[i * n : (i + 1) * n] = row
                if i:
                    made[(i - 1) * n + k] = made[(i - 1) * n + k] - self.scale
                last = (d - 1) * n + k
                c = p.coefficients[i]
                made[last] = made[last] + self.scale * c.numerator / c.denominator
                made[d * n + i * width : d * n + (i + 1) * width] = inputs[k]
                upper.append(made)
            for row in outputs:
                made = [self.zero] * (d * (n + width))
                made[i * n : (i + 1) * n] = row
                lower.append(made)
        return upper + lower

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
