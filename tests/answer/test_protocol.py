"""Every kind of answer, about every plant of the gallery: shown, read back, and specified."""

from __future__ import annotations

import json
import re
import typing
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from html import escape
from pathlib import Path
from typing import Any

import pytest

import mcexact
from mcexact import answer as home
from mcexact.analysis.questions import QUESTIONS
from mcexact.answer.check import answer_of
from mcexact.answer.parameters import ParametricFixedSpectrum
from mcexact.answer.protocol import (
    KINDS,
    Answer,
    Part,
    encode,
    fields_of,
    fitted,
    is_about_dual,
    key_of,
    kind_named,
)
from mcexact.checker.kinds import KINDS as RULES
from mcexact.errors import UsageError
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.shown import LINE, words
from tests.answer.test_golden import answers, of_a_parameter
from tests.checker.box_plants import ALL as ABOUT_BOXES
from tests.checker.parameter_plants import ALL as ABOUT_RANGES
from tests.checker.performance_plants import ALL as ABOUT_PERFORMANCE
from tests.checker.saturation_plants import ALL as ABOUT_SATURATION
from tests.wording import refusal

FORMAT = Path(home.__file__).with_name("FORMAT.md").read_text(encoding="utf-8")
_ELIDED = re.compile(r"… \d+ more|\(degree \d+\)|\d+×\d+ matrix|about -?\d[.\d]*(e[+-]\d+)?")
_NUMBER = re.compile(r"-?\d+(?:[./]\d+)?")
_NAME = re.compile(r"'[^']*'")


PLANTS = [
    pytest.param(name, marks=[pytest.mark.slow] if gallery.load(name).n > 8 else [])
    for name in gallery.names()
    # what is asked of an error system of some hundreds of states takes many minutes
    if gallery.load(name).n * gallery.load(name).m < 200
    # with feedthrough some questions are not asked
    and gallery.load(name).D is None
]


@cache
def about(name: str) -> tuple[tuple[str, Answer], ...]:
    """What can be asked about a plant of the gallery, with a ring for its graph."""
    plant = gallery.load(name)
    if plant.neighbors is None:
        plant = plant.with_neighbors(NeighborGraph.ring(plant.names))
    asked = [
        question
        for question, each in QUESTIONS.items()
        if each.about in {"system", "plant"}
        and each.needs != "uncertainty"
        and (question != "complementary_subsystem" or plant.m > 1)
    ]
    first = plant.names[0]
    everything = mcexact.analyze(plant, asked, subset=[first], channel=first)
    found = [*everything.account.answers.items()]
    found += [(question, each) for question, each in answers(plant) if each is not None]
    if name == "liu2020-3ch-no-communication":
        found += mcexact.design_observer(plant, rate=1).certificates.items()
        found += [(each.kind, each) for _, each in of_a_parameter()]
        found += [
            (name, answer_of(document))
            for name, document in {
                **ABOUT_BOXES,
                **ABOUT_RANGES,
                **ABOUT_PERFORMANCE,
                **ABOUT_SATURATION,
            }.items()
        ]
    return tuple(found)


def test_loops_controllers_and_trajectories_are_told_in_one_line() -> None:
    plant = gallery.load("liu2020-3ch-no-communication")
    plant = plant.with_neighbors(mcexact.NeighborGraph.ring(plant.names))
    design = mcexact.design_observer(plant, rate=1)
    moved = mcexact.simulate(plant, design.controller, points=3)
    results: list[Any] = [design, design.loop, design.controller, design.account, moved]
    results += [mcexact.crosscheck(plant), mcexact.questions.exceptional_gains([[0]], [[1]], [[1]])]
    for found in results:
        line = repr(found)
        assert len(line) <= LINE and "\n" not in line
        assert line.startswith(f"{type(found).__name__}(") and line.endswith(")")


@pytest.mark.parametrize("name", PLANTS)
def test_an_answer_is_told_in_one_line_that_cuts_nothing(name: str) -> None:
    for question, found in about(name):
        line = repr(found)
        assert len(line) <= LINE, (question, line)
        assert "\n" not in line
        assert line.startswith(f"{type(found).__name__}(") and line.endswith(")")
        whole = {key: fitted(value, 10**6) for key, value in found.claim().items()}
        for key, text in whole.items():
            assert f"{key}=" in line, question
            if text in {"True", "False", "None"}:
                assert f"{key}={text}" in line, question
        told = _ELIDED.sub("", line)
        for kind in (_NUMBER, _NAME):
            known = {each for text in whole.values() for each in kind.findall(text)}
            known |= {repr(each["construction"]) for each in found.subject}
            values = told.partition("(")[2]
            keys = {each for key in whole for each in kind.findall(key)}
            assert set(kind.findall(values)) <= known | keys, (question, line)


@pytest.mark.parametrize("name", PLANTS)
def test_an_answer_has_no_truth_value_and_says_what_to_ask(name: str) -> None:
    for _, found in about(name):
        with refusal(TypeError, "truth", part=True) as caught:
            bool(found)
        asked = re.findall(r"\.(\w+)", str(caught.value))
        assert asked and all(hasattr(found, attribute) for attribute in asked)


