"""The instances of ``proofs/ERRATA.md``, decided and certified."""

from __future__ import annotations

from fractions import Fraction

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.fixed_modes import completeness, fixed_spectrum
from mcexact.analysis.sharing import shared_dimension_bound
from mcexact.analysis.structure import transfer_graph
from mcexact.answer.protocol import Answer, encode
from mcexact.checker.kinds import check_document
from mcexact.derived.constructions import extended_system, setpoint_system
from mcexact.exact.linear_algebra import rank
from mcexact.exact.matrix import Matrix, block
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from tests.oracle.enumeration import pencil_rank, plain
from tests.oracle.networks import connectivity


def assert_valid(certificate: Answer) -> None:
    verdict = check_document(encode(certificate).encode("ascii"))
    assert verdict.verdict == "VALID", verdict.line()


def test_a_pole_at_zero_hides_a_zero_at_zero_from_the_determinant() -> None:
    """det diag(1/s, s/(s+1)²) = 1/(s+1)², yet the set-point condition fails."""
    A = [[0, 0, 0], [0, -2, -1], [0, 1, 0]]
    plant = MultiChannelSystem(A, [[[1], [0], [0]], [[0], [1], [0]]], [[[1, 0, 0]], [[0, 1, 0]]])
    for verdict in (joint_controllability(plant), joint_observability(plant)):
        assert verdict.controllable
        assert_valid(verdict)
    B, C = plant.input_matrix(), plant.output_matrix()
    assert rank(block([[plant.A, B], [C, Matrix.zeros(2, 2)]])) == 4
    augmented = joint_controllability(setpoint_system(plant))
    assert str(augmented.uncontrollable_polynomial) == "x"
    assert_valid(augmented)


def test_a_neighbor_that_two_members_hear_counts_once() -> None:
    one = [[1]]
    plant = MultiChannelSystem([[0]], [one] * 3, [one] * 3)
    graph = NeighborGraph.complete(plant.names)
    sizes, s, mode = [1, 1, 1], (0, 1), (Fraction(0), Fraction(1))
    extended = plain(extended_system(plant, sizes, "states", graph))
    loss = pencil_rank(extended, s, mode) - pencil_rank(plain(plant), s, mode)
    once = sum(sizes[j] for j in graph.union(s))
    counted = sum(sizes[j] for i in s for j in graph.neighborhood(i))
    outside = sum(size for i, size in enumerate(sizes) if i not in s)
    assert (once, counted) == (3, 6)
    assert loss == outside + once


def test_a_bound_below_one_is_reached_without_any_subset() -> None:
    one = [[1]]
    plant = MultiChannelSystem([[0]], [one] * 2, [one] * 2)
    graph = NeighborGraph.complete(plant.names)
    bound = shared_dimension_bound(plant, graph)
    assert bound.deficiency == 0
    assert_valid(bound)


def test_no_fixed_mode_and_no_shared_state_can_leave_the_spectrum_split() -> None:
    """Corollary 1 with n_i = 0: the hypotheses of Theorem 2 hold, the conclusion does not."""
    e1, e2 = [[1], [0]], [[0], [1]]
    plant = MultiChannelSystem(
        [[0, 0], [0, 0]],
        [e1, e2, e2],
        [[[1, 0]], [[1, 0]], [[0, 1]]],
        neighbors={"1": ["2"], "2": ["3"], "3": ["1"]},
    )
    assert plant.neighbors is not None and plant.neighbors.is_strongly_connected()
    assert shared_dimension_bound(plant).deficiency == 0
    alone = extended_system(plant, [0, 0, 0])
    spectrum, graph, freedom = fixed_spectrum(alone), transfer_graph(alone), completeness(alone)
    assert spectrum.empty and not freedom.complete
    assert graph.components == (("1",), ("2", "3"))
    shared = extended_system(plant, [1, 1, 1])
    assert completeness(shared).complete
    assert connectivity(plant, shared).union_contained
    for evidence in (spectrum, graph, freedom, completeness(shared)):
        assert_valid(evidence)
