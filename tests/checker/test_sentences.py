"""The checker's table of rules: each is implied by some certificates, and by others it is not."""

from __future__ import annotations

import itertools
import random
import re
from collections.abc import Iterator
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any, get_args

import pytest

from mcexact.analysis.analyze import account_of_dimensions, account_of_links, analyze
from mcexact.analysis.boxes.members import box_setpoints
from mcexact.analysis.fixed_modes import assignability, fixed_spectrum
from mcexact.analysis.questions import asked_by
from mcexact.analysis.sharing import minimal_shared_dimensions
from mcexact.analysis.structure import transfer_graph
from mcexact.answer.account import Account
from mcexact.answer.listing import everything
from mcexact.answer.protocol import document
from mcexact.answer.templates import Template
from mcexact.checker.command import Evidence
from mcexact.checker.core.reading import Limits
from mcexact.checker.kinds import Expectation, Verdict
from mcexact.checker.sentences import RULES, Premise, Rule
from mcexact.checker.sentences_loops import DIMENSIONS
from mcexact.derived.constructions import (
    Share,
    add_links,
    augmented_outputs,
    extended_system,
    merged,
)
from mcexact.exact.roots import StabilityRegion
from mcexact.model import gallery
from mcexact.model.box import Box
from mcexact.model.graph import NeighborGraph
from mcexact.model.parametric import ParametricSystem
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import canonical, plain
from mcexact.synthesis.certify import certify_controller
from tests.answer.asking import asked as asking
from tests.answer.test_sentences import drawn, question
from tests.assurance.attack.forgeries.joined import factors_joined
from tests.checker.box_plants import OF_ONE_PLANT
from tests.checker.corpus_plants import margins_in_boxes
from tests.checker.handmade import Document, changed
from tests.checker.manifests import manifest, one, said, sentence, write
from tests.checker.parameter_plants import HELD, LOOP_DAMPED, LOOP_SAMPLED, OBSERVED, QUARTERS
from tests.checker.polynomials import generous
from tests.checker.saturation_plants import CUT as CUT_OFF
from tests.checker.saturation_plants import NEAR
from tests.checker.test_complementary_subsystem import TWICE
from tests.checker.test_fixed_spectrum import UNEVEN
from tests.checker.test_sentences_design import OF_DESIGNS, seen_and_driven_apart
from tests.checker.test_shared_dimensions import FREE, STABLE
from tests.checker.test_single_channel_gains import BLIND, CUT
from tests.wording import says

TEMPLATES = tuple(everything())
GOOD = {"IMPLIED", "REMARK"}
"""The verdicts on a sentence with which nothing is wrong."""
PAPER = gallery.load("liu2020-3ch-no-communication")
RING = NeighborGraph.ring(PAPER.names)
ONE_PART_AND_TWO = ("movable-by-periodic-gains", "hidden-triple-mode")
"""Plants whose transfer graph is strongly connected, and has two components."""


@pytest.mark.parametrize("template", TEMPLATES, ids=lambda template: template.key)
def test_the_checker_knows_every_sentence_by_its_theorem(template: Template) -> None:
    assert RULES[template.key].theorem == template.theorem


def test_the_checker_knows_no_sentence_that_is_never_said() -> None:
    assert set(RULES) == {template.key for template in TEMPLATES}


@pytest.mark.parametrize("document", [HELD, LOOP_DAMPED, LOOP_SAMPLED, QUARTERS, OBSERVED])
def test_no_rule_ends_with_a_bug_beside_certificates_about_parameters(
    tmp_path: Path, document: Document
) -> None:
    """Loops of plants within ranges have no matrices, and several parameters no one letter."""
    evidence = {"it": document}
    listed = [sentence(key, "it", evidence=evidence) for key in RULES]
    verdicts = said(write(tmp_path, evidence, manifest(evidence, listed)))
    assert [each.line() for each in verdicts if each.verdict not in GOOD | {"INVALID"}] == []
    assert len(verdicts) == len(RULES)


# Analyses and allocations, of plants that have every property somewhere.


