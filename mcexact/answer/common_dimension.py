"""Answer: the least dimension that is enough where every agent shares the same, or that none is."""

from __future__ import annotations

from collections.abc import Iterator

from mcexact.answer.covering import Absence, DeficiencyCut
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
        Whether any dimension is enough.
    dimension : int or None
        k; None where none is enough.
    absence : Absence or None
        That k is enough.
    cut : DeficiencyCut or None
        A set s around which k − 1 is too little, or with an empty boundary N_s∖s; None if k = 0.
    """

    share: str = claim("what is shared")
    feasible: bool = claim("some common dimension is enough")
    dimension: int | None = claim("least common dimension")
    absence: Absence | None = witness()
    cut: DeficiencyCut | None = witness()


def _templates(key: str, theorem: str, some: str, none: str, never: str) -> tuple[Template, ...]:
    """The least for one way of sharing: some states, none, or that nothing is enough."""
    label, proved = "least if all share the same", f"common_dimension_{theorem}"
    least = some + "{k:count state} by each agent: {total:int} in all{time:instant}"
    never += "no number of states is enough"
    return (
        Template(f"common-dimension-{key}", least, f"shared_dimensions.{proved}", label),
        Template(f"common-dimension-{key}-none", none + "{time:instant}", label=label),
        Template(
            f"common-dimension-{key}-impossible", never, f"shared_dimensions.no_{proved}", label
        ),
    )


WORDS = {
    "outputs+states": _templates(
        "outputs-states", "outputs", "outputs, and ", "outputs alone", "beside outputs, "
    ),
    "states": _templates("states", "states", "without outputs, ", "nothing", "without outputs, "),
}
RULES = Rulebook()


def _rule(share: str) -> None:
    """What is said of the least for one way of sharing."""
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
