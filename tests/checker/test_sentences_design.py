"""The checker's rules about designs, verdicts on controllers and refusals."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.fixed_modes import completeness, fixed_spectrum
from mcexact.analysis.structure import setpoint_solvability
from mcexact.answer.protocol import document
from mcexact.checker.kinds import Verdict
from mcexact.checker.sentences import RULES
from mcexact.derived.constructions import (
    augmented_outputs,
    closure,
    error_system,
    extended_system,
    internal_model,
    setpoint_system,
)
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem
from tests.checker import test_setpoint
from tests.checker.box_plants import (
    HELD_ALONE,
    HELD_AROUND,
    HELD_LOOP,
    PART_CERTAIN,
    PART_STABLE,
)
from tests.checker.box_plants import STABLE as UNCONTROLLED
from tests.checker.handmade import (
    INTEGRATOR,
    Document,
    certificate,
    changed,
    checked,
    matrix,
)
from tests.checker.manifests import one, sentence
from tests.checker.recorded import compare, keys
from tests.checker.test_closed_loop_spectrum import LOOP
from tests.checker.test_distributed_observer import ONE as OBSERVER
from tests.checker.test_stability import BY_BLOCKS
from tests.wording import worded

OF_DESIGNS = (
    "design-",
    "certify-",
    "refused-",
    "members-in-region",
    "members-sampled",
    "sampled-",
)
OF_SAMPLES = "members-sampled-region members-sampled-region-part"
"""How the keys of these rules begin."""


def tracking(time: str, program: Document, polynomial: list[Any], **maps: Document) -> Document:
    """The loop of an integrator whose agent has one state z and takes a set-point."""
    agent = {"name": "1", "shared": 0, "private": 1, "shared_update": {}, **maps}
    controller = {"time": time, "agents": [agent | {"private_update": program}]}
    step = {"construction": "closed_loop", "controller": controller}
    system = changed(INTEGRATOR, ("time", time))
    if time == "discrete":
        system["A"] = [[1]]
    claim = {"polynomial": polynomial}
    return certificate("closed_loop_spectrum", system, claim, {"moduli": [101, 103]}, step)


USED = {"outputs": {"1": [[-2]]}, "private": [[-1]]}
FOLLOWED = {"outputs": {"1": [[1]]}, "reference": [[-1]]}
TRACKS = tracking("continuous", FOLLOWED, [1, 2, 1], input=USED)
"""x' = -2 x - z, z' = x - r."""
STEPS = tracking("discrete", FOLLOWED | {"private": [[1]]}, [0, 0, 1], input=USED)
"""x(t+1) = -x - z, z(t+1) = x + z - r: nothing is left after two steps."""
HALF = tracking(
    "continuous",
    {"outputs": {"1": [["1/2"]]}, "reference": [["-1/2"]]},
    ["1/2", 2, 1],
    input=USED,
)
"""x' = -2 x - z, z' = (x - r)/2: half the output is integrated, and 1 is no row of it."""
LEAKS = tracking("continuous", FOLLOWED | {"private": [[-1]]}, [3, 3, 1], input=USED)
DEAF = tracking("continuous", {"outputs": {"1": [[1]]}}, [1, 2, 1], input=USED)
DOUBLES = tracking("continuous", FOLLOWED | {"reference": [[-2]]}, [1, 2, 1], input=USED)
GROWS = tracking(
    "continuous", FOLLOWED, [1, -2, 1], input={"outputs": {"1": [[2]]}, "private": [[-1]]}
)


def turning(delayed: int) -> Document:
    """The loop of x' = u and a model of s² + 1 behind it, whose first state may be delayed."""
    taken = {"outputs": {"1": [[0], [1]]}, "reference": [[0], [-1]]}
    agent = {
        "name": "1",
        "shared": 0,
        "private": 2,
        "shared_update": {},
        "private_update": {**taken, "private": [[-delayed, 1], [-1, 0]]},
        "input": {"outputs": {"1": [[-2]]}, "private": [[1, -1]]},
    }
    controller = {"time": "continuous", "agents": [agent]}
    step = {"construction": "closed_loop", "controller": controller}
    claim = {"polynomial": [1 + delayed, 2 + 2 * delayed, 2 + delayed, 1]}
    return certificate("closed_loop_spectrum", INTEGRATOR, claim, {"moduli": [101, 103]}, step)


