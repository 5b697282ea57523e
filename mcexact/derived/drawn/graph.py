"""Drawn neighbor graphs."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

from mcexact.derived.drawn.choices import Choices, shuffled
from mcexact.errors import UsageError
from mcexact.model.neighbor_graph import NeighborGraph


def drawn_graph(
    choices: Choices,
    names: Sequence[str],
    strongly_connected: bool | None = None,
    longest_delay: int = 0,
) -> NeighborGraph:
    """Draw a neighbor graph.

    Parameters
    ----------
    choices : Choices
    names : sequence of str
        The agents.
    strongly_connected : bool, optional
        True draws an ear decomposition, which every such graph has.  False draws a graph with a set
        of agents that receive no messages from outside the set.  None draws any graph.
    longest_delay : int
        Every edge has a delay from 0 to this.

    Raises
    ------
    UsageError
        If a graph on one agent is not to be strongly connected.

    Examples
    --------
    >>> from mcexact.derived.drawn.choices import SeededChoices
    >>> drawn_graph(SeededChoices(5), ("1", "2", "3"), True).is_strongly_connected()
    True
    >>> drawn_graph(SeededChoices(5), ("1", "2", "3"), False).is_strongly_connected()
    False
    """
    m = len(names)
    heard: list[set[int]] = [{i} for i in range(m)]
    deaf: set[int] = set()
    if strongly_connected:
        _ears(choices, heard)
    elif strongly_connected is not None:
        if m < 2:
            raise UsageError("a graph on one agent is strongly connected")
        order = shuffled(choices, range(m))
        deaf = set(order[: choices.integer(1, m - 1)])
    for i in range(m):
        for j in range(m):
            outside = i in deaf and j not in deaf
            if i != j and not outside and choices.integer(0, 2) == 2:
                heard[i].add(j)
    delays = [
        (i, j, choices.integer(0, longest_delay))
        for i in range(m)
        for j in sorted(heard[i])
        if i != j and longest_delay
    ]
    return NeighborGraph(names, heard, delays)


def _ears(choices: Choices, heard: list[set[int]]) -> None:
    """Add paths through unconnected agents that begin and end at connected ones."""
    order = shuffled(choices, range(len(heard)))
    connected, rest = order[:1], order[1:]
    while rest:
        length = choices.integer(1, len(rest))
        ear, rest = rest[:length], rest[length:]
        path = [choices.option(connected), *ear, choices.option(connected)]
        for sender, receiver in itertools.pairwise(path):
            heard[receiver].add(sender)
        connected += ear
