"""The plant, read from a certificate or from a system file, and its digest."""

import math
import re
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import chain

from . import budget, reading, sparse
from .arithmetic import Matrix
from .reading import Json, Limits, fields, integer, items, malformed, printable, shown, string
from .sparse import SparseMatrix

LONGEST = 2**20
"""The most rows and columns of a matrix that lists its entries."""

NUMBER = re.compile(r"-?[0-9]++(?:/0*+[1-9][0-9]*+|(?:\.[0-9]++)?(?:[eE][+-]?[0-9]++)?)")


@dataclass(frozen=True)
class System:
    """x' = Ax + Σ B_i u_i, y_i = C_i x (or x(t+1) = …), with the neighbor graph.

    ``neighbors[i]`` is N_i in the order of the channels, with i in it; None means that there is no
    graph; ``delays[i, j]`` is d_ij where it is not 0.  ``words`` name the system in
    statements; in a closed loop ``blocks`` are the sizes of x, x_1, z_1, x_2, z_2, …, and
    ``controller`` is the digest of the controller.
    """

    time: str
    names: list[str]
    A: Matrix
    B: list[Matrix]
    C: list[Matrix]
    neighbors: list[list[int]] | None = None
    delays: dict[tuple[int, int], int] = field(default_factory=dict)
    words: str = "the plant"
    blocks: tuple[int, ...] = ()
    controller: str = ""

    @property
    def n(self) -> int:
        """The number of states."""
        return self.A.nrows

    @property
    def m(self) -> int:
        """The number of channels."""
        return len(self.names)

    def place_of(self, name: Json, place: str) -> int:
        """The position of one named channel."""
        return reading.names([name], place, self.names)[0]


