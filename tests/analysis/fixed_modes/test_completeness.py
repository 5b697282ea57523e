"""Completeness: published answers, and the reason each NO gives."""

from dataclasses import replace

import pytest

from mcexact.analysis.fixed_modes import completeness, fixed_spectrum
from mcexact.analysis.single_channel import single_channel_gains
from mcexact.answer import protocol
from mcexact.answer.modes import (
    BlocksWitness,
    ByBlocks,
    Completeness,
    CutWitness,
    FixedModeWitness,
    FreedomWitness,
    TwoPolynomials,
)
from mcexact.checker.kinds import check_document
from mcexact.model import gallery
from mcexact.model.system import MultiChannelSystem


def checked(answer: Completeness) -> Completeness:
    verdict = check_document(protocol.encode(answer).encode())
    assert verdict.verdict == "VALID", verdict
    return answer


@pytest.mark.parametrize("name", gallery.names())
def test_published_systems_have_the_published_answers(name: str) -> None:
    assert checked(completeness(gallery.load(name))).complete == gallery.expected(name)["complete"]


def test_a_fixed_mode_that_the_proper_subsets_do_not_see_makes_it_incomplete() -> None:
    """A = diag(0, 1): 0 is uncontrollable, though each complementary subsystem keeps its rank."""
    system = MultiChannelSystem([[0, 0], [0, 1]], [[[0], [1]]] * 2, [[[1, 1]]] * 2)
    answer = checked(completeness(system))
    assert not answer.complete
    assert isinstance(answer.evidence, FixedModeWitness)


def test_two_loops_that_never_meet_are_incomplete_by_a_cut() -> None:
    I = [[1, 0], [0, 1]]
    system = MultiChannelSystem(I, [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]])
    answer = checked(completeness(system))
    assert isinstance(answer.evidence, CutWitness)
    assert answer.evidence.zero.channels_from == ("1",)


def test_yes_names_no_more_arcs_than_connect_all_channels() -> None:
    n = 6
    system = MultiChannelSystem(
        [[int(j == (i + 1) % n) for j in range(n)] for i in range(n)],
        [[[int(i == k)] for i in range(n)] for k in range(n)],
        [[[int(i == k) for i in range(n)]] for k in range(n)],
    )
    spectrum = fixed_spectrum(system)
    evidence = checked(completeness(system, spectrum=spectrum)).evidence
    assert isinstance(evidence, BlocksWitness)
    assert isinstance(spectrum.evidence, ByBlocks)
    assert len(evidence.arcs) <= 2 * (n - 1)
    assert evidence.blocks == spectrum.evidence.blocks


def test_one_channel_is_complete_iff_it_controls_and_observes_everything() -> None:
    chain = [[0, 1], [0, 0]]
    assert checked(completeness(MultiChannelSystem(chain, [[[0], [1]]], [[[1, 0]]]))).complete
    assert not checked(completeness(MultiChannelSystem(chain, [[[1], [0]]], [[[1, 0]]]))).complete


def test_an_arc_that_vanishes_modulo_the_prime_of_the_gains_is_seen_modulo_another() -> None:
    system = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [0]], [[0], [1]]], [[[0, 1]], [[7, 0]]])
    spectrum = fixed_spectrum(system)
    assert isinstance(spectrum.evidence, ByBlocks)
    [block] = spectrum.evidence.blocks
    assert block.evidence is not None
    gains = block.evidence.gains
    at_7 = replace(spectrum, evidence=TwoPolynomials(gains, 7, (), None))
    answer = checked(completeness(system, spectrum=at_7))
    assert answer.complete and isinstance(answer.evidence, FreedomWitness)
    assert answer.evidence.modulus > 7


@pytest.mark.parametrize("m", [1, 2, 3])
def test_without_states_only_a_single_channel_is_complete(m: int) -> None:
    """Every gain controls and observes nothing, but between several channels there is no arc."""
    nothing = MultiChannelSystem([], [[]] * m, [[]] * m)
    assert single_channel_gains(nothing).exists
    assert checked(completeness(nothing)).complete is (m == 1)
