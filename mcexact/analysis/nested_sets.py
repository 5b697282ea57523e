"""Nested sets of agents, which prove the least total that agents must share.

Dimensions n_i leave no mode fixed iff Σ n_i over N_s∖s is at least δ_s = n − rank P_s(λ) for all s
and λ.  Multipliers y_j of sets s_j, at most c_i in sum around any agent i, prove that Σ c_i n_i is
at least Σ y_j δ_{s_j}: with all c_i = 1 these are sets with pairwise disjoint boundaries.

If only the roots of one irreducible factor lose rank, such sets prove the least cost, and they can
be nested.  For δ is supermodular in s, and every agent is in the boundaries of s and t at least as
often as in those of s ∪ t and s ∩ t: two sets may be replaced by these until all are nested
(`uncrossed`).  An agent i is then in the boundaries of consecutive sets, so that the linear program
of a chain has integral optima.  `nested_sets` starts from any valid inequalities, and adds one that
its integral optimum violates, until it costs as much as is to be proved.  With several factors
there can be a gap, and a branch tree is needed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from mcexact.analysis.covering import CoveringCut, CoveringProgram, Tree, linear_optimum

Agents = frozenset[int]
Weights = dict[Agents, Fraction]

_MOST_ROUNDS = 1000
"""The rounds after which the search ends; each adds an inequality."""


@dataclass(frozen=True)
class Inequalities:
    """The inequalities of one factor of det(xI − A), from which nested sets are chosen.

    Attributes
    ----------
    cut : callable
        The inequality of a set of agents, or None if no rank is lost there.
    subset : callable
        The set of an inequality.
    violated : callable
        Inequalities that dimensions violate; none iff the dimensions suffice.
    """

    cut: Callable[[Agents], CoveringCut | None]
    subset: Callable[[CoveringCut], Agents]
    violated: Callable[[Sequence[int]], Sequence[CoveringCut]]


@dataclass(frozen=True)
class NestedSets:
    """Inequalities of nested sets, ascending, with positive multipliers."""

    cuts: tuple[CoveringCut, ...]
    multipliers: tuple[Fraction, ...]

    @property
    def cost(self) -> Fraction:
        """The cost below which no dimensions suffice."""
        pairs = zip(self.multipliers, self.cuts, strict=True)
        return sum((y * cut.demand for y, cut in pairs), Fraction(0))

    @property
    def tree(self) -> Tree:
        """The node that stands in a certificate in place of a branch tree."""
        return ({"nested": [[k, y] for k, y in enumerate(self.multipliers)]},)


def uncrossed(weights: Mapping[Agents, Fraction]) -> Weights:
    """Replace crossing sets by their unions and intersections until all sets are nested.

    Parameters
    ----------
    weights : mapping
        Positive multipliers of sets.

    Returns
    -------
    dict
        Multipliers of a chain; Σ y_s is the same, and so is, for every agent, the sum over the sets
        that contain it.

    Notes
    -----
    The smaller of two multipliers moves, so Σ y_s |s|² grows in every step, by at least twice the
    unit of the multipliers: the loop ends.

    Examples
    --------
    >>> a, b = frozenset({0, 1}), frozenset({1, 2})
    >>> chain = uncrossed({a: Fraction(1), b: Fraction(2)})
    >>> sorted((sorted(s), int(y)) for s, y in chain.items())
    [([0, 1, 2], 1), ([1], 1), ([1, 2], 1)]
    """
    chain: Weights = dict(weights)
    while True:
        crossing = next(
            ((s, t) for s in chain for t in chain if not (s <= t or t <= s)),
            None,
        )
        if crossing is None:
            return chain
        y = min(chain[each] for each in crossing)
        s, t = crossing
        for each, change in ((s, -y), (t, -y), (s | t, y), (s & t, y)):
            chain[each] = chain.get(each, Fraction(0)) + change
            if not chain[each]:
                del chain[each]


def _packed(program: CoveringProgram, multipliers: Sequence[tuple[int, Fraction]]) -> bool:
    """Whether the multipliers of the inequalities around every agent are at most its price."""
    around = [Fraction(0)] * len(program.costs)
    for k, y in multipliers:
        for i in program.cuts[k].support:
            around[i] += y
    return all(y <= price for y, price in zip(around, program.costs, strict=True))


def _best(program: CoveringProgram) -> tuple[tuple[int, ...], dict[int, Fraction]]:
    """The integers next to an optimum of the linear program, and multipliers within the prices."""
    point, proposals = linear_optimum(program)
    fitting = [dict(each) for each in proposals if _packed(program, each)]

    def value(multipliers: Mapping[int, Fraction]) -> Fraction:
        return sum((y * program.cuts[k].demand for k, y in multipliers.items()), Fraction(0))

    best = max(fitting, key=value, default={})
    return tuple(round(x) for x in point), best


def nested_sets(
    program: CoveringProgram, cost: Fraction | None, inequalities: Inequalities
) -> NestedSets | None:
    """Find nested sets that prove that no dimensions of a smaller cost suffice for one factor.

    Parameters
    ----------
    program : CoveringProgram
        Valid inequalities to begin with, and the prices, without upper limits.
    cost : Fraction or None
        The least cost, if it is known.
    inequalities : Inequalities
        Of one factor.  If it is the only one at whose roots rank is lost, the cost that is proved
        is the least of all.

    Returns
    -------
    NestedSets or None
        None if the linear programs were solved too inaccurately in floating point.

    Notes
    -----
    HiGHS proposes multipliers and points; multipliers are rounded and compared with the prices
    exactly, and the proof is checked again by the checker.
    """
    cuts = {inequalities.subset(cut): cut for cut in program.cuts}
    for _ in range(_MOST_ROUNDS):
        _, multipliers = _best(replace(program, cuts=tuple(cuts.values())))
        listed = list(cuts)
        chain = uncrossed({listed[k]: y for k, y in multipliers.items()})
        known = {s: cuts.get(s) or inequalities.cut(s) for s in sorted(chain, key=len)}
        nested = {s: cut for s, cut in known.items() if cut is not None}
        along = replace(program, cuts=tuple(nested.values()))
        point, multipliers = _best(along)
        used = sorted(multipliers)
        found = NestedSets(tuple(along.cuts[k] for k in used), tuple(multipliers[k] for k in used))
        if cost is not None and found.cost >= cost:
            return found
        new = {inequalities.subset(cut): cut for cut in inequalities.violated(point)}
        if cost is None and not new:
            return found
        if (new | nested).keys() <= cuts.keys():
            return None
        cuts |= nested | new
    return None


def largest_lower_bound(
    program: CoveringProgram, factors: Sequence[Inequalities]
) -> NestedSets | None:
    """Nested sets that prove the largest least cost of one factor alone.

    No dimensions of a smaller cost suffice; None if no factor has such a proof.

    Parameters
    ----------
    program : CoveringProgram
        The prices; its inequalities and upper limits are of no account.
    factors : sequence of Inequalities
        Those of each factor at whose roots rank is lost.
    """
    free = replace(program, upper=(None,) * len(program.costs), cuts=())
    proofs = (nested_sets(free, None, inequalities) for inequalities in factors)
    found = [proof for proof in proofs if proof is not None]
    return max(found, key=lambda proof: proof.cost, default=None)
