"""What `mcexact allocate` prints: who has to share how much, or which links to add, and why."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from mcexact.analysis.allocation import (
    BindingSubset,
    SharedDimensionBound,
    SharedDimensions,
    minimal_shared_dimensions,
    shared_dimension_bound,
)
from mcexact.analysis.communication import MinimalCommunication, minimal_communication
from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.neighbor_graph import neighbor_graph
from mcexact.answer import codec
from mcexact.answer.wording import allocation as say
from mcexact.answer.wording import links
from mcexact.model.system import MultiChannelSystem
from mcexact.report.json_view import polynomial_view
from mcexact.report.text import Table

_BOUND = {"outputs+states": "Theorem 2's bound", "states": "Remark 2's bound"}


def dimensions_report(system: MultiChannelSystem, options: Mapping[str, Any]) -> dict[str, Any]:
    """Decide the least dimensions; JSON, tables and certificates of the answer.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant with a neighbor graph.
    options : mapping
        The keywords of `minimal_shared_dimensions`.
    """
    bound = shared_dimension_bound(system, share=options["share"])
    least = minimal_shared_dimensions(system, **options)
    graph = neighbor_graph(system)
    controllable, observable = joint_controllability(system), joint_observability(system)
    # Theorem 2 leaves no mode fixed; that the whole spectrum can be assigned is more.
    holds = graph.strongly_connected and controllable.controllable and observable.controllable
    holds = holds and not least.certificate.free_assignability
    return {
        "feasible": least.feasible,
        "json": _dimensions_view(system, bound, holds, least),
        "tables": _dimensions_tables(system, bound if holds else None, least),
        "certificates": {
            "shared_dimension_bound": codec.encode(bound.certificate),
            "minimal_shared_dimensions": codec.encode(least.certificate),
            "neighbor_graph": codec.encode(graph.certificate),
            "joint_controllability": codec.encode(controllable.certificate),
            "joint_observability": codec.encode(observable.certificate),
        },
    }


def _dimensions_view(
    system: MultiChannelSystem, bound: SharedDimensionBound, holds: bool, least: SharedDimensions
) -> dict[str, Any]:
    minimal = None
    if least.dimensions is not None:
        minimal = {
            "total": least.total,
            "dimensions": dict(zip(system.names, least.dimensions, strict=True)),
            "cost": str(least.cost),
        }
    return {
        "share": least.share,
        "deficiency": bound.per_agent,
        "bound": {"per_agent": bound.per_agent, "total": bound.total} if holds else None,
        "feasible": least.feasible,
        "minimal": minimal,
        "binding": [
            {
                "subset": list(subset.subset),
                "boundary": list(subset.boundary),
                "mode": None if subset.mode is None else polynomial_view(subset.mode),
                "deficiency": subset.deficiency,
            }
            for subset in least.binding
        ],
        "proof": {"cuts": least.cuts, "nodes": least.nodes},
    }


def _dimensions_tables(
    system: MultiChannelSystem, bound: SharedDimensionBound | None, least: SharedDimensions
) -> tuple[Table, ...]:
    """What is least, beside the bound where that is one; and who has to receive how much."""
    made = least.certificate
    asked = {
        "name": system.name or "system",
        "share": least.share,
        "scope": (system.time, made.bound, made.free_assignability),
        "price": _price(made.costs),
        "limits": "none" if all(u is None for u in made.upper) else "upper",
        "time": _instant(system),
    }
    why = Table(
        "why" if least.feasible else "why nothing is enough",
        ("these agents", "can receive from", "need", "because of"),
        tuple(_reason(subset, system.m) for subset in least.binding),
    )
    if least.dimensions is None:
        return (Table(say.IMPOSSIBLE(**asked), (), ()), why)
    columns: tuple[str, ...] = ("agent", "least")
    row, total, values = say.ROW, say.TOTAL, {}
    if bound is not None:
        columns += (_BOUND[least.share],)
        row, total, values = say.ROW_BOUND, say.TOTAL_BOUND, {"bound": bound.per_agent}
    rows = [
        row.cells(agent=agent, size=size, **values)
        for agent, size in zip(system.names, least.dimensions, strict=True)
    ]
    whole = {} if bound is None else {"bound": bound.total}
    rows.append(total.cells(size=least.total, **whole))
    proof = say.PROOF if asked["price"] == "least" else say.COST_PROOF
    note = proof(cost=least.cost, cuts=least.cuts, nodes=least.nodes)
    shares = Table(say.LEAST(**asked), columns, tuple(rows), note)
    return (shares, why) if least.binding else (shares,)


def _price(costs: Sequence[Fraction]) -> str:
    """Whether the least number is asked for, or the least price."""
    return "least" if all(cost == 1 for cost in costs) else "cheapest"


def _instant(system: MultiChannelSystem) -> str:
    """Whether the answer supposes that messages take no time, although some do."""
    return "delays" if system.neighbors is not None and system.neighbors.delays else "none"


def _reason(subset: BindingSubset, m: int) -> tuple[str, ...]:
    """Why a set of agents needs something; of none and of all it is not a matter of sharing."""
    told = say.REASON_CUT_OFF if subset.mode is None else say.REASON
    if subset.mode is not None and len(subset.subset) in {0, m}:
        told = say.REASON_UNREACHED["observe" if subset.subset else "control"]
    return told.cells(
        subset=subset.subset,
        senders=subset.boundary,
        deficiency=subset.deficiency,
        p=subset.mode,
    )


def arcs_report(system: MultiChannelSystem, options: Mapping[str, Any]) -> dict[str, Any]:
    """Decide the cheapest links; JSON, tables and certificates of the answer.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant.
    options : mapping
        The keywords of `minimal_communication`.
    """
    least = minimal_communication(system, **options)
    return {
        "feasible": least.feasible,
        "json": {
            "share": least.certificate.share,
            "dimensions": options["dimensions"],
            "feasible": least.feasible,
            "added": None if least.added is None else [list(arc) for arc in least.added],
            "cost": None if least.cost is None else str(least.cost),
            "proof": {"cuts": least.cuts, "nodes": least.nodes},
        },
        "tables": (_arcs_table(system, least),),
        "certificates": {"minimal_communication": codec.encode(least.certificate)},
    }


def _arcs_table(system: MultiChannelSystem, least: MinimalCommunication) -> Table:
    made = least.certificate
    asked = {
        "name": system.name or "system",
        "scope": (system.time, made.bound, False),
        "what": (made.share, made.dimensions),
        "price": _price([price for *_, price in made.candidates]),
        "time": _instant(system),
    }
    note = links.PROOF(cuts=least.cuts, nodes=least.nodes)
    if not least.added:
        told = links.IMPOSSIBLE if least.added is None else links.NONE_NEEDED
        return Table(told(**asked), (), (), note)
    prices: dict[tuple[str, str], Fraction] = {(j, i): price for j, i, price in made.candidates}
    rows = [links.ROW.cells(start=j, end=i, cost=prices[j, i]) for j, i in least.added]
    rows.append(links.TOTAL.cells(cost=least.cost))
    return Table(links.LEAST(**asked), ("from", "to", "cost"), tuple(rows), note)
