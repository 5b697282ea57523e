"""The sentences of `mcexact allocate`: the premises are the certificates that it writes."""

from __future__ import annotations

from mcexact.answer.template import Template

_LEAST = ("minimal_shared_dimensions",)

LEAST = Template(
    "allocate-least",
    "{name:name}: {price:price} shared states {share:share} so that {scope:scope}"
    "{limits:limits}{time:instant}",
    _LEAST,
)
IMPOSSIBLE = Template(
    "allocate-impossible",
    "{name:name}: no shared states {share:share} are enough so that {scope:scope}{limits:limits}",
    _LEAST,
)
ROW = Template("allocate-row", "{agent:name} | {size:int}", _LEAST)
TOTAL = Template("allocate-total", "total | {size:int}", _LEAST)
_BOUND = (
    *_LEAST,
    "shared_dimension_bound",
    "neighbor_graph",
    "joint_controllability",
    "joint_observability",
)
_THEOREM_2 = "extended_bound.theorem_2, extended_bound.remark_2"
ROW_BOUND = Template(
    "allocate-row-bound", "{agent:name} | {size:int} | {bound:int}", _BOUND, _THEOREM_2
)
TOTAL_BOUND = Template(
    "allocate-total-bound", "total | {size:int} | {bound:int}", _BOUND, _THEOREM_2
)
PROOF = Template(
    "allocate-proof",
    "proved with {cuts:count subset} and a branch tree of {nodes:count node}",
    _LEAST,
)
COST_PROOF = Template(
    "allocate-cost-proof",
    "least cost {cost:number}; proved with {cuts:count subset} and a branch tree of "
    "{nodes:count node}",
    _LEAST,
)
REASON = Template(
    "allocate-reason", "{subset:names} | {senders:names} | {deficiency:int} | {p:modes}", _LEAST
)
REASON_UNREACHED = {
    verb: Template(
        f"allocate-reason-do-not-{verb}",
        "all together | nobody | {deficiency:int} | {p:modes}, which they do not " + verb,
        _LEAST,
    )
    for verb in ("control", "observe")
}
REASON_CUT_OFF = Template(
    "allocate-reason-cut-off",
    "{subset:names} | {senders:names} | {deficiency:int} | the others do not act on them",
    _LEAST,
)
