"""Sentences made false on purpose, which show that a judge has teeth.

Most are sentences that were said, with one value changed: another count, another mode, another
channel, an edge more or less, a narrower region.  A sentence without values of its own is tried
where it was not said.  A change need not make every sentence false: one that does is enough.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

from flint import fmpq, fmpq_poly

from tests.oracle.sentences.cases import Case, Region, Said
from tests.oracle.sentences.members import scaled

OTHER_WORDS = {
    "own": ("outputs", "instant"), "outputs": ("instant", "own", "states"),
    "instant": ("own", "outputs"),
    "none": ("delays", "upper"), "delays": ("none",), "upper": ("none",),
    "continuous": ("discrete",), "discrete": ("continuous",),
    "least": ("cheapest",), "cheapest": ("least",),
    "outputs+states": ("states",), "states": ("outputs+states",),
    "decentralized": ("extended", "observer"), "observer": ("decentralized",),
    "extended": ("decentralized",), "lifted": ("extended",), "held": ("extended",),
    "without": ("extended",),
    "controllable": ("observable",), "observable": ("controllable",),
}  # fmt: skip
"""Other keywords of the same fields."""
GIVEN = {"time", "control", "part"}
"""Fields that a case determines, or of which one value will do.

So a sentence that has no others can be tried where it was not said.
"""
OLD_STEADY_STATE = "every output tends to the set-point of its agent, if that is constant"


def falsified(sentence: Said, case: Case) -> Iterator[tuple[Said, Case]]:
    """Sentences like one that was said, most of which are false of its case."""
    for name, value in sentence.values.items():
        for other in others(name, value, case):
            yield replace(sentence, values={**sentence.values, name: other}), case
    if sentence.rule == "design-steady-state":
        yield replace(sentence, text=OLD_STEADY_STATE), case
    if sentence.rule.startswith("members-") and case.plant.radii is not None:
        # radii of 100 %, so that corners lose entries
        A, *ports = (scaled(M, fmpq(1)) for M in (case.plant.A, *case.plant.B, *case.plant.C))
        wide = (A, ports[: case.plant.m], ports[case.plant.m :])
        yield (
            sentence,
            Case(replace(case.plant, radii=wide), case.asked, case.controller, case.rows),
        )
    if case.controller is not None and sentence.rule.startswith("design-"):
        yield sentence, replace(case, controller=_silenced(case.controller))


def _silenced(controller: Mapping[str, Any]) -> dict[str, Any]:
    """A controller whose inputs are all 0, and whose agents do nothing."""
    quiet = {"shared_update": {}, "private_update": {}, "input": {}}
    return {**controller, "agents": [{**agent, **quiet} for agent in controller["agents"]]}


def unsaid(fields: Mapping[str, Sequence[str]], case: Case) -> Iterator[Said]:
    """Sentences of rules without values of their own that were not said of a case."""
    known = {row.rule for row in case.rows}
    own = case.asked.get("information", "own") == "own"
    received = "instant" if case.plant.delays else "outputs"
    given = {"time": case.slow, "control": "own" if own else received, "part": "agents"}
    for rule, names in fields.items():
        if rule not in known and set(names) <= GIVEN:
            yield Said(rule, {name: given[name] for name in names})


def others(name: str, value: Any, case: Case) -> Iterator[Any]:
    """Other values for a field."""
    if isinstance(value, bool):
        yield not value
    elif isinstance(value, int):
        yield from (value + 1, value - 1, value + 7)
    elif isinstance(value, Fraction | fmpq):
        yield from (value + 1, value * 999)
    elif isinstance(value, fmpq_poly):
        yield fmpq_poly([fmpq(-355, 113), 1])
        yield value(fmpq_poly([fmpq(17, 5), 1])) if value.degree() > 0 else value + 1
    elif isinstance(value, Region):
        bound = fmpq(1, 10**9) if value.time == "discrete" else fmpq(10**9)
        yield replace(value, bound=bound)
        yield replace(value, bound=fmpq(1) if value.time == "discrete" else fmpq(-(10**9)))
    elif name == "found":  # along the line of a plant with several parameters
        start, rank, _ = value.partition("rank ")
        yield f"{start}rank 98765" if rank else "the roots of x - 98765/7"
    elif isinstance(value, str) and name != "line":
        yield from OTHER_WORDS.get(value, ())
        if name in {"every", "parameters", "t"}:
            yield f"{value} and more"
        if name == "modes":
            yield "x - 98765/7"
        yield from (each for each in _names(case) if each != value)
    elif isinstance(value, list):
        yield from _other_lists(name, value, case)


def _names(case: Case) -> Sequence[str]:
    return case.parametric.names if case.parametric is not None else case.plant.names


def _other_lists(name: str, value: list[Any], case: Case) -> Iterator[list[Any]]:
    """A member less, a member more, or a member changed."""
    names = list(_names(case))
    if value:
        yield value[:-1]
    if name == "where":
        yield [f"{case.parametric.parameters[0]} = 98765/7"]
    if all(isinstance(each, str) for each in value) and name != "where":
        yield [each for each in names if each not in value]
        yield names
        if name == "slowest":
            time, low, high, is_stable = value
            yield [time, low, high, not is_stable]
    elif name == "slowest":
        time, low, high, is_stable = value
        yield [time, str(Fraction(low) + 5), str(Fraction(high) + 5), is_stable]
        yield [time, low, high, not is_stable]
    if name in {"arcs", "edges", "added"}:
        pairs = [[j, i] for j in names for i in names if [j, i] not in [list(e) for e in value]]
        yield from ([*value, pair] for pair in pairs[:2])
    for k, each in enumerate(value):
        if isinstance(each, list | tuple) and name not in {"arcs", "edges", "added", "lost"}:
            for j, part in enumerate(each):
                for other in others("", part, case):
                    changed = [*each[:j], other, *each[j + 1 :]]
                    yield [*value[:k], changed, *value[k + 1 :]]
        elif not isinstance(each, str | list | tuple):
            for other in others("", each, case):
                yield [*value[:k], other, *value[k + 1 :]]
