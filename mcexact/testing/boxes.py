"""Hypothesis strategies that draw members of boxes of plants."""

from __future__ import annotations

from fractions import Fraction

from hypothesis import strategies as st
from hypothesis.strategies import DrawFn, SearchStrategy

from mcexact.model.box import Box
from mcexact.model.system import MultiChannelSystem

_STEPS = 2**10


@st.composite
def _members(draw: DrawFn, box: Box, vertices: bool) -> MultiChannelSystem:
    part = st.sampled_from([1, -1]) if vertices else st.integers(-_STEPS, _STEPS)
    steps = 1 if vertices else _STEPS
    return box.moved(lambda: Fraction(draw(part), steps))


def members(box: Box, *, vertices: bool = False) -> SearchStrategy[MultiChannelSystem]:
    """Draw plants in a box, each uncertain entry anywhere in its interval.

    Parameters
    ----------
    box : Box
    vertices : bool
        Whether every uncertain entry is at one of the two ends of its interval.

    Returns
    -------
    SearchStrategy of MultiChannelSystem
        Plants of exact numbers; they shrink towards the nominal plant, or the upper ends.
    """
    return _members(box, vertices)
