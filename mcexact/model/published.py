"""The published plants by name, and a list of them with what each shows."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import overload

from mcexact.model import gallery as plants
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem

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
    return plants.names() if name is None else plants.load(name)


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
        **{name: plants.load(name) for name in plants.names()},
        **{name: plants.load_parametric(name) for name in plants.parametric_names()},
    }
    for name, system in sorted(systems.items()):
        shows = _shows_for_all(name) if system.parameters else _shows(name)
        sizes = system.n, system.m, system.parameters
        found.append(Published(name, *sizes, system.time, system.source or "", shows))
    return tuple(found)


def _shows_for_all(name: str) -> str:
    """What a plant with parameters shows, from the answers that are known of it."""
    known = plants.expected(name)
    said = f"fixed for every value: {', '.join(known['generic'])}" if known["generic"] else ""
    where = "".join(f", where {each} = 0" for each in known["exceptional"])
    return said + where if said else f"a mode is fixed{where[1:]}"


def _shows(name: str) -> str:
    """What a plant shows, from the answers that are known of it."""
    known = plants.expected(name)
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
