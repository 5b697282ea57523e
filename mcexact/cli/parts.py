"""The option ``--modulo`` of several commands: the plant without a part of its state.

The part is named, or a file has a subspace of the user's: ``{"unobservable": [[1, 1, 1]]}``.
`taken` reads the file in the parent process, as other inputs are read; `without` makes the system
that the answers are about, in the child process.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import Any

import click

from mcexact.cli import options
from mcexact.cli.running import Run
from mcexact.errors import InputError, UsageError
from mcexact.exact.rational import Limits
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import parse

Part = str | tuple[str, bytes] | None
"""A part by name, or the name and the content of a file with a subspace; None for the plant."""
NOT_SAMPLED = (
    "--modulo is about the plant in FILE as it is: leave out --step, or sample it with `mcexact "
    "c2d` first"
)
NOT_REAL = "--modulo is about the ideal loop: leave it out where the real loop is run"
_NAMED = ("unobservable", "uncontrollable", "both")


def option(asked: str) -> Callable[[options.F], options.F]:
    """Return the option; ``asked`` says what the command does with the rest of the plant."""
    return click.option(
        "--modulo",
        metavar="PART",
        help=f"{asked} the plant modulo what no output shows (`unobservable`), without what no "
        "input moves (`uncontrollable`), or without `both`. A file can name a subspace instead, "
        'such as {"unobservable": [[1, 1, 1]]}. In every loop of the plant these modes stay.',
    )


def file_of(values: Mapping[str, Any]) -> str | None:
    """The file with a subspace, if the option names one."""
    named: str | None = values["modulo"]
    return None if named in _NAMED else named


def taken(values: dict[str, Any], run: Run) -> Part:
    """Take the option from the values of a command, and read its file.

    Raises
    ------
    InputError
        If it is neither a part nor the name of a file.
    """
    file, named = file_of(values), values.pop("modulo")
    if file is None:
        return None if named is None else str(named)
    if file != "-" and not os.path.exists(file):
        raise InputError(
            f"expected {', '.join(_NAMED)}, or the name of a file, found {file!a}", where="--modulo"
        )
    return run.read(file)


def without(
    system: MultiChannelSystem | ParametricSystem, part: Part, limits: Mapping[str, int]
) -> Any:
    """Return the system without the part, or itself.

    Raises
    ------
    UsageError
        If the system has parameters, or radii.
    InputError
        If the file is malformed, or its subspace is not one as the part needs it.
    """
    if part is None:
        return system
    if isinstance(system, ParametricSystem):
        raise UsageError("--modulo is about plants without parameters: give values by --at")
    # start-up: of these commands only the child process decides
    from mcexact.analysis.modulo import modulo

    if isinstance(part, str):
        return modulo(system, part)  # type: ignore[arg-type]
    name, data = part
    with InputError.inside(name):
        content = parse(data, Limits(**limits))
        if not isinstance(content, dict):
            raise InputError('expected an object such as {"unobservable": [[1, 1, 1]]}')
        try:
            return modulo(system, content)
        except UsageError as refused:
            raise InputError(refused.message, where=refused.where) from None
