"""System files, with parameters or without: read, written, digest, template.

The format is ``mcexact-system/1``.  Readers are strict: an unknown key, a wrong shape or a
malformed number is an error that names its place.  Decimals are exact as typed.  `unread_plant`
compares all shapes before any entry is read.  A file with the key ``parameters`` has texts in the
grammar of `model.entries` where others have numbers.  `template` returns a file to start from.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import partial
from typing import Any, TypeVar

from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix, block_diagonal
from mcexact.exact.rational import DEFAULT_LIMITS, Limits
from mcexact.exact.rational_functions import FunctionMatrix, RationalFunction
from mcexact.exact.roots import require_time
from mcexact.model.entries import (
    Entries,
    Table,
    checked_parameter,
    json_text_of_number,
    matrix_json,
    number_json,
    numbers,
    parse_expression,
    read_matrix,
    read_number,
    require_shape,
    require_square,
    sparse_matrix_text,
    unread_matrix,
)
from mcexact.model.graph import NeighborGraph
from mcexact.model.limits import limits_document, read_input_limits
from mcexact.model.parametric import ParametricSystem, require_ascending
from mcexact.model.radii import read_radii
from mcexact.model.regulated import read_selection, selection_document
from mcexact.model.sizes import read_sizes
from mcexact.model.system import FORMAT, MultiChannelSystem
from mcexact.model.text import (
    NumberText,
    checked_names,
    checked_text,
    expect_format,
    expect_integer,
    expect_list,
    expect_name,
    expect_object,
    expect_string,
    kind_of,
    numbers_of_any_length,
    parse,
    quoted,
    require_short_numbers,
)

# System files, ``mcexact-system/1``: read strictly, written canonically, and their digest.

M = TypeVar("M")

_REQUIRED = ("format", "time", "A", "channels")
_OPTIONAL = (
    *("name", "source", "sample_time", "neighbors", "delays", "D", "uncertainty", "sizes"),
    *("regulated", "limits", "parameters"),
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
    widths, counts = [M.shape[1] for M in B], [M.shape[0] for M in C]
    D = _read_feedthrough(document, widths, counts, limits)
    if D is not None and "uncertainty" in document:
        raise InputError("expected no radii where D is not zero", where="uncertainty")
    sample_time = None
    if "sample_time" in document:
        sample_time = read_number(document["sample_time"], "sample_time", limits)
    parts = A.matrix(), [B_i.matrix() for B_i in B], [C_i.matrix() for C_i in C]
    radii = None
    if "uncertainty" in document:
        radii = read_radii(document["uncertainty"], document, names, *parts, limits)
    sizes = None
    if "sizes" in document:
        sizes = read_sizes(document["sizes"], names, A.shape[0], widths, counts, limits)
    return MultiChannelSystem(
        *parts,
        D=D,
        time=document["time"],
        names=names,
        neighbors=_read_graph(document, names),
        sample_time=sample_time,
        uncertainty=radii,
        regulated=_read_regulated(document, names, counts, limits),
        limits=_read_limits(document, names, widths, limits),
        typical_sizes=sizes,
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
        Makes a matrix from its `Entries`.
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


def _read_feedthrough(
    document: Mapping[str, Any], p: Sequence[int], q: Sequence[int], limits: Limits
) -> Matrix | None:
    """Read D of the whole system, or of channels the blocks D_ii; None if all entries are 0.

    Raises
    ------
    InputError
        If a matrix that is not zero has another shape, or both are given.
    """
    whole, blocks = None, []
    if "D" in document:
        whole = _of_shape(document["D"], "D", sum(q), sum(p), limits)
    for k, channel in enumerate(document["channels"]):
        own = None
        if "D" in channel:
            own = _of_shape(channel["D"], f"channels[{k}].D", q[k], p[k], limits)
        blocks.append(Matrix.zeros(q[k], p[k]) if own is None else own)
    if all(block.is_zero() for block in blocks):
        return whole
    if whole is not None:
        raise InputError("expected D of the system or of its channels, found both", where="D")
    return block_diagonal(blocks)


def _of_shape(value: Any, where: str, nrows: int, ncols: int, limits: Limits) -> Matrix | None:
    """Read a feedthrough matrix; zeros of any shape are none."""
    D = read_matrix(value, where, limits=limits)
    return None if D.is_zero() else require_shape(D, where, nrows, ncols)


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


def _read_regulated(
    document: dict[str, Any], names: tuple[str, ...], counts: list[int], limits: Limits
) -> dict[str, Matrix] | None:
    """Read which combinations of outputs are regulated, by agent; None if nothing is said."""
    if "regulated" not in document:
        return None
    chosen = _mapping(document["regulated"], "regulated")
    return dict(zip(names, read_selection(chosen, names, counts, "regulated", limits), strict=True))


def _read_limits(
    document: dict[str, Any], names: tuple[str, ...], counts: list[int], limits: Limits
) -> dict[str, Any] | None:
    """Read the limits of inputs, by agent; None if nothing is said."""
    if "limits" not in document:
        return None
    chosen = _mapping(document["limits"], "limits")
    read = read_input_limits(chosen, names, counts, "limits", limits)
    return None if read is None else dict(zip(names, read, strict=True))


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
    if isinstance(system, MultiChannelSystem) and system.D is not None:
        head.append(("D", _matrix_text(system.D, "  ")))
    head.append(("channels", _channels_text(system)))
    if system.neighbors is not None:
        head.extend((key, json.dumps(value)) for key, value in system.neighbors.to_dict().items())
    if system.regulated is not None:
        selection = selection_document(system.regulated, system.names)
        with numbers_of_any_length():
            head.append(("regulated", json.dumps(selection)))
    if system.limits is not None:
        with numbers_of_any_length():
            head.append(("limits", json.dumps(limits_document(system.limits, system.names))))
    if system.uncertainty is not None:
        document = system.uncertainty.document(system.names)
        with numbers_of_any_length():
            head.append(("uncertainty", json.dumps(document)))
    if system.typical_sizes is not None:
        with numbers_of_any_length():
            head.append(("sizes", json.dumps(system.typical_sizes.document(system.names))))
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


# System files with parameters: ``mcexact-system/1`` with the key ``parameters``.

_REQUIRED_WITH_PARAMETERS = ("format", "time", "parameters", "A", "channels")
_OPTIONAL_WITH_PARAMETERS = ("name", "source")
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
    expect_object(document, None, _REQUIRED_WITH_PARAMETERS, _OPTIONAL_WITH_PARAMETERS)
    ranges = {}
    if not isinstance(document["parameters"], dict) or not document["parameters"]:
        raise InputError("expected an object keyed by parameters, at least one", where="parameters")
    for name, value in document["parameters"].items():
        where = f"parameters[{checked_parameter(name, 'parameters')}]"
        options = expect_object(value, where, (), ("range",))
        if "range" in options:
            ranges[name] = _range(options["range"], f"{where}.range", limits)
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


# A system file to start from, with every key explained.

_EXPLAINED = (
    "Replace this text by the source of the numbers. time: continuous or discrete. "
    'A: n rows of n numbers, such as 2, -0.5, 1e-3 or "1/3", read exactly as typed. '
    "channels: the name of each, B (n rows, a column per input) and C (a row per output). "
    "neighbors: for each agent those that it receives messages from; it may be left out. "
    'In discrete time, sample_time is a number, and delays {"valve": {"pump": 2}} says that '
    "messages from pump reach valve after 2 steps. A large matrix can be an object: "
    '{"shape": [n, n], "entries": [[row, column, value]]}, rows and columns from 0. '
    'regulated {"pump": [1]} says which outputs a set-point controller holds, counted from 1. '
    'limits {"pump": [[-1, 2]]} gives the least and the largest value of each input of an agent. '
    "D, a row for each output and a column for each input of all channels, is the direct effect of "
    "inputs on outputs; it may be left out. name and source are free texts."
)
_YAML = """\
# A system x' = A x + B_1 u_1 + B_2 u_2, y_i = C_i x, for mcexact.  Numbers are read exactly as they
# are typed: 2, -0.5, 1e-3, or "1/3" as a text.
format: mcexact-system/1       # as it is
name: two tanks                # a free text; may be left out
source: my own measurements    # a free text; may be left out
time: continuous               # or discrete: x(t+1) = A x + ...
# sample_time: 0.1             # in discrete time, if it is known; no decision uses it
A:                             # n rows of n numbers
- [-0.02, 0.02]
- [0.02, "-1/30"]
channels:                      # one for each agent, which sets u_i and measures y_i
- name: pump
  B: [[0.5], [0]]              # n rows, with a column for each input of this agent
  C: [[1, 0]]                  # a row of n numbers for each output of this agent
