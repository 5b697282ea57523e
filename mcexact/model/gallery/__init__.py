"""Published systems with their sources, some constructed systems, and answers known about them.

Every file names its source, or says that it is constructed.  Decimals are exact as typed.  Plants
with parameters are in the folder ``parametric``.
``expected.json`` contains answers that two independent programs computed exactly.
"""

from __future__ import annotations

import json
from functools import cache
from importlib import resources
from typing import Any

from mcexact.arguments import told
from mcexact.errors import UsageError
from mcexact.model.names import nearest
from mcexact.model.parametric import ParametricSystem
from mcexact.model.parametric_file import read_parametric_system
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import read_system

_EXPECTED = "expected"
_PARAMETRIC = "parametric"


@cache
def names() -> tuple[str, ...]:
    """The names of the systems in the gallery, sorted.

    Examples
    --------
    >>> "hidden-triple-mode" in names()
    True
    """
    return _stems("")


@cache
def parametric_names() -> tuple[str, ...]:
    """The names of the systems with parameters, sorted.

    Examples
    --------
    >>> "quadruple-tank-parametric" in parametric_names()
    True
    """
    return _stems(_PARAMETRIC)


def _stems(folder: str) -> tuple[str, ...]:
    """The names of the system files in a folder, sorted."""
    files = (entry.name for entry in resources.files(__name__).joinpath(folder).iterdir())
    stems = (name.removesuffix(".json") for name in files if name.endswith(".json"))
    return tuple(sorted(stem for stem in stems if stem != _EXPECTED))


def load(name: str) -> MultiChannelSystem:
    """Load a system of the gallery.

    Raises
    ------
    UsageError
        If no system has this name, or the one that has it depends on parameters.

    Examples
    --------
    >>> load("liu2020-3ch-no-communication")
    MultiChannelSystem(n=3, m=3, continuous time, channels: '1', '2', '3')
    """
    if require_name(name) in parametric_names():
        raise UsageError(
            f"{name!r} depends on parameters: load_parametric_system('gallery:{name}') reads it"
        )
    return read_system(text(name))


def load_parametric(name: str) -> ParametricSystem:
    """Load a system with parameters.

    Examples
    --------
    >>> load_parametric("quadruple-tank-parametric").parameters
    ('gamma1', 'gamma2')
    """
    return read_parametric_system(text(name))


def require_name(name: str) -> str:
    """Return the name of a system of the gallery, with or without parameters.

    Raises
    ------
    UsageError
        If no system has this name.
    """
    known = (*names(), *parametric_names())
    if not isinstance(name, str) or name not in known:
        hint = nearest(str(name), known) or "; 'mcexact gallery' lists them"
        raise UsageError(f"there is no system {told(name)} in the gallery{hint}")
    return name


def text(name: str) -> str:
    """The text of a system file of the gallery."""
    folder = _PARAMETRIC if name in parametric_names() else ""
    return _text(folder, name)


def _text(folder: str, stem: str) -> str:
    return resources.files(__name__).joinpath(folder, f"{stem}.json").read_text("utf-8")


def expected(name: str) -> dict[str, Any]:
    """Return the answers in ``expected.json`` about a system of the gallery.

    Examples
    --------
    >>> expected("hidden-triple-mode")["fixed_factors"]
    [{'factor': 'x - 1', 'multiplicity': 3}]
    """
    folder = _PARAMETRIC if name in parametric_names() else ""
    answers: dict[str, dict[str, Any]] = json.loads(_text(folder, _EXPECTED))
    return answers[name]
