"""The rules of the sentences of `mcexact allocate --links`."""

from __future__ import annotations

from mcexact.answer.rules.analysis import Said
from mcexact.answer.sentence import Claim, Given, Rulebook
from mcexact.answer.wording import links as say

RULES = Rulebook()
rule = RULES.rule


@rule("title", say.LEAST, say.IMPOSSIBLE, say.NONE_NEEDED)
def _links(minimal_communication: Claim, given: Given) -> Said:
    found = minimal_communication
    told = say.LEAST if found.added else say.NONE_NEEDED
    yield (say.IMPOSSIBLE if found.added is None else told)(
        name=given.name or "system",
        scope=(given.time, found.bound, False),
        what=(found.share, found.dimensions),
        price="least" if all(price == 1 for *_, price in found.candidates) else "cheapest",
        time=given.delays,
    )


@rule("table", say.ROW, say.TOTAL)
def _added(minimal_communication: Claim) -> Said:
    found = minimal_communication
    if found.added:
        prices = {(j, i): price for j, i, price in found.candidates}
        for j, i in found.added:
            yield say.ROW(start=j, end=i, cost=prices[j, i])
        yield say.TOTAL(cost=found.cost)


@rule("table.note", say.PROOF)
def _proof(minimal_communication: Claim, given: Given) -> Said:
    """The proof of what the certificate claims, feasible or not."""
    _ = minimal_communication.feasible
    yield say.PROOF(cuts=given.cuts, nodes=given.nodes)
