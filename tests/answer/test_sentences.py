"""Every text about a system is in its manifest: said by a rule that read VALID certificates."""

from __future__ import annotations

import hashlib
import json
import random
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import pytest

from mcexact.answer.account import Account
from mcexact.answer.listing import (
    FILE,
    TOPICS,
    everything,
    listing,
    premises_of,
    templates_of,
)
from mcexact.answer.sentence import LOOP, Certified
from mcexact.checker.kinds import check_document
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.report.html import EmbeddedPicture, Picture
from mcexact.report.pages import account_page
from mcexact.report.text import answer, in_lines, latex, plain, tables
from tests.answer.asking import asked as asking
from tests.answer.reading import leaves, texts_of_html, texts_of_latex, texts_of_plain
from tests.oracle.draws import exact, sparse_system

ALL = tuple(everything())
TEMPLATES = {template.key: template for template in ALL}
PROOFS = Path(__file__).parents[2] / "proofs" / "theorems.txt"
AT_ONCE = 10
STARTS = [
    *range(0, 60, AT_ONCE),
    *(pytest.param(start, marks=pytest.mark.slow) for start in range(60, 200, AT_ONCE)),
]
"""The first numbers of the plants that are drawn for one test each."""

# What is no sentence about the system: names of columns and parts of the page.
CHROME = {
    "factor | roots, about | stable | in A | fixed | s | rank",
    "factor of det(xI-A) | rank | below n",
    "All answers",
    "bound and least",
    "channel",
    "Evidence",
    "Every answer has a certificate, which mcexact check verifies independently. Click once on a "
    "block to select all of it.",
}
FROM_THE_CHECKER = re.compile(r"VALID .*|[\w.]+\.json: VALID|LaTeX")
NUMBERS = re.compile(r"-?\d+(/\d+|\.\d+)?")
# Paths in the JSON of which every leaf is a name or a keyword.
NAMES = re.compile(
    r"(nearby|why_fixed)\..*|format|structural_fixed_modes\.information|system\.(name|time|channels)|information|questions\.(question|outcome|reason)|sentences\.(rule|theorem)|"
    r".*\b(arcs|components|inactive|channels|subset|share|property|candidates|added|certificate|name)"
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
    """Something to ask as well."""
    asked: dict[str, Any] = {"links": plant.m <= 3, "failures": plant.m <= 3}
    asked["fewest_failures"] = plant.m <= 2
    if plant.neighbors is not None:
        asked["minimal"] = True
        asked["information"] = rng.choice(["own", "outputs"])
        asked["delayed"] = plant.time == "discrete" and plant.n <= 3
    if rng.random() < 0.3:
        asked["subset"] = [name for name in plant.names if rng.random() < 0.5]
    if rng.random() < 0.2:
        asked |= {"channel": rng.choice(plant.names), "every_channel": True}
    return asked


def known_texts(account: Account) -> set[str]:
    """The texts of the manifest, labels before a bar as in a table, or left out as in JSON."""
    told = {each["text"] for each in account.manifest()["sentences"]}
    assert told == {each.line for each in account.sentences}
    bare = {str(each) for each in account.sentences}
    return told | bare | {" | ".join(each.cells) for each in account.sentences}


def require_known(texts: Iterable[str], known: set[str]) -> None:
    """Every text that is about the system is one of the manifest's."""
    for text in texts:
        if text in CHROME or FROM_THE_CHECKER.fullmatch(text):
            continue
        for part in re.split(r"(?<=[a-z\d}])\. (?=in A:)", text):
            assert part in known, part


def of_figures(texts: list[str]) -> Iterator[str]:
    """Captions taken apart into the sentences that they are made of."""
    for text in texts:
        if text.startswith(("Graphs", "Shared states")):
            title, _, told = text.removesuffix(".").partition(". ")
            yield from (title, *told.split("; "))
        elif text.startswith("Fixed mode. "):
            yield from re.split(r"(?<=Fixed mode)\. |(?<=\.) (?=Sending )", text)
        else:
            yield text


def require_certified(account: Account, topic: str = "analyze") -> None:
    """Every certificate is VALID, and what each sentence rests on stands there.

    A sentence whose rule sees answers rests on some of these; one without premises repeats what was
    given.
    """
    documents = {}
    for file, text in account.certificates.items():
        said = check_document(text.encode("ascii"))
        assert said.verdict == "VALID", (file, said.line())
        documents[file] = json.loads(text)
    manifest = account.manifest()
    for file, text in account.certificates.items():
        assert manifest["certificates"][file] == hashlib.sha256(text.encode("ascii")).hexdigest()
    for said in json.loads(json.dumps(manifest))["sentences"]:
        seen = premises_of(TEMPLATES[said["rule"]], TOPICS[topic][0])
        assert bool(seen) == bool(said["because"]), said
        for file, pointer, value in said["because"]:
            assert at(documents[file], pointer) == value, (said["rule"], pointer)
            stem = re.sub(r"_\d+$", "", file.removesuffix(".json"))
            assert stem in seen or (stem in LOOP and {"loop", "bounded_loop"} & set(seen))


def at(document: Any, pointer: str) -> Any:
    """What a JSON pointer points to."""
    for key in pointer.split("/")[1:]:
        document = document[int(key)] if isinstance(document, list) else document[key]
    return document


@pytest.fixture
def _without_images(monkeypatch: pytest.MonkeyPatch) -> None:
    """Captions without their images, which take most of the time."""

    def caption(drawn: Picture) -> EmbeddedPicture:
        return EmbeddedPicture(drawn.title, drawn.alternative, "data:,", 1.0)

    monkeypatch.setattr(Picture, "embedded", caption)


def require_all_forms(account: Account, view: dict[str, Any]) -> None:
    """Whatever some form of the answer says stands in the manifest."""
    known = known_texts(account)
    said = account.sentences
    require_known(texts_of_plain(plain(tables(said), width=10**6)), known)
    require_known(answer(said), known)
    words = " ".join(in_lines(said, 8).split()).removesuffix(
        " Further fixed modes are listed below."
    )
    assert words in " ".join(answer(said))
    require_known(texts_of_latex(latex(account)), known)
    page = texts_of_html(account_page(account).rendered({}, {}))
    titles = {account.given.system.name, "A multi-channel system"}
    require_known(of_figures([text for text in page if text not in titles]), known)
    for path, leaf in leaves(json.loads(json.dumps(view))):
        if isinstance(leaf, str) and not (NAMES.fullmatch(path) or NUMBERS.fullmatch(leaf)):
            assert leaf in known, (path, leaf)


@pytest.mark.usefixtures("_without_images")
@pytest.mark.parametrize("name", gallery.names())
def test_every_text_about_a_published_plant_is_made_by_a_template(name: str) -> None:
    plant = gallery.load(name)
    asked = {
        "subset": [plant.names[0]],
        "channel": plant.names[0],
        "links": plant.n <= 8 and plant.D is None,
    }
    found = asking(plant, **asked)
    require_certified(found.account)
    require_all_forms(found.account, found.to_dict())


@pytest.mark.usefixtures("_without_images")
@pytest.mark.parametrize("start", STARTS)
def test_every_text_about_a_drawn_plant_is_made_by_a_template(start: int) -> None:
    for seed in range(start, start + AT_ONCE):
        plant = drawn(seed)
        found = asking(plant, **question(plant, random.Random(seed)))
        require_certified(found.account)
        require_all_forms(found.account, found.to_dict())


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
        "sufficient to share | 1 by each agent, 3 together",
    ],
)
def test_a_text_that_no_rule_said_is_found(text: str) -> None:
    known = known_texts(asking(gallery.load("hidden-triple-mode")).account)
    with pytest.raises(AssertionError):
        require_known([text], known)


