"""System files, ``mcexact-system/1``: read strictly, written canonically, and their digest."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, TypeVar

from mcexact.errors import InputError
from mcexact.exact.function_matrix import FunctionMatrix
from mcexact.exact.location import require_time
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import DEFAULT_LIMITS, Limits
from mcexact.model.canonical import numbers_of_any_length
from mcexact.model.json_text import (
    expect_format,
    expect_integer,
    expect_list,
    expect_name,
    expect_object,
    expect_string,
    kind_of,
    parse,
    require_short_numbers,
)
from mcexact.model.matrix_entry import Table, require_square
from mcexact.model.matrix_json import (
    Entries,
    json_text_of_number,
    matrix_json,
    number_json,
    numbers,
    read_matrix,
    read_number,
    sparse_matrix_text,
    unread_matrix,
)
from mcexact.model.names import checked_names, checked_text, quoted
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_forms import FORMAT
from mcexact.model.uncertainty import read_radii

M = TypeVar("M")

_REQUIRED = ("format", "time", "A", "channels")
_OPTIONAL = (
    *("name", "source", "sample_time", "neighbors", "delays", "D", "uncertainty", "parameters"),
)


def read_system(data: bytes | str, *, limits: Limits = DEFAULT_LIMITS) -> MultiChannelSystem:
    """Read a system from the text of a system file.

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
    >>> read_system('''{"format": "mcexact-system/1", "time": "continuous", "A": [[0.1]],
    ...     "channels": [{"name": "1", "B": [[1]], "C": [[1]]}]}''').A[0, 0]
    Fraction(1, 10)
    >>> read_system('{"format": "mcexact-system/1", "time": "continuous", "A": [], "chanels": []}')
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: unknown key 'chanels' (did you mean 'channels'?)
    """
    system = read_document(parse(data, limits), limits)
    require_short_numbers(data, limits)
    return system


def read_document(parsed: Any, limits: Limits = DEFAULT_LIMITS) -> MultiChannelSystem:
    """Read a system from the parsed document of a system file.

    Raises
    ------
    InputError
        If it is malformed; the message says where.
    """
    document = expect_format(parsed, FORMAT)
    if "parameters" in document:
        raise InputError(
            "found a system with parameters, which need values here: `mcexact convert FILE "
            "--at NAME=1/2 -o OTHER` writes the system with them, with one --at for each; in "
            "Python load_parametric_system reads it, and .at({…}) takes values"
        )
    expect_object(document, None, _REQUIRED, _OPTIONAL)
    A, names, B, C = unread_plant(document, partial(numbers, limits=limits))
    if "D" in document:
        _refuse_feedthrough(document["D"], "D", limits)
    for k, channel in enumerate(document["channels"]):
        if "D" in channel:
            _refuse_feedthrough(channel["D"], f"channels[{k}].D", limits)
    sample_time = None
    if "sample_time" in document:
        sample_time = read_number(document["sample_time"], "sample_time", limits)
    parts = A.matrix(), [B_i.matrix() for B_i in B], [C_i.matrix() for C_i in C]
    radii = None
    if "uncertainty" in document:
        radii = read_radii(document["uncertainty"], document, names, *parts, limits)
    return MultiChannelSystem(
        *parts,
        time=document["time"],
        names=names,
        neighbors=_read_graph(document, names),
        sample_time=sample_time,
        uncertainty=radii,
        **texts_of(document),
    )


def texts_of(document: Mapping[str, Any]) -> dict[str, str]:
    """The name and the source that a document has.

    Raises
    ------
    InputError
        If one of them is no text, or a long one.
    """
    return {
        key: checked_text(expect_string(document[key], key), key)
        for key in ("name", "source")
        if key in document
    }


def unread_plant(
    document: Mapping[str, Any], read: Callable[[Entries], M], more: Sequence[str] = ("D",)
) -> tuple[Table[M], tuple[str, ...], list[Table[M]], list[Table[M]]]:
    """Read time and names, and compare all shapes before entries are read.

    Parameters
    ----------
    document : mapping
    read : callable
        Makes a matrix of its entries.
    more : sequence of str
        The keys that a channel may have besides B, C and name.

    Returns
    -------
    A, names, list of B_i, list of C_i

    Raises
    ------
    InputError
        If the time, a channel, a name or a shape is not as expected.
    """
    require_time(document["time"])
    A = require_square(unread_matrix(document["A"], "A", None, None, read), "A")
    channels = expect_list(document["channels"], "channels")
    if not channels:
        raise InputError("expected at least one channel, found none", where="channels")
    n, names, places, B, C = A.shape[0], [], [], [], []
    for k, channel in enumerate(channels):
        where = f"channels[{k}]"
        expect_object(channel, where, ("B", "C"), ("name", *more))
        places.append(f"{where}.name")
        names.append(expect_name(channel.get("name", str(k + 1)), places[k]))
        B.append(unread_matrix(channel["B"], f"{where}.B", n, None, read))
        C.append(unread_matrix(channel["C"], f"{where}.C", None, n, read))
    return A, checked_names(names, places), B, C


def _refuse_feedthrough(value: Any, where: str, limits: Limits) -> None:
    """Raise an error unless a feedthrough matrix is zero."""
    if not read_matrix(value, where, limits=limits).is_zero():
        raise InputError(
            "expected zeros: outputs are y_i = C_i x, without direct feedthrough of an input; "
            "the theory used here does not cover it",
            where=where,
        )


def _read_graph(document: dict[str, Any], names: tuple[str, ...]) -> NeighborGraph | None:
    """Read the neighbor graph with its delays."""
    if "neighbors" not in document:
        if "delays" in document:
            raise InputError("delays need links: the key 'neighbors' is missing", where="delays")
        return None
    neighbors = _mapping(document["neighbors"], "neighbors")
    for name, heard in neighbors.items():
        where = f"neighbors[{quoted(name)}]"
        for k, other in enumerate(expect_list(heard, where)):
            expect_name(other, f"{where}[{k}]")
    delays = {}
    for name, row in _mapping(document.get("delays", {}), "delays").items():
        where = f"delays[{quoted(name)}]"
        delays[name] = {
            other: expect_integer(delay, f"{where}[{quoted(other)}]")
            for other, delay in _mapping(row, where).items()
        }
    return NeighborGraph.from_names(names, neighbors, delays)


def _mapping(value: Any, where: str) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise InputError(f"expected an object keyed by agents, found {kind_of(value)}", where=where)
    return value


def system_text(system: MultiChannelSystem | ParametricSystem) -> str:
    """Return the text of a system file, with one line for each row of a matrix."""
    head: list[tuple[str, str]] = [("format", json.dumps(FORMAT))]
    for key, text in (("name", system.name), ("source", system.source)):
        if text is not None:
            head.append((key, json.dumps(text)))
    head.append(("time", json.dumps(system.time)))
    if isinstance(system, ParametricSystem):
        head.append(("parameters", json.dumps(system.document()["parameters"])))
    elif system.sample_time is not None:
        head.append(("sample_time", json_text_of_number(number_json(system.sample_time))))
    head.append(("A", _matrix_text(system.A, "  ")))
    head.append(("channels", _channels_text(system)))
    if system.neighbors is not None:
        head.extend((key, json.dumps(value)) for key, value in system.neighbors.to_dict().items())
    if system.uncertainty is not None:
        document = system.uncertainty.document(system.names)
        with numbers_of_any_length():
            head.append(("uncertainty", json.dumps(document)))
    return "{\n" + ",\n".join(f'  "{key}": {text}' for key, text in head) + "\n}\n"


def _channels_text(system: MultiChannelSystem | ParametricSystem) -> str:
    blocks = []
    for channel in system.channels:
        lines = [
            f'      "name": {json.dumps(channel.name)}',
            f'      "B": {_matrix_text(channel.B, "      ")}',
            f'      "C": {_matrix_text(channel.C, "      ")}',
        ]
        blocks.append("    {\n" + ",\n".join(lines) + "\n    }")
    return "[\n" + ",\n".join(blocks) + "\n  ]"


def _matrix_text(M: Matrix | FunctionMatrix, indent: str) -> str:
    """Return the JSON text of a matrix, on one line if it is short, else one line for each row."""
    if isinstance(M, Matrix):
        M = M.suited()
        if M.is_sparse:
            return sparse_matrix_text(M, f",\n{indent}  ")
    value = matrix_json(M)
    if isinstance(value, dict) or not value:
        return json.dumps(value)
    rows = ["[" + ", ".join(map(json_text_of_number, row)) + "]" for row in value]
    if sum(map(len, rows)) + 2 * len(rows) <= 80 - len(indent):
        return "[" + ", ".join(rows) + "]"
    return "[\n" + ",\n".join(f"{indent}  {row}" for row in rows) + f"\n{indent}]"
