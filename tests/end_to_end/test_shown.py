"""Results as a prompt and a notebook show them: short, escaped, in words and as plain data."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from fractions import Fraction
from functools import cache
from html.parser import HTMLParser
from typing import Any

import pytest

import mcexact
from mcexact import MultiChannelSystem
from mcexact.model import gallery
from mcexact.model.system_file import read_system
from mcexact.shown import LINE, MOST_ROWS
from tests.wording import refusal

HOSTILE = "<script>alert(1)</script> & $x_1$"


@cache
def plant() -> MultiChannelSystem:
    return MultiChannelSystem(
        [[1, 0, 0], [0, 1, 0], [0, 1, "1/3"]],
        [[[1], [0], [0]], [[0], [1], [0]], [[1], [0], [0]]],
        [[[1, 0, 0], [0, 0, 1]], [[0, 1, 0]], [[0, 1, 0]]],
        names=[HOSTILE, "b", "c"],
        neighbors={"b": [HOSTILE], "c": ["b"], HOSTILE: ["c"]},
        name=HOSTILE,
        source=HOSTILE,
    )


@cache
def tanks() -> MultiChannelSystem:
    return MultiChannelSystem(
        [[1, 2], [3, "1/2"]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]], name="tanks"
    )


@cache
def design() -> mcexact.designs.Design:
    return mcexact.design_decentralized(tanks(), spectrum={"closed_loop": [-1, -2, -3]})


@cache
def run() -> mcexact.simulation.Trajectory:
    return mcexact.simulate(tanks(), design().controller, points=4)


@cache
def record() -> mcexact.questions.Record:
    [found] = mcexact.sweep([plant()])
    return found


def wide(channels: int) -> MultiChannelSystem:
    ones = [[[1]]] * channels
    made = MultiChannelSystem([[1]], ones, ones, names=[f"{k}" + "n" * 90 for k in range(channels)])
    return made.with_neighbors(mcexact.NeighborGraph.ring(made.names))


RESULTS: dict[str, Callable[[], Any]] = {
    "system": plant,
    "wide system": lambda: wide(70),
    "derived system": lambda: mcexact.constructions.dual(plant()),
    "channel": lambda: plant().channels[0],
    "answer": lambda: mcexact.fixed_spectrum(plant()),
    "factor": lambda: mcexact.fixed_spectrum(plant()).factors[0],
    "interval": lambda: mcexact.fixed_spectrum(plant()).best_rate,
    "answer about a derived system": lambda: mcexact.fixed_spectrum(
        mcexact.constructions.merged(tanks(), [["1", "2"]])
    ),
    "verdict": lambda: mcexact.check(mcexact.fixed_spectrum(plant())),
    "bad verdict": lambda: mcexact.check(mcexact.fixed_spectrum(plant()), tanks()),
    "analysis": lambda: mcexact.analyze(plant()),
    "design": design,
    "loop": lambda: design().loop,
    "controller": lambda: design().controller,
    "program": lambda: design().controller.agents[0],
    "map": lambda: design().controller.agents[0].input,
    "graph": lambda: plant().neighbors,
    "wide graph": lambda: wide(70).neighbors,
    "trajectory": run,
    "assessment": lambda: mcexact.assess(design()),
    "record": record,
    "cross-checks": lambda: mcexact.crosscheck(tanks()),
}


class Strict(HTMLParser):
    """Parses a piece of HTML, in which every element has to be closed."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.seen: list[str] = []
        self.feed(text)
        self.close()
        assert not self.open

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.open.append(tag)
        self.seen.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


@pytest.mark.parametrize("name", RESULTS)
def test_a_prompt_shows_a_result_in_one_short_line(name: str) -> None:
    line = repr(RESULTS[name]())
    assert len(line) <= LINE and "\n" not in line and " at 0x" not in line


@pytest.mark.parametrize("name", RESULTS)
def test_a_notebook_shows_a_result_in_html_that_is_closed_and_escaped(name: str) -> None:
    html = RESULTS[name]()._repr_html_()
    seen = Strict(html).seen
    assert seen[:2] == ["div", "style"] and "script" not in seen
    assert "currentColor" in html and "prefers-color-scheme" not in html  # either paper
    assert seen.count("tr") <= 3 * MOST_ROWS


