"""Hypothesis draws plants and graphs by their types."""

from hypothesis import given, settings
from hypothesis import strategies as st

from mcexact import MultiChannelSystem, NeighborGraph, ParametricSystem, joint_controllability
from mcexact.testing import assert_valid


@settings(max_examples=20)
@given(...)
def test_annotated_arguments_are_drawn(
    plant: MultiChannelSystem, graph: NeighborGraph, family: ParametricSystem
) -> None:
    assert_valid(joint_controllability(plant))
    assert 1 <= len(graph.names) <= 4 and family.parameters


@settings(max_examples=20)
@given(st.from_type(MultiChannelSystem))
def test_a_plant_is_drawn_by_its_type(plant: MultiChannelSystem) -> None:
    assert type(plant) is MultiChannelSystem and plant.m >= 1
