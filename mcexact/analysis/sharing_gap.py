"""How far the paper's bounds can be from the least common dimension, over one neighbor graph.

Theorem 2's bound (26) is a dimension of shared sub-states that suffices for every agent, and so is
Remark 2's bound (27) where outputs are not shared; neither need be the least.  Over a neighbor
graph ℕ the first is at most β(ℕ) times the least common dimension, the second at most m − γ(ℕ)
times, for every plant for which some common dimension suffices; and both factors are attained.

- β(ℕ) is the largest number of relays of two nonempty sets S and R of agents that are apart: no
  agent of S receives messages of R, and a relay receives messages of R and sends to S.
- m − γ(ℕ) is the largest number of agents in a boundary N_s∖s; γ(ℕ) is the domination number, the
  least size of a set s with N_s = {1, …, m}.

Both are NP-hard.  `sharing_gap` searches β by depth first over R, since R determines the largest S
that is apart from it; γ is the optimum of a covering program, which `covering` solves and proves.
At the limit on nodes either number comes with two bounds.  `extremal_plant` is a plant that attains
a factor.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction

from mcexact.analysis.covering import CoveringCut, CoveringProgram, Tree, branch_tree, minimize
from mcexact.answer.sharing_gap import SharingGap
from mcexact.derived.constructions import Share, checked_share
from mcexact.errors import InputError, InternalError, LimitReached, UsageError
from mcexact.exact.matrix import Matrix, as_requested
from mcexact.exact.rational import Entry
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_graph

NODE_LIMIT = 50_000
"""The nodes of a search; the checker needs about as many, and is granted enough for these."""

# The search: sets of agents are the bits of integers.


def _bits(members: Sequence[int]) -> int:
    """The set of these positions."""
    return sum(1 << i for i in members)


def _positions(bits: int) -> list[int]:
    """The positions of a set."""
    return [i for i in range(bits.bit_length()) if bits >> i & 1]


class _RelaySearch:
    """A depth-first search over R for two sets that are apart and have many relays.

    A node has the agents that are neither in R nor excluded from it, R, and the agents H that
    receive messages of R.  Whatever else joins R, S is within the complement of H, and a relay
    sends to an agent of that complement and receives messages of R or of an undecided agent.
    """

    def __init__(self, graph: NeighborGraph) -> None:
        self.m = graph.m
        self.heard = [_bits(graph.neighborhood(i)) for i in range(self.m)]
        self.followers = [
            _bits([i for i in range(self.m) if self.heard[i] >> j & 1]) for j in range(self.m)
        ]

    def run(self, most: int, limit: int, *, improve: bool) -> tuple[int, int, bool]:
        """Search for more than ``most`` relays.

        Parameters
        ----------
        most : int
            Nodes that cannot have more relays are closed.
        limit : int
            The number of nodes after which the search ends.
        improve : bool
            Whether to go on with the larger number when more are found, or to end.

        Returns
        -------
        tuple
            The largest number of relays that was found, R, and whether nothing is left open: then
            no R has more relays than that number, or than ``most``.
        """
        best, chosen = most, 0
        stack = [((1 << self.m) - 1, 0, 0)]
        nodes = 0
        while stack:
            undecided, R, H = stack.pop()
            if nodes == limit:
                return best, chosen, False
            nodes += 1
            apart = ((1 << self.m) - 1) & ~H
            if self._count(H, apart, undecided) <= best:
                continue
            relays = self._count(H, apart, 0)
            if relays > best:
                best, chosen = relays, R
                if not improve:
                    return best, chosen, False
            # An agent that nobody outside H hears changes nothing.
            gains = {
                j: (self.followers[j] & apart).bit_count()
                for j in range(self.m)
                if undecided >> j & 1
            }
            j = max(gains, key=gains.__getitem__, default=None)
            if j is not None and gains[j]:
                rest = undecided & ~(1 << j)
                stack.append((rest, R, H))
                stack.append((rest, R | 1 << j, H | self.followers[j]))
        return best, chosen, True

    def _count(self, H: int, apart: int, undecided: int) -> int:
        """The agents that send to an agent of ``apart``, and receive of R or may receive of it."""
        return sum(
            1
            for j in range(self.m)
            if (H >> j & 1 or self.heard[j] & undecided) and self.followers[j] & apart & ~(1 << j)
        )

    def apart_from(self, R: int) -> int:
        """The largest set S that is apart from R."""
        return _bits([i for i in range(self.m) if not self.heard[i] & R])


def _least(holds: Callable[[int], bool], low: int, high: int) -> int:
    """The least number from ``low`` on that holds, by bisection; ``high`` is known to hold."""
    while low < high:
        middle = (low + high) // 2
        low, high = (low, middle) if holds(middle) else (middle + 1, high)
    return high


def _most_relays(graph: NeighborGraph, limit: int) -> tuple[int, int, list[int], list[int]]:
    """The most relays found, a bound on β, and the sets S and R."""
    search = _RelaySearch(graph)
    lower, R, finished = search.run(0, limit, improve=True)
    upper = lower
    if not finished:
        # No two sets have more relays than m − 2, which needs no search.
        upper = _least(
            lambda most: search.run(most, limit, improve=False)[2], lower, max(graph.m - 2, lower)
        )
    S = search.apart_from(R) if lower else 0
    return lower, upper, _positions(S), _positions(R if lower else 0)


def _domination(graph: NeighborGraph, limit: int) -> tuple[list[int], int, Tree]:
    """A small dominating set, a lower bound on the size of any, and its proof."""
    m = graph.m
    cuts = tuple(
        CoveringCut(frozenset(i for i in range(m) if j in graph.neighborhood(i)), 1)
        for j in range(m)
    )
    program = CoveringProgram((Fraction(1),) * m, (1,) * m, cuts)
    values = minimize(program, canonical=False)
    if values is None:
        raise InternalError("every agent receives its own messages")
    size = sum(values)
    try:
        tree = branch_tree(program, Fraction(size), node_limit=limit)
    except LimitReached as error:
        size = int(error.lower or 0)
        tree = branch_tree(program, Fraction(size), node_limit=limit)
    return [i for i in range(m) if values[i]], size, tree


def sharing_gap(
    system: MultiChannelSystem | NeighborGraph,
    graph: NeighborGraph | None = None,
    *,
    node_limit: int = NODE_LIMIT,
) -> SharingGap:
    """Compute by which factors (26) and (27) can exceed the least common dimension over a graph.

    Parameters
    ----------
    system : MultiChannelSystem or NeighborGraph
        A graph, or a system with a graph; its matrices are of no account.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    node_limit : int
        The nodes of either search after which it ends with two bounds, at least 1.

    Raises
    ------
    UsageError
        If there is no neighbor graph, or the limit is not an integer of at least 1.

    Notes
    -----
    Exact.  β(ℕ) and m − γ(ℕ) are NP-hard; graphs of some 20 agents take well below a second, and at
    the limit each number comes with two bounds.  Delays of the graph are of no account.  The
    certificate has sets that attain the numbers.  That no sets attain more is searched by the
    checker itself for β, and proved by a branch tree for γ.

    Examples
    --------
    >>> gap = sharing_gap(NeighborGraph.ring(6))
    >>> gap.relays, gap.boundary, gap.exact
    (2, 3, True)
    >>> sharing_gap(NeighborGraph.ring(3)).always_right
    (True, True)
    """
    if type(node_limit) is not int or node_limit < 1:
        expected = f"expected an integer of at least 1, found {node_limit!r}"
        raise UsageError(expected, where="node_limit")
    if isinstance(system, NeighborGraph):
        system = _without_states(system)
    InputError.require(system, MultiChannelSystem, "system")
    about, graph = with_graph(system, graph)
    relays, relays_at_most, S, R = _most_relays(graph, node_limit)
    dominating, least, tree = _domination(graph, node_limit)
    return SharingGap(
        about,
        relays=relays,
        relays_at_most=relays_at_most,
        boundary=graph.m - len(dominating),
        boundary_at_most=graph.m - least,
        receivers=about.named(S),
        senders=about.named(R),
        dominating=about.named(dominating),
        tree=_named(tree, graph.names),
    )


def _without_states(graph: NeighborGraph) -> MultiChannelSystem:
    """The system without states, inputs and outputs over a graph."""
    none = Matrix.zeros(0, 0)
    ports = [none] * graph.m
    return MultiChannelSystem(none, ports, ports, names=graph.names, neighbors=graph)


def _named(tree: Tree, names: Sequence[str]) -> Tree:
    """The nodes of a tree with the names of agents in place of variables."""
    return tuple(
        {"agent": names[node["variable"]], "at_most": node["at_most"]}
        if "variable" in node
        else node
        for node in tree
    )


# Plants that attain a factor.


def extremal_plant(
    gap: SharingGap,
    share: Share = "outputs+states",
    *,
    dimension: int = 1,
    eigenvalue: Entry = 1,
    time: str = "continuous",
) -> MultiChannelSystem:
    """Make a plant over the graph of a gap whose bound exceeds the least by the whole factor.

    Parameters
    ----------
    gap : SharingGap
    share : {"outputs+states", "states"}
        Whether (26) or (27) is attained.
    dimension : int
        The least common dimension c ≥ 1 of the plant.
    eigenvalue : rational
        The only eigenvalue a of the plant.
    time : {"continuous", "discrete"}

    Returns
    -------
    MultiChannelSystem
        With n = rc + 2 states, r the factor: A = aI; B_i = I for i in S, else the column e_1;
        C_i = I for i in R, else the row e_1'.  S and R are the sets of the gap; for (27) S is its
        dominating set and R all other agents.  It is jointly controllable and observable.

    Raises
    ------
    UsageError
        If the factor is 0, so that no plant needs shared sub-states at all, or the dimension is
        below 1.

    Examples
    --------
    >>> from mcexact.sharing import common_dimension, shared_dimension_bound
    >>> plant = extremal_plant(sharing_gap(NeighborGraph.ring(6)))
    >>> shared_dimension_bound(plant).deficiency, common_dimension(plant).dimension
    (2, 1)
    """
    InputError.require(gap, SharingGap, "gap")
    outputs = checked_share(share) == "outputs+states"
    factor = gap.relays if outputs else gap.boundary
    if type(dimension) is not int or dimension < 1:
        expected = f"expected an integer of at least 1, found {dimension!r}"
        raise UsageError(expected, where="dimension")
    if not factor:
        raise UsageError("over this graph no plant needs shared sub-states", where="gap")
    names = gap.about.names
    S = gap.receivers if outputs else gap.dominating
    R = gap.senders if outputs else tuple(name for name in names if name not in S)
    n = factor * dimension + 2
    whole, one = Matrix.identity(n), Matrix.identity(n).take(cols=[0])
    return MultiChannelSystem(
        whole * as_requested(eigenvalue, where="eigenvalue"),
        [whole if name in S else one for name in names],
        [whole if name in R else one.T for name in names],
        time=time,
        names=names,
        neighbors=gap.about.neighbors,
    )
