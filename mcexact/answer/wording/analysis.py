"""The sentences of `mcexact analyze`.

A premise is an answer of the analysis by the stem of its certificate's file; of the answers about
both ways of sharing the sentence rests on the one that it names.
"""

from __future__ import annotations

from mcexact.answer.template import Template

_SPECTRUM = ("fixed_spectrum",)
_WANG_DAVISON = "S. H. Wang and E. J. Davison 1973"

# What the user gave.

HEADING = Template(
    "heading",
    "{name:name}: {n:count state}, {m:count channel} {names:set}, {time:time} time",
)
INFORMATION = Template("information", "{information:information}", label="information")

# The answer in plain words.

NOTHING_FIXED = Template(
    "nothing-fixed",
    "No mode is fixed: {control:control} can move every mode.",
    _SPECTRUM,
    "fixed_spectrum.absence_all",
)
FREE_THROUGH_ANY = Template(
    "free-through-any-channel",
    "Linear time-invariant channel controllers can assign the whole closed-loop spectrum, also "
    "with all their states in any one channel.",
    ("completeness",),
    "corollary_1.free_assignment",
)
FREE = Template(
    "free",
    "Linear time-invariant channel controllers can assign the whole closed-loop spectrum.",
    ("fixed_spectrum", "assignability"),
    "component_assignment.component_assignment",
)
PARTS = Template(
    "parts",
    "The closed-loop spectrum can be assigned in parts, one for each of {k:int} strong components "
    "of the transfer graph.",
    ("fixed_spectrum", "assignability"),
    "component_assignment.component_assignment",
)
UNSTABLE = Template(
    "not-stabilizable",
    "The plant cannot be stabilized by {control:control}: the slowest fixed mode "
    "{slowest:behavior}.",
    _SPECTRUM,
    "evidence.shrunk_subspace_fixed_dynamic",
)
STABLE = Template(
    "stabilizable",
    "The plant can be stabilized by {control:control}: every fixed mode is stable, and the slowest "
    "one {slowest:behavior}.",
    _SPECTRUM,
    _WANG_DAVISON,
)
_BLAME = "{p:Modes} ({often:often}) {p:are} fixed"
_PBH = "evidence.shrunk_subspace_pencil, joint_controllability.controllable_hautus"
BLAME = Template(
    "fixed-mode",
    _BLAME
    + ": {outside:channels} {outside:do} not control {p:them}, {inside:channels} {inside:do} "
    "not observe {p:them}, and no constant gains help.",
    _SPECTRUM,
    _PBH,
)
UNCONTROLLED = Template(
    "fixed-mode-uncontrolled",
    _BLAME + ": all channels together do not control {p:them}.",
    _SPECTRUM,
    _PBH,
)
UNOBSERVED = Template(
    "fixed-mode-unobserved",
    _BLAME + ": all channels together do not observe {p:them}.",
    _SPECTRUM,
    _PBH,
)
MORE_FIXED = Template(
    "more-fixed-modes", "There are {k:count more factor} of the fixed polynomial.", _SPECTRUM
)
_LINKS = ("minimal_communication",)
LINKS = {
    False: Template(
        "links",
        "Sending outputs along {added:arrows} leaves no mode fixed{time:instant}, and no fewer "
        "links do.",
        _LINKS,
    ),
    True: Template(
        "links-beside-graph",
        "Sending outputs over the neighbor graph and along {added:arrows} leaves no mode "
        "fixed{time:instant}, and no fewer links do.",
        _LINKS,
    ),
}
LINKS_NONE = Template(
    "links-none",
    "Sending outputs over the neighbor graph leaves no mode fixed{time:instant}.",
    _LINKS,
)
NO_LINKS = Template(
    "no-links", "Sending outputs between all agents does not free every mode.", _LINKS
)
SHARING_REMOVES = Template(
    "sharing-removes",
    "Over the neighbor graph it is enough to send outputs and to share {sizes:shared}"
    "{time:instant}, and no smaller number of states is.",
    ("minimal_shared_dimensions_outputs_states",),
)
OUTPUTS_REMOVE = Template(
    "outputs-remove",
    "Over the neighbor graph it is enough to send outputs{time:instant}.",
    ("minimal_shared_dimensions_outputs_states",),
)
NO_SHARING = Template(
    "no-sharing",
    "No sharing over the neighbor graph frees every mode.",
    ("minimal_shared_dimensions_outputs_states",),
)