- name: valve
  B: [[0], [0.4]]
  C: [[0, 1]]
neighbors:                     # for each agent, whose messages it receives; may be left out
  pump: [valve]
  valve: [pump]
# regulated:                   # what a set-point controller holds, counted from 1; else all
#   pump: [1]
# D: [[0, 0], [0, 0]]          # outputs may depend on inputs at once: a row for each output and a
#                              # column for each input of all channels; else zeros
# limits:                      # the least and the largest value of each input of an agent
#   pump: [[-1, 2]]
# delays:                      # in discrete time: messages from valve reach pump after 2 steps
#   pump: {valve: 2}
"""


def template(kind: str) -> str:
    """The text of a starting file, JSON or YAML.

    Examples
    --------
    >>> from mcexact.model.system_file import read_system
    >>> read_system(template("json"))
    MultiChannelSystem(n=2, m=2, continuous time, channels: 'pump', 'valve')
    """
    if kind == "yaml":
        return _YAML
    lines = [
        ("format", "mcexact-system/1"),
        ("name", "two tanks"),
        ("source", _EXPLAINED),
        ("time", "continuous"),
    ]
    head = "".join(f'  "{key}": {json.dumps(value)},\n' for key, value in lines)
    return (
        "{\n" + head + '  "A": [[-0.02, 0.02], [0.02, "-1/30"]],\n'
        '  "channels": [\n'
        '    {"name": "pump",  "B": [[0.5], [0]], "C": [[1, 0]]},\n'
        '    {"name": "valve", "B": [[0], [0.4]], "C": [[0, 1]]}\n'
        "  ],\n"
        '  "neighbors": {"pump": ["valve"], "valve": ["pump"]}\n'
        "}\n"
    )