TURNS, LAGS = turning(0), turning(1)
ROTATED = {
    "outputs": {"1": [[1], [1]]}, "reference": [[-1], [-1]], "private": [[-1, 2], [-1, 1]]
}  # fmt: skip
TURNED = changed(
    TURNS,
    ("subject.0.controller.agents.0.private_update", ROTATED),
    ("subject.0.controller.agents.0.input.private", [[1, -2]]),
)
"""The same loop, with the states z_1 + z_2 and z_2 of the agent."""
HEARD = changed(
    TURNS,
    ("subject.0.controller.agents.0.private_update.outputs.1", [["-1/2"], [1]]),
    ("claim.polynomial", ["3/2", "5/2", 2, 1]),
)
"""The model, whose first state is driven by the output, too, and not by the reference."""
WRONG_SIGN = changed(TURNS, ("subject.0.controller.agents.0.private_update.reference", [[0], [1]]))

STABLE = changed(
    LOOP,
    ("kind", "stability"),
    ("claim", {"stable": True, "bound": 1}),
    ("witness", {"method": "polynomial"}),
)
SLOWER = changed(STABLE, ("claim", {"stable": False, "bound": 9}))
UNBOUNDED = changed(STABLE, ("claim.bound", None))
SCHUR = changed(
    STEPS,
    ("kind", "stability"),
    ("claim", {"stable": True, "bound": "1/2"}),
    ("witness", {"method": "polynomial"}),
)
BLOCKS = changed(
    BY_BLOCKS,
    ("subject", [changed(TRACKS["subject"][0], ("controller.agents.0.private", 0))]),
)
IDLE = {"name": "1", "shared": 0, "private": 0, "shared_update": {}, "private_update": {}}
BLOCKS["subject"][0]["controller"]["agents"] = [IDLE | {"input": {}}]
KEPT = MultiChannelSystem([[1, 0], [0, -2]], [[[1], [0]]], [[[1, 0]]], neighbors={"1": []})
KEPT_LOOP = changed(STABLE, ("system", document(fixed_spectrum(KEPT))["system"]))
TWICE_SEEN, VELOCITY = test_setpoint.TWICE, test_setpoint.VELOCITY
SPECTRUM = certificate(
    "fixed_spectrum",
    LOOP["system"],
    {"polynomial": [1], "factors": [], "stabilizable": True, "best_rate": None},
    {"gains": [matrix([2])], "modulus": 7, "subspaces": [], "completion": None},
)

LOST = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [0]]], [[[1, 0]]], neighbors={"1": []})
"""The mode 2 is neither controlled nor observed."""
FOUND = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [1]]], [[[1, 1]]], neighbors={"1": []})
"""Both modes are."""
STILL = MultiChannelSystem([[0]], [[[0]]], [[[1]]], neighbors={"1": []})
"""Nothing moves it."""


def of(system: MultiChannelSystem) -> dict[str, Document]:
    """The certificates of refusals, or of what refuses nothing."""
    tracked, errors = setpoint_system(system), error_system(system, [Matrix.zeros(1, system.n)])
    shared, followed = extended_system(system, [0], "states"), internal_model(system, "ramp")
    return {
        "control": document(joint_controllability(system)),
        "observe": document(joint_observability(system)),
        "tracked-control": document(joint_controllability(tracked)),
        "tracked-observe": document(joint_observability(tracked)),
        "complete": document(completeness(errors)),
        "errors": document(fixed_spectrum(errors)),
        "fixed": document(fixed_spectrum(system)),
        "shared": document(fixed_spectrum(shared)),
        "tracked": document(fixed_spectrum(extended_system(tracked, [tracked.n], "states"))),
        "followed-control": document(joint_controllability(followed)),
        "followed-observe": document(joint_observability(followed)),
        "followed": document(fixed_spectrum(extended_system(followed, [followed.n], "states"))),
        "followed-alone": document(fixed_spectrum(followed)),
        "followed-too-little": document(
            fixed_spectrum(extended_system(followed, [followed.n - 1], "states"))
        ),
        "too-little": document(fixed_spectrum(extended_system(tracked, [tracked.n - 1], "states"))),
    }


def seen_and_driven_apart(chain: dict[str, list[str]]) -> MultiChannelSystem:
    """A mode that agent 1 sees and agent 3 drives, over some links."""
    return MultiChannelSystem([[1]], [[[0]], [[0]], [[1]]], [[[1]], [[0]], [[0]]], neighbors=chain)


def over_links(links: dict[str, list[str]]) -> dict[str, Document]:
    """The certificate about all that agents can share over these links."""
    paths = closure(seen_and_driven_apart(links))
    return {"over-links": document(fixed_spectrum(augmented_outputs(paths)))}


