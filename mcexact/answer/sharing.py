"""Shared dimensions and links: answers and sentences.

The answers are the `Deficiency`, which is the bound of Theorem 2 on what agents must share; the
least dimensions of each agent (`SharedDimensions`) or one for all (`CommonDimension`); the cheapest
links to add (`MinimalCommunication`); and whether the neighbor graph is strongly connected.

Each kind of answer comes first, then the sentences: those in the table of `mcexact analyze`, and
those of `mcexact allocate` about dimensions and about links.  Templates precede the rules that fill
them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.answer import analysis as say
from mcexact.answer.analysis import Said, asked_usually, empty, fewest
from mcexact.answer.evidence import (
    Absence,
    Block,
    BlocksAbsence,
    ConnectivityCut,
    DeficiencyCut,
    LinkCut,
    Subspace,
    Tree,
)
from mcexact.answer.protocol import Answer, Part, answer, claim, shown, witness
from mcexact.answer.sentence import Claim, Context, Rulebook
from mcexact.answer.templates import Sentence, Template
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial

# Answer: the largest rank deficiency of P_s(λ) over all subsets s and all λ.


@dataclass(frozen=True)
class ByCompletion(Part):
    """Evidence by a loop completed with ρ columns and rows, which moves every mode.

    Attributes
    ----------
    modulus : int
        ℓ ≥ 2, modulo which the characteristic polynomials of A and A_F + B_0 C_0 are coprime.
    gains : tuple of Matrix
        F_i, p_i × q_i, one for each channel.
    B0, C0 : Matrix
        n × ρ and ρ × n.
    polynomial : Polynomial or None
        p, monic of degree at least 1, at whose roots the deficiency is ρ; None iff ρ = 0.
    subspace : Subspace or None
        Of deficiency ρ for p; None iff ρ = 0.
    """

    modulus: int
    gains: tuple[Matrix, ...]
    B0: Matrix
    C0: Matrix
    polynomial: Polynomial | None
    subspace: Subspace | None

    @property
    def worst(self) -> tuple[Polynomial, Subspace] | None:
        """A factor of the largest deficiency, with its subspace."""
        if self.polynomial is None or self.subspace is None:
            return None
        return self.polynomial, self.subspace


@dataclass(frozen=True)
class RankLoss(Part):
    """A fixed factor, with the rank that pencils lose at its roots.

    Attributes
    ----------
    polynomial : Polynomial
    deficiency : int
    subspace : Subspace
        Of this deficiency.
    """

    polynomial: Polynomial
    deficiency: int
    subspace: Subspace


@dataclass(frozen=True)
class ByBlocks(Part):
    """Evidence by blocks of states: only the factors are fixed, at most as often as they lose rank.

    Attributes
    ----------
    blocks : tuple of Block
    modulus : int or None
        As in the evidence of a fixed spectrum by blocks.
    losses : tuple of RankLoss
        All factors; ρ is the largest of their deficiencies.
    """

    blocks: tuple[Block, ...]
    modulus: int | None
    losses: tuple[RankLoss, ...]

    @property
    def worst(self) -> tuple[Polynomial, Subspace] | None:
        """A factor of the largest deficiency, with its subspace."""
        largest = max(self.losses, key=lambda loss: loss.deficiency, default=None)
        return None if largest is None else (largest.polynomial, largest.subspace)


@answer("deficiency")
class Deficiency(Answer):
    """The largest n − rank P_s(λ) is ρ; on (A, B_i, C_{N_i}) it is the bound of Theorem 2.

    Attributes
    ----------
    deficiency : int
        ρ ≥ 0, which is 0 iff no mode is fixed.  If the neighbor graph is strongly connected and the
        plant is jointly controllable and observable, the extended system with n_i ≥ ρ for every
        agent has no fixed mode.
    evidence : ByCompletion or ByBlocks
        The second for large systems, if the bound by blocks does not exceed the degrees of the
        factors.
    """

    deficiency: int = claim()
    evidence: ByCompletion | ByBlocks = witness(whole=True)

    @property
    def polynomial(self) -> Polynomial | None:
        """A polynomial at whose roots the deficiency is ρ; None if ρ = 0."""
        worst = self.evidence.worst
        return None if worst is None else worst[0]

    @property
    def channels(self) -> tuple[str, ...] | None:
        """The largest set s of channels with deficiency ρ; None if ρ = 0."""
        worst = self.evidence.worst
        if worst is None:
            return None
        return tuple(name for name in self.about.names if name not in worst[1].channels_T)

    @property
    def total(self) -> int:
        """m ρ."""
        return self.about.m * self.deficiency


# Answer: the least dimensions that agents must share, or that no dimensions suffice.


@answer("shared_dimensions")
class SharedDimensions(Answer):
    """The least dimensions with which the extended system has no fixed mode, if any exist.

    With ``at_least`` they are dimensions that suffice, and not proved to be the least.

    Attributes
    ----------
    share : str
        ``"outputs+states"`` or ``"states"``.
    bound : Fraction or None
        A rate or radius: only modes that violate it are considered.  None means all modes.
    free_assignability : bool
        Whether the extended transfer graph must also be strongly connected.
    costs : tuple of Fraction
        The positive cost of one dimension of each agent.
    upper : tuple of (int or None)
        Upper limits of the n_i.
    feasible : bool
        Whether some dimensions within the upper limits suffice.
    dimensions : tuple of int, or None
        The optimal n_i; None if no dimensions suffice.
    cost : Fraction or None
        Σ c_i n_i.
    at_least : Fraction or None
        A smaller cost, below which no dimensions suffice, where the search reached its node limit;
        None if no dimensions below ``cost`` suffice.
    absence : BlocksAbsence, Absence or None
    cuts : tuple of DeficiencyCut and ConnectivityCut
    tree : Tree
    """

    share: str = claim()
    bound: Fraction | None = claim()
    free_assignability: bool = claim()
    costs: tuple[Fraction, ...] = claim()
    upper: tuple[int | None, ...] = claim()
    feasible: bool = claim()
    dimensions: tuple[int, ...] | None = claim()
    cost: Fraction | None = claim()
    at_least: Fraction | None = claim(optional=True)
    absence: BlocksAbsence | Absence | None = witness()
    cuts: tuple[DeficiencyCut | ConnectivityCut, ...] = witness()
    tree: Tree = witness()

    @property
    @shown()
    def total(self) -> int | None:
        """Σ n_i."""
        return None if self.dimensions is None else sum(self.dimensions)

    @property
    def multiplicities(self) -> tuple[Fraction, ...] | None:
        """The multipliers of nested sets; None if a branch tree proves the cost."""
        nested = self.tree[0].get("nested") if self.tree else None
        return None if nested is None else tuple(Fraction(y) for _, y in nested)


# Answer: the least common dimension of shared sub-states that suffices, or that none does.


@answer("common_dimension")
class CommonDimension(Answer):
    """With n_i = k' for all i the extended system has no fixed mode iff k' ≥ k.

    Attributes
    ----------
    share : str
        ``"outputs+states"`` or ``"states"``.
    feasible : bool
        Whether some common dimension suffices.
    dimension : int or None
        k; None if no dimension suffices.
    absence : BlocksAbsence, Absence or None
        The evidence that k suffices.
    cut : DeficiencyCut or None
        A set s for which k − 1 does not suffice, or with an empty boundary N_s∖s; None if k = 0.
    """

    share: str = claim("what is shared")
    feasible: bool = claim("some common dimension suffices")
    dimension: int | None = claim("least common dimension")
    absence: BlocksAbsence | Absence | None = witness()
    cut: DeficiencyCut | None = witness()


def _templates(key: str, theorem: str, some: str, none: str, never: str) -> tuple[Template, ...]:
    """The sentences on the least common dimension for one way of sharing."""
    label, proved = "least if all share equally", f"common_dimension_{theorem}"
    least = some + "{k:count state} by each agent: {total:int} in all{time:instant}"
    never += "no number of states suffices"
    return (
        Template(f"common-dimension-{key}", least, f"shared_dimensions.{proved}", label),
        Template(f"common-dimension-{key}-none", none + "{time:instant}", label=label),
        Template(
            f"common-dimension-{key}-impossible", never, f"shared_dimensions.no_{proved}", label
        ),
    )


WORDS = {
    "outputs+states": _templates(
        "outputs-states", "outputs", "outputs, and ", "outputs alone", "in addition to outputs, "
    ),
    "states": _templates(
        "states", "states", "without outputs, ", "without outputs, nothing", "without outputs, "
    ),
}
COMMON_DIMENSION_RULES = Rulebook()


def _rule(share: str) -> None:
    """Make the rule of the least common dimension for one way of sharing."""
    some, none, impossible = WORDS[share]
    question = f"common_dimension_{share.replace('+', '_')}"

    @COMMON_DIMENSION_RULES.rule("table", some, none, impossible, premises=(question,))
    def least(claim: Claim, context: Context) -> Iterator[Sentence]:
        k = claim.dimension
        if claim.share == share:
            template = impossible if k is None else some if k else none
            yield template(k=k, total=k and k * context.m, time=context.delays)


for way in WORDS:
    _rule(way)


# Answer: the cheapest communication links to add, or that no candidates suffice.


@answer("communication")
class MinimalCommunication(Answer):
    """The cheapest links with which no mode is fixed, or the fact that no candidates suffice.

    Attributes
    ----------
    share : str
        The signals that a link carries: ``"outputs"``, ``"outputs+states"`` or ``"states"``.
    dimensions : tuple of int, or None
        The n_i of the extended system; None if only outputs are shared.
    bound : Fraction or None
        A rate or radius: only modes that violate it are considered.  None means all modes.
    candidates : tuple of (str, str, Fraction)
        The links (from, to) that may be added, with their positive costs.
    feasible : bool
        Whether all candidates together suffice.
    added : tuple of (str, str), or None
        The links (from, to) to add; None if no candidates suffice.
    cost : Fraction or None
    absence : BlocksAbsence, Absence or None
    cuts : tuple of LinkCut
    tree : Tree
    """

    share: str = claim()
    dimensions: tuple[int, ...] | None = claim()
    bound: Fraction | None = claim()
    candidates: tuple[tuple[str, str, Fraction], ...] = claim()
    feasible: bool = claim()
    added: tuple[tuple[str, str], ...] | None = claim()
    cost: Fraction | None = claim()
    absence: BlocksAbsence | Absence | None = witness()
    cuts: tuple[LinkCut, ...] = witness()
    tree: Tree = witness()


# Answer: whether the neighbor graph of the system is strongly connected.


@answer("neighbor_graph")
class NeighborGraphVerdict(Answer):
    """The neighbor graph is strongly connected, or not; no witness is needed.

    Attributes
    ----------
    strongly_connected : bool
    """

    strongly_connected: bool = claim()


# Rules of the table of `mcexact analyze`: links, shared states and delays.

SHARING_RULES = Rulebook()
sharing_rule = SHARING_RULES.rule


@sharing_rule(
    "table",
    *[template for key, template in say.TABLE_LINKS.items() if key != "limit"],
    premises=("minimal_communication",),
)
def _links_in_the_table(minimal_communication: Claim, context: Context) -> Said:
    links = minimal_communication
    if fewest(links):
        which = "impossible" if links.added is None else "some" if links.added else "none"
        yield say.TABLE_LINKS[which](added=links.added, time=context.delays)


@sharing_rule("table", say.TABLE_LINKS["limit"], missing="minimal_communication")
def _links_open(context: Context) -> Said:
    yield say.TABLE_LINKS["limit"]()


@sharing_rule("table", say.CONNECTED, say.NOT_CONNECTED, premises=("neighbor_graph",))
def _connected(neighbor_graph: Claim, context: Context) -> Said:
    yield say.CONNECTED() if neighbor_graph.strongly_connected else say.NOT_CONNECTED()


@sharing_rule(
    "table",
    say.SOURCES,
    premises=("shared_fixed_spectrum", "joint_controllability", "joint_observability"),
)
def _sources(
    shared_fixed_spectrum: Claim,
    joint_controllability: Claim,
    joint_observability: Claim,
    context: Context,
) -> Said:
    """The source components, where some agents receive too little."""
    reach = (joint_controllability, joint_observability)
    if any(say.receive_too_little(shared_fixed_spectrum, reach, context)):
        yield say.SOURCES(parts=context.sources)


@sharing_rule("table", say.NEVER_CONTROLLED, premises=("joint_controllability",))
def _never_controlled(joint_controllability: Claim, context: Context) -> Said:
    if context.neighbors is not None and not joint_controllability.controllable:
        yield say.NEVER_CONTROLLED(p=joint_controllability.uncontrollable_polynomial)


@sharing_rule("table", say.NEVER_OBSERVED, premises=("joint_observability",))
def _never_observed(joint_observability: Claim, context: Context) -> Said:
    if context.neighbors is not None and not joint_observability.controllable:
        yield say.NEVER_OBSERVED(p=joint_observability.uncontrollable_polynomial)


@sharing_rule(
    "table",
    say.NO_BOUND,
    premises=("neighbor_graph", "joint_controllability", "joint_observability"),
)
def _no_bound(
    neighbor_graph: Claim,
    joint_controllability: Claim,
    joint_observability: Claim,
    context: Context,
) -> Said:
    reach = (joint_controllability, joint_observability)
    if not neighbor_graph.strongly_connected and all(claim.controllable for claim in reach):
        yield say.NO_BOUND()


def theorem_2(graph: Claim, *reach: Claim) -> bool:
    """Whether the hypotheses of Theorem 2 and Remark 2 hold."""
    return bool(graph.strongly_connected and all(claim.controllable for claim in reach))


def _sharing_rules(share: str, stem: str) -> None:
    """Make the rules of the bound and of the least dimensions for one way of sharing."""
    some, none = say.ENOUGH[share]

    @sharing_rule(
        "table",
        some,
        none,
        premises=(
            f"shared_dimension_bound_{stem}",
            "neighbor_graph",
            "joint_controllability",
            "joint_observability",
        ),
    )
    def _enough(
        bound: Claim,
        neighbor_graph: Claim,
        joint_controllability: Claim,
        joint_observability: Claim,
        context: Context,
    ) -> Said:
        if theorem_2(neighbor_graph, joint_controllability, joint_observability):
            k = bound.deficiency
            yield (some if k else none)(k=k, total=k * context.m, time=context.delays)


def _least_rules(share: str, stem: str) -> None:
    """Make the rules of the least dimensions for one way of sharing."""
    some, none, impossible, limit, between = say.LEAST[share]
    question = f"minimal_shared_dimensions_{stem}"

    @sharing_rule("table", some, none, impossible, between, premises=(question,))
    def _least_of(least: Claim, context: Context) -> Said:
        if not asked_usually(least, share):
            return
        if least.dimensions is None:
            yield impossible()
            return
        sizes, time = list(zip(context.names, least.dimensions, strict=True)), context.delays
        if least.has("at_least"):
            yield between(sizes=sizes, lower=least.at_least, time=time)
        else:
            yield (some if any(least.dimensions) else none)(sizes=sizes, time=time)

    @sharing_rule("table", limit, missing=question)
    def _least_open(context: Context) -> Said:
        yield limit()


SHARES = {"outputs+states": "outputs_states", "states": "states"}
for make_rules in (_sharing_rules, _least_rules):
    for share, stem in SHARES.items():
        make_rules(share, stem)


def _delayed_rules(network: str) -> None:
    """Make the rules of the fixed modes of a network with delays."""
    nothing, something = say.DELAYED[network]

    @sharing_rule("table", nothing, something, premises=(f"{network}_fixed_spectrum",))
    def _delayed(spectrum: Claim, context: Context) -> Said:
        [step] = spectrum.subject
        template = nothing if empty(spectrum) else something
        yield template(p=spectrum.polynomial, k=step["dimensions"][0])


for network in ("lifted", "held"):
    _delayed_rules(network)


# Templates of `mcexact allocate` about dimensions.

LEAST = Template(
    "allocate-least",
    "{name:name}: {price:price} shared states {share:share} so that {scope:scope}"
    "{limits:limits}{time:instant}",
)
WITHIN = Template(
    "allocate-within",
    "{name:name}: shared states {share:share} so that {scope:scope}{limits:limits}{time:instant}: "
    "{sizes:shared} suffice, at a cost of {cost:number}, and nothing below {lower:number} does",
)
IMPOSSIBLE = Template(
    "allocate-impossible",
    "{name:name}: no shared states {share:share} suffice so that {scope:scope}{limits:limits}",
)
ROW = Template("allocate-row", "{agent:name} | {size:int}")
TOTAL = Template("allocate-total", "total | {size:int}")
_THEOREM_2 = "extended_bound.theorem_2, extended_bound.remark_2"
ROW_BOUND = Template("allocate-row-bound", "{agent:name} | {size:int} | {bound:int}", _THEOREM_2)
TOTAL_BOUND = Template("allocate-total-bound", "total | {size:int} | {bound:int}", _THEOREM_2)
PROOF = Template(
    "allocate-proof", "proved with {cuts:count subset} and a branch tree of {nodes:count node}"
)
COST_PROOF = Template(
    "allocate-cost-proof",
    "least cost {cost:number}; proved with {cuts:count subset} and a branch tree of "
    "{nodes:count node}",
)
WITHIN_PROOF = Template(
    "allocate-within-proof",
    "the lower bound is proved with {cuts:count subset}; what lies between is not decided",
)
NESTED_PROOF = Template(
    "allocate-nested-proof",
    "proved by {cuts:count nested subset} with pairwise disjoint boundaries",
)
NESTED_COST_PROOF = Template(
    "allocate-nested-cost-proof",
    "least cost {cost:number}; proved by {cuts:count nested subset}, with multiplicities whose sum "
    "around an agent is at most its price",
)
REASON = Template(
    "allocate-reason", "{subset:names} | {senders:names} | {deficiency:int} | {p:modes}"
)
REASON_UNREACHED = {
    verb: Template(
        f"allocate-reason-do-not-{verb}",
        "all together | nobody | {deficiency:int} | {p:modes}, which they do not " + verb,
    )
    for verb in ("control", "observe")
}
REASON_CUT_OFF = Template(
    "allocate-reason-cut-off",
    "{subset:names} | {senders:names} | {deficiency:int} | the others do not act on them",
)


# Rules of `mcexact allocate` about dimensions.

ALLOCATION_RULES = Rulebook()
allocation_rule = ALLOCATION_RULES.rule


@allocation_rule("title", LEAST, WITHIN, IMPOSSIBLE, premises=("minimal_shared_dimensions",))
def _least(minimal_shared_dimensions: Claim, context: Context) -> Said:
    least = minimal_shared_dimensions
    template = IMPOSSIBLE if least.dimensions is None else LEAST
    within: dict[str, Any] = {}
    if least.has("at_least"):
        sizes = list(zip(context.names, least.dimensions, strict=True))
        template, within = WITHIN, {"sizes": sizes, "cost": least.cost, "lower": least.at_least}
    yield template(
        **within,
        name=context.name or "system",
        share=least.share,
        scope=(context.time, least.bound, least.free_assignability),
        price="least" if all(cost == 1 for cost in least.costs) else "cheapest",
        limits="none" if all(most is None for most in least.upper) else "upper",
        time=context.delays,
    )


@allocation_rule(
    "table",
    ROW,
    TOTAL,
    ROW_BOUND,
    TOTAL_BOUND,
    premises=(
        "minimal_shared_dimensions",
        "shared_dimension_bound",
        "neighbor_graph",
        "joint_controllability",
        "joint_observability",
    ),
)
def _rows(
    minimal_shared_dimensions: Claim,
    shared_dimension_bound: Claim,
    neighbor_graph: Claim,
    joint_controllability: Claim,
    joint_observability: Claim,
    context: Context,
) -> Said:
    """The least dimensions, with the bound of the theorem if its hypotheses hold.

    Theorem 2 says that no mode is fixed, but not that the whole spectrum is assignable.
    """
    least, reach = minimal_shared_dimensions, (joint_controllability, joint_observability)
    if least.dimensions is None or least.has("at_least"):
        return
    row, total, k = ROW, TOTAL, 0
    outputs = least.share == "outputs+states"
    fits = [each["construction"] for each in shared_dimension_bound.subject]
    if (
        fits == ["augmented_outputs"] * outputs
        and not least.free_assignability
        and theorem_2(neighbor_graph, *reach)
    ):
        row, total, k = ROW_BOUND, TOTAL_BOUND, shared_dimension_bound.deficiency
    for agent, size in zip(context.names, least.dimensions, strict=True):
        yield row(agent=agent, size=size, bound=k)
    yield total(size=sum(least.dimensions), bound=k * context.m)


@allocation_rule(
    "table.note",
    PROOF,
    COST_PROOF,
    NESTED_PROOF,
    NESTED_COST_PROOF,
    WITHIN_PROOF,
    premises=("minimal_shared_dimensions",),
)
def _proof(minimal_shared_dimensions: Claim, context: Context) -> Said:
    least = minimal_shared_dimensions
    if least.dimensions is not None:
        equal, weights = all(cost == 1 for cost in least.costs), context.multiplicities
        if least.has("at_least"):
            template = WITHIN_PROOF
        elif weights is None:
            template = PROOF if equal else COST_PROOF
        else:
            disjoint = equal and all(y == 1 for y in weights)
            template = NESTED_PROOF if disjoint else NESTED_COST_PROOF
        yield template(cost=least.cost, cuts=context.cuts, nodes=context.nodes)


@allocation_rule(
    "why",
    REASON,
    REASON_CUT_OFF,
    *REASON_UNREACHED.values(),
    premises=("minimal_shared_dimensions",),
)
def _reasons(minimal_shared_dimensions: Claim, context: Context) -> Said:
    """The active cuts, which the dimensions meet with equality; if no dimensions suffice, all cuts.

    The cuts of the empty set and of all agents do not depend on sharing.
    """
    least = minimal_shared_dimensions
    sizes = None
    if least.dimensions is not None:
        sizes = dict(zip(context.names, least.dimensions, strict=True))
    for cut in least.proof.cuts.separately():
        subset, senders = cut.subset, context.senders(cut.subset)
        demand = cut.deficiency if cut.has("deficiency") else 1
        if sizes is not None and sum(sizes[name] for name in senders) > demand:
            continue
        template, p = REASON_CUT_OFF, None
        if cut.has("polynomial"):
            template, p = REASON, cut.polynomial
            if len(subset) in {0, context.m}:
                template = REASON_UNREACHED["observe" if subset else "control"]
        yield template(subset=subset, senders=senders, deficiency=demand, p=p)


# Templates of `mcexact allocate --links`.

LINKS_LEAST = Template(
    "allocate-links",
    "{name:name}: {price:links} to add so that {scope:scope}, sending {what:carried}{time:instant}",
)
NONE_NEEDED = Template(
    "allocate-no-links-needed",
    "{name:name}: no links to add so that {scope:scope}, sending {what:carried}{time:instant}",
)
LINKS_IMPOSSIBLE = Template(
    "allocate-no-links",
    "{name:name}: no links that may be added suffice so that {scope:scope}, sending {what:carried}",
)
LINKS_ROW = Template("allocate-link", "{start:name} | {end:name} | {cost:number}")
LINKS_TOTAL = Template("allocate-links-total", "total | – | {cost:number}")
LINKS_PROOF = Template(
    "allocate-links-proof",
    "proved with {cuts:count obstruction} and a branch tree of {nodes:count node}",
)


# Rules of `mcexact allocate --links`.

LINK_RULES = Rulebook()
link_rule = LINK_RULES.rule


@link_rule("title", LINKS_LEAST, LINKS_IMPOSSIBLE, NONE_NEEDED, premises=("minimal_communication",))
def _links(minimal_communication: Claim, context: Context) -> Said:
    links = minimal_communication
    template = LINKS_LEAST if links.added else NONE_NEEDED
    yield (LINKS_IMPOSSIBLE if links.added is None else template)(
        name=context.name or "system",
        scope=(context.time, links.bound, False),
        what=(links.share, links.dimensions),
        price="least" if all(price == 1 for *_, price in links.candidates) else "cheapest",
        time=context.delays,
    )


@link_rule("table", LINKS_ROW, LINKS_TOTAL, premises=("minimal_communication",))
def _added(minimal_communication: Claim, context: Context) -> Said:
    links = minimal_communication
    if links.added:
        prices = {(j, i): price for j, i, price in links.candidates}
        for j, i in links.added:
            yield LINKS_ROW(start=j, end=i, cost=prices[j, i])
        yield LINKS_TOTAL(cost=links.cost)


@link_rule("table.note", LINKS_PROOF, premises=("minimal_communication",))
def _proof_of_links(minimal_communication: Claim, context: Context) -> Said:
    """The proof of what the certificate claims, feasible or not."""
    _ = minimal_communication.feasible
    yield LINKS_PROOF(cuts=context.cuts, nodes=context.nodes)
