"""Sentences about a plant with a parameter: each rule says what holds, and refuses all else."""

from __future__ import annotations

import json
import re
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from mcexact import MultiChannelSystem, ParametricSystem, analyze
from mcexact.answer import parameters as say
from mcexact.answer.account import Account
from mcexact.answer.listing import PARAMETERS, premises_of
from mcexact.answer.loops import EVERY_VALUE
from mcexact.answer.templates import templates
from mcexact.checker.kinds import check_document
from mcexact.checker.sentences import RULES
from tests.checker.manifests import Document, manifest, said, sentence, write
from tests.wording import says, worded

IDENTITY = [[[1], [0]], [[0], [1]]]
PLANTS = {
    "tanks": ParametricSystem(
        [[-1, 0], ["1 - t", -2]],
        [[["t"], ["1 - t"]], [[0], [1]]],
        [[[1, 0]], [[0, 1]]],
        parameters=["t"],
    ),
    "ring": ParametricSystem(
        [[1, "t - 2"], ["t", 2]], IDENTITY, [[[1, 0]], [[0, 1]]], parameters=["t"]
    ),
    "valve": ParametricSystem(
        [[1, 0], ["t", 2]], [[[1], [0]]] * 2, [[[0, 1]]] * 2, parameters=["t"]
    ),
    "constant": ParametricSystem(
        [[1, 1], [1, 2]], IDENTITY, [[[1, 0]], [[0, 1]]], parameters=["t"], time="discrete"
    ),
    "modes": ParametricSystem(
        [["t", 0, 0], [0, 2, 0], [0, 0, 3]],
        [[[0], ["t - 1"], [1]]],
        [[["t - 2", 1, 1]]],
        parameters=["t"],
        assume={"t": (0, None)},
    ),
    "stuck": ParametricSystem(
        [[1, 0], [0, "t"]], [[[1], [0]]], [[["t - 2", 0]]], parameters=["t"], assume={"t": (0, 2)}
    ),
    "idle": ParametricSystem([["t"]], [[[0]]], [[[0]]], parameters=["t"]),
    "wide": ParametricSystem(
        [[0, 1, 0], [0, 0, "t"], [0, 0, 0]],
        [[[0], [0], [1]], [["t + 3"], [0], [0]]],
        [[[1, 0, 0]], [[0, 0, 1]]],
        parameters=["t"],
        assume={"t": (-1, 1)},
    ),
    "near": ParametricSystem(
        [["t", 1], [0, 2]],
        [[[1], ["t"]]],
        [[[1, 0]]],
        parameters=["t"],
        assume={"t": ("3/2", 2)},
    ),
}
PLANTS["two"] = ParametricSystem(
    [[1, "a"], ["b", 2]], IDENTITY, [[[1, 0]], [[0, 1]]], parameters=["a", "b"]
)
PLANTS["two, stuck"] = ParametricSystem(
    [["a", 0], [0, "b"]], [[[1], [0]]] * 2, [[[0, "1/a"]]] * 2, parameters=["a", "b"]
)
WITHIN_RANGES = {"near": [*say.WITHIN_RANGES]}
"""The plants that are also asked about all values within ranges."""
TEMPLATES = list(templates(say))


@cache
def account(name: str) -> Account:
    """All answers about a plant."""
    plant, also = PLANTS[name], WITHIN_RANGES.get(name, [])
    return analyze(plant, also=also, channel=plant.names[0]).account


@cache
def evidence(name: str) -> dict[str, Document]:
    """The certificates, by the stem of their files."""
    parts = account(name).certificates
    return {file.removesuffix(".json"): json.loads(text) for file, text in parts.items()}


def asked(questions: tuple[str, ...], known: dict[str, Document]) -> list[str]:
    """The stems of the certificates of some questions."""
    return [stem for stem in known if re.sub(r"_\d+$", "", stem) in questions]


@pytest.mark.parametrize("name", PLANTS)
def test_a_rule_implies_its_sentence_exactly_where_it_is_said(name: str, tmp_path: Path) -> None:
    known = evidence(name)
    told = {each.template.key for each in account(name).derived}
    listed = [
        sentence(each.key, *asked(premises_of(each, PARAMETERS), known), evidence=known)
        for each in TEMPLATES
    ]
    verdicts = said(write(tmp_path, known, manifest(known, listed)))
    found = {each.key: v.verdict for each, v in zip(TEMPLATES, verdicts, strict=True)}
    assert found == {each.key: "IMPLIED" if each.key in told else "INVALID" for each in TEMPLATES}


