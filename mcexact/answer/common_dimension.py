"""Answer: the least common dimension of shared sub-states that suffices, or that none does."""

from __future__ import annotations

from collections.abc import Iterator

from mcexact.answer.covering import Absence, BlocksAbsence, DeficiencyCut
from mcexact.answer.protocol import Answer, answer, claim, witness
from mcexact.answer.sentence import Claim, Given, Rulebook
from mcexact.answer.template import Sentence, Template


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
RULES = Rulebook()


def _rule(share: str) -> None:
    """Make the rule of the least common dimension for one way of sharing."""
    some, none, impossible = WORDS[share]
    question = f"common_dimension_{share.replace('+', '_')}"

    @RULES.rule("table", some, none, impossible, about={"found": question})
    def least(found: Claim, given: Given) -> Iterator[Sentence]:
        k = found.dimension
        if found.share == share:
            told = impossible if k is None else some if k else none
            yield told(k=k, total=k and k * given.m, time=given.delays)


for way in WORDS:
    _rule(way)
