"""Drawn systems with prescribed fixed modes, indices and deficiency.

Each function returns a `Drawn`: the system, and the properties that hold by construction.  No
algorithm of this package computes them, so its answers can be compared with them.

- `jointly_controllable_system`: jointly controllable and observable.
- `uncontrollable_system`: a mode that no channel controls, or that no channel observes.
- `sparse_system`: small sparse entries, and nothing is known.
- `system_with_fixed_mode`, `incomplete_system`: not complete, with a fixed mode or a transfer
  graph that is not strongly connected.
- `system_with_indices`, `system_with_remnant`: prescribed controllability indices, and a
  complementary subsystem with a known remnant polynomial.
- `system_with_deficiency`: a plant over a neighbor graph for which the bound of Theorem 2 (or of
  Remark 2) on shared dimensions is prescribed.

Most are made of the chains of `primary_form`, which a change of basis then hides.  `drawn_system`
makes one from a `Draw`: a seed and a few sizes, which determine it on every machine.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from mcexact.derived.drawn.networks import drawn_graph, network_system
from mcexact.derived.drawn.primary_form import (
    Chain,
    Choices,
    Coefficients,
    Draft,
    Ports,
    SeededChoices,
    as_polynomial,
    draw_chains,
    draw_ports,
    finished,
    irreducible,
    lay_out,
    live,
    place,
    shuffled,
)
from mcexact.errors import LimitReached, UsageError
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import DEFAULT_LIMITS
from mcexact.exact.roots import Time, is_discrete
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem

# Drawn systems that are jointly controllable or not, with fixed modes or without.


@dataclass(frozen=True)
class Drawn:
    """A drawn system with its properties by construction; None means that a property is unknown.

    Attributes
    ----------
    system : MultiChannelSystem
    jointly_controllable, jointly_observable : bool or None
    fixed_modes : bool or None
        Whether there are fixed modes at all.
    fixed_mode : Polynomial or None
        A monic irreducible polynomial whose roots are fixed modes (there may be others).
    multiplicity : int or None
        A number of times that it divides the characteristic polynomial of every closed loop.
    subset : tuple of int or None
        A subset s with rank P_s < n at the roots of ``fixed_mode``.
    indices : tuple of int or None
        The controllability (Brunovsky) indices of (A, [B_1 … B_m]), largest first.
    remnant : Polynomial or None
        The remnant polynomial of the complementary subsystem of ``subset``.
    complete : bool or None
    deficiency : int or None
        The bound of Theorem 2 on shared dimensions (or of Remark 2) over the neighbor graph.
    order : int or None
        The least number of states of a system with the same transfer matrix.
    left_out : Polynomial or None
        The characteristic polynomial of A on what such a system leaves out: the joint fixed modes.
    """

    system: MultiChannelSystem
    jointly_controllable: bool | None = None
    jointly_observable: bool | None = None
    fixed_modes: bool | None = None
    fixed_mode: Polynomial | None = None
    multiplicity: int | None = None
    subset: tuple[int, ...] | None = None
    indices: tuple[int, ...] | None = None
    remnant: Polynomial | None = None
    complete: bool | None = None
    deficiency: int | None = None
    order: int | None = None
    left_out: Polynomial | None = None


def jointly_controllable_system(
    choices: Choices,
    states: int,
    channels: int,
    *,
    time: str = "continuous",
    inactive_channels: bool = False,
    denominators: bool = False,
) -> Drawn:
    """Draw a jointly controllable and jointly observable system, by construction.

    Parameters
    ----------
    choices : Choices
    states, channels : int
        n ≥ 0 and m ≥ 1.
    time : {"continuous", "discrete"}
    inactive_channels : bool
        Whether some channels may have B_i = 0 or C_i = 0.
    denominators : bool
        Whether entries may be fractions.

    Returns
    -------
    Drawn
        Eigenvalues repeat, Jordan chains are long, and entries are sparse before the change of
        basis, so that fixed modes are frequent.

    Examples
    --------
    >>> from mcexact.derived.drawn.primary_form import SeededChoices
    >>> drawn = jointly_controllable_system(SeededChoices(1), states=4, channels=2)
    >>> drawn.system.n, drawn.jointly_controllable
    (4, True)
    """
    _require_sizes(states, channels)
    inputs, outputs = draw_ports(choices, channels, inactive_channels=inactive_channels)
    limit = min(live(inputs, range(channels)), live(outputs, range(channels)))
    chains = draw_chains(choices, states, limit)
    draft = lay_out(choices, chains, inputs, outputs)
    system = finished(choices, draft, inputs.owners, outputs.owners, channels, time, denominators)
    return Drawn(system, jointly_controllable=True, jointly_observable=True)


def system_with_fixed_mode(
    choices: Choices,
    states: int,
    channels: int,
    degree: int = 1,
    *,
    time: str = "continuous",
    denominators: bool = False,
) -> Drawn:
    """Draw a jointly controllable and observable system with a fixed mode that is hard to see.

    Parameters
    ----------
    choices : Choices
    states : int
        n, at least the degree.
    channels : int
        m ≥ 2: one channel that controls and observes everything has no fixed mode.
    degree : int
        The degree of the irreducible polynomial of the fixed mode.
    time : {"continuous", "discrete"}
    denominators : bool

    Returns
    -------
    Drawn
        With ``fixed_mode``, ``multiplicity``, ``subset`` and ``complete=False``.

    Notes
    -----
    The system is made in the normal form of Anderson and Clements and then changed by unimodular
    steps: channels outside the subset act only on a part of the state that the channels in it do
    not measure.

    Examples
    --------
    >>> from mcexact.derived.drawn.primary_form import SeededChoices
    >>> drawn = system_with_fixed_mode(SeededChoices(2), states=5, channels=3, degree=2)
    >>> drawn.fixed_mode.degree, drawn.complete
    (2, False)
    """
    _require_sizes(states, channels)
    if channels < 2:
        raise UsageError("a planted fixed mode needs at least 2 channels")
    if states < degree:
        raise UsageError(f"a fixed mode of degree {degree} needs at least {degree} states")
    order = shuffled(choices, range(channels))
    reach = frozenset(order[: choices.integer(1, channels - 1)])
    subset = frozenset(range(channels)) - reach
    inputs, outputs = draw_ports(choices, channels, reach=reach, subset=subset)
    planted = _planted(choices, irreducible(choices, degree), states // degree)
    limit = min(live(inputs, subset), live(outputs, reach))
    chains = draw_chains(choices, states, limit, [planted])
    draft = lay_out(choices, chains, inputs, outputs)
    return Drawn(
        finished(choices, draft, inputs.owners, outputs.owners, channels, time, denominators),
        jointly_controllable=True,
        jointly_observable=True,
        fixed_modes=True,
        fixed_mode=as_polynomial(planted.polynomial),
        multiplicity=planted.zones.count(2),
        subset=tuple(sorted(subset)),
        complete=False,
    )


def uncontrollable_system(
    choices: Choices,
    states: int,
    channels: int,
    *,
    observable_side: bool = False,
    time: str = "continuous",
) -> Drawn:
    """Draw a system with a mode that no channel controls, or that no channel observes.

    Parameters
    ----------
    choices : Choices
    states, channels : int
        n ≥ 1 and m ≥ 1.
    observable_side : bool
        False: not jointly controllable; True: not jointly observable.
    time : {"continuous", "discrete"}

    Returns
    -------
    Drawn
        The other of the two properties holds.  ``subset`` is empty if no channel controls the mode,
        and the set of all channels if no channel observes it.

    Examples
    --------
    >>> from mcexact.derived.drawn.primary_form import SeededChoices
    >>> uncontrollable_system(SeededChoices(3), states=3, channels=2).jointly_controllable
    False
    """
    _require_sizes(states, channels)
    if not states:
        raise UsageError("a system without states is controllable and observable")
    inputs, outputs = draw_ports(choices, channels)
    limit = min(live(inputs, range(channels)), live(outputs, range(channels)))
    chains = draw_chains(choices, states, limit)
    k = choices.integer(0, len(chains) - 1)
    nobody: frozenset[int] = frozenset()
    lost = chains[k]
    if observable_side:
        chains[k] = replace(lost, seen_by=nobody)
    else:
        chains[k] = replace(lost, reached_by=nobody)
    draft = lay_out(choices, chains, inputs, outputs)
    return Drawn(
        finished(choices, draft, inputs.owners, outputs.owners, channels, time, False),
        jointly_controllable=observable_side,
        jointly_observable=not observable_side,
        fixed_modes=True,
        fixed_mode=as_polynomial(lost.polynomial),
        multiplicity=1,
        subset=tuple(range(channels)) if observable_side else (),
        complete=False,
    )


def system_with_joint_modes(
    choices: Choices, states: int, channels: int, *, time: str = "continuous"
) -> Drawn:
    """Draw a system with states that all channels together do not control or do not observe.

    Parameters
    ----------
    choices : Choices
    states, channels : int
        n ≥ 1 and m ≥ 1.
    time : {"continuous", "discrete"}

    Returns
    -------
    Drawn
        Its ``order`` is below n, and ``left_out`` has the degree n − ``order``.

    Notes
    -----
    Before an integer change of the basis, with a system (A_22, B_2, C_2) that is jointly
    controllable and observable, and a lower triangular block that is 0::

            ⎡ A_11  A_12  A_13  A_14 ⎤        ⎡ B_1 ⎤
            ⎢  0    A_22   0    A_24 ⎥        ⎢ B_2 ⎥
        A = ⎢  0     0    A_33  A_34 ⎥ ,  B = ⎢  0  ⎥ ,   C = [ 0  C_2  0  C_4 ]
            ⎣  0     0     0    A_44 ⎦        ⎣  0  ⎦

    Examples
    --------
    >>> from mcexact.derived.drawn.primary_form import SeededChoices
    >>> drawn = system_with_joint_modes(SeededChoices(2), states=4, channels=2)
    >>> drawn.order, drawn.left_out.degree
    (0, 4)
    """
    _require_sizes(states, channels)
    if not states:
        raise UsageError("a system without states is controllable and observable")
    r = choices.integer(0, states - 1)
    core = jointly_controllable_system(choices, r, channels, time=time).system
    cuts = sorted(choices.integer(0, states - r) for _ in range(2))
    sizes = [cuts[0], r, cuts[1] - cuts[0], states - r - cuts[1]]
    block_of = [k for k, size in enumerate(sizes) for _ in range(size)]
    start = sizes[0]
    middle = range(start, start + r)

    def entry(i: int, j: int) -> Fraction:
        if i in middle and j in middle:
            return core.A[i - start, j - start]
        free = i < j if block_of[i] == block_of[j] else block_of[i] < block_of[j]
        known = i == j or (free and (block_of[i], block_of[j]) != (1, 2))
        return Fraction(choices.integer(-2, 2) if known else 0)

    A = [[entry(i, j) for j in range(states)] for i in range(states)]
    left_out = as_polynomial((1,))
    for i in {*range(states)} - {*middle}:
        left_out = left_out * Polynomial((-A[i][i], Fraction(1)))
    B = [
        [*([choices.integer(-1, 1) for _ in range(c.B.ncols)] for _ in range(start)), *c.B.rows()]
        + [[0] * c.B.ncols] * (sizes[2] + sizes[3])
        for c in core.channels
    ]
    C = [
        [
            [0] * start
            + [*row]
            + [0] * sizes[2]
            + [choices.integer(-1, 1) for _ in range(sizes[3])]
            for row in c.C.rows()
        ]
        for c in core.channels
    ]
    for _ in range(choices.integer(0, 2 * states)):
        i, j = choices.integer(0, states - 1), choices.integer(0, states - 1)
        if i != j:
            _add_state(A, B, C, i, j)
    system = MultiChannelSystem(
        A,
        [Matrix.from_rows(rows, ncols=c.B.ncols) for rows, c in zip(B, core.channels, strict=True)],
        [Matrix.from_rows(rows, ncols=states) for rows in C],
        time=time,
    )
    return Drawn(system, fixed_modes=True, order=r, left_out=left_out)


def _add_state(A: Any, B: Any, C: Any, i: int, j: int) -> None:
    """Let x_i + x_j take the place of x_i."""
    for rows in (A, *B):
        rows[i] = [x + y for x, y in zip(rows[i], rows[j], strict=True)]
    for row in [*A, *(row for rows in C for row in rows)]:
        row[j] -= row[i]


def sparse_system(
    choices: Choices, states: int, channels: int, *, time: str = "continuous"
) -> Drawn:
    """Draw a system with sparse small entries, about which nothing is known.

    Parameters
    ----------
    choices : Choices
    states, channels : int
        n ≥ 0 and m ≥ 1.
    time : {"continuous", "discrete"}

    Returns
    -------
    Drawn
        Many of them have fixed modes, inactive channels, or channels without inputs or outputs, or
        are not jointly controllable or observable.
    """
    _require_sizes(states, channels)
    palette = (0, 0, 0, 0, 1, -1, 2)

    def matrix(rows: int, columns: int) -> Matrix:
        entries = [[choices.option(palette) for _ in range(columns)] for _ in range(rows)]
        return Matrix.from_integers(entries, ncols=columns)

    widths = [
        (choices.option((1, 1, 1, 2, 0)), choices.option((1, 1, 1, 2, 0))) for _ in range(channels)
    ]
    return Drawn(
        MultiChannelSystem(
            matrix(states, states),
            [matrix(states, p) for p, _ in widths],
            [matrix(q, states) for _, q in widths],
            time=time,
        )
    )


def any_system(choices: Choices, states: int, channels: int, *, time: str = "continuous") -> Drawn:
    """Draw a system of any of the kinds in this module.

    Examples
    --------
    >>> from mcexact.derived.drawn.primary_form import SeededChoices
    >>> any_system(SeededChoices(4), states=3, channels=2).system.m
    2
    """
    kind = choices.option(
        ("sparse", "minimal", "inactive", "fixed", "uncontrollable", "unobservable")
    )
    if kind == "minimal":
        return jointly_controllable_system(choices, states, channels, time=time)
    if kind == "inactive":
        return jointly_controllable_system(
            choices, states, channels, time=time, inactive_channels=True, denominators=True
        )
    if kind == "fixed" and channels > 1 and states:
        degree = choices.integer(1, min(3, states))
        return system_with_fixed_mode(choices, states, channels, degree, time=time)
    if kind in ("uncontrollable", "unobservable") and states:
        seen = kind == "unobservable"
        return uncontrollable_system(choices, states, channels, observable_side=seen, time=time)
    return sparse_system(choices, states, channels, time=time)


def with_feedthrough(choices: Choices, drawn: Drawn) -> Drawn:
    """Add a drawn feedthrough to a system, if it has inputs and outputs.

    Parameters
    ----------
    choices : Choices
    drawn : Drawn
        Without feedthrough.

    Returns
    -------
    Drawn
        The same A, B_i and C_i with a D ≠ 0.  Joint controllability and observability are those of
        the given system; of its other properties, which depend on D, none is known.

    Examples
    --------
    >>> from mcexact.derived.drawn.primary_form import SeededChoices
    >>> choices = SeededChoices(2)
    >>> drawn = with_feedthrough(choices, jointly_controllable_system(choices, 2, 2))
    >>> drawn.system.D is not None, drawn.jointly_controllable, drawn.fixed_modes
    (True, True, None)
    """
    system = drawn.system
    p, q = (sum(widths) for widths in zip(*system.sizes, strict=True))
    if not p or not q:
        return drawn
    D = [[choices.option((0, 0, 1, -1, 2)) for _ in range(p)] for _ in range(q)]
    if not any(map(any, D)):
        D[choices.integer(0, q - 1)][choices.integer(0, p - 1)] = 1
    made = MultiChannelSystem(
        system.A,
        [channel.B for channel in system.channels],
        [channel.C for channel in system.channels],
        D=D,
        time=system.time,
        names=system.names,
        neighbors=system.neighbors,
    )
    return Drawn(made, drawn.jointly_controllable, drawn.jointly_observable)


def _require_sizes(states: int, channels: int) -> None:
    if states < 0 or channels < 1:
        raise UsageError(f"expected at least 0 states and 1 channel, found {states} and {channels}")


def _planted(choices: Choices, polynomial: Coefficients, longest: int) -> Chain:
    """A chain with one or more blocks in zone 2, which may begin in zone 1 and end in zone 3."""
    middle = choices.integer(1, min(longest, 2))
    before = choices.integer(0, min(longest - middle, 2))
    after = choices.integer(0, min(longest - middle - before, 2))
    return Chain(polynomial, (1,) * before + (2,) * middle + (3,) * after)


# Drawn systems with prescribed indices, remnant polynomial or incompleteness.


def system_with_indices(
    choices: Choices, indices: Sequence[int], channels: int, *, time: str = "continuous"
) -> Drawn:
    """Draw a jointly observable system with prescribed controllability (Brunovsky) indices.

    Parameters
    ----------
    choices : Choices
    indices : sequence of int
        κ_1, …, κ_r, each ≥ 1; they sum to n and belong to all channels taken together.
    channels : int
    time : {"continuous", "discrete"}

    Returns
    -------
    Drawn
        With ``indices``, largest first.

    Notes
    -----
    A Brunovsky form with a drawn feedback and redundant inputs, neither of which changes the
    indices.  The head of every chain of integrators is measured, so the system is observable.

    Examples
    --------
    >>> from mcexact.derived.drawn.primary_form import SeededChoices
    >>> system_with_indices(SeededChoices(0), [1, 3], channels=2).indices
    (3, 1)
    """
    if any(k < 1 for k in indices):
        raise UsageError(f"expected indices >= 1, found {list(indices)}")
    n, r = sum(indices), len(indices)
    heads = [sum(indices[:k]) for k in range(r)]
    tails = [head + k - 1 for head, k in zip(heads, indices, strict=True)]
    A = [[int(j == i + 1 and i not in tails) for j in range(n)] for i in range(n)]
    small = (0, 0, 1, -1, 2)
    for tail in tails:
        for j in range(n):
            A[tail][j] += choices.option(small)
    inputs = sorted([*range(channels), *(choices.integer(0, channels - 1) for _ in range(r))])
    pivots = sorted(shuffled(choices, range(len(inputs)))[:r])
    B = [[0] * len(inputs) for _ in range(n)]
    for k, tail in enumerate(tails):
        # On the pivots upper triangular with units, so of full row rank.
        for column in range(len(inputs)):
            if column not in pivots or pivots.index(column) > k:
                B[tail][column] = choices.option(small)
        B[tail][pivots[k]] = 1
    outputs = sorted([*range(channels), *(choices.integer(0, channels - 1) for _ in range(r))])
    rows = shuffled(choices, range(len(outputs)))
    C = [[0] * n for _ in outputs]
    for row, head in zip(rows, heads, strict=False):
        C[row][head] = 1
    for row in rows[r:]:
        C[row] = [choices.option(small) for _ in range(n)]
    draft = Draft(A, B, C)
    system = finished(choices, draft, inputs, outputs, channels, time)
    return Drawn(
        system,
        jointly_controllable=True,
        jointly_observable=True,
        indices=tuple(sorted(indices, reverse=True)),
    )


def system_with_remnant(
    choices: Choices,
    states: int,
    channels: int,
    *,
    nonzero_transfer: bool = False,
    time: str = "continuous",
) -> Drawn:
    """Draw a system with a complementary subsystem of known remnant polynomial.

    Parameters
    ----------
    choices : Choices
    states : int
        n ≥ 3.
    channels : int
        m ≥ 2.
    nonzero_transfer : bool
        Whether the complementary subsystem has a nonzero transfer matrix.
    time : {"continuous", "discrete"}

    Returns
    -------
    Drawn
        With ``subset``, ``remnant`` (which may be 1), and ``complete=False`` if that follows.

    Notes
    -----
    Zones as in `primary_form`.  When zone 1 is controlled by T and zone 3 observed by s, P_s is
    equivalent to diag(I, xI − A_22, 0), and its remnant polynomial is that of zone 2. If also a
    chain of integrators leads from one input of T through zones 1 and 3 to one output of s, P_s is
    equivalent to diag(I, xI − A_22, 1, 0): then the first n invariant polynomials do not include
    the last one of xI − A_22.

    Examples
    --------
    >>> from mcexact.derived.drawn.primary_form import SeededChoices
    >>> drawn = system_with_remnant(SeededChoices(1), states=4, channels=2)
    >>> drawn.remnant.degree <= 4, len(drawn.subset)
    (True, 1)
    """
    if channels < 2 or states < 3:
        raise UsageError("a prescribed remnant polynomial needs at least 2 channels and 3 states")
    order = shuffled(choices, range(channels))
    reach = frozenset(order[: choices.integer(1, channels - 1)])
    subset = frozenset(range(channels)) - reach
    # Every channel has two inputs and outputs, so that two chains of zone 2 are possible.
    owners = tuple(sorted([*range(channels)] * 2))
    middle = choices.integer(1, states - 2)
    polynomial = irreducible(choices, 1)
    if nonzero_transfer:
        first = choices.integer((middle + 1) // 2, middle)
        lengths = [first, *([middle - first] if middle > first else [])]
        # The path is nilpotent, and a mode 0 of zone 2 would need its ports.
        polynomial = polynomial if polynomial[0] else (-1, 1)
    else:
        lengths = [middle]
    between = [Chain(polynomial, (2,) * length) for length in lengths]
    before = choices.integer(1, states - middle - 1)
    after = states - middle - before
    zero: Coefficients = (0, 1)
    if nonzero_transfer:
        path = [Chain(zero, (3,) * after + (1,) * before, reach, subset, pure=True)]
    else:
        path = [
            Chain(zero, (1,) * before, reached_by=reach),
            Chain((-3, 1), (3,) * after, seen_by=subset),
        ]
    inputs, outputs = Ports(owners, reach, 1), Ports(owners, subset, 3)
    draft = lay_out(choices, [*path, *between], inputs, outputs)
    exponent = sum(sorted(lengths)[:-1]) if nonzero_transfer else middle
    remnant = as_polynomial(polynomial) ** exponent
    return Drawn(
        finished(choices, draft, owners, owners, channels, time),
        jointly_controllable=True,
        jointly_observable=True,
        subset=tuple(sorted(subset)),
        remnant=remnant,
        complete=False if exponent or not nonzero_transfer else None,
    )


def incomplete_system(
    choices: Choices,
    states: int,
    channels: int,
    reason: str,
    *,
    time: str = "continuous",
) -> Drawn:
    """Draw a jointly controllable and observable system that is not complete.

    Parameters
    ----------
    choices : Choices
    states, channels : int
        At least 2 each.
    reason : {"fixed mode", "transfer graph"}
        Either a fixed mode; or no fixed mode, and a nonempty proper set of channels that no edge of
        the transfer graph leaves.
    time : {"continuous", "discrete"}

    Returns
    -------
    Drawn
        With ``complete=False``; ``subset`` is s for the fixed mode, and the set that no edge enters
        for the transfer graph.

    Notes
    -----
    For the transfer graph: there is no zone 2, one channel of T alone controls and observes zone 1,
    one channel of s alone zone 3.  So no mode is fixed, and C_s (xI − A)⁻¹ B_T = 0.

    Examples
    --------
    >>> from mcexact.derived.drawn.primary_form import SeededChoices
    >>> incomplete_system(SeededChoices(0), 3, 2, "transfer graph").fixed_modes
    False
    """
    if reason == "fixed mode":
        return system_with_fixed_mode(choices, states, channels, time=time)
    if reason != "transfer graph":
        raise UsageError(f'expected "fixed mode" or "transfer graph", found {reason!r}')
    if channels < 2 or states < 2:
        raise UsageError("an incomplete transfer graph needs at least 2 channels and 2 states")
    order = shuffled(choices, range(channels))
    reach = frozenset(order[: choices.integer(1, channels - 1)])
    subset = frozenset(range(channels)) - reach
    inputs, outputs = draw_ports(choices, channels, reach=reach, subset=subset)
    size = choices.integer(1, states - 1)
    chains = []
    for zone, agents, part in ((1, reach, size), (3, subset, states - size)):
        one = frozenset({choices.option(sorted(agents))})
        limit = min(live(inputs, one), live(outputs, one))
        chains += [
            replace(chain, reached_by=one, seen_by=one)
            for chain in draw_chains(choices, part, limit, zones=(zone,))
        ]
    draft = lay_out(choices, chains, inputs, outputs)
    return Drawn(
        finished(choices, draft, inputs.owners, outputs.owners, channels, time),
        jointly_controllable=True,
        jointly_observable=True,
        fixed_modes=False,
        subset=tuple(sorted(subset)),
        complete=False,
    )


# Drawn systems over neighbor graphs with a prescribed bound on shared dimensions.


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
    >>> from mcexact.derived.drawn.primary_form import SeededChoices
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
    polynomial = _planted_factor(choices, degree)
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


def _planted_factor(choices: Choices, degree: int) -> Coefficients:
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
        A, root = system.A * Fraction(1, bound), root.scale(bound).monic()
    else:
        A = system.A - Matrix.identity(system.n) * bound
        root = root.compose_shift(bound)
    return MultiChannelSystem(A, B, C, time=system.time), root


# Systems that are determined by a seed and a few sizes.

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
        The degree of an irreducible polynomial whose roots are fixed modes; None plants none.
    time : str
        ``"continuous"`` or ``"discrete"``.
    neighbors : bool
        Whether it has a strongly connected neighbor graph.
    deficiency : int or None
        The bound of Theorem 2 over a drawn neighbor graph, which determines n; None leaves it open.
    network : str or None
        The kind of network whose equations the system has; its fixed modes are then not known.
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
    """Draw a network, about which nothing else can be prescribed."""
    if draw.fixed_degree is not None or draw.deficiency is not None:
        raise UsageError("a network has fixed modes or not: prescribe none, and no bound")
    if is_discrete(draw.time):
        raise UsageError("networks are drawn in continuous time: sample one with c2d")
    if draw.states > _MOST_STATES:
        raise LimitReached(f"at most {_MOST_STATES} states of a network are drawn")
    return _with_graph(choices, draw, network_system(choices, network, draw.states, draw.channels))


def _with_graph(choices: Choices, draw: Draw, system: MultiChannelSystem) -> MultiChannelSystem:
    """Add a strongly connected neighbor graph to the system, if the draw asks for one."""
    if not draw.neighbors:
        return system
    return system.with_neighbors(drawn_graph(choices, system.names, strongly_connected=True))