def test_every_sentence_is_said_of_some_plant() -> None:
    told = {each.template.key for name in PLANTS for each in account(name).derived}
    assert told == {each.key for each in TEMPLATES}


def test_what_the_manifest_of_an_analysis_says_is_implied(tmp_path: Path) -> None:
    for name, text in account("stuck").files().items():
        (tmp_path / name).write_text(text)
    verdicts = said(tmp_path)
    assert {each.verdict for each in verdicts} == {"IMPLIED"} and len(verdicts) > 8


def test_the_words_name_what_is_lost_where(tmp_path: Path) -> None:
    known = evidence("ring")
    edges = asked(("transfer_graph",), known)
    keys = [
        ("parametric-heading", []),
        ("parametric-complete-unless", ["fixed_spectrum", *edges]),
        ("parametric-graph-lost", edges),
    ]
    listed = [sentence(key, *premises, evidence=known) for key, premises in keys]
    first, second, third = said(write(tmp_path, known, manifest(known, listed)))
    assert "its parameter is t, between -infinity and infinity" in first.statement
    every = "so for every complex value of the parameter t at which all entries of the plant are "
    ends = f"{every}defined, it is complete except at the roots of t - 2 and the roots of t"
    swapped = f"{every}defined, it is complete except at the roots of t and the roots of t - 2"
    assert ends in second.statement or swapped in second.statement
    assert says(third.statement, "edges except")


def test_a_value_that_is_exceptional_for_two_reasons_is_named_once(tmp_path: Path) -> None:
    known = evidence("valve")
    premises = ["fixed_spectrum", *asked(("transfer_graph",), known)]
    told = sentence("parametric-complete-unless", *premises, evidence=known)
    [verdict] = said(write(tmp_path, known, manifest(known, [told])))
    words = "it is complete except at the roots of t from fixed_spectrum.json"
    assert words in verdict.statement


EDGES = [f"transfer_graph_{k}" for k in range(1, 5)]
REFUSED: list[tuple[str, str, list[str], str]] = [
    ("ring", "parametric-controllable-always", ["fixed_spectrum"], "expected a premise"),
    ("ring", "parametric-modes-always", ["joint_controllability"], "expected a premise"),
    ("ring", "parametric-observable-always", ["joint_controllability"], "expected a premise"),
    ("ring", "parametric-channel-controllable-always", ["joint_controllability"], "a premise"),
    ("ring", "parametric-graph-lost", EDGES[:3], 'nothing is said of the edges {"2" -> "2"}'),
    ("ring", "parametric-graph-lost", [*EDGES, "setpoint"], "not about the inputs of a channel"),
    ("ring", "parametric-complete-unless", ["fixed_spectrum", *EDGES[1:]], "nothing is said"),
    ("ring", "parametric-complete-unless", ["fixed_spectrum"], "expected a premise"),
    ("ring", "parametric-setpoint-always", [EDGES[0]], "not about equilibria"),
    (
        "wide",
        "parametric-controllability-indices-unless",
        ["controllability_indices_2", "controllability_indices_3"],
        "not about 1 blocks",
    ),
    (
        "wide",
        "parametric-controllability-indices-unless",
        ["controllability_indices_1"],
        "the ranks may grow with more blocks",
    ),
    (
        "wide",
        "parametric-controllability-indices-unless",
        ["controllability_indices_1", "controllability_indices_2"],
        "the ranks may grow with more blocks",
    ),
    (
        "wide",
        "parametric-controllability-indices-unless",
        ["controllability_indices_1", "setpoint"],
        "not about 1 blocks",
    ),
    (
        "wide",
        "parametric-observability-indices-unless",
        ["controllability_indices_1"],
        "expected a premise",
    ),
    ("near", "parametric-ranges-nothing-fixed", ["box_stabilizability"], "claim is different"),
    ("near", "parametric-ranges-nothing-fixed", ["box_controllability"], "expected a premise"),
    ("near", "parametric-ranges-stabilizable", ["fixed_spectrum"], "expected a premise"),
    ("near", "parametric-ranges-controllable", ["box_observability"], "expected a premise"),
]


