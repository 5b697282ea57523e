"""System files that consist of arrays: MATLAB, numpy, folders of .csv.

Each of the three kinds is read into `Parts`, its arrays by name, and `system_of` makes the system
of them; `parts_of` and a writer for each kind lead back.  Arrays become exact by the rules of
`Reading`: integers and texts are exact; floats become exact by a rounding, which the caller or the
file names, or which is "simplest".

Files of MATLAB, version 5, which ``save -v7`` and ``save -v6`` write, are read here and written
by scipy.  scipy's reader believes the types, sizes and shapes of a file: one wrong byte ends the
interpreter, and 3 MB become 3 GB.  A file is a header and elements; an element has a type, a size
and contents; a variable is an element whose contents are elements: flags, shape, name and values.
Every type and size is compared with what the class and the shape of its variable allow, before
numpy reads the values.

Archives of numpy, from ``numpy.savez``, are read without unpickling anything.  Folders of .csv
files contain the numbers as typed, so they are exact in every case.
"""

from __future__ import annotations

import csv
import io
import math
import os
import re
import struct
import sys
import zipfile
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import accumulate, chain
from pathlib import Path
from typing import Any, cast, get_args

from mcexact.errors import InputError, NotWritten, one_of
from mcexact.exact.matrix import (
    BINARY,
    LARGEST_WHOLE,
    Matrix,
    Rounding,
    common_width,
    from_cells,
    from_float,
    has_rounded,
    is_sparse_array,
    matrix_from_float,
    matrix_to_float,
)
from mcexact.exact.rational import DEFAULT_LIMITS, Limits, decimal_or_quotient
from mcexact.exact.roots import is_discrete
from mcexact.exact.tables import is_mostly_zero
from mcexact.model.entries import LONGEST_SIDE, as_matrix, read_number, require_shape
from mcexact.model.graph import NeighborGraph
from mcexact.model.sizes import TypicalSizes
from mcexact.model.system import MultiChannelSystem, read_by, split_by_sizes
from mcexact.model.text import nearest, quoted, read_bytes, write_text

# Options of readers: limits, rounding, and the sizes of channels.


@dataclass(frozen=True)
class Reading:
    """The options of every reader of system files.

    Attributes
    ----------
    limits : Limits
    rounding : {"decimal", "dyadic", "simplest"}, optional
        How floats become exact numbers, as in `MultiChannelSystem.from_float`; without it as the
        file says, or else by its default.
    inputs, outputs : sequences of int, optional
        The numbers of inputs and outputs of the channels, where B and C are stacked and the file
        does not say.
    """

    limits: Limits = DEFAULT_LIMITS
    rounding: Rounding | None = None
    inputs: Sequence[int] | None = None
    outputs: Sequence[int] | None = None


AS_TYPED = Reading()
"""The files of this package, in which numbers are exact as they are typed."""


# Arrays in files to exact matrices, and exact matrices to arrays without loss.


def require_sides(sides: Any, where: str) -> None:
    """Refuse a shape that no matrix has, before an array of this size is allocated.

    Raises
    ------
    InputError
        If there are more or fewer than two sides, or one is negative or longer than 2**20.
    """
    shape = " × ".join(map(str, sides))
    if len(sides) != 2:
        raise InputError(
            f"expected a matrix, found {len(sides)} dimensions" + (f", {shape}" if sides else ""),
            where=where,
        )
    if min(sides) < 0 or max(sides) > LONGEST_SIDE:
        raise InputError(
            f"expected 0 to {LONGEST_SIDE} rows and columns, found {shape}", where=where
        )


def require_entries(values: Iterable[Any], limits: Limits) -> None:
    """Refuse arrays that have more entries than a file of numbers of 64 bits can have.

    A compressed file can declare many more entries than it has bytes, and converting each takes
    time, except zeros.

    Raises
    ------
    InputError
        If there are too many texts and numbers that are not 0.
    """
    import numpy as np

    most, count = limits.bytes // 8, 0
    for value in values:
        if is_sparse_array(value):
            count += value.nnz
        elif hasattr(value, "dtype"):
            count += value.size if value.dtype.kind == "U" else int(np.count_nonzero(value))
        elif isinstance(value, list):
            count += sum(len(row) - row.count("0") for row in value)
    if count > most:
        raise InputError(
            f"expected at most {most} entries that are not 0 (Limits.bytes), found {count}"
        )


def exact_matrix(
    value: Any, where: str, reading: Reading, nrows: int | None = None, ncols: int | None = None
) -> Matrix:
    """Convert a table of a file to an exact matrix of an expected shape.

    Parameters
    ----------
    value : array, sparse array, or list of rows of texts
        An array of texts has numbers in the grammar of system files.
    where : str
    reading : Reading
    nrows, ncols : int, optional
        The expected shape, which a table without rows and columns takes if it can be empty.

    Raises
    ------
    InputError
        If the table has another shape or other entries.
    """
    if isinstance(value, Matrix):
        M = value
    elif isinstance(value, list) or value.dtype.kind == "U":
        M = _of_texts(value if isinstance(value, list) else value.tolist(), where, reading.limits)
        if not isinstance(value, list) and value.size == 0:
            M = Matrix.zeros(*value.shape)
    else:
        require_sides(value.shape, where)
        M = _of_numbers(value, where, reading)
    if M.shape == (0, 0) and (not nrows or not ncols):
        return Matrix.zeros(nrows or 0, ncols or 0)
    return require_shape(M, where, nrows, ncols)


def _of_texts(rows: list[list[str]], where: str, limits: Limits) -> Matrix:
    """Read numbers in the grammar of system files; equal texts are read once."""
    width = common_width(rows, where)
    known: dict[str, int] = {}
    exact: list[Fraction] = []
    places: list[list[int]] = []
    for i, row in enumerate(rows):
        for entry in sorted(set(row) - known.keys(), key=row.index):
            known[entry] = len(exact)
            exact.append(read_number(entry, f"{where}[{i}][{row.index(entry)}]", limits))
        places.append(list(map(known.__getitem__, row)))
    return _of_distinct(exact, places, width or 0)