def answers(system: MultiChannelSystem) -> dict[str, Document]:
    """The certificates of everything that can be asked, of each channel."""
    found: dict[str, Document] = {}
    asked = asked_by("links", "every-channel", "failures")
    if system.neighbors is not None:
        asked += asked_by("minimal")
        if system.time == "discrete":
            asked += asked_by("delayed")
    for name in system.names:
        analysis = analyze(system, also=asked, subset=[name], channel=name)
        for name_of, answer in analysis.decided().items():
            number = "" if name_of in found else f"_of_{system.names.index(name)}"
            found[name_of + number] = document(answer)
        asked = []
    return found


def known(folder: Path, evidence: dict[str, Document]) -> Evidence:
    """The certificates as the checker has them, all of them VALID."""
    write(folder, evidence)
    found = Evidence(lambda name: (folder / name).read_bytes(), [], Limits(), Expectation())
    for name, digest in manifest(evidence)["certificates"].items():
        assert found.taken(name, digest).verdict == "VALID", name
    return found


def casts(rule: Rule, premises: list[Premise]) -> Iterator[tuple[str, ...]]:
    """Certificates that can play the roles of a rule, one for each, in some ways.

    A role for many is played by all that fit, too.
    """
    able = [
        [each.file for each in premises if role.fits(each, True) or role.fits(each, False)]
        for role in rule.roles
    ]
    yield from itertools.islice(itertools.product(*able), 12)
    if len(rule.roles) == 1 and rule.roles[0].many and able[0]:
        yield tuple(able[0])


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
    ("allocate-least", "allocate-within"),
    ("allocate-within", "allocate-impossible"),
    ("subsystem-zeros", "subsystem-no-zeros"),
    ("lifted-nothing-fixed", "lifted-fixed"),
    ("held-nothing-fixed", "held-fixed"),
    ("decentralized-none", "fixed-besides"),
    ("quotient-fixed-none", "quotient-fixed"),
    ("structural-none", "structural-modes"),
    ("time-varying-stabilizes", "no-causal-control"),
    ("failures-stabilizable", "failures-unstable"),
    ("failures-all-stabilizable", "failures-fewest-unstable"),
    ("failures-all-none", "failures-fewest-fixed"),
]
ELSEWHERE = (
    "feedthrough",
    "modulo-",
    "nearby-",
    "law-",
    *OF_DESIGNS,
    "performance-",
    "first-",
    "parametric-",
    "periodic-",
)
"""How the rules begin that other files hold against certificates: of designs, of performance, of
parameters, of plants nearby, of plants without a part, of loops over a period."""
ALWAYS = {
    *("picture-transfer-graph", "complete"),
    *("pencil-row", "subsystem-normal-rank", "subsystem-remnant"),
    *("members-stabilizable", "members-setpoints"),
    "allocate-links-proof",
    "sharing-gap",
    "joint-fixed",
}
"""What holds of every certificate of its kind: the words say what it is that holds."""


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


def with_hidden_mode(mode: int) -> MultiChannelSystem:
    """The paper's example, of which 1 is a fixed mode, beside a state that no output shows."""
    return MultiChannelSystem(
        [[*row, 0] for row in PAPER.A.tolist()] + [[0, 0, 0, mode]],
        [[*B.tolist(), [1]] for B in PAPER.B],
        [[[*row, 0] for row in C.tolist()] for C in PAPER.C],
    )


def test_each_rule_is_implied_by_some_certificates_and_not_by_all(tmp_path: Path) -> None:
    evidence = [answers(PAPER), answers(PAPER.with_neighbors(RING))]
    evidence += map(answers, [gallery.load("quadruple-tank-pminus"), *map(drawn, range(12))])
    evidence += [answers(gallery.load(name)) for name in ONE_PART_AND_TWO]
    evidence += map(answers, [with_hidden_mode(1), with_hidden_mode(2)])
    chains = {"2": ["1"], "3": ["2"]}, {"1": ["2"], "2": ["3"]}
    evidence += [answers(seen_and_driven_apart(chain)) for chain in chains]
    evidence += [{"a": TWICE}, {"a": BLIND}, {"a": CUT}]
    evidence += [{"a": changed(BLIND, ("claim.channels", ["1"]))}]
    evidence += [{"a": changed(CUT, ("claim.property", "both"))}]
    evidence += [{"a": document(least)} for least in infeasible()]
    evidence += [
        {"a": document(generous(minimal_shared_dimensions(PAPER, RING, share)))}
        for share in get_args(Share)
    ]
    evidence += [{"a": each} for each in OF_ONE_PLANT]
    near = Box.relative(MultiChannelSystem([[1]], [[[1]]], [[[1]]]), "1/100").system
    evidence += [{"a": document(box_setpoints(near))}]
    evidence += [{"a": each} for each in (*margins_in_boxes(), CUT_OFF, NEAR)]
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
                assert verdict.verdict in {"IMPLIED", "REMARK", "INVALID"}, (key, verdict.line())
                (implied if verdict.verdict == "IMPLIED" else denied)[key].add((number, cast))
    for one_key, other in OPPOSITE:
        assert not implied[one_key] & implied[other], (one_key, other)
    about = {
        key
        for key, rule in RULES.items()
        if (rule.roles and not key.startswith(ELSEWHERE)) or rule.roles[:1] == (DIMENSIONS,)
    }
    assert not {key for key in about if not implied[key]}
    assert {key for key in about if not denied[key]} == ALWAYS


