"""Plant and its dual, radii, and the words of statements.

Plants are read from certificates and from system files by the same functions.  A file may give
numbers as decimals and radii as parts of the entries or by the digits that are typed; a certificate
must have the canonical form, of which the digest is taken.  Whether a certificate and a file are
about the same plant is decided by comparing their digests.

`described` says what system a claim is about: the plant by its digest, and the constructions that
were applied to it.  ``FORMAT.md`` specifies these words.  A name always stands in quotes, so that
no name can be mistaken for words of the statement.
"""

from __future__ import annotations

import hashlib
import json
import math
import re
from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import reduce
from itertools import chain
from typing import Any, Protocol

from . import arithmetic, budget, reading
from .arithmetic import Matrix, Polynomial, SparseMatrix, entries_of
from .reading import (
    Json,
    Limits,
    fields,
    incomplete,
    integer,
    items,
    malformed,
    parse,
    printable,
    rational,
    shown,
    string,
)

# The matrices of systems, of controllers and of radii: their numbers, and their canonical form.

LONGEST = 2**20
"""The most rows and columns of a matrix that lists its entries."""

NUMBER = re.compile(r"-?[0-9]++(?:/0*+[1-9][0-9]*+|(?:\.[0-9]++)?(?:[eE][+-]?[0-9]++)?)")


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
    """Whether an integer ≥ 0 has more than a number of digits."""
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
    numbers = [*chain(*rows), *cells.values()]
    whole = set(map(type, numbers)) <= {int}
    different = {1} if whole else {entry.denominator for entry in numbers}
    budget.spend(budget.fractions(len(different), sum(budget.limbs([d]) for d in different)))
    d = math.lcm(*different)
    size = budget.limbs(numbers if whole else [entry.numerator for entry in numbers])
    size += budget.limbs([d])
    budget.build(r if rows else 1, c if rows else len(cells), size, size)
    if isinstance(value, dict):
        known = sorted(
            (i, j, e.numerator * (d // e.denominator)) for (i, j), e in cells.items() if e
        )
        sparse = SparseMatrix(r, c, known, d)
        return arithmetic.listed(sparse) or Matrix(sparse.rows, c, d)
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


def rows_of(M: Matrix) -> list[list[Json]]:
    """The rows of a matrix as in JSON: integers, or "p/q" in lowest terms."""
    budget.spend(budget.fractions(M.nrows * M.ncols, M.limbs))
    if M.denominator == 1:
        return M.rows
    return [[in_json(entry, M.denominator) for entry in row] for row in M.rows]


def in_json(numerator: int, denominator: int) -> Json:
    value = Fraction(numerator, denominator)
    return value.numerator if value.denominator == 1 else str(value)


def form_of(M: Matrix) -> Json:
    """The canonical form of a matrix: its rows, or the entries of a large one that is sparse."""
    sparse = arithmetic.listed(M)
    if sparse is None and (M.nrows or not M.ncols):
        return rows_of(M)
    entries = [] if sparse is None else sparse.entries
    budget.spend(budget.fractions(len(entries), M.limbs))
    triples = [[i, j, in_json(x, M.denominator)] for i, j, x in entries]
    return {"shape": [M.nrows, M.ncols], "entries": triples}


# Radii: how far entries may be from their nominal values.

WAYS = ("relative", "digits", "absolute")


def as_typed(data: bytes, document: Json, limits: Limits) -> Json:
    """The document with its numbers as texts, where radii follow from how they are typed."""
    doubt = document.get("uncertainty")
    wanted = isinstance(doubt, dict) and "digits" in doubt
    return parse(data, limits, str) if wanted else None


def radii_form(
    value: Json, names: list[str], nominal: list[Matrix], limits: Limits | None, typed: Json
) -> Json:
    """The canonical form of the radii that a document gives, None if all are 0.

    ``nominal`` are A, then all B_i, then all C_i.  A certificate gives the radii themselves, a
    system file also a part of every entry, or the digits with which it is typed.
    """
    ways = WAYS if limits else WAYS[2:]
    choices = fields(value, "uncertainty", optional=ways)
    if len(value) != 1:
        expected = " or ".join(map(shown, ways))
        malformed("uncertainty", f"expected exactly one key, {expected}")
    if "absolute" in value:
        radii = _absolute(value["absolute"], names, nominal, limits)
    elif "relative" in value:
        part = Fraction(number(choices[0], "uncertainty.relative", limits))
        if part < 0:
            malformed("uncertainty.relative", "expected a number from 0 on")
        radii = [_multiple(M, part) for M in nominal]
    else:
        string(choices[1], "uncertainty.digits", "as typed")
        radii = [_half_units(part) for part in _matrices_of(typed)]
    form = _form(radii, names)
    if limits:
        _require_short(form, limits)
    return form


def _require_short(form: Json, limits: Limits) -> None:
    """Stop where a radius has more digits than numbers of a file may have."""
    text = json.dumps(form)
    budget.spend(len(text))
    if max(map(len, re.findall("[0-9]+", text)), default=0) > limits.digits:
        message = f"a radius has more than {limits.digits} digits (Limits.digits)"
        incomplete("size", "uncertainty", message)


def read_radii(form: Json, names: list[str], nominal: list[Matrix]) -> list[Matrix]:
    """The radii of A, of all B_i and of all C_i, from their canonical form."""
    if form is not None:
        return _absolute(form["absolute"], names, nominal, None)
    return [Matrix.zeros(M.nrows, M.ncols) for M in nominal]


def _absolute(
    value: Json, names: list[str], nominal: list[Matrix], limits: Limits | None
) -> list[Matrix]:
    """The matrices of radii, with zeros for those that the document leaves out."""
    place = "uncertainty.absolute"
    A, *ports = fields(value, place, optional=("A", "B", "C"))
    forms, places = [A], [f"{place}.A"]
    for key, port in zip("BC", ports, strict=True):
        where = f"{place}.{key}"
        forms += fields({} if port is None else port, where, optional=tuple(names))
        places += [where] * len(names)
    return [
        Matrix.zeros(M.nrows, M.ncols)
        if part is None
        else _positive(read_matrix(part, where, M.nrows, M.ncols, limits), where)
        for part, where, M in zip(forms, places, nominal, strict=True)
    ]


def _positive(M: Matrix, place: str) -> Matrix:
    """A matrix without negative entries."""
    if any(entry < 0 for _, _, entry in entries_of(M)):
        malformed(place, "expected radii from 0 on")
    return M


def _multiple(M: Matrix, part: Fraction) -> Matrix:
    """The matrix of ``part`` times the absolute value of each entry."""
    entries, p, q = entries_of(M), part.numerator, part.denominator
    a, b = M.limbs, budget.limbs_of([part])
    budget.spend(100 * len(entries) + budget.products(len(entries) + 1, a, b))
    return SparseMatrix(
        M.nrows, M.ncols, [(i, j, p * abs(x)) for i, j, x in entries if p], q * M.denominator
    )


def _matrices_of(document: Json) -> list[Json]:
    """A, all B_i and all C_i of a document."""
    channels = document["channels"]
    return [document["A"], *(each["B"] for each in channels), *(each["C"] for each in channels)]


def _half_units(value: Json) -> Matrix:
    """Half a unit of the last digit of every entry that is typed with a point or an exponent."""
    if isinstance(value, dict):
        halves = [[i, j, _half_unit(entry)] for i, j, entry in value["entries"]]
        return read_matrix({**value, "entries": halves}, "uncertainty", None, None)
    return read_matrix([[_half_unit(x) for x in row] for row in value], "uncertainty", None, None)


def _half_unit(text: Json) -> Fraction:
    """Half a unit of the last digit; 0 of an integer, of a quotient, and of 0."""
    mantissa, _, exponent = str(text).lower().partition("e")
    if "/" in mantissa or not ("." in mantissa or exponent) or not Fraction(mantissa):
        return Fraction(0)
    budget.spend(300 + (len(text) + abs(int(exponent or 0))) ** 2 // 500)
    return Fraction(10) ** (int(exponent or 0) - len(mantissa.partition(".")[2])) / 2


def _form(radii: list[Matrix], names: list[str]) -> Json:
    """The radii that are not 0, by their positions, in lowest terms."""
    forms = []
    for M in radii:
        entries = entries_of(M)
        budget.spend(budget.fractions(len(entries), M.limbs))
        listed = [[i, j, in_json(x, M.denominator)] for i, j, x in entries]
        forms.append({"shape": [M.nrows, M.ncols], "entries": listed} if listed else None)
    B, C = forms[1 : len(names) + 1], forms[len(names) + 1 :]
    parts: dict[str, Json] = {"A": forms[0]}
    for key, port in (("B", B), ("C", C)):
        parts[key] = {name: form for name, form in zip(names, port, strict=True) if form}
    nonzero = {key: part for key, part in parts.items() if part}
    return {"absolute": nonzero} if nonzero else None


# The plant, read from a certificate or from a system file, and its digest.


@dataclass(frozen=True)
class System:
    """x' = Ax + Σ B_i u_i, y_i = C_i x (or x(t+1) = …), with the neighbor graph.

    ``D`` is the feedthrough, y = Cx + Du for the inputs and outputs of all channels, None where it
    is zero.  Kinds and constructions that do not know of it refuse systems with one.
    ``neighbors[i]`` is N_i in the order of the channels, with i in it; None means that there is no
    graph; ``delays[i, j]`` is d_ij where it is not 0.  ``words`` name the system in
    statements; in a closed loop ``blocks`` are the sizes of x, x_1, z_1, x_2, z_2, …,
    ``controller`` is the digest of the controller, and ``ports`` say whose the states are and which
    channels it closes, and ``loop`` is what the loop was made from (`constructions.Loop`).
    ``uncertainty`` are the radii of all entries in canonical form; None means that all are certain.
    ``missed`` are, for a sampled plant alone, A and B within which its exact samples are.
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
    ports: str = ""
    uncertainty: Json = None
    loop: Any = field(default=None, compare=False)
    missed: Any = field(default=None, compare=False)
    D: Matrix | None = None

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

    def kept(self, name: Hashable, make: Callable[[], Any]) -> Any:
        """What is proved once for all certificates about the same matrices and channels."""
        direct = () if self.D is None else (self.D,)
        return budget.kept((name, *self.names), make, self.A, *self.B, *self.C, *direct)


def read_system(value: Json, limits: Limits | None = None, typed: Json = None) -> System:
    """Read a system object by the grammar of system files; without limits, of a certificate.

    ``typed`` is the same document with its numbers as texts, if there is one.
    """
    unused = "format", "name", "source", "sample_time", "sizes", "regulated", "limits"
    extra = () if limits is None else unused
    keys = ("time", "A", "channels")
    optional = ("neighbors", "delays", "uncertainty", "D", *extra)
    time, A_rows, listed, heard, waits, doubt, direct, *more = fields(
        value, "system", *keys, optional=optional
    )
    A = read_matrix(A_rows, "A", None, None, limits)
    if A.nrows != A.ncols or not items(listed, "channels"):
        malformed("system", "expected a square A and at least one channel")
    B, C, names, own = [], [], [], []
    budget.spend(4 * len(listed) ** 2)  # names are compared, and delays looked up, for every pair
    for k, channel in enumerate(budget.counted(listed)):
        where = f"channels[{k}]"
        B_rows, C_rows, name, D = fields(channel, where, "B", "C", optional=("name", "D"))
        B.append(read_matrix(B_rows, f"{where}.B", A.nrows, None, limits))
        C.append(read_matrix(C_rows, f"{where}.C", None, A.nrows, limits))
        names.append(str(k + 1) if name is None else name)
        own.append(_feedthrough(D, f"{where}.D", C[k].nrows, B[k].ncols, limits))
    known = reading.own_names(names, [f"channels[{k}].name" for k in range(len(names))])
    p, q = sum(B_i.ncols for B_i in B), sum(C_i.nrows for C_i in C)
    whole = _feedthrough(direct, "D", q, p, limits)
    if any(own_i is not None for own_i in own):
        if whole is not None:
            malformed("D", "expected D of the system or of its channels, found both")
        whole = _of_channels(own, B, C)
    radii = None if doubt is None else radii_form(doubt, known, [A, *B, *C], limits, typed)
    if doubt is not None and whole is not None:
        malformed("uncertainty", "expected no radii where D is not zero")
    plant = System(string(time, "time", "continuous", "discrete"), known, A, B, C)
    plant = replace(plant, uncertainty=radii, D=whole)
    if limits is not None:
        _check_unused(plant, more[1:], limits)
    return plant if heard is None and waits is None else _with_graph(plant, heard, waits)


def _check_unused(plant: System, unused: list[Json], limits: Limits) -> None:
    """Read the parts of a system file on which no claim depends: they are not in the digest."""
    name, source, sample_time, sizes, regulated, ranges = unused
    for key, text in (("name", name), ("source", source)):
        printable("" if text is None else text, key, 10_000, allowed="\n\t")
    period = None if sample_time is None else number(sample_time, "sample_time", limits)
    if period is not None and (period <= 0 or plant.time != "discrete"):
        malformed("sample_time", "expected a number above 0, in discrete time only")
    _check_sizes(plant, sizes, limits)
    for _, i, held in reading.by_name(regulated, "regulated", plant.names):
        listed, q = items(held, "regulated"), plant.C[i].nrows
        if all(type(number) is int for number in listed):
            if not all(1 <= number <= q for number in listed):
                malformed("regulated", f"expected outputs from 1 to {q}")
        else:
            read_matrix(held, "regulated", None, q, limits)
    for _, i, listed in reading.by_name(ranges, "limits", plant.names):
        read_limits(listed, "limits", plant.B[i].ncols, limits)


def read_limits(
    value: Json, place: str, count: int, limits: Limits | None = None
) -> list[tuple[Fraction, Fraction] | None]:
    """The least and the largest value of each input of some; None for one without limits."""
    ranges: list[tuple[Fraction, Fraction] | None] = []
    for pair in items(value, place, count):
        if pair is None:
            ranges.append(None)
            continue
        low, high = (_end(end, place, limits) for end in items(pair, place, 2))
        if not low <= 0 <= high or low == high:
            malformed(place, "expected limits that contain 0")
        ranges.append((low, high))
    return ranges


def _end(value: Json, place: str, limits: Limits | None) -> Fraction:
    return rational(value, place) if limits is None else Fraction(number(value, place, limits))


def _check_sizes(plant: System, sizes: Json, limits: Limits) -> None:
    """Read the typical sizes of signals: claims about costs name their weights themselves."""
    if sizes is None:
        return
    keys = ("states", "inputs", "errors", "disturbances")
    states, inputs, errors, ratio = fields(sizes, "sizes", optional=keys)
    known = tuple(plant.names)
    lists = [] if states is None else [(states, plant.n)]
    for value, counts in (
        (inputs, [M.ncols for M in plant.B]),
        (errors, [M.nrows for M in plant.C]),
    ):
        if value is not None:
            by_name = zip(fields(value, "sizes", optional=known), counts, strict=True)
            lists += [([] if row is None else row, count) for row, count in by_name]
    lists += [] if ratio is None else [([ratio], 1)]
    for row, count in lists:
        values = [number(x, "sizes", limits) for x in items(row, "sizes")]
        if len(values) != count or any(x <= 0 for x in values):
            malformed("sizes", "expected a number above 0 for each state, input and output")


def _feedthrough(
    D: Json, place: str, nrows: int, ncols: int, limits: Limits | None
) -> Matrix | None:
    """A feedthrough of this shape; None for zeros, which may have any shape."""
    read = None if D is None else read_matrix(D, place, None, None, limits)
    if read is None or read.is_zero():
        return None
    if (read.nrows, read.ncols) != (nrows, ncols):
        malformed(place, f"expected {nrows} by {ncols}, found {read.nrows} by {read.ncols}")
    return read


def _of_channels(own: list[Matrix | None], B: list[Matrix], C: list[Matrix]) -> Matrix:
    """The feedthrough of inputs on the outputs of their own channels alone."""
    shapes = [(C_i.nrows, B_i.ncols) for B_i, C_i in zip(B, C, strict=True)]
    blocks = zip(own, shapes, strict=True)
    return reduce(
        arithmetic.diagonal,
        [Matrix.zeros(*shape) if D is None else D for D, shape in blocks],
        Matrix.zeros(0, 0),
    )


def _with_graph(plant: System, heard: Json, waits: Json) -> System:
    known = tuple(plant.names)
    sets = []
    for i, row in enumerate(fields(heard, "neighbors", optional=known)):
        listed = [] if row is None else items(row, "neighbors")
        senders = [plant.place_of(name, "neighbors") for name in listed]
        if len(set(senders)) < len(senders):
            malformed("neighbors", f"{shown(known[i])} lists a neighbor twice")
        sets.append(sorted({i, *senders}))
    delays = {}
    for i, row in enumerate(fields({} if waits is None else waits, "delays", optional=known)):
        for _, j, steps in reading.by_name(row, "delays", known):
            if (integer(steps, "delays") and i == j) or j not in sets[i]:
                malformed("delays", f"{shown(known[i])} receives nothing from {shown(known[j])}")
            if steps:
                delays[i, j] = steps
    return replace(plant, neighbors=sets, delays=delays)


def canonical(system: System) -> dict[str, Json]:
    """The canonical object of this plant in a certificate."""
    known, channels = system.names, zip(system.names, system.B, system.C, strict=True)
    result: dict[str, Json] = {"time": system.time, "A": form_of(system.A)}
    if system.D is not None:
        result["D"] = form_of(system.D)
    result["channels"] = [
        {"name": name, "B": form_of(B), "C": form_of(C)} for name, B, C in channels
    ]
    if system.neighbors is not None:
        sets = enumerate(system.neighbors)
        result["neighbors"] = {known[i]: [known[j] for j in N_i if j != i] for i, N_i in sets}
    for (i, j), steps in system.delays.items():
        result.setdefault("delays", {}).setdefault(known[i], {})[known[j]] = steps
    if system.uncertainty is not None:
        result["uncertainty"] = system.uncertainty
    return result


def read_plant(value: Json) -> System:
    """The system object of a certificate, which must be canonical."""
    system = read_system(value)
    if canonical(system) != value:
        malformed("system", "expected the canonical form: lowest terms, neighbors in order")
    return system


def parse_canonical(data: bytes, limits: Limits) -> Json:
    """The object in the file of a plant beside certificates, whose bytes are its canonical JSON."""
    value = parse(data, limits)
    if canonical_json(value).encode("ascii") != data:
        malformed("system", "expected canonical JSON in the file of the plant")
    return value


def parse_file(data: bytes, limits: Limits) -> Json:
    """The document of a system file or a controller file, its numbers exactly as typed."""
    return reading.parse(data, limits, lambda text: number(text, f"number {text[:24]}", limits))


def read_system_file(data: bytes, limits: Limits) -> System:
    """The system of a system file, numbers as typed."""
    with budget.limited(budget.current(limits.work), len(data)):
        document = parse_file(data, limits)
        if not isinstance(document, dict) or document.get("format") != "mcexact-system/1":
            malformed("format", 'expected a system file, "format": "mcexact-system/1"')
        return read_system(document, limits, as_typed(data, document, limits))


# The words of statements: systems, sets, polynomials, and values as canonical JSON.

FIXED = "fixed under linear time-invariant decentralized control"
PENCIL = "[xI - A, B; C, 0]"
SHORT = 80
"""The longest text of a matrix or a controller that is written out beside its digest."""


def canonical_json(value: Any) -> str:
    """A value as JSON: sorted keys, no blanks, ASCII; a matrix as its rows in lowest terms."""

    def plain(part: Any) -> Any:
        if isinstance(part, Matrix):
            return rows_of(part)
        return part.numerator if part.denominator == 1 else str(part)

    text = json.dumps(value, sort_keys=True, separators=(",", ":"), default=plain)
    budget.spend(len(text))
    return text


def digest_of(text: str) -> str:
    """The SHA-256 of an ASCII text, in lower-case hexadecimal."""
    return hashlib.sha256(text.encode("ascii")).hexdigest()


def digest(system: System) -> str:
    """The SHA-256 of the canonical object of a plant."""
    return digest_of(canonical_json(canonical(system)))


def with_digest(text: str) -> str:
    """The digest of the JSON of matrices or of a controller, and this itself where it is short."""
    return f"SHA-256 {digest_of(text)}" + (f" = {text}" if len(text) <= SHORT else "")


def by_channel(system: System, values: Iterable[Any]) -> dict[str, Any]:
    """One value for each channel, by the names of the channels."""
    return dict(zip(system.names, values, strict=True))


def quoted(name: str) -> str:
    """A name, which can hold no more than its quotes."""
    budget.spend(100 + 6 * len(name))
    return json.dumps(name)


def channel_set(names: Iterable[str]) -> str:
    """A set of channels by name, such as {"1", "3"}."""
    return "{" + ", ".join(map(quoted, names)) + "}"


def edge_set(edges: Iterable[Any]) -> str:
    """A set of edges [from, to], perhaps with a cost, such as {"1" -> "2", "2" -> "1"}."""
    listed = list(edges)
    texts = {name: quoted(name) for name in {end for j, i, *_ in listed for end in (j, i)}}
    budget.spend(sum(100 + len(texts[j]) + len(texts[i]) for j, i, *_ in listed))
    ends = [(f"{texts[j]} -> {texts[i]}", cost) for j, i, *cost in listed]
    return "{" + ", ".join(": ".join([edge, *map(str, cost)]) for edge, cost in ends) + "}"


def polynomial_text(p: Polynomial, x: str = "x") -> str:
    """A polynomial in x, highest power first, such as x^2 - 3/2*x + 1."""
    terms, p = [], [Fraction(c) for c in p]
    budget.spend(budget.fractions(len(p), budget.limbs_of(p)))
    for k, c in reversed(list(enumerate(p))):
        if c:
            power = "" if k == 0 else x if k == 1 else f"{x}^{k}"
            size = str(abs(c)) if abs(c) != 1 or not power else ""
            terms += ["-" if c < 0 else "+", size + ("*" if size and power else "") + power]
    sign = "-" if terms and terms[0] == "-" else ""
    return sign + " ".join(terms[1:]) if terms else "0"


def denied(holds: bool) -> str:
    """The word that denies what follows where it does not hold."""
    return "" if holds else "not "


def counted(number: int, noun: str) -> str:
    """A number of things, such as 1 state or 2 states."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


# Systems: the plant by its digest, and constructions before or behind what they are applied to.


def prefixed(
    words: str,
    system: System,
    blocks: tuple[int, ...] = (),
    ports: str = "",
    loop: Any = None,
    **parts: Any,
) -> System:
    """The system with these parts that a construction makes, named before what it is made from."""
    named = f"{words} of: {system.words}"
    return replace(system, words=named, blocks=blocks, ports=ports, loop=loop, **parts)


def suffixed(system: System, words: str, **parts: Any) -> System:
    """As `prefixed`, but named after what it is made from.

    What begins with a construction stands in parentheses, so that the text parses in one way only.
    """
    alone = system.words.startswith(("the plant", "("))
    before = system.words if alone else f"({system.words})"
    return replace(system, words=f"{before} {words}", blocks=(), ports="", loop=None, **parts)


class Described(Protocol):
    """What statements need to know of a system of numbers, or of rational functions."""

    @property
    def n(self) -> int: ...
    @property
    def m(self) -> int: ...
    @property
    def names(self) -> Sequence[str]: ...
    @property
    def time(self) -> str: ...
    @property
    def words(self) -> str: ...
    @property
    def ports(self) -> str: ...


def described(system: Described) -> str:
    """The system a claim is about: what it was made from, its states, its channels, its time."""
    channels = f"channels {channel_set(system.names)}" if system.m else "no channels"
    sizes = f"{counted(system.n, 'state')}, {system.ports or channels}, {system.time} time"
    return f"{system.words} ({sizes})"


# Construction ``dual``, of which the observability of a plant is the controllability.


def dual(system: System, step: dict[str, Json], place: str) -> System:
    """A', (C_i)', (B_i)'; no neighbor graph.

    Open: see ``proofs/OPEN.md``.
    """
    fields(step, place)
    B, C = [M.T for M in system.C], [M.T for M in system.B]
    D = None if system.D is None else system.D.T
    return prefixed("the dual", system, A=system.A.T, B=B, C=C, D=D, neighbors=None, delays={})