REFUSED = of(LOST) | over_links({"1": ["2"], "2": ["3"]})
ALLOWED = of(FOUND) | over_links({"2": ["1"], "3": ["2"]})
WRONG = {
    "refused-uncontrollable": "observe fixed",
    "refused-unobservable": "control complete",
    "refused-integrators-control": "tracked-observe control",
    "refused-models-control": "tracked-control followed-observe control",
    "refused-models-observe": "tracked-observe followed-control observe",
    "refused-models-fixed": "tracked followed-too-little shared fixed",
    "refused-models-alone": "followed tracked fixed",
    "refused-integrators-observe": "tracked-control observe",
    "refused-errors-fixed": "fixed tracked",
    "refused-fixed": "errors shared",
    "refused-fixed-shared": "fixed errors",
    "refused-over-links": "fixed shared errors",
    "refused-integrators-fixed": "too-little shared fixed",
}
"""Certificates that say such a thing of something else, or too little."""
PLACES = {
    "refused-not-controllable refused-not-controllable-in refused-uncontrollable": "control",
    "refused-unobservable refused-not-observable": "observe",
    "refused-integrators-control": "tracked-control",
    "refused-integrators-observe": "tracked-observe",
    "refused-errors-not-complete": "complete",
    "refused-errors-fixed": "errors",
    "refused-fixed": "fixed",
    "refused-fixed-shared": "shared",
    "refused-over-links": "over-links",
    "refused-integrators-fixed": "tracked",
    "refused-models-control": "followed-control",
    "refused-models-observe": "followed-observe",
    "refused-models-fixed": "followed",
    "refused-models-alone": "followed-alone",
}
LOOPS = "design-observer design-observer-float design-network design-setpoint design-tracking"
SIZES = (
    "design-carrier design-carrier-for design-order design-order-integrators design-order-models "
    "design-shared "
    "design-longest-number design-observer-order certify-states"
)
OBSERVERS = "design-feedback design-errors"
REFUSALS = {key: [REFUSED[place]] for keys, place in PLACES.items() for key in keys.split()}
LOOPS_IN_BOXES = (PART_STABLE, PART_CERTAIN)
IMPLIED: list[tuple[str, list[Document]]] = [
    (SIZES, [LOOP]),
    (LOOPS, [LOOP]),
    (LOOPS, [STABLE]),
    (f"{LOOPS} {OBSERVERS} design-region", [OBSERVER]),
    ("design-region", [STABLE]),
    ("design-assigned", [LOOP]),
    ("design-source-components", [ALLOWED["over-links"]]),
    ("design-kept", [KEPT_LOOP, document(fixed_spectrum(KEPT))]),
    ("design-steady-state", [TRACKS]),
    ("design-steady-state", [STEPS]),
    ("design-steady-state", [HALF]),
    *(("design-steady-regulated", [loop]) for loop in (TRACKS, STEPS, HALF)),
    *(
        ("design-steady-signals", [loop])
        for loop in (TRACKS, STEPS, HALF, LEAKS, TURNS, LAGS, TURNED)
    ),
    ("certify-inside certify-decided certify-largest", [STABLE]),
    ("certify-decided-blocks", [BLOCKS]),
    ("certify-outside refused-outside", [SLOWER]),
    ("certify-least", [SCHUR]),
    *REFUSALS.items(),
    ("refused-no-equilibrium", [TWICE_SEEN]),
    ("refused-no-equilibrium refused-no-equilibrium-zero", [VELOCITY]),
    ("refused-mode-of-the-integrators", [document(setpoint_solvability(STILL))]),
    *(("members-in-region members-in-region-part", [each]) for each in LOOPS_IN_BOXES),
    (f"{LOOPS} sampled-loop", [HELD_LOOP]),
    *((OF_SAMPLES, [each]) for each in (HELD_ALONE, HELD_AROUND)),
    ("members-sampled-exactly", [HELD_ALONE]),
]
DENIED: list[tuple[str, list[Document]]] = [
    (SIZES, [SPECTRUM]),
    (LOOPS, [SLOWER]),
    (LOOPS, [GROWS]),
    (f"{OBSERVERS} certify-inside certify-decided certify-outside refused-outside", [LOOP]),
    ("design-assigned design-source-components", [SPECTRUM]),
    *(("design-region", [loop]) for loop in (LOOP, UNBOUNDED, SLOWER)),
    ("design-kept", [LOOP, SPECTRUM]),
    ("design-kept", [document(fixed_spectrum(KEPT))]),
    *(("design-steady-state", [loop]) for loop in (LOOP, LEAKS, DEAF, DOUBLES, GROWS)),
    *(("design-steady-regulated", [loop]) for loop in (LOOP, LEAKS, DEAF, DOUBLES, GROWS, SLOWER)),
    *(("design-steady-signals", [loop]) for loop in (LOOP, DEAF, DOUBLES, GROWS, SLOWER)),
    *(("design-steady-signals", [loop]) for loop in (HEARD, WRONG_SIGN)),
    *(("design-steady-regulated design-steady-state", [loop]) for loop in (TURNS, LAGS, TURNED)),
    ("design-steady-state", [SLOWER]),
    ("certify-decided-blocks", [LOOP]),
    ("certify-outside refused-outside certify-least", [STABLE]),
    ("certify-inside certify-largest", [SLOWER]),
    ("certify-largest", [UNBOUNDED]),
    ("certify-largest", [SCHUR]),
    *((keys, [ALLOWED[place]]) for keys, place in PLACES.items()),
    *((key, [REFUSED[place]]) for key, places in WRONG.items() for place in places.split()),
    ("refused-no-equilibrium-zero refused-mode-of-the-integrators", [TWICE_SEEN]),
    ("refused-no-equilibrium refused-no-equilibrium-zero", [document(setpoint_solvability(STILL))]),
    *(("members-in-region members-in-region-part", [each]) for each in (UNCONTROLLED, STABLE)),
    *((f"{OF_SAMPLES} members-sampled-exactly", [each]) for each in (*LOOPS_IN_BOXES, HELD_LOOP)),
    ("members-sampled-exactly", [HELD_AROUND]),
    *(("sampled-loop", [each]) for each in (LOOP, STABLE, HELD_ALONE)),
    (
        "refused-mode-of-the-integrators refused-no-equilibrium",
        [document(setpoint_solvability(FOUND))],
    ),
]