@pytest.mark.parametrize(("name", "right"), [*zip(ONE_PART_AND_TWO, ([0, 3], [1, 2]), strict=True)])
def test_time_varying_control_is_judged_by_strong_components_alone(
    tmp_path: Path, name: str, right: list[int]
) -> None:
    plant = gallery.load(name)
    keys = ["quotient-fixed-none", "quotient-fixed", "no-causal-control", "time-varying-stabilizes"]
    for k, parts in enumerate([[list(plant.names)], [[each] for each in plant.names]]):
        evidence = {"modes": document(fixed_spectrum(merged(plant, parts)))}
        evidence["graph"] = document(transfer_graph(plant))
        (tmp_path / str(k)).mkdir()
        listed = [sentence(key, *evidence, evidence=evidence) for key in keys]
        found = said(write(tmp_path / str(k), evidence, manifest(evidence, listed)))
        implied = [i for i, each in enumerate(found) if each.verdict == "IMPLIED"]
        assert implied == (right if k == ONE_PART_AND_TWO.index(name) else [])


@pytest.mark.parametrize(
    ("chain", "right"),
    [
        ({"2": ["1"], "3": ["2"]}, ["free-shared", "source-components"]),
        ({"1": ["2"], "2": ["3"]}, ["refused-over-links", "source-components", "stays-shared"]),
    ],
)
def test_what_any_sharing_leaves_is_judged_over_the_transitive_closure_alone(
    tmp_path: Path, chain: dict[str, list[str]], right: list[str]
) -> None:
    plant = seen_and_driven_apart(chain)
    keys = ["free-shared", "refused-over-links", "source-components", "stays-shared"]
    graph = plant.neighbors
    assert graph is not None
    paths = graph.closure().edges()
    assert len(paths) == len(graph.edges()) + 1
    every = [(j, i) for j in range(3) for i in range(3) if i != j]
    for k, links in enumerate([paths, graph.edges(), every, [*graph.edges(), every[-1]]]):
        made = augmented_outputs(add_links(plant, links))
        evidence = {"modes": document(fixed_spectrum(made))}
        (tmp_path / str(k)).mkdir()
        listed = [sentence(key, *evidence, evidence=evidence) for key in keys]
        found = said(write(tmp_path / str(k), evidence, manifest(evidence, listed)))
        implied = [key for key, each in zip(keys, found, strict=True) if each.verdict == "IMPLIED"]
        assert implied == (right if {*links} == {*paths} else [])


