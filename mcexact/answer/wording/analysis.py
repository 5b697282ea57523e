"""The sentences of `mcexact analyze`: the answer, and the table of all answers."""

from __future__ import annotations

from mcexact.answer.template import Template

_WANG_DAVISON = "S. H. Wang and E. J. Davison 1973"

# The user's input.

HEADING = Template(
    "heading", "{name:name}: {n:count state}, {m:count channel} {names:set}, {time:time} time"
)
INFORMATION = Template("information", "{information:information}", label="information")

# The answer in words.

NOTHING_FIXED = Template(
    "nothing-fixed",
    "No mode is fixed: {control:control} can move every mode.",
    "fixed_spectrum.absence_all",
)
FREE_THROUGH_ANY = Template(
    "free-through-any-channel",
    "Linear time-invariant channel controllers can assign the whole closed-loop spectrum, also "
    "with all their states in any one channel.",
    "corollary_1.free_assignment",
)
FREE = Template(
    "free",
    "Linear time-invariant channel controllers can assign the whole closed-loop spectrum.",
    "component_assignment.component_assignment",
)
PARTS = Template(
    "parts",
    "The closed-loop spectrum can be assigned in parts, one for each of {k:int} strong components "
    "of the transfer graph.",
    "component_assignment.component_assignment",
)
UNSTABLE = Template(
    "not-stabilizable",
    "The plant cannot be stabilized by {control:control}: the slowest fixed mode "
    "{slowest:behavior}.",
    "evidence.shrunk_subspace_fixed_dynamic",
)
STABLE = Template(
    "stabilizable",
    "The plant can be stabilized by {control:control}: every fixed mode is stable, and the slowest "
    "one {slowest:behavior}.",
    _WANG_DAVISON,
)
_BLAME = "{p:Modes} ({often:often}) {p:are} fixed"
_PBH = "evidence.shrunk_subspace_pencil, joint_controllability.controllable_hautus"
BLAME = Template(
    "fixed-mode",
    _BLAME
    + ": {outside:channels} {outside:do} not control {p:them}, {inside:channels} {inside:do} "
    "not observe {p:them}, and no constant gains change that.",
    _PBH,
)
UNCONTROLLED = Template(
    "fixed-mode-uncontrolled", _BLAME + ": all channels together do not control {p:them}.", _PBH
)
UNOBSERVED = Template(
    "fixed-mode-unobserved", _BLAME + ": all channels together do not observe {p:them}.", _PBH
)
LINKS = {
    False: Template(
        "links",
        "Sending outputs along {added:arrows} leaves no mode fixed{time:instant}, and no fewer "
        "links do.",
    ),
    True: Template(
        "links-beside-graph",
        "Sending outputs over the neighbor graph and along {added:arrows} leaves no mode "
        "fixed{time:instant}, and no fewer links do.",
    ),
}
LINKS_NONE = Template(
    "links-none", "Sending outputs over the neighbor graph leaves no mode fixed{time:instant}."
)
NO_LINKS = Template(
    "no-links", "Even if every agent sends its outputs to all others, some mode is fixed."
)
SHARING_REMOVES = Template(
    "sharing-removes",
    "Over the neighbor graph, sending outputs and sharing {sizes:shared} leaves no mode fixed"
    "{time:instant}, and no smaller number of states does.",
)
OUTPUTS_REMOVE = Template(
    "outputs-remove",
    "Over the neighbor graph, sending outputs leaves no mode fixed{time:instant}.",
)
NO_SHARING = Template(
    "no-sharing", "Over the neighbor graph, some mode is fixed however much the agents share."
)

# The table of all answers.

