"""The rules of the sentences of `mcexact analyze`: the answer, and the table of all answers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from mcexact.answer.sentence import Claim, Given, Rulebook
from mcexact.answer.template import Sentence, Template
from mcexact.answer.wording import analysis as say
from mcexact.exact.polynomial import product
from mcexact.exact.roots import steady_point

RULES = Rulebook()
rule = RULES.rule

Said = Iterator[Sentence]


def control(spectrum: Claim, given: Given) -> str:
    """The kind of control that moves none of the fixed modes of a certificate."""
    made = [each["construction"] for each in spectrum.subject]
    if made[-1:] != ["augmented_outputs"]:
        return "own"
    return "instant" if given.delays == "delays" else "outputs"


def slowest(spectrum: Claim, given: Given) -> tuple[str, str, str, bool]:
    """The data for sentences about the slowest fixed mode."""
    rate = spectrum.best_rate
    return given.time, rate.lower, rate.upper, spectrum.stabilizable


def empty(spectrum: Claim) -> bool:
    """Whether no mode is fixed."""
    return bool(spectrum.polynomial.degree == 0)


# The answer in words.


@rule("title", say.HEADING)
def _heading(given: Given) -> Said:
    yield say.HEADING(
        name=given.name or "system", n=given.n, m=given.m, names=given.names, time=given.time
    )


@rule(
    "answer",
    say.NOTHING_FIXED,
    say.STABLE,
    say.UNSTABLE,
    about={"linked": "linked_fixed_spectrum"},
)
def _linked(linked: Claim, given: Given) -> Said:
    """What the agents can do over the links that are there, which leads."""
    heard = control(linked, given)
    if empty(linked):
        yield say.NOTHING_FIXED(control=heard)
    else:
        told = say.STABLE if linked.stabilizable else say.UNSTABLE
        yield told(control=heard, slowest=slowest(linked, given))


@rule("answer", say.NOTHING_FIXED)
def _nothing_fixed(fixed_spectrum: Claim, given: Given) -> Said:
    if empty(fixed_spectrum):
        yield say.NOTHING_FIXED(control=control(fixed_spectrum, given))


@rule("answer", say.FREE_THROUGH_ANY)
def _free_through_any(completeness: Claim, given: Given) -> Said:
    if given.n and completeness.complete:
        yield say.FREE_THROUGH_ANY()


@rule("answer", say.FREE, say.PARTS)
def _assigned(
    fixed_spectrum: Claim, assignability: Claim, completeness: Claim, given: Given
) -> Said:
    if given.n and empty(fixed_spectrum) and not completeness.complete:
        parts = [block for block in assignability.blocks if block.dimension]
        yield say.FREE() if len(parts) <= 1 else say.PARTS(k=len(parts))


@rule("answer", say.STABLE, say.UNSTABLE)
def _stabilized(fixed_spectrum: Claim, given: Given) -> Said:
    if not empty(fixed_spectrum):
        told = say.STABLE if fixed_spectrum.stabilizable else say.UNSTABLE
        by = control(fixed_spectrum, given)
        if by == "own" and given.neighbors is not None and given.neighbors.edges():
            by = "alone"
        yield told(control=by, slowest=slowest(fixed_spectrum, given))


def fewest(links: Claim) -> bool:
    """Whether an answer is about the fewest links that leave no mode fixed, for outputs alone."""
    return (
        links.share == "outputs"
        and links.bound is None
        and all(price == 1 for *_, price in links.candidates)
    )


@rule("answer", *say.LINKS.values(), say.LINKS_NONE, say.NO_LINKS)
def _links_remove(minimal_communication: Claim, fixed_spectrum: Claim, given: Given) -> Said:
    links = minimal_communication
    if empty(fixed_spectrum) or not fewest(links):
        return
    if links.added is None:
        yield say.NO_LINKS()
    else:
        some = say.LINKS[given.neighbors is not None] if links.added else say.LINKS_NONE
        yield some(added=links.added, time=given.delays)


def usual(least: Claim, share: str) -> bool:
    """Whether an answer is about the fewest states with which no mode is fixed."""
    return (
        least.share == share
        and least.bound is None
        and not least.free_assignability
        and all(cost == 1 for cost in least.costs)
        and all(most is None for most in least.upper)
    )


@rule("answer", say.SHARING_REMOVES, say.OUTPUTS_REMOVE, say.NO_SHARING)
def _sharing_removes(
    minimal_shared_dimensions_outputs_states: Claim, fixed_spectrum: Claim, given: Given
) -> Said:
    least = minimal_shared_dimensions_outputs_states
    if empty(fixed_spectrum) or not usual(least, "outputs+states"):
        return
    if least.dimensions is None:
        yield say.NO_SHARING()
    elif any(least.dimensions):
        sizes = list(zip(given.names, least.dimensions, strict=True))
        yield say.SHARING_REMOVES(sizes=sizes, time=given.delays)
    else:
        yield say.OUTPUTS_REMOVE(time=given.delays)


@rule("answer.mode", say.BLAME, say.UNCONTROLLED, say.UNOBSERVED)
def _blame(fixed_spectrum: Claim, given: Given) -> Said:
    """The channels that do not control a mode, and those that do not observe it.

    rank P_s < n implies that [λI − A, B_T] and [λI − A; C_s] have rank below n, T the complement of
    s.
    """
    for factor in fixed_spectrum.factors.ordered("stable"):
        inside = factor.channels
        outside = [name for name in given.names if name not in set(inside)]
        told = say.BLAME if inside and outside else say.UNOBSERVED if inside else say.UNCONTROLLED
        yield told(
            p=factor.polynomial,
            often=(factor.multiplicity_in_A, factor.multiplicity_at_most),
            inside=inside,
            outside=outside,
        )


# The table of all answers.


@rule("table", say.INFORMATION)
def _information(given: Given) -> Said:
    if given.information == "outputs":
        yield say.INFORMATION(information="outputs" if given.delays == "none" else "instant")


def reached(found: Claim, yes: Template, no: Template) -> Said:
    """Whether channels together control or observe every mode."""
    yield yes() if found.controllable else no(p=found.uncontrollable_polynomial)


@rule("table", say.CONTROLLABLE, say.UNCONTROLLABLE)
def _controllable(joint_controllability: Claim) -> Said:
    yield from reached(joint_controllability, say.CONTROLLABLE, say.UNCONTROLLABLE)


@rule("table", say.OBSERVABLE, say.UNOBSERVABLE)
def _observable(joint_observability: Claim) -> Said:
    yield from reached(joint_observability, say.OBSERVABLE, say.UNOBSERVABLE)


@rule("table", say.GRAPH_CONNECTED, say.GRAPH_PARTS)
def _graph(transfer_graph: Claim) -> Said:
    told = say.GRAPH_CONNECTED if transfer_graph.strongly_connected else say.GRAPH_PARTS
    yield told(arcs=transfer_graph.arcs, components=transfer_graph.components)


@rule("table", say.INACTIVE)
def _inactive(transfer_graph: Claim, given: Given) -> Said:
    if given.inactive and transfer_graph.subject == given.system.subject:
        yield say.INACTIVE(names=given.inactive)


@rule("table", say.FIXED_NONE, say.FIXED)
def _fixed(fixed_spectrum: Claim) -> Said:
    p = fixed_spectrum.polynomial
    yield say.FIXED(p=p) if p.degree else say.FIXED_NONE()


@rule("table", say.STABILIZABLE, say.NOT_STABILIZABLE)
def _stabilizable(fixed_spectrum: Claim, given: Given) -> Said:
    told = say.STABILIZABLE if fixed_spectrum.stabilizable else say.NOT_STABILIZABLE
    yield told(control=control(fixed_spectrum, given))


@rule("table", say.SLOWEST, say.ANY_RATE)
def _slowest_mode(fixed_spectrum: Claim, given: Given) -> Said:
    if empty(fixed_spectrum):
        yield say.ANY_RATE()
    else:
        yield say.SLOWEST(slowest=slowest(fixed_spectrum, given))


@rule("table", say.COMPLETE)
def _complete(completeness: Claim) -> Said:
    yield say.COMPLETE(complete=completeness.complete)


def _index_rules(question: str, one: Template, many: Template, none: Template) -> None:
    """Make the rules of controllability or observability indices, or of their omission."""

    @rule("table", one, many, about={"found": question})
    def _indices(found: Claim) -> Said:
        told = many if found.index is None else one
        yield told(indices=found.indices, index=found.index)

    @rule("table", none, missing=question)
    def _left_out() -> Said:
        yield none()


_index_rules("controllability_indices", *say.CONTROLLABILITY_INDICES)
_index_rules("observability_indices", *say.OBSERVABILITY_INDICES)


@rule("table", say.SPECTRUM_FREE, say.SPECTRUM_PARTS)
def _spectrum_parts(fixed_spectrum: Claim, assignability: Claim) -> Said:
    if empty(fixed_spectrum):
        blocks = [(block.dimension, block.channels) for block in assignability.blocks]
        free = sum(size > 0 for size, _ in blocks) <= 1
        yield say.SPECTRUM_FREE() if free else say.SPECTRUM_PARTS(blocks=blocks)


def _most(factor: Claim) -> int | None:
    """How often the roots of a factor may be fixed, as far as its exponents prove it."""
    in_A: int | None = factor.multiplicity_in_A
    if factor.polynomial.degree > 1:
        return in_A
    at_most: int = factor.multiplicity_at_most
    return at_most if in_A is None else min(in_A, at_most)


@rule("table", say.SPECTRUM_MOVED, say.SPECTRUM_MOVED_BETWEEN)
def _spectrum_moved(fixed_spectrum: Claim, assignability: Claim, given: Given) -> Said:
    """Bounds on the number of eigenvalues, with multiplicity, that gains can move.

    n − deg φ, φ the greatest common divisor of all det(xI − A_F): a factor p of the fixed
    polynomial is in φ at least once and at most as often as in det(xI − A), and if it is x − λ at
    most as often as in the loop of the certificate.  That loop says less of a longer p, which a
    certificate does not prove irreducible.  The eigenvalues that belong to no strong component of
    the transfer graph are roots of φ.
    """
    if empty(fixed_spectrum):
        return
    counted = [(f.polynomial.degree, _most(f)) for f in fixed_spectrum.factors]
    if any(most is None for _, most in counted):
        return
    stuck = sum(degree * most for degree, most in counted if most is not None)
    stays = max(fixed_spectrum.polynomial.degree, assignability.fixed_degree)
    told = say.SPECTRUM_MOVED if stuck == stays else say.SPECTRUM_MOVED_BETWEEN
    yield told(k=given.n - stuck, most=given.n - stays, n=given.n)


# Set-points.


@rule("table", say.SETPOINT_ZERO, say.SETPOINT_DEPENDENT)
def _no_setpoints(setpoint: Claim, given: Given) -> Said:
    if setpoint.invariant_zero:
        yield say.SETPOINT_ZERO(place=steady_point(given.time))
    elif not setpoint.solvable:
        yield say.SETPOINT_DEPENDENT()


@rule("table", say.SETPOINT)
def _setpoints(setpoint: Claim, joint_controllability: Claim, joint_observability: Claim) -> Said:
    if (
        setpoint.solvable
        and joint_controllability.controllable
        and joint_observability.controllable
    ):
        yield say.SETPOINT()


@rule("table", say.SETPOINT_STABLE_REST, say.SETPOINT_UNSTABLE_REST)
def _setpoints_beside(
    setpoint: Claim, joint_controllability: Claim, joint_observability: Claim, fixed_spectrum: Claim
) -> Said:
    """Modes that are not controllable or not observable are fixed, perhaps stable."""
    reach = (joint_controllability, joint_observability)
    if not setpoint.solvable or all(found.controllable for found in reach):
        return
    lost = product([found.uncontrollable_polynomial for found in reach])
    unstable = product(
        [
            factor.polynomial
            for factor in fixed_spectrum.factors
            if not factor.stable and factor.polynomial.divides(lost)
        ]
    )
    told = say.SETPOINT_UNSTABLE_REST if unstable.degree else say.SETPOINT_STABLE_REST
    yield told(p=unstable)


@rule("table", *say.GAINS["every"].values())
def _every_channel(every_channel: Claim, given: Given) -> Said:
    yield gains("every", every_channel, given.names)


def gains(want: str, found: Claim, names: Sequence[str]) -> Sentence:
    """The indices for gains that exist, or the obstruction."""
    told = say.GAINS[want]
    if found.exists:
        return told["reached"](reached=found.indices)
    why = found.proof
    if why.has("polynomial"):
        return told["stuck"](name=why.channel, side=why.side, p=why.polynomial)
    inside = set(getattr(why.zero, "from"))
    return told[why.side](name=why.channel, rest=[name for name in names if name not in inside])
