"""What the instances of an examination have in common, in words."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.exact.roots import TIMES
from mcexact.model.system import MultiChannelSystem
from mcexact.reproduce.material import PAPER

_ORIGINS = (
    ("drawn, bound", "drawn over strongly connected graphs for a bound of 1, 2 or 3 that is known"),
    ("drawn, planted", "drawn with a planted fixed mode"),
    ("drawn, a fixed mode", "drawn with a fixed mode by two channels"),
    ("drawn pair", "drawn pairs of matrices"),
    ("three agents, links", "graphs with three agents"),
    ("drawn", "drawn"),
)
_MOST_NAMES = 5


def in_common(names: Sequence[str], plants: Mapping[str, MultiChannelSystem]) -> str:
    """Describe instances: where they come from, their sizes, and what all or some of them are.

    Parameters
    ----------
    names : sequence of str
    plants : mapping of str to MultiChannelSystem
        The plants of those instances that are one.

    Examples
    --------
    >>> from mcexact.reproduce.material import three_channels
    >>> in_common([PAPER], {PAPER: three_channels()})
    'the matrices of the example of IV-B; 3 states, 3 channels, continuous time; jointly \
controllable and observable; over a strongly connected graph'
    """
    found = [plants[name] for name in names if name in plants]
    return "; ".join([*_origins(names), *_sizes(found), *_properties(found)])


def _origins(names: Sequence[str]) -> list[str]:
    """How many instances come from where; a few named ones by their names."""
    by_origin: dict[str, list[str]] = {}
    for name in names:
        origin = next((said for start, said in _ORIGINS if name.startswith(start)), "named")
        by_origin.setdefault("" if name.startswith(PAPER) else origin, []).append(name)
    made = []
    for origin, members in by_origin.items():
        if not origin:
            many = f", in {len(members)} instances" if len(members) > 1 else ""
            made.append(f"the matrices of the example of IV-B{many}")
        elif origin == "named" and len(members) <= _MOST_NAMES:
            made += members
        else:
            made.append(f"{len(members)} {origin}")
    return made


def _sizes(plants: Sequence[MultiChannelSystem]) -> list[str]:
    """The numbers of states and channels, the time domains, and the longest delay."""
    if not plants:
        return []
    times = {plant.time for plant in plants}
    domain = "both time domains" if times == set(TIMES) else f"{times.pop()} time"
    states = _span((plant.n for plant in plants), "state")
    channels = _span((plant.m for plant in plants), "channel")
    delays = [d for p in plants if p.neighbors is not None for _, _, d in p.neighbors.delays]
    late = [f"delays up to {max(delays)}"] if any(delays) else []
    return [", ".join([states, channels, domain, *late])]


def _span(sizes: Iterable[int], noun: str) -> str:
    """From the smallest to the largest number of something."""
    ordered = sorted(sizes)
    least, most = ordered[0], ordered[-1]
    if least == most:
        return f"{most} {noun}{'' if most == 1 else 's'}"
    return f"{least} {'or' if most == least + 1 else 'to'} {most} {noun}s"


def _properties(plants: Sequence[MultiChannelSystem]) -> list[str]:
    """How many are jointly controllable and observable, and have strongly connected graphs."""
    joint = [
        joint_controllability(plant).controllable and joint_observability(plant).controllable
        for plant in plants
    ]
    graphs = [
        plant.neighbors.is_strongly_connected() for plant in plants if plant.neighbors is not None
    ]
    told = _told(joint, "jointly controllable and observable")
    over = (
        "over a strongly connected graph" if len(graphs) == 1 else "over strongly connected graphs"
    )
    return [*told, *_told(graphs, over)]


def _told(found: Sequence[bool], property_: str) -> list[str]:
    """Of how many it is true."""
    if not found:
        return []
    if all(found):
        return [property_ if len(found) == 1 else f"all {property_}"]
    return [f"{sum(found)} of {len(found)} {property_}"]
