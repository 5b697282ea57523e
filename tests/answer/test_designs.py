"""What `allocate`, `design` and `certify` say is made by templates whose premises are certified."""

from __future__ import annotations

import random
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any, get_args

import pytest

from mcexact.analysis.analyze import account_of_dimensions, account_of_links
from mcexact.answer.account import Account
from mcexact.answer.sentence import Context, Sentences
from mcexact.answer.templates import Sentence
from mcexact.checker.command import manifest_verdicts
from mcexact.checker.core.reading import Limits
from mcexact.checker.kinds import Expectation
from mcexact.derived.constructions import Share
from mcexact.errors import Impossible, LimitReached
from mcexact.exact.roots import StabilityRegion
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.report.text import plain, tables
from mcexact.synthesis.certify import account_of_verdict, certify_controller
from mcexact.synthesis.decentralized import design_decentralized, design_extended
from mcexact.synthesis.design import Design
from mcexact.synthesis.distributed_observer import design_observer
from mcexact.synthesis.setpoint import design_setpoint
from tests.answer.reading import texts_of_plain
from tests.answer.test_sentences import drawn, known_texts, require_certified, require_known

CHROME = {
    "why",
    "agent | least",
    "agent | least | Theorem 2's bound",
    "agent | least | Remark 2's bound",
    "these agents | can receive from | need | because of",
    "from | to | cost",
}


def require_said(account: Account, topic: str, folder: Path) -> None:
    """The tables are in the manifest, and the checker finds that the certificates imply them."""
    require_certified(account, topic)
    texts = texts_of_plain(plain(tables(account.sentences), width=10**6))
    require_known([text for text in texts if text not in CHROME], known_texts(account))
    account.save(folder)
    for about, verdict in manifest_verdicts(str(folder), Expectation(), Limits()):
        good = {"IMPLIED", "REMARK"} if "text" in about else {"VALID"}
        assert verdict.verdict in good, (about, verdict.line())


@pytest.mark.parametrize("start", range(0, 60, 10))
def test_what_is_said_of_allocations(start: int, tmp_path: Path) -> None:
    for seed in range(start, start + 10):
        plant, rng = drawn(seed), random.Random(seed)
        if plant.neighbors is None:
            plant = plant.with_neighbors(NeighborGraph.ring(plant.names))
        number = rng.choice([None, Fraction(1, 2)])
        region = None if number is None else StabilityRegion(plant.time, number)
        share = rng.choice(get_args(Share))
        free = rng.random() < 0.3
        asked: dict[str, Any] = {"share": share, "region": region, "free_assignability": free}
        if rng.random() < 0.5:
            asked["costs"] = [rng.randint(1, 9) for _ in plant.names]
        if rng.random() < 0.3:
            asked["upper"] = [rng.choice([None, 0, 1]) for _ in plant.names]
        links: dict[str, Any] = {"dimensions": None, "region": region}
        if rng.random() < 0.5:
            links |= {"dimensions": [rng.randint(0, 1) for _ in plant.names], "share": share}
        for topic, account in (
            ("allocate", account_of_dimensions(plant, **asked)),
            ("allocate --links", account_of_links(plant, **links)),
        ):
            require_said(account, topic, tmp_path / f"{topic}-{seed}")


def wanted(plant: MultiChannelSystem) -> dict[str, Any]:
    return {"rate": "1/10"} if plant.time == "continuous" else {"radius": "9/10"}


DESIGNS: dict[str, Callable[..., Design]] = {
    "observer": design_observer,
    "decentralized": design_decentralized,
    "extended": design_extended,
    "setpoint": design_setpoint,
}


@pytest.mark.parametrize("name", sorted(DESIGNS))
@pytest.mark.parametrize(
    "seed", [*range(4), *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(4, 12))]
)
def test_what_is_said_of_designs_and_of_refusals(name: str, seed: int, tmp_path: Path) -> None:
    plant = drawn(seed)
    if plant.neighbors is None or plant.n > 3:
        plant = gallery.load("liu2020-3ch-no-communication")
        plant = plant.with_neighbors(NeighborGraph.ring(plant.names))
    arithmetic = ("float", "exact")[seed % 2]
    try:
        design = DESIGNS[name](plant, arithmetic=arithmetic, **wanted(plant))
    except LimitReached:
        return
    except Impossible as refusal:
        said, proof = refusal.message, refusal.certificate
        assert isinstance(said, Sentence) and said.template.key.startswith("refused-")
        account = Account({proof.kind: proof}, Context(plant), Sentences([said]))
        require_certified(account, "design, if there is none")
        account.save(tmp_path)
        valid, implied = manifest_verdicts(str(tmp_path), Expectation(), Limits())
        assert [valid[1].verdict, implied[1].verdict] == ["VALID", "IMPLIED"], implied[1].line()
        return
    require_said(design.account, "design, certify", tmp_path)


@pytest.mark.parametrize(
    "options", [{}, {"rate": 50}, {"method": "lyapunov"}, {"largest": True}], ids=str
)
def test_what_is_said_of_controllers(options: dict[str, Any], tmp_path: Path) -> None:
    plant = gallery.load("quadruple-tank-pminus")
    design = design_decentralized(plant, rate="1/100", arithmetic="float")
    found = certify_controller(plant, design.controller, **options)
    account = account_of_verdict(found, largest="largest" in options)
    require_said(account, "design, certify", tmp_path)


def test_a_loop_that_was_asked_to_be_unstable_is_not_called_certified(tmp_path: Path) -> None:
    plant = gallery.load("quadruple-tank-pminus")
    unstable = {"closed_loop": ["1", "2", "3", "4", "-1", "-2", "-3"]}
    account = design_decentralized(plant, spectrum=unstable).account
    assert account.sentences.at("title") == ["closed loop"]
    require_said(account, "design, certify", tmp_path)


def test_a_design_without_a_neighbor_graph_is_said_in_json_as_in_the_tables() -> None:
    plant = gallery.load("quadruple-tank-pminus")
    account = design_decentralized(plant, rate="1/100", arithmetic="float").account
    said = {each["text"] for each in account.as_json()["sentences"]}
    assert said == {each["text"] for each in account.manifest()["sentences"]}