@pytest.mark.parametrize("name", ["ring", "wide", "near"])
def test_what_is_not_implied_is_refused_with_its_reason(name: str, tmp_path: Path) -> None:
    known = evidence(name)
    rows = [row for row in REFUSED if row[0] == name]
    listed = [sentence(key, *premises, evidence=known) for _, key, premises, _ in rows]
    verdicts = said(write(tmp_path, known, manifest(known, listed)))
    for (_, key, _, reason), verdict in zip(rows, verdicts, strict=True):
        assert verdict.verdict == "INVALID" and reason in verdict.message, (key, verdict)


def test_channels_that_are_merged_in_part_do_not_stand_for_all(tmp_path: Path) -> None:
    from mcexact.analysis.parameters.modes import parametric_fixed_spectrum
    from mcexact.answer.protocol import document
    from mcexact.derived.constructions import full_output, merged, rearranged

    plant = ParametricSystem(
        [[1, "t"], [0, 2]], [[[0], [1]], [[1], [0]], [[0], [0]]], [[[1, 0]]] * 3, parameters=["t"]
    )

    def part(plain: MultiChannelSystem) -> MultiChannelSystem:
        return full_output(merged(plain, [["1", "2"], ["3"]]), 0)

    made = document(parametric_fixed_spectrum(rearranged(plant, part)))
    known: dict[str, Any] = {"joint_controllability": json.loads(json.dumps(made))}
    keys = ["parametric-controllable-always", "parametric-controllable-unless"]
    listed = [sentence(key, "joint_controllability", evidence=known) for key in keys]
    for verdict in said(write(tmp_path, known, manifest(known, listed))):
        assert verdict.verdict == "INVALID" and "about other channels" in verdict.message


def test_indices_of_some_channels_do_not_stand_for_all(tmp_path: Path) -> None:
    from mcexact import controllability_indices
    from mcexact.answer.protocol import document

    found = controllability_indices(PLANTS["wide"], ["1"])
    known = {
        f"controllability_indices_{k}": json.loads(json.dumps(document(each)))
        for k, each in enumerate(found, 1)
    }
    listed = [sentence("parametric-controllability-indices-unless", *known, evidence=known)]
    [verdict] = said(write(tmp_path, known, manifest(known, listed)))
    assert verdict.verdict == "INVALID" and says(verdict.message, "about channels")


def test_a_plant_without_a_parameter_has_none_to_speak_of(tmp_path: Path) -> None:
    plain = analyze(PLANTS["ring"].at(5), ["fixed_spectrum"])
    known = {"fixed_spectrum": json.loads(plain.account.certificates["fixed_spectrum.json"])}
    listed = [sentence("parametric-heading"), sentence("heading")]
    first, second = said(write(tmp_path, known, manifest(known, listed)))
    assert first.verdict == "INVALID" and "no parameter" in first.message
    assert second.verdict == "IMPLIED"


OF_PLAIN_PLANTS = ("heading", "inactive-channels", "picture-neighbor-graph")


@pytest.mark.parametrize("parameters", [["t"], ["t", "u"]])
def test_what_is_said_of_a_plant_is_not_said_of_one_with_parameters(
    parameters: list[str], tmp_path: Path
) -> None:
    plant = ParametricSystem(
        [["t"]], [[[1]]], [[[1]]], parameters=parameters, assume=dict.fromkeys(parameters, (1, 2))
    )
    text = analyze(plant, ["box_fixed_modes"]).account.certificates["box_fixed_modes.json"]
    known = {"box_fixed_modes": json.loads(text)}
    listed = [sentence(key) for key in OF_PLAIN_PLANTS]
    for verdict in said(write(tmp_path, known, manifest(known, listed))):
        assert verdict.verdict == "INVALID" and worded(verdict.message)


def test_every_rule_has_a_sentence() -> None:
    said = {template.key for template in (*TEMPLATES, EVERY_VALUE)}
    assert {key for key in RULES if key.startswith("parametric-")} == said


