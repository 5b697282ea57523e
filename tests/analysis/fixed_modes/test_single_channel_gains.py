"""Gains for single channels: what they reach, and why there are none."""

from __future__ import annotations

import random

import pytest

from mcexact import MultiChannelSystem, completeness
from mcexact.analysis.single_channel import Want
from mcexact.answer.protocol import encode
from mcexact.answer.structure import GainsWitness, UnreachedWitness
from mcexact.checker.kinds import check_document
from mcexact.derived.constructions import dual
from mcexact.errors import UsageError
from mcexact.exact.linear_algebra import minimal_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.questions import single_channel_gains
from tests.oracle import enumeration, structure
from tests.oracle.draws import exact, sparse_system
from tests.wording import refusal


def closed(system: MultiChannelSystem, gains: tuple[Matrix, ...]) -> Matrix:
    """A_F."""
    A = system.A
    for channel, F in zip(system.channels, gains, strict=True):
        A = A + channel.B @ F @ channel.C
    return A


def test_the_gains_reach_exactly_the_indices_that_are_said() -> None:
    rng, found_any = random.Random(4), 0
    for _ in range(80):
        system = exact(sparse_system(rng, 4, 3))
        found = single_channel_gains(system, cyclic=True)
        assert check_document(encode(found).encode()).verdict == "VALID"
        if found.gains is None or found.indices is None:
            assert not isinstance(found.evidence, GainsWitness)
            continue
        found_any += 1
        A_F = closed(system, found.gains)
        assert minimal_polynomial(A_F).degree == system.n
        for q, (control, observe) in enumerate(found.indices):
            for A, B, index in (
                (A_F, system.B(q), control),
                (A_F.T, system.C(q).T, observe),
            ):
                rows = [list(map(list, M.rows())) for M in (A, B)]
                ranks = structure.index_ranks(*rows)
                assert ranks[-1:] == [system.n]
                assert len(ranks) == index
    assert found_any > 10


def test_every_channel_can_do_both_iff_the_system_is_complete() -> None:
    rng, seen = random.Random(6), set()
    for _ in range(150):
        system = exact(sparse_system(rng, 4, 3))
        complete = completeness(system).complete
        assert single_channel_gains(system).exists == complete
        seen.add(complete)
    assert seen == {True, False}


def test_one_channel_is_decided_as_by_subsets_and_reachability() -> None:
    rng, seen = random.Random(7), set()
    for _ in range(150):
        small = sparse_system(rng, 4, 3)
        q = rng.randrange(small.m)
        system = exact(small)
        side: Want
        for side, view in (("controllable", small), ("observable", small.dual)):
            found = single_channel_gains(system, system.names[q], want=side)
            assert found.exists == structure.single_channel(view, q)
            seen.add((side, found.exists))
    assert len(seen) == 4


def test_observability_is_controllability_of_the_dual() -> None:
    rng = random.Random(8)
    for _ in range(40):
        system = exact(sparse_system(rng, 4, 3))
        first = single_channel_gains(system, want="observable")
        assert first.exists == single_channel_gains(dual(system), want="controllable").exists


def test_where_no_gains_are_needed_none_are_used() -> None:
    chain = MultiChannelSystem([[0, 0], [1, 0]], [[[1], [0]]], [[[0, 1]]])
    found = single_channel_gains(chain)
    assert found.gains is not None
    assert all(F.is_zero() for F in found.gains)
    assert found.indices == ((2, 2),)


def test_gains_stay_small() -> None:
    n = 8
    A = [[0] * n for _ in range(n)]
    B = [[[int(i == k)] for i in range(n)] for k in range(n)]
    C = [[[int(j == (k + 1) % n) for j in range(n)]] for k in range(n)]
    found = single_channel_gains(MultiChannelSystem(A, B, C))
    assert found.gains is not None
    assert max(abs(F[0, 0]) for F in found.gains) <= 8


def test_a_dead_channel_can_do_nothing_and_hinders_nobody() -> None:
    live = ([[1]], [[1]])
    system = MultiChannelSystem([[1]], [live[0], [[0]]], [live[1], [[0]]])
    assert single_channel_gains(system, "1").exists
    found = single_channel_gains(system, "2")
    assert not found.exists
    assert isinstance(found.evidence, UnreachedWitness)
    assert found.evidence.channel == "2"
    assert not single_channel_gains(system).exists


def test_without_states_everything_is_reached() -> None:
    system = MultiChannelSystem([], [Matrix.zeros(0, 1)], [Matrix.zeros(1, 0)])
    found = single_channel_gains(system, cyclic=True)
    assert found.indices == ((0, 0),)
    assert check_document(encode(found).encode()).verdict == "VALID"


def test_bad_questions_are_refused() -> None:
    system = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    with pytest.raises(UsageError, match='want: expected "controllable", "observable" or "both"'):
        single_channel_gains(system, want="stable")  # type: ignore[arg-type]
    with refusal(UsageError):
        single_channel_gains(system, want="observable", cyclic=True)
    with pytest.raises(UsageError):
        single_channel_gains(system, "nobody")


def test_the_same_question_has_the_same_answer() -> None:
    small = sparse_system(random.Random(12), 4, 3)
    first, second = (encode(single_channel_gains(exact(small))) for _ in range(2))
    assert first == second
    assert enumeration.plain(exact(small)) == small
