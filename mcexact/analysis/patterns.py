"""Structural fixed modes, and why modes of a plant are fixed: by its zeros, or by equalities.

`structural_fixed_modes` decides what is fixed whatever the numbers at the places of the nonzero
entries are.  The digraph has a node for each state, input and output, and an edge for each entry of
A, B, C and of the gains.  Two things are fixed for all numbers, and almost all fix no more (Sezer
and Šiljak 1981; Pichai, Sezer and Šiljak 1984):

1. the modes of A_UU, U the states whose strong components have no input and no output;
2. z modes at 0, where disjoint closed paths cover at most all but z of the other states.

That number is a least-cost perfect matching of rows with columns: each state whose own place has no
entry of A may be left out, at the cost 1.  Some places that cost nothing are taken at once, and
others along shortest paths, whose lengths are the potentials that prove the cost least.

`why_fixed` divides the fixed modes of a plant by this, with the plant's own numbers in A_UU, and
names the null spaces of those that equalities fix and that all channels together do not observe, or
not control.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate, islice
from typing import Any

from mcexact.analysis.fixed_modes import fixed_spectrum, pencil_rank
from mcexact.answer.modes import FixedFactor, FixedSpectrum, PencilRank
from mcexact.answer.patterns import EQUALITIES, ZEROS, Information, StructuralFixedModes
from mcexact.answer.templates import Sentence
from mcexact.derived.constructions import dual
from mcexact.errors import InputError, UsageError, one_of
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import written
from mcexact.model.graph import strong_components
from mcexact.model.system import MultiChannelSystem
from mcexact.shown import Shown

Costs = dict[tuple[int, int], int]
"""0 or 1 for each place, a row and a column, that may be taken."""
_X = Polynomial.from_roots([0])
_MOST_LAWS = 4


def structural_fixed_modes(
    system: MultiChannelSystem, information: Information = "own"
) -> StructuralFixedModes:
    """Decide which modes are fixed for all numbers at the places of the nonzero entries.

    Parameters
    ----------
    system : MultiChannelSystem
        Without feedthrough.
    information : {"own", "outputs"}
        Whether each agent feeds back its own outputs alone, or also those of its neighbors.

    Returns
    -------
    StructuralFixedModes
        Its certificate proves what all such plants have in common; that almost all have no more is
        a theorem (``proofs/structural_fixed_modes.md``).

    Raises
    ------
    InputError
        If the plant has feedthrough.
    UsageError
        If the plant has no neighbor graph, and outputs of neighbors are fed back.

    Notes
    -----
    Exact.  With N states, inputs and outputs and E entries, those of the gains among them, it takes
    O(E log N) steps for each shortest path, at most N of these, besides det(xI − A_UU).

    Examples
    --------
    No input drives the first state, so that its mode is its own number, whatever the gains are:

    >>> plant = MultiChannelSystem([[1, 0], [0, 2]], [[[0], [1]]], [[[1, 1]]])
    >>> found = structural_fixed_modes(plant)
    >>> found.without_feedback, str(found.polynomial)
    ((0,), 'x - 1')

    One agent moves one of three states that it measures, and the others are integrals of that one:
    no two of these have numbers of their own, and one mode stays at 0.

    >>> plant = MultiChannelSystem(
    ...     [[0, 0, 0], [1, 0, 0], [1, 0, 0]], [[[1], [0], [0]]], [[[0, 1, 1]]]
    ... )
    >>> found = structural_fixed_modes(plant)
    >>> found.without_feedback, found.at_zero
    ((), 1)

    In a generic plant with these zeros nothing is fixed; in this one 3 is, by equal numbers:

    >>> plant = MultiChannelSystem([[1, 2], [4, -1]], [[[1], [0]]], [[[1, -1]]])
    >>> structural_fixed_modes(plant).empty, str(fixed_spectrum(plant).polynomial)
    (True, 'x - 3')
    """
    InputError.require(system, MultiChannelSystem, "system")
    one_of(information, ("own", "outputs"), "information")
    if system.D is not None:
        raise InputError("expected a plant without feedthrough", where="system")
    places, size = _places(system, information)
    edges = ((b, a) for a, b in places)
    parts = strong_components(size, edges)
    apart = sorted(a for part in parts if part[-1] < system.n for a in part)
    left = sorted({*range(size)} - {*apart})
    costs = _within(places, left)
    rows, columns, matching = least_matching(len(left), costs)
    z = sum(costs[at] for at in enumerate(matching))
    own = characteristic_polynomial(system.A.take(apart, apart))
    return StructuralFixedModes(
        system,
        information=information,
        without_feedback=tuple(apart),
        at_zero=z,
        polynomial=own * _X**z,
        rows=tuple(rows),
        columns=tuple(columns),
        matching=tuple(left[k] for k in matching),
    )


def _places(system: MultiChannelSystem, information: str) -> tuple[Costs, int]:
    """Where [xI − A, −B, 0; 0, I, −K; −C, 0, I] can differ from 0, and its size; 1 for an x alone.

    The rows are those of states, inputs and outputs, in the order of the channels.
    """
    n, m = system.n, system.m
    senders: Sequence[Iterable[int]] = [[i] for i in range(m)]
    if information == "outputs":
        if system.neighbors is None:
            raise UsageError("the plant has no neighbor graph", where="information")
        senders = [system.neighbors.neighborhood(i) for i in range(m)]
    *starts, size = accumulate((n, *(p for p, _ in system.sizes), *(q for _, q in system.sizes)))
    inputs, outputs = starts[:m], starts[m:]
    places = {(k, k): int(k < n) for k in range(size)}
    places |= {(a, b): 0 for a, b, _ in system.A.nonzero()}
    for B, C, u, y in zip(system.B, system.C, inputs, outputs, strict=True):
        places |= {(a, u + k): 0 for a, k, _ in B.nonzero()}
        places |= {(y + k, b): 0 for k, b, _ in C.nonzero()}
    for i, u in enumerate(inputs):
        for j in senders[i]:
            block = (
                (u + k, outputs[j] + r) for k in range(system.p(i)) for r in range(system.q(j))
            )
            places |= dict.fromkeys(block, 0)
    return places, size


def _within(places: Costs, left: Sequence[int]) -> Costs:
    """The places in some rows and columns, renumbered."""
    new = {k: number for number, k in enumerate(left)}
    return {(new[i], new[j]): x for (i, j), x in places.items() if i in new and j in new}


# A perfect matching of least cost, with potentials that prove it least.  SciPy's and networkx's
# solvers return the matching alone.


def least_matching(size: int, costs: Costs) -> tuple[list[int], list[int], list[int]]:
    """A perfect matching of rows with columns of least cost, which is 0 or 1 at each place.

    Parameters
    ----------
    size : int
        The number of rows, and of columns.
    costs : dict
        Of each place that may be taken; those on the diagonal may be.

    Returns
    -------
    rows, columns, matching : list of int
        Potentials with rows[i] + columns[j] ≤ costs[i, j], which add up to the cost of the
        matching, and the column of each row.

    Examples
    --------
    >>> least_matching(2, {(0, 0): 1, (0, 1): 0, (1, 0): 0, (1, 1): 1})
    ([0, 0], [0, 0], [1, 0])
    >>> least_matching(2, {(0, 0): 1, (0, 1): 0, (1, 1): 1})
    ([1, 2], [0, -1], [0, 1])
    """
    into: list[list[tuple[int, int]]] = [[] for _ in range(size)]
    for (i, j), cost in sorted(costs.items()):
        into[i].append((j, cost))
    row_of = _first_matching(into)
    taken = {i: j for j, i in row_of.items()}
    rows, columns = [0] * size, [0] * size
    while len(taken) < size:
        _extend(into, rows, columns, taken, row_of)
    return rows, columns, [taken[i] for i in range(size)]


def _first_matching(into: list[list[tuple[int, int]]]) -> dict[int, int]:
    """The row of each column that is taken for nothing, by rows of few places first."""
    row_of = dict[int, int]()
    for i in sorted(range(len(into)), key=lambda i: len(into[i])):
        j = next((j for j, cost in into[i] if not cost and j not in row_of), -1)
        if j >= 0:
            row_of[j] = i
    return row_of


def _extend(
    into: list[list[tuple[int, int]]],
    rows: list[int],
    columns: list[int],
    taken: dict[int, int],
    row_of: dict[int, int],
) -> None:
    """Take one more row along a shortest path of reduced costs, and move the potentials (Dijkstra).

    Places that are taken have the reduced cost 0.
    """
    free = [i for i in range(len(rows)) if i not in taken]
    distance, before = dict.fromkeys(free, 0), dict[int, int]()
    to_column: dict[int, int] = {}
    queue, done = [(0, i) for i in free], set[int]()
    last, shortest = -1, 0
    while last < 0:
        length, i = heapq.heappop(queue)
        if i < 0:  # a free column at the end of a path
            last, shortest = -i - 1, length
        elif i not in done:
            done.add(i)
            for j, cost in into[i]:
                reached = length + cost - rows[i] - columns[j]
                if reached < to_column.get(j, reached + 1):
                    to_column[j], before[j] = reached, i
                    row = row_of.get(j)
                    heapq.heappush(queue, (reached, -j - 1 if row is None else row))
                    if row is not None:
                        distance[row] = reached
    for i in done:
        rows[i] += shortest - distance[i]
    for j, reached in to_column.items():
        columns[j] -= max(0, shortest - reached)
    while True:
        i = before[last]
        last_before = taken.get(i, -1)
        taken[i], row_of[last] = last, i
        if last_before < 0:
            return
        last = last_before


# Why modes of a plant are fixed.


@dataclass(frozen=True, eq=False)
class WhyFixed(Shown):
    """Why modes of a plant are fixed.

    Attributes
    ----------
    system : MultiChannelSystem
    structural : StructuralFixedModes or None
        What is fixed for all numbers at the same places; None if no mode is fixed, or nothing is
        known.
    by_zeros, by_equalities : tuple of Polynomial
        The factors of the fixed spectrum that its zeros fix: they stay with all other numbers at
        the same places, but those among the states without feedback.  And those that equalities
        between entries fix: almost all other numbers free them.
    laws : tuple of PencilRank
        For some of the latter that all channels together do not observe, or, of the dual plant, not
        control: the vectors of their null spaces.
    known : bool
        Whether the fixed spectrum is known; without it there is nothing in the others.
    """

    system: MultiChannelSystem
    structural: StructuralFixedModes | None = None
    by_zeros: tuple[Polynomial, ...] = ()
    by_equalities: tuple[Polynomial, ...] = ()
    laws: tuple[PencilRank, ...] = ()
    known: bool = True

    @property
    def answers(self) -> dict[str, StructuralFixedModes | PencilRank]:
        """The proofs, by the names of their certificates."""
        named: dict[str, StructuralFixedModes | PencilRank] = {}
        if self.structural is not None:
            named["structural_fixed_modes"] = self.structural
        return named | {f"law_{k}": law for k, law in enumerate(self.laws, 1)}

    def explain(self) -> str:
        """Say in plain words why modes are fixed, one factor a line."""
        if not self.known:
            return "nothing is known"
        return "\n".join(each.line for each in self._sentences()) or "no mode is fixed"

    def __repr__(self) -> str:
        if not self.known:
            return "WhyFixed(nothing is known)"
        zeros, equalities = len(self.by_zeros), len(self.by_equalities)
        return f"WhyFixed({zeros} factors by zeros, {equalities} by equalities)"

    def _sentences(self) -> Iterator[Sentence]:
        """Yield the reasons, which an analysis says of all factors at once where it can."""
        yield from (ZEROS(p=p) for p in self.by_zeros)
        yield from (EQUALITIES(p=p) for p in self.by_equalities)

    def _labeled(self) -> Iterator[tuple[str, str]]:
        yield from ((each.template.label, str(each)) for each in self._sentences())

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        laws = [
            {"mode": _listed(law.polynomial), "certificate": f"law_{k}.json"}
            for k, law in enumerate(self.laws, 1)
        ]
        return {
            "by_zeros": [_listed(p) for p in self.by_zeros],
            "by_equalities": [_listed(p) for p in self.by_equalities],
            "laws": laws,
        }


def _listed(p: Polynomial) -> list[Any]:
    return [written(c) for c in p.coefficients]


def why_fixed(
    system: MultiChannelSystem,
    spectrum: FixedSpectrum | None = None,
    structural: StructuralFixedModes | None = None,
) -> WhyFixed:
    """Say why modes of a plant are fixed.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant, no derived system, without feedthrough.
    spectrum, structural : optional
        Its fixed spectrum and its structural fixed modes, where each agent feeds back its own
        outputs, if these are known already.

    Raises
    ------
    InputError
        If the system is a derived one, or has feedthrough.
    UsageError
        If the answers are about another system, or about outputs of neighbors.

    Examples
    --------
    The outputs do not show (1, 1), since the rows of A sum to the same number:

    >>> plant = MultiChannelSystem([[1, 2], [4, -1]], [[[1], [0]]], [[[1, -1]]])
    >>> why = why_fixed(plant)
    >>> [str(p) for p in why.by_equalities], why.laws[0].kernel.matrices[0].rows()
    (['x - 3'], ((Fraction(1, 1),), (Fraction(1, 1),)))

    No input drives the first state, so that its mode is its own number, whatever the gains are:

    >>> plant = MultiChannelSystem([[1, 0], [0, 2]], [[[0], [1]]], [[[1, 1]]])
    >>> [str(p) for p in why_fixed(plant).by_zeros]
    ['x - 1']
    """
    InputError.require(system, MultiChannelSystem, "system")
    if system.subject:
        raise InputError("expected a plant, found a derived system", where="system")
    spectrum = FixedSpectrum.known(spectrum, system, "spectrum")
    structural = StructuralFixedModes.known(structural, system, "structural")
    if structural is not None and structural.information != "own":
        raise UsageError("found outputs of neighbors, expected an agent's own", where="structural")
    if spectrum is None:
        spectrum = fixed_spectrum(system)
    if spectrum.empty:
        return WhyFixed(system)
    if structural is None:
        structural = structural_fixed_modes(system)
    freed = [f for f in spectrum.factors if not f.polynomial.divides(structural.polynomial)]
    kept = tuple(f.polynomial for f in spectrum.factors if f not in freed)
    laws = tuple(_laws(system, freed))
    return WhyFixed(system, structural, kept, tuple(f.polynomial for f in freed), laws)


def _laws(system: MultiChannelSystem, factors: Iterable[FixedFactor]) -> Iterator[PencilRank]:
    """Null spaces at rational modes that all channels together do not observe or control."""
    whole = (
        factor
        for factor in factors
        if factor.polynomial.degree == 1 and factor.channels in ((), system.names)
    )
    for factor in islice(whole, _MOST_LAWS):
        about = system if factor.channels else dual(system)
        yield pencil_rank(about, system.names, factor.polynomial)
