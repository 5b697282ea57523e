"""Certificates written by hand are valid, and say in words what they claim."""

from __future__ import annotations

import pytest

from mcexact.checker.core.system import digest, read_plant
from mcexact.checker.kinds import KINDS
from tests.checker.handmade import FIXED, FREE, GRAPH, OSCILLATION, PAPER, VALID, Document, checked
from tests.wording import says, worded


@pytest.mark.parametrize("document", VALID.values(), ids=list(VALID))
def test_every_handmade_certificate_is_valid(document: Document) -> None:
    verdict = checked(document)
    assert verdict.verdict == "VALID", verdict.line()
    assert len(verdict.line().splitlines()) == 1


def test_the_theorem_states_the_claim_in_words() -> None:
    assert (
        worded(checked(FIXED).statement) and digest(read_plant(PAPER)) in checked(FIXED).statement
    )
    assert "discs {0 - 1i +- 1/4, 0 + 1i +- 1/4}" in checked(OSCILLATION).statement
    assert says(checked(FREE).statement, "under stabilizable")
    assert says(checked(GRAPH).statement, "edges components")


def test_every_kind_of_the_spine_has_a_handmade_certificate() -> None:
    spine = {document["kind"] for document in VALID.values()}
    assert spine <= set(KINDS)
    assert len(spine) == 8
