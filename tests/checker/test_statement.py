"""One certificate makes one statement: equal ones where the meaning is equal, and only there."""

from __future__ import annotations

import hashlib
import json
import random
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.cells import looped, rearranged
from mcexact.checker.constructions import CONSTRUCTIONS, read_subject
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import (
    System,
    canonical_json,
    described,
    polynomial_text,
    read_plant,
)
from mcexact.checker.discs import box_of
from mcexact.checker.kinds import KINDS, check_document
from mcexact.checker.parametric_system import digest, plant_of
from mcexact.model.system_file import read_system
from mcexact.model.text import plain
from tests.checker.handmade import (
    CONTROLLABLE,
    FREE,
    PAPER,
    UNCONTROLLABLE,
    VALID,
    Document,
    certificate,
    changed,
    checked,
    matrix,
    plant,
)
from tests.checker.manifests import places, replaced
from tests.checker.parameter_plants import ALL as ABOUT_RANGES
from tests.checker.test_closed_loop_spectrum import LOOP
from tests.checker.test_subject import BUILDS, TIMES, drawn_plant
from tests.oracle.certificates.statement import statement as second
from tests.oracle.certificates.statement import system_words as second_words
from tests.oracle.drawn.certificates import some_certificate

TWO = plant([[0]], ([[1]], [[1]]), ([[1]], [[1]]), neighbors={"1": [], "2": []})
DUAL = {"construction": "dual"}


def drawn(kind: str, count: int) -> Iterator[Document]:
    """Certificates of a kind, drawn and written by hand."""
    by_hand = (*VALID.values(), *ABOUT_RANGES.values())
    yield from (document for document in by_hand if document["kind"] == kind)
    yield from (some_certificate(random.Random(seed), kind) for seed in range(count))


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_the_statement_is_the_one_that_the_format_describes(kind: str) -> None:
    """A second writer fills in the templates of FORMAT.md; its digests are the same."""
    for document in drawn(kind, 12):
        verdict = checked(document)
        assert verdict.statement == second(document)
        assert verdict.statement.isascii() and len(verdict.statement.splitlines()) == 1
        digest = hashlib.sha256(verdict.statement.encode()).hexdigest()
        assert verdict.statement_digest == digest
        assert verdict.line() == f"VALID {digest} {verdict.statement}"


@pytest.mark.parametrize("name", sorted(CONSTRUCTIONS))
def test_the_system_is_named_as_the_format_describes(name: str) -> None:
    rng = random.Random(name)
    for build in BUILDS[name] * 5:
        derived = build(rng, drawn_plant(rng, TIMES.get(name, "discrete")))
        document = certificate("x", derived.canonical_document(), {}, {}, *plain(derived.subject))
        assert subject_of(document).words == second_words(document)


def subject_of(document: Document) -> Any:
    """The subject with the words that a statement has for it."""
    if "parameters" in document["system"]:
        plant: Any = plant_of(document["system"])
        named = replace(plant, words=f"the plant {digest(plant)}")
        if document["kind"].startswith("parametric_box_"):
            return looped(document["subject"], named)
        return rearranged(document["subject"], named)
    verdict = check_document({**document, "kind": "neighbor_graph", "claim": {}, "witness": {}})
    system = read_plant(document["system"])
    named = System(**{**vars(system), "words": f"the plant {verdict.system_digest}"})
    if document["kind"].startswith("box_"):
        return box_of(document["subject"], named, document["kind"])
    return read_subject(document["subject"], named)


# Nothing is lost.

UNUSED: dict[str, tuple[str, Any, set[str]]] = {
    "box_stable": ("gain_radii", None, {"gain_radii"}),
    "common_dimension": ("feasible", False, {"dimension"}),
    "communication": ("feasible", False, {"added", "cost"}),
    "communication by outputs": ("share", "outputs", {"dimensions"}),
    "parametric_box_stable": ("gain_radii", None, {"gain_radii"}),
    "setpoint": ("solvable", True, {"invariant_zero"}),
    "shared_dimensions": ("feasible", False, {"dimensions", "cost"}),
    "single_channel_gains": ("exists", False, {"cyclic", "indices"}),
}
"""Keys that are null, or false, where another key has a value: nothing else is VALID.

Radii that are null are not replaced: a number is no controller, and stops the sentence."""


def others(value: Any, names: list[str]) -> list[Any]:
    """Other values of the same sort in the place of a value."""
    if isinstance(value, bool):
        return [not value]
    if isinstance(value, int):
        return [value + 1, 1 - value if value != 1 - value else value + 2]
    if value is None:
        return [1, {"lower": "1", "upper": "2"}]
    if value in names:
        return [name for name in names if name != value] + [f'{value}"']
    try:
        moved = Fraction(value) + Fraction(1, 3)
    except ValueError:
        words = ("outputs+states", "states", "controllable", "observable", "both")
        return [word for word in words if word != value]
    return [str(moved)] if moved.denominator > 1 else [int(moved)]


