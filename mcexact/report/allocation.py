"""What `mcexact allocate` prints: who has to share how much, or which wires to add, and why."""

from __future__ import annotations

from collections.abc import Mapping
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
from mcexact.certificate import codec
from mcexact.model.system import MultiChannelSystem
from mcexact.report.json_view import polynomial_view
from mcexact.report.text import Table, count, shorten

SHARED = {"outputs+states": "outputs and sub-states", "states": "sub-states alone"}


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
    return {
        "feasible": least.feasible,
        "json": _dimensions_view(system, bound, least),
        "tables": _dimensions_tables(system, bound, least),
        "certificates": {
            "shared_dimension_bound": codec.encode(bound.certificate),
            "minimal_shared_dimensions": codec.encode(least.certificate),
        },
    }


def _dimensions_view(
    system: MultiChannelSystem, bound: SharedDimensionBound, least: SharedDimensions
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
        "bound": {"per_agent": bound.per_agent, "total": bound.total},
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
    system: MultiChannelSystem, bound: SharedDimensionBound, least: SharedDimensions
) -> tuple[Table, ...]:
    name = system.name or "system"
    reasons = Table(
        "why" if least.feasible else "why nothing suffices",
        ("these agents", "must hear from", "at least", "because of"),
        tuple(_reason(subset) for subset in least.binding),
    )
    if least.dimensions is None:
        title = f"{name}: sharing {SHARED[least.share]}, no dimensions leave every mode movable"
        return (Table(title, (), ()), reasons)
    rows = [
        (agent, str(size), str(bound.per_agent))
        for agent, size in zip(system.names, least.dimensions, strict=True)
    ]
    rows.append(("total", str(least.total), str(bound.total)))
    note = _proof(least.cuts, "subset", least.nodes)
    if least.cost != least.total:
        note = f"least cost {least.cost}; {note}"
    shares = Table(
        f"{name}: what each agent has to share ({SHARED[least.share]})",
        ("agent", "least", "Theorem 2's bound"),
        tuple(rows),
        note,
    )
    return (shares, reasons) if least.binding else (shares,)


def _proof(cuts: int, noun: str, nodes: int) -> str:
    return f"proved with {count(cuts, noun)} and a branch tree of {count(nodes, 'node')}"


def _reason(subset: BindingSubset) -> tuple[str, str, str, str]:
    mode = "nothing reaches them otherwise"
    if subset.mode is not None:
        mode = f"the roots of {shorten(str(subset.mode))}"
    return (
        ", ".join(subset.subset),
        ", ".join(subset.boundary) or "nobody: there is no wire",
        str(subset.deficiency),
        mode,
    )


def arcs_report(system: MultiChannelSystem, options: Mapping[str, Any]) -> dict[str, Any]:
    """Decide the cheapest wires; JSON, tables and certificates of the answer.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant with a neighbor graph.
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
    name = system.name or "system"
    note = _proof(least.cuts, "obstruction", least.nodes)
    if least.added is None:
        return Table(f"{name}: no wires that may be added leave every mode movable", (), (), note)
    if not least.added:
        return Table(f"{name}: every mode can be moved as it is, no wire is needed", (), (), note)
    prices: dict[tuple[str, str], Fraction] = {
        (j, i): price for j, i, price in least.certificate.candidates
    }
    rows = [(j, i, str(prices[j, i])) for j, i in least.added]
    rows.append(("total", "", str(least.cost)))
    return Table(f"{name}: wires to add", ("from", "to", "cost"), tuple(rows), note)
