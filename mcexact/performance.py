"""What a loop is worth, proved: cost and the least cost of any controller, margins, saturation.

    >>> from mcexact import MultiChannelSystem
    >>> from mcexact.designs import local_controllers
    >>> from mcexact.performance import cost_bound, disk_margin, loop_cost
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
    >>> controller = local_controllers(plant, [[["-1/2"]]])
    >>> print(f"{float(loop_cost(plant, controller).cost / cost_bound(plant).cost):.2f}")
    1.03
    >>> disk_margin(plant, controller, "inputs").margin > 1
    True

Costs are those of white disturbances, with the weights that the answers name.
"""

from mcexact.analysis.in_units import (
    cost_bound,
    disk_margin,
    loop_cost,
    sector_stability,
    step_peaks,
)
from mcexact.analysis.performance import default_weights, influences
from mcexact.analysis.saturation import saturation_stability, with_anti_windup
from mcexact.answer.performance import (
    CostBound,
    CostGraph,
    CostWeights,
    DiskMargin,
    LoopCost,
    SectorStability,
    StepPeaks,
)
from mcexact.answer.saturation import SaturationStability
from mcexact.model.sizes import TypicalSizes
from mcexact.synthesis.performance import Performance, loop_performance

__all__ = [
    "CostBound",
    "CostGraph",
    "CostWeights",
    "DiskMargin",
    "LoopCost",
    "Performance",
    "SaturationStability",
    "SectorStability",
    "StepPeaks",
    "TypicalSizes",
    "cost_bound",
    "default_weights",
    "disk_margin",
    "influences",
    "loop_cost",
    "loop_performance",
    "saturation_stability",
    "sector_stability",
    "step_peaks",
    "with_anti_windup",
]
