"""The user's plant: read from a certificate or a system file, and its digest."""

from __future__ import annotations

import hashlib
import json
import re
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from .arithmetic import Matrix
from .reading import (
    Limits,
    fields,
    incomplete,
    integer,
    items,
    malformed,
    names,
    parse,
    shown,
    string,
)

NUMBER = re.compile(r"-?[0-9]++(?:/[0-9]++|(?:\.[0-9]++)?(?:[eE]([+-]?[0-9]++))?)")
LARGEST_EXPONENT = 1000
LARGEST_SHAPE = 2**24


@dataclass(frozen=True)
class System:
    """x' = Ax + Σ B_i u_i, y_i = C_i x (or x(t+1) = …), and who hears whom.

    ``neighbors[i]`` is N_i in the order of the channels, i in it, or there is no graph at all;
    ``delays[i, j]`` is d_ij where it is not 0.  ``words`` say what system this is.
    """

    time: str
    names: list[str]
    A: Matrix
    B: list[Matrix]
    C: list[Matrix]
    neighbors: list[list[int]] | None = None
    delays: dict[tuple[int, int], int] = field(default_factory=dict)
    words: str = "the plant"

    @property
    def n(self) -> int:
        """The number of states."""
        return self.A.nrows

    @property
    def m(self) -> int:
        """The number of channels."""
        return len(self.names)


def number(value: Any, place: str) -> Fraction:
    """A number of a system file: an integer, a decimal as typed, or a string "p/q"."""
    if type(value) is int or isinstance(value, Fraction):
        return Fraction(value)
    match = NUMBER.fullmatch(value) if type(value) is str else None
    if match is None or abs(int(match[1] or "0")) > LARGEST_EXPONENT:
        malformed(place, f'expected an integer, a decimal or "p/q", found {shown(value)}')
    if re.search("/0*$", value):
        malformed(place, f"the denominator of {shown(value)} is zero")
    return Fraction(value)


def read_matrix(value: Any, place: str, nrows: int | None, ncols: int | None) -> Matrix:
    """A matrix of a system: a list of rows, or an object that lists its nonzero entries."""
    if isinstance(value, dict):
        shape, entries = fields(value, place, "shape", "entries")
        r, c = (integer(size, f"{place}.shape") for size in items(shape, f"{place}.shape", 2))
        if max(r, 1) * max(c, 1) > LARGEST_SHAPE:
            incomplete("size", f"{place}.shape", f"{r} × {c} entries are too many for this checker")
        cells: dict[tuple[int, int], Fraction] = {}
        for k, triple in enumerate(items(entries, f"{place}.entries")):
            where = f"{place}.entries[{k}]"
            i, j, entry = items(triple, where, 3)
            key = integer(i, where), integer(j, where)
            if key[0] >= r or key[1] >= c or key in cells:
                malformed(where, f"expected a position of its own inside {r} × {c}")
            cells[key] = number(entry, where)
        rows = [[cells.get((i, j), Fraction(0)) for j in range(c)] for i in range(r)]
    else:
        listed = [items(row, f"{place}[{i}]") for i, row in enumerate(items(value, place))]
        r, c = len(listed), len(listed[0]) if listed else ncols or 0
        for i, row in enumerate(listed):
            items(row, f"{place}[{i}]", c)
        rows = [
            [number(entry, f"{place}[{i}][{j}]") for j, entry in enumerate(row)]
            for i, row in enumerate(listed)
        ]
    for expected, found, what in ((nrows, r, "rows"), (ncols, c, "columns")):
        if expected not in (None, found):
            malformed(place, f"expected {expected} {what}, found {found}")
    return Matrix.of(rows, c)