def _of_distinct(exact: list[Fraction], places: list[list[int]], width: int) -> Matrix:
    """The matrix of rows of positions in a list of numbers, most of which can occur often."""
    denominator = math.lcm(*{number.denominator for number in exact})
    numerators = [number.numerator * (denominator // number.denominator) for number in exact]
    rows = [tuple(map(numerators.__getitem__, row)) for row in places]
    return Matrix.from_integers(rows, denominator, width)


def _of_numbers(value: Any, where: str, reading: Reading) -> Matrix:
    """Convert an array of numbers; integers are exact in every form."""
    import numpy as np

    kind = value.dtype.kind
    if kind == "b":
        value = value.astype("u1")
    elif kind == "f":
        _require_finite(value, where)
        if has_rounded(value):
            return _of_floats(value, where, reading.rounding or BINARY)
        value = value.astype("i8")
    elif kind not in "iu":
        kind_in_words = {"c": "complex numbers", "O": "objects"}.get(
            kind, f"entries of type {value.dtype}"
        )
        raise InputError(f"expected real numbers, found {kind_in_words}", where=where)
    if is_sparse_array(value):
        return as_matrix(value, where)
    cells = np.flatnonzero(value)
    if is_mostly_zero(value.size, cells.size):
        return from_cells(value.shape, cells.tolist(), value.ravel()[cells].tolist())
    return as_matrix(value, where)


def _of_floats(value: Any, where: str, rounding: Rounding) -> Matrix:
    """Convert an array of floats; each number is converted once."""
    import numpy as np

    if is_sparse_array(value):
        return matrix_from_float(value, rounding, where=where)
    distinct, places = np.unique(value, return_inverse=True)
    exact = [from_float(number, rounding, where=where) for number in distinct]
    return _of_distinct(exact, places.reshape(value.shape).tolist(), value.shape[1])


def _require_finite(value: Any, where: str) -> None:
    """Refuse an infinity and NaN."""
    import numpy as np

    entries = value.data if is_sparse_array(value) else value.ravel()
    wrong = entries[~np.isfinite(entries)]
    if wrong.size:
        raise InputError(f"expected finite numbers, found {wrong[0]}", where=where)


def integers_or_none(M: Matrix) -> Any:
    """The matrix as an array of integers of 64 bits; None if an entry is something else."""
    import numpy as np

    if M.denominator != 1 or any(abs(x) >= 2**63 for row in M.numerators for x in row):
        return None
    rows = [list(row) for row in M.numerators]
    return np.array(rows, dtype=np.int64).reshape(M.shape)


def floats_of(M: Matrix, where: str, rounding: Rounding | None, *, nearest: bool) -> Any:
    """The matrix as an array of floats from which the rounding restores it.

    Raises
    ------
    InputError
        If there is no such array, and `nearest` is false.
    """
    import numpy as np

    floats = matrix_to_float(M)
    if not np.all(np.isfinite(floats)):
        raise InputError("a number is beyond the range of floats", where=where)
    if nearest:
        return floats
    again = matrix_from_float(floats, rounding or "dyadic", where=where)
    if again != M:
        i, j = next(
            (i, j) for i in range(M.nrows) for j in range(M.ncols) if again[i, j] != M[i, j]
        )
        by = f" with the rounding '{rounding}'" if rounding else ""
        hint = "" if rounding else "--rounding simplest, or "
        raise InputError(
            f"no float is read as {decimal_or_quotient(M[i, j])}{by}: write .json or .csv files, "
            f"or add {hint}--nearest for the nearest floats",
            where=f"{where}[{i}][{j}]",
        )
    return floats


# From the arrays of a file, by name, to a system, and back.

ROUNDING = "rounding"
"""The key of the rounding of floats in a file, used where the caller does not choose one."""
TEXTS = ("time", "name", "source", ROUNDING)
SIZES = ("state_sizes", "input_sizes", "output_errors", "disturbances")
"""The tables of `TypicalSizes`: rows of numbers for all states, inputs and outputs, and r."""
TABLES = ("neighbors", "delays", "inputs", "outputs", "sample_time", *SIZES)
KEYS = ("A", "B", "C", "D", *TABLES, *TEXTS, "names")
NUMBERED = re.compile(r"([BC])_([1-9][0-9]{0,5})")


@dataclass(frozen=True)
class Parts:
    """The contents of a file of arrays, by name.

    Attributes
    ----------
    tables : mapping
        Arrays, sparse arrays, or lists of rows of texts: ``A``; ``B_1``, ``C_1`` and so on, or the
        stacked ``B`` and ``C`` with the sizes ``inputs`` and ``outputs``; and those of `TABLES`.
    texts : mapping
        Texts, by the names in `TEXTS`.
    names : sequence of str, optional
        The names of the channels.
    """

    tables: Mapping[str, Any]
    texts: Mapping[str, str] = field(default_factory=dict)
    names: Sequence[str] | None = None


@dataclass(frozen=True)
class Vocabulary:
    """The names of arrays that have a meaning in a kind of file.

    Attributes
    ----------
    keys : tuple of str
        All names but those with numbers.
    texts : tuple of str
        Those among them that are texts.
    numbered : re.Pattern
        The names with numbers.
    cells : tuple of str
        The names of cell arrays of matrices in files of MATLAB, which stand for names with numbers.
    hint : str
        What is known, as the end of a message.
    """

    keys: tuple[str, ...]
    texts: tuple[str, ...]
    numbered: re.Pattern[str]
    cells: tuple[str, ...]
    hint: str


SYSTEM = Vocabulary(
    KEYS, TEXTS, NUMBERED, ("B", "C"), "; known are A, B_1, C_1, …, or B, C, inputs, outputs"
)


def require_known(names: Iterable[str], what: str, vocabulary: Vocabulary = SYSTEM) -> None:
    """Refuse a name that has no meaning in a file of arrays.

    Raises
    ------
    InputError
        If there is one: a misspelled name must not be ignored.
    """
    for name in names:
        if name not in vocabulary.keys and not vocabulary.numbered.fullmatch(name):
            hint = nearest(name, vocabulary.keys) or vocabulary.hint
            raise InputError(f"unknown {what} {quoted(name)}{hint}")


def system_of(parts: Parts, reading: Reading) -> MultiChannelSystem:
    """Make the system that a file describes.

    Parameters
    ----------
    parts : Parts
    reading : Reading

    Raises
    ------
    InputError
        If a part is missing, or is not as expected.
    """

    rounding = reading.rounding
    if ROUNDING in parts.texts:
        written = parts.texts[ROUNDING]
        one_of(written, get_args(Rounding), ROUNDING, InputError)
        reading = replace(reading, rounding=rounding or cast(Rounding, written))
    elif rounding is None:
        rounding = BINARY
    require_entries(parts.tables.values(), reading.limits)

    def matrix(name: str, nrows: int | None, ncols: int | None) -> Matrix:
        return exact_matrix(parts.tables[name], name, reading, nrows, ncols)

    if "A" not in parts.tables:
        raise InputError("the matrix A is missing")
    A = matrix("A", None, None)
    B, C = _channels(parts, matrix, A.nrows, (reading.inputs, reading.outputs))
    names = parts.names if parts.names is not None else [str(k + 1) for k in range(len(B))]
    D = None
    if "D" in parts.tables:
        D = matrix("D", None, None)
        p, q = sum(M.ncols for M in B), sum(M.nrows for M in C)
        # programs write one zero for a D without entries that are not 0
        D = None if D.is_zero() else require_shape(D, "D", q, p)
    time, sample_time = _time(parts, matrix)
    made = MultiChannelSystem(
        A,
        B,
        C,
        D=D,
        time=time,
        sample_time=sample_time,
        names=names,
        neighbors=_graph(parts, matrix, tuple(names)),
        typical_sizes=_typical_sizes(parts, matrix, B, C),
        name=parts.texts.get("name"),
        source=parts.texts.get("source"),
    )
    # A file that names its rounding was written so that this makes the same numbers again.
    return made if rounding is None else read_by(rounding, made, parts.tables.values())


Read = Callable[[str, int | None, int | None], Matrix]
Sizes = tuple[Sequence[int] | None, Sequence[int] | None]
"""The numbers of inputs and of outputs of the channels, if B and C are stacked."""


def _channels(
    parts: Parts,
    matrix: Read,
    n: int,
    sizes: Sizes,
) -> tuple[list[Matrix], list[Matrix]]:
    """Read B_i and C_i, which the file has one by one or stacked."""
    blocks = {(m[1], int(m[2])) for name in parts.tables if (m := NUMBERED.fullmatch(name))}
    if not blocks:
        return _stacked(parts, matrix, n, _sizes(parts, matrix, sizes))
    if "B" in parts.tables or "C" in parts.tables:
        raise InputError("both stacked matrices and matrices of channels are given: keep one kind")
    count = max(k for _, k in blocks)
    for k in range(1, count + 1):
        for letter in "BC":
            if (letter, k) not in blocks:
                raise InputError(f"the matrix {letter}_{k} is missing; it may be empty")
    columns, rows = (
        [None] * count if each is None else each for each in _sizes(parts, matrix, sizes)
    )
    for name, each in (("inputs", columns), ("outputs", rows)):
        if len(each) != count:
            raise InputError(
                f"expected the sizes of {count} channels, found {len(each)}", where=name
            )
    B = [matrix(f"B_{k}", n, width) for k, width in enumerate(columns, start=1)]
    return B, [matrix(f"C_{k}", height, n) for k, height in enumerate(rows, start=1)]


def _sizes(parts: Parts, matrix: Read, sizes: Sizes) -> Sizes:
    """The numbers of inputs and of outputs of the channels, as the caller or the file says."""
    first, second = (
        each
        if each is not None or name not in parts.tables
        else _integers(matrix(name, None, None), name)
        for name, each in zip(("inputs", "outputs"), sizes, strict=True)
    )
    return first, second


def _stacked(
    parts: Parts,
    matrix: Read,
    n: int,
    sizes: Sizes,
) -> tuple[list[Matrix], list[Matrix]]:
    """Read B and C, which the channels share by their sizes."""
    split = []
    for name, letter, counts in zip(("inputs", "outputs"), "BC", sizes, strict=True):
        if letter not in parts.tables:
            raise InputError(f"the matrix {letter} is missing: give {letter}, or {letter}_1, …")
        if counts is None:
            raise InputError(
                f"{letter} is stacked, and '{name}' is missing, the number of {name} of each "
                f"channel; add it, or write 'mcexact convert FILE --{name} 1,1 -o plant.json'"
            )
        split.append(list(counts))
    B = matrix("B", n, sum(split[0]))
    C = matrix("C", sum(split[1]), n)
    return split_by_sizes(B, C, split[0], split[1])


def _integers(M: Matrix, where: str) -> list[int]:
    """The entries of a row or column of integers that are not negative."""
    if M.denominator != 1 or min(M.shape) > 1:
        raise InputError("expected a list of integers", where=where)
    return [entry for row in M.numerators for entry in row]


def _time(parts: Parts, matrix: Read) -> tuple[str, Any]:
    """Read the time domain, and the sample time if there is one."""
    sample_time = None
    if "sample_time" in parts.tables:
        sample_time = matrix("sample_time", 1, 1)[0, 0]
    time = parts.texts.get("time", "continuous" if sample_time is None else "discrete")
    return time, sample_time


def _graph(parts: Parts, matrix: Read, names: tuple[str, ...]) -> NeighborGraph | None:
    """Read the matrix of neighbors, whose row i marks those that agent i receives from."""
    m = len(names)
    if "neighbors" not in parts.tables:
        if "delays" in parts.tables:
            raise InputError("delays need links: 'neighbors' is missing", where="delays")
        return None
    links = matrix("neighbors", m, m)
    if not all(entry in (0, 1) for row in links.rows() for entry in row):
        raise InputError("expected zeros and ones", where="neighbors")
    delays: list[tuple[int, int, int]] = []
    if "delays" in parts.tables:
        steps = matrix("delays", m, m)
        if steps.denominator != 1:
            raise InputError("expected integers", where="delays")
        delays = [(i, j, d) for i, j, d in steps.nonzero()]
    heard = [[j for j in range(m) if links[i, j]] for i in range(m)]
    return NeighborGraph(names, heard, delays)


def _typical_sizes(
    parts: Parts, matrix: Read, B: Sequence[Matrix], C: Sequence[Matrix]
) -> TypicalSizes | None:
    """Read the sizes of all states and inputs and the errors of all outputs, in rows or columns."""
    if not any(name in parts.tables for name in SIZES):
        return None

    def numbers(name: str, counts: Sequence[int]) -> list[list[Fraction]] | None:
        if name not in parts.tables:
            return None
        M = matrix(name, None, None)
        entries = [x for row in M.rows() for x in row]
        if len(entries) != sum(counts) or min(M.shape) > 1:
            raise InputError(
                f"expected a list of {sum(counts)} numbers, found {M.nrows} × {M.ncols}", where=name
            )
        for k, x in enumerate(entries):
            if x <= 0:
                raise InputError(f"expected a size above 0, found {x}", where=f"{name}[{k}]")
        ends = [*accumulate(counts)]
        return [entries[end - count : end] for end, count in zip(ends, counts, strict=True)]

    n = B[0].nrows
    states = numbers("state_sizes", [n])
    ratio = numbers("disturbances", [1])
    return TypicalSizes(
        None if states is None else states[0],
        numbers("input_sizes", [M.ncols for M in B]),
        numbers("output_errors", [M.nrows for M in C]),
        1 if ratio is None else ratio[0][0],
    )


def _tables_of_sizes(sizes: TypicalSizes) -> dict[str, Matrix]:
    """The tables of sizes, one row each."""
    rows: dict[str, list[Fraction]] = {}
    if sizes.states is not None:
        rows["state_sizes"] = [*sizes.states]
    for name, channels in (("input_sizes", sizes.inputs), ("output_errors", sizes.errors)):
        if channels is not None:
            rows[name] = [*chain(*channels)]
    rows["disturbances"] = [sizes.disturbances]
    return {name: Matrix.from_rows([row], ncols=len(row)) for name, row in rows.items()}


def parts_of(system: MultiChannelSystem) -> Parts:
    """The parts of a system, whose tables are matrices.

    Raises
    ------
    InputError
        If entries are uncertain: arrays have no place for radii.
    """
    if system.uncertainty is not None:
        raise InputError("only .json and .yaml files keep the radii of uncertain entries")
    if system.regulated is not None:
        raise InputError("only .json and .yaml files keep which outputs are regulated")
    if system.limits is not None:
        raise InputError("only .json and .yaml files keep the limits of inputs")
    tables: dict[str, Matrix] = {"A": system.A}
    for k, channel in enumerate(system.channels, start=1):
        tables[f"B_{k}"], tables[f"C_{k}"] = channel.B, channel.C
    if system.D is not None:
        tables["D"] = system.D
    if system.sample_time is not None:
        tables["sample_time"] = Matrix.from_rows([[system.sample_time]])
    if system.typical_sizes is not None:
        tables |= _tables_of_sizes(system.typical_sizes)
    graph = system.neighbors
    if graph is not None:
        m = system.m
        links = [[int(j in graph.neighborhood(i) and i != j) for j in range(m)] for i in range(m)]
        tables["neighbors"] = Matrix.from_integers(links)
        if graph.delays:
            steps = {(i, j): d for i, j, d in graph.delays}
            rows = [[steps.get((i, j), 0) for j in range(m)] for i in range(m)]
            tables["delays"] = Matrix.from_integers(rows)
    texts = {"time": "discrete" if is_discrete(system.time) else "continuous"}
    texts |= {"name": system.name} if system.name is not None else {}
    texts |= {"source": system.source} if system.source is not None else {}
    return Parts(tables, texts, system.names)


# Files of MATLAB, version 5, which ``save -v7`` and ``save -v6`` write.

MAGIC = b"MATLAB 5.0 MAT-file"
_HEADER = 128
_ARRAY, _COMPRESSED = 14, 15
_CELL, _TEXT, _SPARSE = 1, 4, 5
_NUMBERS = frozenset({_SPARSE, *range(6, 16)})
_CLASSES = {2: "a struct", 3: "an object", 16: "a function", 17: "an object"}
_COMPLEX, _LOGICAL = 0x0800, 0x0200
_BYTES, _INT32, _UINT32 = 2, 5, 6
_STORED = {
    **dict(enumerate(("i1", "u1", "i2", "u2", "i4", "u4", "f4"), start=1)),
    **dict(zip((9, 12, 13), ("f8", "i8", "u8"), strict=True)),
}
"""The names in numpy of the types of elements that hold numbers."""
_MEANT = {
    **dict(enumerate(("f8", "f8", "f4", "i1", "u1", "i2", "u2"), start=_SPARSE)),
    **dict(enumerate(("i4", "u4", "i8", "u8"), start=12)),
}
"""The names in numpy of the classes of matrices; a class is stored in any type that fits."""
_ENCODINGS = {1: "ascii", 2: "latin-1", 4: "utf-16", 16: "utf-8", 17: "utf-16", 18: "utf-32"}
"""The types of elements that hold texts."""


@dataclass(frozen=True)
class _Element:
    """An element: its type, and where its contents begin and end."""

    kind: int
    begin: int
    end: int

    @property
    def size(self) -> int:
        """The number of bytes of its contents."""
        return self.end - self.begin


@dataclass(frozen=True)
class _Array:
    """A variable, or an array in a cell: name, class, shape, and the elements that follow these."""

    name: str
    kind: int
    shape: tuple[int, int]
    contents: list[_Element]
    logical: bool = False

    @property
    def count(self) -> int:
        """The number of entries."""
        return self.shape[0] * self.shape[1]


def read_mat(data: bytes, limits: Limits, vocabulary: Vocabulary = SYSTEM) -> Parts:
    """Read the variables of a file: A, B, C and others, as in `Parts`; B and C may be cells.

    Raises
    ------
    InputError
        If it is damaged, larger than ``Limits.bytes`` when decompressed, or has a variable that is
        unknown or no matrix of real numbers.
    """
    try:
        return _File(*_decompressed(data, limits)).parts(vocabulary)
    except (struct.error, zlib.error, UnicodeDecodeError) as error:
        raise InputError(f"the file is damaged: {error}") from None


def _damaged(fault: str, where: str | None = None) -> InputError:
    return InputError(f"the file is damaged: {fault}", where=where or None)


def _decompressed(data: bytes, limits: Limits) -> tuple[bytes, str]:
    """The file with every variable decompressed, no larger than a file may be; its byte order."""
    order = {b"IM": "<", b"MI": ">"}.get(data[126:128])
    if order is None:
        raise _damaged("its byte order is unknown")
    (version,) = struct.unpack_from(f"{order}H", data, 124)
    if version >> 8 != 1:
        raise _damaged(f"expected version 1 in its header, found {version >> 8}")
    chunks, size = [data[:_HEADER]], _HEADER
    for element in _elements(data, order, _HEADER, len(data)):
        if element.kind == _COMPRESSED:
            stream = zlib.decompressobj()
            part = stream.decompress(data[element.begin : element.end], limits.bytes + 1 - size)
            if stream.unconsumed_tail or len(part) + size > limits.bytes:
                raise InputError(
                    f"expected at most {limits.bytes} bytes when decompressed (Limits.bytes), "
                    "found more"
                )
            if not stream.eof:
                raise _damaged("a compressed variable is incomplete")
        else:
            part = data[element.begin - 8 : element.end]
        chunks.append(part + bytes(-len(part) % 8))
        size += len(chunks[-1])
    return b"".join(chunks), order


def _elements(data: bytes, order: str, begin: int, end: int) -> Iterator[_Element]:
    """Yield the elements in a part of a file, whose ends are inside of it."""
    while begin < end:
        kind, size = struct.unpack_from(f"{order}II", data, begin)
        if kind >> 16:  # a size of at most 4, and contents within the 8 bytes
            kind, size, start, following = kind & 0xFFFF, kind >> 16, begin + 4, begin + 8
            if size > 4:
                raise _damaged(f"expected at most 4 bytes in a short element, found {size}")
        else:
            start = begin + 8
            following = start + size + (0 if kind == _COMPRESSED else -size % 8)
        if start + size > end:
            raise _damaged("it ends within a variable")
        yield _Element(kind, start, start + size)
        begin = following


class _File:
    """A file whose variables are decompressed."""

    def __init__(self, data: bytes, order: str) -> None:
        self._data, self._order = data, order

    def parts(self, vocabulary: Vocabulary) -> Parts:
        """Read all variables; the cells of B and C become B_1, C_1 and so on."""
        variables = self._variables()
        _require_variables(variables, vocabulary)
        tables: dict[str, Any] = {}
        texts: dict[str, str] = {}
        names = None
        for variable in variables:
            name = variable.name
            if name in vocabulary.texts:
                texts[name] = self._text(variable)
            elif name == "names":
                names = [self._text(each) for each in self._listed(variable)]
            elif variable.kind == _CELL:
                for k, each in enumerate(self._listed(variable), start=1):
                    tables[f"{name}_{k}"] = self._table(each)
            else:
                tables[name] = self._table(variable)
        return Parts(tables, texts, names)

    def _variables(self) -> list[_Array]:
        variables = []
        for element in _elements(self._data, self._order, _HEADER, len(self._data)):
            if element.kind != _ARRAY:
                raise _damaged(f"it has an element of type {element.kind}")
            variables.append(self._array(element))
        return variables

    def _array(self, element: _Element, cell: str = "") -> _Array:
        """Read the header of an array of real entries, possibly in a cell, and check its shape."""
        if cell and not element.size:  # how MATLAB writes a cell that was never set
            return _Array(cell, 6, (0, 0), [_Element(9, element.end, element.end)])
        contents = list(_elements(self._data, self._order, element.begin, element.end))
        if len(contents) < 3:
            raise _damaged("an array has no header", cell)
        flags, shape, name = contents[:3]
        if (flags.kind, flags.size) != (_UINT32, 8) or (shape.kind, shape.size % 4) != (_INT32, 0):
            raise _damaged("an array has no flags or no shape", cell)
        if name.kind != 1:
            raise _damaged(f"a name is of type {name.kind}", cell)
        (word,) = struct.unpack_from(f"{self._order}I", self._data, flags.begin)
        sides = struct.unpack_from(f"{self._order}{shape.size // 4}i", self._data, shape.begin)
        label = cell or self._data[name.begin : name.end].decode("ascii")
        kind = word & 0xFF
        if kind in _CLASSES:
            raise InputError(f"expected a matrix, found {_CLASSES[kind]}", where=label or None)
        if word & _COMPLEX:
            raise InputError("expected real numbers, found complex numbers", where=label or None)
        require_sides(sides, label)
        return _Array(label, kind, (sides[0], sides[1]), contents[3:], bool(word & _LOGICAL))

    def _listed(self, cell: _Array) -> list[_Array]:
        """The arrays in a cell array, column by column."""
        if len(cell.contents) != cell.count or any(e.kind != _ARRAY for e in cell.contents):
            raise _damaged("a cell array is incomplete", cell.name)
        wanted = {_TEXT} if cell.name == "names" else _NUMBERS
        arrays = [self._array(element, cell.name) for element in cell.contents]
        for each in arrays:
            _require_class(each, wanted)
        return arrays

    def _table(self, array: _Array) -> Any:
        """The numbers of an array."""
        if array.kind == _SPARSE:
            return self._sparse(array)
        if len(array.contents) != 1:
            raise _damaged(
                f"expected 1 element of numbers, found {len(array.contents)}", array.name
            )
        values = self._numbers(array.contents[0], array)
        if values.size != array.count:
            raise _damaged(
                f"{values.size} numbers do not fill {array.shape[0]} × {array.shape[1]} entries",
                array.name,
            )
        return values.reshape(array.shape, order="F")

    def _numbers(self, element: _Element, array: _Array) -> Any:
        """The numbers of an element: floats in the precision of their class, and integers.

        A class of floats is often stored as short integers, which are exact as they are.
        """
        import numpy as np

        stored, meant = self._stored(element, array.name), np.dtype(_MEANT[array.kind])
        if stored.dtype.kind == "f" == meant.kind:
            with np.errstate(all="ignore"):
                values = stored.astype(meant)
            if meant.itemsize >= stored.itemsize or np.array_equal(values, stored, equal_nan=True):
                return values
        elif stored.dtype.kind != "f":
            most = 2 ** (np.finfo(meant).nmant + 1) if meant.kind == "f" else np.iinfo(meant).max
            least = -most if meant.kind == "f" else np.iinfo(meant).min
            if not stored.size or (int(stored.min()) >= least and int(stored.max()) <= most):
                return stored
        raise _damaged(f"class {array.kind} does not hold its numbers", array.name)

    def _stored(self, element: _Element, where: str) -> Any:
        """The numbers of an element as they are stored."""
        import numpy as np

        if element.kind not in _STORED:
            raise _damaged(f"expected numbers, found an element of type {element.kind}", where)
        kind = np.dtype(self._order + _STORED[element.kind])
        if element.size % kind.itemsize:
            raise _damaged(
                f"{element.size} bytes are no numbers of {kind.itemsize} bytes each", where
            )
        return np.frombuffer(self._data, kind, element.size // kind.itemsize, element.begin)

    def _sparse(self, array: _Array) -> Any:
        """A sparse matrix, whose positions have to be inside, column by column and ascending.

        Its elements are the rows of its entries, for each column the position of its first entry
        among them, with the end of the last, and the entries; there can be room for more.
        """
        import numpy as np
        from scipy.sparse import csc_array

        nrows, ncols = array.shape
        if len(array.contents) != 3:
            raise _damaged("a sparse matrix is incomplete", array.name)
        for element in array.contents[:2]:
            if element.kind != _INT32:
                raise _damaged(f"positions are of type {element.kind}", array.name)
        rows, starts = (self._stored(each, array.name) for each in array.contents[:2])
        entries = array.contents[2]
        if array.logical and entries.size == rows.size:  # bytes, though MATLAB calls them floats
            entries = replace(entries, kind=_BYTES)
        values = self._numbers(entries, array)
        if starts.size != ncols + 1 or starts[0] != 0 or np.any(starts[1:] < starts[:-1]):
            raise _damaged("the columns of a sparse matrix have no positions", array.name)
        count = int(starts[-1])
        if min(rows.size, values.size) < count:
            raise _damaged("a sparse matrix has fewer entries than positions", array.name)
        rows, values = rows[:count].astype("i4"), values[:count]
        column = np.repeat(np.arange(ncols), np.diff(starts))
        place = column * nrows + rows
        if np.any((rows < 0) | (rows >= nrows)) or np.any(place[1:] <= place[:-1]):
            raise _damaged("a sparse matrix has rows that are outside or not in order", array.name)
        return csc_array((values, rows, starts.astype("i4")), shape=array.shape)

    def _text(self, array: _Array) -> str:
        """A text in one row."""
        if not array.contents and not array.count:
            return ""
        if array.shape[0] > 1:
            raise InputError(
                f"expected a text of one line, found {array.shape[0]}", where=array.name
            )
        if len(array.contents) != 1 or array.contents[0].kind not in _ENCODINGS:
            raise _damaged("a text has no characters", array.name)
        (element,) = array.contents
        encoding = _ENCODINGS[element.kind]
        if encoding[-2:] in ("16", "32"):
            encoding += "-le" if self._order == "<" else "-be"
        data = self._data[element.begin : element.end]
        text = data.decode(encoding)
        # Programs count characters, or the bytes or pairs of bytes that they stored.
        if array.count not in (len(text), len(data), len(text.encode("utf-16-le")) // 2):
            raise _damaged(f"{len(text)} characters do not fill {array.count}", array.name)
        return text


def _require_variables(variables: list[_Array], vocabulary: Vocabulary) -> None:
    """Refuse variables that are unknown, given twice, or of another class than their name has."""
    names = [variable.name for variable in variables]
    require_known(names, "variable", vocabulary)
    for k, variable in enumerate(variables):
        name = variable.name
        if name in names[:k]:
            raise InputError(f"the variable '{name}' is given twice")
        if name in vocabulary.cells and variable.kind == _CELL:
            continue
        if variable.kind == _CELL and name != "names":
            raise InputError("expected a matrix, found a cell array", where=name)
        _require_class(
            variable,
            {_CELL} if name == "names" else {_TEXT} if name in vocabulary.texts else _NUMBERS,
        )


def _require_class(array: _Array, wanted: frozenset[int] | set[int]) -> None:
    """Refuse an array of another class."""
    if array.kind not in wanted:
        what = {_TEXT: "a text", _CELL: "a cell array of texts"}.get(
            min(wanted), "a matrix of numbers"
        )
        raise InputError(f"expected {what}, found another class", where=array.name)


def mat_bytes(
    parts: Parts,
    rounding: Rounding | None,
    *,
    nearest: bool,
    vocabulary: Vocabulary = SYSTEM,
) -> bytes:
    """Write the variables of a file, of a system with B and C as cells; equal parts, equal bytes.

    Raises
    ------
    InputError
        If a number is no float from which the rounding makes it again, and `nearest` is false.
    """
    import scipy.io

    def array(M: Matrix, where: str) -> Any:
        if _is_whole(M):
            return matrix_to_float(M)
        return floats_of(M, where, rounding, nearest=nearest)

    cells: dict[str, list[Any]] = {letter: [] for letter in vocabulary.cells}
    variables: dict[str, Any] = {}
    for name, M in parts.tables.items():
        letter, _, number = name.partition("_")
        if number.isdigit():
            cells[letter].append(array(M, name))
        else:
            variables[name] = array(M, name)
    for letter, listed in cells.items():
        variables[letter] = _cell(listed)
    variables |= {"names": _cell(parts.names or ()), **parts.texts}
    if not all(_is_whole(M) for M in parts.tables.values()):
        variables[ROUNDING] = rounding or "dyadic"
    stream = io.BytesIO()
    scipy.io.savemat(stream, variables, do_compression=True)  # type: ignore[arg-type]
    header = MAGIC + b", written by mcexact"
    return header.ljust(124) + stream.getvalue()[124:]


def _is_whole(M: Matrix) -> bool:
    """Whether every entry is an integer that a float represents exactly."""
    return M.denominator == 1 and all(abs(x) <= LARGEST_WHOLE for _, _, x in M.nonzero())


def _cell(values: Any) -> Any:
    """A row of cells."""
    import numpy as np

    cell = np.empty((1, len(values)), dtype=object)
    for k, value in enumerate(values):
        cell[0, k] = value
    return cell


# Archives of numpy, which ``numpy.savez`` writes; nothing in them is unpickled.


def read_npz(files: Mapping[str, bytes], limits: Limits, vocabulary: Vocabulary = SYSTEM) -> Parts:
    """Read the arrays of an archive: A, B_1, C_1 and others, as in `Parts`.

    Parameters
    ----------
    files : mapping
        The contents of the members of the archive, by their names.
    limits : Limits
    vocabulary : Vocabulary, optional
        The names that are known, by default those of a system.

    Raises
    ------
    InputError
        If an array is damaged, unknown, or of objects.
    """
    known = {name.removesuffix(".npy"): data for name, data in files.items()}
    require_known(known, "array", vocabulary)
    tables: dict[str, Any] = {}
    texts: dict[str, str] = {}
    names = None
    for name, data in known.items():
        array = _array(data, name)
        if name in vocabulary.texts or name == "names":
            if array.dtype.kind != "U" or array.ndim != (name == "names"):
                expected = "expected texts" if name == "names" else "expected a text"
                raise InputError(expected, where=name)
            if name == "names":
                names = array.tolist()
            else:
                texts[name] = str(array)
        else:
            # A list and a number are matrices of one row.
            tables[name] = array.reshape(1, -1) if array.ndim < 2 and name != "A" else array
            require_sides(tables[name].shape, name)
    return Parts(tables, texts, names)


def _array(data: bytes, name: str) -> Any:
    """Read one array, whose size has to be that of its data."""
    import numpy as np
    from numpy.lib import format as npy

    stream = io.BytesIO(data)
    try:
        version = npy.read_magic(stream)
        read = {(1, 0): npy.read_array_header_1_0, (2, 0): npy.read_array_header_2_0}[version]
        shape, by_columns, dtype = read(stream)
    except KeyError:
        raise InputError("the version of this array is unknown", where=name) from None
    except Exception:  # the header is a Python literal, of which anything can be wrong
        raise InputError("the array is damaged: it has no header of numpy", where=name) from None
    if any(type(side) is not int for side in shape):  # numpy takes true for 1, not everywhere
        raise InputError("the array is damaged: its shape is not of integers", where=name)
    if dtype.hasobject or dtype.names is not None:
        raise InputError(
            "expected numbers or texts, found objects, which would have to be unpickled", where=name
        )
    if len(shape) > 2 or any(side < 0 for side in shape):
        require_sides(shape, name)
    count = 1
    for side in shape:
        count *= side
    rest = data[stream.tell() :]
    if max((0, *shape)) > len(data) or count * dtype.itemsize != len(rest) or not dtype.itemsize:
        if count == 0 and not rest and dtype.itemsize:
            return np.zeros(shape, dtype)
        raise InputError(
            f"the array is damaged: {len(rest)} bytes do not hold {' × '.join(map(str, shape))} "
            "entries",
            where=name,
        )
    if dtype.kind == "U" and np.any(np.frombuffer(rest, dtype.byteorder + "u4") > sys.maxunicode):
        raise InputError("the array is damaged: it has a character that is none", where=name)
    return np.frombuffer(rest, dtype).reshape(shape, order="F" if by_columns else "C")


def npz_bytes(parts: Parts, rounding: Rounding | None, *, nearest: bool) -> bytes:
    """Write the arrays of a system; equal parts give equal bytes.

    Integers become integers of 64 bits.  Other numbers become texts, which are exact, or floats if
    a rounding is given or the nearest ones are wanted.

    Raises
    ------
    InputError
        If a number is no float from which the rounding makes it again, and `nearest` is false.
    """
    import numpy as np

    def array(M: Matrix, where: str) -> Any:
        whole = integers_or_none(M)
        if whole is not None:
            return whole
        if rounding is not None or nearest:
            return floats_of(M, where, rounding, nearest=nearest)
        texts = [[str(decimal_or_quotient(x)) for x in row] for row in M.rows()]
        return np.array(texts)

    arrays = {name: array(M, name) for name, M in parts.tables.items()}
    arrays |= {name: np.array(text) for name, text in parts.texts.items()}
    arrays["names"] = np.array(parts.names)
    if any(value.dtype.kind == "f" for value in arrays.values()):
        arrays[ROUNDING] = np.array(rounding or "dyadic")
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, value in arrays.items():
            member = io.BytesIO()
            np.lib.format.write_array(member, value, version=(1, 0), allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{name}.npy"), member.getvalue())
    return stream.getvalue()


# Folders of .csv files, one for each matrix, with numbers as typed.

SETTINGS = tuple(text for text in TEXTS if text != ROUNDING)
"""The texts in ``system.csv``."""
MARK = "A.csv"
"""The file that every such folder has."""


def packed(folder: str | os.PathLike[str], limits: Limits) -> bytes:
    """Read the .csv files of a folder as an archive.

    Raises
    ------
    InputError
        If one cannot be read, or they are too large.
    """
    stream, size = io.BytesIO(), 0
    with zipfile.ZipFile(stream, "w") as archive:
        for path in sorted(Path(folder).glob("*.csv")):
            with InputError.inside(path.name):
                content = read_bytes(path, limits)
                size += len(content)
                if size > limits.bytes:
                    raise InputError(f"expected at most {limits.bytes} bytes (Limits.bytes)")
            archive.writestr(zipfile.ZipInfo(path.name), content)
    return stream.getvalue()


def read_csv_files(files: Mapping[str, bytes]) -> Parts:
    """Read the tables of a folder: A.csv, B_1.csv, C_1.csv and others, as in `Parts`.

    ``names.csv`` has the name of a channel on each line, and ``system.csv`` has lines ``key,value``
    with the keys time, sample_time, name and source.

    Raises
    ------
    InputError
        If a file is no table of numbers, or is unknown.
    """
    tables: dict[str, Any] = {}
    texts: dict[str, str] = {}
    names = None
    for file, data in files.items():
        stem = file.removesuffix(".csv")
        with InputError.inside(file):
            if stem == "system":
                texts = _settings(data, tables)
            elif stem == "names":
                names = [_single(row) for row in _rows(data)]
            else:
                require_known([stem], "table")
                if stem in SETTINGS:
                    raise InputError("write it into system.csv, as 'key,value'")
                if stem == ROUNDING:
                    raise InputError("leave it out: numbers in .csv files are read as typed")
                tables[stem] = [_entries(row) for row in _rows(data)]
                _require_width(tables[stem])
    return Parts(tables, texts, names)


def _settings(data: bytes, tables: dict[str, Any]) -> dict[str, str]:
    """Read ``system.csv``; the sample time is a table of one number."""
    texts: dict[str, str] = {}
    for row in _rows(data):
        if len(row) != 2:
            raise InputError(f"expected lines 'key,value', found {len(row)} entries")
        key, value = row
        if key == "sample_time" and key not in tables:
            tables[key] = [[_entry(value)]]
        elif key not in SETTINGS or key in texts:
            raise InputError(
                f"expected time, sample_time, name and source, each at most once, "
                f"found {quoted(key)}"
            )
        else:
            texts[key] = value
    return texts


def _single(row: list[str]) -> str:
    """The only entry of a row."""
    if len(row) != 1:
        raise InputError(f"expected one name on each line, found {len(row)} entries")
    return row[0]


def _entries(row: list[str]) -> list[str]:
    """The numbers of a row without the blanks around them."""
    plain = {text: _entry(text) for text in dict.fromkeys(row)}
    return row if all(map(str.__eq__, plain, plain.values())) else [plain[text] for text in row]


def _entry(text: str) -> str:
    """A number without the blanks around it."""
    number = text.strip()
    if "," in number or ";" in number:
        raise InputError(
            f"found {number[:40]!a}: write decimals with a point, and a comma between entries"
        )
    return number


def _require_width(rows: list[list[str]]) -> None:
    """Refuse rows of different lengths; the message counts lines as editors do."""
    for k, row in enumerate(rows, start=1):
        if len(row) != len(rows[0]):
            raise InputError(
                f"expected {len(rows[0])} entries in row {k} as in row 1, found {len(row)}"
            )


def _rows(data: bytes) -> list[list[str]]:
    """Read a table; lines without entries are left out."""
    try:
        text = data.decode("utf-8-sig")
        return [row for row in csv.reader(io.StringIO(text, newline=""), strict=True) if row]
    except UnicodeDecodeError as error:
        raise InputError(f"not UTF-8 text: byte {error.start}") from None
    except csv.Error as error:
        raise InputError(f"no table of entries between commas: {error}") from None


def csv_texts(parts: Parts) -> dict[str, str]:
    """Write the tables of a system, exactly; the keys are the names of files."""
    texts = {f"{name}.csv": _table(M) for name, M in parts.tables.items() if name != "sample_time"}
    if not parts.tables["A"].nrows:  # matrices without rows or without columns are empty files
        channels = range(1, len(parts.names or ()) + 1)
        texts["inputs.csv"] = _lines([[str(parts.tables[f"B_{k}"].ncols) for k in channels]])
        texts["outputs.csv"] = _lines([[str(parts.tables[f"C_{k}"].nrows) for k in channels]])
    if parts.names is not None:
        texts["names.csv"] = _lines([[name] for name in parts.names])
    settings = dict(parts.texts)
    if "sample_time" in parts.tables:
        settings["sample_time"] = str(decimal_or_quotient(parts.tables["sample_time"][0, 0]))
    texts["system.csv"] = _lines([[key, settings[key]] for key in sorted(settings)])
    return texts


def write_csv_files(folder: str | os.PathLike[str], files: Mapping[str, str]) -> None:
    """Write the .csv files of a system into a folder, and remove those of another system.

    Other files stay.  The file that every such folder has is removed first and written last, so
    that an interrupted folder is not read as a mixture of two systems.

    Raises
    ------
    NotWritten
        If a file cannot be written.
    InputError
        If the folder has a .csv file of something else.
    """
    place = Path(folder)
    try:
        place.mkdir(parents=True, exist_ok=True)
        former = sorted(path for path in place.glob("*.csv") if path.name not in files)
        for path in former:
            if path.stem not in ("system", "names"):
                with InputError.inside(os.fspath(path)):
                    require_known([path.stem], "table")
        for path in [place / MARK, *former]:
            path.unlink(missing_ok=True)
    except OSError as error:
        raise NotWritten(f"cannot write: {error.strerror}", where=os.fspath(folder)) from None
    for name in sorted(files, key=lambda name: name == MARK):
        write_text(place / name, files[name])


def _table(M: Matrix) -> str:
    return _lines([[str(decimal_or_quotient(x)) for x in row] for row in M.rows() if row])


def _lines(rows: list[list[str]]) -> str:
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerows(rows)
    return stream.getvalue()
