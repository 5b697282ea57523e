"""The rank of one named pencil."""

import pytest

from mcexact.analysis.fixed_modes import pencil_rank, pencil_ranks
from mcexact.answer import protocol
from mcexact.checker.kinds import check_document
from mcexact.errors import FloatRefused, InputError, UsageError
from mcexact.exact.polynomial import Polynomial
from mcexact.model import gallery
from mcexact.model.system import MultiChannelSystem


def test_the_example_of_the_paper_loses_rank_at_1_for_channels_2_and_3() -> None:
    system = gallery.load("liu2020-3ch-no-communication")
    found = pencil_rank(system, ["3", "2"], 1)
    assert (found.subset, found.rank, found.deficiency) == (("2", "3"), 2, 1)
    assert check_document(protocol.encode(found).encode()).verdict == "VALID"
    elsewhere = pencil_rank(system, ["2", "3"], 2)
    assert elsewhere.deficiency == 0
    assert check_document(protocol.encode(elsewhere).encode()).verdict == "VALID"


def test_irrational_modes_are_asked_for_by_their_polynomial() -> None:
    system = MultiChannelSystem([[0, 2], [1, 0]], [[[0], [0]]], [[[1, 0]]])
    found = pencil_rank(system, [], Polynomial.of(-2, 0, 1))
    assert found.rank == 1
    assert check_document(protocol.encode(found).encode()).verdict == "VALID"
    assert pencil_rank(system, ["1"], Polynomial.of(-2, 0, 1)).rank == 2


def test_a_reducible_polynomial_is_refused_with_its_factors() -> None:
    system = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    with pytest.raises(InputError, match=r"irreducible.*x - 1, x \+ 1"):
        pencil_rank(system, [], Polynomial.of(-1, 0, 1))
    with pytest.raises(InputError, match="degree at least 1"):
        pencil_rank(system, [], Polynomial.of(3))
    with pytest.raises(FloatRefused):
        pencil_rank(system, [], 0.5)
    with pytest.raises(UsageError, match="no channel"):
        pencil_rank(system, ["7"], 1)


def test_one_text_is_no_subset() -> None:
    plant = gallery.load("liu2020-3ch-no-communication")
    with pytest.raises(InputError, match="expected a list of names"):
        pencil_ranks(plant, "23")
