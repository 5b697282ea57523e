"""Controller files: one program for each agent, read strictly, written completely or not at all."""

from __future__ import annotations

import json
import os
import re
from fractions import Fraction
from typing import Any

from mcexact.errors import InputError, place_of
from mcexact.exact.location import require_time
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import DEFAULT_LIMITS, Limits, decimal_or_quotient
from mcexact.model.atomic import write_text
from mcexact.model.controller import MAPS, AgentProgram, Controller, LinearMap
from mcexact.model.json_text import (
    expect_format,
    expect_integer,
    expect_list,
    expect_name,
    expect_object,
    expect_string,
    parse,
    read_bytes,
    require_short_numbers,
    require_start,
)
from mcexact.model.matrix_json import read_matrix
from mcexact.model.names import checked_names, nearest, quoted

FORMAT = "mcexact-controller/1"
_OTHERS = (
    "a controller file is JSON; in Python, local_controllers makes a controller of matrices, "
    "or of systems of python-control"
)


def load_controller(path: str | os.PathLike[str], limits: Limits = DEFAULT_LIMITS) -> Controller:
    """Read a controller from a file, or from standard input for ``-``.

    Parameters
    ----------
    path : path
        ``-`` is the standard input.
    limits : Limits, optional

    Raises
    ------
    InputError
        If it is missing, unreadable or malformed; the message says where.
    """
    with InputError.inside(place_of(path)):
        return read_controller(read_bytes(path, limits), limits)


def read_controller(text: bytes | str, limits: Limits = DEFAULT_LIMITS) -> Controller:
    """Read the text of a controller file.

    Raises
    ------
    InputError
        If the text is malformed; the message says where, what was expected and what was found.
    """
    require_start(text, _OTHERS)
    document = expect_format(parse(text, limits), FORMAT)
    expect_object(document, None, ("format", "time", "system", "agents"))
    require_time(document["time"])
    expect_string(document["system"], "system", "the digest of a system, a string")
    agents = expect_list(document["agents"], "agents")
    if not agents:
        raise InputError("expected at least one agent, found none", where="agents")
    keys = ("name", "shared", "private", *MAPS)
    for k, agent in enumerate(agents):
        expect_object(agent, f"agents[{k}]", keys, ("hold",))
    places = [f"agents[{k}].name" for k in range(len(agents))]
    given = [expect_name(agent["name"], place) for agent, place in zip(agents, places, strict=True)]
    names = checked_names(given, places)
    sizes = [expect_integer(a["shared"], f"agents[{k}].shared") for k, a in enumerate(agents)]
    programs = [
        _read_agent(agent, f"agents[{k}]", names, sizes, limits) for k, agent in enumerate(agents)
    ]
    require_short_numbers(text, limits)
    return Controller(document["time"], document["system"], tuple(programs))


def _read_agent(
    agent: dict[str, Any], where: str, names: tuple[str, ...], sizes: list[int], limits: Limits
) -> AgentProgram:
    """Read one program; ``sizes`` are the dimensions of all shared sub-states."""
    shared = sizes[names.index(agent["name"])]
    private = expect_integer(agent["private"], f"{where}.private")
    shared_update, private_update, given = (
        _read_map(agent[label], f"{where}.{label}", size, names, (sizes, private), limits)
        for label, size in zip(MAPS, (shared, private, None), strict=True)
    )
    hold = {}
    for name, steps in _by_agent(agent.get("hold", {}), f"{where}.hold", names).items():
        hold[name] = expect_integer(steps, f"{where}.hold[{quoted(names[name])}]")
    return AgentProgram(agent["name"], shared, private, shared_update, private_update, given, hold)


def _read_map(
    value: Any,
    where: str,
    nrows: int | None,
    names: tuple[str, ...],
    widths: tuple[list[int], int],
    limits: Limits,
) -> LinearMap:
    """Read one linear map; ``widths`` are the dimensions of all x_j, and that of z_i."""
    expect_object(value, where, (), ("outputs", "shared", "private", "reference"))

    def matrix(entry: Any, place: str, ncols: int | None = None) -> Matrix:
        return read_matrix(entry, place, nrows, ncols, limits)

    def by_agent(key: str, sizes: list[int] | None) -> dict[int, Matrix]:
        found = _by_agent(value.get(key, {}), f"{where}.{key}", names)
        return {
            j: matrix(M, f"{where}.{key}[{quoted(names[j])}]", sizes[j] if sizes else None)
            for j, M in found.items()
        }

    found = LinearMap(
        by_agent("outputs", None),
        by_agent("shared", widths[0]),
        matrix(value["private"], f"{where}.private", widths[1]) if "private" in value else None,
        matrix(value["reference"], f"{where}.reference") if "reference" in value else None,
    )
    heights = sorted({M.nrows for M in found.matrices()})
    if len(heights) > 1:
        raise InputError(
            f"expected matrices of one number of rows, found {heights[0]} and {heights[1]}",
            where=where,
        )
    return found


def _by_agent(value: Any, where: str, names: tuple[str, ...]) -> dict[int, Any]:
    """Read an object keyed by agents' names, and return it keyed by positions, ascending."""
    if not isinstance(value, dict):
        raise InputError("expected an object keyed by agents", where=where)
    for name in value:
        if name not in names:
            raise InputError(f"there is no agent {quoted(name)}{nearest(name, names)}", where=where)
    return {j: value[name] for j, name in enumerate(names) if name in value}


def controller_document(controller: Controller) -> dict[str, Any]:
    """The object of a controller file as plain data, with quotients as strings."""
    return {"format": FORMAT, "system": controller.system, **controller.document()}


def controller_text(controller: Controller) -> str:
    """The text of a controller file: decimals where they are exact and short, a row on one line."""
    document = {"format": FORMAT, "system": controller.system, **_readable(controller.document())}
    text = json.dumps(document, indent=1, ensure_ascii=True)
    return _LIST_OF_NUMBERS.sub(lambda found: f"[{' '.join(found[0][1:-1].split())}]", text) + "\n"


_LONG = 40
_LIST_OF_NUMBERS = re.compile(r"\[\s[^\[\]{}]*\]")


def _readable(value: Any, *, listed: bool = False) -> Any:
    """Write short quotients in lists as decimals; other strings are names."""
    if isinstance(value, dict):
        return {key: _readable(each) for key, each in value.items()}
    if isinstance(value, list):
        return [_readable(each, listed=True) for each in value]
    if listed and isinstance(value, str) and len(value) <= _LONG:
        return decimal_or_quotient(Fraction(value))
    return value


def save_controller(controller: Controller, path: str | os.PathLike[str]) -> None:
    """Write a controller file, completely or not at all.

    Parameters
    ----------
    controller : Controller
    path : path

    Raises
    ------
    NotWritten
        If the file cannot be written.
    """
    InputError.require(controller, Controller, "controller")
    write_text(path, controller_text(controller))
