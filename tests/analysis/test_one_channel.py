"""One sequence of one channel: where it is found, and that it is never more than is moved."""

from __future__ import annotations

import random

import pytest

from mcexact.analysis import blocks
from mcexact.analysis.blocks import (
    MODULI,
    STARTS,
    best_sequences,
    bounded_blocks,
    free_blocks,
    modes_left,
    state_blocks,
)
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.structure import transfer_graph
from mcexact.answer.evidence import KrylovSequence
from mcexact.answer.modes import ByBlocks, TwoPolynomials
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.derived import modular
from mcexact.exact import krylov, tables
from mcexact.exact.matrix import Matrix
from mcexact.model import gallery
from mcexact.model.system import MultiChannelSystem
from mcexact.model.text import text_of
from tests.oracle.draws import exact, sparse_system


def drawn(n: int, widths: list[tuple[int, int]], bound: int = 9) -> MultiChannelSystem:
    """A dense system with p_i inputs and q_i outputs of each channel."""
    rng = random.Random(n)

    def table(rows: int, cols: int) -> Matrix:
        entries = [[rng.randint(-bound, bound) for _ in range(cols)] for _ in range(rows)]
        return Matrix.from_integers(entries, ncols=cols)

    return MultiChannelSystem(
        table(n, n), [table(n, p) for p, _ in widths], [table(q, n) for _, q in widths]
    )


def longest(system: MultiChannelSystem) -> KrylovSequence:
    """The sequence of a system that is one block."""
    [block] = bounded_blocks(system)
    assert block.states == tuple(range(system.n))
    assert isinstance(block.evidence, KrylovSequence)
    return block.evidence


