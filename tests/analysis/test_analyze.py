"""Everything about one system: asked for lazily, decided once, and nothing slow unless named."""

import inspect
import time
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import mcexact
from mcexact.analysis.analyze import Analysis, analyze
from mcexact.analysis.questions import (
    QUESTIONS,
    Question,
    questions_about,
)
from mcexact.checker.command import manifest_verdicts
from mcexact.checker.core.reading import Limits
from mcexact.checker.kinds import Expectation
from mcexact.derived.constructions import dual
from mcexact.errors import InputError, LimitReached, UsageError
from mcexact.model import gallery
from mcexact.model.box import Box
from mcexact.model.graph import NeighborGraph
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from tests.public import PUBLIC
from tests.wording import refusal, says, worded

PAPER = gallery.load("liu2020-3ch-no-communication")
RING = PAPER.with_neighbors(NeighborGraph.ring(PAPER.names))
ANY = Expectation()
NP_HARD = {
    "minimal_shared_dimensions_outputs_states",
    "minimal_shared_dimensions_states",
    "minimal_communication",
}


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The functions that are called, by name."""
    made: list[str] = []
    decide = Question.decide

    def counted(self: Question, *arguments: Any, **keywords: Any) -> Any:
        made.append(self.function)
        return decide(self, *arguments, **keywords)

    monkeypatch.setattr(Question, "decide", counted)
    return made


def test_nothing_is_decided_before_it_is_looked_at_and_nothing_twice(calls: list[str]) -> None:
    found = analyze(RING)
    assert calls == []
    assert found.completeness is found["completeness"]
    assert calls == ["completeness", "fixed_spectrum"] or calls == [
        "fixed_spectrum",
        "completeness",
    ]
    found.decided()
    found.decided()
    assert len(calls) == len(found.asked)


def test_nothing_np_hard_is_asked_unless_it_is_named(calls: list[str]) -> None:
    analyze(RING, subset=["1"], channel="2").decided()
    assert not {"minimal_shared_dimensions", "minimal_communication"} & set(calls)
    assert not NP_HARD & {name for name, question in QUESTIONS.items() if question.by_default}


def test_a_question_that_is_named_alone_is_asked_alone() -> None:
    assert analyze(RING, ["joint_observability"]).decided().keys() == {"joint_observability"}
    found = analyze(RING, ["joint_observability"], also=["minimal_communication"])
    assert found.decided().keys() == {"joint_observability", "minimal_communication"}


def test_what_another_answer_takes_is_among_the_answers() -> None:
    answers = analyze(PAPER, ["pencil_rank"], subset=["2", "3"]).decided()
    assert list(answers) == ["spectrum_of_A", "pencil_rank_1"]
    assert answers["pencil_rank_1"].rank == 2


def test_a_question_is_about_what_the_agents_receive_or_about_the_plant() -> None:
    found = analyze(RING, information="outputs")
    assert found.system.subject == found.fixed_spectrum.subject != ()
    assert found.setpoint.subject == ()


def test_a_limit_leaves_a_question_open_and_the_others_answered(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def ended(self: Question, *arguments: Any, **keywords: Any) -> Any:
        raise LimitReached("too many nodes")

    found = analyze(PAPER, ["fixed_spectrum", "minimal_communication"])
    assert not found.fixed_spectrum.empty
    monkeypatch.setattr(Question, "decide", ended)
    assert found.decided().keys() == {"fixed_spectrum"}
    assert found.open().keys() == {"minimal_communication"}
    with pytest.raises(LimitReached):
        found.minimal_communication  # noqa: B018


def test_indices_of_long_chains_are_asked_by_default() -> None:
    n = 101
    chain = [[int(i == j + 1) for j in range(n)] for i in range(n)]
    first = [[int(i == 0)] for i in range(n)]
    found = analyze(MultiChannelSystem(chain, [first], [[[1] * n]]), nearby=False)
    assert found.left_out == {}
    assert found.controllability_indices.index == n
    assert mcexact.check(found.controllability_indices).valid


def test_a_question_that_takes_long_says_so_before_it_starts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    lines: list[str] = []
    plant = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [1]]], [[[1, 1]]])
    names = ("setpoint", "controllability_indices")
    fewer = dict(QUESTIONS) | {name: replace(QUESTIONS[name], most=1) for name in names}
    monkeypatch.setattr(Analysis, "questions", fewer)
    found = analyze(plant, nearby=False, progress=lines.append)
    assert set(found.left_out) == {"setpoint", "controllability_indices"}
    assert found.setpoint.solvable
    said = [line for line in lines if "takes long" in line]
    assert len(said) == 1 and "more than 1 states" in said[0] and "setpoint" in said[0]


def test_every_question_is_listed_with_its_seconds_or_why_it_is_left_out(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    found = analyze(PAPER)
    told = found.to_dict()["questions"]
    for_fixed_modes = {"quotient_fixed_spectrum", "structural_fixed_modes"}
    for_fixed_modes |= {"minimal_communication"}
    usual = [name for name in found.asked if name not in for_fixed_modes]
    assert usual == list(found.by_default)
    assert [each["question"] for each in told] == list(found.asked)
    assert all(each["outcome"] == "decided" and each["seconds"] >= 0 for each in told)
    fewer = dict(QUESTIONS) | {"setpoint": replace(QUESTIONS["setpoint"], most=2)}
    monkeypatch.setattr(Analysis, "questions", fewer)
    small = analyze(PAPER)
    reason = "more than 2 states, of which it needs dense matrices"
    assert small.left_out == {"setpoint": reason}
    [left] = [each for each in small.to_dict()["questions"] if each["outcome"] != "decided"]
    expected = {"question": "setpoint", "outcome": "left out", "seconds": 0.0, "reason": reason}
    assert left == expected
    asked = analyze(PAPER, also=["setpoint"])
    assert {each.outcome for each in asked.effort()} == {"decided"}
    assert asked.setpoint == found.setpoint


@pytest.mark.parametrize(
    ("n", "width", "asked"), [(101, 1, True), (1500, 2, True), (1501, 500, False)]
)
def test_indices_are_asked_of_as_many_states_as_set_points(n: int, width: int, asked: bool) -> None:
    system = SimpleNamespace(n=n, sizes=((width, 1),), A=SimpleNamespace(is_sparse=False))
    reason = QUESTIONS["controllability_indices"].reason_to_leave_out(system)
    assert (reason == "") == asked
    assert QUESTIONS["setpoint"].reason_to_leave_out(system) == reason
    assert QUESTIONS["fixed_spectrum"].reason_to_leave_out(system) == ""
    sparse = SimpleNamespace(n=n, sizes=((width, 1),), A=SimpleNamespace(is_sparse=True))
    for name in ("setpoint", "controllability_indices", "observability_indices"):
        assert QUESTIONS[name].reason_to_leave_out(sparse) == ""


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"information": "outputs"}, "add 'neighbors' to the file"),
        ({"also": ["minimal_shared_dimensions_states"]}, "add 'neighbors' to the file"),
        ({"questions": ["pencil_rank"]}, "'pencil_rank' is about a set of channels: give subset="),
        ({"questions": ["channel_gains_both"]}, "is about one channel: give channel="),
        ({"questions": ["completness"]}, "there is no question 'completness'"),
        ({"information": "all"}, '"own" or "outputs"'),
        ({"questions": "completeness"}, "questions: expected a list of names"),
        ({"also": "completeness"}, "also: expected a list of names"),
        ({"subset": "12"}, "subset: expected a list of names, found '12': write .'12'."),
    ],
)
def test_what_makes_no_sense_is_refused_before_the_work(given: dict[str, Any], said: str) -> None:
    with pytest.raises((InputError, UsageError), match=said):
        analyze(PAPER, **given)


def test_a_question_that_cannot_be_decided_does_not_stop_the_others() -> None:
    found = analyze(PAPER.with_neighbors(NeighborGraph.ring(PAPER.names)), ["fixed_spectrum"])
    with pytest.raises(UsageError, match="discrete time only"):
        found["lifted_fixed_spectrum"]
    assert "lifted_fixed_spectrum" not in found.asked
    assert found.sentences.at("answer")


def test_a_name_that_is_no_question_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'spectra'"):
        analyze(PAPER).spectra  # noqa: B018
    assert set(QUESTIONS) <= set(dir(analyze(PAPER)))


TABLES = [questions_about(names) for names in ((), ("s",), ("s", "t"))]


@pytest.mark.parametrize(
    ("table", "name"), [(table, name) for table in TABLES for name in sorted(table)]
)
def test_every_question_has_a_function_that_takes_what_the_table_gives_it(
    table: dict[str, Question], name: str
) -> None:
    question = table[name]
    module = __import__(f"mcexact.analysis.{question.module}", fromlist=[question.function])
    taken = inspect.signature(getattr(module, question.function)).parameters
    needed = {question.needs} - {"", "neighbors", "uncertainty"}
    assert {*question.keywords, *question.reuses, *question.shares, *needed} <= set(taken)
    assert {*question.reuses.values(), *question.shares.values()} <= set(table)


def test_the_questions_about_a_plant_depend_on_the_number_of_its_parameters() -> None:
    assert TABLES[0] is QUESTIONS and TABLES[2] is questions_about(("s", "t", "u"))
    assert set(TABLES[1]) == set(TABLES[2]) < set(QUESTIONS)
    within = [name for name, question in QUESTIONS.items() if question.needs == "uncertainty"]
    asked = [[name for name in table if table[name].by_default] for table in TABLES]
    assert [name for name in within if name in asked[0]] == within
    assert [name for name in within if name in asked[1]] == []
    assert [name for name in within if name in asked[2]] == within[:2]


def test_answers_for_all_values_are_saved_and_have_rows(tmp_path: Path) -> None:
    analysis = analyze(PARAMETRIC)
    analysis.save(tmp_path)
    verdicts = {each.verdict for _, each in manifest_verdicts(str(tmp_path), ANY, Limits())}
    assert "VALID" in verdicts and verdicts <= {"VALID", "IMPLIED", "REMARK"}
    assert [row["question"] for row in analysis.to_rows()] == list(analysis.account.parts)


def test_every_question_is_answered_by_a_public_function() -> None:
    functions = {question.function for question in QUESTIONS.values()} - {"neighbor_graph"}
    assert functions | {"analyze"} <= set(PUBLIC)
    assert isinstance(mcexact.analyze(PAPER), Analysis)


def test_what_is_saved_is_what_the_checker_verifies(tmp_path: Path) -> None:
    analyze(RING).save(tmp_path / "new" / "evidence")
    found = manifest_verdicts(str(tmp_path / "new" / "evidence"), ANY, Limits())
    said = [verdict.verdict for _, verdict in found]
    assert set(said) == {"VALID", "IMPLIED", "REMARK"}
    claimed = [each.template.claims for each in analyze(RING).sentences]
    assert said.count("IMPLIED") == sum(claimed) > 0
    assert said.count("REMARK") == len(claimed) - sum(claimed) > 0


def test_the_line_of_an_analysis_is_short() -> None:
    for name in gallery.names():
        assert len(repr(analyze(gallery.load(name)))) < 200


@pytest.mark.parametrize(
    "call",
    [
        lambda plant: mcexact.analyze("plant.json"),  # type: ignore[arg-type]
        lambda plant: mcexact.analyze(None, information="outputs"),
        lambda plant: mcexact.certify_controller(plant, None),
        lambda plant: mcexact.save_certificate(3, "answer.json"),  # type: ignore[arg-type]
    ],
)
def test_an_argument_of_another_type_is_named(call: Callable[[MultiChannelSystem], Any]) -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    with pytest.raises(mcexact.InputError, match=r"\w+: expected an? \w+, found \w+"):
        call(plant)


@pytest.mark.parametrize("unknown", [{"channel": "nowhere"}, {"subset": ["1", "nowhere"]}])
def test_an_unknown_channel_is_refused_at_once(unknown: dict[str, Any]) -> None:
    with refusal(UsageError):
        analyze(PAPER, **unknown)


def endless(*_: Any, **__: Any) -> None:
    """A question that takes for ever."""
    time.sleep(10**6)


PARAMETRIC = ParametricSystem([[1, "t"], [0, 2]], [[[0], [1]]], [[[1, 0]]], parameters=["t"])
INDICES = "mcexact.analysis.controllability.controllability_indices"


def test_a_limit_on_time_keeps_what_was_decided(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(INDICES, endless)
    lines: list[str] = []
    found = analyze(gallery.load("hidden-triple-mode"), timeout=8, progress=lines.append)
    assert found.fixed_spectrum.polynomial.degree == 1
    outcomes = {each.question: (each.outcome, each.reason) for each in found.effort()}
    undecided = {name for name, (outcome, _) in outcomes.items() if outcome == "open"}
    assert undecided == {"controllability_indices", "observability_indices"}
    ((ended, left),) = found.ended().items()
    assert worded(ended, "ended") and "8 s" in ended and left == sorted(undecided)
    assert "not decided" in found.explain() and "not decided" in found._repr_html_()
    assert not [each for each in found.sentences if "left-out" in each.template.key]
    with pytest.raises(LimitReached, match="time limit of 8 s"):
        _ = found.controllability_indices
    assert worded(lines[-1])
    found.save(tmp_path)
    assert {path.stem for path in tmp_path.iterdir()} == {
        "manifest",
        *(name for name, (outcome, _) in outcomes.items() if outcome == "decided"),
    }
    monkeypatch.undo()
    again = analyze(PARAMETRIC, timeout=100)
    assert [str(each) for each in again.sentences] == [
        str(each) for each in analyze(PARAMETRIC).sentences
    ]


def test_answers_with_a_limit_are_those_without() -> None:
    for name in ("liu2020-3ch-no-communication", "compleib-dis2"):
        plant = gallery.load(name)
        limited, free = analyze(plant, timeout=100), analyze(plant)
        assert limited.decided() == free.decided()
        assert limited.account.certificates == free.account.certificates


def test_what_was_ended_is_told_to_be_open_for_its_own_reason() -> None:
    """It is no question that was left out, and none of which no proof was found."""
    plant = Box.relative(gallery.load("compleib-dis2"), Fraction(1, 1000)).system
    found = analyze(plant)
    found.leave_open("the work was interrupted")
    assert found.account.open == [] and found.account.leading == () and found.failing() == {}


@pytest.mark.parametrize(
    ("arguments", "where"),
    [
        ({"timeout": "a day"}, "timeout"),
        ({"timeout": -1}, "timeout"),
        ({"progress": 1}, "progress"),
    ],
)
def test_a_limit_that_is_no_time_is_refused(arguments: dict[str, Any], where: str) -> None:
    for plant in (gallery.load("compleib-dis2"), PARAMETRIC):
        with pytest.raises(UsageError, match=where):
            analyze(plant, **arguments)


def test_a_view_about_observability_does_not_speak_of_controllability() -> None:
    found = analyze(gallery.load("compleib-cse1"), ["joint_controllability", "joint_observability"])
    views = [found[name].to_dict() for name in found.asked]
    assert [each.get("controllable") for each in views] == [True, None]
    assert [each.get("observable") for each in views] == [None, False]
    assert views[0]["uncontrollable_polynomial"] == [1]
    unobservable = found.joint_observability.uncontrollable_polynomial
    assert views[1]["unobservable_polynomial"] == [*unobservable.coefficients]


def canal(neighbors: dict[str, list[str]] | None) -> MultiChannelSystem:
    """A pond that the gate fills and only the farm observes."""
    return MultiChannelSystem(
        [["-1/2", 0, 0], ["1/10", 0, 0], [0, "1/20", "-1/5"]],
        [[["1/2"], [0], [0]], [[0], [0], ["1/10"]]],
        [[[1, 0, 0]], [[0, 1, 0], [0, 0, 1]]],
        names=["gate", "farm"],
        neighbors=neighbors,
    )


@pytest.mark.parametrize(
    ("neighbors", "rules"),
    [
        (None, ["not-stabilizable", "links", "no-causal-control"]),
        ({"gate": [], "farm": []}, ["not-stabilizable", "no-causal-control"]),
        ({"gate": ["farm"]}, ["nothing-fixed", "not-stabilizable"]),
        (
            {"farm": ["gate"]},
            ["not-stabilizable", "not-stabilizable", "stays-shared", "links-beside-graph"],
        ),
    ],
)
def test_what_the_links_of_a_plant_change_about_fixed_modes_leads(
    neighbors: dict[str, list[str]] | None, rules: list[str], tmp_path: Path
) -> None:
    found = analyze(canal(neighbors))
    said = found.sentences.at("answer")
    assert [each.template.key for each in said] == rules
    linked = "no-causal-control" not in rules
    assert ("linked_fixed_spectrum" in found.decided()) == linked
    if linked:
        assert {name for name, *_ in said[0].because} == {"linked_fixed_spectrum.json"}
        other = analyze(canal(neighbors), information="outputs").fixed_spectrum
        assert found.linked_fixed_spectrum.polynomial == other.polynomial
    found.save(tmp_path)
    verdicts = list(manifest_verdicts(str(tmp_path), ANY, Limits()))
    assert {verdict.verdict for _, verdict in verdicts} <= {"VALID", "IMPLIED", "REMARK"}


def test_links_are_not_asked_about_where_nothing_is_fixed_or_questions_are_chosen() -> None:
    free = MultiChannelSystem([[1]], [[[1]], [[1]]], [[[1]], [[1]]], neighbors={"1": ["2"]})
    assert "linked_fixed_spectrum" not in analyze(free).decided()
    chosen = analyze(canal({"gate": ["farm"]}), ["fixed_spectrum"])
    assert list(chosen.decided()) == ["fixed_spectrum"]


FLOATS = [["-0.30000000000000004", "0.7"], ["0.3", "-0.7"]]


def test_a_plant_that_rounding_errors_explain_leads_the_answer_and_has_a_certificate(
    tmp_path: Path,
) -> None:
    plant = MultiChannelSystem(FLOATS, [[["0.1"], ["-0.1"]]], [[[1, 0]]])
    found = analyze(plant)
    first = found.sentences.at("answer")[0]
    assert first.template.key == "nearby-unstable"
    assert found.fixed_spectrum.empty and found.nearby.get("unstable") is not None
    assert str(first) == found.explain().splitlines()[1]
    view = found.to_dict()
    assert view["nearby"]["plants"][0]["lost"] == "unstable"
    assert view["nearby_unstable"]["rank"] == 1
    found.save(tmp_path)
    assert check_manifest(tmp_path) == {"VALID", "IMPLIED", "REMARK"}


def test_plants_nearby_are_left_out_where_that_is_asked_and_it_is_said() -> None:
    plant = MultiChannelSystem(FLOATS, [[["0.1"], ["-0.1"]]], [[[1, 0]]])
    found = analyze(plant, nearby=False)
    assert not any(each.template.key.startswith("nearby-") for each in found.sentences)
    assert "nearby" not in found.to_dict()
    *_, last = found.effort()
    assert (last.question, last.outcome) == ("nearby_plants", "left out") and last.reason
    assert found.nearby.plants  # it can still be asked for


def test_the_search_has_a_time_limit_of_its_own_and_says_when_it_ended() -> None:
    found = analyze(MultiChannelSystem(FLOATS, [[["0.1"], ["-0.1"]]], [[[1, 0]]]))
    found.nearby_seconds = 0.0
    assert not found.nearby.plants and says(found.nearby.ended, "limit search")
    *_, last = found.effort()
    assert (last.question, last.outcome) == ("nearby_plants", "open") and last.reason
    fixed = analyze(MultiChannelSystem([[1, 2], [4, -1]], [[[1], [0]]], [[[1, -1]]]))
    fixed.nearby_seconds = 0.0
    assert fixed.fixed_spectrum.factors and fixed.why_fixed_left_out
    assert "why_fixed" not in fixed.to_dict()
    assert [each.question for each in fixed.effort()][-1] == "why_fixed"


def test_beside_a_plant_of_short_exact_entries_nothing_is_looked_for() -> None:
    found = analyze(MultiChannelSystem([["1/3", 2], ["0.5", 1]], [[[1], [0]]], [[[1, 1]]]))
    assert found.nearby.searched == () and not found.nearby_left_out


def test_a_derived_system_and_agents_that_hear_others_have_no_plants_nearby() -> None:
    plant = MultiChannelSystem(
        FLOATS, [[["0.1"], ["-0.1"]]] * 2, [[[1, 0]]] * 2, neighbors={"1": ["2"], "2": ["1"]}
    )
    for found in (analyze(dual(plant)), analyze(plant, information="outputs")):
        assert found.nearby_left_out and "nearby" not in found.to_dict()


def check_manifest(folder: Path) -> set[str]:
    """The verdicts on the certificates and sentences of a folder."""
    return {each.verdict for _, each in manifest_verdicts(str(folder), Expectation(), Limits())}
