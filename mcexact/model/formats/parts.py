"""The parts of a system file that consists of arrays, and the system that they describe."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, cast, get_args

from mcexact.arguments import one_of
from mcexact.errors import InputError
from mcexact.exact.floats import Rounding
from mcexact.exact.location import is_discrete
from mcexact.exact.matrix import Matrix
from mcexact.model.formats.arrays import exact_matrix, require_entries
from mcexact.model.formats.reading import Reading
from mcexact.model.names import nearest, quoted
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.stacked import split_by_sizes
from mcexact.model.system import MultiChannelSystem

ROUNDING = "rounding"
"""How the floats of a file are read where the caller does not say."""
TEXTS = ("time", "name", "source", ROUNDING)
TABLES = ("neighbors", "delays", "inputs", "outputs", "sample_time")
KEYS = ("A", "B", "C", "D", *TABLES, *TEXTS, "names")
NUMBERED = re.compile(r"([BC])_([1-9][0-9]{0,5})")


@dataclass(frozen=True)
class Parts:
    """What a file of arrays has, by name.

    Attributes
    ----------
    tables : mapping
        Arrays, sparse arrays, or lists of rows of texts: ``A``; ``B_1``, ``C_1`` and so on, or the
        stacked ``B`` and ``C`` with the sizes ``inputs`` and ``outputs``; and those of `TABLES`.
    texts : mapping
        Those of `TEXTS`.
    names : sequence of str, optional
        The names of the channels.
    """

    tables: Mapping[str, Any]
    texts: Mapping[str, str] = field(default_factory=dict)
    names: Sequence[str] | None = None


def require_known(names: Iterable[str], what: str) -> None:
    """Refuse a name that has no meaning in a file of arrays.

    Raises
    ------
    InputError
        If there is one; a misspelled part must not be left out.
    """
    for name in names:
        if name not in KEYS and not NUMBERED.fullmatch(name):
            hint = nearest(name, KEYS) or "; known are A, B_1, C_1, …, or B, C, inputs, outputs"
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

    if ROUNDING in parts.texts:
        written = parts.texts[ROUNDING]
        one_of(written, get_args(Rounding), ROUNDING, InputError)
        reading = replace(reading, rounding=reading.rounding or cast(Rounding, written))
    require_entries(parts.tables.values(), reading.limits)

    def matrix(name: str, nrows: int | None, ncols: int | None) -> Matrix:
        return exact_matrix(parts.tables[name], name, reading, nrows, ncols)

    if "A" not in parts.tables:
        raise InputError("the matrix A is missing")
    A = matrix("A", None, None)
    B, C = _channels(parts, matrix, A.nrows, (reading.inputs, reading.outputs))
    names = parts.names if parts.names is not None else [str(k + 1) for k in range(len(B))]
    if "D" in parts.tables and not matrix("D", None, None).is_zero():
        raise InputError("expected zeros: outputs are y_i = C_i x, without feedthrough", where="D")
    time, sample_time = _time(parts, matrix)
    return MultiChannelSystem(
        A,
        B,
        C,
        time=time,
        sample_time=sample_time,
        names=names,
        neighbors=_graph(parts, matrix, tuple(names)),
        name=parts.texts.get("name"),
        source=parts.texts.get("source"),
    )


Read = Callable[[str, int | None, int | None], Matrix]
Sizes = tuple[Sequence[int] | None, Sequence[int] | None]
"""The numbers of inputs and of outputs of the channels, if B and C are stacked."""


def _channels(
    parts: Parts,
    matrix: Read,
    n: int,
    sizes: Sizes,
) -> tuple[list[Matrix], list[Matrix]]:
    """Read B_i and C_i, which are given one by one or stacked."""
    found = {(m[1], int(m[2])) for name in parts.tables if (m := NUMBERED.fullmatch(name))}
    if not found:
        return _stacked(parts, matrix, n, _sizes(parts, matrix, sizes))
    if "B" in parts.tables or "C" in parts.tables:
        raise InputError("both stacked matrices and matrices of channels are given: keep one kind")
    count = max(k for _, k in found)
    for k in range(1, count + 1):
        for letter in "BC":
            if (letter, k) not in found:
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
    for name, letter, given in zip(("inputs", "outputs"), "BC", sizes, strict=True):
        if letter not in parts.tables:
            raise InputError(f"the matrix {letter} is missing: give {letter}, or {letter}_1, …")
        if given is None:
            raise InputError(
                f"{letter} is stacked, and '{name}' is missing, the number of {name} of each "
                f"channel; add it, or write 'mcexact convert FILE --{name} 1,1 -o plant.json'"
            )
        split.append(list(given))
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


def parts_of(system: MultiChannelSystem) -> Parts:
    """The parts of a system, whose tables are matrices.

    Raises
    ------
    InputError
        If entries are uncertain: arrays have no place for radii.
    """
    if system.uncertainty is not None:
        raise InputError("only .json and .yaml files keep the radii of uncertain entries")
    tables: dict[str, Matrix] = {"A": system.A}
    for k, channel in enumerate(system.channels, start=1):
        tables[f"B_{k}"], tables[f"C_{k}"] = channel.B, channel.C
    if system.sample_time is not None:
        tables["sample_time"] = Matrix.from_rows([[system.sample_time]])
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