@pytest.mark.parametrize("n", [1, 2, 5, 30, 127, 128, 200])
@pytest.mark.parametrize("bound", [9, 10**6, 10**30])
def test_a_dense_system_has_a_sequence_of_all_degrees(n: int, bound: int) -> None:
    found = longest(drawn(n, [(1, 1)] * max(n // 3, 1), bound))
    assert found.degree == n
    assert found.modulus in MODULI
    assert all(0 <= c < found.modulus for c in (*found.recurrence, *found.cofactors[0]))


def test_floats_and_flint_give_the_same_sequence(monkeypatch: pytest.MonkeyPatch) -> None:
    for widths in ([(1, 1)] * 5, [(2, 3), (0, 1), (1, 0), (2, 1)]):
        system = drawn(130, widths)
        by_floats = list(best_sequences(system))
        with monkeypatch.context() as patched:
            patched.setattr(modular, "_KRYLOV_SIZE", 10**9)
            assert list(best_sequences(system)) == by_floats


def test_what_is_left_is_never_less_than_what_is_fixed() -> None:
    for seed in range(300):
        system = exact(sparse_system(random.Random(seed)), "continuous")
        spectrum = fixed_spectrum(system)
        fixed = sum((system.n - f.rank) * f.polynomial.degree for f in spectrum.factors)
        assert modes_left(bounded_blocks(system)) >= fixed
        if isinstance(spectrum.evidence, ByBlocks):
            assert modes_left(spectrum.evidence.blocks) == fixed


def test_two_moduli_that_agree_end_the_search() -> None:
    chain = MultiChannelSystem([[0, 0], [1, 0]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]])
    found = list(best_sequences(chain))
    assert [each.degree for each in found] == [1, 1]
    assert [each.modulus for each in found] == list(MODULI[:2])


def test_a_modulus_that_divides_a_denominator_is_left_out() -> None:
    first, second, third = [f"1/{ell}" for ell in MODULI]
    system = MultiChannelSystem([[first]], [[[second]]], [[[1]]])
    [found] = best_sequences(system)
    assert found.modulus == MODULI[2]
    one = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    [found] = best_sequences(one, denominator=2 * MODULI[0])
    assert found.modulus == MODULI[1]
    nothing = MultiChannelSystem([[first]], [[[second]]], [[[third]]])
    assert list(best_sequences(nothing)) == []
    assert fixed_spectrum(nothing).empty


def test_channels_without_inputs_or_outputs_are_passed_over() -> None:
    system = MultiChannelSystem(
        [[1]], [[[]], [[0]], [[2]]], [[[1]], [[1]], [[3]]], names=["none", "zero", "live"]
    )
    [found] = best_sequences(system)
    assert (found.channel, found.degree) == ("live", 1)
    dead = MultiChannelSystem([[1]], [[[0]]], [[[1]]])
    assert {each.degree for each in best_sequences(dead)} == {0}


def test_wide_channels_are_tried_with_several_combinations() -> None:
    # b and c of one combination each miss a mode; STARTS of them rarely all do
    n = 6
    I = [[int(i == j) for j in range(n)] for i in range(n)]
    found = longest(MultiChannelSystem(I, [I], [I]))
    assert STARTS > 1
    assert found.degree == n and len(found.inputs) == len(found.outputs) == n


def test_without_states_there_is_nothing_to_move() -> None:
    for m in (1, 2):
        system = MultiChannelSystem([], [[]] * m, [[]] * m)
        assert state_blocks(system) == free_blocks(system) == ()


def test_a_mode_that_stays_once_is_proved_by_one_sequence_and_a_chain_is_not() -> None:
    once = fixed_spectrum(gallery.load("compleib-cse1"))
    assert [str(factor.polynomial) for factor in once.factors] == ["x + 1"]
    assert isinstance(once.evidence, ByBlocks)
    jordan = MultiChannelSystem([[1, 1], [0, 1]], [[[0], [0]]], [[[0, 0]]])
    assert isinstance(fixed_spectrum(jordan).evidence, TwoPolynomials)


def test_factors_that_meet_modulo_the_prime_wait_for_another() -> None:
    system = MultiChannelSystem([[1, 0], [0, 1 + MODULI[0]]], [[[0], [0]]], [[[1, 1]]])
    evidence = fixed_spectrum(system).evidence
    assert isinstance(evidence, ByBlocks)
    assert evidence.modulus == MODULI[1]


@pytest.mark.parametrize("name", gallery.names())
def test_a_published_plant_whose_channels_are_connected_needs_one_sequence(name: str) -> None:
    plant = gallery.load(name)
    # the formation keeps the mode 0 in a chain of two states, which is left to two polynomials
    if transfer_graph(plant).strongly_connected and name != "formation-of-twelve":
        assert isinstance(fixed_spectrum(plant).evidence, ByBlocks)


def ring(n: int, spacing: int) -> MultiChannelSystem:
    """States in a ring, coupled to others at a distance, every so many with a channel."""
    A = [(i, (i + 1) % n, 1 + i % 5) for i in range(n)] + [(i, i, i % 3) for i in range(n)]
    A += [(i, (i * i + 7) % n, 2) for i in range(n) if (i * i + 7) % n not in (i, (i + 1) % n)]
    here = range(0, n, spacing)
    B = [Matrix.from_entries((n, 1), [(i, 0, 1)]) for i in here]
    C = [Matrix.from_entries((1, n), [(0, (i + 3) % n, 1)]) for i in here]
    return MultiChannelSystem(Matrix.from_entries((n, n), A), B, C)


def test_a_sparse_system_has_the_same_sequences_as_a_dense_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    system = ring(150, 10)
    assert system.A.is_sparse
    sparsely = list(best_sequences(system))
    with monkeypatch.context() as patched:
        patched.setattr(modular, "stays_sparse", lambda *_: False)
        assert list(best_sequences(system)) == sparsely
        patched.setattr(modular, "_KRYLOV_SIZE", 10**9)
        assert list(best_sequences(system)) == sparsely
    monkeypatch.setattr(krylov, "steps_at_once", lambda *_: 0)  # then it is computed densely
    assert list(best_sequences(system)) == sparsely


def test_large_systems_begin_with_a_larger_modulus(monkeypatch: pytest.MonkeyPatch) -> None:
    assert next(best_sequences(ring(100, 25))).modulus == MODULI[0]
    assert next(best_sequences(ring(1000, 250))).modulus == MODULI[1]  # large and sparse
    monkeypatch.setattr(blocks, "LARGE", 100)
    system = ring(100, 25)
    found = next(best_sequences(system))
    assert (found.modulus, found.degree) == (MODULI[1], 100)
    spectrum = fixed_spectrum(system)
    assert spectrum.empty
    assert check_document(encode(spectrum).encode()).verdict == "VALID"


def test_answers_do_not_depend_on_the_form_of_the_matrices(monkeypatch: pytest.MonkeyPatch) -> None:
    systems = [exact(sparse_system(random.Random(seed)), "discrete") for seed in range(100)]
    dense = [text_of(fixed_spectrum(system).claim()) for system in systems]
    monkeypatch.setattr(tables, "LEAST_SPARSE", 1)
    monkeypatch.setattr(tables, "_SHARE", 1)
    again = [exact(sparse_system(random.Random(seed)), "discrete") for seed in range(100)]
    assert sum(system.A.is_sparse for system in again) > 90
    assert [text_of(fixed_spectrum(system).claim()) for system in again] == dense