def test_every_template_belongs_to_the_rules_of_one_place() -> None:
    for topic, (rulebook, _) in TOPICS.items():
        for template in templates_of(topic):
            places = {rule.place for rule in rulebook if template in rule.templates}
            assert len(places) == 1, (topic, template.key)


def test_a_rule_that_reads_what_is_not_claimed_is_refused() -> None:
    found = asking(gallery.load("hidden-triple-mode")).account
    seen = Certified(found.answers["fixed_spectrum"], "fixed_spectrum.json", {})
    with pytest.raises(AttributeError, match="does not say 'gains' at /claim"):
        seen.gains  # noqa: B018


def test_what_was_read_of_one_member_of_a_list_is_no_premise_of_the_next() -> None:
    read: Any = {}
    plant = MultiChannelSystem([[1, 0], [0, 2]], [[[0], [0]]], [[[1, 1]]])
    seen = Certified(asking(plant).fixed_spectrum, "file", read)
    places = []
    for factor in seen.factors.separately():
        _ = factor.rank
        places.append([pointer for _, pointer in read])
    assert places == [["/claim/factors/0/rank"], ["/claim/factors/1/rank"]]
    assert len(read) == 2


def test_iterating_over_a_claim_records_nothing_and_drops_nothing() -> None:
    read: Any = {}
    plant = MultiChannelSystem([[1, 0], [0, 2]], [[[0], [0]]], [[[1, 1]]])
    seen = Certified(asking(plant).fixed_spectrum, "file", read)
    _ = seen.stabilizable
    assert len(list(seen.factors)) == 2
    assert [pointer for _, pointer in read] == ["/claim/stabilizable"]
    assert next(iter(seen.factors)).rank == next(factor.rank for factor in seen.factors)
    assert any(factor.rank for factor in seen.factors)
    assert [pointer for _, pointer in read] == ["/claim/stabilizable", "/claim/factors/0/rank"]
