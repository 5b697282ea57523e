"""Certificates written by hand are valid, and say in words what they claim."""

from __future__ import annotations

import pytest

from mcexact.checker.kinds import KINDS
from mcexact.checker.system import digest, read_plant
from tests.checker.handmade import FIXED, FREE, GRAPH, OSCILLATION, PAPER, VALID, Document, checked


@pytest.mark.parametrize("document", VALID.values(), ids=list(VALID))
def test_every_handmade_certificate_is_valid(document: Document) -> None:
    verdict = checked(document)
    assert verdict.verdict == "VALID", verdict.line()
    assert len(verdict.line().splitlines()) == 1


def test_the_theorem_states_the_claim_in_words() -> None:
    assert checked(FIXED).statement == (
        f"For the plant {digest(read_plant(PAPER))} "
        '(3 states, channels {"1", "2", "3"}, continuous time): the modes that are fixed under '
        "linear time-invariant decentralized control are the roots of x - 1; x - 1 is not Hurwitz, "
        "has the exponent 3 in det(xI - A) and at most 1 in the greatest common divisor of "
        "det(xI - A_F) over all constant gains F, and one root in each of the discs {1 +- 0}, "
        "where the least rank of [xI - A, B; C, 0] over all sets of channels, C the outputs of the "
        'set and B the inputs of the others, is 2, reached by {"2", "3"}; it is not stabilizable '
        "by linear time-invariant decentralized control; minus the largest real part of a fixed "
        "mode is from -1 to -1"
    )
    assert "discs {0 - 1i +- 1/4, 0 + 1i +- 1/4}" in checked(OSCILLATION).statement
    assert checked(FREE).statement.endswith(
        "no mode is fixed under linear time-invariant decentralized control; it is stabilizable by "
        "linear time-invariant decentralized control"
    )
    assert (
        'exactly the edges {"1" -> "1", "1" -> "2", "2" -> "2"}, the strong components {"1"}, '
        '{"2"}, and is not strongly connected'
    ) in checked(GRAPH).statement


def test_every_kind_of_the_spine_has_a_handmade_certificate() -> None:
    spine = {document["kind"] for document in VALID.values()}
    assert spine <= set(KINDS)
    assert len(spine) == 8
