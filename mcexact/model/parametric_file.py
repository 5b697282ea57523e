"""System files with parameters: ``mcexact-system/1`` with the key ``parameters``."""

from __future__ import annotations

import json
import os
from fractions import Fraction
from typing import Any

from mcexact.errors import InputError, place_of
from mcexact.exact.function_matrix import FunctionMatrix
from mcexact.exact.location import require_time
from mcexact.exact.rational import DEFAULT_LIMITS, Limits
from mcexact.exact.rational_function import RationalFunction
from mcexact.exact.rows import common_width
from mcexact.model.atomic import write_text
from mcexact.model.expression import checked_parameter, parse_expression
from mcexact.model.json_text import (
    NumberText,
    expect_format,
    expect_integer,
    expect_list,
    expect_name,
    expect_object,
    expect_string,
    parse,
    read_bytes,
    require_short_numbers,
)
from mcexact.model.matrix_entry import require_shape, require_square
from mcexact.model.matrix_json import LONGEST_SIDE, read_number
from mcexact.model.names import checked_names
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system_file import FORMAT

_REQUIRED = ("format", "time", "parameters", "A", "channels")
_OPTIONAL = ("name", "source")


def load_parametric_system(
    path: str | os.PathLike[str], *, limits: Limits = DEFAULT_LIMITS
) -> ParametricSystem:
    """Read a system with parameters from a file.

    Parameters
    ----------
    path : path
        ``-`` is the standard input.
    limits : Limits, optional

    Raises
    ------
    InputError
        If the file is missing, unreadable, too large or malformed; the message says where.
    """
    with InputError.inside(place_of(path)):
        return read_parametric_system(read_bytes(path, limits), limits=limits)


def read_parametric_system(
    data: bytes | str, *, limits: Limits = DEFAULT_LIMITS
) -> ParametricSystem:
    """Read a system with parameters from the text of a system file.

    Parameters
    ----------
    data : bytes or str
    limits : Limits, optional

    Raises
    ------
    InputError
        If it is malformed; the message says where.

    Examples
    --------
    >>> read_parametric_system('''{"format": "mcexact-system/1", "time": "continuous",
    ...     "parameters": {"t": {"range": [0, "1/2"]}}, "A": [["1/2 + 3*t^2"]],
    ...     "channels": [{"B": [[1]], "C": [["t/(1 + t)"]]}]}''')
    ParametricSystem(n=1, m=1, continuous time, parameters: t in [0, 1/2], channels: '1')
    """
    document = expect_format(parse(data, limits), FORMAT)
    expect_object(document, None, _REQUIRED, _OPTIONAL)
    require_time(document["time"])
    ranges = {}
    if not isinstance(document["parameters"], dict) or not document["parameters"]:
        raise InputError("expected an object keyed by parameters, at least one", where="parameters")
    for name, said in document["parameters"].items():
        where = f"parameters[{checked_parameter(name, 'parameters')}]"
        found = expect_object(said, where, (), ("range",))
        if "range" in found:
            ranges[name] = _range(found["range"], f"{where}.range", limits)
    parameters = tuple(sorted(document["parameters"]))
    A = require_square(_matrix(document["A"], "A", parameters, limits), "A")
    channels = expect_list(document["channels"], "channels")
    names, places, B, C = [], [], [], []
    for k, channel in enumerate(channels):
        where = f"channels[{k}]"
        expect_object(channel, where, ("B", "C"), ("name",))
        places.append(f"{where}.name")
        names.append(expect_name(channel.get("name", str(k + 1)), places[k]))
        inputs = _matrix(channel["B"], f"{where}.B", parameters, limits)
        outputs = _matrix(channel["C"], f"{where}.C", parameters, limits, A.nrows)
        B.append(require_shape(inputs, f"{where}.B", A.nrows, None))
        C.append(require_shape(outputs, f"{where}.C", None, A.nrows))
    texts = {key: expect_string(document[key], key) for key in _OPTIONAL if key in document}
    system = ParametricSystem(
        A,
        B,
        C,
        parameters=parameters,
        assume=ranges,
        time=document["time"],
        names=checked_names(names, places),
        name=texts.get("name"),
        source=texts.get("source"),
    )
    require_short_numbers(data, limits)
    return system


def _range(value: Any, where: str, limits: Limits) -> tuple[Fraction | None, Fraction | None]:
    ends = expect_list(value, where)
    if len(ends) != 2:
        raise InputError(f"expected two ends, found {len(ends)}", where=where)
    low, high = (None if end is None else read_number(end, where, limits) for end in ends)
    return low, high


def _matrix(
    value: Any, where: str, parameters: tuple[str, ...], limits: Limits, ncols: int = 0
) -> FunctionMatrix:
    """A list of rows, or an object that lists the entries that are not 0."""
    if isinstance(value, dict):
        return _listed(value, where, parameters, limits)
    rows = [expect_list(row, f"{where}[{i}]") for i, row in enumerate(expect_list(value, where))]
    width = common_width(rows, where)
    found = tuple(
        tuple(_entry(v, f"{where}[{i}][{j}]", parameters, limits) for j, v in enumerate(row))
        for i, row in enumerate(rows)
    )
    return FunctionMatrix(found, ncols if width is None else width)


def _listed(value: Any, where: str, parameters: tuple[str, ...], limits: Limits) -> FunctionMatrix:
    given = expect_object(value, where, ("shape", "entries"))
    sides = [
        expect_integer(v, f"{where}.shape") for v in expect_list(given["shape"], f"{where}.shape")
    ]
    if len(sides) != 2 or sides[0] * sides[1] > LONGEST_SIDE:
        raise InputError("expected a number of rows and of columns", where=f"{where}.shape")
    zero = RationalFunction.constant(0, parameters)
    rows = [[zero] * sides[1] for _ in range(sides[0])]
    seen = set()
    for k, triple in enumerate(expect_list(given["entries"], f"{where}.entries")):
        place = f"{where}.entries[{k}]"
        i, j, entry = [*expect_list(triple, place), None, None, None][:3]
        i, j = expect_integer(i, place), expect_integer(j, place)
        if len(triple) != 3 or i >= sides[0] or j >= sides[1] or (i, j) in seen:
            raise InputError("expected a position of its own inside, and an entry", where=place)
        seen.add((i, j))
        rows[i][j] = _entry(entry, place, parameters, limits)
    return FunctionMatrix(tuple(map(tuple, rows)), sides[1])


def _entry(value: Any, where: str, parameters: tuple[str, ...], limits: Limits) -> RationalFunction:
    """A number as typed, or an expression in quotes."""
    if isinstance(value, str) and not isinstance(value, NumberText):
        return parse_expression(value, parameters, limits, where=where)
    return RationalFunction.constant(read_number(value, where, limits), parameters)


def save_parametric_system(system: ParametricSystem, path: str | os.PathLike[str]) -> None:
    """Write a system with parameters as a system file, completely or not at all.

    Parameters
    ----------
    system : ParametricSystem
    path : path

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    texts = {key: getattr(system, key) for key in _OPTIONAL if getattr(system, key) is not None}
    document = {"format": FORMAT, **texts, **system.document()}
    write_text(path, json.dumps(document, indent=1) + "\n")
