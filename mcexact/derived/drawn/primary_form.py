"""Choices, and systems of Jordan chains from which others are drawn.

Choices come from a seed (`SeededChoices`) or from another source, such as a search for a simple
counterexample.  `draw_ports` and `draw_chains` draw the parts of a system, `lay_out` assembles its
matrices, and `finished` hides their structure by a change of basis.

A *chain* of a monic p of degree d and length k is the block J_k(p), k companion matrices of p on
the diagonal and identities above them: a Jordan chain for every root of p.  Its left eigenvectors
live in its last block, its right eigenvectors in its first.  So a system of chains is controllable
iff for every p the rows of B at the last blocks are independent over Q[x]/(p), and observable iff
the columns of C at the first blocks are.  Every pair (A, B) is similar to one of this form.

A *zone* is 1, 2 or 3.  Blocks of a chain never step down in zone, so that A is block upper
triangular in them::

            zone 1  zone 2  zone 3               T    s
        A = ⎡ *       *       * ⎤          B = ⎡ *    * ⎤       C_T = [ *  *  * ]
            ⎢ 0       *       * ⎥              ⎢ 0    * ⎥       C_s = [ 0  0  * ]
            ⎣ 0       0       * ⎦              ⎣ 0    * ⎦

Channels in T act on zone 1 only and the others, s, measure zone 3 only.  Then no constant
decentralized gains move an eigenvalue of zone 2.  (A chain that does step down, from zone 3 to zone
1, carries the inputs of T to the outputs of s.)
"""

from __future__ import annotations

import itertools
import random
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Protocol, TypeVar

from mcexact.errors import UsageError
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.system import MultiChannelSystem

# Sources of the choices from which systems are drawn, such as a seed.

T = TypeVar("T")


class Choices(Protocol):
    """A source of choices.

    Small numbers and early options should give simple systems, since a search for a simple example
    prefers these.
    """

    def integer(self, low: int, high: int) -> int:
        """Draw an integer from ``low`` to ``high``, both included."""
        ...  # pragma: no cover

    def option(self, options: Sequence[T]) -> T:
        """Draw one of the options."""
        ...  # pragma: no cover


class SeededChoices:
    """Pseudorandom choices, which are determined by a seed.

    Parameters
    ----------
    seed : int or str

    Examples
    --------
    >>> first, second = SeededChoices(7), SeededChoices(7)
    >>> first.integer(0, 10**6) == second.integer(0, 10**6)
    True
    """

    def __init__(self, seed: int | str) -> None:
        self._random = random.Random(seed)

    def integer(self, low: int, high: int) -> int:
        """Draw an integer from ``low`` to ``high``, both included, uniformly."""
        return self._random.randint(low, high)

    def option(self, options: Sequence[T]) -> T:
        """Draw one of the options uniformly."""
        return options[self._random.randrange(len(options))]


def shuffled(choices: Choices, items: Sequence[T]) -> list[T]:
    """Draw a permutation of the items; the simplest choices keep their order."""
    rest = list(items)
    return [rest.pop(choices.integer(0, len(rest) - 1)) for _ in items]


# Integer systems made of Jordan chains, with zones that some channels cannot control or observe.

Coefficients = tuple[int, ...]


@dataclass(frozen=True)
class Chain:
    """A chain of a monic polynomial, with the channels that have to control and observe it.

    Attributes
    ----------
    polynomial : tuple of int
        Coefficients, constant first.
    zones : tuple of int
        One for each block.
    reached_by, seen_by : frozenset of int or None
        The channels one of which makes its end controllable (its start observable).  None allows
        every channel; the empty set means that no channel does.
    pure : bool
        Whether the input and the output that do so act on and measure nothing else.
    """

    polynomial: Coefficients
    zones: tuple[int, ...]
    reached_by: frozenset[int] | None = None
    seen_by: frozenset[int] | None = None
    pure: bool = False

    @property
    def degree(self) -> int:
        """Degree of the polynomial."""
        return len(self.polynomial) - 1

    @property
    def size(self) -> int:
        """Number of states."""
        return self.degree * len(self.zones)


