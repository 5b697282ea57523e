"""The rules of the sentences of `mcexact allocate` about dimensions."""

from __future__ import annotations

from mcexact.answer.rules.analysis import Said
from mcexact.answer.rules.sharing import theorem_2
from mcexact.answer.sentence import Claim, Given, Rulebook
from mcexact.answer.wording import allocation as say

RULES = Rulebook()
rule = RULES.rule


@rule("title", say.LEAST, say.IMPOSSIBLE)
def _least(minimal_shared_dimensions: Claim, given: Given) -> Said:
    found = minimal_shared_dimensions
    told = say.IMPOSSIBLE if found.dimensions is None else say.LEAST
    yield told(
        name=given.name or "system",
        share=found.share,
        scope=(given.time, found.bound, found.free_assignability),
        price="least" if all(cost == 1 for cost in found.costs) else "cheapest",
        limits="none" if all(most is None for most in found.upper) else "upper",
        time=given.delays,
    )


@rule("table", say.ROW, say.TOTAL, say.ROW_BOUND, say.TOTAL_BOUND)
def _rows(
    minimal_shared_dimensions: Claim,
    shared_dimension_bound: Claim,
    neighbor_graph: Claim,
    joint_controllability: Claim,
    joint_observability: Claim,
    given: Given,
) -> Said:
    """The least dimensions, with the bound of the theorem if its hypotheses hold.

    Theorem 2 says that no mode is fixed, but not that the whole spectrum is assignable.
    """
    found, reach = minimal_shared_dimensions, (joint_controllability, joint_observability)
    if found.dimensions is None:
        return
    row, total, k = say.ROW, say.TOTAL, 0
    outputs = found.share == "outputs+states"
    fits = [each["construction"] for each in shared_dimension_bound.subject]
    if (
        fits == ["augmented_outputs"] * outputs
        and not found.free_assignability
        and theorem_2(neighbor_graph, *reach)
    ):
        row, total, k = say.ROW_BOUND, say.TOTAL_BOUND, shared_dimension_bound.deficiency
    for agent, size in zip(given.names, found.dimensions, strict=True):
        yield row(agent=agent, size=size, bound=k)
    yield total(size=sum(found.dimensions), bound=k * given.m)


@rule("table.note", say.PROOF, say.COST_PROOF)
def _proof(minimal_shared_dimensions: Claim, given: Given) -> Said:
    found = minimal_shared_dimensions
    if found.dimensions is not None:
        told = say.PROOF if all(cost == 1 for cost in found.costs) else say.COST_PROOF
        yield told(cost=found.cost, cuts=given.cuts, nodes=given.nodes)


@rule("why", say.REASON, say.REASON_CUT_OFF, *say.REASON_UNREACHED.values())
def _reasons(minimal_shared_dimensions: Claim, given: Given) -> Said:
    """The active cuts, which the dimensions meet with equality; if no dimensions suffice, all cuts.

    The cuts of the empty set and of all agents do not depend on sharing.
    """
    found = minimal_shared_dimensions
    sizes = None
    if found.dimensions is not None:
        sizes = dict(zip(given.names, found.dimensions, strict=True))
    for cut in found.proof.cuts:
        subset, senders = cut.subset, given.senders(cut.subset)
        demand = cut.deficiency if cut.has("deficiency") else 1
        if sizes is not None and sum(sizes[name] for name in senders) > demand:
            continue
        told, p = say.REASON_CUT_OFF, None
        if cut.has("polynomial"):
            told, p = say.REASON, cut.polynomial
            if len(subset) in {0, given.m}:
                told = say.REASON_UNREACHED["observe" if subset else "control"]
        yield told(subset=subset, senders=senders, deficiency=demand, p=p)
