"""Sentences are implied by certificates, and nothing else makes the checker say so."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest

from mcexact.checker.command import pointed, verdicts_of
from mcexact.checker.core.budget import GRANTED, PER_BYTE, Budget, limited
from mcexact.checker.core.reading import Limits, Refused
from mcexact.checker.core.system import digest, read_plant
from mcexact.checker.kinds import FORMAT, KINDS, NOT_ABOUT, Expectation, same
from tests import effort
from tests.checker.handmade import FREE, PAPER, Document, changed, checked, without
from tests.checker.manifests import (
    BOUND,
    CONTROLLABLE,
    DUAL,
    EVIDENCE,
    HEARD,
    OBSERVABLE,
    SENTENCES,
    manifest,
    one,
    places,
    replaced,
    said,
    sentence,
    text_of,
    write,
)
from tests.checker.test_closed_loop_spectrum import HALF, LOOP, OPEN
from tests.checker.test_fixed_spectrum import TWO_FACTORS
from tests.wording import says, worded

ABOUT = f"For the plant {digest(read_plant(PAPER))}"
SHARED = "sub-state with its neighbors, without delay"
ENOUGH = sentence("enough-states", "shared_dimension_bound_states", *BOUND)
OUTPUTS = sentence("enough-outputs-states", "shared_dimension_bound_outputs_states", *BOUND)
NOT_STABILIZABLE = sentence("not-stabilizable", "fixed_spectrum")
RING = "neighbor_graph.json"
OTHER = changed(PAPER, ("A", [[-1, 0, 0], [0, -1, 0], [0, 1, -1]]))
"""Another plant with the same names."""


def test_every_sentence_is_said_again_in_the_words_of_the_checker(tmp_path: Path) -> None:
    found = said(write(tmp_path))
    assert [verdict.verdict for verdict in found] == ["IMPLIED"] * len(SENTENCES)
    lines = [verdict.line() for verdict in found]
    assert lines[0] == (
        f'IMPLIED {ABOUT} (3 states, channels {{"1", "2", "3"}}, continuous time): '
        "3 inputs and 4 outputs in all"
    )
    assert says(lines[1], "implied under") and ABOUT in lines[1]
    assert lines[1].endswith("[evidence.shrunk_subspace_fixed_dynamic] from fixed_spectrum.json")
    assert says(lines[2], "implied observed") and ABOUT in lines[2]
    files = ", ".join(f"{name}.json" for name in ("shared_dimension_bound_states", *BOUND))
    assert worded(lines[-1]) and ABOUT in lines[-1] and SHARED in lines[-1] and files in lines[-1]


def test_the_manifest_or_its_folder_may_be_named(tmp_path: Path) -> None:
    assert said(write(tmp_path)) == said(tmp_path / "manifest.json")


def about(plant: Document) -> Expectation:
    """What asks for a plant."""
    return Expectation(system=digest(read_plant(plant)))


def test_the_plant_can_be_insisted_on(tmp_path: Path) -> None:
    write(tmp_path)
    assert {v.verdict for v in said(tmp_path, about(PAPER))} == {"IMPLIED"}
    found = said(tmp_path, about(OTHER))
    assert {v.verdict for v in found} == {NOT_ABOUT, "INVALID"}
    assert [v.code for v in found].count("system") == len(EVIDENCE)


def test_the_agents_may_see_the_outputs_of_their_neighbors(tmp_path: Path) -> None:
    heard = {"observable": changed(OBSERVABLE, ("subject", [HEARD, DUAL]))}
    found = one(tmp_path, sentence("observable", "observable", evidence=heard), heard)
    assert found.verdict == "IMPLIED"
    assert says(found.statement, "neighbors measured") and ABOUT[4:] in found.statement


def test_sentences_about_a_derived_system_are_about_no_other(tmp_path: Path) -> None:
    step = {"construction": "arcs", "added": [["1", "2"]]}
    derived = {"controllable": changed(CONTROLLABLE, ("subject", [step]))}
    listed = manifest(derived, [sentence("controllable", "controllable", evidence=derived)])
    other = step | {"added": [["2", "3"]]}
    for subject, verdict in (([step], "IMPLIED"), ([], "INVALID"), ([other], "INVALID")):
        (found,) = said(write(tmp_path, derived, listed | {"subject": subject}))
        assert found.verdict == verdict, found.line()


def test_what_is_given_is_said_of_the_system_of_the_manifest(tmp_path: Path) -> None:
    """The dual has inputs for outputs, and no certificate need be about just that."""
    evidence = {"observable": OBSERVABLE}
    listed = manifest(evidence, [sentence("heading"), sentence("subsystem")])
    plain, _ = said(write(tmp_path, evidence, listed))
    assert plain.statement.endswith(": 3 inputs and 4 outputs in all")
    found, title = said(write(tmp_path, evidence, listed | {"subject": [DUAL]}))
    assert says(found.statement, "dual states") and ABOUT[4:] in found.statement
    assert found.statement.endswith(": 4 inputs and 3 outputs in all")
    said_of = f"For the dual of: {ABOUT[4:]}"
    assert worded(title.line()) and said_of in title.line()


LINK = {"construction": "arcs", "added": [["1", "2"]]}
SUBJECTS: list[tuple[str, Any, str]] = [
    ("no list", {"construction": "dual"}, "MALFORMED"),
    ("a name alone", ["dual"], "MALFORMED"),
    ("a parameter that the construction has not", [DUAL | {"channel": "1"}], "MALFORMED"),
    ("a channel that the plant has not", [LINK | {"added": [["1", "9"]]}], "MALFORMED"),
    ("a construction that is not known", [{"construction": "nonsense"}], "INCOMPLETE"),
    ("a link that there is already", [LINK, LINK], "INVALID"),
    ("a dual, which has no neighbor graph, with links", [DUAL, LINK], "INVALID"),
]


@pytest.mark.parametrize(
    ("subject", "verdict"), [row[1:] for row in SUBJECTS], ids=[row[0] for row in SUBJECTS]
)
def test_a_manifest_is_about_a_system_that_can_be_made(
    tmp_path: Path, subject: Any, verdict: str
) -> None:
    evidence = {"controllable": CONTROLLABLE}
    listed = manifest(evidence, [sentence("heading"), sentence("subsystem")])
    (found,) = said(write(tmp_path, evidence, listed | {"subject": subject}))
    assert found.verdict == verdict, found.line()
    assert found.place.startswith("subject"), found.line()


# Premises.

PREMISES = [(NOT_STABILIZABLE, "fixed_spectrum")]
PREMISES += [(ENOUGH, name) for name in ("shared_dimension_bound_states", *BOUND)]


@pytest.mark.parametrize(("what", "removed"), PREMISES, ids=[name for _, name in PREMISES])
def test_no_premise_can_be_left_out(tmp_path: Path, what: Document, removed: str) -> None:
    assert one(tmp_path, what).verdict == "IMPLIED"
    rest = [entry for entry in what["because"] if entry[0] != f"{removed}.json"]
    found = one(tmp_path, what | {"because": rest})
    assert (found.verdict, found.code) == ("INVALID", "premise"), found.line()


@pytest.mark.parametrize(("what", "removed"), PREMISES, ids=[name for _, name in PREMISES])
def test_no_certificate_can_be_away(tmp_path: Path, what: Document, removed: str) -> None:
    write(tmp_path, listed=manifest(sentences=[what]))
    (tmp_path / f"{removed}.json").unlink()
    found = said(tmp_path)
    assert [(v.verdict, v.code) for v in found] == [("INVALID", "missing"), ("INVALID", "premise")]


FALSE = {
    "fixed_spectrum": ("claim.stabilizable", True),
    "shared_dimension_bound_states": ("claim.deficiency", 0),
    "neighbor_graph": ("claim.strongly_connected", False),
    "joint_controllability": ("claim.controllable", False),
    "joint_observability": ("claim.dimension", 2),
}


@pytest.mark.parametrize(("what", "falsified"), PREMISES, ids=[name for _, name in PREMISES])
def test_no_claim_can_be_falsified(tmp_path: Path, what: Document, falsified: str) -> None:
    evidence = EVIDENCE | {falsified: changed(EVIDENCE[falsified], FALSE[falsified])}
    premises = [name for name in EVIDENCE if any(name in entry[0] for entry in what["because"])]
    what = sentence(what["rule"], *premises, evidence=evidence)
    # With its old digest it is found at once; with a new one by the rule of its kind.
    for listed in (manifest(sentences=[what]), manifest(evidence, [what])):
        first, second = said(write(tmp_path, evidence, listed))
        assert first.verdict in ("INVALID", "MALFORMED"), first.line()
        assert (second.verdict, second.code) == ("INVALID", "premise"), second.line()


@pytest.mark.parametrize(("what", "exchanged"), PREMISES, ids=[name for _, name in PREMISES])
def test_no_premise_can_be_of_another_plant(tmp_path: Path, what: Document, exchanged: str) -> None:
    graph = changed(PAPER, ("neighbors", {"1": ["2", "3"], "2": ["3"], "3": ["1"]}))
    document = changed(EVIDENCE[exchanged], ("system", graph))
    evidence = EVIDENCE | {exchanged: FREE if exchanged == "fixed_spectrum" else document}
    write(tmp_path, evidence, manifest(evidence, [what]))
    found = said(tmp_path, about(PAPER))
    assert [(v.verdict, v.code) for v in found] == [(NOT_ABOUT, "system"), ("INVALID", "premise")]
    assert any(v.status for v in said(tmp_path))


EXCHANGED: list[tuple[str, str, str, tuple[str, ...]]] = [
    (
        "the bound of the other share",
        "shared_dimension_bound_states",
        "enough-outputs-states",
        BOUND,
    ),
    ("the bound of this share", "shared_dimension_bound_outputs_states", "enough-states", BOUND),
    ("controllability twice", "joint_controllability", "observable", ()),
    ("observability twice", "joint_observability", "controllable", ()),
    ("another kind", "completeness", "stabilizable", ()),
    ("the bound as a spectrum", "shared_dimension_bound_states", "fixed", ()),
]


@pytest.mark.parametrize(
    ("premise", "rule", "others"), [row[1:] for row in EXCHANGED], ids=[row[0] for row in EXCHANGED]
)
def test_a_premise_has_to_be_the_right_one(
    tmp_path: Path, premise: str, rule: str, others: tuple[str, ...]
) -> None:
    found = one(tmp_path, sentence(rule, premise, *others))
    assert (found.verdict, found.code) == ("INVALID", "premise"), found.line()


def test_premises_about_what_the_agents_see_are_about_the_same(tmp_path: Path) -> None:
    evidence = EVIDENCE | {
        "heard": changed(EVIDENCE["joint_observability"], ("subject", [HEARD, DUAL]))
    }
    names = ("shared_dimension_bound_states", "neighbor_graph", "joint_controllability", "heard")
    found = one(tmp_path, sentence("enough-states", *names, evidence=evidence), evidence)
    assert (found.verdict, found.code) == ("INVALID", "premise"), found.line()


CLAIMS = [
    "stabilizable",
    "table-stabilizable",
    "nothing-fixed",
    "any-rate",
    "fixed-mode-unobserved",
]


@pytest.mark.parametrize("rule", CLAIMS)
def test_what_the_claims_deny_is_not_implied(tmp_path: Path, rule: str) -> None:
    found = one(tmp_path, sentence(rule, "fixed_spectrum"))
    assert (found.verdict, found.code) == ("INVALID", "claim"), found.line()


# Sentences.

BECAUSE: list[tuple[str, Any, str, str]] = [
    ("nowhere", ["/claim/nothing", True], "INVALID", "pointer"),
    ("behind the end", ["/claim/factors/1/rank", 2], "INVALID", "pointer"),
    ("far behind the end", ["/claim/factors/2/rank", 2], "INVALID", "pointer"),
    ("minus", ["/claim/factors/-", 2], "INVALID", "pointer"),
    ("a leading zero", ["/claim/factors/00/rank", 2], "INVALID", "pointer"),
    ("without a slash", ["claim/stabilizable", False], "INVALID", "pointer"),
    ("an escape that is none", ["/claim~2", False], "INVALID", "pointer"),
    ("into a number", ["/claim/factors/0/rank/0", 2], "INVALID", "pointer"),
    ("another value", ["/claim/stabilizable", True], "INVALID", "value"),
    ("a number for a truth value", ["/claim/stabilizable", 0], "INVALID", "value"),
    ("another rank", ["/claim/factors/0/rank", 1], "INVALID", "value"),
    ("more channels", ["/claim/factors/0/channels", ["1", "2", "3"]], "INVALID", "value"),
    ("part of an object", ["/claim/best_rate", {"lower": "-1"}], "INVALID", "value"),
    ("the whole rate", ["/claim/best_rate", {"upper": "-1", "lower": "-1"}], "IMPLIED", ""),
    ("the plant", ["/system/time", "continuous"], "IMPLIED", ""),
    ("the evidence", ["/witness/modulus", 101], "IMPLIED", ""),
    ("a set", ["/claim/factors/0/channels/1", "3"], "IMPLIED", ""),
]


@pytest.mark.parametrize(
    ("entry", "verdict", "code"), [row[1:] for row in BECAUSE], ids=[row[0] for row in BECAUSE]
)
def test_every_value_has_to_stand_where_it_is_said_to(
    tmp_path: Path, entry: list[Any], verdict: str, code: str
) -> None:
    because = [*NOT_STABILIZABLE["because"], ["fixed_spectrum.json", *entry]]
    found = one(tmp_path, NOT_STABILIZABLE | {"because": because})
    assert (found.verdict, found.code) == (verdict, code), found.line()


def test_pointers_are_escaped_as_they_should_be() -> None:
    document = {"a/b": {"m~n": [1, {"": 2}]}}
    assert pointed(document, "/a~1b/m~0n/0", "") == 1
    assert pointed(document, "/a~1b/m~0n/1/", "") == 2
    assert pointed(document, "", "") is document
    with pytest.raises(Refused):
        pointed(document, "/a/b", "")


def test_values_are_the_same_only_if_their_types_are() -> None:
    assert same({"a": [1, None]}, {"a": [1, None]})
    for a, b in ((1, True), (0, False), ("1", 1), ([1], [1, 1]), ({"a": 1}, {"a": 1, "b": 1})):
        assert not same(a, b)


def test_a_rule_that_is_not_known_is_no_reason_to_say_yes_or_no(tmp_path: Path) -> None:
    found = one(tmp_path, NOT_STABILIZABLE | {"rule": "is-nice"})
    assert (found.verdict, found.code, found.status) == ("INCOMPLETE", "rule", 5)


@pytest.mark.parametrize("theorem", ["", "extended_bound.theorem_2", "A. Nobody 1999"])
def test_the_theorem_has_to_be_that_of_the_rule(tmp_path: Path, theorem: str) -> None:
    found = one(tmp_path, NOT_STABILIZABLE | {"theorem": theorem})
    assert (found.verdict, found.code) == ("INVALID", "theorem")


def test_a_sentence_rests_on_what_could_not_be_checked_as_little_as_on_what_is_wrong(
    tmp_path: Path,
) -> None:
    evidence = {"fixed_spectrum": changed(FREE, ("kind", "is_nice"))}
    what = sentence("nothing-fixed", "fixed_spectrum", evidence=evidence)
    found = said(write(tmp_path, evidence, manifest(evidence, [what])))
    assert [v.verdict for v in found] == ["INCOMPLETE", "INCOMPLETE"]


def test_a_sentence_does_not_rest_on_what_a_bug_leaves_open(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(KINDS, "fixed_spectrum", None)
    listed = manifest(sentences=[NOT_STABILIZABLE])
    found = said(write(tmp_path, listed=listed))
    assert [v.verdict for v in found] == ["ERROR", "INVALID"]
    assert found[1].code == "premise" and found[1].place.endswith("fixed_spectrum.json")


def test_a_sentence_is_about_the_entries_that_it_points_to(tmp_path: Path) -> None:
    evidence = {"fixed_spectrum": TWO_FACTORS}
    for k, own, other in ((0, "x - 1", "x + 2"), (1, "x + 2", "x - 1")):
        because = [["fixed_spectrum.json", f"/claim/factors/{k}/channels", []]]
        what = sentence("fixed-mode-uncontrolled") | {"because": because}
        found = one(tmp_path, what, evidence)
        assert found.verdict == "IMPLIED", found.line()
        assert own in found.statement and other not in found.statement


@pytest.mark.parametrize(("first", "second"), [("a.json", "b.json"), ("b.json", "a.json")])
def test_entries_of_another_certificate_are_not_meant(
    tmp_path: Path, first: str, second: str
) -> None:
    evidence = {"a": TWO_FACTORS, "b": TWO_FACTORS}
    because = [[first, "/claim/factors/0/channels", []], [second, "/claim/factors/1/channels", []]]
    found = one(tmp_path, sentence("fixed-mode-uncontrolled") | {"because": because}, evidence)
    assert found.verdict == "IMPLIED", found.line()
    assert "x - 1" in found.statement and "x + 2" not in found.statement


@pytest.mark.parametrize("expected", [Expectation(statement="0" * 64), Expectation(claim={})])
def test_one_statement_cannot_be_expected_of_a_manifest(
    tmp_path: Path, expected: Expectation
) -> None:
    (found,) = said(write(tmp_path), expected)
    assert (found.verdict, found.code, found.place) == ("INVALID", "expected", "file")


def test_all_loops_have_the_controller_that_is_expected(tmp_path: Path) -> None:
    another = changed(LOOP, (HALF, [[-2]]), ("claim.polynomial", [3, 6, 1]))
    evidence = {"another": another, "loop": LOOP, "open": OPEN}
    listed = manifest(evidence, [sentence("heading")])
    digest_of_loop = checked(LOOP).controller_digest
    found = said(write(tmp_path, evidence, listed), Expectation(controller=digest_of_loop))
    assert [(v.verdict, v.code) for v in found] == [(NOT_ABOUT, "controller"), ("IMPLIED", "")]
    assert found[0].place == "another.json subject"
    assert [v.verdict for v in said(tmp_path)] == ["IMPLIED"]


@pytest.mark.parametrize("wrong", ["0" * 64, "f" * 64])
def test_another_digest_is_refused_whether_it_is_smaller_or_larger(
    tmp_path: Path, wrong: str
) -> None:
    found = said(write(tmp_path, listed=changed(WHOLE, ("certificates", FILES | {RING: wrong}))))
    assert (found[0].verdict, found[0].code, found[0].place) == (
        "INVALID",
        "digest",
        f"{RING} file",
    )


def test_the_digest_of_a_file_as_long_as_the_limit_is_compared(tmp_path: Path) -> None:
    write(tmp_path, listed=changed(WHOLE, ("certificates", FILES | {RING: SHA})))
    path = tmp_path / RING
    path.write_bytes(path.read_bytes().ljust(20_000))
    found = said(tmp_path, limits=Limits(bytes=20_000))[0]
    assert (found.verdict, found.code, found.place) == ("INVALID", "digest", f"{RING} file")
    found = said(tmp_path, limits=Limits(bytes=19_999))[0]
    assert (found.verdict, found.code, found.place) == ("INCOMPLETE", "size", f"{RING} file")


def test_without_a_certificate_nothing_is_known_of_the_plant(tmp_path: Path) -> None:
    found = one(tmp_path, sentence("heading"), {})
    assert (found.verdict, found.code) == ("INVALID", "premise")


# The form of a manifest.

WHOLE = manifest()
FILES = WHOLE["certificates"]
SHA = "0" * 64
FORMS: list[tuple[str, Any]] = [
    ("a certificate instead", EVIDENCE["fixed_spectrum"]),
    ("another format", changed(WHOLE, ("format", FORMAT))),
    ("a later version", changed(WHOLE, ("format", "mcexact-manifest/2"))),
    ("no sentences", changed(WHOLE, ("sentences", []))),
    ("sentences by name", changed(WHOLE, ("sentences", {"0": SENTENCES[0]}))),
    ("certificates in a list", changed(WHOLE, ("certificates", list(FILES)))),
    ("an unknown key", WHOLE | {"verified": True}),
    ("no certificates", without(WHOLE, "certificates")),
    ("a sentence without its theorem", without(WHOLE, "sentences.0.theorem")),
    ("a sentence with a verdict", changed(WHOLE, ("sentences.0.verdict", "IMPLIED"))),
    ("a rule that is a number", changed(WHOLE, ("sentences.0.rule", 7))),
    ("a premise that is not listed", changed(WHOLE, ("sentences.1.because.0.0", "setpoint.json"))),
    ("a premise of two parts", changed(WHOLE, ("sentences.1.because.0", ["a.json", "/claim"]))),
    ("a pointer that is a list", changed(WHOLE, ("sentences.1.because.0.1", ["claim"]))),
    ("a digest in capitals", changed(WHOLE, ("certificates", FILES | {"a.json": "A" * 64}))),
    ("a short digest", changed(WHOLE, ("certificates", FILES | {"a.json": "0" * 63}))),
    ("a subject that is none", WHOLE | {"subject": "the plant"}),
]
NAMES = [
    "../a.json",
    "/etc/a.json",
    "a/b.json",
    "a\\b.json",
    "..json",
    ".json",
    "a.json\n",
    "C:a.json",
]
NAMES += [
    "a\x00.json",
    "\u00e9.json",
    "manifest.json",
    "-a.json",
    "a.txt",
    "a" * 200 + ".json",
    "~a.json",
]


@pytest.mark.parametrize("listed", [row[1] for row in FORMS], ids=[row[0] for row in FORMS])
def test_a_manifest_has_the_form_of_one(tmp_path: Path, listed: Any) -> None:
    (found,) = said(write(tmp_path, listed=listed))
    assert (found.verdict, found.status) == ("MALFORMED", 3), found.line()


@pytest.mark.parametrize("name", NAMES)
def test_a_name_is_no_path(tmp_path: Path, name: str) -> None:
    (tmp_path / "a.json").write_bytes(text_of(FREE))
    listed = WHOLE | {"certificates": FILES | {name: SHA}}
    (found,) = said(write(tmp_path, listed=listed))
    assert (found.verdict, found.place) == ("MALFORMED", "certificates"), found.line()


@pytest.mark.parametrize("key", ['"sentences":', '"theorem":', '"fixed_spectrum.json":'])
def test_a_key_is_given_once(tmp_path: Path, key: str) -> None:
    text = text_of(WHOLE).decode().replace(key, f"{key}null,{key}", 1)
    (write(tmp_path) / "manifest.json").write_text(text)
    (found,) = said(tmp_path)
    assert found.verdict == "MALFORMED" and worded(found.message)


@pytest.mark.skipif(not hasattr(os, "symlink"), reason="needs symbolic links")
@pytest.mark.parametrize("inside", [True, False])
def test_no_link_is_followed(tmp_path: Path, inside: bool) -> None:
    folder = tmp_path / "evidence"
    folder.mkdir()
    write(folder)
    target = (folder if inside else tmp_path) / "elsewhere.txt"
    (folder / "fixed_spectrum.json").rename(target)
    (folder / "fixed_spectrum.json").symlink_to(target)
    found = said(folder)
    assert (found[0].verdict, found[0].code) == ("INVALID", "file")
    assert {v.verdict for v in found[1:]} == {"IMPLIED", "INVALID"}


@pytest.mark.skipif(not hasattr(os, "symlink"), reason="needs symbolic links")
def test_a_link_to_the_manifest_is_followed(tmp_path: Path) -> None:
    """The certificates are beside the link; who names it has chosen what it leads to."""
    (write(tmp_path) / "manifest.json").rename(tmp_path / "elsewhere.txt")
    (tmp_path / "manifest.json").symlink_to(tmp_path / "elsewhere.txt")
    assert {v.verdict for v in said(tmp_path)} == {"IMPLIED"}
    (tmp_path / "elsewhere.txt").unlink()
    (found,) = said(tmp_path)
    assert (found.verdict, found.code) == ("MALFORMED", "unreadable")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_a_manifest_is_a_file(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "manifest.json")
    (found,) = said(tmp_path)
    told = ("MALFORMED", "file", "a manifest is a regular file")
    assert (found.verdict, found.place, found.message) == told


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_what_is_no_file_is_not_waited_for(tmp_path: Path) -> None:
    write(tmp_path)
    (tmp_path / "fixed_spectrum.json").unlink()
    os.mkfifo(tmp_path / "fixed_spectrum.json")
    assert said(tmp_path)[0].code == "file"
    (tmp_path / "neighbor_graph.json").unlink()
    (tmp_path / "neighbor_graph.json").mkdir()
    assert [v.code for v in said(tmp_path)[:2]] == ["file", "file"]


def test_what_is_missing_or_too_large_is_not_read(tmp_path: Path) -> None:
    (found,) = said(tmp_path)
    assert (found.verdict, found.code) == ("MALFORMED", "unreadable")
    write(tmp_path)
    (found,) = said(tmp_path, limits=Limits(bytes=1000))
    assert (found.verdict, found.code) == ("INCOMPLETE", "size")
    long = WHOLE | {"sentences": [*SENTENCES, NOT_STABILIZABLE | {"text": "x" * 10**5}]}
    (found,) = said(write(tmp_path, listed=long), limits=Limits(bytes=10**5))
    assert (found.verdict, found.code) == ("INCOMPLETE", "size")


def test_a_manifest_is_granted_work_for_its_bytes_once(tmp_path: Path) -> None:
    texts = {"": (write(tmp_path) / "manifest.json").read_bytes()}
    texts |= {f"{name}.json": text_of(document) for name, document in EVIDENCE.items()}
    budget = Budget()
    with limited(budget):
        assert all(not v.status for about, v in verdicts_of(texts.get, Expectation(), Limits()))
    assert budget.usual == GRANTED + PER_BYTE * sum(map(len, texts.values()))


def test_a_verdict_on_a_certificate_names_its_file(tmp_path: Path) -> None:
    write(tmp_path)
    (tmp_path / "completeness.json").write_bytes(b"{}")
    (tmp_path / "neighbor_graph.json").unlink()
    found = [verdict for verdict in said(tmp_path) if verdict.code in {"digest", "missing"}]
    assert [v.place for v in found] == ["completeness.json file", "neighbor_graph.json file"]


def test_many_sentences_cost_no_more_than_their_length(tmp_path: Path) -> None:
    whole = ["fixed_spectrum.json", "", EVIDENCE["fixed_spectrum"] | {"kind": "other"}]
    what = NOT_STABILIZABLE | {"because": [whole, *NOT_STABILIZABLE["because"]]}
    write(tmp_path, listed=WHOLE | {"sentences": [what, NOT_STABILIZABLE] * 500})
    with effort.at_most(2 * (tmp_path / "manifest.json").stat().st_size):
        found = said(tmp_path)
    assert [v.verdict for v in found] == ["INVALID", "IMPLIED"] * 500


# Mutations.


def other_values(value: Any) -> list[Any]:
    """What to put in the place of a value."""
    if isinstance(value, bool):
        return [not value, int(value)]
    if isinstance(value, int):
        return [value + 1, str(value)]
    if isinstance(value, str):
        return [value + "x", value[1:], ""]
    return [None, 0, []]


def test_whatever_is_changed_nothing_else_is_implied(tmp_path: Path) -> None:
    """A mutant may cost an answer; an answer that it gets is one that was true before."""
    true = {verdict.statement for verdict in said(write(tmp_path))}
    mutants = 0
    for path, value in places(WHOLE):
        if path[:1] == ("certificates",) or not path:
            continue
        for other in other_values(value):
            mutants += 1
            mutant = replaced(WHOLE, path, other)
            (tmp_path / "manifest.json").write_bytes(text_of(mutant))
            found = said(tmp_path)
            assert all(v.verdict != "ERROR" for v in found), (path, other)
            assert {v.statement for v in found if v.verdict == "IMPLIED"} <= true, (path, other)
            bound = path[-1] not in {"text"} and mutant != WHOLE
            assert not bound or any(v.status for v in found), (path, other)
    assert mutants > 300
