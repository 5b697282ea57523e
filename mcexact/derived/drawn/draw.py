"""Systems that are determined by a seed and a few sizes."""

from __future__ import annotations

from dataclasses import dataclass

from mcexact.derived.drawn.choices import SeededChoices
from mcexact.derived.drawn.deficiency import system_with_deficiency
from mcexact.derived.drawn.graph import drawn_graph
from mcexact.derived.drawn.systems import jointly_controllable_system, system_with_fixed_mode
from mcexact.errors import LimitReached, UsageError
from mcexact.exact.location import Time
from mcexact.exact.rational import DEFAULT_LIMITS
from mcexact.model.system import MultiChannelSystem

# A drawn system must not exceed the default limit on the size of a system file.
_MOST_NUMBERS = DEFAULT_LIMITS.bytes // 4


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
    """

    seed: int
    states: int = 4
    channels: int = 2
    fixed_degree: int | None = None
    time: Time = "continuous"
    neighbors: bool = False
    deficiency: int | None = None


def drawn_system(draw: Draw) -> MultiChannelSystem:
    """Draw a system that is jointly controllable and observable.

    Raises
    ------
    LimitReached
        If the system would be too large for a system file.
    UsageError
        If both a fixed mode and a deficiency are prescribed, or there are too few channels.

    Examples
    --------
    >>> drawn_system(Draw(seed=7, states=3)).n
    3
    """
    choices = SeededChoices(draw.seed)
    n, m, degree, time = draw.states, draw.channels, draw.fixed_degree, draw.time
    if draw.deficiency is not None:
        n = max(n, draw.deficiency)
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
    if not draw.neighbors:
        return system
    graph = drawn_graph(choices, system.names, strongly_connected=True)
    return system.with_neighbors(graph)