@dataclass(frozen=True)
class Ports:
    """The inputs or the outputs of all channels in one row.

    Attributes
    ----------
    owners : tuple of int
        The channel of each input (output).
    confined : frozenset of int
        The channels that are restricted to one zone: T for inputs, s for outputs.
    zone : int
        This zone: 1 for inputs, 3 for outputs.
    inactive : frozenset of int
        The channels whose matrix stays 0.
    """

    owners: tuple[int, ...]
    confined: frozenset[int]
    zone: int
    inactive: frozenset[int] = frozenset()

    def may_touch(self, port: int, zone: int) -> bool:
        """Whether an input may act on (an output may measure) a zone."""
        owner = self.owners[port]
        return owner not in self.inactive and (owner not in self.confined or zone == self.zone)


@dataclass
class Draft:
    """The integer matrices under construction: A (n×n), B (n×Σp_i), C (Σq_i×n)."""

    A: list[list[int]]
    B: list[list[int]]
    C: list[list[int]]
    scales: list[Fraction] = field(default_factory=list)

    @property
    def n(self) -> int:
        """Number of states."""
        return len(self.A)

    def hide(self, choices: Choices, steps: int, bound: int = 60) -> None:
        """Change the basis of the states by drawn unimodular steps.

        Parameters
        ----------
        choices : Choices
        steps : int
            The number of elementary steps tried.
        bound : int
            A step is left out if an entry becomes larger than this and larger than before.
        """
        n = self.n
        if n < 2:
            return
        for _ in range(steps):
            i, k = choices.integer(0, n - 1), choices.integer(1, n - 1)
            self._elementary(i, (i + k) % n, choices.option((1, -1)), bound)
        order = shuffled(choices, range(n))
        self.A = [[self.A[i][j] for j in order] for i in order]
        self.B = [self.B[i] for i in order]
        self.C = [[row[j] for j in order] for row in self.C]

    def _elementary(self, i: int, j: int, sign: int, bound: int) -> None:
        """Add ``sign`` times row j to row i, and subtract column i from column j accordingly."""
        driven = [a + sign * b for a, b in zip(self.B[i], self.B[j], strict=True)]
        row = [a + sign * b for a, b in zip(self.A[i], self.A[j], strict=True)]
        row[j] -= sign * row[i]
        column = [row[j] if k == i else line[j] - sign * line[i] for k, line in enumerate(self.A)]
        seen = [line[j] - sign * line[i] for line in self.C]
        if max(map(abs, [*row, *column, *driven, *seen])) > bound:
            return
        self.A[i] = row
        for k, line in enumerate(self.A):
            line[j] = column[k]
        self.B[i] = driven
        for line, entry in zip(self.C, seen, strict=True):
            line[j] = entry

    def matrices(
        self, inputs: Sequence[int], outputs: Sequence[int], m: int
    ) -> tuple[Matrix, list[Matrix], list[Matrix]]:
        """Return A, the B_i and the C_i, by assigning columns and rows to channels."""
        d = self.scales or [Fraction(1)] * self.n
        A = Matrix.from_rows(
            [[x * d[i] / d[j] for j, x in enumerate(row)] for i, row in enumerate(self.A)],
            ncols=self.n,
        )
        B = Matrix.from_rows(
            [[x * d[i] for x in row] for i, row in enumerate(self.B)], ncols=len(inputs)
        )
        C = Matrix.from_rows(
            [[x / d[j] for j, x in enumerate(row)] for row in self.C], ncols=self.n
        )
        return (
            A,
            [B.take(cols=[k for k, owner in enumerate(inputs) if owner == i]) for i in range(m)],
            [C.take(rows=[k for k, owner in enumerate(outputs) if owner == i]) for i in range(m)],
        )


def lay_out(choices: Choices, chains: Sequence[Chain], inputs: Ports, outputs: Ports) -> Draft:
    """Assemble A from chains, and draw B and C that control and observe their ends.

    Parameters
    ----------
    choices : Choices
    chains : sequence of Chain
        For every p at most as many as inputs that may act on their ends, and as outputs that may
        measure their starts.
    inputs, outputs : Ports

    Returns
    -------
    Draft
        (A, B) is controllable and (C, A) observable, except for chains that no channel may control
        or observe.
    """
    A, lasts, firsts = place(chains)
    zones = [zone for chain in chains for zone in chain.zones for _ in range(chain.degree)]
    # A companion matrix is controllable from its last state and observable from its first.
    drive = [
        _End(chain.polynomial, rows, rows[-1], chain.reached_by, chain.pure)
        for chain, rows in zip(chains, lasts, strict=True)
    ]
    sight = [
        _End(chain.polynomial, rows, rows[0], chain.seen_by, chain.pure)
        for chain, rows in zip(chains, firsts, strict=True)
    ]
    B = _connect(choices, drive, inputs, zones)
    C = _connect(choices, sight, outputs, zones)
    return Draft(A, [[row[state] for row in B] for state in range(len(A))], C)


