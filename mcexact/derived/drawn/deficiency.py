"""Drawn systems over neighbor graphs with a prescribed bound on shared dimensions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from mcexact.derived.drawn.choices import Choices, shuffled
from mcexact.derived.drawn.parts import as_polynomial
from mcexact.derived.drawn.primary_form import Chain, Coefficients, Draft, place
from mcexact.derived.drawn.systems import Drawn
from mcexact.errors import UsageError
from mcexact.exact.location import is_discrete
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem


@dataclass(frozen=True)
class _Agents:
    """Who is in s, in N_s∖s, and outside; and the arcs of a strongly connected graph."""

    inside: frozenset[int]
    between: frozenset[int]
    outside: frozenset[int]
    neighbors: tuple[frozenset[int], ...]


def system_with_deficiency(
    choices: Choices,
    deficiency: int,
    channels: int = 3,
    *,
    share: str = "outputs+states",
    degree: int = 1,
    length: int = 1,
    boundary: int = 1,
    transfer: bool = True,
    stable: bool = False,
    digits: int = 0,
    delay: int = 0,
    time: str = "continuous",
) -> Drawn:
    """Draw a plant over a strongly connected graph whose bound on shared dimensions is prescribed.

    Parameters
    ----------
    choices : Choices
    deficiency : int
        The bound of Theorem 2, or of Remark 2 if ``share`` is ``"states"``; at least 1.
    channels : int
        At least 3, or 2 if ``share`` is ``"states"``.
    share : {"outputs+states", "states"}
    degree : int
        Of the irreducible polynomial p at whose roots the bound is attained: 1, or 2 for a complex
        pair.
    length : int
        Of its Jordan chains.
    boundary : int
        The number of agents in N_s∖s for the subset s that attains the bound: with 1 the bound is
        tight, with more agents it need not be.
    transfer : bool
        Whether the transfer matrix C_{N_s} (xI − A)⁻¹ B_{m−s} (with C_s for ``"states"``) is
        other than 0.
    stable : bool
        Whether all eigenvalues are in the open left half-plane (unit disc).
    digits : int
        Of the numerators and denominators by which the states are scaled; 0 leaves integers.
    delay : int
        Every link has a delay from 0 to this; in discrete time.
    time : {"continuous", "discrete"}

    Returns
    -------
    Drawn
        Jointly controllable and observable, with all B_i and C_i other than 0, and with
        ``deficiency``, ``fixed_mode``, ``multiplicity``, ``subset`` and ``complete=False``.

    Notes
    -----
    g chains of p, a reached by all agents and the others by those in s alone; b seen by all agents
    and the others by those outside N_s alone (outside s for ``"states"``), g = a + b + δ.  At a
    root of p a subset s' has rank n − g + #{chains reached from m∖s'} + #{chains seen in N_s'},
    which is least, n − δ, for s' = s.  Other modes are reached by all agents and seen from outside.

    Examples
    --------
    >>> from mcexact.derived.drawn.choices import SeededChoices
    >>> drawn = system_with_deficiency(SeededChoices(1), 2, channels=4)
    >>> drawn.deficiency, drawn.system.neighbors.is_strongly_connected()
    (2, True)
    """
    _require(deficiency, channels, share, degree, boundary)
    agents = _drawn_agents(choices, channels, share, boundary)
    reached, seen = choices.integer(1, 2), choices.integer(1, 2)
    count = reached + seen + deficiency
    everyone = frozenset(range(channels))
    # A chain that is reached and seen by all carries inputs of m∖s to the outputs in N_s.
    first = 0 if transfer else reached
    watched = range(first, first + seen)
    polynomial = _planted(choices, degree)
    chains = [
        Chain(
            polynomial,
            (2,) * length,
            everyone if k < reached else agents.inside,
            everyone if k in watched else agents.outside,
        )
        for k in range(count)
    ]
    values = [k for k in (1, -1, 2, -2, 3) if (-k, 1) != polynomial]
    for value in shuffled(choices, values)[: choices.integer(1, 2)]:
        chains.append(Chain((-value, 1), (2,) * choices.integer(1, 2), everyone, agents.outside))
    system = _assembled(choices, chains, count, channels, digits, time)
    root = as_polynomial(polynomial)
    if stable:
        system, root = _stabilized(system, chains, root)
    delays = [
        (i, j, choices.integer(0, delay))
        for i in range(channels)
        for j in sorted(agents.neighbors[i] - {i})
        if delay
    ]
    return Drawn(
        system.with_neighbors(NeighborGraph(system.names, agents.neighbors, delays)),
        jointly_controllable=True,
        jointly_observable=True,
        fixed_modes=True,
        fixed_mode=root,
        multiplicity=deficiency,
        subset=tuple(sorted(agents.inside)),
        complete=False,
        deficiency=deficiency,
    )


def _require(deficiency: int, channels: int, share: str, degree: int, boundary: int) -> None:
    least = 2 if share == "states" else boundary + 2
    if share not in ("outputs+states", "states"):
        raise UsageError(f'expected share "outputs+states" or "states", found {share!r}')
    if deficiency < 1 or boundary < 1:
        raise UsageError("the prescribed bound and the number of agents in between are at least 1")
    if channels < least:
        raise UsageError(f"such a bound needs at least {least} channels, found {channels}")
    if degree not in (1, 2):
        raise UsageError(f"expected degree 1 or 2, found {degree}")


def _planted(choices: Choices, degree: int) -> Coefficients:
    """x − a, or the polynomial of a complex pair a ± bi."""
    a = choices.option((0, 1, -1, 2, -2))
    if degree == 1:
        return (-a, 1)
    b = choices.option((1, 2, 3))
    return (a * a + b * b, -2 * a, 1)


def _drawn_agents(choices: Choices, channels: int, share: str, boundary: int) -> _Agents:
    """A cycle through s, N_s∖s and the others, with further arcs that leave N_s as it is."""
    order = shuffled(choices, range(channels))
    states = share == "states"
    between = 0 if states else boundary
    size = choices.integer(1, channels - between - 1)
    inside, rest = frozenset(order[:size]), order[size:]
    middle = frozenset(rest[:between])
    outside = frozenset(rest[between:])
    heard = [{i} for i in range(channels)]
    for k, i in enumerate(order):
        heard[i].add(order[(k + 1) % channels])
    heard[order[size - 1]] |= middle
    for i in range(channels):
        for j in range(channels):
            allowed = states or i not in inside or j not in outside
            if allowed and choices.integer(0, 3) == 3:
                heard[i].add(j)
    return _Agents(inside, middle, outside, tuple(map(frozenset, heard)))


def _assembled(
    choices: Choices,
    chains: Sequence[Chain],
    count: int,
    channels: int,
    digits: int,
    time: str,
) -> MultiChannelSystem:
    """Give every agent one port for each of the first chains that it joins.

    Other chains share the first port, so that they add nothing to the rank at the roots of p.
    """
    A, lasts, firsts = place(chains)
    n = len(A)
    # A companion matrix is controllable from its last state and observable from its first.
    ends, starts = [states[-1] for states in lasts], [states[0] for states in firsts]
    drives, sights = [chain.reached_by for chain in chains], [chain.seen_by for chain in chains]
    inputs, columns = _ports(choices, n, ends, drives, count, channels)
    outputs, rows = _ports(choices, n, starts, sights, count, channels)
    draft = Draft(A, [[column[state] for column in columns] for state in range(n)], rows)
    draft.hide(choices, choices.integer(0, 4 * n))
    if digits:
        low, high = 10 ** (digits - 1), 10**digits - 1
        draft.scales = [
            Fraction(choices.integer(low, high), choices.integer(low, high)) for _ in range(n)
        ]
    return MultiChannelSystem(*draft.matrices(inputs, outputs, channels), time=time)


def _ports(
    choices: Choices,
    n: int,
    states: Sequence[int],
    joined: Sequence[frozenset[int] | None],
    count: int,
    channels: int,
) -> tuple[list[int], list[list[int]]]:
    """The owners of all inputs (outputs), and their vectors."""
    owners, vectors = [], []
    for i in range(channels):
        mine = [k for k, agents in enumerate(joined) if agents and i in agents]
        ports = [[int(state == states[k]) for state in range(n)] for k in mine if k < count]
        for k in mine:
            if k >= count:
                ports[0][states[k]] = choices.option((1, 2, -1))
        vectors += ports
        owners += [i] * len(ports)
    return owners, vectors


def _stabilized(
    system: MultiChannelSystem, chains: Sequence[Chain], root: Polynomial
) -> tuple[MultiChannelSystem, Polynomial]:
    """Move all eigenvalues by Cauchy's bound on their moduli, which they stay below."""
    bound = 1 + max(abs(c) for chain in chains for c in chain.polynomial[:-1])
    B = [channel.B for channel in system.channels]
    C = [channel.C for channel in system.channels]
    if is_discrete(system.time):
        moved, root = system.A * Fraction(1, bound), root.scale(bound).monic()
    else:
        moved = system.A - Matrix.identity(system.n) * bound
        root = root.compose_shift(bound)
    return MultiChannelSystem(moved, B, C, time=system.time), root