def read_system(value: Any, place: str, *extra: str) -> System:
    """A system object: its matrices, names and neighbors; ``extra`` keys are ignored."""
    optional = ("neighbors", "delays", *extra)
    time, A_rows, listed, heard, waits, *_ = fields(
        value, place, "time", "A", "channels", optional=optional
    )
    string(time, f"{place}.time", "continuous", "discrete")
    A = read_matrix(A_rows, f"{place}.A", None, None)
    if A.nrows != A.ncols:
        malformed(f"{place}.A", f"expected a square matrix, found {A.nrows} × {A.ncols}")
    known, B, C = [], [], []
    if not items(listed, f"{place}.channels"):
        malformed(f"{place}.channels", "expected at least one channel, found none")
    for k, channel in enumerate(listed):
        where = f"{place}.channels[{k}]"
        B_rows, C_rows, name, D = fields(channel, where, "B", "C", optional=("name", "D"))
        known.append(string(str(k + 1) if name is None else name, f"{where}.name"))
        if not known[-1] or known.count(known[-1]) > 1:
            malformed(f"{where}.name", f"expected a name of its own, found {shown(name)}")
        B.append(read_matrix(B_rows, f"{where}.B", A.nrows, None))
        C.append(read_matrix(C_rows, f"{where}.C", None, A.nrows))
        if D is not None and not read_matrix(D, f"{where}.D", None, None).is_zero():
            malformed(f"{where}.D", "expected no feedthrough: outputs are y_i = C_i x")
    if heard is None and waits is None:
        return System(time, known, A, B, C)
    graph = _read_graph(heard, f"{place}.neighbors", known)
    return System(time, known, A, B, C, graph, _read_delays(waits, f"{place}.delays", known, graph))


def _read_graph(value: Any, place: str, known: list[str]) -> list[list[int]]:
    rows = fields(value, place, optional=tuple(known))
    sets = []
    for i, row in enumerate(rows):
        places = [
            names([j], f"{place}.{shown(known[i])}", known)[0] for j in items(row or [], place)
        ]
        if len(set(places)) < len(places):
            malformed(f"{place}.{shown(known[i])}", "expected no neighbor twice")
        sets.append(sorted({i, *places}))
    return sets


def _read_delays(
    value: Any, place: str, known: list[str], graph: list[list[int]]
) -> dict[tuple[int, int], int]:
    delays = {}
    for i, row in enumerate(fields(value or {}, place, optional=tuple(known))):
        for j, steps in enumerate(fields(row or {}, place, optional=tuple(known))):
            if steps is not None and integer(steps, place) and (i == j or j not in graph[i]):
                malformed(place, f"{shown(known[i])} does not hear {shown(known[j])}")
            delays[i, j] = steps or 0
    return {key: steps for key, steps in delays.items() if steps}


def canonical(system: System) -> dict[str, Any]:
    """The one object that stands for this plant in a certificate."""

    def rows(M: Matrix) -> Any:
        if not M.nrows and M.ncols:
            return {"shape": [0, M.ncols], "entries": []}
        return [[plain(Fraction(entry, M.denominator)) for entry in row] for row in M.rows]

    known = system.names
    channels = zip(known, system.B, system.C, strict=True)
    result: dict[str, Any] = {
        "time": system.time,
        "A": rows(system.A),
        "channels": [{"name": name, "B": rows(B), "C": rows(C)} for name, B, C in channels],
    }
    if system.neighbors is not None:
        sets = enumerate(system.neighbors)
        result["neighbors"] = {known[i]: [known[j] for j in N_i if j != i] for i, N_i in sets}
    for (i, j), steps in system.delays.items():
        result.setdefault("delays", {}).setdefault(known[i], {})[known[j]] = steps
    return result


def plain(value: Fraction) -> int | str:
    """A rational as JSON: an integer, or "p/q" in lowest terms."""
    return value.numerator if value.denominator == 1 else f"{value.numerator}/{value.denominator}"


def digest(system: System) -> str:
    """The SHA-256 of the canonical object: sorted keys, no blanks, non-ASCII characters escaped."""
    text = json.dumps(canonical(system), sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode("ascii")).hexdigest()


def read_plant(value: Any) -> System:
    """The system object of a certificate, which must be canonical."""
    system = read_system(value, "system")
    if canonical(system) != value:
        malformed("system", "expected the canonical form (lowest terms, neighbors in order, …)")
    return system


def read_system_file(data: bytes, limits: Limits) -> System:
    """The system of a system file, numbers as typed."""
    document = parse(data, limits, decimal=lambda text: number(text, f"number {shown(text)}"))
    if not isinstance(document, dict) or document.get("format") != "mcexact-system/1":
        malformed("format", 'expected a system file, "format": "mcexact-system/1"')
    return read_system(document, "system", "format", "name", "source", "sample_time", "D")