# The table of all answers.

CONTROLLABLE = Template(
    "controllable", "every mode", ("joint_controllability",), label="jointly controllable"
)
UNCONTROLLABLE = Template(
    "uncontrollable",
    "all but {p:modes}",
    ("joint_controllability",),
    label="jointly controllable",
)
OBSERVABLE = Template(
    "observable", "every mode", ("joint_observability",), label="jointly observable"
)
UNOBSERVABLE = Template(
    "unobservable",
    "all but {p:modes}",
    ("joint_observability",),
    label="jointly observable",
)
GRAPH_CONNECTED = Template(
    "transfer-graph-connected",
    "{arcs:edges}; strongly connected",
    ("transfer_graph",),
    label="transfer graph",
)
GRAPH_PARTS = Template(
    "transfer-graph-parts",
    "{arcs:edges}; components {components:components}",
    ("transfer_graph",),
    label="transfer graph",
)
INACTIVE = Template(
    "inactive-channels", "{names:set}: B_i = 0 or C_i = 0", label="inactive channels"
)
FIXED_NONE = Template("fixed-none", "none", _SPECTRUM, label="fixed modes")
FIXED = Template("fixed", "{p:modes}", _SPECTRUM, label="fixed modes")
STABILIZABLE = Template(
    "table-stabilizable", "yes, by {control:control}", _SPECTRUM, _WANG_DAVISON, "stabilizable"
)
NOT_STABILIZABLE = Template(
    "table-not-stabilizable",
    "not by {control:control}",
    _SPECTRUM,
    "evidence.shrunk_subspace_fixed_dynamic",
    "stabilizable",
)
SLOWEST = Template("slowest", "{slowest:behavior}", _SPECTRUM, label="slowest fixed mode")
ANY_RATE = Template(
    "any-rate",
    "none: every decay rate can be reached",
    _SPECTRUM,
    _WANG_DAVISON,
    "slowest fixed mode",
)
COMPLETE = Template("complete", "{complete:yes}", ("completeness",), label="complete")


def _index_templates(name: str) -> tuple[Template, Template, Template]:
    """The list of indices, with the index where there is one; or why it is left out."""
    label, premises = f"{name} indices", (f"{name}_indices",)
    return (
        Template(f"{name}-index", "{indices:indices}; index {index:int}", premises, label=label),
        Template(f"{name}-indices", "{indices:indices}", premises, label=label),
        Template(
            f"{name}-indices-left-out",
            "left out: many states for few inputs or outputs",
            label=label,
        ),
    )


