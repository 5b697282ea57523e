"""Designs and verdicts on controllers as tables for people, and verdicts as plain data."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mcexact.answer.stability import StabilityVerdict
from mcexact.answer.wording import design as say
from mcexact.report.text import Table
from mcexact.synthesis.design import Design


def design_tables(design: Design) -> tuple[Table, ...]:
    """A table of what is proved, and one of what is measured in floating point."""
    return Table(_title(design), (), tuple(_proved(design))), _measured(design)


def _title(design: Design) -> str:
    if design.name == "setpoint":
        return say.SETPOINT(method=design.method)
    if design.method == "observer":
        return (say.OBSERVER if design.arithmetic == "exact" else say.OBSERVER_FLOAT)()
    return say.NETWORK(kind=design.parts["network"])


def _proved(design: Design) -> list[tuple[str, ...]]:
    """Who carries what, the states, and where the eigenvalues are."""
    parts, rows = design.parts, []
    if "agent" in parts:
        rows.append(say.CARRIER.row(agent=parts["agent"], order=parts["channel_order"]))
    told = say.ORDER_INTEGRATORS if design.name == "setpoint" else say.ORDER
    rows.append(told.row(order=design.order))
    if "observer_order" in parts:
        rows.append(say.OBSERVER_ORDER.row(order=parts["observer_order"]))
    if parts.get("network", "decentralized") != "decentralized":
        rows.append(say.SHARED.row(sizes=list(parts["shared_dimensions"].items())))
    for block in parts.get("blocks", ()):
        carrier = say.CARRIER if len(parts["blocks"]) == 1 else say.CARRIER_FOR
        rows.append(
            carrier.row(agent=block.agent, order=block.order, channels=list(block.channels))
        )
        rows.append(say.ASSIGNED.row(p=block.polynomial))
    if "kept" in parts and parts["kept"].degree > 0:
        rows.append(say.KEPT.row(p=parts["kept"]))
    if "error_polynomial" in parts and design.loop.polynomial is not None:
        rows.append(say.FEEDBACK.row(p=parts["feedback_polynomial"]))
        rows.append(say.ERRORS.row(p=parts["error_polynomial"]))
    if design.region.bound is not None:
        rows.append(say.REGION.row(region=design.region))
    if design.name == "setpoint":
        rows.append(say.STEADY.row())
    rows.append(say.LONGEST.row(bits=design.controller.bit_length()))
    return rows


def _measured(design: Design) -> Table:
    """The figures of the loop; a dash where they are beyond floats."""
    what = "radius" if design.region.discrete else "abscissa"
    labels = {
        "largest_gain": "largest gain",
        "spectral": f"spectral {what}",
        "numerical": f"numerical {what}",
        "distance_to_instability": "distance to instability, at most",
    }
    rows = [
        (labels[key], "–" if value is None else f"{value:.6g}")
        for key, value in design.measures().items()
    ]
    return Table(say.MEASURED(), (), tuple(rows))


def verdict_view(
    found: StabilityVerdict, *, largest: bool = False, warnings: Sequence[str] = ()
) -> dict[str, Any]:
    """The verdict; ``certified`` is whether every eigenvalue lies in the region."""
    region = found.region
    bound = None if region.bound is None else str(region.bound)
    return {
        "certified": found.stable,
        "time": region.time,
        "bound": bound,
        "region": str(region),
        "method": found.method,
        "states": found.about.n,
        "blocks": list(found.blocks),
        "largest": bound if largest else None,
        "warnings": list(warnings),
    }


def verdict_tables(found: StabilityVerdict, *, largest: bool = False) -> tuple[Table, ...]:
    """The verdict in a few lines."""
    region, blocks = found.region, found.blocks
    rows = [
        say.LOOP_STATES.row(n=found.about.n),
        (say.INSIDE if found.stable else say.OUTSIDE).row(region=region),
        say.DECIDED_BLOCKS.row(sizes=blocks)
        if len(blocks) > 1
        else say.DECIDED.row(method=found.method),
    ]
    if largest and region.bound is not None:
        rows.append((say.LEAST if region.discrete else say.LARGEST).row(bound=region.bound))
    return (Table(say.LOOP(), (), tuple(rows)),)