def place(chains: Sequence[Chain]) -> tuple[list[list[int]], list[list[int]], list[list[int]]]:
    """A as the diagonal of all chains, and the states of the last and the first block of each."""
    n = sum(chain.size for chain in chains)
    A = [[0] * n for _ in range(n)]
    firsts: list[list[int]] = []
    lasts: list[list[int]] = []
    start = 0
    for chain in chains:
        d = chain.degree
        for k in range(len(chain.zones)):
            _companion(A, start + k * d, chain.polynomial)
            if k:
                for j in range(d):
                    A[start + (k - 1) * d + j][start + k * d + j] = 1
        firsts.append(list(range(start, start + d)))
        start += chain.size
        lasts.append(list(range(start - d, start)))
    return A, lasts, firsts


def _companion(A: list[list[int]], start: int, polynomial: Coefficients) -> None:
    d = len(polynomial) - 1
    for k in range(d - 1):
        A[start + k][start + k + 1] = 1
    for k in range(d):
        A[start + d - 1][start + k] = -polynomial[k]


@dataclass(frozen=True)
class _End:
    """One end of a chain: its states, and the state that represents 1 in Q[x]/(p)."""

    polynomial: Coefficients
    states: list[int]
    unit: int
    joined_by: frozenset[int] | None
    pure: bool


def _connect(
    choices: Choices, ends: Sequence[_End], ports: Ports, zones: Sequence[int]
) -> list[list[int]]:
    """Draw one row of n entries for each port such that the ends of each p are independent.

    For every p the joined ends have ports of their own, at which the matrix over Q[x]/(p) is
    triangular with units on the diagonal; all other entries are drawn.
    """
    n = len(zones)
    table = [[0] * n for _ in ports.owners]
    settled: set[tuple[int, int]] = set()
    for polynomial in dict.fromkeys(end.polynomial for end in ends):
        fitting = [
            (end, _fitting(end, ports, zones)) for end in ends if end.polynomial == polynomial
        ]
        # Ends that few ports may join come first.
        fitting.sort(key=lambda pair: len(pair[1]))
        taken: list[int] = []
        for end, candidates in fitting:
            if not candidates:
                settled.update((k, state) for k in range(len(table)) for state in end.states)
                continue
            port = choices.option([k for k in candidates if k not in taken])
            settled.update((k, state) for k in (*taken, port) for state in end.states)
            if end.pure:
                settled.update((port, state) for state in range(n))
            table[port][end.unit] = 1
            taken.append(port)
    _scatter(choices, table, settled, ports, zones)
    return table


def _fitting(end: _End, ports: Ports, zones: Sequence[int]) -> list[int]:
    """The ports that may join an end."""
    return [
        k
        for k, owner in enumerate(ports.owners)
        if ports.may_touch(k, zones[end.unit]) and (end.joined_by is None or owner in end.joined_by)
    ]


def _scatter(
    choices: Choices,
    table: list[list[int]],
    settled: set[tuple[int, int]],
    ports: Ports,
    zones: Sequence[int],
) -> None:
    """Draw some of the free entries, and at least one for each port without entries if possible."""
    n = len(zones)
    if not n or not table:
        return
    for _ in range(choices.integer(0, n + len(table))):
        port, state = choices.integer(0, len(table) - 1), choices.integer(0, n - 1)
        value = choices.option((1, -1, 2, -2, 3))
        if (port, state) not in settled and ports.may_touch(port, zones[state]):
            table[port][state] = value
    for port, row in enumerate(table):
        free = [
            state
            for state in range(n)
            if (port, state) not in settled and ports.may_touch(port, zones[state])
        ]
        if free and not any(row):
            row[choices.option(free)] = 1


# Drawn polynomials, chains, inputs and outputs.


