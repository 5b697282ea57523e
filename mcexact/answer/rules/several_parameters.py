"""Sentences about a plant with several parameters, which are proved along lines alone.

They have the templates of one parameter, and no manifest claims them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from mcexact.answer.exceptional_hypersurfaces import Hypersurfaces
from mcexact.answer.rules.parameters import (
    Said,
    Values,
    another,
    complete,
    fixed,
    graph,
    heading,
    in_table,
    indices,
    setpoints,
)
from mcexact.answer.sentence import Given
from mcexact.answer.template import Sentence
from mcexact.answer.wording.parameters import MODES


def sentences_of_several(answers: Mapping[str, Any], given: Given) -> Iterator[Sentence]:
    """Yield the sentences about the answers, each with its place."""
    yield heading(given).bound("title", ())
    if "fixed_spectrum" in answers:
        spectrum = answers["fixed_spectrum"]
        modes, values = _modes(spectrum), _values(spectrum, given)
        for said in (*fixed(modes, values), *another(modes, values)):
            yield said.bound("answer", ())
    for name, answer in answers.items():
        if name.startswith("box_"):  # it is about ranges, and not about almost all values
            continue
        for said in _row(name, answer, answers, given):
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


def _modes(spectrum: Any) -> list[str]:
    return [f"{p}," if ", divided" in p else p for p in spectrum.modes]


def _every(given: Given) -> str:
    return f"almost all values of {given.parameter}"


def _values(answer: Hypersurfaces[Any], given: Given) -> Values:
    return Values(_every(given), tuple(map(str, answer.hypersurfaces)))


def _columns(found: Any, given: Given) -> list[Any]:
    return [(edge, each.rank, _values(each, given)) for edge, each in found.columns.items()]