def mutants(value: Any, names: list[str]) -> Iterator[tuple[tuple[Any, ...], Any]]:
    """Every copy of a value with one leaf changed, or with an entry of a list less or more."""
    for path, node in places(value):
        if isinstance(node, list):
            for k in range(len(node)):
                yield path, replaced_in(value, path, node[:k] + node[k + 1 :])
            yield path, replaced_in(value, path, [*node, *node[-1:]])
        elif not isinstance(node, dict):
            for other in others(node, names):
                yield path, replaced_in(value, path, other)


def replaced_in(value: Any, path: tuple[Any, ...], new: Any) -> Any:
    """A copy in which one node is another one."""
    return replaced({"it": value}, ("it", *path), new)["it"]


def stated(kind: str, claim: Any, system: System) -> str:
    """The sentence, or what stops it where the claim cannot be read."""
    try:
        return KINDS[kind].statement(claim, system)
    except (Refused, TypeError, KeyError, ValueError, IndexError) as error:
        return f"no statement: {type(error).__name__}"


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_no_part_of_a_claim_is_lost(kind: str) -> None:
    rules = [rule for each, rule in UNUSED.items() if each.split()[0] == kind]
    stopped = tried = 0
    for document in drawn(kind, 12):
        system, claim = subject_of(document), document["claim"]
        said = KINDS[kind].statement(claim, system)
        for path, mutant in mutants(claim, system.names):
            if any(
                path[0] in unused and value in (claim[key], mutant[key])
                for key, value, unused in rules
            ):
                continue
            if same_meaning(claim, mutant, system) or claim == mutant:
                continue
            tried += 1
            found = stated(kind, mutant, system)
            stopped += found.startswith("no statement")
            assert found != said, (path, mutant)
    assert tried and stopped < tried / 2


def same_meaning(claim: Any, mutant: Any, system: System) -> bool:
    """Whether matrices are the same numbers, or a bound of stability is null and was 0 or 1."""
    if "M" in claim and isinstance(mutant["M"], dict) and mutant["M"].get("denominator"):
        return meaning(claim) == meaning(mutant)
    if "back_calculation" in claim:
        try:
            return meaning(without_zeros(claim)) == meaning(without_zeros(mutant))
        except (TypeError, KeyError, ZeroDivisionError):
            return False
    others = [{key: v for key, v in each.items() if key != "bound"} for each in (claim, mutant)]
    of_loops = claim.keys() in ({"bound", "stable"}, {"bound", "gain_radii"})
    if not of_loops or canonical_json(others[0]) != canonical_json(others[1]):
        return False
    default = int(system.time == "discrete")
    bounds = [default if each["bound"] is None else each["bound"] for each in (claim, mutant)]
    return bounds[0] == bounds[1]


def without_zeros(claim: Any) -> Any:
    """The claim, with None for anti-windup gains that are all 0."""
    gains = claim["back_calculation"]
    return {
        **claim,
        "back_calculation": [L if any(map(any, L["entries"])) else None for L in gains],
    }


def meaning(value: Any) -> Any:
    """A parameter of a construction without what is only a matter of writing."""
    if isinstance(value, dict) and value.keys() == {"denominator", "entries"}:
        d = value["denominator"]
        return [[str(Fraction(entry, d)) for entry in row] for row in value["entries"]]
    if isinstance(value, dict):
        found = {key: meaning(part) for key, part in value.items()}
        if "hold" in found:
            found["hold"] = {name: steps for name, steps in found["hold"].items() if steps != "0"}
        if "added" in found:
            found["added"].sort()
        return {key: part for key, part in found.items() if part not in ({}, None)}
    return [meaning(part) for part in value] if isinstance(value, list) else str(value)


GRAPH = {"1": ["2"], "2": ["1"], "3": ["1"]}
PORTS = [([[k], [1]], [[1, k]]) for k in (1, 2, 3)]
THREE = plant([[0, 1], [0, 0]], *PORTS, time="discrete", neighbors=GRAPH, delays={"1": {"2": 1}})

HIDDEN = plant([[0] * 3] * 3, *[([[0]] * 3, [[0] * 3])] * 3)
"""Every subspace of it is invariant, and no output shows it."""


