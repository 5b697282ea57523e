"""The sentences of `mcexact design` and `certify`."""

from __future__ import annotations

from mcexact.answer.template import Template

OBSERVER = Template("design-observer", "distributed observer; closed loop certified")
OBSERVER_FLOAT = Template(
    "design-observer-float",
    "distributed observer, designed in floating point; closed loop certified",
)
NETWORK = Template("design-network", "{kind:network}; closed loop certified")
SETPOINT = Template(
    "design-setpoint", "set-point controller ({method:method}); closed loop certified"
)
CARRIER = Template(
    "design-carrier",
    "{agent:name}, of order {order:int}",
    label="agent with the channel controller",
)
CARRIER_FOR = Template(
    "design-carrier-for",
    "{agent:name}, of order {order:int}, for {channels:channels}",
    label="agent with the channel controller",
)
ORDER = Template("design-order", "{order:int}", label="states of all agents together")
ORDER_INTEGRATORS = Template(
    "design-order-integrators",
    "{order:int}, integrators included",
    label="states of all agents together",
)
FEEDBACK = Template("design-feedback", "{p:polynomial}", label="spectrum of A + sum B_i F_i")
ERRORS = Template("design-errors", "{p:polynomial}", label="spectrum of the errors")
REGION = Template("design-region", "{region:region}", label="every eigenvalue of the loop")
OBSERVER_ORDER = Template(
    "design-observer-order", "{order:int}", label="states of the paper's observer"
)
SHARED = Template("design-shared", "{sizes:dimensions}", label="shared dimensions")
ASSIGNED = Template("design-assigned", "{p:polynomial}", label="assigned spectrum")
KEPT = Template("design-kept", "{p:modes}", label="remaining fixed modes")
LONGEST = Template("design-longest-number", "{bits:int} bits", label="longest number")
STEADY = Template(
    "design-steady-state",
    "each tends to its set-point if every set-point, and every disturbance of the plant, is "
    "constant",
    "B. A. Francis and W. M. Wonham 1976",
    "outputs",
)
MEASURED = Template("design-measured", "computed in floating point, not certified", claims=False)

LOOP = Template("certify-loop", "closed loop", claims=False)
LOOP_STATES = Template("certify-states", "{n:int}", label="states of the loop")
INSIDE = Template("certify-inside", "every one satisfies {region:region}", label="eigenvalues")
OUTSIDE = Template(
    "certify-outside", "not every one satisfies {region:region}", label="eigenvalues"
)
DECIDED_BLOCKS = Template(
    "certify-decided-blocks", "by Lyapunov matrices, blocks of {sizes:list} states", label="decided"
)
DECIDED = Template("certify-decided", "{method:decided}", label="decided")
EVERY_LOOP = Template(
    "members-in-region",
    "every eigenvalue of every loop satisfies {region:region}{gains:gains}",
    label="within the radii",
)
EVERY_LOOP_PART = Template(
    "members-in-region-part",
    "{region:region} for every plant within {part:percent} of each entry{gains:gains}",
    label="every loop near this one",
)
EVERY_VALUE = Template(
    "parametric-ranges-in-region",
    "{region:region} for every {parameters:words}{gains:gains}",
    label="every loop in the ranges",
)
FAILING_PLANT = Template(
    "certify-failing-plant",
    "for a plant within {distance:percent_above} of each entry",
    label="a loop is not stable",
)
FAILING_PLANT_RADII = Template(
    "certify-failing-plant-radii",
    "for a plant within {distance:digits_above} times the radii",
    label="a loop is not stable",
)
LARGEST = Template("certify-largest", "{bound:number}", label="largest rate found")
LEAST = Template("certify-least", "{bound:number}", label="least radius found")
