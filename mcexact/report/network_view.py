"""Designs without an observer as tables for people and as plain data for programs."""

from __future__ import annotations

from typing import Any

from mcexact.answer.wording import design as say
from mcexact.report.text import Table
from mcexact.synthesis.extended import ExtendedDesign
from mcexact.synthesis.network_design import NetworkDesign
from mcexact.synthesis.setpoint import SetpointDesign

AnyDesign = NetworkDesign | ExtendedDesign | SetpointDesign


def design_view(name: str, design: AnyDesign) -> dict[str, Any]:
    """The summary of a design; a polynomial is its coefficients as strings."""
    polynomial = design.loop.polynomial
    view: dict[str, Any] = {
        "design": name,
        "arithmetic": design.arithmetic,
        "order": design.order,
        "closed_loop_polynomial": None
        if polynomial is None
        else [str(c) for c in polynomial.coefficients],
        "bits_of_longest_number": design.height,
        "controller": design.controller.document(),
    }
    if isinstance(design, SetpointDesign):
        return view | {"road": design.road}
    found = design.design if isinstance(design, ExtendedDesign) else design
    return view | {
        "network": found.network.kind,
        "shared_dimensions": dict(
            zip(found.network.plant.names, found.network.dimensions, strict=True)
        ),
        "observer_order": found.observer_order,
        "blocks": [
            {
                "channels": list(block.channels),
                "agent": block.agent,
                "order": block.order,
                "polynomial": [str(c) for c in block.polynomial.coefficients],
            }
            for block in found.blocks
        ],
        "kept": [str(c) for c in found.kept.coefficients],
    }


def design_tables(design: AnyDesign) -> tuple[Table, ...]:
    """The summary of a design."""
    if isinstance(design, SetpointDesign):
        rows = [
            say.ORDER_INTEGRATORS.row(order=design.order),
            say.STEADY.row(),
            say.LONGEST.row(bits=design.height),
        ]
        return (Table(say.SETPOINT(method=design.road), (), tuple(rows)),)
    found = design.design if isinstance(design, ExtendedDesign) else design
    rows = [
        say.ORDER.row(order=found.order),
        say.OBSERVER_ORDER.row(order=found.observer_order),
    ]
    if found.network.kind != "decentralized":
        names = found.network.plant.names
        rows.append(say.SHARED.row(sizes=list(zip(names, found.network.dimensions, strict=True))))
    for block in found.blocks:
        carrier = say.CARRIER if len(found.blocks) == 1 else say.CARRIER_FOR
        rows.append(
            carrier.row(agent=block.agent, order=block.order, channels=list(block.channels))
        )
        rows.append(say.ASSIGNED.row(p=block.polynomial))
    if found.kept.degree > 0:
        rows.append(say.KEPT.row(p=found.kept))
    rows.append(say.LONGEST.row(bits=found.height))
    return (Table(say.NETWORK(kind=found.network.kind), (), tuple(rows)),)
