"""The checker's table of rules: each is implied by some certificates, and by others it is not."""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterator
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from mcexact.analysis.accounts import account_of_dimensions, account_of_links
from mcexact.analysis.analyze import analyze
from mcexact.analysis.fixed_modes.completeness import completeness
from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.analysis.questions import asked_by
from mcexact.analysis.sharing.allocation import minimal_shared_dimensions
from mcexact.analysis.structure.controllability import joint_controllability, joint_observability
from mcexact.analysis.structure.setpoint import setpoint_solvability
from mcexact.answer.account import Account
from mcexact.answer.codec import document
from mcexact.answer.listing import everything
from mcexact.answer.template import Template
from mcexact.checker import Verdict
from mcexact.checker.manifest import RULES, Evidence
from mcexact.checker.reading import Limits
from mcexact.checker.sentence import Premise, Rule
from mcexact.checker.sentences_design import DIMENSIONS
from mcexact.derived.error_system import error_system
from mcexact.derived.extended import extended_system
from mcexact.derived.integrators import setpoint_system
from mcexact.exact.matrix import Matrix
from mcexact.model import gallery
from mcexact.model.canonical import canonical, plain
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from tests.answer.asking import asked as asking
from tests.answer.test_sentences import drawn, question
from tests.checker import test_setpoint
from tests.checker.handmade import INTEGRATOR, Document, certificate, changed, matrix
from tests.checker.manifests import manifest, one, said, sentence, write
from tests.checker.test_closed_loop_spectrum import LOOP
from tests.checker.test_complementary_subsystem import TWICE
from tests.checker.test_distributed_observer import ONE as OBSERVER
from tests.checker.test_single_channel_gains import BLIND, CUT
from tests.checker.test_stability import BY_BLOCKS

TEMPLATES = tuple(everything())
PAPER = gallery.load("liu2020-3ch-no-communication")
RING = NeighborGraph.ring(PAPER.names)


@pytest.mark.parametrize("template", TEMPLATES, ids=lambda template: template.key)
def test_the_checker_knows_every_sentence_by_its_theorem(template: Template) -> None:
    assert RULES[template.key].theorem == template.theorem


def test_the_checker_knows_no_sentence_that_is_never_said() -> None:
    assert set(RULES) == {template.key for template in TEMPLATES}


def made(answer: Any) -> Document:
    """The certificate of an answer."""
    return document(answer)


# Analyses and allocations, of plants that have every property somewhere.


def answers(system: MultiChannelSystem) -> dict[str, Document]:
    """The certificates of everything that can be asked, of each channel."""
    found: dict[str, Document] = {}
    asked = asked_by("links", "every-channel")
    if system.neighbors is not None:
        asked += asked_by("minimal")
        if system.time == "discrete":
            asked += asked_by("delayed")
    for name in system.names:
        analysis = analyze(system, besides=asked, subset=[name], channel=name)
        for name_of, answer in analysis.decided().items():
            number = "" if name_of in found else f"_of_{system.names.index(name)}"
            found[name_of + number] = made(answer)
        asked = []
    return found


def known(folder: Path, evidence: dict[str, Document]) -> Evidence:
    """The certificates as the checker has them, all of them VALID."""
    write(folder, evidence)
    found = Evidence(lambda name: (folder / name).read_bytes(), [], Limits(), None)
    for name, digest in manifest(evidence)["certificates"].items():
        assert found.taken(name, digest).verdict == "VALID", name
    return found


def casts(rule: Rule, premises: list[Premise]) -> Iterator[tuple[str, ...]]:
    """Certificates that can play the roles of a rule, one for each, in some ways."""
    able = [
        [each.file for each in premises if role.fits(each, True) or role.fits(each, False)]
        for role in rule.roles
    ]
    yield from itertools.islice(itertools.product(*able), 12)


