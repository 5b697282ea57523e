"""The links and delays of graphs of networkx."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from mcexact.errors import FloatRefused, InputError
from mcexact.model.names import quoted

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