@pytest.mark.parametrize("name", sorted(CONSTRUCTIONS))
def test_no_parameter_of_a_construction_is_lost(name: str) -> None:
    """Two systems have the same words exactly if their parameters mean the same."""
    start = {**(HIDDEN if name == "modulo" else THREE), "time": TIMES.get(name, "discrete")}
    rng, base = (
        random.Random(name),
        read_system(json.dumps({"format": "mcexact-system/1", **start})),
    )
    words: dict[str, Any] = {}
    for build in BUILDS[name] * 6:
        (step,) = plain(build(rng, base).subject)
        own = {key: part for key, part in step.items() if key != "construction"}
        for _, parameters in [((), own), *mutants(own, list(base.names))]:
            written = {"construction": name, **parameters}
            try:
                system = subject_of(certificate("x", start, {}, {}, written))
            except Refused:
                continue
            assert words.setdefault(system.words, meaning(parameters)) == meaning(parameters)
    meanings = [json.dumps(each, sort_keys=True) for each in words.values()]
    assert len(set(meanings)) == len(meanings)
    assert len(words) >= (3 if any(map(bool, words.values())) else 1)


def test_every_order_of_constructions_has_a_name_of_its_own() -> None:
    steps = [
        DUAL,
        {"construction": "full_output", "channel": "1"},
        {"construction": "full_output", "channel": "2"},
        {"construction": "integrators"},
        {"construction": "feedback", "gains": [matrix([1]), matrix([0])]},
        {"construction": "merged", "parts": [["1"], ["2"]]},
    ]
    subjects = [[]] + [[a] for a in steps] + [[a, b] for a in steps for b in steps]
    subjects += [[a, b, c] for a in steps for b in steps for c in steps]
    named: dict[str, Any] = {}
    for subject in subjects:
        document = certificate("x", TWO, {}, {}, *subject)
        try:
            words = subject_of(document).words
        except Refused:
            continue
        assert words not in named, (subject, named[words])
        named[words] = subject
    assert len(named) > 100


# Pairs that once had the same words.

ONE = matrix([1])


def controlled(gain: int) -> Document:
    """A loop of one integrator."""
    return changed(LOOP, ("subject.0.controller.agents.0.input.outputs.1", [[gain]]))


PAIRS: list[tuple[str, list[Document], list[Document]]] = [
    (
        "the dual of full output, and full output of the dual",
        [DUAL, {"construction": "full_output", "channel": "1"}],
        [{"construction": "full_output", "channel": "1"}, DUAL],
    ),
    (
        "two gains",
        [{"construction": "feedback", "gains": [ONE, matrix([0])]}],
        [{"construction": "feedback", "gains": [matrix([0]), ONE]}],
    ),
    (
        "two sets of added links",
        [{"construction": "arcs", "added": [["1", "2"]]}],
        [{"construction": "arcs", "added": [["2", "1"]]}],
    ),
    (
        "two error systems",
        [{"construction": "error", "gains": [ONE, matrix([0])]}],
        [{"construction": "error", "gains": [matrix([0]), ONE]}],
    ),
]


@pytest.mark.parametrize(("what", "one", "other"), PAIRS, ids=[row[0] for row in PAIRS])
def test_each_of_two_has_its_statement(
    what: str, one: list[Document], other: list[Document]
) -> None:
    words = [subject_of(certificate("x", TWO, {}, {}, *steps)).words for steps in (one, other)]
    assert words[0] != words[1], what


def test_two_controllers_and_two_matrices_have_two_statements() -> None:
    agents = "subject.0.controller.agents.0"
    loop = subject_of(LOOP)
    other = subject_of(changed(LOOP, (f"{agents}.shared_update", {})))
    assert loop.words != other.words and loop.controller != other.controller
    system, claim = subject_of(FREE), {"M": matrix([1]), "blocks": 1, "polynomial": [1]}
    said = [
        KINDS["exceptional_gains"].statement({**claim, "M": M, "roots": []}, system)
        for M in (matrix([1]), matrix([2]), matrix([2], denominator=2))
    ]
    assert said[0] == said[2] != said[1]


# The same, written in another way.


def test_denominators_and_the_order_of_links_do_not_matter() -> None:
    half = {"construction": "feedback", "gains": [matrix([1], denominator=2), ONE]}
    same = {
        "construction": "feedback",
        "gains": [matrix([3], denominator=6), matrix([7], denominator=7)],
    }
    names = [subject_of(certificate("x", TWO, {}, {}, step)).words for step in (half, same)]
    assert names[0] == names[1]
    links = [["1", "2"], ["2", "1"]]
    names = [
        subject_of(certificate("x", TWO, {}, {}, {"construction": "arcs", "added": added})).words
        for added in (links, links[::-1])
    ]
    assert names[0] == names[1] and '{"1" -> "2", "2" -> "1"}' in names[0]


def test_decimals_and_the_order_of_discs_do_not_matter() -> None:
    document = VALID["a pair of fixed modes"]
    first, second_disc = document["claim"]["factors"][0]["roots"]
    written = changed(
        document,
        ("claim.factors.0.roots", [{**second_disc, "im": "1.00", "radius": "0.250"}, first]),
        ("claim.best_rate.lower", "-0.2500"),
    )
    assert checked(written).verdict == "VALID"
    assert checked(written).statement == checked(document).statement


