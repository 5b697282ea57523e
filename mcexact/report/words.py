"""The answer of an analysis in plain words, the most important sentence first."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from mcexact.answer.template import Sentence
from mcexact.answer.wording import analysis as say
from mcexact.errors import LimitReached
from mcexact.report.assessment import Assessment
from mcexact.report.assessment_tables import slowest
from mcexact.report.text import WIDTH, wrapped

if TYPE_CHECKING:
    from mcexact.answer.fixed_spectrum import FixedFactor

_MOST_FACTORS = 8


def answer(assessment: Assessment, most_factors: int = _MOST_FACTORS) -> list[Sentence]:
    """What a user wants to know first, one sentence after the other.

    Parameters
    ----------
    assessment : Assessment
    most_factors : int
        How many factors of the fixed polynomial get a sentence of their own.
    """
    if assessment.fixed_spectrum.empty:
        return [
            say.NOTHING_FIXED(control=assessment.control),
            *_assigned(assessment),
        ]
    return [
        _stabilized(assessment),
        *_remedies(assessment),
        *_blames(assessment, most_factors),
    ]


def in_lines(assessment: Assessment, most: int, width: int = WIDTH) -> str:
    """The answer in so many lines; whole sentences are left out, which the table tells as well."""
    lines: list[str] = []
    for factors in range(_MOST_FACTORS, -1, -1):
        lines = []
        for sentence in answer(assessment, factors):
            more = wrapped(sentence, width)
            if len(lines) + len(more) > most:
                break
            lines += more
        else:
            break
    return "\n".join(lines) + "\n"


def _assigned(assessment: Assessment) -> list[Sentence]:
    """How the spectrum can be assigned where nothing is fixed."""
    if assessment.system.n == 0:
        return []
    if assessment.completeness.complete:
        return [say.FREE_THROUGH_ANY()]
    if assessment.assignability.free:
        return [say.FREE()]
    return [say.PARTS(k=sum(block.dimension > 0 for block in assessment.assignability.blocks))]


def _stabilized(assessment: Assessment) -> Sentence:
    """Whether control with this information stabilizes, and how the slowest fixed mode behaves."""
    spectrum = assessment.fixed_spectrum
    told = say.STABLE if spectrum.stabilizable else say.UNSTABLE
    return told(control=assessment.control, slowest=slowest(assessment))


def _blames(assessment: Assessment, most: int) -> Iterator[Sentence]:
    """Who does not reach each fixed mode, those that are not stable first."""
    factors = sorted(assessment.fixed_spectrum.factors, key=lambda factor: factor.stable)
    names = assessment.system.names
    for factor in factors[:most]:
        yield _blame(factor, names)
    if 0 < most < len(factors):
        yield say.MORE_FIXED(k=len(factors) - most)


def _blame(factor: FixedFactor, names: Sequence[str]) -> Sentence:
    """Who does not control a mode, and who does not observe it.

    rank P_s < n leaves [λI − A, B_T] and [λI − A; C_s] with less than n too, T the rest of s.
    """
    inside = set(factor.channels)
    outside = [name for name in names if name not in inside]
    told = say.BLAME if inside and outside else say.UNOBSERVED if inside else say.UNCONTROLLED
    return told(
        p=factor.polynomial,
        often=(factor.multiplicity_in_A, factor.multiplicity_at_most),
        inside=factor.channels,
        outside=outside,
    )


def _remedies(assessment: Assessment) -> Iterator[Sentence]:
    """What frees every mode: links, or shared sub-states; where that was asked for."""
    links = assessment.minimal_communication
    if links is not None and not isinstance(links, LimitReached):
        beside = assessment.system.plant.neighbors is not None
        if links.added is None:
            yield say.NO_LINKS()
        else:
            some = say.LINKS[beside] if links.added else say.LINKS_NONE
            yield some(added=links.added, time=assessment.instant)
    least = (assessment.minimal_shared_dimensions or {}).get("outputs+states")
    if least is None or isinstance(least, LimitReached):
        return
    if least.dimensions is None:
        yield say.NO_SHARING()
    elif any(least.dimensions):
        sizes = list(zip(assessment.system.names, least.dimensions, strict=True))
        yield say.SHARING_REMOVES(sizes=sizes, time=assessment.instant)
    else:
        yield say.OUTPUTS_REMOVE(time=assessment.instant)
