"""Drawn systems that Hypothesis prints as code, which a counterexample can be pasted from."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from hypothesis import strategies as st
from hypothesis.strategies import DrawFn

from mcexact.derived.drawn.systems import Drawn as Drawn
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import written
from mcexact.exact.roots import is_discrete
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem


def printed(draw: DrawFn, found: Drawn) -> Drawn:
    """Return an equal drawn system, which Hypothesis prints as calls of constructors.

    Hypothesis prints what ``st.builds`` made by the call that made it, so the values are built once
    more here, from their arguments.
    """
    known = {
        each.name: value
        for each in fields(found)
        if each.name != "system" and (value := getattr(found, each.name)) is not None
    }
    made: Drawn = _built(draw, Drawn, system=_system(draw, found.system), **known)
    return made


def printed_graph(draw: DrawFn, graph: NeighborGraph) -> NeighborGraph:
    """Return an equal graph, which Hypothesis prints as a call of its constructor."""
    delays = {"delays": graph.delays} if graph.delays else {}
    arguments = {"names": graph.names, "neighbors": graph.neighbors, **delays}
    made: NeighborGraph = _built(draw, NeighborGraph, **arguments)
    return made


def _built(draw: DrawFn, made: Any, **arguments: Any) -> Any:
    return draw(st.builds(made, **{name: st.just(value) for name, value in arguments.items()}))


def _system(draw: DrawFn, system: MultiChannelSystem) -> MultiChannelSystem:
    arguments: dict[str, Any] = {
        "A": _rows(system.A),
        "B": [_rows(channel.B) for channel in system.channels],
        "C": [_rows(channel.C) for channel in system.channels],
    }
    if is_discrete(system.time):
        arguments["time"] = system.time
    if system.names != tuple(str(i + 1) for i in range(system.m)):
        arguments["names"] = system.names
    if system.neighbors is not None:
        arguments["neighbors"] = printed_graph(draw, system.neighbors)
    found: MultiChannelSystem = _built(draw, MultiChannelSystem, **arguments)
    return found


def _rows(M: Matrix) -> Any:
    """The rows as lists; a matrix without entries as it is, since a list would lose its shape."""
    return [[written(x) for x in row] for row in M] if M.nrows and M.ncols else M