def test_a_controller_has_one_digest_however_it_is_written() -> None:
    place = "subject.0.controller.agents.0"
    loop = checked(LOOP)
    assert loop.verdict == "VALID" and len(loop.controller_digest) == 64
    agent = LOOP["subject"][0]["controller"]["agents"][0]
    used = {key: part for key, part in agent["input"].items() if part}
    ((key, by_name),) = list(used.items())[:1]
    ((name, M),) = list(by_name.items())[:1]
    entries = [
        [i, j, str(x) if k % 2 else x]
        for i, row in enumerate(M)
        for j, x in enumerate(row)
        for k in [0]
    ]
    sparse = {"shape": [len(M), len(M[0])], "entries": entries}
    for edits in (
        [(f"{place}.input.{key}.{name}", sparse)],
        [(f"{place}.hold", {})],
        [(f"{place}.hold", {name: 0})],
        [(f"{place}.private_update", {"shared": {}, "outputs": {}})],
    ):
        written = checked(changed(LOOP, *edits))
        assert written.verdict == "VALID", written.line()
        assert written.controller_digest == loop.controller_digest
        assert written.statement == loop.statement


# Names that imitate words.

NAMES = [
    '", "',
    'a" of: ',
    "\n",
    "\u00fc\u202e",
    "\\",
    'the plant "',
    "{1}",
    ")",
    "(",
    "\U0001f600",
    "\x7f",
]


@pytest.mark.parametrize("name", NAMES)
def test_a_name_stands_in_quotes_and_imitates_nothing(name: str) -> None:
    system = replace(subject_of(UNCONTROLLABLE), names=[name])
    claim = {**UNCONTROLLABLE["claim"], "channels": [name]}
    said = f"{described(system)}: {KINDS['controllability'].statement(claim, system)}"
    assert said.isascii() and said.isprintable()
    decoder = json.JSONDecoder()
    found, at = [], said.find('"')
    while at >= 0:
        text, end = decoder.raw_decode(said, at)
        found.append(text)
        at = said.find('"', end)
    assert found == [name, name]


def test_one_name_is_not_two() -> None:
    one = plant([[0]], ([[1]], [[1]]), ([[1]], [[1]]))
    system = subject_of(certificate("x", one, {}, {}))
    claim = CONTROLLABLE["claim"]
    said = {
        KINDS["controllability"].statement({**claim, "channels": listed}, system)
        for listed in (["1", "2"], ['1", "2'], ["1, 2"], ['"1", "2"'], ["1"], [])
    }
    assert len(said) == 6


def test_short_matrices_are_written_out_and_long_ones_are_not() -> None:
    step = {"construction": "feedback", "gains": [ONE, matrix([0])]}
    words = subject_of(certificate("x", TWO, {}, {}, step)).words
    assert words.endswith(' = {"1":[[1]],"2":[[0]]}')
    text = '{"1":[[%s]],"2":[[0]]}'
    for digits in (80 - len(text % ""), 81 - len(text % "")):
        gains = [matrix([10 ** (digits - 1)]), matrix([0])]
        words = subject_of(certificate("x", TWO, {}, {}, {**step, "gains": gains})).words
        value = text % 10 ** (digits - 1)
        assert hashlib.sha256(value.encode()).hexdigest() in words
        assert words.endswith(value) == (len(value) <= 80)


def test_the_statement_is_made_without_the_witness() -> None:
    mode, cut = VALID["incomplete by a fixed mode"], VALID["a cut"]
    assert checked(mode).statement.rpartition(": ")[2] == checked(cut).statement.rpartition(": ")[2]
    assert PAPER is not TWO


@pytest.mark.parametrize(
    ("coefficients", "words"),
    [
        ([], "0"),
        ([0], "0"),
        ([1], "1"),
        ([-1], "-1"),
        ([-2, 1], "x - 2"),
        ([2, -1], "-x + 2"),
        ([1, 0, -1], "-x^2 + 1"),
        ([1, Fraction(-3, 2), 1], "x^2 - 3/2*x + 1"),
        ([0, 0, 0, -2], "-2*x^3"),
    ],
)
def test_a_polynomial_begins_with_the_highest_power(coefficients: list[Any], words: str) -> None:
    assert polynomial_text(coefficients) == words


def test_a_rational_is_an_integer_or_a_fraction_in_lowest_terms() -> None:
    values = [Fraction(6, 2), Fraction(0), Fraction(-6, 4), Fraction(7, 3)]
    assert canonical_json(values) == '[3,0,"-3/2","7/3"]'
