"""Regulated outputs: which combinations S_i y_i of its outputs an agent holds at set-points.

A selection has one matrix S_i of q_i columns for each channel; an agent that holds nothing has one
without rows.  It says what a controller is for, and is no part of a plant: no digest depends on it.
Users name outputs of agents by their positions from 1 on, or give a matrix; `read_selection`
reads both, from a system file too, and `selection_document` writes them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import DEFAULT_LIMITS, Limits, rational_text
from mcexact.model.entries import as_matrix, matrix_json, read_matrix, require_shape
from mcexact.model.text import NumberText, expect_integer, kind_of, nearest, quoted

Selection = tuple[Matrix, ...]


def read_selection(
    value: Any,
    names: Sequence[str],
    counts: Sequence[int],
    where: str = "regulate",
    limits: Limits = DEFAULT_LIMITS,
) -> Selection:
    """Read what each agent holds at set-points.

    Parameters
    ----------
    value : mapping
        For some agents the positions of outputs, from 1 on, a matrix S_i, or None for every output
        of the agent; the other agents hold nothing.
    names : sequence of str
    counts : sequence of int
        The numbers q_i of outputs.
    where : str
    limits : Limits

    Raises
    ------
    InputError
        If an agent or an output does not exist, a matrix has a wrong shape, or nothing is held.

    Examples
    --------
    >>> first, second = read_selection({"left": [2]}, ["left", "right"], [2, 1])
    >>> first.numerators, second.shape
    (((0, 1),), (0, 1))
    >>> read_selection({"left": [3]}, ["left"], [2])
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: regulate['left']: expected outputs from 1 to 2, found 3
    """
    if not isinstance(value, Mapping):
        raise InputError(
            f"expected the outputs that are held by agent, found {kind_of(value)}", where=where
        )
    for name in value:
        if name not in names:
            raise InputError(
                f"there is no channel {quoted(str(name))}{nearest(str(name), names)}", where=where
            )
    selection = tuple(
        _rows(value.get(name, []), q, f"{where}[{quoted(name)}]", limits)
        for name, q in zip(names, counts, strict=True)
    )
    if not any(S.nrows for S in selection):
        raise InputError("expected at least one output that is held, found none", where=where)
    return selection


def _rows(value: Any, q: int, where: str, limits: Limits) -> Matrix:
    """Read S_i: positions from 1 on, or a matrix."""
    if value is None:
        return Matrix.identity(q)
    if not isinstance(value, list | tuple):
        exact = as_matrix(value, where, ncols=q)
    elif all(isinstance(each, int | NumberText) for each in value):
        positions = [expect_integer(each, where) for each in value]
        wrong = next((k for k in positions if not 1 <= k <= q), None)
        if wrong is not None:
            raise InputError(f"expected outputs from 1 to {q}, found {wrong}", where=where)
        return Matrix.identity(q).take(rows=[k - 1 for k in positions])
    elif any(isinstance(entry, NumberText) for row in value for entry in row):
        exact = read_matrix(value, where, ncols=q, limits=limits)
    else:
        exact = as_matrix(value, where, ncols=q)
    return require_shape(exact, where, exact.nrows, q)


def regulated_in(texts: Sequence[str]) -> dict[str, list[int] | None] | None:
    """Read what is held from texts such as ``left:1,3``, or ``left`` for all outputs of an agent.

    Raises
    ------
    InputError
        If no positions follow the last colon, or an agent occurs twice.

    Examples
    --------
    >>> regulated_in(["left:1,3", "right"]), regulated_in([])
    ({'left': [1, 3], 'right': None}, None)
    """
    chosen: dict[str, list[int] | None] = {}
    for text in texts:
        name, colon, listed = text.rpartition(":")
        parts = listed.split(",") if colon else []
        name = name if colon else text
        if name in chosen or not all(part.isascii() and part.isdigit() for part in parts):
            raise InputError(
                f"expected each agent once, as in left or left:1,3, found {quoted(text)}",
                where="--regulate",
            )
        chosen[name] = [int(part) for part in parts] if colon else None
    return chosen or None


def positions_of(S: Matrix) -> list[int] | None:
    """The positions, from 1 on, of the outputs that S selects; None if it combines outputs.

    Examples
    --------
    >>> positions_of(Matrix.identity(3).take(rows=[2, 0])), positions_of(Matrix.from_rows([[1, 1]]))
    ([3, 1], None)
    """
    found = []
    for row in S.rows():
        used = [k for k, entry in enumerate(row) if entry]
        if len(used) != 1 or row[used[0]] != 1:
            return None
        found.append(used[0] + 1)
    return found


def selection_document(selection: Selection, names: Sequence[str]) -> dict[str, Any]:
    """Write a selection as the key ``regulated`` of a system file has it.

    Examples
    --------
    >>> selection_document((Matrix.identity(2), Matrix.zeros(0, 1)), ["left", "right"])
    {'left': [1, 2]}
    """
    document: dict[str, Any] = {}
    for name, S in zip(names, selection, strict=True):
        if S.nrows:
            positions = positions_of(S)
            document[name] = matrix_json(S) if positions is None else positions
    return document


def selection_in_words(selection: Selection, names: Sequence[str]) -> str:
    """Say what is held, outputs as in trajectories.

    Examples
    --------
    >>> one, both = Matrix.identity(1), Matrix.from_rows([[1, "-1/2"]])
    >>> selection_in_words((one, both), ["left", "right"])
    'left, right[1] - 1/2 right[2]'
    """
    parts = []
    for name, S in zip(names, selection, strict=True):
        outputs = [name] if S.ncols == 1 else [f"{name}[{k + 1}]" for k in range(S.ncols)]
        parts += [_sum(row, outputs) for row in S.rows()]
    return ", ".join(parts)


def _sum(row: Sequence[Fraction], outputs: Sequence[str]) -> str:
    """Write a combination of outputs."""
    text = ""
    for x, output in zip(row, outputs, strict=True):
        if x:
            size = "" if abs(x) == 1 else f"{rational_text(abs(x))} "
            sign = ("-" if x < 0 else "") if not text else (" - " if x < 0 else " + ")
            text += f"{sign}{size}{output}"
    return text or "0"