def judged(folder: Path, key: str, documents: list[Document]) -> Verdict:
    """The verdict on a sentence that rests on these certificates."""
    evidence = {f"premise_{k}": each for k, each in enumerate(documents)}
    return one(folder, sentence(key, *evidence, evidence=evidence), evidence)


def rows(table: list[tuple[str, list[Document]]]) -> list[tuple[str, list[Document]]]:
    """A row for each key."""
    return [(key, documents) for keys, documents in table for key in keys.split()]


@pytest.mark.parametrize(("key", "documents"), rows(IMPLIED))
def test_a_design_or_a_refusal_is_implied(
    tmp_path: Path, key: str, documents: list[Document]
) -> None:
    verdict = judged(tmp_path, key, documents)
    assert verdict.verdict == "IMPLIED", verdict.line()


@pytest.mark.parametrize(("key", "documents"), rows(DENIED))
def test_a_design_or_a_refusal_is_not_implied(
    tmp_path: Path, key: str, documents: list[Document]
) -> None:
    verdict = judged(tmp_path, key, documents)
    assert (verdict.verdict, verdict.code in {"claim", "premise"}) == ("INVALID", True)


def test_every_rule_about_designs_and_refusals_is_in_both_tables() -> None:
    about = {key for key, rule in RULES.items() if rule.roles and key.startswith(OF_DESIGNS)}
    about -= {key for key in about if RULES[key].roles[0].nearby}  # tests/checker/test_nearby.py
    shared = {key for key in about if RULES[key].roles[0].kinds == ("shared_dimensions",)}
    assert about - shared <= {key for key, _ in rows(IMPLIED)}
    assert about - shared <= {key for key, _ in rows(DENIED)}


def test_what_is_said_of_a_controller_is_read_off_its_programs(tmp_path: Path) -> None:
    name = checked(LOOP).statement.partition(" (2 states")[0]
    longest = "the longest numerator or denominator in the controller has 3 bits"
    for key, words in {
        "design-order": 'the controller has 1 state ("1": 1 shared, 0 private)',
        "design-longest-number": longest,
        "certify-states": "the loop has 2 states",
    }.items():
        assert judged(tmp_path, key, [LOOP]).statement == f"{name}: {words} from premise_0.json"
    plant = "For " + name.rpartition(" of: ")[2]
    said = judged(tmp_path, "design-observer-order", [LOOP]).statement
    assert worded(said) and plant in said


@pytest.mark.parametrize("key", keys("design"))
def test_a_rule_answers_as_it_did(key: str) -> None:
    compare(key)