@pytest.mark.parametrize("name", RESULTS)
def test_a_notebook_shows_a_result_in_latex_that_is_balanced(name: str) -> None:
    latex = RESULTS[name]()._repr_latex_()
    assert latex.startswith("$") and latex.endswith("$")
    assert latex.replace(r"\$", "").count("$") == 2
    bare = re.sub(r"\\[\\{}]", "", latex)
    assert bare.count("{") == bare.count("}")
    begun, ended = (re.findall(rf"\\{word}\{{(\w+)\}}", latex) for word in ("begin", "end"))
    assert sorted(begun) == sorted(ended)


@pytest.mark.parametrize("name", RESULTS)
def test_a_result_is_said_in_words_without_the_names_of_classes(name: str) -> None:
    said = RESULTS[name]().explain()
    assert said and " object at " not in said and "Fraction(" not in said


@pytest.mark.parametrize(
    "name",
    [
        name
        for name, make in RESULTS.items()
        if name not in {"channel", "program", "map", "trajectory"}
    ],
)
def test_a_result_is_plain_data_that_json_takes(name: str) -> None:
    assert json.loads(json.dumps(RESULTS[name]().to_dict()))


@pytest.mark.parametrize("name", ["answer", "verdict", "bad verdict", "analysis"])
def test_what_decides_is_neither_true_nor_false_and_says_what_to_ask(name: str) -> None:
    found = RESULTS[name]()
    with refusal(TypeError) as caught:
        bool(found)
    for path in re.findall(r"\.(\w+)(?:\.\w+)?", str(caught.value)):
        assert hasattr(found, path)


def test_a_verdict_is_asked_whether_it_is_valid() -> None:
    good, bad = RESULTS["verdict"](), RESULTS["bad verdict"]()
    assert good.valid and not bad.valid
    assert good.explain() == good.statement
    assert bad.explain().startswith("NOT ABOUT system")
    assert repr(good).startswith("Verdict(VALID: For the plant ")
    assert repr(bad).startswith("Verdict(NOT ABOUT system system: about another system")


def test_an_answer_is_explained_in_the_sentences_of_the_analysis() -> None:
    found = mcexact.analyze(gallery.load("hidden-triple-mode"))
    lines = found.explain().splitlines()
    for name in ("fixed_spectrum", "completeness", "joint_observability", "transfer_graph"):
        said = found[name].explain().splitlines()
        assert said and set(said) <= set(lines), name


def test_an_answer_about_a_derived_system_is_stated_as_a_theorem() -> None:
    found = RESULTS["answer about a derived system"]()
    assert found.explain() == mcexact.check(found).statement


def test_plain_data_of_a_system_is_a_system_file() -> None:
    for system in (plant(), tanks(), mcexact.constructions.dual(tanks()), wide(3)):
        read = read_system(json.dumps(system.to_dict()))
        assert (read.A, read.B, read.C, read.neighbors) == (
            system.A, system.B, system.C, system.neighbors
        )  # fmt: skip
        assert (read.name, read.source) == (system.name, system.source)


def test_a_trajectory_is_lists_of_numbers_by_the_names_of_signals() -> None:
    found = run().to_dict()
    signals = [f"{letter} {name}" for letter in "yur" for name in (1, 2)]
    assert list(found) == ["t", "x[1]", "x[2]", *signals]
    assert len(found["t"]) == 5 and found["t"][0] == Fraction(0)
    assert found["y 1"] == found["x[1]"]
    assert "At the end x[1] = " in run().explain()


def test_a_row_of_a_sweep_is_flat() -> None:
    row = record().to_row()
    assert row["n"] == 3 and row["error"] is None
    assert row["fixed_spectrum.polynomial"] == "x - 1/3"
    assert row["fixed_spectrum.factors"] == 1
    assert row["fixed_spectrum.stabilizable"] is False


def test_special_characters_in_formulas_are_outside_of_texts() -> None:
    """Inside of a text MathJax shows an escape as it is written."""
    latex = plant()._repr_latex_() + record()._repr_latex_()
    texts = re.findall(r"\\text\{([^{}]*)\}", latex)
    assert r"\text{fixed}\_\text{spectrum.stabilizable}" in latex
    assert texts and not set("".join(texts)) & set("\\&%$#_~^")


def test_a_record_shows_an_interval_in_words_and_no_empty_cell() -> None:
    html = record()._repr_html_()
    assert "lower -0.3333" in html and "&#x27;lower" not in html and "None" not in html