@pytest.mark.parametrize("name", PLANTS)
def test_an_answer_is_read_back_from_its_certificate(name: str) -> None:
    for question, found in about(name):
        text = encode(found)
        read = answer_of(json.loads(text))
        assert type(read) is type(found)
        assert read == found, question
        assert encode(read) == text
        assert repr(read) == repr(found)
        assert read.to_dict() == found.to_dict()


@pytest.mark.parametrize("name", PLANTS)
def test_everything_that_is_shown_is_in_every_form(name: str) -> None:
    for _, found in about(name):
        entries = list(found.entries())
        assert list(json.loads(json.dumps(found.to_dict()))) == [key for key, _, _ in entries]
        renamed = found.dual_keys if is_about_dual(found.subject) else {}
        assert {renamed.get(key, key) for key in found.claim()} <= found.to_dict().keys()
        html, latex = found._repr_html_(), found._repr_latex_()
        assert latex.startswith("$") and latex.endswith("$")
        labels = [label for _, label, _ in entries]
        if isinstance(found, ParametricFixedSpectrum):  # a row for each mode, and where it is fixed
            labels = [where for where, _, _ in found.rows] or list(found.words)
        for label in labels:
            assert f"<tr><th>{escape(label)}</th>" in html
            assert f"{words(label)} & " in latex
        assert list(found.to_row()) == ["kind", "system", *(key for key, _, _ in entries)]


def test_every_kind_is_asked_about_a_plant_of_the_gallery() -> None:
    seen = {found.kind for _, found in about("liu2020-3ch-no-communication")}
    assert seen == set(RULES) == set(KINDS)


@pytest.mark.parametrize("kind", sorted(RULES))
def test_kind_and_rule_have_the_same_name(kind: str) -> None:
    assert kind_named(kind).kind == kind
    assert RULES[kind].check.__name__ == f"check_{kind}"


def test_long_names_and_numbers_are_left_out_whole() -> None:
    names = ["a" * 250, "b" * 250]
    long = 10**400 + 7
    plant = MultiChannelSystem(
        [[long, 0], [0, long + 2]], [[[1], [0]], [[0], [1]]], [[[0, 0]]] * 2, names=names
    )
    for _, found in answers(plant.with_neighbors(NeighborGraph.ring(plant.names))):
        assert len(repr(found)) <= LINE
        assert "aa" not in repr(found)
        assert "00" not in _ELIDED.sub("", repr(found))


def test_only_an_answer_about_a_dual_says_what_is_observable() -> None:
    plant = gallery.load("liu2020-3ch-no-communication")
    assert mcexact.joint_observability(plant).observable
    with pytest.raises(UsageError, match=r"ask \.controllable"):
        mcexact.joint_controllability(plant).observable  # noqa: B018


def objects(text: str) -> Iterator[set[str]]:
    """The keys of every object that is written out in a text, nested ones too."""
    for start in re.finditer(r'\{(?=")', text):
        depth, segments = 0, [""]
        for character in text[start.end() :]:
            depth += (character in "{[(") - (character in "}])")
            if depth < 0:
                break
            if character == "," and not depth:
                segments.append("")
            else:
                segments[-1] += character
        keys = (re.match(r'\s*"(\w+)"', segment) for segment in segments)
        yield {key.group(1) for key in keys if key}


def parts_of(wanted: Any) -> Iterator[type[Part]]:
    """The parts that a type is made of."""
    if isinstance(wanted, type) and is_dataclass(wanted) and issubclass(wanted, Part):
        yield wanted
        for hint in typing.get_type_hints(wanted).values():
            yield from parts_of(hint)
    for each in typing.get_args(wanted):
        yield from parts_of(each)


def keys_of(part: type[Part]) -> set[str]:
    return {key_of(each) for each in fields(part)}


@pytest.mark.parametrize("kind", sorted(RULES))
def test_the_format_has_the_keys_of_every_kind(kind: str) -> None:
    made, documents = kind_named(kind), list(objects(FORMAT))
    section = FORMAT.partition(f"### `{kind}`\n")[2].partition("\n### ")[0]
    claim, _, witness = f"\n{section}".partition("\nclaim ")[2].partition("\nwitness")
    assert next(objects(claim)) == {key_of(each) for each in fields_of(made, "claim")}
    hints: Mapping[str, Any] = typing.get_type_hints(made)
    of_witness = fields_of(made, "witness")
    if not of_witness:
        assert "witness `{}`" in section
    elif [each.metadata["whole"] for each in of_witness] == [True]:
        for part in typing.get_args(hints[of_witness[0].name]):
            assert keys_of(part) in list(objects(witness)), part
    else:
        assert next(objects(witness)) == {each.name for each in of_witness}
    for hint in hints.values():
        for part in parts_of(hint):
            assert keys_of(part) in documents, part
