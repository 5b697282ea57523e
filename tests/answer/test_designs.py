"""What `allocate`, `design` and `certify` say is made by templates whose premises are certified."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

import pytest

from mcexact.analysis.accounts import account_of_dimensions, account_of_links
from mcexact.answer import codec
from mcexact.answer.listing import TOPICS, premises_of
from mcexact.checker import check_document
from mcexact.errors import Impossible, LimitReached
from mcexact.model import gallery
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.report.account import tables
from mcexact.report.design_view import design_tables, verdict_tables
from mcexact.report.text import Table, plain
from mcexact.synthesis.certify import certify_controller
from mcexact.synthesis.decentralized import design_decentralized
from mcexact.synthesis.extended import design_extended
from mcexact.synthesis.observer import design_observer
from mcexact.synthesis.setpoint import design_setpoint
from tests.answer.reading import texts_of_plain
from tests.answer.test_sentences import drawn, known_texts, match, require_certified, require_known

CHROME = {
    "why",
    "agent | least",
    "agent | least | Theorem 2's bound",
    "agent | least | Remark 2's bound",
    "these agents | can receive from | need | because of",
    "from | to | cost",
}
LOOPS = {"closed_loop_spectrum", "stability", "distributed_observer"}


def require_made(topic: str, tables: tuple[Table, ...], certificates: dict[str, bytes]) -> None:
    """Every text is made by a template, and its premises are among the certificates, all VALID."""
    for name, data in certificates.items():
        assert check_document(data).verdict == "VALID", name
    known = set(certificates) | ({"loop"} if LOOPS & set(certificates) else set())
    for text in texts_of_plain(plain(tables, width=10**6)):
        if text not in CHROME:
            template = match(text, topic)
            seen = premises_of(template, TOPICS[topic][0])
            assert set(seen) <= known, (template.key, known)


def encoded(certificates: dict[str, Any]) -> dict[str, bytes]:
    return {name: codec.encode(made).encode("ascii") for name, made in certificates.items()}


@pytest.mark.parametrize("start", range(0, 60, 10))
def test_what_is_said_of_allocations(start: int) -> None:
    for seed in range(start, start + 10):
        plant, rng = drawn(seed), random.Random(seed)
        if plant.neighbors is None:
            plant = plant.with_neighbors(NeighborGraph.ring(plant.names))
        bound = rng.choice([None, Fraction(1, 2)])
        share = rng.choice(["outputs+states", "states"])
        free = rng.random() < 0.3
        asked = {"share": share, "bound": bound, "free_assignability": free}
        if rng.random() < 0.5:
            asked["costs"] = [rng.randint(1, 9) for _ in plant.names]
        if rng.random() < 0.3:
            asked["upper"] = [rng.choice([None, 0, 1]) for _ in plant.names]
        links: dict[str, Any] = {"dimensions": None, "bound": bound}
        if rng.random() < 0.5:
            links |= {"dimensions": [rng.randint(0, 1) for _ in plant.names], "share": share}
        for topic, account in (
            ("allocate", account_of_dimensions(plant, **asked)),
            ("allocate --arcs", account_of_links(plant, **links)),
        ):
            require_certified(account, topic)
            texts = texts_of_plain(plain(tables(account.sentences), width=10**6))
            require_known([text for text in texts if text not in CHROME], known_texts(account))


def wanted(plant: MultiChannelSystem) -> dict[str, Any]:
    return {"rate": "1/10"} if plant.time == "continuous" else {"radius": "9/10"}


DESIGNS = {
    "observer": design_observer,
    "decentralized": design_decentralized,
    "extended": design_extended,
    "setpoint": design_setpoint,
}


@pytest.mark.parametrize("name", sorted(DESIGNS))
@pytest.mark.parametrize("seed", range(12))
def test_what_is_said_of_designs_and_of_refusals(name: str, seed: int) -> None:
    plant = drawn(seed)
    if plant.neighbors is None or plant.n > 3:
        plant = gallery.load("liu2020-3ch-no-communication")
        plant = plant.with_neighbors(NeighborGraph.ring(plant.names))
    try:
        design = DESIGNS[name](plant, arithmetic="float", **wanted(plant))
    except LimitReached:
        return
    except Impossible as refusal:
        template = match(str(refusal), "design, where there is none")
        assert template.key.startswith("refused-")
        assert refusal.certificate.kind
        data = codec.encode(refusal.certificate).encode("ascii")
        assert check_document(data).verdict == "VALID"
        return
    # The second table is measured, not proved.
    require_made("design, certify", design_tables(design)[:1], encoded(design.certificates))


@pytest.mark.parametrize(
    "options", [{}, {"rate": 50}, {"method": "lyapunov"}, {"largest": True}], ids=str
)
def test_what_is_said_of_controllers(options: dict[str, Any]) -> None:
    plant = gallery.load("quadruple-tank-pminus")
    design = design_decentralized(plant, rate="1/100", arithmetic="float")
    found = certify_controller(plant, design.controller, **options)
    require_made("design, certify", verdict_tables(found), encoded({"stability": found}))
