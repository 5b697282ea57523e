"""Closed loops and refused designs: answers and sentences.

`StabilityVerdict` says whether every eigenvalue of a loop lies in a region, by one of three
methods: roots of the characteristic polynomial located exactly (`PolynomialMethod`), a Lyapunov
matrix for each diagonal block (`LyapunovMethod`), or a quadratic form that proves the contrary
(`InstabilityMethod`).  Lyapunov matrices are proposed in floating point and verified exactly.
`ClosedLoopSpectrum` has the characteristic polynomial itself, and `DistributedObserver` the two
polynomials into which the loop of a distributed observer separates.

The sentences are those of `mcexact design` and `mcexact certify`, and those of refusals, which say
why no requested design exists.  Templates precede the rules that fill them.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any, Literal

from mcexact.answer.analysis import RECEIVE_TOO_LITTLE, SOURCES, WHATEVER_SHARED, Said, sides
from mcexact.answer.protocol import LEFT_OUT, Answer, Part, answer, claim, witness
from mcexact.answer.sentence import Certified, Claim, Context, Rulebook
from mcexact.answer.templates import Template
from mcexact.derived.sampling import is_sampled
from mcexact.errors import Impossible, InternalError
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.roots import LIMITS, StabilityRegion, steady_point
from mcexact.model.signals import constant_signals, signals_in_words
from mcexact.plot.eigenvalues import eigenvalues

# Answer: whether all eigenvalues of a matrix meet a rate or a radius.


@dataclass(frozen=True)
class PolynomialMethod(Part):
    """The checker recomputes the characteristic polynomial over Q and locates its roots exactly."""

    method: Literal["polynomial"] = "polynomial"


@dataclass(frozen=True)
class LyapunovForm(Part):
    """A Lyapunov matrix for a limit other than the rate, of a matrix derived from a block.

    Attributes
    ----------
    P, R, R2 : Matrix
        As in `LyapunovBlock`.
    """

    P: Matrix
    R: Matrix
    R2: Matrix


@dataclass(frozen=True)
class LyapunovBlock(Part):
    """A Lyapunov matrix of one diagonal block D, k × k, proposed in floating point.

    The numbers depend on the processor and on the versions of numpy and scipy, and are verified
    exactly.

    Attributes
    ----------
    size : int
        k.
    P : Matrix
        Symmetric.
    R, R2 : Matrix
        RᵀPR and −R2ᵀ(DᵀP + PD + 2·bound·P)R2 (discrete time: R2ᵀ(bound²P − DᵀPD)R2) are strictly
        diagonally dominant with positive diagonal.
    damping : LyapunovForm or None
        Of the 2k × 2k matrix `lifted`, in continuous time and without a rate.
    largest_modulus : LyapunovForm or None
        Of D, in discrete time and for the largest modulus.
    """

    size: int
    P: Matrix
    R: Matrix
    R2: Matrix
    damping: LyapunovForm | None = field(default=None, kw_only=True, metadata=LEFT_OUT)
    largest_modulus: LyapunovForm | None = field(default=None, kw_only=True, metadata=LEFT_OUT)


@dataclass(frozen=True)
class Transformation(Part):
    """M T = T Δ, T nonsingular modulo ℓ and Δ block upper triangular."""

    T: Matrix
    Delta: Matrix
    modulus: int


@dataclass(frozen=True)
class LyapunovMethod(Part):
    """One Lyapunov matrix for each diagonal block, after a transformation if there is one."""

    transformation: Transformation | None
    blocks: tuple[LyapunovBlock, ...]
    method: Literal["lyapunov"] = "lyapunov"


@dataclass(frozen=True)
class InstabilityMethod(Part):
    """A P whose derivative along the loop is negative, and a v with vᵀPv ≤ 0.

    Attributes
    ----------
    P, R2 : Matrix
        As in `LyapunovBlock`, for the whole matrix.
    v : Matrix
        One column, not 0.
    side : str or None
        ``"bound"``, ``"damping"`` or ``"largest_modulus"``: what is violated, if there are limits.
    """

    P: Matrix
    R2: Matrix
    v: Matrix
    side: str | None = field(default=None, kw_only=True, metadata=LEFT_OUT)
    method: Literal["instability"] = "instability"


@answer("stability")
class StabilityVerdict(Answer):
    """Whether every eigenvalue of the matrix A of a system, usually a loop, lies in a region.

    Attributes
    ----------
    bound : Fraction or None
        A rate ≥ 0 (continuous time) or a radius in (0, 1] (discrete time); None means 0 or 1.
    stable : bool
    damping, largest_modulus : Fraction or None
        Limits in continuous time: −Re λ > damping·|λ|, |λ| < largest_modulus.
    evidence : PolynomialMethod, LyapunovMethod or InstabilityMethod
    """

    bound: Fraction | None = claim()
    stable: bool = claim()
    damping: Fraction | None = claim(optional=True)
    largest_modulus: Fraction | None = claim(optional=True)
    evidence: PolynomialMethod | LyapunovMethod | InstabilityMethod = witness(whole=True)

    @property
    def region(self) -> StabilityRegion:
        """The region in which the eigenvalues should lie."""
        return StabilityRegion(self.about.time, self.bound, self.damping, self.largest_modulus)

    @property
    def blocks(self) -> tuple[int, ...]:
        """The sizes of the separately decided diagonal blocks, or the size of the loop."""
        if isinstance(self.evidence, LyapunovMethod):
            return tuple(block.size for block in self.evidence.blocks)
        return (self.about.n,)

    @property
    def method(self) -> str:
        """The method that decided: ``"polynomial"``, ``"lyapunov"`` or ``"instability"``."""
        return self.evidence.method


# Answer: the characteristic polynomial of a closed loop, coefficient by coefficient.


@answer("closed_loop_spectrum")
class ClosedLoopSpectrum(Answer):
    """The characteristic polynomial of the matrix A of a system, usually a closed loop.

    Attributes
    ----------
    polynomial : Polynomial
        Monic, of degree n.
    moduli : tuple of int
        Pairwise coprime, modulo each of which the polynomials agree; their product exceeds twice a
        bound on the coefficients.
    """

    polynomial: Polynomial = claim()
    moduli: tuple[int, ...] = witness()

    def plot(self, ax: Any = None) -> Any:
        """Draw the eigenvalues with their multiplicities; see `mcexact.plot.eigenvalues`."""
        return eigenvalues(self, ax, time=self.about.time)


# Answer: the loop of a distributed observer separates, and both parts have known spectra.


@answer("distributed_observer")
class DistributedObserver(Answer):
    """In the coordinates (x, e_1, z_1, …), e_i = x_i − x, the loop is [M_F, *; 0, M_E].

    Attributes
    ----------
    feedback : Polynomial
        The characteristic polynomial of M_F = A + Σ B_i F_i, of degree n.
    error : Polynomial
        The characteristic polynomial of M_E, the matrix of the error system.
    bound : Fraction or None
        A certified rate (every real part is below −bound) or radius (every modulus is below it).
    moduli : tuple of int
        As in ``closed_loop_spectrum``, enough for both polynomials.
    """

    feedback: Polynomial = claim()
    error: Polynomial = claim()
    bound: Fraction | None = claim()
    moduli: tuple[int, ...] = witness()


# Templates of `mcexact design` and `certify`.

OBSERVER = Template("design-observer", "distributed observer; closed loop certified")
OBSERVER_FLOAT = Template(
    "design-observer-float",
    "distributed observer, designed in floating point; closed loop certified",
)
NETWORK = Template("design-network", "{kind:network}; closed loop certified")
SETPOINT = Template(
    "design-setpoint", "set-point controller ({method:method}); closed loop certified"
)
TRACKING = Template(
    "design-tracking", "tracking controller ({method:method}); closed loop certified"
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
DESIGN_SOURCES = replace(SOURCES, key="design-source-components")
ORDER = Template("design-order", "{order:int}", label="states of all agents together")
ORDER_INTEGRATORS = Template(
    "design-order-integrators",
    "{order:int}, integrators included",
    label="states of all agents together",
)
ORDER_MODELS = Template(
    "design-order-models",
    "{order:int}, models of signals included",
    label="states of all agents together",
)
FEEDBACK = Template("design-feedback", "{p:polynomial}", label="spectrum of A + sum B_i F_i")
ERRORS = Template("design-errors", "{p:polynomial}", label="spectrum of the errors")
REGION = Template("design-region", "{region:region}", label="every eigenvalue of the loop")
OBSERVER_ORDER = Template(
    "design-observer-order", "{order:int}", label="states of an observer instead"
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
STEADY_REGULATED = Template(
    "design-steady-regulated",
    "{held:regulated}: each tends to its set-point if every set-point, and every disturbance of "
    "the plant, is constant",
    "B. A. Francis and W. M. Wonham 1976",
    "regulated outputs",
)
STEADY_SIGNALS = Template(
    "design-steady-signals",
    "{held:regulated}: each follows its reference with an error that tends to 0 if every "
    "reference, and every disturbance of the plant, is a sum of {signals:words}",
    "B. A. Francis and W. M. Wonham 1976",
    "outputs that follow",
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
EVERY_SAMPLED = Template(
    "members-sampled-region",
    "every eigenvalue of every loop satisfies {region:region}{gains:gains}, sampled exactly",
    label="within the radii",
)
EVERY_SAMPLED_PART = Template(
    "members-sampled-region-part",
    "{region:region} for the exact samples of every plant within {part:percent} of each entry"
    "{gains:gains}",
    label="every loop near this one",
)
SAMPLED_EXACTLY = Template(
    "members-sampled-exactly",
    "{region:region} for the exact samples of the plant{gains:gains}",
    label="sampled exactly",
)
SAMPLED = Template(
    "sampled-loop",
    "every {step:step} with inputs held{late:late}; what is said of one loop is about A and B "
    "rounded to {decimals:count decimal}, at the samples",
    label="the plant is sampled",
)
_EVERY_MARGIN = "at least {margin:digits_below} for every plant within the radii"
_EVERY_MARGIN_PART = (
    "at least {margin:digits_below} for every plant within {part:percent} of each entry"
)
EVERY_MARGIN = {
    at: (
        Template(f"members-{at}-margin", _EVERY_MARGIN, label=label),
        Template(f"members-{at}-margin-part", _EVERY_MARGIN_PART, label=label),
    )
    for at, label in (
        ("input", "disk margin of each input in a box"),
        ("output", "disk margin of each output in a box"),
    )
}
EVERY_VALUE = Template(
    "parametric-ranges-in-region",
    "{region:region} for every {parameters:words}{gains:gains}",
    label="every loop in the ranges",
)
FAILING_PLANT = Template(
    "certify-failing-plant",
    "for some plant within {distance:percent_above} of each entry",
    label="a loop is not stable",
)
FAILING_PLANT_RADII = Template(
    "certify-failing-plant-radii",
    "for some plant within {distance:digits_above} times the radii",
    label="a loop is not stable",
)
LARGEST = Template("certify-largest", "{bound:number}", label="largest rate found")
LEAST = Template("certify-least", "{bound:number}", label="least radius found")


# Rules of `mcexact design` and `certify`.

DESIGN_RULES = Rulebook()
design_rule = DESIGN_RULES.rule


def inside(loop: Claim, region: StabilityRegion) -> bool:
    """Whether the claim about a loop is that every eigenvalue lies in a region."""
    if loop.has("stable"):
        return bool(loop.stable and about(loop, region))
    parts = (loop.polynomial,) if loop.has("polynomial") else (loop.feedback, loop.error)
    return all(region.contains_roots_of(p) for p in parts)


def about(loop: Claim, region: StabilityRegion) -> bool:
    """Whether a claim of the kind ``stability`` is about this region."""
    limits = {name: getattr(loop, name) for name in LIMITS if loop.has(name)}
    return bool(loop.bound == region.bound and limits == region.limits)


# All loops of a box.

EVERY_LOOP_RULES = Rulebook()


@EVERY_LOOP_RULES.rule("table", SAMPLED, premises=("loop",))
def _sampled(loop: Certified, context: Context) -> Said:
    """How the plant was sampled, and which of its matrices the claims about one loop are about."""
    if is_sampled(context.system):
        how = loop.made_by(0)
        yield SAMPLED(step=Fraction(how.step), late=how.late, decimals=how.decimals)


@EVERY_LOOP_RULES.rule(
    "table",
    EVERY_LOOP,
    EVERY_LOOP_PART,
    EVERY_SAMPLED,
    EVERY_SAMPLED_PART,
    SAMPLED_EXACTLY,
    EVERY_VALUE,
    premises=("box_stability",),
)
def _every_loop(box_stability: Claim, context: Context) -> Said:
    """The region of the eigenvalues of all loops: within the radii, or the ranges of parameters."""
    region = StabilityRegion.of(context.time, bound=box_stability.bound)
    gains = None if box_stability.gain_radii is None else context.part_of_gains
    if context.has("parameters"):
        yield EVERY_VALUE(region=region, parameters=context.parameters, gains=gains)
        return
    part, sampled = context.part_of_plant, is_sampled(context.system)
    if part is None:
        yield (EVERY_SAMPLED if sampled else EVERY_LOOP)(region=region, gains=gains)
    elif sampled and not part:
        yield SAMPLED_EXACTLY(region=region, gains=gains)
    else:
        within = EVERY_SAMPLED_PART if sampled else EVERY_LOOP_PART
        yield within(region=region, part=part, gains=gains)


def _margin_rule(at: str) -> None:
    """Make the rule about the disk margin of each input, or output, for all plants of a box."""
    within_radii, within_part = EVERY_MARGIN[at]

    @EVERY_LOOP_RULES.rule("table", within_radii, within_part, premises=(f"box_{at}_margin",))
    def _margin(loops: Claim, context: Context) -> Said:
        if loops.has("disk") and loops.disk.at == f"{at}s":
            part = context.part_of_margins
            if part is None:
                yield within_radii(margin=loops.disk.margin)
            else:
                yield within_part(margin=loops.disk.margin, part=part)


for _at in EVERY_MARGIN:
    _margin_rule(_at)


@EVERY_LOOP_RULES.rule(
    "table", FAILING_PLANT, FAILING_PLANT_RADII, premises=("failing_loop", "loop")
)
def _failing_plant(failing_loop: Claim, loop: Claim, context: Context) -> Said:
    """Say how near a plant is whose loop with the same controller is not stable."""
    if not failing_loop.stable and failing_loop.bound is None and inside(loop, context.region):
        template = FAILING_PLANT_RADII if context.of_radii else FAILING_PLANT
        yield template(distance=context.fails_within)


# Designs.


@design_rule(
    "title", OBSERVER, OBSERVER_FLOAT, NETWORK, SETPOINT, TRACKING, LOOP, premises=("loop",)
)
def _title(loop: Claim, context: Context) -> Said:
    """The heading of a design; without a certified region there is no other sentence."""
    if not inside(loop, context.region):
        yield LOOP()
    elif context.has("followed"):
        yield TRACKING(method=context.method)
    elif context.has("solvability"):
        yield SETPOINT(method=context.method)
    elif context.method == "observer":
        yield (OBSERVER if context.arithmetic == "exact" else OBSERVER_FLOAT)()
    else:
        shares = context.network == "decentralized" or any(context.dimensions.values())
        yield NETWORK(kind=context.network if shares else "without")


@design_rule("table", ORDER, ORDER_INTEGRATORS, ORDER_MODELS)
def _order(context: Context) -> Said:
    template = ORDER_INTEGRATORS if context.has("solvability") else ORDER
    yield (ORDER_MODELS if context.has("followed") else template)(order=context.order)


@design_rule("table", OBSERVER_ORDER)
def _observer_order(context: Context) -> Said:
    if context.has("observer_order"):
        yield OBSERVER_ORDER(order=context.observer_order)


@design_rule("table", SHARED)
def _shared(context: Context) -> Said:
    if context.has("network") and context.network != "decentralized":
        yield SHARED(sizes=list(context.dimensions.items()))


@design_rule("table", CARRIER, CARRIER_FOR)
def _carrier(context: Context) -> Said:
    if context.has("agent"):
        yield CARRIER(agent=context.agent, order=context.channel_order)
    blocks = context.blocks if context.has("blocks") else ()
    template = CARRIER if len(blocks) == 1 else CARRIER_FOR
    for block in blocks:
        yield template(agent=block.agent, order=block.order, channels=block.channels)


@design_rule("table", DESIGN_SOURCES, premises=("shared_fixed_spectrum",))
def _sources(shared_fixed_spectrum: Claim, context: Context) -> Said:
    """The agents on which a design over a graph depends that is not strongly connected."""
    if shared_fixed_spectrum.polynomial.degree < context.n:
        yield DESIGN_SOURCES(parts=context.sources)


@design_rule("table", ASSIGNED, premises=("loop",))
def _assigned(loop: Claim, context: Context) -> Said:
    if context.has("blocks") and loop.has("polynomial"):
        for block in context.blocks:
            if block.polynomial.divides(loop.polynomial):
                yield ASSIGNED(p=block.polynomial)


@design_rule("table", KEPT, premises=("loop", "fixed_spectrum"))
def _kept(loop: Claim, fixed_spectrum: Claim, context: Context) -> Said:
    """The fixed modes that remain under the design."""
    if context.has("kept") and context.kept.degree and inside(loop, context.region):
        fixed = fixed_spectrum.polynomial
        if all(p.divides(fixed) for p, _ in context.kept.factor()):
            yield KEPT(p=context.kept)


@design_rule("table", FEEDBACK, premises=("loop",))
def _feedback(loop: Claim, context: Context) -> Said:
    if loop.has("feedback"):
        yield FEEDBACK(p=loop.feedback)


@design_rule("table", ERRORS, premises=("loop",))
def _errors(loop: Claim, context: Context) -> Said:
    if loop.has("error"):
        yield ERRORS(p=loop.error)


@design_rule("table", REGION, premises=("bounded_loop",))
def _region(bounded_loop: Claim, context: Context) -> Said:
    loop, bound = bounded_loop, context.region.bound
    if bound is not None and loop.bound == bound and inside(loop, context.region):
        yield REGION(region=context.region)


@design_rule("table", OUTSIDE, premises=("stability",))
def _unstable(stability: Claim, context: Context) -> Said:
    """Warn that the loop, whose prescribed spectrum is not stable, must not be installed."""
    if not stability.stable:
        yield OUTSIDE(region=context.region)


@design_rule("table", STEADY, STEADY_REGULATED, STEADY_SIGNALS, premises=("loop",))
def _steady(loop: Claim, context: Context) -> Said:
    if context.has("followed") and inside(loop, context.region):
        words = signals_in_words(context.followed, context.time)
        yield STEADY_SIGNALS(held=context.held, signals=words)
    elif context.has("solvability") and inside(loop, context.region):
        if context.held is None:
            yield STEADY()
        else:
            yield STEADY_REGULATED(held=context.held)


@design_rule("table", LONGEST)
def _longest(context: Context) -> Said:
    yield LONGEST(bits=context.bits)


@design_rule("measured.title", MEASURED)
def _measured(context: Context) -> Said:
    yield MEASURED()


DESIGN = Rulebook([*DESIGN_RULES, *EVERY_LOOP_RULES])

# Verdicts.

VERDICT_RULES = Rulebook()
verdict_rule = VERDICT_RULES.rule


@verdict_rule("title", LOOP, premises=("loop",))
def _verdict(loop: Claim, context: Context) -> Said:
    """The title of a verdict."""
    _ = loop.stable
    yield LOOP()


@verdict_rule("table", LOOP_STATES)
def _states(context: Context) -> Said:
    yield LOOP_STATES(n=context.states)


@verdict_rule("table", INSIDE, OUTSIDE, premises=("loop",))
def _location(loop: Claim, context: Context) -> Said:
    if about(loop, context.region):
        yield (INSIDE if loop.stable else OUTSIDE)(region=context.region)


@verdict_rule("table", DECIDED, DECIDED_BLOCKS, premises=("loop",))
def _decided(loop: Claim, context: Context) -> Said:
    """The method of the decision, and the blocks to which it was applied."""
    proof = loop.proof
    sizes = [block.size for block in proof.blocks] if proof.has("blocks") else []
    yield DECIDED_BLOCKS(sizes=sizes) if len(sizes) > 1 else DECIDED(method=proof.method)


@verdict_rule("table", LARGEST, LEAST, premises=("loop",))
def _largest(loop: Claim, context: Context) -> Said:
    if context.largest and loop.stable and loop.bound is not None:
        yield (LEAST if context.region.discrete else LARGEST)(bound=loop.bound)


@verdict_rule("table", STEADY, STEADY_REGULATED, STEADY_SIGNALS, premises=("loop",))
def _followed(loop: Claim, context: Context) -> Said:
    """What the outputs of the loop follow, by the models of signals in its controller."""
    if context.has("follows") and loop.stable:
        for alpha, held in context.follows.items():
            if alpha != constant_signals(context.time):
                words = signals_in_words(alpha, context.time)
                yield STEADY_SIGNALS(held=held, signals=words)
            elif [(name, len(rows)) for name, rows in held] == context.outputs:
                yield STEADY()
            else:
                yield STEADY_REGULATED(held=held)


VERDICT = Rulebook([*VERDICT_RULES, *EVERY_LOOP_RULES])


# Templates of refusals.

NOT_CONTROLLABLE = Template(
    "refused-not-controllable",
    "no state feedback moves {p:modes}: the system is not jointly controllable",
    "controllability.uncontrollable_modes",
)
NOT_CONTROLLABLE_IN = Template(
    "refused-not-controllable-in",
    "no state feedback moves {p:modes}, {p:escape} {region:region}: the system is not jointly "
    "controllable",
    "controllability.uncontrollable_modes",
)
UNREACHED = {
    "move": Template(
        "refused-uncontrollable",
        "no controller moves {p:modes}, {p:escape} {region:region}: all channels together do not "
        "control {p:them}",
        "controllability.uncontrollable_modes",
    ),
    "see": Template(
        "refused-unobservable",
        "no controller observes {p:modes}, {p:escape} {region:region}: all channels together do "
        "not observe {p:them}",
        "controllability.uncontrollable_modes",
    ),
}
NOT_OBSERVABLE = Template(
    "refused-not-observable",
    "no distributed observer moves {p:modes} of its errors: all channels together do not observe "
    "{p:them}",
    "controllability.uncontrollable_modes",
)
ERRORS_NOT_COMPLETE = Template(
    "refused-errors-not-complete",
    "the error system for these F_i is not complete: no constant K_i, H_ij let one agent control "
    "and observe all estimation errors",
    "free_assignment.corfmat_morse_converse",
)
ERRORS_FIXED = Template(
    "refused-errors-fixed",
    "no constant K_i, H_ij and no linear time-invariant channel controller move {p:modes} of the "
    "error system for these F_i, {p:escape} {region:region}",
    "evidence.shrunk_subspace_fixed_dynamic",
)
_FIXED_MODES = " control moves {p:modes}, which {sides:sides}, and {p:slow}"
FIXED = Template(
    "refused-fixed",
    "no linear time-invariant decentralized" + _FIXED_MODES,
    "evidence.shrunk_subspace_fixed_dynamic",
)
FIXED_SHARED = Template(
    "refused-fixed-shared",
    "no linear time-invariant distributed"
    + _FIXED_MODES
    + " (shared dimensions {sizes:dimensions})",
    "evidence.shrunk_subspace_fixed_dynamic",
)
OVER_LINKS = Template(
    "refused-over-links",
    "no sharing over the neighbor graph lets linear time-invariant control move {p:modes}, "
    f"{{p:escape}} {{region:region}}: {RECEIVE_TOO_LITTLE}",
    WHATEVER_SHARED,
)
NO_CONNECTION = Template(
    "refused-no-connection",
    "no shared dimensions make the transfer graph of the extended system strongly connected: "
    "{agents:agents} {agents:need} {k:count shared state} of other agents, and can receive from "
    "{senders:names}",
    "transfer_graph.zero_transfer_cut",
)
REFUSED_OUTSIDE = Template(
    "refused-outside", "not every eigenvalue of the loop satisfies {region:region}"
)
NO_EQUILIBRIUM = Template(
    "refused-no-equilibrium",
    "no equilibrium holds set-points r with {w:combinations}",
    "setpoint.setpoint_unreachable",
)
NO_EQUILIBRIUM_ZERO = Template(
    "refused-no-equilibrium-zero",
    "no equilibrium holds set-points r with {w:combinations}: {place:int} is an invariant zero of "
    "the plant",
    "setpoint.setpoint_unreachable",
)
MODE_OF_THE_INTEGRATORS = Template(
    "refused-mode-of-the-integrators",
    "no stable loop has integrators of the outputs: all channels together do not control the "
    "mode {place:int} of the plant",
    "setpoint.setpoint_output_part",
)
INTEGRATORS_UNREACHED = {
    verb: Template(
        f"refused-integrators-{verb}",
        "the plant with its integrators has {p:modes}, which all channels together do not " + verb,
        "controllability.uncontrollable_modes",
    )
    for verb in ("control", "observe")
}
INTEGRATORS_FIXED = Template(
    "refused-integrators-fixed",
    "no linear time-invariant distributed control of the plant with its integrators moves "
    "{p:modes}, however many states are shared",
    "evidence.shrunk_subspace_fixed_dynamic",
)

MODELS_UNREACHED = {
    verb: Template(
        f"refused-models-{verb}",
        "the plant with models of these signals has {p:modes}, which all channels together do "
        "not " + verb,
        "controllability.uncontrollable_modes",
    )
    for verb in ("control", "observe")
}
MODELS_ALONE = Template(
    "refused-models-alone",
    "no linear time-invariant decentralized control of the plant with models of these signals "
    "moves {p:modes}",
    "evidence.shrunk_subspace_fixed_dynamic",
)
MODELS_FIXED = Template(
    "refused-models-fixed",
    "no linear time-invariant distributed control of the plant with models of these signals moves "
    "{p:modes}, however many states are shared",
    "evidence.shrunk_subspace_fixed_dynamic",
)


# Rules of refusals, which read the certificate of the refusal.

REFUSAL_RULES = Rulebook()
refusal_rule = REFUSAL_RULES.rule


def refusal(place: str, answer: Answer, **asked: Any) -> Impossible:
    """Return the error that says why no design exists, with the certificate that proves it.

    Parameters
    ----------
    place : str
        The place of the rules.
    answer : Answer
    **asked
        The request, such as the ``region``; and the `template`, if the certificate does not
        determine it.

    Raises
    ------
    InternalError
        If no rule applies to the certificate.
    """
    rules = Rulebook(rule for rule in REFUSAL_RULES if rule.place == place)
    for sentence in rules.sentences({answer.kind: answer}, Context(answer.about, asked)):
        return Impossible(sentence, answer)
    raise InternalError(f"no reason follows from a certificate of the kind {answer.kind}: {place}")


@refusal_rule(
    "unreached",
    NOT_CONTROLLABLE,
    NOT_CONTROLLABLE_IN,
    *UNREACHED.values(),
    NOT_OBSERVABLE,
    *INTEGRATORS_UNREACHED.values(),
    *MODELS_UNREACHED.values(),
    premises=("controllability",),
)
def _unreached(controllability: Claim, context: Context) -> Said:
    if not controllability.controllable:
        p = controllability.uncontrollable_polynomial
        yield context.template(p=p, region=context.region if context.has("region") else None)


@refusal_rule("not complete", ERRORS_NOT_COMPLETE, premises=("completeness",))
def _not_complete(completeness: Claim, context: Context) -> Said:
    if not completeness.complete:
        yield ERRORS_NOT_COMPLETE()


@refusal_rule("fixed", FIXED, FIXED_SHARED, ERRORS_FIXED, premises=("fixed_spectrum",))
def _fixed(fixed_spectrum: Claim, context: Context) -> Said:
    """The first fixed mode that is outside the region."""
    sizes = []
    if fixed_spectrum.subject and "dimensions" in fixed_spectrum.subject[-1]:
        sizes = list(zip(context.names, fixed_spectrum.subject[-1]["dimensions"], strict=False))
    for factor in fixed_spectrum.factors.separately():
        p = factor.polynomial
        if not context.region.contains_roots_of(p):
            others = [name for name in context.names if name not in factor.channels]
            sides = others, factor.channels
            yield context.template(p=p, sides=sides, sizes=sizes, region=context.region)
            return


@refusal_rule("over links", OVER_LINKS, premises=("fixed_spectrum",))
def _over_links(fixed_spectrum: Claim, context: Context) -> Said:
    """The first mode outside the region that stays however much is shared."""
    for factor in fixed_spectrum.factors.separately():
        inside, outside = sides(factor, context)
        if inside and outside and not context.region.contains_roots_of(factor.polynomial):
            p, region = factor.polynomial, context.region
            yield OVER_LINKS(p=p, region=region, inside=inside, outside=outside)
            return


@refusal_rule("models", MODELS_ALONE, premises=("fixed_spectrum",))
def _models_alone(fixed_spectrum: Claim, context: Context) -> Said:
    """The fixed modes outside of the region, of the plant or of the signals."""
    moved = [factor.polynomial for factor in fixed_spectrum.factors.separately()]
    outside = [p for p in moved if not context.region.contains_roots_of(p)]
    if outside:
        yield MODELS_ALONE(p=product(outside))


@refusal_rule("integrators", INTEGRATORS_FIXED, MODELS_FIXED, premises=("fixed_spectrum",))
def _integrators_fixed(fixed_spectrum: Claim, context: Context) -> Said:
    if fixed_spectrum.polynomial.degree:
        yield context.template(p=fixed_spectrum.polynomial)


@refusal_rule("connection", NO_CONNECTION, premises=("shared_dimensions",))
def _no_connection(shared_dimensions: Claim, context: Context) -> Said:
    """A set of agents that need shared states and receive from no other agent."""
    if shared_dimensions.feasible:
        return
    for cut in shared_dimensions.proof.cuts.separately():
        if not cut.has("polynomial") and not (senders := context.senders(cut.subset)):
            yield NO_CONNECTION(agents=cut.subset, senders=senders, k=1)
            return


@refusal_rule("outside", REFUSED_OUTSIDE, premises=("stability",))
def _outside(stability: Claim, context: Context) -> Said:
    if not stability.stable and about(stability, context.region):
        yield REFUSED_OUTSIDE(region=context.region)


@refusal_rule(
    "equilibrium",
    NO_EQUILIBRIUM,
    NO_EQUILIBRIUM_ZERO,
    MODE_OF_THE_INTEGRATORS,
    premises=("setpoint",),
)
def _no_equilibrium(setpoint: Claim, context: Context) -> Said:
    if not setpoint.solvable:
        zero = setpoint.invariant_zero
        template = NO_EQUILIBRIUM_ZERO if zero else NO_EQUILIBRIUM
        if not context.combinations:
            template = MODE_OF_THE_INTEGRATORS
        yield template(w=context.combinations, place=steady_point(context.time))
