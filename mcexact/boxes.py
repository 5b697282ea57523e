"""Answers for all plants whose entries are within given radii: a box.

    >>> from mcexact import MultiChannelSystem
    >>> from mcexact.boxes import Box, box_fixed_modes
    >>> plant = MultiChannelSystem([[0, 1], [-2, -3]], [[[0], [1]]], [[[1, 0]]])
    >>> box_fixed_modes(Box.relative(plant, "1/100").system).bound is None
    True

`largest_uncertainty` and `largest_loop_uncertainty` look for the largest radii for which a proof is
found.
"""

from mcexact.analysis.boxes.largest import (
    LargestRanges,
    LargestUncertainty,
    largest_loop_ranges,
    largest_loop_uncertainty,
    largest_uncertainty,
)
from mcexact.analysis.boxes.loops import box_stability
from mcexact.analysis.boxes.margins import box_disk_margin
from mcexact.analysis.boxes.members import (
    box_controllability,
    box_fixed_modes,
    box_observability,
    box_setpoints,
    box_stabilizability,
)
from mcexact.answer.boxes import (
    BoxControllability,
    BoxFixedModes,
    BoxStability,
    ParametricBoxControllability,
    ParametricBoxFixedModes,
    ParametricBoxStability,
)
from mcexact.model.box import Box
from mcexact.model.radii import Radii

__all__ = [
    "Box",
    "BoxControllability",
    "BoxFixedModes",
    "BoxStability",
    "LargestRanges",
    "LargestUncertainty",
    "ParametricBoxControllability",
    "ParametricBoxFixedModes",
    "ParametricBoxStability",
    "Radii",
    "box_controllability",
    "box_disk_margin",
    "box_fixed_modes",
    "box_observability",
    "box_setpoints",
    "box_stability",
    "box_stabilizability",
    "largest_loop_ranges",
    "largest_loop_uncertainty",
    "largest_uncertainty",
]