OPPOSITE = [
    ("nothing-fixed", "fixed"),
    ("stabilizable", "not-stabilizable"),
    ("controllable", "uncontrollable"),
    ("observable", "unobservable"),
    ("transfer-graph-connected", "transfer-graph-parts"),
    ("controllability-index", "controllability-indices"),
    ("observability-index", "observability-indices"),
    ("neighbor-graph-connected", "neighbor-graph-not-connected"),
    ("setpoint-stable-rest", "setpoint-unstable-rest"),
    ("allocate-least", "allocate-impossible"),
    ("subsystem-zeros", "subsystem-no-zeros"),
    ("lifted-nothing-fixed", "lifted-fixed"),
    ("held-nothing-fixed", "held-fixed"),
]
ALWAYS = {
    *("spectrum-moved", "spectrum-moved-between", "picture-transfer-graph", "complete"),
    *("pencil-row", "subsystem-normal-rank", "subsystem-remnant"),
    *("allocate-proof", "allocate-cost-proof", "allocate-links-proof"),
}
"""What holds of every certificate of its kind: the words say what it is that holds."""
OF_DESIGNS = ("design-", "certify-", "refused-")
"""How the keys begin of which the tables below are."""


def infeasible() -> Iterator[Any]:
    """Nothing suffices: nobody hears, nobody controls, nobody observes, nothing connects."""
    for share in ("outputs+states", "states"):
        yield minimal_shared_dimensions(PAPER, NeighborGraph.empty(PAPER.names), share)
    for B, C in (([[1], [0]], [[1, 1]]), ([[1], [1]], [[1, 0]])):
        lost = MultiChannelSystem([[1, 0], [0, 2]], [B], [C], neighbors={"1": []})
        yield minimal_shared_dimensions(lost)
    apart = MultiChannelSystem([[1]], [[[1]], [[0]]], [[[1]], [[0]]])
    silent = NeighborGraph.empty(apart.names)
    yield minimal_shared_dimensions(apart, silent, free_assignability=True)


def test_each_rule_is_implied_by_some_certificates_and_not_by_all(tmp_path: Path) -> None:
    evidence = [answers(PAPER), answers(PAPER.with_neighbors(RING))]
    evidence += map(answers, [gallery.load("quadruple-tank-pminus"), *map(drawn, range(12))])
    evidence += [{"a": TWICE}, {"a": BLIND}, {"a": CUT}]
    evidence += [{"a": changed(BLIND, ("claim.channels", ["1"]))}]
    evidence += [{"a": changed(CUT, ("claim.property", "both"))}]
    evidence += [{"a": made(least)} for least in infeasible()]
    dual = changed(CUT, ("claim.property", "observable"), ("witness.side", "observable"))
    implied, denied = (dict[str, set[Any]]((key, set()) for key in RULES) for _ in range(2))
    for number, documents in enumerate([*evidence, {"a": dual}]):
        (tmp_path / str(number)).mkdir()
        found = known(tmp_path / str(number), documents)
        for key, rule in RULES.items():
            for cast in casts(rule, list(found.premises.values())):
                because = [[name, "/kind", found.premises[name].kind] for name in cast]
                what = {"text": "", "rule": key, "theorem": rule.theorem, "because": because}
                verdict = found.judged(what, "")
                assert verdict.verdict in {"IMPLIED", "INVALID"}, (key, verdict.line())
                (implied if verdict.verdict == "IMPLIED" else denied)[key].add((number, cast))
    for one_key, other in OPPOSITE:
        assert not implied[one_key] & implied[other], (one_key, other)
    about = {
        key
        for key, rule in RULES.items()
        if (rule.roles and not key.startswith(OF_DESIGNS)) or rule.roles[:1] == (DIMENSIONS,)
    }
    assert not {key for key in about if not implied[key]}
    assert {key for key in about if not denied[key]} == ALWAYS


# What the package says of systems.


def accounts(start: int, stop: int) -> Iterator[Account]:
    """What is said of drawn plants when a lot is asked, and of what their agents have to share."""
    for seed in range(start, stop):
        system, rng = drawn(seed), random.Random(seed)
        yield asking(system, **question(system, rng)).account
        if system.neighbors is None:
            system = system.with_neighbors(NeighborGraph.ring(system.names))
        share, bound = rng.choice(["outputs+states", "states"]), rng.choice([None, Fraction(1, 2)])
        free, costs = rng.random() < 0.3, [rng.randint(1, 2) for _ in system.names]
        yield account_of_dimensions(
            system, share=share, bound=bound, free_assignability=free, costs=costs
        )
        yield account_of_links(system, bound=bound)


