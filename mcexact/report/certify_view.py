"""The verdict on a controller as a table for people and as plain data for programs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mcexact.answer.wording import design as say
from mcexact.report.text import Table
from mcexact.synthesis.certify import ControllerVerdict


def verdict_view(found: ControllerVerdict, warnings: Sequence[str] = ()) -> dict[str, Any]:
    """The verdict; ``certified`` is whether every eigenvalue lies in the region."""
    region = found.verdict.region
    return {
        "certified": found.verdict.stable,
        "time": region.time,
        "bound": None if region.bound is None else str(region.bound),
        "region": str(region),
        "method": found.verdict.method,
        "states": found.loop.n,
        "blocks": list(found.blocks),
        "largest": None if found.largest is None else str(found.largest),
        "warnings": list(warnings),
    }


def verdict_tables(found: ControllerVerdict) -> tuple[Table, ...]:
    """The verdict in a few lines."""
    region = found.verdict.region
    rows = [
        say.LOOP_STATES.row(n=found.loop.n),
        (say.INSIDE if found.verdict.stable else say.OUTSIDE).row(region=region),
        _decided(found),
    ]
    if found.largest is not None:
        told = say.LEAST if region.discrete else say.LARGEST
        rows.append(told.row(bound=found.largest))
    return (Table(say.LOOP(), (), tuple(rows)),)


def _decided(found: ControllerVerdict) -> tuple[str, ...]:
    """How it was decided, and on which blocks."""
    if found.verdict.method == "lyapunov" and len(found.blocks) > 1:
        return say.DECIDED_BLOCKS.row(sizes=found.blocks)
    return say.DECIDED.row(method=found.verdict.method)
