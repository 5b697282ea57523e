"""The paper's statements on extended systems under delays."""

from __future__ import annotations

from mcexact.analysis.fixed_modes import completeness
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.derived.constructions import extended_system, held_system
from mcexact.exact.polynomial import Polynomial
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from tests.assurance.campaigns import extended as campaign
from tests.oracle.networks import (
    connectivity,
    extended_verdict,
    held_verdict,
    lifted_verdict,
)
from tests.synthesis.test_extended import late


def test_the_papers_example_with_delay_3_on_every_link() -> None:
    plant = late()
    lifted, held = lifted_verdict(plant, [0, 0, 1]), held_verdict(plant, [1, 0, 1])
    assert (lifted.system.n, held.system.n) == (19, 11)
    assert lifted.spectrum.polynomial == Polynomial.x()
    assert lifted.only_zero_fixed
    assert not lifted.nothing_fixed
    assert lifted.only_zero_uncontrollable
    assert held.nothing_fixed
    campaign.valid([*lifted.certificates, *held.certificates], "the paper's example")


def test_less_sharing_leaves_mode_1_in_both() -> None:
    plant = late()
    assert not lifted_verdict(plant, [1, 0, 0]).only_zero_fixed
    assert held_verdict(plant, [0, 0, 1]).spectrum.polynomial == Polynomial.from_roots([1])


def test_corollary_1_needs_dimensions_of_at_least_1() -> None:
    plant = MultiChannelSystem(
        [[0, 0], [0, 0]],
        [[[1], [0]], [[0], [1]], [[0], [1]]],
        [[[1, 0]], [[1, 0]], [[0, 1]]],
        neighbors={"1": ["2"], "2": ["3"], "3": ["1"]},
    )
    nothing = completeness(extended_system(plant, [0, 0, 0]))
    assert extended_verdict(plant, [0, 0, 0]).nothing_fixed
    assert not nothing.complete
    assert check_document(encode(nothing).encode()).verdict == "VALID"
    one = completeness(extended_system(plant, [1, 1, 1]))
    assert one.complete
    assert check_document(encode(one).encode()).verdict == "VALID"


def test_a_cut_in_both_graphs_is_a_cut_in_the_held_system() -> None:
    graph = NeighborGraph(("1", "2"), [[], [0]], [(1, 0, 2)])
    plant = MultiChannelSystem(
        [[1, 0], [0, 2]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]], time="discrete"
    )
    found = connectivity(plant, held_system(plant, [1, 1], graph), graph)
    assert (found.union_connected, found.network_connected) == (False, False)
    assert found.union_contained


def test_drawn_networks_obey_every_statement() -> None:
    seen = campaign.statements(12, 5000)
    assert seen["systems"] == 12
