"""Sentences of `mcexact analyze`: templates, and the rules that fill them from certificates.

The first half is about the answer in words (``ANALYSIS_RULES``) and the table of all answers
(``MODE_RULES``), the second one about single modes, channels, sets of channels, and the pictures of
a page (``DETAIL_RULES``).  In each half the templates come first, then the rules in the order of
the output.  A template holds the wording, once, with the theorem that implies it; a rule is a
generator that reads the claims of its premises and yields filled templates, or nothing where the
sentence does not hold.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction

from mcexact.answer.sentence import Claim, Context, Rulebook, Several
from mcexact.answer.templates import Sentence, Template
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.roots import exact_decimal, steady_point

# Templates of the answer, and of the table of all answers.

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
NOT_STABILIZABLE = Template(
    "not-stabilizable",
    "The plant cannot be stabilized by {control:control}: the slowest fixed mode "
    "{slowest:behavior}.",
    "evidence.shrunk_subspace_fixed_dynamic",
)
STABILIZABLE = Template(
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
WHATEVER_SHARED = f"any_graph.any_sharing, {_PBH}"
RECEIVE_TOO_LITTLE = (
    "{inside:agents} {inside:receive} from no other agent and {inside:do} not observe {p:them}, "
    "and {outside:agents} {outside:do} not control {p:them}"
)
STAYS_SHARED = Template(
    "stays-shared",
    f"No sharing over the neighbor graph moves {{p:modes}}: {RECEIVE_TOO_LITTLE}.",
    WHATEVER_SHARED,
)
FREE_SHARED = Template(
    "free-shared",
    "If the agents share enough states over the neighbor graph, no mode is fixed{time:instant}.",
    "any_graph.any_sharing",
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
TABLE_STABILIZABLE = Template(
    "table-stabilizable", "yes, by {control:control}", _WANG_DAVISON, "stabilizable"
)
TABLE_NOT_STABILIZABLE = Template(
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
SETPOINT_FEWER = Template(
    "setpoint-fewer-inputs",
    "no stable linear time-invariant loop holds them all: {inputs:count input} for "
    "{outputs:count output}",
    "setpoint.setpoint_rank",
    "set-points",
)
CONNECTED = Template("neighbor-graph-connected", "strongly connected", label="neighbor graph")
NOT_CONNECTED = Template(
    "neighbor-graph-not-connected", "not strongly connected", label="neighbor graph"
)
SOURCES = Template(
    "source-components",
    "{parts:components}, which no other agent sends to",
    label="source components",
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
        Template(
            f"least-{key}-between",
            before + "{sizes:shared} suffice, fewer than {lower:int} in all do not{time:instant}",
            label=label,
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


# Rules of the answer, and of the table of all answers.

ANALYSIS_RULES = Rulebook()
analysis_rule = ANALYSIS_RULES.rule

Said = Iterator[Sentence]


def control(spectrum: Claim, context: Context) -> str:
    """The kind of control that moves none of the fixed modes of a certificate."""
    constructions = [each["construction"] for each in spectrum.subject]
    if constructions[-1:] != ["augmented_outputs"]:
        return "own"
    return "instant" if context.delays == "delays" else "outputs"


def slowest(spectrum: Claim, context: Context) -> tuple[str, str, str, bool]:
    """The data for sentences about the slowest fixed mode."""
    rate = spectrum.best_rate
    return context.time, rate.lower, rate.upper, spectrum.stabilizable


def empty(spectrum: Claim) -> bool:
    """Whether no mode is fixed."""
    return bool(spectrum.polynomial.degree == 0)


# The answer in words.


@analysis_rule("title", HEADING)
def _heading(context: Context) -> Said:
    yield HEADING(
        name=context.name or "system",
        n=context.n,
        m=context.m,
        names=context.names,
        time=context.time,
    )


@analysis_rule(
    "answer", NOTHING_FIXED, STABILIZABLE, NOT_STABILIZABLE, premises=("linked_fixed_spectrum",)
)
def _linked(linked: Claim, context: Context) -> Said:
    """Say in the first sentence of the answer what the agents can do over the existing links."""
    heard = control(linked, context)
    if empty(linked):
        yield NOTHING_FIXED(control=heard)
    else:
        template = STABILIZABLE if linked.stabilizable else NOT_STABILIZABLE
        yield template(control=heard, slowest=slowest(linked, context))


@analysis_rule("answer", NOTHING_FIXED, premises=("fixed_spectrum",))
def _nothing_fixed(fixed_spectrum: Claim, context: Context) -> Said:
    if empty(fixed_spectrum):
        yield NOTHING_FIXED(control=control(fixed_spectrum, context))


@analysis_rule("answer", FREE_THROUGH_ANY, premises=("completeness",))
def _free_through_any(completeness: Claim, context: Context) -> Said:
    if context.n and completeness.complete:
        yield FREE_THROUGH_ANY()


@analysis_rule("answer", FREE, PARTS, premises=("fixed_spectrum", "assignability", "completeness"))
def _assigned(
    fixed_spectrum: Claim, assignability: Claim, completeness: Claim, context: Context
) -> Said:
    if context.n and empty(fixed_spectrum) and not completeness.complete:
        parts = [block for block in assignability.blocks if block.dimension]
        yield FREE() if len(parts) <= 1 else PARTS(k=len(parts))


@analysis_rule("answer", STABILIZABLE, NOT_STABILIZABLE, premises=("fixed_spectrum",))
def _stabilized(fixed_spectrum: Claim, context: Context) -> Said:
    if not empty(fixed_spectrum):
        template = STABILIZABLE if fixed_spectrum.stabilizable else NOT_STABILIZABLE
        by = control(fixed_spectrum, context)
        if by == "own" and context.neighbors is not None and context.neighbors.edges():
            by = "alone"
        yield template(control=by, slowest=slowest(fixed_spectrum, context))


@analysis_rule(
    "answer",
    STAYS_SHARED,
    FREE_SHARED,
    premises=("shared_fixed_spectrum", "joint_controllability", "joint_observability"),
)
def _shared(
    shared_fixed_spectrum: Claim,
    joint_controllability: Claim,
    joint_observability: Claim,
    context: Context,
) -> Said:
    """What stays over the links of a graph that is not strongly connected, and by which agents.

    Modes that all agents together do not control or observe are left to other sentences.
    """
    if empty(shared_fixed_spectrum):
        yield FREE_SHARED(time=context.delays)
        return
    reach = (joint_controllability, joint_observability)
    for p, inside, outside in receive_too_little(shared_fixed_spectrum, reach, context):
        yield STAYS_SHARED(p=p, inside=inside, outside=outside)


def receive_too_little(
    shared: Claim, reach: Iterable[Claim], context: Context
) -> Iterator[tuple[Polynomial, list[str], list[str]]]:
    """Yield the modes that stay since some agents receive too little, and the two sets of agents.

    These are no modes that all agents together do not control or observe, as ``reach`` has them.
    """
    lost = [claim.uncontrollable_polynomial for claim in reach]
    for factor in shared.factors.separately():
        p, (inside, outside) = factor.polynomial, sides(factor, context)
        if inside and outside and all(p.gcd(q).degree == 0 for q in lost):
            yield p, inside, outside


def sides(factor: Claim, context: Context) -> tuple[list[str], list[str]]:
    """The agents from which paths lead to those that do not observe a mode, and the others.

    The latter do not control it.
    """
    inside = context.receiving(factor.channels)
    return inside, [name for name in context.names if name not in inside]


def fewest(links: Claim) -> bool:
    """Whether an answer is about the fewest links that leave no mode fixed, for outputs alone."""
    return (
        links.share == "outputs"
        and links.bound is None
        and all(price == 1 for *_, price in links.candidates)
    )


@analysis_rule(
    "answer",
    *LINKS.values(),
    LINKS_NONE,
    NO_LINKS,
    premises=("minimal_communication", "fixed_spectrum"),
)
def _links_remove(minimal_communication: Claim, fixed_spectrum: Claim, context: Context) -> Said:
    links = minimal_communication
    if empty(fixed_spectrum) or not fewest(links):
        return
    if links.added is None:
        yield NO_LINKS()
    else:
        some = LINKS[context.neighbors is not None] if links.added else LINKS_NONE
        yield some(added=links.added, time=context.delays)


def usual(least: Claim, share: str) -> bool:
    """Whether an answer has the fewest states with which no mode is fixed."""
    return asked_usually(least, share) and not least.has("at_least")


def asked_usually(least: Claim, share: str) -> bool:
    """Whether an answer is about the fewest states with which no mode is fixed."""
    return (
        least.share == share
        and least.bound is None
        and not least.free_assignability
        and all(cost == 1 for cost in least.costs)
        and all(most is None for most in least.upper)
    )


@analysis_rule(
    "answer",
    SHARING_REMOVES,
    OUTPUTS_REMOVE,
    NO_SHARING,
    premises=("minimal_shared_dimensions_outputs_states", "fixed_spectrum"),
)
def _sharing_removes(
    minimal_shared_dimensions_outputs_states: Claim, fixed_spectrum: Claim, context: Context
) -> Said:
    least = minimal_shared_dimensions_outputs_states
    if empty(fixed_spectrum) or not usual(least, "outputs+states"):
        return
    if least.dimensions is None:
        yield NO_SHARING()
    elif any(least.dimensions):
        sizes = list(zip(context.names, least.dimensions, strict=True))
        yield SHARING_REMOVES(sizes=sizes, time=context.delays)
    else:
        yield OUTPUTS_REMOVE(time=context.delays)


MODE_RULES = Rulebook()
"""About single modes, and the table; what is said of options stands before."""
mode_rule = MODE_RULES.rule


@mode_rule("answer.mode", BLAME, UNCONTROLLED, UNOBSERVED, premises=("fixed_spectrum",))
def _blame(fixed_spectrum: Claim, context: Context) -> Said:
    """The channels that do not control a mode, and those that do not observe it.

    rank P_s < n implies that [λI − A, B_T] and [λI − A; C_s] have rank below n, T the complement of
    s.
    """
    for factor in fixed_spectrum.factors.separately("stable"):
        inside = factor.channels
        outside = [name for name in context.names if name not in set(inside)]
        template = BLAME if inside and outside else UNOBSERVED if inside else UNCONTROLLED
        yield template(
            p=factor.polynomial,
            often=(factor.multiplicity_in_A, factor.multiplicity_at_most),
            inside=inside,
            outside=outside,
        )


# The table of all answers.


@mode_rule("table", INFORMATION)
def _information(context: Context) -> Said:
    if context.information == "outputs":
        yield INFORMATION(information="outputs" if context.delays == "none" else "instant")


def reached(controllability: Claim, yes: Template, no: Template) -> Said:
    """Whether channels together control or observe every mode."""
    yield yes() if controllability.controllable else no(p=controllability.uncontrollable_polynomial)


@mode_rule("table", CONTROLLABLE, UNCONTROLLABLE, premises=("joint_controllability",))
def _controllable(joint_controllability: Claim, context: Context) -> Said:
    yield from reached(joint_controllability, CONTROLLABLE, UNCONTROLLABLE)


@mode_rule("table", OBSERVABLE, UNOBSERVABLE, premises=("joint_observability",))
def _observable(joint_observability: Claim, context: Context) -> Said:
    yield from reached(joint_observability, OBSERVABLE, UNOBSERVABLE)


@mode_rule("table", GRAPH_CONNECTED, GRAPH_PARTS, premises=("transfer_graph",))
def _graph(transfer_graph: Claim, context: Context) -> Said:
    template = GRAPH_CONNECTED if transfer_graph.strongly_connected else GRAPH_PARTS
    yield template(arcs=transfer_graph.arcs, components=transfer_graph.components)


@mode_rule("table", INACTIVE, premises=("transfer_graph",))
def _inactive(transfer_graph: Claim, context: Context) -> Said:
    if context.inactive and transfer_graph.subject == context.system.subject:
        yield INACTIVE(names=context.inactive)


@mode_rule("table", FIXED_NONE, FIXED, premises=("fixed_spectrum",))
def _fixed(fixed_spectrum: Claim, context: Context) -> Said:
    p = fixed_spectrum.polynomial
    yield FIXED(p=p) if p.degree else FIXED_NONE()


@mode_rule("table", TABLE_STABILIZABLE, TABLE_NOT_STABILIZABLE, premises=("fixed_spectrum",))
def _stabilizable(fixed_spectrum: Claim, context: Context) -> Said:
    template = TABLE_STABILIZABLE if fixed_spectrum.stabilizable else TABLE_NOT_STABILIZABLE
    yield template(control=control(fixed_spectrum, context))


@mode_rule("table", SLOWEST, ANY_RATE, premises=("fixed_spectrum",))
def _slowest_mode(fixed_spectrum: Claim, context: Context) -> Said:
    if empty(fixed_spectrum):
        yield ANY_RATE()
    else:
        yield SLOWEST(slowest=slowest(fixed_spectrum, context))


@mode_rule("table", COMPLETE, premises=("completeness",))
def _complete(completeness: Claim, context: Context) -> Said:
    yield COMPLETE(complete=completeness.complete)


def _index_rules(question: str, one: Template, many: Template, none: Template) -> None:
    """Make the rules of controllability or observability indices, or of their omission."""

    @mode_rule("table", one, many, premises=(question,))
    def _indices(claim: Claim, context: Context) -> Said:
        template = many if claim.index is None else one
        yield template(indices=claim.indices, index=claim.index)

    @mode_rule("table", none, missing=question)
    def _left_out(context: Context) -> Said:
        yield none()


_index_rules("controllability_indices", *CONTROLLABILITY_INDICES)
_index_rules("observability_indices", *OBSERVABILITY_INDICES)


@mode_rule("table", SPECTRUM_FREE, SPECTRUM_PARTS, premises=("fixed_spectrum", "assignability"))
def _spectrum_parts(fixed_spectrum: Claim, assignability: Claim, context: Context) -> Said:
    if empty(fixed_spectrum):
        blocks = [(block.dimension, block.channels) for block in assignability.blocks]
        free = sum(size > 0 for size, _ in blocks) <= 1
        yield SPECTRUM_FREE() if free else SPECTRUM_PARTS(blocks=blocks)


def _most(factor: Claim) -> int | None:
    """An upper bound, from its exponents, on how often a factor is fixed; None if there is none."""
    in_A: int | None = factor.multiplicity_in_A
    if factor.polynomial.degree > 1:
        return in_A
    at_most: int = factor.multiplicity_at_most
    return at_most if in_A is None else min(in_A, at_most)


@mode_rule(
    "table", SPECTRUM_MOVED, SPECTRUM_MOVED_BETWEEN, premises=("fixed_spectrum", "assignability")
)
def _spectrum_moved(fixed_spectrum: Claim, assignability: Claim, context: Context) -> Said:
    """Bounds on the number of eigenvalues, with multiplicity, that gains can move.

    n − deg φ, φ the greatest common divisor of all det(xI − A_F): a factor p of the fixed
    polynomial is in φ at least once and at most as often as in det(xI − A), and if it is x − λ at
    most as often as in the loop of the certificate.  For another p that loop proves less, since no
    certificate proves p irreducible.  The eigenvalues that belong to no strong component of the
    transfer graph are roots of φ.
    """
    if empty(fixed_spectrum):
        return
    counted = [(f.polynomial.degree, _most(f)) for f in fixed_spectrum.factors]
    if any(most is None for _, most in counted):
        return
    stuck = sum(degree * most for degree, most in counted if most is not None)
    stays = max(fixed_spectrum.polynomial.degree, assignability.fixed_degree)
    template = SPECTRUM_MOVED if stuck == stays else SPECTRUM_MOVED_BETWEEN
    yield template(k=context.n - stuck, most=context.n - stays, n=context.n)


# Set-points.


@mode_rule("table", SETPOINT_ZERO, SETPOINT_DEPENDENT, SETPOINT_FEWER, premises=("setpoint",))
def _no_setpoints(setpoint: Claim, context: Context) -> Said:
    inputs, outputs = context.signals
    if setpoint.invariant_zero:
        yield SETPOINT_ZERO(place=steady_point(context.time))
    elif not setpoint.solvable and inputs < outputs:
        yield SETPOINT_FEWER(inputs=inputs, outputs=outputs)
    elif not setpoint.solvable:
        yield SETPOINT_DEPENDENT()


@mode_rule("table", SETPOINT, premises=("setpoint", "joint_controllability", "joint_observability"))
def _setpoints(
    setpoint: Claim, joint_controllability: Claim, joint_observability: Claim, context: Context
) -> Said:
    if (
        setpoint.solvable
        and joint_controllability.controllable
        and joint_observability.controllable
    ):
        yield SETPOINT()


@mode_rule(
    "table",
    SETPOINT_STABLE_REST,
    SETPOINT_UNSTABLE_REST,
    premises=("setpoint", "joint_controllability", "joint_observability", "fixed_spectrum"),
)
def _setpoints_beside(
    setpoint: Claim,
    joint_controllability: Claim,
    joint_observability: Claim,
    fixed_spectrum: Claim,
    context: Context,
) -> Said:
    """Modes that are not controllable or not observable are fixed, perhaps stable."""
    reach = (joint_controllability, joint_observability)
    if not setpoint.solvable or all(claim.controllable for claim in reach):
        return
    lost = product([claim.uncontrollable_polynomial for claim in reach])
    unstable = product(
        [
            factor.polynomial
            for factor in fixed_spectrum.factors
            if not factor.stable and factor.polynomial.divides(lost)
        ]
    )
    template = SETPOINT_UNSTABLE_REST if unstable.degree else SETPOINT_STABLE_REST
    yield template(p=unstable)


@mode_rule("table", *GAINS["every"].values(), premises=("every_channel",))
def _every_channel(every_channel: Claim, context: Context) -> Said:
    yield gains("every", every_channel, context.names)


def gains(want: str, claim: Claim, names: Sequence[str]) -> Sentence:
    """The indices for gains that exist, or the obstruction."""
    templates = GAINS[want]
    if claim.exists:
        return templates["reached"](reached=claim.indices)
    why = claim.proof
    if why.has("polynomial"):
        return templates["stuck"](name=why.channel, side=why.side, p=why.polynomial)
    inside = set(getattr(why.zero, "from"))
    return templates[why.side](
        name=why.channel, rest=[name for name in names if name not in inside]
    )


# Templates about single modes, channels, sets of channels, and pictures.

# The table of fixed modes.

FIXED_MODES = Template(
    "fixed-modes",
    "fixed modes: no {control:control} moves them",
    "evidence.shrunk_subspace_fixed_dynamic",
)
FIXED_MODE = Template(
    "fixed-modes-row",
    "{p:polynomial} | {roots:roots} | {stable:yes} | {in_A:int or open} | {stays:int} | {s:set} | "
    "{rank:int}",
    columns=("factor", "roots, about", "stable", "in A", "fixed", "s", "rank"),
)
FIXED_MODES_NOTE = Template(
    "fixed-modes-note",
    "in A: multiplicity in A; fixed: how many of these are fixed at most; rank: that of [xI-A, B "
    "of the channels outside s; C of those in s, 0], which is below n = {n:int}",
)

# A set of channels.

PENCIL = Template(
    "pencil",
    "rank of [xI-A, B of the others; C of s, 0] for s = {s:set}, at every mode of A",
    "closed_loop_spectrum.closed_loop_spectrum",
)
PENCIL_ROW = Template("pencil-row", "{p:polynomial} | {rank:int} | {below:yes}")
SUBSYSTEM = Template("subsystem", "complementary subsystem of s = {s:set}", claims=False)
NORMAL_RANK = Template("subsystem-normal-rank", "{rank:int}", label="normal rank")
ZEROS = Template("subsystem-zeros", "the roots of {zeros:factors}", label="invariant zeros")
NO_ZEROS = Template("subsystem-no-zeros", "none", label="invariant zeros")
REMNANT = Template("subsystem-remnant", "{p:polynomial}", label="remnant polynomial")
SUBSYSTEM_COMPLETE = Template(
    "subsystem-complete",
    "yes: its transfer matrix is not zero, and no rank is below n",
    label="complete",
)
SUBSYSTEM_ZERO = Template("subsystem-zero", "no: its transfer matrix is zero", label="complete")
SUBSYSTEM_DROPS = Template(
    "subsystem-drops", "no: the rank is below n at the roots of {zeros:factors}", label="complete"
)
SUBSYSTEM_BOTH = Template(
    "subsystem-zero-and-drops",
    "no: its transfer matrix is zero, and the rank is below n at the roots of {zeros:factors}",
    label="complete",
)

# A channel.

CHANNEL = Template("channel", "channel {name:name}", claims=False)
_ALONE = {"controllability": "controllable alone", "observability": "observable alone"}
ALONE = {
    what: (
        Template(f"channel-{what}", "every mode", label=label),
        Template(f"channel-no-{what}", "all but {p:modes}", label=label),
    )
    for what, label in _ALONE.items()
}


# Pictures of a page.

PICTURE = Template("picture-graphs", "Graphs", claims=False)
PICTURE_MODE = Template("picture-fixed-mode", "Fixed mode", claims=False)
PICTURE_OUTPUTS = Template("picture-graphs-outputs", "Graphs (agents share outputs)", claims=False)
PICTURE_NEIGHBORS = Template("picture-neighbor-graph", "neighbor graph: {arcs:arrows}")
PICTURE_TRANSFER = Template(
    "picture-transfer-graph", "transfer graph, between different channels: {arcs:arrows}"
)
PICTURE_OBSTRUCTION = Template(
    "picture-obstruction", "orange: {s:channels}, the set s of {p:modes}"
)
PICTURE_HEARD = Template(
    "picture-heard", "purple: {heard:channels}, from which some of them receive"
)
PICTURE_DIMENSIONS = Template("picture-dimensions", "Shared states by agent", claims=False)

# A page.

PAGE_HEADING = Template(
    "page-heading",
    "{n:count state}, {m:count channel}, {time:time} time; {information:information}",
)

# LaTeX.

LATEX_NOTHING_FIXED = Template(
    "latex-nothing-fixed", r"$\Lambda_{{\mathrm{{fixed}}}} = \emptyset$."
)
LATEX_FIXED_MODE = Template(
    "latex-fixed-mode",
    r"${p:latex}$ & {in_A:int or open} & {rank:int} & $\{{\text{{{s:latex_names}}}\}}$ \\",
)


# Rules about single modes, channels, sets of channels, and pictures.

DETAIL_RULES = Rulebook()
detail_rule = DETAIL_RULES.rule

# The table of fixed modes.


@detail_rule("fixed-modes.title", FIXED_MODES, premises=("fixed_spectrum",))
def _fixed_modes(fixed_spectrum: Claim, context: Context) -> Said:
    if not empty(fixed_spectrum):
        yield FIXED_MODES(control=control(fixed_spectrum, context))


@detail_rule("fixed-modes", FIXED_MODE, premises=("fixed_spectrum",))
def _fixed_mode(fixed_spectrum: Claim, context: Context) -> Said:
    for factor in fixed_spectrum.factors.separately("stable"):
        yield FIXED_MODE(
            p=factor.polynomial,
            roots=_centers(factor),
            stable=factor.stable,
            in_A=factor.multiplicity_in_A,
            stays=factor.multiplicity_at_most,
            s=factor.channels,
            rank=factor.rank,
        )


def _centers(factor: Claim) -> list[tuple[Fraction, Fraction]]:
    """The centers of the root discs, or the value of a rational root."""
    if factor.polynomial.degree == 1:
        return [(-factor.polynomial.coefficients[0], Fraction(0))]
    return [(exact_decimal(disc.re), exact_decimal(disc.im)) for disc in factor.roots]


@detail_rule("fixed-modes.note", FIXED_MODES_NOTE, premises=("fixed_spectrum",))
def _columns(fixed_spectrum: Claim, context: Context) -> Said:
    if not empty(fixed_spectrum):
        yield FIXED_MODES_NOTE(n=context.n)


# A set of channels.


@detail_rule("pencil.title", PENCIL, premises=("spectrum_of_A", "pencil_rank"))
def _pencil(spectrum_of_A: Claim, pencil_rank: Iterable[Claim], context: Context) -> Said:
    subsets = [claim.subset for claim in pencil_rank if claim.polynomial.degree]
    if subsets and spectrum_of_A.polynomial.degree:
        yield PENCIL(s=subsets[0])


@detail_rule("pencil", PENCIL_ROW, premises=("pencil_rank",))
def _ranks(pencil_rank: Several, context: Context) -> Said:
    for claim in pencil_rank.separately():
        rank = claim.rank
        yield PENCIL_ROW(p=claim.polynomial, rank=rank, below=rank < context.n)


@detail_rule("subsystem.title", SUBSYSTEM, premises=("complementary_subsystem",))
def _subsystem(complementary_subsystem: Claim, context: Context) -> Said:
    yield SUBSYSTEM(s=complementary_subsystem.subset)


@detail_rule("subsystem", NORMAL_RANK, premises=("complementary_subsystem",))
def _normal_rank(complementary_subsystem: Claim, context: Context) -> Said:
    yield NORMAL_RANK(rank=complementary_subsystem.normal_rank)


@detail_rule("subsystem", ZEROS, NO_ZEROS, premises=("complementary_subsystem",))
def _zeros(complementary_subsystem: Claim, context: Context) -> Said:
    """The largest invariant polynomial has all invariant zeros: each of the others divides it."""
    polynomials = complementary_subsystem.invariant_polynomials
    if polynomials:
        yield ZEROS(zeros=[p for p, _ in polynomials[-1].factor()])
    else:
        yield NO_ZEROS()


@detail_rule("subsystem", REMNANT, premises=("complementary_subsystem",))
def _remnant(complementary_subsystem: Claim, context: Context) -> Said:
    yield REMNANT(p=complementary_subsystem.remnant)


@detail_rule(
    "subsystem",
    *(SUBSYSTEM_COMPLETE, SUBSYSTEM_ZERO, SUBSYSTEM_DROPS, SUBSYSTEM_BOTH),
    premises=("complementary_subsystem",),
)
def _subsystem_complete(complementary_subsystem: Claim, context: Context) -> Said:
    """The roots of the remnant polynomial are the points where the rank is below n."""
    subsystem = complementary_subsystem
    drops = [p for p, _ in subsystem.remnant.factor()]
    if subsystem.complete:
        yield SUBSYSTEM_COMPLETE()
    elif not drops:
        yield SUBSYSTEM_ZERO()
    else:
        yield (SUBSYSTEM_BOTH if subsystem.transfer_zero else SUBSYSTEM_DROPS)(zeros=drops)


# A channel.


@detail_rule("channel.title", CHANNEL, premises=("channel_controllability",))
def _channel(channel_controllability: Claim, context: Context) -> Said:
    [name] = channel_controllability.channels
    yield CHANNEL(name=name)


@detail_rule("channel", *ALONE["controllability"], premises=("channel_controllability",))
def _controlled_alone(channel_controllability: Claim, context: Context) -> Said:
    yield from reached(channel_controllability, *ALONE["controllability"])


@detail_rule("channel", *ALONE["observability"], premises=("channel_observability",))
def _observed_alone(channel_observability: Claim, context: Context) -> Said:
    yield from reached(channel_observability, *ALONE["observability"])


def _gains_rules(want: str) -> None:
    """Make the rule of gains with which one channel controls or observes everything."""

    @detail_rule("channel", *GAINS[want].values(), premises=(f"channel_gains_{want}",))
    def _with_gains(claim: Claim, context: Context) -> Said:
        yield gains(want, claim, context.names)


for want in ("controllable", "observable", "both"):
    _gains_rules(want)


# The page, its pictures, and LaTeX.


@detail_rule("page", PAGE_HEADING)
def _page_heading(context: Context) -> Said:
    heard = "outputs" if context.delays == "none" else "instant"
    information = heard if context.information == "outputs" else "own"
    yield PAGE_HEADING(n=context.n, m=context.m, time=context.time, information=information)


@detail_rule("mode.title", PICTURE_MODE, premises=("fixed_spectrum",))
def _mode_picture(fixed_spectrum: Claim, context: Context) -> Said:
    if not empty(fixed_spectrum):
        yield PICTURE_MODE()


@detail_rule("graphs.title", PICTURE, PICTURE_OUTPUTS)
def _picture(context: Context) -> Said:
    yield PICTURE_OUTPUTS() if context.information == "outputs" else PICTURE()


@detail_rule("graphs", PICTURE_NEIGHBORS)
def _neighbor_edges(context: Context) -> Said:
    if context.neighbors is not None:
        names = context.names
        edges = [(names[j], names[i]) for j, i in context.neighbors.edges()]
        yield PICTURE_NEIGHBORS(arcs=edges)


@detail_rule("graphs", PICTURE_TRANSFER, premises=("transfer_graph",))
def _transfer_edges(transfer_graph: Claim, context: Context) -> Said:
    yield PICTURE_TRANSFER(arcs=[edge for edge in transfer_graph.arcs if edge[0] != edge[1]])


@detail_rule("graphs", PICTURE_OBSTRUCTION, PICTURE_HEARD, premises=("fixed_spectrum",))
def _obstruction(fixed_spectrum: Claim, context: Context) -> Said:
    """The picture marks the set of the first mode, and the outside agents that send to it."""
    for factor in fixed_spectrum.factors.separately():
        subset = factor.channels
        if subset:
            yield PICTURE_OBSTRUCTION(s=subset, p=factor.polynomial)
        heard = context.senders(subset) if context.neighbors is not None else []
        if heard:
            yield PICTURE_HEARD(heard=heard)
        break


@detail_rule(
    "dimensions.title", PICTURE_DIMENSIONS, premises=("minimal_shared_dimensions_outputs_states",)
)
def _dimensions_title(minimal_shared_dimensions_outputs_states: Claim, context: Context) -> Said:
    if minimal_shared_dimensions_outputs_states.share == "outputs+states":
        yield PICTURE_DIMENSIONS()


@detail_rule("latex", LATEX_NOTHING_FIXED, premises=("fixed_spectrum",))
def _latex_nothing(fixed_spectrum: Claim, context: Context) -> Said:
    if empty(fixed_spectrum):
        yield LATEX_NOTHING_FIXED()


@detail_rule("latex", LATEX_FIXED_MODE, premises=("fixed_spectrum",))
def _latex_modes(fixed_spectrum: Claim, context: Context) -> Said:
    for factor in fixed_spectrum.factors.separately():
        yield LATEX_FIXED_MODE(
            p=factor.polynomial, in_A=factor.multiplicity_in_A, rank=factor.rank, s=factor.channels
        )
