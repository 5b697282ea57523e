"""Systems made from systems, each of which the checker makes again from the given one.

    >>> import mcexact
    >>> from mcexact.constructions import dual, merged
    >>> plant = mcexact.gallery("movable-by-periodic-gains")
    >>> as_one = merged(plant, [plant.names])
    >>> as_one.names, mcexact.fixed_spectrum(as_one).empty, dual(dual(plant)).A == plant.A
    (('1+2',), True, True)

An answer about such a system has a certificate about the given plant, which names the construction.
"""

from mcexact.analysis.modulo import MinimalRealization, modulo
from mcexact.analysis.stability import matrix_system
from mcexact.derived.constructions import (
    along_line,
    augmented_outputs,
    closure,
    dual,
    error_system,
    extended_system,
    failed,
    held_system,
    internal_model,
    lifted_system,
    merged,
    regulated_outputs,
    restricted,
    servo_system,
    setpoint_system,
    slow_system,
    union_graph,
)
from mcexact.derived.drawn.systems import Draw
from mcexact.derived.feedthrough import input_filters, plant_controller
from mcexact.derived.modulo import LeftOut, without_part
from mcexact.derived.sampling import c2d, sampled_system
from mcexact.derived.variants import (
    Variant,
    neighbor_graph_variants,
    parameter_grid,
    sensor_variants,
)
from mcexact.model.periodic import periodic_loop
from mcexact.model.signals import signal_polynomial
from mcexact.model.system import from_stacked

__all__ = [
    "Draw",
    "LeftOut",
    "MinimalRealization",
    "Variant",
    "along_line",
    "augmented_outputs",
    "c2d",
    "closure",
    "dual",
    "error_system",
    "extended_system",
    "failed",
    "from_stacked",
    "held_system",
    "input_filters",
    "internal_model",
    "lifted_system",
    "matrix_system",
    "merged",
    "modulo",
    "neighbor_graph_variants",
    "parameter_grid",
    "periodic_loop",
    "plant_controller",
    "regulated_outputs",
    "restricted",
    "sampled_system",
    "sensor_variants",
    "servo_system",
    "setpoint_system",
    "signal_polynomial",
    "slow_system",
    "union_graph",
    "without_part",
]
