"""Joint controllability and observability, with what escapes them."""

import random
from collections import Counter
from fractions import Fraction

import pytest

from mcexact.analysis import controllability
from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.answer import protocol
from mcexact.answer.structure import ByBlocks
from mcexact.checker.kinds import check_document
from mcexact.derived.constructions import dual
from mcexact.errors import UsageError
from mcexact.exact.krylov import controllable_subspace
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model import gallery
from mcexact.model.system import MultiChannelSystem
from tests.oracle.draws import exact, sparse_system


@pytest.mark.parametrize("name", gallery.names())
def test_published_systems_have_the_published_answers(name: str) -> None:
    system, wanted = gallery.load(name), gallery.expected(name)
    for answer, key in (
        (joint_controllability(system), "jointly_controllable"),
        (joint_observability(system), "jointly_observable"),
    ):
        assert answer.controllable == wanted[key]
        assert check_document(protocol.encode(answer).encode()).verdict == "VALID"


def test_a_diagonal_system_of_20_states_is_controllable_from_one_input() -> None:
    """In floating point the rank of this matrix [B, AB, …] is 7."""
    A = [[(i + 1) * (i == j) for j in range(20)] for i in range(20)]
    system = MultiChannelSystem(A, [[[1]] * 20], [[[1] * 20]])
    assert joint_controllability(system).dimension == 20


def test_some_channels_leave_what_the_others_alone_drive() -> None:
    A = [[1, 0, 0], [0, 2, 1], [0, 0, 2]]
    B = [[[1], [0], [0]], [[0], [0], [1]]]
    system = MultiChannelSystem(A, B, [[[1, 1, 1]], [[1, 1, 1]]], names=["left", "right"])
    left = joint_controllability(system, ["left"])
    assert left.dimension == 1
    assert left.uncontrollable_polynomial == Polynomial.from_roots([2, 2])
    assert joint_controllability(system, ["right"]).uncontrollable_polynomial.degree == 1
    assert joint_controllability(system).controllable
    nobody = joint_controllability(system, [])
    assert nobody.dimension == 0
    assert nobody.uncontrollable_polynomial == Polynomial.from_roots([1, 2, 2])
    with pytest.raises(UsageError, match="no channel"):
        joint_controllability(system, ["middle"])


def test_the_annihilator_certifies_long_rational_entries() -> None:
    """The controllable line is spanned by a vector whose entries need several primes."""
    huge = 10**60 + 7
    v = Matrix.column([1, Fraction(huge, 3**50), Fraction(-(7**40), huge)])
    A = Matrix.identity(3) + v @ Matrix.from_rows([[1, 0, 0]])
    found = controllable_subspace(A, v, random.Random(0))
    assert found.dimension == 1
    assert (found.X - v).is_zero()
    W = found.annihilator()
    assert (W @ v).is_zero()
    assert W.take(cols=found.free) == Matrix.identity(2)


def test_observability_is_controllability_of_the_dual() -> None:
    rng = random.Random(4)
    for _ in range(20):
        system = exact(sparse_system(rng))
        ours, theirs = joint_observability(system), joint_controllability(dual(system))
        assert ours.dimension == theirs.dimension
        assert ours.uncontrollable_polynomial == theirs.uncontrollable_polynomial


def test_a_system_without_states_is_controllable_and_observable() -> None:
    system = MultiChannelSystem([], [Matrix.zeros(0, 1)], [Matrix.zeros(1, 0)])
    for answer in (joint_controllability(system), joint_observability(system)):
        assert answer.controllable
        assert check_document(protocol.encode(answer).encode()).verdict == "VALID"


def answers_by_blocks(number: int, monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """Compare the answers that large systems get with those of small ones; count the evidence."""
    rng, counted = random.Random(number), Counter[str]()
    system = exact(sparse_system(rng))
    subsets = [None, [], system.names[:1], [name for name in system.names if rng.random() < 0.5]]
    spectrum = fixed_spectrum(system)
    for decide in (joint_controllability, joint_observability):
        for channels in subsets:
            expected = decide(system, channels)
            with monkeypatch.context() as patched:
                patched.setattr(controllability, "_SMALL", -1)
                found = decide(system, channels)
                assert found == decide(system, channels, spectrum=spectrum)
            assert found.claim() == expected.claim()
            assert check_document(protocol.encode(found).encode()).verdict == "VALID"
            assert check_document(protocol.encode(expected).encode()).verdict == "VALID"
            kind = "rank" if found.channels else "nobody"
            if isinstance(found.evidence, ByBlocks):
                kind = "own outputs" if found.evidence.measured is None else "states"
            counted[f"{kind}, {'all' if found.controllable else 'part'}"] += 1
    return counted


def test_blocks_say_what_ranks_say(monkeypatch: pytest.MonkeyPatch) -> None:
    counted = sum((answers_by_blocks(k, monkeypatch) for k in range(40)), Counter[str]())
    assert set(counted) >= {"own outputs, all", "states, all", "states, part"}
    assert counted["rank, all"] + counted["rank, part"] <= counted.total() // 20, counted