def told(folder: Path, account: Account, listed: Any) -> list[Verdict]:
    """The verdicts on a manifest beside the certificates of an account."""
    folder.mkdir(exist_ok=True)
    for name, text in account.certificates.items():
        (folder / name).write_text(text, encoding="ascii")
    (folder / "manifest.json").write_text(canonical(listed), encoding="ascii")
    return said(folder)


@pytest.mark.parametrize("start", range(0, 60, 10))
def test_everything_that_is_said_is_implied(tmp_path: Path, start: int) -> None:
    for number, account in enumerate(accounts(start, start + 10)):
        found = told(tmp_path / str(number), account, account.manifest())
        assert len(found) == len(account.sentences)
        assert not [verdict.line() for verdict in found if verdict.verdict != "IMPLIED"]


def test_what_is_said_of_derived_systems_is_implied(tmp_path: Path) -> None:
    system = extended_system(PAPER.with_neighbors(RING), [0, 0, 1], "outputs+states")
    for number, information in enumerate(("own", "outputs")):
        account = analyze(system, information=information).account
        found = told(tmp_path / str(number), account, account.manifest())
        assert {verdict.verdict for verdict in found} == {"IMPLIED"}
        assert all("the extended system of the plant" in verdict.theorem for verdict in found)
        bare = {key: value for key, value in account.manifest().items() if key != "subject"}
        found = told(tmp_path / str(number), account, bare)
        assert {verdict.verdict for verdict in found} == {"IMPLIED", "INVALID"}


def text_in(texts: dict[str, str], name: str) -> bytes:
    """The text of this name."""
    return texts[name].encode("ascii")


def test_no_sentence_is_implied_on_fewer_grounds_or_on_false_ones() -> None:
    """Without a premise it is not, or says the same without it; with another value it is not."""
    for account in accounts(0, 4):
        whole = plain(account.manifest())
        found = Evidence(partial(text_in, account.certificates), [], Limits(), None)
        for name, digest in whole["certificates"].items():
            assert found.taken(name, digest).verdict == "VALID"
        for what in whole["sentences"]:
            words = found.judged(what, "").theorem.rpartition(" from ")[0]
            for name in {name for name, *_ in what["because"]}:
                rest = [entry for entry in what["because"] if entry[0] != name]
                left = found.judged(what | {"because": rest}, "")
                same = left.theorem.rpartition(" from ")[0] == words
                assert left.verdict == "INVALID" or same or not RULES[what["rule"]].roles
            for k, (name, pointer, value) in enumerate(what["because"]):
                false = [name, pointer, 7 if value != 7 else 8]
                because = [*what["because"][:k], false, *what["because"][k + 1 :]]
                assert found.judged(what | {"because": because}, "").code == "value"


# Designs, verdicts on controllers, refusals.


def tracking(time: str, program: Document, polynomial: list[int], **maps: Document) -> Document:
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
LEAKS = tracking("continuous", FOLLOWED | {"private": [[-1]]}, [3, 3, 1], input=USED)
DEAF = tracking("continuous", {"outputs": {"1": [[1]]}}, [1, 2, 1], input=USED)
DOUBLES = tracking("continuous", FOLLOWED | {"reference": [[-2]]}, [1, 2, 1], input=USED)
GROWS = tracking(
    "continuous", FOLLOWED, [1, -2, 1], input={"outputs": {"1": [[2]]}, "private": [[-1]]}
)

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
KEPT_LOOP = changed(STABLE, ("system", made(fixed_spectrum(KEPT))["system"]))
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
    shared = extended_system(system, [0], "states")
    return {
        "control": made(joint_controllability(system)),
        "observe": made(joint_observability(system)),
        "tracked-control": made(joint_controllability(tracked)),
        "tracked-observe": made(joint_observability(tracked)),
        "complete": made(completeness(errors)),
        "errors": made(fixed_spectrum(errors)),
        "fixed": made(fixed_spectrum(system)),
        "shared": made(fixed_spectrum(shared)),
        "tracked": made(fixed_spectrum(extended_system(tracked, [tracked.n], "states"))),
        "too-little": made(fixed_spectrum(extended_system(tracked, [tracked.n - 1], "states"))),
    }


