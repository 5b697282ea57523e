"""Loops closed modulo a prime: by floats and without them, the polynomials are the same."""

import random
from itertools import islice

import pytest

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.answer import protocol
from mcexact.answer.modes import ByBlocks
from mcexact.checker.kinds import check_document
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.derived.drawn.systems import system_with_fixed_mode
from mcexact.derived.modular import (
    ModularSystem,
    closed_loop,
    drawn_gains,
    drawn_residues,
    generator,
    loop_polynomials,
    quick_bits,
    residue_systems,
)
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem


def drawn(n: int, widths: list[tuple[int, int]], seed: int) -> MultiChannelSystem:
    """Dense integer matrices, with a denominator in A."""
    rng = random.Random(seed)

    def matrix(rows: int, cols: int, denominator: int = 1) -> Matrix:
        table = [[rng.randint(-99, 99) for _ in range(cols)] for _ in range(rows)]
        return Matrix.from_integers(table, denominator, ncols=cols)

    B, C = [matrix(n, p) for p, _ in widths], [matrix(q, n) for _, q in widths]
    return MultiChannelSystem(matrix(n, n, 6), B, C)


def test_polynomials_of_large_loops_are_those_of_the_matrices() -> None:
    system = drawn(140, [(1, 2), (3, 1), (2, 2)], seed=3)
    modular = next(residue_systems(system, generator(system, "test"), quick_bits(system)))
    assert modular.modulus < 2**24
    gains = drawn_gains(modular, random.Random(4))
    assert loop_polynomials(modular, gains) == (
        modular.A.characteristic_polynomial(),
        closed_loop(modular, gains).characteristic_polynomial(),
    )


def test_many_outputs_make_the_prime_smaller() -> None:
    narrow = drawn(128, [(1, 1)], seed=1)
    wide = drawn(128, [(1, 2000), (1, 1)], seed=1)
    assert quick_bits(wide) < quick_bits(narrow)
    modular = next(residue_systems(wide, generator(wide, "test"), quick_bits(wide)))
    gains = drawn_gains(modular, random.Random(4))
    closed = closed_loop(modular, gains).characteristic_polynomial()
    assert loop_polynomials(modular, gains)[1] == closed


def test_a_large_system_without_fixed_modes_is_certified() -> None:
    spectrum = fixed_spectrum(drawn(128, [(1, 1)] * 8, seed=2))
    assert spectrum.empty and isinstance(spectrum.evidence, ByBlocks)
    [block] = spectrum.evidence.blocks
    assert block.evidence is not None and block.evidence.modulus < 2**24
    verdict = check_document(protocol.encode(spectrum).encode())
    assert verdict.verdict == "VALID", verdict


@pytest.mark.parametrize("degree", [1, 2])
def test_a_planted_mode_is_found_among_128_states(degree: int) -> None:
    planted = system_with_fixed_mode(SeededChoices(degree), states=128, channels=6, degree=degree)
    spectrum = fixed_spectrum(planted.system)
    assert planted.fixed_mode in [f.polynomial for f in spectrum.factors]
    verdict = check_document(protocol.encode(spectrum).encode())
    assert verdict.verdict == "VALID", verdict


@pytest.mark.parametrize("ell", [2, 3, 7, 8, 13, 2**19 - 1])
def test_all_residues_are_drawn(ell: int) -> None:
    found = list(islice(drawn_residues(random.Random(ell), ell), 500))
    assert all(0 <= x < ell for x in found) and 2 * max(found) >= ell
    assert len(set(found)) == ell or ell > 13


def test_gains_have_the_sizes_of_their_channels() -> None:
    for widths in ([(1, 1)] * 3, [(1, 1), (2, 3), (0, 2), (2, 0)]):
        system = drawn(4, widths, seed=1)
        gains = drawn_gains(ModularSystem(system, 31), random.Random(1))
        assert [len(F) for F in gains] == [p for p, _ in widths]
        assert [{len(row) for row in F} for F in gains] == [{q} if p else set() for p, q in widths]
        drawn_one_by_one = list(islice(drawn_residues(random.Random(1), 31), 9))
        entries = [x for F in gains for row in F for x in row]
        assert entries == drawn_one_by_one[: len(entries)]
