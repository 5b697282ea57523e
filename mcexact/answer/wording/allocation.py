"""The sentences of `mcexact allocate`."""

from __future__ import annotations

from mcexact.answer.template import Template

LEAST = Template(
    "allocate-least",
    "{name:name}: {price:price} shared states {share:share} so that {scope:scope}"
    "{limits:limits}{time:instant}",
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
