"""Sentences about control that varies in time or is nonlinear: quotient fixed modes.

Linear time-invariant decentralized control leaves the fixed modes where they are.  Of these,
control that varies in time leaves only the *quotient* fixed modes: those of the plant with the
channels of each strong component of its transfer graph merged into one.  `ANSWER_RULES` say whether
any causal decentralized control stabilizes a plant which linear time-invariant control does not,
and `TABLE_RULES` list the quotient fixed modes.  `PERIODIC_RULES` are about the loop of a periodic
decentralized controller over one period, whose eigenvalues a certificate locates.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from mcexact.answer.sentence import Certified, Claim, Context, Rulebook
from mcexact.answer.templates import Sentence, Template
from mcexact.exact.roots import is_discrete

Said = Iterator[Sentence]

_NECESSARY = "time_varying.no_causal_control_moves"

TIME_VARYING = Template(
    "time-varying-stabilizes",
    "Time-varying {control:causal} can stabilize the plant.",
    "B. D. O. Anderson and J. B. Moore 1981; P. P. Khargonekar and A. B. Ozguler 1994; "
    "L. Gong and M. Aldeen 1997",
)
NO_CAUSAL = Template(
    "no-causal-control",
    "No time-varying or nonlinear causal {control:causal} can stabilize it.",
    _NECESSARY,
)
OPTION = Template(
    "time-varying-option",
    "`mcexact design decentralized --periodic` designs such control.",
    claims=False,
)
_LABEL = "quotient fixed modes"
NONE = Template("quotient-fixed-none", "none", label=_LABEL)
QUOTIENT = Template("quotient-fixed", "{p:modes}", _NECESSARY, _LABEL)

_ANY_STEP = "periodic.any_step"
PERIODIC = Template(
    "periodic-stabilizes",
    "The decentralized controller of period {period:int} stabilizes the plant.",
    _ANY_STEP,
)
PERIODIC_NOT = Template(
    "periodic-unstable",
    "The decentralized controller of period {period:int} does not stabilize the plant.",
    _ANY_STEP,
)
PERIODIC_LOOP = Template("periodic-loop", "closed loop over a period", claims=False)
PERIODIC_RADIUS = Template(
    "periodic-radius",
    "over {steps:count step} the state tends to 0 faster than ({radius:number})^{steps:int}",
    _ANY_STEP,
    "decay of the loop",
)
PERIODIC_SLOW = Template(
    "periodic-slow",
    "over {steps:count step} the state does not tend to 0 faster than "
    "({radius:number})^{steps:int}",
    _ANY_STEP,
    "decay of the loop",
)
PERIODIC_STATES = Template("periodic-states", "{n:int}", label="states of the loop")
PERIODIC_ORDER = Template("periodic-order", "{order:int}", label="states of all agents together")

ANSWER_RULES, TABLE_RULES, PERIODIC_RULES = Rulebook(), Rulebook(), Rulebook()


def _of_the_system(quotient: Certified, graph: Claim, context: Context) -> bool:
    """Whether the parts are the strong components of the system that the sentences are about."""
    *before, last = quotient.subject
    merged = quotient.made_by(len(before)).parts if last["construction"] == "merged" else ()
    components = graph.components
    return len(before) == len(context.system.subject) and _sets(merged) == _sets(components)


def _sets(parts: Iterable[Iterable[str]]) -> set[frozenset[str]]:
    return {frozenset(part) for part in parts}


@ANSWER_RULES.rule(
    "answer",
    TIME_VARYING,
    OPTION,
    NO_CAUSAL,
    premises=("fixed_spectrum", "transfer_graph", "quotient_fixed_spectrum"),
)
def _stabilized(
    fixed_spectrum: Claim,
    transfer_graph: Claim,
    quotient_fixed_spectrum: Certified,
    context: Context,
) -> Said:
    """Whether any causal control stabilizes a plant that linear time-invariant control does not."""
    quotient = quotient_fixed_spectrum
    if fixed_spectrum.stabilizable or not _of_the_system(quotient, transfer_graph, context):
        return
    linked = context.neighbors is not None and context.neighbors.edges()
    by = "alone" if linked else "own"
    if quotient.stabilizable:
        yield TIME_VARYING(control=by)
        system = context.system
        if is_discrete(system.time) and system.D is None and not system.subject:
            yield OPTION()
    else:
        yield NO_CAUSAL(control=by)


@TABLE_RULES.rule("table", NONE, QUOTIENT, premises=("transfer_graph", "quotient_fixed_spectrum"))
def _quotient(transfer_graph: Claim, quotient_fixed_spectrum: Certified, context: Context) -> Said:
    if _of_the_system(quotient_fixed_spectrum, transfer_graph, context):
        p = quotient_fixed_spectrum.polynomial
        yield QUOTIENT(p=p) if p.degree else NONE()


# The loop of a periodic decentralized controller, which is decided over one period.


@PERIODIC_RULES.rule("answer", PERIODIC, PERIODIC_NOT, premises=("periodic_loop",))
def _periodic(periodic_loop: Claim, context: Context) -> Said:
    """Whether the loop tends to 0, from every start in every step of the period."""
    if periodic_loop.stable:
        yield PERIODIC(period=context.period)
    elif periodic_loop.bound is None:
        yield PERIODIC_NOT(period=context.period)


@PERIODIC_RULES.rule("title", PERIODIC_LOOP, premises=("periodic_loop",))
def _title(periodic_loop: Claim, context: Context) -> Said:
    """The title of a verdict."""
    _ = periodic_loop.stable
    yield PERIODIC_LOOP()


@PERIODIC_RULES.rule("table", PERIODIC_RADIUS, PERIODIC_SLOW, premises=("periodic_loop",))
def _decay(periodic_loop: Claim, context: Context) -> Said:
    """The radius of one step, whose power is the certified radius of the period."""
    radius, N = context.region.bound, context.period
    if radius is not None and periodic_loop.bound == radius**N:
        template = PERIODIC_RADIUS if periodic_loop.stable else PERIODIC_SLOW
        yield template(steps=N, radius=radius)


@PERIODIC_RULES.rule("table", PERIODIC_STATES, premises=("periodic_loop",))
def _states(periodic_loop: Claim, context: Context) -> Said:
    """The size of the loop that the verdict is about."""
    _ = periodic_loop.stable
    yield PERIODIC_STATES(n=context.states)


@PERIODIC_RULES.rule("table", PERIODIC_ORDER, premises=("periodic_loop",))
def _order(periodic_loop: Claim, context: Context) -> Said:
    """How much of it the controller adds."""
    _ = periodic_loop.stable
    yield PERIODIC_ORDER(order=context.order)
