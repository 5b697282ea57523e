"""Published and constructed systems by name.

Every file names its source, or says that it is constructed.  Decimals are exact as typed.  Plants
with parameters are in the folder ``parametric``.  ``expected.json`` contains answers that two
independent programs computed exactly.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any, overload

from mcexact.errors import UsageError, shown_value
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import read_parametric_system, read_system
from mcexact.model.text import nearest

# The files, read by name.

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
        raise UsageError(f"there is no system {shown_value(name)} in the gallery{hint}")
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


# The function for users, and a list of the published plants with what each shows.

_LONGEST = 24


@overload
def gallery() -> tuple[str, ...]: ...
@overload
def gallery(name: str) -> MultiChannelSystem: ...
def gallery(name: str | None = None) -> MultiChannelSystem | tuple[str, ...]:
    """Load a published plant, or list the names of all of them.

    Parameters
    ----------
    name : str, optional

    Raises
    ------
    UsageError
        If no plant has this name.

    Examples
    --------
    >>> gallery("quadruple-tank-pminus")
    MultiChannelSystem(n=4, m=2, continuous time, channels: '1', '2')
    >>> len(gallery()) > 30
    True
    >>> gallery("quadruple-tank")
    Traceback (most recent call last):
        ...
    mcexact.errors.UsageError: there is no system 'quadruple-tank' in the gallery (did you mean \
'quadruple-tank-pplus'?)
    """
    return names() if name is None else load(name)


@dataclass(frozen=True)
class Published:
    """A published plant in a list.

    Attributes
    ----------
    name : str
        The name for `gallery`, and behind ``gallery:`` for commands.
    n, m : int
    parameters : tuple of str
        Those on which it depends; `load_parametric_system` reads such a plant.
    time : {"continuous", "discrete"}
    source : str
    shows : str
        What is known of its fixed modes, in a few words.
    """

    name: str
    n: int
    m: int
    parameters: tuple[str, ...]
    time: str
    source: str
    shows: str


def published() -> tuple[Published, ...]:
    """List all published plants.

    Examples
    --------
    >>> print(next(each.shows for each in published() if each.name == "hidden-triple-mode"))
    fixed: (x - 1)^3, although jointly controllable and observable
    """
    found = []
    systems: dict[str, MultiChannelSystem | ParametricSystem] = {
        **{name: load(name) for name in names()},
        **{name: load_parametric(name) for name in parametric_names()},
    }
    for name, system in sorted(systems.items()):
        shows = _shows_for_all(name) if system.parameters else _shows(name)
        sizes = system.n, system.m, system.parameters
        found.append(Published(name, *sizes, system.time, system.source or "", shows))
    return tuple(found)


def _shows_for_all(name: str) -> str:
    """What a plant with parameters shows, from the answers that are known of it."""
    known = expected(name)
    said = f"fixed for every value: {', '.join(known['generic'])}" if known["generic"] else ""
    where = "".join(f", where {each} = 0" for each in known["exceptional"])
    return said + where if said else f"a mode is fixed{where[1:]}"


def _shows(name: str) -> str:
    """What a plant shows, from the answers that are known of it."""
    known = expected(name)
    fixed = [_factor(each["factor"], each["multiplicity"]) for each in known["fixed_factors"]]
    lost = [
        word
        for word, key in (
            ("controllable", "jointly_controllable"),
            ("observable", "jointly_observable"),
        )
        if not known[key]
    ]
    if not fixed:
        if known["complete"]:
            return "no fixed mode, complete"
        return "no fixed mode, and yet not complete"
    why = "not jointly " + " or ".join(lost) if lost else (
        "although jointly controllable and observable"
    )  # fmt: skip
    return f"fixed: {', '.join(fixed)}, {why}"


def _factor(text: str, multiplicity: int) -> str:
    """A factor of the fixed polynomial with its multiplicity."""
    shown = re.sub(r"\+ \(-([^()]*)\)", r"- \1", text)
    if len(shown) > _LONGEST:
        degree = max([1, *map(int, re.findall(r"x\^(\d+)", shown))])
        shown = f"a factor of degree {degree}"
    return f"({shown})^{multiplicity}" if multiplicity > 1 else shown
