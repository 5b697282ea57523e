"""The answers of `mcexact analyze` as tables."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import TYPE_CHECKING

from mcexact.answer.template import Template
from mcexact.answer.wording import analysis as say
from mcexact.answer.wording import details
from mcexact.certificate.single_channel_gains import GainsWitness, StuckWitness
from mcexact.errors import LimitReached
from mcexact.exact.enclosures import exact_decimal
from mcexact.exact.location import steady_point
from mcexact.exact.polynomial import Polynomial, product
from mcexact.report.assessment import Assessment, ChannelAnswers
from mcexact.report.text import Table

if TYPE_CHECKING:
    from mcexact.analysis.complementary_subsystem import ComplementarySubsystem
    from mcexact.analysis.controllability_indices import ControllabilityIndices
    from mcexact.analysis.single_channel_gains import SingleChannelGains
    from mcexact.answer.evidence import RateInterval
    from mcexact.answer.fixed_spectrum import FixedFactor

Row = tuple[str, ...]


def assessment_tables(
    assessment: Assessment, *, most_factors: int | None = None
) -> tuple[Table, ...]:
    """All answers, then the fixed modes, then what was asked about channels.

    Parameters
    ----------
    assessment : Assessment
    most_factors : int, optional
        How many factors of the fixed polynomial are listed; all of them by default.
    """
    system = assessment.system
    heading = say.HEADING(
        name=system.name or "system", n=system.n, m=system.m, names=system.names, time=system.time
    )
    rows = [row for part in _PARTS for row in part(assessment)]
    tables = [Table(heading, (), tuple(rows))]
    if not assessment.fixed_spectrum.empty:
        tables.append(_fixed_modes(assessment, most_factors))
    if assessment.pencil_ranks:
        tables.append(_pencil_ranks(assessment))
    if assessment.complementary_subsystem is not None:
        tables.append(_complementary_subsystem(assessment.complementary_subsystem, system.n))
    if assessment.channel is not None:
        tables.append(_channel(assessment.channel))
    return tuple(tables)


def _joint(assessment: Assessment) -> Iterator[Row]:
    """Joint controllability and observability, or the modes that are out of reach."""
    if assessment.information == "outputs":
        yield say.INFORMATION.row(information=assessment.control)
    for found, yes, no in (
        (assessment.controllability, say.CONTROLLABLE, say.UNCONTROLLABLE),
        (assessment.observability, say.OBSERVABLE, say.UNOBSERVABLE),
    ):
        yield yes.row() if found.controllable else no.row(p=found.uncontrollable_polynomial)


def _graph(assessment: Assessment) -> Iterator[Row]:
    """The transfer graph, its components, and the channels that no edge can touch."""
    graph = assessment.transfer_graph
    told = say.GRAPH_CONNECTED if graph.strongly_connected else say.GRAPH_PARTS
    yield told.row(arcs=graph.arcs, components=graph.components)
    if graph.dead:
        yield say.INACTIVE.row(names=graph.dead)


def _spectrum(assessment: Assessment) -> Iterator[Row]:
    """What stays, whether the rest can be stabilized, and how fast."""
    spectrum, control = assessment.fixed_spectrum, assessment.control
    if spectrum.best_rate is None:
        yield say.FIXED_NONE.row()
        yield say.STABILIZABLE.row(control=control)
        yield say.ANY_RATE.row()
        return
    yield say.FIXED.row(p=spectrum.polynomial)
    told = say.STABILIZABLE if spectrum.stabilizable else say.NOT_STABILIZABLE
    yield told.row(control=control)
    yield say.SLOWEST.row(slowest=slowest(assessment))


def slowest(assessment: Assessment) -> tuple[str, RateInterval | None, bool]:
    """What is said of the slowest fixed mode is made of this."""
    spectrum = assessment.fixed_spectrum
    return assessment.system.time, spectrum.best_rate, spectrum.stabilizable


def _structure(assessment: Assessment) -> Iterator[Row]:
    """Completeness, indices, and what can be assigned."""
    yield say.COMPLETE.row(complete=assessment.completeness.complete)
    for found, (one, many, none) in (
        (assessment.controllability_indices, say.CONTROLLABILITY_INDICES),
        (assessment.observability_indices, say.OBSERVABILITY_INDICES),
    ):
        yield _indices(found, one, many, none)
    yield _assignability(assessment)


def _indices(
    found: ControllabilityIndices | None, one: Template, many: Template, none: Template
) -> Row:
    if found is None:
        return none.row()
    told = many if found.index is None else one
    return told.row(indices=found.indices, index=found.index)


def _assignability(assessment: Assessment) -> Row:
    """What of the spectrum can be assigned, or how many eigenvalues can be moved."""
    found = assessment.assignability
    if assessment.fixed_spectrum.empty:
        blocks = [(block.dimension, block.channels) for block in found.blocks]
        return say.SPECTRUM_FREE.row() if found.free else say.SPECTRUM_PARTS.row(blocks=blocks)
    least, most = movable(assessment)
    told = say.SPECTRUM_MOVED if least == most else say.SPECTRUM_MOVED_BETWEEN
    return told.row(k=least, most=most, n=assessment.system.n)


def movable(assessment: Assessment) -> tuple[int, int]:
    """Bounds on the number of eigenvalues, with multiplicity, that gains can move.

    n − deg φ, φ the greatest common divisor of all det(xI − A_F): a factor p of the fixed
    polynomial is in φ at least once and at most as often as in the loop of the certificate, and
    what belongs to no strong component of the transfer graph is in φ.
    """
    n, factors = assessment.system.n, assessment.fixed_spectrum.factors
    fixed = sum(factor.polynomial.degree for factor in factors)
    stuck = sum(factor.polynomial.degree * factor.multiplicity_at_most for factor in factors)
    return n - stuck, n - max(fixed, assessment.assignability.fixed_degree)


def _setpoint(assessment: Assessment) -> Iterator[Row]:
    """Whether every output can be held, or what stands against it."""
    found = assessment.setpoint
    if found.invariant_zero:
        yield say.SETPOINT_ZERO.row(place=steady_point(assessment.system.time))
    elif not found.solvable:
        yield say.SETPOINT_DEPENDENT.row()
    elif assessment.controllability.controllable and assessment.observability.controllable:
        yield say.SETPOINT.row()
    else:
        unstable = _out_of_reach(assessment)
        told = say.SETPOINT_STABLE_REST if unstable.degree == 0 else say.SETPOINT_UNSTABLE_REST
        yield told.row(p=unstable)


def _out_of_reach(assessment: Assessment) -> Polynomial:
    """The product of the factors, not stable, that are not jointly controllable and observable."""
    unreached = (
        assessment.controllability.uncontrollable_polynomial
        * assessment.observability.uncontrollable_polynomial
    )
    return product(
        factor.polynomial
        for factor in assessment.fixed_spectrum.factors
        if not factor.stable and factor.polynomial.divides(unreached)
    )


def _links(assessment: Assessment) -> Iterator[Row]:
    """The fewest links to add, where that was asked for."""
    links = assessment.minimal_communication
    if isinstance(links, LimitReached):
        yield say.TABLE_LINKS["limit"].row()
    elif links is not None:
        found = "impossible" if links.added is None else "some" if links.added else "none"
        yield say.TABLE_LINKS[found].row(added=links.added, time=assessment.instant)


def _sharing(assessment: Assessment) -> Iterator[Row]:
    """What is enough to share over the neighbor graph, and what is least."""
    if assessment.neighbor_graph is None:
        return
    connected = assessment.neighbor_graph.strongly_connected
    yield (say.CONNECTED if connected else say.NOT_CONNECTED).row()
    unreached = [
        told.row(p=found.uncontrollable_polynomial)
        for found, told in (
            (assessment.controllability, say.NEVER_CONTROLLED),
            (assessment.observability, say.NEVER_OBSERVED),
        )
        if not found.controllable
    ]
    yield from unreached
    if not unreached and not connected:
        yield say.NO_BOUND.row()
    if bound_holds(assessment):
        for share, bound in assessment.shared_dimension_bounds.items():
            some, none = say.ENOUGH[share]
            told = some if bound.per_agent else none
            yield told.row(k=bound.per_agent, total=bound.total, time=assessment.instant)
    for share, least in (assessment.minimal_shared_dimensions or {}).items():
        some, none, impossible, limit = say.LEAST[share]
        if isinstance(least, LimitReached):
            yield limit.row()
        elif least.dimensions is None:
            yield impossible.row()
        else:
            sizes = list(zip(assessment.system.names, least.dimensions, strict=True))
            told = some if any(least.dimensions) else none
            yield told.row(sizes=sizes, time=assessment.instant)


def bound_holds(assessment: Assessment) -> bool:
    """Whether the hypotheses of Theorem 2 hold, so that its bound is one."""
    return (
        assessment.neighbor_graph is not None
        and assessment.neighbor_graph.strongly_connected
        and assessment.controllability.controllable
        and assessment.observability.controllable
    )


def _delayed(assessment: Assessment) -> Iterator[Row]:
    """What stays with messages that take their time."""
    if assessment.delayed is None:
        return
    found = assessment.delayed
    for name, verdict, sizes in (
        ("lifted", found.lifted, found.lifted_dimensions),
        ("held", found.held, found.held_dimensions),
    ):
        nothing, something = details.DELAYED[name]
        told = nothing if verdict.nothing_fixed else something
        yield told.row(p=verdict.spectrum.polynomial, n=verdict.system.n, k=sizes[0])


def _every_channel(assessment: Assessment) -> Iterator[Row]:
    if assessment.every_channel is not None:
        yield gains_row("every", assessment.every_channel)


_PARTS: tuple[Callable[[Assessment], Iterator[Row]], ...] = (
    _joint,
    _graph,
    _spectrum,
    _structure,
    _setpoint,
    _every_channel,
    _links,
    _sharing,
    _delayed,
)


def _fixed_modes(assessment: Assessment, most: int | None) -> Table:
    """One row for each factor of the fixed spectrum, those that are not stable first."""
    n = assessment.system.n
    factors = sorted(assessment.fixed_spectrum.factors, key=lambda factor: factor.stable)
    rows = tuple(
        details.FIXED_MODE.cells(
            p=factor.polynomial,
            roots=_centers(factor),
            stable=factor.stable,
            in_A=factor.multiplicity_in_A,
            stays=factor.multiplicity_at_most,
            s=factor.channels,
            rank=factor.rank,
        )
        for factor in factors[:most]
    )
    note: str = details.FIXED_MODES_NOTE(n=n)
    if len(rows) < len(factors):
        note = f"{details.FIXED_MODES_MORE(k=len(factors) - len(rows))}. {note}"
    return Table(
        details.FIXED_MODES(control=assessment.control),
        ("factor", "roots, about", "stable", "in A", "stay", "s", "rank"),
        rows,
        note,
    )


def _centers(factor: FixedFactor) -> list[tuple[Fraction, Fraction]]:
    """The centers of the root discs; a rational root itself."""
    if factor.polynomial.degree == 1:
        return [(-factor.polynomial.coefficients[0], Fraction(0))]
    return [(exact_decimal(disc.re), exact_decimal(disc.im)) for disc in factor.roots]


def _pencil_ranks(assessment: Assessment) -> Table:
    """One row for each mode of A, for the subset that was asked about."""
    rows = tuple(
        details.PENCIL_ROW.cells(
            p=found.polynomial, rank=found.rank, below=found.rank < assessment.system.n
        )
        for found in assessment.pencil_ranks
    )
    title = details.PENCIL(s=assessment.pencil_ranks[0].subset)
    return Table(title, ("factor of det(xI-A)", "rank", "below n"), rows)


def _complementary_subsystem(found: ComplementarySubsystem, n: int) -> Table:
    """One row for each answer about the subsystem."""
    zeros = [each.polynomial for each in found.zeros]
    rows = (
        details.NORMAL_RANK.row(rank=found.normal_rank),
        details.ZEROS.row(zeros=zeros) if zeros else details.NO_ZEROS.row(),
        details.REMNANT.row(p=found.remnant),
        subsystem_completeness(found, n),
    )
    return Table(details.SUBSYSTEM(s=found.subset), (), rows)


def subsystem_completeness(found: ComplementarySubsystem, n: int) -> tuple[str, str]:
    """Whether a complementary subsystem is complete, or why not."""
    drops = [each.polynomial for each in found.zeros if each.rank < n]
    if drops:
        told = details.SUBSYSTEM_BOTH if found.transfer_zero else details.SUBSYSTEM_DROPS
        return told.row(zeros=drops)
    return (details.SUBSYSTEM_ZERO if found.transfer_zero else details.SUBSYSTEM_COMPLETE).row()


def _channel(found: ChannelAnswers) -> Table:
    """One row for each answer about the channel."""
    rows: list[Row] = []
    for what, alone in (
        ("controllability", found.controllability),
        ("observability", found.observability),
    ):
        yes, no = details.ALONE[what]
        rows.append(yes.row() if alone.controllable else no.row(p=alone.uncontrollable_polynomial))
    rows += [gains_row(want, gains) for want, gains in found.gains.items()]
    return Table(details.CHANNEL(name=found.name), (), tuple(rows))


def gains_row(want: str, found: SingleChannelGains) -> tuple[str, str]:
    """The indices that gains reach, or why there are none."""
    told = details.GAINS[want]
    why = found.certificate.evidence
    if isinstance(why, GainsWitness):
        return told["reached"].row(reached=found.indices)
    if isinstance(why, StuckWitness):
        return told["stuck"].row(name=why.channel, side=why.side, p=why.polynomial)
    names = [channel["name"] for channel in found.certificate.system["channels"]]
    rest = [name for name in names if name not in set(why.zero.channels_from)]
    return told[why.side].row(name=why.channel, rest=rest)
