"""Pencils of subsystems: normal rank, zeros, remnant polynomial, completeness."""

from __future__ import annotations

import random
from itertools import pairwise

import pytest
from hypothesis import given

from mcexact import MultiChannelSystem, completeness
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.constructions import dual
from mcexact.derived.drawn.systems import Drawn
from mcexact.errors import UsageError
from mcexact.exact.linear_algebra import characteristic_polynomial, companions, invariant_form, rank
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial, product
from mcexact.model import gallery
from mcexact.questions import complementary_subsystem
from mcexact.testing import systems_with_remnant
from tests.oracle import enumeration
from tests.oracle.draws import exact, sparse_system


def certified(system: MultiChannelSystem, s: list[str]) -> object:
    """The answer, after its certificate was found VALID."""
    found = complementary_subsystem(system, s)
    verdict = check_document(encode(found).encode())
    assert verdict.verdict == "VALID", verdict.line()
    return found


@given(systems_with_remnant(max_states=4))
def test_the_prescribed_remnant_polynomial_is_found(drawn: Drawn) -> None:
    assert drawn.subset is not None
    names = drawn.system.named(drawn.subset)
    found = complementary_subsystem(drawn.system, names)
    assert found.remnant == drawn.remnant
    assert check_document(encode(found).encode()).verdict == "VALID"


def test_rank_at_a_zero_is_that_of_the_pencil() -> None:
    rng = random.Random(5)
    zeros = 0
    for _ in range(80):
        small = sparse_system(rng, 4, 3)
        system = exact(small)
        if system.m < 2:
            continue
        s = tuple(range(rng.randint(1, system.m - 1)))
        found = complementary_subsystem(system, system.named(s))
        for zero in found.zeros:
            zeros += 1
            p = zero.polynomial.coefficients
            assert zero.rank == enumeration.pencil_rank(small, s, p) < found.normal_rank
            assert len(zero.roots) == zero.polynomial.degree
    assert zeros > 20


def test_the_dual_with_the_complement_has_the_same_zeros() -> None:
    rng = random.Random(9)
    for _ in range(40):
        system = exact(sparse_system(rng, 4, 3))
        if system.m < 2:
            continue
        found = complementary_subsystem(system, system.names[:1])
        turned = complementary_subsystem(dual(system), system.names[1:])
        assert turned.invariant_polynomials == found.invariant_polynomials
        assert turned.remnant == found.remnant
        assert turned.complete == found.complete


def test_complete_means_every_subsystem_is_where_all_is_controlled_and_observed() -> None:
    rng, seen = random.Random(3), set()
    for _ in range(150):
        small = sparse_system(rng, 3, 3)
        system = exact(small)
        dimensions = [enumeration.controllable_dimension(v) for v in (small, small.dual)]
        if dimensions != [small.n, small.n]:
            continue
        parts = [
            complementary_subsystem(system, system.named(s)).complete
            for s in enumeration.subsets(system.m)
            if 0 < len(s) < system.m
        ]
        assert completeness(system).complete == all(parts)
        seen.add((all(parts), len(parts) > 0))
    assert {(True, True), (False, True)} <= seen


def test_two_zeros_at_one_place_leave_a_remnant_polynomial() -> None:
    port = ([[1], [0], [0]], [[1, 0, 0]])
    twice = MultiChannelSystem([[1, 0, 0], [0, 2, 0], [0, 0, 2]], [port[0]] * 2, [port[1]] * 2)
    found = certified(twice, ["1"])
    assert str(found.remnant) == "x - 2"  # type: ignore[attr-defined]
    apart = MultiChannelSystem([[1, 0, 0], [0, 2, 0], [0, 0, 3]], [port[0]] * 2, [port[1]] * 2)
    found = certified(apart, ["1"])
    assert [str(f) for f in found.invariant_polynomials] == ["x^2 - 5*x + 6"]  # type: ignore[attr-defined]
    assert found.complete  # type: ignore[attr-defined]


def test_the_paper_says_why_its_example_is_incomplete() -> None:
    system = gallery.load("liu2020-3ch-no-communication")
    found = complementary_subsystem(system, ["2", "3"])
    assert found.transfer_zero
    assert [zeros.rank for zeros in found.zeros] == [2]


def test_a_quadruple_tank_of_nonminimum_phase_has_its_zero() -> None:
    for name in gallery.names():
        system = gallery.load(name)
        if 1 < system.m <= 3 and system.n <= 8:
            certified(system, list(system.names[:1]))


@pytest.mark.parametrize("s", [[], ["1", "2"]])
def test_no_channel_and_all_channels_leave_no_subsystem(s: list[str]) -> None:
    system = MultiChannelSystem([[0]], [[[1]]] * 2, [[[1]]] * 2)
    with pytest.raises(UsageError, match="nonempty proper subset"):
        complementary_subsystem(system, s)


@pytest.mark.parametrize(
    "system",
    [
        MultiChannelSystem([], [Matrix.zeros(0, 1)] * 2, [Matrix.zeros(1, 0)] * 2),
        MultiChannelSystem([[0]], [Matrix.zeros(1, 0)] * 2, [Matrix.zeros(0, 1)] * 2),
        MultiChannelSystem([[0]], [[[0]]] * 2, [[[0]]] * 2),
        MultiChannelSystem([[0, 2], [1, 0]], [[[1], [0]]] * 2, [[[0, 0]], [[1, 0]]]),
        MultiChannelSystem([["1/3", 10**30], [0, "-1/7"]], [[[0], [1]]] * 2, [[[1, 0]]] * 2),
    ],
    ids=["no states", "no ports", "ports of zeros", "irrational modes", "long numbers"],
)
def test_edges_are_certified(system: MultiChannelSystem) -> None:
    certified(system, ["1"])
    certified(system, ["2"])


def test_the_rational_canonical_form_is_similar_and_its_polynomials_divide() -> None:
    rng = random.Random(2)
    for _ in range(30):
        n = rng.randint(0, 5)
        Z = Matrix.from_rows(
            [[rng.choice([0, 0, 0, 1, -1]) for _ in range(n)] for _ in range(n)], ncols=n
        )
        T, found = invariant_form(Z, rng)
        assert rank(T) == n
        assert Z @ T == T @ companions(found)
        assert product(found) == characteristic_polynomial(Z)
        assert all(f.divides(g) for f, g in pairwise(found))
    assert invariant_form(Matrix.zeros(2, 2), rng)[1] == (Polynomial.of(0, 1),) * 2
