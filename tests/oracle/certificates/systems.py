"""Multi-channel systems, read from the object ``system`` of a certificate."""

from __future__ import annotations

import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from flint import fmpq_mat

from . import algebra
from .reading import demand, integer, listed, place, rational, record, table, text

HIDDEN = ("Cc", "Cf", "Cs", "Zl", "Zp")
"""The Unicode categories of characters that do not print."""

Radii = tuple[fmpq_mat, list[fmpq_mat], list[fmpq_mat]]
"""Of A, of all B_i and of all C_i."""


@dataclass(frozen=True)
class System:
    """ẋ = A x + Σ B_i u_i, y_i = C_i x (discrete time: x(t+1)).

    Attributes
    ----------
    neighborhoods : list of lists of int, optional
        N_i for each i, with i in it, in the order of the channels; None without neighbor graph.
    delays : mapping
        d_ij under (i, j), where it is not 0.
    radii : matrices, optional
        Of A, of all B_i and of all C_i; None where all entries are certain.
    D : matrix, optional
        The feedthrough of all inputs to all outputs; None where it is 0.
    """

    time: str
    A: fmpq_mat
    names: tuple[str, ...]
    B: tuple[fmpq_mat, ...]
    C: tuple[fmpq_mat, ...]
    neighborhoods: tuple[tuple[int, ...], ...] | None = None
    delays: Mapping[tuple[int, int], int] = field(default_factory=dict)
    radii: Radii | None = None
    D: fmpq_mat | None = None

    @property
    def n(self) -> int:
        """The number of states."""
        return int(self.A.nrows())

    @property
    def m(self) -> int:
        """The number of channels."""
        return len(self.names)

    def inputs(self, channels: Sequence[int] | None = None) -> fmpq_mat:
        """B of the channels named, side by side; of all by default."""
        chosen = range(self.m) if channels is None else channels
        return algebra.beside([self.B[i] for i in chosen], self.n)

    def outputs(self, channels: Sequence[int] | None = None) -> fmpq_mat:
        """C of the channels named, below each other; of all by default."""
        chosen = range(self.m) if channels is None else channels
        return algebra.below([self.C[i] for i in chosen], self.n)

    def graph(self) -> tuple[tuple[int, ...], ...]:
        """The neighbor graph, which the system must have."""
        demand(self.neighborhoods is not None, "expected a system with a neighbor graph")
        return self.neighborhoods or ()

    def between(self, outputs: Sequence[int], inputs: Sequence[int]) -> fmpq_mat | None:
        """The feedthrough from the inputs of some channels to the outputs of some."""
        if self.D is None:
            return None
        q, p = [C.nrows() for C in self.C], [B.ncols() for B in self.B]
        whole = self.D.tolist()
        rows = [whole[sum(q[:i]) + k] for i in outputs for k in range(q[i])]
        columns = [sum(p[:j]) + k for j in inputs for k in range(p[j])]
        cells = [row[j] for row in rows for j in columns]
        D = fmpq_mat(len(rows), len(columns), cells)
        return D if any(cell != 0 for cell in cells) else None

    def plain(self) -> System:
        """The same system without a neighbor graph."""
        return replace(self, neighborhoods=None, delays={})


def read_plant(value: Any) -> System:
    """The user's plant."""
    found = record(
        value, "time", "A", "channels", optional=("D", "neighbors", "delays", "uncertainty")
    )
    demand(found["time"] in ("continuous", "discrete"), "expected a time domain")
    A = table(found["A"], None, None)
    n = A.nrows()
    demand(A.ncols() == n, "expected a square matrix")
    channels = [record(c, "name", "B", "C") for c in listed(found["channels"])]
    names = tuple(text(c["name"]) for c in channels)
    require_names(names)
    B = tuple(table(c["B"], n, None) for c in channels)
    C = tuple(table(c["C"], None, n) for c in channels)
    neighborhoods = _graph(found["neighbors"], names) if "neighbors" in found else None
    delays = _delays(found["delays"], names, neighborhoods) if "delays" in found else {}
    radii = None
    if "uncertainty" in found:
        radii = _radii(record(found["uncertainty"], "absolute")["absolute"], names, A, B, C)
    D = None
    if "D" in found:
        p, q = sum(M.ncols() for M in B), sum(M.nrows() for M in C)
        D = table(found["D"], q, p)
        demand(any(x != 0 for x in D.entries()), "expected a feedthrough that is not 0")
        demand(radii is None, "expected no radii beside a feedthrough")
    return System(found["time"], A, names, B, C, neighborhoods, delays, radii, D)


def _radii(value: Any, names: Sequence[str], A: fmpq_mat, B: Any, C: Any) -> Radii:
    """The radii, of which those that are 0 are left out."""
    found = record(value, optional=("A", "B", "C"))
    demand(bool(found) and all(found.values()), "expected no empty part")
    ports = [
        [_listed_radii(part.get(name), M) for name, M in zip(names, matrices, strict=True)]
        for part, matrices in (
            (record(found.get("B", {}), optional=names), B),
            (record(found.get("C", {}), optional=names), C),
        )
    ]
    return _listed_radii(found.get("A"), A), ports[0], ports[1]


def _listed_radii(value: Any, nominal: fmpq_mat) -> fmpq_mat:
    """The radii of one matrix, by their positions."""
    M = fmpq_mat(nominal.nrows(), nominal.ncols())
    if value is not None:
        found = record(value, "shape", "entries")
        shape = [integer(side, 0) for side in listed(found["shape"], 2)]
        demand(shape == [M.nrows(), M.ncols()], "expected the shape of the matrix")
        entries = [listed(entry, 3) for entry in listed(found["entries"])]
        places = [(integer(i, 0), integer(j, 0)) for i, j, _ in entries]
        demand(bool(places) and places == sorted(set(places)), "expected sorted positions")
        for (i, j), (_, _, radius) in zip(places, entries, strict=True):
            demand(i < M.nrows() and j < M.ncols(), "expected positions inside")
            M[i, j] = rational(radius)
            demand(M[i, j] > 0, "expected a radius above 0")
    return M


def require_names(names: Sequence[str]) -> None:
    """Names that print, of which no two look alike."""
    demand(bool(names), "expected at least one channel")
    for name in names:
        printing = all(unicodedata.category(c) not in HIDDEN for c in name)
        demand(1 <= len(name) <= 256 and printing, "expected a name that prints")
    forms = {unicodedata.normalize("NFC", name) for name in names}
    demand(len(forms) == len(names), "expected different names")


def _graph(value: Any, names: Sequence[str]) -> tuple[tuple[int, ...], ...]:
    found = record(value, *names)
    neighborhoods = []
    for i, name in enumerate(names):
        others = [place(j, names) for j in listed(found[name])]
        demand(others == sorted(set(others)) and i not in others, "expected sorted neighbors")
        neighborhoods.append(tuple(sorted({i, *others})))
    return tuple(neighborhoods)


def _delays(value: Any, names: Sequence[str], neighborhoods: Any) -> dict[tuple[int, int], int]:
    demand(isinstance(value, Mapping), "expected delays")
    demand(neighborhoods is not None or not value, "expected delays along links")
    found = {}
    for receiver, row in value.items():
        i = place(receiver, names)
        demand(isinstance(row, Mapping), "expected delays")
        for sender, steps in row.items():
            j = place(sender, names)
            demand(j in neighborhoods[i] and j != i, "expected a delay along a link")
            found[i, j] = integer(steps, 1)
    return found
