"""The neighbor graph with its delays, and graphs of networkx.

`NeighborGraph` is the directed graph of who receives whose messages, with an edge j → i if agent
i receives messages of j; N_i always contains i.  Delays count steps and belong to edges.  Only
directed graphs of networkx are converted, and edge weights are refused, since they would be lost.

`strong_components` are those of any graph that is given by its edges.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from mcexact.errors import FloatRefused, InputError, UsageError, several
from mcexact.model.text import checked_name, checked_names, nearest, quoted
from mcexact.shown import LINE, Shown

# Strong components, by lists: networkx takes longer to load than most answers to be found.


def strong_components(m: int, edges: Iterable[tuple[int, int]]) -> tuple[tuple[int, ...], ...]:
    """Strong components of a graph on 0 … m−1, each ascending, sorted by first member.

    Parameters
    ----------
    m : int
    edges : iterable of (int, int)
        (j, i) is the edge j → i.

    Examples
    --------
    >>> strong_components(3, [(0, 1), (1, 0), (1, 2)])
    ((0, 1), (2,))
    """
    into: list[list[int]] = [[] for _ in range(m)]
    out: list[list[int]] = [[] for _ in range(m)]
    for j, i in edges:
        into[i].append(j)
        out[j].append(i)
    return tuple(sorted(tuple(sorted(part)) for part in components_of(into, out)))


def connects(names: Iterable[Any], edges: Iterable[tuple[Any, Any]]) -> bool:
    """Whether edges between these names, at least one, make a strongly connected graph."""
    place = {name: k for k, name in enumerate(names)}
    return len(strong_components(len(place), ((place[j], place[i]) for j, i in edges))) == 1


def components_of(into: list[list[int]], out: list[list[int]]) -> list[list[int]]:
    """The strong components of a graph with these edges into and out of each node.

    Two depth-first searches (Kosaraju): each component is reached from later ones alone.
    """
    unseen, components = bytearray(b"\1" * len(into)), []
    order = _finished(into, range(len(into)), unseen)
    unseen = bytearray(b"\1" * len(into))
    for root in reversed(order):
        component = _finished(out, [root], unseen)
        if component:
            components.append(component)
    return components


def _finished(arcs: list[list[int]], roots: Iterable[int], unseen: bytearray) -> list[int]:
    """The unseen nodes that are reached, in the order in which the search leaves them."""
    order = []
    for root in roots:
        if not unseen[root]:
            continue
        unseen[root] = 0
        path = [(root, iter(arcs[root]))]
        while path:
            node, rest = path[-1]
            for other in rest:
                if unseen[other]:
                    unseen[other] = 0
                    path.append((other, iter(arcs[other])))
                    break
            else:
                order.append(node)
                path.pop()
    return order


# The delays of messages on the links of a graph, and the positions of its agents.


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
    delay_of: dict[tuple[int, int], int] = {}
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
        if (i, j) in delay_of:
            raise InputError("expected one delay, found two", where=where)
        if delay and i == j:
            raise InputError("expected 0: an agent has its own signals without delay", where=where)
        if j not in neighbors[i]:
            raise InputError(
                f"there is no such link: list {quoted(names[j])} among the neighbors "
                f"of {quoted(names[i])}, or remove the delay",
                where=where,
            )
        delay_of[i, j] = delay
    return tuple(sorted((i, j, d) for (i, j), d in delay_of.items() if d))


def agent_position(value: object, m: int, where: str) -> int:
    """Check and return the position of one of m agents."""
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < m:
        raise InputError(f"expected positions of agents 0 … {m - 1}, found {value!r}", where=where)
    return value


# The links and delays of graphs of networkx.

Links = tuple[Sequence[str], dict[str, list[str]], dict[str, dict[str, int]]]


def links_of(graph: Any, names: Sequence[str] | None) -> Links:
    """Return the agents of a directed graph, from whom each receives messages, and the delays.

    Raises
    ------
    InputError
        As `NeighborGraph.from_networkx` says.
    """
    if not getattr(graph, "is_directed", lambda: False)():
        raise InputError(
            "expected a directed graph, found an undirected one; "
            "use graph.to_directed() if messages go both ways along each edge",
            where="graph",
        )
    if graph.is_multigraph():
        raise InputError(
            "expected at most one edge from an agent to another, found a multigraph; "
            "use networkx.DiGraph(graph)",
            where="graph",
        )
    labels = {node: _label(node) for node in graph.nodes}
    if names is None:
        names = tuple(labels.values())
    missing = [name for name in names if name not in labels.values()]
    if missing or len(labels) != len(names):
        more = [label for label in labels.values() if label not in names]
        raise InputError(
            "expected the channels as nodes; "
            + (f"no node for {', '.join(map(quoted, missing))}" if missing else "")
            + ("; " if missing and more else "")
            + (f"no channel for {', '.join(map(quoted, more))}" if more else ""),
            where="graph",
        )
    heard: dict[str, list[str]] = {name: [] for name in names}
    delays: dict[str, dict[str, int]] = {name: {} for name in names}
    for sender, receiver, data in graph.edges(data=True):
        j, i = labels[sender], labels[receiver]
        heard[i].append(j)
        delays[i][j] = _edge_delay(data, f"edge {quoted(j)} -> {quoted(i)}")
    return names, heard, delays


def _label(node: object) -> str:
    """Return the name of a networkx node."""
    if isinstance(node, float):
        raise FloatRefused(f"expected names or integers as nodes, found {node!r}", where="graph")
    if isinstance(node, bool) or not isinstance(node, (str, int)):
        raise InputError(f"expected names or integers as nodes, found {node!r}", where="graph")
    return str(node)


def _edge_delay(data: Mapping[str, Any], where: str) -> Any:
    """Return the delay of a networkx edge; a weight is refused, because it would be lost."""
    weight = data.get("weight", 1)
    if isinstance(weight, float):
        raise FloatRefused(f"an edge has a delay but no weight, found {weight!r}", where=where)
    if weight != 1:
        raise InputError(f"an edge has a delay but no weight, found {weight!r}", where=where)
    return data.get("delay", 0)


# The neighbor graph: the directed graph of who receives whose messages, with delays.


@dataclass(frozen=True, repr=False)
class NeighborGraph(Shown):
    """A directed graph on m agents with an edge j → i if and only if i receives messages of j.

    Methods take and return positions 0 … m−1 of agents.  The neighbor set N_i always contains i.

    Parameters
    ----------
    names : sequence of str
        The agents, in the order of the channels.
    neighbors : sequence of iterables of int
        ``neighbors[i]`` is N_i; i itself may be left out and is added.
    delays : iterable of (i, j, d), optional
        d_ij ≥ 0, the number of steps that a message takes from j to i; by default 0.  d_ii = 0.

    Raises
    ------
    InputError
        If a position is out of range, or a delay is negative or not on an edge.

    Notes
    -----
    Paper, sections I and V-A.  ``neighbors`` and ``delays`` are sorted and delays of 0 are dropped,
    so equal graphs compare equal.

    Examples
    --------
    The paper's cyclic graph, N_1 = {1, 2}, N_2 = {2, 3}, N_3 = {3, 1}:

    >>> graph = NeighborGraph(("1", "2", "3"), [[1], [2], [0]])
    >>> graph.neighborhood(2)
    (0, 2)
    >>> graph.is_strongly_connected()
    True
    >>> NeighborGraph(("1", "2"), [[1], []]).is_strongly_connected()
    False
    """

    names: tuple[str, ...]
    neighbors: tuple[tuple[int, ...], ...]
    delays: tuple[tuple[int, int, int], ...] = field(default=())

    def __init__(
        self,
        names: Sequence[str],
        neighbors: Sequence[Iterable[int]],
        delays: Iterable[tuple[int, int, int]] = (),
    ) -> None:
        names = several(names, "names")
        names = checked_names(names, [f"names[{i}]" for i in range(len(names))])
        neighbors = several(neighbors, "neighbors", "sets of positions, one for each agent")
        m = len(names)
        if len(neighbors) != m:
            raise InputError(
                f"expected {m} neighbor sets, one for each agent, found {len(neighbors)}",
                where="neighbors",
            )
        sets = []
        for i, heard in enumerate(neighbors):
            where = f"neighbors[{i}]"
            listed = several(heard, where, "positions")
            sets.append(tuple(sorted({i, *(agent_position(j, m, where) for j in listed)})))
        object.__setattr__(self, "names", names)
        object.__setattr__(self, "neighbors", tuple(sets))
        object.__setattr__(self, "delays", checked_delays(delays, names, sets))

    @classmethod
    def from_names(
        cls,
        names: Sequence[str],
        neighbors: Mapping[str, Iterable[str]],
        delays: Mapping[str, Mapping[str, int]] | None = None,
    ) -> NeighborGraph:
        """Build a graph from neighbor sets of names, as in a system file.

        Parameters
        ----------
        names : sequence of str
            The agents, in the order of the channels.
        neighbors : mapping
            ``neighbors[i]`` lists the agents whose messages i receives; an agent without an entry
            receives no messages.
        delays : mapping, optional
            ``delays[i][j]`` is d_ij.

        Raises
        ------
        InputError
            If an agent is unknown or listed twice.

        Examples
        --------
        >>> graph = NeighborGraph.from_names(("a", "b"), {"a": ["b"]}, {"a": {"b": 2}})
        >>> graph.edges(), graph.delay(0, 1)
        (((1, 0),), 2)
        """
        names = tuple(names)
        position = {name: i for i, name in enumerate(names)}

        def at(name: object, where: str) -> int:
            good = checked_name(name, where)
            if good not in position:
                raise InputError(
                    f"there is no agent {quoted(good)}{nearest(good, names)}", where=where
                )
            return position[good]

        sets: list[list[int]] = [[] for _ in names]
        for name, heard in neighbors.items():
            where = f"neighbors[{quoted(name)}]"
            i = at(name, "neighbors")
            if isinstance(heard, str) or not isinstance(heard, Iterable):
                kind = "a string" if isinstance(heard, str) else f"{heard!r}"
                raise InputError(f"expected a list of names, found {kind}", where=where)
            for k, other in enumerate(heard):
                j = at(other, f"{where}[{k}]")
                if j in sets[i]:
                    raise InputError(f"{quoted(other)} is listed twice", where=f"{where}[{k}]")
                sets[i].append(j)
        late: list[tuple[int, int, int]] = []
        for name, row in (delays or {}).items():
            i, where = at(name, "delays"), f"delays[{quoted(name)}]"
            late.extend((i, at(other, where), delay) for other, delay in row.items())
        return cls(names, sets, late)

    @classmethod
    def complete(cls, names: Sequence[str] | int) -> NeighborGraph:
        """Return the complete graph without delays, on agents as in `ring`."""
        names = _agents(names)
        return cls(names, [range(len(names))] * len(names))

    @classmethod
    def ring(cls, names: Sequence[str] | int) -> NeighborGraph:
        """Return the cyclic graph N_i = {i, i+1}, N_m = {m, 1}, as in the paper's example.

        Parameters
        ----------
        names : sequence of str, or int
            The agents; or their number m, for the names "1" … "m" that channels have by default.

        Examples
        --------
        >>> NeighborGraph.ring(3).names
        ('1', '2', '3')
        >>> NeighborGraph.ring(["1", "2", "3"]).neighbors
        ((0, 1), (1, 2), (0, 2))
        """
        names = _agents(names)
        m = len(names)
        return cls(names, [[(i + 1) % m] for i in range(m)])

    @classmethod
    def empty(cls, names: Sequence[str] | int) -> NeighborGraph:
        """Return the graph without edges, on agents as in `ring`."""
        names = _agents(names)
        return cls(names, [[] for _ in names])

    def __repr__(self) -> str:
        delays = f", {self.delays}" if self.delays else ""
        whole = f"NeighborGraph({self.names}, {self.neighbors}{delays})"
        if len(whole) <= LINE:
            return whole
        return f"<neighbor graph of {self.m} agents, {len(self.edges())} links>"

    def explain(self) -> str:
        """Say in plain words who receives whose messages, one agent a line."""
        return "\n".join(f"Agent {name} receives {sources}." for name, sources in self._labeled())

    def _labeled(self) -> Iterator[tuple[str, str]]:
        """Yield each agent, and from whom it receives messages, with delays."""
        for i, name in enumerate(self.names):
            heard = []
            for j in self.neighbors[i]:
                late = self.delay(i, j)
                if i != j:
                    heard.append(self.names[j] + (f" ({late} steps late)" if late else ""))
            yield name, f"messages of {', '.join(heard)}" if heard else "no messages"

    def to_dict(self) -> dict[str, Any]:
        """Return ``neighbors`` by names and, if there are any, ``delays``, as in a system file."""
        names = self.names
        document: dict[str, Any] = {
            "neighbors": {
                names[i]: [names[j] for j in self.neighborhood(i) if j != i] for i in range(self.m)
            }
        }
        if self.delays:
            rows: dict[str, dict[str, int]] = {}
            for i, j, delay in self.delays:
                rows.setdefault(names[i], {})[names[j]] = delay
            document["delays"] = rows
        return document

    @property
    def m(self) -> int:
        """The number of agents."""
        return len(self.names)

    def neighborhood(self, i: int) -> tuple[int, ...]:
        """Return N_i, which contains i, in the order of the channels."""
        return self.neighbors[i]

    def plot(self, ax: Any = None) -> Any:
        """Draw the graph; see `mcexact.plot.graph`."""
        from mcexact.plot.graphs import graph

        return graph(self, ax, title="neighbor graph")

    def union(self, channels: Iterable[int]) -> tuple[int, ...]:
        """Return N_s, the union of the N_i over i in s, in the order of the channels.

        Examples
        --------
        >>> NeighborGraph.ring(["1", "2", "3", "4"]).union([0, 1])
        (0, 1, 2)
        """
        return tuple(sorted({j for i in channels for j in self.neighbors[i]}))

    def followers(self, j: int) -> tuple[int, ...]:
        """Return F_j, the agents that receive messages of j, and j itself.

        Examples
        --------
        >>> NeighborGraph.ring(["1", "2", "3"]).followers(0)
        (0, 2)
        """
        return tuple(i for i in range(self.m) if j in self.neighbors[i])

    def edges(self) -> tuple[tuple[int, int], ...]:
        """Return all edges (j, i), from j to i ≠ j, sorted."""
        return tuple(
            sorted((j, i) for i, heard in enumerate(self.neighbors) for j in heard if i != j)
        )

    def delay(self, i: int, j: int) -> int:
        """Return d_ij, the number of steps that a message takes from j to i.

        The result is 0 also where no link leads from j to i; ``neighbors`` says which links exist.
        """
        return self._delay_of.get((i, j), 0)

    def longest_delay(self, j: int) -> int:
        """Return d_j, the largest d_ij over the followers i of j."""
        return max((d for (_, sender), d in self._delay_of.items() if sender == j), default=0)

    @cached_property
    def _delay_of(self) -> dict[tuple[int, int], int]:
        return {(i, j): d for i, j, d in self.delays}

    def with_edges(self, added: Iterable[tuple[int, int]]) -> NeighborGraph:
        """Return the graph with further edges (j, i) without delay: j joins N_i.

        Edges that exist already keep their delays.

        Raises
        ------
        InputError
            If a position is out of range.

        Examples
        --------
        >>> NeighborGraph.empty(["1", "2"]).with_edges([(0, 1)]).edges()
        ((0, 1),)
        """
        sets = [set(heard) for heard in self.neighbors]
        for j, i in added:
            agent_position(j, self.m, "edges")
            sets[agent_position(i, self.m, "edges")].add(j)
        return NeighborGraph(self.names, sets, self.delays)

    def is_strongly_connected(self) -> bool:
        """Whether the graph is strongly connected.

        Examples
        --------
        >>> NeighborGraph.ring(["1", "2"]).is_strongly_connected()
        True
        >>> NeighborGraph.empty(["1", "2"]).is_strongly_connected()
        False
        """
        return len(strong_components(self.m, self.edges())) == 1

    def closure(self) -> NeighborGraph:
        """Return the transitive closure: agent i receives from every j with a path from j to i.

        Delays are left out, so that signals take no time on any path.

        Examples
        --------
        >>> NeighborGraph(("1", "2", "3"), [[], [0], [1]]).closure().edges()
        ((0, 1), (0, 2), (1, 2))
        """
        heard = [set(N) for N in self.neighbors]
        for j in range(self.m):  # Warshall: paths through agents up to j
            for N in heard:
                if j in N:
                    N |= heard[j]
        return NeighborGraph(self.names, heard)

    def source_components(self) -> tuple[tuple[int, ...], ...]:
        """Return the strong components into which no edge leads from another component.

        Examples
        --------
        >>> NeighborGraph(("1", "2", "3"), [[1], [0], [1]]).source_components()
        ((0, 1),)
        """
        parts = strong_components(self.m, self.edges())
        return tuple(part for part in parts if {*self.union(part)} == {*part})

    def _digraph(self, nodes: Sequence[Any]) -> Any:
        import networkx

        graph = networkx.DiGraph()
        graph.add_nodes_from(nodes)
        graph.add_edges_from((nodes[j], nodes[i]) for j, i in self.edges())
        return graph

    def to_networkx(self) -> Any:
        """Return a ``networkx.DiGraph`` on the names; nonzero delays are edge attributes."""
        graph = self._digraph(self.names)
        for i, j, delay in self.delays:
            graph.edges[self.names[j], self.names[i]]["delay"] = delay
        return graph

    @classmethod
    def from_networkx(cls, graph: Any, names: Sequence[str] | None = None) -> NeighborGraph:
        """Convert a directed networkx graph; an edge j → i means that i receives messages of j.

        Parameters
        ----------
        graph : networkx.DiGraph
            Nodes are strings or integers.  An edge may have an integer ``delay``, but no weight.
        names : sequence of str, optional
            The channels in order, which must be the nodes; by default the nodes in the graph's
            order.

        Raises
        ------
        InputError
            If the graph is undirected or has parallel edges, if a node is neither a string nor an
            integer (networkx merges the nodes 1, True and 1.0 silently), if the nodes are not the
            channels, or if an edge has a weight.
        FloatRefused
            If a node or a delay is a float.

        Examples
        --------
        >>> import networkx
        >>> graph = networkx.DiGraph([("b", "a")])
        >>> NeighborGraph.from_networkx(graph, names=("a", "b")).edges()
        ((1, 0),)
        >>> NeighborGraph.from_networkx(networkx.Graph([("b", "a")]))  # doctest: +ELLIPSIS
        Traceback (most recent call last):
            ...
        mcexact.errors.InputError: graph: expected a directed graph, found an undirected one; ...
        """
        return cls.from_names(*links_of(graph, names))


def _agents(names: Sequence[str] | int) -> tuple[Any, ...]:
    """Return names of agents as a tuple; a number of agents stands for "1", "2" and so on."""
    if isinstance(names, int) and not isinstance(names, bool):
        if names < 0:
            raise InputError(f"expected a number of agents >= 0, found {names}", where="names")
        return tuple(str(i + 1) for i in range(names))
    return several(names, "names", "names, or a number of agents")


def graph_for(graph: Any, names: tuple[str, ...]) -> NeighborGraph | None:
    """Return a graph on the channels with these names.

    Parameters
    ----------
    graph : NeighborGraph, networkx.DiGraph, mapping of str to iterable of str, or None

    Raises
    ------
    UsageError
        If the graph has other agents, or the same agents in another order.
    """
    if graph is None:
        return None
    if isinstance(graph, Mapping):
        return NeighborGraph.from_names(names, graph)
    if hasattr(graph, "is_directed"):
        return NeighborGraph.from_networkx(graph, names)
    if not isinstance(graph, NeighborGraph):
        raise InputError(
            "expected a NeighborGraph, a networkx.DiGraph or a mapping of names, "
            f"found {type(graph).__name__}",
            where="neighbors",
        )
    if graph.names != names:
        raise UsageError(
            f"expected a graph on the agents {', '.join(map(quoted, names))} in this order, "
            f"found {', '.join(map(quoted, graph.names))}",
            where="neighbors",
        )
    return graph