CONTROLLABILITY_INDICES = _index_templates("controllability")
OBSERVABILITY_INDICES = _index_templates("observability")
_SPLIT = ("fixed_spectrum", "assignability")
SPECTRUM_FREE = Template(
    "spectrum-free",
    "freely assignable",
    _SPLIT,
    "component_assignment.component_assignment",
    "closed-loop spectrum",
)
SPECTRUM_PARTS = Template(
    "spectrum-parts",
    "assignable in parts: {blocks:blocks}",
    _SPLIT,
    "component_assignment.component_assignment",
    "closed-loop spectrum",
)
SPECTRUM_MOVED = Template(
    "spectrum-moved",
    "{k:int} of {n:count eigenvalue} can be moved",
    _SPLIT,
    "fixed_spectrum.multiplicity_at_most, spectrum_split.spectrum_split",
    "closed-loop spectrum",
)
SPECTRUM_MOVED_BETWEEN = Template(
    "spectrum-moved-between",
    "from {k:int} to {most:int} of {n:count eigenvalue} can be moved",
    _SPLIT,
    "fixed_spectrum.multiplicity_at_most, spectrum_split.spectrum_split",
    "closed-loop spectrum",
)
_SETPOINT = ("setpoint", "joint_controllability", "joint_observability")
_INTEGRATORS = "setpoint.setpoint_rank; E. J. Davison 1976"
SETPOINT = Template(
    "setpoint",
    "centralized control holds every output at any value",
    _SETPOINT,
    _INTEGRATORS,
    "set-points",
)
SETPOINT_STABLE_REST = Template(
    "setpoint-stable-rest",
    "centralized control holds every output at any value, beside stable modes that it cannot move",
    (*_SETPOINT, "fixed_spectrum"),
    _INTEGRATORS,
    "set-points",
)
SETPOINT_UNSTABLE_REST = Template(
    "setpoint-unstable-rest",
    "no stable loop holds them: {p:modes} {p:are} out of reach, and {p:unstable}",
    (*_SETPOINT, "fixed_spectrum"),
    "joint_controllability.controllable_hautus",
    "set-points",
)
SETPOINT_ZERO = Template(
    "setpoint-zero",
    "no stable linear time-invariant loop holds them all: {place:int} is an invariant zero",
    ("setpoint",),
    "setpoint.setpoint_rank",
    "set-points",
)
SETPOINT_DEPENDENT = Template(
    "setpoint-dependent",
    "no stable linear time-invariant loop holds them all: the inputs cannot move the outputs "
    "independently",
    ("setpoint",),
    "setpoint.setpoint_rank",
    "set-points",
)
CONNECTED = Template(
    "neighbor-graph-connected", "strongly connected", ("neighbor_graph",), label="neighbor graph"
)
NOT_CONNECTED = Template(
    "neighbor-graph-not-connected",
    "not strongly connected",
    ("neighbor_graph",),
    label="neighbor graph",
)
_BOUND = ("neighbor_graph", "joint_controllability", "joint_observability")
_ENOUGH = "enough to share"
ENOUGH = {
    "outputs+states": (
        Template(
            "enough-outputs-states",
            "outputs, and {k:count state} by each agent: {total:int} in all{time:instant}",
            ("shared_dimension_bound_outputs_states", *_BOUND),
            "extended_bound.theorem_2",
            _ENOUGH,
        ),
        Template(
            "enough-outputs",
            "outputs alone{time:instant}",
            ("shared_dimension_bound_outputs_states", *_BOUND),
            "extended_bound.theorem_2",
            _ENOUGH,
        ),
    ),
    "states": (
        Template(
            "enough-states",
            "without outputs, {k:count state} by each agent: {total:int} in all{time:instant}",
            ("shared_dimension_bound_states", *_BOUND),
            "extended_bound.remark_2",
            _ENOUGH,
        ),
        Template(
            "enough-nothing",
            "nothing",
            ("shared_dimension_bound_states", *_BOUND),
            "extended_bound.remark_2",
            _ENOUGH,
        ),
    ),
}
NO_BOUND = Template(
    "enough-unknown",
    "no bound: the neighbor graph is not strongly connected",
    ("neighbor_graph",),
    label=_ENOUGH,
)
NEVER_CONTROLLED = Template(
    "sharing-in-vain-controllability",
    "no amount of sharing frees {p:modes}, which all agents together do not control",
    ("joint_controllability",),
    "joint_controllability.controllable_hautus",
    _ENOUGH,
)
NEVER_OBSERVED = Template(
    "sharing-in-vain-observability",
    "no amount of sharing frees {p:modes}, which all agents together do not observe",
    ("joint_observability",),
    "joint_controllability.observable_hautus",
    _ENOUGH,
)


def _least_templates(key: str, premise: str, before: str, alone: str) -> tuple[Template, ...]:
    """What is least, for one way of sharing: some states, none, or that nothing suffices."""
    label = "least to share"
    return (
        Template(f"least-{key}", before + "{sizes:shared}{time:instant}", (premise,), label=label),
        Template(f"least-{key}-none", alone + "{time:instant}", (premise,), label=label),
        Template(
            f"least-{key}-impossible", before + "no dimensions suffice", (premise,), label=label
        ),
        Template(f"least-{key}-limit", before + "not decided within the node limit", label=label),
    )


TABLE_LINKS = {
    "some": Template(
        "table-links", "{added:arrows}{time:instant}", _LINKS, label="fewest links to add"
    ),
    "none": Template("table-links-none", "none{time:instant}", _LINKS, label="fewest links to add"),
    "impossible": Template(
        "table-links-impossible", "no links are enough", _LINKS, label="fewest links to add"
    ),
    "limit": Template(
        "table-links-limit", "not decided within the node limit", label="fewest links to add"
    ),
}
LEAST = {
    "outputs+states": _least_templates(
        "outputs-states",
        "minimal_shared_dimensions_outputs_states",
        "beside outputs, ",
        "outputs alone",
    ),
    "states": _least_templates(
        "states", "minimal_shared_dimensions_states", "without outputs, ", "nothing"
    ),
}