def test_what_holds_within_ranges_of_several_parameters_has_a_manifest(tmp_path: Path) -> None:
    """Certificates along lines, and about ranges, are about one plant and in one manifest."""
    plant = ParametricSystem(
        [["a", 1], [0, "b"]],
        [[[1], [0]], [[0], [1]]],
        [[[1, 0]], [[0, 1]]],
        parameters=["a", "b"],
        assume={"a": ("3/2", 2), "b": (3, "7/2")},
    )
    found = analyze(plant, also=["box_controllability"]).account
    for name, text in found.files().items():
        (tmp_path / name).write_text(text)
    assert {path.stem for path in tmp_path.iterdir()} >= {"manifest", "fixed_spectrum_1"}
    verdicts = [*said(tmp_path)]
    assert {each.verdict for each in verdicts} == {"IMPLIED"}
    rules = [each["rule"] for each in found.manifest()["sentences"]]
    assert rules == [each["rule"] for each in found.as_json()["sentences"]]
    first, second, third = (
        verdict
        for verdict, key in zip(verdicts, rules, strict=True)
        if key.startswith("parametric-ranges-")
    )
    assert says(first.statement, "real parameter")
    assert says(second.statement, "stabilized some")
    assert says(third.statement, "together control")
    assert [key for key in rules if "ranges" in key] == [
        f"parametric-ranges-{way}" for way in ("nothing-fixed", "stabilizable", "controllable")
    ]


def test_values_with_a_common_root_do_not_hide_that_edges_vanish_together(tmp_path: Path) -> None:
    """For t = 1 the channel 1 reaches no other: 2 not for the roots 1 and 2, 3 not for 1."""
    plant = ParametricSystem(
        [[1, 0, 0], [0, 2, 0], [0, 0, 3]],
        [[[1], [0], [0]], [[0], [1], [0]], [[0], [0], [1]]],
        [[[1, 1, 1]], [["(t - 1)*(t - 2)", 1, 1]], [["t - 1", 1, 1]]],
        parameters=["t"],
    )
    parts = analyze(plant, ["completeness"]).account.certificates
    known = {name.removesuffix(".json"): json.loads(text) for name, text in parts.items()}
    edges = asked(("transfer_graph",), known)
    keys = ["parametric-complete-always", "parametric-complete-unless"]
    listed = [sentence(key, "fixed_spectrum", *edges, evidence=known) for key in keys]
    first, second = said(write(tmp_path, known, manifest(known, listed)))
    assert (first.verdict, second.verdict) == ("INVALID", "IMPLIED")
    assert says(second.statement, "complete except")
    [edge] = [known[name] for name in edges if len(known[name]["claim"]["exceptional"]) == 2]
    discs = [each["roots"][0] for each in edge["claim"]["exceptional"]]
    edge["claim"]["exceptional"] = [{"value": [2, -3, 1], "roots": discs, "rank": 0}]
    del edge["witness"]["exceptional"][1:]
    for name in edges:
        assert check_document(json.dumps(known[name]).encode()).verdict == "VALID"
    listed = [sentence(key, "fixed_spectrum", *edges, evidence=known) for key in keys]
    for verdict in said(write(tmp_path, known, manifest(known, listed))):
        assert verdict.verdict == "INVALID" and "some roots of a value alone" in verdict.message


BEYOND = ParametricSystem(
    [[1, "t - 2"], ["t", 2]],
    [[[1], [0]], [[0], ["t - 3"]]],
    [[[1, 0]], [[0, 1]]],
    parameters=["t"],
    assume={"t": (5, 6)},
)
"""Beyond the range one edge vanishes at 2, another at 0, and nothing is controlled at 3."""


