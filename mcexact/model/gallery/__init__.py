"""Published systems with their sources, some constructed systems, and answers known about them.

Every file names its source, or says that it is constructed.  Decimals are exact as typed.
``expected.json`` contains answers that two independent programs computed exactly.
"""

from __future__ import annotations

import json
from functools import cache
from importlib import resources
from typing import Any

from mcexact.errors import UsageError
from mcexact.model.names import nearest, quoted
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import read_system

_EXPECTED = "expected"


@cache
def names() -> tuple[str, ...]:
    """The names of the systems in the gallery, sorted.

    Examples
    --------
    >>> "hidden-triple-mode" in names()
    True
    """
    files = resources.files(__name__).iterdir()
    stems = (entry.name.removesuffix(".json") for entry in files if entry.name.endswith(".json"))
    return tuple(sorted(stem for stem in stems if stem != _EXPECTED))


def load(name: str) -> MultiChannelSystem:
    """Load a system of the gallery.

    Raises
    ------
    UsageError
        If no system has this name.

    Examples
    --------
    >>> load("liu2020-3ch-no-communication")
    MultiChannelSystem(n=3, m=3, continuous time, channels: '1', '2', '3')
    """
    return read_system(text(require_name(name)))


def require_name(name: str) -> str:
    """Return the name of a system of the gallery.

    Raises
    ------
    UsageError
        If no system has this name.
    """
    if name not in names():
        hint = nearest(name, names()) or "; 'mcexact gallery' lists them"
        raise UsageError(f"there is no system {quoted(name)} in the gallery{hint}")
    return name


def text(name: str) -> str:
    """The text of a system file of the gallery."""
    return resources.files(__name__).joinpath(f"{name}.json").read_text("utf-8")


def expected(name: str) -> dict[str, Any]:
    """Return the answers in ``expected.json`` about a system of the gallery.

    Examples
    --------
    >>> expected("hidden-triple-mode")["fixed_factors"]
    [{'factor': 'x - 1', 'multiplicity': 3}]
    """
    answers: dict[str, dict[str, Any]] = json.loads(text(_EXPECTED))
    return answers[name]
