"""How the spectrum splits over the strong components."""

from __future__ import annotations

import random

from mcexact import MultiChannelSystem, assignability, fixed_spectrum
from mcexact.analysis.controllability import joint_controllability
from mcexact.analysis.structure import transfer_graph
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from tests.oracle.draws import exact, sparse_system


def closed(system: MultiChannelSystem, F: list[Matrix]) -> Matrix:
    """A_F."""
    A = system.A
    for channel, gain in zip(system.channels, F, strict=True):
        A = A + channel.B @ gain @ channel.C
    return A


def drawn(system: MultiChannelSystem, rng: random.Random) -> list[Matrix]:
    return [
        Matrix.from_rows(
            [[rng.randint(-9, 9) for _ in range(system.q(i))] for _ in range(system.p(i))],
            ncols=system.q(i),
        )
        for i in range(system.m)
    ]


def test_the_gains_of_one_component_move_as_many_eigenvalues_as_are_said() -> None:
    rng, moved = random.Random(2), 0
    for _ in range(60):
        system = exact(sparse_system(rng, 4, 3))
        found = assignability(system)
        assert check_document(encode(found).encode()).verdict == "VALID"
        assert found.fixed_degree + sum(b.dimension for b in found.blocks) == system.n
        F, G = drawn(system, rng), drawn(system, rng)
        for block in found.blocks:
            c = system.indices(block.channels)
            mixed = [G[i] if i in c else F[i] for i in range(system.m)]
            before = characteristic_polynomial(closed(system, F))
            after = characteristic_polynomial(closed(system, mixed))
            # All but the part of this component is a common factor.
            assert before.gcd(after).degree >= system.n - block.dimension
            moved += before != after
    assert moved > 30


def test_without_fixed_modes_the_degrees_are_those_of_reachable_subspaces() -> None:
    rng, split = random.Random(3), 0
    for _ in range(120):
        system = exact(sparse_system(rng, 4, 4))
        if not fixed_spectrum(system).empty:
            continue
        found = assignability(system)
        assert found.fixed_degree == 0
        arcs = set(transfer_graph(system).arcs)
        for block in found.blocks:
            T = set(block.channels)
            while new := {i for j, i in arcs if j in T} - T:
                T |= new
            inside = [name for name in system.names if name in T]
            rest = [name for name in inside if name not in block.channels]
            dimensions = [
                joint_controllability(system, names).dimension for names in (inside, rest)
            ]
            assert block.dimension == dimensions[0] - dimensions[1]
        split += len(found.blocks) > 1
    assert split > 3


def test_a_state_that_two_channels_drive_and_none_measures_is_in_no_block() -> None:
    system = MultiChannelSystem([[5]], [[[1]], [[1]]], [[[0]], [[0]]])
    found = assignability(system)
    assert [block.dimension for block in found.blocks] == [0, 0]
    assert found.fixed_degree == 1
    assert found.undivided and not fixed_spectrum(system).empty


def test_one_channel_that_does_everything_is_free() -> None:
    assert assignability(MultiChannelSystem([[0]], [[[1]]], [[[1]]])).undivided
    inactive = MultiChannelSystem([[0]], [[[1]], [[0]]], [[[1]], [[1]]])
    assert assignability(inactive).undivided


def test_without_states_there_is_nothing_to_move() -> None:
    system = MultiChannelSystem([], [Matrix.zeros(0, 1)] * 2, [Matrix.zeros(1, 0)] * 2)
    found = assignability(system)
    assert found.fixed_degree == 0
    assert check_document(encode(found).encode()).verdict == "VALID"
