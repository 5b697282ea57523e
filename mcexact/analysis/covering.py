"""Covering integer programs: the optimum, and a branch tree that proves it exactly.

The program is

    minimize Σ c_i x_i  subject to  Σ_{i ∈ S_k} x_i ≥ d_k for every cut k, 0 ≤ x_i ≤ u_i, x integer,

with positive rational costs.  HiGHS searches in floating point, and its results are only proposals.
`minimize` returns an optimal point, whose values are checked as integers against every cut.  That
no point is cheaper is proved by `branch_tree`: each leaf is a box of points with rational
multipliers of the cuts, which bound the cost from below by weak duality; they are verified here and
again by the checker.  The problem is NP-hard, so the tree has a limit of nodes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

from mcexact.errors import InternalError, LimitReached, McexactError
from mcexact.exact.matrix import to_float

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]

DEFAULT_NODE_LIMIT = 10_000
"""The number of branch nodes after which the search for a tree ends."""

_SAFE_RATIO = 10**6

_MULTIPLIER_DENOMINATORS = (1, 2, 3, 4, 6, 12, 60, 1000, 10**6)


@dataclass(frozen=True)
class CoveringCut:
    """The inequality Σ_{i ∈ support} x_i ≥ demand, with its proof for a certificate."""

    support: frozenset[int]
    demand: int
    evidence: Any = None


@dataclass(frozen=True)
class CoveringProgram:
    """A covering integer program in ``len(costs)`` variables.

    Attributes
    ----------
    costs
        Positive rational costs.
    upper
        Upper bound of each variable, or None.
    cuts
        The covering inequalities.
    """

    costs: tuple[Fraction, ...]
    upper: tuple[int | None, ...]
    cuts: tuple[CoveringCut, ...] = ()

    @cached_property
    def unit(self) -> Fraction:
        """The unit in which costs become floats, chosen so that they are integers if possible."""
        content = math.gcd(*(int(cost * self.grid) for cost in self.costs))
        return max(Fraction(content or 1, self.grid), max(self.costs, default=Fraction(0)) / 2**40)

    @cached_property
    def float_costs(self) -> list[float]:
        """The costs in units, for the search in floating point."""
        return [to_float(cost / self.unit) for cost in self.costs]

    @cached_property
    def largest_demand(self) -> int:
        """A value of a variable beyond which no cut needs more."""
        return max((cut.demand for cut in self.cuts), default=0)

    def unsolved(self, what: str) -> McexactError:
        """The error to raise if the floating-point search did not lead to a proof."""
        if max(self.costs) > _SAFE_RATIO * min(self.costs):
            return LimitReached(
                f"the prices differ by a factor of more than {_SAFE_RATIO}, and the search in "
                "floating point found no proof; bring them closer together"
            )
        return InternalError(what)

    @cached_property
    def grid(self) -> int:
        """The common denominator of the costs: every objective value is a multiple of 1/grid."""
        return math.lcm(1, *(cost.denominator for cost in self.costs))

    def cost(self, values: Sequence[int]) -> Fraction:
        """The objective Σ c_i x_i."""
        return sum((c * x for c, x in zip(self.costs, values, strict=True)), Fraction(0))

    def violated_cut(self, upper: Sequence[int | None]) -> int | None:
        """The first cut that no x ≤ upper satisfies, or None.

        Parameters
        ----------
        upper : sequence of int or None
            An upper bound of each variable; None is no bound.

        Examples
        --------
        >>> cuts = (CoveringCut(frozenset({0, 1}), 2, None),)
        >>> program = CoveringProgram((Fraction(1), Fraction(1)), (None, None), cuts)
        >>> program.violated_cut((0, 1)), program.violated_cut((0, None))
        (0, None)
        """
        for number, cut in enumerate(self.cuts):
            bounds = [upper[i] for i in cut.support]
            finite = [bound for bound in bounds if bound is not None]
            if len(finite) == len(bounds) and sum(finite) < cut.demand:
                return number
        return None


Node = dict[str, Any]
"""``{"variable": i, "at_most": k}``, ``{"violated": k}`` or ``{"multipliers": [[k, y], …]}``."""

Tree = tuple[Node, ...]
"""The nodes in preorder: an inner node splits its box into x_i ≤ k, whose tree follows, and
x_i ≥ k + 1, whose tree follows that."""


def minimize(program: CoveringProgram, *, canonical: bool = True) -> tuple[int, ...] | None:
    """Find an optimal integer point of a covering program, or None if it has no point.

    Parameters
    ----------
    program
        The covering program.
    canonical
        Break ties: among all optimal points take the lexicographically least.

    Notes
    -----
    HiGHS searches in floating point.  The returned point is checked against every cut; only
    :func:`branch_tree` proves that no point is cheaper.
    """
    if program.violated_cut(program.upper) is not None:
        return None
    if not program.costs:
        return ()
    values = _integer_optimum(program, program.float_costs, ())
    if not canonical or not any(values):
        return values
    best = program.cost(values)
    fixed: list[int] = []
    for variable in range(len(program.costs)):
        if values[variable] > 0:
            objective = [1.0 if i == variable else 0.0 for i in range(len(program.costs))]
            values = _integer_optimum(program, objective, fixed, at_most=best)
            if program.cost(values) != best:
                raise program.unsolved("a tie of a covering program was broken at another cost")
        fixed.append(values[variable])
    return values


def _integer_optimum(
    program: CoveringProgram,
    objective: Sequence[float],
    fixed: Sequence[int],
    at_most: Fraction | None = None,
) -> tuple[int, ...]:
    """Minimize ``objective`` over the program, the first variables fixed, the cost bounded."""
    import numpy as np
    from scipy.optimize import Bounds, LinearConstraint, milp

    size = len(program.costs)
    rows = [_row(cut, size) for cut in program.cuts]
    low = [to_float(cut.demand) for cut in program.cuts]
    high = [np.inf] * len(rows)
    if at_most is not None:
        rows.append(np.array(program.float_costs))
        low.append(-np.inf)
        high.append(to_float(at_most / program.unit) + 0.5)
    constraints = [LinearConstraint(np.array(rows), low, high)] if rows else []
    top = program.largest_demand
    upper = np.array([np.inf if u is None else to_float(min(u, top)) for u in program.upper])
    lower = np.zeros(size)
    for i, value in enumerate(fixed):
        lower[i] = upper[i] = value
    optimum = milp(
        np.array(objective),
        integrality=np.ones(size, dtype=int),
        bounds=Bounds(lower, upper),
        constraints=constraints,
        options={"mip_rel_gap": 0.0},
    )
    if optimum.x is None:
        raise program.unsolved(f"the integer program could not be solved: {optimum.message}")
    values = tuple(round(float(x)) for x in optimum.x)
    if not all(sum(values[i] for i in cut.support) >= cut.demand for cut in program.cuts):
        raise InternalError("the integer program's answer does not satisfy its own cuts")
    return values


def _row(cut: CoveringCut, size: int) -> Floats:
    import numpy as np

    row = np.zeros(size)
    row[list(cut.support)] = 1.0
    return row


def branch_tree(
    program: CoveringProgram,
    value: Fraction | None,
    *,
    node_limit: int = DEFAULT_NODE_LIMIT,
) -> Tree:
    """Find a tree that proves that no point of the program costs less than ``value``.

    Parameters
    ----------
    program
        The covering program.
    value
        The optimal cost, or None to prove that the program has no point.
    node_limit
        The number of nodes after which the search ends, at least 1.

    Raises
    ------
    LimitReached
        After ``node_limit`` nodes, or if the prices differ too much for floating point.

    Notes
    -----
    A leaf holds multipliers y ≥ 0.  With r = c − Σ_k y_k 1_{S_k} every point of the leaf costs at
    least Σ y_k d_k + Σ_i min(r_i l_i, r_i u_i); rounded up to the grid of the costs this is ≥
    ``value``.
    A point cheaper than ``value`` has x_i ≤ value / c_i, so every leaf is bounded from above.
    """
    first = tuple(_tighter(u, value, c) for u, c in zip(program.upper, program.costs, strict=True))
    nodes: list[Node] = []
    boxes: list[tuple[tuple[int, ...], tuple[int | None, ...]]] = [((0,) * len(first), first)]
    while boxes:
        lower, upper = boxes.pop()
        if len(nodes) == node_limit:
            raise LimitReached(
                f"the branch tree reached its limit of {node_limit} nodes",
                lower=None if value is None else relaxation_bound(program, value)[0],
                upper=value,
            )
        node = _node(program, value, lower, upper)
        nodes.append(node)
        if "variable" in node:
            i, k = node["variable"], node["at_most"]
            boxes.append(((*lower[:i], k + 1, *lower[i + 1 :]), upper))
            boxes.append((lower, (*upper[:i], k, *upper[i + 1 :])))
    return tuple(nodes)


def _node(
    program: CoveringProgram,
    value: Fraction | None,
    lower: tuple[int, ...],
    upper: tuple[int | None, ...],
) -> Node:
    """Return a leaf if this box is finished, else the split of its most fractional variable."""
    violated = program.violated_cut(upper)
    if violated is not None:
        return {"violated": violated}
    if value is None:
        raise InternalError("a covering program without a violated cut has a point")
    relaxed, duals = _relaxation(program, lower, upper)
    multipliers = _proving_multipliers(program, lower, upper, duals, value)
    if multipliers is not None:
        return _leaf(multipliers)
    split = _most_fractional(relaxed)
    if split is not None:
        return {"variable": split, "at_most": math.floor(relaxed[split])}
    # The multipliers are not accurate enough, but a smaller box needs less accuracy.
    widths = [0 if u is None else u - l for l, u in zip(lower, upper, strict=True)]
    widest = max(range(len(widths)), key=widths.__getitem__)
    if not widths[widest]:
        raise program.unsolved("the relaxation is integral but cheaper than the optimum")
    return {"variable": widest, "at_most": lower[widest] + (widths[widest] - 1) // 2}


def relaxation_bound(program: CoveringProgram, value: Fraction) -> tuple[Fraction, Tree]:
    """A lower bound of every cost from the linear relaxation, and the tree that proves it.

    Parameters
    ----------
    program : CoveringProgram
    value : Fraction
        The cost of some point of the program.

    Notes
    -----
    The tree is one leaf.  Its multipliers bound the points that cost less than ``value``, and so
    all the more those that cost less than the bound, whose upper bounds are tighter.
    """
    upper = [_tighter(u, value, c) for u, c in zip(program.upper, program.costs, strict=True)]
    lower = (0,) * len(program.costs)
    _, duals = _relaxation(program, lower, upper)
    best, leaf = Fraction(0), _leaf([])
    for denominator in _MULTIPLIER_DENOMINATORS:
        multipliers = _multipliers(program, duals, denominator)
        bound = leaf_bound(program, lower, upper, multipliers) or Fraction(0)
        rounded = Fraction(math.ceil(bound * program.grid), program.grid)
        if rounded > best:
            best, leaf = rounded, _leaf(multipliers)
    return best, (leaf,)


def _leaf(multipliers: Sequence[tuple[int, Fraction]]) -> Node:
    return {"multipliers": [[k, y] for k, y in multipliers]}


def _tighter(upper: int | None, value: Fraction | None, cost: Fraction) -> int | None:
    if value is None:
        return upper
    implied = math.floor(value / cost)
    return implied if upper is None else min(upper, implied)


def _relaxation(
    program: CoveringProgram, lower: Sequence[int], upper: Sequence[int | None]
) -> tuple[Floats, Floats]:
    """Primal point of the linear relaxation over a box, and cut multipliers in units of cost."""
    import numpy as np
    from scipy.optimize import linprog

    size = len(program.costs)
    if not program.cuts:
        return np.array(lower, dtype=float), np.zeros(0)
    optimum = linprog(
        program.float_costs,
        A_ub=-np.array([_row(cut, size) for cut in program.cuts]),
        b_ub=[-to_float(cut.demand) for cut in program.cuts],
        bounds=[
            (low, None if high is None else max(low, min(high, program.largest_demand)))
            for low, high in zip(lower, upper, strict=True)
        ],
        method="highs-ds",
    )
    if optimum.x is None:
        raise program.unsolved(f"the linear relaxation could not be solved: {optimum.message}")
    return np.asarray(optimum.x), -np.asarray(optimum.ineqlin.marginals)


def linear_optimum(
    program: CoveringProgram,
) -> tuple[list[float], list[list[tuple[int, Fraction]]]]:
    """Propose an optimum of the linear program without upper limits, and multipliers of the cuts.

    Returns
    -------
    tuple
        A point in floating point, and pairs of cuts with positive multipliers for each of several
        denominators; nothing is verified.
    """
    size = len(program.costs)
    point, duals = _relaxation(program, (0,) * size, (None,) * size)
    proposals = [_multipliers(program, duals, each) for each in _MULTIPLIER_DENOMINATORS]
    return [float(x) for x in point], proposals


def _proving_multipliers(
    program: CoveringProgram,
    lower: Sequence[int],
    upper: Sequence[int | None],
    duals: Floats,
    value: Fraction,
) -> list[tuple[int, Fraction]] | None:
    """Multipliers of small denominator near ``duals`` that prove ``value`` exactly, or None."""
    for denominator in _MULTIPLIER_DENOMINATORS:
        multipliers = _multipliers(program, duals, denominator)
        bound = leaf_bound(program, lower, upper, multipliers)
        if bound is not None and Fraction(math.ceil(bound * program.grid), program.grid) >= value:
            return multipliers
    return None


def _multipliers(
    program: CoveringProgram, duals: Floats, denominator: int
) -> list[tuple[int, Fraction]]:
    """The positive multipliers near ``duals`` of at most this denominator, in units of cost."""
    rounded = (Fraction(float(dual)).limit_denominator(denominator) for dual in duals)
    return [(k, y * program.unit) for k, y in enumerate(rounded) if y > 0]


def leaf_bound(
    program: CoveringProgram,
    lower: Sequence[int],
    upper: Sequence[int | None],
    multipliers: Sequence[tuple[int, Fraction]],
) -> Fraction | None:
    """The bound Σ y_k d_k + Σ_i min over [l_i, u_i] of r_i x_i, or None when it is unbounded.

    Parameters
    ----------
    program : CoveringProgram
        With costs c_i and cuts Σ x_i ≥ d_k over the support of cut k.
    lower, upper : sequence of int, of int or None
        The box [l_i, u_i] of a leaf of the branch tree.
    multipliers : sequence of (int, Fraction)
        Pairs of k and y_k ≥ 0, which define r_i = c_i − Σ y_k over the cuts k whose support has i.

    Notes
    -----
    By weak duality every point of the box that satisfies the cuts costs at least this much, for
    all multipliers y ≥ 0; so they may come from floating point.
    """
    reduced = list(program.costs)
    bound = Fraction(0)
    for k, y in multipliers:
        bound += y * program.cuts[k].demand
        for i in program.cuts[k].support:
            reduced[i] -= y
    for r, low, high in zip(reduced, lower, upper, strict=True):
        if r >= 0:
            bound += r * low
        elif high is None:
            return None
        else:
            bound += r * high
    return bound


def _most_fractional(values: Floats) -> int | None:
    gaps = [abs(float(x) - round(float(x))) for x in values]
    widest = max(range(len(gaps)), key=gaps.__getitem__, default=None)
    return None if widest is None or gaps[widest] < 1e-6 else widest