CONTROLLABLE = Template("controllable", "every mode", label="jointly controllable")
UNCONTROLLABLE = Template("uncontrollable", "all but {p:modes}", label="jointly controllable")
OBSERVABLE = Template("observable", "every mode", label="jointly observable")
UNOBSERVABLE = Template("unobservable", "all but {p:modes}", label="jointly observable")
GRAPH_CONNECTED = Template(
    "transfer-graph-connected", "{arcs:edges}; strongly connected", label="transfer graph"
)
GRAPH_PARTS = Template(
    "transfer-graph-parts",
    "{arcs:edges}; components {components:components}",
    label="transfer graph",
)
INACTIVE = Template(
    "inactive-channels", "{names:set}: B_i = 0 or C_i = 0", label="inactive channels"
)
FIXED_NONE = Template("fixed-none", "none", label="fixed modes")
FIXED = Template("fixed", "{p:modes}", label="fixed modes")
STABILIZABLE = Template(
    "table-stabilizable", "yes, by {control:control}", _WANG_DAVISON, "stabilizable"
)
NOT_STABILIZABLE = Template(
    "table-not-stabilizable",
    "not by {control:control}",
    "evidence.shrunk_subspace_fixed_dynamic",
    "stabilizable",
)
SLOWEST = Template("slowest", "{slowest:behavior}", label="slowest fixed mode")
ANY_RATE = Template(
    "any-rate", "none: every decay rate can be reached", _WANG_DAVISON, "slowest fixed mode"
)
COMPLETE = Template("complete", "{complete:yes}", label="complete")


def _index_templates(name: str) -> tuple[Template, Template, Template]:
    """The sentences on controllability or observability indices, or on their omission."""
    label = f"{name} indices"
    return (
        Template(f"{name}-index", "{indices:indices}; index {index:int}", label=label),
        Template(f"{name}-indices", "{indices:indices}", label=label),
        Template(
            f"{name}-indices-left-out",
            "left out: many states for few inputs or outputs",
            label=label,
            claims=False,
        ),
    )


CONTROLLABILITY_INDICES = _index_templates("controllability")
OBSERVABILITY_INDICES = _index_templates("observability")
SPECTRUM_FREE = Template(
    "spectrum-free",
    "freely assignable",
    "component_assignment.component_assignment",
    "closed-loop spectrum",
)
SPECTRUM_PARTS = Template(
    "spectrum-parts",
    "assignable in parts: {blocks:blocks}",
    "component_assignment.component_assignment",
    "closed-loop spectrum",
)
SPECTRUM_MOVED = Template(
    "spectrum-moved",
    "{k:int} of {n:count eigenvalue} can be moved",
    "fixed_spectrum.multiplicity_at_most, spectrum_split.spectrum_split",
    "closed-loop spectrum",
)
SPECTRUM_MOVED_BETWEEN = Template(
    "spectrum-moved-between",
    "from {k:int} to {most:int} of {n:count eigenvalue} can be moved",
    "fixed_spectrum.multiplicity_at_most, spectrum_split.spectrum_split",
    "closed-loop spectrum",
)
_INTEGRATORS = "setpoint.setpoint_rank; E. J. Davison 1976"
SETPOINT = Template(
    "setpoint", "centralized control holds every output at any value", _INTEGRATORS, "set-points"
)
SETPOINT_STABLE_REST = Template(
    "setpoint-stable-rest",
    "centralized control holds every output at any value; some stable modes cannot be moved",
    _INTEGRATORS,
    "set-points",
)
SETPOINT_UNSTABLE_REST = Template(
    "setpoint-unstable-rest",
    "no loop is stable: {p:modes} {p:are} not controllable or not observable, and {p:unstable}",
    "joint_controllability.controllable_hautus",
    "set-points",
)
SETPOINT_ZERO = Template(
    "setpoint-zero",
    "no stable linear time-invariant loop holds them all: {place:int} is an invariant zero",
    "setpoint.setpoint_rank",
    "set-points",
)
SETPOINT_DEPENDENT = Template(
    "setpoint-dependent",
    "no stable linear time-invariant loop holds them all: the inputs cannot move the outputs "
    "independently",
    "setpoint.setpoint_rank",
    "set-points",
)
CONNECTED = Template("neighbor-graph-connected", "strongly connected", label="neighbor graph")
NOT_CONNECTED = Template(
    "neighbor-graph-not-connected", "not strongly connected", label="neighbor graph"
)
_ENOUGH = "sufficient to share"
ENOUGH = {
    "outputs+states": (
        Template(
            "enough-outputs-states",
            "outputs, and {k:count state} by each agent: {total:int} in all{time:instant}",
            "extended_bound.theorem_2",
            _ENOUGH,
        ),
        Template(
            "enough-outputs", "outputs alone{time:instant}", "extended_bound.theorem_2", _ENOUGH
        ),
    ),
    "states": (
        Template(
            "enough-states",
            "without outputs, {k:count state} by each agent: {total:int} in all{time:instant}",
            "extended_bound.remark_2",
            _ENOUGH,
        ),
        Template("enough-nothing", "without outputs, nothing", "extended_bound.remark_2", _ENOUGH),
    ),
}
NO_BOUND = Template(
    "enough-unknown", "no bound: the neighbor graph is not strongly connected", label=_ENOUGH
)
NEVER_CONTROLLED = Template(
    "sharing-in-vain-controllability",
    "no sharing allows control to move {p:modes}, which all agents together do not control",
    "joint_controllability.controllable_hautus",
    _ENOUGH,
)
NEVER_OBSERVED = Template(
    "sharing-in-vain-observability",
    "no sharing allows control to move {p:modes}, which all agents together do not observe",
    "joint_controllability.observable_hautus",
    _ENOUGH,
)