def test_what_several_certificates_imply_is_about_the_values_that_all_are_about(
    tmp_path: Path,
) -> None:
    found = analyze(BEYOND).account
    for name, text in found.files().items():
        (tmp_path / name).write_text(text)
    verdicts = [*said(tmp_path)]
    rules = [each["rule"] for each in found.manifest()["sentences"]]
    known = {name: json.loads(text) for name, text in found.certificates.items()}
    for rule, stems in (
        ("parametric-complete-always", ("fixed_spectrum", "transfer_graph_")),
        ("parametric-graph-always", ("transfer_graph_",)),
        ("parametric-controllability-indices-always", ("controllability_indices_",)),
    ):
        verdict = verdicts[rules.index(rule)]
        conclusion = verdict.statement.rpartition("; so ")[2]
        assert verdict.verdict == "IMPLIED" and "between 5 and 6, " in conclusion
        parts = [each for name, each in known.items() if name.startswith(stems)]
        outside = {
            json.dumps(entry["value"]) for each in parts for entry in each["claim"]["outside"]
        }
        words = {json.dumps([-k, 1]): f"roots of t - {k}," for k in (2, 3)} | {
            json.dumps([0, 1]): "roots of t,"
        }
        assert outside and outside <= words.keys()
        assert {value for value, word in words.items() if word in conclusion} == outside
    graph = [known[f"transfer_graph_{k}.json"]["claim"]["outside"] for k in range(1, 5)]
    assert len({json.dumps(each) for each in graph}) > 1


LINES: list[tuple[str, str, list[str], str]] = [
    ("two, stuck", "parametric-almost-nothing-fixed", ["fixed_spectrum_1"], "claim is different"),
    ("two, stuck", "parametric-almost-setpoint", ["setpoint_1"], "claim is different"),
    ("two, stuck", "parametric-almost-complete", ["fixed_spectrum_1", "transfer_graph_1"], "claim"),
    ("two, stuck", "parametric-almost-controllable", ["fixed_spectrum_1"], "expected a premise"),
    ("two, stuck", "parametric-modes-some", ["fixed_spectrum_1"], "expected a premise"),
    ("two, stuck", "parametric-complete-never", ["fixed_spectrum_1", "transfer_graph_1"], "expect"),
    ("two", "parametric-almost-complete", ["fixed_spectrum_1", "transfer_graph_1"], "different"),
    ("two", "parametric-almost-graph", ["setpoint_1"], "not about the inputs of a channel"),
    ("two", "parametric-almost-setpoint", ["transfer_graph_1"], "not about equilibria"),
    ("two", "parametric-almost-observable", ["joint_controllability_1"], "expected a premise"),
    ("two", "parametric-line-graph", ["setpoint_1"], "claim is different"),
    ("two", "parametric-setpoint-always", ["setpoint_1"], "expected a premise"),
    ("two", "parametric-graph-lost", ["transfer_graph_1"], "expected a premise"),
]


@pytest.mark.parametrize("name", ["two", "two, stuck"])
def test_a_line_implies_no_more_than_what_a_point_of_it_shows(name: str, tmp_path: Path) -> None:
    known = evidence(name)
    rows = [row for row in LINES if row[0] == name]
    listed = [sentence(key, *premises, evidence=known) for _, key, premises, _ in rows]
    verdicts = said(write(tmp_path, known, manifest(known, listed)))
    for (_, key, _, reason), verdict in zip(rows, verdicts, strict=True):
        assert verdict.verdict == "INVALID" and reason in verdict.message, (key, verdict)


@pytest.mark.parametrize("name", ["two", "two, stuck"])
def test_all_certificates_along_lines_are_in_the_manifest(name: str, tmp_path: Path) -> None:
    found = account(name)
    for file, text in found.files().items():
        (tmp_path / file).write_text(text)
    verdicts = [*said(tmp_path)]
    assert {each.verdict for each in verdicts} == {"IMPLIED"}
    told = found.manifest()["sentences"]
    on_lines = {e[0] for each in told if "-line-" in each["rule"] for e in each["because"]}
    assert on_lines == found.certificates.keys()
    for each, verdict in zip(told, verdicts, strict=True):
        if each["rule"].startswith("parametric-almost-"):
            assert says(verdict.statement, "almost complex")


def test_a_restriction_to_some_channels_says_nothing_of_all_on_a_line(tmp_path: Path) -> None:
    known = dict(evidence("two"))
    known["joint_controllability_1"] = known["channel_controllability_1"]
    keys = ["parametric-almost-controllable", "parametric-line-controllable"]
    listed = [sentence(key, "joint_controllability_1", evidence=known) for key in keys]
    for verdict in said(write(tmp_path, known, manifest(known, listed))):
        assert verdict.verdict == "INVALID" and "expected a premise" in verdict.message
