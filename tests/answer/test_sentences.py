"""Every text about a system comes from a template whose premises were certified and checked."""

from __future__ import annotations

import json
import random
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from mcexact.answer import codec
from mcexact.answer.listing import FILE, TOPICS, everything, listing
from mcexact.answer.template import Template, templates
from mcexact.checker import check_document
from mcexact.model import gallery
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.report.assessment import Assessment, assess
from mcexact.report.assessment_page import assessment_page
from mcexact.report.assessment_tables import assessment_tables
from mcexact.report.json_view import assessment_view
from mcexact.report.latex import assessment_latex
from mcexact.report.picture import EmbeddedPicture, Picture
from mcexact.report.text import plain
from mcexact.report.words import answer
from tests.answer.reading import leaves, texts_of_html, texts_of_latex, texts_of_plain
from tests.oracle.draws import exact, sparse_system

ALL = tuple(everything())
PROOFS = Path(__file__).parents[2] / "proofs" / "theorems.txt"
DRAWN = 200
AT_ONCE = 10

# What is no sentence about the system: names of columns and parts of the page.
CHROME = {
    "factor | roots, about | stable | in A | stay | s | rank",
    "factor of det(xI-A) | rank | below n",
    "All answers",
    "Evidence",
    "Every answer has a certificate, which mcexact check verifies independently. Click once on a "
    "block to select all of it.",
}
FROM_THE_CHECKER = re.compile(r"VALID .*|[\w.]+\.json: VALID|LaTeX")
NUMBERS = re.compile(r"-?\d+(/\d+|\.\d+)?")
# Paths in the JSON of which every leaf is a name or a keyword.
NAMES = re.compile(
    r"system\.(name|time|channels)|information|.*\b(arcs|components|dead_channels|channels|subset|"
    r"added|certificate(\..*)?|name)"
)


def drawn(seed: int) -> MultiChannelSystem:
    """A small plant, often with fixed modes or idle channels, some with a neighbor graph."""
    rng = random.Random(seed)
    plant = exact(sparse_system(rng), rng.choice(["continuous", "discrete"]))
    if rng.random() < 0.6:
        edges = {
            name: [other for other in plant.names if other != name and rng.random() < 0.5]
            for name in plant.names
        }
        plant = plant.with_neighbors(NeighborGraph.from_names(plant.names, edges))
    return plant


def question(plant: MultiChannelSystem, rng: random.Random) -> dict[str, Any]:
    """Something to ask besides."""
    asked: dict[str, Any] = {"links": plant.m <= 3}
    if plant.neighbors is not None:
        asked["minimal"] = True
        asked["information"] = rng.choice(["own", "outputs"])
        asked["delayed"] = plant.time == "discrete" and plant.n <= 3
    if rng.random() < 0.3:
        asked["subset"] = [name for name in plant.names if rng.random() < 0.5]
    if rng.random() < 0.2:
        asked |= {"channel": rng.choice(plant.names), "every_channel": True}
    return asked


def match(text: str, topic: str) -> Template:
    """The template of a topic that makes a text."""
    for template in templates(*TOPICS[topic]):
        if template.pattern.fullmatch(text):
            return template
    raise AssertionError(f"no template made {text!r}")


def matches(texts: Iterator[str] | list[str]) -> Iterator[Template]:
    """The templates of texts that are about the system."""
    for text in texts:
        if text in CHROME or FROM_THE_CHECKER.fullmatch(text):
            continue
        for part in re.split(r"(?<=[a-z\d}])\. (?=in A:)", text):
            yield match(part, "analyze")


def of_figures(texts: list[str]) -> Iterator[str]:
    """Captions taken apart into the sentences that they are made of."""
    for text in texts:
        if text.startswith(("Graphs", "Shared states")):
            title, _, told = text.removesuffix(".").partition(". ")
            yield from (title, *told.split("; "))
        else:
            yield text


def certified(assessment: Assessment) -> set[str]:
    """The stems of the certificates, all of them VALID."""
    for name, made in assessment.certificates().items():
        said = check_document(codec.encode(made).encode("ascii"))
        assert said.verdict == "VALID", (name, said.line())
    return {name.removesuffix(".json") for name in assessment.certificates()}


