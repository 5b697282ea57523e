"""The rules of the sentences of `mcexact analyze` about a plant with parameters.

With one parameter they read certificates.  With several the same sentences are made from answers
that are proved along lines alone, and no manifest claims them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import networkx as nx

from mcexact.answer.parameter_values import (
    in_parameter,
    mode_text,
    value_text,
)
from mcexact.answer.sentence import Claim, Given, Rulebook
from mcexact.answer.template import Sentence
from mcexact.answer.wording import parameters as say

RULES = Rulebook()
rule = RULES.rule

Said = Iterator[Sentence]
Edge = tuple[str, str]


@dataclass(frozen=True)
class Values:
    """Where something else holds than for almost all values.

    Attributes
    ----------
    every : str
        The values that are decided, such as "every value of t in [0, 1]".
    where : tuple of str
        The exceptional ones, each as a condition such as "t = 1/2".
    """

    every: str
    where: tuple[str, ...]

    @property
    def almost(self) -> str:
        """The values without the exceptional ones, in words."""
        return self.every.replace("every", "almost every", 1) if self.where else self.every

    @property
    def given(self) -> dict[str, Any]:
        """The fields of templates."""
        return {"every": self.almost, "where": self.where}


def values_of(claims: Iterable[Claim], given: Given) -> Values:
    """The exceptional values of certificates about one parameter."""
    where: dict[str, None] = {}
    every = f"every value of {given.parameter}{given.apart}"
    for certified in claims:
        if [each.value for each in certified.outside]:
            every = f"every value of {given.parameters}{given.apart}"
        for each in certified.exceptional:
            where[value_text(each.value, [*each.roots], given.parameter)] = None
    return Values(every, tuple(where))


def scaled(given: Given) -> str:
    """What modes are divided by, where A has denominators."""
    if given.scale.degree < 1:
        return ""
    return f", divided by {in_parameter(given.scale, given.parameter)}"


# Sentences from what was found, whatever proves it.


def fixed(modes: str, values: Values) -> Said:
    """Which modes are fixed for almost every value, and that others are at some."""
    if modes:
        # What they are divided by is put in, between two commas.
        yield say.FIXED(modes=modes + "," * (", divided by " in modes), every=values.almost)
    else:
        yield say.NOTHING_FIXED(every=values.almost)


def another(modes: str, values: Values) -> Said:
    """Where another mode is fixed."""
    if values.where:
        yield say.ANOTHER(another=bool(modes), where=values.where)


def in_table(question: str, modes: str, values: Values) -> Said:
    """The modes of a question, for every value or where they are others."""
    always, unless, some, more = say.MODES[question]
    told = (more if values.where else some) if modes else (unless if values.where else always)
    yield told(modes=modes, **values.given)


def graph(columns: Sequence[tuple[Edge, int, Values]]) -> Said:
    """The edges for almost every value, and where which vanish."""
    edges = [edge for edge, rank, _ in columns if rank]
    lost = [(edge, values.where) for edge, _, values in columns if values.where]
    if lost:
        yield say.GRAPH[1](edges=edges, lost=lost)
    else:
        whole = [values.every for _, _, values in columns]
        yield say.GRAPH[0](edges=edges, every=max(whole, key=len))


def complete(
    names: Sequence[str],
    modes: str,
    values: Values,
    columns: Sequence[tuple[Edge, int, Values]],
    t: str,
) -> Said:
    """Whether no mode is fixed and the edges connect all channels, and where not."""
    edges = {edge: found.where for edge, rank, found in columns if rank}
    if modes or not connects(names, edges):
        yield say.COMPLETE[2](t=t)
        return
    where = dict.fromkeys(values.where)
    for at in dict.fromkeys(each for listed in edges.values() for each in listed):
        if not connects(names, [edge for edge, lost in edges.items() if at not in lost]):
            where[at] = None
    every = max([values.every, *(found.every for _, _, found in columns)], key=len)
    told = Values(every, tuple(where))
    yield (say.COMPLETE[1] if where else say.COMPLETE[0])(**told.given)


def connects(names: Sequence[str], edges: Iterable[Edge]) -> bool:
    """Whether a digraph is strongly connected."""
    made = nx.DiGraph()
    made.add_nodes_from(names)
    made.add_edges_from(edges)
    return bool(nx.is_strongly_connected(made))


def indices(name: str, ranks: Sequence[int], values: Values) -> Said:
    """The indices for almost every value: how many k have a rank that grows by j or more."""
    growth = [b - a for a, b in zip([0, *ranks], ranks, strict=False)]
    sizes = [sum(g > j for g in growth) for j in range(growth[0])]
    told = say.INDICES[name][bool(values.where)]
    yield told(indices=[size for size in sizes if size], **values.given)


def setpoints(rank: int, full: int, values: Values, t: str) -> Said:
    """Whether every set-point has an equilibrium."""
    always, unless, never = say.SETPOINT
    if rank < full:
        yield never(t=t)
    else:
        yield (unless if values.where else always)(**values.given)


# The same from certificates.


@rule("title", say.HEADING)
def _heading(given: Given) -> Said:
    yield heading(given)


def heading(given: Given) -> Sentence:
    """The sizes of the system, and its parameters."""
    return say.HEADING(
        name=given.name or "system",
        n=given.n,
        m=given.m,
        names=given.names,
        time=given.time,
        parameters=given.parameters,
        undefined=given.undefined,
    )


def modes_of(spectrum: Claim, given: Given) -> str:
    """The generic modes of a certificate, with what all are divided by; nothing if it has none."""
    modes = ", ".join(mode_text(p, given.parameter) for p in spectrum.generic)
    return modes and modes + scaled(given)


RANGES = Rulebook()
"""The rules about all values within ranges, of which there may be several."""


def _within_ranges(question: str, holds: Callable[[Claim, Given], bool]) -> None:
    @RANGES.rule("answer", say.RANGES[question], about={"found": question})
    def _said(found: Claim, given: Given) -> Said:
        if holds(found, given):
            yield say.RANGES[question](parameters=given.parameters)


_within_ranges("box_fixed_modes", lambda found, given: found.bound is None)
_within_ranges("box_stabilizability", lambda found, given: found.bound is not None)
for each in ("box_controllability", "box_observability"):
    _within_ranges(
        each, lambda found, given: found.bound is None and len(found.channels) == given.m
    )
RULES.extend(RANGES)


@rule("answer", say.FIXED, say.NOTHING_FIXED)
def _fixed(fixed_spectrum: Claim, given: Given) -> Said:
    yield from fixed(modes_of(fixed_spectrum, given), values_of([fixed_spectrum], given))


@rule("answer", say.ANOTHER)
def _another(fixed_spectrum: Claim, given: Given) -> Said:
    yield from another(modes_of(fixed_spectrum, given), values_of([fixed_spectrum], given))


def _of_modes(question: str) -> None:
    @rule("table", *say.MODES[question], about={"found": question})
    def _row(found: Claim, given: Given) -> Said:
        yield from in_table(question, modes_of(found, given), values_of([found], given))


for each in ("joint_controllability", "joint_observability"):
    _of_modes(each)


def _columns(edges: Iterable[Claim], given: Given) -> list[tuple[Edge, int, Values]]:
    return [
        ((getattr(each.matrix, "from"), each.matrix.to), each.rank, values_of([each], given))
        for each in edges
    ]


@rule("table", *say.GRAPH)
def _graph(transfer_graph: Iterable[Claim], given: Given) -> Said:
    yield from graph(_columns(transfer_graph, given))


_of_modes("fixed_spectrum")


@rule("table", *say.COMPLETE)
def _complete(fixed_spectrum: Claim, transfer_graph: Iterable[Claim], given: Given) -> Said:
    yield from complete(
        given.names,
        modes_of(fixed_spectrum, given),
        values_of([fixed_spectrum], given),
        _columns(transfer_graph, given),
        given.parameter,
    )


def _of_indices(name: str) -> None:
    @rule("table", *say.INDICES[name], about={"found": f"{name}_indices"})
    def _row(found: Iterable[Claim], given: Given) -> Said:
        parts = [(each.rank, values_of([each], given)) for each in found]
        every = max((values.every for _, values in parts), key=len)
        where = dict.fromkeys(at for _, values in parts for at in values.where)
        yield from indices(name, [rank for rank, _ in parts], Values(every, tuple(where)))


for each in say.INDICES:
    _of_indices(each)


@rule("table", *say.SETPOINT)
def _setpoints(setpoint: Claim, given: Given) -> Said:
    values = values_of([setpoint], given)
    yield from setpoints(setpoint.rank, given.n + given.outputs, values, given.parameter)


for each in ("channel_controllability", "channel_observability"):
    _of_modes(each)
