"""Plants whose entries are rational functions of a parameter, and plants of either sort."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from . import budget, reading
from .arithmetic import Matrix, Polynomial, poly_divide, poly_product
from .common_factors import Terms
from .expressions import PARAMETER, common_divisor, function, function_text
from .reading import Json, Limits, fields, incomplete, integer, items, malformed, printable, string
from .several_parameters import Quotient, quotient, quotient_text
from .statement import canonical_json, digest_of
from .system import System, canonical, parse_file, read_plant, read_system
from .system_matrices import number
from .uncertainty import as_typed

Layers = list[Matrix]
"""The coefficients of a matrix of polynomials in the parameter, constant term first."""
Range = tuple[Fraction | None, Fraction | None]
"""The least and the largest value of t; None where there is none."""
Table = tuple[list[list[Any]], int]
"""Rows of functions, of one parameter or of several, and the number of columns."""
Entries = Callable[[Json, str, Limits | None], Any]
"""How an entry is read, at a place."""
ONE = [Fraction(1)]
HASHES = 150
"""What a rational costs as a part of a key."""


@dataclass(frozen=True, kw_only=True)
class FunctionSystem:
    """A plant of rational functions of parameters.

    ``ranges`` has the least and the largest value of each parameter, None where there is none.
    ``tables`` are A, B_1, C_1, B_2, … as functions, each a numerator and a denominator, and
    ``document`` is the canonical object of the plant; ``ports`` is as in `System`.
    """

    time: str
    names: list[str]
    ranges: dict[str, Range]
    tables: list[Table]
    document: Json
    neighbors: list[list[int]] | None = None
    words: str = "the plant"
    controller: str = ""
    ports: str = ""

    @property
    def n(self) -> int:
        """The number of states."""
        return len(self.tables[0][0])

    @property
    def m(self) -> int:
        """The number of channels."""
        return len(self.names)

    def number(self, value: int) -> Any:
        """A number as a function."""
        return quotient(value, "", tuple(self.ranges), None)

    def terms(self, entry: Any) -> Quotient:
        """Numerator and denominator by the exponents of the parameters."""
        found: Quotient = entry
        return found

    def remade(self, tables: list[Table], **parts: Any) -> "FunctionSystem":
        """The same with other functions."""
        return replace(self, tables=tables, **parts)


@dataclass(frozen=True, kw_only=True)
class ParametricSystem(FunctionSystem):
    """x' = A/δ x + Σ B_i/β_i u_i, y_i = C_i/γ_i x with polynomials in t in A, B_i and C_i.

    ``scale`` is δ, monic, and ``poles`` are the monic denominators of the plant: what is made of it
    is about the same values of t, even without the entries that have these denominators.
    """

    parameter: str
    range: Range
    A: Layers
    B: list[Layers]
    C: list[Layers]
    scale: Polynomial
    poles: list[Polynomial]

    def number(self, value: int) -> Any:
        """A number as a function."""
        return function(value, "", self.parameter, None)

    def terms(self, entry: Any) -> Quotient:
        """Numerator and denominator by the exponents of the parameter."""

        def of(p: Polynomial) -> Terms:
            return {(k,): c for k, c in enumerate(p) if c}

        return of(entry[0]), of(entry[1])

    def remade(self, tables: list[Table], **parts: Any) -> "FunctionSystem":
        """The same with other functions."""
        return replace(self, **cleared_tables(tables) | {"poles": self.poles}, **parts)

    def others(self, channels: list[int]) -> list[int]:
        """The channels that are not among these."""
        return [i for i in range(self.m) if i not in channels]


def plant_of(value: Json) -> System | FunctionSystem:
    """The plant of a certificate, which must be canonical."""
    if not has_parameters(value):
        return read_plant(value)
    plant = read_parametric(value)
    if plant.document != value:
        malformed("system", "expected the canonical form: lowest terms, expanded")
    return plant


def plant_of_file(data: bytes, limits: Limits) -> Json:
    """The canonical object of the plant in a system file, numbers as typed."""
    with budget.limited(budget.current(limits.work), len(data)):
        document = parse_file(data, limits)
        if not isinstance(document, dict) or document.get("format") != "mcexact-system/1":
            malformed("format", 'expected a system file, "format": "mcexact-system/1"')
        if has_parameters(document):
            return read_parametric(document, limits).document
        return canonical(read_system(document, limits, as_typed(data, document, limits)))


def has_parameters(value: Json) -> bool:
    """Whether a plant depends on parameters."""
    return isinstance(value, dict) and "parameters" in value


def digest(plant: System | FunctionSystem) -> str:
    """The SHA-256 of the canonical object of a plant."""
    known = plant.document if isinstance(plant, FunctionSystem) else canonical(plant)
    return digest_of(canonical_json(known))


def digest_of_values(plant: System | FunctionSystem, known: str) -> str:
    """The digest of a plant without its radii; ``known`` is the one with them."""
    if isinstance(plant, FunctionSystem) or plant.uncertainty is None:
        return known
    return digest(replace(plant, uncertainty=None))


def read_parametric(value: Json, limits: Limits | None = None) -> FunctionSystem:
    """A plant with parameters by the grammar of system files; without limits, of a certificate."""
    extra = () if limits is None else ("format", "name", "source")
    keys = ("time", "parameters", "A", "channels")
    time, known, entries, listed, *texts = fields(value, "system", *keys, optional=extra)
    for key, text in zip(extra[1:], texts[1:], strict=True):
        printable("" if text is None else text, key, 10_000, allowed="\n\t")
    if not isinstance(known, dict) or not known:
        malformed("parameters", "expected an object keyed by parameters")
    for name in known:
        if not PARAMETER.fullmatch(name) or name == "x":
            malformed(
                "parameters", f"expected the name of a parameter, found {reading.shown(name)}"
            )
    ranges = {name: _range(known[name], f"parameters.{name}", limits) for name in sorted(known)}
    read, write = _entries(tuple(ranges))
    tables = [_table(entries, "A", read, limits, None, 0)]
    n, names = len(tables[0][0]), []
    for k, channel in enumerate(budget.counted(items(listed, "channels"))):
        where = f"channels[{k}]"
        B, C, name = fields(channel, where, "B", "C", optional=("name",))
        tables.append(_table(B, f"{where}.B", read, limits, n, 0))
        tables.append(_table(C, f"{where}.C", read, limits, None, n))
        names.append(str(k + 1) if name is None else name)
    if tables[0][1] != n or not names or any(width != n for _, width in tables[2::2]):
        malformed("system", "expected a square A, at least one channel, and matching shapes")
    own = reading.own_names(names, [f"channels[{k}].name" for k in range(len(names))])
    forms = [_form(table, write) for table in tables]
    channels = [
        {"name": name, "B": B, "C": C}
        for name, B, C in zip(own, forms[1::2], forms[2::2], strict=True)
    ]
    said = {
        name: {} if bounds == (None, None) else {"range": [_end(bound) for bound in bounds]}
        for name, bounds in ranges.items()
    }
    document = {"time": string(time, "time", "continuous", "discrete"), "parameters": said}
    document |= {"A": forms[0], "channels": channels}
    parts = {"time": time, "names": own, "ranges": ranges, "document": document}
    if len(ranges) > 1:
        return FunctionSystem(tables=tables, **parts)
    [(t, bounds)] = ranges.items()
    return ParametricSystem(parameter=t, range=bounds, **cleared_tables(tables), **parts)


def one_parameter(plant: FunctionSystem) -> ParametricSystem:
    """The plant, of which a claim is known for one parameter alone."""
    if not isinstance(plant, ParametricSystem):
        incomplete("parameters", "parameters", "more than one parameter")
    return plant


def _entries(parameters: tuple[str, ...]) -> tuple[Entries, Callable[[Any], Json]]:
    """How entries with these parameters are read, and written."""
    if len(parameters) > 1:
        return (
            lambda value, place, limits: quotient(value, place, parameters, limits),
            lambda entry: quotient_text(entry, parameters),
        )
    [t] = parameters
    return (
        lambda value, place, limits: function(value, place, t, limits),
        lambda entry: function_text(entry, t),
    )


def _range(told: Json, place: str, limits: Limits | None) -> Range:
    (ends,) = fields(told, place, optional=("range",))
    if ends is None:
        return None, None
    place += ".range"
    low, high = (
        None if end is None else Fraction(number(end, place, limits))
        for end in items(ends, place, 2)
    )
    if low is not None and high is not None and low > high:
        malformed(place, "expected an interval")
    return low, high


def _end(bound: Fraction | None) -> Json:
    return None if bound is None else function_text(([bound] if bound else [], ONE), "")


def _table(
    value: Json, place: str, read: Entries, limits: Limits | None, nrows: int | None, ncols: int
) -> Table:
    """A matrix of functions: a list of rows, or an object that lists its nonzero entries."""
    if isinstance(value, dict):
        shape, entries = fields(value, place, "shape", "entries")
        r, c = (integer(side, f"{place}.shape") for side in items(shape, f"{place}.shape", 2))
        budget.spend(budget.table(r, c, 1))
        rows = [[read(0, place, limits)] * c for _ in range(r)]
        seen = set()
        for i, j, entry in (items(triple, place, 3) for triple in items(entries, place)):
            if integer(i, place) >= r or integer(j, place) >= c or (i, j) in seen:
                malformed(place, f"expected a position of its own inside {r} by {c}")
            seen.add((i, j))
            rows[i][j] = read(entry, place, limits)
    else:
        listed = [items(row, place) for row in items(value, place)]
        c = len(listed[0]) if listed else ncols
        rows = [[read(entry, place, limits) for entry in items(row, place, c)] for row in listed]
    if nrows not in (None, len(rows)):
        malformed(place, f"expected {nrows} rows, found {len(rows)}")
    return rows, c


def _form(table: Table, write: Callable[[Any], Json]) -> Json:
    """The canonical form of a matrix."""
    rows, ncols = table
    if not rows and ncols:
        return {"shape": [0, ncols], "entries": []}
    return [[write(entry) for entry in row] for row in rows]


def cleared_tables(tables: list[Table]) -> dict[str, Any]:
    """The parts of a plant that these matrices determine."""
    (A, *ports), denominators = zip(*map(_cleared, tables), strict=True)
    found = {"A": A, "B": ports[0::2], "C": ports[1::2], "scale": denominators[0]}
    return {"tables": tables, **found, "poles": [*denominators]}


def least_denominator(denominators: list[Polynomial]) -> Polynomial:
    """The least common multiple of polynomials, monic; 1 of none."""
    delta: Polynomial = ONE
    for bottom in denominators:
        rest = poly_divide(bottom, common_divisor(delta, bottom))[0]
        delta = poly_product(delta, [c / rest[-1] for c in rest])
    return delta


def _cleared(table: Table) -> tuple[Layers, Polynomial]:
    """The layers of M, and δ, with M/δ the matrix and δ the least common denominator."""
    rows, ncols = table
    # a hash of a rational takes the inverse of its denominator modulo a prime
    budget.spend(sum(HASHES * (1 + len(bottom)) for row in rows for _, bottom in row))
    different = dict.fromkeys(tuple(bottom) for row in rows for _, bottom in row)
    delta = least_denominator([*map(list, different)])
    factors = {bottom: poly_divide(delta, [*bottom])[0] for bottom in different}
    above = [
        [poly_product(top, factors[tuple(bottom)]) if top else [] for top, bottom in row]
        for row in rows
    ]
    values = [c for row in above for entry in row for c in entry]
    longest = budget.limbs_of(values)
    d = _least_multiple(values)
    length = max((len(entry) for row in above for entry in row), default=1)
    layers = []
    for k in range(max(length, 1)):
        budget.build(len(rows), ncols, longest, budget.limbs([d]))
        layer = [
            [e[k].numerator * (d // e[k].denominator) if k < len(e) else 0 for e in row]
            for row in above
        ]
        layers.append(Matrix(layer, ncols, d))
    return layers, delta


def _least_multiple(values: list[Fraction]) -> int:
    """The least common denominator."""
    different = {c.denominator for c in values}
    budget.spend(budget.fractions(len(different), sum(budget.limbs([d]) for d in different)))
    return math.lcm(*different)