def require_premises(assessment: Assessment, used: set[Template]) -> None:
    stems = certified(assessment)
    numbered = {re.sub(r"_\d+$", "", stem) for stem in stems}
    for template in used:
        missing = set(template.premises) - stems - numbered
        assert not missing, (template.key, missing)


@pytest.fixture
def _without_images(monkeypatch: pytest.MonkeyPatch) -> None:
    """Captions without their images, which take most of the time."""

    def caption(drawn: Picture) -> EmbeddedPicture:
        return EmbeddedPicture(drawn.title, drawn.alternative, "data:,", 1.0)

    monkeypatch.setattr(Picture, "embedded", caption)


def in_all_forms(assessment: Assessment) -> set[Template]:
    """Every template that some form of the answer uses."""
    wide = plain(assessment_tables(assessment), width=10**6)
    used = set(matches(texts_of_plain(wide)))
    used |= set(matches([str(each) for each in answer(assessment)]))
    used |= set(matches(texts_of_latex(assessment_latex(assessment))))
    page = texts_of_html(assessment_page(assessment).rendered({}, {}))
    titles = {assessment.system.name, "A multi-channel system"}
    used |= set(matches(of_figures([text for text in page if text not in titles])))
    view = json.loads(json.dumps(assessment_view(assessment, with_certificates=True)))
    for path, leaf in leaves(view):
        if isinstance(leaf, str) and not (NAMES.fullmatch(path) or NUMBERS.fullmatch(leaf)):
            used.add(unlabeled(leaf))
    return used


def unlabeled(text: str) -> Template:
    """The template of a text that stands under a key, where a table would have its label."""
    for template in templates(*TOPICS["analyze"]):
        if template.pattern.fullmatch(f"{template.label} | {text}" if template.label else text):
            return template
    raise AssertionError(f"no template made {text!r}")


@pytest.mark.usefixtures("_without_images")
@pytest.mark.parametrize("name", gallery.names())
def test_every_text_about_a_published_plant_is_made_by_a_template(name: str) -> None:
    plant = gallery.load(name)
    asked = {"subset": [plant.names[0]], "channel": plant.names[0], "links": plant.n <= 8}
    assessment = assess(plant, **asked)
    require_premises(assessment, in_all_forms(assessment))


@pytest.mark.usefixtures("_without_images")
@pytest.mark.parametrize("start", range(0, DRAWN, AT_ONCE))
def test_every_text_about_a_drawn_plant_is_made_by_a_template(start: int) -> None:
    for seed in range(start, start + AT_ONCE):
        plant = drawn(seed)
        assessment = assess(plant, **question(plant, random.Random(seed)))
        require_premises(assessment, in_all_forms(assessment))


def test_the_list_of_all_sentences_is_the_one_in_the_file() -> None:
    assert FILE.read_text(encoding="utf-8") == listing(), "run make sentences"


def test_every_theorem_is_proved_by_machine_or_has_an_author() -> None:
    proved = {line.split()[0] for line in PROOFS.read_text().splitlines() if "." in line}
    for template in ALL:
        for theorem in re.split(r"[,;] ", template.theorem) if template.theorem else ():
            author = re.fullmatch(r"[A-Z][\w. ]+ (and [A-Z][\w. ]+ )?\d{4}", theorem)
            assert theorem in proved or author, (template.key, theorem)


def test_every_sentence_has_a_name_of_its_own() -> None:
    keys = [template.key for template in ALL]
    assert len(keys) == len(set(keys))


@pytest.mark.parametrize(
    "text",
    [
        "No mode is fixed.",
        "stabilizable | by anything",
        "The plant cannot be stabilized by decentralized control: the slowest fixed mode grows.",
        "enough to share | 1 by each agent, 3 together",
    ],
)
def test_a_text_that_no_template_made_is_found(text: str) -> None:
    with pytest.raises(AssertionError, match="no template made"):
        match(text, "analyze")