def _least_templates(key: str, before: str, alone: str) -> tuple[Template, ...]:
    """The sentences on the least dimensions for one way of sharing."""
    label = "least to share"
    return (
        Template(f"least-{key}", before + "{sizes:shared}{time:instant}", label=label),
        Template(f"least-{key}-none", alone + "{time:instant}", label=label),
        Template(f"least-{key}-impossible", before + "no dimensions suffice", label=label),
        Template(
            f"least-{key}-limit",
            before + "not decided within the node limit",
            label=label,
            claims=False,
        ),
    )


TABLE_LINKS = {
    "some": Template("table-links", "{added:arrows}{time:instant}", label="fewest links to add"),
    "none": Template("table-links-none", "none{time:instant}", label="fewest links to add"),
    "impossible": Template(
        "table-links-impossible", "no links suffice", label="fewest links to add"
    ),
    "limit": Template(
        "table-links-limit",
        "not decided within the node limit",
        label="fewest links to add",
        claims=False,
    ),
}
LEAST = {
    "outputs+states": _least_templates(
        "outputs-states", "in addition to outputs, ", "outputs alone"
    ),
    "states": _least_templates("states", "without outputs, ", "without outputs, nothing"),
}


def _gains(key: str, label: str) -> dict[str, Template]:
    """The sentences on gains for single channels: their indices, or an obstruction."""
    causes = {
        "controllable": "it does not act on {rest:channels}",
        "observable": "{rest:channels} {rest:do} not act on it",
    }
    return {
        "reached": Template(f"{key}-gains", "yes, {reached:reached}", label=label),
        "stuck": Template(
            f"{key}-stuck",
            "no: no constant gains make channel {name:name} {side:side} at {p:modes}",
            label=label,
        ),
    } | {
        side: Template(
            f"{key}-unreached-{side}",
            f"no: no constant gains make channel {{name:name}} {side}, since {cause}",
            "single_channel_gains.single_channel_no_cut",
            label,
        )
        for side, cause in causes.items()
        if key.removeprefix("channel-") not in causes.keys() - {side}
    }


GAINS = {
    want: _gains(f"channel-{want}", f"{want} with gains")
    for want in ("controllable", "observable", "both")
} | {"every": _gains("every-channel", "through every channel")}

DELAYED = {
    name: (
        Template(
            f"{name}-nothing-fixed",
            "none, if each agent shares {k:count state}",
            label=f"fixed with delays, {name}",
        ),
        Template(
            f"{name}-fixed",
            "{p:modes}, if each agent shares {k:count state}",
            label=f"fixed with delays, {name}",
        ),
    )
    for name in ("lifted", "held")
}
