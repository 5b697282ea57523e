"""What sentences say is true, by an oracle that knows the plant and the sentence alone."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest
from flint import fmpq, fmpq_mat

from mcexact.analysis.analyze import analyze
from mcexact.analysis.sharing import minimal_shared_dimensions
from mcexact.answer.listing import everything
from mcexact.answer.rulebook import ALLOCATION
from mcexact.answer.sentence import Context
from mcexact.answer.sharing import SHARING_RULES
from mcexact.derived.constructions import Share
from mcexact.derived.sampling import sampled_system
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.polynomial import Polynomial
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.decentralized import design_decentralized, design_extended
from mcexact.synthesis.longest_step import longest_step
from mcexact.synthesis.optimum.figures import Aims
from mcexact.synthesis.performance import performance_of
from mcexact.synthesis.setpoint import design_setpoint
from tests.assurance.campaigns.sentences import caught, drawn, examined
from tests.checker.polynomials import generous
from tests.oracle.sentences import JUDGES, UNJUDGED, Case, Said, plant_of, said, verdict
from tests.oracle.sentences.cases import Region, plain
from tests.oracle.sentences.designs import document_of, tracks
from tests.oracle.sentences.falsified import OLD_STEADY_STATE
from tests.oracle.sentences.members import scaled

FAST = [number for number in range(600, 675) if number % 10 in {0, 2, 5, 8}]
"""Analyses, allocations and boxes, which take little; designs and parameters are slow tests."""
SLOW = range(630, 730, 10)


def test_every_rule_has_a_judge_or_a_reason_why_it_has_none() -> None:
    rules = {template.key for template in everything()}
    assert sorted([*JUDGES, *UNJUDGED]) == sorted(rules)


@pytest.mark.parametrize("number", FAST)
def test_every_sentence_about_a_drawn_plant_is_true(number: int) -> None:
    wrong, _ = examined(number)
    assert wrong == []


@pytest.mark.slow
@pytest.mark.parametrize("first", SLOW)
def test_every_sentence_about_more_drawn_plants_is_true(first: int) -> None:
    for number in range(first, first + 10):
        wrong, _ = examined(number)
        assert wrong == []


@pytest.fixture(scope="module")
def tracking() -> Iterator[tuple[Said, Case]]:
    """A design that holds two outputs, and what it says of them."""
    plant = MultiChannelSystem([[0, 1], [1, -2]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]])
    made = design_setpoint(plant, rate="1/2")
    document = document_of(json.loads(json.dumps(made.controller.document(), default=str)))
    asked = {"region": plain(made.region), "network": "decentralized"}
    rows = [said(each) for each in made.account.sentences]
    [held] = [row for row in rows if row.rule == "design-steady-state"]
    yield held, Case(plant_of(plant), asked, document, rows)


SAMPLED_RULES = {
    *("sampled-loop", "first-sampled", "first-box", "members-sampled-region-part"),
    "performance-another-step",
}


@pytest.fixture(scope="module")
def at_samples() -> tuple[list[Said], Case]:
    """What is said of a loop with a sampled plant, about the samples and the box."""
    plant = MultiChannelSystem([[0, 1], [0, -1]], [[[0], [1]]], [[[1, 0]]])
    made = design_decentralized(sampled_system(plant, "1/5", 1))
    document = document_of(json.loads(json.dumps(made.controller.document(), default=str)))
    how = {"step": "1/5", "late": 1, "decimals": 12}
    longest = longest_step(made.loop.closed.plant, made.controller)
    account = made.account_with(made.every_loop(), performance_of(made.loop.closed), longest)
    rows = [said(each) for each in account.sentences]
    case = Case(plant_of(plant), {"sampling": how}, document, rows)
    return [row for row in rows if row.rule in SAMPLED_RULES], case


def test_what_is_said_of_samples_is_true_of_drawn_plants(
    at_samples: tuple[list[Said], Case],
) -> None:
    rows, case = at_samples
    assert {row.rule for row in rows} == SAMPLED_RULES
    assert all(verdict(row, case) for row in rows)
    alone = {"region": Region("discrete"), "gains": None}
    for rule in ("members-sampled-exactly", "first-exact"):
        assert verdict(Said(rule, alone), case)
    plant = case.plant
    around = replace(plant, radii=(scaled(plant.A, fmpq(1, 1000)), *none_of(plant)))
    assert verdict(Said("members-sampled-region", alone), replace(case, plant=around))


def none_of(plant: Any) -> tuple[list[fmpq_mat], list[fmpq_mat]]:
    """Radii of certain inputs and outputs."""
    return [M * 0 for M in plant.B], [M * 0 for M in plant.C]


@pytest.fixture(scope="module")
def held() -> tuple[Said, Case]:
    """What is said of a loop in continuous time whose controller runs at samples."""
    plant = MultiChannelSystem([[0, 1], [0, -1]], [[[0], [1]]], [[[1, 0]]])
    made = design_decentralized(plant)
    document = document_of(json.loads(json.dumps(made.controller.document(), default=str)))
    account = made.account_with(None, None, longest_step(plant, made.controller))
    rows = [said(each) for each in account.sentences]
    [row] = [row for row in rows if row.rule == "performance-at-samples"]
    return row, Case(plant_of(plant), {}, document, rows)


def test_a_controller_at_samples_has_the_margin_that_is_told(held: tuple[Said, Case]) -> None:
    row, case = held
    assert verdict(row, case)
    for change in ({"step": 9}, {"margin": "9/5"}):
        assert verdict(replace(row, values={**row.values, **change}), case) is False


@pytest.mark.parametrize(
    "change", [{"part": 5}, {"step": 9}, {"late": 0}, {"decimals": 3}, {"margin": "9/5"}]
)
def test_what_is_false_of_samples_is_denied(
    at_samples: tuple[list[Said], Case], change: dict[str, Any]
) -> None:
    rows, case = at_samples
    (key,) = change
    known = [row for row in rows if key in row.values]
    assert known
    for row in known:
        assert verdict(replace(row, values={**row.values, **change}), case) is False


def test_outputs_tend_to_set_points_that_are_all_constant(tracking: tuple[Said, Case]) -> None:
    held, case = tracking
    assert verdict(held, case)
    assert tracks(case, [False, False])


def test_an_output_moves_with_the_set_point_of_another_agent(tracking: tuple[Said, Case]) -> None:
    held, case = tracking
    assert not tracks(case, [False, True], disturbed=False)
    assert verdict(replace(held, text=OLD_STEADY_STATE), case) is False


def test_outputs_of_a_loop_without_its_controller_are_not_held(tracking: tuple[Said, Case]) -> None:
    held, case = tracking
    assert case.controller is not None
    idle = {"shared_update": {}, "private_update": {}, "input": {}}
    agents = [{**agent, **idle} for agent in case.controller["agents"]]
    assert verdict(held, replace(case, controller={**case.controller, "agents": agents})) is False


def test_modes_of_messages_that_no_agent_uses_do_not_remain_in_the_loop() -> None:
    plant = MultiChannelSystem([[0]], [[[0]], [[2]]], [[[0]], []], time="discrete")
    graph = NeighborGraph.from_names(plant.names, {"2": ["1"]}, {"2": {"1": 2}})
    made = design_extended(plant.with_neighbors(graph), radius="1/2", arithmetic="float")
    [told] = [each for each in made.account.sentences if each.template.key == "design-kept"]
    assert made.controller.order == 0
    assert told.values["p"] == characteristic_polynomial(made.loop.matrix) == Polynomial.of(0, 1)


@pytest.mark.parametrize("share", ["outputs+states", "states"])
def test_both_bounds_on_what_agents_share_are_judged(share: Share) -> None:
    """The lower one by all dimensions that cost less, the upper one by those in the sentence."""
    paper = gallery.load("liu2020-3ch-no-communication")
    plant = paper.with_neighbors(NeighborGraph.ring(paper.names))
    least = minimal_shared_dimensions(plant, share=share)
    enough, given = generous(least), Context(plant, {"cuts": 1, "nodes": 1, "multiplicities": (1,)})
    asked = {"share": share, "bound": None, "free_assignability": False}
    case = Case(plant_of(plant), asked)
    question = f"minimal_shared_dimensions_{share.replace('+', '_')}"
    for sentences in (
        ALLOCATION.sentences({"minimal_shared_dimensions": enough}, given),
        SHARING_RULES.sentences({question: enough}, given),
    ):
        rows = [said(each) for each in sentences if each.template.key.endswith(("in", "between"))]
        [told] = rows
        lower, sizes = least.total or 0, told.values["sizes"]
        assert verdict(told, case) and told.values["lower"] == lower
        changes: list[dict[str, Any]] = [{"lower": lower + 1}, {"lower": lower + 4}]
        changes += [{"sizes": [(name, 0) for name, _ in sizes]}]
        changes += [{"cost": 3}] if "cost" in told.values else []
        for change in changes:
            assert verdict(replace(told, values={**told.values, **change}), case) is False


UNSEEN = MultiChannelSystem([[1, 2], [4, -1]], [[[1], [0]]], [[[1, -1]]])
"""The rows of A sum to 3, and the output is a difference."""
UNMOVED = MultiChannelSystem([[1, 4], [2, -1]], [[[1], [-1]]], [[[1, 0]]])
BESIDE = MultiChannelSystem([[1, 2, 0], [4, -1, 0], [0, 0, 5]], [[[1], [0], [0]]], [[[1, -1, 0]]])
ROUNDED = MultiChannelSystem(
    [["0.30000000000000004", "0.7"], ["0.7", "0.3"]], [[[1], [0]]], [[["0.1", "-0.1"]]]
)
TURNED = MultiChannelSystem(
    [["0.30000000000000004", "0.7"], ["0.7", "0.3"]], [[[1], [-1]]], [[["0.1", 0]]]
)
LINKED = MultiChannelSystem(
    [[1, 0], [1, 2]],
    [[[1], [0]], [[0], [1]]],
    [[[0, 0]], [[1, 1]]],
    neighbors={"1": ["2"], "2": []},
)
"""The first state is fed back only where agent 1 receives the output of agent 2, or conversely."""
OF_DATA = ("fixed-by-", "law-", "nearby-law-")


@pytest.mark.parametrize("plant", [UNSEEN, UNMOVED, BESIDE, ROUNDED, TURNED])
def test_why_modes_are_fixed_is_judged_and_denied(plant: MultiChannelSystem) -> None:
    found = analyze(plant)
    asked: dict[str, Any] = {
        "nearby": {each.lost: plant_of(each.plant) for each in found.nearby.plants}
    }
    case = Case(plant_of(plant), asked)
    rows = [said(each) for each in found.sentences if each.template.key.startswith(OF_DATA)]
    assert rows and all(verdict(row, case) for row in rows)
    for row in rows:
        changes: list[dict[str, Any]] = [{"p": Polynomial.from_roots([7])}]
        changes += [{"vectors": [[1, 2, 0][: plant.n]]}] if "vectors" in row.values else []
        for change in changes:
            changed = {name: plain(value) for name, value in change.items()}
            assert verdict(replace(row, values={**row.values, **changed}), case) is False
        if row.rule.startswith("fixed-by-"):
            other = {"zeros": "equalities", "equalities": "zeros"}[
                row.rule.removeprefix("fixed-by-")
            ]
            assert verdict(replace(row, rule=f"fixed-by-{other}"), case) is False


@pytest.mark.parametrize("information", ["own", "outputs"])
@pytest.mark.parametrize("plant", [UNSEEN, BESIDE, LINKED])
def test_what_is_fixed_for_all_numbers_is_judged_and_denied(
    plant: MultiChannelSystem, information: str
) -> None:
    linked = plant if plant.neighbors is not None else plant.with_neighbors({"1": []})
    found = analyze(linked, ["structural_fixed_modes"], information=information)
    [row] = [said(each) for each in found.sentences if each.template.key.startswith("structural-")]
    case = Case(plant_of(linked))
    assert verdict(row, case)
    others: list[dict[str, Any]] = [{"modes": [[2, 3], 0]}, {"modes": [[], 5]}]
    others *= "modes" in row.values
    others += [{"information": "instant"}]
    others += [{"information": "own" if information == "outputs" else "outputs"}] * (
        plant is LINKED
    )
    for change in others:
        assert verdict(replace(row, values={**row.values, **change}), case) is False
    opposite = {"structural-none": "structural-modes"}.get(row.rule, "structural-none")
    values: dict[str, Any] = {"modes": [[1], 0]} if "none" in row.rule else {}
    assert verdict(replace(row, rule=opposite, values={**row.values, **values}), case) is False


@pytest.mark.slow
def test_judges_deny_what_was_made_false() -> None:
    met: set[str] = set()
    denied: set[str] = set()
    for number in (2, 22, 292, 900, 902, 905, 908, 910, 912, 915, 918, 920, 922, 950):
        met |= {sentence.rule for sentence, _ in drawn(number) if sentence.rule in JUDGES}
        denied |= caught(number, met - denied)
    assert len(met) > 60
    assert met - denied == set()


def test_what_is_false_of_a_loop_over_a_period_is_denied() -> None:
    numbers = (6, 16, 26, 36, 76)
    met = {each.rule for number in numbers for each, _ in drawn(number) if each.rule in JUDGES}
    assert {rule for rule in JUDGES if rule.startswith("periodic-")} <= met
    assert met == set().union(*(caught(number, met) for number in numbers))


def test_what_is_regulated_tends_to_its_set_points_and_nothing_else_does() -> None:
    plant = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0], [0, 1]]])
    made = design_setpoint(plant, regulate={"1": [1]}, rate="1/4", aims=Aims(effort=1))
    document = document_of(json.loads(json.dumps(made.controller.document(), default=str)))
    asked = {"region": plain(made.region), "network": "decentralized"}
    rows = [said(each) for each in made.account.sentences]
    [held] = [row for row in rows if row.rule == "design-steady-regulated"]
    case = Case(plant_of(plant), asked, document, rows)
    assert verdict(held, case)
    for other in ([["1", [["0", "1"]]]], [["1", [["1", "0"], ["0", "1"]]]], []):
        assert not verdict(replace(held, values={"held": other}), case)


def test_what_follows_signals_follows_these_and_no_others() -> None:
    plant = MultiChannelSystem([[0]], [[[1]]], [[[1], [0]]])
    made = design_setpoint(
        plant,
        regulate={"1": [1]},
        signals="step,poly:s^2+2",
        rate="1/9",
        aims=Aims(effort=0),
    )
    document = document_of(json.loads(json.dumps(made.controller.document(), default=str)))
    asked = {"region": plain(made.region), "network": "decentralized"}
    rows = [said(each) for each in made.account.sentences]
    [held] = [row for row in rows if row.rule == "design-steady-signals"]
    case, values = Case(plant_of(plant), asked, document, rows), dict(held.values)
    assert verdict(held, case)
    for words in ("steps", "solutions of s^2 + 2", "solutions of s^3 + 2*s"):
        assert verdict(replace(held, values={**values, "signals": words}), case)
    for words in ("sinusoids of 2 rad", "ramps", "polynomials of degrees up to 2"):
        assert not verdict(replace(held, values={**values, "signals": words}), case)
    for other in ([["1", [["0", "1"]]]], []):
        assert not verdict(replace(held, values={**values, "held": other}), case)
