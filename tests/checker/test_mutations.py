"""A few certificates of every registered kind under the mutation engine."""

from __future__ import annotations

import pytest

from mcexact.checker.kinds import KINDS
from tests.checker.handmade import VALID, Document, checked
from tests.checker.mutations import Tally, attack, draws, mutants, registrations

REGISTERED = registrations()


def test_every_kind_of_the_checker_is_registered() -> None:
    assert set(REGISTERED) == set(KINDS)


@pytest.mark.parametrize("document", VALID.values(), ids=list(VALID))
def test_no_mutant_of_a_handmade_certificate_is_accepted_for_nothing(document: Document) -> None:
    registered = REGISTERED[document["kind"]]
    assert registered.confirms(document)
    tally = Tally()
    attack(document, registered, tally)
    assert tally.failures == []
    assert sum(tally.rejected.values()) > tally.mutants / 2


@pytest.mark.parametrize("kind", sorted(REGISTERED))
def test_no_mutant_of_a_drawn_certificate_is_accepted_for_nothing(kind: str) -> None:
    tally = Tally()
    for document in draws(2, {kind: REGISTERED[kind]}):
        assert checked(document).verdict == "VALID"
        assert REGISTERED[kind].confirms(document)
        attack(document, REGISTERED[kind], tally)
    assert tally.failures == []


def test_every_place_of_a_document_is_changed() -> None:
    document = VALID["the paper's fixed mode"]
    changed = {what.rpartition(":")[0] or what for what, _ in mutants(document)}
    for place in (
        "witness.modulus",
        "claim.factors.0.roots.0.radius",
        "system.neighbors.3.0",
        "witness.subspaces.0.U.coefficients.0.2.1",
        "claim.stabilizable",
    ):
        assert any(what.startswith(place) for what in changed), place