REFUSED, ALLOWED = of(LOST), of(FOUND)
WRONG = {
    "refused-uncontrollable": "observe fixed",
    "refused-unobservable": "control complete",
    "refused-integrators-control": "tracked-observe control",
    "refused-integrators-observe": "tracked-control observe",
    "refused-errors-fixed": "fixed tracked",
    "refused-fixed": "errors shared",
    "refused-fixed-shared": "fixed errors",
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
    "refused-integrators-fixed": "tracked",
}
LOOPS = "design-observer design-observer-float design-network design-setpoint"
SIZES = (
    "design-carrier design-carrier-for design-order design-order-integrators design-shared "
    "design-longest-number certify-states"
)
OBSERVERS = "design-feedback design-errors"
REFUSALS = {key: [REFUSED[place]] for keys, place in PLACES.items() for key in keys.split()}
IMPLIED: list[tuple[str, list[Document]]] = [
    (SIZES, [LOOP]),
    (LOOPS, [LOOP]),
    (LOOPS, [STABLE]),
    (f"{LOOPS} {OBSERVERS} design-region", [OBSERVER]),
    ("design-region", [STABLE]),
    ("design-assigned", [LOOP]),
    ("design-kept", [KEPT_LOOP, made(fixed_spectrum(KEPT))]),
    ("design-steady-state", [TRACKS]),
    ("design-steady-state", [STEPS]),
    ("certify-inside certify-decided certify-largest", [STABLE]),
    ("certify-decided-blocks", [BLOCKS]),
    ("certify-outside refused-outside", [SLOWER]),
    ("certify-least", [SCHUR]),
    *REFUSALS.items(),
    ("refused-no-equilibrium", [TWICE_SEEN]),
    ("refused-no-equilibrium refused-no-equilibrium-zero", [VELOCITY]),
    ("refused-mode-of-the-integrators", [made(setpoint_solvability(STILL))]),
]
DENIED: list[tuple[str, list[Document]]] = [
    (SIZES, [SPECTRUM]),
    (LOOPS, [SLOWER]),
    (LOOPS, [GROWS]),
    (f"{OBSERVERS} certify-inside certify-decided certify-outside refused-outside", [LOOP]),
    ("design-assigned", [SPECTRUM]),
    *(("design-region", [loop]) for loop in (LOOP, UNBOUNDED, SLOWER)),
    ("design-kept", [LOOP, SPECTRUM]),
    ("design-kept", [made(fixed_spectrum(KEPT))]),
    *(("design-steady-state", [loop]) for loop in (LOOP, LEAKS, DEAF, DOUBLES, GROWS, SLOWER)),
    ("certify-decided-blocks", [LOOP]),
    ("certify-outside refused-outside certify-least", [STABLE]),
    ("certify-inside certify-largest", [SLOWER]),
    ("certify-largest", [UNBOUNDED]),
    ("certify-largest", [SCHUR]),
    *((keys, [ALLOWED[place]]) for keys, place in PLACES.items()),
    *((key, [REFUSED[place]]) for key, places in WRONG.items() for place in places.split()),
    ("refused-no-equilibrium-zero refused-mode-of-the-integrators", [TWICE_SEEN]),
    ("refused-no-equilibrium refused-no-equilibrium-zero", [made(setpoint_solvability(STILL))]),
    ("refused-mode-of-the-integrators refused-no-equilibrium", [made(setpoint_solvability(FOUND))]),
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
    shared = {key for key in about if RULES[key].roles[0].kinds == ("shared_dimensions",)}
    assert about - shared <= {key for key, _ in rows(IMPLIED)}
    assert about - shared <= {key for key, _ in rows(DENIED)}


def test_what_is_said_of_a_controller_is_read_off_its_programs(tmp_path: Path) -> None:
    sizes = "(continuous time, 2 states, 0 channels)"
    name = f"the closed loop of the plant and the controller given {sizes}"
    for key, words in {
        "design-order": f"the controller in {name} has 1 state (1: 1 shared, 0 private)",
        "design-longest-number": f"the longest numerator or denominator in {name} has 3 bits",
        "certify-states": f"{name}: 2 states",
    }.items():
        assert judged(tmp_path, key, [LOOP]).theorem == f"{words} from premise_0.json"
