"""System files with parameters: ``mcexact-system/1`` with the key ``parameters``."""

from __future__ import annotations

from fractions import Fraction
from functools import partial
from typing import Any

from mcexact.errors import InputError
from mcexact.exact.function_matrix import FunctionMatrix
from mcexact.exact.rational import DEFAULT_LIMITS, Limits
from mcexact.exact.rational_function import RationalFunction
from mcexact.model.expression import checked_parameter, parse_expression
from mcexact.model.json_text import (
    NumberText,
    expect_format,
    expect_list,
    expect_object,
    parse,
    require_short_numbers,
)
from mcexact.model.matrix_json import Entries, read_number
from mcexact.model.parametric import ParametricSystem, require_ascending
from mcexact.model.system_file import texts_of, unread_plant
from mcexact.model.system_forms import FORMAT

_REQUIRED = ("format", "time", "parameters", "A", "channels")
_OPTIONAL = ("name", "source")
_MOST_CELLS = 2**20


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
    system = read_parametric_document(parse(data, limits), limits)
    require_short_numbers(data, limits)
    return system


def read_parametric_document(parsed: Any, limits: Limits = DEFAULT_LIMITS) -> ParametricSystem:
    """Read a system with parameters from the parsed document of a system file.

    Raises
    ------
    InputError
        If it is malformed; the message says where.
    """
    document = expect_format(parsed, FORMAT)
    if "parameters" not in document:
        raise InputError("found a system without parameters, which load_system reads")
    expect_object(document, None, _REQUIRED, _OPTIONAL)
    ranges = {}
    if not isinstance(document["parameters"], dict) or not document["parameters"]:
        raise InputError("expected an object keyed by parameters, at least one", where="parameters")
    for name, said in document["parameters"].items():
        where = f"parameters[{checked_parameter(name, 'parameters')}]"
        found = expect_object(said, where, (), ("range",))
        if "range" in found:
            ranges[name] = _range(found["range"], f"{where}.range", limits)
    parameters = tuple(sorted(document["parameters"]))
    read = partial(_functions, parameters=parameters, limits=limits)
    A, names, B, C = unread_plant(document, read, ())
    return ParametricSystem(
        A.matrix(),
        [B_i.matrix() for B_i in B],
        [C_i.matrix() for C_i in C],
        parameters=parameters,
        assume=ranges,
        time=document["time"],
        names=names,
        **texts_of(document),
    )


def _range(value: Any, where: str, limits: Limits) -> tuple[Fraction | None, Fraction | None]:
    ends = expect_list(value, where)
    if len(ends) != 2:
        raise InputError(f"expected two ends, found {len(ends)}", where=where)
    low, high = (None if end is None else read_number(end, where, limits) for end in ends)
    require_ascending(low, high, where)
    return low, high


def _functions(entries: Entries, parameters: tuple[str, ...], limits: Limits) -> FunctionMatrix:
    """Read the functions of a matrix."""
    r, c = entries.shape
    if entries.rows is not None:
        return FunctionMatrix(
            tuple(
                tuple(
                    _entry(value, f"{entries.where}[{i}][{j}]", parameters, limits)
                    for j, value in enumerate(row)
                )
                for i, row in enumerate(entries.rows)
            ),
            c,
        )
    if r * c > _MOST_CELLS:
        raise InputError(
            f"expected at most {_MOST_CELLS} entries in a matrix of functions, found {r} × {c}",
            where=entries.where,
        )
    zero = RationalFunction.constant(0, parameters)
    rows = [[zero] * c for _ in range(r)]
    for k, i, j, value in entries.listed():
        rows[i][j] = _entry(value, f"{entries.place(k)}[2]", parameters, limits)
    return FunctionMatrix(tuple(map(tuple, rows)), c)


def _entry(value: Any, where: str, parameters: tuple[str, ...], limits: Limits) -> RationalFunction:
    """A number as typed, or an expression in quotes."""
    if isinstance(value, str) and not isinstance(value, NumberText):
        return parse_expression(value, parameters, limits, where=where)
    return RationalFunction.constant(read_number(value, where, limits), parameters)
