"""The construction ``periodic_loop``: phases in order, of agents that use their own outputs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from mcexact.checker.constructions import read_subject
from mcexact.checker.core.reading import Limits
from mcexact.checker.core.system import read_plant
from mcexact.checker.kinds import Expectation, check_document
from tests.checker.handmade import Document, certificate, changed, checked
from tests.checker.manifests import manifest, said, sentence, write
from tests.checker.tables import accepts, rejects

PLANT: Document = {
    "time": "discrete",
    "A": [["11/10", 0, 0], [0, "1/2", 0], [0, 0, 0]],
    "channels": [
        {"name": "1", "B": [[1], [0], [0]], "C": [[0, 1, 1]]},
        {"name": "2", "B": [[0], [6], [-11]], "C": [[1, 0, 0]]},
    ],
}
"""x_1 is 11/10 x_1 + u_1, and channel 1 measures what u_2 does to x_2 + x_3."""


def agent(name: str, gain: Any = None, **more: Any) -> Document:
    """An agent without states whose input is a gain times its output."""
    control = {} if gain is None else {"outputs": {name: [[gain]]}}
    own = {"shared": 0, "private": 0, "shared_update": {}, "private_update": {}}
    return {"name": name, **own, "input": control, **more}


def phase(*agents: Document) -> Document:
    return {"time": "discrete", "agents": list(agents)}


def over(*phases: Document) -> Document:
    return {"construction": "periodic_loop", "phases": list(phases)}


def claimed(bound: Any, stable: bool, *subject: Document, system: Document = PLANT) -> Document:
    claim = {"bound": bound, "stable": stable}
    return certificate("stability", system, claim, {"method": "polynomial"}, *subject)


ODD, EVEN, IDLE = (
    phase(agent("1", 1), agent("2")),
    phase(agent("1"), agent("2", "121/500")),
    phase(agent("1"), agent("2")),
)
REMEMBERS = phase(
    agent("1", 1, private=1, private_update={"outputs": {"1": [[1]]}}), agent("2", "121/500")
)
"""Agent 1 remembers its output for a step, which changes nothing of the plant."""
GAINS = claimed(None, True, over(EVEN, ODD))
FAST = claimed("3/4", True, over(EVEN, ODD))
"""x³ − x²/4 − 363x/1000: the roots are 0 and some 0.74 and −0.49."""
RING = {**PLANT, "neighbors": {"1": ["2"], "2": ["1"]}}
HEARS = phase(agent("1", 1), agent("2", input={"outputs": {"1": [[0]]}}))
FOUR = over(EVEN, ODD, IDLE, IDLE)

ACCEPTED = [
    ("gains of period 2", GAINS),
    ("they are stable from the other phase on, too", claimed(None, True, over(ODD, EVEN))),
    ("a radius of the period", FAST),
    ("a smaller radius that they do not have", claimed("7/10", False, over(EVEN, ODD))),
    ("the period twice", claimed("9/16", True, over(EVEN, ODD, EVEN, ODD))),
    ("no gains at all", claimed(None, False, over(IDLE))),
    ("two idle steps more, which undo a part of it", claimed(None, True, FOUR)),
    ("one phase alone is not stable", claimed(None, False, over(EVEN))),
    ("a state of an agent", claimed(None, False, over(REMEMBERS, REMEMBERS))),
    ("links of the plant, which nobody uses", claimed(None, True, over(EVEN, ODD), system=RING)),
    ("a signal of another agent times 0", claimed(None, True, over(EVEN, HEARS), system=RING)),
    (
        "behind another construction",
        claimed(None, True, {"construction": "dual"}, over(EVEN, ODD)),
    ),
]

SLOW, UNSTABLE = claimed("1/2", False, over(EVEN, ODD)), claimed(None, False, over(IDLE))
SAID = [GAINS, FAST, SLOW, UNSTABLE, claimed("1/2", False, over(IDLE))]
"""What sentences follow from."""

PHASES = "subject.0.phases"
FIRST = f"{PHASES}.0.agents.0"
SECOND = f"{PHASES}.0.agents.1"
NOT = "INVALID"
BAD = "MALFORMED"
OF_OTHER = {"outputs": {"1": [[1]]}}
REJECTED = [
    ("a phase is missing", GAINS, (PHASES, [EVEN]), NOT),
    ("the other phase is missing", GAINS, (PHASES, [ODD]), NOT),
    ("a phase more", GAINS, (PHASES, [EVEN, ODD, ODD]), NOT),
    ("the phases permuted", claimed(None, True, FOUR), (PHASES, [EVEN, IDLE, ODD, IDLE]), NOT),
    ("no phases", GAINS, (PHASES, []), BAD),
    ("a radius of one step for that of a period", FAST, ("claim.bound", "9/16"), NOT),
    ("unstable", GAINS, ("claim.stable", False), NOT),
    ("another gain", GAINS, (f"{SECOND}.input.outputs.2", [[1]]), NOT),
    ("an agent that hears another one", GAINS, (f"{SECOND}.input", OF_OTHER), NOT),
    (
        "an agent that hears another one over a link",
        claimed(None, True, over(EVEN, ODD), system=RING),
        (f"{SECOND}.input.outputs.1", [["1/1000"]]),
        NOT,
    ),
    (
        "an agent that shares a state",
        GAINS,
        ((f"{FIRST}.shared", 1), (f"{FIRST}.shared_update", {"outputs": {"1": [[1]]}})),
        NOT,
    ),
    ("an agent that holds a signal", GAINS, (f"{FIRST}.hold", {"1": 1}), NOT),
    ("an agent with a set-point", GAINS, (f"{FIRST}.input", {"reference": [[1]]}), NOT),
    ("a state in one phase alone", GAINS, (f"{FIRST}.private", 1), NOT),
    (
        "states of another agent",
        GAINS,
        ((f"{FIRST}.private", 1), (f"{PHASES}.1.agents.1.private", 1)),
        NOT,
    ),
    ("a phase in continuous time", GAINS, (f"{PHASES}.1.time", "continuous"), NOT),
    ("a plant in continuous time", GAINS, ("system.time", "continuous"), NOT),
    (
        "plant and phases in continuous time",
        GAINS,
        (
            ("system.time", "continuous"),
            (f"{PHASES}.0.time", "continuous"),
            (f"{PHASES}.1.time", "continuous"),
            ("claim.stable", False),
        ),
        NOT,
    ),
    ("agents in another order", GAINS, (f"{PHASES}.0", phase(agent("2"), agent("1"))), NOT),
    ("an agent is missing", GAINS, (f"{PHASES}.0", phase(agent("1"))), NOT),
    ("an unknown agent", GAINS, (f"{FIRST}.name", "3"), NOT),
    ("an object of phases", GAINS, (PHASES, {"0": EVEN, "1": ODD}), BAD),
    ("a phase that is none", GAINS, (PHASES, [EVEN, None]), BAD),
    ("a gain of another shape", GAINS, (f"{SECOND}.input.outputs.2", [[1, 1]]), BAD),
    ("a word besides", GAINS, ("subject.0.period", 2), BAD),
    ("a loop in a loop", GAINS, ("subject", [over(EVEN, ODD)] * 2), NOT),
]

test_a_true_claim_about_a_periodic_loop_is_accepted = accepts(ACCEPTED)
test_anything_else_is_rejected = rejects(REJECTED)


def test_the_first_phase_is_applied_first() -> None:
    made = read_subject([over(EVEN, ODD)], read_plant(PLANT))
    even, odd = (read_subject([over(each)], read_plant(PLANT)).A for each in (EVEN, ODD))
    assert made.A.equals(odd @ even)
    assert not made.A.equals(even @ odd)
    assert (made.B, made.C, made.blocks, made.loop) == ([], [], (), None)


def test_the_statement_names_the_number_of_steps() -> None:
    statement = checked(GAINS).statement
    assert statement.startswith("For the loop over 2 steps with the periodic controller with SHA")
    assert "3 of the controlled system and 0 added by the controller" in statement
    assert "the loop over 1 step with" in checked(claimed(None, False, over(IDLE))).statement


@pytest.mark.parametrize("kind", ["box_stable", "box_fixed"])
def test_nothing_is_known_of_boxes(kind: str) -> None:
    verdict = checked({**GAINS, "kind": kind})
    assert (verdict.verdict, verdict.code) == ("INCOMPLETE", "construction")


def test_nothing_is_known_of_feedthrough() -> None:
    verdict = checked(changed(GAINS, ("system.D", [[0, 0], [1, 0]])))
    assert (verdict.verdict, verdict.code) == ("INCOMPLETE", "feedthrough")


@pytest.mark.parametrize("kind", ["loop_cost", "disk_margin", "step_peaks", "distributed_observer"])
def test_other_kinds_about_loops_prove_nothing_of_it(kind: str) -> None:
    assert checked({**GAINS, "kind": kind}).verdict != "VALID"


def test_a_controller_file_is_that_of_the_certificate() -> None:
    def file(*phases: Document, **more: Any) -> bytes:
        parts = [{"agents": each["agents"]} for each in phases]
        head = {"format": "mcexact-periodic-controller/1", "system": "", "time": "discrete"}
        return json.dumps({**head, "phases": parts, **more}).encode()

    def verdict(data: bytes) -> str:
        wanted = Expectation().controlled(data, Limits())
        return check_document(GAINS, wanted).verdict

    assert verdict(file(EVEN, ODD)) == "VALID"
    for other in (file(ODD, EVEN), file(EVEN), file(EVEN, ODD, EVEN), file(EVEN, IDLE)):
        assert verdict(other) == "NOT ABOUT"
    assert verdict(file(EVEN, ODD, system="0" * 64)) == "NOT ABOUT"
    alone = json.dumps({"format": "mcexact-controller/1", "system": "", **EVEN}).encode()
    assert verdict(alone) == "NOT ABOUT"


@pytest.mark.parametrize(
    ("rule", "implied"),
    [
        ("periodic-stabilizes", [GAINS, FAST]),
        ("periodic-unstable", [UNSTABLE]),
        ("periodic-radius", [FAST]),
        ("periodic-slow", [SLOW]),
        ("periodic-states", [GAINS, FAST, SLOW, UNSTABLE]),
        ("periodic-order", [GAINS, FAST, SLOW, UNSTABLE]),
    ],
)
def test_a_sentence_follows_from_what_is_claimed(
    tmp_path: Path, rule: str, implied: list[Document]
) -> None:
    for k, document in enumerate((GAINS, FAST, SLOW, UNSTABLE)):
        (tmp_path / str(k)).mkdir()
        evidence = {"loop": document}
        [found] = said(
            write(
                tmp_path / str(k),
                evidence,
                manifest(evidence, [sentence(rule, "loop", evidence=evidence)]),
            )
        )
        assert (found.verdict == "IMPLIED") == (document in implied), found.line()


def test_a_loop_of_one_controller_implies_no_sentence_about_a_period(tmp_path: Path) -> None:
    step = {"construction": "closed_loop", "controller": EVEN}
    evidence = {"loop": claimed(None, False, step)}
    rules = ["periodic-unstable", "periodic-states"]
    listed = [sentence(rule, "loop", evidence=evidence) for rule in rules]
    found = said(write(tmp_path, evidence, manifest(evidence, listed)))
    assert [each.verdict for each in found] == ["INVALID"] * 2
