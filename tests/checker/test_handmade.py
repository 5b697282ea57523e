"""Certificates written by hand are valid, and say in words what they claim."""

from __future__ import annotations

import pytest

from mcexact.checker.kinds import KINDS
from tests.checker.handmade import FIXED, FREE, GRAPH, OSCILLATION, VALID, Document, checked


@pytest.mark.parametrize("document", VALID.values(), ids=list(VALID))
def test_every_handmade_certificate_is_valid(document: Document) -> None:
    verdict = checked(document)
    assert verdict.verdict == "VALID", verdict.line()
    assert len(verdict.line().splitlines()) == 1


def test_the_theorem_states_the_claim_in_words() -> None:
    assert checked(FIXED).theorem == (
        "the fixed spectrum of the plant (continuous time, 3 states, 3 channels) is that of x - 1: "
        "x - 1 (exponent 3 in det(xI - A), at most 1 in the gcd of all det(xI - A_F); least pencil "
        "rank 2, reached by the channels {2, 3}; not stable; roots 1 +- 0); not stabilizable by "
        "linear time-invariant decentralized control; minus the largest real part of a fixed mode "
        "is between -1 and -1"
    )
    assert "roots 0 - 1i +- 1/4, 0 + 1i +- 1/4" in checked(OSCILLATION).theorem
    assert checked(FREE).theorem.endswith(
        "has no fixed modes; stabilizable by linear time-invariant decentralized control"
    )
    assert "exactly: 1 -> 1, 1 -> 2, 2 -> 2; strong components {1} {2}" in checked(GRAPH).theorem


def test_every_kind_of_the_spine_has_a_handmade_certificate() -> None:
    spine = {document["kind"] for document in VALID.values()}
    assert spine <= set(KINDS)
    assert len(spine) == 8