def test_an_exponent_of_a_product_does_not_limit_how_often_one_root_stays(tmp_path: Path) -> None:
    """In every loop x(x − 1) divides once, and x twice: gains move 1 eigenvalue of 4."""
    plant = MultiChannelSystem(
        [[0, 1, 1, 0], [0, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
        [[[0], [0], [0], [1]]],
        [[[0, 0, 0, 1]]],
    )
    split, spectrum = document(assignability(plant)), document(fixed_spectrum(plant))
    assert split["system"] == UNEVEN["system"]
    for proof, words in ((UNEVEN, "from 0 to 1"), (spectrum, "1")):
        evidence = {"fixed": proof, "split": split}
        found = [
            one(tmp_path, sentence(key, *evidence, evidence=evidence), evidence)
            for key in ("spectrum-moved-between", "spectrum-moved")
        ]
        assert f": gains move {words} of the 4 eigenvalues [" in found[0].statement
        assert (found[1].verdict == "IMPLIED") == (proof is spectrum), found[1].line()


def chains(rng: random.Random) -> MultiChannelSystem:
    """Chains of two states at 0 and at 1, of each of which gains move one state or none."""
    n = 4
    A, B, C = [[0] * n for _ in range(n)], [[0] for _ in range(n)], [0] * n
    for k, root in ((0, 0), (2, 1)):
        A[k][k], A[k][k + 1], A[k + 1][k + 1] = root, 1, root
        B[k][0], C[k] = rng.randrange(2), 1
    for _ in range(6):  # the same system in other coordinates
        i, j = rng.sample(range(n), 2)
        A[i] = [a + b for a, b in zip(A[i], A[j], strict=True)]
        for row in A:
            row[j] -= row[i]
        B[i][0] += B[j][0]
        C[j] -= C[i]
    return MultiChannelSystem(A, [B], [[C]])


def test_however_factors_are_joined_the_bounds_on_what_gains_move_hold(tmp_path: Path) -> None:
    uneven = 0
    for seed in range(60):
        rng = random.Random(seed)
        plant = chains(rng)
        spectrum = document(fixed_spectrum(plant))
        factors = spectrum["claim"]["factors"]
        stays = [factor["multiplicity_at_most"] for factor in factors]
        joined = factors_joined(rng, spectrum)
        if joined is not None:
            uneven += min(stays) < max(stays)
            evidence = {"fixed": joined, "split": document(assignability(plant))}
            what = sentence("spectrum-moved-between", *evidence, evidence=evidence)
            words = one(tmp_path, what, evidence).statement.rpartition("gains move ")[2]
            between = words.partition(" of ")[0].removeprefix("from ").split(" to ")
            least, most = int(between[0]), int(between[-1])
            assert least <= plant.n - sum(stays) <= most
    assert uneven > 5


def test_a_text_counts_as_the_checker_does_where_a_factor_is_longer() -> None:
    """x² + 1 stays once in drawn loops and is twice in χ_A: it is not proved irreducible."""
    J = [[0, -1], [1, 0]]
    twice = [[*row, 0, 0] for row in J] + [[0, 0, *row] for row in J]
    plant = MultiChannelSystem(twice, [[[0], [0], [1], [0]]], [[[0, 0, 1, 0]]])
    account = analyze(plant).account
    assert says(map(str, account.sentences.at("table")), "eigenvalues moved")
    (factor,) = analyze(plant).fixed_spectrum.factors
    assert (factor.multiplicity_in_A, factor.multiplicity_at_most) == (2, 1)


MODE = "mode of real part at least -1 that is fixed under linear time-invariant decentralized"
CUTS = [
    (
        "allocate-reason",
        STABLE,
        f'for no {MODE} control, sharing sub-states without delay, {{"2", "3"}} receives from '
        '{"1"}, which must share at least 1 sub-state in all: the roots of x - 1',
    ),
    (
        "allocate-reason-cut-off",
        FREE,
        "for a strongly connected transfer graph, sharing sub-states without delay, "
        '{"2"} receives from {"1"}, which must share at least 1 sub-state in all: the others do '
        "not act on it",
    ),
]


@pytest.mark.parametrize(("key", "least", "words"), CUTS, ids=[key for key, *_ in CUTS])
def test_a_cut_says_what_it_is_needed_for_and_what_is_shared(
    tmp_path: Path, key: str, least: Document, words: str
) -> None:
    found = one(tmp_path, sentence(key, "least", evidence={"least": least}), {"least": least})
    assert words in found.statement


# What the package says of systems.


def accounts(start: int, stop: int) -> Iterator[Account]:
    """What is said of drawn plants when a lot is asked, and of what their agents have to share."""
    for seed in range(start, stop):
        system, rng = drawn(seed), random.Random(seed)
        yield asking(system, **question(system, rng)).account
        if system.neighbors is None:
            system = system.with_neighbors(NeighborGraph.ring(system.names))
        share, bound = rng.choice(get_args(Share)), rng.choice([None, Fraction(1, 2)])
        region = None if bound is None else StabilityRegion(system.time, bound)
        free, costs = rng.random() < 0.3, [rng.randint(1, 2) for _ in system.names]
        yield account_of_dimensions(
            system, share=share, region=region, free_assignability=free, costs=costs
        )
        yield account_of_links(system, region=region)


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
        assert not [verdict.line() for verdict in found if verdict.verdict not in GOOD]


def test_what_is_said_of_derived_systems_is_implied(tmp_path: Path) -> None:
    system = extended_system(PAPER.with_neighbors(RING), [0, 0, 1], "outputs+states")
    for number, information in enumerate(("own", "outputs")):
        account = analyze(system, information=information).account
        found = told(tmp_path / str(number), account, account.manifest())
        assert {verdict.verdict for verdict in found} == GOOD
        assert all(says(verdict.statement, "extended") for verdict in found)
        bare = {key: value for key, value in account.manifest().items() if key != "subject"}
        found = told(tmp_path / str(number), account, bare)
        assert {verdict.verdict for verdict in found} == {*GOOD, "INVALID"}


def text_in(texts: dict[str, str], name: str) -> bytes:
    """The text of this name."""
    return texts[name].encode("ascii")


def test_no_sentence_is_implied_on_fewer_grounds_or_on_false_ones() -> None:
    """Without a premise it is not, or says the same without it; with another value it is not."""
    for account in accounts(0, 4):
        whole = plain(account.manifest())
        found = Evidence(partial(text_in, account.certificates), [], Limits(), Expectation())
        for name, digest in whole["certificates"].items():
            assert found.taken(name, digest).verdict == "VALID"
        for what in whole["sentences"]:
            words = found.judged(what, "").statement.rpartition(" from ")[0]
            for name in {name for name, *_ in what["because"]}:
                rest = [entry for entry in what["because"] if entry[0] != name]
                left = found.judged(what | {"because": rest}, "")
                same = left.statement.rpartition(" from ")[0] == words
                assert left.verdict == "INVALID" or same or not RULES[what["rule"]].roles
            for k, (name, pointer, value) in enumerate(what["because"]):
                false = [name, pointer, 7 if value != 7 else 8]
                because = [*what["because"][:k], false, *what["because"][k + 1 :]]
                assert found.judged(what | {"because": because}, "").code == "value"


REMARKS = {each.key for each in TEMPLATES if not each.claims}
"""Titles, and what is not decided or not proved, as the package marks them."""


def of_different_plants() -> Iterator[dict[str, Document]]:
    """Certificates about plants that differ in everything, two with loops, two with parameters."""
    for A, B, C, heard, controller, rate in (
        ([[1]], [[[1]], [[0]]], [[[1]], [[1]]], {"1": ["2"]}, [[[-3]], [[0]]], "1/2"),
        (
            *([[2, 0], [0, -1]], [[[0], [0]], [[1], [1]]], [[[1, 0]], [[0, 1]]], {"2": ["1"]}),
            *([[[0]], ([[-5]], [["1/7"]], [[-6]], [[0]])], None),
        ),
    ):
        plant = MultiChannelSystem(A, B, C, neighbors=heard)
        loop = certify_controller(plant, local_controllers(plant, controller), rate=rate)
        yield {"graph": document(transfer_graph(plant)), "loop": document(loop)}
    for t in "st":
        family = ParametricSystem([[t]], [[[1]]], [[[1]]], parameters=[t])
        yield {"modes": document(fixed_spectrum(family))}


def test_a_rule_that_would_say_the_same_of_every_system_is_marked_as_a_remark(
    tmp_path: Path,
) -> None:
    """Nothing is claimed by it, so that it must not be counted as proved."""
    assert {key for key, rule in RULES.items() if not rule.claims} == REMARKS
    plants = []
    for k, documents in enumerate(of_different_plants()):
        (tmp_path / str(k)).mkdir()
        plants.append(known(tmp_path / str(k), documents))
    for key in (key for key, rule in RULES.items() if not rule.roles):
        what = {"text": "", "rule": key, "theorem": "", "because": []}
        found = [each.judged(what, "") for each in plants]
        said = [re.sub("[0-9a-f]{64}", "", each.statement) for each in found if not each.status]
        if key in REMARKS:
            assert [each.verdict for each in found] == ["REMARK"] * len(plants), key
            assert len(set(said)) == 1 and f"{key} claims nothing" in said[0]
        else:
            assert {each.verdict for each in found} <= {"IMPLIED", "INVALID"}, key
            assert len(said) == len(set(said)) >= 2, (key, said)
