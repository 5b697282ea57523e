"""Designs without an observer as tables for people and as plain data for programs."""

from __future__ import annotations

from typing import Any

from mcexact.report.text import Table, shorten
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
            ("states of all agents together", f"{design.order}, integrators included"),
            ("gain from set-points to outputs", "the identity, exactly"),
            ("longest number", f"{design.height} bits"),
        ]
        title = f"set-point controller ({design.road}), closed loop certified"
        return (Table(title, (), tuple(rows)),)
    found = design.design if isinstance(design, ExtendedDesign) else design
    rows = [
        ("states of all agents together", str(found.order)),
        ("a distributed observer would have", str(found.observer_order)),
    ]
    if found.network.kind != "decentralized":
        names = found.network.plant.names
        sizes = zip(names, found.network.dimensions, strict=True)
        rows.append(("shared dimensions", ", ".join(f"{name}: {n}" for name, n in sizes)))
    for block in found.blocks:
        carrier = f"{block.agent}, of order {block.order}"
        if len(found.blocks) > 1:
            carrier += f", for the channels {', '.join(block.channels)}"
        rows.append(("agent with the channel controller", carrier))
        rows.append(("spectrum that it assigns", shorten(str(block.polynomial))))
    if found.kept.degree > 0:
        rows.append(("fixed modes kept", shorten(str(found.kept))))
    rows.append(("longest number", f"{found.height} bits"))
    title = f"{found.network.kind} design, closed loop certified"
    return (Table(title, (), tuple(rows)),)
