"""The delays of messages on the links of a graph, and the positions of its agents."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from mcexact.arguments import several
from mcexact.errors import FloatRefused, InputError
from mcexact.model.names import quoted


def checked_delays(
    delays: Iterable[tuple[int, int, int]],
    names: Sequence[str],
    neighbors: Sequence[Sequence[int]],
) -> tuple[tuple[int, int, int], ...]:
    """Sort the delays (i, j, d) and drop those of 0; refuse a delay that is not on an edge.

    Parameters
    ----------
    delays : iterable of (i, j, d)
        d_ij ≥ 0, the number of steps that a message takes from j to i.
    names : sequence of str
        The agents.
    neighbors : sequence of sequences of int
        ``neighbors[i]`` is N_i, which contains i.

    Raises
    ------
    InputError
        If a position is out of range, or a delay is negative, given twice or not on an edge.
    FloatRefused
        If a delay is a float.
    """
    found: dict[tuple[int, int], int] = {}
    for k, late in enumerate(several(delays, "delays", "triples (i, j, d)")):
        triple = several(late, f"delays[{k}]", "the two positions and the delay")
        if len(triple) != 3:
            raise InputError(f"expected (i, j, d), found {late!r}", where=f"delays[{k}]")
        i, j, delay = triple
        i, j = agent_position(i, len(names), "delays"), agent_position(j, len(names), "delays")
        where = f"delays[{quoted(names[i])}][{quoted(names[j])}]"
        if isinstance(delay, bool) or not isinstance(delay, int) or delay < 0:
            kind = FloatRefused if isinstance(delay, float) else InputError
            raise kind(f"expected an integer >= 0, found {delay!r}", where=where)
        if (i, j) in found:
            raise InputError("expected one delay, found two", where=where)
        if delay and i == j:
            raise InputError("expected 0: an agent has its own signals without delay", where=where)
        if j not in neighbors[i]:
            raise InputError(
                f"there is no such link: list {quoted(names[j])} among the neighbors "
                f"of {quoted(names[i])}, or remove the delay",
                where=where,
            )
        found[i, j] = delay
    return tuple(sorted((i, j, d) for (i, j), d in found.items() if d))


def agent_position(value: object, m: int, where: str) -> int:
    """Check and return the position of one of m agents."""
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < m:
        raise InputError(f"expected positions of agents 0 … {m - 1}, found {value!r}", where=where)
    return value
