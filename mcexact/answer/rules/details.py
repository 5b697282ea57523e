"""The rules of the sentences of `mcexact analyze` about single modes, channels and pictures."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from mcexact.answer.rules.analysis import Said, control, empty, gains, reached
from mcexact.answer.sentence import Claim, Given, Rulebook
from mcexact.answer.wording import details as say
from mcexact.answer.wording.analysis import GAINS
from mcexact.exact.roots import exact_decimal

RULES = Rulebook()
rule = RULES.rule

# The table of fixed modes.


@rule("fixed-modes.title", say.FIXED_MODES)
def _fixed_modes(fixed_spectrum: Claim, given: Given) -> Said:
    if not empty(fixed_spectrum):
        yield say.FIXED_MODES(control=control(fixed_spectrum, given))


@rule("fixed-modes", say.FIXED_MODE)
def _fixed_mode(fixed_spectrum: Claim) -> Said:
    for factor in fixed_spectrum.factors.ordered("stable"):
        yield say.FIXED_MODE(
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


@rule("fixed-modes.note", say.FIXED_MODES_NOTE)
def _columns(fixed_spectrum: Claim, given: Given) -> Said:
    if not empty(fixed_spectrum):
        yield say.FIXED_MODES_NOTE(n=given.n)


# A set of channels.


@rule("pencil.title", say.PENCIL)
def _pencil(spectrum_of_A: Claim, pencil_rank: Iterable[Claim]) -> Said:
    subsets = [found.subset for found in pencil_rank if found.polynomial.degree]
    if subsets and spectrum_of_A.polynomial.degree:
        yield say.PENCIL(s=subsets[0])


@rule("pencil", say.PENCIL_ROW)
def _ranks(pencil_rank: Iterable[Claim], given: Given) -> Said:
    for found in pencil_rank:
        rank = found.rank
        yield say.PENCIL_ROW(p=found.polynomial, rank=rank, below=rank < given.n)


@rule("subsystem.title", say.SUBSYSTEM)
def _subsystem(complementary_subsystem: Claim) -> Said:
    yield say.SUBSYSTEM(s=complementary_subsystem.subset)


@rule("subsystem", say.NORMAL_RANK)
def _normal_rank(complementary_subsystem: Claim) -> Said:
    yield say.NORMAL_RANK(rank=complementary_subsystem.normal_rank)


@rule("subsystem", say.ZEROS, say.NO_ZEROS)
def _zeros(complementary_subsystem: Claim) -> Said:
    """The largest invariant polynomial has all invariant zeros: each of the others divides it."""
    polynomials = complementary_subsystem.invariant_polynomials
    if polynomials:
        yield say.ZEROS(zeros=[p for p, _ in polynomials[-1].factor()])
    else:
        yield say.NO_ZEROS()


@rule("subsystem", say.REMNANT)
def _remnant(complementary_subsystem: Claim) -> Said:
    yield say.REMNANT(p=complementary_subsystem.remnant)


@rule(
    "subsystem",
    *(say.SUBSYSTEM_COMPLETE, say.SUBSYSTEM_ZERO, say.SUBSYSTEM_DROPS, say.SUBSYSTEM_BOTH),
)
def _subsystem_complete(complementary_subsystem: Claim) -> Said:
    """The roots of the remnant polynomial are the points where the rank is below n."""
    found = complementary_subsystem
    drops = [p for p, _ in found.remnant.factor()]
    if found.complete:
        yield say.SUBSYSTEM_COMPLETE()
    elif not drops:
        yield say.SUBSYSTEM_ZERO()
    else:
        yield (say.SUBSYSTEM_BOTH if found.transfer_zero else say.SUBSYSTEM_DROPS)(zeros=drops)


# A channel.


@rule("channel.title", say.CHANNEL)
def _channel(channel_controllability: Claim) -> Said:
    [name] = channel_controllability.channels
    yield say.CHANNEL(name=name)


@rule("channel", *say.ALONE["controllability"])
def _controlled_alone(channel_controllability: Claim) -> Said:
    yield from reached(channel_controllability, *say.ALONE["controllability"])


@rule("channel", *say.ALONE["observability"])
def _observed_alone(channel_observability: Claim) -> Said:
    yield from reached(channel_observability, *say.ALONE["observability"])


def _gains_rules(want: str) -> None:
    """Make the rule of gains with which one channel controls or observes everything."""

    @rule("channel", *GAINS[want].values(), about={"found": f"channel_gains_{want}"})
    def _with_gains(found: Claim, given: Given) -> Said:
        yield gains(want, found, given.names)


for want in ("controllable", "observable", "both"):
    _gains_rules(want)


# The page, its pictures, and LaTeX.


@rule("page", say.PAGE_HEADING)
def _page_heading(given: Given) -> Said:
    heard = "outputs" if given.delays == "none" else "instant"
    information = heard if given.information == "outputs" else "own"
    yield say.PAGE_HEADING(n=given.n, m=given.m, time=given.time, information=information)


@rule("graphs.title", say.PICTURE, say.PICTURE_OUTPUTS)
def _picture(given: Given) -> Said:
    yield say.PICTURE_OUTPUTS() if given.information == "outputs" else say.PICTURE()


@rule("graphs", say.PICTURE_NEIGHBORS)
def _neighbor_edges(given: Given) -> Said:
    if given.neighbors is not None:
        names = given.names
        edges = [(names[j], names[i]) for j, i in given.neighbors.edges()]
        yield say.PICTURE_NEIGHBORS(arcs=edges)


@rule("graphs", say.PICTURE_TRANSFER)
def _transfer_edges(transfer_graph: Claim) -> Said:
    yield say.PICTURE_TRANSFER(arcs=[edge for edge in transfer_graph.arcs if edge[0] != edge[1]])


@rule("graphs", say.PICTURE_OBSTRUCTION, say.PICTURE_HEARD)
def _obstruction(fixed_spectrum: Claim, given: Given) -> Said:
    """The picture marks the set of the first mode, and the outside agents that send to it."""
    for factor in fixed_spectrum.factors:
        subset = factor.channels
        if subset:
            yield say.PICTURE_OBSTRUCTION(s=subset, p=factor.polynomial)
        heard = given.senders(subset) if given.neighbors is not None else []
        if heard:
            yield say.PICTURE_HEARD(heard=heard)
        break


@rule("dimensions.title", say.PICTURE_DIMENSIONS)
def _dimensions_title(minimal_shared_dimensions_outputs_states: Claim) -> Said:
    if minimal_shared_dimensions_outputs_states.share == "outputs+states":
        yield say.PICTURE_DIMENSIONS()


@rule("latex", say.LATEX_NOTHING_FIXED)
def _latex_nothing(fixed_spectrum: Claim) -> Said:
    if empty(fixed_spectrum):
        yield say.LATEX_NOTHING_FIXED()


@rule("latex", say.LATEX_FIXED_MODE)
def _latex_modes(fixed_spectrum: Claim) -> Said:
    for factor in fixed_spectrum.factors:
        yield say.LATEX_FIXED_MODE(
            p=factor.polynomial, in_A=factor.multiplicity_in_A, rank=factor.rank, s=factor.channels
        )