def number(value: Json, place: str, limits: Limits | None = None) -> Fraction | int:
    """A number of a system file: an integer, a decimal as typed, or a string "p/q".

    ``limits`` are those of a file; a certificate's numbers were limited when it was parsed.
    """
    result: Fraction | int
    if type(value) is int or isinstance(value, Fraction):
        result, typed = value, 0
    else:
        good = type(value) is str and NUMBER.fullmatch(value)
        mantissa, exponent, *_ = [*re.split("[eE]", value), "0"] if good else ["", "0"]
        if not good or abs(int(exponent)) > (limits or Limits).exponent:
            malformed(place, f'expected an integer, a decimal or "p/q", found {shown(value)}')
        typed = 0 if "/" in mantissa else len(mantissa.strip("-").replace(".", ""))
        budget.spend(300 + (len(value) + abs(int(exponent))) ** 2 // 500)
        result = Fraction(value)
    if limits is None:
        return result
    size = max(abs(result.numerator), result.denominator)
    if typed > limits.digits or too_long(size, limits.digits):
        reading.incomplete("size", place, f"needs more than {limits.digits} digits (Limits.digits)")
    return result


def too_long(value: int, digits: int) -> bool:
    """Whether an integer that is not negative has more than so many digits."""
    return value.bit_length() > 3 * digits and value >= 10**digits


def read_matrix(
    value: Json, place: str, nrows: int | None, ncols: int | None, limits: Limits | None = None
) -> Matrix:
    """A matrix of a system: a list of rows, or an object that lists its nonzero entries."""
    rows: list[list[Json]] = []
    cells: dict[tuple[int, int], Json] = {}
    if isinstance(value, dict):
        shape, entries = fields(value, place, "shape", "entries")
        r, c = (integer(size, f"{place}.shape") for size in items(shape, f"{place}.shape", 2))
        if max(r, c) > LONGEST:
            reading.incomplete("size", f"{place}.shape", f"{r} by {c} is too large")
        for i, j, entry in (items(triple, place, 3) for triple in items(entries, place)):
            if integer(i, place) >= r or integer(j, place) >= c or (i, j) in cells:
                malformed(place, f"expected a position of its own inside {r} by {c}")
            cells[i, j] = number(entry, place, limits)
    else:
        r, listed = len(items(value, place)), value
        c = len(items(listed[0], place)) if listed else ncols or 0
        plain = limits is None and _are_integers(listed, c)
        rows = listed if plain else [_numbers(items(x, place, c), place, limits) for x in listed]
    if nrows not in (None, r) or ncols not in (None, c):
        malformed(place, f"expected another shape, found {r} by {c}")
    given = [*chain(*rows), *cells.values()]
    whole = set(map(type, given)) <= {int}
    different = {1} if whole else {entry.denominator for entry in given}
    budget.spend(budget.fractions(len(different), sum(budget.limbs([d]) for d in different)))
    d = math.lcm(*different)
    size = budget.limbs(given if whole else [entry.numerator for entry in given])
    size += budget.limbs([d])
    budget.build(r if rows else 1, c if rows else len(cells), size, size)
    if isinstance(value, dict):
        known = sorted(
            (i, j, e.numerator * (d // e.denominator)) for (i, j), e in cells.items() if e
        )
        found = SparseMatrix(r, c, known, d)
        return sparse.listed(found) or Matrix(found.rows, c, d)
    if whole:
        return Matrix(rows, c)
    return Matrix([[e.numerator * (d // e.denominator) for e in row] for row in rows], c, d)


def _are_integers(rows: list[Json], ncols: int) -> bool:
    """Whether each row is a list of so many integers; a row at a time takes three times as long."""
    lists = set(map(type, rows)) <= {list} and set(map(len, rows)) <= {ncols}
    return lists and set(map(type, chain.from_iterable(rows))) <= {int}


def _numbers(row: list[Json], place: str, limits: Limits | None) -> list[Json]:
    """The numbers of a row; integers of a certificate are as they should be."""
    known = limits is None and set(map(type, row)) <= {int}
    return row if known else [number(entry, place, limits) for entry in row]


def read_system(value: Json, limits: Limits | None = None) -> System:
    """Read a system object by the grammar of system files; without limits, of a certificate."""
    extra = () if limits is None else ("format", "name", "source", "sample_time", "D")
    keys, optional = ("time", "A", "channels"), ("neighbors", "delays", *extra)
    time, A_rows, listed, heard, waits, *more = fields(value, "system", *keys, optional=optional)
    A = read_matrix(A_rows, "A", None, None, limits)
    if A.nrows != A.ncols or not items(listed, "channels"):
        malformed("system", "expected a square A and at least one channel")
    B, C, names = [], [], []
    budget.spend(4 * len(listed) ** 2)  # names are compared, and delays looked up, for every pair
    for k, channel in enumerate(budget.counted(listed)):
        where = f"channels[{k}]"
        B_rows, C_rows, name, D = fields(channel, where, "B", "C", optional=("name", "D"))
        B.append(read_matrix(B_rows, f"{where}.B", A.nrows, None, limits))
        C.append(read_matrix(C_rows, f"{where}.C", None, A.nrows, limits))
        names.append(str(k + 1) if name is None else name)
        _require_no_feedthrough(D, f"{where}.D", limits)
    known = reading.own_names(names, [f"channels[{k}].name" for k in range(len(names))])
    plant = System(string(time, "time", "continuous", "discrete"), known, A, B, C)
    if limits is not None:
        _check_unused(plant, more[1:], limits)
    return plant if heard is None and waits is None else _with_graph(plant, heard, waits)


def _check_unused(plant: System, given: list[Json], limits: Limits) -> None:
    """Read the parts of a system file on which no claim depends: they are not in the digest."""
    name, source, sample_time, D = given
    for key, text in (("name", name), ("source", source)):
        printable("" if text is None else text, key, 10_000, allowed="\n\t")
    period = None if sample_time is None else number(sample_time, "sample_time", limits)
    if period is not None and (period <= 0 or plant.time != "discrete"):
        malformed("sample_time", "expected a number above 0, in discrete time only")
    _require_no_feedthrough(D, "D", limits)


def _require_no_feedthrough(D: Json, place: str, limits: Limits | None) -> None:
    """Refuse a D that is not zero, of any shape."""
    if D is not None and not read_matrix(D, place, None, None, limits).is_zero():
        malformed(place, "expected no feedthrough: outputs are y_i = C_i x")


def _with_graph(plant: System, heard: Json, waits: Json) -> System:
    known = tuple(plant.names)
    sets = []
    for i, row in enumerate(fields(heard, "neighbors", optional=known)):
        listed = [] if row is None else items(row, "neighbors")
        found = [plant.place_of(name, "neighbors") for name in listed]
        if len(set(found)) < len(found):
            malformed("neighbors", f"{shown(known[i])} lists a neighbor twice")
        sets.append(sorted({i, *found}))
    delays = {}
    for i, row in enumerate(fields({} if waits is None else waits, "delays", optional=known)):
        for _, j, steps in reading.by_name(row, "delays", known):
            if (integer(steps, "delays") and i == j) or j not in sets[i]:
                malformed("delays", f"{shown(known[i])} receives nothing from {shown(known[j])}")
            if steps:
                delays[i, j] = steps
    return System(plant.time, plant.names, plant.A, plant.B, plant.C, sets, delays)


def rows_of(M: Matrix) -> list[list[Json]]:
    """The rows of a matrix as in JSON: integers, or "p/q" in lowest terms."""
    budget.spend(budget.fractions(M.nrows * M.ncols, M.limbs))
    if M.denominator == 1:
        return M.rows
    return [[_in_json(entry, M.denominator) for entry in row] for row in M.rows]


def _in_json(numerator: int, denominator: int) -> Json:
    value = Fraction(numerator, denominator)
    return value.numerator if value.denominator == 1 else str(value)


def _form_of(M: Matrix) -> Json:
    """The canonical form of a matrix: its rows, or the entries of a large one that is sparse."""
    found = sparse.listed(M)
    if found is None and (M.nrows or not M.ncols):
        return rows_of(M)
    entries = [] if found is None else found.entries
    budget.spend(budget.fractions(len(entries), M.limbs))
    triples = [[i, j, _in_json(x, M.denominator)] for i, j, x in entries]
    return {"shape": [M.nrows, M.ncols], "entries": triples}


def canonical(system: System) -> dict[str, Json]:
    """The canonical object of this plant in a certificate."""
    known, channels = system.names, zip(system.names, system.B, system.C, strict=True)
    result: dict[str, Json] = {"time": system.time, "A": _form_of(system.A)}
    result["channels"] = [
        {"name": name, "B": _form_of(B), "C": _form_of(C)} for name, B, C in channels
    ]
    if system.neighbors is not None:
        sets = enumerate(system.neighbors)
        result["neighbors"] = {known[i]: [known[j] for j in N_i if j != i] for i, N_i in sets}
    for (i, j), steps in system.delays.items():
        result.setdefault("delays", {}).setdefault(known[i], {})[known[j]] = steps
    return result


def read_plant(value: Json) -> System:
    """The system object of a certificate, which must be canonical."""
    system = read_system(value)
    if canonical(system) != value:
        malformed("system", "expected the canonical form: lowest terms, neighbors in order")
    return system


def parse_file(data: bytes, limits: Limits) -> Json:
    """The document of a system file or a controller file, its numbers exactly as typed."""
    return reading.parse(data, limits, lambda text: number(text, f"number {text[:24]}", limits))


def read_system_file(data: bytes, limits: Limits) -> System:
    """The system of a system file, numbers as typed."""
    with budget.limited(budget.current(limits.work), len(data)):
        document = parse_file(data, limits)
        if not isinstance(document, dict) or document.get("format") != "mcexact-system/1":
            malformed("format", 'expected a system file, "format": "mcexact-system/1"')
        return read_system(document, limits)
