"""Sentences about a plant with several parameters, whose certificates are about lines.

What holds at one point of a line for lack of no rank holds for almost all values: these sentences,
and what each certificate says of its line, are made by rules.  Where else it holds is computed,
confirmed on the lines, and said with the templates of one parameter; no manifest claims that.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from typing import Any

from mcexact.answer.exceptional_hypersurfaces import Hypersurfaces, mode_in_x
from mcexact.answer.parameter_values import in_parameter, mode_text, value_text
from mcexact.answer.rules.parameters import (
    RANGES,
    Edge,
    Said,
    Values,
    another,
    complete,
    connects,
    fixed,
    graph,
    heading,
    in_table,
    indices,
    setpoints,
)
from mcexact.answer.sentence import Claim, Given, Rulebook
from mcexact.answer.template import Sentence
from mcexact.answer.wording import parameters as say
from mcexact.answer.wording.parameters import MODES
from mcexact.exact.polynomial import Polynomial

RULES = Rulebook()
"""The rules that read certificates, with those about ranges."""


@RULES.rule("title", say.HEADING)
def _heading(given: Given) -> Said:
    yield heading(given)


RULES.extend(RANGES)


def _almost(question: str, place: str, holds: Callable[[Claim, Given], bool]) -> None:
    """Enter the rule of a sentence about almost all values that one certificate implies."""

    @RULES.rule(place, say.ALMOST[question], about={"found": question})
    def _said(found: Iterable[Claim], given: Given) -> Said:
        for each in found:
            if holds(each, given):
                yield say.ALMOST[question](parameters=given.parameter)
                return


def _nothing(found: Claim, given: Given) -> bool:
    return not len(found.generic)


_almost("fixed_spectrum", "answer", _nothing)
for each in MODES:
    if each != "fixed_spectrum":
        _almost(each, "proved", _nothing)
_almost("setpoint", "proved", lambda found, given: bool(found.rank == given.n + given.outputs))


def _edges(found: Iterable[Claim]) -> list[Edge]:
    """The edges that some point of a line has; others may be edges elsewhere."""
    pairs = [((getattr(each.matrix, "from"), each.matrix.to), each.rank) for each in found]
    return [*dict.fromkeys(edge for edge, rank in pairs if rank)]


@RULES.rule("proved", say.ALMOST["transfer_graph"])
def _graph(transfer_graph: Iterable[Claim], given: Given) -> Said:
    if edges := _edges(transfer_graph):
        yield say.ALMOST["transfer_graph"](parameters=given.parameter, edges=edges)


@RULES.rule("proved", say.ALMOST["completeness"])
def _completeness(
    fixed_spectrum: Iterable[Claim], transfer_graph: Iterable[Claim], given: Given
) -> Said:
    free = any(_nothing(each, given) for each in fixed_spectrum)
    if free and connects(given.names, _edges(transfer_graph)):
        yield say.ALMOST["completeness"](parameters=given.parameter)


def _on_line(question: str, told: Callable[[Claim, str, Given], str]) -> None:
    """Enter the rule that repeats what each certificate says of its line."""

    @RULES.rule("line", say.ON_LINE[question], about={"found": question})
    def _said(found: Iterable[Claim], given: Given) -> Said:
        for each in found:
            line, s = _line(each.subject[0])
            yield say.ON_LINE[question](line=line, found=told(each, s, given))


def _line(step: Mapping[str, Any]) -> tuple[str, str]:
    """A line in words, and its parameter."""
    s = step["parameter"]
    ends = {
        name: Polynomial.of(Fraction(a), Fraction(step["direction"][name]))
        for name, a in step["point"].items()
    }
    return ", ".join(f"{name} = {in_parameter(p, s)}" for name, p in ends.items()), s


def _conditions(found: Claim, s: str) -> str:
    return " or ".join(value_text(each.value, each.roots, s) for each in found.exceptional)


def _modes_there(found: Claim, s: str, given: Given) -> str:
    """The modes for every value of s, and where others are."""
    modes = ", ".join(mode_text(p, s) for p in found.generic)
    always = f"the roots of {modes}{given.divided}" if modes else "none"
    where = _conditions(found, s)
    return always + (f"{'; others, too,' if modes else ', but'} where {where}" if where else "")


def _ranks_there(found: Claim, s: str, given: Given) -> str:
    """The rank for almost every value of s, and where it is less."""
    matrix, where = found.matrix, _conditions(found, s)
    named = ""
    if matrix.name == "controllability":
        named = f"{matrix.blocks} block{'s' * (matrix.blocks > 1)}: "
    elif matrix.name == "transfer":
        named = f"{getattr(matrix, 'from')} -> {matrix.to}: "
    return f"{named}rank {found.rank}" + (f", less where {where}" if where else "")


for each in say.ON_LINE:
    _on_line(each, _modes_there if each in MODES else _ranks_there)


def sentences_of_several(answers: Mapping[str, Any], given: Given) -> Iterator[Sentence]:
    """Yield the sentences that no certificate implies, each with its place."""
    if "fixed_spectrum" in answers:
        spectrum = answers["fixed_spectrum"]
        modes, values = _modes(spectrum), _values(spectrum, given)
        for said in (*(fixed(modes, values) if modes else ()), *another(modes, values)):
            yield said.bound("answer", ())
    for name, decided in answers.items():
        if name.startswith("box_"):  # it is about ranges, and not about almost all values
            continue
        for said in _row(name, decided, answers, given):
            yield said.bound("table", ())


def _row(name: str, answer: Any, answers: Mapping[str, Any], given: Given) -> Said:
    t = given.parameter
    if name in MODES:
        yield from in_table(name, _modes(answer), _values(answer, given))
    elif name == "setpoint":
        values = _values(answer, given)
        yield from setpoints(answer.rank, given.n + given.outputs, values, t)
    elif name == "transfer_graph":
        yield from graph(_columns(answer, given))
    elif name == "completeness":
        modes, values = _modes(answer.spectrum), _values(answer.spectrum, given)
        yield from complete(given.names, modes, values, _columns(answer.graph, given), t)
    else:
        where = dict.fromkeys(at for each in answer for at in _values(each, given).where)
        values = Values(_every(given), tuple(where))
        ranks = [each.rank for each in answer]
        yield from indices(name.removesuffix("_indices"), ranks, values)


def _modes(spectrum: Any) -> str:
    modes = ", ".join(map(mode_in_x, spectrum.generic))
    return modes and modes + spectrum.divided


def _every(given: Given) -> str:
    return f"almost all values of {given.parameter}"


def _values(answer: Hypersurfaces[Any], given: Given) -> Values:
    return Values(_every(given), tuple(map(str, answer.hypersurfaces)))


def _columns(found: Any, given: Given) -> list[Any]:
    return [(edge, each.rank, _values(each, given)) for edge, each in found.columns.items()]