def irreducible(choices: Choices, degree: int) -> Coefficients:
    """Draw a monic irreducible polynomial over Q: x − a, or one of Eisenstein's for the prime 2.

    Parameters
    ----------
    choices : Choices
    degree : int
        At least 1.

    Returns
    -------
    tuple of int
        Constant first.

    Examples
    --------
    >>> from mcexact.derived.drawn.primary_form import SeededChoices
    >>> len(irreducible(SeededChoices(0), 3)) - 1
    3
    """
    if degree < 1:
        raise UsageError(f"expected a degree >= 1, found {degree}")
    if degree == 1:
        return (-choices.option((0, 1, -1, 2, -2, 3)), 1)
    middle = [2 * choices.option((0, 1, -1)) for _ in range(degree - 1)]
    return (2 * choices.option((1, -1)), *middle, 1)


def draw_ports(
    choices: Choices,
    channels: int,
    *,
    reach: frozenset[int] = frozenset(),
    subset: frozenset[int] = frozenset(),
    inactive_channels: bool = False,
) -> tuple[Ports, Ports]:
    """Draw the numbers of inputs and outputs of the channels, and which channels are inactive."""
    inputs, outputs = [], []
    for i in range(channels):
        inputs += [i] * choices.option((1, 1, 1, 2))
        outputs += [i] * choices.option((1, 1, 1, 2))
    silent: frozenset[int] = frozenset()
    blind: frozenset[int] = frozenset()
    if inactive_channels:
        # At least one channel has inputs, and at least one has outputs.
        silent = frozenset(shuffled(choices, range(channels))[: choices.integer(0, channels - 1)])
        blind = frozenset(shuffled(choices, range(channels))[: choices.integer(0, channels - 1)])
    return (
        Ports(tuple(inputs), reach, 1, silent),
        Ports(tuple(outputs), subset, 3, blind),
    )


def live(ports: Ports, channels: Collection[int]) -> int:
    """The number of ports of the active channels."""
    return sum(owner in channels and owner not in ports.inactive for owner in ports.owners)


def draw_chains(
    choices: Choices,
    states: int,
    limit: int,
    planted: Sequence[Chain] = (),
    zones: Sequence[int] = (1, 3),
) -> list[Chain]:
    """Draw chains for the remaining states, at most ``limit`` of the same polynomial.

    Parameters
    ----------
    choices : Choices
    states : int
        The number of states of all chains.
    limit : int
        At least 1, and the number of planted chains of one polynomial.
    planted : sequence of Chain
        Prescribed chains, which come first.
    zones : sequence of int
        The zones in which the other chains may lie.
    """
    chains = list(planted)
    left = states - sum(chain.size for chain in chains)
    count = Counter(chain.polynomial for chain in chains)
    zone = choices.option(zones)
    pool = [irreducible(choices, 1) for _ in range(1 + states // 8)]
    while left:
        degree = choices.option((1, 1, 1, 1, 2, 3))
        polynomial = irreducible(choices, degree) if 1 < degree <= left else None
        if polynomial is None or count[polynomial] >= limit:
            free = [each for each in pool if count[each] < limit]
            longer = [k for k, c in enumerate(chains) if c.degree <= left and c not in planted]
            if not free and longer:
                # Lengthening a chain does not need further ports.
                k = choices.option(longer)
                chains[k] = replace(chains[k], zones=(*chains[k].zones, chains[k].zones[-1]))
                left -= chains[k].degree
                continue
            fresh = ((-a, 1) for a in itertools.count() if not count[-a, 1])
            polynomial = choices.option(free) if free else next(fresh)
        d = len(polynomial) - 1
        length = choices.integer(1, min(left // d, 1 + states // 4))
        chains.append(Chain(polynomial, (zone,) * length))
        count[polynomial] += 1
        left -= d * length
        # Changing the zone is the simpler choice, so that no zone stays empty.
        zone = choices.option([*(z for z in zones if z != zone), zone])
    return chains


def finished(
    choices: Choices,
    draft: Draft,
    inputs: Sequence[int],
    outputs: Sequence[int],
    channels: int,
    time: str,
    denominators: bool = False,
) -> MultiChannelSystem:
    """Hide the structure by a change of basis, and make the system."""
    # Small examples may keep a readable basis; large ones never do.
    least = 2 * draft.n if draft.n > 12 else 0
    draft.hide(choices, choices.integer(least, 4 * draft.n))
    if denominators:
        draft.scales = [Fraction(choices.option((1, 1, 2, 3))) for _ in range(draft.n)]
    A, B, C = draft.matrices(inputs, outputs, channels)
    return MultiChannelSystem(A, B, C, time=time)


def as_polynomial(coefficients: Coefficients) -> Polynomial:
    return Polynomial(tuple(Fraction(c) for c in coefficients))
