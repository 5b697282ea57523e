"""Systems that are determined by a seed and a few sizes."""

from __future__ import annotations

from dataclasses import dataclass

from mcexact.derived.drawn.choices import Choices, SeededChoices
from mcexact.derived.drawn.deficiency import system_with_deficiency
from mcexact.derived.drawn.graph import drawn_graph
from mcexact.derived.drawn.networks import network_system
from mcexact.derived.drawn.systems import jointly_controllable_system, system_with_fixed_mode
from mcexact.errors import LimitReached, UsageError
from mcexact.exact.location import Time, is_discrete
from mcexact.exact.rational import DEFAULT_LIMITS
from mcexact.model.system import MultiChannelSystem

# A drawn system must not exceed the default limit on the size of a system file.
_MOST_NUMBERS = DEFAULT_LIMITS.bytes // 4
# A network has less than 16 numbers in a row of A, whose positions are written, too.
_MOST_STATES = DEFAULT_LIMITS.bytes // 512


@dataclass(frozen=True)
class Draw:
    """The description of a drawn system; equal descriptions give equal systems on every machine.

    Attributes
    ----------
    seed : int
    states, channels : int
        n and m.
    fixed_degree : int or None
        If given, the system has fixed modes, the roots of an irreducible factor of this degree.
    time : str
        ``"continuous"`` or ``"discrete"``.
    neighbors : bool
        Whether it has a strongly connected neighbor graph.
    deficiency : int or None
        If given, it has one, over which the bound of Theorem 2 is this; n then follows.
    network : str or None
        If given, the equations are those of this kind of network, and what is fixed is not known.
    """

    seed: int
    states: int = 4
    channels: int = 2
    fixed_degree: int | None = None
    time: Time = "continuous"
    neighbors: bool = False
    deficiency: int | None = None
    network: str | None = None


def drawn_system(draw: Draw) -> MultiChannelSystem:
    """Draw a system that is jointly controllable and observable, or a network.

    Raises
    ------
    LimitReached
        If the system would be too large for a system file.
    UsageError
        If more than one of a fixed mode, a deficiency and a network is prescribed, a network does
        not exist in this size or this time, or there are too few channels.

    Examples
    --------
    >>> drawn_system(Draw(seed=7, states=3)).n
    3
    """
    choices = SeededChoices(draw.seed)
    n, m, degree, time = draw.states, draw.channels, draw.fixed_degree, draw.time
    if draw.deficiency is not None:
        n = max(n, draw.deficiency)
    if draw.network is not None:
        return _network(choices, draw, draw.network)
    if (numbers := max(n, 1) * (n + 2 * m)) > _MOST_NUMBERS:
        raise LimitReached(
            f"a system of {n} states and {m} channels has {numbers} numbers or more, and at most "
            f"{_MOST_NUMBERS} are drawn; draw fewer states or channels"
        )
    if draw.deficiency is not None:
        if degree is not None:
            raise UsageError("a plant with a prescribed bound has a fixed mode already: give one")
        return system_with_deficiency(choices, draw.deficiency, m, time=time).system
    if degree is None:
        system = jointly_controllable_system(choices, n, m, time=time).system
    else:
        system = system_with_fixed_mode(choices, n, m, degree, time=time).system
    return _with_graph(choices, draw, system)


def _network(choices: Choices, draw: Draw, network: str) -> MultiChannelSystem:
    """A network, which is as it is: nothing else about it can be prescribed."""
    if draw.fixed_degree is not None or draw.deficiency is not None:
        raise UsageError("a network has fixed modes or not: prescribe none, and no bound")
    if is_discrete(draw.time):
        raise UsageError("networks are drawn in continuous time: sample one with c2d")
    if draw.states > _MOST_STATES:
        raise LimitReached(f"at most {_MOST_STATES} states of a network are drawn")
    return _with_graph(choices, draw, network_system(choices, network, draw.states, draw.channels))


def _with_graph(choices: Choices, draw: Draw, system: MultiChannelSystem) -> MultiChannelSystem:
    """The system with a strongly connected neighbor graph, if it is to have one."""
    if not draw.neighbors:
        return system
    return system.with_neighbors(drawn_graph(choices, system.names, strongly_connected=True))
